"""./tools/example, as somebody calls it who has just cloned the project."""

import os
import subprocess

INTERPRETERS = "host"

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


def test_somebody_presses_start_and_stop_for_the_program_that_wants_keys():
    status, printed = example("own_program")
    assert status == 0
    assert "address=1 state=ready" in printed and "starts=1\n" in printed
