# SPDX-License-Identifier: MIT
"""What an operator does with the keys of the panel alone: each script of tools/examples, run by
the command that stands at its head.

They read the display at each step (`expect`); here is what must be true of the drives afterwards.
"""

import os
import re
import shlex
import subprocess

import pytest

from tiers import PACKAGED, TOP

INTERPRETERS = "host"

FOLDER = os.path.join(TOP, "tools", "examples")
SCRIPTS = sorted(name for name in os.listdir(FOLDER) if name.endswith(".txt"))
BY_KEYS = {"press", "hold", "wait", "expect", "lcd"}
# What looks at a simulated drive, or happens to it: no key, and nothing that the panel hears of.
HAPPENS = {"drive", "param", "fault", "warn", "off", "on", "unplug", "plug"}
MUST_PRINT = {  # in this order
    "commission.txt": [
        "|A0 9600 MM420   |", "|>ALL DONE       |", "|RUNNING      A0 |",
        "state=running hz=10.00", "P0304[0]=230", "P0305[0]=2.9", "P0307[0]=0.55",
        "P1120[0]=5.0", "state=ready hz=0.00",
    ],
    "fault_and_warning.txt": [
        "|FAULT F0001  A1 |", "|>Overcurrent    |", "|>Short circuit  |", "|>Check cable,   |",
        "|READY        A1 |", "state=ready hz=0.00", "|>F0001 Overcurre|",
        "state=running hz=10.00", "|A0501       1/16|", "|>Current limit  |",
        "|CAUSE       2/16|", "|>The motor takes|", "|REMEDY      9/16|", "|>Check          |",
    ],
    "no_answer.txt": [
        "|OTHER LENGTH A4 |", "|>PKW 127 WORDS  |", "P2011[0]=9", "|NO CONTACT   A4 |",
        "|>P2011 = 4      |", "|>A9  ANSWERS    |", "|A9: P2011=4     |", "|>NO REPLY       |",
        "|A4 MIRROR TEST  |", "|>NOBODY         |", "address=4 state=running hz=10.00",
    ],
    "parameter.txt": [
        "state=running hz=10.00", "|r0027      1.63A|", "|P1120     10.00s|",
        "|WRITTEN (EEPROM)|", "P1120[0]=2.5", "|P1120      2.50s|", "P1120[0]=2.5",
    ],
    "parameter_set.txt": [
        "|>SAVED: 422     |", "|3 DIFFER     1/4|", "|>10>2.5         |", "|>WRITTEN, EQUAL |",
        "P1120[0]=2.5", "P1001[0]=17.5", "P1082[0]=45.0", "P2011[0]=2", "P2014[0]=2000",
        "P1120[0]=2.5", "address=2 state=running",
    ],
}  # fmt: skip


def lines(name):
    with open(os.path.join(FOLDER, name), encoding="utf-8") as file:
        return file.read().splitlines()


def command(name):
    """The command at its head, as words."""
    head = "\n".join(line[1:] for line in lines(name) if line[:1] == "#")
    found = re.search(r"\./tools/panel (?:.*\\\n)*.*", head)[0]
    return shlex.split(found.replace("\\\n", " "))


@pytest.mark.parametrize("name", sorted(MUST_PRINT))
def test_an_operator_does_it_by_keys_alone(name):
    words = command(name)
    assert words[words.index("--script") + 1] == "tools/examples/" + name
    ended = subprocess.run(
        words, cwd=TOP, capture_output=True, text=True, timeout=240, check=False
    )
    assert ended.returncode == 0, ended.stdout + ended.stderr
    printed = ended.stdout
    for wanted in MUST_PRINT[name]:
        before, _, printed = printed.partition(wanted)
        assert printed, "%s is missing behind:\n%s" % (wanted, before or ended.stdout)


@pytest.mark.skipif(not PACKAGED.exists(), reason="fetched with USS_STRICT=1 tools/test")
def test_on_the_micropython_of_debian_it_is_the_same():
    """In CI unix64 is built here; those who only want to see the panel have the package."""
    environment = {**os.environ, "MICROPYPATH": "%s:%s/firmware:.frozen" % (TOP, TOP)}
    panel = [PACKAGED, "-X", "heapsize=16M", "tools/live/virtual_panel.py"]
    words = command("parameter.txt")
    printed = [
        subprocess.run(
            [*program, *words[1:]], cwd=TOP, env=environment, capture_output=True, timeout=240
        ).stdout
        for program in (panel, words[:1])
    ]
    assert printed[0] == printed[1] and b"WRITTEN" in printed[0], printed


@pytest.mark.parametrize("name", sorted(MUST_PRINT))
def test_nothing_but_keys_moves_the_panel(name):
    commands = [line.split() for line in lines(name) if line and line[0] != "#"]
    assert {words[0] for words in commands} <= BY_KEYS | HAPPENS
    changed = [words[2].split("[")[0] for words in commands if words[0] == "param" and words[3:]]
    allowed = {  # what somebody has done to the drive before
        "no_answer.txt": {"P2013", "P2011"},
        "parameter_set.txt": {"P1120", "P1001", "P1082", "P2014"},
    }
    assert set(changed) <= allowed.get(name, set())
    assert sum(words[0] == "expect" for words in commands) > 10


def test_each_is_named_in_the_manuals():
    for manual in ("firmware/panel/README.md", "tools/README.md"):
        with open(os.path.join(TOP, manual), encoding="utf-8") as file:
            text = file.read()
        for name in SCRIPTS:
            assert "examples/%s" % name in text, (manual, name)
