# SPDX-License-Identifier: MIT
"""Which family a drive is of. The panel begins anew with it, so no motor may run."""

from panel import texts
from panel.menu import Entries
from uss.families import NAMES


class List(Entries):
    """argument: the `Control`."""

    title = texts.FAMILY

    def first(self):
        return NAMES.index(self.argument.survey.family.__name__)

    def count(self):
        return len(NAMES)

    def words(self, position):
        return NAMES[position].encode()

    def choose(self, position, now_ms):
        panel = self.panel
        if panel.any_runs():
            panel.say(now_ms, texts.STOP_FIRST)
            return
        panel.settings.set_kind(self.argument.drive.address, NAMES[position].lower())
        panel.close_menu()
        panel.wants = "app"
