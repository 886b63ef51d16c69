# SPDX-License-Identifier: MIT
"""A START or a JOG that was obeyed: when that was, how things stood, and what took it back.

In use:

    command = Command(drive, survey, desk)
    command.give(now_us, bus.dead_man_trips)        # the key was obeyed, each time
    command.settle_in()                     # once, before anything that follows
    command.send(now_us)                    # ON goes out from now on
    notice = command.why_in_vain(jogs, now_us)  # again and again while it is sent, or NOTHING
    notice = command.why_stopped()          # the engine has taken it back
"""

from micropython import const

from panel import permits, risks, texts
from uss import pzd
from uss.timing import elapsed

_NONE = const(-1)  # no version
_START_US = const(5_000_000)  # a drive that does not run by then is told to stop again
# START is given up if ON has not been sent by then, and in so many of the longest rounds of the
# list: 17 questions take a drive 10 s at 1200 baud, and 23 s where eight are asked.
_CHECK_US = const(12_000_000)
_CHECK_ROUNDS = const(10)


class Command:
    """drive: `uss.drive.Drive`. survey: its `Survey`. desk: the `Desk` of its control.
    dead_man_trips: those of the bus when the key was pressed.

    `Control` writes these fields, and the command only sets `risk` back: risk, the row of
    risks.RISKS that a START is to be asked about next; question, that it was asked about last;
    accepted, by row the value with which the operator takes that risk; exposure_ms, how long the
    motor would run on too long, when it was started; exposure_version, of the survey when that was
    looked at last. Nobody but the command writes the others.
    """

    accepted = (risks.NONE,) * len(risks.RISKS)

    def __init__(self, drive, survey, desk):
        self._drive = drive
        self._survey = survey
        self._bus = desk.bus
        self._mask = desk.mask

    def settle_in(self):
        """Make the other fields. Each takes memory, and to find it takes a chip so long that they
        are shared out among turns; but no field is made while a motor runs."""
        if self.accepted is Command.accepted:
            self.accepted = list(Command.accepted)
            self.question = 0
            self.exposure_ms = 0
            self.exposure_version = _NONE
            self._version = _NONE  # of the survey, as judged last
            self._is_local = False  # commands, and setpoints, come from elsewhere
            self._is_foreign = False

    def give(self, now_us, dead_man_trips):
        self.risk = 0
        self._contacts = self._drive.contacts
        self._dead_man_trips = dead_man_trips
        self._failures = self._bus.failures
        self.send(now_us)

    def send(self, now_us):
        self._since_us = now_us
        self._ran = False

    def is_stale(self):
        """Whether the loop has hung since it was given: too old to be obeyed."""
        return self._bus.dead_man_trips != self._dead_man_trips

    def is_overdue(self, now_us):
        """Whether whoever pressed START expects no motor to turn any more. The drive lags, or many
        others are asked, or the loop is slow: all that is looked at before ON took too long.
        """
        most_us = self._mask >> 2  # a clock of a short period cannot tell more than half of it
        waited_us = elapsed(now_us, self._since_us, self._mask)
        if waited_us < min(_CHECK_US, most_us):
            return False
        return waited_us >= min(_CHECK_ROUNDS * self._bus.turns.longest_cycle_us(), most_us)

    def why_stopped(self):
        """What made the engine take it back, as a notice."""
        drive, bus = self._drive, self._bus
        if not drive.contact or drive.contacts != self._contacts:
            return texts.LINE_FAILED
        if self.is_stale():
            return texts.PANEL_HUNG
        if bus.failures != self._failures:
            return texts.ENGINE_FAILED
        return texts.STOPPED_ITSELF

    def has_judged(self):
        """Whether `why_in_vain` has judged all that is known of the drive."""
        return self._survey.version == self._version

    def why_in_vain(self, jogs, now_us):
        """Why it has to be taken back, as a notice, or NOTHING. jogs: no setpoint matters.

        ON that leads to nothing must not take effect minutes later; nor may one to a drive that
        listens to somebody else by now.
        """
        survey = self._survey
        if survey.version != self._version:  # else there is nothing new to judge
            self._version = survey.version
            self._is_local = permits.is_local(survey) or permits.tells_no_status(survey)
            self._is_foreign = permits.is_foreign(survey)
        if self._is_local or self._is_foreign and not jogs:
            return texts.TAKEN_AWAY
        if not self._ran:
            if self._drive.state() == pzd.RUNNING:
                self._ran = True
            elif elapsed(now_us, self._since_us, self._mask) >= _START_US:
                return texts.DID_NOT_START
        return texts.NOTHING
