# SPDX-License-Identifier: MIT
"""The drives of the panel at a glance. SET chooses one.

 9.98 Hz    2/31        row 1: actual frequency; place in the list
>A12 RUNNING            row 2: address and state
"""

from panel import wording
from panel.menu import Entries, words


class List(Entries):
    def count(self):
        return len(self.panel.controls)

    def heading(self, position):
        return words.speed(self.panel.controls[position])

    def words(self, position):
        control = self.panel.controls[position]
        state = wording.of(wording.text(control), control.survey.family)
        return b"A%-2d %s" % (control.drive.address, state)

    def control_at(self, position):
        return self.panel.controls[position]

    def choose(self, position, now_ms):
        return "drive", self.panel.controls[position]
