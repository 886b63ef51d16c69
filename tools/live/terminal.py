# SPDX-License-Identifier: MIT
"""The terminal as a picture of lines and a source of strokes. It knows nothing of a panel.

On the Unix port of MicroPython. If you open it, close it again, whatever happens in between:

    terminal = Terminal()
    terminal.open()
    try:
        terminal.draw(["first line", HIGHLIGHT + "second" + PLAIN])
        for stroke in strokes.take(terminal.read(20), now_ms): ...
    finally:
        terminal.close()

Escape sequences are those of ECMA-48 that every terminal knows, and the DEC private modes 7, 25,
1049 and 2004 (a paste stands in brackets) as xterm has them.
"""

import os
import select
import sys
import termios

# Marks in a line that take no room: what stands between them is shown in reverse.
HIGHLIGHT = "\x0e"
PLAIN = "\x0f"

# Second screen, no cursor, no wrapping of lines, pastes in brackets.
OPEN = "\x1b[?1049h\x1b[?25l\x1b[?7l\x1b[?2004h\x1b[2J"
CLOSE = "\x1b[0m\x1b[?2004l\x1b[?7h\x1b[?25h\x1b[?1049l"
# Go there, clear it, write, plain again. Clearing comes first: after a character in the last
# column the cursor still stands on it.
LINE = "\x1b[%d;1H\x1b[K%s\x1b[0m"
REVERSED = "\x1b[7m"
NORMAL = "\x1b[27m"

USUAL_ROWS, USUAL_COLUMNS = 24, 80
# The exit status is the figure, cut to what fits into one: 255.
SIZE_COMMAND = "set -- $(stty size 2>/dev/null); n=${%d:-0}; exit $((n < 255 ? n : 255))"

FLUSH = 2  # TCSAFLUSH: MicroPython's termios does not name it
READ_MAX = 1024  # a longer paste is taken in pieces

ARROWS = {b"\x1b[A": "UP", b"\x1b[B": "DOWN", b"\x1b[C": "RIGHT", b"\x1b[D": "LEFT"}
ESCAPE = "ESCAPE"
OTHER = "OTHER"  # a key that has no name here
SPACE, DELETE = 0x20, 0x7F  # this one, and all up to that one, are no part of a key's sequence
ESCAPE_MS = 60  # an escape sequence that was cut in two, as by ssh, is together again by then
SEQUENCE_MAX = 16
PASTE_BEGINS, PASTE_ENDS = b"\x1b[200~", b"\x1b[201~"
# A paste comes in pieces of READ_MAX: what follows within so long is a part of it. And one whose
# end never came is over after so long a silence.
PIECE_MS = 60
UNENDED_MS = 1_000


class Terminal:
    """Standard input and output, which are a terminal."""

    def __init__(self):
        self._settings = None
        self._shown = []
        self._poller = select.poll()

    def open(self):
        """Raw, the second screen, no cursor."""
        self._settings = termios.tcgetattr(0)
        termios.setraw(0)
        self._poller.register(sys.stdin, select.POLLIN)
        self._write(OPEN)

    def close(self):
        """Make it as it was before, and drop unread input, so that no shell takes it."""
        settings, self._settings = self._settings, None
        if settings is None:
            return
        try:
            self._write(CLOSE)
            termios.tcsetattr(0, FLUSH, settings)
        except (EOFError, OSError):
            pass  # it has gone: there is nothing to restore

    def read(self, wait_ms):
        """The bytes that were typed; waits for the first one so long. EOFError: it has gone."""
        typed = bytearray()
        while len(typed) < READ_MAX and self._poller.poll(0 if typed else wait_ms):
            try:
                byte = sys.stdin.buffer.read(1)
            except OSError:
                byte = b""
            if not byte:
                raise EOFError
            typed += byte
        return typed

    def draw(self, lines):
        """Show these lines from the top; those that differ are written. EOFError: as `read`."""
        pieces = []
        for row, line in enumerate(lines):
            if row >= len(self._shown) or self._shown[row] != line:
                shown = line.replace(HIGHLIGHT, REVERSED).replace(PLAIN, NORMAL)
                pieces.append(LINE % (row + 1, shown))
        self._shown = list(lines)
        if pieces:
            self._write("".join(pieces))

    def clear(self):
        """Draw everything anew the next time."""
        self._shown = []
        self._write("\x1b[2J")

    def size(self):
        """Rows and columns, 255 at the most. A terminal that does not tell has 24 x 80.

        MicroPython cannot ask the kernel, so `stty` does: a few milliseconds.
        """
        rows, columns = (os.system(SIZE_COMMAND % place) >> 8 for place in (1, 2))
        return rows or USUAL_ROWS, columns or USUAL_COLUMNS

    def _write(self, text):
        try:
            sys.stdout.write(text)
        except OSError:
            raise EOFError


class Strokes:
    """From bytes to strokes: a character, "UP" ... for the arrows, ESCAPE, or OTHER.

    An Esc does not swallow what is typed after it: a character that begins no sequence is a stroke
    of its own, and a space or a control character ends every sequence.

    pasted    the strokes taken last were not typed one after the other: they stood in brackets, or
              several different ones came in one read
    brackets  they stood in brackets
    """

    def __init__(self):
        self.pasted = self.brackets = False
        self._sequence = b""  # the beginning of an escape sequence
        self._began_ms = 0
        self._in_brackets = False
        self._pasted_ms = -UNENDED_MS  # when the last piece of a paste came

    def take(self, typed, now_ms):
        """The strokes that these bytes complete. Without a byte: an Esc that was only that."""
        strokes = []
        if not typed and self._sequence and now_ms - self._began_ms >= ESCAPE_MS:
            strokes.append(ESCAPE if self._sequence == b"\x1b" else OTHER)
            self._sequence = b""
        self.brackets = self._in_brackets
        for byte in typed:
            self._take(byte, now_ms, strokes)
        self._judge(typed, strokes, now_ms)
        return strokes

    def _judge(self, typed, strokes, now_ms):
        """Whether it is a paste, a piece of one, or a paste whose end never came."""
        if self._in_brackets and not typed and now_ms - self._pasted_ms >= UNENDED_MS:
            self._in_brackets = False
        self.brackets = self.brackets or self._in_brackets
        different = len(set(strokes)) > 1
        follows = now_ms - self._pasted_ms < PIECE_MS
        self.pasted = bool(strokes) and (self.brackets or different or follows)
        if self.pasted or self._in_brackets and typed:
            self._pasted_ms = now_ms

    def _take(self, byte, now_ms, strokes):
        if self._sequence and not self._goes_on(byte):
            strokes.append(ESCAPE if self._sequence == b"\x1b" else OTHER)
            self._sequence = b""
        if self._sequence:
            self._continue(byte, strokes)
        elif byte == 0x1B:
            self._sequence = b"\x1b"
            self._began_ms = now_ms
        elif byte < 0x80:
            strokes.append(chr(byte))
        elif byte >= 0xC0:  # once for a character of several bytes
            strokes.append(OTHER)

    def _goes_on(self, byte):
        if self._sequence == b"\x1b":
            return byte in b"[O"
        return byte > SPACE and byte != DELETE

    def _continue(self, byte, strokes):
        self._sequence += bytes((byte,))
        sequence = self._sequence
        # The Linux console has one [ more in its function keys.
        going_on = len(sequence) == 2 or byte < 0x40 or sequence == b"\x1b[["
        if not going_on or len(sequence) >= SEQUENCE_MAX:
            self._sequence = b""
            if sequence in (PASTE_BEGINS, PASTE_ENDS):
                self._in_brackets = sequence == PASTE_BEGINS
                self.brackets = True
                return
            strokes.append(ARROWS.get(sequence.replace(b"\x1bO", b"\x1b["), OTHER))
