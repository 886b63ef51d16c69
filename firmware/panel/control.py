# SPDX-License-Identifier: MIT
"""One drive under the operator's hand: start, stop, jog, reverse, and what came of them.

The rules that keep a motor from starting by surprise and a STOP from getting lost live here, in
`permits` and in `uss.drive`; pages only show, keys only ask.

    control = Control(drive, survey, Desk(bus, settings, mask))
    control.ask(now_us)                 # again and again, in steps of their own:
    control.watch(now_us)               # each takes its time
    control.start()                     # START: asks the drive first, then ON, or `refusal`
    control.stop()                      # STOP
    control.jog(pzd.JOG_LEFT)           # a jog key goes down
    control.end_jog()                   # and up
"""

from micropython import const

# From the bottom of the house up: an import inside an import inside an import takes stack.
from uss.timing import elapsed
from uss import pzd
from uss.families import rows
from uss.survey import REREAD_US
from panel import permits, risks, texts
from panel.command import Command
from panel.reports.fault import NO_FAULT, Fault
from panel.reports.journal import Journal
from panel.phases import ASKING, CHECKING, IDLE, JOGGING, RUNNING
from panel.setpoint import Setpoint
from panel.stop_watch import NO_WATCH, StopWatch
from panel.supervision import longest_off_time_ms, off_time_ms

_UNKNOWN = const(-1)  # no status word
_PREPARED = const(-1)  # no START waits to be prepared
_OBEYED = const(-2)  # one does, and its command is given,
_SETTLED = const(-3)  # has all its fields,
_COUNTED = const(-4)  # and telegrams are counted anew
_SILENT_MAX = const(3)  # telegrams without an answer after which the speed is not known any more
_RUNS_REREAD_US = const(200_000)  # a setting of one that runs is read again so often: while shown,
_UNSEEN_REREAD_US = const(330_000)  # and while not
_DOUBT_US = const(40_000_000)  # in which P2019[0] of each drive has been read again

# settings.second_stop: what a held STOP sends.
SECOND_STOPS = {"OFF3": pzd.OFF3, "OFF2": pzd.OFF2, "none": 0}


class Desk:
    """What the controls of a panel share. bus: the `Master`, its drives added. settings: a
    `Settings`. mask: the clock's period - 1.

    defect: what is wrong with the line's hardware, of texts, or NOTHING. longest_off_time_ms: a
    longer P2014 is a risk. off_time_ms: one that fits this bus. journal: of what happens.
    """

    def __init__(self, bus, settings, mask, defect=texts.NOTHING):
        self.bus = bus
        self.settings = settings
        self.mask = mask
        self.defect = defect
        self.journal = Journal(mask)
        self.follow_list()

    def note_answer(self):
        """A drive answers: the line was low while nobody held it up, or its wires were crossed."""
        if self.defect == texts.LINE_LOW:
            self.defect = texts.NOTHING

    def follow_list(self):
        """The list of the bus has changed."""
        cycle_us = self.bus.turns.longest_cycle_us()
        self.longest_off_time_ms = longest_off_time_ms(cycle_us)
        self.off_time_ms = off_time_ms(cycle_us)


class Control:
    """drive: `uss.drive.Drive`. survey: its `Survey`. desk: a `Desk`.

    Fields for a page: `phase`, of `phases`; `setpoint`; `reversed`, the direction START takes;
    `refusal`, why a key was not obeyed, to be shown once; `notice`, why the drive is not on any
    more; `remark`, what has become of its P2014 while it runs: texts, or NOTHING; `lost_running`,
    contact was lost while it ran, or before it was heard at rest after its last ON;
    `absence_known`, STOP was pressed while it was shown and silent; `stop_watch`, whether a STOP
    is obeyed; `fault`.

    The writer writes `moving`, it is being given another address, and sets `moved`, it has been.
    Nobody else writes a field of it.
    """

    # Most drives never need these: each takes memory of its own when it first differs.
    moving = False
    moved = False
    reversed = False
    remark = texts.NOTHING
    lost_running = False
    absence_known = False
    stop_watch = NO_WATCH
    fault = NO_FAULT
    phase = IDLE
    refusal = texts.NOTHING
    notice = texts.NOTHING
    _command = None  # the last one that was obeyed
    _start_trips = _PREPARED  # bus.dead_man_trips when START was pressed, or how far it is
    _stirred_at_us = None  # it last ran, or may have; None: it rests for sure
    _jogged = False  # what turns, or ramps down, is a jog of this panel

    # Eight fields that all drives need. One more would take 16 bytes more of each.

    def __init__(self, drive, survey, desk):
        self.drive = drive
        self.survey = survey
        self.desk = desk
        self.setpoint = Setpoint(survey, desk.settings)
        self._now_us = 0
        self._contact = False  # as last seen
        self._quiet_zsw = _UNKNOWN  # drive.zsw when there was nothing to watch
        self._judged = -1  # version of the survey when its status word was judged

    # --- what an operator does ------------------------------------------------------------------

    def start(self):
        """Run with the setpoint shown, once the drive has confirmed its settings.

        What can be told at once, or turns out on the way, is in `refusal`: texts.REFUSED_...
        """
        self.refusal = permits.why_not_start(self)
        if not self.refusal and not self.is_starting():
            self.notice = texts.NOTHING
            self.phase = CHECKING
            self._quiet_zsw = _UNKNOWN
            self._start_trips = self.desk.bus.dead_man_trips

    def accept_risk(self, row, value):
        """The operator takes the risk that it was asked about, as it was then, and starts the
        drive. P2014 = 0 is accepted for this drive once and for all, see `risks`."""
        if row == risks.SUPERVISION and not value:
            self.desk.settings.accept_unsupervised(self.drive.address)
        else:
            self._command.accepted[row] = value
        self.start()

    def stop(self):
        """OFF, always; acknowledge what was announced about this drive and its fault, if shown."""
        if self.fault.was_shown():
            self.drive.acknowledge()
        self.stop_unseen()
        self.notice = texts.NOTHING
        self.absence_known = not self.drive.contact

    def stop_unseen(self):
        """OFF for a drive that need not be the one shown, so nothing is acknowledged.

        A second stop that is on its way is not weakened by this.
        """
        self._stop(self.drive.off)

    def second_stop(self):
        """Stop by what the settings say: OFF3, OFF2, or nothing more than OFF1."""
        off = SECOND_STOPS[self.desk.settings.second_stop]
        if off:
            self._stop(off)

    def jog(self, stw):
        """Turn while a key is held. stw: pzd.JOG_RIGHT or JOG_LEFT. Not obeyed: `refusal`."""
        self.refusal = permits.why_not_jog(self)
        if not self.refusal:
            self._obey(self.desk.bus.dead_man_trips)
            self._command.settle_in()
            self.stop_watch.end()
            self.phase = JOGGING
            self._jogged = True
            self.survey.count_anew()
            self._command.exposure_ms = risks.exposure_ms(self)
            self.drive.start(self.drive.hsw, stw)

    def end_jog(self):
        if self.phase == JOGGING:
            self._stop(self.drive.off)

    def reverse(self):
        """The other direction: at once for a drive that runs, preselected for one that stands."""
        if self.phase == JOGGING:
            self.refusal = texts.REFUSED_JOG
            return
        self.reversed = not self.reversed
        if self.survey.family.on_reverse:
            self.drive.turn(self._on())
        else:
            self.setpoint.negate(self.reversed)

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
        refusal = self.refusal
        if refusal:
            self.refusal = texts.NOTHING
        return refusal

    def keep_quiet(self):
        """Forget what it would say and ask: another drive is shown."""
        self.take_refusal()
        self.drop_question()
        if self.phase != CHECKING:
            self.survey.drop_recheck()

    def question(self):
        """The row of risks.RISKS that ASKING is about."""
        return self._command.question

    def drop_question(self):
        """Nobody takes the risk."""
        if self.phase == ASKING:
            self.phase = IDLE

    # --- what is known --------------------------------------------------------------------------

    def actual_centihertz(self):
        """The actual frequency with its sign, or None while it cannot be told."""
        drive = self.drive
        actual = self.survey.actual
        if not drive.contact or drive.silent >= _SILENT_MAX or actual is None:
            return None
        return actual.centihertz(pzd.signed_hiw(self.survey.family, drive.hiw, drive.zsw))

    def actual_is_beyond(self):
        """Whether the actual frequency is more than its word can say, and so unknown."""
        return self.drive.hiw in pzd.BEYOND

    def runs(self):
        """Whether its motor turns by the last status word. False without contact."""
        drive = self.drive
        return drive.contact and drive.tells_status and drive.state() == pzd.RUNNING

    def is_unheard(self):
        """Whether it has not been heard since the panel started: it may be running."""
        return not self.drive.contacts and self.drive.silent >= _SILENT_MAX

    def is_active(self):
        """Whether it runs, is told to run, or ran and has not been heard at rest since. STOP ends
        the alarm, but a motor that nobody hears may still turn: only a restart of the panel
        forgets that.
        """
        return self.drive.wanted != 0 or self.runs() or self._may_run()

    def is_quiet(self):
        """Whether it stands as it did when `watch` found nothing to watch."""
        drive = self.drive
        return (
            drive.zsw == self._quiet_zsw
            and drive.contact == self._contact
            and not self.moved
            and self.survey.version == self._judged
        )

    def is_starting(self):
        """Whether START has been obeyed: the drive is being asked, or ON is sent."""
        return self.phase == CHECKING or self.drive.is_on()

    def needs_attention(self):
        """Whether it may run though it should not: an alarm."""
        return self.lost_running or self.stop_watch.unconfirmed

    def own_jog_ends(self):
        """Whether it turns because a jog of this panel is still ramping down."""
        return self._jogged and self.stop_watch.active

    def accepts(self, row, value):
        """Whether the operator has taken this risk, a row of risks.RISKS, with this value."""
        return self._command is not None and self._command.accepted[row] == value

    def accepts_unsupervised(self):
        """Whether P2014 = 0 has been accepted for it."""
        return self.drive.address in self.desk.settings.unsupervised

    def is_half_written(self):
        """Whether a parameter set is on it in part: see `panel.sets.writing`."""
        return self.drive.address in self.desk.settings.half_at

    def is_unsaved(self):
        """Whether its address is another one than the panel will look for after a restart."""
        return self.moved and self.desk.settings.dirty

    # --- what goes on ---------------------------------------------------------------------------

    def ask(self, now_us, reread_us=REREAD_US):
        """Learn the settings of the drive, and keep the setpoint within them.

        Answers whether the setpoint had news to take: then it took long, and the step is for
        nothing else.
        """
        if self.phase == CHECKING and self._start_trips != _PREPARED:
            self._obey_start()
            return False
        survey = self.survey
        if self.drive.wanted:
            is_shown = reread_us == REREAD_US
            survey.step(now_us, _RUNS_REREAD_US if is_shown else _UNSEEN_REREAD_US)
            survey.settle()
            if survey.has_restarted():
                self._take_back(texts.DRIVE_RESET)
            return self.setpoint.step()  # at once: a limit may have come down
        if self.setpoint.step() and survey.complete:
            return True
        survey.step(now_us, reread_us)  # `ask_on` judges the answer: each takes long
        return False

    def ask_on(self, now_us):
        """In between, for somebody waits: what was just answered is judged, and is not all."""
        if self.phase == CHECKING and self._start_trips != _PREPARED:
            self._prepare()
        elif self.phase == CHECKING or not self.survey.is_settled():
            self.survey.step(now_us)

    def watch(self, now_us):
        """Look what became of the commands, and whether the drive does as it is told."""
        self._now_us = now_us
        drive = self.drive
        survey = self.survey
        if survey.version != self._judged:
            self._judged = survey.version
            if survey.values[rows.STATUS_SENT] >= 0:  # else what was known stays true
                drive.tells_status = not permits.tells_no_status(survey)
        if drive.zsw & pzd.ZSW_FAULT and self.fault is NO_FAULT:
            self.fault = Fault(drive, self.desk.mask, survey.family)
        if self.fault is not NO_FAULT:
            self._watch_fault(now_us)
        if drive.contact != self._contact:
            self._contact = drive.contact
            if drive.contact:
                self.desk.note_answer()
            is_lost_running = drive.was_running and not drive.contact
            if is_lost_running != self.lost_running:
                self.lost_running = is_lost_running
                if is_lost_running:
                    self._note(texts.OTHER_LOST)
        if self.phase == CHECKING:
            self._finish_check(now_us)
            return  # that may have taken long
        if self.phase == RUNNING or self.phase == JOGGING:
            self._watch_command(now_us)
        elif drive.off != pzd.OFF1:
            self._watch_second_stop()
        self._watch_stop(now_us)
        if self.moved and not self.desk.settings.dirty:
            self.moved = False
        zsw = drive.zsw
        is_busy = (
            zsw & (pzd.ZSW_RUNNING | pzd.ZSW_FAULT)
            or drive.wanted
            or self.lost_running
            or self._stirred_at_us is not None
            or drive.off != pzd.OFF1
            or self._may_run()  # ON was sent, and its answer is still to come
        )
        self._quiet_zsw = _UNKNOWN if is_busy else zsw

    def _watch_fault(self, now_us):
        number = self.fault.number
        self.fault.step(now_us)
        if self.fault.number not in (0, number):
            self._note(texts.FAULT, self.fault.number)

    def _stop(self, off):
        self.drive.stop(off)
        if self.phase == RUNNING:
            self._note(texts.STOP_KEY)
        self.phase = IDLE
        self._quiet_zsw = _UNKNOWN
        self.survey.drop_recheck()
        if not self.stop_watch.active:  # pressing again does not put the alarm off
            self._begin_stop_watch()

    def _on(self):
        family = self.survey.family
        return self.reversed and family.on_reverse or family.on

    def _obey(self, dead_man_trips):
        """Obey a key: what was said of the run before is over."""
        self._forget_remark()
        self._quiet_zsw = _UNKNOWN
        if self._command is None:
            self._command = Command(self.drive, self.survey, self.desk)
        self._command.give(self._now_us, dead_man_trips)

    def _obey_start(self):
        """Begin what `start` has left to later turns, one thing in each: a step with a key in it
        takes long already. This takes longest, since a command takes memory.
        """
        if self._command is None:
            self._command = Command(self.drive, self.survey, self.desk)
        elif self._start_trips >= 0:
            self._obey(self._start_trips)
            self._start_trips = _OBEYED
        else:
            self._prepare()

    def _prepare(self):
        """The rest of it, in those turns that do more besides."""
        if self._start_trips == _OBEYED:
            self._command.settle_in()
            self._start_trips = _SETTLED
        elif self._start_trips == _SETTLED:
            self.survey.count_anew()
            self._start_trips = _COUNTED
        elif self._start_trips == _COUNTED:
            self.survey.recheck()
            self._start_trips = _PREPARED

    def _finish_check(self, now_us):
        """ON, if the drive has told its settings and there is nothing against it."""
        if self._start_trips != _PREPARED:
            self._prepare()
            return
        if self.setpoint.has_news():
            return  # HSW may be another once `ask` has taken them
        command = self._command
        refusal = permits.why_not_start(self)
        if not refusal and command.is_overdue(now_us):
            refusal = texts.REFUSED_CHECKING
        if not refusal and (self.survey.unchecked or not self.survey.is_settled()):
            return
        if not refusal and command.risk < len(risks.RISKS):  # one in a turn: each takes long
            if risks.is_open(self, command.risk):
                self.phase = ASKING
                self.survey.drop_recheck()
                command.question = command.risk
                self._say(texts.DID_NOT_START)
            command.risk += 1
            return
        if not refusal and command.risk == len(risks.RISKS):
            command.exposure_ms = risks.exposure_ms(self)
            command.risk += 1
            return
        self.phase = IDLE
        self.survey.drop_recheck()
        if command.is_stale():
            self._say(texts.PANEL_HUNG)
        elif refusal:
            self.refusal = refusal
            self._say(texts.DID_NOT_START)  # the operator may look at another drive by now
        else:
            command.send(now_us)
            self.stop_watch.end()
            if self._jogged:
                self._jogged = False
            self.phase = RUNNING
            self.drive.start(self.drive.hsw, self._on())

    def _watch_command(self, now_us):
        """ON, or JOG, is taken back here when the engine did so or when it leads to nothing."""
        command = self._command
        if self.drive.stopped_by_engine():
            self._take_back(command.why_stopped())
        elif not self.drive.is_on():
            return
        elif command.has_judged() and command.exposure_version != self.survey.version:
            command.exposure_version = self.survey.version  # in a turn of its own
            self._look_at_supervision()
        else:
            notice = command.why_in_vain(self.phase == JOGGING, now_us)
            if notice:
                self._take_back(notice)

    def _look_at_supervision(self):
        """Whether it would run on longer without this panel than when it was started."""
        self._forget_remark()
        if risks.exposure_ms(self) > self._command.exposure_ms:
            is_long = self.survey.values[rows.SUPERVISION] > 0
            if self.phase == JOGGING:  # that is refused
                self._take_back(texts.RUNS_LONG if is_long else texts.UNSUPERVISED)
            else:
                self.remark = texts.RUNS_LONG if is_long else texts.RUNS_FOR_EVER

    def _forget_remark(self):
        if self.remark:
            self.remark = texts.NOTHING

    def _watch_stop(self, now_us):
        """Watch whether a drive that must stand comes to rest: after a STOP from the key on, one
        that runs against OFF from when that is seen."""
        watch = self.stop_watch
        if watch.active:
            unconfirmed = watch.unconfirmed
            watch.step(now_us)
            if watch.unconfirmed and not unconfirmed:
                self._note(texts.OTHER_UNCONFIRMED)
        elif not self.drive.wanted and (self._runs_against_off() or self._is_in_doubt()):
            watch = self._begin_stop_watch()
        if watch.active or self.drive.wanted:
            self._stirred_at_us = now_us
        elif self._stirred_at_us is not None:
            if elapsed(now_us, self._stirred_at_us, self.desk.mask) >= _DOUBT_US:
                self._stirred_at_us = None
        if self._jogged and not (self.phase == JOGGING or watch.active):
            self._jogged = False

    def _begin_stop_watch(self):
        if self.stop_watch is NO_WATCH:
            self.stop_watch = StopWatch(self.drive, self.desk.mask)
        else:
            self.stop_watch.begin()
        return self.stop_watch

    def _may_run(self):
        """Whether the motor may turn. One that never tells may if anything has stirred it."""
        return self.drive.may_run() if self.drive.tells_status else self._is_in_doubt()

    def _is_in_doubt(self):
        """Whether it came to rest by words that may be no status: its STOP must be watched."""
        return self._stirred_at_us is not None and not self.drive.tells_status

    def _take_back(self, notice):
        self.drive.stop(self.drive.off)
        self.phase = IDLE
        self._say(notice)

    def _say(self, notice):
        self.notice = notice
        self._note(notice)

    def _note(self, text, number=0):
        self.desk.journal.note(text, self.drive.address, number)

    def _watch_second_stop(self):
        """Back to OFF1, which ends the inhibit, once OFF2 or OFF3 was heard and it stands."""
        drive = self.drive
        if drive.answered_stw & ~pzd.STW_ACKNOWLEDGE != drive.off:
            return
        local = permits.is_local(self.survey)
        if drive.tells_status and drive.state() != pzd.RUNNING or local:
            drive.stop(pzd.OFF1)

    def _runs_against_off(self):
        """Whether a drive of this bus runs though nobody wants it to: it may not obey OFF1."""
        return (
            self.drive.zsw & pzd.ZSW_RUNNING != 0  # looked at first: it mostly does not
            and self.runs()
            and self.survey.complete
            and not permits.is_local(self.survey)
        )
