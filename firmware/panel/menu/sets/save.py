# SPDX-License-Identifier: MIT
"""A new parameter set: its name, letter by letter, then it is saved.

NAME, SET=SAVE          UP and DOWN change a letter, NEXT and PREVIOUS choose it, SET saves
>PUM[P] 1

A1 SAVE  41%            how far it is, and the minutes and seconds that it still takes. PARAM gives
>0:21 LEFT              it up
"""

import on_demand
from panel import texts
from panel.menu import BACK, Entries
from panel.menu.sets import words

LETTERS = b" ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-"
NAME_MAX = 10


class List(Entries):
    """argument: the `Control` of its drive."""

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        self._name = bytearray(b"SE" + b"T 1     ")
        self._at = 0
        self._work = None

    def heading(self, position):
        work = self._work
        if work is None:
            return texts.of(words.NAME)
        return texts.of(words.SAVING, self.argument.drive.address, work.percent())

    def words(self, position):
        work = self._work
        if work is None:
            at, name = self._at, bytes(self._name)
            return b"%s[%s]%s" % (name[:at], name[at : at + 1], name[at + 1 :].rstrip())
        if work.outcome:
            return texts.of(*work.outcome)
        left_s = work.left_s
        return b"..." if left_s is None else texts.of(words.LEFT, left_s // 60, left_s % 60)

    def step(self, position, now_ms):
        work = self._work
        if work is not None and work.outcome is None:
            work.step(now_ms)

    def is_busy(self):
        return self._work is not None and self._work.outcome is None

    def is_searching(self):
        return self.is_busy()

    def search(self):
        self._work.search()

    def take_keys(self, acts):
        if self._work is not None:
            return BACK if acts.has("SET") and self._work.outcome else None
        turned = acts.direction("NEXT", "PREVIOUS")
        self._at = (self._at + turned) % NAME_MAX
        return turned != 0

    def change(self, position, steps):
        if self._work is None:
            name, at = self._name, self._at
            place = LETTERS.find(name[at : at + 1]) + (1 if steps > 0 else -1)
            name[at] = LETTERS[place % len(LETTERS)]
        return True

    def choose(self, position, now_ms):
        if self._work is not None:
            return
        saving = on_demand.load("panel.sets.saving")
        name = bytes(self._name).rstrip()
        refusal = saving.why_not(self.panel, self.argument)
        if refusal or not name:
            self.panel.say(now_ms, refusal or words.NAME)
        else:
            self._work = saving.Save(self.panel, self.argument, name)

    def leave(self, now_ms):
        if self.is_busy():
            self._work.end(words.NOTHING_WRITTEN)

    def end(self):
        self.panel.remembered["panel.menu.sets.overview"] = object()  # it is to look anew
