# SPDX-License-Identifier: MIT
"""A Pico with display and keys for Wokwi, a simulator in the browser: boards/pico/diagram.json.

There are no drives in it, and no transceiver: it shows the display and the keys.
"""

import json

from tools.drawing.wires import wires

LCD_PINS = ("RS", "E", "D4", "D5", "D6", "D7")
COLOURS = ("red", "green", "blue", "yellow", "white", "black")


def part(kind, name, top, left, attributes):
    return {"type": f"wokwi-{kind}", "id": name, "top": top, "left": left, "attrs": attributes}


def diagram():
    parts = [
        part("pi-pico", "pico", 0, 0, {"env": "micropython"}),
        part("lcd1602", "lcd", -220, -60, {"pins": "full"}),
    ]
    joined = [
        ["lcd:VSS", "pico:GND.1", "black", []],
        ["lcd:RW", "pico:GND.1", "black", []],
        ["lcd:K", "pico:GND.1", "black", []],
        ["lcd:VDD", "pico:VSYS", "red", []],
        ["lcd:A", "pico:VSYS", "red", []],
    ]
    keys = 0
    for number, what in sorted(wires("pico").items()):
        if what.startswith("LCD "):
            joined.append([f"lcd:{what[4:]}", f"pico:GP{number}", "green", []])
        elif what.startswith("key "):
            key = what[4:].split(",")[0]
            column, row = divmod(keys, 7)
            place = (70 * row, 160 + 130 * column)
            if "normally closed" in what:  # a button of Wokwi closes; this lies on 1 until slid
                parts.append(part("slide-switch", key, *place, {"value": ""}))
                pin, ground = "2", "1"
            else:
                attrs = {"label": key, "color": COLOURS[keys % len(COLOURS)]}
                parts.append(part("pushbutton", key, *place, attrs))
                pin, ground = "1.l", "2.l"
            joined.append([f"{key}:{pin}", f"pico:GP{number}", "blue", []])
            joined.append([f"{key}:{ground}", "pico:GND.1", "black", []])
            keys += 1
    made = {"version": 1, "author": "USS panel", "editor": "wokwi", "parts": parts}
    made["connections"] = joined
    return json.dumps(made, indent=1) + "\n"
