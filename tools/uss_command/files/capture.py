# SPDX-License-Identifier: MIT
"""Telegrams in a file: a line each, seconds, > to the drives or < from them, characters.

        0.001263 > 02 0E 01 12 BC 00 00 00 00 00 00 04 7E 00 00 D9

What begins with # is a remark. The lines of `bus` in scripts of the panel are read as well.
"""

import re
import time

from tools.uss_command.errors import Failure, Misused
from tools.uss_command.explanation import FROM_DRIVE, TO_DRIVE

LINE = re.compile(r"\s*(?:(?:([\d.]+)\s+)?([<>])\s+)?((?:[0-9A-Fa-f]{2}[ \t,]*)+)(?:\s.*)?$")
WAYS = {">": TO_DRIVE, "<": FROM_DRIVE}
MICROSECONDS = 1e-6


def characters_of(text):
    """Characters typed in hex: 02 06, 0206, 0x02,0x06, {02}{06}. Misused."""
    text = re.sub(r"0[xX]", "", text)
    text = re.sub(r"[\s,;:{}-]", "", text)
    try:
        characters = bytes.fromhex(text)
    except ValueError:
        raise Misused("%s: that is not pairs of hexadecimal digits" % text[:40]) from None
    if not 0 < len(characters) <= 256:
        raise Misused("a telegram has 1...256 characters, not %d" % len(characters))
    return characters


def read_capture(path):
    """[(seconds or None, TO_DRIVE, FROM_DRIVE or None, characters)]. Failure."""
    found = []
    try:
        with open(path, encoding="utf-8", errors="replace") as file:
            for number, line in enumerate(file, 1):
                text = line.rstrip("\n")
                if not text.strip() or text.lstrip().startswith("#"):
                    continue
                match = LINE.match(text)
                if not match:
                    raise Failure("%s, line %d: no telegram in hex" % (path, number))
                found.append((_seconds(match[1]), WAYS.get(match[2]), characters_of(match[3])))
    except OSError as error:
        raise Failure("%s: %s" % (path, error.strerror)) from None
    return found


def _seconds(word):
    if not word:
        return None
    return float(word) if "." in word else int(word) * MICROSECONDS


class Capture:
    """A watch of the link that keeps everything; pieces of a reply that came apart are joined.

    show(seconds, is_sent, characters): called for each telegram as well.
    """

    def __init__(self, path=None, show=None):
        self._began_us = time.monotonic_ns() // 1000
        self._show = show
        self._pending = None  # (seconds, characters) of what comes in
        self._file = None
        if path:
            try:
                self._file = open(path, "w", encoding="utf-8")
            except OSError as error:
                raise Failure("%s: %s" % (path, error.strerror)) from None
            self._file.write("# seconds, > to the drives, < from them\n")

    def __call__(self, is_sent, characters, at_us):
        seconds = max(0, at_us - self._began_us) / 1e6  # it may have begun before this did
        if is_sent:
            self.flush()
            self._keep(seconds, True, characters)
            return
        if self._pending is None:
            self._pending = seconds, b""
        self._pending = self._pending[0], self._pending[1] + characters
        joined = self._pending[1]
        if len(joined) > 1 and len(joined) >= joined[1] + 2:
            self.flush()

    def flush(self):
        pending, self._pending = self._pending, None
        if pending:
            self._keep(pending[0], False, pending[1])

    def close(self):
        self.flush()
        if self._file:
            self._file.close()

    def _keep(self, seconds, is_sent, characters):
        if self._file:
            mark = ">" if is_sent else "<"
            self._file.write("%12.6f %s %s\n" % (seconds, mark, characters.hex(" ").upper()))
        if self._show:
            self._show(seconds, is_sent, characters)
