# SPDX-License-Identifier: MIT
"""What a drive says of a parameter: its limits, name, unit, data type ... (tasks 4 and 5).

The description elements of specification C-6. Not every drive has them, or all of them; with
fixed length it tells one at a time. The panel knows its parameters and does not need this.

    job = read_description(2010, LOWER_LIMIT)   # without an element: all of them
    drive.ask(job)                              # ... later:
    if job.state == pkw.DONE: print(job.description().lower)
"""

import struct

from micropython import const

from uss import pkw
from uss.tasks.long_jobs import LongJob, characters_of, number_of, text_of, words_of

IDENTIFIER, ELEMENTS, FACTOR, QUANTITY, ACCESS, NAME = range(1, 7)
LOWER_LIMIT, UPPER_LIMIT, DEFAULT, EXTENSION = range(7, 11)

# In the order of the complete description, which lacks DEFAULT (SIDOOR has that element). Size 0
# means the size of the parameter's value.
DESCRIPTION = (  # element, its characters, `Description` field
    (IDENTIFIER, 2, "identifier"),
    (ELEMENTS, 2, "elements"),
    (FACTOR, 4, "factor"),
    (QUANTITY, 2, "quantity"),
    (ACCESS, 4, "access"),
    (NAME, 16, "name"),
    (LOWER_LIMIT, 0, "lower"),
    (UPPER_LIMIT, 0, "upper"),
    (DEFAULT, 0, "default"),
    (EXTENSION, 2, "extension"),
)
NARROW_SIZE = const(36)  # characters of it if the value is a word; four more for a double word
WIDE_SIZE = const(40)

# Identifier: bits 0-7 are the data type, the others are as SIDOOR and TR have them. Bit 8
# (scaling) means one thing with SIDOOR and the opposite with TR.
I16, I32, U8, U16, U32, FLOAT, STRING = range(3, 10)
WRITE_PROTECTED = const(1 << 9)
HAS_TEXTS = const(1 << 10)
CHANGED = const(1 << 12)  # it differs from the factory setting
ONLY_RESETTABLE = const(1 << 13)
ARRAY = const(1 << 14)


def is_size(element, size):
    """Whether a description element may have so many characters."""
    if element == pkw.ALL:
        return size in (NARROW_SIZE, WIDE_SIZE)
    for row, characters, _ in DESCRIPTION:
        if row == element and characters:
            return size == characters
    return size in (2, 4)


class Description:
    """What a drive says of a parameter; a field that was not asked for is None.

    identifier   word: data type (`data_type`) and flags, WRITE_PROTECTED ...
    elements     of an array
    factor       float: the value times this is in the physical unit
    quantity     word: index of the physical quantity, index of the conversion
    access       four characters: password, group, rights
    name         text
    lower, upper limits, and `default`; with sign or point when the identifier says so
    extension    word
    """

    def __init__(self):
        for _, _, field in DESCRIPTION:
            setattr(self, field, None)

    def data_type(self):
        """I16, I32, U8, U16, U32, FLOAT or STRING; None when it was not asked for."""
        return None if self.identifier is None else self.identifier & 0xFF

    def take(self, element, characters):
        """Take one element as it came; ignore one that is not in DESCRIPTION."""
        for row, size, field in DESCRIPTION:
            if row == element:
                setattr(self, field, self._value(element, characters[-size:]))

    def _value(self, element, characters):
        if element == FACTOR:
            return struct.unpack(">f", characters)[0]
        if element == ACCESS:
            return characters
        if element == NAME:
            return text_of(characters)
        value = number_of(characters)
        if element in (LOWER_LIMIT, UPPER_LIMIT, DEFAULT):
            return typed(value, len(characters), self.data_type())
        return value


def typed(value, size, data_type):
    """An unsigned number of `size` characters, converted to its data type."""
    if data_type == FLOAT and size == 4:
        return pkw.words_to_float(value >> 16, value & 0xFFFF)
    half = 1 << 8 * size - 1
    return value - 2 * half if data_type in (I16, I32) and value >= half else value


class DescriptionJob(LongJob):
    """Reads or writes description elements. element: 1...10, or pkw.ALL, the whole description.

    characters: what to write; None reads. An element of two characters fits every channel, one of
    four needs four words. Names and the whole description need variable length, or the drive
    refuses. ValueError if the element does not have so many characters.
    """

    def __init__(self, number, element, characters=None):
        task = pkw.READ_DESCRIPTION if characters is None else pkw.WRITE_DESCRIPTION
        if characters is not None and not is_size(element, len(characters)):
            raise ValueError("element %r of %d characters" % (element, len(characters)))
        super().__init__(task, number, element, words_of(characters or b""), WIDE_SIZE // 2)

    def description(self):
        """A `Description` of what came."""
        description = Description()
        characters = characters_of(self.data[: self.count] or (self.high, self.low))
        if self.index != pkw.ALL:
            description.take(self.index, characters)
            return description
        limit_size = 2 if len(characters) == NARROW_SIZE else 4
        at = 0
        for element, size, _ in DESCRIPTION:
            if element != DEFAULT:
                end = at + (size or limit_size)
                description.take(element, characters[at:end])
                at = end
        return description

    def _is_whole(self, reply, words):
        return is_size(self.index, 2 * words)


def read_description(number, element=pkw.ALL):
    """A job that reads one description element, or all; see `DescriptionJob`."""
    return DescriptionJob(number, element)


def write_description(number, element, characters):
    """A job that writes one description element, or all, as they go over the line."""
    return DescriptionJob(number, element, characters)
