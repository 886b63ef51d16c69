# SPDX-License-Identifier: MIT
"""A half-duplex RS-485 link over a UART whose driver needs no pin of the program's.

Fulfils the contract `link` of `hal`. Either the UART switches the driver by itself (RS-485 mode of
an ESP32-S3), or the transceiver finds its direction. Nothing depends on the instant at which a
callback comes, so a port with soft callbacks will do.

    link = SelfDirectedLink(uart, clock, 19200, idle_us=1250, late_us=14_000)
"""

from hal.link.bursts import Bursts


def _copy(source, target, at, count):
    for index in range(count):
        target[at + index] = source[index]


class SelfDirectedLink(Bursts):
    """uart: 8E1 at `baud`, buffers of at least 256 characters, with IRQ_RXIDLE as a soft
    interrupt. idle_us, late_us: see `Bursts`.
    """

    foreseen = True

    def __init__(self, uart, clock, baud, idle_us, late_us):
        self.sent_at = 0
        # A table, because the product does not fit a small integer at every rate.
        self._durations_us = [-(-11_000_000 * count // baud) for count in range(257)]
        self._started_at_us = 0
        self._duration_us = 0
        Bursts.__init__(self, uart, clock, baud, _copy, hard=False, idle=(idle_us, late_us))

    def send(self, buffer, count):
        self._burst_ended = False
        self._duration_us = duration_us = self._durations_us[count]
        self._started_at_us = started_at_us = self._ticks_us()
        self._uart.write(buffer, count)
        # Not the sum: the clock's last tick is the largest small integer, and beyond is no memory.
        self.sent_at = (started_at_us - (self._mask - duration_us) - 1) & self._mask

    def sending_us(self, now_us):
        duration_us = self._duration_us
        if not duration_us:
            return 0
        passed_us = (now_us - self._started_at_us) & self._mask
        if passed_us > self._mask >> 1:  # `now_us` was read before the sending began
            passed_us = 0
        if passed_us < duration_us:
            return duration_us - passed_us
        if not self._uart.txdone():  # its clock is a little slower than the chip's
            return 1
        self._duration_us = 0
        return 0

    def close(self):
        self._uart.irq(handler=None, trigger=0)
        self._uart.deinit()
        self._duration_us = 0
