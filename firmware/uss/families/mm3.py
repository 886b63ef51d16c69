# SPDX-License-Identifier: MIT
"""MICROMASTER 3."""

from uss import pzd
from uss.layout import Layout
from uss.families.generic import CUTS_OFF, GENERIC, RESCALES, codes
from uss.families.rows import ALL_DIGITS, COMMAND, COMMAND_SOURCE, COUNT_OF_ROWS, STEPS, WORD


class MM3(GENERIC):
    """MICROMASTER 3: MICROMASTER, MICROMASTER Vector, MIDIMASTER Vector. (?) all but the layout,
    0C7Fh and that IND is 0."""

    name = "MICROMASTER 3"
    layout = Layout(3, 2)
    pkw_choices = (3,)
    pzd_choices = range(2, 3)
    has_indices = False
    has_eeprom_tasks = False
    first_index = 0
    has_array_tasks = False
    baud_codes = codes(3, 7)
    baud = 9600
    baud_number = 92
    address_number = 91
    off_time_number = 93
    off_time_unit_ms = 1000
    off_time_fault = 8
    fault_number = 930
    fault_format = "F%03d"
    motor = (81, 82)
    access = (9, 3)
    save = (971, 1)
    shown = ((910, 4), (91, 30), (94, None), (12, None), (13, None))
    survey = (
        (910, 0, WORD, None),  # 1: ON and setpoint both come from USS
        None,
        (94, 0, STEPS, None),
        (95, 0, WORD, None),
        (12, 0, STEPS, None),
        (13, 0, STEPS, None),
        (93, 0, WORD, None),
    ) + (None,) * (COUNT_OF_ROWS - 7)
    meaning = ((COMMAND, COMMAND_SOURCE, ALL_DIGITS, (1,), None),)
    absolute_value = 2
    on = 0x0C7F  # bit 11 is "run right"
    on_reverse = 0x147F  # bit 12 is "run left"
    jog_right = pzd.JOG_RIGHT
    jog_left = pzd.JOG_LEFT
    hsw_is_signed = False
    hiw_is_signed = False
    is_cumulative = False
    stw_bits = "STW_BITS_MM3"
    zsw_bits = "ZSW_BITS_MM3"
    integer_doubles = ()
    ask_first = {
        9: CUTS_OFF,  # access level
        91: CUTS_OFF,
        92: CUTS_OFF,
        93: CUTS_OFF,
        94: RESCALES,
        95: RESCALES,
        910: CUTS_OFF,  # remote mode
        944: CUTS_OFF,  # factory reset
    }
    permanent = (91, 92)
