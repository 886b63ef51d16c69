# SPDX-License-Identifier: MIT
"""What this panel is: version, licence, board."""

from panel import texts
from panel.menu import Entries, words
from version import VERSION


class List(Entries):
    title = words.MENU_ABOUT

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        self._rows = (
            texts.of(words.ABOUT_VERSION, VERSION.encode()),
            texts.of(words.LICENCE),
            panel.board.name.encode(),
        )

    def count(self):
        return len(self._rows)

    def words(self, position):
        return self._rows[position]
