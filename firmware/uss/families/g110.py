# SPDX-License-Identifier: MIT
"""SINAMICS G110."""

from uss.layout import VARIABLE, Layout
from uss.families import rows
from uss.families.mm4 import MM420
from uss.families.rows import CENTIHERTZ, SOURCE, WORD


class G110(MM420):
    """SINAMICS G110, the variant with USS instead of the analogue input."""

    name = "SINAMICS G110"
    layout = Layout(VARIABLE, 2)
    has_indices = False
    has_bop_link = False
    survey = (
        (700, 0, WORD, None),
        (1000, 0, WORD, None),
        (2000, 0, CENTIHERTZ, None),
        None,  # (?) that it has none
        (1080, 0, CENTIHERTZ, None),
        (1082, 0, CENTIHERTZ, None),
        (2014, 0, WORD, None),
        (1210, 0, WORD, 0),
        (2024, 0, rows.COUNT, 0),
        None,  # one data set of each kind
        None,
        (2019, 0, SOURCE, None),
        None,  # (?) how the other words of P2019 are asked for
        (719, 0, WORD, 0),
        (840, 0, SOURCE, rows.source(2036, 0)),
        (1070, 0, SOURCE, rows.source(2018, 1)),
        None,  # (?) no PID controller
    )
    absolute_value = None
