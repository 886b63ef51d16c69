# SPDX-License-Identifier: MIT
"""The blocks and structures of a published B&R project for USS, under their names.

For people who know that project. DriveController is called once a scan; DriveSetup, DriveSequence
and DriveData are its structures, indexed by the drive's address. It stands on top of the engine,
which goes on by itself between the calls. The panel never imports it. README.md lists each member
and code. The blocks for telegrams of your own are in `blocks`.

    with DriveController(open_bus, board.clock) as controller:  # open_bus() -> a `master.Master`
        controller.DriveSequence.ControllSequence[1] = 1        # the rest is 255 already
        controller.Cmd.Start = True
        while True:                                 # the scan; however it ends, the motors stop
            wanted = controller.DriveSetup[1].PZD
            wanted.Freq, wanted.Run = 25.0, switch()
            controller()
            print(controller.DriveData[1].StatusWord.DriveRunning, controller.Status.ErrorID)

Only the rising edge of Run, or of a jog, makes a motor run, and only if the drive can run at that
moment. No motor starts because power comes back, a drive answers again, a fault or an error is
acknowledged or the scan goes on. No member raises an exception: a wrong value gives a code.
Source: D. Matocha, bachelor thesis, Liberec 2019; see `codes`.
"""

from micropython import const

from uss import pzd
from uss.bits import may_start
from uss.br import codes
from uss.br.blocks import Status, check_frequency, check_lengths, is_word, setpoint, take_speed
from uss.br.structures import (
    ADDRESSES,
    RESTART,
    SEQUENCE_MAX,
    DriveData,
    DriveSequence,
    DriveSetup,
)
from uss.families import G110, drive_maker
from uss.layout import Layout
from uss.leave import leave, persist
from uss.master import CLOSED, OFF
from uss.scaling import run_words

REST_US = const(100)  # between two looks at the bus in `close`
_NOTHING = const(0)  # no control word that moves a motor


class ControllerCommands:
    """Start, Stop: by their rising edge; Stop goes first. ErrorAcknowledge: while it is on."""

    def __init__(self):
        self.Start = False
        self.Stop = False
        self.ErrorAcknowledge = False


class DriveController:
    """The dispatcher. Call it once a scan.

    open_bus: function -> a `Master` without drives; called once, by the first Start. clock: of the
    board, see `hal`. families: by address, {1: MM440}; a G110, the drive of the source, for all
    others. polled: a call makes the engine go on. False: something else does, such as `hal.pacer`,
    which goes on even if the scan does not, and then stops the motors.

    Status.Ready: it may be started. Busy: it is at work. Done: it was stopped, and the line is
    left. Error, ErrorID: the first thing that was wrong since the last ErrorAcknowledge; the bus
    goes on meanwhile. Leaving `with` stops the motors, see `close`. `bus`: None before Start.
    """

    def __init__(self, open_bus, clock, families=None, polled=True):
        self.Cmd = ControllerCommands()
        self.Status = Status()
        self.DriveSetup = [DriveSetup() for _ in range(ADDRESSES)]
        self.DriveSequence = DriveSequence()
        self.DriveData = [DriveData() for _ in range(ADDRESSES)]
        self.bus = None
        self._open_bus = open_bus
        self._clock = clock
        self._polled = polled
        self._families = families or {}
        self._motors = {}  # by address, of the drives that have turns
        self._sequence = ()  # as it was read last
        self._arranged = None  # as it was made the circulating list
        self._was_started = True  # what is on already has no rising edge
        self._was_stopped = True
        self._failures = 0
        self._is_leaving = False

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def __call__(self):
        """If you do not call it for 300 ms, every motor is stopped. If `polled`, that happens only
        when you call it again."""
        command, status = self.Cmd, self.Status
        if self.bus is not None:
            self._go_on()
        if command.ErrorAcknowledge and status.Error:
            status.Error = False
            status.ErrorID = codes.NO_ERROR
        starts = command.Start and not self._was_started
        stops = command.Stop and not self._was_stopped
        self._was_started, self._was_stopped = bool(command.Start), bool(command.Stop)
        if stops and status.Busy:
            self.bus.off()
            self._is_leaving = True
            self._motors_forget()
        elif starts and status.Ready and not command.Stop:
            self._begin()
        if status.Busy:
            self._serve()

    def close(self):
        """Stop every motor, wait for the drives' answers, and send nothing any more.

        It takes a second and a round of the bus at the most; Ctrl-C does not cut it short. If not
        `polled`, the engine has to go on meanwhile: give the pacer a timer, and stop it
        afterwards. The link stays open.
        """
        persist(self._close)

    # --- the line -------------------------------------------------------------------------------

    def _begin(self):
        status = self.Status
        if self.bus is None or self.bus.phase == CLOSED:
            self.bus = self._open_bus()
            self._motors = {}
            self._failures = 0
            self._go_on()
        else:
            self.bus.on()
        self._is_leaving = False
        status.Ready = status.Done = False
        status.Busy = True

    def _go_on(self):
        now = self._clock.ticks_us()
        bus = self.bus
        if self._polled:
            try:
                bus.poll(now)  # before `refresh`, or the engine would not notice a scan that hung
            except OSError:  # the port: the engine begins anew, with every motor stopped
                bus.recover(now)
            except BaseException:  # also Ctrl-C, which may have struck in the middle of `poll`
                bus.recover(now)
                raise
        bus.refresh(now)

    def _rest(self):
        self._go_on()
        self._clock.sleep_us(REST_US)

    def _close(self):
        if self.bus is not None and self.bus.phase != CLOSED:
            leave(self.bus, self._clock, self._rest)
        self._motors_forget()
        self.Status.clear()

    def _motors_forget(self):
        for address, motor in self._motors.items():
            motor.forget()
            self.DriveData[address].Status.Receive = False

    # --- a scan ---------------------------------------------------------------------------------

    def _serve(self):
        bus, status = self.bus, self.Status
        if bus.phase == OFF:
            status.Busy = False
            status.Done = status.Ready = True
            return
        if bus.failures != self._failures:
            self._failures = bus.failures
            self._fail(codes.READ_FAILED)
        if self._is_leaving:
            return
        self._arrange()
        for address, motor in self._motors.items():
            setup = self.DriveSetup[address]
            code = check_lengths(setup.Lengh)
            self._fail(code)
            self._fail(motor.command(setup.PZD, not code and address in self._sequence))
            if motor.report(self.DriveData[address], setup.PZD):
                self.DriveSequence.ADDR = address

    def _fail(self, code):
        """Keep the first code, until it is acknowledged."""
        status = self.Status
        if code and not status.Error:
            status.Error = True
            status.ErrorID = code

    def _arrange(self):
        """Make ControllSequence the circulating list. A drive that is no more in it, or whose
        lengths have changed, is stopped first and leaves when it stands."""
        self._read_sequence()
        turns = self.bus.turns
        for address in list(self._motors):
            drive = self._motors[address].drive
            if address in self._sequence and self._is_as_set_up(drive):
                continue
            if drive.wanted:
                drive.stop()
            if not drive.may_run() and drive.stops == drive.stops_sent:
                turns.remove(drive)
                del self._motors[address]
                self.DriveData[address].Status.Receive = False
        for address in self._sequence:
            if address not in self._motors:
                self._add(address)
        wanted = [address for address in self._sequence if address in self._motors]
        wanted += [address for address in self._motors if address not in self._sequence]
        if wanted != self._arranged:
            turns.arrange([self._motors[address].drive for address in wanted])
            self._arranged = wanted

    def _read_sequence(self):
        """With a wrong entry the one before stays."""
        read = []
        for entry in self.DriveSequence.ControllSequence[1 : SEQUENCE_MAX + 1]:
            if entry == RESTART:
                break
            if not is_word(entry, ADDRESSES - 1):
                self._fail(codes.ADDRESS)
                return
            read.append(entry)
        self._sequence = read

    def _is_as_set_up(self, drive):
        """Whether its telegrams are divided as DriveSetup says, unless that is wrong."""
        lengths, layout = self.DriveSetup[drive.address].Lengh, drive.layout
        if check_lengths(lengths):
            return True
        return (layout.pkw_words, layout.pzd_words) == (lengths.PKW_lengh, lengths.PZD_lengh)

    def _add(self, address):
        lengths = self.DriveSetup[address].Lengh
        code = check_lengths(lengths)
        if code:
            self._fail(code)
            return
        layout = Layout(lengths.PKW_lengh, lengths.PZD_lengh)
        family = self._families.get(address, G110)
        self._motors[address] = _Motor(
            self.bus.turns.add(address, layout, drive_maker(family)), family
        )
        self._arranged = None


class _Motor:
    """A drive of the bus, and what DriveSetup wanted of it in the last scan."""

    def __init__(self, drive, family):
        self.drive = drive
        self._family = family
        self._wanted = True  # what is on already has no rising edge
        self._acknowledge = True
        self._counters = list(drive.counters)

    def forget(self):
        """Whatever is on has no rising edge any more."""
        self._wanted = self._acknowledge = True

    def command(self, wanted, may_run):
        """Pass the members of DriveSetup[adr].PZD on; answer the code of what is wrong with them.

        may_run: False if something else is wrong, so that the motor must stop.
        """
        drive = self.drive
        code = check_frequency(wanted)
        stw = hsw = _NOTHING
        if not code and may_run and drive.layout.pzd_words:
            stw, hsw = self._words(wanted)
        rises = stw != _NOTHING and not self._wanted
        # An error stops the motor, and uses up what is on.
        self._wanted = bool(wanted.Run or wanted.JOGRight or wanted.JOGLeft)
        if stw == _NOTHING or drive.wanted and not self._goes_on(stw):
            if drive.wanted:
                drive.stop()
        elif drive.wanted and not drive.stopped_by_engine():
            drive.hsw = hsw
            if stw != drive.wanted:
                drive.turn(stw)
        elif rises and drive.contact and may_start(drive.zsw):
            drive.start(hsw, stw)
        if wanted.FaultAcknowledge and not self._acknowledge:
            drive.acknowledge()
        self._acknowledge = bool(wanted.FaultAcknowledge)
        return code

    def _goes_on(self, stw):
        """Whether a motor that is told to run may be told this instead: Run and a jog, or the two
        jogs, do not become one another."""
        both_run = stw & self.drive.wanted & pzd.STW_ON
        return both_run or stw == self.drive.wanted

    def _words(self, wanted):
        """STW and HSW; two jogs at once are none, and with Run there is no jog."""
        family = self._family
        if wanted.Run:
            return run_words(family, setpoint(wanted), bool(wanted.Reverse))
        if bool(wanted.JOGRight) != bool(wanted.JOGLeft):
            return (family.jog_right if wanted.JOGRight else family.jog_left), _NOTHING
        return _NOTHING, _NOTHING

    def report(self, data, wanted):
        """Set DriveData[adr]; answer whether there is news of the drive."""
        drive = self.drive
        counters = list(drive.counters)
        if drive.silent:
            said = codes.of_reply(counters, self._counters)
            data.Status.ErrorID = said or data.Status.ErrorID
        elif drive.contact:
            data.Status.ErrorID = codes.NO_ERROR
        data.Status.Receive = drive.contact and not drive.silent
        is_news = counters[0] != self._counters[0]
        self._counters = counters
        if is_news and drive.layout.pzd_words:
            zsw, hiw = drive.zsw, drive.hiw
            data.StatusWord.take(zsw)
            if not check_frequency(wanted):
                count = pzd.signed(pzd.signed_hiw(self._family, hiw, zsw))
                take_speed(data.ActualValue, hiw, count, wanted.RefFreq)
        return is_news
