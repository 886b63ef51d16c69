# SPDX-License-Identifier: MIT
"""What is known of the parameter that is shown, and how it reads: both rows, each in a step of its
own. See `inspection`.
"""

from micropython import const

import catalogue
from panel import texts
from panel.lookup import text, words
from uss.timing import elapsed

_BLINK_MS = const(800)  # of these the digit is away for
_AWAY_MS = const(250)
_MISSING = b"..."


class Sight:
    """For `Editing`: row, form, high, low, table, as they are now."""

    def __init__(self, panel):
        self.panel = panel
        self._control = panel.selected  # of the drive that all this belongs to
        self.table = None  # of the catalogue
        self.number = self.index = 0
        self.row = None  # of the catalogue
        self.form = None  # None: nothing is read
        self.high = self.low = 0
        self._refused = False  # the drive does not tell it
        self._value_name = texts.NOTHING
        self._is_coming = False  # one is looked for, and none was shown before
        self._is_known = True  # the catalogue was looked into
        self._typed = None  # a number that is being typed, and the place that changes
        self._place = 2  # few drives have numbers above 9999
        self._editing = None  # an `Editing`
        self._used_at_ms = None
        self._first_turn = 0  # of what row 1 says in turn

    def is_reading(self):
        """Whether the catalogue says that it can only be read."""
        return self.row is not None and self.row[catalogue.KEY][:1] == b"r"

    def row_1(self):
        if self._typed is not None:
            return texts.of(words.TYPE_NUMBER)
        if self._is_coming:
            return _MISSING
        if self._editing is None:
            return self._in_turn(self._lines())
        name = self._editing.name()
        return self._in_turn([self._value_row()] + self._lines()[1:]) if name is None else name

    def row_2(self, now_ms):
        if self._is_coming:
            return texts.NOTHING
        if self._typed is None and self._editing is None:
            return self._value_row()
        used_at_ms = now_ms if self._used_at_ms is None else self._used_at_ms
        away_ms = elapsed(now_ms, used_at_ms, self.panel.mask) % _BLINK_MS
        is_away = away_ms >= _BLINK_MS - _AWAY_MS
        if self._typed is None:
            return self._editing.row(is_away)
        number = bytes(self._typed)
        return number[: self._place] + b"_" + number[self._place + 1 :] if is_away else number

    def _in_turn(self, lines):
        return lines[(self.panel.announcer.page_turns - self._first_turn) % len(lines)]

    def label(self):
        """P1120."""
        return (b"r%04d" if self.is_reading() else b"P%04d") % self.number

    def _lines(self):
        """What row 1 says in turn."""
        if self.row is None:
            name = texts.of(words.NO_NAME) if self._is_known else _MISSING
            return [name, self._limits()]
        lines = [text(self.row)]
        if self._value_name:
            lines.append(self._value_name)
        lines.append(self._limits())
        return lines

    def _limits(self):
        """The address, and between which values the parameter may be, as far as there is room."""
        row = self.row
        limits = b"A%d" % self._control.drive.address
        if row and row[catalogue.HIGHEST]:
            between = row[catalogue.LOWEST] + b"..." + row[catalogue.HIGHEST]
            for more in (b" " + between, row[catalogue.UNIT]):
                if len(limits) + len(more) > texts.ROW_WIDTH:
                    break  # a unit alone would be one of the address
                limits += more
        return limits

    def _value_row(self):
        """P1120[0]  10.00s"""
        label = self.label()
        is_array = self.index or self.row is None or catalogue.indices(self.row) > 1
        if is_array and self._control.survey.family.has_indices:
            label += b"[%d]" % self.index
        words_of_value = b"-----" if self._refused else b"?"
        width = texts.ROW_WIDTH - len(label)
        if self.form:
            words_of_value = self.form.fitting(self.high, self.low, width - 1)
            if len(words_of_value) > width:
                label = self.label()
                width = texts.ROW_WIDTH - len(label)
            if len(words_of_value) > width:
                words_of_value = self.form.roughly(self.high, self.low)
        return label + b" " * (width - len(words_of_value)) + words_of_value[:width]
