# SPDX-License-Identifier: MIT
"""machine.UART of the ports: that of the ESP32 with its late IRQ_RXIDLE; the RP2040's has limits.

On the ESP32 each character goes into the driver's buffer at once, and looking at it changes
nothing. IRQ_RXIDLE comes from a timer of two characters (of 12 bits), 500 us at least, that the
first character of a burst starts: at its second tick after the last one (machine_uart.c,
uart_timer_callback).
"""

from boards.sim.chip import machine as sim
from boards.sim.ports.chips import CHIPS

RXIDLE = 0x1000
RX = 0x02
BREAK = 0x20
IDLE_BITS, IDLE_MIN_US = 24, 500
FIFO = 128
# UART 1 of the ESP32-S3: UART_RS485_CONF_REG (ESP-IDF, components/soc/esp32s3: uart_reg.h). It is
# cleared when the UART is made: uart_hal_init() sets the mode of a plain UART.
RS485_CONF = {(CHIPS["ESP32S3"].machine, 1): 0x6001_0000 + 0x4C}
RP2_UART_PINS = {0: (0, 12, 16, 28), 1: (4, 8, 20, 24)}  # of TX; RX is the next one


def make(port, number, baud, options, pins):
    if port.model.port == "esp32":
        if options.get("rxbuf", 256) <= FIFO:
            port.refuse("uart buffer", options["rxbuf"])
        return SoftUart(port, number, baud)
    for pin, first in zip(pins, (0, 1)):
        if pin - first not in RP2_UART_PINS.get(number, ()):
            port.refuse("uart pin", pin)
    return CheckedUart(port, baud)


class CheckedUart(sim.UART):
    """That of the RP2040."""

    def __init__(self, port, baud):
        self._port = port
        sim.UART.__init__(self, port.chip, baud)

    def irq(self, handler=None, trigger=0, hard=False):
        check_irq(self._port, handler, trigger, self.IRQ_RXIDLE)
        sim.UART.irq(self, handler, trigger, hard)


def check_irq(port, handler, trigger, known):
    if handler is not None and not callable(handler):
        port.refuse("uart handler")
    if trigger & ~known:
        port.refuse("uart trigger", trigger & ~known)


class SoftUart(sim.UART):
    """on_send(): called before it sends; None: nobody wants to know."""

    IRQ_RXIDLE = RXIDLE
    IRQ_RX = RX
    IRQ_BREAK = BREAK

    def __init__(self, port, number, baud):
        self.on_send = None
        self._port = port
        self._number = number
        self._idle_tick_us = max(-(-IDLE_BITS * 1_000_000 // baud), IDLE_MIN_US)
        self._burst_began_us = None
        port.mem32.levels.pop(RS485_CONF.get((port.model.machine, number)), 0)
        sim.UART.__init__(self, port.chip, baud)

    def irq(self, handler=None, trigger=0, hard=False):
        if self._number == 0 and self._port.model.machine.endswith("with ESP32"):
            self._port.refuse("uart of the prompt", 0)
        check_irq(self._port, handler, trigger, RXIDLE | RX | BREAK)
        if hard:
            self._port.refuse("uart hard")
        self._interrupt.handler = handler if trigger else None
        self._interrupt.hard = False

    def write(self, data, n=None):
        if self.on_send is not None:
            self.on_send()
        return sim.UART.write(self, data, n)

    def receive(self, data, first, stop):
        if self._burst_began_us is None:
            self._burst_began_us = self._clock.now_us
        sim.UART.receive(self, data, first, stop)
        self._in_fifo = 0

    def quiet_since(self, at_us):
        """The last character ended at `at_us`: the second tick from there on counts."""
        began_us = self._burst_began_us
        if began_us is None:
            return
        tick_us = self._idle_tick_us
        ticks = max(at_us - began_us, 0) // tick_us + 2
        self._clock.schedule(self._timeout, began_us + ticks * tick_us)

    def _timed_out(self):
        if self.line is not None and self.line.receiving():
            return  # another burst has begun: its end counts
        self._burst_began_us = None
        self._chip.interrupt(self._interrupt)

    def _is_due(self):
        return True
