# SPDX-License-Identifier: MIT
"""The motor potentiometer of a simulated drive: a setpoint that two bits turn up and down.

It makes the setpoint, which the motor follows with its own ramp.

    potentiometer.set(5.0)
    potentiometer.turn(now_us, 1)                   # up, until told otherwise
    while potentiometer.is_due(later_us):           # worked out when somebody asks
        potentiometer.step(50.0, 10.0, 10.0, False)
    potentiometer.output_hz

It goes in steps of 10 ms, which is a choice; the parameter lists tell the ramp times alone.
"""

STEP_US = 10_000


class Potentiometer:
    """output_hz   r1050
    next_us     when the next step is due, while it turns
    """

    def __init__(self):
        self.output_hz = 0.0
        self.next_us = 0
        self._direction = 0

    def set(self, hz):
        self.output_hz = hz

    def turn(self, now_us, direction):
        """1 up, -1 down, 0 stand still."""
        if direction != self._direction:
            self._direction = direction
            self.next_us = now_us + STEP_US

    def is_due(self, now_us):
        return self._direction != 0 and self.next_us <= now_us

    def step(self, full_hz, up_s, down_s, both_ways):
        """Turn by 10 ms: away from 0 Hz by `up_s` for 0...full_hz, else by `down_s`.

        both_ways: down goes on beyond 0 Hz, to the left. At its end it stands still.
        """
        self.next_us += STEP_US
        hz = self.output_hz
        full_s = up_s if hz * self._direction >= 0 else down_s
        steps = full_s * 1_000_000 / STEP_US
        hz += self._direction * (full_hz / steps if steps > 1 else full_hz)
        hz = min(max(hz, -full_hz if both_ways else 0.0), full_hz)
        if hz == self.output_hz:
            self._direction = 0
        self.output_hz = hz
