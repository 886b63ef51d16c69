# SPDX-License-Identifier: MIT
"""The code of the lock, digit by digit: UP and DOWN change a digit, SET goes to the next one.

The last SET opens the lock, or makes this the new code: 0000 for no lock.
"""

from panel import texts
from panel.menu import BACK, Entries, words

_DIGITS = 4


class List(Entries):
    """argument: True: a new code is given; False: the lock is to be opened."""

    title = words.SET_NEXT

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        self._digits = [0]

    def words(self, position):
        *before, last = self._digits
        before = b"".join([b"%d" % digit for digit in before])
        text = words.NEW_CODE
        if not self.argument:  # somebody may look on
            text, before = words.CODE, b"*" * len(before)
        return texts.of(text, b"%s%d" % (before, last) + b"_" * (_DIGITS - len(self._digits)))

    def change(self, position, steps):
        self._digits[-1] = (self._digits[-1] + (1 if steps > 0 else -1)) % 10
        return True

    def choose(self, position, now_ms):
        digits = self._digits
        if len(digits) < _DIGITS:
            digits.append(0)
            return None
        code = 0
        for digit in digits:
            code = 10 * code + digit
        return self._keep(code, now_ms) if self.argument else self._try(code, now_ms)

    def _keep(self, code, now_ms):
        panel = self.panel
        panel.settings.change("lock_code", code)
        panel.heed_settings()
        panel.say(now_ms, words.KEPT if code else words.NO_LOCK)
        return BACK

    def _try(self, code, now_ms):
        panel = self.panel
        if code != panel.settings.lock_code:
            self._digits = [0]
            panel.say(now_ms, words.WRONG_CODE)
            return None
        panel.guard.unlock()
        panel.say(now_ms, words.UNLOCKED)
        return BACK
