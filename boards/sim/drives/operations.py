# SPDX-License-Identifier: MIT
"""What a simulated drive does because a parameter was written: it saves, resets, calculates.

Some operations take seconds in which a real drive is silent (P0340, P0970, P0971, P1910, P3900).
This carries them out and tells how long they take; drive.py keeps silent meanwhile. A family's
OPERATIONS name its numbers: {number: (what, seconds)}.

    operations.note(970)        # P0970 was written: True if that starts something
    operations.seconds()        # 10: of the first operation that waits
    operations.carry_out()      # do it; P0970 is 0 again

No parameter list says how long each takes; users have reported that a reset takes about 10 s. The
calculations are general knowledge, and their formulas rough: a master only needs to see a change.
"""

SAVE = "RAM to EEPROM"
RESET = "factory reset"
CALCULATE = "motor data"
END_COMMISSIONING = "end of quick commissioning"
ACKNOWLEDGE = "acknowledge"
CLEAR_FAULTS, CLEAR_WARNINGS, CLEAR_ENERGY = "clear faults", "clear warnings", "clear energy"
CLEARS = (CLEAR_FAULTS, CLEAR_WARNINGS, CLEAR_ENERGY)

# Values of P3900.
RESET_OTHERS, RESET_TERMINALS = 1, 2

SQUARE_ROOT_OF_3 = 1.7320508


class Operations:
    """family: a module such as mm420. Operations are carried out one after the other."""

    def __init__(self, family, parameters, process, switches):
        self._table = family.OPERATIONS
        self._only_zero = family.ONLY_ZERO
        self._kept = family.KEPT
        self._quick = family.QUICK_COMMISSIONING
        self._terminals = family.TERMINALS
        self._parameters = parameters
        self._process = process
        self._switches = switches
        self._waiting = []

    def forget(self):
        """As at power-up: nothing waits."""
        del self._waiting[:]

    def note(self, number):
        """A number was written. Return whether that starts an operation, which then waits.

        An operation that only clears something is done at once, so that the reply to the write
        shows it.
        """
        if number not in self._table:
            return False
        if number not in self._only_zero and not any(self._parameters.ram[number]):
            return False
        self._waiting.append(number)
        if len(self._waiting) == 1 and self._table[number][0] in CLEARS and not self.seconds():
            self.carry_out()
            return False
        return True

    def seconds(self):
        """How long the first operation that waits takes; None if none waits."""
        if not self._waiting:
            return None
        number = self._waiting[0]
        return (self._switches.silence_s or {}).get(number, self._table[number][1])

    def carry_out(self):
        """Do the first operation that waits; its number is 0 again."""
        number = self._waiting.pop(0)
        what = self._table[number][0]
        values = list(self._parameters.ram.get(number, ()))
        for index in range(len(values)):
            self._parameters.store(number, index, 0, False)
        if what == SAVE:
            self._parameters.save()
        elif what == RESET:
            self._parameters.deliver(self._kept_numbers())
        elif what == CALCULATE:
            self._calculate(values)
        elif what == END_COMMISSIONING:
            self._end_commissioning(values[0])
        elif what == ACKNOWLEDGE:
            self._process.acknowledge()
        elif what == CLEAR_FAULTS:
            self._process.clear_faults()
        elif what == CLEAR_WARNINGS:
            self._process.clear_warnings()
        else:
            self._process.clear_energy()

    def _kept_numbers(self):
        return self._kept if self._switches.keeps_link else ()

    def _end_commissioning(self, how):
        """P3900. This changes RAM only; P0971 saves it."""
        parameters = self._parameters
        if how == RESET_OTHERS:
            parameters.restore_defaults(self._quick + self._kept_numbers())
        elif how == RESET_TERMINALS:
            first, last = self._terminals
            others = [number for number in parameters.ram if not first <= number <= last]
            parameters.restore_defaults(others)
        parameters.store(10, 0, 0, False)
        self._calculate([1] * len(parameters.ram[340]))

    def _calculate(self, wanted):
        """P0340 or P1910: calculate values from the motor's rating plate, for the data sets
        wanted.
        """
        ram = self._parameters.ram
        for index in range(len(ram[304])):
            if wanted[min(index, len(wanted) - 1)]:
                current = ram[305][index]
                resistance = 0.1 * ram[304][index] / (SQUARE_ROOT_OF_3 * current)
                self._parameters.fit(350, index, resistance)
                self._parameters.fit(2000, index, ram[310][index])
                self._parameters.fit(2002, index, current)
