# SPDX-License-Identifier: MIT
"""The pictures of the boards, and the Wokwi diagram, against the tables of the board files.

How a picture looks is tried with the others: test_pictures.py.
"""

import json
import re

import pytest

from tiers import TOP
from tools.drawing.__main__ import files
from tools.drawing.layouts import LAYOUTS, RESISTOR, modules, sides
from tools.drawing.picture import picture
from tools.drawing.wires import keep_off, table, wires

INTERPRETERS = "host"


def test_what_is_there_is_what_the_tables_make():
    path = "boards/pico/diagram.json"
    assert (TOP / path).read_text() == files()[path], "python3 tools/drawing makes it anew"


def texts_of(board):
    return [box.text for box in picture(board).texts]


@pytest.mark.parametrize("board", LAYOUTS)
def test_each_wire_and_each_pin_is_in_the_picture(board):
    shown = texts_of(board)
    for side in sides(board):
        for pin in side:
            assert pin in shown, pin
    for what in wires(board).values():
        assert shown.count(what) == 1, what
    form = LAYOUTS[board][1]
    led_out = [pin for side in sides(board) for pin in side]
    for number in wires(board):
        assert form % number in led_out, number


# What a module is joined to, by the constants of the board file.
JOINED = {
    "DI": "BUS_SEND",
    "TXD": "BUS_SEND",
    "RO": "BUS_RECEIVE",
    "RXD": "BUS_RECEIVE",
    "DE, /RE": "DRIVER_ENABLE",
    "LV1": "BACKPACK_SDA",
    "LV2": "BACKPACK_SCL",
}


@pytest.mark.parametrize("board", LAYOUTS)
def test_transceiver_and_level_shifter_are_at_the_pins_of_the_board_file(board):
    names, met = table(board), set()
    for _, left, _ in modules(board):
        for what, pin in left:
            number = re.fullmatch(r"GP(?:IO)?(\d+)", what)
            if number:
                assert int(number[1]) == names[JOINED[pin]], (what, pin)
                met.add(JOINED[pin])
    assert met == {name for name in JOINED.values() if names[name] is not None}


@pytest.mark.parametrize("board", LAYOUTS)
def test_the_resistor_that_silences_the_driver_is_that_of_the_manual(board):
    shown = texts_of(board)
    way = "to ground" if table(board)["DRIVER_ENABLE"] is not None else "to 3V3"
    assert shown.count(f"{RESISTOR[board]} {way}") == 1
    assert RESISTOR[board] in (TOP / "boards" / board / "README.md").read_text()


@pytest.mark.parametrize("board", LAYOUTS)
def test_a_pin_that_has_a_wire_is_not_one_to_leave_alone(board):
    """Or the picture would say so."""
    assert not set(wires(board)) & set(keep_off(board))
    if board == "pico":
        assert texts_of(board).count("no key here") == 1


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
            pin = "2" if "normally closed" in what else "1.l"
            assert joined[number] == what[4:].split(",")[0] + ":" + pin
        else:
            assert number not in joined
    kinds = {part["id"]: part["type"] for part in made["parts"]}
    grounded = {one for one, other, _, _ in made["connections"] if other == "pico:GND.1"}
    # A button of Wokwi closes: with one STOP would be down for ever.
    assert kinds["STOP"] == "wokwi-slide-switch" and "STOP:1" in grounded
    assert kinds["START"] == "wokwi-pushbutton" and "START:2.l" in grounded
    ids = [part["id"] for part in made["parts"]]
    assert len(set(ids)) == len(ids)
