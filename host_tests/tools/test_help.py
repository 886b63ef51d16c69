# SPDX-License-Identifier: MIT
"""--help of every command: at once, and nothing is installed for it; and what is wrong with a
command line is one sentence.

The commands stand in a fresh tree here, without a build/, and pip, apt and MicroPython are out of
reach.
"""

import os
import resource
import shutil
import subprocess
import sys

import pytest

from tiers import TOP

INTERPRETERS = "host"

COMMANDS = sorted(
    path.name for path in (TOP / "tools").iterdir() if path.is_file() and os.access(path, os.X_OK)
)
# In processor time, for others may be at work on the machine; and as many times as long as START
# takes at that moment, for the machine may be slow.
HELP_STARTS = 6
START = ("-I", "-c", "import argparse, dataclasses")
REACHED = "bash env dirname sed cat printf".split()

# What is wrong with a command line, and how the sentence begins; what follows is argparse's.
WRONG = (
    ("bench", ("--only", "coffee"), "--only: invalid choice: 'coffee'"),
    ("bringup", ("--baud", "3"), "--baud: invalid choice: 3"),
    ("bringup", ("--frob",), "unrecognized arguments: --frob"),
    ("deploy", ("--board", "esp8266"), "--board: invalid choice: 'esp8266'"),
    ("deploy", ("--remove", "--replace"), "--remove goes with none of --board-file, --replace"),
    ("drive", ("--baud", "3", "--pty"), "--baud: invalid choice: 3"),
    ("drive", (), "one of the arguments --pty --port is required"),
    ("mutants", ("--count", "0"), "--count: 0 is not 1...100000"),
    ("soak", ("--seeds", "x"), "--seeds: x is no whole number"),
    ("uf2", ("--board", "pico3"), "--board pico3 is not understood"),
    ("uss", (), "the following arguments are required: COMMAND"),
)


@pytest.fixture(scope="module")
def fresh(tmp_path_factory):
    """A tree that nothing was fetched for, and the environment of its commands."""
    folder = tmp_path_factory.mktemp("fresh")
    for name in ("tools", "firmware", "boards"):
        ignored = shutil.ignore_patterns("__pycache__")
        shutil.copytree(TOP / name, folder / name, ignore=ignored)
    programs = folder / "bin"
    programs.mkdir()
    for name in REACHED:
        (programs / name).symlink_to(shutil.which(name))
    (programs / "python3").symlink_to(sys.executable)
    return folder, {"PATH": str(programs)}


def run(fresh, command, *words):
    folder, environment = fresh
    ended = subprocess.run(
        [folder / "tools" / command, *words],
        env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True,
    )  # fmt: skip
    assert not (folder / "build").exists(), ended.stderr
    return ended


def processor_s(work):
    """What `work()` returns, and the processor time of the processes that it has started."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    ended = work()
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return ended, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


@pytest.mark.parametrize("command", COMMANDS)
def test_help_is_instant_and_installs_nothing(fresh, command):
    folder, environment = fresh
    start = [folder / "bin/python3", *START]
    taken, starts = [], []
    for word in ("--help", "-h", "--help"):
        starts.append(processor_s(lambda: subprocess.run(start, env=environment, check=True))[1])
        ended, taken_s = processor_s(lambda word=word: run(fresh, command, word))
        taken.append(taken_s)
        assert (ended.returncode, ended.stderr) == (0, ""), ended.stderr
        assert ended.stdout.startswith("usage: ") and f"tools/{command}" in ended.stdout[:30]
    assert min(taken) < HELP_STARTS * min(starts), (taken, starts)


@pytest.mark.parametrize(("command", "words", "said"), WRONG, ids=lambda value: str(value)[:20])
def test_what_is_wrong_is_one_sentence(fresh, command, words, said):
    ended = run(fresh, command, *words)
    assert (ended.returncode, ended.stdout) == (2, ""), ended
    assert ended.stderr.startswith(f"tools/{command}: {said}"), ended.stderr
    assert ended.stderr.count("\n") == 1, ended.stderr


def test_the_panel_has_the_same_help_with_a_micropython_and_without(fresh):
    with_one = subprocess.run([TOP / "tools" / "panel", "--help"], capture_output=True, text=True)
    assert run(fresh, "panel", "--help").stdout == with_one.stdout
