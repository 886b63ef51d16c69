# SPDX-License-Identifier: MIT
"""JSON to the letter, for a small file that a person may have written.

MicroPython's own reader takes a missing comma, one too many, and half a file for good. This one
takes what the standard (RFC 8259) allows and nothing else, and does not go deeper than DEPTH_MAX.

    fields(b'{"baud": 9600}')       # [("baud", 9600, b'"baud": 9600')]
"""

import json

DEPTH_MAX = 4  # each level takes stack
WORD_MAX = 24  # characters of a number

BLANKS = b" \t\r\n"
ENDS = BLANKS + b',:[]{}"'  # behind a number
WORDS = (b"true", b"false", b"null")
ESCAPED = b'"\\/bfnrtu'
HEXADECIMAL = b"0123456789abcdefABCDEF"
BACKSLASH, COLON, COMMA, LETTER_U, QUOTE = b'\\:,u"'
BRACE, BRACE_END, BRACKET, BRACKET_END = b"{}[]"


def fields(data):
    """The members of the object that `data` (bytes) is, in their order: name, value, source.

    ValueError: it is no object, no JSON, or nested too deep.
    """
    data.decode()  # UnicodeError is a ValueError
    reader = Reader(data)
    try:
        found = reader.members()
    except IndexError:
        raise ValueError("it ends too soon") from None
    reader.end()
    return found


class Reader:
    """Goes through `data` once; any method may raise ValueError, or IndexError at the end."""

    def __init__(self, data):
        self._data = data
        self._at = 0
        self._depth = 0

    def members(self):
        found = []
        for _ in self._items(BRACE, BRACE_END):
            self._peek()
            began = self._at
            name = self._string()
            self._take(COLON)
            value = self._value()
            found.append((name, value, self._data[began : self._at]))
        return found

    def end(self):
        """Nothing but blanks may follow."""
        if self._data[self._at :].strip(BLANKS):
            raise ValueError("more follows")

    def _items(self, first, last):
        """Once for each thing between two brackets, which the caller then reads."""
        self._take(first)
        self._depth += 1
        if self._depth > DEPTH_MAX:
            raise ValueError("nested too deep")
        if self._peek() != last:
            yield
            while self._peek() == COMMA:
                self._at += 1
                yield
        self._take(last)
        self._depth -= 1

    def _value(self):
        first = self._peek()
        if first == BRACE:
            return {name: value for name, value, _ in self.members()}
        if first == BRACKET:
            return [self._value() for _ in self._items(BRACKET, BRACKET_END)]
        return self._string() if first == QUOTE else self._word()

    def _string(self):
        data = self._data
        began = self._at
        self._take(QUOTE)
        while data[self._at] != QUOTE:
            if data[self._at] < 0x20:
                raise ValueError("a control character")
            if data[self._at] == BACKSLASH:
                self._escape()
            self._at += 1
        self._at += 1
        return json.loads(data[began : self._at])

    def _escape(self):
        data = self._data
        self._at += 1
        if data[self._at] not in ESCAPED:
            raise ValueError("no such escape")
        if data[self._at] == LETTER_U:
            for _ in range(4):
                self._at += 1
                if data[self._at] not in HEXADECIMAL:
                    raise ValueError("no such character")

    def _word(self):
        data = self._data
        began = self._at
        while data[self._at] not in ENDS:
            self._at += 1
        word = data[began : self._at]
        if word not in WORDS and not is_number(word):
            raise ValueError("no number")
        return json.loads(word)

    def _peek(self):
        """The next character that is no blank."""
        data = self._data
        while data[self._at] in BLANKS:
            self._at += 1
        return data[self._at]

    def _take(self, wanted):
        if self._peek() != wanted:
            raise ValueError("another character is due")
        self._at += 1


def is_number(word):
    """Whether JSON allows this number: no + in front, no 0 that leads, digits around the point."""
    mantissa, letter, exponent = word.lower().partition(b"e")
    whole, point, fraction = mantissa.partition(b".")
    if whole[:1] == b"-":
        whole = whole[1:]
    if exponent[:1] in (b"+", b"-"):
        exponent = exponent[1:]
    return (
        len(word) <= WORD_MAX
        and whole.isdigit()
        and (whole[:1] != b"0" or len(whole) == 1)
        and (not point or fraction.isdigit())
        and (not letter or exponent.isdigit())
    )
