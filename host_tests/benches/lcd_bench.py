# SPDX-License-Identifier: MIT
"""What the tests of the displays share: the simulated controller, and a driver wired to it."""

from boards.sim.chip.backpack import I2C
from boards.sim.chip.backpack import Backpack as BackpackChip
from boards.sim.chip.lcd import POWER_ON_US, Lcd
from boards.sim.chip.machine import Chip, Pin
from boards.sim.clock import Clock
from boards.sim.line.wire import Wire
from hal.display.backpack import Backpack
from hal.display.hd44780 import Hd44780
from hal.display.probe import answers

LOOP_US = 2_000  # from one call of show to the next

HOURGLASS = bytes((0x1F, 0x11, 0x0A, 0x04, 0x0A, 0x11, 0x1F, 0x00))
UP_AND_DOWN = bytes((0x04, 0x0E, 0x15, 0x04, 0x04, 0x15, 0x0E, 0x04))

RUNNING = b"S: 10.0 F: 10.00RUNNING      A1 "
READY = b"S: 10.0 F:  0.00READY        A1 "


class LcdBench:
    """A controller that has just got power, and pins. `boot` makes a driver on new pins."""

    def __init__(self, ticks_start=0, ticks_mask=0x3FFFFFFF):
        self.clock = Clock(ticks_start, ticks_mask)
        self.chip = Chip(self.clock, Wire(self.clock, 19200))
        self.lcd = Lcd(self.clock)
        self.display = None
        self.wire()

    def wire(self):
        self.enable = Pin(self.chip)
        self.register_select = Pin(self.chip)
        self.data = tuple(Pin(self.chip) for _ in range(4))
        self.lcd.wire(self.register_select, self.enable, self.data)

    def boot(self, glyphs=b""):
        self.display = Hd44780(self.register_select, self.enable, self.data, self.clock)
        self.display.define(glyphs)
        return self.display

    def restart(self):
        """The microcontroller resets and boots again; the display keeps its power."""
        self.lcd.let_go()
        self.chip.reset()
        self.clock.advance(10_000)
        self.wire()

    def turn(self, picture):
        """One turn of the main loop; whether all is shown."""
        shown = self.display.show(picture)
        self.clock.advance(LOOP_US)
        return shown

    def run(self, picture, ms=200):
        """So many milliseconds of main loop; answers whether all was shown at the end."""
        until_us = self.clock.now_us + ms * 1000
        shown = False
        while self.clock.now_us < until_us:
            shown = self.turn(picture)
        return shown

    def text(self):
        return "".join(self.lcd.text())

    def written(self):
        """How many bytes the controller has taken."""
        return self.lcd.characters + self.lcd.dots + self.lcd.instructions

    # --- without the driver ---------------------------------------------------------------------

    def nibble(self, register, nibble):
        """By the book: levels, E up, E down."""
        self.register_select(register)
        for position, pin in enumerate(self.data):
            pin(nibble >> position & 1)
        self.enable(1)
        self.clock.advance(1)
        self.enable(0)

    def byte(self, register, code, wait_us=61):
        self.nibble(register, code >> 4)
        self.nibble(register, code & 0x0F)
        self.clock.advance(wait_us)

    def command(self, code, wait_us=53):
        self.byte(0, code, wait_us)

    def letters(self, text):
        for code in text:
            self.byte(1, code)

    def start(self):
        """Initialising by instruction, as the data sheet has it (figure 24), display on."""
        self.clock.advance(POWER_ON_US)
        for nibble, wait_us in ((3, 4_100), (3, 100), (3, 53), (2, 53)):
            self.nibble(0, nibble)
            self.clock.advance(wait_us)
        for code, wait_us in ((0x28, 53), (0x08, 53), (0x01, 2_160), (0x06, 53), (0x0C, 53)):
            self.command(code, wait_us)


class BackpackBench(LcdBench):
    """The same controller behind a backpack on I2C."""

    def wire(self):
        self.chip_of_backpack = BackpackChip(self.clock, self.lcd)
        self.made = 0  # how often the I2C was made

    def make_i2c(self):
        """What the driver sends with it goes through `write_to`, which a test may replace."""
        self.made += 1
        i2c = I2C(self.clock, self.chip_of_backpack)
        self.write_to = i2c.writeto
        i2c.writeto = lambda address, data: self.write_to(address, data)
        return i2c

    def boot(self, glyphs=b""):
        """As a board file does: look whether it is there, then make the driver."""
        assert answers(I2C(self.clock, self.chip_of_backpack), self.chip_of_backpack.address)
        self.display = Backpack(self.make_i2c, self.chip_of_backpack.address, self.clock)
        self.display.define(glyphs)
        return self.display

    def restart(self):
        """The microcontroller resets and boots again; the backpack keeps its outputs."""
        self.chip.reset()
        self.clock.advance(10_000)

    def check(self):
        assert self.lcd.complaints() == [] and self.chip_of_backpack.complaints == []
