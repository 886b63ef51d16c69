# SPDX-License-Identifier: MIT
"""A drive that does all that the USS specification knows. No such drive exists.

Tables and columns are those of mm420.py, and so are its numbers. It has every rate, 0...16 PZD
words, complete descriptions and texts, and counts the elements of an array from 1. A task that is
not for arrays has no index (C-4.2.2): with one it is refused. P4, P7, P9 and P18 are those of the
specification's examples (C-8).

    Drive(clock, wire, 1, {2013: 127, 2012: 16}, family=generic, reports=True)
"""

from boards.sim.drives.parameters import rows_like
from boards.sim.drives.families import mm420

NAME = "drive of the specification"

ROWS = rows_like(
    mm420.ROWS,
    (
        # number, name, type, unit, indices, minimum, maximum, default, change, level, note
        (4, "array of double words", "U32", "", 4, 0, 0xFFFFFFFF, (1, 2, 3, 4), "CUT", 1, ""),
        (7, "value with texts", "U16", "", 1, 0, 9, 2, "CUT", 1, "texts tell its values"),
        (9, "array with texts", "U16", "", 3, 0, 9, 5, "CUT", 1, "of its elements and values"),
        (18, "word", "U16", "", 1, 0, 0xFFFF, 0, "CUT", 1, ""),
        (19, "signed word", "I16", "%", 1, -1000, 1000, -1, "CUT", 1, ""),
        (2010, "USS baud rate", "U16", "", 2, 1, 13, 6, "CUT", 2, "a code, see BAUD_CODES"),
        (2012, "USS PZD length", "U16", "words", 2, 0, 16, 2, "CUT", 3, ""),
        (2018, "PZD received", "U16", "", 16, None, None, 0, "", 3, ""),
        (2019, "PZD sent", "U32", "", 16, 0, 0x0FA00000,
         (0x00340000, 0x00150000, 0, 0x00350000) + (0,) * 12, "CT", 3, ""),
    ),
)  # fmt: skip

PERMITTED = mm420.PERMITTED

BAUD_CODES = {1: 300, 2: 600, 13: 187500}
BAUD_CODES.update(mm420.BAUD_CODES)

COMMISSIONED = mm420.COMMISSIONED
LINK = mm420.LINK
SETTINGS = mm420.SETTINGS
OTHER_COMMANDS = mm420.OTHER_COMMANDS
SOURCES = mm420.SOURCES
SETPOINT_SOURCES = mm420.SETPOINT_SOURCES
READINGS = mm420.READINGS
OPERATIONS = mm420.OPERATIONS
ONLY_ZERO = mm420.ONLY_ZERO
KEPT = mm420.KEPT
QUICK_COMMISSIONING = mm420.QUICK_COMMISSIONING
TERMINALS = mm420.TERMINALS
STYLE = mm420.STYLE
CHANNEL = {
    "tasks": (1, 2, 3, 4, 5, 6, 7, 8, 9, 11, 12, 13, 14, 15),
    "pages": True,
    "first index": 1,
    "plain index": False,
    "scalar as array": False,
    "elements": (1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 255),
    "variable elements": (),
    "neighbours": 2,
    "texts": {
        (7, 1, 3): "300 BAUD",
        (7, 1, 4): "600 BAUD",
        (9, 1, 1): "BAUDRATE FOR SS1",
        (9, 1, 2): "BAUDRATE FOR SS2",
        (9, 2, 4): "1200 BAUD",
    },
    "level": 3,
    "user list": None,
    "rights": (927, 0x0008),
    "steps": mm420.CHANNEL["steps"],
    "active": mm420.CHANNEL["active"],
    "tightened": mm420.CHANNEL["tightened"],
}
