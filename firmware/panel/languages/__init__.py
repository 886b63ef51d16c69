# SPDX-License-Identifier: MIT
"""The words of a language that is not English, read one by one from `words.tsv`.

    German = Language("de")
    German.get(b"RUNNING", b"RUNNING")          # b"L\xc4UFT", in ISO 8859-1

A row of the table is a text in English and its words in every other language, which the first row
names; where these are missing, the text is in English. A firmware file has the table as modules,
which tools/deploying/packing.py makes: `words_de`. Either stays in flash. What was shown last is
kept; any other text costs a search, once, of some milliseconds in a file.
"""

from binascii import crc32
from struct import pack, unpack_from

from micropython import const

import on_demand

_KEPT = const(24)  # more than a page and what is announced meanwhile have
_PIECE = const(256)
_ROW_MAX = const(128)  # bytes of a row

# The table is missing or damaged, or there is no memory: not even for this tuple, if made then.
_FAILURES = (OSError, ImportError, ValueError, MemoryError)


class Language:
    """name: as the first row of the table has it."""

    def __init__(self, name):
        self._kept = {}
        self._column = 0  # there are no words in it
        self._module = None
        try:
            try:
                with _table() as table:
                    names = _cells(table.read(_ROW_MAX))
                if name.encode() in names:
                    self._column = names.index(name.encode())
            except OSError:
                self._module = on_demand.load("panel.languages.words_" + name)
        except _FAILURES:
            pass

    def get(self, text, _):
        """The words of a text, as that of a dictionary."""
        words = self._kept.get(text)
        if words is None:
            try:
                words = self._read(text) or text
                if len(self._kept) >= _KEPT:
                    self._kept.clear()
                self._kept[text] = words
            except _FAILURES:  # better in English than not at all
                words = text
        return words

    def _read(self, text):
        if self._module:
            return _unpacked(self._module, text)
        if not self._column:
            return text
        with _table() as table:
            cells = _find(table, b"\n%s\t" % text)
        if self._column < len(cells):
            return bytes([ord(letter) for letter in cells[self._column].decode()])
        return text


def _table():
    return open(__file__.rpartition("/")[0] + "/words.tsv", "rb")


def _cells(row):
    """The cells of a row, and of nothing that comes after it."""
    return row.split(b"\n", 1)[0].split(b"\t")


def _find(table, wanted):
    """The cells of the row that begins like this, behind the end of the one before; or none."""
    # Piece by piece in the same bytes: whatever a search takes from the heap is to be collected.
    overlap = len(wanted)
    window = bytearray(overlap + _PIECE)
    whole = memoryview(window)
    room = whole[overlap:]
    while True:
        count = table.readinto(room)
        if not count:
            return ()
        end = overlap + count
        found = window.find(wanted, 0, end)
        if found >= 0:
            return _cells(bytes(whole[found + 1 : end]) + table.read(_ROW_MAX))
        whole[:overlap] = whole[count:end]


def _unpacked(module, text):
    """KEYS are the check sums of the texts, 4 bytes each; PLACES where their WORDS begin, 2 bytes
    each, and one more.
    """
    key = pack("<I", crc32(text))
    at = module.KEYS.find(key)
    while at > 0 and at & 3:
        at = module.KEYS.find(key, at + 1)
    if at < 0:
        return text
    first, end = unpack_from("<HH", module.PLACES, at >> 1)
    return module.WORDS[first:end]
