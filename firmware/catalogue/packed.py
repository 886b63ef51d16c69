# SPDX-License-Identifier: MIT
"""A table that is frozen into the firmware, where room is scarce: blocks of rows, each compressed.

The module `catalogue.tables` holds them all, made by tools/deploying/packing.py. Of each it has

    head        the first line
    blocks      one after the other, raw deflate
    index       8 bytes for each block: the key of its first row, and where it begins

`bring` finds the row of a key: it unpacks one block, of 2 KB, in which it searches. That block is
in memory for as long as somebody reads.
"""

import struct
from io import BytesIO

from deflate import RAW, DeflateIO
from micropython import const

import on_demand

_WINDOW_BITS = const(11)  # of packing.py
_ENTRY = "<II"
_ENTRY_BYTES = const(8)
_FIRST, _PIECE = const(64), const(192)  # bytes that are unpacked in a step: first come the codes
_NEAR = const(200)  # bytes; what is nearer is found by reading on


class Packed:
    """row_key: what tells the key of a row by its beginning."""

    def __init__(self, family, row_key):
        tables = on_demand.load("catalogue.tables").TABLES
        self._block, blocks, self._index = tables[family]
        self._row_key = row_key
        self._blocks = BytesIO(blocks)  # which reads it where it is
        self._place = None  # of the block, in the index
        self._at = 0  # so much of it has been read

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def line(self):
        """The next line; empty at the end of the block, which is the end of a row: see `go_on`."""
        block, at = self._block, self._at
        self._at = end = block.find(b"\n", at) + 1 or len(block)
        return block[at:end]

    def bring(self, key):
        """The next row is that with this key, or one before it that is near. None after each piece
        of the search.
        """
        low, high = 0, len(self._index) // _ENTRY_BYTES
        while high - low > 1:
            middle = (low + high) // 2
            if struct.unpack_from(_ENTRY, self._index, middle * _ENTRY_BYTES)[0] <= key:
                low = middle
            else:
                high = middle
        yield None
        if low * _ENTRY_BYTES != self._place:  # else it is that which the row before came from
            self._block = yield from self._unpack(low * _ENTRY_BYTES)
            yield None
        block = self._block
        low, high = 0, len(block)
        while high - low > _NEAR:
            middle = block.rfind(b"\n", low, (low + high) // 2) + 1
            if not middle:  # a long row
                break
            if self._row_key(block[middle : middle + 16]) < key:
                low = middle
            else:
                high = middle
            if 2 * _NEAR < high - low <= 4 * _NEAR:  # once
                yield None
        self._at = low

    def go_on(self):
        """At the end of a block, go to the next one, and tell whether there is one."""
        place = self._place + _ENTRY_BYTES
        if place < len(self._index):
            self._block = yield from self._unpack(place)
            self._at = 0
        return place < len(self._index)

    def _unpack(self, place):
        """A block as bytes. None after each piece."""
        self._place = place
        self._blocks.seek(struct.unpack_from(_ENTRY, self._index, place)[1])
        packed = DeflateIO(self._blocks, RAW, _WINDOW_BITS)
        yield None
        block, piece = b"", packed.read(_FIRST)
        while piece:
            yield None
            block += piece
            piece = packed.read(_PIECE)
        return block
