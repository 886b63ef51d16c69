# SPDX-License-Identifier: MIT
"""tools/bringup called wrongly, or where nothing can be checked: one line, and no report is lost.

The checks themselves, and the command on a board: test_pico_bringup.py.
"""

import subprocess

import pytest

from tiers import TOP

INTERPRETERS = "host"

COMMAND = TOP / "tools" / "bringup"
PYTHON = TOP / "build" / "mpremote" / "bin" / "python"

# The command, with a board whose cable is pulled after the first check.
PULLED = """
import sys
sys.path[0] = %r
from tools.bringing_up import __main__ as command

class Bench:
    def __init__(self, port, options, say):
        self.say = say

    def run(self):
        self.say("PASS   1  comes once")
        raise command.DeployError("the port is gone")

    def close(self):
        pass

command.Bench = Bench
sys.argv[1:] = ["--yes", "--port", "nix"]
sys.exit(command.main())
""" % str(TOP)


def bringup(*words, folder, answer=""):
    return subprocess.run(
        [COMMAND, *words], input=answer, capture_output=True, text=True, timeout=120, cwd=folder
    )


def says(ended, status, line):
    assert ended.returncode == status, ended.stderr
    assert ended.stderr.splitlines()[-1] == line, ended.stderr


@pytest.mark.parametrize("answer", ["", "no\n", "y\n"])
def test_whoever_does_not_say_yes_has_sent_nothing(answer, tmp_path):
    ended = bringup(folder=tmp_path, answer=answer)
    says(ended, 1, "tools/bringup: nothing was sent, for you did not say yes")
    assert not [*tmp_path.iterdir()]


def test_a_port_that_is_not_there_is_named_and_an_older_report_stays(tmp_path):
    report = tmp_path / "bringup.txt"
    report.write_text("of yesterday\n")
    ended = bringup("--yes", "--port", "/dev/nix", folder=tmp_path)
    says(ended, 1, "tools/bringup: there is no /dev/nix")
    assert report.read_text() == "of yesterday\n"


@pytest.mark.parametrize("report", ["nix/report.txt", "."])
def test_a_report_that_cannot_be_written_is_told_before_anything_is_sent(report, tmp_path):
    ended = bringup("--yes", "--port", "/dev/nix", "--report", report, folder=tmp_path)
    says(ended, 1, f"tools/bringup: the report cannot be written: {report}")


@pytest.mark.parametrize(
    "words", [("--wired", "nix"), ("--address", "32"), ("--baud", "100"), ("nix",), ("--port",)]
)
def test_a_word_that_is_wrong_is_named(words, tmp_path):
    ended = bringup(*words, folder=tmp_path)
    assert ended.returncode == 2 and ended.stderr.startswith("tools/bringup: ")
    assert words[0] in ended.stderr and ended.stderr.count("\n") == 1


def test_what_was_found_before_the_cable_was_pulled_is_in_the_report(tmp_path):
    ended = subprocess.run(
        [PYTHON, "-B", "-c", PULLED], capture_output=True, text=True, timeout=120, cwd=tmp_path
    )
    says(ended, 1, "tools/bringup: the port is gone")
    report = (tmp_path / "bringup.txt").read_text()
    assert report == "PASS   1  comes once\nbroken off: the port is gone\n"
