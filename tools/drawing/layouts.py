# SPDX-License-Identifier: MIT
"""The pins of the boards as they are led out, from the end with the USB plug: left, right.

Sources: Raspberry Pi Pico data sheet, 2.1 (seen from above, USB on top; the Pico 2 is the same);
ESP32-S3-DevKitC-1 v1.1 user guide, J1 and J3; ESP32-DevKitC V4 user guide, J2 and J3 (both seen
from above, antenna on top).
"""

from tools.drawing.wires import table

PICO = (
    "GP0 GP1 GND GP2 GP3 GP4 GP5 GND GP6 GP7 GP8 GP9 GND GP10 GP11 GP12 GP13 GND GP14 GP15",
    "VBUS VSYS GND 3V3_EN 3V3 ADC_VREF GP28 AGND GP27 GP26 RUN GP22 GND GP21 GP20 GP19 GP18 GND"
    " GP17 GP16",
)
ESP32S3 = (
    "3V3 3V3 RST 4 5 6 7 15 16 17 18 8 3 46 9 10 11 12 13 14 5V GND",
    "GND 43 44 1 2 42 41 40 39 38 37 36 35 0 45 48 47 21 20 19 GND GND",
)
ESP32 = (
    "3V3 EN 36 39 34 35 32 33 25 26 27 14 12 GND 13 9 10 11 5V",
    "GND 23 22 1 3 21 GND 19 18 5 17 16 4 0 2 15 8 7 6",
)
# Board: its pins; how a number is written on it; what else is joined to it, by name of pin.
LAYOUTS = {
    "pico": (PICO, "GP%d", {"VSYS": "5 V through a diode", "3V3": "3.3 V for modules"}),
    "pico2": (PICO, "GP%d", {"VSYS": "5 V through a diode", "3V3": "3.3 V for modules"}),
    "esp32s3": (ESP32S3, "%d", {"5V": "5 V", "3V3": "3.3 V for modules"}),
    "esp32": (ESP32, "%d", {"5V": "5 V", "3V3": "3.3 V for modules"}),
}


END = {"pico": "USB", "pico2": "USB", "esp32s3": "antenna", "esp32": "antenna"}
# At the driver enable, or for a transceiver without one at its TXD.
RESISTOR = {"pico": "10 kohm", "pico2": "8.2 kohm", "esp32s3": "10 kohm", "esp32": "10 kohm"}

# Modules: name; rows of what is joined and the module's pin, left and right. A word in capitals is
# a constant of the board file, and stands for its pin.
TRANSCEIVER = (
    "transceiver for 3.3 V",
    (
        ("BUS_SEND", "DI"),
        ("BUS_RECEIVE", "RO"),
        ("DRIVER_ENABLE", "DE, /RE"),
        ("RESISTOR to ground", "DE, /RE"),
        ("3V3", "VCC"),
        ("GND", "GND"),
    ),
    (("P+ of the drives", "A"), ("N- of the drives", "B"), ("0 V of the drives", "GND")),
)
SELF_DIRECTED = (
    "transceiver for 3.3 V that finds its direction by itself",
    (
        ("BUS_SEND", "TXD"),
        ("RESISTOR to 3V3", "TXD"),
        ("BUS_RECEIVE", "RXD"),
        ("3V3", "VCC"),
        ("GND", "GND"),
    ),
    (("P+ of the drives", "A"), ("N- of the drives", "B"), ("0 V of the drives", "GND")),
)
SHIFTER = (
    "level shifter, before a backpack of 5 V",
    (("BACKPACK_SDA", "LV1"), ("BACKPACK_SCL", "LV2"), ("3V3", "LV"), ("GND", "GND")),
    (
        ("SDA of the display", "HV1"),
        ("SCL of the display", "HV2"),
        ("5 V, VCC of the display", "HV"),
        ("GND of the display", "GND"),
    ),
)


def sides(board):
    """The two rows of names."""
    return [side.split() for side in LAYOUTS[board][0]]


def numbered(board):
    """Whether people count its pins: on the others the numbers of the pins are others."""
    return LAYOUTS[board][0] is PICO


def modules(board):
    """Those that are joined to the board, as in `TRANSCEIVER`, with its pins."""
    names = table(board)
    form = LAYOUTS[board][1]
    form = "GPIO%d" if form == "%d" else form  # beside a module a number alone says nothing

    def joined(what):
        if what in names:
            return form % names[what]
        return what.replace("RESISTOR", RESISTOR[board])

    bus = TRANSCEIVER if names["DRIVER_ENABLE"] is not None else SELF_DIRECTED
    for name, *rows in (bus, SHIFTER):
        yield name, *([(joined(what), pin) for what, pin in side] for side in rows)
