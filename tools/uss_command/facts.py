# SPDX-License-Identifier: MIT
"""What the catalogue says of the parameters of a drive: names, units, types, texts, faults.

facts = Facts(MM440)
facts.name(1082)                    # "Max. frequency"
number, index = parameter("r0021[0]")
facts.value(job)                    # 50.0: by its type in the catalogue, else the family's
facts.shown(700, 5)                 # "5 USS COM link"
"""

import re

import catalogue
from tools.uss_command.errors import Misused
from uss import families, pkw
from uss.families.questions import is_float

LIKE = {"mm4": "mm420", "cu240s": "mm440", "generic": None}  # families without a table of theirs
SPEC = re.compile(r"[PpRr]?(\d{1,6})(?:\[(\d{1,3})\])?$")
TYPES = ("word", "dword", "float")
DOUBLES = ("U32", "I32", "Float", "BICO")
ENCODING = "latin-1"


def parameter(text):
    """(number, index) of P1082, r0021[0], 1082. Misused."""
    found = SPEC.match(text)
    if not found or int(found[1]) > pkw.NUMBER_MAX or int(found[2] or 0) > pkw.INDEX_MAX:
        raise Misused("%s is no parameter such as P1082 or r0021[0]" % text)
    return int(found[1]), int(found[2] or 0)


class Facts:
    """family: of `uss.families`."""

    def __init__(self, family):
        self.family = family
        family = getattr(family, "com", None) or family
        while not family.__module__.startswith(families.__name__):
            family = family.__base__  # a class of the user's own
        name = family.__name__.lower()
        name = LIKE.get(name, name)
        self.catalogue = name if name in catalogue.FAMILIES else None
        self._rows = {}

    def row(self, number):
        """The row of the catalogue, or None."""
        if self.catalogue is None:
            return None
        if number not in self._rows:
            self._rows[number] = catalogue.find(self.catalogue, number)
        return self._rows[number]

    def _cell(self, number, column):
        row = self.row(number)
        return row[column].decode(ENCODING) if row else ""

    def name(self, number):
        return self._cell(number, catalogue.NAME)

    def unit(self, number):
        return self._cell(number, catalogue.UNIT)

    def type(self, number):
        """U16 I16 U32 I32 Float BICO, or "" where nobody knows."""
        return self._cell(number, catalogue.TYPE)

    def asks(self, number):
        """ "C": it may cut the bus off; "R": a setpoint may mean something else; or ""."""
        told = self._cell(number, catalogue.ASKS)
        return told or ("C" if number in self.family.ask_first else "")

    def label(self, number, index=0):
        """r0021[0] or P1082[0]."""
        row = self.row(number)
        letter = "r" if row and row[catalogue.KEY][:1] == b"r" else "P"
        return "%s%04d[%d]" % (letter, number, index)

    def kind(self, job):
        """The type of what a finished job has read: that of the catalogue if its width fits."""
        told = self.type(job.number)
        if told and (told in DOUBLES) == (job.width == pkw.DOUBLE):
            return told
        if job.width == pkw.WORD:
            return "U16"
        if self.family.integer_doubles is None:
            return "?32"
        return "Float" if is_float(self.family, job.number) else "U32"

    def value(self, job):
        """The value that a finished job has read."""
        return self.of_words(self.kind(job), job)

    def of_words(self, kind, job):
        if kind == "Float":
            return single(job.float_value())
        return job.signed_value() if kind in ("I16", "I32") else job.integer_value()

    def shown(self, number, value, kind=None):
        """A value as people read it, with the text of a choice."""
        kind = kind or self.type(number)
        if kind == "BICO":
            return "%d:%d" % (value >> 16, value & 0xFFFF)
        if isinstance(value, float):
            return "%.6g" % value
        text = self.choice(number, value)
        return "%d%s" % (value, " " + text if text else "")

    def choice(self, number, value):
        row = self.row(number)
        if not row or row[catalogue.FORM][:1] != b"v":
            return ""
        for choice in catalogue.choices(self.catalogue, row[catalogue.FORM]):
            if catalogue.number(choice, 1) == value:
                return choice[catalogue.NAME].decode(ENCODING)
        return ""

    def fault(self, number):
        """{"fault": "F0001", "name", "cause", "remedy"}"""
        told = {"fault": self.family.fault_format % number}
        row = catalogue.fault(self.catalogue, number) if self.catalogue else None
        if row:
            for name, column in (
                ("name", catalogue.NAME), ("cause", catalogue.CAUSE), ("remedy", catalogue.REMEDY)
            ):  # fmt: skip
                told[name] = row[column].decode(ENCODING).replace("|", " ")
        return told

    def parameters(self, numbers=None):
        """(number, indices) of what can be set, in order. numbers: b"300-311 335" or None."""
        if self.catalogue is None:
            return
        for row in catalogue.rows(self.catalogue, numbers or catalogue.ALL):
            self._rows[catalogue.number(row)] = row
            if row[catalogue.KEY][:1] == b"P":
                yield catalogue.number(row), catalogue.indices(row)


def single(value):
    """A single, as short as it can be told from its neighbours: 40.5, 0.1."""
    return float("%.7g" % value)


def number_of(text, kind):
    """What a person has typed as a value of this type. Misused."""
    try:
        if ":" in text:
            number, index = text.split(":")
            return int(number) << 16 | int(index)
        if kind == "Float":
            value = float(text.replace(",", "."))
            if value - value != 0:
                raise ValueError
            return value
        return int(text, 16 if text.lower().startswith("0x") else 10)
    except ValueError:
        wanted = "a number" if kind == "Float" else "an integer"
        raise Misused("%s is not %s" % (text, wanted)) from None
