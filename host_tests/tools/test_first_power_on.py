# SPDX-License-Identifier: MIT
"""From the first power-on to drives that run, by keys alone, and the spare panel after that.

The script is the example of the manual: ./tools/panel --unset ... --script first_power_on.txt
"""

import json
import os
import re
import subprocess

from tiers import TOP

INTERPRETERS = "host"

PANEL = os.path.join(TOP, "tools", "panel")
SCRIPT = os.path.join(TOP, "tools", "examples", "first_power_on.txt")
LINE = "1,2=g110,3=mm440,4=v20/4,5=g110/4,8=mm420/factory"
KEY_COMMANDS = {"press", "hold", "down", "up", "wait", "expect", "drive"}


def panel(*words, script="-", text="", folder=TOP):
    return subprocess.run(
        [PANEL, *words, "--script", script],
        input=text, capture_output=True, text=True, timeout=240, cwd=folder, check=False,
    )  # fmt: skip


def set_up(folder):
    """The first panel, whose settings are in the file one.json afterwards. What was printed."""
    words = ("--unset", "--baud", "38400", "--drives", LINE, "--settings", "one.json")
    ended = panel(*words, script=SCRIPT, folder=folder)
    assert ended.returncode == 0, ended.stderr
    return re.findall(r"address=(\d+) state=(\w+) hz=(\S+) .*starts=(\d+)", ended.stdout)


def test_a_panel_that_nobody_has_set_up_is_set_up_by_its_keys_alone(tmp_path):
    with open(SCRIPT) as file:
        commands = {line.split()[0] for line in file if line.strip() and line[0] != "#"}
    assert commands == KEY_COMMANDS
    seen = set_up(tmp_path)
    wanted = [("0", "running", "10.00", "1")]  # the one as delivered
    for address in "12345":
        hz = "17.50" if address == "3" else "10.00"
        wanted += [
            (address, "running", hz, "1"),
            (address, "running", "-" + hz, "1"),
            (address, "running", "-5.00", "2"),  # a jog
            (address, "ready", "0.00", "2"),
        ]
    assert seen == wanted
    kept = json.loads((tmp_path / "one.json").read_text())
    assert (kept["baud"], kept["drives"]) == (38400, [1, 2, 3, 4, 5])
    assert kept["kinds"] == {"2": "g110", "4": "v20/4", "5": "g110/4"}


RUN_ALL = "wait 3000\n" + "".join(
    "press START\nwait 6000\ndrive %d\npress ADDRESS_UP\nwait 5000\n" % address
    for address in (5, 2, 4)
)


def test_a_spare_panel_takes_over_the_settings_of_the_first_one(tmp_path):
    """The file is copied; the spare has the same drives, kinds, order and limits."""
    first = {
        "baud": 9600, "drives": [5, 2, 4], "kinds": {"2": "g110", "4": "v20/4"},
        "highest_centihertz": 1200, "setpoint_centihertz": 1100, "second_stop": "none",
    }  # fmt: skip
    (tmp_path / "one.json").write_text(json.dumps(first))
    (tmp_path / "spare.json").write_bytes((tmp_path / "one.json").read_bytes())
    words = ("--settings", "spare.json", "--drives", "2=g110,4=v20/4,5,7")
    more = "press ADDRESS_UP\nwait 1000\nhold UP 3000\nexpect S: 12.0\nwait 4000\ndrive 2\n"
    ended = panel(*words, text=RUN_ALL + more, folder=tmp_path)
    assert ended.returncode == 0, ended.stderr
    seen = re.findall(r"address=(\d+) state=(\w+) hz=(\S+)", ended.stdout)
    assert seen == [
        ("5", "running", "11.00"), ("2", "running", "11.00"), ("4", "running", "11.00"),
        ("2", "running", "12.00"),
    ], seen  # fmt: skip


def test_a_spare_panel_with_a_bad_file_says_so_and_loses_nothing(tmp_path):
    good = '{"baud": 9600, "drives": [5, 2], "kinds": {"2": "g110"}'
    for text, said in (
        (good, "FILE IS NO JSON"),  # it was copied in part
        (good.replace("9600", "9601") + "}", "baud"),
        (good.replace("g110", "g111") + "}", "kinds"),
    ):
        (tmp_path / "spare.json").write_text(text)
        words = ("--settings", "spare.json", "--drives", "2=g110,5")
        script = "wait 1500\nexpect SETTINGS DAMAGED\nwait 3000\nexpect %s\n" % said
        ended = panel(*words, text=script, folder=tmp_path)
        assert ended.returncode == 0, ended.stderr
        aside = tmp_path / "spare.json.bad"  # when the panel had something to write
        assert text in [
            one.read_text() for one in (tmp_path / "spare.json", aside) if one.exists()
        ]
        aside.unlink(missing_ok=True)


def test_unset_wants_a_new_file(tmp_path):
    (tmp_path / "one.json").write_text("{}")
    ended = panel("--unset", "--settings", "one.json", text="wait 1\n", folder=tmp_path)
    assert ended.returncode == 2 and "--unset: one.json holds settings already" in ended.stderr
    assert (tmp_path / "one.json").read_text() == "{}"
    script = "wait 2500\nexpect SET=DO  PARAM=NO\npress PARAM\nwait 3000\nexpect READY        A1\n"
    ended = panel("--unset", "--settings", "two.json", text=script, folder=tmp_path)
    assert ended.returncode == 0, ended.stderr
