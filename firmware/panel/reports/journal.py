# SPDX-License-Identifier: MIT
"""What has happened since power-on, the last events first: alarms, and what stopped a motor.

    journal.tick(now_ms)                # again and again: it counts the seconds
    journal.note(texts.PANEL_HUNG, 3)   # of drive 3; it takes no memory
    text, address, number, age_s = journal.event(0)     # the last one

Only what is lost with the power stands here; the drive has a memory of its own faults.
"""

from micropython import const

from panel import texts
from uss.timing import elapsed

EVENTS = const(16)  # that are kept
NOBODY = const(0xFF)  # in place of an address: the panel itself


class Journal:
    """mask: the clock's period - 1. count: how many events it has, EVENTS at the most."""

    def __init__(self, mask):
        self.count = 0
        self._mask = mask
        self._next = 0
        self._seconds = 0  # since power-on
        self._counted_at_ms = None
        self._texts = [texts.NOTHING] * EVENTS
        self._addresses = bytearray(EVENTS)
        self._numbers = [0] * EVENTS
        self._at_s = [0] * EVENTS

    def tick(self, now_ms):
        """Count the seconds. To be called twice in a period of the clock, at the least."""
        if self._counted_at_ms is None:
            self._counted_at_ms = now_ms
        while elapsed(now_ms, self._counted_at_ms, self._mask) >= 1_000:
            self._counted_at_ms = self._counted_at_ms + 1_000 & self._mask
            self._seconds += 1

    def note(self, text, address=NOBODY, number=0):
        """text: of `texts`. number: of a fault, which stands for the text where there is one."""
        place = self._next
        self._texts[place] = text
        self._addresses[place] = address
        self._numbers[place] = number
        self._at_s[place] = self._seconds
        self._next = (place + 1) % EVENTS
        self.count = min(self.count + 1, EVENTS)

    def event(self, place):
        """text, address, number, and how many seconds ago; place: 0 is the last event."""
        at = (self._next - 1 - place) % EVENTS
        age_s = self._seconds - self._at_s[at]
        return self._texts[at], self._addresses[at], self._numbers[at], age_s
