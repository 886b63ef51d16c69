# SPDX-License-Identifier: MIT
"""The bus for your own program: it runs, stops, reads and writes drives in a few words.

It stands in front of the engine (`master`, `drive`) and adds floats, calls that wait, and
exceptions that say in plain words why something was not done. What only few programs need is
behind `bus.engine` and `drive.engine`. It takes heap, so do not call it in an interrupt. The panel
does not import it.

    with Master(link, baud=19200) as bus:       # a link of `hal`; leaving it stops every drive
        drive = bus.add(3, MM440)               # a family of `families`
        drive.run(25.0)                         # Hz, or NotStarted and the reason
        bus.wait(10)                            # seconds; the bus goes on meanwhile
        print(drive.hertz, drive.read(1082))
        drive.stop()

A program that does not wait must call `step` again and again. After 300 ms without it the bus
stops every motor.
"""

# Lower layers first: an import inside an import inside an import takes stack.
from uss.timing import Timing, elapsed
from uss.drive import COUNTERS, NO_CONTROL
from uss import bits, families, master, outside, pkw, pzd
from uss.going_on import master_of
from uss.bus import pkw_errors
from uss.errors import WHY_SILENT, UssError
from uss.errors import FallsSilent, NoContact, NotStarted, Refused, TimedOut
from uss.families.rows import ACTUAL, STATUS
from uss.layout import Layout
from uss.leave import leave, persist
from uss.bus.survey import Survey
from uss.scaling import Scale, run_words

REST_US = 100  # between two looks at the bus while a call waits
TRIES = 3  # a wait for contact ends after so many telegrams without a valid reply
LISTEN_US = 1_000_000  # a bus that has just begun, or was put on, sends long before this is over
START_S = 5.0  # a drive that was told to run has so long to do it
SETTLE_S = 1.0  # before a start a drive has so long to lift its inhibit, or to clear a fault
OFF_TIME_S = (0.3, 65.0)  # the telegram-off times allowed; a word of ms ends at 65.5
ROUNDS = 3  # a telegram-off time must last so many rounds of the bus
RETRIES_MAX = 255

# `Drive.state` of a drive that answers, indexed by pzd.state. Below: of one that does not answer.
STATES = ("not ready", "ready", "running", "fault", "inhibited")
NO_CONTACT = "no contact"
MAY_RUN = "no contact, may run"

NOT_CONTROLLED = "drive %d was added without control"
LEFT_ALONE = "drive %d runs, and this bus has no control of it: it is left alone"
LINE_IN_USE = "another master is on the line"

# Why there is no contact with drive %d, indexed by `drive.Drive.trouble`.
TROUBLES = (
    "drive %d does not answer",
    "drive %d: what comes for an answer is noise",
    "drive %d answers in telegrams of another length: its layout has another P2012 or P2013",
    "drive %d: another address answers in its place",
    "drive %d: its answers have a wrong check character (BCC)",
)


class Drive:
    """One drive, made by `Master.add`. Speeds have a sign: negative turns left.

    A method that waits keeps the bus going, and raises NoContact if the drive does not answer.
    `engine` is the `drive.Drive` behind it.
    """

    def __init__(self, bus, engine, family, scale, unsupervised, control):
        self.bus = bus
        self.has_control = control
        self.left_alone = False  # it ran, although this bus has no control of it
        self.engine = engine
        self.family = family
        self.unsupervised = unsupervised
        self.survey = Survey(self, scale)
        if not family.hiw_is_signed:
            engine.tell_speed(0)
        self._kinds = {}  # double words: number -> (contacts, kind), as the drive describes them

    # --- to run and to stop ---------------------------------------------------------------------

    def run(self, hertz=None, percent=None, rpm=None):
        """Turn the motor at one of the three: Hz, percent of the reference, or 1/min without slip.

        If the motor stands, this reads the drive's settings (a third of a second at 19200 baud,
        half a second beside other drives) and waits until the drive says that it runs. If it runs,
        the new speed goes with its next telegram. Raises NotStarted; ValueError if the speed is
        beyond the drive's limits, or if not exactly one speed is given.
        """
        if self.set(hertz, percent, rpm):
            return
        stops = self._check_start(True)
        stw, hsw = run_words(self.family, self.survey.setpoint(hertz, percent, rpm))
        self._start(hsw, stw, stops)

    def set(self, hertz=None, percent=None, rpm=None):
        """Set a new speed, as run() takes it, if this bus has told the motor to run.

        Returns whether it has. If not, nothing happens: this starts no motor. ValueError as in
        run().
        """
        _check_speed(hertz, percent, rpm)
        if not self._has_speed():
            return False
        stw, hsw = run_words(self.family, self.survey.setpoint(hertz, percent, rpm))
        if not self._has_speed():  # `setpoint` may wait for settings; it was stopped meanwhile
            return False
        self.engine.hsw = hsw
        self.engine.turn(stw)
        return True

    def jog_right(self):
        """Turn at the drive's own jog frequency until `stop`. Waits as run() does; NotStarted."""
        self._jog(self.family.jog_right)

    def jog_left(self):
        """As jog_right, in the other direction."""
        self._jog(self.family.jog_left)

    def stop(self, off=pzd.OFF1):
        """Ramp down to a stop. The drive stays stopped until run() or a jog.

        This does not wait. The stop goes ahead of everything else on the bus, and again until the
        drive answers. off: OFF1, OFF2 or OFF3 of `pzd`; anything else is a ValueError.
        """
        self.engine.stop(off)

    def off2(self):
        """Coast to a stop; otherwise as stop()."""
        self.stop(pzd.OFF2)

    def off3(self):
        """Stop as fast as the drive can; otherwise as stop()."""
        self.stop(pzd.OFF3)

    def acknowledge(self):
        """Acknowledge a fault, unless the drive is told to run. Does not wait. UssError: this bus
        has no control of it."""
        if not self.has_control:
            raise UssError(NOT_CONTROLLED % self.engine.address)
        self.engine.acknowledge()

    def control(self, bits, on):
        """Set these bits of STW to 1, or to 0, in every telegram, also while the drive runs.

        bits: any of 3...6, which are otherwise 1, and 13...15, which are otherwise 0. ValueError
        for other bits.
        """
        self.engine.control(bits, on)

    def put(self, place, word):
        """Send `word`, 0...FFFFh, as PZD word `place`, 3...16, from the next telegram on.

        ValueError if there is no such word, or the drive's layout has no such place.
        """
        self.engine.put(place, word)

    def supervise(self, seconds):
        """Make the drive trip when it hears nothing for so long; 0: never. Written to its RAM.

        Raises ValueError if the family's telegram-off time is unknown, if the time is outside
        OFF_TIME_S, or if it is shorter than three rounds of the bus. Refused, TimedOut.
        """
        family = self.family
        if family.off_time_number is None:
            raise ValueError("nobody knows the telegram-off time of a %s" % family.name)
        least, longest = OFF_TIME_S
        least = max(least, ROUNDS * self.bus.round_us() / 1_000_000)
        if seconds != 0 and not least <= seconds <= longest:  # refuses a NaN too
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
        """Which of `receiver.TROUBLES` most of these telegrams met with."""
        return self.engine.trouble

    @property
    def contact(self):
        """Whether the drive answers, and this bus still asks it."""
        return self.engine.contact and not self._why_not_asked()

    @property
    def zsw(self):
        """The status word of its last reply; None while it does not answer."""
        return self.word(1)

    @property
    def hiw(self):
        """The actual value of its last reply, 0...FFFFh; None while it does not answer."""
        return self.word(2)

    def word(self, place):
        """PZD word `place` of its last reply, see `drive.Drive`; None while it does not answer."""
        word = self.engine.word(place)
        return word if self.contact else None

    @property
    def state(self):
        """One of STATES, NO_CONTACT, or MAY_RUN: no contact, but the motor may be running."""
        if self.contact:
            return STATES[pzd.state(self.engine.zsw)]
        return MAY_RUN if self.engine.may_run() else NO_CONTACT

    def is_on(self):
        """Whether the drive is told to run, and the bus has not taken that back."""
        return self.engine.is_on()

    @property
    def is_running(self):
        """Whether the drive answers, and says that it runs."""
        return self.contact and self.engine.zsw & pzd.ZSW_RUNNING != 0

    @property
    def hertz(self):
        """The actual frequency. Waits for the drive's settings if they are not known yet.
        ValueError if the settings do not tell the scale; the same holds for percent and rpm."""
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
        """The number of the present fault, which is read from the drive; 0 if there is none; -1 if
        there is one and the drive cannot tell which. Waits; NoContact, TimedOut."""
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
        """Read the value of a parameter. Waits; Refused, TimedOut.

        A word comes as an unsigned int. A double word comes as a float or an int: the family says
        which, or else the drive's own description of the parameter. If neither says it, `kind`
        (float or int) does, else it is an int. ValueError if the parameter is known not to be of
        this kind.
        """
        _check_kind(kind)
        job = self.do(self.addressed(pkw.read(number, index)))
        return self._value(job, self._agreed(job, kind))

    def write(self, number, value, index=0, eeprom=False, kind=None, sure=False):
        """Write a parameter to RAM, or RAM and EEPROM; return what the drive has confirmed.

        This first reads the parameter, to learn whether it is a word or a double word. kind: as in
        read(). sure: must be True for the parameters in family.ask_first, by which this bus may
        lose the drive or a speed may change its meaning. ValueError without it, and for a value or
        a kind that does not fit. UssError for the drive's address while its motor may run. Waits;
        Refused, TimedOut.
        """
        _check_kind(kind)
        if eeprom and not self.family.has_eeprom_tasks:
            raise ValueError(
                "no task of %s writes the EEPROM: write parameter %d afterwards"
                % (self.family.name, self.family.save[0])
            )
        if number in self.family.ask_first and not sure:
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
        return self._value(self.do(self.addressed(job)), kind)

    def do(self, job):
        """Carry out any job of `pkw`, wait for its end and return it.

        Raises Refused; TimedOut, or its subclass FallsSilent; UssError if the drive's telegrams
        have no PKW words.
        """
        self.carry_out(job)
        self.raise_unless_done(job)
        return job

    def ask(self, job):
        """Queue a job of `pkw` and do not wait. It is over when its state is no longer PENDING.

        RuntimeError if 8 jobs wait already, if this one is pending, or if the drive has no
        parameter channel.
        """
        self.engine.ask(job)

    def carry_out(self, job):
        """Carry out a job and wait for its end, however it ends. NoContact if it was not begun, or
        if the bus was put off before it ended."""
        self.finish(self.begin(job))

    def begin(self, job):
        """Wait for contact only, queue the job and return it. Call `finish` next."""
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
        """Raise the exception that fits a job that has ended in any state but DONE."""
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
        """The job, changed to an array task if the family takes an index by those."""
        if not job.index or not self.family.has_array_tasks:
            return job
        from uss.tasks import arrays  # here, because it takes memory that most programs need

        return arrays.with_array_task(job, self.family)

    def _agreed(self, job, kind):
        """What the parameter is that a finished job has read: None for a word, else float or int.

        kind: what the program says it is, or None. ValueError if it is something else.
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
        """float or int, as the family or the drive's description says; None if neither does."""
        if self.family.integer_doubles is not None:
            return float if families.is_float(self.family, number) else int
        contacts = self.engine.contacts  # after a loss of contact it may be another drive
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
        """HIW with its sign. ValueError if HIW is known not to be the speed."""
        wrong = self.survey.what_is_wrong(ACTUAL)
        if wrong:
            raise ValueError("drive %d %s" % (self.engine.address, wrong))
        self._wait_for_contact()
        return pzd.signed_hiw(self.family, self.engine.word(2), self.engine.zsw)

    def _jog(self, stw):
        if not stw:
            raise NotStarted("a %s has no jog" % self.family.name)
        if self.is_running and self.engine.wanted not in self._jogs():
            self._refuse("is running")
        self._start(0, stw, self._check_start(False))

    def _jogs(self):
        return self.family.jog_right, self.family.jog_left

    def _has_speed(self):
        """Whether the drive is told to run with a setpoint of this bus, not to jog."""
        engine = self.engine
        return not self._why_not_asked() and engine.is_on() and engine.wanted not in self._jogs()

    def _check_start(self, needs_setpoint):
        """Read what must be known of the drive; raise NotStarted if it must not be started now.

        Returns how many stops it had been told when that began.
        """
        engine = self.engine
        self._raise_unless_asked()
        if not self.has_control:
            raise NotStarted(NOT_CONTROLLED % engine.address)
        if engine.stopped_by_engine():
            self._refuse(
                "was stopped: it was lost, tripped, switched itself off, or step() was not called "
                "for too long. stop() says that you know of it"
            )
        if engine.layout.pzd_words < (2 if needs_setpoint else 1):
            self._refuse("has no room for it in its telegrams: %r" % engine.layout)
        stops = engine.stops
        self._wait_for_contact()
        # OFF2 and OFF3 inhibit it until OFF1 follows, unless it was told so just now.
        if engine.off != pzd.OFF1 and engine.stops == stops:
            if self.is_running:
                self._refuse("is still stopping")
            engine.stop()
            stops = engine.stops
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
        return stops

    def _start(self, hsw, stw, stops):
        """Start the drive, unless it has been told more stops, and wait until it runs. If it does
        not start soon, stop it again, so that it cannot start later."""
        engine = self.engine
        self._raise_unless_asked()
        if engine.stops != stops:
            self._refuse("was told to stop meanwhile")
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
        """Make the bus keep within the drive's telegram-off time from now on; None: not known."""
        if off_time_ms is not None:
            self.bus.engine.deadlines.supervise(self.engine, off_time_ms)

    def _may_start(self):
        return self.engine.contact and bits.may_start(self.engine.zsw)

    def _refuse(self, reason):
        raise NotStarted("drive %d %s" % (self.engine.address, reason))

    def _wait_for_contact(self):
        """Wait until the drive answers. Only TRIES failures from now on end the wait: what it did
        before does not count."""
        self._raise_unless_asked()
        engine = self.engine
        if engine.contact:
            return
        failures = sum(engine.counters[1:])  # telegrams to it without a valid reply; wraps

        def has_answered_or_failed():
            failed = (sum(engine.counters[1:]) - failures) & 0xFFFF
            return engine.contact or failed >= TRIES or self._why_not_asked() is not None

        patience_us = LISTEN_US + TRIES * self.bus.engine.turns.longest_cycle_us()
        engine.ask_soon()  # one of several silent drives may wait long for its turn
        self.bus.wait(patience_us / 1_000_000, has_answered_or_failed)
        if not self.contact:
            raise self._no_contact()

    def _no_contact(self):
        """The NoContact that says why."""
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
        """Why the bus sends the drive no telegrams any more, in words; None if it does."""
        bus = self.bus
        if self.left_alone:
            return LEFT_ALONE % self.engine.address
        if bus.engine.phase != master.CLOSED and self not in bus.drives:
            return "drive %d is not on the bus" % self.engine.address
        return bus.why_silent()


class Master:
    """The bus on a link of `hal`; the clock comes with the link.

    baud: the line's rate, one of USS. reply_timeout_ms: how long a reply may take to begin; 20 by
    the specification, adapters may need more. lost_ms: a drive counts as lost after so long
    without a valid reply. idle: a function that is called again and again while a call waits, at
    least once in 2 ms, for instance to feed a watchdog. It is not called once the bus is being
    closed, so that nothing in it keeps a motor turning. ValueError if the rate is none of USS, or
    if another Master has the link and was not closed.

    drives: each once, in the order added. engine: the `master.Master` behind it.
    """

    def __init__(self, link, baud=19200, reply_timeout_ms=20, lost_ms=1000, idle=None):
        self.clock = clock = link.clock
        self.drives = []
        timing = Timing(baud, reply_timeout_ms * 1000)
        if getattr(link, "bus", None):
            raise ValueError("another Master has this link: close() that one first")
        self.engine = master_of(link, timing, clock.ticks_mask, lost_ms * 1000)
        self._link = link
        self._uncontrolled = 0  # so many drives were added without control
        link.bus = self
        self._idle = idle
        self._pacer = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    # --- the list -------------------------------------------------------------------------------

    def add(self, address, family=None, layout=None, scale=None, unsupervised=False, control=True):
        """Put a drive at the end of the circulating list; return its `Drive`.

        The same address again gives the same drive, unchanged, one more turn. family: of
        `families`; GENERIC by default. layout: how its telegrams are divided, if not as the
        family's usually are. scale: a `scaling.Scale` for a drive that cannot tell its own; what
        the drive tells goes first. unsupervised: the drive may run although its telegram-off time
        is 0 or unknown, so that nothing would stop it if the program died. control: False reads
        and writes parameters alone: bit 10 of STW is 0, nothing but an explicit `stop` tells the
        drive anything, and it is left alone as soon as it is seen to run. ValueError if the
        address is beyond 31, the family cannot be set to the layout, the list is full, or the
        drive is there already with another family or layout. TypeError.
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
        if not control and not family.takes_no_control:
            raise ValueError("a %s takes no telegrams without control" % family.name)
        make = families.drive_maker(family, control)
        engine = self.engine.turns.add(address, layout, make)
        drive = Drive(self, engine, family, scale, unsupervised, control)
        self.drives.append(drive)
        self._uncontrolled += not control
        return drive

    def remove(self, drive):
        """Take a drive off the bus. ValueError if it is not on this bus, or may be running."""
        self.engine.turns.remove(drive.engine)
        self.drives = [other for other in self.drives if other is not drive]

    def arrange(self, drives):
        """Make these the circulating list: each drive of the bus at least once, 255 at
        the most.

        A drive that stands in it more often is asked more often. ValueError if a drive is missing,
        or not of this bus.
        """
        self.engine.turns.arrange([drive.engine for drive in drives])

    def readdress(self, drive, address):
        """The drive answers at another address from now on. ValueError: taken, or beyond 31."""
        self.engine.turns.readdress(drive.engine, address)

    def supervise(self, drive, off_time_ms):
        """Say after how many ms without telegrams a drive trips, if it cannot tell that; 0: never.
        While the drive may run, the bus sends it a telegram at least every third of that time.

        This writes nothing to the drive; `Drive.supervise` does.
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
        """A round of the list begins so long after the round before; 0: at once. May be set."""
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
        """Let interrupts keep the engine going from now on.

        pacer: the class `hal.pacer.Pacer`. timer: the board's timer, or None.
        """
        self._pacer = pacer(self.engine, self._link, self.clock, timer)
        self._pacer.start()

    def step(self):
        """Say that the program is alive, and do what is due. Call it again and again."""
        engine = self.engine
        now = self.clock.ticks_us()
        # Poll first, then say that the loop is alive: the engine must see how long that took.
        if self._pacer:
            self._pacer.tend()
        else:
            try:
                engine.poll(now)
            except BaseException:  # also Ctrl-C, which may have struck in the middle of `poll`
                engine.recover(now)
                raise
        engine.refresh(now)
        if self._uncontrolled:
            self._leave_alone()

    def _leave_alone(self):
        """Drop the drives that run without control of this bus: telegrams would keep a drive from
        noticing that whoever told it to run is gone."""
        for drive in self.drives:
            engine = drive.engine
            if engine.off == NO_CONTROL and engine.contact and engine.zsw & pzd.ZSW_RUNNING:
                drive.left_alone = True
                self.remove(drive)

    def rest(self):
        """Do a step, then sleep a tenth of a millisecond."""
        self.step()
        if self._idle:
            self._idle()
        self.clock.sleep_us(REST_US)

    def wait(self, seconds, until=None):
        """Keep the bus going for so long, or until `until()` is true; return whether it is.

        NoContact if the bus is closed.
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
        """Send OFF1 to every drive, a telegram each; drives that run get theirs first. This takes
        control of those that were added without."""
        for drive in self.drives:
            drive.stop()

    def broadcast_stop(self):
        """Send OFF1 to all drives at once in a single telegram, then to each one its own, as
        `stop_all` does.

        ValueError unless every drive's family takes broadcasts, all have 4 PKW words, and all have
        the same number of PZD words. Each drive is sent its own OFF1 even then.
        """
        for drive in self.drives:
            if not drive.family.takes_broadcast:
                self.engine.stop_all()
                raise ValueError("a %s takes no broadcast" % drive.family.name)
        outside.stop_all(self.engine)

    def mirror(self, node, net_count=12):
        """Whether a node sends back a mirror telegram of so many net characters. It does not obey
        such a telegram.

        A drive of fixed length answers only its own length; for drives of this bus that length is
        used instead of `net_count`. Waits; NoContact if this bus sends nothing.
        """
        drive = self.engine.turns.at(node)
        if drive is not None:
            net_count = drive.layout.net_count
        probe = outside.Mirror(node, bytes(net_count))
        self.post(probe)
        while probe.state == pkw.PENDING:
            if self.why_silent() or self.engine.is_line_in_use():
                raise NoContact(self.why_silent() or LINE_IN_USE)
            self.rest()
        return probe.state == pkw.DONE

    def post(self, telegram_outside):
        """Send a telegram outside the list once (see `outside`). Its state tells what became of
        it.

        NoContact if this bus sends nothing. RuntimeError if 8 wait already, or this one does.
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
        """Leave the line to others: send OFF1 to every drive, then nothing until on().

        This does not wait; is_silent() tells when the bus sends nothing any more.
        """
        self.engine.off()

    def on(self):
        """Take the line again: listen first, as at the beginning. A drive that ran needs a new
        run()."""
        self.engine.on()

    @property
    def foreign(self):
        """Heard from another master: bursts before our first telegram, telegrams after it."""
        return self.engine.foreign

    def is_line_in_use(self):
        """Whether another master was heard, so that this bus listens and does not send."""
        return self.engine.is_line_in_use()

    def has_echo(self):
        """Whether the line echoes what is sent: two wires, and a receiver that stays on."""
        return self.engine.has_echo()

    def why_silent(self):
        """Why the bus sends nothing any more, in words; None if it sends."""
        return WHY_SILENT.get(self.engine.phase)

    def is_silent(self):
        """Whether the bus has stopped sending, after off() or close()."""
        return self.engine.phase in WHY_SILENT

    def close(self):
        """Stop every drive, wait for the answers, then leave the line and the link.

        Ctrl-C does not cut this short, because a motor may be turning. It takes at most a second
        and a round of the bus. `idle` is not called any more.
        """
        self._idle = None
        try:
            leave(self.engine, self.clock, self.rest)
        finally:
            persist(self._pacer.stop if self._pacer else self._link.close)
            if self._link.bus is self:
                self._link.bus = None


def help():
    """Print every verb of a bus and of a drive."""
    from uss.bus import verbs  # here, because a program does without

    verbs.tell()


def _check_kind(kind):
    if kind not in (None, int, float):
        raise ValueError("kind is int or float, not %r" % (kind,))


def _check_speed(hertz, percent, rpm):
    """ValueError, TypeError unless exactly one speed is given, and is a finite number."""
    speeds = [speed for speed in (hertz, percent, rpm) if speed is not None]
    if len(speeds) != 1:
        raise ValueError("say one speed: hertz, percent or rpm")
    if not isinstance(speeds[0], (int, float)):
        raise TypeError("a speed is a number, not %r" % (speeds[0],))
    if speeds[0] - speeds[0] != 0:  # for a NaN or an infinity the difference is a NaN
        raise ValueError("a speed of %r" % speeds[0])


def _check_types(address, family, layout, scale):
    """TypeError if an argument of `Master.add` is of the wrong type."""
    if not isinstance(address, int):
        raise TypeError("an address is an integer 0...31, not %r" % (address,))
    if family is not None and not hasattr(family, "survey"):
        raise TypeError("a family is a class of uss.families, not %r" % (family,))
    if layout is not None and not isinstance(layout, Layout):
        raise TypeError("say layout=Layout(4, 2), not %r" % (layout,))
    if scale is not None and not isinstance(scale, Scale):
        raise TypeError("say scale=Scale(50.0), not %r" % (scale,))
