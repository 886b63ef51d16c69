# SPDX-License-Identifier: MIT
"""The picture that a display shows: two rows of sixteen character codes.

Drawing writes into the picture and allocates nothing; a display driver finds the differences.
Words come in ISO 8859-1, those of `texts` and those of the catalogue alike, and this is the only
place that knows what the display has for their letters.

    screen.put(1, 0, 12, texts.RUNNING)         # in a field of 12, blanks after it
    screen.number(0, 2, 5, -1000, 2)            # -10.00 in a field of 5: "-10.0"
"""

from micropython import const

from uss import fast

ROWS = const(2)
COLUMNS = const(16)

# Character codes with pictures of our own, 5 x 8 dots, and the pictures one after the other.
BUSY, EDITS = range(2)  # 2, 3, 4: see the table below
GLYPHS = bytes(
    (0x1F, 0x11, 0x0A, 0x04, 0x0A, 0x11, 0x1F, 0x00)  # an hourglass
    + (0x04, 0x0E, 0x15, 0x04, 0x04, 0x15, 0x0E, 0x04)  # an arrow up and down
    + (
        0x0A,
        0x00,
        0x0E,
        0x11,
        0x1F,
        0x11,
        0x11,
        0x00,
    )  # A, O and U with two dots, which ROM A00 lacks
    + (0x0A, 0x00, 0x0E, 0x11, 0x11, 0x11, 0x0E, 0x00)
    + (0x0A, 0x00, 0x11, 0x11, 0x11, 0x11, 0x0E, 0x00)
)

# What the display has for the characters 80h...FFh of ISO 8859-1. Most have ROM A00: a letter that
# it lacks goes without its accent. ROM A02 has them where ISO 8859-1 has them.
_OF_ROM_A00 = (
    b"????????????????????????????????"
    b'\x20!\xec\xed?\x5c|?"ca<--R-'
    b"\xdf?23'\xe4?\xa5,1o>????"
    b"AAAA\x02AACEEEEIIII"
    b"DNOOOO\x03xOUUU\x04YP\xe2"
    b"aaaa\xe1aaceeeeiiii"
    b"d\xeeoooo\xef\xfdouuu\xf5ypy"
)
_ACCENTED = const(0x80)  # the first of them

_BLANK = const(0x20)
_BLANKS = bytes((_BLANK,)) * COLUMNS
_MINUS = const(0x2D)
_POINT = const(0x2E)
_ZERO = const(0x30)
_NINE = const(0x39)
_CARET = const(0x5E)
_DIVISORS = (100, 10, 1)  # of hundredths, by the decimals that are left


class Screen:
    """picture: a bytearray of ROWS * COLUMNS codes, row by row. rom: of the display, "A00" or
    "A02".
    """

    def __init__(self, rom="A00"):
        self.picture = bytearray(b" " * (ROWS * COLUMNS))
        self._codes = bytes(range(_ACCENTED, 0x100)) if rom == "A02" else _OF_ROM_A00

    def put(self, row, column, width, text):
        """Write `text` into a field of `width`, cut or filled with blanks on the right.

        text: bytes in ISO 8859-1, and below 8 the pictures of our own.
        """
        at = row * COLUMNS + column
        count = min(len(text), width)
        fast.translate(text, self.picture, at, count, self._codes)
        fast.copy(_BLANKS, self.picture, at + count, width - count)

    def number(self, row, column, width, hundredths, decimals):
        """Write a number right-aligned with up to `decimals` (0...2) decimals, rounded.

        The rule for values that need more room: the field keeps its place and its width, and
        decimals are given up, the last first, until the value fits. A value that does not fit even
        then fills the field with 9s, so that it cannot be read as a small one.
        """
        magnitude = abs(hundredths)
        negative = hundredths < 0
        for left in range(decimals, -1, -1):
            divisor = _DIVISORS[left]
            digits = (magnitude + divisor // 2) // divisor
            if self._digits(row * COLUMNS + column, width, digits, left, negative):
                return
        for index in range(width):
            self.picture[row * COLUMNS + column + index] = _NINE

    def digits(self, row, column, width, number):
        """Write a whole number, not negative, in exactly `width` digits: 0001. The last ones of
        more digits.
        """
        at = row * COLUMNS + column
        for position in range(at + width - 1, at - 1, -1):
            self.picture[position] = _ZERO + number % 10
            number //= 10

    def mark(self, count):
        """Write a ^ over so many of the first places: FN of a compact keypad."""
        for place in range(count):
            self.picture[place] = _CARET

    def rows(self):
        """Both rows as text, for people and tests."""
        text = "".join(self._letter(code) for code in self.picture)
        return text[:COLUMNS], text[COLUMNS:]

    def _letter(self, code):
        """As `put` was given it."""
        of_rom = code < _BLANK or code >= _ACCENTED
        place = self._codes.find(bytes((code,))) if of_rom else -1
        return chr(code if place < 0 else _ACCENTED + place)

    def _digits(self, at, width, digits, decimals, negative):
        """Write `digits`, a point before the last `decimals`; False when the field is short."""
        negative = negative and digits != 0  # -0.00 reads as if it turned
        picture = self.picture
        position = at + width - 1
        if decimals:
            if width < decimals + 2:  # at least one digit before the point
                return False
            for _ in range(decimals):
                picture[position] = _ZERO + digits % 10
                digits //= 10
                position -= 1
            picture[position] = _POINT
            position -= 1
        while position >= at:
            picture[position] = _ZERO + digits % 10
            digits //= 10
            position -= 1
            if not digits:
                break
        if digits or negative and position < at:
            return False
        if negative:
            picture[position] = _MINUS
            position -= 1
        while position >= at:
            picture[position] = _BLANK
            position -= 1
        return True
