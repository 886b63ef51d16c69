# SPDX-License-Identifier: MIT
"""The bus of `uss.bus`, with the patience that adapters need."""

from uss import bus

REPLY_TIMEOUT_MS = 60  # adapters keep characters back, many for 16 ms; the specification says 20


class Master(bus.Master):
    """As `uss.bus.Master`; link: a `SerialLink`."""

    def __init__(self, link, baud=19200, reply_timeout_ms=REPLY_TIMEOUT_MS, **others):
        bus.Master.__init__(self, link, baud, reply_timeout_ms, **others)
