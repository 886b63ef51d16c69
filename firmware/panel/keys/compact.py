# SPDX-License-Identifier: MIT
"""A keypad of eight: which of its keys, alone or behind FN, has which function of the fourteen.

    FN      the next key has its second function, FN twice: its third. It ends by itself after 3 s
    JOG     turns to the side that REVERSE has chosen, as the sign of the setpoint shows

Nothing needs two hands, and nothing behind FN moves a motor: whoever is too late for FN changes a
setpoint by a step or the page at the most. STOP is STOP at any time, and ends what FN has begun.
In use: as `Keys`, see `panel.keys.keys_of`.
"""

from micropython import const

from panel import texts
from panel.keys import NAMES, Keys
from uss.timing import elapsed

# Key: its function alone, behind FN, behind FN twice; None: it has none. A key that is not here
# has its own function always.
FUNCTIONS = {
    "START": ("START", None, None),
    "REVERSE": ("REVERSE", None, None),
    "JOG": ("JOG_RIGHT", None, None),  # JOG_LEFT by REVERSE
    "UP": ("UP", "NEXT", "ADDRESS_UP"),
    "DOWN": ("DOWN", "PREVIOUS", "ADDRESS_DOWN"),
    "P": ("PARAM", "SET", "EDIT"),
    "FN": (None, None, None),
}

_SHIFT_MS = const(3_000)
_SHIFTS = const(3)
_MOVED_BY_JOG = ("JOG_RIGHT", "JOG_LEFT")


class CompactKeys:
    """Fields and methods are those of `Keys`, and the bits are those of functions. names: of the
    keys as the board has them. panel: knows the direction, and says why a key does nothing.
    """

    def __init__(self, names, mask, held=(), panel=None):
        self.down = self.pressed = self.repeated = self.repeats = self.shift = 0
        self._mask = mask
        self._panel = panel
        self._keys = keys = Keys(names, mask)  # as they are wired
        self.at_rest = False
        self.unsettled = keys.unsettled
        self.held_repeats = keys.held_repeats
        self.forget = keys.forget
        self._fn = keys.bit("FN")
        self._jog = keys.bit("JOG")
        self._functions = [FUNCTIONS.get(name, (name,) * _SHIFTS) for name in names]
        there = [name for row in self._functions for name in row]
        there += _MOVED_BY_JOG if self._jog else ()
        self._bits = {name: 1 << NAMES.index(name) for name in NAMES if name in there}
        # What each key does from its last press on, as the bit of a function.
        self._does = [self.bit(row[0]) for row in self._functions]
        self._held = self.bits(held)
        self._shifted_at_ms = 0

    def bit(self, key):
        """The bit of a function; 0 when this board has no key for it."""
        return self._bits.get(key, 0)

    def bits(self, names):
        return sum([self.bit(key) for key in names])

    def pace(self, delay_ms, repeat_ms):
        self._keys.pace(delay_ms, repeat_ms)
        self.held_repeats = self._keys.held_repeats

    def withhold(self, bits):
        """As that of `Keys`; a FN counts as not pressed either."""
        self.shift = 0
        self.pressed &= ~bits
        self.repeated &= ~bits
        if not self.pressed:
            self.forget()

    def update(self, raw, now_ms, unclear=0):
        keys = self._keys
        were_down = self.down
        keys.update(raw, now_ms, unclear)
        self.pressed = 0
        if keys.pressed:
            self._press(keys.pressed, now_ms)
        self.down = self._done_by(keys.down)
        self.repeated = self._done_by(keys.repeated)
        self.repeats = keys.repeats
        if self.shift and elapsed(now_ms, self._shifted_at_ms, self._mask) >= _SHIFT_MS:
            self.shift = 0
        self.unsettled = keys.unsettled
        self.at_rest = keys.at_rest and not self.shift
        done = (self.down | were_down) & self._held | self.pressed | self.repeated
        return (done | keys.pressed & self._fn) != 0

    def _press(self, pressed, now_ms):
        """These keys went down: each has the same function until it goes down again."""
        others = pressed & ~self._fn
        for position in range(len(self._does)):
            bit = 1 << position
            if others & bit:
                function = self.bit(self._functions[position][self.shift])
                if function and bit == self._jog and self._turns_left():
                    function = self.bit("JOG_LEFT")
                if not function and self._panel:
                    self._panel.say(now_ms, texts.REFUSED_FN)
                self._does[position] = function
                self.pressed |= function
        if others:
            self.shift = 0
        if pressed & self._fn:
            self.shift = (self.shift + 1) % _SHIFTS
            self._shifted_at_ms = now_ms

    def _turns_left(self):
        return self._panel is not None and self._panel.selected.reversed

    def _done_by(self, keys):
        """The functions of these keys."""
        functions = position = 0
        while keys:
            if keys & 1:
                functions |= self._does[position]
            keys >>= 1
            position += 1
        return functions
