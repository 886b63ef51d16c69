# SPDX-License-Identifier: MIT
"""What goes on on the line: of the bus, of the panel itself, and of each drive.

DIAGNOSIS    5/8
>A4 NO CONTACT          SET: its counters, times, last telegrams, and the mirror test
"""

from panel import texts, wording
from panel.menu import Entries
from panel.menu import words as menu_words
from panel.menu.diagnosis import words

# Text, module.
_LISTS = (
    (words.BUS_COUNTERS, "diagnosis.counters"),
    (words.BUS_TIMES, "diagnosis.times"),
    (words.BUS_OFF, "diagnosis.off"),
    (words.THE_PANEL, "diagnosis.health"),
)
_OF_A_DRIVE = ("diagnosis.counters", "diagnosis.times", "diagnosis.telegrams", "diagnosis.mirror")


class List(Entries):
    """argument: the `Control` of a drive, or None for the first list."""

    title = menu_words.MENU_DIAGNOSIS

    def heading(self, position):
        if self.argument is None:
            return texts.of(self.title)
        return b"A%d" % self.argument.drive.address

    def count(self):
        if self.argument is not None:
            return len(_OF_A_DRIVE)
        return len(_LISTS) + len(self.panel.controls)

    def words(self, position):
        if self.argument is not None:
            return texts.of(words.OF_A_DRIVE[position])
        if position < len(_LISTS):
            return texts.of(_LISTS[position][0])
        control = self.panel.controls[position - len(_LISTS)]
        state = wording.of(wording.text(control), control.survey.family)
        return b"A%-2d %s" % (control.drive.address, state)

    def control_at(self, position):
        if self.argument is not None:
            return self.argument
        place = position - len(_LISTS)
        return self.panel.controls[place] if place >= 0 else None

    def choose(self, position, now_ms):
        if self.argument is not None:
            return _OF_A_DRIVE[position], self.argument
        if position < len(_LISTS):
            return _LISTS[position][1], None
        return "diagnosis.overview", self.panel.controls[position - len(_LISTS)]
