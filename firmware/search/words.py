# SPDX-License-Identifier: MIT
"""The texts of the search, in memory only while it works. See `panel.texts`."""

FIND_DRIVES_S = b"FIND DRIVES %3ds"
RATES_SET_GO = b"%d RATES SET=GO"
BAUD_SECONDS = b"%d BAUD %ds"
SEARCH_ENDS = b"ENDING"
FOUND_STOP_ENDS = b"%d FOUND STOP=NO"
TAKE_DRIVES = b"TAKE %d DRIVES?"
SET_YES = b"SET=YES PARAM=NO"
NOBODY_FOUND = b"NOBODY ANSWERED"
CHECK_WIRES = b"WIRES? MAINS?"
TAKEN = b"[X]"
NOT_TAKEN = b"[ ]"
