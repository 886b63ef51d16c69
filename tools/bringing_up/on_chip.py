# SPDX-License-Identifier: MIT
"""The checks of tools/bringup inside the chip, an RP2040 or RP2350. This file is MicroPython.

tools/bringup sends it over the serial line, with `chips` and `hal` of the tree beside it. Each
function prints nothing and answers its figures; `checks.py` judges them. GP4 is joined to GP5.
"""

import gc
import os
import time

import machine

from chips import rp2

SEND, RECEIVE, DRIVER_ENABLE = 4, 5, 6
SDA, SCL = 0, 1
BURSTS = (16, 24, 25, 32, 64, 200)
MARGIN_US = 3_000
UART_ERRORS = 4  # offset of UARTRSR: the errors of the character that was read last
SCRATCH = "bringup.tmp"

ticks_us, ticks_diff = time.ticks_us, time.ticks_diff


class Line:
    """The link at a rate, and when its interrupt came."""

    def __init__(self, baud):
        self.baud = baud
        self.came_at = 0
        self.came = 0
        driver = rp2.low(DRIVER_ENABLE)
        self.link = rp2.make_link(SEND, RECEIVE, driver, rp2.Clock(), baud)
        self.heard = bytearray(300)
        self.link.on_activity = self.note

    def note(self):
        self.came_at = ticks_us()
        self.came += 1

    def send(self, data):
        """How many characters came back, whether they are these, and how long after the last stop
        bit the interrupt came, in us; -1: it did not come."""
        self.came = 0
        self.link.send(data, len(data))
        wait_us = self.link.sending_us(ticks_us()) + 80_000_000 // self.baud + MARGIN_US
        time.sleep_us(wait_us)
        late_us = ticks_diff(self.came_at, self.link.sent_at) if self.came else -1
        count = max(self.link.receive(self.heard, 0), 0)
        return count, self.heard[:count] == data, late_us


def identity():
    """What the chip and its MicroPython call themselves; system clock in MHz; bytes of heap."""
    gc.collect()
    return rp2.CHIP, os.uname().release, machine.freq() // 1_000_000, gc.mem_free()


def driver_is_low():
    """The level of the driver enable, before anything has touched it, and why the chip booted."""
    return machine.mem32[rp2.GPIO_IN] >> DRIVER_ENABLE & 1, rp2.why_it_booted()


def bursts(baud):
    """For each burst: characters sent, those that came back, whether right, interrupt after us."""
    line = Line(baud)
    try:
        return [(count,) + line.send(bytes(range(count))) for count in BURSTS]
    finally:
        line.link.close()


def codes():
    """All 256 characters at 115200: how many came back, whether right, error bits of the UART."""
    line = Line(115_200)
    came, right, errors = 0, True, 0
    try:
        for first in range(0, 256, 32):
            count, same, _ = line.send(bytes(range(first, first + 32)))
            came += count
            right = right and same
            errors |= machine.mem32[rp2.UART_REGISTERS + UART_ERRORS] & 15
        return came, right, errors
    finally:
        line.link.close()


def unread():
    """400 characters that nobody reads; then 16 more: how many of these came, whether right."""
    line = Line(115_200)
    try:
        for _ in range(2):
            line.link.send(bytes(200), 200)
            time.sleep_ms(25)
        while line.link.receive(line.heard, 0) > 0:
            pass
        return line.send(bytes(range(16)))[:2]
    finally:
        line.link.close()


def saves(count):
    """The longest of so many saves of 1 KB, in ms."""
    longest = 0
    for number in range(count):
        began = time.ticks_ms()
        with open(SCRATCH, "wb") as file:
            file.write(bytes([number]) * 1024)
        longest = max(longest, time.ticks_diff(time.ticks_ms(), began))
    os.remove(SCRATCH)
    return longest


def timers(count):
    """Callbacks of 1 ms under collections: how many came, the latest in us, whether hard."""
    timer = rp2.make_timer()
    late = []
    state = [0, 0]

    def come(_timer):
        state[0] += 1
        state[1] = ticks_us()

    for turn in range(count):
        state[0] = 0
        began = ticks_us()
        timer.init(mode=timer.ONE_SHOT, period=1_000, tick_hz=1_000_000, callback=come)
        if turn % 8 == 0:
            gc.collect()
        time.sleep_ms(3)
        if state[0]:
            late.append(ticks_diff(state[1], began) - 1_000)
    timer.deinit()
    return len(late), max(late), isinstance(timer, rp2.HardTimer)


def i2c_absent():
    """How long a write to nobody takes, in us; -1: somebody acknowledges."""
    i2c = rp2.make_i2c(SDA, SCL)
    began = ticks_us()
    try:
        i2c.writeto(0x27, b"\x08")
    except OSError:
        return ticks_diff(ticks_us(), began)
    return -1


def watchdog_stops():
    """Whether a watchdog of 2 s that was stopped leaves the chip alone for 3 s."""
    watchdog = rp2.Watchdog()
    watchdog.feed()
    watchdog.stop()
    time.sleep_ms(3_000)
    return True


def watchdog_bites():
    """Starts it, and does not come back."""
    rp2.Watchdog().feed()
    while True:
        pass
