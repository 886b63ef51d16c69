# SPDX-License-Identifier: MIT
"""How the value of a parameter reads, and how it is typed: word, double word, with a sign,
floating point, hexadecimal, a connector 52:3.

    form = Form(row, pkw.DOUBLE)                # row of the catalogue, or None
    form.words(high, low)                       # b"10.00"
    form.typed(high, low)                       # bytearray(b" 0010.00"), digit by digit
    form.bits(typed)                            # what the drive is sent; ValueError: beyond it

The catalogue says how a value is meant; the drive says how wide it is, which goes first.
"""

import catalogue
from micropython import const

from uss import pkw

UNSIGNED, SIGNED, FLOAT, CONNECTOR, HEX = range(5)
_KINDS = {"I16": SIGNED, "I32": SIGNED, "Float": FLOAT, "BICO": CONNECTOR}

_DIGITS = "0123456789ABCDEF"
_DECIMALS = const(3)  # of a floating-point number that the catalogue does not know
_PLACES = const(6)  # likewise, before the point
TYPED_MAX = 13  # characters, with the sign
_FLOAT_MAX = const(999_999_999)  # what is beyond is typed in hexadecimal


class Form:
    """list: the list of texts that the values or the bits have, such as b"v700"; or b"".

    unit: behind the value. lowest, highest: as in the catalogue, b"" if unknown.
    """

    def __init__(self, row, width, is_hex=False):
        self.width = width
        self.unit = self.lowest = self.highest = self.list = b""
        kind, form = b"", b""
        if row:
            kind, self.unit, form = row[catalogue.TYPE], row[catalogue.UNIT], row[catalogue.FORM]
            self.lowest, self.highest = row[catalogue.LOWEST], row[catalogue.HIGHEST]
        if self.unit[:1].isdigit():
            self.unit = b" " + self.unit  # 1395 1/min
        kind = _KINDS.get(kind.decode(), UNSIGNED) if kind else FLOAT
        if width == pkw.WORD and kind != SIGNED:
            kind = UNSIGNED
        if form[:1] in (b"v", b"b"):
            self.list = form
        if is_hex or form == b"x" or form[:1] == b"b":
            kind = HEX
        self.kind = kind
        self._decimals = int(form) if form.isdigit() else _DECIMALS

    def words(self, high, low, decimals=None):
        """A value as it is read. decimals: fewer than it has."""
        bits = self._joined(high, low)
        if self.kind == HEX:
            return b"%0*Xh" % (4 * self.width, bits)
        if self.kind == CONNECTOR:
            return b"%d:%d" % (high, low)
        if self.kind == FLOAT:
            value = pkw.words_to_float(high, low)
            return b"%.*f" % (self._decimals if decimals is None else decimals, value)
        return b"%d" % self._signed(bits)

    def fitting(self, high, low, width):
        """The same with its unit, as far as there is room for that and the decimals."""
        words = self.words(high, low)
        if self.unit and len(words) + len(self.unit) <= width:
            return words + self.unit
        decimals = self._decimals
        while self.kind == FLOAT and len(words) > width and decimals:
            decimals -= 1
            words = self.words(high, low, decimals)
        return words

    def roughly(self, high, low):
        """A number that has no room in any other way."""
        bits = self._joined(high, low)
        is_float = self.kind == FLOAT
        return b"%.4g" % (pkw.words_to_float(high, low) if is_float else self._signed(bits))

    def can_be_typed(self, high, low):
        """Whether the digits of a value can be typed one by one."""
        return self.kind != FLOAT or abs(pkw.words_to_float(high, low)) <= _FLOAT_MAX

    def typed(self, high, low):
        """A value with all its places, and the place of its ones."""
        bits = self._joined(high, low)
        kind = self.kind
        if kind == FLOAT:
            return self._typed_float(pkw.words_to_float(high, low))
        if kind == HEX:
            text = b"%0*X" % (4 * self.width, bits)
        elif kind == CONNECTOR:
            text = b"%05d:%03d" % (high, low)
        else:
            value = self._signed(bits)
            text = b"%0*d" % (self._places(value, 5 if self.width == pkw.WORD else 10), abs(value))
            if kind == SIGNED:
                text = _sign(value) + text
        return bytearray(text), text.find(b":") - 1 if kind == CONNECTOR else len(text) - 1

    def _typed_float(self, value):
        decimals = self._decimals
        while True:
            text = b"%.*f" % (decimals, abs(value))
            point = text.find(b".")
            missing = self._places(value, _PLACES) - (point if decimals else len(text))
            text = b"0" * missing + text
            if len(text) < TYPED_MAX or not decimals:
                break
            decimals -= 1
        if value < 0 or not self.lowest or self.lowest[:1] == b"-":
            text = _sign(value) + text
        return bytearray(text), (text.find(b".") if decimals else len(text)) - 1

    def _places(self, value, unknown):
        """How many a number has in front of the point while it is typed."""
        highest = catalogue.value(self.highest)
        places = unknown if highest is None else len(str(int(highest)))
        return max(places, len(str(abs(int(value)))))

    def bits(self, typed):
        """The value that was typed as 16 or 32 bits. ValueError: beyond what they can say."""
        text = bytes(typed).decode()
        if self.kind == HEX:
            return int(text, 16)
        if self.kind == FLOAT:
            high, low = pkw.float_to_words(float(text))
            return self._joined(high, low)
        if self.kind == CONNECTOR:
            number, index = [int(part) for part in text.split(":")]
            return self._joined(pkw.word_of(number), pkw.word_of(index))
        return self.of_number(int(text))

    def of_number(self, value):
        """A whole number as 16 or 32 bits. ValueError: as above."""
        if self.width == pkw.WORD:
            bits = pkw.word_of(value)
        else:
            high, low = pkw.words_of(value)
            bits = high << 16 | low
        if self._signed(bits) != value:
            raise ValueError("%r is beyond its type" % (value,))
        return bits

    def number(self, high, low):
        """The value as a whole number, as the lists of the catalogue have it."""
        return self._signed(self._joined(high, low))

    def _joined(self, high, low):
        return low if self.width == pkw.WORD else high << 16 | low

    def _signed(self, bits):
        half = 1 << 16 * self.width - 1
        return bits - 2 * half if self.kind == SIGNED and bits >= half else bits


def turn(typed, place, direction, base=10):
    """UP or DOWN on this place of what is typed: the digit goes round by itself."""
    code = typed[place]
    if code in b"+-":
        typed[place] = 0x2D if code == 0x2B else 0x2B
        return
    digit = _DIGITS.find(chr(code))
    typed[place] = ord(_DIGITS[(digit + direction) % base])


def move(typed, place, direction):
    """The next place, or the one before, that holds a digit or a sign."""
    while True:
        place = (place + direction) % len(typed)
        if typed[place] not in b".:":
            return place


def _sign(value):
    return b"-" if value < 0 else b"+"
