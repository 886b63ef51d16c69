# SPDX-License-Identifier: MIT
"""The fault of one drive: its number, and whether it has been seen long enough to acknowledge it.

    fault = Fault(drive, mask)
    fault.step(now)                     # again and again
    fault.number                        # 1 for F0001; 0 while it is not known
    fault.seen = True                   # it is on the display
    if fault.was_shown: drive.acknowledge()
"""

from micropython import const

from uss import pkw, profiles, pzd
from uss.timing import elapsed

_SHOWN_US = const(1_000_000)  # a STOP in the moment of the trip must not wipe its number away
_AGAIN_US = const(500_000)  # between two questions


class Fault:
    """drive: a `Drive`. mask: the clock's period - 1.

    active: the drive has tripped. seen: whoever shows it says so here. was_shown: for a second.
    """

    def __init__(self, drive, mask):
        self.active = False
        self.number = 0
        self.seen = False
        self.was_shown = False
        self._drive = drive
        self._mask = mask
        self._job = None  # made with the first trip: most drives never have one
        self._asked = False
        self._asked_at = 0
        self._wait_us = 0  # between the last question and the next
        self._stale = False  # what was asked belongs to an earlier trip
        self._since = 0  # when it was seen first

    def step(self, now):
        drive = self._drive
        if not (self.active or self._asked or drive.zsw & pzd.ZSW_FAULT):
            return  # as it mostly is
        active = drive.contact and drive.state() == pzd.FAULT
        if active != self.active:
            self.active = active
            self.number = 0
            self.seen = False
            self.was_shown = False
            self._wait_us = 0
            self._stale = self._asked
        if not self.seen:
            self._since = now
        elif active and elapsed(now, self._since, self._mask) >= _SHOWN_US:
            self.was_shown = True  # for good: the clock forgets how long ago that was
        if self._asked:
            self._take()
        elif active:
            self._ask(now)  # again and again: there may be another one by now

    def _ask(self, now):
        waited_us = elapsed(now, self._asked_at, self._mask)
        if waited_us < self._wait_us or self._drive.channel.is_full():
            return
        if self._job is None:
            self._job = pkw.read(profiles.FAULT_NUMBER)
        self._drive.ask(self._job)
        self._asked = True
        self._asked_at = now
        self._wait_us = _AGAIN_US

    def _take(self):
        if self._job.state == pkw.PENDING:
            return
        self._asked = False
        if self._job.state == pkw.DONE and not self._stale:
            self.number = self._job.low
        self._stale = False
