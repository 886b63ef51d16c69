# SPDX-License-Identifier: MIT
"""Tells from a drive's own count of telegrams, r2024, whether the drive was without its mains.

The count starts at 0 when the drive powers up. So the drive was reset when the count has gone
back, or when it lacks telegrams that the drive has answered.

    count = TelegramCount(drive)
    count.asked()                       # a job that reads r2024 was queued
    count.take(before, now)             # the count before, and the count that was just read
    count.take_restart()                # whether the drive was reset while it was wanted to run
    count.begin()                       # another run begins: start counting anew
    count.forget()                      # contact was lost
"""

from micropython import const

from uss.drive import COUNTERS, NODES

_GOOD = COUNTERS.index("good")
_BESIDE = const(64)  # a drive may count so many telegrams that this master does not count,
_LATE = const(32)  # and may count so many later than it answers them


class TelegramCount:
    """drive: a `Drive`. The count is compared with its counters of exchanges.

    restarted: since `begin` the drive was reset while it was wanted to run. is_told: as far as is
    known the drive answers when it is asked for its count; the survey writes this.
    """

    def __init__(self, drive):
        self._drive = drive
        self._exchanges = 0  # with the drive, when its last count was taken,
        self._answers = 0  # and those of them that it had answered then
        self._answers_asked = 0  # those that it had answered when it was asked for this count
        self.forget()

    def forget(self):
        """Contact was lost: it may be another drive."""
        self._counts_all = False  # the drive counts telegrams to other drives too
        self._moves = False
        self.begin()

    def begin(self):
        """Start anew: from the next count on a count that lacks telegrams means a reset."""
        self.restarted = False
        self.is_told = True
        self._begun = False

    def asked(self):
        """The drive is being asked for its count."""
        self._answers_asked = self._drive.counters[_GOOD]

    def take_restart(self):
        """Return `restarted` and clear it."""
        restarted, self.restarted = self.restarted, False
        return restarted

    def take(self, before, count):
        """Find out whether the drive has been reset since the last count. A count that never moves
        tells nothing.
        """
        exchanges = 0
        for counted in self._drive.counters:
            exchanges += counted
        # The loop may be late: this count does not include what was answered after the question.
        since = (exchanges - self._exchanges) & 0xFFFF
        answered = (self._answers_asked - self._answers) & 0xFFFF
        self._exchanges, self._answers = exchanges, self._drive.counters[_GOOD]
        grown = (count - before) & 0xFFFF
        self._moves = self._moves or before > 0 and grown > 0
        begun, self._begun = self._begun, True
        if not begun:
            return
        if count >= before and grown > since + (_BESIDE >> 2):
            self._counts_all = True
        most = (since * NODES if self._counts_all else since) + _BESIDE
        least = answered - (answered >> 3) - _LATE
        if count < before and grown > most or self._moves and grown < least:
            self.restarted = self._drive.wanted != 0
