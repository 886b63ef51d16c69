# SPDX-License-Identifier: MIT
"""The line from the panel to the drives: three wires, a shield, resistors at both ends. The
terminals are those of the table of boards/COMMISSIONING.md.
"""

import re
from pathlib import Path
from typing import NamedTuple

from tools.pictures.svg import Picture, wrapped

MANUAL = Path(__file__).resolve().parents[2] / "boards" / "COMMISSIONING.md"
HEADING = "### Terminals of the drives"
ACROSS, EDGE = 460, 14
WIRES = {"P+": (104, "orange"), "N-": (142, "blue"), "0 V": (180, "ink")}  # x, colour
SHIELD = (84, 200)  # from, to
BOX, NAME = 224, 296  # where a device begins, and what it is called
FONT, SMALL, STEP = 12, 11, 16
ROW, DEVICE, GAP = 18, 64, 12  # of a terminal; height of a device, and from one to the next
RESISTOR = "120 ohm"
PANEL = ("A", "B", "GND")
NOTES = (
    "The cable goes from terminal to terminal: the branches drawn here have no length. 120 ohm at "
    "its two ends and nowhere else.",
    "Dashed: the shield. It lies on the metal of each device, and is no wire: 0 V has its own.",
)


class Drive(NamedTuple):
    """terminals: of P+, N-, 0 V."""

    name: str
    terminals: tuple


def drives():
    """Those of the manual that have numbers."""
    table = MANUAL.read_text(encoding="utf-8").partition(HEADING)[2].partition("\n### ")[0]
    found = []
    for line in re.findall(r"^\| .*", table, re.M)[1:]:
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if re.search(r"\d", cells[1]):
            found.append(Drive(cells[0], tuple(cells[1:4])))
    return found


def bus():
    listed = drives()
    told = (
        f"{drive.name}: " + ", ".join(map(" ".join, zip(WIRES, drive.terminals)))
        for drive in listed
    )
    picture = Picture(
        ACROSS, "The line from the panel to the drives", " ".join(NOTES) + " " + "; ".join(told)
    )
    y = EDGE
    for note in NOTES:
        lines = wrapped(note, ACROSS - 2 * EDGE, FONT)
        y = picture.lines(EDGE, y + FONT, lines, STEP, colour="pale", size=FONT) - 8
    top = y + 38
    for name, (x, colour) in WIRES.items():
        picture.text(x, top - 8, name, colour, FONT, "middle", bold=True)
    begin, end = SHIELD
    bottom = top + 2 * ROW + (1 + len(listed)) * (DEVICE + GAP) - GAP + 2 * ROW
    cable = [(begin, top + 2), (end, top + 2), (end, bottom - 2), (begin, bottom - 2)]
    picture.line([*cable, cable[0]], "line", 1.5, dashes="5 4")
    for x, colour in WIRES.values():
        picture.line([(x, top), (x, bottom)], colour, 2.5)
    _resistor(picture, top + ROW)
    _resistor(picture, bottom - ROW)
    y = top + 2 * ROW
    for device in (Drive("the panel's transceiver", PANEL), *listed):
        _device(picture, y, device)
        y += DEVICE + GAP
    picture.down = bottom + EDGE
    return picture


def _resistor(picture, y):
    """Between P+ and N-."""
    begin, end = WIRES["P+"][0], WIRES["N-"][0]
    picture.line([(begin, y), (end, y)], "ink", 2)
    picture.rect(begin + 8, y - 5, end - begin - 16, 10, "paper", edge="ink")
    picture.text(SHIELD[0] - 6, y + 4, RESISTOR, size=FONT, anchor="end")


def _device(picture, y, device):
    """A box, joined to the three wires and the shield."""
    picture.rect(BOX, y, ACROSS - EDGE - BOX, DEVICE, "box", radius=6, edge="line")
    for at, (wire, terminal) in enumerate(zip(WIRES, device.terminals, strict=True)):
        x, colour = WIRES[wire]
        row = y + 11 + at * ROW
        picture.line([(x, row), (BOX, row)], colour, 2)
        picture.shape(f"M{x - 4} {row}a4 4 0 1 0 8 0a4 4 0 1 0 -8 0", colour)
        picture.text(BOX + 8, row + 4, terminal, colour, FONT, bold=True)
    picture.line([(SHIELD[1], y + DEVICE - 5), (BOX, y + DEVICE - 5)], "line", 1.5, dashes="5 4")
    lines = wrapped(device.name, ACROSS - EDGE - NAME - 6, FONT)
    middle = y + DEVICE / 2 - STEP * (len(lines) - 1) / 2 + 4
    picture.lines(NAME, middle, lines, STEP, size=FONT)
