# SPDX-License-Identifier: MIT
"""One setting: UP and DOWN change it, SET keeps it, PARAM leaves it as it was.

What the bus is made with (its rate, its times) acts when the panel begins anew, which it does at
once if no motor runs.
"""

import on_demand
from panel import texts
from panel.menu import Entries


class List(Entries):
    """argument: the name of the setting."""

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        self.title = texts.SETTING_NAMES[argument]
        self._value = getattr(panel.settings, argument)

    def words(self, position):
        value = self._value
        return value.encode() if isinstance(value, str) else b"%d" % value

    def change(self, position, steps):
        self._value = on_demand.call("settings_file", "moved", self.argument, self._value, steps)
        return True

    def choose(self, position, now_ms):
        panel = self.panel
        if panel.any_runs():
            panel.say(now_ms, texts.STOP_FIRST)
            return
        settings = panel.settings
        settings.change(self.argument, self._value)
        panel.close_menu()
        panel.wants = "app"
