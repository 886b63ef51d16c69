# SPDX-License-Identifier: MIT
"""Converts words of PZD2 to percent, Hz and 1/min and back, in floating point, with direction.

For programs that work in a loop: everything here takes memory, so do not call it in an interrupt.
The panel works in integers, with `pzd.Scaling`.

    scale = Scale(reference_hertz=50.0, pole_pairs=2)
    scale.from_rpm(-750.0)              # 0xE000
    scale.hertz(0x2000)                 # 25.0
    run_words(MM3, 0xE000)              # (0x147F, 0x2000): this one does not take a sign
"""

from uss.pzd import FULL_SCALE, HSW_MAX, HSW_MIN, signed

CENTIHERTZ_PER_HERTZ = 100
SECONDS_PER_MINUTE = 60
RATED_ROUNDING = 0.01  # a motor's plate rounds its frequency by at most this fraction


class Scale:
    """What PZD2 of one drive means, both ways. Every value has a sign: negative turns left.

    reference_hertz: the frequency that is 100 %, 4000h: P2000; P094 of an MM3.
    reference_rpm: instead of that the speed that is 100 %: p2000 of a G120.
    pole_pairs: of the motor; they convert one to the other.
    absolute: PZD2 is in 0.01 Hz (P2009 = 1; P095 = 2 of an MM3).

    ValueError if a value needs an argument that was not given, or if no word can carry it: beyond
    -200 ... 200 % of the reference, or -327.68 ... 327.67 Hz when absolute. 200 % itself becomes
    199.994 %, the largest word.
    """

    def __init__(self, reference_hertz=None, reference_rpm=None, pole_pairs=None, absolute=False):
        if reference_hertz is None and reference_rpm and pole_pairs:
            reference_hertz = reference_rpm * pole_pairs / SECONDS_PER_MINUTE
        elif reference_rpm is None and reference_hertz and pole_pairs:
            reference_rpm = reference_hertz * SECONDS_PER_MINUTE / pole_pairs
        for reference in (reference_hertz, reference_rpm):
            if reference is not None and not reference > 0:
                raise ValueError("reference of %r" % (reference,))
        self.reference_hertz = reference_hertz
        self.reference_rpm = reference_rpm
        self.absolute = absolute

    def from_percent(self, percent):
        """The setpoint word, 0...FFFFh, for percent of the reference."""
        return self._word(percent / 100)

    def from_hertz(self, hertz):
        """The setpoint word for a frequency."""
        if self.absolute:
            return _limited(hertz * CENTIHERTZ_PER_HERTZ)
        return self._word(hertz / self._needed(self.reference_hertz))

    def from_rpm(self, rpm):
        """The setpoint word for a speed in 1/min; for an asynchronous motor without slip."""
        return self._word(rpm / self._needed(self.reference_rpm))

    def percent(self, word):
        """An actual value in percent of the reference."""
        return 100 * self._fraction(word)

    def hertz(self, word):
        """An actual value in Hz."""
        if self.absolute:
            return signed(word) / CENTIHERTZ_PER_HERTZ
        return self._fraction(word) * self._needed(self.reference_hertz)

    def rpm(self, word):
        """An actual value in 1/min; for an asynchronous motor without slip."""
        return self._fraction(word) * self._needed(self.reference_rpm)

    def _word(self, fraction):
        return _limited(fraction * self._full())

    def _fraction(self, word):
        return signed(word) / self._full()

    def _full(self):
        """The count that stands for the reference."""
        if self.absolute:
            return self._needed(self.reference_hertz) * CENTIHERTZ_PER_HERTZ
        return FULL_SCALE

    def _needed(self, reference):
        if reference is None:
            raise ValueError(
                "reference or pole pairs of the drive are not known: add it with scale=Scale(...)"
            )
        return reference


def run_words(family, hsw, reverse=False):
    """The (STW, HSW) that make a drive of the family run.

    hsw: a setpoint word with its sign. reverse: turn the other way; a negative setpoint and
    `reverse` cancel each other, as in the drive.
    """
    if family.hsw_is_signed and family.on_reverse:
        return (family.on_reverse if reverse else family.on), hsw
    count = -signed(hsw) if reverse else signed(hsw)
    if family.hsw_is_signed:
        return family.on, min(count, HSW_MAX) & 0xFFFF
    return (family.on_reverse if count < 0 else family.on), min(abs(count), HSW_MAX)


def pole_pairs(frequency_hertz, speed_rpm):
    """A motor's pole pairs, from its rated frequency and its rated speed, which slip may lower.

    ValueError if no motor has these; a rated speed of 0 means that it was not entered.
    """
    one_pair_rpm = SECONDS_PER_MINUTE * frequency_hertz
    if not 0 < speed_rpm <= one_pair_rpm * (1 + RATED_ROUNDING):
        raise ValueError("a motor of %r Hz and %r 1/min" % (frequency_hertz, speed_rpm))
    return int(one_pair_rpm / speed_rpm + RATED_ROUNDING)


def _limited(count):
    if not HSW_MIN <= count <= HSW_MAX + 1:  # true of a NaN, too
        raise ValueError("more than a telegram can carry: 200 % of the reference, or 327.67 Hz")
    return min(round(count), HSW_MAX) & 0xFFFF
