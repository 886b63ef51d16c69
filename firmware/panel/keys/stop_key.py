# SPDX-License-Identifier: MIT
"""The STOP key: what it does when it goes down, and what while it is held.

    stage         what it has sent                              ends when
    RELEASED      nothing                                       the key goes down: PRESSED
    PRESSED       OFF1 to the drive shown; a second stop that   it is held for 1.5 s: SECOND_SENT
                  goes on is not weakened
    SECOND_SENT   to that drive its second stop: OFF3, OFF2     it is held for 4 s: ALL_SENT
                  or nothing, by the settings
    ALL_SENT      OFF1 to every drive

Each stage ends in RELEASED when the key goes up. A STOP that was down when the panel started stays
RELEASED: it sends nothing, it only forbids START and JOG.
"""

from micropython import const

from panel import texts
from uss.timing import elapsed

_TELL_MS = const(300)  # held so long, what comes next is said
_SECOND_MS = const(1_500)
_ALL_MS = const(4_000)

RELEASED, PRESSED, SECOND_SENT, ALL_SENT = range(4)

# settings.second_stop: what is said before it, and after it.
SAID = {
    "OFF3": (texts.HOLD_FOR_OFF3, texts.OFF3_HOLD_FOR_ALL),
    "OFF2": (texts.HOLD_FOR_OFF2, texts.OFF2_HOLD_FOR_ALL),
    "none": (texts.HOLD_FOR_ALL, texts.HOLD_FOR_ALL),
}


class StopKey:
    """bit: of the key. controls: of all drives. second_stop: of the settings. mask: of the clock.

    say: say(now_ms, text) has a text shown for a while.

    text: what is to be said while it is held, a text or NOTHING. is_down: no START and no
    JOG meanwhile.
    left: how many looks `stop_next` has still to take, until every drive was told to stop.
    """

    def __init__(self, bit, controls, second_stop, mask, say):
        self.text = texts.NOTHING
        self.is_down = False
        self.left = 0
        self._bit = bit
        self._controls = controls
        self._said = SAID[second_stop]
        self._mask = mask
        self._say = say
        self._stage = RELEASED
        self._control = None  # the drive that was shown when it went down
        self._pressed_at_ms = 0

    def step(self, keys, control, now_ms):
        """keys: `Keys`, up to date. control: of the drive that is shown."""
        self.is_down = keys.down & self._bit != 0
        if keys.pressed & self._bit:
            self._stage = PRESSED
            self._pressed_at_ms = now_ms
            self._control = control
            control.stop()
        elif not self.is_down:
            self._stage = RELEASED
            self.text = texts.NOTHING
        elif self._stage == RELEASED:  # nobody pressed it since power-on
            self.text = texts.STOP_IS_DOWN
        else:
            self._hold(now_ms)

    def stop_next(self):
        """Send OFF1 to the next drive. All at once would take too long for a step of the loop, and
        the line takes them one by one. The first round is for those that run, the second for all.
        """
        self.left -= 1
        control = self._controls[self.left % len(self._controls)]
        if self.left < len(self._controls) or control.is_active():
            control.stop_unseen()

    def _hold(self, now_ms):
        held_ms = elapsed(now_ms, self._pressed_at_ms, self._mask)
        if self._stage == PRESSED and held_ms >= _SECOND_MS:
            self._stage = SECOND_SENT
            self._control.second_stop()
            self.text = self._said[1]
        if self._stage == SECOND_SENT and held_ms >= _ALL_MS:
            self._stage = ALL_SENT
            self.left = 2 * len(self._controls)
            self._say(now_ms, texts.ALL_STOPPED)
            self.text = texts.ALL_STOPPED
        elif self._stage == PRESSED and held_ms >= _TELL_MS:
            self.text = self._said[0]
