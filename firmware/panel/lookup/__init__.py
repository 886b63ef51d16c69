# SPDX-License-Identifier: MIT
"""What the catalogue knows, at the panel: every parameter of a drive, its faults and warnings.

    parameter   the page of one parameter, which walks a group, the favourites or all
    value       how a value reads, and how it is typed
    groups      the menu's list of groups
    what        the menu's text of a fault or a warning: what it means, what to do
    memory      the menu's list of the drive's last faults

All of it is in memory only while it is shown. A row costs a search in the flash: `Search` does a
piece of it in each step.
"""

import catalogue
from panel import texts

_COLUMNS = {"de": catalogue.DE}  # of a language that is spoken; English has its words in all rows


def name_of(family):
    """The family's table in the catalogue; None: there is none."""
    name = (family.com or family).__name__.lower()
    name = {"cu240s": "mm440"}.get(name, name)
    return name if name in catalogue.FAMILIES else None


def text(row, column=catalogue.NAME):
    """A text of a row, in the language that is spoken."""
    own = _COLUMNS.get(texts.language(), catalogue.EN)
    return row[column + own] or row[column + catalogue.EN]


def broken(left, width):
    """The lines of a text of the catalogue, one by one, between words as far as they fit."""
    left = left.replace(catalogue.LINE, b" ")
    while left:
        end = len(left)
        if end > width:
            end = left.rfind(b" ", 0, width + 1)
            end = end if end > 0 else width
        yield left[:end]
        left = left[end:].lstrip()


class Search:
    """Rows that are looked for, a piece in each step."""

    def __init__(self):
        self.rows = None  # the generator; None: nothing is looked for

    def begin(self, rows):
        """Look for these rows, and for none of those before."""
        if self.rows is not None:
            self.rows.close()
        self.rows = rows

    def step(self):
        """The next row; None: not yet, or there is no further one, and `rows` is None."""
        try:
            return next(self.rows)
        except StopIteration:
            self.rows = None
            return None
