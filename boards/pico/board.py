# SPDX-License-Identifier: MIT
"""The panel on a Raspberry Pi Pico: which pin is what. README.md beside it shows the wiring.

The attributes below the tables are those that `hal` asks of any board. The board looks for the
display: it takes a backpack on I2C if one answers, and four data lines otherwise.

If you wire it differently, put a changed copy as board.py on the chip's file system: MicroPython
finds it there before the one that is frozen into the firmware.
"""

import os

import micropython
from machine import Pin

from chips import rp2
from hal.store import FileStore

# --- what is wired where: GPIO numbers ----------------------------------------------------------

BUS_SEND = 4
BUS_RECEIVE = 5  # of UART 1
DRIVER_ENABLE = 6  # with a pull-down of 10 kohm: a driver that is on while the chip boots blocks

BACKPACK_SDA = 0
BACKPACK_SCL = 1
BACKPACK_ADDRESSES = (0x27, 0x3F)  # PCF8574 and PCF8574A, as they are sold: A0...A2 open

LCD_REGISTER_SELECT = 7  # six pins in a row: register select, enable, D4...D7; R/W to ground
LCD_ENABLE = 8

KEYS = (  # each to ground; none at GP15, whose pull-up fails a while when USB comes (RP2040-E5)
    ("START", 13),
    ("STOP", 14),
    ("REVERSE", 3),
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

SETTINGS_FILE = "settings.json"

rp2.expect("RP2040")

# Before anything else: nobody drives the bus.
driver_enable = Pin(DRIVER_ENABLE, Pin.OUT, value=0)

micropython.alloc_emergency_exception_buf(100)

name = "RASPBERRY PICO"
reset_cause = rp2.why_it_booted()
clock = rp2.Clock()
display = rp2.make_display(
    BACKPACK_SDA, BACKPACK_SCL, BACKPACK_ADDRESSES, LCD_REGISTER_SELECT, LCD_ENABLE, clock
)
backlight = getattr(display, "backlight", None)  # a backpack switches it
keypad = rp2.make_keypad(KEYS, NORMALLY_CLOSED)
store = FileStore(SETTINGS_FILE, open, os)
watchdog = rp2.Watchdog()
timer = rp2.make_timer()
idle = rp2.idle


def make_link(baud):
    return rp2.make_link(BUS_SEND, BUS_RECEIVE, driver_enable, clock, baud)
