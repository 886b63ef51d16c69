# SPDX-License-Identifier: MIT
"""The process data of a simulated drive: from STW and HSW to a turning motor, ZSW and HIW.

Control and status words are those of the USS specification (C-5.2.1) with the bits of the drive's
own family (mm420.py tells how a family says so), the status words as recorded on real drives. It
knows no telegrams and no parameter tasks; drive.py hands it the PZD words. States and motor are
those of inverter.py.

    process.accept([0x047F, 0x2000])    # PZD words as received
    process.words(2)                    # PZD words to send: ZSW and HIW, or as P2019 has them
    process.quantity(CURRENT, 0)        # 2.16 A, what r0027 shows
"""

from boards.sim.drives.words import (
    ACTUAL,
    AFTER_RAMP,
    ALWAYS,
    BOTH_JOGS,
    BY_PLC,
    COMMAND_SET,
    CONTROL_1,
    CONTROL_2,
    CONTROL_WORD_2,
    CURRENT,
    CURRENT_LIMIT,
    DATA_SETS,
    DC_LINK,
    DRIVE_STATE,
    ENERGY,
    EXTERNAL,
    FAULT,
    FAULT_COUNT,
    FAULT_TIMES,
    FAULT_VALUES,
    FAULTS,
    FIXED,
    INHIBITED,
    INVERTER_LOAD,
    INVERTER_TEMPERATURE,
    JOG,
    MOTOR_LOAD,
    MOTOR_TEMPERATURE,
    NO_COMMAND,
    NO_OFF2,
    NO_OFF3,
    NOTHING,
    OFF,
    ON,
    POTENTIOMETER,
    POWER,
    POWER_FACTOR,
    READY,
    READY_TO_RUN,
    RECEIVED,
    RUN_TIME,
    RUNNING,
    SPEED,
    STATUS_1,
    STATUS_2,
    STOPPING,
    TORQUE,
    TOTAL,
    VOLTAGE,
    WANTED,
    WARNING_COUNT,
    WARNINGS,
)
from boards.sim.drives.power.data_sets import DataSets
from boards.sim.drives.power.inverter import WORDS, Inverter

# Bits of status word 1 that no family has elsewhere.
ZSW_NO_OFF2 = 0x0010
ZSW_NO_OFF3 = 0x0020
ZSW_WARNING = 0x0080
ZSW_NO_DEVIATION = 0x0100
ZSW_REACHED = 0x0400
ZSW_BRAKE = 0x1000
ZSW_RIGHT = 0x4000
ZSW_SECOND_PROFILE = 0x07FF  # the bits of a drive in standby that leaves bits 11 to 15 at 0

# Status word 2: bit 10, the technology controller is at its minimum, being off.
ZSW2_ALWAYS = 0x0400

PLAIN = (STATUS_1, ACTUAL)
FREQUENCIES = (WANTED, ACTUAL, AFTER_RAMP, TOTAL, FIXED, POTENTIOMETER)
FROM_PLANT = (
    CURRENT, CURRENT_LIMIT, VOLTAGE, DC_LINK, TORQUE, POWER, ENERGY, POWER_FACTOR, MOTOR_LOAD,
    MOTOR_TEMPERATURE, INVERTER_LOAD, INVERTER_TEMPERATURE,
)  # fmt: skip

# r0002. 3, starting, is over too soon to be seen.
DRIVE_STATES = {FAULT: 2, RUNNING: 4, STOPPING: 5}
READY_FOR_USE, IN_COMMISSIONING = 1, 0


class Process(Inverter):
    """The inverter as a bus sees it."""

    # Defaults for families that do not set these.
    tolerance_hz = 3.0  # of ZSW bit 8
    slow_hz = 1.0  # ZSW2 bit 1
    threshold_hz = 30.0  # ZSW2 bits 4, 5
    threshold_percent = 100.0  # of the rated current: ZSW2 bit 3
    threshold_v = 800  # ZSW2 bits 7, 8
    brake = 0  # P1215: a holding brake
    external_fault = ALWAYS  # P2106: 0 is a fault
    reference_v, reference_a, reference_nm = 1000, 0.1, 0.75  # 4000h of what is sent

    def __init__(self, clock, parameters, family, switches):
        self._previous = 0
        # The words taken over last, and the state that they have led to. The same words do not
        # lead out of that state, except out of the inhibit: a word that has acknowledged a fault
        # lifts the inhibit when it comes again.
        self._taken = None
        self._led_to = OFF
        style = family.STYLE
        self._state_bits = style["states"]
        self._right_at_zero = style["right at zero"]
        self._signed = style["signed"]
        self._own_status = style.get("status", ())
        self._obeyed_bits = style["obeyed bits"]
        self._control_fault = style["control fault"]
        self._warning_numbers = style["warnings"]
        self._obeys = False  # the last telegram had STW bit 10
        self._alarms = 0  # bits of LIMITED ... BOTH_JOGS that are present
        Inverter.__init__(self, clock, parameters, family, switches)
        self._sets = DataSets(self._sources, family.LINK["index"])
        memory = self.memory
        self._lists = {
            RECEIVED: self.image,
            FAULTS: memory.numbers,
            FAULT_VALUES: memory.values,
            FAULT_TIMES: memory.times,
            WARNINGS: memory.warnings,
        }
        self._quantities = {
            STATUS_1: self.zsw,
            STATUS_2: self.zsw2,
            CONTROL_1: self.command_word,
            DRIVE_STATE: self._drive_state,
            ACTUAL: self.hz,
            WANTED: self.setpoint_hz,
            AFTER_RAMP: self.hz,
            TOTAL: self._setpoint.total_hz,
            FIXED: self._setpoint.fixed_hz,
            POTENTIOMETER: self._potentiometer_hz,
            COMMAND_SET: self._command_set,
            SPEED: self._speed_rpm,
            FAULT_COUNT: memory.fault_count,
            WARNING_COUNT: memory.warning_count,
        }
        self._take_settings()

    def power_on(self):
        """Everything in the image is 0: OFF2, OFF3, inhibited; or OFF1, and so ready."""
        self.image[:] = [0] * WORDS
        self._taken = None
        if self._switches.clean_power_up:
            self.image[0] = BY_PLC | NO_COMMAND
        Inverter.power_on(self)
        self.refresh()

    # Process data in

    def accept(self, words):
        """Take over the PZD words of a telegram, unless STW bit 10 declares them invalid."""
        if not words:
            return
        self._obeys = words[0] & BY_PLC != 0
        if self._obeys:
            self._take_over(words)
        elif self._control_fault and self.state == RUNNING:
            self.trip(self._control_fault)

    def accept_broadcast(self, enable, words):
        """Take over what the enable array (a, b, c, d) of a broadcast lets through.

        The array is the specification's (A-3, C-5.2.3 and appendix): bit 0 of a is the flag, its
        other bits name PZD1 ... PZD15; b, c and d are bit masks for PZD1, PZD4 and PZD5. There is
        no bit for PZD16.
        """
        switches = self._switches
        if not words or switches.broadcast_bit_10 and not words[0] & BY_PLC:
            return
        if switches.broadcast_without_flag and not enable[0]:
            self.accept(words)
            return
        if not enable[0] & 1:
            return
        masks = {0: enable[1], 3: enable[2], 4: enable[3]}  # these are taken bit by bit
        merged = []
        for i in range(len(words)):
            mask = masks.get(i, 0xFFFF) if enable[0] >> (i + 1) & 1 else 0
            merged.append(self.image[i] & ~mask | words[i] & mask)
        self.accept(merged)

    def refresh(self):
        """A parameter changed: use it from now on. That gives no new command."""
        self._pass_time()
        self._settle(self._clock.now_us)
        self._take_settings()
        self._taken = None  # the same words may mean something else now
        self._previous = self.command_word()
        self.command(self._previous, 0)

    def command_word(self):
        """The control word that is obeyed, r0054: that of this bus if P0700 says so."""
        return self._sources.command(self.image, self._obeyed_bits)

    def steps_per_hz(self):
        """Steps for each hertz, for a family whose frequencies are whole numbers."""
        return 100 if self.scaling else 10

    def _take_over(self, words):
        self._pass_time()
        if words == self._taken and self.state == self._led_to:
            return  # nothing new
        self._taken = list(words)
        self.image[: len(words)] = words
        if self._sets.by_bus and self._sets.look(self.image, not self.plant.driven):
            self._take_settings()
        stw = self.command_word()
        rising = stw & ~self._previous
        self._previous = stw
        self._watch_external_fault()
        if self._restarts:
            rising |= self.risen_again(stw)
        self.command(stw, rising)
        self._led_to = self.state if self.state != INHIBITED else None
        if self._sets.selected != self._sets.drive:
            self._led_to = None  # look again when it stands

    def _watch_external_fault(self):
        if not self._sources.is_word(self.external_fault):
            return
        number = self._numbers[EXTERNAL]
        if self._sources.bit(self.external_fault, self.image):
            self.clear_cause(number)
        elif number not in self.memory.causes:
            self.trip(number, 0, True)

    def _take_settings(self):
        ram = self._parameters.ram
        family = self._family
        before_hz = self.potentiometer_hz
        sets = self._sets
        sets.take(ram)
        sets.look(self.image, not self.plant.driven)
        for name, number, divisor in family.SETTINGS:
            values = ram[number]
            value = values[sets.index(number, len(values))]
            if divisor != 1:
                value = value / (divisor or self.steps_per_hz())
            setattr(self, name, value)
        if self.potentiometer_hz != before_hz:
            self._potentiometer.set(self.potentiometer_hz)
        self.skipped_hz = _not_zero(self.skip_1_hz, self.skip_2_hz, self.skip_3_hz, self.skip_4_hz)
        self.fixed_hz = (self.fixed_1_hz, self.fixed_2_hz, self.fixed_3_hz, self.fixed_4_hz)
        self._sources.take(self)
        self._setpoint.absolute = self.scaling == family.STYLE["absolute"]
        self._sent = PLAIN
        if family.LINK["sent"]:
            readings = family.READINGS
            self._sent = [readings.get(n >> 16, (NOTHING,))[0] for n in ram[family.LINK["sent"]]]

    # Process data out

    def words(self, count):
        """The first `count` PZD words of a reply."""
        words = []
        for place in range(count):
            words.append(self._word(place))
        return words

    def _word(self, place):
        what = self._sent[place] if place < len(self._sent) else NOTHING
        if what == STATUS_1:
            return self.zsw()
        if what == ACTUAL:
            return self._scaled(self.hz(), place)
        if what == NOTHING:
            return 0
        value = self.quantity(what, 0)
        if what in FREQUENCIES:
            return self._scaled(value, place)
        reference = self._reference(what)
        if reference is None:
            return int(value) & 0xFFFF
        return _limited(round(value * 16384 / reference))

    def _scaled(self, hz, place):
        if not self._signed:
            hz = abs(hz)
        absolute = place == 1 and self._setpoint.absolute
        return _limited(round(hz * 100) if absolute else round(hz * 16384 / self.reference_hz))

    def _reference(self, what):
        """The value of a quantity that is sent as 4000h; None: it is sent as it is."""
        if what == SPEED:
            return self.reference_hz * self._rpm_per_hz()
        if what == CURRENT or what == CURRENT_LIMIT:
            return self.reference_a
        if what == VOLTAGE or what == DC_LINK:
            return self.reference_v
        if what == TORQUE:
            return self.reference_nm
        return 100 if what in FROM_PLANT else None

    # Status words

    def zsw(self):
        """Status word 1, r0052."""
        hz = self.hz()
        if self.state == OFF:
            return 0
        if self._own_status:
            return self._own_zsw(hz)
        stw = self._stw
        zsw = self._state_bits[self.state] & ~self._look_round(hz)
        if stw & NO_OFF2:
            zsw |= ZSW_NO_OFF2
        if stw & NO_OFF3 and not self._off3:
            zsw |= ZSW_NO_OFF3
        if not stw or self.memory.is_warning():  # before the first PZD the captures warn
            zsw |= ZSW_WARNING
        if abs(self.setpoint_hz() - hz) <= self.tolerance_hz:
            zsw |= ZSW_NO_DEVIATION
        if abs(hz) >= self.reached_hz:
            zsw |= ZSW_REACHED
        if hz > 0 or not hz and self._right_at_zero:
            zsw |= ZSW_RIGHT
        if self.brake and self.plant.driven:
            zsw &= ~ZSW_BRAKE
        if self._switches.bare_standby and self.state == READY:
            zsw = zsw & ZSW_SECOND_PROFILE | ZSW_REACHED
        return zsw

    def _own_zsw(self, hz):
        """Status word 1 of a drive that has its own bits: rows of (bit, what it says)."""
        gains = self._motor.slope(self._clock.now_us) * hz  # above 0 the motor becomes faster
        says = {
            "ready": self.state in (READY, READY_TO_RUN),
            "operates": self.state == RUNNING,
            "fault": self.state == FAULT,
            "faster": gains > 0,
            "slower": gains < 0,
            "inhibited": self.state == INHIBITED,
            "warns": self.memory.is_warning(),
            "turns": hz != 0,
            "obeys": self._obeys,
        }
        return sum([bit for bit, what in self._own_status if says[what]])

    def zsw2(self):
        """Status word 2, r0053."""
        hz = self.hz()
        if self.state == OFF:
            return 0
        size = abs(hz)
        zsw2 = ZSW2_ALWAYS
        zsw2 |= 0x0002 if size > self.slow_hz else 0
        zsw2 |= 0x0004 if size > self.minimum_hz else 0
        slope = self._motor.slope(self._clock.now_us)
        threshold_a = self.threshold_percent * self.rated_a / 100
        zsw2 |= 0x0008 if self.plant.quantity(CURRENT, hz, slope) >= threshold_a else 0
        zsw2 |= 0x0010 if size > self.threshold_hz else 0x0020
        zsw2 |= 0x0040 if size >= abs(self.setpoint_hz()) else 0
        dc_link_v = self.plant.quantity(DC_LINK, hz, slope)
        zsw2 |= 0x0080 if dc_link_v < self.threshold_v else 0x0100
        zsw2 |= 0x0200 if self._clock.now_us >= self._motor.end_us else 0
        return zsw2

    def _look_round(self, hz):
        """Update the warnings that the drive gives by itself, LIMITED ... BOTH_JOGS."""
        alarms = self.plant.alarms(hz, self._motor.slope(self._clock.now_us))
        if self._stw & JOG == JOG and not self._stw & ON:
            alarms |= BOTH_JOGS
        if alarms != self._alarms:
            self._alarms = alarms
            self._warn()
        return alarms

    def _warn(self):
        for alarm, number in self._warning_numbers:
            self.memory.warn(number, bool(self._alarms & alarm))

    # Readings

    def quantity(self, what, index):
        """What a reading shows, in its unit (Hz and 1/min signed): `what` is a name of
        words.py, `index` a place in one that is a list.
        """
        self.zsw()  # updates the warnings
        if what in self._lists:
            places = self._lists[what]
            return places[index] if index < len(places) else 0
        if what in FROM_PLANT:
            self._settle(self._clock.now_us)
            hz = self._motor.hz(self._clock.now_us)
            value = self.plant.quantity(what, hz, self._motor.slope(self._clock.now_us))
            return value if self.state != OFF or what == ENERGY else 0.0
        if what == CONTROL_2:
            return self.image[CONTROL_WORD_2]
        if what == DATA_SETS:
            return self._sets.drive if index else self._sets.selected
        if what == RUN_TIME:
            seconds = self.run_s(self._clock.now_us)
            return seconds & 0xFFFF if index else seconds >> 16 & 0xFFFF
        return self._quantities[what]()

    def clear_faults(self):
        """P0952 = 0: forget all faults but the present one."""
        self.memory.forget_faults()

    def clear_warnings(self):
        """P2111 = 0: forget the warnings that are gone."""
        self.memory.forget_warnings()

    def clear_energy(self):
        """P0040 = 1: the energy meter begins at 0."""
        self._pass_time()
        self._settle(self._clock.now_us)
        self.plant.energy_kwh = 0.0

    def _command_set(self):
        return self._sets.command

    def _drive_state(self):
        if self.commissioning:
            return IN_COMMISSIONING
        return DRIVE_STATES.get(self.state, READY_FOR_USE)

    def _potentiometer_hz(self):
        return self._potentiometer.output_hz

    def _rpm_per_hz(self):
        return 60 / max(round(self.rated_hz * 60 / (self.rated_rpm or 1500)), 1)

    def _speed_rpm(self):
        return self.hz() * self._rpm_per_hz()


def _limited(value):
    """The value limited to a signed word of 16 bits."""
    return max(-32768, min(32767, value)) & 0xFFFF


def _not_zero(*values):
    return [value for value in values if value]
