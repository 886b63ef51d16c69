"""A character display of 2 x 16 with the controller HD44780, on four data lines.

Fulfils the contract `display` of `hal`. The controller cannot be read (R/W is tied low), so the
driver waits as long as the slowest specimen needs, and remembers what it wrote to write only what
differs. Panels live beside inverters: a pulse on the wires can swap nibbles, move the picture or
spoil a character. So every REFRESH_US all is set up and written anew, which nobody sees.

    display = Hd44780(register_select, enable, (d4, d5, d6, d7), clock)
    display.define(bytes((0x1F, 0x11, 0x0A, 0x04, 0x0A, 0x11, 0x1F, 0x00)))     # character 0
    display.show(picture)               # each step of the loop, until it answers True
"""

from micropython import const

_COLUMNS = const(16)
_CELLS = const(32)

REFRESH_US = const(8_000_000)  # half a period of the shortest clock that a board may have

# Data sheet: Hitachi HD44780U, ADE-207-272. Table 6, figure 10 and the bus timing give the figures
# in the comments, for 270 kHz; the slowest oscillator has 190 kHz. What is at power-on: figure 24.
_PULSE_US = const(1)  # 450 ns
_COMMAND_US = const(53)  # 37 us
_DATA_US = const(61)  # the same, and 1.5 clocks until the address has moved
_HOME_US = const(2_160)  # 1.52 ms
_POWER_ON_US = const(40_000)
_SLEEP_LIMIT_US = const(100)  # whoever must wait longer comes back later

# A byte takes 63 us, and about 45 us of computing on an RP2040 (estimated, not measured). Nine,
# the last one switching the display on, stay below 1 ms.
BYTES_PER_PIECE = const(8)

_FIRST_ROW = const(0x80)  # "set DDRAM address"
_SECOND_ROW = const(0xC0)
_GLYPHS = const(0x40)  # "set CGRAM address"
_DISPLAY_ON = const(0x0C)  # no cursor

# What puts the controller in order, whatever nibble of whatever it waits for, and whether or not
# it has just got power: code, whole byte or high nibble only, time until the next one.
# There is no "clear" among it: the old picture stays until the new one is written over it. "Home"
# is, because nothing else brings a picture back that a pulse has moved; else it changes nothing.
_SEQUENCE = (
    (0x30, False, 4_100),  # may be the second nibble of a "home", then this takes long
    (0x30, False, 100),
    (0x30, False, 100),  # 8 bits by now, in any case
    (0x20, False, 100),  # 4 bits
    (0x28, True, _COMMAND_US),  # 4 bits, 2 lines, 5 x 8 dots
    (0x06, True, _COMMAND_US),  # the address moves to the right, the picture does not
    (0x02, True, _HOME_US),
)


class Hd44780:
    """register_select, enable: Pins. data: Pins D4, D5, D6, D7. clock: contract of `hal`."""

    rows = 2
    columns = _COLUMNS

    def __init__(self, register_select, enable, data, clock):
        self._set_register_select = register_select.value
        self._set_enable = enable.value
        self._set_d4, self._set_d5, self._set_d6, self._set_d7 = [pin.value for pin in data]
        self._ticks_us = clock.ticks_us
        self._sleep_us = clock.sleep_us
        self._mask = clock.ticks_mask
        self._glyphs = b""
        self._shown = bytearray(_CELLS)
        self._step = 0  # of _SEQUENCE
        self._since = 0
        self._wait_us = 0
        self._come_back_after(_POWER_ON_US)
        self._in_order = False  # the sequence is over: bytes can be written
        self._unsure = 0  # bytes that must be written whatever the display seems to show
        self._at = 0  # the cell that is looked at next
        self._address = -1  # the cell to which the controller's address leads
        self._is_on = False
        self._lines = 0
        for pin in (enable, register_select) + tuple(data):
            pin.value(0)

    def define(self, glyphs):
        """glyphs: 8 bytes for each of at most 8 characters. ValueError: any other length."""
        if len(glyphs) % 8 or len(glyphs) > 64:
            raise ValueError("8 bytes for each of 8 characters at most, not %d" % len(glyphs))
        self._glyphs = bytes(glyphs)

    def show(self, picture):
        """Bring the display a piece nearer to `picture`, 32 codes; whether it shows it all."""
        if (self._ticks_us() - self._since) & self._mask > self._wait_us:
            self._put_in_order()
        if self._in_order and (self._unsure or self._shown != picture):
            self._write(picture)
        return self._is_on and self._shown == picture

    def _put_in_order(self):
        """The next steps of the sequence, up to one that must be waited for longer."""
        self._in_order = False
        while self._step < len(_SEQUENCE):
            code, whole, wait_us = _SEQUENCE[self._step]
            self._step += 1
            self._set_register_select(0)
            self._nibble(code)
            if whole:
                self._nibble(code << 4)
            if wait_us > _SLEEP_LIMIT_US:
                self._come_back_after(wait_us)
                return
            self._sleep_us(wait_us)
        self._step = 0
        self._in_order = True
        self._unsure = len(self._glyphs) + _CELLS
        self._address = -1
        self._come_back_after(REFRESH_US)

    def _come_back_after(self, wait_us):
        self._since = self._ticks_us()
        self._wait_us = wait_us

    def _write(self, picture):
        """A piece of the dots, then of the cells, going round from where it stopped."""
        left = BYTES_PER_PIECE
        while left and self._unsure > _CELLS:
            left -= self._write_dots(len(self._glyphs) + _CELLS - self._unsure)
            self._unsure -= 1
        for _ in range(_CELLS):
            at = self._at
            if self._unsure or self._shown[at] != picture[at]:
                if left < (1 if at == self._address else 2):
                    return
                left -= self._write_cell(at, picture[at])
                if self._unsure:
                    self._unsure -= 1
                    if not self._unsure:
                        self._byte(0, _DISPLAY_ON, _COMMAND_US)
                        self._is_on = True
            self._at = at + 1 if at + 1 < _CELLS else 0

    def _write_dots(self, index):
        """Answers how many bytes that took, as the next one does."""
        count = 1
        if index == 0:
            self._byte(0, _GLYPHS, _COMMAND_US)
            count = 2
        self._byte(1, self._glyphs[index], _DATA_US)
        return count

    def _write_cell(self, at, code):
        count = 1
        column = at % _COLUMNS
        if at != self._address:
            self._byte(0, (_SECOND_ROW if at >= _COLUMNS else _FIRST_ROW) + column, _COMMAND_US)
            count = 2
        self._byte(1, code, _DATA_US)
        self._shown[at] = code
        # Behind the last column the controller has 24 cells more, which nobody sees.
        self._address = at + 1 if column + 1 < _COLUMNS else -1
        return count

    def _byte(self, register, code, duration_us):
        self._set_register_select(register)
        self._nibble(code)
        self._nibble(code << 4)
        self._sleep_us(duration_us)

    def _nibble(self, code):
        """Bits 7...4 of `code`; a line that stays as it is costs nothing."""
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
        self._sleep_us(_PULSE_US)
        self._set_enable(0)
