# SPDX-License-Identifier: MIT
"""What a simulated drive shows under its read-only numbers.

Most readings come from the process (process.py), some from the link's counters, a few from the
parameters. A reading without a kind in the family's READINGS always has the value of its row.

    readings = Readings(family, parameters, process, slave)
    readings.value(52, 0)       # ZSW
"""

from boards.sim.drives.words import (
    ACTUAL,
    CONTROL_1,
    CONTROL_2,
    COUNTERS,
    FAULTS,
    RECEIVED,
    STATUS_1,
    STATUS_2,
    WANTED,
)
from boards.sim.drives.parameters import CHANGE, DEFAULT, TYPE
from boards.sim.drives.families.mm4_readings import NUMBERS, OUTPUTS, POLE_PAIRS, SLIP

# Sources of digital outputs, each a number and a bit of it, and what inverts them.
OUTPUT_SOURCES = (731, 732, 733)
OUTPUTS_INVERTED = 748


class Readings:
    """family: a module such as mm420; the others are what the drive is made of."""

    def __init__(self, family, parameters, process, slave):
        self._table = family.READINGS
        self._parameters = parameters
        self._process = process
        self._slave = slave
        self._link = family.LINK["index"]

    def value(self, number, index):
        """The value of a number and index that exist, an int or a float as its type says."""
        what, detail = self._table.get(number, (None, 0))
        process = self._process
        if what in (ACTUAL, WANTED):
            return self._frequency(number, what, detail)
        if what == STATUS_1:
            return process.zsw()
        if what == STATUS_2:
            return process.zsw2()
        if what == CONTROL_1:
            return process.command_word()
        if what == CONTROL_2:
            return process.image[3]
        if what == RECEIVED:
            return process.image[detail + index]
        if what == FAULTS:
            place = detail + index
            return process.faults[place] if place < len(process.faults) else 0
        if what == COUNTERS:
            return self._slave.counters()[detail] if index == self._link else 0
        if what is None:
            return self._constant(number, index)
        if what in (NUMBERS, OUTPUTS, POLE_PAIRS, SLIP):
            return self._derived(what, index)
        value = process.quantity(what, index)
        return value if self._is_float(number) else round(abs(value) * (detail or 1))

    def _frequency(self, number, what, factor):
        process = self._process
        hz = process.hz() if what == ACTUAL else process.setpoint_hz()
        if self._is_float(number):
            return hz * factor
        return round(abs(hz) * process.steps_per_hz())

    def _is_float(self, number):
        return self._parameters.rows[number][TYPE] == "F"

    def _constant(self, number, index):
        default = self._parameters.rows[number][DEFAULT]
        return default[index] if isinstance(default, tuple) else default

    def _derived(self, what, index):
        rows = self._parameters.rows
        if what == NUMBERS:  # readings, settings
            settings = len([number for number in rows if rows[number][CHANGE]])
            return settings if index else len(rows) - settings
        if what == OUTPUTS:
            return self._outputs()
        ram = self._parameters.ram
        hz, rpm = ram[310][0], ram[311][0]
        pairs = max(1, int(60 * hz / rpm)) if rpm else 1
        if what == POLE_PAIRS:
            return pairs
        synchronous = 60 * hz / pairs
        return 100 * (synchronous - rpm) / synchronous

    def _outputs(self):
        """A bit for each digital output; if the source is not a status word, the output is
        open."""
        ram = self._parameters.ram
        states = 0
        for place, number in enumerate(OUTPUT_SOURCES):
            if number in ram:
                source, bit = ram[number][0] >> 16, ram[number][0] & 0xFFFF
                if bit < 16 and self._table.get(source, (None, 0))[0] in (STATUS_1, STATUS_2):
                    states |= (self.value(source, 0) >> bit & 1) << place
        return states ^ ram[OUTPUTS_INVERTED][0]
