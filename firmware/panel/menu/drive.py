# SPDX-License-Identifier: MIT
"""What can be done with one drive of the list, which `drives` hands on."""

from micropython import const

from panel import texts
from panel.menu import Entries, words

_KIND = const(2)  # the first entry of what it is


class List(Entries):
    """argument: its `Control`."""

    @property
    def title(self):
        return b"A%d" % self.argument.drive.address

    def count(self):
        return _KIND + len(words.KIND) + 1

    def words(self, position):
        if position < _KIND:
            return texts.of((words.SHOW_DRIVE, words.REMOVE_DRIVE)[position])
        row = position - _KIND
        if row == len(words.KIND):
            return words.speed(self.argument)
        return words.of_kind(row, kind_of(self.argument)[row])

    def control_at(self, position):
        return self.argument

    def choose(self, position, now_ms):
        panel = self.panel
        if _KIND <= position < _KIND + len(words.KIND):
            return "kind", (self.argument, position - _KIND)
        if position >= _KIND or self.argument not in panel.controls:
            return None
        shown, address = panel.selected, self.argument.drive.address
        panel.show(self.argument)
        panel.close_menu()
        if position == 1:
            try:
                panel.remove()
                if shown is not self.argument:  # STOP is for the drive that it was for
                    panel.show(shown)
                panel.say(now_ms, words.REMOVED, address)
            except ValueError:  # the only one, or it may be running
                panel.say(now_ms, words.NOT_REMOVED, address)
        return None


def kind_of(control):
    """What it is now, by row of words.KIND."""
    family, layout = control.survey.family, control.drive.layout
    base = family.com or family
    link = words.LINKS[1 if family.com else 0]
    return base.__name__, layout.pkw_words, layout.pzd_words, link
