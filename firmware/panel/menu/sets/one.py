# SPDX-License-Identifier: MIT
"""What can be done with one parameter set: compare it with the drive that is shown, write it into
that drive, delete it.
"""

from panel import texts
from panel.menu import Entries
from panel.menu.sets import words

TITLE_MAX = 10


class List(Entries):
    """argument: the name of its file, and that of the set."""

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        self._control = control = panel.selected
        self._file, name = argument
        self.title = name[:TITLE_MAX]
        self._entries = [(words.COMPARE, None)]  # and whether the EEPROM is written
        if control.survey.family.has_eeprom_tasks:
            self._entries += [(words.INTO_RAM, False), (words.INTO_EEPROM, True)]
        else:
            self._entries.append((words.INTO, False))

    def count(self):
        return len(self._entries) + 1

    def words(self, position):
        if position == len(self._entries):
            return texts.of(words.DELETE)
        return texts.of(self._entries[position][0], self._control.drive.address)

    def choose(self, position, now_ms):
        if self.panel.any_runs():
            self.panel.say(now_ms, texts.STOP_FIRST)
            return None
        if position == len(self._entries):
            return "sets.ask", (words.ASK_DELETE, (), self._delete)
        return "sets.write", (self._control, self._file, self._entries[position][1])

    def _delete(self, now_ms):
        self.panel.errand = self._remove

    def _remove(self):
        panel = self.panel
        try:
            panel.board.store.remove(self._file)
        except OSError:
            pass  # it has gone already
        panel.remembered["panel.menu.sets.overview"] = self._file
