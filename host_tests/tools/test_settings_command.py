# SPDX-License-Identifier: MIT
"""tools/settings with a file; with a chip: pico/test_pico_settings_command.py."""

import json
import os
import stat
import subprocess
import types

import pytest

import settings_file
from tiers import TOP
from tools.deploying import ports
from tools.deploying.errors import DeployError

INTERPRETERS = "host"

COMMAND = TOP / "tools" / "settings"
EXAMPLES = TOP / "tools" / "examples" / "settings"
PICO, S3 = (0x2E8A, 0x0005), (0x303A, 0x4001)


@pytest.fixture
def settings(tmp_path):
    """Calls it for tmp_path/panel.json."""

    def call(*words, status=0, **environment):
        ended = subprocess.run(
            [COMMAND, "--file", "panel.json", *map(str, words)],
            cwd=tmp_path, capture_output=True, text=True, stdin=subprocess.DEVNULL,
            env={**os.environ, **environment},
        )  # fmt: skip
        assert ended.returncode == status, ended.stderr
        assert "Traceback" not in ended.stderr
        return ended

    return call


def stored(folder):
    return json.loads((folder / "panel.json").read_text())


def test_every_setting_is_shown_with_its_meaning_and_limits(settings):
    ended = settings("get")
    rows = [line.split(" = ")[0] for line in ended.stdout.splitlines()]
    assert rows == list(settings_file.DEFAULTS)
    for name, _, lowest, highest, meaning in settings_file.NUMBERS:
        assert f"# {meaning}; {lowest}...{highest}\n" in ended.stdout, name
    for name, _, choices, meaning in settings_file.CHOICES:
        assert f"# {meaning}; {' '.join(map(str, choices))}\n" in ended.stdout, name
    assert "no file of settings yet" in ended.stderr


def test_the_file_may_be_named_behind_the_command(settings, tmp_path):
    """Whichever of the two comes to mind first. The last one counts."""
    settings("set", "baud=9600", "--file", "other.json")
    assert json.loads((tmp_path / "other.json").read_text())["baud"] == 9600
    assert not (tmp_path / "panel.json").exists()


def test_for_programs_it_is_json(settings):
    assert json.loads(settings("get", "--json").stdout)["baud"] == 19200
    assert json.loads(settings("get", "baud", "lost_ms", "--json").stdout) == {
        "baud": 19200,
        "lost_ms": 1000,
    }


def test_settings_are_changed_in_every_way_in_which_one_writes_them(settings, tmp_path):
    settings("set", "baud=9600", "drives=1,2,5", "kinds.2=g110", "second_stop=none")
    assert stored(tmp_path)["baud"] == 9600 and stored(tmp_path)["second_stop"] == "none"
    assert stored(tmp_path)["drives"] == [1, 2, 5] and stored(tmp_path)["kinds"] == {"2": "g110"}
    settings("set", "kinds.5=v20/4", "repeats.1=2", "favourites.mm440=700,1120")
    assert stored(tmp_path)["kinds"] == {"2": "g110", "5": "v20/4"}
    assert stored(tmp_path)["favourites"] == {"mm440": [700, 1120]}
    settings("set", "kinds.2=", "repeats=", 'favourites={"g110": [1]}', "drives=[7]")
    assert stored(tmp_path)["kinds"] == {"5": "v20/4"} and stored(tmp_path)["repeats"] == {}
    assert stored(tmp_path)["favourites"] == {"g110": [1]} and stored(tmp_path)["drives"] == [7]
    before = (tmp_path / "panel.json").stat()
    assert "nothing is written" in settings("set", "baud=9600").stderr
    assert (tmp_path / "panel.json").stat().st_ino == before.st_ino


def test_the_panel_reads_what_was_written(settings, tmp_path):
    settings("set", "drives=4", "baud=38400")
    ended = subprocess.run(
        [TOP / "tools" / "panel", "--settings", tmp_path / "panel.json", "--script", "-"],
        input="wait 1500\nexpect READY        A4\n", capture_output=True, text=True,
    )  # fmt: skip
    assert (ended.returncode, ended.stderr) == (0, "")


@pytest.mark.parametrize(
    ("word", "why"),
    [
        ("baud=14400", "baud: 14400 is none of 300 600 1200"),
        ("baud=fast", "baud: 'fast' is none of 300"),
        ("lost_ms=99", "lost_ms: 99 is not 100...5000"),
        ("lost_ms=5001", "lost_ms: 5001 is not 100...5000"),
        ("lost_ms=-5", "lost_ms: '-5' is not 100...5000"),
        ("drives=1,32", "drives: [1, 32] are not up to 31 addresses 0...31"),
        ("drives=1,1", "drives: [1, 1] are not up to 31 addresses 0...31"),
        ("drives=", "drives: [] are not up to 31"),
        ("kinds.3=coffee", "kinds: no family coffee: there are generic mm3"),
        ("kinds.32=g110", "kinds: '32' is no address 0...31"),
        ("repeats.1=5", "repeats: 5 is not 2...4"),
        ("kinds=g110", "kinds: say kinds.1=VALUE, or kinds="),
        ("baud.1=9600", "baud has no parts: say baud=VALUE"),
        ("bautrate=9600", "there is no setting bautrate: there are baud second_stop"),
        ("lowest_centihertz=65001", "lowest_centihertz: 65001 is not 0...65000"),
    ],
)
def test_what_cannot_be_is_refused_with_its_limits(settings, tmp_path, word, why):
    settings("set", "baud=9600")
    before = (tmp_path / "panel.json").read_bytes()
    ended = settings("set", "log=JSON", word, status=2)
    assert ended.stderr.startswith(f"tools/settings: {why}"), ended.stderr
    assert ended.stderr.count("\n") == 1 and ended.stdout == ""
    assert (tmp_path / "panel.json").read_bytes() == before


def test_two_limits_that_do_not_fit_are_refused_together_with_the_file(settings, tmp_path):
    settings("set", "highest_centihertz=3000")
    ended = settings("set", "lowest_centihertz=4000", status=2)
    assert "lowest_centihertz: 4000 is above highest_centihertz: 3000" in ended.stderr


def test_what_a_newer_firmware_has_stored_stays(settings, tmp_path):
    (tmp_path / "panel.json").write_text('{"new": [1,  2], "baud": 9600}')
    settings("set", "baud=19200")
    assert '"new": [1,  2]' in (tmp_path / "panel.json").read_text()
    assert stored(tmp_path)["baud"] == 19200


def test_a_wrong_value_in_the_file_is_told_and_can_be_put_right(settings, tmp_path):
    damaged = '{"baud": 14400, "drives": [3]}'
    (tmp_path / "panel.json").write_text(damaged)
    assert "SETTINGS DAMAGED: baud: 14400 is none of" in settings("get", status=2).stderr
    assert "baud: 14400 is none of" in settings("set", "lost_ms=500", status=2).stderr
    settings("set", "baud=9600")
    assert stored(tmp_path)["drives"] == [3] and stored(tmp_path)["baud"] == 9600
    assert (tmp_path / "panel.json.bad").read_text() == damaged


def test_a_file_that_is_no_json_is_left_alone_until_it_is_edited(settings, tmp_path):
    (tmp_path / "panel.json").write_text('{"baud": 9600')
    ended = settings("set", "lost_ms=500", status=2)
    assert "the settings are damaged (it ends too soon): edit them" in ended.stderr
    settings("edit", EDITOR="sed -i s/9600/9600}/")
    assert stored(tmp_path) == {"baud": 9600}
    assert (tmp_path / "panel.json.bad").read_text() == '{"baud": 9600'


def test_an_editor_sees_all_settings_and_what_it_leaves_is_checked(settings, tmp_path):
    editor = tmp_path / "an editor"
    editor.write_text('#!/bin/sh\ncat "$2" >shown\nsed -i "s/$1/" "$2"\n')
    editor.chmod(0o755)
    settings("edit", VISUAL=f"'{editor}' 19200/9600")
    assert json.loads((tmp_path / "shown").read_text())["baud"] == 19200
    assert stored(tmp_path)["baud"] == 9600
    ended = settings("edit", VISUAL=f"'{editor}' 9600/14400", status=2)
    assert "baud: 14400 is none of" in ended.stderr and stored(tmp_path)["baud"] == 9600
    where = ended.stderr.split("what you typed is in ")[1].strip()
    with open(where) as typed:
        assert json.load(typed)["baud"] == 14400
    os.remove(where)
    assert "Nothing was changed." in settings("edit", VISUAL="true").stderr
    assert "false ended with status 1" in settings("edit", VISUAL="false", status=2).stderr
    gone = settings("edit", VISUAL="/no/such/editor", status=2).stderr
    assert "/no/such/editor: No such file or directory" in gone


def test_settings_and_sets_go_out_and_in(settings, tmp_path):
    settings("set", "drives=1,2")
    (tmp_path / "1.set").write_bytes((EXAMPLES / "pump.set").read_bytes())
    settings("out", "kept")
    assert sorted(os.listdir(tmp_path / "kept")) == ["1.set", "settings.json"]
    assert stored(tmp_path)["drives"] == [1, 2]
    settings("out", "kept")  # the same once more
    settings("set", "drives=1")
    ended = settings("out", "kept", status=2)
    assert "kept/settings.json is there already, and differs" in ended.stderr
    (tmp_path / "1.set").unlink()
    settings("in", "kept/settings.json", "kept/1.set")
    assert stored(tmp_path)["drives"] == [1, 2] and (tmp_path / "1.set").exists()
    assert stat.S_IMODE((tmp_path / "1.set").stat().st_mode) == 0o644


def test_nothing_that_a_panel_does_not_take_goes_in(settings, tmp_path):
    good = (EXAMPLES / "pump.set").read_text()
    (tmp_path / "cut.set").write_text(good[: len(good) // 2])
    (tmp_path / "changed.set").write_text(good.replace("0005", "0006", 1))
    (tmp_path / "wrong.json").write_text('{"baud": 1}')
    for name, why in (
        ("cut.set", "is no parameter set that a panel takes"),
        ("changed.set", "is no parameter set that a panel takes"),
        ("wrong.json", "wrong.json: baud: 1 is none of"),
    ):
        ended = settings("in", EXAMPLES / "pump.set", name, status=2)
        assert why in ended.stderr, ended.stderr
        assert not (tmp_path / "pump.set").exists()
    two = settings("in", *sorted(EXAMPLES.glob("*.json")), status=2).stderr
    assert "three_drives.json: one file of settings, and each set once" in two
    assert "nowhere.set: No such file" in settings("in", "nowhere.set", status=1).stderr


def test_another_set_of_that_name_is_not_replaced(settings, tmp_path):
    (tmp_path / "pump.set").write_text("of somebody else")
    ended = settings("in", EXAMPLES / "pump.set", status=2)
    assert "there is another pump.set on the panel" in ended.stderr
    assert (tmp_path / "pump.set").read_text() == "of somebody else"


def test_a_folder_that_is_not_there_is_named(tmp_path):
    ended = subprocess.run(
        [COMMAND, "--file", tmp_path / "no/panel.json", "set", "baud=9600"],
        capture_output=True, text=True,
    )  # fmt: skip
    assert ended.returncode == 1 and "No such file or directory" in ended.stderr
    assert ended.stderr.count("\n") == 1


@pytest.mark.parametrize("path", sorted(EXAMPLES.iterdir()), ids=lambda path: path.name)
def test_a_panel_takes_the_example_files(settings, path):
    assert "is written" in settings("in", path).stderr


# ---- which port -------------------------------------------------------------------------------


def port(usb, device="/dev/ttyACM0"):
    return types.SimpleNamespace(vid=usb[0], pid=usb[1], device=device, serial_number="1")


def test_the_one_board_on_usb_is_meant_whichever_it_is():
    other = port((0x0403, 0x6001), "/dev/ttyUSB0")
    assert ports.choose_any([other, port(PICO)]) == "/dev/ttyACM0"
    assert ports.choose_any([port(S3)]) == "/dev/ttyACM0"
    for several in ([port(PICO), port(S3)], [port(PICO), port(PICO, "/dev/ttyACM1")]):
        with pytest.raises(DeployError, match="there are several"):
            ports.choose_any(several)
    with pytest.raises(DeployError, match="no Pico with MicroPython is plugged in"):
        ports.choose_any([other])
