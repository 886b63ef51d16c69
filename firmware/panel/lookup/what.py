# SPDX-License-Identifier: MIT
"""What a fault or a warning means, what causes it, and what to do, line by line.

A0501        1/9    CAUSE        2/9    REMEDY       6/9
>Current limit      >The motor takes    >Check motor
"""

import catalogue
from panel import texts
from panel.lookup import Search, name_of, text, words
from panel.menu import Entries

_WIDTH = 15  # of an entry


class List(Entries):
    """argument: ("F" or "A", number, what it is called, such as b"F0072")."""

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        kind, number, self._name = argument
        self._lines = []  # (heading, line)
        self._search = Search()
        table = name_of(panel.selected.survey.family)
        if table:
            rows = catalogue.rows(table, b"%d" % number, kind, paced=True)
            self._search.begin(rows)

    def step(self, position, now_ms):
        if self._search.rows is None:
            return
        row = self._search.step()
        if row:
            self._search.begin(None)
            self._put(self._name, text(row))
            self._put(texts.of(words.CAUSE), text(row, catalogue.CAUSE))
            self._put(texts.of(words.REMEDY), text(row, catalogue.REMEDY))

    def count(self):
        return len(self._lines) or 1

    def heading(self, position):
        return self._lines[position][0] if self._lines else self._name

    def words(self, position):
        if self._lines:
            return self._lines[position][1]
        return b"..." if self._search.rows is not None else texts.of(words.NO_TEXT)

    def _put(self, heading, words_of_it):
        """Break a text into lines, between words as far as they fit."""
        line = b""
        for word in words_of_it.replace(catalogue.LINE, b" ").split():
            if line and len(line) + 1 + len(word) > _WIDTH:
                self._lines.append((heading, line))
                line = b""
            line += b" " + word if line else word
            while len(line) > _WIDTH:
                self._lines.append((heading, line[:_WIDTH]))
                line = line[_WIDTH:]
        if line:
            self._lines.append((heading, line))
