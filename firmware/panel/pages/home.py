"""The home page: setpoint and actual frequency of the selected drive, its state, its address.

    S: 10.0 F:  9.98        row 1: setpoint and actual frequency in Hz, negative turns left
    RUNNING      A1         row 2: state in words, address

Row 1 has 5 places for the setpoint and 6 for the actual frequency. A value that needs more room
gives up decimals (-650.00 is shown as -650.0); without contact the actual frequency is dashes,
never the last one known. What must be said before the state can be shown takes row 2 whole.
"""

from micropython import const

from panel import texts

ADDRESS_COLUMN = const(13)
ANNOUNCE_MS = const(1_500)  # another drive is announced so long, then the state shows as long


class Home:
    """panel: the `Panel` whose selected drive is shown."""

    def __init__(self, panel):
        self._panel = panel

    def take_keys(self, keys):
        """UP and DOWN move the setpoint, faster while they are held."""
        panel = self._panel
        moved = keys.pressed | keys.repeated
        direction = bool(moved & keys.bit("UP")) - bool(moved & keys.bit("DOWN"))
        if direction:
            panel.selected.change(direction * panel.step_of(keys))

    def draw(self, screen, now_ms):
        control = self._panel.selected
        if control.lost_running:
            screen.put(0, 0, texts.ROW_WIDTH, texts.NO_CONTACT_ROW)
        else:
            self._draw_frequencies(screen, control)
        self._draw_row_2(screen, control, now_ms)

    def _draw_frequencies(self, screen, control):
        screen.put(0, 0, 2, b"S:")
        screen.number(0, 2, 5, control.setpoint_centihertz, 1)
        screen.put(0, 7, 3, b" F:")
        actual = control.actual_centihertz()
        if actual is None:
            screen.put(0, 10, 6, texts.UNKNOWN_VALUE)
        elif control.actual_is_beyond():
            screen.put(0, 10, 6, texts.BEYOND_VALUE)
        else:
            screen.number(0, 10, 6, actual, 2)

    def _draw_row_2(self, screen, control, now_ms):
        panel = self._panel
        if control.stop_watch.unconfirmed:
            screen.put(1, 0, texts.ROW_WIDTH, texts.STOP_UNCONFIRMED)
        elif control.lost_running:
            self._draw_state(screen, texts.MAY_RUN)
        elif panel.message:
            screen.put(1, 0, texts.ROW_WIDTH, panel.message)
        elif panel.line_in_use():
            screen.put(1, 0, texts.ROW_WIDTH, texts.LINE_IN_USE)
        elif panel.announced and not now_ms // ANNOUNCE_MS & 1:
            self._draw_announcement(screen)
        else:
            self._draw_state(screen, control.state_text())

    def _draw_state(self, screen, text):
        screen.put(1, 0, ADDRESS_COLUMN, text)
        self._draw_address(screen, ADDRESS_COLUMN, self._panel.selected.drive.address)

    def _draw_announcement(self, screen):
        at = self._draw_address(screen, 0, self._panel.announced.drive.address)
        screen.put(1, at, texts.ROW_WIDTH - at, self._panel.announcement)

    def _draw_address(self, screen, column, address):
        """A and the address, left-aligned in three places; answers the column after it."""
        screen.put(1, column, 3, b"A")
        width = 2 if address > 9 else 1
        screen.number(1, column + 1, width, address * 100, 0)
        return column + 1 + width
