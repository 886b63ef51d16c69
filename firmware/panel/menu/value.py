# SPDX-License-Identifier: MIT
"""One setting: UP and DOWN change it, SET keeps it, PARAM leaves it as it was.

Some act at once. With the others, such as the rate of the bus, the panel begins anew, which it
does at once if no motor runs.
"""

import on_demand
from panel import texts
from panel.menu import BACK, Entries, words


class List(Entries):
    """argument: its row of words.SETTINGS."""

    title = words.SET_KEEPS

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        self._value = getattr(panel.settings, argument[0])

    def words(self, position):
        return words.reading(self.argument, self._value)

    def change(self, position, steps):
        name, settings = self.argument[0], self.panel.settings
        schema = on_demand.load("settings_file")  # it stays as long as this is shown
        self._value = schema.moved(settings, name, self._value, steps)
        return True

    def choose(self, position, now_ms):
        name, _, _, at_once = self.argument
        panel, settings = self.panel, self.panel.settings
        if getattr(settings, name) == self._value:
            return BACK
        if not at_once and panel.any_runs():
            panel.say(now_ms, texts.STOP_FIRST)
            return None
        settings.change(name, self._value)
        if at_once:
            panel.heed_settings()
            panel.say(now_ms, words.KEPT)
        else:
            panel.begin_anew()
        return BACK
