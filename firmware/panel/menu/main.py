# SPDX-License-Identifier: MIT
"""The first list of the menu."""

from panel import texts
from panel.menu import Entries, words

LISTS = (  # text, module
    (words.MENU_DRIVES, "drives"),
    (words.ANY_ADDRESS, "address"),
    (texts.FIND_DRIVES, "find"),
    (words.MENU_SETTINGS, "settings"),
    (words.MENU_SETS, "sets.overview"),
    (words.MENU_ORDER, "order"),
    (words.MENU_TURNS, "turns"),
    (words.MENU_DIAGNOSIS, "diagnosis.overview"),
    (words.PARAMETERS, "lookup.groups"),
    (words.COMMISSION, "commission.overview"),
    (words.FAULT_MEMORY, "lookup.memory"),
    (words.MENU_EVENTS, "events"),
    (words.MENU_ABOUT, "about"),
)
OF_SEVERAL = ("order", "turns")  # drives
OF_PARAMETERS = ("lookup.groups", "lookup.memory", "commission.overview")


class List(Entries):
    title = words.MENU

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        several = len(panel.controls) > 1
        self._lists = [row for row in LISTS if several or row[1] not in OF_SEVERAL]
        drive = panel.selected.drive
        if not drive.layout.pkw_words:
            self._lists = [row for row in self._lists if row[1] not in OF_PARAMETERS]
        self._trouble = _trouble(panel)  # what `what` is to tell
        if self._trouble:
            self._lists.insert(0, (words.WHAT_IS, "lookup.what"))
        if not drive.contact:  # whoever has none is looking for the drive
            self._lists.insert(0, (words.WHY_NO_CONTACT, "contact"))
        if panel.settings.lock_code:
            self._lists.append((words.MENU_LOCK, None))

    def count(self):
        return len(self._lists)

    def words(self, position):
        text = self._lists[position][0]
        return texts.of(text, self._trouble[2]) if text == words.WHAT_IS else texts.of(text)

    def choose(self, position, now_ms):
        text, name = self._lists[position]
        if text == words.MENU_LOCK:
            self.panel.lock(now_ms)
            return None
        return name, self._trouble if text == words.WHAT_IS else None


def _trouble(panel):
    """The fault of the drive shown, or else its warning: ("F", 72, b"F0072"); or None."""
    fault, warning = panel.selected.fault, panel.warning
    if fault.active and fault.number:
        name = panel.selected.survey.family.fault_format.encode() % fault.number
        return "F", fault.number, name
    if warning.active and warning.number:
        digits = b"%0*d" % (warning.digits, warning.number)
        return "A", warning.number, texts.of(texts.WARNING_LETTER) + digits
    return None
