# SPDX-License-Identifier: MIT
"""./tools/example, as somebody calls it who has just cloned the project."""

import os
import subprocess
import tempfile

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

TOP = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def example(*words):
    """(exit status, what it printed), called from some other folder."""
    command = [os.path.join(TOP, "tools", "example"), *words]
    done = subprocess.run(command, capture_output=True, text=True, cwd="/", timeout=60)
    assert not done.stderr, done.stderr
    return done.returncode, done.stdout


def test_without_a_name_it_tells_which_there_are():
    for words in ((), ("no_such",), ("simulation",)):
        status, printed = example(*words)
        assert status == 2
        assert printed.startswith("usage: ./tools/example broadcast_stop|one_drive|own_program|")


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
