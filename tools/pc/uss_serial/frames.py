# SPDX-License-Identifier: MIT
"""What a program and the keeper of its port say to each other, through two pipes.

A frame is a letter, the length of what follows (2 bytes, the high one first), and that.

    OPEN        >  JSON: port, baud; once more: go on at this rate
    TELEGRAM    >  instant (8 bytes, microseconds), PZD words (or NOT_TOLD), characters
    ALIVE       >  instant
    OPENED      <
    FAILED      <  why, in words
    DATA        <  instant at which they came, characters
    WRONG       <  characters dropped since: with a wrong parity, with a wrong stop bit (2 bytes)
    CUT, BACK   <  the port has gone, and why; it is there again
    STOPPED     <  addresses, a byte each, that were sent OFF1 in the program's place
"""

import struct

OPEN, TELEGRAM, ALIVE = b"O", b"T", b"A"
OPENED, FAILED, DATA, WRONG, CUT, BACK, STOPPED = b"o", b"f", b"d", b"w", b"c", b"b", b"s"

NOT_TOLD = 255  # PZD words
INSTANT = struct.Struct(">Q")
COUNTS = struct.Struct(">BB")
_HEAD = struct.Struct(">cH")


def framed(letter, content=b""):
    return _HEAD.pack(letter, len(content)) + content


def read_frame(stream):
    """(letter, content), or None at the end. stream: its read waits for all of it."""
    head = stream.read(_HEAD.size)
    if len(head) < _HEAD.size:
        return None
    letter, length = _HEAD.unpack(head)
    content = stream.read(length)
    return (letter, content) if len(content) == length else None
