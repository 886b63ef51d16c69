"""The SINAMICS G110 as data: an MM420 without indices, and PKW of variable length as delivered.

Tables and columns are those of mm420.py. It may also go without any PKW words (recorded on a live
one: 0 + 2), and its ZSW says "left" while it stands. That it has no P2009 is general knowledge.

    Drive(clock, wire, 0, {2013: 0}, family=g110)
"""

from boards.sim import mm420
from boards.sim.drive_parameters import INDICES, NUMBER, rows_like

NAME = "SINAMICS G110"

# What is a list even here: process data and faults.
LISTS = (947, 2018, 2019)

ROWS = rows_like(
    mm420.ROWS,
    [row[:INDICES] + (1,) + row[INDICES + 1 :] for row in mm420.ROWS if row[NUMBER] not in LISTS]
    + [
        # number, name, type, unit, indices, minimum, maximum, default, change, level, note
        (700, "command source", "U16", "", 1, 0, 5, 2, "CT", 1, "0, 1 keypad, 2 terminals, 5 USS"),
        (2010, "USS baud rate", "U16", "", 1, 3, 9, 6, "CUT", 2, "a code, see BAUD_CODES"),
    ],
    without=(2009,),
)

PERMITTED = dict(mm420.PERMITTED)
PERMITTED[700] = (0, 1, 2, 5)

BAUD_CODES = {code: baud for code, baud in mm420.BAUD_CODES.items() if code <= 9}
COMMISSIONED = {3: 3, 700: 5, 1000: 5, 2012: 2, 2013: 127}
LINK = mm420.LINK
SETTINGS = tuple(row for row in mm420.SETTINGS if row[0] != "scaling")
OTHER_COMMANDS = mm420.OTHER_COMMANDS
SETPOINT_SOURCES = mm420.SETPOINT_SOURCES
READINGS = mm420.READINGS
STYLE = dict(mm420.STYLE)
STYLE["right at zero"] = False
STYLE["absolute"] = None
CHANNEL = mm420.CHANNEL
