# SPDX-License-Identifier: MIT
"""The first thing shown after power-on: what this is, and what it is not. And what follows it."""

from micropython import const

from panel import texts
from panel.keys import unknown
from panel.pages import Page
from uss.timing import elapsed
from version import VERSION

_SHOWN_MS = const(800)

# Shown after power-on, both rows: the panel's STOP goes over a wire and through two processors.
SPLASH = (b"USS %s IS NO", b"EMERGENCY STOP")  # with the version in it

SETTINGS_DAMAGED = b"SETTINGS DAMAGED"  # defaults are used for what is wrong
# What is wrong, said after it: the name of a setting, as far as it fits, or this of the file.
SETTINGS_SUSPECTS = {
    "unreadable": b"FILE UNREADABLE",
    "too big": b"FILE TOO BIG",
    "no JSON": b"FILE IS NO JSON",
}
SETTING = b"%s"
KEY_UNKNOWN = b"NO KEY %s"  # the board file names one that there is not
_NAME_WIDTH = const(9)


def notices(settings, key_names, first):
    """What is said one after the other when it has gone: texts, with their values."""
    about = [(notice,) for notice in first if notice]
    if settings.complaint is not None:
        suspect = (SETTING, _start_of(settings.suspect, texts.ROW_WIDTH))
        if settings.suspect in SETTINGS_SUSPECTS:
            suspect = (SETTINGS_SUSPECTS[settings.suspect],)
        about += [(SETTINGS_DAMAGED,), suspect]
    return about + [(KEY_UNKNOWN, _start_of(name, _NAME_WIDTH)) for name in unknown(key_names)]


def _start_of(name, width):
    return str(name)[:width].encode()


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
        screen.put(0, 0, texts.ROW_WIDTH, texts.of(SPLASH[0], VERSION.encode()))
        screen.put(1, 0, texts.ROW_WIDTH, texts.of(SPLASH[1]))
