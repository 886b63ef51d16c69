# SPDX-License-Identifier: MIT
"""Parameter sets: those that the panel's flash keeps, and a new one of the drive that is shown.

SETS         1/3        SET saves the parameters of the drive shown as a new set
>SAVE A1

SETS         2/3        the others: address of the drive that it was made of, and its name
>A1 PUMP 1
"""

from panel import texts
from panel.menu import Entries
from panel.menu.sets import words
from panel.sets import set_file

UNREAD = b"..."


class List(Entries):
    title = words.SETS

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        self._control = panel.selected
        self._seen = None
        self.step(0, 0)

    def step(self, position, now_ms):
        """Look what there is."""
        marked = self._control.is_half_written()
        seen = (marked, self.panel.remembered.get(__name__))
        if seen != self._seen:  # a set more, or less, or what was half written is not any more
            self._seen = seen
            self._marked = marked
            try:
                self._names = self.panel.board.store.names(set_file.ENDING)
            except OSError:
                self._names = []
            self._heads = [None] * len(self._names)

    def is_searching(self):
        return None in self._heads

    def search(self):
        """Read one head."""
        place = self._heads.index(None)
        self._heads[place] = self._head(self._names[place])

    def count(self):
        return 1 + self._marked + len(self._names)

    def words(self, position):
        address = self._control.drive.address
        place = position - 1 - self._marked
        if place >= 0:
            return self._heads[place] or UNREAD
        if position or not self._marked:
            return texts.of(words.SAVE, address)
        return texts.of(words.GIVE_UP, address)

    def choose(self, position, now_ms):
        place = position - 1 - self._marked
        if place >= 0:
            row = self._heads[place] or UNREAD
            return "sets.one", (self._names[place], row.split(b" ", 1)[-1])
        if position or not self._marked:
            return self._save(now_ms)
        values = (self._control.drive.address,)
        return "sets.ask", (words.ASK_GIVE_UP, values, self._give_up)

    def _save(self, now_ms):
        panel = self.panel
        if panel.any_runs():
            panel.say(now_ms, texts.STOP_FIRST)
            return None
        return "sets.save", self._control

    def _give_up(self, now_ms):
        self.panel.settings.note_set(self._control.drive.address)

    def _head(self, name):
        """In words."""
        try:
            head = set_file.read_head(self.panel.board.store, name)
            return b"A%d %s" % (head.address, head.name)
        except (OSError, ValueError):
            return texts.of(words.NO_SET_FILE, name.encode())[: texts.ROW_WIDTH - 1]
