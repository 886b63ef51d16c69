# SPDX-License-Identifier: MIT
"""Who holds which key of a panel that several front ends show at once.

    holds = Holds(world)
    holds.hear(7, now_ms)               # whatever this front end says
    holds.down(7, "JOG_RIGHT")          # KeyRefused: it may not now, and why
    holds.up(7, "JOG_RIGHT")
    holds.step(now_ms)                  # every few milliseconds, now_ms is real time

A key is down while anybody holds it. It stays down for 100 ms of the panel's time, so that the
panel sees the shortest press. Presses that have to wait for that begin in the order in which they
came, so that SET does not overtake the DOWN before it. STOP waits for nobody and wins: whoever
presses it, all other keys come up. Who was not heard for 300 ms holds no key any more. When nobody
is heard for 2 s, nobody could press STOP: then all drives get OFF1.
"""

from boards.sim.clock import Event
from boards.sim.world import RELEASE_MS, TAP_MS
from tools.live.keys import STARTERS, STOP
from tools.live.pace import UNHEARD_MS

ALONE_MS = 2_000
ARMED_MS = 2_000
STOP_ALL_MS = 4_500  # STOP held for so long stops every drive
WAITING_MAX = 6  # presses of a key that wait; more would come after the person wants them
COMMAND = -1  # holds the key of a command that lets time pass

UNARMED = "on a real line %s is two keys within 2 s: arm it, then press it"
STOP_HELD = "no %s while STOP is held"
TOO_FAST = "too fast: this %s was left out"


class KeyRefused(Exception):
    """The key does not go down. Text: why."""


class Press:
    """One key: who holds it, and what is due on it."""

    def __init__(self):
        self.holders = set()
        self.waiting = 0  # presses that have not begun
        self.is_down = False
        self.least_us = 0  # it stays down until then
        self.free_us = 0  # it stays up until then

    def is_over(self):
        """Whether it should come up: nobody holds it, or it has to, for the next press."""
        return not self.holders or self.waiting > 0


class Holds:
    """world: a `World`. lonely: nobody was heard for 2 s, and somebody was before; the drives get
    OFF1 at that moment.
    """

    def __init__(self, world):
        self.lonely = False
        self._world = world
        self._presses = {}
        self._order = []  # keys of the presses that wait, the first one first
        self._next_us = 0  # the next of them begins then at the earliest
        self._heard_ms = {}  # of each front end that is there
        self._armed_ms = {}
        self._now_ms = 0
        self._last_ms = None  # when anybody was heard

    # --- front ends -----------------------------------------------------------------------------

    def hear(self, who, now_ms):
        """This front end has said something."""
        self._now_ms = now_ms
        self._last_ms = now_ms
        self._heard_ms[who] = now_ms
        self.lonely = False

    def leave(self, who):
        """This front end has gone: it holds no key, and is no STOP."""
        self.release(who)
        self._heard_ms.pop(who, None)
        self._armed_ms.pop(who, None)

    def is_there(self):
        """Whether anybody is."""
        return bool(self._heard_ms)

    def arm(self, who):
        """The first of the two keys for START and JOG on a real line."""
        self._armed_ms[who] = self._now_ms

    # --- keys -----------------------------------------------------------------------------------

    def down(self, who, key):
        """KeyRefused."""
        press = self._press(key)
        if who in press.holders:
            return
        if key in STARTERS:
            self._may_start(who, key)
        if not press.holders:
            if press.waiting >= WAITING_MAX:
                raise KeyRefused(TOO_FAST % key)
            press.waiting += 1
            self._order.append(key)
        press.holders.add(who)
        self._do_due(key, press)
        if key == STOP:
            self._stop_wins()

    def up(self, who, key):
        press = self._press(key)
        press.holders.discard(who)
        self._do_due(key, press)

    def release(self, who):
        """This front end lets go of every key."""
        for key in self._presses:
            self.up(who, key)

    def vanish(self):
        """Nobody was heard: let go of every key."""
        for key, press in self._presses.items():
            self._forget(key, press)
            press.holders.clear()
            self._do_due(key, press)

    def fix(self, key, down):
        """A command that lets time pass has put a key down, or up: `Errand`."""
        press = self._press(key)
        press.is_down = down
        self._forget(key, press)
        press.least_us = 0
        if down:
            press.holders.add(COMMAND)
            if key == STOP:
                self._stop_wins()
            return
        press.holders.discard(COMMAND)
        press.free_us = self._world.clock.now_us + RELEASE_MS * 1000
        if press.holders:  # somebody else holds it as well
            press.waiting = 1
            self._order.append(key)

    def keys(self):
        """Those that are down."""
        return [key for key in self._world.keypad.names if self._is_down(key)]

    def step(self, now_ms):
        """Do what is due."""
        self._now_ms = now_ms
        for who in list(self._heard_ms):
            if now_ms - self._heard_ms[who] >= UNHEARD_MS:
                self.release(who)
            if now_ms - self._heard_ms[who] >= ALONE_MS:
                self.leave(who)
        for key, press in self._presses.items():
            self._do_due(key, press)
        if not self.lonely and self._last_ms is not None and now_ms - self._last_ms >= ALONE_MS:
            self.lonely = True
            self.vanish()
            stop_all(self._world)

    # --- inside ---------------------------------------------------------------------------------

    def _press(self, key):
        if key not in self._presses:
            if key not in self._world.keypad.names:
                raise KeyRefused(
                    "no key %s: there are %s" % (key, " ".join(self._world.keypad.names))
                )
            self._presses[key] = Press()
        return self._presses[key]

    def _is_down(self, key):
        press = self._presses.get(key)
        return press is not None and press.is_down

    def _may_start(self, who, key):
        """KeyRefused. On a real line one `arm` is good for one press."""
        armed_ms = self._armed_ms.pop(who, None)
        stop = self._presses.get(STOP)
        if stop is not None and stop.holders:
            raise KeyRefused(STOP_HELD % key)
        if self._world.port is not None:
            if armed_ms is None or self._now_ms - armed_ms >= ARMED_MS:
                raise KeyRefused(UNARMED % key)

    def _stop_wins(self):
        for key, press in self._presses.items():
            if key == STOP:
                continue
            press.holders.clear()
            self._forget(key, press)
            press.least_us = 0
            self._do_due(key, press)

    def _forget(self, key, press):
        """Its presses that wait do not come any more."""
        press.waiting = 0
        self._order = [other for other in self._order if other != key]

    def _has_its_turn(self, key, now_us):
        return key == STOP or self._order[0] == key and now_us >= self._next_us

    def _do_due(self, key, press):
        now_us = self._world.clock.now_us
        if press.is_down:
            if press.is_over() and now_us >= press.least_us:
                self._world.up(key)
                press.is_down = False
                press.free_us = now_us + RELEASE_MS * 1000
        elif press.waiting and now_us >= press.free_us and self._has_its_turn(key, now_us):
            self._world.down(key)
            press.is_down = True
            press.waiting -= 1
            self._order.remove(key)
            if self._order:  # somebody presses faster than the panel looks
                self._next_us = now_us + (TAP_MS + RELEASE_MS) * 1000
            press.least_us = now_us + TAP_MS * 1000


def stop_all(world):
    """OFF1 to every drive; the panel goes on."""
    if not hasattr(world, "app"):  # an emulated chip: there a person would hold STOP
        world.down(STOP)
        let_go = Event(lambda: world.up(STOP))
        world.clock.schedule(let_go, world.clock.now_us + STOP_ALL_MS * 1000)
        return
    bus = getattr(world.app, "bus", None)  # a search has none, and no motor runs then
    if bus is not None:
        bus.stop_all()
