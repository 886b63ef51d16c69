# SPDX-License-Identifier: MIT
"""SINAMICS V20."""

from uss.layout import VARIABLE, Layout
from uss.families.generic import CUTS_OFF, codes
from uss.families.mm4 import MM440
from uss.families.rows import ABSOLUTE


class V20(MM440):
    """SINAMICS V20, as its connection macro Cn010 sets it up for USS."""

    name = "SINAMICS V20"
    layout = Layout(VARIABLE, 2)
    has_array_tasks = True
    has_bop_link = False  # index 1 is reserved
    baud_codes = codes(6, 12)
    baud = 38400
    fault_format = "F%d"
    protocol = (2023, 1)  # 2 is Modbus; acts after a power cycle
    survey = MM440.survey[:ABSOLUTE] + (None,) + MM440.survey[ABSOLUTE + 1 :]  # (?) it has none
    absolute_value = None
    ask_first = dict(MM440.ask_first)
    ask_first[717] = CUTS_OFF  # (?) connection macro: rewrites the sources and the link
    permanent = MM440.permanent + (2023,)
