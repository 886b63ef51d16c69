# SPDX-License-Identifier: MIT
"""The world of `boards.sim` around a real board file, on the machine of its port.

    world = PortWorld(main.start, "boards/esp32s3/board.py", addresses=(1, 2, 3))
    world.run(1000)
    world.freeze(3_000)                 # the interpreter hangs in C: no callback runs either

The board file and what it takes from `chips` are those that run on the chip. Its wires are looked
up in its tables: DRIVER_ENABLE, KEYS, ROWS, COLUMNS. Callbacks are soft and late, and every now
and then a collection holds everything up (soft.py). Only the settings lie in the simulated flash.
"""

from boards.sim.chip.backpack import Backpack
from boards.sim.chip.machine import WDT
from boards.sim.clock import Event
from boards.sim.line.wire import Transceiver
from boards.sim.ports.chips import CHIPS
from boards.sim.ports.esp32_uart import RS485_CONF
from boards.sim.ports.loading import chip_of, load
from boards.sim.ports.machine import Port
from boards.sim.ports.soft import COLLECTION_EVERY_US, COLLECTION_US, SoftChip
from boards.sim.world import World

FREEZE_SLICE_US = 1_000


class Wire:
    """The driver enable of the transceiver: it follows a pin, the UART, or both in turn."""

    def __init__(self):
        self.on_change = None
        self._level = 0

    def value(self):
        return self._level

    def put(self, level):
        if level != self._level:
            self._level = level
            if self.on_change is not None:
                self.on_change(level)


class PortWorld(World):
    """path: of a board file. The others are those of `World`.

    port, board     of the present life of the chip
    collection_us   how long one takes
    """

    def __init__(self, start, path, **options):
        self._path = path
        self._model = CHIPS[chip_of(path)]
        self.backpack = None
        self.port = None
        self.board = None
        self._next_collection_us = COLLECTION_EVERY_US
        self.collection_us = COLLECTION_US
        options.setdefault("keys", "matrix" if "MATRIX" in open(path).read() else "direct")
        World.__init__(self, start, **options)

    def make_chip(self):
        return SoftChip(self.clock, self.wire, self.random if self.seed else None)

    def make_board(self, loop_us, cause):
        if self.backpack is None:
            self.backpack = Backpack(self.clock, self.lcd_chip)
        self.backpack.join()  # a chip that restarts lets go of its own wires, not of these
        port = self.port = Port(self._model, self.chip)
        port.backpack = self.backpack
        port.reset_word = port.WDT_RESET if cause else port.PWRON_RESET
        self._step_us = loop_us
        port.sleep_loop = self._sleep
        port.make_uart_line = self._wire_uart
        board = self.board = load(self._path, port)
        board.store = self.store
        pins = [port.pins[number] for _, number in board.KEYS]
        rows = [port.pins[number] for number in getattr(board, "ROWS", ())]
        columns = [port.pins[number] for number in getattr(board, "COLUMNS", ())]
        self.keypad.connect(pins, rows, columns)
        return board

    def freeze(self, ms):
        """Let so many milliseconds pass in which nothing of the interpreter runs."""
        until_us = self.clock.now_us + ms * 1000
        self.chip.hold()
        while self.clock.now_us < until_us:
            self.clock.advance(min(FREEZE_SLICE_US, until_us - self.clock.now_us))
            if self._bitten:
                self.reset()
                self.run(max(0, until_us - self.clock.now_us) // 1000)
                return
        self.chip.let_go()

    def watchdog_ms(self):
        """The time of the watchdog that runs, None if none does."""
        times_ms = [one.timeout_ms for one in self.chip.peripherals if isinstance(one, WDT)]
        return times_ms[-1] if times_ms else None

    def _sleep(self):
        clock = self.clock
        clock.advance(self._step_us())
        if clock.now_us >= self._next_collection_us and not self._bitten:
            self._next_collection_us = clock.now_us + COLLECTION_EVERY_US
            self.chip.hold()
            clock.advance(self.collection_us)
            self.chip.let_go()

    def _wire_uart(self, uart):
        """Join the UART to the line by a transceiver; its driver enable is as the board has it."""
        enable = Wire()
        number = self.board.DRIVER_ENABLE
        if number is not None:
            self.port.pins[number].on_change = lambda level: self._by_pin(enable, number, level)
        uart.on_send = lambda: self._by_uart(uart, enable, number)
        Transceiver(self.wire, uart, enable)

    def _by_pin(self, enable, number, level):
        if not self._uart_drives(number):
            enable.put(level)

    def _by_uart(self, uart, enable, number):
        """The UART, or the transceiver, switches the driver on for as long as it sends."""
        if number is not None and not self._uart_drives(number):
            return
        enable.put(1)
        done = Event(lambda: self._sent(uart, enable, done))
        self.clock.schedule(done, self.clock.now_us)

    def _sent(self, uart, enable, done):
        if uart.txdone():
            enable.put(0)
        else:
            self.clock.schedule(done, uart._sent_us)

    def _uart_drives(self, number):
        """Whether the registers say that the UART's DTR drives this pin while it sends."""
        for register, value, matrix, signal in DTR.get(self._model.machine, ()):
            levels = self.port.mem32.levels
            if levels.get(register, 0) & value and levels.get(matrix + 4 * number) == signal:
                return True
        return False


# UART 1 of the ESP32-S3: its RS-485 register, the bit that turns it on; the GPIO matrix, and the
# signal U1DTR (ESP-IDF, components/soc/esp32s3: uart_reg.h, gpio_reg.h, gpio_sig_map.h).
DTR = {
    machine: ((register, 1, 0x6000_4000 + 0x554, 17),)
    for (machine, _), register in RS485_CONF.items()
}
