# SPDX-License-Identifier: MIT
"""What this panel is: version, licence, where its texts are explained."""

from panel import texts
from panel.menu import Entries
from version import VERSION


class List(Entries):
    title = texts.MENU_ABOUT

    def count(self):
        return 2

    def words(self, position):
        return (texts.of(texts.ABOUT_VERSION, VERSION.encode()), texts.of(texts.LICENCE))[position]
