# SPDX-License-Identifier: MIT
"""The module `machine` of a port, on the simulated chip: it refuses what that port refuses.

    port = Port(CHIPS["ESP32S3"], chip)
    port.Pin(6, port.Pin.OUT, value=0)  # a board file says machine.Pin: loading.py

The same names, arguments and limits as on the port (refusals.py). What a program does with the
chip reaches the wire, the display and the keys of `boards.sim` by way of `world.py` beside this.
"""

from boards.sim.chip import machine as sim
from boards.sim.chip.backpack import I2C as SimulatedI2C
from boards.sim.ports import esp32_uart

PULL_UP_OF = {"esp32": 2, "rp2": 1}
I2C_COUNT = 2


class Memory:
    """machine.mem32: what was written where, in turn, and what is read there."""

    def __init__(self):
        self.written = []
        self.levels = {}
        self.on_write = None

    def __getitem__(self, address):
        return self.levels.get(address, 0)

    def __setitem__(self, address, value):
        self.written.append((address, value))
        self.levels[address] = value
        if self.on_write is not None:
            self.on_write()


class Port:
    """model: of `chips.CHIPS`. chip: a simulated chip. clock: virtual time.

    pins            number -> pin, as they were made
    met             the refusals that were raised or noted, in turn: (name, text)
    lenient         names of refusals that are noted and not raised
    backpack        of the display, or None: nobody acknowledges on I2C
    reset_word      what machine.reset_cause() answers
    make_uart_line  called with each UART that is made
    """

    IN, OUT = 0, 1
    WDT_RESET, PWRON_RESET = 3, 1

    def __init__(self, model, chip, lenient=()):
        self.model = model
        self.chip = chip
        self.clock = chip.clock
        self.pins = {}
        self.met = []
        self.lenient = lenient
        self.backpack = None
        self.reset_word = self.PWRON_RESET
        self.mem32 = Memory()
        self.make_uart_line = None
        self.sleep_loop = None  # called by time.sleep_ms, if anything is
        self.claimed = ()  # state machines that somebody else has
        self.Pin = pin_of(self)
        self.UART = uart_of(self)
        self.Timer = timer_of(self)
        self.WDT = watchdog_of(self)
        self.I2C = i2c_of(self)

    def refuse(self, name, *values):
        """Raise the refusal of that name, and note it."""
        refusal = self.model.refusals[name]
        text = refusal.text % values if "%" in refusal.text else refusal.text
        self.met.append((name, text))
        if name not in self.lenient:
            raise refusal.error(text)

    def check_pin(self, number, drives, pulls):
        for what in self.model.troubles(number, drives, pulls):
            self.refuse(what, number)


def number_of(pin):
    if isinstance(pin, int):
        return pin
    if not hasattr(pin, "number"):
        raise ValueError("%r is no number of a pin" % (pin,))
    return pin.number


# Each port has classes of its own: programs use their constants, as Pin.PULL_UP.


def pin_of(port):
    class Pin(sim.Pin):
        IN, OUT = sim.Pin.IN, sim.Pin.OUT
        OPEN_DRAIN = sim.Pin.OPEN_DRAIN
        PULL_UP = PULL_UP_OF[port.model.port]

        def __init__(self, pin, mode=None, pull=None, *, value=0):
            self.number = number = number_of(pin)
            drives = mode in (self.OUT, self.OPEN_DRAIN)
            port.check_pin(number, drives, pull is not None)
            if mode is None and number in port.pins:
                mode = port.pins[number].mode
            elif mode is None:
                mode = self.IN
            sim.Pin.__init__(self, port.chip, mode, pull, value=value)
            port.pins.setdefault(number, self)
            if drives or pull is not None:
                port.pins[number] = self

        def init(self, mode, pull=None, *, value=0):
            self.value(value)

    return Pin


def uart_of(port):
    class UART:
        IRQ_RXIDLE = esp32_uart.RXIDLE if port.model.port == "esp32" else sim.UART.IRQ_RXIDLE

        def __new__(cls, number, baudrate, **options):
            return make_uart(port, number, baudrate, options)

    return UART


def timer_of(port):
    class Timer(sim.Timer):
        def __init__(self, number=-1):
            esp32 = port.model.port == "esp32"
            if number >= port.model.timers or (not esp32 and number != -1):
                port.refuse("timer", number)
            if esp32 and number == 0:
                port.refuse("timer of the uart", number)
            sim.Timer.__init__(self, port.chip)

        def init(self, **options):
            if options.pop("hard", False):
                port.refuse("timer hard")
            if not options.get("period", 1) and port.model.port == "esp32":
                port.refuse("timer period")
            sim.Timer.init(self, **options)

    return Timer


def watchdog_of(port):
    class WDT(sim.WDT):
        def __init__(self, id=0, timeout=5000):
            if not 0 < timeout <= port.model.watchdog_ms:
                port.refuse("watchdog time", timeout)
            for other in port.chip.peripherals:
                if isinstance(other, sim.WDT):  # there is one: its time is set anew
                    other.die()
            self.timeout_ms = timeout
            sim.WDT.__init__(self, port.chip, timeout, port.model.watchdog_ms)

        def __getattr__(self, name):
            port.refuse("watchdog stop", name)

    return WDT


def i2c_of(port):
    class I2C:
        def __init__(self, number, *, sda, scl, freq=400_000, timeout=50_000):
            if not 0 <= number < I2C_COUNT:
                port.refuse("i2c", number)
            sda, scl = number_of(sda), number_of(scl)
            if port.model.port == "rp2":
                for pin, first in ((sda, 0), (scl, 1)):
                    if pin % 4 != first + 2 * number:
                        port.refuse("i2c pin", pin)
            for pin in (sda, scl):
                port.check_pin(pin, True, True)
            self._i2c = None
            if port.backpack is not None:
                self._i2c = SimulatedI2C(port.clock, port.backpack, freq)

        def writeto(self, address, data):
            if self._i2c is None or address not in self._i2c.scan():
                port.refuse("i2c absent", address)
            return self._i2c.writeto(address, data)

    return I2C


def make_uart(port, number, baudrate, options):
    """machine.UART of the port, on its wire."""
    if not 0 <= number < port.model.uarts:
        port.refuse("uart", number)
    send, receive = number_of(options["tx"]), number_of(options["rx"])
    port.check_pin(send, True, False)
    port.check_pin(receive, False, True)
    uart = esp32_uart.make(port, number, baudrate, options, (send, receive))
    if port.make_uart_line is not None:
        port.make_uart_line(uart)
    return uart
