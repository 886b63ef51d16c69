# SPDX-License-Identifier: MIT
"""The home page: setpoint and actual frequency of the selected drive, its state, its address.

    S: 10.0 F:  9.98        row 1: setpoint and actual frequency in Hz, negative turns left
    RUNNING      A1         row 2: state in words, in turn with a warning; address

Row 1 and the address are drawn by `panel.view`, because parameter mode shows them too.
"""

import on_demand
from panel import texts, wording
from panel.reports.fault import draw_number
from panel.pages import Page, warning


class Home(Page):
    """UP and DOWN move the setpoint, faster while they are held. EDIT: digit by digit.
    NEXT and PREVIOUS show other values than the actual frequency, see `panel.pages.values`.
    """

    tells_state = True

    def take_keys(self, acts, now_ms):
        panel = self.panel
        direction = acts.direction("UP", "DOWN")
        if direction:
            panel.selected.change(direction * panel.setpoint_step * acts.pace())
        step = acts.direction("NEXT", "PREVIOUS")
        try:
            if acts.has("EDIT"):
                panel.cover(on_demand.load("panel.pages.digits").Digits(panel))
            elif step:
                values = self.values or on_demand.load("panel.pages.values").Values(panel)
                self._keep(values, values.turn(step))
        except MemoryError:
            panel.say(now_ms, texts.NO_MEMORY)

    def open(self):
        if self.values:
            self.values.forget()

    def step(self, keys, now_ms):
        if self.values and not self.values.step(now_ms):
            self._keep(None, False)

    def _keep(self, values, shown):
        """Another value than the actual frequency is shown, or is not any more."""
        self.values = values if shown else None
        if not shown:
            on_demand.drop("panel.pages.values")

    def draw(self, screen, now_ms):
        control = self.panel.selected
        text = wording.text(control)
        if text != texts.FAULT and warning.draw(screen, self.panel):
            return
        words = wording.of(text, control.survey.family)
        screen.put(1, 0, texts.STATE_WIDTH + 1, words)
        if text == texts.FAULT:
            draw_number(screen, 1, len(words) + 1, texts.FAULT_LETTER, control.fault)
