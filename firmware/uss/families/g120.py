# SPDX-License-Identifier: MIT
"""SINAMICS G120, of both generations."""

from uss import pzd
from uss.layout import VARIABLE, Layout
from uss.families.generic import CUTS_OFF, GENERIC, RESCALES, codes
from uss.families.mm4 import MM440
from uss.families.rows import COUNT_OF_ROWS, RPM, WORD


class CU240S(MM440):
    """SINAMICS G120 of the first generation, with a Control Unit CU240S. (?) what the MM440 says
    besides the link, the scaling and the arrays."""

    name = "SINAMICS G120 CU240S"
    has_array_tasks = True


class G120(GENERIC):
    """SINAMICS G120 of the second generation (CU230-2, CU240-2, CU250-2), G120C, G120X."""

    name = "SINAMICS G120"
    layout = Layout(VARIABLE, 2)
    pzd_choices = range(0, 9)  # (?)
    first_index = 0
    baud_codes = codes(4, 13)
    baud = 38400  # (?)
    baud_number = 2020
    address_number = 2021
    pzd_words_number = 2022
    pkw_words_number = 2023
    off_time_number = 2040
    off_time_fault = 1910
    fault_number = 947  # (?)
    fault_format = "F%05d"
    motor = (310, 311)
    protocol = (2030, 1)
    save = (971, 1)
    shown = ((2021, 30), (2040, 65535))
    survey = (
        None,  # the macro p0015 = 21 connects ON and setpoint to the link
        None,
        (2000, 0, RPM, None),
        None,
        (1080, 0, RPM, None),
        (1082, 0, RPM, None),
        (2040, 0, WORD, None),  # (?) the type
    ) + (None,) * (COUNT_OF_ROWS - 7)
    on_reverse = pzd.ON_REVERSE
    takes_no_control = False  # (?) while it runs it trips with F07220
    stw_bits = "STW_BITS_G120"
    zsw_bits = "ZSW_BITS_G120"
    integer_doubles = "G120"
    ask_first = {  # (?) the selection
        10: CUTS_OFF,  # commissioning: the motor does not run
        15: CUTS_OFF,  # macro
        840: CUTS_OFF,  # source of ON
        970: CUTS_OFF,  # factory reset
        1070: CUTS_OFF,  # source of the setpoint
        2000: RESCALES,
        2020: CUTS_OFF,
        2021: CUTS_OFF,
        2022: CUTS_OFF,
        2023: CUTS_OFF,
        2030: CUTS_OFF,
        2040: CUTS_OFF,
        2051: RESCALES,  # what the drive sends
    }
    permanent = (2020, 2021, 2022, 2023, 2030)
