# SPDX-License-Identifier: MIT
"""--drives 1,2=g110,3=v20/4,8=mm420/factory, as ./tools/panel, ./tools/example and ./tools/drive
take it.
"""

import json
import os
import subprocess

import pytest

from program_bench import PANEL, Drives, Panel, programs

INTERPRETERS = "host"

TOP = PANEL[: -len("/tools/panel")]
SIX = "1=mm440,2=g110,3=v20,4=g120,5=mm3,6=generic"

MINE = """
import board
from uss.bus import Master
from uss.families import G110

with Master(board.make_link(19200)) as bus:
    drive = bus.add(2, G110)
    drive.run(20.0)
    print(drive.state, bus.mirror(0), bus.mirror(8))
"""

program = pytest.fixture(programs)


def panel(*words, script="", folder=TOP):
    return subprocess.run(
        [PANEL, *words, "--script", "-"],
        input=script, capture_output=True, text=True, timeout=120, cwd=folder, check=False,
    )  # fmt: skip


def test_each_drive_is_of_its_family_and_supervised():
    asked = (
        ("param 1 P2012[0]", "P2012[0]=2"),
        ("param 2 P2013", "P2013[0]=127"),
        ("param 3 P2010[0]", "P2010[0]=7"),
        ("param 4 P2020", "P2020[0]=7"),
        ("param 5 P092", "P0092[0]=7"),
        ("param 6 P0004[3]", "P0004[3]=4"),
        ("param 7 P2013[0]", "P2013[0]=4"),
    )
    supervised = ("P2014[0]", "P2014", "P2014[0]", "P2040", "P093", "P2014[0]", "P2014[0]")
    script = "".join([command + "\n" for command, _ in asked])
    for address, parameter in enumerate(supervised, 1):
        script += "param %d %s\n" % (address, parameter)
    ended = panel("--drives", "7," + SIX, script=script)
    assert (ended.returncode, ended.stderr) == (0, "")
    lines = ended.stdout.splitlines()
    assert lines[: len(asked)] == [answer for _, answer in asked]
    times = [int(line.split("=")[1]) for line in lines[len(asked) :]]
    times[4] *= 1000  # a MICROMASTER 3 has seconds
    assert min(times) >= 2000 and len(times) == 7, times


def test_a_drive_as_delivered_is_told_about_and_the_panel_knows_nothing_of_it(tmp_path):
    ended = panel(
        "--drives", "2,8=v20/factory", "--settings", "kept.json",
        script="wait 3000\nlcd\ndrive 8\nparam 8 P2010[0]\nparam 8 P2014[0]\n", folder=tmp_path,
    )  # fmt: skip
    assert ended.returncode == 0
    said = "panel: drive 8 is as delivered: it answers at address 1, at 38400 baud, not 19200\n"
    assert ended.stderr == said
    lines = ended.stdout.splitlines()
    assert lines[1] == "|READY        A2 |" and lines[2].startswith("address=1 state=")
    assert " good=0 " in lines[2] and lines[3:] == ["P2010[0]=8", "P2014[0]=2000"]
    kept = json.loads((tmp_path / "kept.json").read_text())
    assert kept["drives"] == [2] and not kept.get("kinds")


def test_one_as_delivered_answers_at_its_own_rate():
    ended = panel(
        "--drives", "3=v20/factory", "--baud", "38400", script="wait 3000\nlcd\ndrive 3\n"
    )
    said = "panel: drive 3 is as delivered: it answers at address 1, at 38400 baud\n"
    assert (ended.returncode, ended.stderr) == (0, said)
    assert "NO CONTACT" not in ended.stdout


FOUND_AND_TAKEN = """
wait 3000
press SET
wait 3000
press SET
wait 40000
press PARAM
wait 500
press SET
wait 8000
"""


@pytest.mark.parametrize(
    "kind, fault, then", (("v20", "FAULT F72", "LOCAL"), ("g120", "FAULT F01910", "READY"))
)
def test_mains_off_and_on_clear_the_fault_of_one_that_obeys_its_terminals(kind, fault, then):
    """TROUBLESHOOTING, a drive as delivered: it trips when it is found, and takes no STOP."""
    script = (
        FOUND_AND_TAKEN + "press STOP\nwait 3000\nlcd\noff 8\nwait 2000\non 8\nwait 4000\nlcd\n"
    )
    ended = panel("--unset", "--drives", "8=%s/factory" % kind, script=script)
    assert ended.returncode == 0
    before, after = ended.stdout.splitlines()[1::2]
    assert fault in before and then in after


def test_two_drives_with_one_address_show_what_troubleshooting_says():
    script = "wait 3000\nline twin 1\n" + 20 * "wait 700\nlcd\n"
    ended = panel("--drives", "1,2", script=script)
    assert ended.returncode == 0
    shown = {row.strip("|").rsplit("A1")[0].strip() for row in ended.stdout.splitlines()[1::2]}
    assert {"CHECKING", "LINE NOISE"} & shown, shown
    assert shown <= {"CHECKING", "LINE NOISE", "READY"}, shown


def test_the_settings_keep_the_kinds_and_the_next_run_simulates_them(tmp_path):
    words = ("--settings", str(tmp_path / "kept.json"))
    drives = "1,2=g110,3=v20/4,7=mm440/4+4"
    ended = panel(*words, "--drives", drives, script="wait 100\n")
    assert (ended.returncode, ended.stderr) == (0, "")
    kept = json.loads((tmp_path / "kept.json").read_text())
    assert kept["drives"] == [1, 2, 3, 7] and kept["baud"] == 19200
    assert kept["kinds"] == {"2": "g110", "3": "v20/4", "7": "mm440/4+4"}
    script = "param 2 P2013\nparam 3 P2013[0]\nparam 7 P2012[0]\n"
    ended = panel(*words, script=script)
    assert (ended.returncode, ended.stderr) == (0, "")
    assert ended.stdout.splitlines() == ["P2013[0]=127", "P2013[0]=4", "P2012[0]=4"]
    ended = panel(*words, "--drives", "1,2,3,7", script="wait 100\n")
    said = "the panel looks for drives 1,2=g110,3=v20/4,7=mm440/4+4; there are 1,2,3,7\n"
    assert ended.returncode == 0 and ended.stderr.endswith(said)


@pytest.mark.parametrize("kinds", ['"x"', "[1]", '{"1": "mm9"}', '{"1": 5}', '{"x": "g110"}'])
def test_kinds_that_nobody_understands_are_left_to_the_panel(tmp_path, kinds):
    path = tmp_path / "kept.json"
    path.write_text('{"drives": [1], "kinds": %s}' % kinds)
    ended = panel("--settings", str(path), script="param 1 P2013[0]\n")
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, "P2013[0]=4\n", "")


def test_a_family_of_the_settings_that_is_not_simulated_is_pointed_out(tmp_path):
    path = tmp_path / "kept.json"
    path.write_text('{"drives": [1, 2], "kinds": {"2": "cu240s"}}')
    ended = panel("--settings", str(path), script="wait 100\n")
    assert ended.returncode == 0
    assert ended.stderr.endswith(" the panel looks for drives 1,2=cu240s; there are 1,2\n")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("1=foo",), "--drives: no family foo: there are mm420"),
        (("1,1=g110",), "--drives: 1 stands there twice"),
        (("5=mm3/4",), "--drives: 5=mm3/4: a MICROMASTER 3 has 3+2 words"),
        (("32=g110",), "--drives: 32 is no address 0...31"),
        (("1,2=v20", "--baud", "2400"), "a SINAMICS V20 has no code for 2400 baud"),
        (
            ("1=mm420/factory", "--port", "/dev/null"),
            "--drives: 1=mm420/factory: a real drive is as it is",
        ),
        (("1=foo", "--port", "/dev/null"), "--drives: no family foo: there are generic mm3 mm410"),
        (("1=foo", "--board", "pico"), "--drives: no family foo: there are mm420"),
    ],
)
def test_what_there_cannot_be_is_refused(words, said):
    ended = panel("--drives", *words)
    assert ended.returncode == 2 and ended.stderr.startswith("panel: " + said), ended.stderr
    assert ended.stderr.count("\n") == 1 and not ended.stdout


def test_thirty_one_known_drives_and_one_as_delivered_are_the_most():
    known = ",".join(map(str, range(1, 32)))
    ended = panel("--drives", known + ",0=mm420/factory", script="wait 100\n")
    assert ended.returncode == 0, ended.stderr
    assert "31 at the most" in panel("--drives", known + ",0=g110").stderr


def test_on_a_real_line_the_families_are_what_the_panel_expects(program, tmp_path):
    drives = program(Drives, "--address", "1,2=g110/0,8=v20/factory")
    kept = tmp_path / "kept.json"
    words = ("--drives", "1,2=g110/0,3=mm430", "--settings", str(kept))
    on_line = program(Panel, drives.path, *words)
    on_line.shows("READY")
    on_line.process.stdin.close()
    assert on_line.ends() in (0, 1)
    stored = json.loads(kept.read_text())
    assert stored["drives"] == [1, 2, 3]
    assert stored["kinds"] == {"2": "g110/0", "3": "mm430"}
    words = ("--port", drives.path, "--settings", str(kept), "--drives", "1,2")
    ended = panel(*words)
    assert ended.returncode == 2
    assert ended.stderr.startswith("panel: --drives: %s says 1,2=g110/0,3=mm430" % kept)


def test_tools_example_takes_the_same(tmp_path):
    path = tmp_path / "mine.py"
    path.write_text(MINE)
    command = [
        os.path.join(TOP, "tools", "example"),
        str(path),
        "--drives",
        "2=g110,8=g110/factory",
    ]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert done.returncode == 0, done.stderr
    told = "(drive 8 is as delivered: it answers at address 0, at 9600 baud, not 19200)\n"
    assert done.stdout.startswith(told + "running False False\n")


def test_tools_drive_takes_the_same(program):
    drives = program(Drives, "--address", "2=g110/3,8=mm420/factory", "--baud", "9600")
    said = "tools/drive: drive 8 is as delivered: it answers at address 0, at 9600 baud"
    assert drives.line() == said
    assert drives.asked("param 2 P2013") == "P2013[0]=3"
    assert drives.asked("param 8 P0700[0]") == "P0700[0]=2"
    assert drives.asked("drive 8").startswith("address=0 ")
