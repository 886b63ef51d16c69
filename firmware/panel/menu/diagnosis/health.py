# SPDX-License-Identifier: MIT
"""The panel itself: why it started, and the memory that is free, which SET counts.

To count takes 10 ms, so no motor may run.
"""

import on_demand
from panel import texts
from panel.menu import Entries
from panel.menu.diagnosis import words


class List(Entries):
    _free = None  # bytes, once they were counted

    def count(self):
        return 2

    def heading(self, position):
        return texts.of((words.RESTART, words.HEAP)[position])

    def words(self, position):
        if position:
            if self._free is None:
                return texts.of(words.SET_COUNTS)
            return texts.of(words.BYTES, self._free)
        bitten = self.panel.board.reset_cause
        return texts.of(words.WATCHDOG if bitten else words.NOT_BITTEN)

    def choose(self, position, now_ms):
        if not position:
            return
        if self.panel.any_runs():
            self.panel.say(now_ms, texts.STOP_FIRST)
        else:
            self._free = on_demand.free_bytes()
