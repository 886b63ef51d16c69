# SPDX-License-Identifier: MIT
"""The SINAMICS G110 as data: an MM420 without indices, and PKW of variable length as delivered.

Tables and columns are those of mm420.py. It may also go without any PKW words (recorded on a live
one: 0 + 2), and its ZSW says "left" while it stands. That it has no P2009 is general knowledge.

    Drive(clock, wire, 0, {2013: 0}, family=g110)
"""

from boards.sim.drives.parameters import DEFAULT, INDICES, NUMBER, only, rows_like
from boards.sim.drives.families import mm420

NAME = "SINAMICS G110"

# What is a list even here: user list, process data, faults, warnings, the make.
LISTS = (13, 947, 948, 949, 964, 2018, 2019, 2110)

# What it has no hardware for: analog output, communication board, link on the keypad's side, PID
# controller (general knowledge). And no P2009.
WITHOUT = (
    771, 773, 774, 776, 777, 778, 779, 780, 781, 918, 2009, 2015, 2016, 2032, 2033, 2040, 2050,
    2051, 2053, 2054, 2090, 2091, 2200, 2253, 2264, 2266, 2280, 2285, 2291, 2292, 2294,
)  # fmt: skip


def _without_index(row):
    default = row[DEFAULT]
    if isinstance(default, tuple):
        default = default[0]
    return row[:INDICES] + (1,) + row[INDICES + 1 : DEFAULT] + (default,) + row[DEFAULT + 1 :]


ROWS = rows_like(
    mm420.ROWS,
    [_without_index(row) for row in mm420.ROWS if row[NUMBER] not in LISTS]
    + [
        # number, name, type, unit, indices, minimum, maximum, default, change, level, note
        (700, "command source", "U16", "", 1, 0, 5, 2, "CT", 1, "0, 1 keypad, 2 terminals, 5 USS"),
        (1000, "frequency setpoint source", "U16", "", 1, 0, 55, 2, "CT", 1, "see PERMITTED"),
        (1800, "pulse frequency", "U16", "kHz", 1, 2, 16, 8, "CUT", 2, ""),
        (2010, "USS baud rate", "U16", "", 1, 3, 9, 6, "CUT", 2, "a code, see BAUD_CODES"),
    ],
    without=WITHOUT,
)

PERMITTED = only(mm420.PERMITTED, ROWS)
PERMITTED[700] = (0, 1, 2, 5)
SOURCES = (0, 1, 2, 3, 5)
PERMITTED[1000] = tuple(10 * additional + main for additional in SOURCES for main in SOURCES)
PERMITTED[1300] = (0, 2, 3)

BAUD_CODES = {code: baud for code, baud in mm420.BAUD_CODES.items() if code <= 9}
COMMISSIONED = {3: 3, 700: 5, 1000: 5, 2012: 2, 2013: 127}
LINK = mm420.LINK
NUMBERS = [row[NUMBER] for row in ROWS]
SETTINGS = tuple(row for row in mm420.SETTINGS if row[1] in NUMBERS)
OTHER_COMMANDS = mm420.OTHER_COMMANDS
SOURCES = mm420.SOURCES
SETPOINT_SOURCES = mm420.SETPOINT_SOURCES
READINGS = only(mm420.READINGS, ROWS)
OPERATIONS = mm420.OPERATIONS
ONLY_ZERO = mm420.ONLY_ZERO
KEPT = (100, 2010, 2011)
QUICK_COMMISSIONING = mm420.QUICK_COMMISSIONING
TERMINALS = mm420.TERMINALS
STYLE = dict(mm420.STYLE)
STYLE["right at zero"] = False
STYLE["absolute"] = None
CHANNEL = mm420.CHANNEL
