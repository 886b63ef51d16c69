# SPDX-License-Identifier: MIT
"""What every board with an ESP32 or ESP32-S3 needs: clock, watchdog, timer, bus, display, keys.

A board file says which pin is what and asks here for the rest. A driver is handed objects of the
chip; this is the only place that makes them. Facts of the port: MicroPython 1.25 to 1.29,
ports/esp32; of the chips: ESP-IDF, components/soc/<chip>/include/soc.

Callbacks are soft here: they wait for a garbage collection and for anything that runs in C. Where
that does not end, only the watchdog and the drives' own time-out are left.
"""

import os
import sys
import time

import machine
import micropython
from machine import I2C, UART, WDT, Pin, Timer

from hal.display.probe import answers, free
from hal.keypad import Keypad, Matrix
from hal.link.self_directed import SelfDirectedLink
from hal.store import FileStore

# --- which part of the chip does what ------------------------------------------------------------

BUS_UART = 1  # UART 0 is the prompt's on the classic ESP32
# Up to MicroPython 1.28 the port uses Timer 0 for IRQ_RXIDLE.
BUS_TIMER, DRIVER_TIMER = 1, 2
RECEIVE_BUFFER = SEND_BUFFER = 512  # characters; the port takes 256 and more
BACKPACK_I2C = 0
BACKPACK_HZ = 100_000  # the most that a PCF8574 takes
BACKPACK_TIMEOUT_US = 5_000
WATCHDOG_MS = 2_000
# The port cannot stop a watchdog (machine_wdt.c), and sets its time anew with each WDT().
MAINTENANCE_MS = 24 * 3_600_000
SETTINGS_FILE = "settings.json"

# How late a soft callback may be: a collection of 12 ms, and what else runs in C.
SOFT_US = 14_000
# IRQ_RXIDLE: a timer of two characters, of 12 bits here, but 500 us at least; it is the second
# tick after the last character that counts (machine_uart.c, uart_irq_configure_timer).
IDLE_BITS, IDLE_MIN_US = 24, 500
# Above this rate the driver would still be on when a drive answers: it waits two characters.
TIMED_DRIVER_BAUD_MAX = 9_600

# --- registers -----------------------------------------------------------------------------------

# UART 1: its RS-485 register, and the signal DTR that it makes of it. Where the GPIO matrix
# selects the signal of pin 0; those of the others follow, 4 bytes each. The classic ESP32 has such
# a register too, but nobody has shown that its DTR works (esp-hal#3796).
#   ESP32-S3: reg_base.h, uart_reg.h (UART_RS485_CONF_REG), gpio_sig_map.h (U1DTR_OUT_IDX),
#   gpio_reg.h (GPIO_FUNC0_OUT_SEL_CFG_REG)
RS485_BY_CHIP = {"ESP32S3": (0x6001_004C, 17, 0x6000_4554), "ESP32": None}
# The UART makes DTR high while it sends (bit 0), also if it hears something (bit 4): STOP must go
# out. Bits 1 and 2 stay 0: each would make the stop bit longer (esp-idf#12568). Bit 3 stays 0: it
# does not hear itself.
RS485_ON = 1 << 0 | 1 << 4

CHIP = sys.implementation._machine.rpartition(" with ")[2]
if CHIP not in RS485_BY_CHIP:
    raise ValueError("this firmware knows %s, no %s" % (" and ".join(sorted(RS485_BY_CHIP)), CHIP))

micropython.alloc_emergency_exception_buf(100)


def expect(chip):
    """Raises ValueError on another chip: there the pins of this board may be something else."""
    if chip != CHIP:
        raise ValueError("this board file is for the %s, and here is a %s" % (chip, CHIP))


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


def idle():
    """Other tasks of the chip run for 1 ms; so do callbacks that have waited."""
    time.sleep_ms(1)


# --- watchdog, timer -----------------------------------------------------------------------------


class Watchdog:
    """Starts with the first feeding; unfed for WATCHDOG_MS it restarts the chip."""

    def __init__(self):
        self._wdt = None

    def feed(self):
        if self._wdt is None:
            self._wdt = WDT(timeout=WATCHDOG_MS)
        self._wdt.feed()

    def stop(self):
        """For a day: no chip of this family can stop it."""
        if self._wdt is not None:
            WDT(timeout=MAINTENANCE_MS).feed()
            self._wdt = None
        return True


def why_it_booted():
    """Either "WATCHDOG", or "" for power-on, the EN pin and machine.reset()."""
    return "WATCHDOG" if machine.reset_cause() == machine.WDT_RESET else ""


def make_timer():
    """A timer with soft callbacks: the port has no others."""
    return Timer(BUS_TIMER)


# --- bus -----------------------------------------------------------------------------------------


def make_link(send, receive, clock, baud):
    """The transceiver finds its direction by itself. send, receive: numbers of pins."""
    return SelfDirectedLink(make_uart(send, receive, baud), clock, baud, idle_us(baud), SOFT_US)


def make_rs485_link(send, receive, driver_enable, clock, baud):
    """The UART switches the driver itself. driver_enable: the number of a pin, low by now.
    ValueError: a chip whose UART cannot."""
    if RS485_BY_CHIP[CHIP] is None:
        raise ValueError("nobody knows how the UART of an %s switches a driver" % CHIP)
    uart = make_uart(send, receive, baud)
    for register, value in rs485_writes(driver_enable):  # after each `init` of the UART
        machine.mem32[register] = value
    return SelfDirectedLink(uart, clock, baud, idle_us(baud), SOFT_US)


def rs485_writes(driver_enable):
    """What is written where, in this order: the mode first, or DTR would follow its idle level."""
    register, signal, matrix = RS485_BY_CHIP[CHIP]
    return (register, RS485_ON), (matrix + 4 * driver_enable, signal)


def make_timed_link(send, receive, driver_enable, clock, baud):
    """A timer switches the driver off. driver_enable: a Pin, which is low by now. ValueError: this
    rate is too fast for that."""
    if baud > TIMED_DRIVER_BAUD_MAX:
        raise ValueError(
            "%d baud wants a transceiver that finds its direction by itself: a timer switches the"
            " driver off too late above %d" % (baud, TIMED_DRIVER_BAUD_MAX)
        )
    from hal.link.rs485 import Rs485Link

    uart = make_uart(send, receive, baud)
    timer = Timer(DRIVER_TIMER)
    idle = (idle_us(baud), SOFT_US)
    return Rs485Link(uart, driver_enable, timer, clock, baud, hard=False, idle=idle)


def make_uart(send, receive, baud):
    return UART(
        BUS_UART,
        baud,
        bits=8,
        parity=0,  # even
        stop=1,
        tx=Pin(send),
        rx=Pin(receive, Pin.IN, Pin.PULL_UP),  # the transceiver lets go of it while it sends
        rxbuf=RECEIVE_BUFFER,
        txbuf=SEND_BUFFER,
    )


def idle_us(baud):
    """The least that IRQ_RXIDLE comes after the last character; twice that is the most."""
    return max(-(-IDLE_BITS * 1_000_000 // baud), IDLE_MIN_US)


# --- display -------------------------------------------------------------------------------------


def make_display(sda, scl, addresses, clock):
    """The backpack that answers, or the first one: it may come later."""

    def make_i2c():
        data = Pin(sda, Pin.IN, Pin.PULL_UP)
        pulse = Pin(scl, Pin.OPEN_DRAIN, Pin.PULL_UP, value=1)
        free(data, pulse, time.sleep_us)
        return I2C(
            BACKPACK_I2C, sda=data, scl=pulse, freq=BACKPACK_HZ, timeout=BACKPACK_TIMEOUT_US
        )

    from hal.display.backpack import Backpack

    i2c = make_i2c()
    there = [address for address in addresses if answers(i2c, address)]
    return Backpack(make_i2c, (there or addresses)[0], clock)


# --- keys ----------------------------------------------------------------------------------------


def make_keypad(keys, normally_closed, rows=(), columns=(), names=(), clock=None):
    """keys: rows of a name and the number of a pin; each key to ground. rows, columns, names: of a
    matrix, see `hal.keypad.Matrix`."""
    pins = tuple((key, Pin(number, Pin.IN, Pin.PULL_UP)) for key, number in keys)
    matrix = None
    if rows:
        lines = tuple(Pin(number, Pin.OPEN_DRAIN, Pin.PULL_UP, value=1) for number in rows)
        inputs = tuple(Pin(number, Pin.IN, Pin.PULL_UP) for number in columns)
        matrix = Matrix(lines, inputs, names, clock)
    return Keypad(pins, matrix, normally_closed)
