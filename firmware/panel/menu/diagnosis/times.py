# SPDX-License-Identifier: MIT
"""How long things take on the line, the shortest and the longest since this list was opened.

A4 REPLY     3/3        CYCLE: from one telegram to the drive to the next; START: the silence
>2.1-18.3 ms            before the panel's telegram; REPLY: until the drive answers
"""

from micropython import const

from panel import texts
from panel.menu import Entries
from panel.menu.diagnosis import words
from uss.finding.witness import NEVER, Witness

_LONG_MS = const(1_000)  # from here on without decimals


class List(Entries):
    """argument: the `Control` of a drive; None: of all."""

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        bus = panel.bus
        address = argument and argument.drive.address
        bus.witness = Witness(bus.timing.character_us, panel.mask, address)

    def count(self):
        return len(words.TIMES)

    def heading(self, position):
        name = texts.of(words.TIMES[position])
        if self.argument is None:
            return texts.of(words.BUS, name)
        return b"A%d %s" % (self.argument.drive.address, name)

    def words(self, position):
        times = self.panel.bus.witness.times
        least, most = times[2 * position], times[2 * position + 1]
        if most == NEVER:
            return texts.of(words.NONE_YET)
        least, most = (least + 50) // 100, (most + 50) // 100
        if most >= 10 * _LONG_MS:
            return texts.of(words.LONG_RANGE, least // 10, most // 10)
        return texts.of(words.RANGE, least // 10, least % 10, most // 10, most % 10)

    def control_at(self, position):
        return self.argument

    def end(self):
        self.panel.bus.witness = None
