# SPDX-License-Identifier: MIT
"""The home page: setpoint and actual frequency of the selected drive, its state, its address.

    S: 10.0 F:  9.98        row 1: setpoint and actual frequency in Hz, negative turns left
    RUNNING      A1         row 2: state in words, in turn with a warning; address

Row 1 and the address are drawn by `panel.view`, because parameter mode shows them too.
"""

from panel import state, texts
from panel.fault import draw_number
from panel.pages import warning


class Home:
    """panel: the `Panel` whose selected drive is shown. keys: its `Keys`."""

    whole = False
    tells_state = True
    obeys = True

    def __init__(self, panel, keys):
        self._panel = panel
        self._up = keys.bit("UP")
        self._down = keys.bit("DOWN")

    def take_keys(self, acts, now_ms):
        """UP and DOWN move the setpoint, faster while they are held."""
        direction = acts.moved(self._up) - acts.moved(self._down)
        if direction:
            panel = self._panel
            panel.selected.change(direction * panel.setpoint_step * acts.pace())

    def draw(self, screen, now_ms):
        control = self._panel.selected
        text = state.text(control)
        if text is not texts.FAULT and warning.draw(screen, self._panel):
            return
        screen.put(1, 0, texts.STATE_WIDTH + 1, text)
        if text is texts.FAULT:
            draw_number(screen, 1, len(text) + 1, texts.FAULT_LETTER, control.fault)
