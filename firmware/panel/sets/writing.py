# SPDX-License-Identifier: MIT
"""From a file into a drive, or only compared with it.

phase       what goes on                                        ends when
CHECKS      the file is gone through, then the drive's rating   it is whole: COMPARES
COMPARES    each value is read and compared                     nothing differs: over
                                                                to be written: ASKS
ASKS        somebody is asked whether to write what differs     yes: WRITES
WRITES      the drive is marked as half written, in flash;      done: ASKS_CUT, if there is
            then what differs is written, part of it in         something of that kind, else
            commissioning (P0010 = 1)                           VERIFIES
ASKS_CUT    likewise, about what may cut the bus off or change  yes: it is written. VERIFIES
            what a setpoint means, see `ask_first` of a family
VERIFIES    everything is compared again; once more WRITES,     nothing differs: the mark is
            because a parameter may have changed another one    taken away
"""

from micropython import const

from panel.menu.sets import words
from panel.pages.parameter_words import NO_ANSWER, failure
from panel.sets import pump, set_file
from panel.sets.work import Work, catalogue_of
from uss import pkw
from uss.families import rows as survey_rows

CHECKS, COMPARES, ASKS, WRITES, ASKS_CUT, VERIFIES = range(6)

LISTED_MAX = const(20)  # differences that are shown
_ROUNDS = const(2)
_HIDDEN = const(204)  # by the access level
_NOT_IN_THIS_MODE = const(17)
_COMMISSIONING = const(10)

# What another drive keeps, besides what asks first: bus and sources (numbers, first and last).
BUS_AND_SOURCES = (
    (700, 719), (800, 927), (1000, 1000), (1055, 1056), (1070, 1076), (1110, 1113), (1140, 1142),
    (2009, 2051), (2103, 2106),
)  # fmt: skip
# What a drive with another rating keeps: motor and rating.
MOTOR = ((100, 100), (200, 399), (601, 640), (1800, 1825), (1900, 1926))
OF_FAMILY = {"mm3": (((6, 7), (91, 95)), ((71, 89), (101, 101)))}


class Write(Work):
    """name: of the file. eeprom: whether it is written there too; None: it is only compared.

    phase. differs: so many values; listed: the first of them, each (number, index, type,
    high, low of the set, high, low of the drive or None); cutters: of those that ask.
    opens: its access level is opened for the writing. answer: what somebody says to ASKS and
    ASKS_CUT.
    """

    def __init__(self, panel, control, name, eeprom=None):
        self._name = name
        self._eeprom = eeprom
        self.phase = CHECKS
        self.differs = 0
        self.cutting = 0  # of them
        self.listed = []
        self.cutters = []
        self.answer = None
        self._declined = False
        self._level = None  # of the access, as it was
        self._level_row = None  # what the set says of it, if it differs
        self._refusal = None
        self._check = None  # of the file, as text
        self._todo = bytearray()  # a bit for each row: it differs
        Work.__init__(self, panel, control)
        family = catalogue_of(self.family)
        self._left_out = OF_FAMILY.get(family, (BUS_AND_SOURCES, MOTOR))
        self._is_other = self._is_rated_otherwise = False

    @property
    def opens(self):
        access = self.family.access
        return access is not None and self._level is not None and self._level < access[1]

    def work(self):
        settings, address = self.panel.settings, self.drive.address
        yield from self._look_through()
        self.phase = COMPARES
        yield from self._compare()
        if not self.differs:
            # Another set than the one that is on it in part says nothing of what that has changed.
            if settings.half_written.get(str(address)) == self._check:
                settings.note_set(address)
            self.outcome = (words.ALL_EQUAL,)
            return
        if self._eeprom is None:
            self.outcome = (words.DIFFER, self.differs)
            return
        yield from self._ask(ASKS)
        if not self.answer:
            self.outcome = (words.NOTHING_WRITTEN,)
            return
        settings.note_set(address, self._check)
        while settings.dirty:
            yield
        self.done, self.total = 0, self.total + self.differs
        for turn in range(_ROUNDS):
            yield from self._write(not turn)
            self.phase = VERIFIES
            yield from self._compare()
            if not self.differs:
                break
        self.control.survey.recheck()
        if self.differs:
            self.outcome = (words.STILL_DIFFER, self.differs)
        else:
            settings.note_set(address)
            self.outcome = (words.WRITTEN_EQUAL,)

    # --- parts of it, generators ----------------------------------------------------------------

    def _look_through(self):
        store = self.panel.board.store
        head = set_file.read_head(store, self._name)
        if head.family != catalogue_of(self.family):
            raise ValueError(words.OTHER_FAMILY, head.family.upper().encode())
        count = 0
        rows = set_file.rows(store, self._name)
        while True:
            try:
                row = next(rows)
            except StopIteration as ended:
                self._check = "%08X" % ended.value
                break
            if row is None:
                yield
            else:
                self.done = count = count + 1
        self.done = 0
        self.total = max(count, 1)
        self._todo = bytearray(count + 8 >> 3)
        self._is_other = head.address != self.drive.address
        ratings = {}
        yield from self.read_ratings(lambda *told: ratings.update({told[0]: told[1:]}))
        self._is_rated_otherwise = ratings != head.ratings or self._is_other and not ratings
        if self.family.access:
            job = yield from self.one(*pump.reads(self.family, self.family.access[0], 0))
            self._level = job.low if job.state == pkw.DONE else None

    def _compare(self):
        self.differs = self.cutting = 0
        self.listed = []
        self.cutters = []
        self._level_row = None
        yield from pump.run(self.drive, self._readings(), self._take_reading)

    def _readings(self):
        for row in set_file.rows(self.panel.board.store, self._name):
            if row is None:
                yield None
            elif self._is_left_out(row[1]):
                self._set(row[0], False)
                self.done += 1
            else:
                yield pump.reads(self.family, row[1], row[2]), row

    def _take_reading(self, job, row):
        if self.is_to_be_repeated(job):
            return True
        self.done += 1
        place, number, _, kind, high, low = row
        is_double = kind in set_file.DOUBLES
        told = (None, None)
        if job.state == pkw.DONE:
            told = job.high if is_double else 0, job.low
        elif job.state == pkw.TIMED_OUT:
            raise ValueError(NO_ANSWER)
        elif job.error == _HIDDEN:
            raise ValueError(*failure(job))
        width = pkw.DOUBLE if is_double else pkw.WORD
        is_equal = job.state == pkw.DONE and job.width == width and told == (high, low)
        self._set(place, not is_equal)
        if not is_equal:
            self.differs += 1
            if number in self.family.ask_first:
                self.cutting += 1
                self.cutters.append(row[1:] + told)
            if self.family.access and number == self.family.access[0]:
                self._level_row = row
            if len(self.listed) < LISTED_MAX:
                self.listed.append(row[1:] + told)
        return False

    def _ask(self, phase):
        self.phase, self.answer, self.asks = phase, None, True
        while self.answer is None:
            yield
        self.asks = False

    def _write(self, asks):
        """Write what differs."""
        family, access = self.family, self.family.access
        self.phase = WRITES
        if self.opens:
            yield from self._one_write(access[0], access[1])
        self._refusal = None
        if self.differs > self.cutting:
            yield from self._write_those(False)
            if self._refusal == _NOT_IN_THIS_MODE and _COMMISSIONING in family.ask_first:
                yield from self._one_write(_COMMISSIONING, 1)
                yield from self._write_those(False)
                yield from self._one_write(_COMMISSIONING, 0)
        if self.cutting and asks:
            yield from self._ask(ASKS_CUT)
            self._declined = not self.answer
            self.phase = WRITES
        if self.cutting and not self._declined:
            yield from self._write_those(True)
        level_row = None if self._declined else self._level_row
        if level_row:
            self._level = level_row[-1]
            yield from self.one(*pump.writes(family, level_row, self._eeprom))
        elif self.opens:
            yield from self._one_write(access[0], self._level)

    def _write_those(self, cuts):
        yield from pump.run(self.drive, self._writes(cuts), self._take_write, 1)

    def _writes(self, cuts):
        family = self.family
        level = family.access[0] if family.access else None
        for row in set_file.rows(self.panel.board.store, self._name):
            if row is None:
                yield None
            elif self._is_set(row[0]) and row[1] != level and cuts == (row[1] in family.ask_first):
                yield pump.writes(family, row, self._eeprom), row

    def _take_write(self, job, row):
        if job.state == pkw.DONE:
            self._set(row[0], False)
            self.done += 1
        elif job.state == pkw.REFUSED and self._refusal != _NOT_IN_THIS_MODE:
            self._refusal = job.error
        return False

    def _one_write(self, number, value):
        """Into RAM. ValueError: the drive did not do it."""
        job = yield from self.one(pkw.WRITE_WORD, number, 0, 0, value)
        if job.state != pkw.DONE:
            raise ValueError(*failure(job))

    # --- which values ---------------------------------------------------------------------------

    def _is_left_out(self, number):
        if number in self.never:
            return True
        asks = number in self.family.ask_first
        if asks and self._declined:
            return True
        bus, motor = self._left_out
        if self._is_rated_otherwise and _is_in(number, motor):
            return True
        reference = self.family.survey[survey_rows.REFERENCE]
        is_reference = reference is not None and number == reference[0]
        return self._is_other and (_is_in(number, bus) or asks and not is_reference)

    def _set(self, place, is_todo):
        bit = 1 << (place & 7)
        if is_todo:
            self._todo[place >> 3] |= bit
        else:
            self._todo[place >> 3] &= ~bit

    def _is_set(self, place):
        return self._todo[place >> 3] >> (place & 7) & 1


def _is_in(number, ranges):
    for first, last in ranges:
        if first <= number <= last:
            return True
    return False
