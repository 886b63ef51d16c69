# SPDX-License-Identifier: MIT
"""A question about a parameter set: SET is yes, PARAM no. Row 1 says in turn what is at stake."""

from panel import texts
from panel.menu import BACK, Entries
from panel.menu.sets import words


class List(Entries):
    """argument: the texts for row 1, what belongs into them, a function of now_ms: yes."""

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        stakes, values, self._do = argument
        self._stakes = texts.filled(stakes, *values)

    def heading(self, position):
        return self._stakes[self.panel.announcer.page_turns % len(self._stakes)]

    def words(self, position):
        return texts.of(words.YES_OR_NO)

    def choose(self, position, now_ms):
        self._do(now_ms)
        return BACK
