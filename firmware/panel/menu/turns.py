# SPDX-License-Identifier: MIT
"""How often each drive stands in the circulating list: so much more often it is asked.

SET takes one up, UP and DOWN change it, SET keeps it, unless the round would become so long that
another drive trips. The panel begins anew with it, so no motor may run.
"""

import on_demand
from micropython import const

from panel import texts, wording
from panel.menu import Entries, words

_ROUNDS = const(3)  # within P2014, in which every drive answers late


class List(Entries):
    title = words.MENU_TURNS

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        self._times = None  # of the drive that is taken up

    def heading(self, position):
        return texts.of(self.title if self._times is None else words.CARRYING)

    def count(self):
        return len(self.panel.controls)

    def words(self, position):
        times = self._times or self._stored(position)
        return texts.of(words.TIMES, self.panel.controls[position].drive.address, times)

    def control_at(self, position):
        return self.panel.controls[position]

    def change(self, position, steps):
        if self._times is None:
            return False
        most = on_demand.load("settings_file").REPEATS_MAX
        self._times = max(1, min(most, self._times + (1 if steps > 0 else -1)))
        return True

    def choose(self, position, now_ms):
        panel = self.panel
        times, self._times = self._times, None
        if times is None:
            self._times = self._stored(position)
            return
        address = panel.controls[position].drive.address
        repeats = dict(panel.settings.repeats)
        repeats.pop(str(address), None)
        if times > 1:
            repeats[str(address)] = times
        if repeats == panel.settings.repeats:
            return
        refusal = texts.of(texts.STOP_FIRST) if panel.any_runs() else self._refusal(repeats)
        if refusal:
            panel.say(now_ms, refusal)
            return
        panel.settings.change("repeats", repeats)
        panel.begin_anew()

    def _stored(self, position):
        address = self.panel.controls[position].drive.address
        return self.panel.settings.repeats.get(str(address), 1)

    def _refusal(self, repeats):
        """Words: why the list cannot be like that; None if it can."""
        controls, turns = self.panel.controls, self.panel.bus.turns
        entries = []
        for control in controls:
            entries += [control.drive] * repeats.get(str(control.drive.address), 1)
        if len(entries) <= len(turns.list):  # a shorter round is never worse
            return None
        round_ms = turns.longest_cycle_us(entries) // 1000 + 1
        for control in controls:
            drive, survey = control.drive, control.survey
            if drive.contact and not survey.complete:
                return texts.of(texts.REFUSED_CHECKING)
            if 0 < survey.off_time_ms() < _ROUNDS * round_ms:
                return wording.of(words.SHORT, survey.family) % drive.address
        return None
