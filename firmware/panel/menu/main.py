# SPDX-License-Identifier: MIT
"""The first list of the menu."""

from panel import texts
from panel.menu import Entries

LISTS = (  # text, module; None: the search, which is a program of its own
    (texts.MENU_DRIVES, "drives"),
    (texts.ANY_ADDRESS, "address"),
    (texts.FIND_DRIVES, None),
    (texts.MENU_SETTINGS, "numbers"),
    (texts.MENU_ABOUT, "about"),
)


class List(Entries):
    title = texts.MENU

    def first(self):
        """Whoever has no contact is looking for the drive."""
        return 0 if self.panel.selected.drive.contact else LISTS.index((texts.FIND_DRIVES, None))

    def count(self):
        return len(LISTS)

    def words(self, position):
        return texts.of(LISTS[position][0])

    def choose(self, position, now_ms):
        name = LISTS[position][1]
        if name is None:
            self.panel.offer_search(now_ms)
            return None
        return name, None
