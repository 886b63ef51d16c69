# SPDX-License-Identifier: MIT
"""The panel on an ESP32-DevKitC: which pin is what. README.md beside it shows the wiring.

The transceiver finds its direction by itself. For one with a driver enable, up to 9600 baud, give
DRIVER_ENABLE the number of a pin: on a module without PSRAM GPIO17 is free.

If you wire it differently, put a changed copy as board.py on the chip's file system.
"""

from chips import esp32

name, CHIP = "ESP32", "ESP32"

# GPIO numbers
BUS_SEND, BUS_RECEIVE = 33, 4  # 16 and 17 belong to the PSRAM of a WROVER module
DRIVER_ENABLE = None

BACKPACK_SDA, BACKPACK_SCL = 21, 22
BACKPACK_ADDRESSES = (0x27, 0x3F)  # PCF8574 and PCF8574A, as they are sold: A0...A2 open

KEYS = (("START", 13), ("STOP", 14))  # each to ground
NORMALLY_CLOSED = ("STOP",)  # () for a STOP that closes: then a broken wire is not noticed

# The other keys join a row to a column.
ROWS = (25, 26, 27)
COLUMNS = (18, 19, 23, 32)
MATRIX = (
    ("REVERSE", "JOG_RIGHT", "JOG_LEFT", "PARAM"),
    ("UP", "DOWN", "ADDRESS_UP", "ADDRESS_DOWN"),
    ("NEXT", "PREVIOUS", "EDIT", "SET"),
)

esp32.expect(CHIP)
driver_enable = None if DRIVER_ENABLE is None else esp32.low(DRIVER_ENABLE)  # nobody drives
must_supervise = True  # a hang in C stops every callback: only the drive's P2014 is left then
reset_cause = esp32.why_it_booted()
clock = esp32.Clock()
display = esp32.make_display(BACKPACK_SDA, BACKPACK_SCL, BACKPACK_ADDRESSES, clock)
backlight = display.backlight
keypad = esp32.make_keypad(KEYS, NORMALLY_CLOSED, ROWS, COLUMNS, MATRIX, clock)
store = esp32.make_store()
watchdog = esp32.Watchdog()
timer = esp32.make_timer()
idle = esp32.idle


def make_link(baud):
    if driver_enable is None:
        return esp32.make_link(BUS_SEND, BUS_RECEIVE, clock, baud)
    return esp32.make_timed_link(BUS_SEND, BUS_RECEIVE, driver_enable, clock, baud)
