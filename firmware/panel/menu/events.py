# SPDX-License-Identifier: MIT
"""What has happened since power-on: alarms, and what stopped a motor; the last one first.

A3 5:12       1/7       the drive, and how long ago: 5 min 12 s; 3h05; 12d04h
>FAULT F0001            SET tells what that means, for the drive that is shown
"""

from micropython import const

from panel import texts, wording
from panel.reports.journal import NOBODY
from panel.menu import Entries, words

_WIDTH = const(15)  # of an entry
_THE_PANEL = b"P"  # in place of an address


class List(Entries):
    title = words.MENU_EVENTS

    def _event(self, position):
        return self.panel.journal.event(position)

    def count(self):
        return self.panel.journal.count or 1

    def heading(self, position):
        if not self.panel.journal.count:
            return texts.of(self.title)
        _, address, _, age_s = self._event(position)
        who = _THE_PANEL if address == NOBODY else b"A%d" % address
        return who + b" " + age(age_s)

    def words(self, position):
        if not self.panel.journal.count:
            return texts.of(words.NO_EVENTS)
        text, address, number, _ = self._event(position)
        if number:
            return texts.of(texts.FAULT) + b" " + self._fault(address, number)
        control = self.control_of(address) or self.panel.selected
        return wording.of(text, control.survey.family).strip()[:_WIDTH]

    def _fault(self, address, number):
        control = self.control_of(address) or self.panel.selected
        return control.survey.family.fault_format.encode() % number

    def control_at(self, position):
        if self.panel.journal.count:
            return self.control_of(self._event(position)[1])
        return None

    def choose(self, position, now_ms):
        control = self.control_at(position)
        if control is None or control is not self.panel.selected:
            return None
        _, address, number, _ = self._event(position)
        return ("lookup.what", ("F", number, self._fault(address, number))) if number else None


def age(seconds):
    """How long ago something was, at most 6 characters."""
    minutes = seconds // 60
    if minutes < 60:
        return b"%d:%02d" % (minutes, seconds % 60)
    hours = minutes // 60
    if hours < 24:
        return b"%dh%02d" % (hours, minutes % 60)
    return b"%dd%02dh" % (hours // 24, hours % 24)
