# SPDX-License-Identifier: MIT
"""The pins of the boards as they are led out, from the end with the USB plug: left, right.

Sources: Raspberry Pi Pico data sheet, 2.1 (seen from above, USB on top; the Pico 2 is the same);
ESP32-S3-DevKitC-1 v1.1 user guide, J1 and J3; ESP32-DevKitC V4 user guide, J2 and J3 (both seen
from above, antenna on top).
"""

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
    "pico": (PICO, "GP%d", {"VSYS": "5 V through a diode", "3V3": "transceiver 3.3 V"}),
    "pico2": (PICO, "GP%d", {"VSYS": "5 V through a diode", "3V3": "transceiver 3.3 V"}),
    "esp32s3": (ESP32S3, "%d", {"5V": "5 V", "3V3": "transceiver 3.3 V"}),
    "esp32": (ESP32, "%d", {"5V": "5 V", "3V3": "transceiver 3.3 V"}),
}


def sides(board):
    """The two rows of names."""
    return [side.split() for side in LAYOUTS[board][0]]
