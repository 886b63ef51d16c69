"""The process data of a simulated drive: from STW and HSW to a turning motor, ZSW and HIW.

Control and status words are those of the USS specification (C-5.2.1) with the MICROMASTER 4's own
bits (r0052 ... r0054), the status words as recorded on real drives. It knows no telegrams and no
parameter tasks; drive.py hands it the PZD words.

    process.accept([0x047F, 0x2000])    # PZD words as received
    process.words(2)                    # PZD words to send: ZSW and HIW, as P2019 has them

Nothing runs in the background: what time does (a ramp ends, pulses go off) is worked out when
somebody asks, for the instant at which it happened.
"""

from boards.sim.motor import Motor

# Control word 1. OFF2 and OFF3 are low-active commands.
ON = 0x0001
NO_OFF2 = 0x0002
NO_OFF3 = 0x0004
PULSES = 0x0008
RAMP_OUTPUT = 0x0010
RAMP_RUN = 0x0020
SETPOINT = 0x0040
ACKNOWLEDGE = 0x0080
JOG_RIGHT = 0x0100
JOG_LEFT = 0x0200
JOG = JOG_RIGHT | JOG_LEFT
BY_PLC = 0x0400
REVERSE = 0x0800

# States, named as in a report.
INHIBITED = "inhibited"
READY = "ready"
READY_TO_RUN = "ready to run"
RUNNING = "running"
STOPPING = "stopping"
FAULT = "fault"
OFF = "off"

# Status word 1: bits 0 to 3 and 6, which exclude each other on a MICROMASTER 4.
STATE_BITS = {
    INHIBITED: 0x0041,
    READY: 0x0001,
    READY_TO_RUN: 0x0002,
    RUNNING: 0x0004,
    STOPPING: 0x0004,
    FAULT: 0x0048,
}
ZSW_NO_OFF2 = 0x0010
ZSW_NO_OFF3 = 0x0020
ZSW_WARNING = 0x0080
ZSW_NO_DEVIATION = 0x0100
ZSW_AT_MAXIMUM = 0x0400
ZSW_RIGHT = 0x4000
# Bits that never change here: 9 control requested, 11 no current limit, 12 (1 in every capture),
# 13 no motor overload, 15 no inverter overload.
ZSW_ALWAYS = 0xBA00

# Status word 2: 7 DC link voltage in order, 10 technology controller at its minimum, being off.
ZSW2_ALWAYS = 0x0480

# P0700: what the drive obeys instead of the COM link. Open terminals and an untouched keypad say
# OFF1 and nothing worse; a link on which nobody ever spoke says 0000.
NO_COMMAND = NO_OFF2 | NO_OFF3 | PULSES | RAMP_OUTPUT | RAMP_RUN | SETPOINT
OTHER_SOURCES = {0: NO_COMMAND, 1: NO_COMMAND, 2: NO_COMMAND, 4: 0, 6: 0}
COM_LINK = 5


class Process:
    """state    one of the names above
    starts   how often the pulses were switched on
    image    the process data in force, by word: STW, HSW and what P2012 adds
    faults   r0947: the present trip in the first two places, older ones behind, two places each
    """

    def __init__(self, clock, parameters):
        self._clock = clock
        self._ram = parameters.ram
        self._motor = Motor()
        self.starts = 0
        self.image = [0, 0, 0, 0]
        self.faults = [0] * 8
        self.state = OFF
        self._jogging = False  # running, or stopping, on a JOG command
        self._off3 = False  # stopping on OFF3, which cannot be taken back
        self._previous = 0

    def power_on(self):
        """Everything in the image is 0: OFF2, OFF3, inhibited. A fault counts as acknowledged."""
        self._file_faults()
        self.image = [0, 0, 0, 0]
        self.state = INHIBITED
        self._jogging = self._off3 = False
        self.refresh()

    def power_off(self):
        self._pulses_off(OFF)

    # Process data in

    def accept(self, words):
        """Take over the PZD words of a telegram, unless STW bit 10 declares them invalid."""
        if words and words[0] & BY_PLC:
            self.image[: len(words)] = words
            self._obey()

    def accept_broadcast(self, enable, words):
        """Take over what the enable array (a, b, c, d) of a broadcast lets through.

        The array is the specification's (A-3, C-5.2.3 and appendix): bit 0 of a is the flag, its
        other bits name the words; b and c are bit masks for PZD1 and PZD4.
        """
        if not enable[0] & 1:
            return
        masks = {0: enable[1], 3: enable[2]}  # PZD1 and PZD4 are taken bit by bit
        merged = []
        for i in range(len(words)):
            mask = masks.get(i, 0xFFFF) if enable[0] >> (i + 1) & 1 else 0
            merged.append(self.image[i] & ~mask | words[i] & mask)
        self.accept(merged)

    def refresh(self):
        """A parameter changed: go by it from now on. No command counts as given by that."""
        self._previous = self.command_word()
        self._command(self._previous, 0)

    def trip(self, number):
        """A fault: pulses off at once. One more before it is acknowledged is noted beside it."""
        if not self.faults[0]:
            self.faults[0] = number
        elif number != self.faults[0] and not self.faults[1]:
            self.faults[1] = number
        self._pulses_off(FAULT)

    # Process data out

    def words(self, count):
        """The first `count` PZD words of a reply, by P2019."""
        return [self._word(i) for i in range(count)]

    def _word(self, place):
        number = self._ram[2019][place] >> 16
        if number in (20, 21, 24):
            hz = self.setpoint_hz() if number == 20 else self.hz()
            return self._scaled(hz, place == 1 and self._ram[2009][0])
        if number == 52:
            return self.zsw()
        if number == 53:
            return self.zsw2()
        return self.command_word() if number == 54 else 0

    def _scaled(self, hz, absolute):
        value = round(hz * 100) if absolute else round(hz * 16384 / self._ram[2000][0])
        return max(-32768, min(32767, value)) & 0xFFFF

    def zsw(self):
        """Status word 1, r0052."""
        hz = self.hz()
        if self.state == OFF:
            return 0
        stw = self.command_word()
        zsw = ZSW_ALWAYS | STATE_BITS[self.state]
        if stw & NO_OFF2:
            zsw |= ZSW_NO_OFF2
        if stw & NO_OFF3 and not self._off3:
            zsw |= ZSW_NO_OFF3
        # Before the first PZD the captures warn. Two JOG commands at once are warning A0923.
        if not stw or stw & JOG == JOG and not stw & ON:
            zsw |= ZSW_WARNING
        if abs(self.setpoint_hz() - hz) <= self._ram[2164][0]:
            zsw |= ZSW_NO_DEVIATION
        if abs(hz) >= self._ram[1082][0]:
            zsw |= ZSW_AT_MAXIMUM
        if hz >= 0:
            zsw |= ZSW_RIGHT
        return zsw

    def zsw2(self):
        """Status word 2, r0053."""
        hz = self.hz()
        if self.state == OFF:
            return 0
        size = abs(hz)
        zsw2 = ZSW2_ALWAYS
        zsw2 |= 0x0002 if size > self._ram[2167][0] else 0
        zsw2 |= 0x0004 if size > self._ram[1080][0] else 0
        zsw2 |= 0x0010 if size > self._ram[2155][0] else 0x0020
        zsw2 |= 0x0040 if size >= abs(self.setpoint_hz()) else 0
        zsw2 |= 0x0200 if self._clock.now_us >= self._motor.end_us else 0
        return zsw2

    def hz(self):
        """The frequency of the motor now, signed."""
        self._pass_time()
        return self._motor.hz(self._clock.now_us)

    def setpoint_hz(self):
        """The frequency that the ramp generator is given, within P1080 and P1082: r0020."""
        stw = self.command_word()
        if self._jogging and self.state == RUNNING:
            if stw & JOG == JOG:
                return self.hz()
            return self._limited(-self._ram[1059][0] if stw & JOG_LEFT else self._ram[1058][0], 0)
        sources = self._ram[1000][0]
        hz = self._source_hz(sources % 10) + self._source_hz(sources // 10)
        if stw & REVERSE:
            hz = -hz
        return self._limited(hz, stw & REVERSE)

    # Setpoint channel

    def _source_hz(self, source):
        if source == 1:
            return self._ram[1040][0]  # nobody turns the potentiometer
        if source != COM_LINK:
            return 0.0  # terminals without a signal, links on which nobody talks
        hsw = self.image[1]
        if hsw & 0x8000:
            hsw -= 0x10000
        return hsw / 100 if self._ram[2009][0] else hsw * self._ram[2000][0] / 16384

    def _limited(self, hz, reverse):
        size = min(max(abs(hz), self._ram[1080][0]), self._ram[1082][0])
        if not size:
            return 0.0
        return -size if hz < 0 or not hz and reverse else size

    # State machine

    def command_word(self):
        """The control word that is obeyed, r0054: that of the COM link if P0700 says so."""
        return OTHER_SOURCES.get(self._ram[700][0], self.image[0])

    def _obey(self):
        stw = self.command_word()
        rising = stw & ~self._previous
        self._previous = stw
        self._command(stw, rising)

    def _command(self, stw, rising):
        """One step of the state machine: `rising` are the bits that have just gone to 1."""
        self._pass_time()
        if self.state == OFF:
            return
        if self.state == FAULT:
            if rising & ACKNOWLEDGE:
                self._file_faults()
                self.state = INHIBITED
        elif not stw & NO_OFF2:
            self._pulses_off(INHIBITED)
        elif not stw & NO_OFF3:
            self._quick_stop(stw)
        elif self.state == INHIBITED:
            if not stw & ON:
                self.state = READY
        elif self._ram[10][0]:
            self._step(stw & ~(ON | JOG), 0)  # commissioning: the motor must not run
        else:
            self._step(stw, rising)
        self._steer(stw)

    def _quick_stop(self, stw):
        if self.state in (RUNNING, STOPPING) and stw & PULSES:
            self.state = STOPPING
            self._off3 = True
        else:
            self._pulses_off(INHIBITED)

    def _step(self, stw, rising):
        """The states in which neither OFF2 nor OFF3 nor a fault has the word."""
        jog = stw & JOG in (JOG_RIGHT, JOG_LEFT) and rising & JOG and not stw & ON
        if self.state == READY:
            if rising & ON and not stw & PULSES:
                self.state = READY_TO_RUN
            elif stw & PULSES and (rising & ON or jog):
                self._start(jog)
        elif self.state == READY_TO_RUN:
            if not stw & ON:
                self.state = READY
            elif stw & PULSES:
                self._start(False)
        elif not stw & PULSES:
            on = self.state == RUNNING and stw & ON
            self._pulses_off(INHIBITED if self._off3 else READY_TO_RUN if on else READY)
        elif self.state == RUNNING:
            if rising & ON:
                self._jogging = False
            elif not stw & (JOG if self._jogging else ON):
                self.state = STOPPING
        elif not self._off3 and (rising & ON or self._jogging and jog):
            self.state = RUNNING
            self._jogging = not rising & ON

    def _start(self, jogging):
        self.state = RUNNING
        self._jogging = bool(jogging)
        self.starts += 1

    def _file_faults(self):
        if self.faults[0]:
            self.faults[:] = [0, 0] + self.faults[:6]

    def _pulses_off(self, state):
        self.state = state
        self._jogging = self._off3 = False
        self._motor.coast(self._clock.now_us)

    def _pass_time(self):
        """At standstill, whatever stopped it, the pulses go off."""
        if self.state == STOPPING and self._clock.now_us >= self._motor.end_us:
            self._pulses_off(INHIBITED if self._off3 else READY)

    def _steer(self, stw):
        """Give the motor its course: ramp times are for 0...P1082."""
        ram = self._ram
        now_us = self._clock.now_us
        full_hz = ram[1082][0]
        up_s, down_s = ram[1120][0], ram[1121][0]
        if self._jogging:
            up_s, down_s = ram[1060][0], ram[1061][0]
        if self.state == STOPPING:
            if self._off3:
                down_s = ram[1135][0]
            self._motor.ramp(now_us, 0.0, full_hz, up_s, down_s)
            self._pass_time()
        elif self.state != RUNNING:
            self._motor.coast(now_us)
        elif not stw & RAMP_OUTPUT:
            self._motor.jump(now_us, 0.0)
        elif not stw & RAMP_RUN or self._jogging and stw & JOG == JOG:
            self._motor.hold(now_us)
        else:
            target_hz = self.setpoint_hz() if stw & SETPOINT else 0.0
            self._motor.ramp(now_us, target_hz, full_hz, up_s, down_s)
