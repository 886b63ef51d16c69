# SPDX-License-Identifier: MIT
"""Where to look for drives: beside those that are controlled, or without them at every rate."""

from panel import texts
from panel.menu import Entries, words


class List(Entries):
    title = texts.FIND_DRIVES

    def first(self):
        """Who hears no drive at all may have the wrong rate."""
        return 0 if any([control.drive.contact for control in self.panel.controls]) else 1

    def count(self):
        return 2

    def words(self, position):
        return texts.of((words.AT_THIS_RATE, words.AT_ALL_RATES)[position])

    def choose(self, position, now_ms):
        if not position and not self.panel.line_in_use():
            return "beside", None
        self.panel.offer_search(now_ms)
        return None
