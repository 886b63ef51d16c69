# SPDX-License-Identifier: MIT
"""What a simulated drive tells about its parameters: elements of a description, and texts.

They are made from the rows of the family and from its table of texts (USS specification C-6 and
C-4.2.2). This knows no tasks and refuses nothing: the channel does.

    element(row, 6, 0)              # the words of "ramp-up time    "
    texts = Texts({(7, 1, 3): "300 BAUD"})
    texts.words(7, 0x0003)          # the same, of the first text field, element 3
"""

from boards.sim.drives.parameters import (
    CHANGE,
    DEFAULT,
    INDICES,
    LEVEL,
    MAXIMUM,
    MINIMUM,
    NAME,
    TYPE,
    UNIT,
    words_of,
)

TEXT_CHARACTERS = 16

# Elements of a description, in the order of the complete one.
COMPLETE = (1, 2, 3, 4, 5, 6, 7, 8, 10)
IDENTIFIER, COUNT, FACTOR, QUANTITY, RIGHTS, TITLE, LOWEST, HIGHEST, FACTORY, EXTENSION = range(
    1, 11
)

# Low byte of the identifier (general knowledge, unverified), and its bits.
DATA_TYPES = {"I16": 3, "U16": 6, "U32": 7, "F": 8}
PROTECTED, HAS_TEXTS, ARRAY = 0x0200, 0x0400, 0x4000

# Quantity and conversion index by unit (general knowledge, unverified).
QUANTITIES = {"s": 0x0400, "ms": 0x04FD, "Hz": 0x1C00, "%": 0x1800, "V": 0x1500, "A": 0x1600}

# Bits of IND.
WRITES, SECOND_FIELD = 0x0100, 0x0200


def element(row, which, flags):
    """The words of an element of a description, 1...10, or of the complete one, 255.

    flags: bits of the identifier that do not follow from the row.
    """
    if which == 255:
        words = ()
        for one in COMPLETE:
            words += element(row, one, flags)
        return words
    if which == IDENTIFIER:
        return (identifier(row) | flags,)
    if which == COUNT:
        return (row[INDICES],)
    if which == FACTOR:
        return words_of("F", 1.0)
    if which == QUANTITY:
        return (QUANTITIES.get(row[UNIT], 0),)
    if which == RIGHTS:
        return (row[LEVEL], 0x0001 if row[CHANGE] else 0)
    if which == TITLE:
        return text_words(row[NAME])
    if which == EXTENSION:
        return (0,)
    value = row[{LOWEST: MINIMUM, HIGHEST: MAXIMUM, FACTORY: DEFAULT}[which]]
    if isinstance(value, tuple):
        value = value[0]
    return words_of(row[TYPE], value or 0)


def identifier(row):
    """Data type and bits of a parameter: element 1."""
    word = DATA_TYPES[row[TYPE]]
    word |= 0 if row[CHANGE] else PROTECTED
    return word | (ARRAY if row[INDICES] > 1 else 0)


def text_words(text):
    """Eight words: 16 characters, the first one in the high byte, filled up with blanks."""
    data = (text + " " * TEXT_CHARACTERS)[:TEXT_CHARACTERS].encode()
    return tuple(data[i] << 8 | data[i + 1] for i in range(0, TEXT_CHARACTERS, 2))


class Texts:
    """table: (number, field 1 or 2, element): text, as delivered; None: the drive has none."""

    def __init__(self, table):
        self._words = {place: text_words(text) for place, text in (table or {}).items()}

    @staticmethod
    def writes(ind):
        """Whether this IND makes a text task one that writes."""
        return bool(ind & WRITES)

    def has(self, number):
        """Whether there is any text to a number."""
        return any([place[0] == number for place in self._words])

    def exists(self, number, ind):
        return self._place(number, ind) in self._words

    def words(self, number, ind):
        """The eight words of a text that exists."""
        return self._words[self._place(number, ind)]

    def write(self, number, ind, words):
        """Keep these words if they are a text; return whether they are."""
        if len(words) != TEXT_CHARACTERS // 2:
            return False
        self._words[self._place(number, ind)] = tuple(words)
        return True

    def _place(self, number, ind):
        return number, 2 if ind & SECOND_FIELD else 1, ind & 0xFF
