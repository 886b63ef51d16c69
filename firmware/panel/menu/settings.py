# SPDX-License-Identifier: MIT
"""The settings, each with its value; SET opens one."""

from panel import texts
from panel.menu import Entries, words

LISTS = (  # text, module, argument: what is more than a value
    (words.LOCK_CODE, "code", True),
    (words.ACCEPTED, "accepted", None),
    (words.KEY_TEST, "keys", None),
)

NEEDED = {"light_minutes": "backlight", "log": "serial"}  # of the board


class List(Entries):
    title = words.MENU_SETTINGS

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        board = panel.board
        self._rows = [
            row for row in words.SETTINGS if getattr(board, NEEDED.get(row[0], "name"), None)
        ]

    def count(self):
        return len(self._rows) + len(LISTS)

    def words(self, position):
        if position >= len(self._rows):
            return texts.of(LISTS[position - len(self._rows)][0])
        row = self._rows[position]
        return words.reading(row, getattr(self.panel.settings, row[0]))

    def choose(self, position, now_ms):
        if position >= len(self._rows):
            return LISTS[position - len(self._rows)][1:]
        return "value", self._rows[position]
