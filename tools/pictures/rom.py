# SPDX-License-Identifier: MIT
"""The dots of the display's characters: ROM A00 of the HD44780U, in 5 x 8.

`rom_a00.json` has 8 rows of 5 dots for each code from 20h to 7Fh and from A0h to FFh; the leftmost
dot of a row is its bit 4. The dots are those of table 4 of the data sheet (Hitachi, ADE-207-272,
1999), read from the squares of its page 17, not from a picture of it. The table has ten rows for
E0h...FFh; the panel runs the display with eight. lcd1602-font-a00.ts of wokwi-elements (commit
6a2c268c) agrees in all 192 characters, display-module-2 of display-module-fonts (commit 856205a0)
in 94 of its 96: "i" and "w" are one dot off there. Codes below 10h are the firmware's own
characters: their dots come from the display's memory.
"""

import json
from pathlib import Path

ROWS, COLUMNS = 8, 5
OWN = 0x10  # codes below this have their dots in the display's memory, two codes each
FILE = Path(__file__).with_name("rom_a00.json")


def rom():
    """{code: rows}."""
    return {int(code, 16): rows for code, rows in json.loads(FILE.read_text()).items()}


def rows_of(code, cgram, known):
    """The 8 rows of a character. cgram: 64 bytes. known: what `rom` answers."""
    if code < OWN:
        first = (code & 7) * ROWS
        return [row & 0x1F for row in cgram[first : first + ROWS]]
    return known[code]
