# SPDX-License-Identifier: MIT
"""The first thing shown after power-on: what this is, and what it is not."""

from panel import texts


class Splash:
    """Any key ends it and does nothing else, but for STOP."""

    whole = True
    tells_state = False
    obeys = False

    def take_keys(self, acts, now_ms):
        pass

    def draw(self, screen, now_ms):
        screen.put(0, 0, texts.ROW_WIDTH, texts.SPLASH[0])
        screen.put(1, 0, texts.ROW_WIDTH, texts.SPLASH[1])
