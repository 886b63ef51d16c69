# SPDX-License-Identifier: MIT
"""The bus for a program of one's own: drives that run, stop, are read and written, in a few words.

In front of the engine (`master`, `drive`): floats, calls that wait, and exceptions that say in
plain words why something was not done. What only few programs need is found behind `bus.engine`
and `drive.engine`. It takes heap, so nothing of it belongs into an interrupt. The panel does not
import it.

    with Master(link, baud=19200) as bus:       # a link of `hal`; leaving it stops every drive
        drive = bus.add(3, MM440)               # a family of `families`
        drive.run(25.0)                         # Hz, or NotStarted and the reason
        bus.wait(10)                            # seconds, in which the bus goes on
        print(drive.hertz, drive.read(1082))
        drive.stop()

Whoever does not wait calls `step` again and again: without it for 300 ms every motor is stopped.
"""

# From the bottom of the house up: an import inside an import inside an import takes stack.
from uss.timing import Timing, elapsed
from uss.drive import COUNTERS
from uss import bits, families, master, outside, pkw, pzd
from uss.bus import pkw_errors
from uss.bus.errors import WHY_SILENT, UssError
from uss.bus.errors import FallsSilent, NoContact, NotStarted, Refused, TimedOut
from uss.families.rows import ACTUAL, STATUS
from uss.layout import Layout
from uss.leave import leave, persist
from uss.bus.survey import Survey
from uss.scaling import Scale, run_words, signed_hiw

REST_US = 100  # between two looks at the bus while a call waits
TRIES = 3  # telegrams without a valid reply: nobody waits for more of them
LISTEN_US = 1_000_000  # a bus that has just begun, or was put on, sends long before
START_S = 5.0  # for a drive to run after it was told to
SETTLE_S = 1.0  # for a drive to lift its inhibit, or a fault to go, before it is started
OFF_TIME_S = (0.3, 65.0)  # telegram-off times that are taken; a word of ms ends at 65.5
ROUNDS = 3  # of the bus that a telegram-off time must last
RETRIES_MAX = 255

# `Drive.state` of a drive that answers, by the numbers of pzd.state; and of one that does not.
STATES = ("not ready", "ready", "running", "fault", "inhibited")
NO_CONTACT = "no contact"
MAY_RUN = "no contact, may run"

LINE_IN_USE = "another master is on the line"

# Why there is no contact with drive %d, by `drive.Drive.trouble`.
TROUBLES = (
    "drive %d does not answer",
    "drive %d: what comes for an answer is noise",
    "drive %d answers in telegrams of another length: its layout has another P2012 or P2013",
    "drive %d: another address answers in its place",
    "drive %d: its answers have a wrong check character (BCC)",
)


class Drive:
    """One drive, made by `Master.add`. Speeds have a sign: negative turns left.

    What waits lets the bus go on, and raises NoContact when the drive does not answer. `engine` is
    the `drive.Drive` behind it.
    """

    def __init__(self, bus, engine, family, scale, unsupervised):
        self.bus = bus
        self.engine = engine
        self.family = family
        self.unsupervised = unsupervised
        self.survey = Survey(self, scale)
        if not family.hiw_is_signed:
            engine.tell_speed(0)
        self._kinds = {}  # of double words, number -> (contacts, kind), as the drive tells them

    # --- to run and to stop ---------------------------------------------------------------------

    def run(self, hertz=None, percent=None, rpm=None):
        """Have the motor turn at one of the three; percent of the reference, 1/min without slip.

        To a motor that stands it waits until the drive has told its settings, a third of a second
        at 19200 baud, half a second beside others, and says that it runs. To one that runs the new
        speed goes with its next telegram. NotStarted; ValueError: a speed beyond the drive's
        limits, or not one speed.
        """
        if self.set(hertz, percent, rpm):
            return
        self._check_start(True)
        stw, hsw = run_words(self.family, self.survey.setpoint(hertz, percent, rpm))
        self._start(hsw, stw)

    def set(self, hertz=None, percent=None, rpm=None):
        """A new speed, as of run(), for a motor that this bus has told to run; it starts none.

        Answers whether there was such a motor; nothing happens otherwise. ValueError as of run().
        """
        _check_speed(hertz, percent, rpm)
        if not self._has_speed():
            return False
        stw, hsw = run_words(self.family, self.survey.setpoint(hertz, percent, rpm))
        if not self._has_speed():  # it was asked for its settings first, and stopped meanwhile
            return False
        self.engine.hsw = hsw
        self.engine.turn(stw)
        return True

    def jog_right(self):
        """Turn at the drive's own jog frequency until `stop`. Waits as run() does; NotStarted."""
        self._jog(self.family.jog_right)

    def jog_left(self):
        """As jog_right, the other way."""
        self._jog(self.family.jog_left)

    def stop(self, off=pzd.OFF1):
        """Ramp down to a stop, which holds until run() or a jog.

        It waits for nothing: it goes ahead of everything, and again until the drive answers. off:
        OFF1, OFF2 or OFF3 of `pzd`, ValueError else.
        """
        self.engine.stop(off)

    def off2(self):
        """Coast to a stop; otherwise likewise."""
        self.stop(pzd.OFF2)

    def off3(self):
        """Stop as fast as the drive can; otherwise likewise."""
        self.stop(pzd.OFF3)

    def acknowledge(self):
        """Acknowledge a fault, while it does not run. Waits for nothing."""
        self.engine.acknowledge()

    def control(self, bits, on):
        """Have these bits of STW 1, or 0, in every telegram, also while it runs.

        bits: any of 3...6, which are 1 otherwise, and 13...15, which are 0. ValueError: others.
        """
        self.engine.control(bits, on)

    def put(self, place, word):
        """Send `word`, 0...FFFFh, as PZD word `place`, 3...16, from the next telegram on.

        ValueError: no such word, or not in its layout.
        """
        self.engine.put(place, word)

    def supervise(self, seconds):
        """Have the drive trip when it hears nothing for so long, 0: never; kept in its RAM.

        ValueError: nobody knows how, or the time is none of OFF_TIME_S, or shorter than three
        rounds of the bus. Refused, TimedOut.
        """
        family = self.family
        if family.off_time_number is None:
            raise ValueError("nobody knows the telegram-off time of a %s" % family.name)
        least, longest = OFF_TIME_S
        least = max(least, ROUNDS * self.bus.round_us() / 1_000_000)
        if seconds != 0 and not least <= seconds <= longest:  # nor a NaN
            raise ValueError(
                "supervise() takes seconds, %.1f...%.0f on this bus, or 0 for never: not %r"
                % (least, longest, seconds)
            )
        value = round(seconds * 1000 / family.off_time_unit_ms)
        if seconds:
            value = max(value, 1)  # 0 would be "never"
        self.write(family.off_time_number, value, family.link_index, sure=True)
        self.bus.supervise(self, value * family.off_time_unit_ms)

    # --- what it does ---------------------------------------------------------------------------

    @property
    def address(self):
        """0...31; `Master.readdress` changes it."""
        return self.engine.address

    @property
    def layout(self):
        """The `Layout` of its telegrams."""
        return self.engine.layout

    @property
    def counters(self):
        """A 16-bit figure for each name in `drive.COUNTERS`."""
        return self.engine.counters

    @property
    def status(self):
        """The error status word: what went wrong since the last valid reply, 0 after one."""
        return self.engine.status

    @property
    def silent(self):
        """Telegrams without a valid reply in a row."""
        return self.engine.silent

    @property
    def trouble(self):
        """Which of `receiver.TROUBLES` that mostly was."""
        return self.engine.trouble

    @property
    def contact(self):
        """Whether it answers, and this bus still asks it."""
        return self.engine.contact and not self._why_not_asked()

    @property
    def zsw(self):
        """The status word of its last reply; None when it does not answer: nothing is known."""
        return self.word(1)

    @property
    def hiw(self):
        """The actual value of its last reply, 0...FFFFh; None likewise."""
        return self.word(2)

    def word(self, place):
        """PZD word `place` of its last reply, as of `drive.Drive`; None likewise."""
        word = self.engine.word(place)
        return word if self.contact else None

    @property
    def state(self):
        """One of STATES, NO_CONTACT, or MAY_RUN: it ran when contact was lost."""
        if self.contact:
            return STATES[pzd.state(self.engine.zsw)]
        return MAY_RUN if self.engine.may_run() else NO_CONTACT

    def is_on(self):
        """Whether it is told to run, and the bus has not taken that back."""
        return self.engine.is_on()

    @property
    def is_running(self):
        """Whether it answers, and says that it runs."""
        return self.contact and self.engine.zsw & pzd.ZSW_RUNNING != 0

    @property
    def hertz(self):
        """The actual frequency. Waits for the drive's settings when they are not known yet;
        ValueError when they do not tell, as for the next two."""
        return self.survey.hertz_scale().hertz(self._actual())

    @property
    def percent(self):
        """The actual speed in percent of the reference."""
        return self.survey.known_scale().percent(self._actual())

    @property
    def rpm(self):
        """The actual speed in 1/min, without slip."""
        return self.survey.rpm_scale().rpm(self._actual())

    @property
    def fault(self):
        """0, or the number of the present fault, for which it waits; -1 when the drive has one and
        cannot tell which. NoContact, TimedOut."""
        self._wait_for_contact()
        if not self.engine.zsw & pzd.ZSW_FAULT:
            return 0
        if self.family.fault_number is None or not self.engine.layout.pkw_words:
            return -1
        try:
            return self.read(self.family.fault_number)
        except Refused:
            return -1

    # --- parameters -----------------------------------------------------------------------------

    def read(self, number, index=0, kind=None):
        """The value of a parameter; waits for it. Refused, TimedOut.

        A word comes as an int from 0 on. A double word is a float or an int, as the family has it,
        or else the drive's own description of the parameter; where neither says, an int, or what
        `kind` says, float or int. ValueError: a kind that it is known not to be.
        """
        _check_kind(kind)
        job = self.do(self.addressed(pkw.read(number, index)))
        return self._value(job, self._agreed(job, kind))

    def write(self, number, value, index=0, eeprom=False, kind=None, sure=False):
        """Write a parameter into RAM, or RAM and EEPROM; answers what the drive has confirmed.

        The drive is asked first what it is, a word or a double word; kind: as of read(). sure: to
        be said for parameters by which this bus may lose the drive, or a speed mean something
        else: family.ask_first. ValueError without it, and for a value or a kind that does not fit.
        Waits; Refused, TimedOut; UssError: its address, while the motor may run.
        """
        _check_kind(kind)
        if eeprom and not self.family.has_eeprom_tasks:
            raise ValueError(
                "no task of %s writes the EEPROM: write parameter %d afterwards"
                % (self.family.name, self.family.save[0])
            )
        asked_first = number in self.family.ask_first
        if asked_first and not sure:
            raise ValueError(
                "%s may take drive %d away from this bus, or change what a speed means; "
                "sure=True writes it all the same" % (pkw.name(number, index), self.engine.address)
            )
        if number == self.family.address_number and self.engine.may_run():
            raise UssError(
                "drive %d may be running: stop it before it gets another address, or nobody could"
                % self.engine.address
            )
        kind = self._agreed(self.do(self.addressed(pkw.read(number, index))), kind)
        if kind is float:
            job = pkw.write_float(number, value, index, eeprom)
        elif int(value) != value:
            raise ValueError("%s takes integers, not %r" % (pkw.name(number, index), value))
        elif kind is int:
            job = pkw.write_double(number, int(value), index, eeprom)
        else:
            job = pkw.write_word(number, int(value), index, eeprom)
        if asked_first:
            self.survey.forget()
        return self._value(self.do(self.addressed(job)), kind)

    def do(self, job):
        """Carry out any job of `pkw`, wait for its end and answer it.

        Refused; TimedOut, and as one FallsSilent; UssError when the drive's telegrams have no PKW
        words.
        """
        self.carry_out(job)
        self.raise_unless_done(job)
        return job

    def ask(self, job):
        """Queue a job of `pkw` and do not wait: its state tells when it is no longer PENDING.

        RuntimeError when 8 wait already, it is pending, or the drive has no parameter channel.
        """
        self.engine.ask(job)

    def carry_out(self, job):
        """Wait for the end of a job, whatever that is. NoContact: it was not begun, or the bus
        was put off before it ended."""
        self.finish(self.begin(job))

    def begin(self, job):
        """As carry_out, but it waits for contact alone, and answers the job: `finish` is next."""
        if not self.layout.pkw_words:
            raise UssError("drive %d has no parameter channel: %r" % (self.address, self.layout))
        self._wait_for_contact()
        self.ask(job)
        return job

    def finish(self, job):
        """Wait for the end of a job that was begun."""
        self.engine.want_turns(True)
        try:
            while job.state == pkw.PENDING:
                self._raise_unless_asked()
                self.bus.rest()
        finally:
            self.engine.want_turns(False)

    def raise_unless_done(self, job):
        """The exception that a job deserves which has ended otherwise."""
        if job.state == pkw.DONE:
            return
        name = pkw.name(job.number, job.index)
        if job.state == pkw.REFUSED:
            text = pkw_errors.error_text(job.error)
            raise Refused("drive %d refuses %s: %s" % (self.engine.address, name, text), job)
        if job.state == pkw.UNANSWERED:
            raise FallsSilent(
                "drive %d falls silent when it is asked about %s, and answers without"
                % (self.engine.address, name)
            )
        if not self.engine.contact:
            raise self._no_contact()
        raise TimedOut("drive %d does not answer about %s" % (self.engine.address, name))

    # --- behind it ------------------------------------------------------------------------------

    def addressed(self, job):
        """The job, by the task that drives of the family take its index with."""
        if not job.index or not self.family.has_array_tasks:
            return job
        from uss.tasks import arrays  # here, because most programs need the room that it takes

        return arrays.with_array_task(job, self.family)

    def _agreed(self, job, kind):
        """What a parameter is that a finished job has read: None, a word; else float or int.

        kind: what the program says that it is, None for nothing. ValueError: it is not.
        """
        found = None if job.width == pkw.WORD else self._kind_of_double(job.number)
        if job.width != pkw.WORD and found is None:
            return kind or int
        if kind is not None and kind is not (found or int):
            raise ValueError(
                "%s of drive %d is %s, not of kind %s: leave kind= out"
                % (
                    pkw.name(job.number, job.index), self.engine.address,
                    "a word" if found is None else "a float" if found is float else "an integer",
                    "float" if kind is float else "int",
                )
            )  # fmt: skip
        return found

    def _kind_of_double(self, number):
        """float or int, as the family or the drive's description says; None: nobody says it."""
        if self.family.integer_doubles is not None:
            return float if families.is_float(self.family, number) else int
        contacts = self.engine.contacts  # behind a loss it may be another drive
        known, kind = self._kinds.get(number, (None, None))
        if known != contacts:
            from uss.tasks import descriptions  # as above

            job = descriptions.read_description(number, descriptions.IDENTIFIER)
            self.carry_out(job)
            told = job.description().data_type() if job.state == pkw.DONE else None
            kind = float if told == descriptions.FLOAT else None
            if told in (descriptions.I32, descriptions.U32):
                kind = int
            self._kinds[number] = (contacts, kind)
        return kind

    def _value(self, job, kind):
        return job.float_value() if kind is float else job.integer_value()

    def _actual(self):
        """HIW with its sign. ValueError: it is known not to be the speed."""
        wrong = self.survey.what_is_wrong(ACTUAL)
        if wrong:
            raise ValueError("drive %d %s" % (self.engine.address, wrong))
        self._wait_for_contact()
        return signed_hiw(self.family, self.engine.word(2), self.engine.zsw)

    def _jog(self, stw):
        if not stw:
            raise NotStarted("a %s has no jog" % self.family.name)
        if self.is_running and self.engine.wanted not in self._jogs():
            self._refuse("is running")
        self._check_start(False)
        self._start(0, stw)

    def _jogs(self):
        return self.family.jog_right, self.family.jog_left

    def _has_speed(self):
        """Whether it is told to run, and by a setpoint of this bus."""
        engine = self.engine
        return not self._why_not_asked() and engine.is_on() and engine.wanted not in self._jogs()

    def _check_start(self, needs_setpoint):
        """NotStarted unless everything that must be known of the drive lets it be started now."""
        self._raise_unless_asked()
        if self.engine.stopped_by_engine():
            self._refuse(
                "was stopped: it was lost, tripped, switched itself off, or step() was not called "
                "for too long. stop() says that you know of it"
            )
        if self.engine.layout.pzd_words < (2 if needs_setpoint else 1):
            self._refuse("has no room for it in its telegrams: %r" % self.engine.layout)
        self._wait_for_contact()
        if self.engine.off != pzd.OFF1:  # OFF2 and OFF3 inhibit it until OFF1 follows
            if self.is_running:
                self._refuse("is still stopping")
            self.engine.stop()
        stops = self.engine.stops
        survey = self.survey
        survey.ask()
        wrong = survey.what_is_wrong(STATUS)
        if wrong:
            self._refuse(wrong)
        if not self._may_start():
            self.bus.wait(SETTLE_S, self._may_start)
        fault = self.fault
        if fault:
            name = self.family.fault_format % fault if fault > 0 else "a fault"
            self._refuse("has tripped with %s: acknowledge() when its cause is gone" % name)
        if not self._may_start():
            self._refuse("is inhibited, or stopped by OFF2 or OFF3 from elsewhere")
        obstacle = survey.obstacle(needs_setpoint, self.unsupervised)
        if obstacle:
            self._refuse(obstacle)
        self.keep_within(survey.off_time_ms())
        if self.engine.stops != stops:
            self._refuse("was told to stop meanwhile")

    def _start(self, hsw, stw):
        """Start it and wait until it runs. What does not start soon shall not start later."""
        engine = self.engine
        self._raise_unless_asked()
        engine.start(hsw, stw)
        self.bus.wait(
            START_S, lambda: self.is_running or not engine.wanted or engine.stopped_by_engine()
        )
        if self.is_running:
            return
        self._raise_unless_asked()
        if engine.stopped_by_engine():
            self._refuse("did not start: it was lost, or tripped")
        if not engine.wanted:
            self._refuse("was told to stop meanwhile")
        engine.stop()
        self._refuse("did not start: is it being commissioned (P0010), or held by its terminals?")

    def keep_within(self, off_time_ms):
        """The drive's telegram-off time is known, or None: the bus keeps within it from now on."""
        if off_time_ms is not None:
            self.bus.engine.deadlines.supervise(self.engine, off_time_ms)

    def _may_start(self):
        return self.engine.contact and bits.may_start(self.engine.zsw)

    def _refuse(self, reason):
        raise NotStarted("drive %d %s" % (self.engine.address, reason))

    def _wait_for_contact(self):
        """Until it answers, or has failed to a few times from now on: what it did before is old
        news."""
        self._raise_unless_asked()
        engine = self.engine
        if engine.contact:
            return
        failures = sum(engine.counters[1:])  # telegrams to it without a valid reply; wraps

        def has_answered_or_failed():
            failed = (sum(engine.counters[1:]) - failures) & 0xFFFF
            return engine.contact or failed >= TRIES or self._why_not_asked() is not None

        patience_us = LISTEN_US + TRIES * self.bus.engine.turns.longest_cycle_us()
        engine.ask_soon()  # among other silent ones it may have no turn for long
        self.bus.wait(patience_us / 1_000_000, has_answered_or_failed)
        if not self.contact:
            raise self._no_contact()

    def _no_contact(self):
        """The exception that says why."""
        reason = self._why_not_asked()
        if self.bus.engine.is_line_in_use():
            reason = LINE_IN_USE
        if reason:
            return NoContact(reason)
        trouble = self.engine.trouble
        return NoContact(TROUBLES[trouble] % self.engine.address, trouble)

    def _raise_unless_asked(self):
        reason = self._why_not_asked()
        if reason:
            raise NoContact(reason)

    def _why_not_asked(self):
        """Why no telegram goes to it any more, in words; None: one does."""
        bus = self.bus
        if bus.engine.phase != master.CLOSED and self not in bus.drives:
            return "drive %d is not on the bus" % self.engine.address
        return bus.why_silent()


class Master:
    """The bus on a link of `hal`, which brings its clock.

    baud: of the line, a rate of USS. reply_timeout_ms: how long a reply may take to begin; 20 by
    the specification, adapters may need more. lost_ms: without a valid reply for so long a drive
    counts as lost. idle: called again and again while a call waits, at least once in 2 ms: to feed
    a watchdog, say; never while the bus is closed, so that nothing in it keeps a motor turning.
    ValueError: no rate of USS, or another Master has the link and was not closed.

    drives: each once, in the order added. engine: the `master.Master` behind it.
    """

    def __init__(self, link, baud=19200, reply_timeout_ms=20, lost_ms=1000, idle=None):
        self.clock = clock = link.clock
        self.drives = []
        timing = Timing(baud, reply_timeout_ms * 1000)
        if getattr(link, "bus", None):
            raise ValueError("another Master has this link: close() that one first")
        self.engine = master.Master(link, timing, clock.ticks_mask, lost_ms * 1000)
        self._link = link
        link.bus = self
        self._idle = idle
        self._pacer = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    # --- the list -------------------------------------------------------------------------------

    def add(self, address, family=None, layout=None, scale=None, unsupervised=False):
        """Put a drive at the end of the circulating list; answer its `Drive`.

        The same address again gives the same drive, unchanged, one more turn. family: of
        `families`, GENERIC when it is not told. layout: how its telegrams are divided, if not as
        the family's are. scale: a `scaling.Scale`, for a drive that cannot tell its own: what it
        tells goes first. unsupervised: it may run although its telegram-off time is 0, or nobody
        knows it, and nobody would stop it if the program died. ValueError: an address beyond 31, a
        layout that the family cannot be set to, the list is full, the drive is there already and
        of another family or layout. TypeError.
        """
        _check_types(address, family, layout, scale)
        for drive in self.drives:
            if drive.address == address:
                if family not in (None, drive.family):
                    raise ValueError("drive %d is a %s already" % (address, drive.family.name))
                self.engine.turns.add(address, layout or drive.layout)
                return drive
        family = family or families.GENERIC
        layout = layout or family.layout
        if not families.can_be_set_to(family, layout):
            raise ValueError("a %s has no %r" % (family.name, layout))
        engine = self.engine.turns.add(address, layout)
        drive = Drive(self, engine, family, scale, unsupervised)
        self.drives.append(drive)
        return drive

    def remove(self, drive):
        """Take a drive off the bus. ValueError when it is not on it, or may be running."""
        self.engine.turns.remove(drive.engine)
        self.drives = [other for other in self.drives if other is not drive]

    def arrange(self, drives):
        """Make these the circulating list, each drive of the bus at least once, 255 at the most.

        Who stands in it more often is asked more often. ValueError when one is missing or strange.
        """
        self.engine.turns.arrange([drive.engine for drive in drives])

    def readdress(self, drive, address):
        """From now on the drive answers at another address. ValueError: taken, or beyond 31."""
        self.engine.turns.readdress(drive.engine, address)

    def supervise(self, drive, off_time_ms):
        """Tell of a drive that cannot be asked after which time without telegrams it trips, in ms,
        0: never. The bus keeps within a third of that while it may run.

        Nothing is written to the drive: `Drive.supervise` does that.
        """
        if not isinstance(off_time_ms, int) or not 0 <= off_time_ms <= 1000 * OFF_TIME_S[1]:
            raise ValueError("a telegram-off time is an integer in ms, not %r" % (off_time_ms,))
        drive.survey.told_off_time_ms = off_time_ms
        drive.keep_within(off_time_ms)

    def round_us(self):
        """How long a round of the list takes when every drive answers as soon as it may."""
        timing = self.engine.timing
        delay_us = timing.start_interval_us
        entries = [(drive.layout.net_count,) * 2 + (delay_us,) for drive in self.engine.turns.list]
        return max(timing.cycle_us(entries), self.cycle_us)

    @property
    def cycle_us(self):
        """A round of the list begins so long after the one before; 0: at once. May be set."""
        return self.engine.turns.cycle_us

    @cycle_us.setter
    def cycle_us(self, cycle_us):
        if not isinstance(cycle_us, int) or cycle_us < 0:
            raise ValueError(
                "cycle_us is a number of microseconds from 0 on, not %r" % (cycle_us,)
            )
        self.engine.turns.cycle_us = cycle_us

    @property
    def retries(self):
        """How often an exchange without a valid reply is repeated at once; 0...255. May be set."""
        return self.engine.retries

    @retries.setter
    def retries(self, retries):
        if retries not in range(RETRIES_MAX + 1):
            raise ValueError("retries is 0...%d, not %r" % (RETRIES_MAX, retries))
        self.engine.retries = retries

    # --- time -----------------------------------------------------------------------------------

    def pace(self, pacer, timer):
        """From now on interrupts keep the engine going.

        pacer: the class `hal.pacer.Pacer`. timer: that of the board, or None.
        """
        self._pacer = pacer(self.engine, self._link, self.clock, timer)
        self._pacer.start()

    def step(self):
        """Say that the program is alive, and do what is due. To be called again and again."""
        engine = self.engine
        now = self.clock.ticks_us()
        # The engine before it hears that the loop is alive: it must see how long that took.
        if self._pacer:
            self._pacer.tend()
        else:
            try:
                engine.poll(now)
            except BaseException:  # Ctrl-C as well: it may have struck in the middle
                engine.recover(now)
                raise
        engine.refresh(now)

    def rest(self):
        """A step, and a tenth of a millisecond for everybody else."""
        self.step()
        if self._idle:
            self._idle()
        self.clock.sleep_us(REST_US)

    def wait(self, seconds, until=None):
        """Let the bus go on for so long, or until `until()` is true; answer whether it is.

        NoContact: the bus is closed.
        """
        if self.engine.phase == master.CLOSED:
            raise NoContact(self.why_silent())
        left_us = int(seconds * 1_000_000)
        before = self.clock.ticks_us()
        while True:
            self.rest()
            if until and until():
                return True
            now = self.clock.ticks_us()
            left_us -= elapsed(now, before, self.clock.ticks_mask)
            before = now
            if left_us <= 0:
                return until is None

    # --- all together ---------------------------------------------------------------------------

    def stop_all(self):
        """OFF1 to every drive by a telegram each; those that run have theirs first."""
        self.engine.stop_all()

    def broadcast_stop(self):
        """OFF1 to all drives at once, in a single telegram, and then to each by one of its own, as
        `stop_all` has it.

        ValueError unless every drive's family takes broadcasts, and all have 4 PKW words and as
        many PZD words; each is sent its own OFF1 even so.
        """
        for drive in self.drives:
            if not drive.family.takes_broadcast:
                self.engine.stop_all()
                raise ValueError("a %s takes no broadcast" % drive.family.name)
        outside.stop_all(self.engine)

    def mirror(self, node, net_count=12):
        """Whether a node sends back a telegram of so many net characters, which it does not obey.

        A drive of fixed length answers none but its own length, which is taken for those of this
        bus. Waits; NoContact: nothing is sent on this bus.
        """
        for drive in self.drives:
            if drive.address == node:
                net_count = drive.layout.net_count
        probe = outside.Mirror(node, bytes(net_count))
        self.post(probe)
        while probe.state == pkw.PENDING:
            if self.why_silent() or self.engine.is_line_in_use():
                raise NoContact(self.why_silent() or LINE_IN_USE)
            self.rest()
        return probe.state == pkw.DONE

    def post(self, telegram_outside):
        """Send a telegram outside the list once (see `outside`), which tells what became of it.

        NoContact: nothing is sent on this bus. RuntimeError when 8 wait, or it does.
        """
        reason = self.why_silent()
        if reason:
            raise NoContact(reason)
        self.engine.turns.post(telegram_outside)

    def counters(self):
        """The counters of all drives together, as named in `drive.COUNTERS`."""
        rows = range(len(COUNTERS))
        return [sum([drive.counters[row] for drive in self.drives]) for row in rows]

    def status(self):
        """The error status word of the bus: what is wrong with any of its drives."""
        status = 0
        for drive in self.drives:
            status |= drive.status
        return status

    # --- the line -------------------------------------------------------------------------------

    def off(self):
        """Leave the line to others: OFF1 to every drive first, then nothing is sent until on().

        It does not wait; is_silent() tells when it has come so far.
        """
        self.engine.off()

    def on(self):
        """Take the line again: listen first, as at the beginning. What ran needs a new run()."""
        self.engine.on()

    @property
    def foreign(self):
        """Heard from another master: bursts before the first telegram, telegrams after it."""
        return self.engine.foreign

    def is_line_in_use(self):
        """Whether another master was heard and is listened to instead of talking."""
        return self.engine.is_line_in_use()

    def has_echo(self):
        """Whether what is sent comes back: two wires, and a receiver that stays on."""
        return self.engine.has_echo()

    def why_silent(self):
        """Why nothing is sent any more, in words; None: something is."""
        return WHY_SILENT.get(self.engine.phase)

    def is_silent(self):
        """Whether nothing is sent any more, after off() or close()."""
        return self.engine.phase in WHY_SILENT

    def close(self):
        """Stop every drive, wait for the answers, and leave the line and the link alone.

        Ctrl-C does not cut this short: it takes a second and a round of the bus at the most, and a
        motor may be turning. `idle` is not called any more.
        """
        self._idle = None
        try:
            leave(self.engine, self.clock, self.rest)
        finally:
            persist(self._pacer.stop if self._pacer else self._link.close)
            if self._link.bus is self:
                self._link.bus = None


def _check_kind(kind):
    if kind not in (None, int, float):
        raise ValueError("kind is int or float, not %r" % (kind,))


def _check_speed(hertz, percent, rpm):
    """ValueError, TypeError: not one speed, or none that is a number."""
    speeds = [speed for speed in (hertz, percent, rpm) if speed is not None]
    if len(speeds) != 1:
        raise ValueError("say one speed: hertz, percent or rpm")
    if not isinstance(speeds[0], (int, float)):
        raise TypeError("a speed is a number, not %r" % (speeds[0],))
    if speeds[0] - speeds[0] != 0:  # of a NaN and of what is infinite it is a NaN
        raise ValueError("a speed of %r" % speeds[0])


def _check_types(address, family, layout, scale):
    """TypeError: an argument of `Master.add` is none."""
    if not isinstance(address, int):
        raise TypeError("an address is an integer 0...31, not %r" % (address,))
    if family is not None and not hasattr(family, "survey"):
        raise TypeError("a family is a class of uss.families, not %r" % (family,))
    if layout is not None and not isinstance(layout, Layout):
        raise TypeError("say layout=Layout(4, 2), not %r" % (layout,))
    if scale is not None and not isinstance(scale, Scale):
        raise TypeError("say scale=Scale(50.0), not %r" % (scale,))
