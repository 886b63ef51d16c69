# SPDX-License-Identifier: MIT
"""Draws boards/*/pins.svg and boards/pico/diagram.json from the tables of the board files.

    python3 tools/drawing

A test compares what is there with what this makes.
"""

import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path[0] = str(TOP)

from tools.drawing.layouts import LAYOUTS  # noqa: E402
from tools.drawing.picture import picture  # noqa: E402
from tools.drawing.wokwi import diagram  # noqa: E402


def files():
    """{path from the top: text}."""
    made = {f"boards/{board}/pins.svg": picture(board).svg() for board in LAYOUTS}
    made["boards/pico/diagram.json"] = diagram()
    return made


if __name__ == "__main__":
    for path, text in files().items():
        (TOP / path).write_text(text)
