# SPDX-License-Identifier: MIT
"""From the keys that are down now to what an operator did: pressed, repeated.

    keys = Keys(keypad.names, clock.ticks_mask)
    keys.update(keypad.read(), clock.ticks_ms())
    if keys.pressed & keys.bit("START"): ...

A key counts once it has been the same for _DEBOUNCE_MS; STOP goes down with the second reading, so
that neither a slow loop nor a chattering contact loses it. A key that is down when the panel
starts is `down`, but not `pressed` before it was seen up: a START that is jammed or leant on
starts nothing, while a STOP that is down, or whose wire is broken, is down from the beginning.
"""

from micropython import const

import on_demand

# All keys that the panel knows; a board has STOP and any others of them.
NAMES = (
    "START", "STOP", "REVERSE", "JOG_RIGHT", "JOG_LEFT", "UP", "DOWN", "ADDRESS_UP",
    "ADDRESS_DOWN", "PARAM", "NEXT", "PREVIOUS", "EDIT", "SET",
)  # fmt: skip

# Keys of a compact keypad, which have more than one of those functions: see `panel.keys.compact`.
COMPACT_NAMES = ("JOG", "P", "FN")

_DEBOUNCE_MS = const(20)
_DELAY_MS = const(400)  # until a key repeats, and from then on; settings may say otherwise
_REPEAT_MS = const(120)
_HELD_MS = const(1_000)  # so long a key is down that is held for more than its repeats

# How a value moves while its key is held: repeats, then steps for each of them.
PACES = ((16, 100), (8, 10), (0, 1))


def unknown(names):
    """Those of a board's keys that the panel does not know: each would be dead."""
    return [name for name in names if name not in NAMES and name not in COMPACT_NAMES]


def keys_of(names, mask, held=(), panel=None):
    """The `Keys` of a board that has these, or `CompactKeys`, which behave alike. panel: the
    `Panel` that has them, None in a program that moves no motor.
    """
    if [name for name in names if name in COMPACT_NAMES]:
        return on_demand.load("panel.keys.compact").CompactKeys(names, mask, held, panel)
    return Keys(names, mask, held)


class Acts:
    """What was pressed and repeated in a step, for those who take it up in the next one.

    keys: the `Keys`. `pressed`, `repeated`, `repeats`: as there, when `note` was called.
    """

    def __init__(self, keys):
        self.bit = keys.bit
        self.forget = keys.forget  # a key that is held repeats nothing any more
        self._keys = keys
        self.note()

    def note(self):
        """Keep what has just been found."""
        keys = self._keys
        self.pressed = keys.pressed
        self.repeated = keys.repeated
        self.repeats = keys.repeats

    def is_held(self, bits):
        """Whether it is one of these keys that has just been held for a second."""
        return self.repeated & bits != 0 and self.repeats == self._keys.held_repeats

    def has(self, key):
        """Whether this key went down."""
        return self.pressed & self.bit(key) != 0

    def direction(self, up, down):
        """1 when the key `up` went down or repeated, -1 when `down` did, else 0."""
        moved = self.pressed | self.repeated
        return (moved & self.bit(up) != 0) - (moved & self.bit(down) != 0)

    def pace(self, highest=10):
        """Steps for a value that a held key moves: more the longer it is held, up to `highest`."""
        if self.repeated:
            for repeats, steps in PACES:
                if self.repeats > repeats and steps <= highest:
                    return steps
        return 1


class Keys:
    """names: of the keys, in the order of their bits. mask: the millisecond clock's period - 1.

    held: names of keys that matter as long as they are down, not only when they are pressed.

    After each `update`, as bits: `down`, the keys that are down; `pressed`, those that went down
    just now; `repeated`, those that repeat just now. `repeats`: how often the key
    that repeats has done so; `held_repeats`: how often after _HELD_MS. Only the key pressed last
    repeats. `at_rest`: no key is down or has
    just been, and each has been seen up; as long as none is down, `update` has nothing to do.
    `unsettled`: keys that moved lately or have not been seen up yet, as bits: then it takes long.
    `shift`: how often FN of a compact keypad was pressed for the next key.
    """

    shift = 0

    def __init__(self, names, mask, held=()):
        self.down = 0
        self.pressed = 0
        self.repeated = 0
        self.repeats = 0
        self._bits = {key: 1 << position for position, key in enumerate(names)}
        self._mask = mask
        self._held = self.bits(held)
        self._eager = self.bit("STOP")
        self._raw = 0
        self._changed_at_ms = {bit: 0 for bit in self._bits.values()}
        self._all = (1 << len(names)) - 1
        self._released = 0  # keys that were seen up since the start
        self._last = 0  # the key pressed last, while it is down
        self._repeat_at_ms = 0
        self._wait_ms = 0  # from then to the next repeat
        self.pace(_DELAY_MS, _REPEAT_MS)
        self._first = True
        self.at_rest = False
        self.unsettled = self._all

    def bit(self, key):
        """The bit of a key by name; 0 when this board has no such key."""
        return self._bits.get(key, 0)

    def bits(self, names):
        """The bits of several keys."""
        return sum(self.bit(key) for key in names)

    def pace(self, delay_ms, repeat_ms):
        """A key repeats after `delay_ms`, 900 at the most, and from then on every `repeat_ms`."""
        self._delay_ms = delay_ms
        self._repeat_ms = repeat_ms
        self.held_repeats = 1 - (delay_ms - _HELD_MS) // repeat_ms

    def withhold(self, bits):
        """These keys count as not pressed, until they were let go."""
        self.pressed &= ~bits
        self.repeated &= ~bits
        self._last &= ~bits

    def forget(self):
        """What is down repeats nothing any more: it has to be pressed anew."""
        self._last = 0

    def update(self, raw, now_ms, unclear=0):
        """raw: what the keypad reads now, as bits. unclear: the keys among them of which it cannot
        tell; they are up, and each must be seen up before it counts again.

        Answers whether there is anything to do: a key was pressed or repeats, or one of those that
        are held is down or was until now.
        """
        were_down = self.down
        if unclear:
            raw &= ~unclear
            self.down &= ~unclear
            if self._last & unclear:
                self._last = 0
        if self._first:
            self._first = False
            self._raw = raw
            for bit in self._changed_at_ms:
                self._changed_at_ms[bit] = now_ms
        self.pressed = 0
        self.repeated = 0
        if raw != self._raw or raw != were_down or self.unsettled or unclear:
            changed = raw ^ self._raw
            self._raw = raw
            self.unsettled = unsettled = changed | raw ^ self.down | self._all & ~self._released
            if unsettled:
                self._debounce(changed, unsettled, now_ms)
            self._released &= ~unclear
        if self._last and (now_ms - self._repeat_at_ms) & self._mask >= self._wait_ms:
            self._repeat_at_ms = now_ms
            self._wait_ms = self._repeat_ms
            self.repeats += 1
            self.repeated = self._last
        seen = self.down | were_down
        self.at_rest = not (seen or self.unsettled or unclear)
        return (seen & self._held | self.pressed | self.repeated) != 0

    def _debounce(self, changed, unsettled, now_ms):
        """unsettled: the keys, as bits, that moved just now or are not yet what they read."""
        changed_at_ms, raw = self._changed_at_ms, self._raw
        at_once = raw & self._eager  # what did not move just now is believed
        while unsettled:
            bit = unsettled & -unsettled  # the lowest of them
            unsettled ^= bit
            if changed & bit:
                changed_at_ms[bit] = now_ms
            elif at_once & bit or (now_ms - changed_at_ms[bit]) & self._mask >= _DEBOUNCE_MS:
                self._settle(bit, raw & bit, now_ms)

    def _settle(self, bit, is_down, now_ms):
        if not is_down:
            self._released |= bit
            self.down &= ~bit
            if self._last == bit:
                self._last = 0
            return
        if self._released & bit and not self.down & bit:
            self.pressed |= bit
            self._last = bit
            self._repeat_at_ms = now_ms
            self._wait_ms = self._delay_ms
            self.repeats = 0
        self.down |= bit
