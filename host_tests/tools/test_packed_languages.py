# SPDX-License-Identifier: MIT
"""A firmware file holds the words of the languages, and says the same as the table does."""

import subprocess

import pytest

from text_bench import columns, rows
from tiers import TIERS, TOP
from tools.deploying import packing
from tools.deploying.image import Firmware

INTERPRETERS = "host"

SAYS = """
import sys
sys.path[:] = sys.argv[1:]
from panel.languages import Language
language = Language("de")
for text in %r:
    print(language.get(text, text))
"""


@pytest.mark.parametrize("tier", ["unix64", "unix32"])
def test_a_firmware_file_says_the_same(tmp_path, tier):
    if not (TOP / "build" / tier / "micropython").exists():
        pytest.skip("no " + tier)
    (tmp_path / "panel/languages").mkdir(parents=True)
    for name in ("panel/__init__.py", "panel/languages/__init__.py", "on_demand.py"):
        (tmp_path / name).write_bytes((TOP / "firmware" / name).read_bytes())
    for path, source in packing.modules(TOP / "firmware").items():
        if path.startswith("panel/"):
            (tmp_path / path).write_text(source)
    texts = [row[0] for row in rows()[1]] + [b"NO SUCH TEXT"]
    spoken = columns()["de"] | {b"NO SUCH TEXT": b"NO SUCH TEXT"}
    done = subprocess.run(
        [*TIERS[tier].command, "-c", SAYS % (texts,), str(tmp_path)],
        cwd=TOP, capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert done.stdout.split("\n")[:-1] == [repr(spoken[text]) for text in texts]


def test_deploying_copies_the_table_as_it_is():
    firmware = Firmware.read(TOP, "pico")
    path = "panel/languages/words.tsv"
    assert firmware.files(0)[path] == (TOP / "firmware" / path).read_bytes()
