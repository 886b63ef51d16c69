# SPDX-License-Identifier: MIT
"""Which keys are down: a test of the keypad. A PARAM that is held leaves it; STOP acts."""

from panel import texts
from panel.keys import NAMES
from panel.menu import BACK, Entries, words


class List(Entries):
    title = words.KEY_TEST
    tells_stop = False  # the name of the key is what is wanted here

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        self._words = texts.of(words.PRESS_A_KEY)

    def heading(self, position):
        return texts.of(words.KEY_TEST_ENDS)

    def words(self, position):
        return self._words

    def take_keys(self, acts):
        for name in NAMES:
            if acts.has(name):
                self._words = name.encode()
        if acts.is_held(acts.bit("PARAM")):
            return BACK
        return True
