"""The virtual board: the attributes that `hal` asks of any board, on a simulated chip.

Display, keypad and store are things of the panel that outlive a restart of the chip; the board
itself is made anew by every restart, as on the chip.
"""

from boards.sim.chip import UART, WDT, Pin, Timer
from boards.sim.wire import Transceiver
from hal.rs485 import Rs485Link

KEYS = ("START", "STOP", "UP", "DOWN", "ADDRESS_UP", "ADDRESS_DOWN")

LOOP_US = 2_000  # what a step of the main loop takes at the most on the chip
WATCHDOG_MS = 2_000


class Display:
    """A display of 2 x 16 characters that takes a few of them at a time.

    While it writes, time passes and interrupts come, as on the chip.
    """

    rows = 2
    columns = 16
    cells_max = 8  # written by one call of show
    cell_us = 100  # a character over the 4-bit bus, with its share of cursor moves

    def __init__(self, clock):
        self._clock = clock
        self._shown = bytearray(b" " * (self.rows * self.columns))

    def show(self, picture):
        shown = self._shown
        if shown == picture:
            return True
        written = 0
        for index in range(len(shown)):
            if shown[index] != picture[index]:
                shown[index] = picture[index]
                written += 1
                if written == self.cells_max:
                    break
        self._clock.advance(written * self.cell_us)
        return shown == picture

    def text(self):
        """Both rows, as a person reads them."""
        text = "".join(chr(code) for code in self._shown)
        return text[: self.columns], text[self.columns :]


class Keypad:
    """Keys that a hand, a script or a test holds down."""

    def __init__(self, names=KEYS):
        self.names = names
        self._down = 0

    def read(self):
        return self._down

    def hold(self, key):
        self._down |= 1 << self._position(key)

    def let_go(self, key):
        self._down &= ~(1 << self._position(key))

    def _position(self, key):
        if key not in self.names:
            raise ValueError("no key %s: there are %s" % (key, " ".join(self.names)))
        return self.names.index(key)


class Store:
    """A small file that outlives the chip's restarts."""

    def __init__(self, data=None):
        self._data = data

    def read(self):
        return self._data

    def replace(self, data):
        self._data = bytes(data)


class Watchdog:
    """Starts with the first feeding; unfed for WATCHDOG_MS it restarts the chip."""

    def __init__(self, chip):
        self._chip = chip
        self._wdt = None

    def feed(self):
        if self._wdt is None:
            self._wdt = WDT(self._chip, WATCHDOG_MS)
        else:
            self._wdt.feed()


class HardTimer(Timer):
    """A timer whose callbacks are hard interrupts, as the chip has them from 1.26 on."""

    def init(self, *, mode, period, tick_hz, callback):
        Timer.init(self, mode=mode, period=period, tick_hz=tick_hz, callback=callback, hard=True)


class Board:
    """One life of the chip, from boot to reset.

    chip: a `chip.Chip` that is running. polled: its UART offers no receive interrupt.
    loop_us: a function that answers how long this step of the main loop takes, in microseconds.
    """

    name = "SIMULATED"

    def __init__(self, chip, display, keypad, store, polled=False, loop_us=None):
        self.clock = chip.clock
        self.display = display
        self.keypad = keypad
        self.store = store
        self.watchdog = Watchdog(chip)
        self.timer = HardTimer(chip)
        self.disable_irq = chip.disable_irq
        self.enable_irq = chip.enable_irq
        self._chip = chip
        self._polled = polled
        self._loop_us = loop_us or _usual_loop_us

    def make_link(self, baud):
        chip = self._chip
        driver_enable = Pin(chip)
        uart = UART(chip, baud)
        Transceiver(chip.wire, uart, driver_enable)
        timer = HardTimer(chip)
        return Rs485Link(
            uart, driver_enable, timer, chip.clock, baud, interrupts=not self._polled
        )

    def idle(self):
        self.clock.advance(self._loop_us())


def _usual_loop_us():
    return LOOP_US
