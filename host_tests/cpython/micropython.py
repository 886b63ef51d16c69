# SPDX-License-Identifier: MIT
"""What CPython lacks of MicroPython's own module, for the tests that run on both.

Only `const`: whatever needs more of the real module (heap_lock, viper) is tested on MicroPython.
"""


def const(value):
    return value
