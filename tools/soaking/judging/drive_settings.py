# SPDX-License-Identifier: MIT
"""The settings of a drive, its earlier ones, and how long the panel may still use those.

The panel reads settings again and again (rules 6 and 17 of its promises). That takes time, and
replies of the drive: old values are allowed until enough of both have passed.

    settings = Settings(drive, kind)
    settings.note(now, replies)             # they may have changed; replies: of the drive so far
    for values in settings.in_force(since_us, replies): ...     # those that the panel may use
"""

from tools.soaking.judging.facts import ALWAYS
from tools.soaking.judging.families import G120, LINKED, MM3, RPM_PER_HZ, SPEEDS

KEPT = 8  # values that were replaced
HIGHEST_HZ = 650  # that any drive may have
PERCENT = 100  # 4000h, where nobody knows what that is in hertz


class Values:
    """The settings that a run of a drive uses, at one time, as the panel can know them.

    Frequencies are in Hz, or in percent where the panel knows no hertz: `is_percent`. What it
    cannot read is as if the drive had none.

    tells_speed: HIW is its frequency, as far as the panel knows. off_time_us: P2014, 0: it never
    trips. full_hz: 4000h in truth. shows_speed: so HIW is compared with the motor. ended_us,
    ended_at: when other values came in their place, and how many replies of the drive there had
    been by then.
    """

    def __init__(self, drive, sight):
        family = sight.family
        number, unit = family.reference
        self.full_hz = real_full_hz(drive)
        self.is_percent = sight.is_percent
        absolute = _real_absolute(drive)
        self.absolute = absolute and not sight.is_percent
        self.reference_hz = PERCENT if sight.is_percent else self.full_hz
        self.lowest_hz, self.highest_hz = 0, HIGHEST_HZ
        if sight.reads_limits:
            lowest, highest = family.limits
            per_unit = 1
            if unit == "1/min":
                per_unit = PERCENT / _read(drive, number, PERCENT)
            elif unit == "steps":
                per_unit = 1 / _steps_per_hz(drive)
            self.lowest_hz = _read(drive, lowest, 0) * per_unit
            self.highest_hz = _read(drive, highest, HIGHEST_HZ / per_unit) * per_unit
        self.tells_speed = True
        if sight.reads_sent:
            (number, index), right = family.sent
            self.tells_speed = _read(drive, number, None, index) == right
        self.shows_speed = sends_speed(drive) and not (absolute and sight.is_percent)
        self.off_time_us = 0
        if sight.reads_words:
            number, unit_us = family.off_time
            self.off_time_us = _read(drive, number, 0, _index_of(drive, number)) * unit_us
        self.ended_us = self.ended_at = ALWAYS

    def key(self):
        return self.meaning() + (self.lowest_hz, self.highest_hz, self.off_time_us)

    def meaning(self):
        """What HSW and HIW mean."""
        return (
            self.reference_hz, self.absolute, self.tells_speed, self.is_percent, self.full_hz,
            self.shows_speed,
        )  # fmt: skip


class Settings:
    """drive: whose they are. kind: a `Kind`, what the panel takes it for. rows: `Values`, oldest
    first; the last are those of now."""

    def __init__(self, drive, kind):
        self.drive = drive
        self.kind = kind
        self.rows = [Values(drive, kind.sight())]

    def note(self, now, replies):
        sight = self.kind.sight()
        if sight is None:
            return  # it may know one thing or another
        values, last = Values(self.drive, sight), self.rows[-1]
        if values.key() != last.key():
            last.ended_us, last.ended_at = now, replies
            self.rows = self.rows[-KEPT:] + [values]

    def in_force(self, since_us, replies):
        """The values that were set at some time since `since_us`, or since so many replies."""
        return [
            values
            for values in self.rows
            if values.ended_us >= since_us or values.ended_at >= replies
        ]


class Scaling:
    """What HSW and HIW mean, in hertz, or in percent. reference_hz: P2000. absolute: P2009, in
    0.01 Hz."""

    def __init__(self, reference_hz, absolute):
        self.reference_hz = reference_hz
        self.absolute = absolute

    def hz(self, hsw):
        return hsw / 100 if self.absolute else hsw * self.reference_hz / 0x4000

    def allows(self, hsw, values, settings, begins):
        """Whether a setpoint, without its sign, is within the limits of the drive, `values`, and
        those of the settings, in 0.01 Hz or 0.01 %; the lowest counts when a run begins.
        """
        hz = self.hz(hsw)
        highest_hz = min(values.highest_hz, settings.get("highest_centihertz", 65000) / 100)
        lowest_hz = max(values.lowest_hz, settings.get("lowest_centihertz", 0) / 100)
        full_hz = 327.67 if self.absolute else 1.99994 * self.reference_hz
        highest_hz = min(highest_hz, full_hz)
        lowest_hz = min(lowest_hz, highest_hz)
        slack_hz = 0.006 + self.reference_hz / 0x4000
        return (not begins or lowest_hz - slack_hz <= hz) and hz <= highest_hz + slack_hz


def scalings(rows):
    """All that these `Values` allow: P2000 and P2009 are read one after the other."""
    pairs = {(row.reference_hz, other.absolute) for row in rows for other in rows}
    return [Scaling(*pair) for pair in sorted(pairs)]


def magnitude(hsw):
    """A setpoint without its sign."""
    return 0x10000 - hsw if hsw & 0x8000 else hsw


def sends_speed(drive):
    """Whether PZD2 of a drive is its actual frequency."""
    number = drive.family.LINK["sent"]
    return number is None or _read(drive, number, 0, 1) >> 16 in SPEEDS


def real_full_hz(drive):
    """What 4000h is in hertz."""
    name = drive.family.NAME
    if name == MM3:
        return drive.read(94) / _steps_per_hz(drive)
    return _read(drive, 2000, 50) / (RPM_PER_HZ if name == G120 else 1)


def _real_absolute(drive):
    """Whether PZD2 is in 0.01 Hz."""
    if drive.family.NAME == MM3:
        return drive.read(95) == 2
    return bool(_read(drive, 2009, 0, _index_of(drive, 2009)))


def _steps_per_hz(drive):
    """Of an MM3."""
    return 100 if drive.read(95) else 10


def _index_of(drive, number):
    return drive.family.LINK["index"] if number in LINKED else 0


def _read(drive, number, missing, index=0):
    try:
        return drive.read(number, index)
    except KeyError:
        return missing
