# SPDX-License-Identifier: MIT
"""Process data: control word STW, status word ZSW, and the scaling of setpoint and actual value.

This holds facts as tables; no telegram, no drive object. The master sends STW with the main
setpoint HSW, the drive sends ZSW with the main actual value HIW (specification C-5). `bits` names
each bit.

    ON, OFF1                          # whole control words a master sends
    state(0xFB34)                     # RUNNING
    Scaling(5000, False).hsw(1000)    # 10.00 Hz of 50.00 Hz as 0CCDh
"""

from micropython import const

# --- control word -------------------------------------------------------------------------------

STW_ON = const(0x0001)
STW_ACKNOWLEDGE = const(0x0080)
STW_REVERSE = const(0x0800)
STW_RUN = const(0x0301)  # ON, JOG_RIGHT, JOG_LEFT: each of them turns the motor

# Whole control words. Bit 10 is never 0. With ON a MICROMASTER 4 ignores the jogs.
OFF1 = const(0x047E)  # ramp down; the first word that a drive is sent
OFF2 = const(0x047C)  # coast
OFF3 = const(0x047A)  # ramp down as fast as the drive can
ON = const(0x047F)
ON_REVERSE = const(0x0C7F)
JOG_RIGHT = const(0x057E)
JOG_LEFT = const(0x067E)

# --- status word --------------------------------------------------------------------------------

ZSW_READY = const(0x0031)  # to switch on, and neither OFF2 nor OFF3 is in force
ZSW_RUNNING = const(0x0004)
ZSW_FAULT = const(0x0008)
ZSW_INHIBIT = const(0x0040)
ZSW_WARNING = const(0x0080)
ZSW_RUNS_RIGHT = const(0x4000)

# The states that a status word may tell. One that matches no row of STATES is NOT_READY.
NOT_READY, READY, RUNNING, FAULT, INHIBITED = range(5)

# The first row that matches counts: a fault outranks all, then the inhibit. MM4 shows 31h when
# ready and 34h when running, G120 31h and 37h: bits 0 to 2 are exclusive on the MM4, cumulative on
# the G120. So only the highest of them that is set counts.
STATES = (  # mask, value, state
    (0x0008, 0x0008, FAULT),
    (0x0040, 0x0040, INHIBITED),
    (0x0004, 0x0004, RUNNING),
    (0x0031, 0x0031, READY),
)


def _look_up(zsw):
    for mask, value, name in STATES:
        if zsw & mask == value:
            return name
    return NOT_READY


# The state for each value of the bits in STATES, because the panel asks many times a second.
_STATE_BITS = const(0x7F)
_STATE_OF = bytes(_look_up(zsw) for zsw in range(_STATE_BITS + 1))


def state(zsw):
    """One of NOT_READY, READY, RUNNING, FAULT, INHIBITED for a status word."""
    return _STATE_OF[zsw & _STATE_BITS]


# --- scaling ------------------------------------------------------------------------------------

FULL_SCALE = const(0x4000)  # 100 % of the reference frequency P2000
REFERENCE_MIN = const(100)  # P2000 in centihertz (MICROMASTER 4 parameter list)
REFERENCE_MAX = const(65000)
HSW_MIN = const(-0x8000)
HSW_MAX = const(0x7FFF)
BEYOND = (0x7FFF, 0x8000)  # a drive stops counting here: the true value may be any beyond it


def signed(word):
    """The two's complement value of a 16-bit word: 8000h...FFFFh are negative."""
    return word - 0x10000 if word & 0x8000 else word


def signed_hiw(family, hiw, zsw):
    """The actual value of a drive of the family as a word with a sign.

    If HIW is only a magnitude, bit 14 of ZSW tells the direction. A value that is already negative
    stays negative.
    """
    if family.hiw_is_signed or zsw & ZSW_RUNS_RIGHT or hiw & 0x8000:
        return hiw
    return -hiw & 0xFFFF


class Scaling:
    """Between frequencies and the words of PZD2, all in integers that fit 31 bits.

    Frequencies are in centihertz (0.01 Hz): 1000 is 10.00 Hz.

    reference_centihertz: P2000, 100...65000.
    absolute: True when P2009 = 1, PZD2 is then the frequency itself in 0.01 Hz.
    """

    def __init__(self, reference_centihertz, absolute):
        if not REFERENCE_MIN <= reference_centihertz <= REFERENCE_MAX:
            raise ValueError("reference frequency of %d centihertz" % reference_centihertz)
        self.reference_centihertz = reference_centihertz
        self.absolute = absolute

    def is_of(self, reference_centihertz, absolute):
        """Whether it was made with these arguments."""
        return self.reference_centihertz == reference_centihertz and self.absolute == absolute

    def full_scale(self):
        """The count that stands for the reference."""
        return self.reference_centihertz if self.absolute else FULL_SCALE

    def limit_centihertz(self):
        """The largest frequency that a word can carry: 200 % of the reference, or 327.67 Hz."""
        if self.absolute:
            return HSW_MAX
        return 2 * self.reference_centihertz - 1

    def hsw(self, centihertz):
        """The unsigned word for a frequency, rounded, and limited to the word's range."""
        if self.absolute:
            count = centihertz
        else:
            magnitude = min(abs(centihertz), 2 * self.reference_centihertz)
            # At most 65000 * 16384 fits a small integer, so twice that is computed in two halves.
            reference = self.reference_centihertz
            whole = FULL_SCALE if magnitude >= reference else 0
            rest = magnitude - reference if whole else magnitude
            count = whole + (rest * FULL_SCALE + reference // 2) // reference
            count = -count if centihertz < 0 else count
        return max(HSW_MIN, min(HSW_MAX, count)) & 0xFFFF

    def centihertz(self, hiw):
        """The signed frequency that an actual value means, rounded to 0.01 Hz."""
        count = signed(hiw)
        if self.absolute:
            return count
        # count * reference in two parts: the product itself can exceed a small integer.
        magnitude = abs(count)
        high, low = magnitude >> 7, magnitude & 0x7F
        reference = self.reference_centihertz
        frequency = (high * reference + ((low * reference) >> 7) + 64) >> 7
        return -frequency if count < 0 else frequency
