# SPDX-License-Identifier: MIT
"""Whether a STOP is obeyed: the drive has answered OFF1, slows down, and comes to rest.

An answer alone says that OFF1 was heard, not that it is obeyed: a drive that takes its commands
from elsewhere answers as well. So its speed is watched until the motor stands still. A drive that
falls silent need not answer if it was heard at rest after its last ON. A drive that does not send
its status gives no evidence: its STOP is never confirmed.

    watch = NO_WATCH                # of a drive that nobody has stopped yet
    watch = StopWatch(drive, mask)  # OFF1 is being sent; the time counts from the next step on
    watch.begin()                   # likewise, another time
    watch.step(now_us)              # again and again
    watch.unconfirmed               # an alarm
"""

from micropython import const

from uss import pzd
from uss.timing import elapsed

_CONFIRM_US = const(1_000_000)  # a STOP that is not confirmed by then is an alarm
_SLOWING_US = const(3_000_000)  # from then on the drive slows down once in this time at the least,
_SLOWER = const(4)  # by so many steps of HIW: 0.012 Hz of 50 Hz, more than the word trembles
_ANSWERS_MIN = const(3)  # so many answers must have come to judge by: long lists take their time
_SILENT_MAX = const(3)  # after so many telegrams without an answer none is waited for


class StopWatch:
    """drive: a `uss.drive.Drive`. mask: of the clock.

    `active`: the motor has still to come to rest. `unconfirmed`: it should have said so by now, or
    does not slow down.
    """

    def __init__(self, drive, mask):
        self._drive = drive
        self._mask = mask
        self.begin()

    def begin(self):
        self.active = True
        self.unconfirmed = False
        self._slowed = False  # it has been seen to slow down
        self._seems_slower = False  # by less than the word may tremble
        self._slowed_at_us = None  # when that was last, at first when the watch began
        self._off_answers = self._drive.off_answers  # then
        self._speed = 0  # |HIW| then, at first the highest since the watch began

    def end(self):
        """The motor stands still, or is wanted to run again."""
        self.active = False
        self.unconfirmed = False

    def step(self, now_us):
        if not self.active:
            return
        if self._slowed_at_us is None:
            self._slowed_at_us = now_us
        drive = self._drive
        if drive.contact:
            answers = (drive.off_answers - self._off_answers) & 0xFFFF
            if answers and drive.tells_status:
                if drive.state() != pzd.RUNNING:
                    self.end()
                    return
                self._look_at(abs(pzd.signed(drive.hiw)), now_us)
            waits = answers or self._slowed
            if waits and answers < _ANSWERS_MIN and drive.silent < _SILENT_MAX:
                return
        patience_us = _SLOWING_US if self._slowed or self._seems_slower else _CONFIRM_US
        if elapsed(now_us, self._slowed_at_us, self._mask) < patience_us:
            return
        if drive.contacts and not drive.may_run():
            self.end()
        else:
            self.unconfirmed = True

    def _look_at(self, speed, now_us):
        if speed <= self._speed - _SLOWER:
            self._slowed = True
            self._slowed_at_us = now_us
            self._off_answers = self._drive.off_answers
            self._speed = speed
            self.unconfirmed = False
        elif not self._slowed:
            self._seems_slower = speed < self._speed
            self._speed = max(self._speed, speed)


class NoWatch:
    """Stands for the `StopWatch` of a drive that nobody has stopped since the panel started.

    With 31 drives that saves 3 KB.
    """

    active = False
    unconfirmed = False

    def end(self):
        pass


NO_WATCH = NoWatch()
