# SPDX-License-Identifier: MIT
"""The bus of `uss.bus`, with the patience that adapters need."""

from uss import bus

_Bus = bus.Master  # tools/pc/example.py puts the one below in its place

REPLY_TIMEOUT_MS = 60  # adapters keep characters back, many for 16 ms; the specification says 20


class Master(_Bus):
    """As `uss.bus.Master`; link: a `SerialLink`."""

    def __init__(self, link, baud=19200, reply_timeout_ms=REPLY_TIMEOUT_MS, **others):
        _Bus.__init__(self, link, baud, reply_timeout_ms, **others)
