# SPDX-License-Identifier: MIT
"""How long a drive may wait for a telegram before it stops by itself: P2014, telegram off time.

With P2014 = 0 a motor runs on for ever when the panel dies. The panel offers a time that fits its
bus: long enough for bad luck, short enough to matter.

    off_time_ms(bus.turns.longest_cycle_us())         # 1000...65000
    longest_off_time_ms(bus.turns.longest_cycle_us()) # from 2000 on: more is too long
"""

from micropython import const

_CYCLES = const(3)  # rounds of the bus in which every drive answers late
_SHORTEST_MS = const(1_000)
_LONGEST_MS = const(65_000)  # P2014 goes to 65535
_STEP_MS = const(100)
_PATIENCE_MS = const(2_000)  # a motor may run on for so long, or
_PATIENCE_CYCLES = const(4)  # so many rounds of the bus


def off_time_ms(longest_cycle_us):
    """A telegram off time for a drive, in ms, rounded up to tenths of a second."""
    needed_ms = -(-_CYCLES * (longest_cycle_us // 1000 + 1) // _STEP_MS) * _STEP_MS
    return min(max(needed_ms, _SHORTEST_MS), _LONGEST_MS)


def longest_off_time_ms(longest_cycle_us):
    """With a longer P2014, in ms, a motor runs on too long when the panel dies."""
    return max(_PATIENCE_MS, _PATIENCE_CYCLES * (longest_cycle_us // 1000 + 1))
