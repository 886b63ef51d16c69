# SPDX-License-Identifier: MIT
"""A hand at the panel's keys, for a keyboard that does not tell when a key is let go, and a mouse.

    hand = Hand(send, is_real)
    hand.tap("UP", now_ms)          # down and up: the panel keeps it down for 100 ms of its time
    hand.hold("JOG_RIGHT", now_ms)  # a capital: down until another key, or until it gets tired
    hand.press("UP", now_ms)        # the mouse button on a key, until `lift`
    hand.see(down, now_ms)          # whenever the panel tells which keys are down
    hand.step(now_ms)               # every few milliseconds

What is typed is done one after the other, as fast as the panel sees it; STOP goes ahead of all.
A held JOG lets go when the keyboard does not repeat it. On a real line every key but STOP does the
same: a terminal that went silent must not move a setpoint on and on. A key under the mouse button
does not; but a terminal that does not answer gives no sign of life, and then the panel lets go of
every key by itself.
"""

from tools.live.keys import JOGS, STOP

# Without a repeat the hand lets go after so long: if the keyboard repeats already, and if it still
# waits before its first repeat (X11: 660 ms).
REPEAT_MS = 300
FIRST_REPEAT_MS = 700
LOST_MS = 1_000  # a key that was pressed is seen to be down, and a tap is over, long before
WAITING_MAX = 6  # strokes typed ahead; more would come after the person wants them


class Hand:
    """send(kind, **fields): to the panel. held: the key that a capital holds, or None. pressed:
    the one under the mouse button.
    """

    def __init__(self, send, is_real):
        self.held = None
        self.pressed = None
        self._send = send
        self._is_real = is_real
        self._waiting = []  # (key, whether to hold it)
        self._tapped = None  # the key whose tap is not over
        self._was_seen = False  # ... and that the panel told of
        self._began_ms = 0  # when a key went down last
        self._renewed_ms = 0  # when the capital was typed last, or seen to be down
        self._patience_ms = FIRST_REPEAT_MS

    def tap(self, key, now_ms):
        """Press a key and let it go. False: too many wait, this one is lost."""
        return self._take(key, False, now_ms)

    def hold(self, key, now_ms):
        """Press a key and keep it down until the next one. As `tap`."""
        renewed = self.holds(key)
        self._patience_ms = REPEAT_MS if renewed else FIRST_REPEAT_MS
        self._renewed_ms = now_ms
        return renewed or self._take(key, True, now_ms)

    def holds(self, key):
        """Whether this key is held, or waits to be: another capital only renews that."""
        return key == self.held or (key, True) in self._waiting

    def press(self, key, now_ms):
        """The mouse button goes down on a key."""
        self.lift()
        self._let_go_of_held()
        self._waiting.clear()
        self.pressed = key
        self._began_ms = now_ms
        self._send("down", key=key)

    def lift(self):
        """The mouse button comes up."""
        key, self.pressed = self.pressed, None
        if key is not None:
            self._send("up", key=key)

    def let_go(self):
        """Let go of everything, and forget what waits."""
        self.held = self.pressed = self._tapped = None
        self._waiting.clear()
        self._send("release")

    def refused(self):
        """The panel did not let the last key go down."""
        self.held = self.pressed = self._tapped = None

    def see(self, down, now_ms):
        """The panel tells which keys are down: it may have let go of ours by itself."""
        is_late = now_ms - self._began_ms >= LOST_MS
        if self._tapped in down:
            self._was_seen = True
        elif self._was_seen or is_late:
            self._tapped = None
        if is_late and self.held not in down:
            self.held = None
        if is_late and self.pressed not in down:
            self.pressed = None
        self._go_on(now_ms)

    def step(self, now_ms):
        """Let go of a capital that the keyboard does not repeat."""
        fleeting = self.held in JOGS or self.held != STOP and self._is_real
        if self.held and fleeting and now_ms - self._renewed_ms >= self._patience_ms:
            self._let_go_of_held()

    def _take(self, key, hold, now_ms):
        if key == STOP:
            self._waiting.clear()
            self._begin(key, hold, now_ms)
            return True
        if len(self._waiting) >= WAITING_MAX:
            return False
        self._waiting.append((key, hold))
        self._go_on(now_ms)
        return True

    def _go_on(self, now_ms):
        if self._waiting and self._tapped is None:
            key, hold = self._waiting.pop(0)
            self._begin(key, hold, now_ms)

    def _begin(self, key, hold, now_ms):
        self._let_go_of_held()
        if key == self.pressed:
            self.lift()
        self._began_ms = now_ms
        self._send("down", key=key)
        if hold:
            self.held = key
        else:
            self._send("up", key=key)
            self._tapped = key
            self._was_seen = False

    def _let_go_of_held(self):
        key, self.held = self.held, None
        if key is not None:
            self._send("up", key=key)
