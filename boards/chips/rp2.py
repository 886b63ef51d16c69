# SPDX-License-Identifier: MIT
"""What every board with an RP2040 or RP2350 needs: clock, watchdog, timer, bus, display, keys.

A board file says which pin is what and asks here for the rest. A driver is handed objects of the
chip; this is the only place that makes them. Names and numbers of registers: the data sheets of
RP2040 and RP2350; where only one place is named, both chips have it there.
"""

import sys

# Before anything else is asked of the chip: on another one, not even the next imports would work.
ADDRESSES = {  # where the chips differ: watchdog, UART 1, I2C 0 (RP2040 2.2, RP2350 2.2)
    "RP2040": (0x4005_8000, 0x4003_8000, 0x4004_4000),
    "RP2350": (0x400D_8000, 0x4007_8000, 0x4009_0000),
}
CHIP = sys.implementation._machine.rpartition(" with ")[2]
if CHIP not in ADDRESSES:
    raise ValueError("this firmware knows %s, no %s" % (" and ".join(sorted(ADDRESSES)), CHIP))

import os
import time

import machine
import micropython
import rp2
from machine import I2C, UART, WDT, Pin, Timer

from hal.display.probe import answers, free
from hal.keypad import Keypad
from hal.link.rp2_rs485 import Rp2Link, is_frozen

if is_frozen:  # only then is there memory for it
    from hal.link.rp2_going_on import Rp2GoingOnLink as Rp2Link
from hal.store import FileStore

# --- which part of the chip does what ------------------------------------------------------------

BUS_UART = 1  # the one that `Rp2Link` knows
# Both of PIO 0, whose 32 instructions hold both programs: the radio of a Pico W takes a machine of
# the last PIO, and no program can have that one afterwards (pico-sdk, cyw43_bus_pio_spi.c).
BUS_STATE_MACHINE, LCD_STATE_MACHINE = 0, 1
RECEIVE_BUFFER, SEND_BUFFER = 256, 32  # characters; nothing is sent through the UART
BACKPACK_I2C = 0
BACKPACK_HZ = 100_000  # the most that a PCF8574 takes
BACKPACK_TIMEOUT_US = 5_000  # a transfer takes 1 ms; this long only when its wires are shorted
WATCHDOG_MS = 2_000
SETTINGS_FILE = "settings.json"

# --- registers -----------------------------------------------------------------------------------

GPIO_IN = 0xD000_0004  # the levels of all pins (SIO, RP2040 2.3.1.7)
WATCHDOG, UART_REGISTERS, I2C_REGISTERS = ADDRESSES[CHIP]

# The watchdog (RP2040 4.7.6). Writing to the second address clears bits.
WATCHDOG_CONTROL, WATCHDOG_CONTROL_CLEAR = WATCHDOG, WATCHDOG + 0x3000
WATCHDOG_ENABLE = 1 << 30
WATCHDOG_REASON = WATCHDOG + 0x08
WATCHDOG_SCRATCH_4 = WATCHDOG + 0x1C
# What the SDK leaves in SCRATCH_4 when a watchdog is started, and 0 for a reset that is wanted.
STARTED = 0x6AB7_3121


# The buffer of endpoint 2 IN, by which MicroPython sends to the PC (RP2040 4.1.2.5).
USB_IN_BUFFER = 0x5010_0090
USB_AVAILABLE = 1 << 10  # it waits for the PC


def expect(chip):
    """Raises ValueError on another chip: there the pins of this board may be something else."""
    if chip != CHIP:
        raise ValueError("this board file is for the %s, and here is a %s" % (chip, CHIP))


micropython.alloc_emergency_exception_buf(100)


class Clock:
    """The functions of `time` as they are: their period is 2**30 on this port."""

    ticks_mask = (1 << 30) - 1

    def __init__(self):
        self.ticks_us = time.ticks_us
        self.ticks_ms = time.ticks_ms
        self.sleep_us = time.sleep_us


def low(number):
    """The pin as an output that is low."""
    return Pin(number, Pin.OUT, value=0)


def make_store():
    return FileStore(SETTINGS_FILE, open, os)


_serial = []  # the one that was made


def serial():
    """The USB serial port, on which the prompt is, too. Most panels never need it."""
    if not _serial:
        _serial.append(make_serial())
    return _serial[0]


def make_serial():
    import select

    from hal.serial import Serial

    stream = sys.stdout.buffer  # takes what comes as well
    poll = select.poll()
    poll.register(stream, select.POLLIN | select.POLLOUT)
    return Serial(stream, poll, micropython.kbd_intr, usb_is_idle)


def usb_is_idle():
    """Whether the PC has taken the last packet."""
    return not machine.mem16[USB_IN_BUFFER] & USB_AVAILABLE


def idle():
    """The processor sleeps for 1 ms at most; interrupts are served in it."""
    time.sleep_ms(1)


# --- watchdog ------------------------------------------------------------------------------------


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
        machine.mem32[WATCHDOG_CONTROL_CLEAR] = WATCHDOG_ENABLE
        machine.mem32[WATCHDOG_SCRATCH_4] = 0
        self._wdt = None
        return True


def why_it_booted():
    """Either "WATCHDOG", or "" for power-on, the RUN pin and machine.reset()."""
    bitten = machine.mem32[WATCHDOG_REASON] and machine.mem32[WATCHDOG_SCRATCH_4] == STARTED
    return "WATCHDOG" if bitten else ""


# --- timer ---------------------------------------------------------------------------------------


class HardTimer:
    """machine.Timer with hard callbacks, which the port has from MicroPython 1.26 on."""

    ONE_SHOT = Timer.ONE_SHOT

    def __init__(self, timer):
        self._timer = timer
        self.deinit = timer.deinit

    def init(self, mode, period, tick_hz, callback):
        # By its name: a call of a bound `timer.init` takes heap for so many arguments.
        timer = self._timer
        timer.init(mode=mode, period=period, tick_hz=tick_hz, callback=callback, hard=True)


def make_timer():
    """A timer with hard callbacks, or with soft ones where the port takes no others."""
    machine_timer = Timer()
    timer = HardTimer(machine_timer)
    try:
        timer.init(Timer.ONE_SHOT, 1_000_000, 1_000_000, print)  # a second: it never comes to that
    except (TypeError, ValueError):  # it knows no such thing; it knows it, and has it not
        return machine_timer
    timer.deinit()
    return timer


# --- bus -----------------------------------------------------------------------------------------


def make_link(send, receive, driver_enable, clock, baud):
    """send, receive: numbers of pins. driver_enable: a Pin, which is low by now."""
    send_pin = Pin(send)
    # The transceiver lets go of this wire while the driver is on.
    receive_pin = Pin(receive, Pin.IN, Pin.PULL_UP)
    uart = UART(
        BUS_UART,
        baud,
        bits=8,
        parity=0,  # even
        stop=1,
        tx=send_pin,
        rx=receive_pin,
        rxbuf=RECEIVE_BUFFER,
        txbuf=SEND_BUFFER,
    )
    link = Rp2Link(
        uart,
        UART_REGISTERS,
        BUS_STATE_MACHINE,
        rp2.DMA(),
        send_pin,
        driver_enable,
        clock,
        baud,
    )
    link.defect = find_defect(driver_enable, receive_pin, clock, baud)
    return link


def find_defect(driver_enable, receive_pin, clock, baud):
    """Of the bus, with its link made: see `hal.link.rp2_check`, which leaves the memory again."""
    import hal.link.rp2_check

    try:
        check = hal.link.rp2_check.find
        return check(machine.mem32, UART_REGISTERS, driver_enable, receive_pin, clock, baud)
    finally:
        del sys.modules["hal.link.rp2_check"], hal.link.rp2_check


# --- display -------------------------------------------------------------------------------------


def make_display(sda, scl, addresses, register_select, enable, clock):
    """The backpack that answers; the display on four data lines when none does. The driver that is
    not needed takes no memory. All but `addresses` and `clock`: numbers of pins."""
    i2c = make_i2c(sda, scl)
    for address in addresses:
        if answers(i2c, address):
            from hal.display.backpack import Backpack

            return Backpack(lambda: make_posted_i2c(sda, scl, clock), address, clock)
    from hal.display.rp2_hd44780 import PioHd44780

    return PioHd44780(LCD_STATE_MACHINE, Pin(register_select), Pin(enable), clock)


def make_posted_i2c(sda, scl, clock):
    from hal.display.rp2_i2c import PostedI2C

    return PostedI2C(make_i2c(sda, scl), I2C_REGISTERS, machine.mem32, clock)


def make_i2c(sda, scl):
    """The I2C of the backpack, after its wires were made free."""
    data = Pin(sda, Pin.IN, Pin.PULL_UP)
    pulse = Pin(scl, Pin.OPEN_DRAIN, Pin.PULL_UP, value=1)
    free(data, pulse, time.sleep_us)
    return I2C(BACKPACK_I2C, sda=data, scl=pulse, freq=BACKPACK_HZ, timeout=BACKPACK_TIMEOUT_US)


# --- keys ----------------------------------------------------------------------------------------


def make_keypad(keys, normally_closed):
    """keys: rows of a name and the number of a pin; each key to ground."""
    pins = tuple((key, Pin(number, Pin.IN, Pin.PULL_UP)) for key, number in keys)
    masks = tuple(1 << number for _, number in keys)
    all_keys = sum(masks)

    def levels():
        return machine.mem32[GPIO_IN] & all_keys

    return Keypad(pins, closed=normally_closed, levels=levels, masks=masks)
