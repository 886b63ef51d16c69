"""What a drive says of its parameters: descriptions, texts, changes made by somebody else.

The panel does without: no MICROMASTER, G110 or V20 has texts or reports changes, and the panel
knows its parameters. Tasks 4, 5 and 15, replies 9...12 (specification C-4.2.1.2, C-4.2.2, C-6).

    job = read_description(2010, LOWER_LIMIT)   # or read_text(7, 3): the meaning of value 2
    drive.ask(job)                              # ... later:
    if job.state == pkw.DONE: print(job.description().lower)

    reports = Reports(drive.channel)
    report = reports.get()                      # a change, or None
"""

import struct
from array import array

from micropython import const

from uss import pkw
from uss.pkw_array import LongJob

# --- descriptions -------------------------------------------------------------------------------

IDENTIFIER, ELEMENTS, FACTOR, QUANTITY, ACCESS, NAME = range(1, 7)
LOWER_LIMIT, UPPER_LIMIT, DEFAULT, EXTENSION = range(7, 11)

# In the order of the complete description, which goes without DEFAULT (SIDOOR has that). A size of
# 0 is that of the parameter's value.
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
NARROW_SIZE = const(36)  # characters of it when the value is a word; four more for a double word
WIDE_SIZE = const(40)

# Identifier: bits 0-7 data type, the others as SIDOOR and TR have them. Bit 8 (scaling) means the
# opposite with each of the two.
I16, I32, U8, U16, U32, FLOAT, STRING = range(3, 10)
WRITE_PROTECTED = const(1 << 9)
HAS_TEXTS = const(1 << 10)
CHANGED = const(1 << 12)  # from the factory setting
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
        """Take one element as it came; nothing when it is none of DESCRIPTION."""
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
    """An unsigned number of `size` characters as what its data type says it is."""
    if data_type == FLOAT and size == 4:
        return pkw.words_to_float(value >> 16, value & 0xFFFF)
    half = 1 << 8 * size - 1
    return value - 2 * half if data_type in (I16, I32) and value >= half else value


class DescriptionJob(LongJob):
    """Reads or writes description elements. element: 1...10, or pkw.ALL, the whole description.

    characters: to write them; None reads. An element of two characters fits every channel, one of
    four needs four words; names and the whole need variable length, or the drive refuses.
    ValueError when an element has not so many characters.
    """

    def __init__(self, number, element, characters=None):
        task = pkw.READ_DESCRIPTION if characters is None else pkw.WRITE_DESCRIPTION
        if characters is not None and not is_size(element, len(characters)):
            raise ValueError("element %r of %d characters" % (element, len(characters)))
        super().__init__(task, number, element, words_of(characters or b""), WIDE_SIZE // 2)

    def description(self):
        """A `Description` of what came."""
        description = Description()
        characters = self._characters()
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

    def _characters(self):
        if self.count:
            return characters_of(self.data[: self.count])
        return characters_of((self.high, self.low))

    def _is_whole(self, reply, words):
        return is_size(self.index, 2 * words)


def read_description(number, element=pkw.ALL):
    """A job that reads one description element, or all; see `DescriptionJob`."""
    return DescriptionJob(number, element)


def write_description(number, element, characters):
    """A job that writes one description element, or all, as they go over the line."""
    return DescriptionJob(number, element, characters)


# --- texts --------------------------------------------------------------------------------------

TEXT_SIZE = const(16)  # characters
_WRITE = const(1 << 8)  # bits of IND
_SECOND_FIELD = const(1 << 9)


class TextJob(LongJob):
    """Reads or writes a text of 16 characters. Needs variable length; MASTERDRIVES have them.

    field 1: of an array, the meaning of each index (element = index); of a number, that of each
    value (element = value + 1). field 2: of an array, that of each value (element = value + 1).
    ValueError: no such field or element, or characters that no drive can have.
    """

    def __init__(self, number, element, field, characters=None):
        if not 1 <= element <= pkw.INDEX_MAX or field not in (1, 2):
            raise ValueError("text %r of field %r" % (element, field))
        words = () if characters is None else words_of(characters)
        super().__init__(pkw.TEXT, number, element, words, TEXT_SIZE // 2)
        page = (0 if characters is None else _WRITE) | (_SECOND_FIELD if field == 2 else 0)
        self.words[2] |= page >> 8
        self.key |= page

    def fits(self, form):
        """Whether a channel of this form can carry it."""
        return bool(form & pkw.VARIABLE_LENGTH) and super().fits(form)

    @property
    def text(self):
        """The text, without the blanks behind it."""
        return text_of(characters_of(self.data[: self.count]))

    def _is_whole(self, reply, words):
        return 2 * words == TEXT_SIZE


def read_text(number, element, field=1):
    """A job that reads a text; see `TextJob`."""
    return TextJob(number, element, field)


def write_text(number, element, text, field=1):
    """A job that writes a text, 0...16 characters of Latin-1."""
    characters = bytes([ord(character) for character in text])
    if len(characters) > TEXT_SIZE:
        raise ValueError("a text of %d characters" % len(characters))
    return TextJob(number, element, field, characters + b" " * (TEXT_SIZE - len(characters)))


# --- change reports -----------------------------------------------------------------------------

REPORT, REPORT_DOUBLE, REPORT_ELEMENT, REPORT_ELEMENT_DOUBLE = range(9, 13)  # AK
REPORTS_MAX = const(8)  # that wait; a power of two

_FIELDS = const(5)  # of a report in the ring: PKE, IND, width, high word, low word
_TOGGLE = const(0x08)  # bit 11 of PKE


class Report:
    """A parameter that somebody else has changed.

    number, index: which; index pkw.ALL is the whole array. width: pkw.WORD or pkw.DOUBLE, the
    value as in a `Job`; or 0 when the report has none, as of a whole array: it must be read.
    """

    def __init__(self, words):
        self.number = (words[0] & 0x07FF) + pkw.PNU_PER_PAGE * page_of(words[1])
        self.index = words[1] & 0xFF
        self.width = words[2]
        self.high = words[3]
        self.low = words[4]

    integer_value = pkw.Job.integer_value
    signed_value = pkw.Job.signed_value
    float_value = pkw.Job.float_value


class Reports:
    """Takes the change reports of a drive, and acknowledges each by sending its bit 11 back.

    channel: the drive's. RuntimeError when it has no PKW words. As long as REPORTS_MAX wait, the
    next is not acknowledged: the drive repeats it, and answers no task before. `close` ends it.

    Written by the loop: _out. By the engine: everything else.
    """

    def __init__(self, channel):
        self.bit = 0  # for the first character of PKE
        self._known = False  # a reply has said what the bit is
        self._ring = array("H", [0] * (_FIELDS * REPORTS_MAX))
        self._in = 0
        self._out = 0
        self._channel = channel
        channel.follow(self)

    def get(self):
        """The oldest `Report` that waits, once; None when there is none."""
        out = self._out
        if out == self._in:
            return None
        at = out % REPORTS_MAX * _FIELDS
        report = Report(self._ring[at : at + _FIELDS])
        self._out = (out + 1) % (2 * REPORTS_MAX)
        return report

    def close(self):
        """Follow no reports any more."""
        self._channel.follow(None)

    # --- for the engine: allocates nothing ------------------------------------------------------

    def take(self, net, at, count, form):
        """Look at the PKW words of a reply, `count` characters in `net` from index `at` on."""
        bit = net[at] & _TOGGLE
        if REPORT <= net[at] >> 4 <= REPORT_ELEMENT_DOUBLE:
            # One that was seen before is repeated with the same bit until its echo has come.
            if self._known and bit == self.bit:
                return
            if (self._in - self._out) % (2 * REPORTS_MAX) == REPORTS_MAX:
                return
            self._keep(net, at, count, form)
        self.bit = bit  # in other replies it is the last that was acknowledged
        self._known = True

    def _keep(self, net, at, count, form):
        wide = not net[at] >> 4 & 1  # AK 10 and 12
        low_at = at + 6 if wide or form == pkw.FOUR_WORDS else at + 4
        ring = self._ring
        to = self._in % REPORTS_MAX * _FIELDS
        ring[to] = net[at] << 8 | net[at + 1]
        ring[to + 1] = net[at + 2] << 8 | net[at + 3]
        if net[at + 3] == pkw.ALL or wide and count < pkw.FOUR_WORDS:
            ring[to + 2] = ring[to + 3] = ring[to + 4] = 0
        else:
            ring[to + 2] = pkw.DOUBLE if wide else pkw.WORD
            ring[to + 3] = net[at + 4] << 8 | net[at + 5] if wide else 0
            ring[to + 4] = net[low_at] << 8 | net[low_at + 1]
        self._in = (self._in + 1) % (2 * REPORTS_MAX)


# --- words and characters -----------------------------------------------------------------------


def page_of(ind):
    """The page of 2000 numbers that an IND word names; see `pkw.ind`."""
    return ind >> 15 & 0x01 | ind >> 11 & 0x0E | ind >> 6 & 0x30


def characters_of(words):
    """Words as the characters that they travel as."""
    return b"".join([struct.pack(">H", word) for word in words])


def words_of(characters):
    """An even number of characters as words."""
    return [number_of(characters[at : at + 2]) for at in range(0, len(characters), 2)]


def number_of(characters):
    """The unsigned number that characters are, the high one first."""
    return int.from_bytes(characters, "big")


def text_of(characters):
    """Characters as a text, without the blanks behind it."""
    return "".join([chr(character) for character in characters]).rstrip(" \0")
