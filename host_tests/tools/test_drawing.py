# SPDX-License-Identifier: MIT
"""The pictures of the boards, and the Wokwi diagram, against the tables of the board files."""

import json
import re

import pytest

from tiers import TOP
from tools.drawing.__main__ import files
from tools.drawing.layouts import LAYOUTS, sides
from tools.drawing.picture import CHARACTER, EDGE, FONT, texts_of
from tools.drawing.wires import table, wires

INTERPRETERS = "host"


@pytest.mark.parametrize("path", files())
def test_what_is_there_is_what_the_tables_make(path):
    assert (TOP / path).read_text() == files()[path], "python3 tools/drawing makes it anew"


@pytest.mark.parametrize("board", LAYOUTS)
def test_no_text_overlaps_another_and_none_leaves_the_picture(board):
    boxes = []
    for x, y, text, _ in texts_of(board):
        box = (x, y - FONT, x + len(text) * CHARACTER, y + FONT // 3)
        assert box[0] >= 0 and box[2] <= EDGE, text
        for other in boxes:
            apart = (
                box[2] <= other[0]
                or other[2] <= box[0]
                or box[3] <= other[1]
                or other[3] <= box[1]
            )
            assert apart, (text, other)
        boxes.append(box)


@pytest.mark.parametrize("board", LAYOUTS)
def test_each_wire_and_each_pin_is_in_the_picture(board):
    shown = [text for _, _, text, _ in texts_of(board)]
    for side in sides(board):
        for pin in side:
            assert pin in shown, pin
    for what in wires(board).values():
        assert shown.count(what) == 1, what
    form = LAYOUTS[board][1]
    led_out = [pin for side in sides(board) for pin in side]
    for number in wires(board):
        assert form % number in led_out, number


def rows_of_manual(board):
    """{number: what} of the table of pins in a board's README."""
    text = (TOP / "boards" / board / "README.md").read_text()
    section = text.split("## Pins")[1].split("\n\n")[1]
    found = {}
    for line in section.splitlines()[2:]:
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        step = 3 if board == "pico" else 2
        for at in range(0, len(cells) - 1, step):
            number = re.fullmatch(r"(?:GP)?(\d+)", cells[at])
            if number:
                found[int(number[1])] = cells[at + step - 1]
    return found


@pytest.mark.parametrize("board", ["pico", "esp32s3", "esp32"])
def test_the_table_of_the_manual_is_that_of_the_board_file(board):
    told = rows_of_manual(board)
    names = table(board)
    for number, what in wires(board).items():
        if what.startswith("key "):
            assert told[number] == what, number
        elif what.startswith("LCD"):
            assert what in told[number]
        else:
            assert told[number] and not told[number].startswith("free"), number
    free = [number for number, what in told.items() if what.startswith("free")]
    assert not set(free) & set(wires(board)), free
    assert names["BUS_SEND"] in told


def test_wokwi_has_the_same_wires():
    made = json.loads(files()["boards/pico/diagram.json"])
    joined = {}
    for one, other, _, _ in made["connections"]:
        if other.startswith("pico:GP"):
            joined[int(other[len("pico:GP") :])] = one
    for number, what in wires("pico").items():
        if what.startswith("LCD "):
            assert joined[number] == "lcd:" + what[4:]
        elif what.startswith("key "):
            assert joined[number] == what[4:].split(",")[0] + ":1.l"
        else:
            assert number not in joined
    ids = [part["id"] for part in made["parts"]]
    assert len(set(ids)) == len(ids)
