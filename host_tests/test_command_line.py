"""./tools/panel as a user calls it: what it prints, and its exit status.

In a terminal it is another thing: test_terminal.py.
"""

import os
import subprocess

import pytest

INTERPRETERS = "host"

TOP = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PANEL = os.path.join(TOP, "tools", "panel")

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
        (("--drives", "1,1", "--script", "-"), "an address stands there twice"),
        (("--baud", "14400", "--script", "-"), "USS knows 300 600"),
        (("--baud", "300", "--script", "-"), "MICROMASTER 420 has no code for 300 baud"),
        (("--seed", "x", "--script", "-"), "--seed x is no number"),
        (("--speed", "0"), "--speed 0: time passes 1...100 times as fast"),
        (("--speed", "101"), "--speed 101: time passes 1...100 times as fast"),
        (("--speed=fast",), "--speed fast: time passes 1...100 times as fast"),
        (("--polled=yes", "--script", "-"), "--polled takes no value"),
    ],
)
def test_a_wrong_command_line_is_exit_status_2(words, said):
    ended = panel(*words, script="wait 1\n")
    assert ended.returncode == 2
    assert said in ended.stderr and "usage: ./tools/panel" in ended.stderr
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


def test_help_is_no_error():
    ended = panel("--help")
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
