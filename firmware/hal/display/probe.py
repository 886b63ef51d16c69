# SPDX-License-Identifier: MIT
"""Finds out whether a display's backpack is there, before its driver takes memory.

In use:

    free(data_pin, clock_pin, time.sleep_us)
    answers(i2c, 0x27)
"""

from micropython import const

BACKLIGHT = const(0x08)  # the output P3 of every backpack
_CLOCKS = const(9)  # a byte and its acknowledgement,
_PULSE_US = const(5)  # at 100 kHz


def free(data, pulse, sleep_us):
    """Make the wires of an I2C free: a reset in the middle of a transfer leaves the backpack
    waiting for a clock, and it holds SDA low. data: an input. pulse: an open-drain output, high.
    """
    for _ in range(_CLOCKS):
        sleep_us(_PULSE_US)
        if data.value():
            break
        pulse.value(0)
        sleep_us(_PULSE_US)
        pulse.value(1)


def answers(i2c, address):
    """Whether a backpack is there. Switches its backlight on and writes nothing."""
    try:
        i2c.writeto(address, bytes((BACKLIGHT,)))
    except OSError:
        return False
    return True
