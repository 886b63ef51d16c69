# SPDX-License-Identifier: MIT
"""Looks on while the master exchanges telegrams: how long things take, and the last telegrams.

There is one only while somebody looks at it, so that it costs nothing otherwise.

    bus.witness = witness = Witness(bus.timing.character_us, mask, 4)
    witness.times[CYCLE]                # the shortest, an array: [CYCLE + 1] the longest, in us
    witness.request, witness.reply      # the first KEPT characters, and how many there were
    bus.witness = None
"""

from array import array

from micropython import const

from uss.fast import copy
from uss.telegram import GOOD

KEPT = const(42)  # characters of a telegram
NEVER = const(0)  # in place of a time: there was none

# Places in `times`, of the shortest; the longest stands behind it.
CYCLE = const(0)  # from one request to a drive to the next
START_DELAY = const(2)  # from the end of a reply to STX of the next request
RESPONSE_DELAY = const(4)  # from the end of a request to STX of the reply (A-5.2.1.1)


class Witness:
    """character_us: of the line. mask: the clock's period - 1. address: of the drive that it looks
    at; None: of all, and the cycle is that of the one that it sees first.

    finding: of the receiver, on the last exchange; -1: there was none. is_held: the last telegrams
    stay as they are.
    """

    def __init__(self, character_us, mask, address=None):
        self.times = array("i", bytes(4 * 6))
        self.request = bytearray(KEPT)
        self.request_count = 0
        self.reply = bytearray(KEPT)
        self.reply_count = 0
        self.finding = -1
        self.is_held = False
        self._address = address
        self._first = address
        self._character_us = character_us
        self._mask = mask
        self._asked_at = 0  # the drive of the cycle, last
        self._is_asked = False
        self._heard_at = 0  # the last reply, whoever sent it
        self._is_heard = False

    def note(self, drive, finding, receiver):
        """From the engine: an exchange is over. Allocates nothing."""
        mask = self._mask
        sent_at = receiver.sent_at
        start_us = (sent_at - drive.size * self._character_us - self._heard_at) & mask
        was_heard = self._is_heard
        self._is_heard = finding == GOOD
        self._heard_at = receiver.heard_at
        address = drive.request[2]
        if self._first is None:
            self._first = address
        if address == self._first:
            if self._is_asked:
                self._take(CYCLE, (sent_at - self._asked_at) & mask)
            self._is_asked = True
            self._asked_at = sent_at
        if self._address is not None and address != self._address:
            return
        if was_heard:
            self._take(START_DELAY, start_us)
        if finding == GOOD:
            length_us = receiver.count * self._character_us
            self._take(RESPONSE_DELAY, (receiver.heard_at - sent_at - length_us) & mask)
        if not self.is_held:
            self.finding = finding
            self.request_count = drive.size
            copy(drive.request, self.request, 0, min(drive.size, KEPT))
            self.reply_count = receiver.count
            copy(receiver.buffer, self.reply, 0, min(receiver.count, KEPT))

    def _take(self, place, us):
        """Another time; one that is below 0, by the link's resolution, is none."""
        if us > self._mask >> 1:
            return
        times = self.times
        if times[place + 1] == NEVER or us < times[place]:
            times[place] = us
        if us >= times[place + 1]:
            times[place + 1] = us or 1
