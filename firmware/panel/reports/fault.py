# SPDX-License-Identifier: MIT
"""The fault of a drive, and its warning: a status bit reports it, a parameter has its number.

In use:

    warning = DriveWarning(drive, mask, MM440)
    warning.step(now_us)                # again and again
    warning.number                      # 501 for A0501; 0 while it is not known
    warning.turn_to(other, MM3)         # another drive is shown

    fault = NO_FAULT                    # of a drive that has not tripped yet
    fault = Fault(drive, mask, MM440)   # has to be seen before it may be acknowledged
    fault.show(passed_ms)               # it was on the display for so long
    if fault.was_shown(): drive.acknowledge()
"""

from micropython import const

from panel import texts
from panel.reading import Reading
from uss import pkw, pzd
from uss.timing import elapsed

_SHOWN_MS = const(1_000)  # a STOP in the moment of the trip must not wipe its number away
_AGAIN_US = const(500_000)  # between two questions
_REFUSED_US = const(10_000_000)  # and after one that the drive does not answer


class Report:
    """drive: a `Drive`. mask: the clock's period - 1. bit: of ZSW. parameter: its index 0 has the
    number; None: nobody knows which has it. digits: of the number as it is shown, 0: as many as
    it has.

    active: the drive reports it now.
    """

    def __init__(self, drive, mask, bit, parameter, digits):
        self.digits = digits
        self._drive = drive
        self._mask = mask
        self._bit = bit
        self._parameter = parameter
        self._reading = Reading()
        self._asked_at_us = 0
        self._turn(False)

    def step(self, now_us):
        drive = self._drive
        if not (self.active or drive.zsw & self._bit):
            return  # as it mostly is
        active = drive.contact and drive.tells_status and drive.zsw & self._bit != 0
        if active != self.active:
            self._turn(active)
        if self._reading.asked:
            self._take()
        elif active:
            self._ask(now_us)  # again and again: there may be another one by now

    def _turn(self, active):
        """It comes or goes."""
        self.active = active
        self.number = 0
        self._wait_us = 0  # between the last question and the next
        self._reading.drop()

    def _ask(self, now_us):
        waited_us = elapsed(now_us, self._asked_at_us, self._mask)
        if self._parameter is None:
            return
        if waited_us >= self._wait_us and self._reading.ask(self._drive, self._parameter):
            self._asked_at_us = now_us
            self._wait_us = _AGAIN_US

    def _take(self):
        job = self._reading.take()
        if job is None:
            return
        if job.state in (pkw.REFUSED, pkw.UNANSWERED):
            self._wait_us = _REFUSED_US
        elif job.state == pkw.DONE:
            self.number = job.low


class DriveWarning(Report):
    """Of the drive that is shown."""

    def __init__(self, drive, mask, family):
        digits = _digits(family.fault_format)
        Report.__init__(self, drive, mask, pzd.ZSW_WARNING, family.warning_number, digits)

    def turn_to(self, drive, family):
        """It is about another drive from now on."""
        if self.active:
            self._turn(False)
        self._drive = drive
        self._parameter = family.warning_number
        self.digits = _digits(family.fault_format)


class Fault(Report):
    """It has to be seen before it may be acknowledged."""

    def __init__(self, drive, mask, family):
        digits = _digits(family.fault_format)
        Report.__init__(self, drive, mask, pzd.ZSW_FAULT, family.fault_number, digits)

    def show(self, passed_ms):
        """It was on the display for so long."""
        if self.active and self._shown_ms < _SHOWN_MS:
            self._shown_ms += passed_ms

    def was_shown(self):
        """Whether it has been on the display for a second since the drive tripped."""
        return self._shown_ms >= _SHOWN_MS

    def _turn(self, active):
        Report._turn(self, active)
        self._shown_ms = 0


class NoFault:
    """Stands for the `Fault` of a drive that has not tripped since the panel started.

    Most never do: with 31 drives that saves 3 KB.
    """

    active = False
    number = 0

    def step(self, now_us):
        pass

    def show(self, passed_ms):
        pass

    def was_shown(self):
        return False


NO_FAULT = NoFault()


def draw_number(screen, row, column, letter, report):
    """A letter and the number of a fault or a warning, once that is known."""
    if report.number:
        screen.put(row, column, 1, texts.of(letter))
        digits = report.digits or len(str(report.number))
        screen.digits(row, column + 1, digits, report.number)


def _digits(form):
    """How many digits a number has in a form such as F%04d; 0 where that is not said."""
    return int(form[3]) if form[2] == "0" else 0
