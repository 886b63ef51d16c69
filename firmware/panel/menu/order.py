# SPDX-License-Identifier: MIT
"""The order of the list of drives, which is that of the address keys and of their turns.

SET takes a drive up, UP and DOWN carry it, SET puts it down. PARAM keeps the new order: the panel
begins anew with it, so no motor may run.
"""

from panel import texts
from panel.menu import Entries, words


class List(Entries):
    title = words.MENU_ORDER

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        self._drives = list(panel.settings.drives)
        self._carried = None  # the place of the drive that is taken up

    def count(self):
        return len(self._drives)

    def words(self, position):
        if self._carried is None:
            return b"A%d" % self._drives[position]
        return texts.of(words.CARRIED, self._drives[self._carried])

    def heading(self, position):
        return texts.of(self.title if self._carried is None else words.CARRYING)

    def control_at(self, position):
        return self.control_of(self._drives[position])

    def choose(self, position, now_ms):
        if self.panel.any_runs():
            self.panel.say(now_ms, texts.STOP_FIRST)
        else:
            self._carried = position if self._carried is None else None

    def change(self, position, steps):
        """The menu walks, and the drive goes with it."""
        if self._carried is not None:
            drives, count = self._drives, len(self._drives)
            address = drives.pop(self._carried)
            self._carried = (self._carried + (1 if steps < 0 else -1)) % count
            drives.insert(self._carried, address)
        return False

    def leave(self, now_ms):
        panel, drives = self.panel, tuple(self._drives)
        if drives == panel.settings.drives:
            return
        if panel.any_runs():
            panel.say(now_ms, texts.STOP_FIRST)
        else:
            panel.settings.change("drives", drives)
            panel.begin_anew()
