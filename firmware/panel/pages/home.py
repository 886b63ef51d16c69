"""The home page: setpoint and actual frequency of the selected drive, its state, its address.

    S: 10.0 F:  9.98        row 1: setpoint and actual frequency in Hz, negative turns left
    RUNNING      A1         row 2: state in words, address

Row 1 is drawn by `panel.view`, because parameter mode shows it too.
"""

from panel import state, texts
from panel.view import draw_address

FAULT_DIGITS_COLUMN = len(texts.FAULT) + 1 + len(texts.FAULT_LETTER)


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
            control.fault.seen = True
        if text is texts.FAULT and control.fault.number:
            at = FAULT_DIGITS_COLUMN
            screen.put(1, at - 1, 1, texts.FAULT_LETTER)
            screen.digits(1, at, 4, control.fault.number)
        draw_address(screen, control)
