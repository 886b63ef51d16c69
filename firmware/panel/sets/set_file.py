# SPDX-License-Identifier: MIT
"""The file of a parameter set: lines of text, as README.md beside this has them.

    head = read_head(store, "1.set")            # ValueError: it is none
    for row in rows(store, "1.set"): ...        # (place, number, index, type, high, low)

`rows` ends with ValueError, whose argument is a text, unless the file is whole and to the letter.
So whoever wants to be sure goes through it once before he does anything.
"""

from binascii import crc32

from micropython import const

from panel.menu.sets import words
from uss.pkw import INDEX_MAX, NUMBER_MAX

ENDING = ".set"
FIRST = b"US" + b"S SE" + b"T 1"  # in parts: it is no text of the display
END = b"end"
RATING = b"rating"
REMARK = b"#"
FIELDS = (b"family", b"address", b"name", b"panel")  # of the head, in this order
NAME_MAX = const(10)
SIZE_MAX = const(131072)  # bytes, with remarks
_LINE_MAX = const(64)  # without a remark
_PIECE = const(256)  # bytes that are read at once
WORDS = (b"U16", b"I16")  # types of 16 bits; the others have 32
DOUBLES = (b"U32", b"I32", b"Float", b"BI" + b"CO")
_AT_ONCE = const(2)  # lines, then somebody else's turn


class Head:
    """Whose set it is. ratings: number of a reading -> (high, low)."""

    def __init__(self, family, address, name):
        self.family = family
        self.address = address
        self.name = name
        self.ratings = {}


def head_lines(family, address, name, version, ratings):
    """The beginning of a file. ratings: as in `Head`."""
    values = (family, b"%d" % address, name, version)
    lines = [FIRST] + [field + b" " + value for field, value in zip(FIELDS, values)]
    return lines + [_rating(number, ratings[number]) for number in sorted(ratings)]


def row_line(number, index, kind, high, low):
    value = b"%04X" % low if kind in WORDS else b"%04X%04X" % (high, low)
    return b"P%04d %d %s %s" % (number, index, kind, value)


def end_line(count, check):
    return b"%s %d %08X" % (END, count, check)


def checked(line, check):
    """The check of all lines up to this one: CRC-32, each with a line feed behind it."""
    return crc32(line + b"\n", check)


def read_head(store, name):
    """ValueError: it is no set. OSError: it cannot be read."""
    file = store.open(name)
    try:
        return _head(_lines(file))[0]
    finally:
        file.close()


def _head(lines):
    """The head, the first line behind it, and the check so far."""
    values = []
    try:
        line = next(lines)
        if line != FIRST:
            raise ValueError(words.NO_SET)
        check = checked(line, 0)
        for field in FIELDS:
            line = next(lines)
            if line[: len(field) + 1] != field + b" ":
                raise ValueError(words.DAMAGED)
            values.append(line[len(field) + 1 :])
            check = checked(line, check)
        family, address, name, _ = values
        head = Head(family.decode(), int(address), name)
        if b"%d" % head.address != address or not 0 <= head.address <= 31:
            raise ValueError(words.DAMAGED)
        if not 0 < len(name) <= NAME_MAX or min(name) < 32:
            raise ValueError(words.DAMAGED)
        for line in lines:
            if line[: len(RATING)] != RATING:
                return head, line, check
            number, value = line.split(b" ")[1:]
            number, value = int(number), (int(value[:4], 16), int(value[4:], 16))
            if _rating(number, value) != line:
                raise ValueError(words.DAMAGED)
            head.ratings[number] = value
            check = checked(line, check)
    except StopIteration:
        pass
    except ValueError as error:
        raise _told(error)
    raise ValueError(words.CUT_SHORT)


def rows(store, name):
    """The rows of a file, and None where somebody else may have his turn. The generator's value is
    the check of the file, which tells one set from another.
    """
    file = store.open(name)
    try:
        lines = _lines(file)
        _, line, check = _head(lines)
        last, place = -1, 0
        while line[: len(END)] != END:
            row = _row(line)
            if row[0] << 8 | row[1] <= last:  # each stands there once, in order
                raise ValueError(words.DAMAGED)
            last = row[0] << 8 | row[1]
            check = checked(line, check)
            yield (place,) + row
            place += 1
            if not place % _AT_ONCE:
                yield None
            line = next(lines)
        if line != end_line(place, check) or list(lines):
            raise ValueError(words.DAMAGED)
        return check
    except StopIteration:
        raise ValueError(words.CUT_SHORT)
    finally:
        file.close()


def _row(line):
    """(number, index, type, high, low)."""
    try:
        key, index, kind, value = line.split(b" ")
        number, index = int(key[1:]), int(index)
        high, low = int(value[:-4] or b"0", 16), int(value[-4:], 16)
        is_known = kind in WORDS + DOUBLES and number <= NUMBER_MAX and index <= INDEX_MAX
        if is_known and line == row_line(number, index, kind, high, low):
            return number, index, kind, high, low
    except ValueError:
        pass
    raise ValueError(words.DAMAGED)


def _rating(number, value):
    return b"%s %d %04X%04X" % (RATING, number, value[0], value[1])


def _told(error):
    """With a text for people, whatever went wrong."""
    is_told = error.args and isinstance(error.args[0], bytes)
    return error if is_told else ValueError(words.DAMAGED)


def _lines(file):
    """The lines, without what ends them and without remarks. One that is nothing else is none."""
    left, size = b"", 0
    while True:
        piece = file.read(_PIECE)
        size += len(piece)
        if size > SIZE_MAX:
            raise ValueError(words.TOO_BIG)
        *whole, left = (left + piece).split(b"\n")
        if not piece and left:
            whole, left = [left], b""  # the last one need not end in a line feed
        for line in whole:
            mark = line.find(REMARK)
            if mark < 0:
                yield line[:-1] if line[-1:] == b"\r" else line
            elif line[:mark].rstrip():
                yield line[:mark].rstrip()
        if not piece:
            return
        if len(left) > _LINE_MAX:
            mark = left.find(REMARK)
            if mark < 0:
                raise ValueError(words.NO_SET)
            left = left[: mark + 1]  # a remark may be as long as it likes
