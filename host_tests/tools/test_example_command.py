# SPDX-License-Identifier: MIT
"""./tools/example, as somebody calls it who has just cloned the project."""

import os
import subprocess
import tempfile

from tiers import TOP

INTERPRETERS = "host"

MINE = """
import board
from uss.bus import Master
from uss.families import G110

with Master(board.make_link(19200)) as bus:
    drive = bus.add(2, G110)
    drive.run(20.0)
    print(drive.state, bus.mirror(1))
"""

LONG = """
import board
from uss.bus import Master
from uss.families import MM420

with Master(board.make_link(19200)) as bus:
    bus.add(1, MM420)
    bus.wait(60)
    assert not board.keypad.read()
print("over")
"""


def called(*words):
    command = [os.path.join(TOP, "tools", "example"), *words]
    return subprocess.run(command, capture_output=True, text=True, cwd="/", timeout=60)


def example(*words):
    """(exit status, what it printed), called from some other folder."""
    done = called(*words)
    assert not done.stderr, done.stderr
    return done.returncode, done.stdout


NAMES = "broadcast_stop one_drive own_family own_program parameters plc_br plc_s7 three_drives"


def test_without_a_name_it_tells_which_there_are():
    done = called()
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == f"tools/example: say which: {NAMES}, or FILE.py\n"
    status, printed = example("--help")
    assert status == 0 and f"  NAME         {NAMES} \n" in printed


def test_what_there_is_not_is_said_in_a_line():
    for words, told in (
        (("no_such",), "there is no example no_such: broadcast_stop one_drive"),
        (("simulation",), "there is no example simulation"),
        (("/no/such.py",), "/no/such.py cannot be read (ENOENT)"),
        (("no_such_folder/mine.py",), "no_such_folder/mine.py cannot be read"),
        (("one_drive", "--drives", "1=foo"), "no family foo: there are mm420"),
        (("one_drive", "--drives=x"), "x is no address 0...31"),
        (("one_drive", "--drives", "32"), "32 is no address 0...31"),
        (("one_drive", "--drives", "1,1"), "1 stands there twice"),
        (("one_drive", "--drives", "1", "--drives", "2"), "--drives stands there twice"),
        (("one_drive", "--drives"), "--drives wants a list"),
        (("one_drive", "parameters"), "one at a time"),
        (("one_drive", "--help-me"), "unknown option --help-me"),
    ):
        done = called(*words)
        assert done.returncode == 2 and told in done.stderr, (words, done.stderr)
        assert len(done.stderr.splitlines()) == 1 and not done.stdout, done.stderr


def test_nobody_presses_keys_or_ends_a_program_that_does_not_want_it():
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "mine.py")
        with open(path, "w") as file:
            file.write(LONG)
        status, printed = example(path, "--drives", "1")
    assert status == 0
    assert printed.startswith("over\n") and "pressed" not in printed
    assert "\nThe simulated drives 60." in printed


def test_an_example_runs_and_the_drives_say_what_became_of_them():
    status, printed = example("parameters")
    assert status == 0
    assert printed.startswith("P0700 = 5 and P1082 = 50.00 Hz\n")
    assert "\naddress=1 state=ready hz=0.00 stw=047E" in printed


def test_a_program_of_ones_own_finds_the_board_and_the_drives_it_asks_for():
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "mine.py")
        with open(path, "w") as file:
            file.write(MINE)
        status, printed = example(path, "--drives", "1,2=G110")
    assert status == 0
    assert printed.startswith("running True\n")
    assert "\naddress=1 " in printed and "\naddress=2 " in printed and "address=3" not in printed


def test_somebody_presses_start_and_stop_for_the_program_that_wants_keys():
    status, printed = example("own_program")
    assert status == 0
    assert "address=1 state=ready" in printed and "starts=1\n" in printed
    assert printed.startswith("(START is pressed after 2 s)\n(STOP is pressed after 12 s)\n")
    assert "(Ctrl-C is pressed after 40 s)\n" in printed
