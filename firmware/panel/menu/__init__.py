# SPDX-License-Identifier: MIT
"""The menu: lists in lists, behind a PARAM that is held for a second.

    MENU         1/4        row 1: which list, and the place in it
    >DRIVES                 row 2: the entry; UP and DOWN walk, SET chooses, PARAM goes back

`engine` shows a list and walks it. Each list is a module of its own with a class `List`, and is in
memory only while it is shown. To add one, write its file and put its name into the list above it.
"""

from panel import texts

BACK = ("", None)  # of `choose`: back to the list above this one
PAGE = "page"  # of `choose`: (PAGE, place) closes the menu and shows this page of `pages.table`


class Entries:
    """What every list has. panel: the `Panel`. argument: what the list above it has handed on.

    ahead: modules that it has loaded for what it leads to; they leave the memory with it.
    title: a text; 16 characters in a list that has one entry only, else 10. Answers of `choose`:
    (name of a list, argument), (PAGE, place), BACK, or None: the list stays.
    """

    title = b""
    ahead = ()
    tells_stop = True  # STOP says which drive it has stopped

    def __init__(self, panel, argument=None):
        self.panel = panel
        self.argument = argument

    def first(self):
        """The entry that is shown first."""
        return 0

    def step(self, position, now_ms):
        """Again and again while it is shown."""

    def is_searching(self):
        """Whether `search` has something to do, which takes long."""
        return False

    def search(self):
        """Do a piece of it."""

    def is_busy(self):
        """Whether it has something to do that a minute without a key does not end."""
        return False

    def count(self):
        """How many entries there are now, one at the least."""
        return 1

    def heading(self, position):
        """Row 1 in words, in front of the place in the list."""
        return texts.of(self.title)

    def words(self, position):
        """The entry in words, at most 15 of them."""
        return b""

    def control_at(self, position):
        """The `Control` of the drive that the entry names, or None. STOP is for it, too."""

    def control_of(self, address):
        """The `Control` of the drive with this address, or None."""
        for control in self.panel.controls:
            if control.drive.address == address:
                return control
        return None

    def choose(self, position, now_ms):
        """SET was pressed on it."""

    def change(self, position, steps):
        """UP or DOWN moves a value instead of walking: True if it does."""
        return False

    def take_keys(self, acts):
        """Before the menu does: True if the keys are not for the menu, BACK if it is to leave."""
        return False

    def leave(self, now_ms):
        """PARAM goes back to the list above this one."""

    def end(self):
        """It is not shown any more, however that came."""
