# SPDX-License-Identifier: MIT
"""What can be done with one drive of the list, which `drives` hands on."""

from panel import texts
from panel.menu import Entries, words


class List(Entries):
    """argument: its `Control`."""

    @property
    def title(self):
        return b"A%d" % self.argument.drive.address

    def count(self):
        return 4

    def words(self, position):
        control = self.argument
        family = control.survey.family
        layout = control.drive.layout
        return (
            texts.of(texts.SHOW_DRIVE),
            texts.of(texts.REMOVE_DRIVE),
            b"%s %d+%d" % (family.__name__.encode(), layout.pkw_words, layout.pzd_words),
            words.speed(control),
        )[position]

    def choose(self, position, now_ms):
        panel = self.panel
        if position == 2:
            return "families", self.argument
        if position > 1 or self.argument not in panel.controls:
            return None
        panel.show(self.argument)
        panel.close_menu()
        if position == 1:
            try:
                panel.remove()
                panel.say(now_ms, texts.REMOVED)
            except ValueError:  # the only one, or it may be running
                panel.say(now_ms, texts.NOT_REMOVED)
        return None
