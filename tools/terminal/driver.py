# SPDX-License-Identifier: MIT
"""The terminal for Textual, made safe for a panel: which strokes count is decided here.

It differs from Textual's own driver in this:

* It cuts what comes into strokes itself (strokes.py). Textual takes the pieces of a sequence that
  it does not know for letters, and a letter starts a motor here.
* What came all at once, as a paste does, is one message, `Together`, and no keys.
* It draws on standard output, so that standard error can be led elsewhere.
* It can ask the terminal whether it is still there: `ask()`, and then `Answered` comes.
* Ctrl-Z does nothing: a panel that stands still stops nothing.
* It hears of a new size also where the program that started it has blocked that signal.
* A terminal that has gone ends the program: `Gone`.
* A terminal without UTF-8 is sent ASCII alone.

    PanelApp(driver_class=TerminalDriver)
"""

import os
import selectors
import signal
import sys
import time
from contextlib import suppress

from textual import events, messages
from textual._ansi_sequences import ANSI_SEQUENCES_KEYS
from textual._xterm_parser import XTermParser
from textual.drivers.linux_driver import LinuxDriver
from textual.keys import _character_to_key
from textual.message import Message

from tools.live.plain import in_ascii, understands_utf_8
from tools.terminal.strokes import ESCAPE, OTHER, Strokes

READ_MAX = 1024  # a longer paste is taken in pieces
LOOK_S = 0.02  # so often an Esc that was only that is looked for
WHERE = "\x1b[6n"  # asks for the place of the cursor: every terminal answers
FOCUS_IN, FOCUS_OUT = "\x1b[I", "\x1b[O"
SYNCHRONISED = "\x1b[?2026;"  # followed by 1 or 2: it can show a picture in one go


class Together(Message, bubble=False):
    """Strokes that were not typed one after the other.

    strokes: as `Strokes` has them. brackets: the terminal says itself that they were pasted.
    """

    def __init__(self, strokes, brackets):
        super().__init__()
        self.strokes = strokes
        self.brackets = brackets


class Answered(Message, bubble=False):
    """The terminal has answered `ask`."""


class Gone(Message, bubble=False):
    """The terminal is no more."""


class Screen:
    """What is drawn on. Where the terminal has gone, it takes all and shows nothing.

    An error would end Textual's thread that writes; the program would wait for it without an end.
    """

    def __init__(self, file):
        self._file = file

    def write(self, text):
        with suppress(OSError):
            self._file.write(text)

    def flush(self):
        with suppress(OSError):
            self._file.flush()

    def fileno(self):
        return self._file.fileno()


class TerminalDriver(LinuxDriver):
    def __init__(self, app, **others):
        super().__init__(app, **others)
        self._file = Screen(sys.__stdout__)
        self._is_plain = not understands_utf_8(os.environ.get)
        self._mouse_parser = XTermParser()
        signal.signal(signal.SIGTSTP, signal.SIG_IGN)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGWINCH])

    def write(self, data):
        super().write(in_ascii(data) if self._is_plain else data)

    def ask(self):
        self.write(WHERE)

    def size_now(self):
        """Columns and rows."""
        return self._get_terminal_size()

    def run_input_thread(self):
        selector = selectors.DefaultSelector()
        selector.register(self.fileno, selectors.EVENT_READ)
        strokes = Strokes()
        with selector:
            while not self.exit_event.is_set():
                typed = b""
                if selector.select(LOOK_S):
                    try:
                        typed = os.read(self.fileno, READ_MAX)
                    except OSError:
                        pass
                    if not typed:
                        self.send_message(Gone())
                        return
                self._take(strokes, typed)

    def _query_in_band_window_resize(self):
        """The kernel tells the size; a terminal that tells it too would tell the mouse in dots."""

    def _take(self, strokes, typed):
        taken = strokes.take(typed, int(time.monotonic() * 1000))
        for report in strokes.reports:
            self._report(report)
        if strokes.pasted:
            self.send_message(Together(taken, strokes.brackets))
        else:
            for stroke in taken:
                self.process_message(key_of(stroke))

    def _report(self, report):
        if report in (FOCUS_IN, FOCUS_OUT):
            self.process_message(events.AppFocus() if report == FOCUS_IN else events.AppBlur())
        elif report.startswith("\x1b[<"):
            event = self._mouse_parser.parse_mouse_code(report)
            if event is not None:
                self.process_message(event)
        elif report.endswith("R"):
            self.send_message(Answered())
        elif report[: len(SYNCHRONISED)] == SYNCHRONISED and report[len(SYNCHRONISED)] in "12":
            self.process_message(messages.TerminalSupportsSynchronizedOutput())


def key_of(stroke):
    """The stroke as Textual names it."""
    known = ANSI_SEQUENCES_KEYS.get(stroke)
    if isinstance(known, tuple):
        return events.Key(known[0].value, stroke if len(stroke) == 1 else None)
    if len(stroke) == 1 and stroke != ESCAPE:
        return events.Key(_character_to_key(stroke), stroke)
    return events.Key("escape" if stroke == ESCAPE else OTHER, None)
