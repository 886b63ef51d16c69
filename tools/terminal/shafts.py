# SPDX-License-Identifier: MIT
"""The mark that shows how a motor turns."""

# The shaft, seen from its end, turning to the right. The mark shows it behind a gear, as slow as
# the eye can follow, and never more than one position further: its direction can always be seen.
SHAFT = "|/-\\"
HZ_PER_STEP_A_SECOND = 3
STEP = HZ_PER_STEP_A_SECOND * 1_000_000


class Shafts:
    """Turns the marks: positions[address]."""

    def __init__(self):
        self.positions = {}
        self._angles = {}  # Hz times microseconds
        self._turned_us = None

    def turn(self, drives, us):
        """To the world's time `us`."""
        passed_us = us - self._turned_us if self._turned_us is not None else 0
        self._turned_us = us
        for drive in drives:
            address = drive["a"]
            angle = self._angles.get(address, 0.0) + (drive["hz"] or 0.0) * passed_us
            position = self.positions.setdefault(address, 0)
            if abs(angle) >= STEP:
                step = 1 if angle > 0 else -1
                self.positions[address] = position + step
                angle = max(-STEP, min(STEP, angle - step * STEP))
            self._angles[address] = angle

    def mark(self, address):
        return SHAFT[self.positions.get(address, 0) % len(SHAFT)]
