# SPDX-License-Identifier: MIT
"""Bus off: the panel leaves the line to a PC tool, until PARAM, or STOP, takes it back.

P2014 MAY TRIP          no motor may run. SET sends OFF1 to every drive, and when each has
>SET=LEAVE LINE         answered, or was told, the panel is silent

PARAM=BACK              then the panel listens first, as after power-on
>LINE IS FREE
"""

from panel import texts, wording
from panel.menu import Entries
from panel.menu.diagnosis import words
from uss.master import OFF


class List(Entries):
    _is_left = False

    def heading(self, position):
        if not self._is_left:
            return wording.of(words.MAY_TRIP, self.panel.selected.survey.family)
        is_free = self.panel.bus.phase == OFF
        return texts.of(words.BACK if is_free else words.BUS_OFF)

    def words(self, position):
        if not self._is_left:
            return texts.of(words.SET_LEAVES)
        if self.panel.bus.phase == OFF:
            return texts.of(words.LINE_IS_FREE)
        return texts.of(words.STOPS_DRIVES)

    def choose(self, position, now_ms):
        if self._is_left:
            return
        if self.panel.any_runs():
            self.panel.say(now_ms, texts.STOP_FIRST)
        else:
            self._is_left = True
            self.panel.bus.off()

    def is_busy(self):
        return self._is_left

    def take_keys(self, acts):
        if acts.has("STOP"):  # which is always sent
            self.end()
        return False

    def end(self):
        if self._is_left:
            self._is_left = False
            self.panel.bus.on()
