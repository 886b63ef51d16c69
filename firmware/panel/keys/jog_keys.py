# SPDX-License-Identifier: MIT
"""The two jog keys: a drive turns while exactly one of them is held, and only by a fresh press.

Two at once mean none. So does another drive that is shown, a STOP that is down, a page that has
no place for jogging. Whatever ended a jog, the key must go up and down again.
"""

from panel.phases import JOGGING
from uss import pzd


class JogKeys:
    """One for the panel, because a hand jogs one drive at a time. right, left: bits of keys."""

    def __init__(self, right, left):
        self._right = right
        self._left = left
        self._control = None  # the drive that is jogged
        self._key = 0  # and the bit of the key that does it

    def step(self, keys, control, allowed):
        """keys: `Keys`, up to date. control: of the drive that is shown."""
        right, left = self._right, self._left
        down = keys.down & (right | left)
        if not down and self._control is None:
            return
        if self._control is not None:
            if down != self._key or control is not self._control or not allowed:
                self._control.end_jog()
            if self._control.phase != JOGGING:
                self._control = None
        if self._control is None and allowed and keys.pressed & down and down in (right, left):
            control.jog(pzd.JOG_RIGHT if down == right else pzd.JOG_LEFT)
            if control.phase == JOGGING:
                self._control = control
                self._key = down
