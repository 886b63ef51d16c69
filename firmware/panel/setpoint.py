# SPDX-License-Identifier: MIT
"""The setpoint of one drive: what the operator set, kept within every limit, as a word to send.

    setpoint = Setpoint(survey, settings)
    setpoint.step()                     # again and again: limits may have been read
    setpoint.change(10)                 # 0.1 Hz up
    setpoint.centihertz                 # what is shown and sent, without its sign

While the drive is wanted to run, only a key raises it in hertz: no limit that goes away does, no
minimum frequency that comes, no other scaling. What lowers it in that time lowers it for good.
For a drive in percent (`Survey.is_percent`) read "0.01 %" where it says centihertz.
"""

from uss.pzd import signed


class Setpoint:
    """settings: has setpoint_centihertz, lowest_centihertz, highest_centihertz.

    centihertz: in 0.01 Hz, never negative; the direction belongs to `Control`, which has it sent
    as a bit of the control word or by `negate`. Nobody else writes a field of it, and nobody else
    writes drive.hsw, which goes out with ON only.
    """

    _negative = False  # most drives never need it: it takes memory when it first differs

    def __init__(self, survey, settings):
        self.centihertz = settings.setpoint_centihertz
        self._asked_centihertz = settings.setpoint_centihertz  # what the operator set
        self._settings = settings
        self._survey = survey
        self._find_limits()
        self._seen = 0  # the survey's version that `step` saw last; of a drive to run ~version
        self._scaling = None  # by which drive.hsw was made

    def change(self, centihertz):
        """A key moves it by so much, within the limits of the drive and of the settings."""
        self.step()
        wish = self.centihertz + centihertz
        lowest = self._lowest
        if centihertz < 0 and self._survey.drive.wanted:
            lowest = min(lowest, self.centihertz)  # down is not up to the lowest
        self._send(max(min(max(wish, lowest), self._highest), 0))
        self._asked_centihertz = self.centihertz

    def negate(self, negative):
        """Send it with a minus, or without: the direction, where the control word has none."""
        magnitude = self._magnitude()
        self._negative = negative
        self._put(magnitude)

    def is_below(self):
        """Whether it is below the lowest frequency of the drive, at which that runs instead."""
        return self.centihertz < self._lowest

    def has_news(self):
        """Whether the survey knows what `step` has not taken yet."""
        return self._survey.version != (~self._seen if self._seen < 0 else self._seen)

    def step(self):
        """A limit that comes or goes moves it at once; what the operator set is remembered.

        While a drive runs and does not tell its limits, what is shown stays what is sent. Answers
        whether the survey has news.
        """
        survey = self._survey
        wanted = survey.drive.wanted
        seen, now = self._seen, ~survey.version if wanted else survey.version
        if seen == now:
            return False
        self._seen = now
        if seen == ~now and wanted:  # nothing is new but that it is to run
            return False
        self._find_limits()
        if not wanted:
            self._send(max(min(self._asked_centihertz, self._highest), self._lowest))
        elif survey.complete:
            self._lower()
        return True

    def _find_limits(self):
        survey, settings = self._survey, self._settings
        highest, lowest = settings.highest_centihertz, settings.lowest_centihertz
        if survey.complete:
            highest = min(highest, survey.highest())
            lowest = max(lowest, survey.lowest())
        self._highest = highest  # that the settings and the drive allow
        self._lowest = min(lowest, highest)

    def _lower(self):
        """No more than what is in force, which another scaling has changed, and the limits."""
        scaling = self._survey.scaling
        centihertz = min(self.centihertz, self._highest)
        in_force = self._magnitude()
        if scaling is not self._scaling:
            centihertz = min(centihertz, scaling.centihertz(in_force))
        self._send(centihertz)
        self._put(min(self._magnitude(), in_force))  # nor by rounding
        self._asked_centihertz = min(self._asked_centihertz, centihertz)

    def _send(self, centihertz):
        self.centihertz = centihertz
        if self._survey.complete:
            self._scaling = self._survey.scaling
            self._put(self._scaling.hsw(centihertz))

    def _put(self, magnitude):
        self._survey.drive.hsw = -magnitude & 0xFFFF if self._negative else magnitude

    def _magnitude(self):
        """That of drive.hsw."""
        return abs(signed(self._survey.drive.hsw))
