# SPDX-License-Identifier: MIT
"""The dots of the display's characters, beside what a person sees in them."""

import pytest

from boards.sim.chip.lcd import LOOKS, ROM
from tools.pictures.rom import COLUMNS, ROWS, rom, rows_of

INTERPRETERS = "host"

SEEN = {
    0x41: ".###. #...# #...# #...# ##### #...# #...# .....",
    0x52: "####. #...# #...# ####. #.#.. #..#. #...# .....",
    0x31: "..#.. .##.. ..#.. ..#.. ..#.. ..#.. .###. .....",
    0x67: "..... .#### #...# #...# .#### ....# .###. .....",
    0x5C: "#...# .#.#. ##### ..#.. ##### ..#.. ..#.. .....",
    0x7E: "..... ..#.. ...#. ##### ...#. ..#.. ..... .....",
    0x7F: "..... ..#.. .#... ##### .#... ..#.. ..... .....",
    0xA5: "..... ..... ..... .##.. .##.. ..... ..... .....",
    0xDF: "###.. #.#.. ###.. ..... ..... ..... ..... .....",
    0xE1: ".#.#. ..... .###. ....# .#### #...# .#### .....",
    0xE2: "..... ..... .###. #...# ####. #...# ####. #....",
    0xE4: "..... ..... #...# #...# #...# #..## ###.# #....",
    0xEE: ".###. ..... #.##. ##..# #...# #...# #...# .....",
    0xEF: ".#.#. ..... .###. #...# #...# #...# .###. .....",
    0xF5: ".#.#. ..... #...# #...# #...# #...# #..## .##.#",
    0xFD: "..... ..#.. ..... ##### ..... ..#.. ..... .....",
    0xFF: "##### ##### ##### ##### ##### ##### ##### #####",
}


def seen(rows):
    dots = (format(row, "05b") for row in rows)
    return " ".join(dots).replace("0", ".").replace("1", "#")


def test_all_codes_that_the_rom_has_are_there_and_no_other():
    assert list(rom()) == [*range(0x20, 0x80), *range(0xA0, 0x100)]


def test_each_character_is_eight_rows_of_five_dots():
    for code, rows in rom().items():
        assert len(rows) == ROWS and all(0 <= row < 1 << COLUMNS for row in rows), hex(code)


@pytest.mark.parametrize("code", [*SEEN])
def test_a_character_looks_as_in_the_data_sheet(code):
    assert seen(rom()[code]) == SEEN[code]


def test_the_characters_that_differ_from_ascii_are_tried():
    assert set(ROM) <= set(SEEN)


def test_the_simulated_display_has_no_character_twice():
    blank = [code for code, rows in rom().items() if not any(rows)]
    assert blank == [0x20, 0xA0, 0xFE]
    drawn = [tuple(rows) for rows in rom().values() if any(rows)]
    alike = {rows for rows in drawn if drawn.count(rows) > 1}
    assert alike == {(0, 0, 0, 31, 0, 0, 0, 0)}  # minus, and the Japanese sign of a long vowel


def test_the_codes_below_sixteen_come_from_the_memory_of_the_display():
    hourglass = next(dots for dots, look in LOOKS.items() if look == "⧗")
    cgram = bytes(8) + hourglass + bytes(48)
    assert rows_of(1, cgram, rom()) == rows_of(9, cgram, rom()) == list(hourglass)
    assert rows_of(0x41, cgram, rom()) == rom()[0x41]
