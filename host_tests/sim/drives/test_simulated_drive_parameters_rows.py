# SPDX-License-Identifier: MIT
"""Every row of every family, asked and written over the bus: what its table says is what it does.

The answers are worked out here from the rows alone, in the words of the USS specification; which
layout a row is asked in is drawn, so that all of them are seen in a run. The access level is open,
the commissioning step the one that the number needs.
"""

import random

from boards.sim.drives.families import NAMES, mm3, named
from boards.sim.drives.parameters import (
    CHANGE,
    INDICES,
    MAXIMUM,
    MINIMUM,
    NUMBER,
    TYPE,
    is_word,
    value_of,
    words_of,
)
from drive_bench import OFF1, Bench

FAMILIES = tuple(named(name) for name in NAMES)
SEED = 6
LAYOUTS = (3, 4, 127)

READ, WRITE_WORD, WRITE_DOUBLE = 1, 2, 3
READ_ARRAY, WRITE_ARRAY_WORD, WRITE_ARRAY_DOUBLE, COUNT = 6, 7, 8, 9
REFUSED = 7


class Commissioner:
    """A drive of a family in a layout, open to all changes, and one of its rows."""

    def __init__(self, family, row, layout):
        self.row = row
        self.number = row[NUMBER]
        self.channel = family.CHANNEL
        parameters = {self.channel["level"]: 3 if family is mm3 else 4}
        self.layout = 3
        if family.LINK["layout"] is None:
            self.layout = layout
            parameters[family.LINK["pkw words"]] = layout
        self.bench = Bench(parameters, family=family)
        self.drive = self.bench.drive
        self.bench.exchange(*[0] * (3 if layout == 127 else self.layout) + [OFF1, 0])
        steps = self.channel["steps"]
        if row[CHANGE] == "C":
            self.drive.write(steps[0], 0, steps[1].get(self.number, 1))

    def ask(self, ak, index=0, words=None):
        """A task; AK and value words of the reply."""
        words = list(words or (0,))
        if self.layout == 4 and len(words) == 1:
            words = [0] + words
        if self.layout == 3:
            words = words[:1]
        page = 0x8000 if self.number >= 2000 else 0
        pke, ind = ak << 12 | self.number % 2000, page | index
        reply = self.bench.exchange(*[pke, ind] + words + [OFF1, 0])
        assert reply[:2] == [reply[0] & 0xF000 | self.number % 2000, ind]
        values = reply[2:-2]
        if self.layout == 4 and reply[0] >> 12 not in (2, 5):
            assert values[0] == 0
            values = values[1:]
        return reply[0] >> 12, values

    def refusal(self, ak, index=0, words=None):
        """The error number of a task that must be refused."""
        reply, values = self.ask(ak, index, words)
        assert reply == REFUSED, (self.number, ak, reply)
        return values[0]


def test_every_row_of_every_family():
    random.seed(SEED)
    for family in FAMILIES:
        for row in family.ROWS:
            layout = LAYOUTS[random.getrandbits(8) % 3]
            task = Commissioner(family, row, layout)
            try:
                check_reading(task, row)
                check_refusals(task, row)
                check_limits(task, row)
            except AssertionError as error:
                raise AssertionError((SEED, family.NAME, row, layout, error))


def fits(task):
    return is_word(task.row[TYPE]) or task.layout != 3


def check_reading(task, row):
    word = is_word(row[TYPE])
    array = READ_ARRAY in task.channel["tasks"]
    if not fits(task):
        assert task.refusal(READ) == 102
    else:
        ak, words = task.ask(READ)
        assert ak == (1 if word else 2) and len(words) == (1 if word else 2)
        if row[CHANGE]:  # a reading may have another value by now
            assert value_of(row[TYPE], words) == task.drive.read(task.number)
    if array and row[INDICES] > 1:
        first = task.channel["first index"]
        place = random.getrandbits(8) % row[INDICES]
        if fits(task):
            ak, words = task.ask(READ_ARRAY, first + place)
            assert ak == (4 if word else 5)
            if row[CHANGE]:
                assert value_of(row[TYPE], words) == task.drive.read(task.number, place)
        assert task.refusal(READ_ARRAY, first + row[INDICES]) == 3
        assert task.ask(COUNT) == (6, [row[INDICES]])
    elif array:
        assert task.refusal(READ_ARRAY, 2) == 4
        assert task.ask(COUNT) == (6, [1])


def check_refusals(task, row):
    word = is_word(row[TYPE])
    right, wrong = (WRITE_WORD, WRITE_DOUBLE) if word else (WRITE_DOUBLE, WRITE_WORD)
    if not row[CHANGE]:
        if fits(task):
            assert task.refusal(right, 0, (0,) if word else (0, 0)) == 1
        return
    if wrong in task.channel["tasks"] and (wrong == WRITE_WORD or task.layout != 3):
        assert task.refusal(wrong, 0, (0,) if wrong == WRITE_WORD else (0, 0)) == 5
    if not fits(task):
        assert task.refusal(right, 0, (0, 0)) == 102
        return
    before = task.drive.read(task.number)
    for value in beyond(row):
        assert task.refusal(right, 0, words_of(row[TYPE], value)) == 2, value
    last = task.channel["first index"] + row[INDICES]
    if row[INDICES] > 1 and WRITE_ARRAY_WORD in task.channel["tasks"]:
        ak = WRITE_ARRAY_WORD if word else WRITE_ARRAY_DOUBLE
        assert task.refusal(ak, last, words_of(row[TYPE], row[MINIMUM])) == 3
    assert task.drive.read(task.number) == before


def beyond(row):
    """Values just outside of the limits that the type can still carry."""
    low, high = row[MINIMUM], row[MAXIMUM]
    if row[TYPE] == "F":
        return (low - abs(low) / 1000 - 0.001, high * 1.001)
    values = []
    if low > (-0x8000 if row[TYPE] == "I16" else 0):
        values.append(low - 1)
    if high < {"U16": 0xFFFF, "I16": 0x7FFF, "U32": 0xFFFFFFFF}[row[TYPE]]:
        values.append(high + 1)
    return values


def check_limits(task, row):
    """They are taken, unless they are no legal setting (104), or the number only goes to 0 (6)."""
    if not row[CHANGE] or not fits(task):
        return
    family = task.drive.family
    value = row[MAXIMUM if random.getrandbits(1) else MINIMUM]
    ak = WRITE_WORD if is_word(row[TYPE]) else WRITE_DOUBLE
    place = 0
    if row[INDICES] > 1 and WRITE_ARRAY_WORD in task.channel["tasks"]:
        place = random.getrandbits(8) % row[INDICES]
        ak = WRITE_ARRAY_WORD if is_word(row[TYPE]) else WRITE_ARRAY_DOUBLE
    index = task.channel["first index"] + place if ak > WRITE_DOUBLE else 0
    words = words_of(row[TYPE], value)
    if value not in family.PERMITTED.get(task.number, (value,)):
        assert task.refusal(ak, index, words) == 104
    elif task.number in family.ONLY_ZERO and value:
        assert task.refusal(ak, index, words) == 6
    else:
        before = task.drive.eeprom_writes
        reply, values = task.ask(ak, index, words)
        assert reply == {2: 1, 3: 2, 7: 4, 8: 5}[ak]
        if task.number not in family.OPERATIONS:
            assert value_of(row[TYPE], values) == value
            assert task.drive.read(task.number, place) == value
            if family is not mm3:
                assert task.drive.eeprom_writes == before


def test_every_reading_has_a_value():
    """Whole numbers that fit their words, floats that are numbers."""
    for family in FAMILIES:
        drive = Bench(family=family).drive
        for row in family.ROWS:
            for index in range(row[INDICES]):
                value = drive.read(row[NUMBER], index)
                where = family.NAME, row[NUMBER], index, value
                if row[TYPE] == "F":
                    assert isinstance(value, (int, float)) and value == value, where
                else:
                    assert isinstance(value, int), where
                    bits = 32 if row[TYPE] == "U32" else 16
                    assert -(1 << (bits - 1)) <= value < 1 << bits, where
