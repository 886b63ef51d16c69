# SPDX-License-Identifier: MIT
"""The mains of the drives: a supply that dips, for all of them at once.

What a lower voltage does to one drive is `Drive.supply`; here there is none for a while.

    mains = Mains(clock, drives)
    mains.dip(200)                      # all drives are without for 200 ms
"""

from boards.sim.clock import Event


class Mains:
    """drives: a list of `Drive`. A drive that was switched off by hand stays off."""

    def __init__(self, clock, drives):
        self._clock = clock
        self._drives = drives
        self._without = []
        self._back = Event(self._come_back)

    def dip(self, ms):
        """Cut the mains for so long, or until the end of a dip under way. May be called in an
        event.
        """
        for drive in self._drives:
            if drive.mains:
                drive.power_off()
                self._without.append(drive)
        at_us = self._clock.now_us + ms * 1000
        if not self._back.armed or self._back.at_us < at_us:
            self._clock.schedule(self._back, at_us)

    def _come_back(self):
        drives, self._without = self._without, []
        for drive in drives:
            drive.power_on()
