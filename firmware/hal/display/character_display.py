# SPDX-License-Identifier: MIT
"""A character display of 2 x 16 with the controller HD44780: what is written when.

Fulfils the contract `display` of `hal`, for the drivers that move the wires: `hd44780` by four
pins, `rp2_hd44780` by the RP2040's PIO, `backpack` through I2C. The controller cannot be read
(R/W is tied low), so the driver waits as long as the slowest specimen needs. It remembers what it
wrote and writes only what differs. Panels live beside inverters: a pulse on the wires can swap
nibbles, move the picture or spoil a character. So every REFRESH_US the driver sets the controller
up and writes everything anew; this is not visible. While it sets it up nothing else is written, so
it rather begins when a change has just been written: the next one is not at hand yet.
"""

from micropython import const

_COLUMNS = const(16)
_CELLS = const(32)

REFRESH_US = const(8_000_000)  # half a period of the shortest clock that a board may have
_REFRESH_SOON_US = const(7_000_000)  # from then on it waits for a change

# Data sheet: Hitachi HD44780U, ADE-207-272. Table 6, figure 10 and the bus timing give the figures
# in the comments, for 270 kHz; the slowest oscillator has 190 kHz. What is at power-on: figure 24.
_COMMAND_US = const(53)  # 37 us
_DATA_US = const(61)  # the same, and 1.5 clocks until the address has moved
_HOME_US = const(2_160)  # 1.52 ms
POWER_ON_US = const(40_000)
_SLEEP_LIMIT_US = const(100)  # for a longer wait the driver returns and goes on later
_NEXT_PIECE_US = const(101)

_FIRST_ROW = const(0x80)  # "set DDRAM address"
_SECOND_ROW = const(0xC0)
_GLYPHS = const(0x40)  # "set CGRAM address"
_DISPLAY_ON = const(0x0C)  # no cursor

# This sequence puts the controller in order, whichever nibble it waits for, and whether or not it
# has just got power: code, whole byte or high nibble only, time until the next one.
# It has no "clear": the old picture stays until the new one is written over it. It has a "home",
# because nothing else brings a picture back that a pulse has moved; else "home" changes nothing.
# From the second 0x30 to 0x28 the second row may be dark: within a single piece that is too short
# to see.
_SEQUENCE = (
    (0x30, False, 4_100),  # may be the second nibble of a "home", then this takes long
    (0x30, False, 100),
    (0x30, False, 100),  # 8 bits by now, in any case
    (0x20, False, 100),  # 4 bits
    (0x28, True, _NEXT_PIECE_US),  # 4 bits, 2 lines, 5 x 8 dots
    (0x06, True, _COMMAND_US),  # the address moves to the right, the picture does not
    (0x02, True, _HOME_US),
)


class CharacterDisplay:
    """Drivers that bring nibbles to the controller inherit this. clock: contract of `hal`.

    bytes_per_piece     2 at least; `show` writes at most so many
    cells_per_piece     2 at least; `show` compares so many
    _nibble(register, code)     bits 7...4 of `code`. register: 0 instruction, 1 data
    _byte(register, code)       both nibbles and a pause, if the driver has a better way than this
    _pause(us)                  nothing may reach the controller for so long
    _end_piece()                writes what these two have only collected; False when that failed,
                                and then it has called `_start_over`
    """

    rows = 2
    columns = _COLUMNS
    bytes_per_piece = 2
    cells_per_piece = _CELLS
    _nibble = _pause = _end_piece = None  # see above

    def __init__(self, clock):
        self._ticks_us = clock.ticks_us
        self._mask = clock.ticks_mask
        self._glyphs = b""
        self._shown = bytearray(_CELLS)
        self._cell = 0  # the next one to compare
        self._start_over(POWER_ON_US)

    def define(self, glyphs):
        """glyphs: 8 bytes for each of at most 8 characters. ValueError: any other length."""
        if len(glyphs) % 8 or len(glyphs) > 64:
            raise ValueError("8 bytes for each of 8 characters at most, not %d" % len(glyphs))
        self._glyphs = bytes(glyphs)

    def show(self, picture):
        """Bring the display a piece nearer to `picture`, 32 codes; whether it shows it all."""
        waited_us = (self._ticks_us() - self._since_us) & self._mask
        if waited_us > self._wait_us:
            self._put_in_order()
        if self._in_order and (self._unsure or self._shown != picture):
            self._write(picture)
            if waited_us > _REFRESH_SOON_US and self._rests(picture):
                self._put_in_order()
        return self._is_on and self._shown == picture

    def _rests(self, picture):
        """Whether all is written. (It is not after a failure, and not within a refresh.)"""
        return self._in_order and not self._unsure and self._shown == picture

    def _start_over(self, after_us):
        """Set everything up anew, not before so many microseconds; assume nothing is shown."""
        self._step = 0  # of _SEQUENCE
        self._in_order = False  # True once the sequence is over and bytes can be written
        self._unsure = 0  # bytes that must be written whatever the display seems to show
        self._leads_to = -1  # the controller's address: a cell, or _CELLS + index of dots
        self._is_on = False
        self._ahead = 0  # how many pieces in a row went ahead of a refresh
        self._come_back_after(after_us)

    def _put_in_order(self):
        """Do the next steps of the sequence, up to one with a longer wait."""
        self._in_order = False
        if self._step == len(_SEQUENCE):
            self._step = 0
            self._in_order = True
            self._unsure = len(self._glyphs) + _CELLS + 1
            self._leads_to = -1
            self._come_back_after(REFRESH_US)
            return
        wait_us = 0
        while wait_us <= _SLEEP_LIMIT_US:
            self._pause(wait_us)
            code, whole, wait_us = _SEQUENCE[self._step]
            self._step += 1
            if whole:
                self._byte(0, code)
            else:
                self._nibble(0, code)
        if self._end_piece():
            self._come_back_after(wait_us)

    def _come_back_after(self, wait_us):
        self._since_us = self._ticks_us()
        self._wait_us = wait_us

    def _write(self, picture):
        """Write a piece of what differs; in a refresh, of the dots, then of all cells.

        What differs goes ahead of a refresh. It takes two of three pieces at the most, so that a
        picture that changes all the time is refreshed too.
        """
        left = self.bytes_per_piece
        if self._unsure > 1 and self._is_on and self._ahead < 2 and self._shown != picture:
            self._ahead += 1
            self._write_ahead(picture, left)
        else:
            self._ahead = 0
            while left and self._unsure > _CELLS + 1:
                left -= self._write_dots(len(self._glyphs) + _CELLS + 1 - self._unsure)
                self._unsure -= 1
            if self._unsure == 1:  # first, because what differs may leave no room for it
                self._byte(0, _DISPLAY_ON)
                self._unsure = 0
                self._is_on = True
                left -= 1
            self._write_cells(picture, left)
        self._end_piece()

    def _write_ahead(self, picture, left):
        """Write what differs, from the first cell on. The refresh writes these cells once more."""
        shown = self._shown
        for at in range(_CELLS):
            if shown[at] != picture[at]:
                cost = 1 if at == self._leads_to else 2
                if left < cost:
                    break
                left -= cost
                self._write_cell(at, picture[at], cost == 2)

    def _write_dots(self, index):
        """Answers how many bytes that took: one, if the address leads there already."""
        cost = 1 if self._leads_to == _CELLS + index else 2
        if cost == 2:
            self._byte(0, _GLYPHS | index)
        self._byte(1, self._glyphs[index])
        self._leads_to = _CELLS + index + 1
        return cost

    def _write_cells(self, picture, left):
        """Write what differs in the next cells, in a refresh all of them, in at most `left` bytes.

        It goes round from where it stopped.
        """
        shown, at = self._shown, self._cell
        for _ in range(self.cells_per_piece):
            if shown[at] != picture[at] or self._unsure > 1:
                cost = 1 if at == self._leads_to else 2
                if left < cost:
                    break
                left -= cost
                self._write_cell(at, picture[at], cost == 2)
                if self._unsure > 1:
                    self._unsure -= 1
                elif shown == picture:
                    at = 0  # what changes next is most likely in the first row
                    break  # looking at the rest of the cells takes longer than this comparison
            at = at + 1 if at + 1 < _CELLS else 0
        self._cell = at

    def _write_cell(self, at, code, go_there):
        if go_there:
            self._byte(0, _FIRST_ROW + at if at < _COLUMNS else _SECOND_ROW - _COLUMNS + at)
        self._byte(1, code)
        self._shown[at] = code
        # After the last column the controller has 24 more cells, which are not visible.
        self._leads_to = at + 1 if at != _COLUMNS - 1 and at != _CELLS - 1 else -1

    def _byte(self, register, code):
        self._nibble(register, code)
        self._nibble(register, code << 4)
        self._pause(_DATA_US if register else _COMMAND_US)
