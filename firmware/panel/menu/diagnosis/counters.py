# SPDX-License-Identifier: MIT
"""Counters of the specification (A-5.2.3), of a drive or of all, and how fast they grow.

A4 NOREPLY   6/7        counted since the panel started, 16 bits; a minute, since this entry
>  812  2880/min        was chosen
"""

from micropython import const

from panel import texts
from panel.menu import Entries
from panel.menu.diagnosis import words
from uss.timing import elapsed

_SOON_MS = const(2_000)  # a rate of less says nothing
_MINUTE_MS = const(60_000)


class List(Entries):
    """argument: the `Control` of a drive; None: of the bus."""

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        self._names = words.COUNTERS
        self._drives = [argument] if argument else panel.controls
        if not argument:
            self._names += words.OF_THE_BUS
        self._row = -1
        self._first = 0  # what was counted when the row was chosen,
        self._first_at_ms = 0  # and when that was
        self._passed_ms = 0

    def count(self):
        return len(self._names)

    def heading(self, position):
        name = texts.of(self._names[position])
        if self.argument is None:
            return texts.of(words.BUS, name)
        return b"A%d %s" % (self.argument.drive.address, name)

    def words(self, position):
        counted, passed_ms = self._counted(position), self._passed_ms
        if position != self._row or passed_ms < _SOON_MS:
            return texts.of(words.COUNTS, counted)
        grown = counted - self._first & 0xFFFF
        return texts.of(words.PER_MINUTE, counted, grown * _MINUTE_MS // passed_ms)

    def control_at(self, position):
        return self.argument

    def step(self, position, now_ms):
        if position != self._row:
            self._row = position
            self._first = self._counted(position)
            self._first_at_ms = now_ms
        self._passed_ms = elapsed(now_ms, self._first_at_ms, self.panel.mask)

    def _counted(self, row):
        if row >= len(words.COUNTERS):
            bus = self.panel.bus
            row -= len(words.COUNTERS)
            return (bus.turns.exchanges, bus.foreign, bus.failures, bus.dead_man_trips)[row]
        counted = 0
        for control in self._drives:
            counted += control.drive.counters[row]
        return counted & 0xFFFF
