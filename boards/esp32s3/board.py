# SPDX-License-Identifier: MIT
"""The panel on an ESP32-S3-DevKitC-1: which pin is what. README.md beside it shows the wiring.

If you wire it differently, put a changed copy as board.py on the chip's file system.
"""

from chips import esp32

name, CHIP = "ESP32-S3", "ESP32S3"

# GPIO numbers
BUS_SEND, BUS_RECEIVE = 17, 18
DRIVER_ENABLE = 16  # with a pull-down of 10 kohm: on while the chip boots, it blocks the bus

BACKPACK_SDA, BACKPACK_SCL = 8, 9
BACKPACK_ADDRESSES = (0x27, 0x3F)  # PCF8574 and PCF8574A, as they are sold: A0...A2 open

KEYS = (  # each to ground
    ("START", 11),
    ("STOP", 12),
    ("REVERSE", 13),
    ("JOG_RIGHT", 14),
    ("JOG_LEFT", 21),
    ("UP", 4),
    ("DOWN", 5),
    ("ADDRESS_UP", 6),
    ("ADDRESS_DOWN", 7),
    ("PARAM", 15),
    ("NEXT", 1),
    ("PREVIOUS", 2),
    ("EDIT", 42),
    ("SET", 41),
)
NORMALLY_CLOSED = ("STOP",)  # () for a STOP that closes: then a broken wire is not noticed

esp32.expect(CHIP)
driver_enable = esp32.low(DRIVER_ENABLE)  # before anything else: nobody drives the bus
must_supervise = True  # a hang in C stops every callback: only the drive's P2014 is left then
reset_cause = esp32.why_it_booted()
clock = esp32.Clock()
display = esp32.make_display(BACKPACK_SDA, BACKPACK_SCL, BACKPACK_ADDRESSES, clock)
backlight = display.backlight
keypad = esp32.make_keypad(KEYS, NORMALLY_CLOSED)
store = esp32.make_store()
watchdog = esp32.Watchdog()
timer = esp32.make_timer()
idle = esp32.idle


def make_link(baud):
    return esp32.make_rs485_link(BUS_SEND, BUS_RECEIVE, DRIVER_ENABLE, clock, baud)
