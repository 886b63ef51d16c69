# SPDX-License-Identifier: MIT
"""A character display on four data lines and two others, moved by plain pins.

In use:

    display = Hd44780(register_select, enable, (d4, d5, d6, d7), clock)
    display.define(bytes((0x1F, 0x11, 0x0A, 0x04, 0x0A, 0x11, 0x1F, 0x00)))     # character 0
    display.show(picture)               # each step of the loop, until it answers True
"""

from micropython import const

from hal.display.character_display import CharacterDisplay

_PULSE_US = const(1)  # 450 ns by the data sheet, see `character_display`


class Hd44780(CharacterDisplay):
    """On four data lines. register_select, enable: Pins. data: Pins D4, D5, D6, D7."""

    bytes_per_piece = 8  # a byte takes 63 us of waiting, and 190 us of computing on an RP2040

    def __init__(self, register_select, enable, data, clock):
        self._set_register_select = register_select.value
        self._set_enable = enable.value
        self._set_d4, self._set_d5, self._set_d6, self._set_d7 = [pin.value for pin in data]
        self._pause = clock.sleep_us
        self._lines = 0
        for pin in (enable, register_select) + tuple(data):
            pin.value(0)
        CharacterDisplay.__init__(self, clock)

    def _nibble(self, register, code):
        """Set the lines, only those that change, and pulse E."""
        self._set_register_select(register)
        changed = code ^ self._lines
        self._lines = code
        if changed & 0x80:
            self._set_d7(code >> 7 & 1)
        if changed & 0x40:
            self._set_d6(code >> 6 & 1)
        if changed & 0x20:
            self._set_d5(code >> 5 & 1)
        if changed & 0x10:
            self._set_d4(code >> 4 & 1)
        self._set_enable(1)
        self._pause(_PULSE_US)
        self._set_enable(0)

    def _end_piece(self):
        return True
