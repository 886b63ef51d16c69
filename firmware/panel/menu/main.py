# SPDX-License-Identifier: MIT
"""The first list of the menu."""

from panel import texts
from panel.menu import Entries, words

LISTS = (  # text, module
    (words.MENU_DRIVES, "drives"),
    (words.ANY_ADDRESS, "address"),
    (texts.FIND_DRIVES, "find"),
    (words.MENU_SETTINGS, "settings"),
    (words.MENU_ORDER, "order"),
    (words.MENU_TURNS, "turns"),
    (words.MENU_ABOUT, "about"),
)
OF_SEVERAL = ("order", "turns")  # drives


class List(Entries):
    title = words.MENU

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        several = len(panel.controls) > 1
        self._lists = [row for row in LISTS if several or row[1] not in OF_SEVERAL]
        if not panel.selected.drive.contact:  # whoever has none is looking for the drive
            self._lists.insert(0, (words.WHY_NO_CONTACT, "contact"))
        if panel.settings.lock_code:
            self._lists.append((words.MENU_LOCK, None))

    def count(self):
        return len(self._lists)

    def words(self, position):
        return texts.of(self._lists[position][0])

    def choose(self, position, now_ms):
        text, name = self._lists[position]
        if text == words.MENU_LOCK:
            self.panel.lock(now_ms)
            return None
        return name, None
