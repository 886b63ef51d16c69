# SPDX-License-Identifier: MIT
"""A chip whose callbacks are soft: they wait until the interpreter gets to them.

    chip = SoftChip(clock, wire, random)
    chip.hold()                         # a collection, or anything that runs in C
    clock.advance(12_000)
    chip.let_go()

In between a callback comes LATE_US after its cause: the task of the interpreter has to be woken,
and the bytecode under way, or a write to the display, to end.
"""

from boards.sim.chip.machine import Chip
from boards.sim.clock import Event

LATE_US = (60, 900)
COLLECTION_US = 12_000
COLLECTION_EVERY_US = 700_000


class SoftChip(Chip):
    """random: a function of (low, high); None: every callback is as late as it may be."""

    def __init__(self, clock, wire, random=None):
        Chip.__init__(self, clock, wire)
        self.frozen = False  # nothing of the interpreter runs
        self._random = random
        self._held = []
        self._alarms = {}

    def interrupt(self, interrupt):
        if interrupt.hard:
            Chip.interrupt(self, interrupt)
            return
        alarm = self._alarms.get(id(interrupt))
        if alarm is None:
            alarm = Event(lambda: self._come(interrupt))
            self._alarms[id(interrupt)] = alarm
        if not alarm.armed:
            late_us = self._random(*LATE_US) if self._random else LATE_US[1]
            self.clock.schedule(alarm, self.clock.now_us + late_us)

    def hold(self):
        self.frozen = True

    def let_go(self):
        self.frozen = False
        held, self._held = self._held, []
        for interrupt in held:
            Chip.interrupt(self, interrupt)

    def reset(self):
        for alarm in self._alarms.values():
            self.clock.cancel(alarm)
        self._alarms = {}
        self._held = []
        self.frozen = False
        Chip.reset(self)

    def _come(self, interrupt):
        if self.frozen:
            if interrupt not in self._held:
                self._held.append(interrupt)
        else:
            Chip.interrupt(self, interrupt)
