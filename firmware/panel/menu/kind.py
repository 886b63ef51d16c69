# SPDX-License-Identifier: MIT
"""What a drive is, chosen by hand: its family, PKW and PZD words, or its link, each only as the
family can have it. The panel begins anew with it, so no motor may run.
"""

from panel import texts
from panel.menu import BACK, Entries, words
from panel.menu.drive import kind_of
from uss import families
from uss.families.bop import on_bop
from uss.families.kinds import PZD_MIN, text
from uss.layout import Layout


class List(Entries):
    """argument: (the `Control`, the row of words.KIND)."""

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        self._control, self._row = argument
        self.title = words.KIND_TITLES[self._row]
        self._family = family = self._control.survey.family
        self._layout = self._control.drive.layout
        self._choices = (
            families.NAMES,
            family.pkw_choices,
            [count for count in family.pzd_choices if count >= PZD_MIN],
            words.LINKS if family.has_bop_link else words.LINKS[:1],
        )[self._row]

    def first(self):
        now = kind_of(self._control)[self._row]
        return list(self._choices).index(now) if now in self._choices else 0

    def count(self):
        return len(self._choices)

    def words(self, position):
        return words.of_kind(self._row, self._choices[position])

    def control_at(self, position):
        return self._control

    def choose(self, position, now_ms):
        panel = self.panel
        if self._choices[position] == kind_of(self._control)[self._row]:
            return BACK
        if panel.any_runs():
            panel.say(now_ms, texts.STOP_FIRST)
            return None
        kind = text(*self._chosen(self._choices[position]))
        panel.settings.set_kind(self._control.drive.address, kind)
        panel.begin_anew()
        return None

    def _chosen(self, choice):
        """Family and layout; of another family those that it can have, too, stay."""
        family, layout, row = self._family, self._layout, self._row
        is_bop = family.com is not None
        if row == words.PKW:
            return family, Layout(
                choice, layout.pzd_words
            )  # not short: that was tried for another
        if row == words.PZD:
            return family, Layout(layout.pkw_words, choice, short=layout.short)
        base = family.com or family
        if row == words.FAMILY:
            base = getattr(families, choice)
            if not (self._control.drive.contact and layout.suits(base)):
                layout = base.layout
        else:
            is_bop = choice != words.LINKS[0]
        return on_bop(base) if is_bop and base.has_bop_link else base, layout
