# SPDX-License-Identifier: MIT
"""One number for a whole run: if a seed runs differently on two interpreters, the numbers differ.

In use:

    digest = Digest(world)
    digest.look()                   # after every slice of time
    digest.number
"""

import struct
from binascii import crc32

PICTURE = "<qqqq"  # now, us; telegrams ever; characters and instructions that the display took
TELEGRAM = "<qB"  # when it began, us; whether it is the panel's


class Digest:
    """number: CRC-32 of every telegram as it was sent, and of the display after every slice."""

    def __init__(self, world):
        self.number = 0
        self._world = world
        self._told = 0  # telegrams so far
        self._picture = bytearray(struct.calcsize(PICTURE))
        self._telegram = bytearray(struct.calcsize(TELEGRAM))

    def look(self):
        """Add what has happened since the last look."""
        world = self._world
        lcd, log = world.lcd_chip, world.wire.log
        number = self.number
        for at_us, from_panel, characters in log.last(log.count - self._told):
            struct.pack_into(TELEGRAM, self._telegram, 0, at_us, from_panel)
            number = crc32(characters, crc32(self._telegram, number))
        self._told = log.count
        struct.pack_into(
            PICTURE, self._picture, 0, world.clock.now_us, log.count, lcd.characters,
            lcd.instructions,
        )  # fmt: skip
        self.number = crc32(lcd.ddram, crc32(self._picture, number))

    def with_more(self, *what):
        """The number, and the texts that belong to it."""
        return crc32(repr(what).encode(), self.number)
