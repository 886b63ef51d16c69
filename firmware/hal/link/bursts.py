# SPDX-License-Identifier: MIT
"""The receiving half of a link: what a UART hears, burst by burst.

`rp2_rs485`, `rs485` and `self_directed` add the half that sends. A burst is over when the line has
been silent for 32 bits; then the UART interrupts (IRQ_RXIDLE, receive time-out of a PL011).
MicroPython's handler on the RP2040 moves characters from the UART's FIFO of 32 to a buffer of 256,
and leaves one in the FIFO so that the time-out will come. This has two consequences:

* A look (`any`) in the middle of a burst empties the FIFO and uses the time-out up. So the link
  does not look while characters stand in the FIFO, except after HALF_FULL characters: a time-out
  may have got lost, and with it the announcement of its burst.
* While the buffer is full, the FIFO cannot be emptied. If the time-out then comes again as soon as
  it is acknowledged (the documents leave that open), the chip never leaves its handler. So the
  link drops characters that find no room at once: no telegram is that long.
"""

from micropython import const

IDLE_BITS = const(32)
POLLED_RESOLUTION_US = const(5_000)  # how late a link without interrupts may be looked at
BUFFER = const(256)  # characters: as many as the longest telegram has
HALF_FULL = const(128)
_BITS_PER_CHARACTER = const(11)
_COMING = const(-1)  # `receive` answers so while characters come in, to be announced at their end


def _nobody():
    """What the link calls until `on_activity` is set."""


class Bursts:
    """uart: 8E1 at `baud`, with a receive buffer of BUFFER. interrupts: it has IRQ_RXIDLE; hard:
    as a hard interrupt.

    copy(source, target, at, count): for a burst that is taken in pieces. fifo: two functions, if a
    program can look into the UART's FIFO: holds(), whether characters stand in it; clear(uart),
    which moves them to the buffer, drops those that find no room, and does not jump (see
    `_on_idle`). None: each look takes the characters that there are.

    idle: None for a PL011, or how long after the last character IRQ_RXIDLE comes at the least, and
    how much later than twice that at the most; in microseconds.
    """

    def __init__(self, uart, clock, baud, copy, fifo=None, interrupts=True, hard=True, idle=None):
        self.on_activity = _nobody
        self.clock = clock
        self.interrupts = interrupts
        self.received_at = 0
        self._idle_us = IDLE_BITS * 1_000_000 // baud
        self.resolution_us = self._idle_us if interrupts else POLLED_RESOLUTION_US
        if idle is not None:
            self._idle_us, late_us = idle
            self.resolution_us = self._idle_us + late_us
        self._uart = uart
        self._ticks_us = clock.ticks_us
        self._mask = clock.ticks_mask
        self._copy = copy
        self._fifo_holds, self._clear_fifo = (fifo if interrupts else None) or (None, _leave)
        self._scratch = bytearray(BUFFER)
        self._burst_ended = False
        self._burst_ended_at_us = 0
        self._coming = False  # characters stood in the FIFO at the last look
        self._coming_since_us = 0
        self._half_full_us = HALF_FULL * _BITS_PER_CHARACTER * 1_000_000 // baud
        if interrupts:
            uart.irq(handler=self._on_idle, trigger=uart.IRQ_RXIDLE, hard=hard)

    def receive(self, buffer, at):
        uart = self._uart
        ended = self._burst_ended
        if ended:
            self._burst_ended = self._coming = False
        elif self._is_coming():
            return _COMING
        count = uart.any()
        if not count:
            return 0
        if at:
            count = min(count, len(buffer) - at, BUFFER)
            if count:
                uart.readinto(self._scratch, count)
                self._copy(self._scratch, buffer, at, count)
        else:
            count = uart.readinto(buffer, count)  # as far as there is room
        self.received_at = self._burst_ended_at_us if ended else self._ticks_us()
        return count

    def _is_coming(self):
        """Whether a burst is coming in whose end on_activity will announce."""
        if self._fifo_holds is None or not self._fifo_holds():
            self._coming = False
            return False
        now_us = self._ticks_us()
        if not self._coming:
            self._coming = True
            self._coming_since_us = now_us
        elif (now_us - self._coming_since_us) & self._mask >= self._half_full_us:
            self._coming = False
        return self._coming

    def _on_idle(self, _uart):
        # No jump in here: a pending Ctrl-C would be raised at it and end this handler for good.
        self._burst_ended_at_us = (self._ticks_us() - self._idle_us) & self._mask
        self._burst_ended = True
        self.on_activity()
        self._clear_fifo(self._uart)  # after the engine, which may have sent by now


def _leave(_uart):
    """The `clear` of a FIFO that a program cannot look into."""
