# SPDX-License-Identifier: MIT
"""What a terminal sends, cut into strokes, and into reports of its own accord.

    strokes = Strokes()
    for stroke in strokes.take(typed, now_ms):      # typed: bytes, none at all now and then
        ...
    strokes.reports                                 # mouse, answers, focus: whole sequences

A stroke is a character, the sequence of a key ("\\x1b[A"), ESCAPE alone, or OTHER, which was no
whole sequence. An Esc does not swallow what is typed after it: a character that begins no sequence
is a stroke of its own, and a space or a control character ends every sequence. So a STOP is heard
wherever it stands, and no piece of an unknown key is taken for a letter.
"""

import re

ESCAPE = "\x1b"
OTHER = "OTHER"
SPACE, DELETE = 0x20, 0x7F  # this one, and all up to that one, are no part of a key's sequence
ESCAPE_MS = 60  # an escape sequence that was cut in two, as by ssh, is together again by then
SEQUENCE_MAX = 32
# Mouse, the place of the cursor, what the terminal can do, whether its window has the focus.
REPORT = re.compile(r"\x1b\[(<[-\d;]+[Mm]|\d+;\d+R|\?[\d;]*\$y|[IO])")
PASTE_BEGINS, PASTE_ENDS = "\x1b[200~", "\x1b[201~"
# A paste comes in pieces: what follows within so long is a part of it. And one whose end never
# came is over after so long a silence.
PIECE_MS = 60
UNENDED_MS = 1_000


class Strokes:
    """pasted    the strokes taken last were not typed one after the other: they stood in brackets,
                 or several different ones came in one read
    brackets  they stood in brackets
    reports   what came with them and is no stroke
    """

    def __init__(self):
        self.pasted = self.brackets = False
        self.reports = []
        self._sequence = ""  # the beginning of an escape sequence
        self._letter = b""  # the beginning of a character of several bytes
        self._began_ms = 0
        self._in_brackets = False
        self._pasted_ms = -UNENDED_MS  # when the last piece of a paste came

    def take(self, typed, now_ms):
        """The strokes that these bytes complete. Without a byte: an Esc that was only that."""
        strokes = []
        self.reports = []
        if not typed and self._sequence and now_ms - self._began_ms >= ESCAPE_MS:
            self._break_off(strokes)
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
            self._break_off(strokes)
        if self._sequence:
            self._continue(byte, strokes)
        elif byte == 0x1B:
            self._sequence = ESCAPE
            self._began_ms = now_ms
        elif byte < 0x80:
            strokes.append(chr(byte))
        else:
            self._spell(byte, strokes)

    def _spell(self, byte, strokes):
        """A byte of a character that has several."""
        self._letter = bytes((byte,)) if byte >= 0xC0 else self._letter + bytes((byte,))
        try:
            strokes.append(self._letter.decode())
            self._letter = b""
        except UnicodeDecodeError:
            self._letter = self._letter[:4]

    def _break_off(self, strokes):
        strokes.append(ESCAPE if self._sequence == ESCAPE else OTHER)
        self._sequence = ""

    def _goes_on(self, byte):
        if self._sequence == ESCAPE:
            return byte in b"[O"
        return SPACE < byte < DELETE

    def _continue(self, byte, strokes):
        self._sequence += chr(byte)
        sequence = self._sequence
        # The Linux console has one [ more in its function keys.
        going_on = len(sequence) == 2 or byte < 0x40 or sequence == "\x1b[["
        if going_on and len(sequence) < SEQUENCE_MAX:
            return
        self._sequence = ""
        if sequence in (PASTE_BEGINS, PASTE_ENDS):
            self._in_brackets = sequence == PASTE_BEGINS
            self.brackets = True
        elif REPORT.fullmatch(sequence):
            self.reports.append(sequence)
        else:
            strokes.append(OTHER if going_on else sequence)
