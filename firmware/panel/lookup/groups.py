# SPDX-License-Identifier: MIT
"""Parameters of the drive shown: by number, the favourites, all, and the groups of the catalogue.

SET goes to the page of the first one: `parameter`.
"""

import catalogue
import on_demand
from panel import texts
from panel.lookup import Search, name_of, text, words
from panel.menu import PAGE, Entries
from panel.menu.words import PARAMETERS
from panel.pages.table import PAGES, PARAMETER

# As `inspection` has them.
_FAVOURITES, _FIRST, _TYPED = None, -1, -2
_PLACE = "panel.lookup.groups"  # in `Panel.remembered`: the entry that was chosen last


class List(Entries):
    title = PARAMETERS
    ahead = PAGES[PARAMETER][2]

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        table = name_of(panel.selected.survey.family)
        self._rows = [  # text, numbers, the first one
            (texts.of(words.BY_NUMBER), catalogue.ALL, _TYPED),
            (texts.of(words.FAVOURITES), _FAVOURITES, _FIRST),
        ]
        self._search = Search()
        self._loaded = 0  # of the modules that the page wants
        if table:
            self._rows.append((texts.of(words.ALL_OF_THEM), catalogue.ALL, _FIRST))
            self._search.begin(catalogue.rows(table, catalogue.ALL, "G", paced=True))

    def first(self):
        return self.panel.remembered.get(_PLACE, 0)

    def is_searching(self):
        return self._search.rows is not None or self._loaded < len(self.ahead)

    def search(self):
        if self._search.rows is None:
            if self.panel.has_time():
                self._load_ahead()
            return
        row = self._search.step()
        if row:
            self._rows.append((text(row)[:15], row[catalogue.NUMBERS], _FIRST))

    def _load_ahead(self):
        """What the page wants comes while somebody chooses, a module in a step."""
        try:
            on_demand.load(self.ahead[self._loaded])
            self._loaded += 1
        except MemoryError:
            self.ahead = ()  # the page says so, if somebody goes there

    def count(self):
        return len(self._rows)

    def words(self, position):
        return self._rows[position][0]

    def choose(self, position, now_ms):
        panel = self.panel
        _, numbers, number = self._rows[position]
        panel.remembered[_PLACE] = position
        panel.remembered["panel.lookup.parameter"] = numbers, number
        return PAGE, PARAMETER
