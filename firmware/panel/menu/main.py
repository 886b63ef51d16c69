# SPDX-License-Identifier: MIT
"""The first list of the menu."""

from panel import texts
from panel.menu import Entries

LISTS = (  # text, module
    (texts.MENU_DRIVES, "drives"),
    (texts.ANY_ADDRESS, "address"),
    (texts.FIND_DRIVES, "find"),
    (texts.MENU_SETTINGS, "settings"),
    (texts.MENU_ORDER, "order"),
    (texts.MENU_TURNS, "turns"),
    (texts.MENU_ABOUT, "about"),
)
OF_SEVERAL = ("order", "turns")  # drives


class List(Entries):
    title = texts.MENU

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        several = len(panel.controls) > 1
        self._lists = [row for row in LISTS if several or row[1] not in OF_SEVERAL]
        if not panel.selected.drive.contact:  # whoever has none is looking for the drive
            self._lists.insert(0, (texts.WHY_NO_CONTACT, "contact"))
        if panel.settings.lock_code:
            self._lists.append((texts.MENU_LOCK, None))

    def count(self):
        return len(self._lists)

    def words(self, position):
        return texts.of(self._lists[position][0])

    def choose(self, position, now_ms):
        text, name = self._lists[position]
        if text == texts.MENU_LOCK:
            self.panel.lock(now_ms)
            return None
        return name, None
