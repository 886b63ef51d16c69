# SPDX-License-Identifier: MIT
"""A screen that does not put up with a text that is cut, or runs into another field.

In use, by `panel_bench`:

    panel.panel.Screen = StrictScreen

A row is drawn anew from its first place on. Until then a blank may be written over, but no other
character.
"""

from panel.screen import COLUMNS, ROWS, Screen

BLANK = 0x20


class StrictScreen(Screen):
    def __init__(self, rom="A00"):
        Screen.__init__(self, rom)
        self._drawn = bytearray(ROWS * COLUMNS)  # 1: in this picture, and no blank

    def put(self, row, column, width, text):
        assert len(text) <= width, "%r is cut to %d characters" % (text, width)
        if column == 0:
            self._begin(row)
        self._check(row, column, len(text))
        Screen.put(self, row, column, width, text)
        self._note(row, column, len(text))

    def number(self, row, column, width, hundredths, decimals):
        self._check(row, column, width)
        Screen.number(self, row, column, width, hundredths, decimals)
        self._note(row, column, width)

    def digits(self, row, column, width, number):
        self._check(row, column, width)
        Screen.digits(self, row, column, width, number)
        self._note(row, column, width)

    def _begin(self, row):
        for column in range(COLUMNS):
            self._drawn[row * COLUMNS + column] = 0

    def _check(self, row, column, width):
        assert column + width <= COLUMNS, "%d characters from column %d on" % (width, column)
        for place in range(row * COLUMNS + column, row * COLUMNS + column + width):
            assert not self._drawn[place], "drawn over: %r" % (self.rows(),)

    def _note(self, row, column, width):
        for place in range(row * COLUMNS + column, row * COLUMNS + column + width):
            self._drawn[place] = self.picture[place] != BLANK
