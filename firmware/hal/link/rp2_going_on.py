# SPDX-License-Identifier: MIT
"""A half-duplex RS-485 link of the RP2040 that goes on by itself: at the very beginning of the
interrupt that reports a reply it looks at that reply, and begins to send the next telegram.

Fulfils the contract `link` of `hal`, with the part that is optional. It takes memory: boards have
it only where the firmware is frozen. Runs on the chip alone; it is proven on the emulated one.
"""

from array import array

import micropython
from micropython import const

from hal.link.rp2_rs485 import SIZE_MAX, Rp2Link, begin, encode

# What the interrupt needs at once, in one array: to find a field takes 4 us.
_EXPECTED = const(0)  # characters of the reply after which the telegram is to go out; 0: none
_TAKEN = const(1)  # characters of a reply that stand where they belong already
_WENT_ON = const(2)  # the telegram is on its way
_EARLIEST_US = const(3)  # before that the reply cannot be over
_COUNT = const(4)  # of the telegram, in characters
_DURATION_US = const(5)  # of the telegram
_IDLE_US = const(6)
_MASK = const(7)
_FIGURES = const(8)
_REQUEST = const(9)  # of what else it needs


class Rp2GoingOnLink(Rp2Link):
    """Arguments: those of `Rp2Link`."""

    goes_on = True

    def __init__(self, uart, registers, state_machine, dma, tx_pin, driver_enable, clock, baud):
        self._figures = array("i", bytes(4 * _FIGURES))
        self._figures[_MASK] = clock.ticks_mask
        # What else it needs; an element of a list is found faster.
        self._hands = [clock.ticks_us]
        Rp2Link.__init__(
            self, uart, registers, state_machine, dma, tx_pin, driver_enable, clock, baud
        )
        self._figures[_IDLE_US] = self._idle_us
        self._next_words = array("H", bytes(2 * (SIZE_MAX + 1)))
        # An interrupt exchanges the two. If garbage is just being collected, the collector may
        # find one of them twice and the other never: so both have a name that never changes.
        self._kept = (self._words, self._next_words)

    def instruct(self, buffer, says_nothing_new, plan, attention):
        uart = self._uart
        self._hands = [
            self._ticks_us, uart.any, uart.readinto, buffer, says_nothing_new, self._registers,
            plan, attention, self._channel, None,
        ]  # fmt: skip

    def prepare(self, request, size, buffer, count, after_us):
        figures = self._figures
        figures[_EXPECTED] = 0
        self._hands[_REQUEST] = request
        figures[_COUNT] = count
        figures[_DURATION_US] = (count * self._sixty_four_us >> 6) + self._lead_us
        # Not the sum, as in `send`.
        figures[_EARLIEST_US] = (self.sent_at - (self._mask - after_us) - 1) & self._mask
        encode(buffer, count, self._next_words)
        figures[_EXPECTED] = size  # at last: from here on the interrupt may come

    def take_back(self):
        self._figures[_EXPECTED] = 0

    def follow(self):
        figures = self._figures
        if not figures[_WENT_ON]:
            return False
        figures[_WENT_ON] = 0
        self._hand_over()
        return True

    def receive(self, buffer, at):
        if not self._figures[_TAKEN]:
            return Rp2Link.receive(self, buffer, at)
        return self._hand_over()

    def _hand_over(self):
        """The reply that the interrupt has taken is the caller's."""
        figures = self._figures
        count = figures[_TAKEN]
        figures[_TAKEN] = 0
        self._burst_ended = self._coming = False
        self.received_at = self._burst_ended_at_us
        return count

    def close(self):
        self.take_back()
        Rp2Link.close(self)

    # Machine code has no jump that raises a pending Ctrl-C: see `Bursts`.
    @micropython.viper
    def _on_idle(self, uart):
        """Take the reply, if it is as long as expected; go on if all is as it was to be."""
        figures = ptr32(self._figures)
        hands = self._hands
        ended_us = (int(hands[0]()) - figures[6]) & figures[7]
        size = figures[0]
        if size != 0:
            figures[0] = 0
            if int(hands[1]()) == size:
                reply = hands[3]
                hands[2](reply, size)
                figures[1] = size
                half = figures[7] >> 1
                registers = ptr32(hands[5])
                if (ended_us - figures[3]) & figures[7] <= half and hands[4](
                    reply, size, hands[9], hands[6], hands[7]
                ):
                    if registers[6] & 0x10 != 0:  # UARTFR, RXFE: else somebody goes on talking
                        words = self._next_words
                        begin(words, figures[4], hands[8])
                        now_us = int(hands[0]())
                        self._next_words = self._words
                        self._words = words
                        self._started_at_us = now_us
                        self._duration_us = figures[5]
                        self.sent_at = (now_us + figures[5]) & figures[7]
                        figures[2] = 1
        self._burst_ended_at_us = ended_us
        self._burst_ended = True
        self.on_activity()
        self._clear_fifo(uart)
