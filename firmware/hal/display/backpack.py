# SPDX-License-Identifier: MIT
"""A character display behind a PCF8574 backpack: the HD44780's four data lines through I2C.

Fulfils the contract `display` of `hal`; `character_display` decides what to write, and when.
If a backpack is unplugged, or a pulse upsets its wires, the driver tries it again every AGAIN_US
and sets it up anew when it answers. The panel goes on meanwhile.

    display = Backpack(make_i2c, 0x27, clock)
    display.show(picture)               # each step of the loop, until it answers True
    display.failures                    # transfers that were not acknowledged
    display.backlight(False)            # as the contract `board` of `hal` has it
"""

from micropython import const

from hal.display.character_display import POWER_ON_US, CharacterDisplay
from hal.display.probe import BACKLIGHT

AGAIN_US = const(500_000)

# What the outputs P0...P7 lead to on every backpack of this kind. R/W, P1, stays low.
_REGISTER_SELECT = const(0x01)
_ENABLE = const(0x04)
_DATA = const(0xF0)  # D4...D7

# Two bytes for the controller, each 4 on the bus, and one before each when the register changes.
# With the address they take 1 ms at 100 kHz.
_LONGEST = const(10)


class Backpack(CharacterDisplay):
    """make_i2c: a function that frees the wires if need be and answers an I2C of at most 100 kHz;
    called again after each failure. address: of the PCF8574. clock: contract of `hal`.
    """

    bytes_per_piece = 2

    def __init__(self, make_i2c, address, clock):
        self.failures = 0
        self._make_i2c = make_i2c
        self._i2c_address = address
        self._write_to = make_i2c().writeto
        self._buffer = bytearray(_LONGEST)
        # The slices are made here once, because making one takes heap.
        self._pieces = tuple(memoryview(self._buffer)[:end] for end in range(_LONGEST + 1))
        self._count = 0
        self._register = -1  # what P0 was last set for; -1 unknown
        self._lost = False  # the last transfer failed
        self._light = BACKLIGHT
        CharacterDisplay.__init__(self, clock)

    def backlight(self, on):
        self._light = BACKLIGHT if on else 0
        self._register = -1  # this byte sets it too
        self._buffer[0] = self._light
        self._count = 1
        self._end_piece()

    def _nibble(self, register, code):
        lines = code & _DATA | self._light | (_REGISTER_SELECT if register else 0)
        buffer, count = self._buffer, self._count
        if register != self._register:
            # The register must stand 40 ns before E rises; data need not before E falls.
            self._register = register
            buffer[count] = lines
            count += 1
        buffer[count] = lines | _ENABLE
        buffer[count + 1] = lines
        self._count = count + 2

    def _pause(self, us):
        """Nothing: two bytes on the bus between nibbles take 180 us, longer than any pause."""

    def _end_piece(self):
        count, self._count = self._count, 0
        if self._lost:  # only look whether it is there again: the display may just have got power
            self._buffer[0] = self._light
            count = 1
        try:
            self._write_to(self._i2c_address, self._pieces[count])
        except OSError:
            self.failures = (self.failures + 1) & 0xFFFF
            self._lost = True
            self._write_to = self._make_i2c().writeto
            self._start_over(AGAIN_US)
            return False
        if self._lost:
            self._lost = False
            self._register = -1
            self._start_over(POWER_ON_US)
            return False
        return True
