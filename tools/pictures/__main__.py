# SPDX-License-Identifier: MIT
"""Draws the pictures of the manuals, .github/pictures/*.svg, from the panel and from tables.

    python3 tools/pictures

A test compares what is there with what this makes. `python3 tools/drawing` makes those of the
boards.
"""

import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
# In host_tests/cpython is a module `micropython`: the panel runs on CPython here.
sys.path[:1] = [str(TOP), str(TOP / "firmware"), str(TOP / "host_tests" / "cpython")]

from tools.pictures import bench, bus, exchange, front, pages, states  # noqa: E402

FOLDER = ".github/pictures"
PICTURES = {
    "panel": front.fourteen,
    "panel_eight_keys": front.eight,
    "pages": pages.pages,
    "menu": pages.menu,
    "states": states.states,
    "exchange": exchange.exchange,
    "bench": bench.bench,
    "bus": bus.bus,
}


def files():
    """{path from the top: a function that makes the `Picture`}."""
    return {f"{FOLDER}/{name}.svg": make for name, make in PICTURES.items()}


if __name__ == "__main__":
    for path, make in files().items():
        (TOP / path).parent.mkdir(exist_ok=True)
        (TOP / path).write_text(make().svg(), encoding="utf-8")
