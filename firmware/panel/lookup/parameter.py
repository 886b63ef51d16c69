# SPDX-License-Identifier: MIT
"""The page of one parameter, any that the drive shown has; the menu leads to it.

    Ramp-up time            its name, in turn with its limits and what its value is called
    P1120[0]  10.00s        number, index, value and unit

`inspection` does the work, and comes with the first turn.
"""

from panel import texts
from panel.lookup.inspection import Inspection
from panel.pages import Page
from panel.pages.table import PAGES, PARAMETER


class Parameter(Page):
    """Begins with what the menu has left in `Panel.remembered`: see `inspection`."""

    modules = PAGES[PARAMETER][2]

    def __init__(self, panel):
        Page.__init__(self, panel)
        self._inspection = None
        self._was_whole = True

    @property
    def whole(self):
        """It has both rows, unless an alarm of the drive shown needs them."""
        self._was_whole = not self.panel.selected.needs_attention()
        return self._was_whole

    @property
    def obeys(self):
        """While something is typed no motor starts, and PARAM ends that."""
        return self._inspection is None or not self._inspection.is_typing()

    @property
    def is_busy(self):
        return self._inspection is None or self._inspection.is_searching()

    def is_coming(self):
        return self._inspection is None or self._inspection.is_coming()

    def step(self, keys, now_ms):
        if self.is_coming():
            self.work(now_ms)
        else:
            self._inspection.step(keys, now_ms)

    def work(self, now_ms):
        """Look on in the catalogue."""
        if self._inspection is None:
            self._inspection = Inspection(self.panel)
        else:
            self._inspection.look_on()

    def take_keys(self, acts, now_ms):
        if self._inspection is not None and self._inspection.has_begun():
            self._inspection.take_keys(acts, now_ms)

    def draw(self, screen, now_ms):
        if not self._was_whole:  # the alarm has ended since the picture was begun
            screen.put(1, 0, texts.STATE_WIDTH, texts.NOTHING)
            return
        row = texts.NOTHING if self._inspection is None else self._inspection.row_1()
        screen.put(0, 0, texts.ROW_WIDTH, row)

    def draw_row_2(self, screen, now_ms):
        row = texts.NOTHING if self._inspection is None else self._inspection.row_2(now_ms)
        screen.put(1, 0, texts.ROW_WIDTH, row)
