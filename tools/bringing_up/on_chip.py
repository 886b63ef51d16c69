# SPDX-License-Identifier: MIT
"""The checks of tools/bringup that need no line. This file is MicroPython, for an RP2040 or
RP2350; on_line.py has the others.

Each function answers its figures, and `checks.py` judges them.
"""

import gc
import os
import sys
import time

import machine
import micropython
import on_line

from chips import rp2

SDA, SCL = 0, 1
LIGHT = b"\x08"  # to a backpack: the light is on, the display is not spoken to
LCD_REGISTER_SELECT, LCD_ENABLE = 7, 8
PATIENCE_MS = 2_000

# Registers of the watchdog that live through its restart, and that nobody else uses.
HUNG_US, DROVE = rp2.WATCHDOG + 0x0C, rp2.WATCHDOG + 0x10

ticks_us, ticks_diff = time.ticks_us, time.ticks_diff


def identity():
    """What the chip and its MicroPython call themselves; system clock in MHz; bytes of heap."""
    gc.collect()
    return rp2.CHIP, os.uname().release, machine.freq() // 1_000_000, gc.mem_free()


def heap():
    """Bytes of the heap, free or not."""
    return gc.mem_free() + gc.mem_alloc()


def hang():
    """Switches the driver on, starts the watchdog and hangs until that bites: does not return."""
    micropython.kbd_intr(-1)  # or a Ctrl-C would end it
    line = on_line.Line(300)
    line.link.send(bytes(250), 250)  # so the driver is on for 9 s
    time.sleep_ms(10)
    machine.mem32[DROVE] = machine.Pin(on_line.DRIVER_JUMPER, machine.Pin.IN).value()
    watchdog = rp2.Watchdog()
    began = ticks_us()
    watchdog.feed()
    while True:
        machine.mem32[HUNG_US] = ticks_diff(ticks_us(), began)


def driver_after_bite():
    """Levels of the driver enable, by its jumper: before the watchdog bit, and at the first
    statement afterwards."""
    with open("/bringup/bitten") as file:
        return machine.mem32[DROVE], int(file.read())


def watchdog():
    """How long the chip hung before it bit, in us; why the chip restarted; and whether one that
    was stopped leaves the chip alone for 3 s."""
    hung_us, cause = machine.mem32[HUNG_US], rp2.why_it_booted()
    stopped = rp2.Watchdog()
    stopped.feed()
    stopped.stop()
    time.sleep_ms(3_000)
    return hung_us, cause, True


def saves(count):
    """The longest of so many saves of 1 KB, in ms."""
    longest = 0
    for number in range(count):
        began = time.ticks_ms()
        with open(on_line.SCRATCH, "wb") as file:
            file.write(bytes([number]) * 1024)
        longest = max(longest, time.ticks_diff(time.ticks_ms(), began))
    os.remove(on_line.SCRATCH)
    return longest


def timers(count):
    """Callbacks of 1 ms, some of them with a collection or with blanks to the USB port: how many
    came, the latest in us, whether hard."""
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
        elif turn % 8 == 4:
            sys.stdout.write(" " * 64)
        time.sleep_ms(3)
        if state[0]:
            late.append(ticks_diff(state[1], began) - 1_000)
    timer.deinit()
    return len(late), max(late, default=0), isinstance(timer, rp2.HardTimer)


def i2c(addresses, pieces):
    """How long a write to nobody takes at the most, in us; if somebody acknowledges, -1 - how many
    of so many writes failed."""
    bus = rp2.make_i2c(SDA, SCL)
    longest_us = 0
    for address in addresses:
        began = ticks_us()
        try:
            bus.writeto(address, LIGHT)
        except OSError:
            longest_us = max(longest_us, ticks_diff(ticks_us(), began))
        else:
            return -1 - _failures(bus, address, pieces)
    return longest_us


def _failures(bus, address, pieces):
    failed = 0
    for _ in range(pieces):
        try:
            bus.writeto(address, LIGHT)
        except OSError:
            failed += 1
    return failed


def show(addresses, first):
    """32 character codes from `first` on, on the display: whether its driver says all is shown."""
    clock = rp2.Clock()
    display = rp2.make_display(SDA, SCL, addresses, LCD_REGISTER_SELECT, LCD_ENABLE, clock)
    picture = bytearray(range(first, first + 32))
    began = time.ticks_ms()
    while not display.show(picture):
        if time.ticks_diff(time.ticks_ms(), began) > PATIENCE_MS:
            return False
        time.sleep_ms(1)
    return True
