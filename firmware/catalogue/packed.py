# SPDX-License-Identifier: MIT
"""A table that is frozen into the firmware, where room is scarce: blocks of rows, each compressed.

A module such as `catalogue.table_mm440` holds it, made by tools/deploying/packing.py:

    BLOCKS      the blocks one after the other, raw deflate
    INDEX       8 bytes for each: the key of its first row, and where it begins

It is read as a file is, but that `bring` finds the block of a key. One block is in memory at a
time, for as long as somebody reads.
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
        self._load(0)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def read(self, count):
        """Not beyond the end of a block, which is the end of a row."""
        piece = self._text.read(count)
        if not piece and self._place + _ENTRY_BYTES < len(self._index):
            self._load(self._place + _ENTRY_BYTES)
            piece = self._text.read(count)
        return piece

    def seek(self, offset, _):
        """Within what was read last."""
        self._text.seek(offset, 1)

    def bring(self, key):
        """The next row is the first of the last block that may have this key."""
        low, high = 0, len(self._index) // _ENTRY_BYTES
        while high - low > 1:
            middle = (low + high) // 2
            if struct.unpack_from(_ENTRY, self._index, middle * _ENTRY_BYTES)[0] <= key:
                low = middle
            else:
                high = middle
        self._load(low * _ENTRY_BYTES)

    def _load(self, place):
        self._place = place
        self._blocks.seek(struct.unpack_from(_ENTRY, self._index, place)[1])
        self._text = BytesIO(DeflateIO(self._blocks, RAW, _WINDOW_BITS).read())
