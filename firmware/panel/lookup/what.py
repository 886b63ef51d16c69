# SPDX-License-Identifier: MIT
"""What a fault or a warning means, what causes it, and what to do, line by line.

A0501        1/9    CAUSE        2/9    REMEDY       6/9
>Current limit      >The motor takes    >Check motor
"""

import catalogue
from panel import texts
from panel.lookup import Search, broken, name_of, text, words
from panel.menu import Entries

_WIDTH = 15  # of an entry


class List(Entries):
    """argument: ("F" or "A", number, what it is called, such as b"F0072")."""

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        kind, number, self._name = argument
        self._lines = []  # (heading, line)
        self._breaking = None  # makes them, one in a step
        self._search = Search()
        table = name_of(panel.selected.survey.family)
        if table:
            rows = catalogue.rows(table, b"%d" % number, kind, paced=True)
            self._search.begin(rows)

    def step(self, position, now_ms):
        if self._breaking is not None:
            self._lines += next(self._breaking, ())

    def is_searching(self):
        return self._search.rows is not None

    def search(self):
        row = self._search.step()
        if row:
            self._search.begin(None)
            self._breaking = self._broken(row)

    def count(self):
        return len(self._lines) or 1

    def heading(self, position):
        return self._lines[position][0] if self._lines else self._name

    def words(self, position):
        if self._lines:
            return self._lines[position][1]
        return b"..." if self._search.rows is not None else texts.of(words.NO_TEXT)

    def _broken(self, row):
        """Name, cause and remedy in lists of a line, between words as far as they fit."""
        for heading, column in (
            (self._name, catalogue.NAME),
            (texts.of(words.CAUSE), catalogue.CAUSE),
            (texts.of(words.REMEDY), catalogue.REMEDY),
        ):
            for line in broken(text(row, column), _WIDTH):
                yield ((heading, line),)
