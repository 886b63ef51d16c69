# SPDX-License-Identifier: MIT
"""The settings of a drive, its earlier ones, and how long the panel may still use those.

The panel reads settings again and again (rules 6 and 17 of its promises). That takes time, and
replies of the drive: old values are allowed until enough of both have passed.

    settings = Settings(drive)
    settings.note(now, replies)             # they may have changed; replies: of the drive so far
    for values in settings.in_force(since_us, replies): ...     # those that the panel may use
"""

from tools.soaking.judging.facts import ALWAYS, MS

ACTUAL_HZ = 21 << 16  # P2019[1]: r0021, the actual frequency
KEPT = 8  # values that were replaced


class Values:
    """The settings that a run of a drive uses, at one time, in Hz and microseconds.

    tells_hz: HIW is its frequency. off_time_us: P2014, 0: it never trips. ended_us, ended_at: when
    other values came in their place, and how many replies of the drive there had been by then.
    """

    def __init__(self, drive):
        self.reference_hz = _read(drive, 2000, 50)
        self.absolute = bool(_read(drive, 2009, 0))
        self.tells_hz = _read(drive, 2019, None, 1) == ACTUAL_HZ
        self.lowest_hz = _read(drive, 1080, 0)
        self.highest_hz = _read(drive, 1082, 650)
        self.off_time_us = _read(drive, 2014, 0) * MS
        self.ended_us = self.ended_at = ALWAYS

    def key(self):
        return self.meaning() + (self.lowest_hz, self.highest_hz, self.off_time_us)

    def meaning(self):
        """What HSW and HIW mean."""
        return self.reference_hz, self.absolute, self.tells_hz


class Settings:
    """drive: whose they are. rows: `Values`, oldest first; the last are those of now."""

    def __init__(self, drive):
        self.drive = drive
        self.rows = [Values(drive)]

    def note(self, now, replies):
        values, last = Values(self.drive), self.rows[-1]
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
    """What HSW and HIW mean, in hertz. reference_hz: P2000. absolute: P2009, in 0.01 Hz."""

    def __init__(self, reference_hz, absolute):
        self.reference_hz = reference_hz
        self.absolute = absolute

    def hz(self, hsw):
        return hsw / 100 if self.absolute else hsw * self.reference_hz / 0x4000

    def allows(self, hsw, values, settings, begins):
        """Whether a setpoint is within the limits of the drive, `values`, and those of the
        settings; the lowest counts when a run begins.
        """
        if hsw & 0x8000:
            return False
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


def _read(drive, number, missing, index=0):
    try:
        return drive.read(number, index)
    except KeyError:
        return missing
