"""One drive under the operator's hand: what may be done with it, and what is to be said about it.

The rules that keep a motor from starting by surprise and a STOP from getting lost live here and in
`uss.drive`; pages only show, keys only ask.

    control = Control(drive, survey, bus, mask, settings)
    control.step(now)                  # each step of the loop
    refusal = control.start()          # None, or the text that says why not
    control.stop()
"""

from micropython import const

from panel import texts
from uss import profiles, pzd
from uss.timing import elapsed

CONFIRM_US = const(1_000_000)  # a STOP that is not confirmed by then is an alarm
START_US = const(5_000_000)  # a drive that does not run by then is told to stop again


class Control:
    """drive: `uss.drive.Drive`. survey: its `Survey`. bus: the `Master`. mask: of the clock.

    settings: has setpoint_centihertz, lowest_centihertz, highest_centihertz.

    Fields for a page: `setpoint_centihertz`; `notice`, a text why the drive is not on any more, or
    None; `lost_running`, it was running when contact was lost and nobody has acknowledged that;
    `stop_unconfirmed`.
    """

    def __init__(self, drive, survey, bus, mask, settings):
        self.drive = drive
        self.survey = survey
        self.setpoint_centihertz = settings.setpoint_centihertz
        self.notice = None
        self.lost_running = False
        self.stop_unconfirmed = False
        self._bus = bus
        self._mask = mask
        self._lowest = settings.lowest_centihertz
        self._highest = settings.highest_centihertz
        self._version = 0  # of the survey, as last seen
        self._contact = False  # as last seen
        self._contacts = 0  # drive.contacts when it was started
        self._dead_man_trips = 0  # bus.dead_man_trips when it was started
        self._failures = 0
        self._stopping = False  # a STOP is to be confirmed
        self._stopped_at = 0
        self._off_answers = 0  # drive.off_answers when it was stopped
        self._fastest = 0  # |HIW| seen since the STOP
        self._started_at = 0
        self._started = False  # seen running since START
        self._now = 0

    # --- what an operator does ------------------------------------------------------------------

    def start(self):
        """Run with the setpoint shown. None, or why not: one of texts.REFUSED_..."""
        drive = self.drive
        refusal = self._refusal()
        if refusal is not None or drive.is_on():
            return refusal
        self.notice = None
        self._stopping = False
        self.stop_unconfirmed = False
        self._contacts = drive.contacts
        self._dead_man_trips = self._bus.dead_man_trips
        self._failures = self._bus.failures
        self._started_at = self._now
        self._started = False
        drive.start(drive.hsw)
        return None

    def stop(self):
        """OFF1, always, and acknowledge what was announced about this drive."""
        self.drive.stop()
        self.notice = None
        self.lost_running = False
        self.stop_unconfirmed = False
        self._stopping = True
        self._stopped_at = self._now
        self._off_answers = self.drive.off_answers
        self._fastest = 0

    def change(self, centihertz):
        """Move the setpoint by so much, within the limits of the drive and of the settings."""
        self.setpoint_centihertz = self._limited(self.setpoint_centihertz + centihertz)
        if self.survey.complete:
            self.drive.hsw = self.survey.scaling.hsw(self.setpoint_centihertz)

    # --- what goes on ---------------------------------------------------------------------------

    def step(self, now):
        """Look at the drive; each step of the loop."""
        self._now = now
        self.survey.step(now)
        drive = self.drive
        if drive.contact != self._contact:
            self._contact = drive.contact
            self.lost_running = drive.was_running and not drive.contact
        if drive.stopped_by_engine():
            self.notice = self._why_stopped()
            drive.stop()
        elif drive.is_on():
            self._watch_start(now)
        if self._stopping:
            self._watch_stop(now)
        if self.survey.version != self._version:
            self._version = self.survey.version
            self.change(0)

    def actual_centihertz(self):
        """The actual frequency with its sign, or None while it cannot be told."""
        if not self.drive.contact or self.survey.scaling is None:
            return None
        return self.survey.scaling.centihertz(self.drive.hiw)

    def runs(self):
        """Whether its motor turns by the last status word. False without contact."""
        return self.drive.contact and self.drive.state() == pzd.RUNNING

    def state_text(self):
        """The state in words, at most texts.STATE_WIDTH. A motor that turns outranks a notice."""
        drive = self.drive
        if not drive.contact:
            return texts.NO_CONTACT
        state = drive.state()
        if state == pzd.FAULT:
            return texts.FAULT
        if state == pzd.RUNNING:
            return self._running_text()
        if drive.is_on():
            return texts.STARTING
        if self.notice is not None:
            return self.notice
        if state == pzd.INHIBITED:
            return texts.INHIBITED
        if not self.survey.complete:
            return texts.CHECKING
        if self._is_foreign(profiles.COMMAND_SOURCE):
            return texts.LOCAL
        return texts.READY if state == pzd.READY else texts.NOT_READY

    def _running_text(self):
        if self.drive.is_on():
            warning = self.drive.zsw & pzd.ZSW_WARNING
            return texts.RUNNING_WARNING if warning else texts.RUNNING
        local = self._is_foreign(profiles.COMMAND_SOURCE)
        return texts.RUNS_LOCALLY if local else texts.STOPPING

    def _refusal(self):
        """Why START is not sent, in the order in which an operator would want to know."""
        drive, survey = self.drive, self.survey
        if not drive.contact:
            return texts.REFUSED_SILENT
        state = drive.state()
        if state == pzd.FAULT:
            return texts.REFUSED_FAULT
        if not survey.complete:
            return texts.REFUSED_SCALING if survey.unreadable else texts.REFUSED_CHECKING
        if self._is_foreign(profiles.COMMAND_SOURCE):
            return texts.REFUSED_COMMAND
        if self._is_foreign(profiles.SETPOINT_SOURCE):
            return texts.REFUSED_SETPOINT
        if state == pzd.INHIBITED:
            return texts.REFUSED_INHIBITED
        if state == pzd.NOT_READY:
            return texts.REFUSED_NOT_READY
        return None

    def _is_foreign(self, source):
        """Whether a source is known and is not this bus. source: row of profiles.SURVEY."""
        value = self.survey.values[source]
        return value >= 0 and value != profiles.USS_ON_COM_LINK

    def _why_stopped(self):
        drive, bus = self.drive, self._bus
        if not drive.contact or drive.contacts != self._contacts:
            return texts.LINE_FAILED
        if bus.dead_man_trips != self._dead_man_trips:
            return texts.PANEL_HUNG
        if bus.failures != self._failures:
            return texts.ENGINE_FAILED
        return texts.STOPPED_ITSELF

    def _watch_start(self, now):
        """ON that leads to nothing is taken back: it must not take effect minutes later."""
        if self.drive.state() == pzd.RUNNING:
            self._started = True
        elif not self._started:
            foreign = self._is_foreign(profiles.COMMAND_SOURCE)
            if foreign or elapsed(now, self._started_at, self._mask) >= START_US:
                self.drive.stop()
                self.notice = texts.DID_NOT_START

    def _watch_stop(self, now):
        """A STOP is confirmed when the drive has answered OFF1 and does not run, or slows down."""
        drive = self.drive
        if drive.contact and drive.off_answers != self._off_answers:
            speed = abs(pzd.signed(drive.hiw))
            if drive.state() != pzd.RUNNING or speed < self._fastest:
                self._stopping = False
                self.stop_unconfirmed = False
                return
            self._fastest = max(self._fastest, speed)
        if elapsed(now, self._stopped_at, self._mask) >= CONFIRM_US:
            self.stop_unconfirmed = True

    def _limited(self, centihertz):
        values = self.survey.values
        highest, lowest = self._highest, self._lowest
        if self.survey.complete:
            highest = min(highest, values[profiles.HIGHEST])
            highest = min(highest, self.survey.scaling.limit_centihertz())
            lowest = max(lowest, values[profiles.LOWEST])
        return max(min(centihertz, highest), min(lowest, highest))
