# SPDX-License-Identifier: MIT
"""The picture of 2 x 16 characters. The texts that stand in it: test_languages.py."""

from panel.screen import BUSY, COLUMNS, EDITS, GLYPHS, ROWS, Screen
from uss import families


def shown(width, hundredths, decimals):
    """What stands in a field that was full of something else, as nothing beside it changes."""
    screen = Screen()
    for row in range(ROWS):
        screen.put(row, 0, COLUMNS, b"x" * COLUMNS)
    screen.number(1, 3, width, hundredths, decimals)
    other, row = screen.rows()
    assert other == "x" * 16 and row[:3] == "xxx" and row[3 + width :] == "x" * (13 - width)
    return row[3 : 3 + width]


def test_numbers_stand_at_the_right_of_their_field():
    """Width, hundredths, decimals: what is shown."""
    for width, hundredths, decimals, text in (
        (5, 1000, 1, " 10.0"),
        (6, 998, 2, "  9.98"),
        (6, 0, 2, "  0.00"),
        (6, 5, 2, "  0.05"),
        (6, -5, 2, " -0.05"),
        (6, -1, 2, " -0.01"),
        (6, -1000, 2, "-10.00"),
        (6, 65000, 2, "650.00"),
        (5, 65000, 1, "650.0"),
        (2, 3100, 0, "31"),
        (5, 1005, 1, " 10.1"),  # rounded, half away from zero
        (5, -1005, 1, "-10.1"),
        (5, 1004, 1, " 10.0"),
    ):
        assert shown(width, hundredths, decimals) == text, (width, hundredths, decimals)


def test_a_value_that_needs_more_room_gives_up_decimals():
    assert shown(6, -65000, 2) == "-650.0"
    assert shown(5, -10000, 1) == " -100"
    assert shown(5, -65000, 1) == " -650"
    assert shown(3, 65000, 2) == "650"
    assert shown(3, 5, 2) == "0.1" and shown(2, 50, 1) == " 1"  # no point without a digit


def test_a_value_that_never_fits_is_not_shown_as_a_small_one():
    assert shown(2, 65000, 1) == "99"
    assert shown(3, -65000, 1) == "999"


def test_a_zero_has_no_sign():
    assert shown(5, -4, 1) == "  0.0"


def test_every_frequency_of_a_drive_fits_its_field():
    for centihertz in range(-65000, 65001, 127):
        for width, decimals in ((5, 1), (6, 2)):
            text = shown(width, centihertz, decimals)
            places = len(text.split(".")[1]) if "." in text else 0
            assert abs(float(text) * 100 - centihertz) <= (0.5, 5, 50)[2 - places] + 0.01, text


def test_a_number_with_all_its_digits_begins_with_zeros():
    """A parameter number of one that is being typed; of more digits there are the last ones."""
    screen = Screen()
    for number, text in ((0, "0000"), (7, "0007"), (1089, "1089"), (9, "0009"), (12345, "2345")):
        for row in range(ROWS):
            screen.put(row, 0, COLUMNS, b"x" * COLUMNS)
        screen.digits(1, 3, 4, number)
        assert screen.rows() == ("x" * 16, "xxx" + text + "x" * 9), number


def test_fn_of_a_compact_keypad_stands_over_the_first_places():
    screen = Screen()
    screen.put(0, 0, COLUMNS, b"x" * COLUMNS)
    screen.mark(2)
    assert screen.rows() == ("^^" + "x" * 14, " " * 16)


def test_text_is_cut_or_filled_to_its_field():
    screen = Screen()
    screen.put(0, 2, 4, b"RUNNING")
    screen.put(1, 0, 16, b"READY")
    assert screen.rows() == ("  RUNN          ", "READY           ")
    screen.put(0, 2, 4, b"A")
    assert screen.rows()[0] == "  A             "


def test_the_picture_has_the_size_of_the_display():
    assert len(Screen().picture) == ROWS * COLUMNS == 32


def test_letters_are_those_of_iso_8859_1():
    """Capital umlauts are pictures of the panel's own; other letters may lose their accent."""
    screen = Screen()
    screen.put(0, 0, 16, b"\xc4\xd6\xdc\xe4\xf6\xfc\xdf \xb0\xb5 \xe9\xc7\xa7")
    assert bytes(screen.picture[:14]) == b"\x02\x03\x04\xe1\xef\xf5\xe2 \xdf\xe4 eC?"
    assert screen.rows()[0] == "ÄÖÜäöüß °µ eC?  "
    screen = Screen("A02")
    screen.put(0, 0, 16, b"\xc4\xd6\xdc\xe4\xf6\xfc\xdf \xe9\xc7")
    assert bytes(screen.picture[:10]) == b"\xc4\xd6\xdc\xe4\xf6\xfc\xdf \xe9\xc7"


PICTURES = """
#####   ..#..   .#.#.   .#.#.   .#.#.
#...#   .###.   .....   .....   .....
.#.#.   #.#.#   .###.   .###.   #...#
..#..   ..#..   #...#   #...#   #...#
.#.#.   ..#..   #####   #...#   #...#
#...#   #.#.#   #...#   #...#   #...#
#####   .###.   #...#   .###.   .###.
.....   ..#..   .....   .....   .....
"""


def test_the_pictures_of_our_own_are_an_hourglass_an_arrow_and_three_letters():
    """Of codes 0 to 4, as the display is given their dots: five in a row, eight rows."""
    assert (BUSY, EDITS) == (0, 1) and len(GLYPHS) == 5 * 8
    for row, line in enumerate(PICTURES.strip().split("\n")):
        for code, dots in enumerate(line.split()):
            bits = int(dots.replace("#", "1").replace(".", "0"), 2)
            assert GLYPHS[8 * code + row] == bits, (code, row)


def test_parameter_numbers_fit_their_field():
    for family in families.FAMILIES:
        assert all(0 < number <= 9999 for number, _ in family.shown)
