# SPDX-License-Identifier: MIT
"""Tells from a drive's own count of telegrams, r2024, whether the drive was without its mains.

The count starts at 0 when the drive powers up. So the drive was reset when the count has gone
back, or when it lacks telegrams that the drive has answered.

    count = TelegramCount(drive)
    count.asked()                       # r2024 is being asked for
    count.take(before, now)             # its answer, and the one before
    count.take_restart()                # whether it was reset while it was wanted to run
    count.begin()                       # another run begins: nothing has been counted yet
    count.forget()                      # contact was lost
"""

from micropython import const

from uss.drive import COUNTERS, NODES

_GOOD = COUNTERS.index("good")
_BESIDE = const(64)  # telegrams that a drive may count and this master does not,
_LATE = const(32)  # and that it may count later than it answers them


class TelegramCount:
    """drive: a `Drive`. Its counters of exchanges are what the count is held against.

    restarted: since `begin` the drive was reset while it was wanted to run. is_told: it answers
    when it is asked for its count, as far as anybody knows; for the survey to write.
    """

    def __init__(self, drive):
        self._drive = drive
        self._exchanges = 0  # with the drive, when its count was read,
        self._answers = 0  # and those of them that it has answered,
        self._answers_asked = 0  # and had, when it was asked for the present count
        self.forget()

    def forget(self):
        """Contact was lost: it may be another drive."""
        self._counts_all = False  # the telegrams to others as well
        self._moves = False
        self.begin()

    def begin(self):
        """From the next count on fewer telegrams mean that the drive was reset."""
        self.restarted = False
        self.is_told = True
        self._begun = False

    def asked(self):
        """The drive is being asked for its count."""
        self._answers_asked = self._drive.counters[_GOOD]

    def take_restart(self):
        """`restarted`, which is forgotten by this."""
        restarted, self.restarted = self.restarted, False
        return restarted

    def take(self, before, count):
        """Find out whether the drive has been reset since the last count. One that never moves
        tells nothing.
        """
        exchanges = 0
        for counted in self._drive.counters:
            exchanges += counted
        # The loop may be late: what was answered since the question is none of this count's.
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
