# SPDX-License-Identifier: MIT
"""The panel on a Raspberry Pi Pico 2: which pin is what. README.md beside it shows the wiring.

If you wire it differently, put a changed copy as board.py on the chip's file system: MicroPython
finds it there before the one that is frozen into the firmware.
"""

from chips import rp2

name, CHIP = "RASPBERRY PICO 2", "RP2350"

# GPIO numbers
BUS_SEND, BUS_RECEIVE = 4, 5  # receive: of UART 1
DRIVER_ENABLE = 6  # with 8.2 kohm at most to ground: on while the chip boots, it blocks the bus

BACKPACK_SDA, BACKPACK_SCL = 0, 1
BACKPACK_ADDRESSES = (0x27, 0x3F)  # PCF8574 and PCF8574A, as they are sold: A0...A2 open

# Six pins in a row: register select, enable, D4...D7; R/W to ground. Used if no backpack answers.
LCD_REGISTER_SELECT, LCD_ENABLE = 7, 8

KEYS = (  # each to ground
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

rp2.expect(CHIP)
driver_enable = rp2.low(DRIVER_ENABLE)  # before anything else: nobody drives the bus
reset_cause = rp2.why_it_booted()
clock = rp2.Clock()
display = rp2.make_display(
    BACKPACK_SDA, BACKPACK_SCL, BACKPACK_ADDRESSES, LCD_REGISTER_SELECT, LCD_ENABLE, clock
)
backlight = getattr(display, "backlight", None)  # a backpack switches it
keypad = rp2.make_keypad(KEYS, NORMALLY_CLOSED)
store = rp2.make_store()
serial = rp2.serial  # USB
watchdog = rp2.Watchdog()
timer = rp2.make_timer()
idle = rp2.idle


def make_link(baud):
    return rp2.make_link(BUS_SEND, BUS_RECEIVE, driver_enable, clock, baud)
