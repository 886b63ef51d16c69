# SPDX-License-Identifier: MIT
"""What the firmware takes from MicroPython's module of this name, on CPython."""

import io
import zlib

RAW = 1


class DeflateIO(io.BytesIO):
    """What is packed in a stream, from where it stands on. form: RAW."""

    def __init__(self, stream, form, window_bits):
        assert form == RAW
        io.BytesIO.__init__(self, zlib.decompressobj(-window_bits).decompress(stream.read()))
