# SPDX-License-Identifier: MIT
"""Mirror test: a drive sends back what it was sent, and acts on nothing in it (A-5.3).

A4 MIRROR TEST          telegrams that came back unchanged, four a second; SET begins anew
>12 OK OF 12
"""

from micropython import const

from panel import texts
from panel.menu import Entries
from panel.menu import words as menu_words
from panel.menu.diagnosis import words
from uss.finding.mirror import Mirror
from uss.pkw import DONE, NEW, PENDING
from uss.timing import elapsed

_EVERY_MS = const(250)
_COUNTED_MAX = const(9999)


class List(Entries):
    """argument: the `Control` of a drive."""

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        drive = argument.drive
        # Each character another one, and bit 10 of STW is 0.
        net = bytearray(0x5A ^ index for index in range(drive.layout.net_count))
        if drive.layout.pzd_words:
            net[-drive.layout.pzd_count] &= 0xFB
        self._mirror = Mirror(drive.address, net)
        self._sent_at_ms = None
        self._sent = self._good = 0

    def heading(self, position):
        return texts.of(words.MIRROR, self.argument.drive.address)

    def words(self, position):
        return texts.of(menu_words.OK_OF, self._good, self._sent)

    def control_at(self, position):
        return self.argument

    def choose(self, position, now_ms):
        self._sent = self._good = 0

    def step(self, position, now_ms):
        mirror, bus = self._mirror, self.panel.bus
        if mirror.state == PENDING:
            return
        if mirror.state != NEW:
            self._good += mirror.state == DONE
            self._sent += 1
            mirror.state = NEW
        sent_at_ms = self._sent_at_ms
        if sent_at_ms is not None and elapsed(now_ms, sent_at_ms, self.panel.mask) < _EVERY_MS:
            return
        may = not bus.turns.has_command() and not bus.deadlines.silence_wait_us()
        if may and self._sent < _COUNTED_MAX:
            bus.turns.post(mirror)
            self._sent_at_ms = now_ms
