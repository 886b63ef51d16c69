# SPDX-License-Identifier: MIT
"""Random numbers of a seed: the same ones for the same seed on every interpreter, without heap.

If other draws must not change your numbers, make your own dice.

    dice = Dice(4711)
    dice.random(1, 6)
"""

BITS = 0x3FFFFFFF


class Dice:
    """seed: any integer from 0 on; which: a number for each of several dice of one seed."""

    def __init__(self, seed, which=0):
        self._state = (seed * 0x2545F + which * 0x1B873 + 0x1234567) & BITS or 1  # never 0

    def random(self, low, high):
        """A number from low to high, both included (xorshift).

        Bits that a shift would lose are masked before it: beyond 30 the 32-bit build takes heap.
        """
        state = self._state
        state ^= (state & 0x7FFFFF) << 7
        state ^= state >> 9
        state ^= (state & 0x3FFFFF) << 8
        self._state = state
        return low + state % (high - low + 1)
