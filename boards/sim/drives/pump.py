# SPDX-License-Identifier: MIT
"""A turbo pump with USS that is no Siemens drive: 4 + 6 words, its own status bits, no EEPROM
tasks.

The bits are those that TurboCtl (1.1.1, turboctl/telegram/codes.py) lists for a Leybold TURBOVAC
i/iX, and so are the length and the tasks. All else, parameters and scaling, is that of
generic.py: nobody measured a pump. It is like a file of `families`, with the tables and columns of
mm420.py, but --drives does not name it.

    Drive(clock, wire, 1, family=pump)
"""

from boards.sim.drives.families import generic

NAME = "turbo pump"

ROWS = generic.ROWS
PERMITTED = generic.PERMITTED
BAUD_CODES = generic.BAUD_CODES
COMMISSIONED = dict(generic.COMMISSIONED)
COMMISSIONED[2012] = 6
LINK = dict(generic.LINK)
LINK["broadcast"] = False
SETTINGS = generic.SETTINGS
OTHER_COMMANDS = generic.OTHER_COMMANDS
SOURCES = generic.SOURCES
SETPOINT_SOURCES = generic.SETPOINT_SOURCES
READINGS = generic.READINGS
OPERATIONS = generic.OPERATIONS
ONLY_ZERO = generic.ONLY_ZERO
KEPT = generic.KEPT
QUICK_COMMISSIONING = generic.QUICK_COMMISSIONING
TERMINALS = generic.TERMINALS
STYLE = dict(generic.STYLE)
STYLE["status"] = (
    (0x0001, "ready"),
    (0x0004, "operates"),
    (0x0008, "fault"),
    (0x0010, "faster"),
    (0x0020, "slower"),
    (0x0040, "inhibited"),
    (0x0800, "turns"),
    (0x4000, "warns"),
    (0x8000, "obeys"),
)
CHANNEL = dict(generic.CHANNEL)
CHANNEL["tasks"] = (1, 2, 3, 6, 7, 8)
