# SPDX-License-Identifier: MIT
"""The file of a parameter set, as the panel has it, with remarks for people.

    USS SET 1                           # 2026-11-24 15:40, MICROMASTER 440
    family mm440
    address 1
    name pump 3
    panel tools/uss
    rating 206 40400000
    P1082 0 Float 42220000              # 40.5 Hz, Max. frequency
    end 345 1A2B3C4D

A row is number, index, type and value in hex. The last line has the number of rows and the CRC-32
of all lines before it, each with a line feed, without the remarks and the blanks before them. A
file that was cut short or changed is none. `bare` leaves the remarks out, for a panel.
"""

import os
import re
import tempfile
import time
from binascii import crc32

from tools.uss_command.errors import Failure

FIRST, END, RATING = "USS SET 1", "end", "rating"
FIELDS = ("family", "address", "name", "panel")
WORDS, DOUBLES = ("U16", "I16"), ("U32", "I32", "Float", "BICO", "?32")
ROW = re.compile(r"P(\d{4,6}) (\d{1,3}) (\S+) ([0-9A-F]{4}(?:[0-9A-F]{4})?)$")
MADE_BY = "tools/uss"
NAME_MAX = 10
REMARK = "  # "
TYPE_OF_THE_PANEL = {"?32": "U32"}


class Row:
    """number, index, kind (type), high, low: what the drive has."""

    def __init__(self, number, index, kind, high, low, remark=""):
        self.number = number
        self.index = index
        self.kind = kind
        self.high = high
        self.low = low
        self.remark = remark

    @property
    def place(self):
        return self.number, self.index

    @property
    def words(self):
        return self.high, self.low

    def line(self):
        kind = TYPE_OF_THE_PANEL.get(self.kind, self.kind)
        value = "%04X" % self.low if kind in WORDS else "%04X%04X" % (self.high, self.low)
        return "P%04d %d %s %s" % (self.number, self.index, kind, value)


class ParameterSet:
    """family: as the catalogue calls it. address, name; ratings: number -> (high, low); rows."""

    def __init__(self, family, address, name, ratings=None, rows=()):
        self.family = family
        self.address = address
        self.name = name
        self.ratings = dict(ratings or {})
        self.rows = list(rows)

    def by_place(self):
        return {row.place: row for row in self.rows}


def text_of(one, about="", bare=False):
    """The text of a file. about: a remark behind the first line."""
    lines = [(FIRST, time.strftime("%Y-%m-%d %H:%M, ") + about)]
    values = (one.family, "%d" % one.address, one.name, MADE_BY)
    lines += [("%s %s" % pair, "") for pair in zip(FIELDS, values)]
    for number, words in sorted(one.ratings.items()):
        lines.append(("%s %d %04X%04X" % (RATING, number, *words), ""))
    lines += [(row.line(), row.remark) for row in sorted(one.rows, key=lambda row: row.place)]
    check = 0
    for line, _ in lines:
        check = crc32(line.encode() + b"\n", check)
    lines.append(("%s %d %08X" % (END, len(one.rows), check), ""))
    if bare:
        return "".join(line + "\n" for line, _ in lines)
    return "".join(
        (line.ljust(34) + REMARK + remark if remark else line) + "\n" for line, remark in lines
    )


def write_whole(path, text):
    """The file is there when it is whole; else what was there before. Failure."""
    folder = os.path.dirname(os.path.abspath(path))
    try:
        number, aside = tempfile.mkstemp(dir=folder, prefix=".uss", suffix=".part")
        try:
            with os.fdopen(number, "w", encoding="utf-8", newline="\n") as file:
                file.write(text)
                file.flush()
                os.fsync(file.fileno())
            os.replace(aside, path)
        except BaseException:
            os.unlink(aside)
            raise
    except OSError as error:
        raise Failure("%s: %s" % (path, error.strerror)) from None


def read_whole(path):
    """The `ParameterSet` in a file. Failure: it is none, or not whole."""
    try:
        with open(path, encoding="utf-8") as file:
            told = file.read().splitlines()
    except UnicodeDecodeError:
        raise Failure("%s: it is no parameter set" % path) from None
    except OSError as error:
        raise Failure("%s: %s" % (path, error.strerror)) from None
    lines = [re.sub(r"\s*#.*$", "", line).rstrip() for line in told]
    lines = [line for line in lines if line]
    if not lines or lines[0] != FIRST:
        raise Failure("%s: it is no parameter set (no %r in its first line)" % (path, FIRST))
    if lines[-1].split(" ")[0] != END:
        raise Failure("%s: it is not whole: there is no last line %r" % (path, END))
    check = 0
    for line in lines[:-1]:
        check = crc32(line.encode() + b"\n", check)
    one = _parsed(path, lines[1:-1])
    if lines[-1] != "%s %d %08X" % (END, len(one.rows), check):
        raise Failure("%s: it was changed or damaged: count or check are wrong" % path)
    return one


def _parsed(path, lines):
    fields = {}
    for number, field in enumerate(FIELDS):
        name, _, value = (lines[number : number + 1] or [""])[0].partition(" ")
        if name != field:
            raise Failure("%s: no line %r in its head" % (path, field))
        fields[field] = value
    try:
        one = ParameterSet(fields["family"], int(fields["address"]), fields["name"])
        for line in lines[len(FIELDS) :]:
            if line.startswith(RATING + " "):
                _, number, value = line.split(" ")
                one.ratings[int(number)] = int(value[:4], 16), int(value[4:], 16)
                continue
            found = ROW.match(line)
            if not found or (found[3] in WORDS) != (len(found[4]) == 4):
                raise ValueError(line)
            value = int(found[4], 16)
            row = Row(int(found[1]), int(found[2]), found[3], value >> 16, value & 0xFFFF)
            one.rows.append(row)
    except ValueError as error:
        raise Failure("%s: not understood: %s" % (path, error)) from None
    return one
