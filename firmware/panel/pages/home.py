"""The home page: setpoint and actual frequency of the selected drive, its state, its address.

    S: 10.0 F:  9.98        row 1: setpoint and actual frequency in Hz, negative turns left
    RUNNING      A1         row 2: state in words, address

Row 1 and the address are drawn by `panel.view`, because parameter mode shows them too.
"""

from panel import state, texts
from panel.view import draw_fault


class Home:
    """panel: the `Panel` whose selected drive is shown."""

    whole = False
    tells_state = True
    obeys = True

    def __init__(self, panel):
        self._panel = panel

    def take_keys(self, keys, now_ms):
        """UP and DOWN move the setpoint, faster while they are held."""
        panel = self._panel
        direction = keys.moved("UP") - keys.moved("DOWN")
        if direction:
            panel.selected.change(direction * panel.setpoint_step * keys.pace())

    def draw(self, screen, now_ms):
        control = self._panel.selected
        text = state.text(control)
        screen.put(1, 0, texts.STATE_WIDTH + 1, text)
        if text is texts.FAULT:
            draw_fault(screen, 1, len(text) + 1, control.fault)
