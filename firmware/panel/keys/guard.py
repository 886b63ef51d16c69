# SPDX-License-Identifier: MIT
"""A panel that nobody uses: its light goes off, and its lock closes.

Neither holds up a STOP. While the lock is closed, a drive can be chosen, started and stopped, and
its setpoint moved; a key for anything else says so. What is pressed in the dark only makes light:
nobody has seen what would start.

In memory only where a setting asks for it.
"""

from micropython import const

from uss.timing import elapsed

_LOCK_MS = const(300_000)  # without a key for so long the lock closes
_MINUTE_MS = const(60_000)

# What the lock refuses on every page; where START and the like do not act, SET as well.
LOCKED_KEYS = ("REVERSE", "JOG_RIGHT", "JOG_LEFT", "PARAM")


class Guard:
    """settings: a `Settings`. keys: `Keys`. mask: of the clock. backlight: of the board, or None.
    locked: at first.

    locked, dark: as it is now. Nobody else writes a field of it.
    """

    def __init__(self, settings, keys, mask, backlight, locked):
        self._settings = settings
        self._keys = keys
        self._mask = mask
        self._backlight = backlight
        self.locked = locked and settings.lock_code != 0
        self.dark = False
        self._used_at_ms = None  # a key was pressed
        self._lit_at_ms = None  # a key was pressed, or there was an alarm
        self._stop_bit = keys.bit("STOP")
        self._locked_bits = keys.bits(LOCKED_KEYS)
        self._set_bit = keys.bit("SET")

    def lock(self):
        self.locked = self._settings.lock_code != 0

    def unlock(self):
        self.locked = False

    def note_keys(self, now_ms):
        """Keys have moved. In the dark none counts but STOP."""
        self._used_at_ms = self._lit_at_ms = now_ms
        if self.dark:
            self._shine(True)
            self._keys.withhold(~self._stop_bit)

    def holds_back(self, acts, page):
        """Take from `acts` what the lock refuses on this page; whether a key was among it."""
        refused = self._locked_bits if page.obeys else self._locked_bits | self._set_bit
        pressed = acts.pressed & refused
        acts.pressed &= ~refused
        acts.repeated &= ~refused
        return pressed != 0

    def step(self, now_ms, alarm):
        """Again and again. Answers whether the lock closes just now."""
        if self._used_at_ms is None:
            self._used_at_ms = self._lit_at_ms = now_ms
        if alarm:
            self._lit_at_ms = now_ms
        minutes = self._settings.light_minutes
        if self.dark:
            if alarm:
                self._shine(True)
        elif minutes and self._backlight:
            if elapsed(now_ms, self._lit_at_ms, self._mask) >= minutes * _MINUTE_MS:
                self._shine(False)
        if self.locked or not self._settings.lock_code:
            return False
        self.locked = elapsed(now_ms, self._used_at_ms, self._mask) >= _LOCK_MS
        return self.locked

    def _shine(self, on):
        self.dark = not on
        self._backlight(on)
