# SPDX-License-Identifier: MIT
"""A table that is frozen into the firmware, where room is scarce: blocks of rows, each compressed.

A module such as `catalogue.table_mm440` holds it, made by tools/deploying/packing.py:

    HEAD        the first line
    BLOCKS      the blocks one after the other, raw deflate
    INDEX       8 bytes for each: the key of its first row, and where it begins

It is read as a file is, but that `bring` finds the row of a key: it unpacks one block, of 2 KB, in
which it searches. That block is in memory for as long as somebody reads.
"""

import struct
from io import BytesIO

from deflate import RAW, DeflateIO
from micropython import const

import on_demand

_WINDOW_BITS = const(11)  # of packing.py
_ENTRY = "<II"
_ENTRY_BYTES = const(8)
_PIECE = const(256)  # that is unpacked in a step
_NEAR = const(200)  # bytes; what is nearer is found by reading on


class Packed:
    """row_key: what tells the key of a row by its beginning."""

    def __init__(self, family, row_key):
        module = on_demand.load("catalogue.table_" + family)
        self._row_key = row_key
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
        """Not beyond the end of a block, which is the end of a row: see `go_on`."""
        piece, self._left = self._left, b""
        self._last = piece = piece or self._stream.read(count)
        return piece

    def seek(self, offset, _):
        """Back within what was read last."""
        if offset:
            self._left = self._last[offset:]

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
        block = yield from self._unpack(low * _ENTRY_BYTES)
        low, high = 0, len(block)
        while high - low > _NEAR:
            middle = block.rfind(b"\n", low, (low + high) // 2) + 1
            if not middle:  # a long row
                break
            if self._row_key(block[middle : middle + 16]) < key:
                low = middle
            else:
                high = middle
        self._stream = BytesIO(block)
        self._stream.seek(low)

    def go_on(self):
        """At the end of a block, go to the next one, and tell whether there is one."""
        place = self._place + _ENTRY_BYTES
        if place < len(self._index):
            self._stream = BytesIO((yield from self._unpack(place)))
        return place < len(self._index)

    def _unpack(self, place):
        """A block as bytes. None after each piece."""
        self._place = place
        self._left = b""
        self._blocks.seek(struct.unpack_from(_ENTRY, self._index, place)[1])
        packed = DeflateIO(self._blocks, RAW, _WINDOW_BITS)
        yield None
        block, piece = b"", packed.read(_PIECE)
        while piece:
            yield None
            block += piece
            piece = packed.read(_PIECE)
        return block
