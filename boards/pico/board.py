# SPDX-License-Identifier: MIT
"""The panel on a Raspberry Pi Pico: which pin is what. README.md beside it shows the wiring.

The attributes below the tables are those that `hal` asks of any board. A PIO state machine sends
to the bus and owns the driver enable; UART 1 receives. The board looks for the display: it takes a
backpack on I2C if one answers, and four data lines otherwise.

If you wire it differently, put a changed copy as board.py on the chip's file system: MicroPython
finds it there before the one that is frozen into the firmware.
"""

import os
import time

import machine
import micropython
import rp2
from machine import I2C, UART, WDT, Pin, Timer

from hal.display.probe import answers
from hal.keypad import Keypad
from hal.link.rp2_rs485 import Rp2Link
from hal.store import FileStore

# --- what is wired where: GPIO numbers ----------------------------------------------------------

BUS_SEND = 4
BUS_RECEIVE = 5
DRIVER_ENABLE = 6  # with a pull-down of 10 kohm: a driver that is on while the chip boots blocks

BACKPACK_SDA = 0
BACKPACK_SCL = 1
BACKPACK_ADDRESSES = (0x27, 0x3F)  # PCF8574 and PCF8574A, as they are sold: A0...A2 open

LCD_REGISTER_SELECT = 7  # six pins in a row: register select, enable, D4...D7; R/W to ground
LCD_ENABLE = 8

KEYS = (  # each to ground
    ("START", 13),
    ("STOP", 14),
    ("REVERSE", 15),
    ("JOG_RIGHT", 16),
    ("JOG_LEFT", 17),
    ("UP", 18),
    ("DOWN", 19),
    ("ADDRESS_UP", 20),
    ("ADDRESS_DOWN", 21),
    ("PARAM", 22),
    ("NEXT", 26),
    ("PREVIOUS", 27),
    ("EDIT", 28),
    ("SET", 2),
)
NORMALLY_CLOSED = ("STOP",)  # () for a STOP that closes: then a broken wire is not noticed

# Before anything else: nobody drives the bus.
_driver_enable = Pin(DRIVER_ENABLE, Pin.OUT, value=0)

# --- how -----------------------------------------------------------------------------------------

BUS_UART = 1
BUS_STATE_MACHINE = 0  # the first of PIO 0
LCD_STATE_MACHINE = 4  # the first of PIO 1
RECEIVE_BUFFER, SEND_BUFFER = 256, 32  # characters; nothing is sent through the UART
BACKPACK_I2C, BACKPACK_REGISTERS = 0, 0x4004_4000
BACKPACK_HZ = 100_000  # the most that a PCF8574 takes
BACKPACK_TIMEOUT_US = 5_000  # a transfer takes 1 ms; this long only when its wires are shorted
BACKPACK_CLOCKS, BACKPACK_PULSE_US = 9, 5  # a byte and its acknowledgement, at 100 kHz
WATCHDOG_MS = 2_000
SETTINGS_FILE = "settings.json"

LEVELS = 0xD000_0004  # register GPIO_IN of the SIO (RP2040 data sheet, 2.3.1.7): all pins
KEY_PINS = sum(1 << number for _, number in KEYS)

# Registers of the watchdog (RP2040 data sheet, 4.7.6). Writing to the second address clears bits.
CONTROL, CONTROL_CLEAR = 0x4005_8000, 0x4005_B000
REASON = 0x4005_8008
SCRATCH_4 = 0x4005_801C
ENABLE = 1 << 30
# What the SDK leaves in SCRATCH_4 when a watchdog is started, and 0 for a reset that is wanted.
STARTED = 0x6AB7_3121


class Clock:
    """The functions of `time` as they are: their period is 2**30 on this port."""

    ticks_mask = (1 << 30) - 1

    def __init__(self):
        self.ticks_us = time.ticks_us
        self.ticks_ms = time.ticks_ms
        self.sleep_us = time.sleep_us


class Watchdog:
    """Starts with the first feeding; unfed for WATCHDOG_MS it restarts the chip."""

    def __init__(self):
        self._wdt = None

    def feed(self):
        if self._wdt is None:
            self._wdt = WDT(timeout=WATCHDOG_MS)
        else:
            self._wdt.feed()

    def stop(self):
        """By the bit that machine.WDT does not offer. A restart after this is a wanted one."""
        machine.mem32[CONTROL_CLEAR] = ENABLE
        machine.mem32[SCRATCH_4] = 0
        self._wdt = None
        return True


class HardTimer:
    """machine.Timer with hard callbacks, which the port has from MicroPython 1.26 on."""

    ONE_SHOT = Timer.ONE_SHOT

    def __init__(self, timer):
        self._init = timer.init
        self.deinit = timer.deinit

    def init(self, mode, period, tick_hz, callback):
        self._init(mode=mode, period=period, tick_hz=tick_hz, callback=callback, hard=True)


def make_timer():
    """A timer with hard callbacks, or with soft ones where the port takes no others."""
    machine_timer = Timer()
    timer = HardTimer(machine_timer)
    try:
        timer.init(Timer.ONE_SHOT, 1_000_000, 1_000_000, print)  # a second: it never comes to that
    except TypeError:
        return machine_timer
    timer.deinit()
    return timer


def make_i2c():
    """The I2C of the backpack, after its wires were made free: a reset in the middle of a transfer
    leaves the backpack waiting for a clock, and it holds SDA low.
    """
    data = Pin(BACKPACK_SDA, Pin.IN, Pin.PULL_UP)
    pulse = Pin(BACKPACK_SCL, Pin.OPEN_DRAIN, Pin.PULL_UP, value=1)
    for _ in range(BACKPACK_CLOCKS):
        time.sleep_us(BACKPACK_PULSE_US)
        if data.value():
            break
        pulse.value(0)
        time.sleep_us(BACKPACK_PULSE_US)
        pulse.value(1)
    return I2C(BACKPACK_I2C, sda=data, scl=pulse, freq=BACKPACK_HZ, timeout=BACKPACK_TIMEOUT_US)


def make_posted_i2c():
    from hal.display.rp2_i2c import PostedI2C

    return PostedI2C(make_i2c(), BACKPACK_REGISTERS, machine.mem32, clock)


def make_display():
    """The backpack that answers; the display on four data lines when none does. The driver that is
    not needed takes no memory."""
    i2c = make_i2c()
    for address in BACKPACK_ADDRESSES:
        if answers(i2c, address):
            from hal.display.backpack import Backpack

            return Backpack(make_posted_i2c, address, clock)
    from hal.display.rp2_hd44780 import PioHd44780

    return PioHd44780(LCD_STATE_MACHINE, Pin(LCD_REGISTER_SELECT), Pin(LCD_ENABLE), clock)


def make_keypad():
    pins = tuple((key, Pin(number, Pin.IN, Pin.PULL_UP)) for key, number in KEYS)
    masks = tuple(1 << number for _, number in KEYS)
    return Keypad(pins, closed=NORMALLY_CLOSED, levels=key_levels, masks=masks)


def key_levels():
    """The levels of all pins of keys, as bits."""
    return machine.mem32[LEVELS] & KEY_PINS


def make_link(baud):
    send = Pin(BUS_SEND)
    # The transceiver lets go of this wire while the driver is on.
    receive = Pin(BUS_RECEIVE, Pin.IN, Pin.PULL_UP)
    uart = UART(
        BUS_UART,
        baud,
        bits=8,
        parity=0,  # even
        stop=1,
        tx=send,
        rx=receive,
        rxbuf=RECEIVE_BUFFER,
        txbuf=SEND_BUFFER,
    )
    return Rp2Link(uart, BUS_STATE_MACHINE, rp2.DMA(), send, _driver_enable, clock, baud)


def why_it_booted():
    """Either "WATCHDOG", or "" for power-on, the RUN pin and machine.reset()."""
    bitten = machine.mem32[REASON] and machine.mem32[SCRATCH_4] == STARTED
    return "WATCHDOG" if bitten else ""


def idle():
    """The processor sleeps for 1 ms at most; interrupts are served in it."""
    time.sleep_ms(1)


micropython.alloc_emergency_exception_buf(100)

name = "RASPBERRY PICO"
reset_cause = why_it_booted()
clock = Clock()
display = make_display()
keypad = make_keypad()
store = FileStore(SETTINGS_FILE, open, os)
watchdog = Watchdog()
timer = make_timer()
