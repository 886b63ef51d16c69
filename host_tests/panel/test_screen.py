# SPDX-License-Identifier: MIT
"""The picture of 2 x 16 characters, and the texts that stand in it."""

from panel import texts
from panel.menu import words as menu_words
from panel.pages import parameter_words, splash
from panel.screen import COLUMNS, ROWS, Screen
from search import words as search_words
from uss import families


def shown(width, hundredths, decimals):
    screen = Screen()
    screen.number(1, 3, width, hundredths, decimals)
    row = screen.rows()[1]
    assert row[:3] == "   " and row[3 + width :] == " " * (13 - width)
    return row[3 : 3 + width]


def test_numbers_stand_at_the_right_of_their_field():
    """Width, hundredths, decimals: what is shown."""
    for width, hundredths, decimals, text in (
        (5, 1000, 1, " 10.0"),
        (6, 998, 2, "  9.98"),
        (6, 0, 2, "  0.00"),
        (6, 5, 2, "  0.05"),
        (6, -5, 2, " -0.05"),
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


def test_text_is_cut_or_filled_to_its_field():
    screen = Screen()
    screen.put(0, 2, 4, b"RUNNING")
    screen.put(1, 0, 16, b"READY")
    assert screen.rows() == ("  RUNN          ", "READY           ")
    screen.put(0, 2, 4, b"A")
    assert screen.rows()[0] == "  A             "


def test_the_picture_has_the_size_of_the_display():
    assert len(Screen().picture) == ROWS * COLUMNS == 32


def all_words(value):
    """The words, in every language, of a text or texts, however deep they stand."""
    if isinstance(value, bytes):
        for column in texts.LANGUAGES.values():
            yield column.get(value, value)
    elif isinstance(value, (tuple, dict)) and value is not texts.LANGUAGES:
        for part in value.values() if isinstance(value, dict) else value:
            yield from all_words(part)


def named_texts():
    """(name, text or texts) of all that the modules of texts have."""
    return [
        (name, getattr(module, name))
        for module in (texts, splash, parameter_words, menu_words, search_words)
        for name in dir(module)
        if name[0] != "_" and name != "NOTHING"
    ]


def test_no_text_is_wider_than_its_place():
    states = (
        "NO_CONTACT LINE_NOISE OTHER_LENGTH WRONG_DRIVE WRONG_CHECK CHECKING NOT_READY READY "
        "STARTING RUNNING STOPPING JOGS_RIGHT JOGS_LEFT FAULT INHIBITED LOCAL RUNS_LOCALLY "
        "LINE_FAILED PANEL_HUNG ENGINE_FAILED STOPPED_ITSELF DID_NOT_START TAKEN_AWAY MAY_RUN"
    ).split()
    values = ("UNREAD_VALUE", "REFUSED_VALUE", "UNKNOWN_VALUE", "BEYOND_VALUE")
    seen = 0
    for name, named in named_texts():
        width = texts.ROW_WIDTH
        if name in states:
            width = texts.STATE_WIDTH
        elif name in values:
            width = texts.VALUE_WIDTH
        elif name == "OTHER_TRIPPED":
            width = texts.ROW_WIDTH - len("A31") - len("01910")
        elif name == "OTHER_REFUSAL":
            width = texts.ROW_WIDTH - len("65535") + len("%d")
        elif name.startswith("OTHER_"):
            width = texts.ROW_WIDTH - len("A31")
        for text in all_words(named):
            assert 0 < len(text.replace(b"A%d", b"")) <= width, (name, text)
            seen += 1
    assert seen > 100, seen


def test_every_text_is_made_of_characters_that_the_display_has():
    """The ROM of the HD44780 has a yen sign for the backslash and an arrow for the tilde."""
    for name, named in named_texts():
        for text in all_words(named):
            for code in text:
                assert 0x20 <= code < 0x7E and chr(code) != "\\", (name, text)


def test_every_state_of_a_drive_fits_beside_its_fault_number():
    """A G120 has the longest: F01910."""
    for words, letter in zip(all_words(texts.FAULT), all_words(texts.FAULT_LETTER)):
        assert len(words) + 1 + len(letter) + 5 <= texts.STATE_WIDTH


def test_parameter_names_fit_their_field():
    for name in (parameter_words.PARAMETER, parameter_words.READ_PARAMETER):
        for words in all_words(name):
            assert len(words) == parameter_words.PARAMETER_WIDTH
    for family in families.FAMILIES:
        assert all(0 < number <= 9999 for number, _ in family.shown)
