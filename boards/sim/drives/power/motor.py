# SPDX-License-Identifier: MIT
"""The motor of a simulated drive: its frequency as a path through time.

process.py tells it where to go and how fast. The path is a few corners with straight lines between
them, laid when a command changes and only read afterwards. So the frequency at an instant does not
depend on how often it is read.

    motor.ramp(now_us, 25.0, 50.0, 10.0, 5.0)   # to 25 Hz; 0...50 Hz takes 10 s, 50...0 Hz 5 s
    motor.hz(now_us + 1_000_000)                # 5.0

Frequencies are signed, negative turns left. Times are microseconds of virtual time.
"""


class Motor:
    """changing(now_us) is called before the path changes.

    end_us   when the path ends: from then on the frequency stays
    """

    def __init__(self, changing):
        self.end_us = 0
        self._changing = changing
        self._corners = [(0, 0.0)]  # (instant, frequency), the first is where the path began
        self._order = None

    def hz(self, now_us):
        """Frequency at `now_us`, which is not before the last command."""
        if now_us >= self.end_us:
            return self._corners[-1][1]
        at = self._next_corner(now_us)
        from_us, from_hz = self._corners[at - 1]
        to_us, to_hz = self._corners[at]
        return from_hz + (to_hz - from_hz) * (now_us - from_us) / (to_us - from_us)

    def slope(self, now_us):
        """How fast it changes at `now_us`, in Hz/s."""
        if now_us >= self.end_us:
            return 0.0
        at = self._next_corner(now_us)
        from_us, from_hz = self._corners[at - 1]
        to_us, to_hz = self._corners[at]
        return (to_hz - from_hz) * 1e6 / (to_us - from_us)

    def _next_corner(self, now_us):
        """The corner that comes next, on a path that has not ended."""
        at = 1
        while self._corners[at][0] <= now_us:
            at += 1
        return at

    def ramp(self, now_us, target_hz, full_hz, up_s, down_s):
        """Go to `target_hz`, through standstill if the direction changes.

        0...full_hz takes `up_s`, full_hz...0 takes `down_s`; 0 s means at once.
        """
        order = (target_hz, full_hz, up_s, down_s)
        if order == self._order:
            return  # on its way: laying the path anew would only add rounding errors
        self._changing(now_us)
        hz = self.hz(now_us)
        self._order = order
        self._corners = [(now_us, hz)]
        self.end_us = now_us
        if hz * target_hz < 0:
            self._go(0.0, hz, full_hz, down_s)
            hz = 0.0
        slowing = abs(target_hz) < abs(hz)
        self._go(target_hz, target_hz - hz, full_hz, down_s if slowing else up_s)

    def hold(self, now_us):
        """Stay at the present frequency."""
        self.ramp(now_us, self.hz(now_us), 1.0, 0.0, 0.0)

    def jump(self, now_us, target_hz):
        """Be at `target_hz` at once."""
        self.ramp(now_us, target_hz, 1.0, 0.0, 0.0)

    def coast(self, now_us, coast_s):
        """Pulses off: friction alone brings it to standstill, from 50 Hz in `coast_s`."""
        self.ramp(now_us, 0.0, 50.0, coast_s, coast_s)

    def _go(self, target_hz, change_hz, full_hz, full_s):
        if full_hz:
            self.end_us += int(abs(change_hz) * full_s * 1e6 / full_hz + 0.5)
        self._corners.append((self.end_us, target_hz))
