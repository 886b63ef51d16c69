# SPDX-License-Identifier: MIT
"""A half-duplex RS-485 link over a UART, a driver-enable pin and a one-shot timer.

Fulfils the contract `link` of `hal`. The timer ends the transmission: it fires when the last stop
bit should have left, looks whether it has, and drops the driver enable. That is exact if timer
callbacks run at once (the simulated chip, hard timers). A port whose timers wait for the garbage
collector cannot promise it; use a transceiver with automatic direction there.

The pin must be low before the UART is made: a driver that is on while the chip boots blocks the
line.
"""

from micropython import const

from hal.link.bursts import Bursts

RELEASES_MAX = const(16)  # looks at the transmitter, a quarter of a character apart


def _copy(source, target, at, count):
    for index in range(count):
        target[at + index] = source[index]


class Rs485Link(Bursts):
    """uart: 8E1 at `baud`, buffers of at least 256 characters. driver_enable: a Pin, 1 sends.

    timer: for the driver enable only. interrupts: False if the UART has none. hard: False if the
    port has only soft interrupts (ESP32). fifo, idle: as in `Bursts`.
    """

    def __init__(
        self,
        uart,
        driver_enable,
        timer,
        clock,
        baud,
        interrupts=True,
        hard=True,
        fifo=None,
        idle=None,
    ):
        self.sent_at = 0
        self.late_releases = 0  # transmissions that did not end when they should have
        self._driver_enable = driver_enable
        self._timer = timer
        # A table, because the product does not fit a small integer at every rate.
        self._durations_us = [-(-11_000_000 * count // baud) for count in range(257)]
        self._sending = False
        self._started_at_us = 0
        self._duration_us = 0
        self._releases = 0
        self._on_timer = self._release  # bound once: binding allocates
        driver_enable.value(0)
        Bursts.__init__(self, uart, clock, baud, _copy, fifo, interrupts, hard, idle)

    def send(self, buffer, count):
        self._sending = True
        self._burst_ended = False
        self._releases = 0
        self._duration_us = self._durations_us[count]
        self._driver_enable.value(1)
        self._started_at_us = self._ticks_us()
        self._uart.write(buffer, count)
        self._arm(self._duration_us)

    def sending_us(self, now_us):
        if not self._sending:
            return 0
        passed_us = (now_us - self._started_at_us) & self._mask
        if passed_us > self._mask >> 1:  # `now_us` was read before the sending began
            passed_us = 0
        return max(self._duration_us - passed_us, 1)

    def close(self):
        self._timer.deinit()
        if self.interrupts:
            self._uart.irq(handler=None, trigger=0)
        self._driver_enable.value(0)
        self._sending = False
        self._uart.deinit()

    def _release(self, _timer):
        if not self._uart.txdone() and self._releases < RELEASES_MAX:
            # The UART's clock is a little slower than the timer's: look again in a moment.
            self._releases += 1
            self._arm(self._durations_us[1] // 4 + 1)
            return
        self._driver_enable.value(0)
        self.sent_at = self._ticks_us()
        if self._releases == RELEASES_MAX:
            self.late_releases = (self.late_releases + 1) & 0xFFFF
        self._sending = False
        self.on_activity()

    def _arm(self, after_us):
        timer = self._timer
        timer.init(
            mode=timer.ONE_SHOT, period=after_us, tick_hz=1_000_000, callback=self._on_timer
        )
