# SPDX-License-Identifier: MIT
"""The parts of the window: what was told (views.py), keys for the mouse, a line to type on."""

from rich.text import Text
from textual.message import Message
from textual.widget import Widget
from textual.widgets import Input, Static

from tools.live.keys import STARTERS, STOP
from tools.terminal import views
from tools.terminal.letters import COMMAND, SETPOINT

LINE_MAX = 70
HISTORY_MAX = 100
LEFT_BUTTON = 1
WHEEL_ROWS = 3
ENTERS = ("enter", "ctrl+j")
FIGURES = "-0123456789.,"  # of a setpoint
LEFT, STOPPED = object(), object()  # what a stroke on the line may mean


class Shown(Static):
    """A text that is drawn only when it has changed."""

    can_focus = False
    shown = None

    def show(self, text):
        now = text.style, text
        if now != self.shown:
            self.shown = now
            self.update(text)


class KeyCap(Static):
    """A key of the panel, for the mouse, with its letter and what it does now."""

    can_focus = False

    class Pressed(Message):
        def __init__(self, key):
            super().__init__()
            self.key = key

    class Lifted(Message):
        def __init__(self, key):
            super().__init__()
            self.key = key

    def __init__(self, letter, key):
        super().__init__("", id="key_" + key, classes="stop" if key == STOP else None)
        self.set_class(key in STARTERS, "starter")
        self.key = key
        self._letter = letter
        self._how = None

    def show(self, how):
        """how: "HELD", "down" or ""."""
        if how != self._how:
            self._how = how
            self.set_class(bool(how), "down")
            self.update("%s %-12s %s" % (self._letter, self.key, how))

    def on_mouse_down(self, event):
        if event.button == LEFT_BUTTON:
            event.stop()
            self.capture_mouse()
            self.post_message(self.Pressed(self.key))

    def on_mouse_up(self, event):
        event.stop()
        self.release_mouse()
        self.post_message(self.Lifted(self.key))


class Telegrams(Widget):
    """The newest rows that fit; the wheel goes back, and then it stands still."""

    can_focus = False

    def __init__(self, telegrams, **others):
        super().__init__(**others)
        self.in_hex = False
        self.back = 0  # so many rows before the newest
        self._telegrams = telegrams

    def render(self):
        width, height = self.size.width, self.size.height
        rows = self._telegrams.rows
        end = max(len(rows) - self.back, min(height, len(rows)))
        shown = rows[max(0, end - height) : end]
        return Text("\n").join(views.telegram(row, width, self.in_hex) for row in shown)

    def scroll_rows(self, rows):
        """Go back so many rows; negative: forward."""
        most = max(0, len(self._telegrams.rows) - self.size.height)
        self.back = max(0, min(self.back + rows, most))
        self.refresh()

    def on_mouse_scroll_up(self, event):
        event.stop()
        self.scroll_rows(WHEEL_ROWS)

    def on_mouse_scroll_down(self, event):
        event.stop()
        self.scroll_rows(-WHEEL_ROWS)


class Line(Input):
    """The line to type on: a command after `:`, or a setpoint after `=`. It stays open for the
    next command, so that no word of it is taken for keys. Two spaces in a row are STOP.

    kind: COMMAND or SETPOINT while it is open, else None. The window gives it the strokes.
    """

    def __init__(self, **others):
        super().__init__(max_length=LINE_MAX, compact=True, select_on_focus=False, **others)
        self.kind = None
        self._history = []
        self._at = 0

    def open(self, kind):
        self.kind = kind
        self.value = ""
        self._at = len(self._history)
        self.display = True
        self.focus()

    def close(self):
        self.kind = None
        self.value = ""
        self.display = False
        self.screen.set_focus(None)

    def put(self, text):
        """Text that came all at once."""
        if self.kind == COMMAND:
            self.insert_text_at_cursor(text)

    def _on_paste(self, event):
        """What is said to be a paste is left out."""
        event.stop()
        event.prevent_default()

    def take(self, event):
        """A stroke. Return LEFT, STOPPED, a whole line that is not empty, or None."""
        if event.key == "escape":
            return LEFT
        if event.key in ENTERS:
            return self._entered()
        if event.key == "space" and self._is_stop():
            self.value = ""
            return STOPPED
        if event.key in ("up", "down"):
            self._recall(-1 if event.key == "up" else 1)
        elif event.key in EDITING:
            EDITING[event.key](self)
        elif event.is_printable and event.character:
            if self.kind == COMMAND or event.character in FIGURES:
                self.insert_text_at_cursor(event.character)
        return None

    def _is_stop(self):
        return self.kind == SETPOINT or self.value[: self.cursor_position][-1:] in ("", " ")

    def _entered(self):
        text, self.value = self.value, ""
        if not text.strip():
            return LEFT
        if self.kind == COMMAND:
            self._history = [one for one in self._history if one != text][1 - HISTORY_MAX :]
            self._history.append(text)
            self._at = len(self._history)
        return text

    def _recall(self, step):
        """An earlier command, or a later one."""
        if self.kind == COMMAND:
            self._at = max(0, min(self._at + step, len(self._history)))
            self.value = self._history[self._at] if self._at < len(self._history) else ""
            self.cursor_position = len(self.value)

    def _clear(self):
        self.value = ""


EDITING = {
    "left": Input.action_cursor_left,
    "right": Input.action_cursor_right,
    "home": Input.action_home,
    "ctrl+a": Input.action_home,
    "end": Input.action_end,
    "ctrl+e": Input.action_end,
    "backspace": Input.action_delete_left,
    "delete": Input.action_delete_right,
    "ctrl+w": Input.action_delete_left_word,
    "ctrl+u": Line._clear,
}
