# SPDX-License-Identifier: MIT
"""A parameter set is compared with a drive, or written into it.

A2 COMPARE  41%         how far it is; the minutes and seconds that it still takes, and how many
>0:21 3 DIFF            values differ by now. PARAM ends it

3 DIFFER    1/4         a question, SET is yes. The other entries are what differs
>SET=WRITE A2

P1120[0]    2/4         what the drive has, and what the set says
>10>2.5
"""

import on_demand
from panel import texts
from panel.menu import BACK, Entries
from panel.menu.sets import words
from uss import pkw


class List(Entries):
    """argument: the `Control` of the drive, the name of the file, and whether it is written into
    the EEPROM; None: it is only compared."""

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        control, name, eeprom = argument
        self._control = control
        self._writing = on_demand.load("panel.sets.writing")
        self._work = self._writing.Write(panel, control, name, eeprom)

    def control_at(self, position):
        return self._control

    def _listed(self):
        work = self._work
        if work.asks and work.phase == self._writing.ASKS_CUT:
            return work.cutters
        return work.listed if work.asks or work.outcome else ()

    def count(self):
        return 1 + len(self._listed())

    def heading(self, position):
        work, writing, address = self._work, self._writing, self._control.drive.address
        if position:
            number, index = self._listed()[position - 1][:2]
            return b"P%04d[%d]" % (number, index)
        if work.outcome:
            return b"A%d" % address
        if work.asks:
            is_cut = work.phase == writing.ASKS_CUT
            return texts.of(
                *(words.MAY_CUT, work.cutting) if is_cut else (words.SO_MANY, work.differs)
            )
        if work.phase == writing.CHECKS:
            return texts.of(words.CHECKING, address)
        text = words.WRITING if work.phase == writing.WRITES else words.COMPARING
        return texts.of(text, address, work.percent())

    def words(self, position):
        work = self._work
        if position:
            _, _, kind, high, low, now_high, now_low = self._listed()[position - 1]
            now = words.ABSENT if now_low is None else value(kind, now_high, now_low)
            return texts.of(words.DIFFERENCE, now, value(kind, high, low))[: texts.ROW_WIDTH - 1]
        if work.outcome:
            return texts.of(*work.outcome)
        if work.asks:
            question = self._question()
            return question[self.panel.announcer.page_turns % len(question)]
        if work.left_s is None:
            return b"..."
        left = work.left_s // 60, work.left_s % 60
        if work.differs:
            return texts.of(words.LEFT_DIFFER, *left + (work.differs,))
        return texts.of(words.LEFT, *left)

    def _question(self):
        """What row 2 says in turn."""
        work = self._work
        if work.phase == self._writing.ASKS_CUT:
            return texts.filled(words.ASK_CUT)
        stakes = (words.ASK_WRITE,)
        values = (self._control.drive.address,)
        if work.opens:
            stakes = (words.OPENS, words.ASK_WRITE)
            values = work.family.access + values
        return texts.filled(stakes, *values)

    def step(self, position, now_ms):
        self._work.step(now_ms)

    def is_busy(self):
        return self._work.outcome is None and not self._work.asks

    def is_searching(self):
        return self.is_busy()

    def search(self):
        self._work.search()

    def take_keys(self, acts):
        work = self._work
        if work.asks and work.phase == self._writing.ASKS_CUT and acts.has("PARAM"):
            work.answer = False  # all else stays written
            return True
        return BACK if work.outcome and acts.has("SET") else None

    def choose(self, position, now_ms):
        if self._work.asks and not position:
            self._work.answer = True

    def leave(self, now_ms):
        if self._work.outcome is None:
            is_half = self._control.is_half_written()
            address = self._control.drive.address
            told = (words.HALF_WRITTEN, address) if is_half else (words.NOTHING_WRITTEN,)
            self._work.end(*told)
            self.panel.say(now_ms, *told)


def value(kind, high, low):
    """A value as people read it."""
    if kind == b"Float":
        return b"%s" % ("%.5g" % pkw.words_to_float(high, low)).encode()
    if kind[:1] == b"B":  # a connector
        return b"%d:%d" % (high, low)
    number = high << 16 | low
    limit = 1 << (15 if kind == b"I16" else 31)
    return b"%d" % (number - 2 * limit if kind[:1] == b"I" and number >= limit else number)
