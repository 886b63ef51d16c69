# SPDX-License-Identifier: MIT
"""The drives that were accepted with P2014 = 0; SET takes that back: START asks again."""

from panel import texts
from panel.menu import Entries, words


class List(Entries):
    title = words.ACCEPTED

    def count(self):
        return max(len(self.panel.settings.unsupervised), 1)

    def words(self, position):
        accepted = self.panel.settings.unsupervised
        if not accepted:
            return texts.of(words.NO_DRIVE)
        return texts.of(words.TAKE_BACK, accepted[position])

    def choose(self, position, now_ms):
        settings = self.panel.settings
        kept = list(settings.unsupervised)
        if kept:
            kept.pop(position)
            settings.change("unsupervised", tuple(kept))
            self.panel.say(now_ms, words.KEPT)
