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
from panel.lookup import value, words
from panel.lookup.answers import FAVOURITES, Answers
from panel.lookup.editing import Editing
from panel.pages import parameter_words
from uss import pkw

_ELSEWHERE = ("START", "REVERSE", "JOG_RIGHT", "JOG_LEFT")  # keys that wait while one types
_TOO_LOW = const(200)  # an error of `parameter_words`


class Inspection(Answers):
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
            if direction and not self._is_coming:
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
        if self.form is None or self._is_moving or not self._is_known:
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
