# SPDX-License-Identifier: MIT
"""The settings that are numbers or a choice, with their limits; SET opens one."""

import on_demand
from panel import texts
from panel.menu import Entries


class List(Entries):
    title = texts.MENU_SETTINGS

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        self._names = on_demand.call("settings_file", "changeable")

    def count(self):
        return len(self._names)

    def words(self, position):
        return texts.of(texts.SETTING_NAMES[self._names[position]])

    def choose(self, position, now_ms):
        return "value", self._names[position]
