# SPDX-License-Identifier: MIT
"""The procedures of commissioning that the family of the drive shown has in the catalogue."""

import catalogue
from panel import texts
from panel.lookup import Search, name_of
from panel.menu import Entries
from panel.commission import words
from panel.menu.words import COMMISSION


class List(Entries):
    title = COMMISSION

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        self._control = panel.selected
        self._procedures = []  # numbers, from 1 on
        self._search = Search()
        table = name_of(panel.selected.survey.family)
        if table:
            self._search.begin(catalogue.rows(table, catalogue.ALL, "S", paced=True))

    def is_searching(self):
        return self._search.rows is not None

    def search(self):
        row = self._search.step()
        if row:
            procedure = catalogue.number(row) // 100
            if procedure not in self._procedures:
                self._procedures.append(procedure)

    def count(self):
        return len(self._procedures) or 1

    def words(self, position):
        if self._procedures:
            return texts.of(words.PROCEDURES[self._procedures[position] - 1])
        return b"..." if self.is_searching() else texts.of(words.NO_STEPS)

    def control_at(self, position):
        return self._control

    def choose(self, position, now_ms):
        if not self._procedures:
            return None
        return "commission.course", (self._control, self._procedures[position])
