# SPDX-License-Identifier: MIT
"""The I2C backpack of an LCD: a PCF8574 whose eight outputs are the controller's wires.

A byte that it acknowledges is on its outputs at once, all eight bits together. But a controller
wants one change after the other. If E moves in the same byte as another wire, it is not known
which moves first, so this model takes the worse order.

    backpack = Backpack(clock, lcd)         # lcd: a `boards.sim.chip.lcd.Lcd`
    backpack.take(0x0C)                     # E up, backlight on: as acknowledged on the bus
    i2c = I2C(clock, backpack, 100_000)     # for a driver; as machine.I2C, for this one device
    i2c.writeto(0x27, b"\x0c\x08")
"""

ADDRESS = 0x27
ENODEV = 5  # the RP2040 port raises this, EIO, if there is no acknowledgement

# The outputs, as these boards are wired.
RS, RW, E, BACKLIGHT = 0x01, 0x02, 0x04, 0x08
DATA = (0x10, 0x20, 0x40, 0x80)  # D4...D7

BITS = 9  # of a byte on the bus, its acknowledgement included

READS = "the backpack reads the display (R/W is high) while E is high"


class Output:
    """One of the outputs, with the interface of a pin for its listeners."""

    def __init__(self, bit):
        self.bit = bit
        self.on_change = None


class Backpack:
    """address: on the bus. plugged: False while its cable is pulled.

    bytes_taken   how many it has acknowledged
    lit           whether the backlight is on
    complaints    the first broken rule that the controller itself cannot see, or nothing
    """

    def __init__(self, clock, lcd, address=ADDRESS):
        self.address = address
        self.plugged = True
        self.bytes_taken = 0
        self.complaints = []
        self._clock = clock
        self._lcd = lcd
        self._outputs = {bit: Output(bit) for bit in (RS, E) + DATA}
        self._level = 0  # the levels that the controller was told, with RW and the backlight
        self.power_on()

    def power_on(self):
        """Power comes, or comes back, for the backpack and its display."""
        self._lcd.power_on()
        self.join()
        # All outputs are high now (data sheet, power-on reset), R/W too: so the controller is
        # being read and takes nothing. Its initialisation undoes what the first byte may do to it.
        self._level = 0

    def join(self):
        """Its outputs are the controller's wires, as they still are after a reset of the chip."""
        self._lcd.wire(self._outputs[RS], self._outputs[E], [self._outputs[bit] for bit in DATA])

    @property
    def lit(self):
        return bool(self._level & BACKLIGHT)

    def take(self, byte):
        """Take a byte that was acknowledged just now."""
        self.bytes_taken += 1
        changed = byte ^ self._level
        falls, rises = changed & self._level & E, changed & byte & E
        if falls:  # the other wires may have changed before E
            self._change((byte & ~E) | E)
        elif rises and not changed & RS:  # RS must be set before E rises, the data may come later
            self._change(byte & ~E)
        elif rises:
            self._change(self._level | E)
        self._change(byte)

    def _change(self, level):
        changed = level ^ self._level
        self._level = level
        if level & E and level & RW and not self.complaints:
            self.complaints.append("at %d us: %s" % (self._clock.now_us, READS))
        for bit, output in self._outputs.items():
            if changed & bit:
                output.on_change(1 if level & bit else 0)


class I2C:
    """machine.I2C as far as a driver of the backpack uses it, on virtual time.

    hz: of the bus. writeto() takes its time, so it is for the main loop.
    """

    def __init__(self, clock, backpack, hz=100_000):
        self._clock = clock
        self._backpack = backpack
        self._byte_us = -(-BITS * 1_000_000 // hz)

    def scan(self):
        """The addresses that acknowledge."""
        return [self._backpack.address] if self._backpack.plugged else []

    def writeto(self, address, data, stop=True):
        """Send all of `data`; return how many bytes were acknowledged. OSError: none."""
        self._clock.advance(self._byte_us)
        if address not in self.scan():
            raise OSError(ENODEV)
        for byte in data:
            self._clock.advance(self._byte_us)
            self._backpack.take(byte)
        return len(data)
