# SPDX-License-Identifier: MIT
"""The steps of one procedure, as the catalogue has them: what the drive has, and what it needs.

P0304*      7/23        the parameter of a step, with a star once the step is done
>Motor voltage          in turn its name, what the drive has, and what to know about it

The last entry says how many are left. UP and DOWN walk; what SET does:

    phase     row 2                 SET                                     PARAM
    LOOKS     name, value, note     a value that a person tells: TYPES      leaves the list
                                    one that is told here: ASKS
    TYPES     NEW 0400V             what means another speed: ASKS          LOOKS
                                    anything else: writes it
    ASKS      5? SET=YES            writes it                               LOOKS
    WRITES    WRITING ...           nothing                                 leaves the list

Nothing is written while the motor runs. It goes into the RAM of a drive that has both; the last
step of each procedure stores it. What is left out stays left: who comes back sees it.
"""

import catalogue
from micropython import const

from panel import texts
from panel.lookup import Search, broken, name_of, text, value
from panel.menu import Entries
from panel.commission import words
from panel.commission.step import Step
from panel.pages import parameter_words
from panel.reading import Reading
from uss import pkw

LOOKS, TYPES, ASKS, WRITES = range(4)

_TOLD = "panel.commission.course"  # in `Panel.remembered`: keys of steps, by argument
_MISSING = b"..."
_WIDTH = const(15)  # of an entry


class List(Entries):
    """argument: the `Control` of the drive, and the number of the procedure."""

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        self._control, procedure = argument
        self._table = name_of(self._control.survey.family)
        self._told = panel.remembered.setdefault(_TOLD, {}).setdefault(argument, [])
        self._steps = []
        self._search = Search()  # for all steps, then for the rows of the one that is shown
        self._first_turn = 0  # of the page, since the name of the step is known
        self._look(None)
        numbers = b"%d00-%d99" % (procedure, procedure)
        self._search.begin(catalogue.rows(self._table, numbers, "S", paced=True))
        self._is_complete = False  # all steps are known
        self._reading = Reading()
        self._asked = None  # the step that the drive was asked about
        self._unread = []  # steps that a reading tells about, and none has yet
        self._shown = None  # the step that is shown
        self._write = None  # a `Write` that is on its way

    def _look(self, step):
        """Show a step, of which nothing is known yet."""
        self._shown = step
        self._phase = LOOKS
        self._lines = []  # its name, and what to know about it
        self._note = None  # makes the lines of that, one in a step
        self._row = None  # of its parameter
        self._form = None  # None: its value was not read
        self._failure = None  # why it cannot be
        self._has = 0  # the bits of its value
        self._typed = self._at = None
        self._bits = 0  # that are to be written
        if step is None:
            self._search.begin(None)
        else:
            self._search_for("S", step.key)

    def _search_for(self, kind, number):
        self._search.begin(catalogue.rows(self._table, b"%d" % number, kind, paced=True))

    # --- what is shown --------------------------------------------------------------------------

    def count(self):
        return len(self._steps) + 1 if self._is_complete else 1

    def control_at(self, position):
        return self._control

    def heading(self, position):
        if not self._is_complete or position == len(self._steps):
            return b"A%d" % self._control.drive.address
        step = self._steps[position]
        return b"P%04d%s" % (step.number, b"*" if step.is_done else b"")

    def words(self, position):
        turn = self.panel.announcer.page_turns
        if not self._is_complete:
            return _MISSING
        if position == len(self._steps):
            return self._what_is_left(turn)
        if self._steps[position] is not self._shown:
            return _MISSING
        if self._phase == TYPES:
            typed, at = bytes(self._typed), self._at
            return b"%s[%s]%s" % (typed[:at], typed[at : at + 1], typed[at + 1 :])
        if self._phase == ASKS:
            return self._question(turn)
        if self._phase == WRITES:
            return texts.of(words.WRITES)
        lines = self._lines[:1] + [self._value()] + self._lines[1:]
        return lines[(turn - self._first_turn) % len(lines)]

    def _what_is_left(self, turn):
        left = self._left()
        if not left:
            return texts.of(words.ALL_DONE)
        if turn & 1:
            return texts.of(words.LEFT_FIRST, left[0].number)
        return texts.of(words.LEFT, len(left))

    def _value(self):
        """What the drive has, and what it needs, where that is another value."""
        step, form = self._shown, self._form
        if form is None:
            return texts.of(*self._failure) if self._failure else _MISSING
        has = form.fitting(self._has >> 16, self._has & 0xFFFF, _WIDTH - 6)
        if step.is_typed or step.is_done:
            return texts.of(words.IS, has)
        bits = step.needed(form, self._has)
        return texts.of(words.NEEDS, has, form.words(bits >> 16, bits & 0xFFFF))

    def _question(self, turn):
        form, bits = self._form, self._bits
        if self._shown.rescales(bits, self._has) and turn & 1:
            return texts.of(words.RESCALES)
        return texts.of(words.ASK, form.fitting(bits >> 16, bits & 0xFFFF, _WIDTH - 8))

    def _left(self):
        return [step for step in self._steps if not step.is_done]

    # --- keys -----------------------------------------------------------------------------------

    def take_keys(self, acts):
        if self._phase == LOOKS or self._phase == WRITES:
            return None
        if acts.has("PARAM") or acts.has("STOP"):
            self._phase = LOOKS
        elif acts.has("SET"):
            return None
        elif self._phase == TYPES:
            place, direction = acts.direction("NEXT", "PREVIOUS"), acts.direction("UP", "DOWN")
            if place:
                self._at = value.move(self._typed, self._at, place)
            if direction:
                base = 16 if self._form.kind == value.HEX else 10
                value.turn(self._typed, self._at, direction, base)
        return True

    def choose(self, position, now_ms):
        step, form = self._shown, self._form
        if step is None or form is None or self._phase == WRITES:
            return
        if self._control.is_active():
            self.panel.say(now_ms, words.STOP_IT, self._control.drive.address)
        elif self._phase == LOOKS and step.is_typed:
            self._typed, self._at = form.typed(self._has >> 16, self._has & 0xFFFF)
            self._phase = TYPES
        elif self._phase == LOOKS and step.is_done and not step.is_told:
            self.panel.say(now_ms, words.IS_RIGHT)
        elif self._phase == LOOKS:
            self._bits = step.needed(form, self._has)
            self._phase = ASKS
        elif self._phase == TYPES:
            try:
                self._bits = form.bits(self._typed)
            except ValueError:
                self.panel.say(now_ms, parameter_words.REFUSALS[pkw.BEYOND_LIMITS])
                return
            if step.rescales(self._bits, self._has):
                self._phase = ASKS
            else:
                self._begin_write(now_ms)
        else:
            self._begin_write(now_ms)

    def _begin_write(self, now_ms):
        step, family = self._shown, self._control.survey.family
        eeprom = family.has_eeprom_tasks and step.number in family.permanent
        width = self._form.width
        what = self._control, step.number, step.index, self._bits, eeprom, width
        self._write = self.panel.write(now_ms, *what)
        self._phase = WRITES if self._write else LOOKS

    # --- what goes on ---------------------------------------------------------------------------

    def is_busy(self):
        return self._write is not None

    def is_searching(self):
        return self._search.rows is not None or self._note is not None

    def search(self):
        if self._note is not None:
            self._break_on()
            return
        row = self._search.step()
        if not self._is_complete:
            if row:
                is_done = catalogue.number(row) in self._told
                self._steps.append(Step(row, self._control, is_done))
            elif self._search.rows is None:
                self._is_complete = True
                self._read_all()
        elif row and not self._lines:
            self._lines = [text(row)[:_WIDTH]]
            self._first_turn = self.panel.announcer.page_turns  # it comes first
            self._note = broken(text(row, catalogue.STEP_NOTE), _WIDTH)
        elif row:
            self._row = row

    def _break_on(self):
        """The next line of what there is to know about the step; after it comes its parameter."""
        line = next(self._note, None)
        if line is None:
            self._note = None
            self._search_for("P", self._shown.number)
        else:
            self._lines.append(line)

    def step(self, position, now_ms):
        if not self._is_complete:
            return
        step = self._steps[position] if position < len(self._steps) else None
        if step is not self._shown:
            self._look(step)
        elif self._write is not None:
            self._follow_write()
        elif self._asked is not None:
            self._take_answer()
        elif self._phase == LOOKS and not self.is_searching():
            self._ask()

    def _follow_write(self):
        write = self._write
        if write.outcome is None:
            return
        self._write, self._phase, self._form = None, LOOKS, None
        step = self._shown
        if write.done and step is not None and step.is_told:
            step.is_done = True
            self._told.append(step.key)
        self._read_all()

    def _read_all(self):
        """Ask about each step again: to write one parameter may change others."""
        self._unread = [step for step in self._steps if not step.is_told]

    def _ask(self):
        """About the step that is shown, as long as its value is not there; else about others."""
        step = self._shown
        if step is None or self._form is not None or self._failure:
            step = self._unread[0] if self._unread else None
        if step is not None and step.ask(self._reading):
            self._asked = step

    def _take_answer(self):
        job = self._reading.take()
        if job is None:
            return
        step, self._asked = self._asked, None
        if step in self._unread:
            self._unread.remove(step)
        if not step.is_told:
            step.is_done = job.state == pkw.DONE and step.is_right(job)
        if step is not self._shown:
            return
        self._failure = None if job.state == pkw.DONE else parameter_words.failure(job)
        if self._failure is None:
            self._has = job.integer_value()
            self._form = step.form(self._row, job)

    def leave(self, now_ms):
        if not self._is_complete:
            return
        address, left = self._control.drive.address, len(self._left())
        text = (words.LEAVES_LEFT, address, left) if left else (words.LEAVES_DONE, address)
        self.panel.say(now_ms, *text)
