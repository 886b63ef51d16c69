# SPDX-License-Identifier: MIT
"""What a simulated drive remembers of its faults and warnings: r0947, r0948, r0949, r2110.

It decides nothing: process.py says when there is a fault and when one is acknowledged.

    memory.strike(1, 0, 3600)   # F0001 at 3600 s of run time
    memory.file()               # acknowledged: all move on by one trip
    memory.numbers              # [0, 0, 1, 0, 0, 0, 0, 0]

A trip has two places, the second for one more fault before the first was acknowledged; as many
trips are kept as r0947 has places for, four on a MICROMASTER 4 and 32 on a V20 (order of r0947 as
the SED2 manual has it). They outlive the power.
"""

from boards.sim.drives.parameters import INDICES
from boards.sim.drives.words import FAULT_TIMES, FAULTS

TRIPS = 4  # at least
PLACES = 2  # of a trip in numbers and values
TIMES = 3  # words of a trip in r0948; the third would be month and year of a real clock
SHOWN = 2  # warnings that are present in r2110, and as many that are gone


def memory_of(family, rows):
    """A memory as large as what shows it. rows: {number: row} of the family."""
    numbers = [_places(family, rows, kind) for kind in (FAULTS, FAULT_TIMES)]
    trips = max(TRIPS, numbers[0] // PLACES)
    return FaultMemory(trips, min(TIMES, numbers[1] // trips) or TIMES)


def _places(family, rows, kind):
    """How many indices the longest list has that shows something of this kind."""
    readings = family.READINGS
    return max([0] + [rows[n][INDICES] for n in readings if readings[n][0] == kind])


class FaultMemory:
    """numbers   r0947: the present trip in the first two places, older ones behind
    values    r0949, as numbers
    times     r0948: run time in seconds of each trip: high word, low word, and nothing where it
              has a third one
    warnings  r2110: the first two present ones, then the last two that are gone
    causes    numbers of faults whose cause is still there
    """

    def __init__(self, trips=TRIPS, time_words=TIMES):
        self.numbers = [0] * (trips * PLACES)
        self.values = [0] * (trips * PLACES)
        self.times = [0] * (trips * time_words)
        self._time_words = time_words
        self.warnings = [0] * (2 * SHOWN)
        self.causes = []
        self._present = []  # warnings, the oldest first

    def strike(self, number, value, seconds):
        """Add a fault. If more than two come before the acknowledgement, keep the first two."""
        if not self.numbers[0]:
            place = 0
            self.times[:2] = [seconds >> 16 & 0xFFFF, seconds & 0xFFFF]
        elif number != self.numbers[0] and not self.numbers[1]:
            place = 1
        else:
            return
        self.numbers[place] = number
        self.values[place] = value

    def file(self):
        """The present trip is acknowledged."""
        if self.numbers[0]:
            for places, width in self._lists():
                places[:] = [0] * width + places[:-width]

    def fault_count(self):
        """P0952: the faults in r0947."""
        return _not_zero(self.numbers)

    def forget_faults(self):
        """P0952 = 0: forget all faults except the present trip."""
        for places, width in self._lists():
            places[width:] = [0] * (len(places) - width)

    def _lists(self):
        """Each list that is kept for the trips, and how many places a trip takes in it."""
        return (self.numbers, PLACES), (self.values, PLACES), (self.times, self._time_words)

    def warn(self, number, on):
        """A warning comes or goes."""
        if on == (number in self._present):
            return
        if on:
            self._present.append(number)
        else:
            self._present.remove(number)
            self.warnings[SHOWN:] = [number] + self.warnings[SHOWN:-1]
        self.warnings[:SHOWN] = (self._present + [0] * SHOWN)[:SHOWN]

    def is_warning(self):
        return bool(self._present)

    def warning_count(self):
        """P2111: the warnings in r2110."""
        return _not_zero(self.warnings)

    def forget_warnings(self):
        """P2111 = 0: forget the warnings that are gone."""
        self.warnings[SHOWN:] = [0] * SHOWN


def _not_zero(numbers):
    return len([number for number in numbers if number])
