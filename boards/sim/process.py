"""The process data of a simulated drive: from STW and HSW to a turning motor, ZSW and HIW.

Control and status words are those of the USS specification (C-5.2.1) with the bits of the drive's
own family (mm420.py tells how a family says so), the status words as recorded on real drives. It
knows no telegrams and no parameter tasks; drive.py hands it the PZD words.

    process.accept([0x047F, 0x2000])    # PZD words as received
    process.words(2)                    # PZD words to send: ZSW and HIW, or as P2019 has them

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
RIGHT, LEFT = 0x0800, 0x1000  # of a family with a bit for each direction

# States, named as in a report.
INHIBITED = "inhibited"
READY = "ready"
READY_TO_RUN = "ready to run"
RUNNING = "running"
STOPPING = "stopping"
FAULT = "fault"
OFF = "off"

# Bits of status word 1 that no family has elsewhere.
ZSW_NO_OFF2 = 0x0010
ZSW_NO_OFF3 = 0x0020
ZSW_WARNING = 0x0080
ZSW_NO_DEVIATION = 0x0100
ZSW_REACHED = 0x0400
ZSW_RIGHT = 0x4000

# Status word 2: 7 DC link voltage in order, 10 technology controller at its minimum, being off.
ZSW2_ALWAYS = 0x0480

# What an obeyed source says that is not this bus: open terminals and an untouched keypad say OFF1
# and nothing worse; a link on which nobody ever spoke says 0000.
NO_COMMAND = NO_OFF2 | NO_OFF3 | PULSES | RAMP_OUTPUT | RAMP_RUN | SETPOINT

# Setpoint sources that make a difference here.
POTENTIOMETER, COM_LINK = 1, 5

# What a reading shows, and a PZD word carries: the second column of a family's READINGS.
NOTHING = "nothing"
STATUS_1, STATUS_2 = "status word 1", "status word 2"
CONTROL_1, CONTROL_2 = "control word 1", "control word 2"
WANTED, ACTUAL = "frequency wanted", "actual frequency"
RECEIVED = "word received"
FAULTS = "fault numbers"
COUNTERS = "telegram counters"

STEPS = 0  # in the place of a divisor: a frequency in 0.1 Hz, or in 0.01 Hz as `scaling` says

WORDS = 16  # process data words, at most
PLAIN = (STATUS_1, ACTUAL) + (NOTHING,) * (WORDS - 2)


class Process:
    """state    one of the names above
    starts   how often the pulses were switched on
    image    the process data in force, by word: STW, HSW and what the layout adds
    faults   r0947: the present trip in the first two places, older ones behind, two places each

    The settings that it goes by are attributes, in Hz and seconds, taken from the parameters
    whenever one of these has changed.
    """

    # What a family has that cannot set it.
    commissioning = 0
    command_source = setpoint_source = COM_LINK
    scaling = 0
    potentiometer_hz = 0.0
    jog_right_hz = jog_left_hz = 5.0
    jog_up_s = jog_down_s = 10.0
    minimum_hz = 0.0
    off3_s = 5.0
    tolerance_hz = 3.0  # of ZSW bit 8
    slow_hz = 1.0  # ZSW2 bit 1
    threshold_hz = 30.0  # ZSW2 bits 4, 5

    def __init__(self, clock, parameters, family):
        self._clock = clock
        self._ram = parameters.ram
        self._family = family
        self._motor = Motor()
        self.starts = 0
        self.image = [0] * WORDS
        self.faults = [0] * 8
        self.state = OFF
        self._jogging = False  # running, or stopping, on a JOG command
        self._off3 = False  # stopping on OFF3, which cannot be taken back
        self._previous = 0
        style = family.STYLE
        self._state_bits = style["states"]
        self._right_at_zero = style["right at zero"]
        self._signed = style["signed"]
        self._two_directions = style["two directions"]
        self._obeyed_bits = style["obeyed bits"]
        self._control_fault = style["control fault"]
        self._take_settings()

    def power_on(self):
        """Everything in the image is 0: OFF2, OFF3, inhibited. A fault counts as acknowledged."""
        self._file_faults()
        self.image = [0] * WORDS
        self.state = INHIBITED
        self._jogging = self._off3 = False
        self.refresh()

    def power_off(self):
        self._pulses_off(OFF)

    # Process data in

    def accept(self, words):
        """Take over the PZD words of a telegram, unless STW bit 10 declares them invalid."""
        if not words:
            return
        if words[0] & BY_PLC:
            self.image[: len(words)] = words
            self._obey()
        elif self._control_fault and self.state == RUNNING:
            self.trip(self._control_fault)

    def accept_broadcast(self, enable, words):
        """Take over what the enable array (a, b, c, d) of a broadcast lets through.

        The array is the specification's (A-3, C-5.2.3 and appendix): bit 0 of a is the flag, its
        other bits name PZD1 ... PZD15; b, c and d are bit masks for PZD1, PZD4 and PZD5. There is
        no bit for PZD16.
        """
        if not enable[0] & 1:
            return
        masks = {0: enable[1], 3: enable[2], 4: enable[3]}  # these are taken bit by bit
        merged = []
        for i in range(len(words)):
            mask = masks.get(i, 0xFFFF) if enable[0] >> (i + 1) & 1 else 0
            merged.append(self.image[i] & ~mask | words[i] & mask)
        self.accept(merged)

    def refresh(self):
        """A parameter changed: go by it from now on. No command counts as given by that."""
        self._take_settings()
        self._previous = self.command_word()
        self._command(self._previous, 0)

    def trip(self, number):
        """A fault: pulses off at once. One more before it is acknowledged is noted beside it."""
        if not self.faults[0]:
            self.faults[0] = number
        elif number != self.faults[0] and not self.faults[1]:
            self.faults[1] = number
        self._pulses_off(FAULT)

    def acknowledge(self):
        """The fault counts as seen; its cause is gone."""
        if self.state == FAULT:
            self._file_faults()
            self.state = INHIBITED

    def steps_per_hz(self):
        """Of a family whose frequencies are whole numbers."""
        return 100 if self.scaling else 10

    def _take_settings(self):
        ram = self._ram
        family = self._family
        for name, number, divisor in family.SETTINGS:
            value = ram[number][0]
            if divisor != 1:
                value = value / (divisor or self.steps_per_hz())
            setattr(self, name, value)
        self._other_command = family.OTHER_COMMANDS.get(self.command_source)
        source = family.SETPOINT_SOURCES.get(self.setpoint_source, self.setpoint_source)
        self._sources = (source % 10, source // 10)  # main, additional
        self._absolute = self.scaling == family.STYLE["absolute"]
        self._sent = PLAIN
        if family.LINK["sent"]:
            readings = family.READINGS
            self._sent = [readings.get(n >> 16, (NOTHING,))[0] for n in ram[family.LINK["sent"]]]

    # Process data out

    def words(self, count):
        """The first `count` PZD words of a reply."""
        return [self._word(i) for i in range(count)]

    def _word(self, place):
        sent = self._sent
        what = sent[place] if place < len(sent) else NOTHING
        if what == STATUS_1:
            return self.zsw()
        if what == ACTUAL:
            return self._scaled(self.hz(), place)
        if what == WANTED:
            return self._scaled(self.setpoint_hz(), place)
        if what == STATUS_2:
            return self.zsw2()
        if what == CONTROL_1:
            return self.command_word()
        return self.image[3] if what == CONTROL_2 else 0

    def _scaled(self, hz, place):
        if not self._signed:
            hz = abs(hz)
        absolute = place == 1 and self._absolute
        value = round(hz * 100) if absolute else round(hz * 16384 / self.reference_hz)
        return max(-32768, min(32767, value)) & 0xFFFF

    def zsw(self):
        """Status word 1, r0052."""
        hz = self.hz()
        if self.state == OFF:
            return 0
        stw = self.command_word()
        zsw = self._state_bits[self.state]
        if stw & NO_OFF2:
            zsw |= ZSW_NO_OFF2
        if stw & NO_OFF3 and not self._off3:
            zsw |= ZSW_NO_OFF3
        # Before the first PZD the captures warn. Two JOG commands at once are warning A0923.
        if not stw or stw & JOG == JOG and not stw & ON:
            zsw |= ZSW_WARNING
        if abs(self.setpoint_hz() - hz) <= self.tolerance_hz:
            zsw |= ZSW_NO_DEVIATION
        if abs(hz) >= self.reached_hz:
            zsw |= ZSW_REACHED
        if hz > 0 or not hz and self._right_at_zero:
            zsw |= ZSW_RIGHT
        return zsw

    def zsw2(self):
        """Status word 2, r0053."""
        hz = self.hz()
        if self.state == OFF:
            return 0
        size = abs(hz)
        zsw2 = ZSW2_ALWAYS
        zsw2 |= 0x0002 if size > self.slow_hz else 0
        zsw2 |= 0x0004 if size > self.minimum_hz else 0
        zsw2 |= 0x0010 if size > self.threshold_hz else 0x0020
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
            return self._limited(-self.jog_left_hz if stw & JOG_LEFT else self.jog_right_hz, 0)
        main, additional = self._sources
        hz = self._source_hz(main)
        if additional:
            hz += self._source_hz(additional)
        if self._two_directions:
            if stw & (RIGHT | LEFT) not in (RIGHT, LEFT):
                return 0.0  # neither, or both
            stw = REVERSE if stw & LEFT else 0
        if stw & REVERSE:
            hz = -hz
        return self._limited(hz, stw & REVERSE)

    # Setpoint channel

    def _source_hz(self, source):
        if source == POTENTIOMETER:
            return self.potentiometer_hz  # nobody turns the potentiometer
        if source != COM_LINK:
            return 0.0  # terminals without a signal, links on which nobody talks
        hsw = self.image[1]
        if hsw & 0x8000:
            hsw -= 0x10000
        return hsw / 100 if self._absolute else hsw * self.reference_hz / 16384

    def _limited(self, hz, reverse):
        size = min(max(abs(hz), self.minimum_hz), self.maximum_hz)
        if not size:
            return 0.0
        return -size if hz < 0 or not hz and reverse else size

    # State machine

    def command_word(self):
        """The control word that is obeyed, r0054: that of this bus if P0700 says so."""
        word = self._other_command
        return self.image[0] & self._obeyed_bits if word is None else word

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
                self.acknowledge()
        elif not stw & NO_OFF2:
            self._pulses_off(INHIBITED)
        elif not stw & NO_OFF3:
            self._quick_stop(stw)
        elif self.state == INHIBITED:
            if not stw & ON:
                self.state = READY
        elif self.commissioning:
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
        now_us = self._clock.now_us
        full_hz = self.maximum_hz
        up_s, down_s = self.up_s, self.down_s
        if self._jogging:
            up_s, down_s = self.jog_up_s, self.jog_down_s
        if self.state == STOPPING:
            if self._off3:
                down_s = self.off3_s
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
