# SPDX-License-Identifier: MIT
"""A half-duplex RS-485 link of the RP2040: a PIO state machine sends, UART 1 receives.

Fulfils the contract `link` of `hal`. The state machine puts the characters on the line (8E1) and
switches the driver; DMA feeds it from a buffer. Once `send` has returned, nothing depends on
Python any more: neither a garbage collection nor the writing of flash moves an edge. The driver is
on 3/8 of a bit before the first start bit and off 1/8 of a bit after the last stop bit, at every
rate.

    driver_enable = Pin(6, Pin.OUT, value=0)        # low before anything else
    rx = Pin(5, Pin.IN, Pin.PULL_UP)                # it floats while the driver is on
    uart = UART(1, baud, bits=8, parity=0, stop=1, tx=Pin(4), rx=rx, rxbuf=256, txbuf=32)
    link = Rp2Link(uart, 0x40038000, 0, rp2.DMA(), Pin(4), driver_enable, clock, baud)

Runs on the chip alone; it is proven on the emulated one.
"""

from array import array

import micropython
import rp2
from micropython import const

import hal
from hal.link.bursts import Bursts

# Of the state machine. Its divider goes to 65536, so that 300 baud are possible up to a system
# clock of 314 MHz: more than either chip is made for.
_CYCLES_PER_BIT = const(16)
_LEAD_CYCLES = const(8)  # from the DMA's first word to the first start bit, at the most
_BITS_PER_CHARACTER = const(11)
_BITS_BEFORE_STOP = const(10)
SIZE_MAX = const(256)
# Of MicroPython as it comes: 8 KB, less what its functions in C keep. That of the firmware file is
# longer (STACK_MORE of tools/fetch/pico.sh), and the engine finds room wherever the program is.
_STACK_BYTES = const(7_936)
_WORDS = const(1)  # code of the DMA for transfers of 16 bits

is_frozen = ".frozen" in hal.__path__


@rp2.asm_pio(
    sideset_init=rp2.PIO.OUT_LOW,
    out_init=rp2.PIO.OUT_HIGH,
    out_shiftdir=rp2.PIO.SHIFT_RIGHT,
)
def transmitter():
    """First word: characters - 1. Then a word for each character, as `encode` makes them.

    A bit takes 16 cycles; characters follow each other without a gap, because fetching the next
    one is part of the stop bit. The DMA writes 16 bits, which the chip puts on both halves of the
    32-bit bus: `out(y, 16)` takes one of them, where `mov(y, osr)` would count far too many.
    """
    pull(block).side(0)
    out(y, 16).side(1)[3]
    label("character")
    pull(block).side(1)
    set(x, _BITS_BEFORE_STOP - 1).side(1)
    label("bit")
    out(pins, 1).side(1)[14]
    jmp(x_dec, "bit").side(1)
    out(pins, 1).side(1)[12]  # the stop bit, which lasts until the next `out`
    jmp(y_dec, "character").side(1)
    nop().side(1)[3]  # to its end, and two cycles more


@micropython.viper
def encode(buffer: ptr8, count: int, words: ptr16):
    """Put the state machine's words into `words`.

    Each word has the 11 bits of a character in the order sent: 0, 8 bits, even parity, 1. Before
    them comes how many there are.
    """
    words[0] = count - 1
    index = 0
    while index < count:
        character = buffer[index]
        parity = 0x6996 >> ((character ^ character >> 4) & 15) & 1  # of four bits, looked up
        index += 1
        words[index] = 1 << 10 | parity << 9 | character << 1


@micropython.viper
def begin(words: ptr16, count: int, channel: ptr32):
    """Start the DMA channel that brings the words of so many characters."""
    channel[14] = count + 1  # AL3_TRANS_COUNT
    channel[15] = int(words)  # AL3_READ_ADDR_TRIG: begins


@micropython.viper
def _copy(source: ptr8, target: ptr8, at: int, count: int):
    index = 0
    while index < count:
        target[at + index] = source[index]
        index += 1


class Rp2Link(Bursts):
    """uart: UART 1 as above, made before this. registers: its address, which is not the same on
    every chip. state_machine: its number, 0...7.

    dma: an rp2.DMA that the link may keep; `close` gives the channel back. tx_pin and
    driver_enable: pins, which the state machine takes over. baud: 300...187500.
    """

    foreseen = True
    if not is_frozen:
        stack_bytes = _STACK_BYTES
    defect = ""  # who makes the link looks for one: rp2_check

    def __init__(self, uart, registers, state_machine, dma, tx_pin, driver_enable, clock, baud):
        self.sent_at = 0
        self._registers = registers
        self._dma = dma
        self._tx_pin = tx_pin
        self._driver_enable = driver_enable
        self._is_driving = driver_enable.value
        self._frequency = _CYCLES_PER_BIT * baud
        # Both rounded up. 64 characters, so that the product of `send` is exact to a microsecond
        # or two and fits a small integer at every rate.
        self._lead_us = -(-_LEAD_CYCLES * 1_000_000 // self._frequency) + 1
        self._sixty_four_us = -(-64 * _BITS_PER_CHARACTER * 1_000_000 // baud)
        self._started_at_us = 0
        self._duration_us = 0
        self._words = array("H", bytes(2 * (SIZE_MAX + 1)))
        self._state_machine = rp2.StateMachine(state_machine)
        self._set_up()
        request = (state_machine >> 2) * 8 + (state_machine & 3)  # "its FIFO has room"
        control = dma.pack_ctrl(size=_WORDS, inc_read=True, inc_write=False, treq_sel=request)
        dma.config(read=self._words, write=self._state_machine, count=1, ctrl=control)
        self._channel = dma.registers
        Bursts.__init__(self, uart, clock, baud, _copy, (self._holds, self._clear))

    def send(self, buffer, count):
        if self._is_driving():  # the last telegram never ended; this does not happen on the chip
            self._dma.active(0)
            self._set_up()
        self._burst_ended = False
        words = self._words
        encode(buffer, count, words)
        duration_us = (count * self._sixty_four_us >> 6) + self._lead_us
        self._started_at_us = started_at_us = self._ticks_us()
        begin(words, count, self._channel)
        self._duration_us = duration_us
        # Not the sum: the clock's last tick is the largest small integer, and beyond is no memory.
        self.sent_at = (started_at_us - (self._mask - duration_us) - 1) & self._mask

    def sending_us(self, now_us):
        passed_us = (now_us - self._started_at_us) & self._mask
        if passed_us > self._mask >> 1:  # `now_us` was read before the sending began
            passed_us = 0
        if passed_us < self._duration_us:
            return self._duration_us - passed_us
        self._duration_us = 0  # otherwise the clock would wrap, much later, and this seem to last
        return 1 if self._is_driving() else 0

    def close(self):
        self._uart.deinit()  # first: this ends its interrupts, and nothing empties it any more
        self._driver_enable.init(self._driver_enable.OUT, value=0)
        self._tx_pin.init(self._tx_pin.IN, self._tx_pin.PULL_UP)
        self._state_machine.active(0)
        self._dma.active(0)
        self._dma.close()
        self._duration_us = 0

    def _set_up(self):
        """Put the state machine at its beginning, the driver off, its FIFO empty."""
        self._state_machine.init(
            transmitter,
            freq=self._frequency,
            sideset_base=self._driver_enable,
            out_base=self._tx_pin,
        )
        self._state_machine.active(1)

    @micropython.viper
    def _holds(self) -> bool:
        """Whether characters stand in the UART's FIFO."""
        registers = ptr32(self._registers)
        return registers[6] & 0x10 == 0  # UARTFR, RXFE: it is empty

    @micropython.viper
    def _clear(self, uart):
        """Move the characters in the UART's FIFO to its buffer; drop those that find no room."""
        registers = ptr32(self._registers)
        if registers[6] & 0x10 == 0:
            uart.any()
            while registers[6] & 0x10 == 0:
                registers[0]  # UARTDR: to read it is enough
