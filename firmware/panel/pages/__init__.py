# SPDX-License-Identifier: MIT
"""The pages of the panel, one file each, and what all of them keep to: `Page`.

A page draws itself and takes keys of its own. PARAM goes from each page of the table, in `table`,
to the next. What hides the page for a while is a page as well: the splash, a question.

To add a page, write its file, put its class into the table, and its words into `panel.texts`.
"""


class Page:
    """panel: the `Panel`; `panel.selected` is the `Control` of the drive that is shown.

    whole: it takes both rows; otherwise row 1 shows the frequencies, and row 2 ends in the address
    tells_state: its row 2 says what the drive shown does (pages that are not whole)
    obeys: START, REVERSE, JOG, address keys and PARAM act while it is shown; STOP always acts
    locks: it obeys the lock, see `panel.keys.guard`
    announces: what has to be said of other drives is said while it is shown
    draw_row_2: likewise row 2 of a page that is whole, in a step of its own, where both rows take
    too long; None: `draw` has drawn both
    values: draw in row 1 what stands there in place of the actual frequency; None: nothing does
    modules: nobody needs them in memory when it is gone
    is_busy: it has more to do than `step` can, so that `work` is called as well
    """

    modules = ()
    is_busy = False
    whole = False
    tells_state = False
    obeys = True
    locks = True
    announces = True
    draw_row_2 = None
    values = None

    def __init__(self, panel):
        self.panel = panel

    def open(self):
        """It is shown from now on."""

    def close(self):
        """It has covered another page, and need not be shown any more."""
        self.panel.uncover()

    def is_ready(self):
        """Whether it has anything to show. Until then the page that it covers is shown."""
        return True

    def is_coming(self):
        """Whether the next `step` loads a part of it, which takes the turn of all others."""
        return False

    def step(self, keys, now_ms):
        """Again and again while it is shown, or hidden by another. keys: `panel.keys.Keys`."""

    def work(self, now_ms):
        """Go on with what is looked for."""

    def take_keys(self, acts, now_ms):
        """A key was pressed, or repeats. acts: `panel.keys.Acts`."""

    def draw(self, screen, now_ms):
        """Draw both rows, row 1 where there is `draw_row_2`, or row 2 in front of the address.
        Change nothing else."""
