# SPDX-License-Identifier: MIT
"""The first thing shown after power-on: what this is, and what it is not."""

from micropython import const

from panel import texts
from panel.pages import Page
from uss.timing import elapsed

_SHOWN_MS = const(800)


class Splash(Page):
    """It ends by itself. Any key ends it and does nothing else, but for STOP."""

    modules = ("panel.pages.splash",)
    whole = True
    obeys = False
    announces = False

    def __init__(self, panel):
        Page.__init__(self, panel)
        self._began_at_ms = None

    def step(self, keys, now_ms):
        if self._began_at_ms is None:
            self._began_at_ms = now_ms
        elif elapsed(now_ms, self._began_at_ms, self.panel.mask) >= _SHOWN_MS:
            self.panel.uncover()

    def take_keys(self, acts, now_ms):
        if acts.pressed:
            self.panel.uncover()
            if acts.pressed & acts.bit("START"):
                self.panel.say(now_ms, texts.REFUSED_EARLY)

    def draw(self, screen, now_ms):
        for row in range(len(texts.SPLASH)):
            screen.put(row, 0, texts.ROW_WIDTH, texts.of(texts.SPLASH[row]))
