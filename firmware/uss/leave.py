# SPDX-License-Identifier: MIT
"""How a program leaves the line: every drive is stopped and has answered before telegrams end.

The panel, `bus` and `s7` use it. The engine's part is `Master.close`; this waits for its end.

    leave(bus, clock, go_on)        # bus: a `master.Master`
    persist(pacer.stop)             # for anything else that must not be cut short
"""

from micropython import const

from uss.master import CLOSED
from uss.timing import elapsed

_PATIENCE_US = const(1_000_000)  # for the answers to OFF1, and a round of the bus on top


def leave(bus, clock, go_on):
    """Return when every drive in contact has answered OFF1, the others were sent it, and the bus
    sends nothing any more: mostly within a second and a round of the bus. At once if the bus is
    off, or listens because another master was heard.

    clock: as of `hal`. go_on: a function called again and again meanwhile; it makes the engine go
    on, feeds a watchdog, sleeps. Ctrl-C does not cut this short, because a motor may be turning.
    """
    persist(bus.close)
    persist(_wait, bus, clock, go_on)


def persist(action, *arguments):
    """Call `action`; if Ctrl-C strikes in the middle, call it once more from the beginning."""
    while True:
        try:
            return action(*arguments)
        except KeyboardInterrupt:
            pass


def _wait(bus, clock, go_on):
    patience_us = _PATIENCE_US + bus.turns.longest_cycle_us()
    left_us = 2 * patience_us  # as much again for an exchange under way, or a link that hangs
    before = clock.ticks_us()
    while bus.phase != CLOSED and left_us > 0:
        try:
            if left_us <= patience_us:
                bus.give_up()
            go_on()
        except KeyboardInterrupt:
            pass
        now = clock.ticks_us()
        left_us -= elapsed(now, before, clock.ticks_mask)
        before = now
