# SPDX-License-Identifier: MIT
"""One parameter of the drive shown: its name and limits from the catalogue, its value from the
drive, again and again. The drive decides what there is; the catalogue only helps.

NEXT and PREVIOUS go to another parameter of the group, UP and DOWN to another index. EDIT begins
to change the value, see `editing`; SET writes it, see `writing`. SET held while nothing is edited
puts the parameter among the favourites, or takes it away.
"""

from micropython import const

import catalogue
import on_demand
from catalogue import beside
from panel import texts
from panel.lookup import Search, favourites, name_of, text, value, words
from panel.lookup.editing import Editing
from panel.lookup.sight import Sight
from panel.pages import parameter_words
from panel.pages.writing import EEPROM_MS, Writing
from panel.reading import Reading
from uss import pkw
from uss.families.generic import CUTS_OFF, RESCALES
from uss.timing import elapsed

# What a page is to begin with, as `Panel.remembered` has it: numbers and number. In place of the
# numbers of a group FAVOURITES; in place of a number FIRST, or TYPED: the operator says it.
FAVOURITES = None
FIRST, TYPED = const(-1), const(-2)

_WORK_US = const(500)  # then it is enough for a step: a piece takes up to 2.2 ms
_PIECES_MAX = const(6)
_READ_MS = const(500)  # between an answer and the next question
_STALE_MS = const(60_000)  # what nobody goes on typing is dropped
_ELSEWHERE = ("START", "REVERSE", "JOG_RIGHT", "JOG_LEFT")  # keys that wait while one types
_TOO_LOW = const(200)  # an error of `parameter_words`
_RISKS = {b"C": CUTS_OFF, b"R": RESCALES}


class Inspection(Sight):
    def __init__(self, panel):
        Sight.__init__(self, panel)
        self._numbers, number = panel.remembered["panel.lookup.parameter"]
        self._search = Search()  # for the row of a number
        self._names = Search()  # for what a value is called
        self._reading = Reading()
        self._writing = Writing(panel)
        self._read_at_ms = 0
        if number == TYPED:
            self._typed = bytearray(b"P00000")
            number = 0
        if number == FIRST and self._numbers is FAVOURITES:
            number = (self._favourites() or [0])[0]
        self._turn_to(max(number, 0))
        if number == FIRST:
            self._search.begin(beside.following(self.table, self._numbers, number))
            self._is_moving = self._is_coming = True

    def is_typing(self):
        """Whether a number or a value is being typed."""
        return self._typed is not None or self._editing is not None

    def is_coming(self):
        """Whether the first parameter is looked for, and nothing else is to be done."""
        return self._is_coming

    def _turn_to(self, number, row=None, index=None):
        """Another parameter, index or drive: nothing is known of it yet."""
        panel = self.panel
        self._control = control = panel.selected
        family = control.survey.family
        self.table = name_of(family)
        self.number = number
        if index is None:
            index = family.link_index if number in family.linked else 0
        self.index = index
        self.row = row
        self._is_moving = False  # another parameter of the group is looked for
        self._is_coming = False
        self._is_known = row is not None or not self.table
        if self._is_known:
            self._search.begin(None)
        else:
            self._search.begin(catalogue.rows(self.table, b"%d" % number, paced=True))
        self._names.begin(None)
        self._value_name = texts.NOTHING
        self._named_value = None  # what the name is of
        self.form = None
        self.high = self.low = 0
        self._refused = False
        self._due = True
        self._editing = None
        self._held_at_ms = None  # SET went down while nothing was edited
        self._writing.forget()
        self._reading.drop()
        self._first_turn = panel.announcer.page_turns  # its name comes first
        panel.remembered["panel.lookup.parameter"] = self._numbers, number

    # --- keys -----------------------------------------------------------------------------------

    def take_keys(self, acts, now_ms):
        self._used_at_ms = now_ms
        if self.panel.selected is not self._control:
            self._turn_to(self.number)
        set_key = acts.bit("SET")
        if acts.pressed & ~set_key:
            self._writing.let_go()
            self._held_at_ms = None
        if self.is_typing():
            self._type(acts, now_ms)
        elif acts.has("EDIT"):
            self._edit(now_ms)
        elif acts.pressed == set_key and set_key:
            self.panel.say(now_ms, parameter_words.EDIT_FIRST)
            self._held_at_ms = now_ms
        else:
            direction = acts.direction("NEXT", "PREVIOUS")
            if direction and not self._is_moving:
                self._walk(direction)
            direction = acts.direction("UP", "DOWN")
            if direction:
                self._go_to_index(direction, now_ms)

    def _type(self, acts, now_ms):
        """A number or a value is being typed."""
        if acts.has("STOP") or acts.has("PARAM"):
            self._typed = self._editing = None
            acts.forget()  # a PARAM that is held does nothing else
        elif acts.pressed & sum([acts.bit(key) for key in _ELSEWHERE]):
            self.panel.say(now_ms, words.SET_OR_PARAM)
        elif acts.has("SET"):
            if acts.pressed == acts.bit("SET"):  # with another key it is no clear wish
                self._set(now_ms)
        elif self._typed is not None:
            self._place = 1 + (self._place - 1 + acts.direction("NEXT", "PREVIOUS")) % 5
            value.turn(self._typed, self._place, acts.direction("UP", "DOWN"))
        elif acts.has("EDIT"):
            self._editing.next_way()
            if self._editing.way is None:
                self._editing = None
        elif self._editing.take_keys(acts):
            self.panel.say(now_ms, parameter_words.READ_ONLY)

    def _edit(self, now_ms):
        if self.form is None or self._is_moving:
            self.panel.say(now_ms, parameter_words.NOT_READ_YET)
            return
        self._editing = Editing(self)
        if self._editing.way is None:
            self._editing = None
            self.panel.say(now_ms, parameter_words.READ_ONLY)

    def _set(self, now_ms):
        if self._typed is not None:
            number, self._typed = int(bytes(self._typed[1:]).decode()), None
            self._turn_to(number)
            return
        if self.is_reading():
            self.panel.say(now_ms, parameter_words.READ_ONLY)
            return
        family, number = self._control.survey.family, self.number
        try:
            bits = self._editing.bits()
        except ValueError:
            self.panel.say(now_ms, parameter_words.REFUSALS[pkw.BEYOND_LIMITS])
            return
        if number == family.off_time_number and self._trips_with(bits):
            self.panel.say(now_ms, parameter_words.REFUSALS[_TOO_LOW])
            return
        risk = family.ask_first.get(number)
        if risk is None and self.row:
            risk = _RISKS.get(self.row[catalogue.ASKS])
        what = (self._control, number, self.index, bits, self.form.width)
        new = self.form.words(bits >> 16, bits & 0xFFFF)
        values = (self._control.drive.address, number, self.index, new)
        ask = on_demand.load("panel.lookup.ask").ASK if risk is not None else None
        on_demand.drop("panel.lookup.ask")
        self._writing.set(now_ms, what, risk, values, ask)

    def _trips_with(self, bits):
        """Whether with this telegram-off time the drive would trip on this bus."""
        family = self._control.survey.family
        return 0 < bits * family.off_time_unit_ms < self._control.desk.off_time_ms

    def _walk(self, direction):
        """Another parameter of the group."""
        number, numbers = self.number, self._numbers
        if numbers is FAVOURITES:
            chosen = self._favourites()
            if chosen:
                place = chosen.index(number) + direction if number in chosen else 0
                self._turn_to(chosen[place % len(chosen)])
        elif self.table:
            find = beside.following if direction > 0 else beside.preceding
            self._search.begin(find(self.table, numbers, number))
            self._is_moving = True
        else:
            self._turn_to(max(0, number + direction))

    def _go_to_index(self, direction, now_ms):
        count, index = pkw.INDEX_MAX + 1, self.index + direction
        if self.row and b"i" not in self.row[catalogue.UNSURE]:
            count = catalogue.indices(self.row)
        if count == 1 or not self._control.survey.family.has_indices:
            self.panel.say(now_ms, words.NOT_AN_ARRAY)
        else:
            self._turn_to(self.number, self.row, index % count)

    def _favourites(self):
        panel = self.panel
        return favourites.favourites(panel.settings, panel.selected.survey.family)

    # --- what goes on ---------------------------------------------------------------------------

    def step(self, keys, now_ms):
        if self.panel.selected is not self._control:
            self._turn_to(self.number)
        if self.is_typing() and self._is_over(self._used_at_ms, _STALE_MS, now_ms):
            self._typed = self._editing = None
        contact = self._control.drive.contact and self._control.drive.layout.pkw_words
        set_is_down = keys.down & keys.bit("SET")
        write = self._writing.step(set_is_down if contact else 0, now_ms)
        if write:
            self._due = True
            if write.done:
                self._editing = None
        if not set_is_down:
            self._held_at_ms = None
        elif self._is_over(self._held_at_ms, EEPROM_MS, now_ms):
            self._held_at_ms = None
            family = self._control.survey.family
            self.panel.say(now_ms, favourites.turn(self.panel.settings, family, self.number))
        if not contact:
            self.form = None
            self._editing = None
            self._due = True
        elif self.is_searching() and not (self._reading.asked or self._due):
            return  # that is enough for a step
        elif self._reading.asked:
            self._take_answer(now_ms)
        else:
            self._ask(now_ms)

    def _is_over(self, since_ms, wait_ms, now_ms):
        return since_ms is not None and elapsed(now_ms, since_ms, self.panel.mask) >= wait_ms

    def is_searching(self):
        """Whether something is looked for in the catalogue."""
        rows = self._editing.search.rows if self._editing is not None else None
        return not (rows is self._search.rows is self._names.rows is None)

    def look_on(self):
        """As many pieces of it as fit a step of the loop."""
        ticks_us = self.panel.board.clock.ticks_us
        began_us = ticks_us()
        for _ in range(_PIECES_MAX):
            if self._look_on() or not self.is_searching():
                return
            if elapsed(ticks_us(), began_us, self.panel.mask) >= _WORK_US:
                return

    def _look_on(self):
        """One piece. Answers whether it has brought a row."""
        row = None
        if self._search.rows is not None:
            row = self._search.step()
            if row and self._is_moving:
                self._turn_to(catalogue.number(row), row)
            elif row:
                self.row = row
                self.form = None  # it is read anew, with what is known now
                self._due = True
            elif self._search.rows is None:
                self._is_moving = self._is_coming = False
                self._is_known = True
        elif self._editing is not None:
            self._editing.step()
        elif self._names.rows is not None:
            row = self._names.step()
            if row and catalogue.number(row, 1) == self._named_value:
                self._value_name = text(row)
        return row is not None

    def _ask(self, now_ms):
        if self._due or self._is_over(self._read_at_ms, _READ_MS, now_ms):
            index = self.index
            is_element = index and self._control.survey.family.has_array_tasks
            task = pkw.READ_ELEMENT if is_element else pkw.READ
            if self._reading.ask(self._control.drive, self.number, index, task):
                self._due = False

    def _take_answer(self, now_ms):
        job = self._reading.take()
        if job is None:
            return
        self._read_at_ms = now_ms
        refused = job.state in (pkw.REFUSED, pkw.UNANSWERED)
        if refused and not self._refused:
            self.panel.say(now_ms, *parameter_words.failure(job))
        self._refused = refused
        if job.state != pkw.DONE:
            self.form = None
            return
        self.high, self.low = job.high, job.low
        if self.form is None or self.form.width != job.width:
            integers = self._control.survey.family.integer_doubles
            is_integer = job.width == pkw.WORD or integers and self.number in integers
            self.form = value.Form(self.row, job.width, is_integer)
        self._name_value()

    def _name_value(self):
        """Look for what the value is called."""
        form = self.form
        if form.list[:1] != b"v":
            return
        number = form.number(self.high, self.low)
        if number != self._named_value:
            self._named_value = number
            self._value_name = texts.NOTHING
            if number >= 0:
                numbers = b"%s.%d" % (form.list[1:], number)
                self._names.begin(catalogue.rows(self.table, numbers, "V", paced=True))
