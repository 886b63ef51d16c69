# SPDX-License-Identifier: MIT
"""tools/uss backup, restore, compare: a drive in a file, and never half a file for a whole one."""

import io

import pytest

from panel.sets import set_file
from program_bench import Drives, programs
from tools.uss_command.errors import Failure
from tools.uss_command.files.set_file import ParameterSet, Row, read_whole, text_of, write_whole
from uss_command_bench import hubs, uss
from uss_virtual_bench import World

INTERPRETERS = "host"

program = pytest.fixture(programs)
hub = pytest.fixture(hubs)


def run(path, *words):
    return uss(path, "--kind", "mm440", *words, baud=115200)


def test_a_drive_is_saved_changed_compared_and_restored(tmp_path):
    world = World({1: "mm440"})
    file = str(tmp_path / "a.set")
    saved = world.uss(
        "--kind", "mm440", "backup", file, "--name", "pump 3", "--numbers", "0-1399,2000"
    )
    assert saved.status == 0 and saved.json["rows"] >= 200, saved.error
    assert saved.json["family"] == "mm440"
    text = (tmp_path / "a.set").read_text()
    assert "\nfamily mm440\naddress 1\nname pump 3\n" in text
    assert "P1082 0 Float 42480000" in text and "# 50 Hz, Max. frequency" in text
    assert world.uss("--kind", "mm440", "compare", file).status == 0
    dry = world.uss("--kind", "mm440", "restore", file, "--dry-run", as_json=False)
    assert dry.output == "0 would be written, 0 left out\n", "a person is told that, too"
    world.drives[1].write(1120, 0, 7.5)
    world.drives[1].write(2000, 0, 60)
    world.drives[1].write(304, 0, 400)
    differs = world.uss("--kind", "mm440", "compare", file)
    assert differs.status == 1
    shown = {row["parameter"]: (row["here"], row["there"]) for row in differs.rows}
    assert shown.keys() == {"P0304[0]", "P1120[0]", "P2000[0]"}
    assert shown["P1120[0]"] == ("10", "7.5")
    dry = world.uss("--kind", "mm440", "restore", file, "--dry-run")
    assert [row["parameter"] for row in dry.rows] == ["P0304[0]", "P1120[0]"]
    assert world.drives[1].read(1120, 0) == 7.5
    written = world.uss("--kind", "mm440", "restore", file, "--all")
    assert written.status == 0 and written.json["written"] == 3, written.output + written.error
    assert world.drives[1].read(10, 0) == 0, "the commissioning is over"
    assert world.uss("--kind", "mm440", "compare", file).status == 0


def test_the_cable_is_pulled_in_the_middle(program, hub, tmp_path):
    drives = program(Drives, "--baud", "115200", "--address", "1=mm440")
    line = hub(drives.path)
    file = tmp_path / "a.set"
    assert run(line.path, "backup", str(file), "--numbers", "1000-1099").status == 0
    whole = file.read_bytes()
    line.cut_after = 600
    cut = run(line.path, "backup", str(file), "--numbers", "1000-1099")
    assert cut.status == 1 and cut.error.endswith("the line is cut"), cut.error
    assert file.read_bytes() == whole, "the old one is still there"
    assert [path.name for path in tmp_path.iterdir() if "line" not in path.name] == ["a.set"]
    line.plug()
    for number in range(1, 15):
        drives.asked("param 1 P%04d[0] 11.5" % (1000 + number))
    rows = len(read_whole(str(file)).rows)
    line.cut_after = (rows + 9) * 16  # 4 questions first, then 5 of them are written
    cut = run(line.path, "restore", str(file))
    assert cut.status == 1 and "of 14 were written: the drive has a part of the set" in cut.error
    line.plug()
    assert run(line.path, "compare", str(file)).status == 1
    again = run(line.path, "restore", str(file))
    assert again.status == 0, again.error + again.output
    assert run(line.path, "compare", str(file)).status == 0


def test_another_drive_keeps_its_place_on_the_bus(tmp_path):
    world = World({1: "mm440", 2: "mm440"}, parameters={2: {2000: 60.0, 1120: 3.0}})
    file = str(tmp_path / "a.set")
    assert world.uss("--kind", "mm440", "backup", file, "--numbers", "700-2100").status == 0
    dry = world.uss("--kind", "mm440", "--address", "2", "restore", file, "--all", "--dry-run")
    assert [row["parameter"] for row in dry.rows] == ["P1120[0]"]
    assert dry.json["left_out"] == 2  # P2000, P2011
    other = world.uss("--kind", "mm420", "restore", file)
    assert other.status == 1 and "is of a mm440" in other.error


def sample():
    rows = [
        Row(304, 1, "U16", 0, 230, "230 V, Motor voltage"),
        Row(1082, 0, "Float", 0x4222, 0, "40.5 Hz"),
        Row(2019, 0, "BICO", 52, 0, "52:0"),
    ]
    return ParameterSet("mm420", 5, "pump #".strip("# "), {206: (0x4040, 0)}, rows)


def test_the_file_is_what_the_panel_has_but_for_the_remarks(tmp_path):
    bare = text_of(sample(), bare=True)
    assert bare.splitlines() == [
        "USS SET 1", "family mm420", "address 5", "name pump", "panel tools/uss",
        "rating 206 40400000", "P0304 1 U16 00E6", "P1082 0 Float 42220000",
        "P2019 0 BICO 00340000", "end 3 " + bare.split()[-1],
    ]  # fmt: skip
    for text in (bare, text_of(sample(), "MICROMASTER 420"), bare.replace("\n", "\r\n")):
        path = str(tmp_path / "a")
        write_whole(path, text)
        one = read_whole(path)
        assert (one.family, one.address, one.name, one.ratings) == (
            "mm420", 5, "pump", {206: (0x4040, 0)},
        )  # fmt: skip
        assert [row.line() for row in one.rows] == [row.line() for row in sample().rows]


def test_the_panel_reads_the_file_with_and_without_remarks():
    texts = text_of(sample(), "MICROMASTER 420"), text_of(sample(), bare=True)
    for text in texts + (texts[0].replace("\n", "\r\n"),):
        store = Store(text)
        head = set_file.read_head(store, "a.set")
        assert (head.family, head.address, head.name) == ("mm420", 5, b"pump")
        assert head.ratings == {206: (0x4040, 0)}
        read = [row for row in set_file.rows(store, "a.set") if row]
        assert [row[1:] for row in read] == [
            (one.number, one.index, one.kind.encode(), one.high, one.low) for one in sample().rows
        ]


class Store:
    """The panel's flash with one file on it."""

    def __init__(self, text):
        self.text = text.encode()

    def open(self, name):
        return io.BytesIO(self.text)


def test_no_piece_of_a_file_is_taken_for_whole_nor_one_that_was_changed(tmp_path):
    path = tmp_path / "a"
    text = text_of(sample(), "MICROMASTER 420")
    for size in range(len(text) - 1):
        path.write_text(text[:size])
        with pytest.raises(Failure):
            read_whole(str(path))
    for old, new in (("00E6", "00E7"), ("address 5", "address 6"), ("P1082", "P1080"),
                     ("Float", "U32"), ("end 3", "end 2"), ("mm420", "mm440")):  # fmt: skip
        path.write_text(text.replace(old, new, 1))
        with pytest.raises(Failure):
            read_whole(str(path))
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(Failure, match="no parameter set"):
        read_whole(str(path))
