# SPDX-License-Identifier: MIT
"""What this panel is: version, licence, board, memory."""

import on_demand
from panel import texts
from panel.menu import Entries, words
from version import VERSION


class List(Entries):
    title = words.MENU_ABOUT

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        self._rows = [
            texts.of(words.ABOUT_VERSION, VERSION.encode()),
            texts.of(words.LICENCE),
            panel.board.name.encode(),
        ]
        self._counted = False

    def step(self, position, now_us):
        """To count what is free takes as long as a collection does: once, in a step of its own."""
        if self._counted:
            return
        self._counted = True
        free = on_demand.free_bytes()
        if free is not None:
            self._rows.append(texts.of(words.FREE_MEMORY, free // 1024))

    def count(self):
        return len(self._rows)

    def words(self, position):
        return self._rows[position]
