# SPDX-License-Identifier: MIT
"""Pseudo-random numbers: one seed decides the sequence, the same on every interpreter.

In use:

    dice = Dice(7)
    other = Dice(7, 1)      # others of the same seed
    dice.below(6)           # 0...5
    may("commissions", 7)   # whether the operator of this seed does that
"""

MASK = 0x3FFFFFFF  # a small integer on 32-bit builds

# What an operator may be given to: which dice of his seed tell it, and in one life of how many.
# There he does little else.
GIVEN_TO = {
    "types": (13, 4),  # sets setpoints digit by digit
    "looks_up": (19, 4),  # looks parameters and faults up
    "diagnoses": (21, 8),  # looks into the line, and leaves it to others
    "keeps_sets": (29, 8),  # saves and writes parameter sets, if there are few drives
    "commissions": (31, 8),  # commissions drives, reads the events, and tours the menu
    "locks": (55, 12),  # locks the keys, opens the lock, and tries it
    "arranges": (137, 8),  # keeps another order of several drives, and other turns of theirs
    "resets": (151, 12),  # gives drives their factory settings, and has motors identified
}


class Dice:
    def __init__(self, seed, which=0):
        self._state = (seed * 0x1E3779B + which * 0x3C6EF35 + 0x2545F49) & MASK or 1
        for _ in range(8):
            self.below(2)

    def below(self, limit):
        """0...limit - 1 (xorshift)."""
        state = self._state
        state ^= (state << 7) & MASK
        state ^= state >> 9
        state ^= (state << 8) & MASK
        self._state = state
        return (state >> 3) % limit

    def between(self, low, high):
        return low + self.below(high - low + 1)

    def one_of(self, choices):
        return choices[self.below(len(choices))]


def may(what, seed):
    """Whether the operator of this seed is given to what GIVEN_TO names, if its world lets him."""
    which, one_in = GIVEN_TO[what]
    return Dice(seed, which).below(one_in) == 0
