# SPDX-License-Identifier: MIT
"""One drive under the operator's hand: start, stop, jog, reverse, and what came of them.

The rules that keep a motor from starting by surprise and a STOP from getting lost live here, in
`permits` and in `uss.drive`; pages only show, keys only ask.

    control = Control(drive, survey, bus, mask, settings)
    control.ask(now)                    # again and again, in steps of their own:
    control.watch(now)                  # each takes its time
    control.start()                     # START: asks the drive first, then ON, or `refusal`
    control.stop()                      # STOP
    control.jog(pzd.JOG_LEFT)           # a jog key goes down
    control.end_jog()                   # and up
"""

from micropython import const

from panel import permits, texts
from panel.command import Command
from panel.fault import Fault
from panel.setpoint import Setpoint
from panel.stop_watch import StopWatch
from uss import pzd
from uss.survey import REREAD_US

_UNKNOWN = const(-1)  # no status word
_SILENT_MAX = const(3)  # telegrams without an answer after which the speed is not known any more

# settings.second_stop: what a held STOP sends.
SECOND_STOPS = {"OFF3": pzd.OFF3, "OFF2": pzd.OFF2, "none": 0}


class Control:
    """drive: `uss.drive.Drive`. survey: its `Survey`. bus: the `Master`. mask: of the clock.

    settings: a `Settings`.

    Fields for a page: `setpoint`; `reversed`, the direction START takes; `jogging`, 0 or the
    control word of the jog that is held; `checking`, START was obeyed and the drive is being
    asked; `refusal`, why a key was not obeyed, to be shown once; `question`, START waits to be
    told that the drive may run unsupervised; `notice`, why the drive is not on any more, or None;
    `lost_running`, it was running when contact was lost and nobody has acknowledged that;
    `stop_watch`, whether a STOP is obeyed; `fault`; `moving`, it is being given another address;
    `moved`, it has been.
    """

    def __init__(self, drive, survey, bus, mask, settings):
        self.drive = drive
        self.survey = survey
        self.setpoint = Setpoint(drive, survey, settings)
        self.stop_watch = StopWatch(drive, mask)
        self.fault = Fault(drive, mask)
        self.moving = False
        self.moved = False
        self.reversed = False
        self.jogging = 0
        self.checking = False
        self.refusal = None
        self.question = False
        self.notice = None
        self.lost_running = False
        self._command = Command(drive, survey, bus, mask)
        self._settings = settings
        self._now = 0
        self._contact = False  # as last seen
        self._quiet_zsw = _UNKNOWN  # drive.zsw when there was nothing to watch
        self._jogged = False  # what turns, or ramps down, is a jog of this panel

    # --- what an operator does ------------------------------------------------------------------

    def start(self):
        """Run with the setpoint shown, once the drive has confirmed its settings.

        What can be told at once, or turns out on the way, is in `refusal`: texts.REFUSED_...
        """
        self.refusal = permits.why_not_start(self)
        if self.refusal is None and not self.is_starting():
            self._obey()
            self.checking = True
            self.survey.recheck()

    def accept_unsupervised(self):
        """The operator takes the risk for this drive, once and for all, and starts it."""
        self._settings.accept_unsupervised(self.drive.address)
        self.start()

    def stop(self):
        """OFF, always; acknowledge what was announced about this drive and its fault, if shown."""
        if self.fault.was_shown:
            self.drive.acknowledge()
        self.stop_unseen()
        self.notice = None
        self.lost_running = False

    def stop_unseen(self):
        """OFF for a drive that need not be the one shown, so nothing is acknowledged.

        A second stop that is on its way is not weakened by this.
        """
        self._stop(self.drive.off)

    def second_stop(self):
        """Stop by what the settings say: OFF3, OFF2, or nothing more than OFF1."""
        off = SECOND_STOPS[self._settings.second_stop]
        if off:
            self._stop(off)

    def jog(self, stw):
        """Turn while a key is held. stw: pzd.JOG_RIGHT or JOG_LEFT. Not obeyed: `refusal`."""
        self.refusal = permits.why_not_jog(self)
        if self.refusal is None:
            self._obey()
            self.stop_watch.end()
            self.jogging = stw
            self._jogged = True
            self.drive.start(self.drive.hsw, stw)

    def end_jog(self):
        if self.jogging:
            self._stop(self.drive.off)

    def reverse(self):
        """The other direction: at once for a drive that runs, preselected for one that stands."""
        if self.jogging:
            self.refusal = texts.REFUSED_JOG
            return
        self.reversed = not self.reversed
        self.drive.turn(self._on())

    def change(self, centihertz):
        """Move the setpoint, unless the drive runs and does not tell its settings: what is shown
        is what is sent.
        """
        if self.drive.wanted and not self.survey.complete:
            self.refusal = texts.REFUSED_CHECKING
            return
        self.setpoint.change(centihertz)

    def take_refusal(self):
        """The refusal, which is forgotten by this."""
        refusal, self.refusal = self.refusal, None
        return refusal

    def keep_quiet(self):
        """Forget what would be said and asked: another drive is shown."""
        self.refusal = None
        self.question = False
        if not self.checking:
            self.survey.drop_recheck()

    def learn_anew(self):
        """Have all settings of the drive read again soon: it is shown from now on."""
        self.survey.recheck()

    # --- what is known --------------------------------------------------------------------------

    def actual_centihertz(self):
        """The actual frequency with its sign, or None while it cannot be told."""
        drive = self.drive
        if not drive.contact or drive.silent >= _SILENT_MAX or self.survey.scaling is None:
            return None
        return self.survey.scaling.centihertz(drive.hiw)

    def actual_is_beyond(self):
        """Whether the actual frequency is more than its word can say, and so unknown."""
        return self.drive.hiw in pzd.BEYOND

    def runs(self):
        """Whether its motor turns by the last status word. False without contact."""
        return self.drive.contact and self.drive.state() == pzd.RUNNING

    def is_active(self):
        """Whether it runs, is told to, or may run out of contact."""
        return self.lost_running or self.drive.wanted != 0 or self.runs()

    def is_quiet(self):
        """Whether it stands, as when `watch` found nothing that would have to be watched."""
        drive = self.drive
        is_same = drive.zsw == self._quiet_zsw and drive.contact == self._contact
        return is_same and not self.moved

    def is_starting(self):
        """Whether START has been obeyed: the drive is being asked, or ON is sent."""
        return self.checking or self.drive.is_on()

    def needs_attention(self):
        """Whether it may run though it should not: an alarm."""
        return self.lost_running or self.stop_watch.unconfirmed

    def own_jog_ends(self):
        """Whether it turns because a jog of this panel is still ramping down."""
        return self._jogged and self.stop_watch.active

    def accepts_unsupervised(self):
        return self.drive.address in self._settings.unsupervised

    def is_unsaved(self):
        """Whether its address is another one than the panel will look for after a restart."""
        return self.moved and self._settings.dirty

    # --- what goes on ---------------------------------------------------------------------------

    def ask(self, now, reread_us=REREAD_US):
        """Learn the settings of the drive, and keep the setpoint within them.

        Answers whether there was news: then it took long, and the step is for nothing else.
        """
        survey = self.survey
        survey.step(now, reread_us)
        if reread_us == REREAD_US:  # it is shown, or waited for
            survey.settle()
        return self.setpoint.step()

    def ask_on(self, now):
        """In between, for somebody waits: what was just answered is not all."""
        if self.checking:
            self.survey.step(now)

    def watch(self, now):
        """Look what became of the commands, and whether the drive does as it is told."""
        self._now = now
        drive = self.drive
        self.fault.step(now)
        if drive.contact != self._contact:
            self._contact = drive.contact
            self.lost_running = drive.was_running and not drive.contact
        if self.checking:
            self._finish_check(now)
            return  # that may have taken long
        if drive.wanted:
            self._watch_command(now)
        elif drive.off != pzd.OFF1:
            self._watch_second_stop()
        self._watch_stop(now)
        if self.moved and not self._settings.dirty:
            self.moved = False
        zsw = drive.zsw
        is_busy = (
            zsw & (pzd.ZSW_RUNNING | pzd.ZSW_FAULT)
            or drive.wanted
            or self.lost_running
            or self.stop_watch.active
            or drive.off != pzd.OFF1
        )
        self._quiet_zsw = _UNKNOWN if is_busy else zsw

    def _stop(self, off):
        self.drive.stop(off)
        self.jogging = 0
        self.question = False
        self.checking = False
        self._quiet_zsw = _UNKNOWN
        self.survey.drop_recheck()
        if not self.stop_watch.active:  # pressing again does not put the alarm off
            self.stop_watch.begin()

    def _on(self):
        return pzd.ON_REVERSE if self.reversed else pzd.ON

    def _obey(self):
        """A key was obeyed: what was said of the drive is over."""
        self.notice = None
        self.question = False
        self._quiet_zsw = _UNKNOWN
        self._command.give(self._now)

    def _finish_check(self, now):
        """ON, if the drive has told its settings and there is nothing against it."""
        refusal = permits.why_not_start(self)
        if refusal is None and self.survey.unchecked:
            if not self._command.is_overdue(now):
                return
            refusal = texts.REFUSED_CHECKING
        self.checking = False
        self.survey.drop_recheck()
        if self._command.is_stale():
            self.notice = texts.PANEL_HUNG
        elif refusal is not None:
            self.refusal = refusal
            self.notice = texts.DID_NOT_START  # the operator may look at another drive by now
        elif permits.is_unsupervised(self.survey) and not self.accepts_unsupervised():
            self.question = True
            self.notice = texts.DID_NOT_START
        else:
            self._command.send(now)
            self.stop_watch.end()
            self._jogged = False
            self.drive.start(self.drive.hsw, self._on())

    def _watch_command(self, now):
        """ON, or JOG, is taken back here when the engine did so or when it leads to nothing."""
        if self.drive.stopped_by_engine():
            self._take_back(self._command.why_stopped())
        elif self.drive.is_on():
            notice = self._command.why_in_vain(self.jogging, now)
            if notice is not None:
                self._take_back(notice)

    def _watch_stop(self, now):
        """Whether a drive that is to stand still comes to rest; a STOP is watched from the key on,
        and one that runs against OFF from when that is seen."""
        watch = self.stop_watch
        if watch.active:
            watch.step(now)
        elif not self.drive.wanted and self._runs_against_off():
            watch.begin()
        if self._jogged and not (self.jogging or watch.active):
            self._jogged = False

    def _take_back(self, notice):
        self.drive.stop(self.drive.off)
        self.jogging = 0
        self.notice = notice

    def _watch_second_stop(self):
        """Back to OFF1, which ends the inhibit, once OFF2 or OFF3 was heard and it stands."""
        drive = self.drive
        if drive.answered_stw & ~pzd.STW_ACKNOWLEDGE != drive.off:
            return
        local = permits.is_local(self.survey)
        if drive.state() != pzd.RUNNING or local:
            drive.stop(pzd.OFF1)

    def _runs_against_off(self):
        """Whether a drive of this bus runs though nobody wants it to: it may not obey OFF1."""
        return (
            self.drive.zsw & pzd.ZSW_RUNNING != 0  # looked at first: it mostly does not
            and self.runs()
            and self.survey.complete
            and not permits.is_local(self.survey)
        )
