# SPDX-License-Identifier: MIT
"""The chips that there are boards for: what their machine code is called, and how USB names them.

target = TARGETS["ESP32S3"]         # the second word of a board file's line `name, CHIP = ...`
"""

import re
from typing import NamedTuple

MICROPYTHON_RP2 = (0x2E8A, 0x0005)  # USB: Raspberry Pi, MicroPython
MICROPYTHON_ESP32S3 = (0x303A, 0x4001)  # USB: Espressif, MicroPython by native USB


class Target(NamedTuple):
    machine_code: str  # `-march` of mpy-cross
    usb: tuple | None  # None: behind a USB adapter that may as well be something else's
    called: str


TARGETS = {
    "RP2040": Target("armv6m", MICROPYTHON_RP2, "Pico"),
    "RP2350": Target("armv6m", MICROPYTHON_RP2, "Pico 2"),  # that takes the RP2040's code
    "ESP32S3": Target("xtensawin", MICROPYTHON_ESP32S3, "ESP32-S3"),
    "ESP32": Target("xtensawin", None, "ESP32"),
}
USUAL = "RP2040"  # of a board file that does not say

CHIP = re.compile(rb'^name, CHIP = .*"(\w+)"', re.MULTILINE)


def chip_of(board_file, otherwise=USUAL):
    """The chip that a board file says it is for. board_file: its bytes."""
    found = CHIP.search(board_file)
    return found[1].decode() if found else otherwise
