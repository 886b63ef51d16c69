# SPDX-License-Identifier: MIT
"""The blocks of the S7-200's USS library: USS_INIT, USS_CTRL, USS_RPM_W/D/R, USS_WPM_W/D/R.

For people who know that library. Each block is an object that you call once a scan, with its
inputs by name; its outputs are its attributes. The blocks stand on top of the engine, which goes
on by itself between the calls. The panel never imports them. README.md lists each pin and code.

    with Port(open_bus, board.clock) as port:   # open_bus(baud) answers a `master.Master`
        init, motor, frequency = USS_INIT(port), USS_CTRL(port), USS_RPM_R(port)
        while True:                             # the scan; however it ends, the motors stop
            port.scan()
            init(EN=True, MODE=1, BAUD=19200, ACTIVE=0b10)
            motor(EN=True, RUN=switch(), DRIVE=1, TYPE=1, SPEED_SP=50.0)
            frequency(EN=True, XMT_REQ=button(), DRIVE=1, PARAM=21)
            if motor.ERROR: print(codes.text(motor.ERROR))

Only the rising edge of RUN makes a motor run, and only if the drive can run at that moment. No
motor starts because power comes back, a drive answers again, a fault is acknowledged or the scan
goes on: RUN has to go off and on. No input raises an exception: a wrong value gives a code in
ERROR. Source: S7-200 system manual, USS library.
"""

from micropython import const

from uss import pkw, pzd
from uss.s7 import codes
from uss.families import MM3, MM4, drive_maker
from uss.master import DEAD_MAN_US, OFF
from uss.leave import leave, persist
from uss.s7.parameters import (  # noqa: F401  (also blocks of this library)
    Block,
    USS_RPM_D,
    USS_RPM_R,
    USS_RPM_W,
    USS_WPM_D,
    USS_WPM_R,
    USS_WPM_W,
)
from uss.scaling import Scale, run_words
from uss.telegram import NODE_MAX
from uss.timing import BAUD_RATES, elapsed
from uss.bits import may_start

USS = const(1)  # MODE of USS_INIT
PPI = const(0)  # the port is used for something else

TYPES = (MM3, MM4)  # what TYPE of USS_CTRL means: 0 and 1
DEFAULT_TYPE = const(1)  # TYPE of an active drive that no USS_CTRL has named yet

REST_US = const(100)  # between two looks at the bus in `close`

SPEED_LIMIT = const(200)  # percent
PERCENT = Scale()  # of full speed, 4000h


class Port:
    """The serial port that all blocks share.

    open_bus: function, baud -> a `Master` without drives on a link of that rate; it lets go of the
        one before, whose phase is OFF or CLOSED then. clock: of the board, see `hal`.
    types: the family for each value of TYPE, see `families`.
    polled: `scan` makes the engine go on. False: something else does, such as `hal.pacer`, which
        goes on even if the scan does not, and then stops the motors.

    Leaving `with` stops the motors, see `close`. Fields to look at: `bus` (None while the port is
    not set up for USS), `drives` and `families` (by address), `now` (the instant of this scan).
    For the blocks: `controls`, the USS_CTRL that commands each drive.
    """

    def __init__(self, open_bus, clock, types=TYPES, polled=True):
        self.bus = None
        self.now = 0
        self.drives = [None] * (NODE_MAX + 1)
        self.families = [types[min(DEFAULT_TYPE, len(types) - 1)]] * (NODE_MAX + 1)
        self.controls = [None] * (NODE_MAX + 1)
        self.job = None  # the parameter job of the block that was served last
        self._open_bus = open_bus
        self._clock = clock
        self._types = types
        self._polled = polled
        self._baud = 0
        self._leaving = None  # the bus that is being left
        self._following = None  # (baud, active) of the bus after it

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def scan(self):
        """Call this once at the beginning of every scan.

        If you do not call it for 300 ms, every motor is stopped; if you do not call a USS_CTRL for
        300 ms, its motor is. If `polled`, that happens only when you call `scan` again.
        """
        self.now = self._clock.ticks_us()
        bus = self._leaving or self.bus
        if bus is None:
            return
        self._go_on(bus, self.now)
        mask = self._clock.ticks_mask
        for control in self.controls:
            if control and elapsed(self.now, control.called_at, mask) > DEAD_MAN_US:
                control.leave()

    def close(self):
        """Stop every motor, wait for the drives' answers, and send nothing any more.

        It takes a second and a round of the bus at the most; Ctrl-C does not cut it short. After
        that the blocks say PORT_NOT_USS, and USS_INIT may begin anew. If not `polled`, the engine
        has to go on meanwhile: give the pacer a timer, and stop it afterwards. The link stays
        open.
        """
        persist(self._close)

    # --- for the blocks -------------------------------------------------------------------------

    def refusal(self, address):
        """Why no block may use the drive at this address: a status code, or NO_ERROR."""
        if self.bus is None:
            return codes.PORT_NOT_USS
        if not isinstance(address, int) or not 0 <= address <= NODE_MAX:
            return codes.ILLEGAL_ADDRESS
        if self.drives[address] is None:
            return codes.NOT_ACTIVE
        return codes.NO_ERROR

    def refusal_to(self, control, address, type_number):
        """Why this USS_CTRL may not command the drive at this address, as one of this TYPE."""
        refusal = self.refusal(address)
        if refusal:
            return refusal
        if self.controls[address] not in (None, control):
            return codes.INTERFERENCE
        return self._set_type(address, type_number)

    def is_busy(self):
        """Whether a parameter job is under way."""
        return self.job is not None and self.job.state == pkw.PENDING

    def is_waiting_for(self, job):
        """Whether this job is under way; not if the line was left before the job ended."""
        return self.job is job and job.state == pkw.PENDING

    def ask(self, drive, job):
        """Queue a parameter job. RuntimeError if the drive takes none."""
        drive.ask(job)
        self.job = job

    def set_up(self, mode, baud, active):
        """Begin to set the port up; return a code of `codes`. `is_set_up` tells when it is
        done."""
        refusal = self._refuses(mode, baud, active)
        if refusal:
            return refusal
        if mode == PPI:
            baud = active = 0
        if self.bus is None:
            if mode == USS:
                self._open(baud, active)
        elif baud == self._baud:
            self._activate(active)
        else:
            self._activate(0)
            self.bus.off()
            self._leaving = self.bus
            self._following = (baud, active)
            self.bus = self.job = None
        return codes.NO_ERROR

    def is_set_up(self):
        """Whether the change that was begun is complete."""
        if self._leaving is not None and self._leaving.phase == OFF:
            self._leaving = None
            baud, active = self._following
            if baud:
                self._open(baud, active)
        return self._leaving is None

    def _go_on(self, bus, now):
        if self._polled:
            try:
                bus.poll(now)  # before `refresh`, or the engine would not notice a scan that hung
            except BaseException:  # also Ctrl-C, which may have struck in the middle of `poll`
                bus.recover(now)
                raise
        bus.refresh(now)

    def _rest(self):
        self._go_on(self._leaving or self.bus, self._clock.ticks_us())
        self._clock.sleep_us(REST_US)

    def _close(self):
        bus = self._leaving or self.bus
        if bus is None:
            return
        leave(bus, self._clock, self._rest)
        for address in range(NODE_MAX + 1):
            self.drives[address] = self.controls[address] = None
        self._leaving = self.bus = self.job = None

    def _set_type(self, address, type_number):
        if not isinstance(type_number, int) or not 0 <= type_number < len(self._types):
            return codes.ILLEGAL_COMMAND
        family = self._types[type_number]
        if not family.layout.pzd_words:
            return codes.ILLEGAL_COMMAND
        if self.families[address] is family:
            return codes.NO_ERROR
        if self.is_busy():
            return codes.PORT_BUSY
        if self.drives[address].may_run():
            return codes.CHANGE_NOT_ALLOWED
        self._remove(address)
        self.families[address] = family
        self._add(address)
        return codes.NO_ERROR

    def _refuses(self, mode, baud, active):
        if not isinstance(mode, int) or mode not in (PPI, USS):
            return codes.PROTOCOL
        if mode == USS and (not isinstance(baud, int) or baud not in BAUD_RATES):
            return codes.BAUD_RATE
        if mode == USS and (not isinstance(active, int) or active < 0 or active >> NODE_MAX + 1):
            return codes.ILLEGAL_ADDRESS
        if self._leaving is not None or (self.is_busy() and not self.bus.is_line_in_use()):
            return codes.PORT_BUSY
        keeps = active if mode == USS and baud == self._baud else 0
        for drive in self.drives:
            if drive is not None and not keeps >> drive.address & 1 and drive.may_run():
                return codes.CHANGE_NOT_ALLOWED
        return codes.NO_ERROR

    def _open(self, baud, active):
        self.bus = self._open_bus(baud)
        self._baud = baud
        self.bus.refresh(self.now)
        self._activate(active)

    def _activate(self, active):
        for address in range(NODE_MAX + 1):
            is_active = active >> address & 1
            if is_active and self.drives[address] is None:
                self._add(address)
            elif not is_active and self.drives[address] is not None:
                self._remove(address)

    def _add(self, address):
        self.drives[address] = self.bus.turns.add(
            address, self.families[address].layout, drive_maker(self.families[address])
        )

    def _remove(self, address):
        self.bus.turns.remove(self.drives[address])
        self.drives[address] = None


class USS_INIT(Block):
    """Sets up the port, once for each rising edge of EN.

    MODE: 1 USS, 0 the port is for something else. BAUD: bits per second. ACTIVE: bit n is drive n.
    DONE: the last request is over; that may take a scan or more. ERROR: a code of `codes`;
    STATUS_WORD: that of the S7-1200. With an error nothing has changed.
    """

    def __init__(self, port):
        self.DONE = False
        self._port = port
        self._was_enabled = False
        self._is_at_work = False

    def __call__(self, EN=False, MODE=USS, BAUD=9600, ACTIVE=0):
        if EN and not self._was_enabled:
            self._tell(self._port.set_up(MODE, BAUD, ACTIVE))
            self._is_at_work = self.ERROR == codes.NO_ERROR
            self.DONE = not self._is_at_work
        self._was_enabled = bool(EN)
        if self._is_at_work and self._port.is_set_up():
            self._is_at_work = False
            self.DONE = True


class USS_CTRL(Block):
    """Commands one active drive and shows its state. Call it in every scan.

    RUN: its rising edge starts the motor; off is OFF1, down the ramp. OFF2: coast; OFF3: stop as
    fast as the drive can. Both stop the motor while they are on; after them RUN needs a new edge.
    F_ACK: its rising edge acknowledges a fault. DIR: the other direction. DRIVE: 0...31. TYPE: 0
    MICROMASTER 3, 1 MICROMASTER 4. SPEED_SP: percent of full speed, -200...200; a negative value
    reverses the direction. EN off: the block does nothing, and after 300 ms its motor is stopped.

    RESP_R: on for one scan when the drive has answered; only then do the next outputs change.
    STATUS: ZSW. SPEED: percent. RUN_EN, INHIBIT, FAULT: bits of ZSW; D_DIR: its bit 14, runs
    right. ERROR: a code of `codes`, of the inputs or of the last telegram; STATUS_WORD: the
    S7-1200's. An error of the inputs stops the motor, except SPEED_RANGE, with which the motor
    keeps its speed and direction. RUN_VOID, which Siemens does not have: RUN is on but starts
    nothing; it has to go off and on.
    """

    def __init__(self, port):
        self.RESP_R = False
        self.STATUS = 0
        self.SPEED = 0.0
        self.RUN_EN = False
        self.D_DIR = False
        self.INHIBIT = False
        self.FAULT = False
        self.RUN_VOID = False
        self.called_at = 0  # the instant of the scan in which it was called last
        self._port = port
        self._drive = None
        self._family = None  # of this drive
        self._run = True  # RUN in the last scan
        self._f_ack = True
        self._counters = None  # of the drive, in the last scan
        self._reply_code = codes.NO_ERROR

    def __call__(
        self, EN=True, RUN=False, OFF2=False, OFF3=False, F_ACK=False, DIR=False, DRIVE=0, TYPE=1,
        SPEED_SP=0.0,
    ):  # fmt: skip
        self.RESP_R = False
        if not EN:
            return
        error = self._take_drive(DRIVE, TYPE)
        if error:
            self.RUN_VOID = bool(RUN)
        else:
            off = pzd.OFF2 if OFF2 else pzd.OFF3 if OFF3 else pzd.OFF1
            error = self._command(RUN, off, DIR, SPEED_SP)
            if F_ACK and not self._f_ack:
                self._drive.acknowledge()
            self._f_ack = bool(F_ACK)
            self._report()
        self._tell(error or self._reply_code)

    def leave(self):
        """Stop the motor and let the drive go."""
        drive = self._drive
        if drive is None:
            return
        if drive.wanted:
            drive.stop()
        self._port.controls[drive.address] = None
        self._drive = None

    def _take_drive(self, address, type_number):
        """Command the drive at this address and no other; return a code."""
        port = self._port
        self.called_at = port.now
        error = port.refusal_to(self, address, type_number)
        drive = None if error else port.drives[address]
        if drive is not self._drive:
            self.leave()
            if drive is not None:
                self._begin(drive)
        return error

    def _begin(self, drive):
        self._drive = drive
        self._family = self._port.families[drive.address]
        self._port.controls[drive.address] = self
        # An input that is already on has no rising edge: it may have been on since before
        # power-on.
        self._run = True
        self._f_ack = True
        self._reply_code = codes.NO_ERROR
        self._counters = list(drive.counters)

    def _command(self, run, off, reverse, speed):
        """Pass the inputs on to the drive; return a code: SPEED_RANGE for a bad setpoint."""
        drive = self._drive
        rises = run and not self._run
        self._run = bool(run)
        is_number = isinstance(speed, (int, float))
        in_range = is_number and -SPEED_LIMIT <= speed <= SPEED_LIMIT  # False for a NaN
        run_allowed = run and off == pzd.OFF1
        if off != drive.off or (drive.wanted and not run_allowed):
            drive.stop(off)
        elif run_allowed and in_range:
            stw, hsw = run_words(self._family, PERCENT.from_percent(speed), bool(reverse))
            if self._is_followed():
                drive.hsw = hsw
                if stw != drive.wanted:
                    drive.turn(stw)
            elif rises and drive.contact and may_start(drive.zsw):
                drive.start(hsw, stw)
        self.RUN_VOID = bool(run) and not self._is_followed()
        return codes.NO_ERROR if in_range else codes.SPEED_RANGE

    def _is_followed(self):
        """Whether the drive is being told to run."""
        return self._drive.wanted != 0 and not self._drive.stopped_by_engine()

    def _report(self):
        """Set the outputs, as far as there is news of the drive."""
        drive = self._drive
        counters = list(drive.counters)  # replies that come from now on are for the next scan
        if drive.silent:
            self._reply_code = codes.of_reply(counters, self._counters) or self._reply_code
        elif self._port.bus.is_line_in_use():
            self._reply_code = codes.PORT_BUSY
        else:
            self._reply_code = codes.NO_ERROR
        self.RESP_R = counters[0] != self._counters[0]
        self._counters = counters
        if self.RESP_R:
            self.STATUS = drive.word(1)
            zsw = drive.zsw
            self.SPEED = PERCENT.percent(pzd.signed_hiw(self._family, drive.hiw, zsw))
            self.RUN_EN = zsw & pzd.ZSW_RUNNING != 0
            self.D_DIR = zsw & pzd.ZSW_RUNS_RIGHT != 0
            self.INHIBIT = zsw & pzd.ZSW_INHIBIT != 0
            self.FAULT = zsw & pzd.ZSW_FAULT != 0
