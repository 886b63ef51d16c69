# SPDX-License-Identifier: MIT
"""What must be known of a drive before it may be started, read from it again and again.

The loop reads it through parameter jobs, which cost the bus nothing: every telegram has a
parameter channel. A `Survey` reads all rows of the family's survey when contact is made, and one
every REREAD_US from then on, so that it notices a change made at the drive itself. It forgets
everything when contact is lost. After `recheck` it reads all rows again soon.

    survey = Survey(drive, MM4, clock.ticks_mask, spare_jobs())
    survey.step(now_us)             # each step of the loop
    if survey.complete: survey.scaling.hsw(1000)
    survey.recheck()                # before a START; survey.unchecked counts down to 0
"""

from micropython import const

# Lower layers first: an import inside an import inside an import takes stack.
from uss.timing import elapsed
from uss import pkw, pzd
from uss.families import rows
from uss.families.rows import RPM, STEPS
import uss.drive  # noqa: F401
from uss.telegram_count import TelegramCount

REREAD_US = const(100_000)
_UNKNOWN = const(-1)
_SPARES = const(4)  # a list of four is never resized, so taking from it takes no memory
_NOTHING = const(-1)  # no row
_ALL = rows.COUNT_OF_ROWS  # in place of a row: all have been forgotten

# The coded exponents of the frequencies that a drive can have, as floating-point singles, from the
# first that is not 0.00 Hz to the largest.
_EXPONENT_MIN = const(119)  # 2**-8 Hz and more
_EXPONENT_MAX = const(136)  # less than 2**10 Hz
_MANTISSA_BITS = const(148)  # mantissa * 25 >> 148 - exponent is in 0.01 Hz
_CENTI = const(100)
_CENTIHERTZ_MAX = const(65_000)

# The same of speeds, from 0.5 1/min to 2**18: mantissa >> 150 - exponent is in 1/min.
_RPM_EXPONENT_MIN = const(126)
_RPM_EXPONENT_MAX = const(144)
_RPM_BITS = const(150)
_RPM_MAX = const(210_000)  # p2000 of a G120

# A drive that does not tell its reference, or tells it in 1/min, is shown in percent: then
# hundredths of a percent stand wherever there are hundredths of a hertz.
_HUNDRED_PERCENT = const(10_000)
_OF_A_WORD = (rows.WORD, STEPS, rows.COUNT)
_NOTHING_ASKED = (None,) * rows.COUNT_OF_ROWS

_ODD_MAX = const(2)  # answers in a row that make no sense: perhaps it has another layout
_UNANSWERED_MAX = const(2)  # then the row counts as missing, and is read only before a START
_ABSENT = (pkw.NO_PARAMETER, pkw.NO_INDEX)  # the drive has no such parameter
_FIRST = rows.COMMAND_SET  # a round begins with it, because it tells the indices of others
_LATER = (rows.RESTART, rows.COUNTER)  # only START needs them, and has them read
_BLANK = [0 if row in _LATER else _UNKNOWN for row in range(rows.COUNT_OF_ROWS)]
_WATCHED = (rows.COUNTER, rows.LOWEST, rows.HIGHEST)  # read more often while it runs


def spare_jobs():
    """Second jobs for surveys that ask a lot: those of drives that are shown, or were just now.

    With a second job every telegram carries a question while the operator waits for the answers. A
    second job for each survey would waste memory.
    """
    return [pkw.read(0) for _ in range(_SPARES)]


class Survey:
    """drive: a `Drive`. family: the drive's, of `families`. mask: the clock's period - 1. spares:
    `spare_jobs()`, shared by several surveys.

    values: for each row of family.survey the number read, or rows.UNKNOWN; 0 for _LATER until they
    are read.
    complete: all rows are known. scaling: a `pzd.Scaling` of the setpoint, or None while it is not
    known; actual: that of HIW, or None while it is not known that HIW tells the frequency.
    wrong: for each subject of family.meaning the row that is known and wrong, or RIGHT.
    unreadable: the drive refused one of them, or fell silent on it. version: counts the changes
    of all this.
    unchecked: how many rows `recheck` has still to read.
    count: the `TelegramCount`; None before the first START, because most drives need none.

    Only the survey writes its fields.
    """

    latest_scaling = None  # the newest of any drive: most drives of a bus have the same, shared

    # Most drives never need these: each takes memory of its own when it first differs.
    wrong = rows.NOTHING_WRONG
    unreadable = False
    unchecked = 0
    count = None
    _turn = 0  # counts while it runs: rows of the round and of _WATCHED take turns
    _asked_next = None  # the job on its way behind `_asked`
    _unanswered = None  # by row: how often the drive fell silent on it
    _odd = 0  # answers in a row that make no sense

    def __init__(self, drive, family, mask, spares):
        self.drive = drive
        self.family = family
        self.values = _BLANK[:]  # a list that is made like this has no room to grow
        self.complete = False
        self.scaling = None
        self.actual = None
        self.version = 0
        self._mask = mask
        self._job = pkw.read(0)  # the survey's own job; a second one comes from the spares
        self._spares = spares
        self._asked = None  # the job on its way that was asked first
        self._row = _FIRST  # the next row of the round
        self._changed = _NOTHING  # the row whose value is new and not judged yet, or _ALL
        self._read_at_us = 0
        self._contact = 0  # the values belong to this drive.contacts; 0 without contact
        self._asks = self._askable()  # the rows that are read

    def is_percent(self):
        """Whether frequencies of this drive are in percent, see _HUNDRED_PERCENT."""
        reference = self._asks[rows.REFERENCE]
        return reference is None or reference[2] == RPM

    def lowest(self):
        """The lowest frequency of the drive, P1080, in centihertz. Only when complete."""
        return self._limit(rows.LOWEST, 0)

    def highest(self):
        """The highest frequency of the drive, in centihertz. Only when complete."""
        return min(self.own_highest(), self.scaling.limit_centihertz())

    def own_highest(self):
        """The same, although no telegram may be able to say it."""
        return self._limit(rows.HIGHEST, _CENTIHERTZ_MAX)

    def off_time_ms(self):
        """The drive's telegram-off time; 0 if it does not tell one."""
        return max(self.values[rows.SUPERVISION], 0) * self.family.off_time_unit_ms

    def recheck(self):
        """Read every row again soon; the drive gets more than its turn meanwhile."""
        if self.drive.contact:
            self.unchecked = self._count_asked()
        if self.count:
            self.count.is_told = True
        self.settle()
        self._row = _FIRST
        self._disown()

    def count_anew(self):
        """Count telegrams anew: after the next count, one that lacks telegrams means a reset."""
        self._turn = self._turn  # a field that is made now takes no memory when the motor runs
        if self.count is None:
            self.count = TelegramCount(self.drive)
        else:
            self.count.begin()

    def has_restarted(self):
        """Whether the drive was without its mains while it was wanted to run. True only once."""
        return self.count is not None and self.count.take_restart()

    def drop_recheck(self):
        """Give up the recheck: the operator does not wait for it any more."""
        self._check_no_more()
        self.drive.want_turns(False)

    def step(self, now_us, reread_us=REREAD_US):
        """Take an answer that has come, ask for the next; allocates only when a value is new.

        reread_us: once all rows are known, the time from one reread row to the next.
        """
        drive = self.drive
        contact = drive.contacts if drive.contact else 0
        if contact != self._contact:
            self._contact = contact
            self._forget()  # nothing else in this step: this takes long enough
            if contact and reread_us == REREAD_US:  # the drive is shown: the operator waits
                self.unchecked = self._count_asked()
        elif self._changed != _NOTHING:
            self.settle()
        elif self._asked and self._asked.state != pkw.PENDING:
            self._read_at_us = now_us
            self._take()
        elif self._is_due(now_us, reread_us):
            self._ask(drive.channel)
        if self.unchecked or drive.asking:
            drive.want_turns(self.unchecked > 0)

    def is_settled(self):
        """Whether all that was read has been judged."""
        return self._changed == _NOTHING

    def settle(self):
        """Judge a new value now; otherwise the next step does, as it takes long."""
        row, self._changed = self._changed, _NOTHING
        if row == _NOTHING:
            return
        if row == rows.REFERENCE or row == rows.ABSOLUTE:
            self._judge_scaling()
        else:
            self._judge_meaning()
            if self.scaling is None and self._contact:
                self._judge_scaling()  # another data set has made it unknown
        self._judge()

    def _check_no_more(self):
        if self.unchecked:
            self.unchecked = 0

    def _forget(self):
        self._check_no_more()
        self._row = _FIRST
        self._disown()
        if self.count:
            self.count.forget()
        if self._unanswered:
            self._unanswered = None
        known = self.unreadable or self.complete or self._changed != _NOTHING
        self._changed = _NOTHING
        if self.values != _BLANK:
            known = True
            self.values[:] = _BLANK
        self._asks = self._askable()  # another layout, perhaps
        if known or self.is_percent():
            self.scaling = None
            self.complete = False  # at once, as in `_make_unknown`
            self._note_readable()
            self._changed = _ALL

    def _askable(self):
        """The rows that the drive can be asked for: three PKW words carry no double word."""
        survey, pkw_words = self.family.survey, self.drive.layout.pkw_words
        if not pkw_words or survey[rows.REFERENCE] is None:
            return _NOTHING_ASKED
        if pkw_words == 3 and survey[rows.REFERENCE][2] != STEPS:
            return tuple([row if row and row[2] in _OF_A_WORD else None for row in survey])
        return survey

    def _is_due(self, now_us, reread_us):
        """Whether to ask for a row now."""
        asked = self._asked
        if self._asked_next or not self.drive.contact or self._asks is _NOTHING_ASKED:
            return False
        if asked is self._job and not self._spares:
            return False
        if self.unchecked > (asked is not None) or not self.complete:
            return True
        return not asked and elapsed(now_us, self._read_at_us, self._mask) >= reread_us

    # --- questions and answers ------------------------------------------------------------------

    def _ask(self, channel):
        if channel.is_full():
            return  # the queue is full, because others ask too: try later
        row = self._next_row()
        wanted = self._asks[row]
        job = self._spares.pop() if self._asked is self._job else self._job
        job.aim(pkw.READ, wanted[0], rows.index_of(wanted, self.values))
        job.tag = row
        if row == rows.COUNTER and self.count:
            self.count.asked()
        channel.ask(job)
        if self._asked:
            self._asked_next = job
        else:
            self._asked = job

    def _disown(self):
        """Ignore the answers on their way: they were asked for too early to count."""
        if self._asked:
            self._asked.tag = _NOTHING
        if self._asked_next:
            self._asked_next.tag = _NOTHING

    def _next_row(self):
        """Go on with the round; while the drive runs, every other row is one of _WATCHED."""
        if self.drive.wanted and self.complete and not self.unchecked:
            self._turn = (self._turn + 1) % (2 * len(_WATCHED))
            if self._turn & 1:
                row = _WATCHED[self._turn >> 1]
                if row == rows.COUNTER and self.count is not None and not self.count.is_told:
                    self._turn += 2
                    row = _WATCHED[self._turn >> 1]
                if self._asks[row] is not None:
                    return row
        row = self._row
        while self._asks[row] is None or not self.unchecked and self._is_left_out(row):
            row = (row + 1) % len(self.values)
        self._row = (row + 1) % len(self.values)
        return row

    def _is_left_out(self, row):
        """Whether the round leaves the row out: only START needs it, or it is in _WATCHED."""
        missing = self._asks[row][3]
        if self._is_unanswered(row) and self.values[row] == missing:
            return True
        if row in _LATER:
            return self.values[row] != _UNKNOWN
        return self.drive.wanted != 0 and self.complete and row in _WATCHED

    def _is_unanswered(self, row):
        """Whether the drive has fallen silent on the row so often that it seems to lack it."""
        return self._unanswered is not None and self._unanswered[row] == _UNANSWERED_MAX

    def _take(self):
        """Take the answer to the question that was asked first."""
        job = self._asked
        row = job.tag
        if job is not self._job:
            self._spares.append(job)
        self._asked = self._asked_next
        if self._asked:
            self._asked_next = None
        if row == _NOTHING:
            return
        if self.unchecked:
            self.unchecked -= 1
        if job.state != pkw.DONE:
            self._take_refusal(job, row)
            return
        if self._unanswered:
            self._unanswered[row] = 0
        if job.high and job.width == pkw.WORD:
            self._wonder(1)  # there is no high word: what stands there is something else
        elif self._odd:
            self._odd = 0
        kind = self._asks[row][2]
        if kind == rows.COUNT:
            before, self.values[row] = self.values[row], job.low
            if self.count:
                self.count.take(before, job.low)
            return
        value = job.low
        if kind == rows.CENTIHERTZ:
            value = centihertz(job.high, value)
        elif kind == rows.SOURCE:
            value = rows.source(job.high, value)
        elif kind == RPM:
            value = rpm(job.high, value)
        elif kind == STEPS:
            value = self._from_steps(value)
        elif value > pkw.INDEX_MAX and (row == rows.COMMAND_SET or row == rows.DRIVE_SET):
            value = _UNKNOWN  # no data set has this number
        if value != self.values[row] or value == _UNKNOWN:
            self._put(row, value)

    def _wonder(self, weight):
        """Whether its answers make sense, as long as not everything is known."""
        self._odd += weight
        if self._odd >= _ODD_MAX and not (self.complete or self.drive.doubted):
            self._odd = 0
            self.drive.doubt()

    def _take_refusal(self, job, row):
        value = _UNKNOWN
        if job.state == pkw.REFUSED and job.error == pkw.TOO_SMALL:
            self._wonder(_ODD_MAX)  # any length has room for it: it has none
        elif job.state == pkw.TIMED_OUT and not self.drive.silent:
            self._wonder(1)
        if row == rows.COUNTER:
            if job.state == pkw.TIMED_OUT:
                return  # the line was bad; the next count tells as much
            if self.count:
                self.count.is_told = False
        is_absent = job.state == pkw.REFUSED and job.error in _ABSENT
        if job.state == pkw.UNANSWERED:
            self._unanswered = self._unanswered or bytearray(len(self.values))
            self._unanswered[row] = min(self._unanswered[row] + 1, _UNANSWERED_MAX)
            is_absent = self._is_unanswered(row)
            if not is_absent and self.drive.asking:  # ask again while it has more than its turn:
                self.unchecked = self._count_asked()  # in turns of a long list it would be lost
        if is_absent or row in _LATER and job.state != pkw.TIMED_OUT:
            value = self._asks[row][3]
        if value is None or value == _UNKNOWN:
            value = _UNKNOWN
            self.unreadable = job.state == pkw.REFUSED or job.state == pkw.UNANSWERED
        if self.values[row] != value or value == _UNKNOWN:
            self._put(row, value)

    def _put(self, row, value):
        """Keep a new value, to be judged later. Another data set makes other values unknown."""
        self.values[row] = value
        self._changed = row
        if row == rows.COMMAND_SET or row == rows.DRIVE_SET:
            self._make_unknown(1, (rows.BY_COMMAND_SET, rows.BY_DRIVE_SET))
        elif row == rows.ABSOLUTE:
            self._make_unknown(2, (STEPS,))

    def _make_unknown(self, place, meant):
        """The values of the rows that have one of these in this place."""
        for row in range(len(self.values)):
            asked = self._asks[row]
            if asked is not None and asked[place] in meant:
                self.values[row] = _UNKNOWN
                self.scaling = None
                self.complete = False  # at once, so that nothing uses what is not judged yet

    def _from_steps(self, value):
        """0.01 Hz of a frequency in steps whose size the row ABSOLUTE tells."""
        absolute = self.values[rows.ABSOLUTE]
        if absolute == _UNKNOWN:
            return _UNKNOWN  # it is asked for again
        return value if absolute else value * 10

    # --- what it amounts to ---------------------------------------------------------------------

    def _judge(self):
        """Judge all values together, after one of them changed."""
        self.version += 1
        tells = not self._is_missing(rows.ACTUAL_SENT) and self.wrong[rows.ACTUAL] == rows.RIGHT
        self.actual = self.scaling if tells else None
        self.complete = self.scaling is not None and not self._lacks_any()
        if self.complete:
            self._note_readable()
            has_sign = tells and self.family.hiw_is_signed
            self.drive.tell_speed(self.scaling.full_scale() if has_sign else 0)

    def _judge_meaning(self):
        wrong = rows.wrong_rows(self.family.meaning, self.values)
        if wrong is not self.wrong:
            self.wrong = wrong

    def _note_readable(self):
        if self.unreadable:
            self.unreadable = False

    def _lacks_any(self):
        values, asks = self.values, self._asks  # found once: a field takes long to look up
        for row in range(len(values)):
            if values[row] == _UNKNOWN and asks[row] is not None:
                return True
        return False

    def _is_missing(self, row):
        """Whether a value is still to be told."""
        return self.values[row] == _UNKNOWN and self._asks[row] is not None

    def _judge_scaling(self):
        """The scaling, made once for all drives that have the same."""
        reference = self.values[rows.REFERENCE]
        is_absolute = self.values[rows.ABSOLUTE] == self.family.absolute_value
        if self._is_missing(rows.REFERENCE) or self._is_missing(rows.ABSOLUTE):
            reference = 0
        elif self.is_percent():
            reference = _HUNDRED_PERCENT if reference and not is_absolute else 0
            if is_absolute:
                self.unreadable = True
        if reference < pzd.REFERENCE_MIN:
            self.scaling = None
            self.complete = False  # at once, as in `_make_unknown`
        elif self.scaling is None or not self.scaling.is_of(reference, is_absolute):
            latest = Survey.latest_scaling
            if latest is None or not latest.is_of(reference, is_absolute):
                Survey.latest_scaling = latest = pzd.Scaling(reference, is_absolute)
            self.scaling = latest

    def _limit(self, row, missing):
        """A frequency that the drive has told, or what stands for it."""
        value = self.values[row]
        if value == _UNKNOWN:
            return missing
        if self._asks[row][2] == RPM:
            return value * _HUNDRED_PERCENT // self.values[rows.REFERENCE]
        return value

    def _count_asked(self):
        return len(self._asks) - self._asks.count(None)


def centihertz(high, low):
    """Convert an IEEE-754 single in hertz, two words, to 0.01 Hz; -1 if a drive cannot have this
    frequency. This uses no floating-point number, which would take memory each time.
    """
    exponent = high >> 7  # with the sign
    if exponent > _EXPONENT_MAX:
        return 0 if high == 0x8000 and not low else _UNKNOWN  # minus nothing
    if exponent < _EXPONENT_MIN:
        return 0
    shift = _MANTISSA_BITS - exponent
    mantissa = (0x80 | high & 0x7F) << 16 | low
    value = (mantissa * (_CENTI >> 2) + (1 << shift - 1)) >> shift
    return value if value <= _CENTIHERTZ_MAX else _UNKNOWN


def rpm(high, low):
    """Convert an IEEE-754 single in 1/min, two words, to whole 1/min, rounded; -1 if a drive
    cannot have this speed. As `centihertz`, without a floating-point number.
    """
    exponent = high >> 7
    if exponent > _RPM_EXPONENT_MAX:
        return 0 if high == 0x8000 and not low else _UNKNOWN
    if exponent < _RPM_EXPONENT_MIN:
        return 0
    shift = _RPM_BITS - exponent
    mantissa = (0x80 | high & 0x7F) << 16 | low
    value = (mantissa + (1 << shift - 1)) >> shift
    return value if value <= _RPM_MAX else _UNKNOWN
