# SPDX-License-Identifier: MIT
"""What the page of a parameter asks: its row from the catalogue, its value from the drive, again
and again, and what that value is called. See `inspection`, which takes the keys.
"""

from micropython import const

import catalogue
from catalogue import beside
from panel import texts
from panel.lookup import Search, favourites, name_of, text, value
from panel.lookup.sight import Sight
from panel.pages import parameter_words
from panel.pages.writing import EEPROM_MS, Writing
from panel.reading import Reading
from uss import pkw
from uss.timing import elapsed

# What a page is to begin with, as `Panel.remembered` has it: numbers and number. In place of the
# numbers of a group FAVOURITES; in place of a number FIRST, or TYPED: the operator says it.
FAVOURITES = None
FIRST, TYPED = const(-1), const(-2)

_WORK_US = const(900)  # then a step has no time for a piece, which takes up to 1.2 ms, and
_ALONE_US = const(2_000)  # likewise where no interrupt comes
_QUIET_US = const(4_000)  # for so long no reply can be over: then none comes
_PIECES_MAX = const(6)
_READ_MS = const(500)  # between an answer and the next question
_STALE_MS = const(60_000)  # what nobody goes on typing is dropped


class Answers(Sight):
    def __init__(self, panel):
        Sight.__init__(self, panel)
        self._numbers, number = panel.remembered["panel.lookup.parameter"]
        self._search = Search()  # for the row of a number
        self._names = Search()  # for what a value is called
        self._reading = Reading()
        self._writing = Writing(panel)
        self._read_at_ms = 0
        self._first = number  # which it is to begin with; None: it has begun
        self._found = None
        self._is_coming = True

    def has_begun(self):
        return self._first is None

    def _begin(self):
        number, self._first = self._first, None
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
        self._found = None  # its row
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
        is_idle = rows is self._search.rows is self._names.rows is None
        return not is_idle or self._found is not None or self._first is not None

    def look_on(self):
        """As many pieces of it as fit a step of the loop."""
        panel = self.panel
        work_us = _ALONE_US if panel.is_undisturbed(_QUIET_US) else _WORK_US
        for _ in range(_PIECES_MAX):
            if self._look_on() or not self.is_searching():
                return
            if panel.has_taken(work_us):
                return

    def _look_on(self):
        """One piece. Answers whether it has brought a row."""
        row = None
        if self._first is not None:
            self._begin()
            return True
        if self._found is not None:
            self._turn_to(catalogue.number(self._found), self._found)
            return True
        if self._search.rows is not None:
            row = self._search.step()
            if row and self._is_moving:
                self._found = row
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
            if self._editing is None:  # else what is typed still has a form
                self.form = None
            return
        self.high, self.low = job.high, job.low
        if self.form is None or self.form.width != job.width:
            self.form = value.Form(self.row, job.width)
            self._editing = None  # digits of another form would mean something else
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

    def _favourites(self):
        panel = self.panel
        return favourites.favourites(panel.settings, panel.selected.survey.family)
