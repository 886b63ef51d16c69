# SPDX-License-Identifier: MIT
"""The world's clock where the world is joined to something real: it follows a true counter.

Simulated events keep their exact instants; in real time they come as late as the machine was busy.
If somebody sleeps in the clock, it runs ahead of the counter, and then waits for it.

    clock = RealClock(stopwatch)        # stopwatch() -> microseconds, never falls, never wraps
    clock.follow()                      # events up to now happen
    clock.next_us()                     # how long nothing is going to happen
"""

from boards.sim.clock import Clock

NOTHING_DUE_US = 1_000_000


class RealClock(Clock):
    """read_us: a function that answers true microseconds since whatever instant."""

    def __init__(self, read_us):
        Clock.__init__(self)
        self._read_us = read_us
        self._began_us = read_us()

    def ticks_us(self):
        self._follow_unless_inside()
        return Clock.ticks_us(self)

    def ticks_ms(self):
        self._follow_unless_inside()
        return Clock.ticks_ms(self)

    def follow(self):
        """Let the time pass that has truly passed."""
        true_us = self.true_us()
        if true_us > self.now_us:
            self.advance_to(true_us)

    def true_us(self):
        """The true time since the world began."""
        return self._read_us() - self._began_us

    def next_us(self):
        """Microseconds until the next event, 0 when it is due, 1 s at the most."""
        for at_us, _ in self.coming():
            return min(max(at_us - self.true_us(), 0), NOTHING_DUE_US)
        return NOTHING_DUE_US

    def _follow_unless_inside(self):
        if not self._advancing:
            self.follow()
