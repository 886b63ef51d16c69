# SPDX-License-Identifier: MIT
"""The texts of parameter sets, in memory only while one of their lists is shown. See
`panel.texts`.
"""

SETS = b"SETS"
SAVE = b"SAVE A%d"
GIVE_UP = b"GIVE UP A%d"  # the set that is on it in part
NO_SET_FILE = b"? %s"  # a file that is none

COMPARE = b"COMPARE A%d"
INTO_RAM = b"INTO A%d RAM"
INTO_EEPROM = b"INTO A%d EEPROM"
INTO = b"INTO A%d"  # of a family that does not tell RAM from EEPROM
DELETE = b"DELETE IT"

NAME = b"NAME, SET=SAVE"  # letter by letter

# While it works: address, percent; minutes, seconds, so many values differ.
SAVING = b"A%d SAVE %d%%"
CHECKING = b"A%d CHECK"
COMPARING = b"A%d COMPARE %d%%"
WRITING = b"A%d WRITE %d%%"
LEFT = b"%d:%02d LEFT"
LEFT_DIFFER = b"%d:%02d %d DIFF"

# Whether to write: row 1, and what row 2 says in turn.
SO_MANY = b"%d DIFFER"
OPENS = b"P%04d=%d FOR IT"  # the access level, meanwhile
ASK_WRITE = b"SET=WRITE A%d"
MAY_CUT = b"%d MAY CUT"
ASK_CUT = (b"THE BUS OFF, OR", b"CHANGE THE Hz:", b"SET=DO PARAM=NO")

# Other questions: what row 1 says in turn, row 2.
ASK_DELETE = (b"DELETE IT?",)
ASK_GIVE_UP = (b"A%d: SET IS HALF", b"WRITTEN. ALLOW", b"START, JOG?")
YES_OR_NO = b"SET=DO PARAM=NO"

# How it ended.
SAVED = b"SAVED: %d"
SAVED_UNTOLD = b"BUT %d UNTOLD"
ALL_EQUAL = b"ALL EQUAL"
DIFFER = b"DIFFER: %d"
WRITTEN_EQUAL = b"WRITTEN, EQUAL"
STILL_DIFFER = b"HALF, DIFFER %d"
NOTHING_WRITTEN = b"NOTHING WRITTEN"
HALF_WRITTEN = b"A%d: HALF A SET"

DIFFERENCE = b"%s>%s"  # what the drive has, and what the set says
ABSENT = b"---"  # the drive does not tell it

# What is wrong with a file, or against saving one.
NO_SET = b"IS NO SET"
CUT_SHORT = b"INCOMPLETE"
DAMAGED = b"DAMAGED"
TOO_BIG = b"TOO BIG"
OTHER_FAMILY = b"IT IS OF %s"
FLASH_FULL = b"FLASH IS FULL"  # or broken
TOO_MANY = b"20 SETS, DELETE"
NO_TABLE = b"NO TABLE OF IT"  # nobody knows what its family has
