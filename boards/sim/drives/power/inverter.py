# SPDX-License-Identifier: MIT
"""The inverter of a simulated drive: its states, and what they make the motor do.

The states are those of PROFIdrive as a MICROMASTER 4 goes through them (P and r numbers are those
of the MICROMASTER 4). The inverter obeys one control word; process.py decides which one, and
handles all other process data. It trips and warns, and fault_memory.py remembers that.

    inverter.command(0x047F, 0x0001)    # ON, which has just risen
    inverter.state                      # "running"
    inverter.hz()                       # 0.0

Nothing runs in the background. At each call the inverter works out what has happened meanwhile (a
ramp ends, pulses go off, an overload trips), for the instant at which it happened.
"""

from boards.sim.drives.power import restart
from boards.sim.drives.words import (
    ACKNOWLEDGE,
    THIS_BUS,
    DOWN,
    FAULT,
    INHIBITED,
    JOG,
    JOG_LEFT,
    JOG_RIGHT,
    MOP,
    NO_OFF2,
    NO_OFF3,
    OFF,
    ON,
    PULSES,
    RAMP_OUTPUT,
    RAMP_RUN,
    READY,
    READY_TO_RUN,
    RUNNING,
    SETPOINT,
    STOPPING,
    UNDERVOLTAGE,
    UP,
)
from boards.sim.drives.power.fault_memory import memory_of
from boards.sim.drives.power.motor import Motor
from boards.sim.drives.power.plant import Plant
from boards.sim.drives.power.potentiometer import Potentiometer
from boards.sim.drives.power.setpoint import SetpointChannel
from boards.sim.drives.power.sources import Sources

WORDS = 16  # process data words, at most

TURNS = {UP: 1, DOWN: -1}  # both bits, or none: the motor potentiometer stands still


class Inverter:
    """state   INHIBITED ... OFF, see words.py
    starts  how often the pulses were switched on
    image   the process data in force, by word: STW, HSW and what the layout adds
    faults  r0947: the present trip in the first two places, older ones behind, two places each
    memory  all of its faults and warnings
    plant   what hangs on it: mains, motor, load

    The settings that it uses are attributes, in Hz and seconds, taken from the parameters whenever
    one of these has changed.
    """

    # Every family sets these.
    maximum_hz = reached_hz = reference_hz = up_s = down_s = None
    # Defaults for families that do not set these.
    commissioning = 0
    command_source = setpoint_source = THIS_BUS
    scaling = 0
    potentiometer_hz = 0.0
    potentiometer_kept = 0  # P1031: it goes on where it was, P1040 follows
    potentiometer_right = 1  # P1032: it does not go below 0 Hz
    jog_right_hz = jog_left_hz = 5.0
    jog_up_s = jog_down_s = 10.0
    minimum_hz = 0.0
    off3_s = 5.0
    skip_1_hz = skip_2_hz = skip_3_hz = skip_4_hz = 0.0
    skip_band_hz = 2.0
    fixed_1_hz = fixed_2_hz = fixed_3_hz = fixed_4_hz = 0.0
    no_reverse = 0  # P1110

    command_word = None  # command_word(): STW, wherever it comes from; see `Process`
    flying_start = 1  # P1200
    auto_restart = None  # P1210
    selection = 0  # P0719
    on_source = main_source = None  # P0840, P1070
    controller = 0  # P2200
    controller_source = 0  # P2253
    gain, highest_percent, lowest_percent = 3.0, 100.0, 0.0
    # The rating plates of motor and inverter.
    rated_v, rated_a, rated_kw = 230, 3.25, 0.75
    rated_hz, rated_rpm = 50.0, 1395
    inverter_a = 3.9
    magnetising_percent = 0.0  # 0: half of the rated current
    overload_percent = 150.0
    heat_s = 100
    vdc_controller = 0

    def __init__(self, clock, parameters, family, switches):
        self._clock = clock
        self._parameters = parameters
        self._family = family
        self._switches = switches
        self.image = [0] * WORDS
        self.memory = memory_of(family, parameters.rows)
        self.faults = self.memory.numbers
        self.plant = Plant(self, switches)
        self._motor = Motor(self._settle)
        self._potentiometer = Potentiometer()
        self._sources = Sources(family)
        self._setpoint = SetpointChannel(
            self, self.image, self._potentiometer, self._sources, family.STYLE
        )
        self._numbers = family.STYLE["faults"]
        self._restart_table = family.STYLE["restarts"]
        self.starts = 0
        self.state = OFF
        self._jogging = False  # running, or stopping, on a JOG command
        self._off3 = False  # stopping on OFF3, which cannot be taken back
        self._restarts = False  # P1210: ON that stands in the next telegram starts it
        self._freed_by = restart.OTHER  # what switched the pulses off last
        self._stw = 0  # the control word that was obeyed last
        self._given_hz = None  # the setpoint, once it was worked out
        self._passed_us = -1  # everything is worked out up to this instant
        self._run_us = 0  # time with mains, before they came the last time
        self._on_us = 0

    # What happens to it

    def power_on(self):
        """Inhibited, or in fault as before: P1210. A fault whose cause is left is back."""
        action = self._action(restart.BLACKOUT)
        self.state = FAULT
        if action != restart.NOTHING or not self.faults[0]:
            self.memory.file()
            self.state = INHIBITED
        self._on_us = self._clock.now_us
        for number in self.memory.causes:
            self.trip(number)
        self._restarts = action == restart.RESTART and self._switches.bus_restart

    def after_brownout(self):
        """The mains are back in time; a second has passed."""
        self._pass_time()
        action = self._action(restart.BROWNOUT)
        if self.state == FAULT and action != restart.NOTHING:
            self.acknowledge()
            self._restarts = action == restart.RESTART and self._switches.bus_restart
            stw = self.command_word()
            self.command(stw, self.risen_again(stw))

    def _action(self, away):
        number = self.faults[0]
        fault = restart.OTHER_FAULT if number else restart.NO_FAULT
        if number == self._numbers[UNDERVOLTAGE]:
            fault = restart.UNDERVOLTED
        return restart.action(self._restart_table, self.auto_restart, away, fault)

    def power_off(self):
        self._pass_time()
        if self.state != OFF:
            self._run_us += self._clock.now_us - self._on_us
        self._restarts = False
        self._pulses_off(OFF, self._clock.now_us, restart.POWER)

    def trip(self, number, value=0, lasting=False):
        """A fault: pulses off at once. Another one before the acknowledgement is noted beside it.

        lasting: it cannot be acknowledged before its cause was cleared.
        """
        self._pass_time()
        if lasting and number not in self.memory.causes:
            self.memory.causes.append(number)
        self._trip(self._clock.now_us, number, value)

    def clear_cause(self, number=None):
        """End the cause of a lasting fault; without a number, the causes of all."""
        causes = self.memory.causes
        causes[:] = [cause for cause in causes if number not in (None, cause)]

    def acknowledge(self):
        """Clear the fault, unless its cause is still there."""
        self._pass_time()
        if self.state == FAULT and not self.memory.causes and not self._persists():
            self.memory.file()
            self.state = INHIBITED

    def load(self, percent, kind, inertia_s):
        """Another load, see Plant."""
        self._pass_time()
        self._settle(self._clock.now_us)
        self.plant.percent = percent
        self.plant.kind = kind
        self.plant.inertia_s = inertia_s

    def supply(self, volts):
        """Another voltage of the mains."""
        self._pass_time()
        self._settle(self._clock.now_us)
        self.plant.supply_v = volts
        if self.plant.driven and self.plant.is_low():
            self._trip(self._clock.now_us, self._numbers[UNDERVOLTAGE], 0)

    # What it does

    def hz(self):
        """The frequency of the motor now, signed."""
        self._pass_time()
        return self._motor.hz(self._clock.now_us)

    def setpoint_hz(self):
        """The frequency that the ramp generator is given: r0020, r1119.

        It is within P1080 and P1082, or 0 without STW bit 6.
        """
        if self._given_hz is None:
            stw = self._stw
            jogs = self._jogging and self.state == RUNNING
            if jogs and stw & JOG == JOG:
                return self._motor.hz(self._clock.now_us)
            if not stw & SETPOINT:
                self._given_hz = 0.0
            else:
                channel = self._setpoint
                self._given_hz = channel.jog_hz(stw) if jogs else channel.hz(stw)
        return self._given_hz

    def run_s(self, at_us):
        """Seconds with mains, ever: r2114."""
        since_us = 0 if self.state == OFF else at_us - self._on_us
        return (self._run_us + since_us) // 1_000_000

    # State machine

    def command(self, stw, rising):
        """One step of the state machine: `rising` are the bits that have just gone to 1."""
        self._pass_time()
        self._stw = stw
        self._given_hz = None
        if self.state == OFF:
            return
        if self.state == FAULT:
            if rising & ACKNOWLEDGE:
                self.acknowledge()
        elif not stw & NO_OFF2:
            self._pulses_off(INHIBITED, self._clock.now_us, restart.OFF2)
        elif not stw & NO_OFF3:
            self._quick_stop(stw)
        elif self.state == INHIBITED:
            if not stw & ON:
                self.state = READY
        elif self.commissioning:
            self._step(stw & ~(ON | JOG), 0)  # commissioning: the motor must not run
        else:
            self._step(stw, rising)
        self._given_hz = None
        self._turn_potentiometer(stw)
        self._steer(self._clock.now_us)

    def risen_again(self, stw):
        """ON if it stands when the drive restarts by itself: it counts as risen, once."""
        restarts, self._restarts = self._restarts, False
        if not (restarts and stw & ON and self.state in (INHIBITED, READY)):
            return 0
        self.state = READY
        return ON

    def _quick_stop(self, stw):
        if self.state in (RUNNING, STOPPING) and stw & PULSES:
            self.state = STOPPING
            self._off3 = True
        else:
            self._pulses_off(INHIBITED, self._clock.now_us)

    def _step(self, stw, rising):
        """One step in the states that neither OFF2, OFF3 nor a fault decides."""
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
            state = INHIBITED if self._off3 else READY_TO_RUN if on else READY
            self._pulses_off(state, self._clock.now_us)
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
        self._settle(self._clock.now_us)
        self.plant.driven = True
        if not self.potentiometer_kept:
            self._potentiometer.set(self.potentiometer_hz)
        hz = self._motor.hz(self._clock.now_us)
        if hz and not restart.catches(self.flying_start, self._freed_by, hz, self.setpoint_hz()):
            self._motor.jump(self._clock.now_us, 0.0)  # it forces its own frequency on the motor

    def _trip(self, at_us, number, value):
        self.memory.strike(number, value, self.run_s(at_us))
        self._pulses_off(FAULT, at_us, restart.FAULT)

    def _persists(self):
        """Whether the cause of a trip by itself is still there."""
        for kind, number in self._numbers.items():
            if number in self.faults[:2] and self.plant.persists(kind):
                return True
        return False

    def _pulses_off(self, state, at_us, freed_by=restart.OTHER):
        if self.plant.driven or state == OFF:
            self._freed_by = freed_by
        if self.plant.driven:
            self._settle(at_us)
            self.plant.driven = False
            self._keep_potentiometer()
        self.state = state
        self._jogging = self._off3 = False
        self._given_hz = None
        self._potentiometer.turn(at_us, 0)
        self._motor.coast(at_us, self.plant.coast_s)

    # What time does

    def _pass_time(self):
        now_us = self._clock.now_us
        if now_us == self._passed_us:
            return
        self._passed_us = now_us
        potentiometer = self._potentiometer
        while potentiometer.is_due(now_us) and self.state == RUNNING:
            at_us = potentiometer.next_us
            potentiometer.step(
                self.maximum_hz, self.up_s, self.down_s, not self.potentiometer_right
            )
            self._given_hz = None
            self._follow(at_us)
            self._steer(at_us)
        if self.state == STOPPING and now_us >= self._motor.end_us:
            self._stand_still()
        self._follow(now_us)

    def _follow(self, at_us):
        """Let the plant go on up to `at_us`, with the motor on its present path."""
        tripped = self.plant.follow(self._motor, at_us)
        if tripped is not None:
            kind, trip_us = tripped
            self._trip(trip_us, self._numbers[kind], 0)

    def _settle(self, at_us):
        """Call this before something changes that the plant uses."""
        self.plant.settle(self._motor, at_us)

    def _stand_still(self):
        """Switch the pulses off at standstill, whatever stopped the motor."""
        end_us = self._motor.end_us
        self._follow(end_us)
        if self.state == STOPPING:
            self._pulses_off(INHIBITED if self._off3 else READY, end_us)

    def _steer(self, at_us):
        """Give the motor its course: ramp times are for 0...P1082."""
        stw = self._stw
        full_hz = self.maximum_hz
        up_s, down_s = self.up_s, self.down_s
        if self._jogging:
            up_s, down_s = self.jog_up_s, self.jog_down_s
        if self.state == STOPPING:
            if self._off3:
                down_s = self.off3_s
            self._motor.ramp(at_us, 0.0, full_hz, up_s, down_s)
            if at_us >= self._motor.end_us:
                self._stand_still()
        elif self.state != RUNNING:
            return  # it coasts already
        elif not stw & RAMP_OUTPUT:
            self._motor.jump(at_us, 0.0)
        elif not stw & RAMP_RUN or self._jogging and stw & JOG == JOG:
            self._motor.hold(at_us)
        else:
            self._motor.ramp(at_us, self.setpoint_hz(), full_hz, up_s, down_s)

    def _turn_potentiometer(self, stw):
        direction = 0
        sources = (self._sources.main, self._sources.additional)
        if self.state == RUNNING and not self._jogging and MOP in sources:
            direction = TURNS.get(stw & (UP | DOWN), 0)
        self._potentiometer.turn(self._clock.now_us, direction)

    def _keep_potentiometer(self):
        """P1031: its position goes into P1040 when the motor is not driven any more."""
        hz = self._potentiometer.output_hz
        if self.potentiometer_kept and hz != self.potentiometer_hz:
            for name, number, _ in self._family.SETTINGS:
                if name == "potentiometer_hz":
                    self._parameters.set(number, 0, hz)
                    self.potentiometer_hz = self._parameters.ram[number][0]
                    self._potentiometer.set(self.potentiometer_hz)
