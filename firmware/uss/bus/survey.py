# SPDX-License-Identifier: MIT
"""What a drive tells of itself: who may command it, what 100 % is, how fast it may turn.

`bus` asks before a start, and when you want a speed in Hz or 1/min. It reads the rows of the
family's survey, one value each; `families.rows` judges them. It keeps nothing over a loss of
contact, because another drive may answer afterwards. The panel uses `uss.survey` instead, which
never waits.

    survey = Survey(drive, None)
    survey.ask()                        # waits
    survey.obstacle(True, False)        # None, or why it must not be started, in words
    survey.setpoint(25.0, None, None)
"""

from uss import families, pkw
from uss.families import rows
from uss.families.rows import ACTUAL, COMMAND, RIGHT, SETPOINT, STATUS, UNKNOWN
from uss.pkw import NO_INDEX, NO_PARAMETER
from uss.pzd import FULL_SCALE
from uss.scaling import CENTIHERTZ_PER_HERTZ, Scale, pole_pairs

TOLERANCE = 1.001  # a limit rounded to a word of PZD2 must not count as beyond itself

FIRST = (rows.COMMAND_SET, rows.DRIVE_SET, rows.ABSOLUTE)  # the other rows depend on these
LEFT_OUT = (rows.RESTART, rows.COUNTER)  # `bus` does not need these
_ABSENT = (NO_PARAMETER, NO_INDEX)  # the drive has no such parameter

# What to say of a drive in which a row of the subject is wrong.
WRONGS = {
    COMMAND: "is not under USS control",
    SETPOINT: "is not under USS control",
    STATUS: "does not send its status word",
    ACTUAL: "does not send its actual speed",
}


class Survey:
    """drive: a `bus.Drive`. scale: a `scaling.Scale` that the program knows, or None; what the
    drive tells goes before it.

    values: what was read for each row of the family's survey, UNKNOWN if it is not known. scale:
    None as long as it is not known. told_off_time_ms: the telegram-off time that the program says
    of a drive that does not tell it, None as long as it has said nothing.
    """

    def __init__(self, drive, scale):
        self.scale = scale
        self.values = [UNKNOWN] * rows.COUNT_OF_ROWS
        self.told_off_time_ms = None
        self._told_scale = scale
        self._wrong = rows.NOTHING_WRONG  # as far as is known
        self._is_fine = False  # a word that holds a frequency counts in 0.01 Hz
        self._drive = drive
        self._contact = None  # `contacts` of the drive when it was asked

    def ask(self):
        """Read all that is needed. Waits; NoContact, Refused, TimedOut."""
        drive = self._drive
        survey = drive.family.survey
        self.forget()
        self.values = [UNKNOWN] * len(survey)
        if drive.layout.pkw_words:
            asked = [row for row in range(len(survey)) if survey[row] and row not in LEFT_OUT]
            self._read([row for row in asked if row in FIRST])
            self._is_fine = self.values[rows.ABSOLUTE] > 0
            self._read([row for row in asked if row not in FIRST])
        self._wrong = rows.wrong_rows(drive.family.meaning, self.values)
        self.scale = self._scale()
        self._tell_speed()
        self._contact = drive.engine.contacts

    def forget(self):
        """A setting may have changed: ask anew when it is needed."""
        self._contact = None

    def off_time_ms(self):
        """The drive's telegram-off time; None if neither the drive nor the program tells it."""
        value = self.values[rows.SUPERVISION]
        if value == UNKNOWN:
            return self.told_off_time_ms
        return round(value * self._drive.family.off_time_unit_ms)

    def obstacle(self, needs_setpoint, unsupervised):
        """Why the drive must not be started as it is set up, in words; None if it may be.

        needs_setpoint: the speed comes from this bus. unsupervised: the drive may run although it
        would not notice the end of the telegrams.
        """
        wrong = self.what_is_wrong(COMMAND) or needs_setpoint and self.what_is_wrong(SETPOINT)
        if wrong:
            return wrong
        if needs_setpoint and self.scale is None:
            return "cannot tell what 100 % is: add it to the bus with scale=Scale(...)"
        if unsupervised or self.off_time_ms():
            return None
        if self.values[rows.SUPERVISION] == UNKNOWN:
            return (
                "may run on if this program died: it does not tell its telegram-off time. "
                "bus.supervise(drive, 2000) says that it has one of 2000 ms; or add it to the bus "
                "with unsupervised=True"
            )
        return (
            "would run on if this program died: %s = 0. supervise(2.0) changes that; or add "
            "it to the bus with unsupervised=True" % self._name(rows.SUPERVISION)
        )

    def what_is_wrong(self, subject):
        """What is wrong with the drive by a row of this subject, in words; None if nothing is."""
        row = self._wrong[subject]
        if row == RIGHT:
            return None
        family, found = self._drive.family, self.values[row]
        wanted = [rule[3][0] for rule in family.meaning if rule[:2] == (subject, row)][0]
        if family.survey[row][2] == rows.SOURCE:
            found, wanted = ["%d:%d" % (value >> 16, value & 0xFFFF) for value in (found, wanted)]
        return "%s: %s = %s, not %s" % (WRONGS[subject], self._name(row), found, wanted)

    # --- speeds ---------------------------------------------------------------------------------

    def setpoint(self, hertz, percent, rpm):
        """The setpoint word, 0...FFFFh with its sign, for the one of the three that is not None.

        ValueError if it is beyond the drive's limits, or the drive does not tell enough for this
        unit.
        """
        if hertz is not None:
            word = self.hertz_scale().from_hertz(hertz)
        elif rpm is not None:
            word = self.rpm_scale().from_rpm(rpm)
        else:
            word = self.known_scale().from_percent(percent)
        for row in (rows.LOWEST, rows.HIGHEST):
            if self.values[row] != UNKNOWN:
                self._check_limit(row, self.values[row], word)
        return word

    def known_scale(self):
        """The scale; asks the drive if need be. ValueError if the drive cannot tell it."""
        if self._contact != self._drive.engine.contacts:
            self.ask()
        if self.scale is None:
            raise ValueError("drive %d cannot tell what 100 %% is" % self._drive.address)
        return self.scale

    def hertz_scale(self):
        """The scale, with its reference in Hz if the drive tells enough for that."""
        scale = self.known_scale()
        return self._with_motor(scale) if scale.reference_hertz is None else scale

    def rpm_scale(self):
        """The scale, with its reference in 1/min if the drive tells enough for that."""
        scale = self.known_scale()
        return self._with_motor(scale) if scale.reference_rpm is None else scale

    def _read(self, asked):
        """Read these rows. The next job is queued while one is on the line."""
        drive, before = self._drive, None
        for row in asked:
            job = drive.begin(drive.addressed(pkw.read(*self._place(row))))
            job.tag = row
            if before:
                self._take(before)
            before = job
        if before:
            self._take(before)

    def _take(self, job):
        """Wait for the job; keep its answer, or the default of a drive without the parameter."""
        row = job.tag
        self._drive.finish(job)
        _, _, kind, missing = self._drive.family.survey[row]
        if row == rows.SUPERVISION:
            missing = None  # the program may tell it
        error = job.error if job.state == pkw.REFUSED else None
        if job.state == pkw.DONE:
            self.values[row] = families.value(job, kind, self._is_fine)
        elif missing is not None and (job.state == pkw.UNANSWERED or error in _ABSENT):
            self.values[row] = missing
        elif error != NO_PARAMETER:
            self._drive.raise_unless_done(job)

    def _place(self, row):
        """The parameter number and the index of a row."""
        asked = self._drive.family.survey[row]
        return asked[0], rows.index_of(asked, self.values)

    def _scale(self):
        """The scale that the drive tells, else the one that was told, else None."""
        scale = self._own_scale()
        tells = scale is not None and (scale.reference_hertz or scale.reference_rpm)
        return scale if tells or self._told_scale is None else self._told_scale

    def _tell_speed(self):
        """Tell the engine what 100 % of the actual value is, if HIW tells the speed."""
        drive, scale = self._drive, self.scale
        if scale is not None and drive.family.hiw_is_signed:
            is_hertz = scale.absolute and scale.reference_hertz
            full = scale.reference_hertz * CENTIHERTZ_PER_HERTZ if is_hertz else FULL_SCALE
            drive.engine.tell_speed(0 if self.what_is_wrong(ACTUAL) else round(full))

    def _own_scale(self):
        """The scale by the values that were read; None if one that decides it is unknown."""
        family = self._drive.family
        values = self.values
        if family.survey[rows.ABSOLUTE] and values[rows.ABSOLUTE] == UNKNOWN:
            return None
        absolute = values[rows.ABSOLUTE] == family.absolute_value
        reference = values[rows.REFERENCE]
        if reference == UNKNOWN:
            return Scale(absolute=absolute)
        if family.survey[rows.REFERENCE][2] == rows.RPM:
            return Scale(reference_rpm=reference, absolute=absolute)
        return Scale(reference_hertz=reference, absolute=absolute)

    def _with_motor(self, scale):
        """The scale with both references: the motor's rating converts one to the other."""
        drive = self._drive
        if not drive.family.motor or not drive.layout.pkw_words:
            return scale
        frequency, speed = drive.family.motor
        kind = drive.family.survey[rows.REFERENCE][2]  # its other frequencies are of this kind
        rated_hertz = families.value(drive.do(pkw.read(frequency)), kind, self._is_fine)
        pairs = pole_pairs(rated_hertz, drive.read(speed))
        self.scale = Scale(scale.reference_hertz, scale.reference_rpm, pairs, scale.absolute)
        return self.scale

    def _check_limit(self, row, limit, word):
        if self._drive.family.survey[row][2] == rows.RPM:
            speed, unit = abs(self.scale.rpm(word)), "1/min"
        else:
            speed, unit = abs(self.scale.hertz(word)), "Hz"
        if row == rows.LOWEST:
            is_beyond = speed * TOLERANCE < limit
        else:
            is_beyond = speed > limit * TOLERANCE
        if is_beyond:
            raise ValueError(
                "%.2f %s is beyond the limit of drive %d: %s = %.2f %s"
                % (speed, unit, self._drive.address, self._name(row), limit, unit)
            )

    def _name(self, row):
        return pkw.name(*self._place(row))
