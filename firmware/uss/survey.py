# SPDX-License-Identifier: MIT
"""What must be known of a drive before it may be started, read from it again and again.

Works on the loop's side, through parameter jobs, which cost the bus nothing: every telegram has a
parameter channel. It reads the rows of `profiles.SURVEY` at once when contact is made and one
every REREAD_US from then on, so that a change made at the drive itself is noticed. What was known
is forgotten when contact is lost. `recheck` has all of it read again soon.

    survey = Survey(drive, clock.ticks_mask)
    survey.step(now)                # each step of the loop
    if survey.complete: survey.scaling.hsw(1000)
    survey.recheck()                # before a START; survey.unchecked counts down to 0
"""

from micropython import const

from uss import pkw, profiles, pzd
from uss.timing import elapsed

REREAD_US = const(200_000)
_UNKNOWN = const(-1)


class Survey:
    """drive: a `Drive`. mask: the clock's period - 1.

    values: for each row of profiles.SURVEY the number read, or _UNKNOWN.
    complete: all rows are known. scaling: a `pzd.Scaling`, or None while it is not known.
    unreadable: the drive refused one of them. version: counts the changes of all this.
    unchecked: how many rows `recheck` has still to read.
    """

    def __init__(self, drive, mask):
        self.drive = drive
        self.values = [_UNKNOWN] * len(profiles.SURVEY)
        self.complete = False
        self.scaling = None
        self.unreadable = False
        self.version = 0
        self.unchecked = 0
        self._mask = mask
        self._job = pkw.read(0)
        self._words = [_UNKNOWN] * (2 * len(profiles.SURVEY))  # as last read: high, low, high ...
        self._row = 0
        self._asked = False
        self._stale = False  # what was asked was asked too early to count
        self._changed = False  # what was read is new, and still to be judged
        self._read_at = 0
        self._contact = 0  # drive.contacts to which the values belong

    def lowest(self):
        """The lowest frequency of the drive, P1080, in centihertz. Once complete."""
        return self.values[profiles.LOWEST]

    def highest(self):
        """The highest frequency that can be had of it, in centihertz. Once complete."""
        return min(self.values[profiles.HIGHEST], self.scaling.limit_centihertz())

    def recheck(self):
        """Have every row read again soon: the drive gets more than its turn meanwhile."""
        self.unchecked = len(self.values)
        if self._changed:
            self._changed = False
            self._judge()
        self._row = 0
        self._stale = self._asked

    def drop_recheck(self):
        """Nobody waits for it any more."""
        self.unchecked = 0
        self.drive.want_turns(False)

    def step(self, now, reread_us=REREAD_US):
        """Take an answer that has come, ask for the next; allocates only when a value is new.

        reread_us: once all is known, a row is read again so long after the one before.
        """
        drive = self.drive
        if not drive.contact or drive.contacts != self._contact:
            self._forget()
            self._contact = drive.contacts
            self._stale = self._asked
        if self._changed:
            self.settle()
        elif self._asked:
            if self._job.state != pkw.PENDING:
                self._asked = False
                self._read_at = now
                if not self._stale:
                    self._take()
                self._stale = False
        elif drive.contact:
            in_a_hurry = self.unchecked or not self.complete
            if in_a_hurry or elapsed(now, self._read_at, self._mask) >= reread_us:
                self._ask(drive.channel)
        if self.unchecked or drive.asking:
            drive.want_turns(self.unchecked > 0)

    def settle(self):
        """Find out what a value that is new amounts to; else the next step begins with it, because
        it takes long.
        """
        if self._changed:
            self._changed = False
            self._judge()
            self._go_on()

    def _forget(self):
        self.unchecked = 0
        changed, self._changed = self._changed, False
        if not (self.complete or self._row or self.unreadable or changed):
            return
        self.complete = False
        self.scaling = None
        self.unreadable = False
        self.version += 1
        self._row = 0
        for row in range(len(self.values)):
            self.values[row] = _UNKNOWN
            self._words[2 * row] = _UNKNOWN

    def _ask(self, channel):
        if channel.is_full():
            return  # others ask as well: later
        number, index, _ = profiles.SURVEY[self._row]
        self._job.aim(pkw.READ, number, index)
        channel.ask(self._job)
        self._asked = True

    def _take(self):
        job = self._job
        row = self._row
        kind = profiles.SURVEY[row][2]
        if job.state != pkw.DONE:
            self.values[row] = _UNKNOWN
            self._words[2 * row] = _UNKNOWN
            self.unreadable = job.state == pkw.REFUSED
            self._changed = True
        elif job.high != self._words[2 * row] or job.low != self._words[2 * row + 1]:
            self._words[2 * row] = job.high
            self._words[2 * row + 1] = job.low
            if kind == profiles.CENTIHERTZ:
                self.values[row] = _centihertz(job.float_value())
            else:
                self.values[row] = job.low
            self._changed = True
        else:
            self._go_on()

    def _go_on(self):
        """This row is done with."""
        if self.unchecked:
            self.unchecked -= 1
        self._row = self._row + 1 if self._row + 1 < len(profiles.SURVEY) else 0

    def _judge(self):
        """What the values amount to, after one of them changed."""
        values = self.values
        self.version += 1
        self.complete = _UNKNOWN not in values
        reference, absolute = values[profiles.REFERENCE], values[profiles.ABSOLUTE]
        if reference < pzd.REFERENCE_MIN or absolute == _UNKNOWN:
            self.complete = False
            self.scaling = None
        elif (
            self.scaling is None
            or self.scaling.reference_centihertz != reference
            or self.scaling.absolute != bool(absolute)
        ):
            self.scaling = pzd.Scaling(reference, bool(absolute))
        if self.complete:
            self.unreadable = False


def _centihertz(hertz):
    """A frequency as an integer in 0.01 Hz; _UNKNOWN when it is none that a drive can have."""
    if not 0 <= hertz <= 650:  # also true of a NaN, which compares with nothing
        return _UNKNOWN
    return int(hertz * 100 + 0.5)
