# SPDX-License-Identifier: MIT
"""The reader of the catalogue: what the panel and a program ask it."""

import gc
import sys

import catalogue
from catalogue import (
    DE,
    DEFAULT,
    EN,
    FORM,
    HIGHEST,
    INDICES,
    LINE,
    NAME,
    NUMBERS,
    REMEDY,
    SOURCE,
    UNIT,
    UNSURE,
)

MICROPYTHON = sys.implementation.name == "micropython"
RAM_BYTES = 4096  # the bar on a chip, with everything that stays


def test_a_parameter_has_its_name_in_both_languages():
    row = catalogue.find("mm440", 1120)
    assert row[NAME + EN] == b"Ramp-up time"
    assert row[NAME + DE] == b"Hochlaufzeit"
    assert row[UNIT] == b"s" and catalogue.value(row[HIGHEST]) == 650


def test_a_number_that_a_drive_does_not_have():
    assert catalogue.find("mm440", 1) is None
    assert catalogue.find("mm440", 9999) is None
    assert catalogue.fault("mm440", 9) is None and catalogue.warning("mm440", 9) is None


def test_the_first_and_the_last_row_of_each_kind_are_found():
    for family in catalogue.FAMILIES:
        numbers = [catalogue.number(row) for row in catalogue.rows(family)]
        for number in (numbers[0], numbers[-1], numbers[len(numbers) // 2]):
            assert catalogue.number(catalogue.find(family, number)) == number, family
        for kind, look in (("F", catalogue.fault), ("A", catalogue.warning)):
            for row in catalogue.rows(family, kind=kind):
                assert look(family, catalogue.number(row)) == row, (family, row[0])


def test_a_search_finds_every_parameter():
    for row in catalogue.rows("mm440"):
        assert catalogue.find("mm440", catalogue.number(row)) == row, row


def test_a_family_that_nobody_knows():
    for ask in (
        lambda family: list(catalogue.groups(family)),
        lambda family: catalogue.find(family, 1),
    ):
        try:
            ask("mm5")
        except ValueError as error:
            assert "mm5" in str(error)
        else:
            raise AssertionError("no error")


def test_an_umlaut_is_one_byte():
    row = catalogue.fault("mm440", 1)
    assert row[NAME + DE] == b"\xdcberstrom"  # ISO 8859-1


def test_a_remedy_is_lines_for_the_display():
    lines = catalogue.fault("mm440", 72)[REMEDY + EN].split(LINE)
    assert len(lines) == 2 and max([len(line) for line in lines]) <= 60


def test_what_the_values_of_a_parameter_are_called():
    form = catalogue.find("mm440", 700)[FORM]
    texts = {catalogue.number(row, 1): row[NAME + EN] for row in catalogue.choices("mm440", form)}
    assert form == b"v700" and texts[5] == b"USS on COM link" and 3 not in texts


def test_a_connector_is_as_the_drive_has_it():
    row = catalogue.find("mm440", 840)
    assert catalogue.value(row[DEFAULT]) == 722 << 16


def test_an_empty_cell_is_no_value():
    assert catalogue.value(catalogue.find("mm440", 27)[HIGHEST]) is None
    assert catalogue.value(b"0.01") == 0.01 and catalogue.value(b"-650") == -650


def test_a_group_lists_numbers_in_the_order_of_a_menu():
    for group in catalogue.groups("mm440"):
        if group[NAME + EN] == b"Ramps":
            found = [catalogue.number(row) for row in catalogue.rows("mm440", group[NUMBERS])]
            assert found[:3] == [1120, 1121, 1124], found
            return
    raise AssertionError("no such group")


def test_the_steps_that_make_a_drive_ready():
    link = [row[3:6] for row in catalogue.steps("mm440", 1)]
    assert [b"2011", b"0", b"@address"] in link and [b"700", b"0", b"5"] in link
    motor = [row[3] for row in catalogue.steps("mm440", 3)]
    assert motor[1] == b"10" and b"304" in motor and b"3900" in motor


def test_data_sets_are_indices():
    assert catalogue.indices(catalogue.find("mm440", 304)) == 3
    assert catalogue.indices(catalogue.find("mm440", 10)) == 1


def test_a_family_says_only_what_is_different():
    like, row = catalogue.find("mm440", 1000), catalogue.find("mm420", 1000)
    assert row[NAME + DE] == like[NAME + DE] == b"Sollwertquelle"
    assert (like[HIGHEST], row[HIGHEST]) == (b"77", b"66")
    assert catalogue.fault("mm420", 1) == catalogue.fault("mm440", 1)[:SOURCE] + [b"GK"]


def test_a_family_says_that_there_is_nothing():
    assert catalogue.find("mm440", 207)[UNSURE] == b"i"
    assert catalogue.find("mm420", 207)[UNSURE] == b""


def test_a_family_has_no_more_than_stands_in_its_table():
    assert catalogue.find("mm440", 1240) and catalogue.find("mm440", 1460)
    assert catalogue.find("mm420", 1240) and catalogue.find("mm420", 1460) is None
    assert catalogue.warning("mm440", 590) and catalogue.warning("mm420", 590) is None


def test_one_data_set_where_a_family_has_no_more():
    assert catalogue.find("mm440", 304)[INDICES] == b"3 DDS"
    assert catalogue.find("mm420", 304)[INDICES] == b"1 DDS"
    assert catalogue.find("mm440", 700)[INDICES] == b"3 CDS"


def test_a_list_of_values_is_replaced_as_a_whole():
    own = [catalogue.number(row, 1) for row in catalogue.choices("mm420", b"v1000")]
    assert 6 in own and 7 not in own  # no second analog input
    assert len(list(catalogue.choices("mm420", b"v2009"))) == 2  # that of the MM440
    assert list(catalogue.steps("mm430", 1)) == list(catalogue.steps("mm440", 1))


def test_a_step_of_the_main_loop_asks_for_a_piece():
    pieces = list(catalogue.rows("mm440", b"1120-1121", paced=True))
    assert pieces[0] is None  # it has looked once
    assert len(pieces) < 20, len(pieces)
    assert [catalogue.number(row) for row in pieces if row] == [1120, 1121]


def look_around(module):
    for family in module.FAMILIES:
        module.find(family, 10)
        for group in module.groups(family):
            for _ in module.rows(family, group[NUMBERS]):
                break


def test_the_tables_stay_in_flash():
    """What the catalogue takes on a chip beside the panel, which knows many of its words."""
    if not MICROPYTHON:
        return
    import micropython

    sys.path.insert(0, "firmware")  # what is compiled already has the numbers of lines
    import app  # noqa: F401

    sys.modules.pop("catalogue")
    micropython.opt_level(3)  # without the numbers of lines, as it is put onto a chip
    gc.collect()
    before = gc.mem_alloc()
    module = __import__("catalogue")
    look_around(module)
    gc.collect()
    cost = gc.mem_alloc() - before
    micropython.opt_level(0)
    sys.path.pop(0)
    print("the catalogue costs", cost, "bytes")
    if sys.maxsize < 1 << 31:  # where a pointer has 4 bytes, as on the chip
        assert cost < RAM_BYTES, cost
