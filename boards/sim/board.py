# SPDX-License-Identifier: MIT
"""The virtual board: the attributes that `hal` asks of any board, on a simulated chip.

The display's controller, the switches and the flash belong to the panel and outlive a restart of
the chip. Every restart makes a new board, as on the chip.
"""

# Lower layers first: an import inside an import inside an import takes stack.
import hal.link.rs485  # noqa: F401
from boards.sim.chip.machine import UART, WDT, Pin, Timer
from boards.sim.going_on import GoingOnLink
from boards.sim.line.wire import Transceiver
from hal.display.hd44780 import Hd44780
from hal.keypad import Keypad, Matrix

KEYS = (
    "START",
    "STOP",
    "REVERSE",
    "JOG_RIGHT",
    "JOG_LEFT",
    "UP",
    "DOWN",
    "ADDRESS_UP",
    "ADDRESS_DOWN",
    "PARAM",
    "NEXT",
    "PREVIOUS",
    "EDIT",
    "SET",
)

# A compact keypad, see firmware/panel/keys/compact.py.
COMPACT_KEYS = ("START", "STOP", "REVERSE", "JOG", "UP", "DOWN", "P", "FN")

NORMALLY_CLOSED = ("STOP",)

# How the keys may be wired: which are in a matrix. The others have pins of their own.
WIRINGS = {
    "direct": (),
    "matrix": (
        ("REVERSE", "JOG_RIGHT", "JOG_LEFT", "PARAM"),
        ("UP", "DOWN", "ADDRESS_UP", "ADDRESS_DOWN"),
        ("NEXT", "PREVIOUS", "EDIT", "SET"),
    ),
}
# Which keys there are, and how they are wired.
KEYPADS = {wiring: (KEYS, matrix) for wiring, matrix in WIRINGS.items()}
KEYPADS["compact"] = (COMPACT_KEYS, ())

# Steps of the main loop: the usual one of the simulation, and the longest ones on the chip.
LOOP_US, LONG_LOOP_US = 2_000, 4_000
WATCHDOG_MS = 2_000


class Watchdog:
    """Starts with the first feeding; if unfed for WATCHDOG_MS, it restarts the chip."""

    def __init__(self, chip):
        self._chip = chip
        self._wdt = None

    def feed(self):
        if self._wdt is None:
            self._wdt = WDT(self._chip, WATCHDOG_MS)
        else:
            self._wdt.feed()

    def stop(self):
        """Stop it by a bit of the RP2040's register, which machine.WDT does not offer."""
        if self._wdt is not None:
            self._wdt.die()
            self._wdt = None
        return True


class HardTimer(Timer):
    """A timer whose callbacks are hard interrupts, as on the chip since MicroPython 1.26."""

    def __init__(self, chip):
        Timer.__init__(self, chip)
        self._is_hard = True


class Board:
    """One life of the chip, from boot to reset.

    chip: a `chip.Chip` that is running. lcd: the controller of the panel's display. switches: of
    the panel's keys. polled: its UART offers no receive interrupt.
    loop_us: a function that answers how long this step of the main loop takes, in microseconds.
    reset_cause: why the chip booted, see `hal`. usb: a `Usb`, the port of a PC that logs.
    """

    name = "SIMULATED"

    def __init__(self, chip, lcd, switches, store, polled=False, loop_us=None, reset_cause="",
                 usb=None):  # fmt: skip
        self.reset_cause = reset_cause
        self._usb = usb
        self._serial = None
        self.clock = chip.clock
        self.display = make_display(chip, lcd)
        self.backlight = lcd.light
        lcd.light(True)  # as every board has it at first
        self.keypad = make_keypad(chip, switches)
        self.store = store
        self.watchdog = Watchdog(chip)
        self.timer = HardTimer(chip)
        self._chip = chip
        self._polled = polled
        self._loop_us = loop_us or _usual_loop_us

    def make_link(self, baud):
        chip = self._chip
        driver_enable = Pin(chip)
        uart = UART(chip, baud)
        Transceiver(chip.wire, uart, driver_enable)
        timer = HardTimer(chip)
        interrupts = not self._polled
        fifo = (uart.fifo_holds, clear_fifo)
        return GoingOnLink(
            uart, driver_enable, timer, chip.clock, baud, interrupts=interrupts, fifo=fifo
        )

    def serial(self):
        if self._serial is None:
            self._serial = self._usb.serial()
        return self._serial

    def idle(self):
        clock = self.clock
        clock.advance_to(clock.now_us + self._loop_us())
        if self._chip.storms:
            self._chip.wait_out_storm()


def clear_fifo(uart):
    """Move what is in the FIFO to the buffer; what finds no room is lost."""
    uart.any()
    uart.drop_fifo()


def make_display(chip, lcd):
    """The driver of the display, on new pins that are wired to the controller."""
    register_select = Pin(chip)
    enable = Pin(chip)
    data = tuple(Pin(chip) for _ in range(4))
    lcd.wire(register_select, enable, data)
    return Hd44780(register_select, enable, data, chip.clock)


def make_keypad(chip, switches):
    """The driver of the keys, on new pins that are joined to the switches."""
    direct = tuple((key, Pin(chip, Pin.IN, Pin.PULL_UP)) for key in switches.direct)
    rows = tuple(Pin(chip, Pin.OPEN_DRAIN, value=1) for _ in switches.matrix)
    matrix, columns = None, ()
    if rows:
        columns = tuple(Pin(chip, Pin.IN, Pin.PULL_UP) for _ in switches.matrix[0])
        matrix = Matrix(rows, columns, switches.matrix, chip.clock)
    pins = tuple(pin for _, pin in direct)
    switches.connect(pins, rows, columns)
    masks = tuple(pin.mask for pin in pins)
    return Keypad(direct, matrix, switches.closed, reader(chip, sum(masks)), masks)


def reader(chip, mask):
    """A function that answers the levels of these pins as bits."""

    def levels():
        return chip.levels & mask

    return levels


def _usual_loop_us():
    return LOOP_US
