# SPDX-License-Identifier: MIT
"""The chips that there are boards for: which pins they have, and what is the matter with some.

A row of `pins`: what is the matter, a name of `refusals.py`, and with which pins. Sources stand
there. `modules`: what the port has beside `machine`.
"""

from boards.sim.ports import refusals


class ChipModel:
    def __init__(self, machine, port, count, pins, timers, uarts, watchdog_ms):
        self.machine = machine  # sys.implementation._machine
        self.port = port
        self.count = count  # of pins
        self.pins = pins
        self.timers = timers
        self.uarts = uarts
        self.watchdog_ms = watchdog_ms  # the longest
        self.refusals = dict(refusals.ANY)
        self.refusals.update(refusals.ESP32 if port == "esp32" else refusals.RP2)

    def troubles(self, number, drives=False, pulls=False):
        """Names of refusals for this pin. drives: it is to be an output; pulls: with a pull-up."""
        if not 0 <= number < self.count:
            return ["pin"]
        wanted = {"output": drives, "pull": pulls}
        return [
            what for what, numbers in self.pins if number in numbers and wanted.get(what, True)
        ]


# What Python can have of an ESP32's memory, in bytes, by what MicroPython prints of it: mem_info()
# says "total" and "max new split", idf_heap_info() the largest block beside the heap.
HEAP_BYTES = {
    "ESP32-S3": 64_000 + 188_352,  # without PSRAM: MicroPython, pull request 12141
    "ESP32 with PSRAM": 4_098_240,  # "total" of 4 MB, less what ESP-IDF takes
    "ESP32 without PSRAM": 64_000 + 112_216,  # MicroPython, issue 7214
}

CHIPS = {
    "ESP32": ChipModel(
        "Generic ESP32 module with ESP32",
        "esp32",
        40,
        (
            ("pin", (20, 24, 28, 29, 30, 31)),
            ("flash", (6, 7, 8, 9, 10, 11)),
            ("output", (34, 35, 36, 37, 38, 39)),
            ("pull", (34, 35, 36, 37, 38, 39)),
            ("strapping", (0, 2, 5, 12, 15)),
            ("prompt", (1, 3)),
        ),
        4,
        3,
        1 << 31,
    ),
    "ESP32S3": ChipModel(
        "Generic ESP32S3 module with ESP32S3",
        "esp32",
        49,
        (
            ("pin", (22, 23, 24, 25)),
            ("flash", (26, 27, 28, 29, 30, 31, 32)),
            ("psram", (33, 34, 35, 36, 37)),
            ("strapping", (0, 3, 45, 46)),
            ("prompt", (19, 20, 43, 44)),
            ("led", (38, 48)),
        ),
        4,
        3,
        1 << 31,
    ),
    "RP2040": ChipModel(
        "Raspberry Pi Pico with RP2040",
        "rp2",
        30,
        (("board", (23, 24, 25, 29)), ("e5", (15,))),
        0,
        2,
        8388,
    ),
    "RP2350": ChipModel(
        "Raspberry Pi Pico2 with RP2350", "rp2", 30, (("board", (23, 24, 25, 29)),), 0, 2, 16777
    ),
}
