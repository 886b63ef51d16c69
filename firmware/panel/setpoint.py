# SPDX-License-Identifier: MIT
"""The setpoint of one drive: what the operator set, kept within every limit, as a word to send.

    setpoint = Setpoint(drive, survey, settings)
    setpoint.step()                     # again and again: limits may have been read
    setpoint.change(10)                 # 0.1 Hz up
    setpoint.centihertz                 # what is shown and sent, without its sign
"""


class Setpoint:
    """settings: has setpoint_centihertz, lowest_centihertz, highest_centihertz.

    centihertz: in 0.01 Hz, never negative; the direction is a bit of the control word and belongs
    to `Control`. Writes drive.hsw, which goes out with ON only.
    """

    def __init__(self, drive, survey, settings):
        self.centihertz = settings.setpoint_centihertz
        self._asked_centihertz = settings.setpoint_centihertz  # what the operator set
        self._settings = settings
        self._lowest = settings.lowest_centihertz  # that the settings and the drive allow
        self._highest = settings.highest_centihertz
        self._drive = drive
        self._survey = survey
        self._version = 0  # of the survey, as last seen

    def change(self, centihertz):
        """Move it by so much, within the limits of the drive and of the settings."""
        self.step()
        self._apply(self.centihertz + centihertz)
        self._asked_centihertz = self.centihertz

    def step(self):
        """A limit that comes or goes moves it at once; what the operator set is remembered.

        While a drive runs and does not tell its limits, what is shown stays what is sent. Answers
        whether the survey has news.
        """
        if self._survey.version == self._version:
            return False
        self._version = self._survey.version
        self._find_limits()
        if self._survey.complete or not self._drive.wanted:
            self._apply(self._asked_centihertz)
        return True

    def _find_limits(self):
        survey, settings = self._survey, self._settings
        highest, lowest = settings.highest_centihertz, settings.lowest_centihertz
        if survey.complete:
            highest = min(highest, survey.highest())
            lowest = max(lowest, survey.lowest())
        self._highest = highest
        self._lowest = min(lowest, highest)

    def _apply(self, centihertz):
        self.centihertz = centihertz = max(min(centihertz, self._highest), self._lowest)
        if self._survey.complete:
            self._drive.hsw = self._survey.scaling.hsw(centihertz)
