# SPDX-License-Identifier: MIT
"""The SINAMICS V20 as data: an MM440 with other defaults, as its macro Cn010 sets it up for USS.

Tables and columns are those of mm420.py. It supervises the line, P2014, 500 ms after the macro and
2000 ms as delivered, but only once it has had process data. That it has no P2009 is general
knowledge, and so is the default of P2014.

    Drive(clock, wire, 1, family=v20)
"""

from boards.sim.drives.parameters import only, rows_like
from boards.sim.drives.families.mm4_parameters import LAST_SOURCE
from boards.sim.drives.families import mm440

NAME = "SINAMICS V20"

# What it has no hardware for: further inputs and outputs, communication board, link on the side of
# the keypad (general knowledge). And no P2009.
WITHOUT = (
    705, 706, 707, 708, 733, 918, 2009, 2015, 2016, 2032, 2033, 2040, 2050, 2051, 2053, 2054,
    2090, 2091, 3980,
)  # fmt: skip

ROWS = rows_like(
    mm440.ROWS,
    (
        # number, name, type, unit, indices, minimum, maximum, default, change, level, note
        (208, "rated inverter voltage", "U32", "V", 1, None, None, 400, "", 2, ""),
        (304, "rated motor voltage", "U16", "V", 3, 10, 2000, 400, "C", 1, ""),
        (700, "command source", "U16", "", 3, 0, 5, 1, "CT", 1, "0, 1 keypad, 2 terminals, 5 USS"),
        (720, "number of digital inputs", "U16", "", 1, None, None, 4, "", 3, ""),
        (840, "source of ON", "U32", "", 3, 0, LAST_SOURCE, 0x00130000, "CT", 3, "19:0, keypad"),
        (927, "parameters changeable via", "U16", "", 1, 0, 31, 31, "CUT", 2, "bit 3 this bus"),
        (947, "last fault codes", "U16", "", 64, None, None, 0, "", 2, ""),
        (948, "fault times", "U16", "", 64, None, None, 0, "", 3, ""),
        (949, "fault values", "U32", "", 64, None, None, 0, "", 3, ""),
        (952, "number of faults", "U16", "", 1, 0, 64, 0, "CT", 3, "0 clears"),
        (970, "factory reset", "U16", "", 1, 0, 21, 0, "C", 1, "1, 21 reset and return to 0"),
        (1000, "frequency setpoint source", "U16", "", 3, 0, 77, 1, "CT", 1, "see PERMITTED"),
        (1070, "source of the main setpoint", "U32", "", 3, 0, LAST_SOURCE, 0x041A0000, "CT", 3,
         "1050:0, the motor potentiometer"),
        (2000, "reference frequency", "F", "Hz", 3, 1.0, 599.0, 50.0, "CT", 2, "4000h in PZD"),
        (2010, "USS baud rate", "U16", "", 2, 6, 12, 8, "CUT", 2, "a code, see BAUD_CODES"),
        (2011, "USS address", "U16", "", 2, 0, 31, 1, "CUT", 2, ""),
        (2014, "USS telegram off time", "U16", "ms", 2, 0, 65535, 2000, "CT", 3, "0: none"),
        (2021, "Modbus address", "U16", "", 1, 1, 247, 1, "T", 2, ""),
        (2023, "RS485 protocol", "U16", "", 1, 0, 3, 1, "T", 1, "1 USS; from power-up on"),
    ),
    without=WITHOUT,
)  # fmt: skip

PERMITTED = only(mm440.PERMITTED, ROWS)
PERMITTED[700] = (0, 1, 2, 5)
PERMITTED[970] = (0, 1, 21)
SOURCES = (0, 1, 2, 3, 5, 7)
PERMITTED[1000] = tuple(10 * additional + main for additional in SOURCES for main in SOURCES)

BAUD_CODES = {code: baud for code, baud in mm440.BAUD_CODES.items() if code >= 6}
COMMISSIONED = {3: 3, 700: 5, 1000: 5, 2012: 2, 2013: 127, 2014: 500}
LINK = dict(mm440.LINK)
LINK["from process data"] = True
LINK["protocol"] = 2023
SETTINGS = tuple(row for row in mm440.SETTINGS if row[0] != "scaling")
OTHER_COMMANDS = mm440.OTHER_COMMANDS
SOURCES = mm440.SOURCES
SETPOINT_SOURCES = mm440.SETPOINT_SOURCES
READINGS = only(mm440.READINGS, ROWS)
OPERATIONS = mm440.OPERATIONS
ONLY_ZERO = mm440.ONLY_ZERO
KEPT = (2010, 2021, 2023)
QUICK_COMMISSIONING = mm440.QUICK_COMMISSIONING
TERMINALS = mm440.TERMINALS
STYLE = dict(mm440.STYLE)
STYLE["absolute"] = None
CHANNEL = mm440.CHANNEL
