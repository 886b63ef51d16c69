"""One drive under the operator's hand: what may be done with it, and what is to be said about it.

The rules that keep a motor from starting by surprise and a STOP from getting lost live here and in
`uss.drive`; pages only show, keys only ask.

    control = Control(drive, survey, bus, mask, settings)
    control.step(now)                  # each step of the loop
    control.start()                    # START: asks the drive first, then ON, or `refusal`
    control.stop()                     # STOP
"""

from micropython import const

from panel import texts
from panel.stop_watch import StopWatch
from uss import profiles, pzd
from uss.timing import elapsed

START_US = const(5_000_000)  # a drive that does not run by then is told to stop again


class Control:
    """drive: `uss.drive.Drive`. survey: its `Survey`. bus: the `Master`. mask: of the clock.

    settings: has setpoint_centihertz, lowest_centihertz, highest_centihertz.

    Fields for a page: `setpoint_centihertz`; `refusal`, why START was not obeyed, to be shown
    once; `notice`, why the drive is not on any more, or None; `lost_running`, it was running when
    contact was lost and nobody has acknowledged that; `stop_watch`, whether a STOP is obeyed.
    """

    def __init__(self, drive, survey, bus, mask, settings):
        self.drive = drive
        self.survey = survey
        self.setpoint_centihertz = settings.setpoint_centihertz
        self.refusal = None
        self.notice = None
        self.lost_running = False
        self.stop_watch = StopWatch(drive, mask)
        self._bus = bus
        self._mask = mask
        self._now = 0
        self._asked_centihertz = settings.setpoint_centihertz  # what the operator set
        self._lowest = settings.lowest_centihertz
        self._highest = settings.highest_centihertz
        self._version = 0  # of the survey, as last seen
        self._contact = False  # as last seen
        # From START on.
        self._checking = False  # the drive is being asked before it is sent ON
        self._started_at = 0
        self._ran = False
        self._contacts = 0  # drive.contacts, bus.dead_man_trips and bus.failures then
        self._dead_man_trips = 0
        self._failures = 0

    # --- what an operator does ------------------------------------------------------------------

    def start(self):
        """Run with the setpoint shown, once the drive has confirmed its settings.

        What can be told at once, or turns out on the way, is in `refusal`: texts.REFUSED_...
        """
        self.refusal = self._why_not()
        if self.refusal is not None or self._checking or self.drive.is_on():
            return
        self.notice = None
        self._contacts = self.drive.contacts
        self._dead_man_trips = self._bus.dead_man_trips
        self._failures = self._bus.failures
        self._started_at = self._now
        self._checking = True
        self.survey.recheck()

    def take_refusal(self):
        """The refusal, which is forgotten by this."""
        refusal, self.refusal = self.refusal, None
        return refusal

    def stop(self):
        """OFF1, always, and acknowledge what was announced about this drive."""
        self.drive.stop()
        self._checking = False
        self.survey.drop_recheck()
        self.notice = None
        self.lost_running = False
        self.stop_watch.begin(self._now)

    def change(self, centihertz):
        """Move the setpoint by so much, within the limits of the drive and of the settings.

        Not while a drive runs that does not tell its settings: what is shown is what is sent.
        """
        if self.drive.wanted and not self.survey.complete:
            self.refusal = texts.REFUSED_CHECKING
            return
        self._asked_centihertz = self._limited(self.setpoint_centihertz + centihertz)
        self._set_setpoint()

    # --- what goes on ---------------------------------------------------------------------------

    def step(self, now):
        """Look at the drive; each step of the loop."""
        self._now = now
        self.survey.step(now)
        if self.survey.version != self._version:
            self._version = self.survey.version
            self._set_setpoint()
        drive = self.drive
        if drive.contact != self._contact:
            self._contact = drive.contact
            self.lost_running = drive.was_running and not drive.contact
        if self._checking:
            self._finish_check(now)
        if drive.stopped_by_engine():
            self.notice = self._why_stopped()
            drive.stop()
        elif drive.is_on():
            self._watch_start(now)
        if not self.stop_watch.active and self._runs_against_off():
            self.stop_watch.begin(now)
        self.stop_watch.step(now)

    def actual_centihertz(self):
        """The actual frequency with its sign, or None while it cannot be told."""
        if not self.drive.contact or self.survey.scaling is None:
            return None
        return self.survey.scaling.centihertz(self.drive.hiw)

    def actual_is_beyond(self):
        """Whether the actual frequency is more than its word can say, and so unknown."""
        return self.drive.hiw in pzd.BEYOND

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
        if self._checking or drive.is_on():
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

    def _why_not(self):
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
        slowest = min(survey.values[profiles.LOWEST], survey.values[profiles.HIGHEST])
        if slowest > survey.scaling.limit_centihertz():
            return texts.REFUSED_MINIMUM
        if state == pzd.INHIBITED:
            return texts.REFUSED_INHIBITED
        if state == pzd.NOT_READY:
            return texts.REFUSED_NOT_READY
        return None

    def _is_foreign(self, source):
        """Whether a source is known and is not this bus. source: row of profiles.SURVEY."""
        value = self.survey.values[source]
        return value >= 0 and value != profiles.USS_ON_COM_LINK

    def _finish_check(self, now):
        """ON, if the drive has told its settings and there is nothing against it."""
        refusal = self._why_not()
        if refusal is None and self.survey.unchecked:
            patience_us = 2 * len(profiles.SURVEY) * self._bus.patience_us
            # A clock of a short period cannot tell more than half of it.
            patience_us = min(patience_us, self._mask >> 2)
            if elapsed(now, self._started_at, self._mask) < patience_us:
                return
            refusal = texts.REFUSED_CHECKING
        self._checking = False
        self.survey.drop_recheck()
        if self._bus.dead_man_trips != self._dead_man_trips:
            self.notice = texts.PANEL_HUNG  # that START is too old to be obeyed
        elif refusal is not None:
            self.refusal = refusal
            self.notice = texts.DID_NOT_START  # the operator may look at another drive by now
        else:
            self._started_at = now
            self._ran = False
            self.stop_watch.end()
            self.drive.start(self.drive.hsw)

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
        """ON that leads to nothing is taken back: it must not take effect minutes later. So is one
        to a drive that listens to somebody else by now.
        """
        command, setpoint = profiles.COMMAND_SOURCE, profiles.SETPOINT_SOURCE
        if self._is_foreign(command) or self._is_foreign(setpoint):
            self.drive.stop()
            self.notice = texts.TAKEN_AWAY
        elif self.drive.state() == pzd.RUNNING:
            self._ran = True
        elif not self._ran and elapsed(now, self._started_at, self._mask) >= START_US:
            self.drive.stop()
            self.notice = texts.DID_NOT_START

    def _runs_against_off(self):
        """Whether a drive of this bus runs though nobody wants it to: it may not obey OFF1."""
        return (
            self.runs()
            and not self.drive.wanted
            and self.survey.complete
            and not self._is_foreign(profiles.COMMAND_SOURCE)
        )

    def _limited(self, centihertz):
        values = self.survey.values
        highest, lowest = self._highest, self._lowest
        if self.survey.complete:
            highest = min(highest, values[profiles.HIGHEST])
            highest = min(highest, self.survey.scaling.limit_centihertz())
            lowest = max(lowest, values[profiles.LOWEST])
        return max(min(centihertz, highest), min(lowest, highest))

    def _set_setpoint(self):
        self.setpoint_centihertz = self._limited(self._asked_centihertz)
        if self.survey.complete:
            self.drive.hsw = self.survey.scaling.hsw(self.setpoint_centihertz)
