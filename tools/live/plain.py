# SPDX-License-Identifier: MIT
"""What a terminal that shows only ASCII gets in place of other characters.

On MicroPython and on CPython.
"""

# The display's own characters; "?" for all others.
STAND_INS = {
    "\u2195": "^",  # up-down arrow
    "\u29d7": "X",  # hourglass
    "\u2192": ">",
    "\u2190": "<",
    "\u00a5": "Y",  # the ROM's yen sign
    "\u00b0": "o",
    "\u00c4": "A",  # umlauts: a letter has one place
    "\u00d6": "O",
    "\u00dc": "U",
    "\u00e4": "a",
    "\u00f6": "o",
    "\u00fc": "u",
    "\u00df": "s",
    "\u00b5": "u",
    "\u2026": ">",  # more is there
    "\u2502": "|",  # frames
    "\u2500": "-",
    "\u250c": "+",
    "\u2510": "+",
    "\u2514": "+",
    "\u2518": "+",
}


def in_ascii(text):
    """A text for a terminal without UTF-8, as wide as it is."""
    return "".join(one if ord(one) < 0x80 else STAND_INS.get(one, "?") for one in text)


def understands_utf_8(getenv):
    """Whether the environment says that the terminal understands UTF-8."""
    for name in ("LC_ALL", "LC_CTYPE", "LANG"):
        value = getenv(name)
        if value:
            return "UTF8" in value.upper().replace("-", "")
    return False
