# SPDX-License-Identifier: MIT
"""The tables as a firmware file carries them: packed constants, without a file beside them."""

import subprocess

import pytest

import catalogue
from tiers import TIERS, TOP
from tools.deploying import packing
from tools.deploying.image import Firmware

INTERPRETERS = "host"

# Prints a line for each row of each table, and what single questions find.
EVERYTHING = """
import sys
sys.path[:] = sys.argv[1:]
import catalogue
for family in catalogue.FAMILIES:
    for kind in "AFGPSV":
        for row in catalogue.rows(family, kind=kind):
            print(family, row)
            if kind in "AFP" and catalogue.number(row) % 10 == 1:
                assert catalogue.find(family, catalogue.number(row), kind) == row
    for group in catalogue.groups(family):
        print([catalogue.number(row) for row in catalogue.rows(family, group[3])])
    print(catalogue.find(family, 9998), [len(list(catalogue.choices(family, b"v3")))])
"""

PACED = """
import sys
sys.path[:] = sys.argv[1:]
import catalogue
print([row and catalogue.number(row) for row in catalogue.rows("mm440", b"1120-1121", paced=True)])
"""

# The first that a panel looks up, and all of it: the family that it is like comes with it.
FIRST = """
import sys
family = sys.argv[1]
sys.path[:] = sys.argv[2:]
import catalogue
print(list(catalogue.rows(family, b"700-1120")))
"""


def firmware_without_tables(folder):
    """Where the interpreter finds the firmware as it is in a firmware file, by its name, too."""
    folder = folder / ".frozen"
    (folder / "catalogue").mkdir(parents=True)
    for name in ("catalogue/__init__.py", "catalogue/packed.py", "on_demand.py"):
        (folder / name).write_bytes((TOP / "firmware" / name).read_bytes())
    for path, source in packing.modules(TOP / "firmware").items():
        if path.startswith("catalogue/"):
            (folder / path).write_text(source)
    return folder


def run(tier, program, *folders):
    command = [*TIERS[tier].command, "-c", program, *map(str, folders)]
    done = subprocess.run(command, cwd=TOP, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.parametrize("tier", ["unix64", "unix32"])
def test_packed_tables_say_the_same(tmp_path, tier):
    if not (TOP / "build" / tier / "micropython").exists():
        pytest.skip("no " + tier)
    packed = run(tier, EVERYTHING, firmware_without_tables(tmp_path))
    assert packed.count("\n") > 3000
    assert packed == run(tier, EVERYTHING, "firmware")


@pytest.mark.parametrize("family", catalogue.FAMILIES)
def test_any_family_may_be_the_first_one(tmp_path, family):
    packed = run("unix64", FIRST, family, firmware_without_tables(tmp_path))
    assert len(packed) > 500 and packed == run("unix64", FIRST, family, "firmware")


def test_a_packed_table_is_searched_by_its_index(tmp_path):
    pieces = run("unix64", PACED, firmware_without_tables(tmp_path))
    assert pieces.endswith("None, 1120, None, None, 1121]\n") and pieces.count("None") < 40, pieces


def test_a_block_is_small_enough_to_be_unpacked():
    for family in catalogue.FAMILIES:
        table = (TOP / "firmware/catalogue" / (family + ".tsv")).read_bytes()
        rows = [line for line in table.splitlines(keepends=True) if line[:1] != b"#"][1:]
        blocks = list(packing.blocks(rows))
        assert max(len(block) for _, block in blocks) <= packing.BLOCK_BYTES
        assert b"".join(block for _, block in blocks) == b"".join(rows)


def test_deploying_copies_the_tables_as_they_are():
    firmware = Firmware.read(TOP, "pico")
    firmware.compile(lambda path, source: b"M\x06\x00\x1f" + path.encode())
    for files in (firmware.files(0), firmware.compiled_files()):
        for family in catalogue.FAMILIES:
            path = "catalogue/%s.tsv" % family
            assert files[path] == (TOP / "firmware" / path).read_bytes()
