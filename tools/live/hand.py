# SPDX-License-Identifier: MIT
"""A hand at the panel's keys, for a keyboard that does not tell when a key is let go.

    hand = Hand(world)
    hand.tap("START")               # down for 100 ms, as soon as the taps before it are done
    hand.hold("JOG_RIGHT", now_ms)  # down until something else is pressed
    hand.step(now_ms)               # every few milliseconds of the world

Taps happen in the world's time, so that the panel sees a tap at every speed. A held JOG runs in
real time: it lets go when the keyboard does not repeat it. On a real line every key but STOP does
the same: a terminal that went silent must not move a setpoint on and on.
"""

from boards.sim.world import RELEASE_MS, TAP_MS
from tools.live.keys import JOGS, STOP

TAP_US = TAP_MS * 1000
RELEASE_US = RELEASE_MS * 1000  # a key that was let go is up for so long before the next one
# Without a repeat the hand lets go after so long: if the keyboard repeats already, and if it still
# waits before its first repeat (X11: 660 ms).
REPEAT_MS = 300
FIRST_REPEAT_MS = 700
WAITING_MAX = 6  # taps typed ahead; more would come after the person wants them


class Hand:
    """world: a `World`.

    key: the one that is down, or None. held: it stays down. fixed: keys that a command put down.
    """

    def __init__(self, world):
        self.key = None
        self.held = False
        self.fixed = set()
        self._world = world
        self._waiting = []  # (key, whether to hold it)
        self._let_go_us = 0  # when the tap is over
        self._free_us = 0  # when the next key may go down
        self._renewed_ms = 0  # when the capital was typed last
        self._patience_ms = FIRST_REPEAT_MS

    def tap(self, key):
        """Press a key and let it go. False: too many taps are waiting, this one is lost."""
        return self._take(key, False)

    def hold(self, key, now_ms):
        """Press a key and keep it down until the next one; now_ms is real time. As `tap`."""
        renewed = self.holds(key)
        self._patience_ms = REPEAT_MS if renewed else FIRST_REPEAT_MS
        self._renewed_ms = now_ms
        return renewed or self._take(key, True)

    def holds(self, key):
        """Whether this key is held, or waits to be: another capital only renews that."""
        return (key, True) in self._waiting or self.held and self.key == key

    def let_go(self):
        """Let go of what is held, and forget the taps that wait."""
        self._waiting.clear()
        if self.key:
            self._up()

    def vanish(self):
        """The person was not heard: let go of every key, those of commands too."""
        self.let_go()
        for key in self.fixed:
            self._world.up(key)
        self.fixed.clear()

    def fix(self, key, down):
        """A command put a key down, or up, without this hand; it is no longer in the hand."""
        self.fixed.discard(key)
        if down:
            self.fixed.add(key)
        if key == self.key:
            self.key = None
            self.held = False

    def step(self, now_ms):
        """Do what is due; now_ms is real time."""
        world_us = self._world.clock.now_us
        if self.held:
            tired = self._is_fleeting() and now_ms - self._renewed_ms >= self._patience_ms
            if tired or self._waiting:
                self._up()
        elif self.key and world_us >= self._let_go_us:
            self._up()
        if self._waiting and not self.key and world_us >= self._free_us:
            self._down(*self._waiting.pop(0))

    def _is_fleeting(self):
        """Whether the key that is held has to be repeated."""
        return self.key in JOGS or self.key != STOP and self._world.port is not None

    def _take(self, key, hold):
        if key == STOP:
            self._waiting.clear()
            if STOP in self.fixed:  # to press what is down already, it has to come up first
                self.let_go()
                self.key = STOP
                self.held = True
            elif self.key != STOP:
                self._down(STOP, hold)
                return True
        if self.held:
            self._up()
        if len(self._waiting) >= WAITING_MAX:
            return False
        self._waiting.append((key, hold))
        return True

    def _down(self, key, hold):
        before = self.key
        self._world.down(key)
        if before:  # STOP is down already when the other one goes up
            self._world.up(before)
        self.fixed.discard(key)
        self.key = key
        self.held = hold
        self._let_go_us = self._world.clock.now_us + TAP_US

    def _up(self):
        self._world.up(self.key)
        self.fixed.discard(self.key)
        self.key = None
        self.held = False
        self._free_us = self._world.clock.now_us + RELEASE_US
