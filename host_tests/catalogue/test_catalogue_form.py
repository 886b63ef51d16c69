# SPDX-License-Identifier: MIT
"""The form of the tables: what a person who edits them may get wrong."""

import re

import catalogue
from catalogue_bench import COLUMNS, ORDER, Row, Table, letter
from tiers import TOP

INTERPRETERS = "host"

TABLES = [Table(family) for family in catalogue.FAMILIES]
TYPES = {
    "U16": (0, 0xFFFF), "I16": (-0x8000, 0x7FFF), "U32": (0, 0xFFFFFFFF),
    "I32": (-0x80000000, 0x7FFFFFFF), "BICO": (0, 0xFFFFFFFF), "Float": (-1e38, 1e38),
}  # fmt: skip
CHARACTERS = set(map(chr, range(0x20, 0x7E))) - {"\\"} | set("äöüÄÖÜß°")
NAME_WIDTH, LINE_WIDTH = 16, 60

# At least so many parameters.
COUNTS = {
    "mm440": 250, "mm430": 200, "mm420": 150, "mm410": 100, "g110": 150, "v20": 200, "g120": 40,
    "mm3": 40,
}  # fmt: skip

# All that the documents and lists at hand know of: faults and warnings by family.
MM4_FAULTS = "1-5 11 12 15 20-24 30 35 41 42 51-54 60 70-72 80 85 90 101 221 222 450 452"
MM4_WARNINGS = "501-506 511 512 520-523 535 541 542 590 600 700-711 910-912 920-923 936 952"
MESSAGES = {
    "mm440": (MM4_FAULTS, MM4_WARNINGS),
    "g110": ("1-5 11 51 52 60 72 85", "501-505 511 600 910 911 920 922 923"),
    "v20": (
        "1-6 11 12 20 35 41 51 52 60-64 71 72 80 85 100 101 221 222 350 410 452",
        "501-505 511 600 910-912 920-923 936 952",
    ),
    "mm3": ("1-5 8-13 18 30 31 33 36 74 106 112 151-153 188 201 212 231 255", ""),
    "g120": ("1910 7011 7220 7860 30001-30003", "7012 7400 7805"),
}  # fmt: skip


def numbers(text):
    found = set()
    for part in text.split():
        first, _, last = part.partition("-")
        found |= set(range(int(first), int(last or first) + 1))
    return found


def written_rows():
    """Each row of each table, with the place to look for."""
    for table in TABLES:
        for kind in ORDER:
            for cells in table.rows[kind]:
                yield "%s %s" % (table.family, cells[0]), kind, cells


def test_a_row_has_every_column_and_no_blanks_around_a_cell():
    for place, kind, cells in written_rows():
        assert len(cells) == len(COLUMNS[kind]), (place, cells)
        assert [cell.strip() for cell in cells] == cells, place


def test_keys_ascend_so_that_a_search_finds_them():
    for table in TABLES:
        keys = [line.split("\t")[0] for line in table.lines[1:] if line and line[0] != "#"]
        parts = [(letter(key), *key[1:].partition(".")) for key in keys]
        order = [(kind, int(number), int(value or 0)) for kind, number, _, value in parts]
        for before, after in zip(order, order[1:]):
            assert before < after, (table.family, before, after)


def test_a_key_is_written_as_the_manuals_write_it():
    form = re.compile(r"[AF]\d{1,5}|G\d\d|[Ppr]\d{3,4}|S\d{3}|V\d+\.\d+")
    for place, _kind, cells in written_rows():
        assert form.fullmatch(cells[0]), place


def test_the_display_can_show_every_text():
    for place, kind, cells in written_rows():
        for column, cell in zip(COLUMNS[kind], cells):
            assert set(cell) <= CHARACTERS, (place, cell)
            if column in ("en", "de"):
                assert len(cell) <= NAME_WIDTH, (place, cell)
            elif column != "numbers":
                for line in cell.split("|"):
                    assert len(line) <= LINE_WIDTH, (place, line)


def test_both_languages_say_it():
    for table in TABLES:
        rows = table.parameters() + table.messages()
        rows += [Row(cells) for kind in "GSV" for cells in table.rows[kind]]
        for row in rows:
            texts = [name for name in vars(row) if name.endswith(("en", "de"))]
            for name in texts:
                assert getattr(row, name), (table.family, row.key, name)
            assert len(texts) >= 2
    for place, _, cells in written_rows():
        assert bool(cells[1]) == bool(cells[2]), "%s: one language of two" % place


def test_names_of_one_family_can_be_told_apart_within_a_list():
    for table in TABLES:
        lists = {}
        for cells in table.rows["V"]:
            lists.setdefault(cells[0].split(".")[0], []).append(cells)
        for key, rows in lists.items():
            for language in (1, 2):
                names = [cells[language] for cells in rows]
                assert len(set(names)) == len(names), (table.family, key, names)


def test_every_row_has_a_source_that_the_manual_explains():
    known = set(
        re.findall(r"^\| `(\w+)` \|", (TOP / "firmware/catalogue/README.md").read_text(), re.M)
    )
    for place, _kind, cells in written_rows():
        unsure, source = cells[-2:]
        assert source in known, (place, source)
        assert set(unsure) <= set("ntilda-"), (place, unsure)
    assert {"GK", "PL440"} <= known


def test_types_limits_and_defaults():
    for table in TABLES:
        for row in table.parameters():
            place = "%s %s" % (table.family, row.key)
            smallest, largest = TYPES[row.type]
            assert int(row.indices.split()[0]) >= 1, place
            limits = [catalogue.value(cell.encode()) for cell in (row.lowest, row.highest)]
            if row.key[0] == "r":
                assert (row.lowest, row.highest, row.default, row.states) == ("",) * 4, place
                continue
            assert row.states and set(row.states) <= set("CUT"), place
            if None in limits:
                assert "l" in row.unsure, place
                continue
            assert smallest <= limits[0] <= limits[1] <= largest, place
            defaults = row.default.split(",")
            assert len(defaults) in (1, int(row.indices.split()[0])), place
            for default in defaults:
                known = catalogue.value(default.encode())
                assert known is not None or "d" in row.unsure, place
                assert known is None or limits[0] <= known <= limits[1], place


def test_a_whole_number_has_no_fraction():
    for table in TABLES:
        for row in table.parameters():
            cells = (row.lowest, row.highest, row.default)
            if row.type == "BICO":
                assert all(":" in cell for cell in cells if cell), row.key
            elif row.type != "Float":
                assert "." not in "".join(cells), (table.family, row.key)


def test_the_form_of_a_value_is_known():
    for table in TABLES:
        for row in table.parameters():
            if row.form[0] in "vb":
                texts = list(catalogue.choices(table.family, row.form.encode()))
                assert texts, (table.family, row.key, row.form)
                if row.form[0] == "b":
                    assert [
                        bit for bit in [catalogue.number(text, 1) for text in texts] if bit > 31
                    ] == []
            else:
                assert row.form == "x" or row.form in "012345", (table.family, row.key)
            assert row.level in ("1", "2", "3", "4"), (table.family, row.key)


def test_what_a_list_of_values_offers_lies_between_the_limits():
    for table in TABLES:
        for row in table.parameters():
            if row.form[0] != "v" or row.key[0] == "r" or not row.highest:
                continue
            texts = catalogue.choices(table.family, row.form.encode())
            offered = [catalogue.number(text, 1) for text in texts]
            offered = [value for value in offered if int(row.lowest) <= value <= int(row.highest)]
            assert offered, (table.family, row.key)
            for default in row.default.split(","):
                assert not default or int(default) in offered, (table.family, row.key)


def test_every_list_is_used():
    for table in TABLES:
        used = {row.form[1:] for row in table.parameters() if row.form[0] in "vb"}
        for cells in table.rows["V"]:
            assert cells[0][1:].split(".")[0] in used, (table.family, cells[0])


def test_a_group_has_rows_and_every_parameter_a_group():
    for table in TABLES:
        left = {row.number() for row in table.parameters()}
        for group in catalogue.groups(table.family):
            listed = {catalogue.number(row) for row in
                      catalogue.rows(table.family, group[catalogue.NUMBERS])}  # fmt: skip
            if table.rows["G"]:
                assert listed, (table.family, group)
            left -= listed
        assert not left, (table.family, sorted(left))


def test_how_many_there_are():
    for table in TABLES:
        assert len(table.parameters()) >= COUNTS[table.family], table.family


def test_every_known_fault_and_warning_is_explained():
    for family, (faults, warnings) in MESSAGES.items():
        for number in numbers(faults):
            assert catalogue.fault(family, number), (family, "fault", number)
        for number in numbers(warnings):
            assert catalogue.warning(family, number), (family, "warning", number)


def test_a_step_sets_a_parameter_that_there_is():
    for table in TABLES:
        for step in catalogue.rows(table.family, kind="S"):
            number, index, value = [cell.decode() for cell in step[3:6]]
            row = catalogue.find(table.family, int(number))
            assert row, (table.family, step)
            assert int(index) < catalogue.indices(row), (table.family, step)
            assert value in ("?", "@baud", "@address", "@pkw", "@off") or int(value) >= 0
            if value.isdigit() and row[catalogue.HIGHEST]:
                limits = [catalogue.value(row[column]) for column in (7, 8)]
                assert limits[0] <= int(value) <= limits[1], (table.family, step)


def test_the_head_says_how_many_data_sets_there_are():
    for table in TABLES:
        assert table.head[0] == "=" + table.family and len(table.head) == 5, table.head
        assert table.head[2] in ("",) + catalogue.FAMILIES
        assert not table.head[2] or not Table(table.head[2]).head[2], (
            "like one that is like another"
        )
