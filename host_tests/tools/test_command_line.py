# SPDX-License-Identifier: MIT
"""./tools/panel as a user calls it: what it prints, and its exit status.

In a terminal it is another thing: test_terminal.py.
"""

import json
import os
import shutil
import subprocess

import pytest

from tiers import TOP

INTERPRETERS = "host"

PANEL = os.path.join(TOP, "tools", "panel")
MICROPYTHON = os.path.join(TOP, "build", "unix64", "micropython")

START_AND_STOP = """\
wait 1000
press START
wait 5000
lcd
drive 1
press STOP
wait 8000
drive 1
"""


# With P2014 = 0 the panel asks; START takes the risk, which the settings keep.
ACCEPTED = """\
wait 1500
param 1 P2014[0] 0
press START
wait 5000
press START
wait 3000
expect RUNNING
press STOP
wait 8000
"""


def panel(*words, script="", folder=TOP):
    return subprocess.run(
        [PANEL, *words],
        input=script, capture_output=True, text=True, timeout=120, cwd=folder, check=False,
    )  # fmt: skip


@pytest.mark.parametrize("options", [(), ("--polled",), ("--seed", "3"), ("--seed=4", "--polled")])
def test_start_turns_the_motor_and_stop_stops_it(options, tmp_path):
    ended = panel("--script", "-", *options, script=START_AND_STOP, folder=tmp_path)
    assert (ended.returncode, ended.stderr) == (0, "")
    row_1, row_2, running, stopped = ended.stdout.splitlines()
    assert (row_1, row_2) == ("|S: 10.0 F: 10.00|", "|RUNNING      A1 |")
    assert running.startswith("address=1 state=running hz=10.00 stw=047F zsw=FB34 ")
    assert stopped.startswith("address=1 state=ready hz=0.00 stw=047E zsw=FB31 ")


def test_a_script_may_stand_in_a_file_with_any_name(tmp_path):
    script = tmp_path / "first light.txt"
    script.write_text("wait 1000\nexpect READY\nlcd\n")
    ended = panel("--script", script.name, folder=tmp_path)
    assert ended.returncode == 0 and ended.stdout.splitlines()[1] == "|READY        A1 |"


def test_drives_and_baud_rate_are_those_asked_for():
    ended = panel(
        "--drives", "2,31", "--baud", "9600", "--script", "-",
        script="wait 2000\nlcd\ndrive 31\nbus 1\n",
    )  # fmt: skip
    assert ended.returncode == 0
    assert ended.stdout.splitlines()[1] == "|READY        A2 |"
    assert "address=31 state=ready" in ended.stdout


def test_the_same_seed_gives_the_same_run():
    script = "wait 3000\nbus 20\n"
    runs = [panel("--seed", seed, "--script", "-", script=script).stdout for seed in "775"]
    assert runs[0] == runs[1] != runs[2]


def test_a_failed_expectation_is_exit_status_1(tmp_path):
    ended = panel("--script", "-", script="wait 1000\nexpect RUNNING\n")
    assert ended.returncode == 1
    assert "standard input:2: expected RUNNING" in ended.stderr
    assert "|READY        A1 |" in ended.stderr


def test_an_unknown_word_is_exit_status_2_and_names_file_and_line(tmp_path):
    script = tmp_path / "wrong.txt"
    script.write_text("wait 10\n\njump\n")
    ended = panel("--script", str(script))
    assert ended.returncode == 2
    assert "wrong.txt:3: unknown command jump" in ended.stderr


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--scrpt", "-"), "unknown option --scrpt"),
        (("now",), "unknown option now"),
        (("--script",), "--script wants a value"),
        (("--script", "nowhere.txt"), "nowhere.txt: cannot be read"),
        (("--script", "."), "cannot be read"),
        (("--drives", "32", "--script", "-"), "32 is no address 0...31"),
        (("--drives", "", "--script", "-"), "nothing is no address"),
        (("--drives", "1,1", "--script", "-"), "1 stands there twice"),
        (("--drives", ",".join(map(str, range(32))), "--script", "-"), "31 at the most"),
        (("--keys", "loop", "--script", "-"), "keys are wired compact or direct or matrix"),
        (("--settings", "nowhere/settings.json", "--script", "-"), "cannot be kept"),
        (("--settings", "", "--script", "-"), "cannot be kept"),
        (("--settings", ".", "--script", "-"), "is no ordinary file"),
        (("--settings", "/dev/full", "--script", "-"), "is no ordinary file"),
        (("--settings", "/dev/null", "--script", "-"), "is no ordinary file"),
        (("--settings", "/proc/self/mem", "--script", "-"), "cannot be kept"),  # unreadable
        (("--baud", "14400", "--script", "-"), "USS knows 300 600"),
        (("--baud", "300", "--script", "-"), "MICROMASTER 420 has no code for 300 baud"),
        (("--seed", "x", "--script", "-"), "--seed x is no number"),
        (("--speed", "0"), "--speed 0: time passes 1...100 times as fast"),
        (("--speed", "101"), "--speed 101: time passes 1...100 times as fast"),
        (("--speed=fast",), "--speed fast: time passes 1...100 times as fast"),
        (("--polled=yes", "--script", "-"), "--polled takes no value"),
        (("--board", "arduino", "--script", "-"), "--board arduino: there are sim and pico"),
        (("--flash", "file", "--script", "-"), "--flash is not for --board sim"),
        (("--display", "wires", "--script", "-"), "--display is not for --board sim"),
    ],
)
def test_a_wrong_command_line_is_exit_status_2(words, said):
    ended = panel(*words, script="wait 1\n")
    assert ended.returncode == 2
    assert said in ended.stderr and ended.stderr.count("\n") == 1
    assert ended.stdout == "" and "Traceback" not in ended.stderr


def test_a_file_that_is_no_text_is_refused(tmp_path):
    script = tmp_path / "picture.png"
    script.write_bytes(bytes(range(256)))
    ended = panel("--script", str(script))
    assert ended.returncode == 2 and "Traceback" not in ended.stderr


def test_standard_input_that_is_no_text_is_refused():
    ended = subprocess.run(
        [PANEL, "--script", "-"], input=b"wait 10\n\xff\xfe\n", capture_output=True, check=False
    )
    assert ended.returncode == 2 and b"is no text" in ended.stderr


def test_a_full_disk_is_said():
    with open("/dev/full", "w") as full:
        ended = subprocess.run(
            [PANEL, "--script", "-"],
            input="wait 1000\nlcd\n", stdout=full, stderr=subprocess.PIPE, text=True, check=False,
        )  # fmt: skip
    assert ended.returncode == 1 and "input or output failed" in ended.stderr
    assert "Traceback" not in ended.stderr


def test_a_byte_order_mark_and_the_line_ends_of_other_systems_do_not_matter(tmp_path):
    script = tmp_path / "notepad.txt"
    script.write_bytes(b"\xef\xbb\xbfwait 1000\r\nexpect READY\r\n")
    ended = panel("--script", str(script))
    assert (ended.returncode, ended.stderr) == (0, "")


def test_without_a_script_and_without_a_terminal_it_says_so():
    ended = panel()
    assert ended.returncode == 2
    assert "this is no terminal: give the panel a --script" in ended.stderr


@pytest.mark.parametrize("word", ["--help", "-h"])
def test_help_is_no_error(word):
    ended = panel(word)
    assert ended.returncode == 0 and "usage: ./tools/panel" in ended.stdout


def test_a_reader_that_goes_away_is_no_crash():
    reader, writer = os.pipe()
    os.close(reader)
    with os.fdopen(writer, "w") as gone:
        ended = subprocess.run(
            [PANEL, "--script", "-"],
            input="wait 1000\nlcd\nlcd\n", stdout=gone, stderr=subprocess.PIPE, text=True,
            timeout=60, check=False,
        )  # fmt: skip
    assert ended.returncode == 1 and "Traceback" not in ended.stderr


# --- the panel's settings -----------------------------------------------------------------------


def test_settings_are_kept_from_one_run_to_the_next(tmp_path):
    first = panel(
        "--settings", "kept.json", "--drives", "1,2", "--baud", "9600", "--script", "-",
        script=ACCEPTED, folder=tmp_path,
    )  # fmt: skip
    assert (first.returncode, first.stderr) == (0, "")
    kept = json.loads((tmp_path / "kept.json").read_text())
    assert (kept["drives"], kept["baud"], kept["unsupervised"]) == ([1, 2], 9600, [1])
    second = panel(
        "--settings", "kept.json", "--script", "-",
        script="wait 1500\nparam 1 P2014[0] 0\npress START\nwait 3000\nexpect RUNNING\n",
        folder=tmp_path,
    )  # fmt: skip
    assert (second.returncode, second.stderr) == (0, "")
    assert os.listdir(tmp_path) == ["kept.json"]


def test_the_log_goes_into_a_file_a_line_of_json_a_second(tmp_path):
    words = ("--json", "log.json", "--drives", "1,2", "--script", "-")
    for _ in range(2):  # the second one goes on at its end
        assert panel(*words, script="wait 5000\n", folder=tmp_path).returncode == 0
    lines = [json.loads(line) for line in (tmp_path / "log.json").read_text().splitlines()]
    assert 6 <= len(lines) <= 10
    assert [drive["state"] for drive in lines[-1]["drives"]] == ["READY", "READY"]


def test_a_log_that_cannot_be_written_holds_nobody_up(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    for path in ("pipe", ".", "nowhere/log.json", "/dev/full"):
        ended = panel("--json", path, "--script", "-", script="wait 1\n", folder=tmp_path)
        assert ended.returncode == 2 and "panel: --json" in ended.stderr, path


def test_without_settings_nothing_is_written(tmp_path):
    assert panel("--script", "-", script=ACCEPTED, folder=tmp_path).returncode == 0
    assert os.listdir(tmp_path) == []


def test_a_damaged_settings_file_is_said_and_kept_aside(tmp_path):
    kept = tmp_path / "kept.json"
    kept.write_text('{"drives": [1], "bau')
    words = ("--settings", str(kept), "--script", "-")
    ended = panel(*words, script="wait 1000\nexpect SETTINGS DAMAGED\n")
    assert (ended.returncode, ended.stderr) == (0, "")
    assert os.listdir(tmp_path) == ["kept.json"] and kept.read_text().endswith('"bau')
    ended = panel(*words, script="wait 1000\npress STOP\n" + ACCEPTED)
    assert (ended.returncode, ended.stderr) == (0, "")
    assert (tmp_path / "kept.json.bad").read_text() == '{"drives": [1], "bau'
    assert json.loads(kept.read_text())["unsupervised"] == [1]


@pytest.mark.parametrize("from_file", [True, False])
def test_a_line_of_three_megabytes_is_a_line_that_is_too_long(tmp_path, from_file):
    text = "wait 10\nlcd\n" + 3_000_000 * "x" + "\n"
    script = tmp_path / "script"
    script.write_text(text)
    if from_file:
        ended = panel("--script", str(script))
    else:
        ended = panel("--script", "-", script=text)
    assert ended.returncode == 2 and len(ended.stderr) < 1000
    assert ":3: a line of more than 1000 characters is no command" in ended.stderr
    assert ended.stdout.count("|") == 4


def test_an_option_twice_is_refused():
    ended = panel("--drives", "1", "--drives=2", "--script", "-")
    assert ended.returncode == 2 and "--drives stands there twice" in ended.stderr


def test_a_settings_file_that_no_chip_could_hold_is_a_damaged_one(tmp_path):
    kept = tmp_path / "kept.json"
    for text in (
        '{"drives": [7], "new": "%s"}' % (20_000_000 * "x"),
        '{"drives": [7], %s}' % ", ".join('"%d": 1' % n for n in range(200_000)),
        '{"drives": [7], "new": %s}' % (1000 * "[" + 1000 * "]"),
    ):
        kept.write_text(text)
        words = ("--settings", str(kept), "--script", "-")
        ended = panel(*words, script="wait 1000\nexpect SETTINGS DAMAGED\n" + ACCEPTED)
        assert (ended.returncode, ended.stderr) == (0, "")
        assert (tmp_path / "kept.json.bad").read_text() == text
        assert json.loads(kept.read_text())["unsupervised"] == [1]


def test_settings_in_a_pipe_are_refused_and_nobody_waits(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    ended = panel("--settings", str(pipe), "--script", "-", script="wait 1\n")
    assert ended.returncode == 2 and "is no ordinary file" in ended.stderr


def test_settings_that_name_other_drives_than_are_simulated_are_pointed_out(tmp_path):
    kept = tmp_path / "kept.json"
    kept.write_text('{"drives": [5, 6]}')
    words = ("--settings", str(kept), "--script", "-")
    ended = panel(*words, "--drives", "1,2", script="wait 3000\nexpect NO CONTACT A5\n")
    assert ended.returncode == 0
    said = "panel: by %s the panel looks for drives 5,6; there are 1,2\n" % kept
    assert ended.stderr == said
    ended = panel(*words, "--drives", "6,5", script="wait 1000\nexpect READY A5\n")
    assert (ended.returncode, ended.stderr) == (0, "")
    assert kept.read_text() == '{"drives": [5, 6]}'


def test_a_baud_rate_that_is_not_that_of_the_settings_is_refused(tmp_path):
    kept = tmp_path / "kept.json"
    kept.write_text('{"baud": 9600}')
    ended = panel("--settings", str(kept), "--baud", "19200", "--script", "-")
    assert ended.returncode == 2 and "--baud 19200: %s says 9600" % kept in ended.stderr
    kept.write_text('{"baud": 300}')
    ended = panel("--settings", str(kept), "--script", "-")
    assert ended.returncode == 2 and "has no code for 300 baud" in ended.stderr
    ended = panel("--settings", str(tmp_path / "new.json"), "--baud", "300", "--script", "-")
    assert ended.returncode == 2 and not (tmp_path / "new.json").exists()


def test_keys_in_a_matrix_work_as_well():
    script = START_AND_STOP + "press UP\nwait 100\nexpect S: 10.1\n"
    ended = panel("--keys", "matrix", "--script", "-", script=script)
    assert (ended.returncode, ended.stderr) == (0, "")
    assert ended.stdout.splitlines()[1] == "|RUNNING      A1 |"


def test_eight_keys_work_as_well():
    more = "press FN\nwait 100\nexpect ^: 10.0\npress UP\nwait 500\nexpect 0.0%\npress JOG\n"
    ended = panel("--keys", "compact", "--script", "-", script=START_AND_STOP + more)
    assert (ended.returncode, ended.stderr) == (0, "")
    assert ended.stdout.splitlines()[1] == "|RUNNING      A1 |"
    ended = panel("--keys", "compact", "--script", "-", script="press PARAM\n")
    assert ended.returncode == 2
    assert "no key PARAM: there are START STOP REVERSE JOG UP DOWN P FN" in ended.stderr


# --- a firmware that fails ----------------------------------------------------------------------

FAILING = """
from app import App

def start(board):
    app = App(board)
    app.start()
    steps = [0]
    step = app.step

    def fail():
        steps[0] += 1
        if steps[0] > %d:
            raise %s
        step()

    app.step = fail
    if %d < 0:
        fail()
    return app
"""


@pytest.mark.parametrize("steps", [-1, 200])
@pytest.mark.parametrize(
    "error", ["ValueError('x')", "KeyError('x')", "OSError(5)", "AssertionError('x')"]
)
def test_a_crash_of_the_firmware_shows_where_and_has_a_status_of_its_own(tmp_path, error, steps):
    (tmp_path / "main.py").write_text(FAILING % (steps, error, steps))
    ended = subprocess.run(
        [MICROPYTHON, "-X", "heapsize=16M", os.path.join(TOP, "tools", "live", "virtual_panel.py")]
        + ["--script", "-"],
        input="wait 1000\nlcd\n", capture_output=True, text=True, timeout=60, check=False,
        env={**os.environ, "MICROPYPATH": "%s:%s:%s/firmware:.frozen" % (tmp_path, TOP, TOP)},
    )  # fmt: skip
    assert ended.returncode == 4 and ended.stdout == ""
    assert "Traceback" in ended.stderr and ", in fail" in ended.stderr
    assert error.split("(")[0] in ended.stderr and "standard input:" not in ended.stderr


def test_what_an_emulated_pico_cannot_do_is_refused_before_anything_is_fetched(tmp_path):
    shutil.copytree(os.path.join(TOP, "tools"), tmp_path / "tools")
    for folder in ("firmware", "boards"):
        os.symlink(os.path.join(TOP, folder), tmp_path / folder)
    os.mkdir(tmp_path / "build")
    os.symlink(os.path.dirname(MICROPYTHON), tmp_path / "build" / "unix64")
    for options, why in (("--polled", "--polled is not for --board pico"),
                         ("--baud 300", "has no code for 300 baud"),
                         ("--nonsense", "unknown option --nonsense")):  # fmt: skip
        ended = subprocess.run(
            [tmp_path / "tools" / "panel", "--script", "-", "--board", "pico", *options.split()],
            input="", capture_output=True, text=True, timeout=60, check=False,
        )  # fmt: skip
        assert ended.returncode == 2 and why in ended.stderr, ended.stderr
        assert ended.stdout == "" and os.listdir(tmp_path / "build") == ["unix64"]
