# SPDX-License-Identifier: MIT
"""A table that is frozen into the firmware, where room is scarce: blocks of rows, each compressed.

A module such as `catalogue.table_mm440` holds it, made by tools/deploying/packing.py:

    HEAD        the first line
    BLOCKS      the blocks one after the other, raw deflate
    INDEX       8 bytes for each: the key of its first row, and where it begins

It is read as a file is, but that `bring` finds the block of a key. What is unpacked on the way is
in memory, 128 bytes at a time, and the window of 2 KB, for as long as somebody reads.
"""

import struct
from io import BytesIO

from deflate import RAW, DeflateIO
from micropython import const

import on_demand

_WINDOW_BITS = const(11)  # of packing.py
_ENTRY = "<II"
_ENTRY_BYTES = const(8)


class Packed:
    def __init__(self, family):
        name = "catalogue.table_" + family
        module = on_demand.load(name)
        on_demand.drop(name)
        self._index = module.INDEX
        self._blocks = BytesIO(module.BLOCKS)  # which reads it where it is
        self._place = 0  # of the block, in the index
        self._stream = BytesIO(module.HEAD)
        self._last = self._left = b""

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def read(self, count):
        """Not beyond the end of a block, which is the end of a row."""
        piece, self._left = self._left, b""
        if not piece:
            piece = self._stream.read(count)
        if not piece and self._place + _ENTRY_BYTES < len(self._index):
            self._begin(self._place + _ENTRY_BYTES)
            piece = self._stream.read(count)
        self._last = piece
        return piece

    def seek(self, offset, _):
        """Back within what was read last."""
        if offset:
            self._left = self._last[offset:]

    def bring(self, key):
        """The next row is the first of the last block that may have this key."""
        low, high = 0, len(self._index) // _ENTRY_BYTES
        while high - low > 1:
            middle = (low + high) // 2
            if struct.unpack_from(_ENTRY, self._index, middle * _ENTRY_BYTES)[0] <= key:
                low = middle
            else:
                high = middle
        self._begin(low * _ENTRY_BYTES)

    def _begin(self, place):
        self._place = place
        self._left = b""
        self._blocks.seek(struct.unpack_from(_ENTRY, self._index, place)[1])
        self._stream = DeflateIO(self._blocks, RAW, _WINDOW_BITS)
