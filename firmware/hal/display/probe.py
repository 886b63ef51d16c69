# SPDX-License-Identifier: MIT
"""Finds out whether a display's backpack is there, before its driver takes memory.

In use:

    answers(i2c, 0x27)
"""

from micropython import const

BACKLIGHT = const(0x08)  # the output P3 of every backpack


def answers(i2c, address):
    """Whether a backpack is there. Switches its backlight on and writes nothing."""
    try:
        i2c.writeto(address, bytes((BACKLIGHT,)))
    except OSError:
        return False
    return True
