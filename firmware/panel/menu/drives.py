# SPDX-License-Identifier: MIT
"""The drives of the panel at a glance: address, state, actual frequency. SET chooses one."""

from panel import texts, wording
from panel.menu import Entries


class List(Entries):
    title = texts.MENU_DRIVES

    def count(self):
        return len(self.panel.controls)

    def words(self, position):
        control = self.panel.controls[position]
        state = wording.of(wording.text(control), control.survey.family)
        return b"A%-2d %s" % (control.drive.address, state)

    def choose(self, position, now_ms):
        return "drive", self.panel.controls[position]
