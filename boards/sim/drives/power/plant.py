# SPDX-License-Identifier: MIT
"""The mains, motor and load of a simulated drive, and the current that they draw.

This is simple, and only plausible: the motor turns as fast as its drive says, whatever the load.
The current follows from frequency, acceleration and load; the motor warms up as one body (I
squared t). Figures that no rating plate gives are choices. Like the motor's path, all this is
worked out at each call; a trip that has come meanwhile has the instant at which it came.

    plant = Plant(settings, switches)
    plant.percent, plant.kind = 80.0, FAN
    plant.follow(motor, now_us)             # None, or (OVERHEAT, instant)
    plant.quantity(CURRENT, 50.0, 0.0)      # 2.76 A at 50 Hz, not accelerating
"""

import math

from boards.sim.drives.words import (
    CURRENT,
    CURRENT_LIMIT,
    DC_LINK,
    ENERGY,
    HELD_DOWN,
    HOT,
    INVERTER_LOAD,
    LIMITED,
    LOW_SUPPLY,
    MOTOR_LOAD,
    MOTOR_TEMPERATURE,
    OVERCURRENT,
    OVERHEAT,
    OVERVOLTAGE,
    POWER,
    POWER_FACTOR,
    STRAINED,
    TORQUE,
    UNDERVOLTAGE,
    VOLTAGE,
)

# How the load depends on the frequency: not at all, in proportion, by its square.
CONSTANT, LINEAR, FAN = "constant", "linear", "fan"
EXPONENTS = {CONSTANT: 0, LINEAR: 1, FAN: 2}

INERTIA_S = 0.5
SUPPLY_V = 400.0
DC_PER_SUPPLY = 1.4  # r0026 is 560 V on 400 V
UNDERVOLTAGE_PART = 0.62  # of the supply
VDC_CONTROLLER_PER_SUPPLY = 1.63  # the Vdc-max controller holds it here: 1.15 times the peak
OVERVOLTAGE_PER_SUPPLY = 2.1  # 840 V on 400 V
SAG_PART = 0.02  # of the DC link voltage, at rated power
RISE_V = 600.0  # of the DC link voltage, if rated power is fed back, on a supply of 400 V
LOST_PART = 0.05  # of rated power, in motor and inverter, before any of it comes back

STRAIN_S = 1.0  # at the current limit, until it trips
TOO_HOT, WARM = 1.1, 1.0  # heat at which it trips and warns
AMBIENT_C, MOTOR_RISE_C, INVERTER_RISE_C = 20.0, 80.0, 40.0
STEP_US = 20_000  # of the sum over a ramp


class Plant:
    """settings: has the rating plate, see Inverter. switches: those of the drive.

    percent     load at the rated frequency and above, in percent of the rated torque
    kind        CONSTANT, LINEAR or FAN
    inertia_s   0...rated frequency with rated torque and no load
    supply_v    mains
    coast_s     how long it coasts from 50 Hz, whatever the load; any value may be set
    driven      whether the pulses are on
    heat        I squared t of the motor, 1.0 in the long run at rated current
    energy_kwh  r0039

    Before you change anything that it uses, except `coast_s`, settle it up to that instant.
    """

    def __init__(self, settings, switches):
        self._settings = settings
        self._switches = switches
        self.percent = 50.0
        self.kind = FAN
        self.inertia_s = INERTIA_S
        self.coast_s = 5.0
        self.supply_v = SUPPLY_V
        self.driven = False
        self.heat = 0.0
        self.energy_kwh = 0.0
        self._strained_s = 0.0
        self._at_us = 0  # so far heat and energy are worked out
        self._quiet = False  # nothing can happen before the next `settle`
        self._told_hz = self._told_slope = None  # `_told` is the answer for these
        self._told = 0

    # What time does

    def follow(self, motor, to_us):
        """Go on to `to_us` along the motor's path.

        Returns what tripped on the way, (kind, instant), after which it goes no further; or None.
        """
        if self._quiet:
            return None
        tripped = self._go_on(motor, to_us)
        self._quiet = tripped is None and self._is_quiet(motor)
        return tripped

    def settle(self, motor, to_us):
        """Go on to `to_us`, before a change. `follow` has made sure that nothing trips by then."""
        self._go_on(motor, to_us)
        self._quiet = False
        self._told_hz = None

    def _go_on(self, motor, to_us):
        if not self.driven:
            self._cool(to_us)
            return None
        while self._at_us < to_us:
            until_us = to_us
            if self._at_us < motor.end_us:
                until_us = min(to_us, motor.end_us, self._at_us + STEP_US)
            middle_us = self._at_us + (until_us - self._at_us) // 2
            hz = motor.hz(middle_us)
            kind = self._step(hz, motor.slope(middle_us), until_us)
            if kind is not None:
                return kind, self._at_us
        return None

    def _is_quiet(self, motor):
        if self.heat > WARM or self.is_low():
            return False
        if not self.driven:
            return True
        if self._at_us < motor.end_us:
            return False
        drawn = self._drawn(self.torque(motor.hz(self._at_us), 0.0))
        return drawn <= min(self._limit(), WARM)

    def persists(self, kind):
        """Whether the cause of the trip is still there."""
        if kind == OVERHEAT:
            return self.heat > WARM
        return kind == UNDERVOLTAGE and self.is_low()

    def is_low(self):
        """Whether the mains are too low to run on."""
        return self.supply_v < UNDERVOLTAGE_PART * SUPPLY_V

    def _cool(self, to_us):
        if self.heat:
            self.heat *= math.exp((self._at_us - to_us) / 1e6 / self._heat_s())
        self._strained_s = 0.0
        self._at_us = to_us

    def _step(self, hz, slope, until_us):
        """Go on to `until_us`, or to the instant of a trip; return what trips."""
        torque = self.torque(hz, slope)
        drawn = self._drawn(torque)
        limit = self._limit()
        step_s = (until_us - self._at_us) / 1e6
        kind, step_s = self._trip(torque, hz, drawn, limit, step_s)
        square = min(drawn, limit) ** 2
        self.heat = square + (self.heat - square) * math.exp(-step_s / self._heat_s())
        self._strained_s = self._strained_s + step_s if drawn > limit else 0.0
        self.energy_kwh += max(self._power_kw(torque, hz), 0.0) * step_s / 3600
        self._at_us = until_us if kind is None else self._at_us + int(step_s * 1e6)
        return kind

    def _trip(self, torque, hz, drawn, limit, step_s):
        """What trips within the next `step_s` seconds, or None, and after how many."""
        if self.is_low():
            return UNDERVOLTAGE, 0.0
        if self._switches.overvoltage_trips and self._fed_back_v(torque, hz) > self._highest_v():
            return OVERVOLTAGE, 0.0
        if not self._switches.overload_trips:
            return None, step_s
        if drawn > limit and self._strained_s + step_s >= STRAIN_S:
            return OVERCURRENT, max(STRAIN_S - self._strained_s, 0.0)
        square = min(drawn, limit) ** 2
        if square > TOO_HOT:
            if self.heat >= TOO_HOT:
                return OVERHEAT, 0.0
            hot_s = self._heat_s() * math.log((square - self.heat) / (square - TOO_HOT))
            if hot_s <= step_s:
                return OVERHEAT, hot_s
        return None, step_s

    # What is drawn. Torque, current and power are parts of the rated ones here.

    def torque(self, hz, slope):
        """Load and acceleration, negative where the motor is braked. slope: Hz/s."""
        load = self.percent / 100 * min(self._speed(hz), 1.0) ** EXPONENTS[self.kind]
        speeding_up = slope * self.inertia_s / self._rated_hz()
        return load + (-speeding_up if hz < 0 else speeding_up)

    def _rated_hz(self):
        return self._settings.rated_hz or 50.0  # a MICROMASTER 3 can be set to 0

    def _speed(self, hz):
        return abs(hz) / self._rated_hz()

    def _drawn(self, torque):
        """The current that the motor needs: the magnetising one, and the one for the torque."""
        idle = self._settings.magnetising_percent / 100 or 0.5
        return math.sqrt(idle * idle + (1 - idle * idle) * torque * torque)

    def _heat_s(self):
        return self._settings.heat_s or 100  # 0: it is switched off

    def _limit(self):
        return self._settings.overload_percent / 100

    def _power_kw(self, torque, hz):
        return torque * self._speed(hz) * self._settings.rated_kw

    def _fed_back_v(self, torque, hz):
        """The DC link voltage, if nothing limits it."""
        part = torque * self._speed(hz)
        full_v = self.supply_v * DC_PER_SUPPLY
        if part >= -LOST_PART:
            return full_v * (1 - SAG_PART * max(part, 0.0))
        return full_v + RISE_V * self.supply_v / SUPPLY_V * (-part - LOST_PART)

    def _highest_v(self):
        return OVERVOLTAGE_PER_SUPPLY * SUPPLY_V

    # Told

    def alarms(self, hz, slope):
        """The warnings that are present, bits of LIMITED ... HELD_DOWN."""
        alarms = HOT if self.heat >= WARM else 0
        if self.is_low():
            alarms |= LOW_SUPPLY
        if not self.driven:
            return alarms
        if hz != self._told_hz or slope != self._told_slope:
            self._told = self._drawn_alarms(hz, slope)
            self._told_hz = hz
            self._told_slope = slope
        return alarms | self._told

    def _drawn_alarms(self, hz, slope):
        torque = self.torque(hz, slope)
        alarms = 0
        if self._drawn(torque) > self._limit():
            alarms |= LIMITED
        if self._inverter_part(torque) > 1:
            alarms |= STRAINED
        if self._settings.vdc_controller and self._fed_back_v(torque, hz) > self._controlled_v():
            alarms |= HELD_DOWN
        return alarms

    def _controlled_v(self):
        return VDC_CONTROLLER_PER_SUPPLY * SUPPLY_V

    def _inverter_part(self, torque):
        amps = min(self._drawn(torque), self._limit()) * self._settings.rated_a
        return amps / self._settings.inverter_a

    def dc_link_v(self, torque, hz):
        voltage = self._fed_back_v(torque, hz) if self.driven else self.supply_v * DC_PER_SUPPLY
        held = self._settings.vdc_controller
        return min(voltage, self._controlled_v() if held else self._highest_v())

    def quantity(self, what, hz, slope):
        """In its own unit: A, V, Nm, kW, kWh, %, degrees Celsius."""
        torque = self.torque(hz, slope) if self.driven else 0.0
        if what == DC_LINK:
            return self.dc_link_v(torque, hz)
        if what == ENERGY:
            return self.energy_kwh
        if what == MOTOR_LOAD:
            return self.heat * 100
        if what == MOTOR_TEMPERATURE:
            return AMBIENT_C + MOTOR_RISE_C * self.heat
        if what == CURRENT_LIMIT:
            return self._limit() * self._settings.rated_a
        return self._drawn_quantity(what, hz, torque)

    def _drawn_quantity(self, what, hz, torque):
        settings = self._settings
        driven = 1 if self.driven else 0
        drawn = min(self._drawn(torque), self._limit()) * driven
        if what == CURRENT:
            return drawn * settings.rated_a
        if what == VOLTAGE:
            highest_v = min(settings.rated_v, self.supply_v)
            return min(settings.rated_v * self._speed(hz), highest_v) * driven
        if what == TORQUE:
            rated_nm = settings.rated_kw * 9550 / (settings.rated_rpm or 1)
            return torque * rated_nm * (-1 if hz < 0 else 1)
        if what == POWER:
            return self._power_kw(torque, hz)
        if what == POWER_FACTOR:
            return min(abs(torque) / drawn, 1.0) if drawn else 0.0
        part = self._inverter_part(torque) * driven
        if what == INVERTER_LOAD:
            return part * 100
        return AMBIENT_C + 10 + INVERTER_RISE_C * part  # INVERTER_TEMPERATURE
