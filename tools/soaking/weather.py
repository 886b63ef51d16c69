# SPDX-License-Identifier: MIT
"""What goes wrong on the line during a soak: which faults, how often, and how many there were.

In use:

    weather = Weather(world, plan)
    weather.change()                # other faults from now on
    weather.clear()                 # no faults from now on
    weather.dips                    # supplies that fail: (whose, milliseconds), not yet carried
    out
"""

from boards.sim.dice import Dice
from boards.sim.line.faults import BABBLE_MS, WIRE_CUT_MS, LineFaults
from tools.soaking.worlds import CLEAN, WILD

# Kind: the highest rate of a rough line, and of a wild one.
RATES = {
    "flip": (0.002, 0.01),
    "lost": (0.0003, 0.005),
    "doubled": (0.0003, 0.005),
    "stray": (0.0003, 0.005),
    "late": (0.003, 0.1),
    "cut": (0.003, 0.1),
    "foreign": (0.003, 0.1),
    "noise": (0.3, 10),
    "babble": (60, 400),
    "wire cut": (60, 300),
    "dip": (60, 200),
}
STEPS = 1000


class Weather:
    """faults: the `LineFaults` of the world's line, None where the plan is CLEAN."""

    def __init__(self, world, plan):
        self.dips = []
        self.faults = None
        self._dice = plan.dice
        self._plan = plan
        self._clock = world.clock
        self._wire = world.wire
        self._struck = self._lasting = 0  # faults so far; how many of them go on for a while
        self._cuts = 0
        self._deaf_until_us = 0
        self._until_us = 0  # when the last of those is over, at the latest
        if plan.level != CLEAN:
            self.faults = LineFaults(world.wire, Dice(plan.seed, 3).random, None, self._dip)

    def change(self):
        """Draw a rate for each kind, up to its highest or 0; now and then there are no faults."""
        dice = self._dice
        if self.faults is None or not dice.below(4):
            return
        column = 1 if self._plan.level == WILD else 0
        for kind in sorted(RATES):
            if dice.below(2):
                rate = RATES[kind][column]
                self.faults.set(kind, rate * dice.between(1, STEPS) / STEPS)
        if column and not dice.below(6):
            self.faults.set("twin", dice.one_of(self._plan.addresses))

    def clear(self):
        if self.faults is not None:
            self.faults.calm()
            self._wire.echo = self._plan.echo  # the echo belongs to the plan, not to the weather
            self._until_us = 0

    def is_bad(self):
        """Whether a fault has struck since the last call, or may still go on."""
        if self.faults is None:
            return False
        now_us = self._clock.now_us
        count = self.faults.count
        struck = sum(count.values())
        if struck == self._struck:
            return now_us < self._until_us
        self._struck = struck
        lasting = count["babble"] + count["wire cut"]
        if lasting != self._lasting:
            self._lasting = lasting
            self._until_us = now_us + max(BABBLE_MS[1], WIRE_CUT_MS[1]) * 1000
        return True

    def may_be_deaf(self):
        """Whether the panel's wires may be broken, so that it does not hear what the line says."""
        count = self.faults.count["wire cut"] if self.faults is not None else 0
        if count != self._cuts:
            self._cuts = count
            self._deaf_until_us = self._clock.now_us + (WIRE_CUT_MS[1] + 100) * 1000
        return self._clock.now_us < self._deaf_until_us

    def count(self):
        return self.faults.count if self.faults is not None else {}

    def _dip(self, whose, ms):
        self.dips.append((whose, ms))
