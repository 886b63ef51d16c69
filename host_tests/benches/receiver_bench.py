# SPDX-License-Identifier: MIT
"""A receiver alone, and characters that come when a test says so: to the microsecond.

In use:

    line = Line()
    line.come(REPLY, 3 * TCH)               # a reply, three characters after the request: GOOD
"""

from uss import telegram
from uss.drive import Drive
from uss.receiver import Receiver
from uss.timing import Timing

MASK = (1 << 30) - 1
BAUD = 19200
LINE = Timing(BAUD)
TCH = LINE.character_us  # 573 us
REPLY = bytes((0x02, 0x0E, 0x01, 0, 0, 0, 0, 0, 0, 0, 0, 0xFB, 0x34, 0x20, 0x00, 0xE2))
SENT_AT = 1000


class Link:
    """Delivers what it is told, exact to the microsecond."""

    interrupts = True
    resolution_us = 0
    received_at = 0

    def __init__(self):
        self.burst = b""

    def receive(self, buffer, at):
        count = len(self.burst)
        buffer[at : at + count] = self.burst
        self.burst = b""
        return count


class Line:
    """A receiver that awaits the reply of drive 1, and the characters that come."""

    def __init__(self, mask=MASK, sent_at=SENT_AT, polled_us=0):
        self.link = Link()
        self.link.resolution_us = polled_us
        self.mask = mask
        self.sent_at = sent_at
        self.receiver = Receiver(LINE, mask)
        self.drive = Drive(1, mask)
        self.drive.fill(0)
        telegram.seal(self.drive.request, 1, 12)
        self.receiver.open(self.drive, sent_at)

    def come(self, characters, pause_us, after_us=0):
        """`characters` back to back after a pause; seen `after_us` late. Answers the finding."""
        begin = self.receiver.heard_at + pause_us
        end = begin + len(characters) * TCH
        self.link.burst = bytes(characters)
        self.link.received_at = (end + after_us) & self.mask
        return self.receiver.take(self.link, (end + after_us) & self.mask)

    def silence(self, until_us):
        """Nothing came until so long after the request."""
        return self.receiver.take(self.link, (self.sent_at + until_us) & self.mask)
