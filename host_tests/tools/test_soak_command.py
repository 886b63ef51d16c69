# SPDX-License-Identifier: MIT
"""tools/soak: its command line, what it prints, its exit status. A few seconds of virtual time."""

import shutil
import subprocess
import sys

import pytest

from tiers import TOP

INTERPRETERS = "host"

MICROPYTHON = TOP / "build" / "unix64" / "micropython"
needs_micropython = pytest.mark.skipif(
    not MICROPYTHON.exists(), reason="there is no MicroPython: tools/test"
)


def soak(*arguments):
    done = subprocess.run(
        [sys.executable, "-I", "-B", TOP / "tools" / "soaking", *map(str, arguments)],
        capture_output=True,
        text=True,
    )
    return done.returncode, done.stdout, done.stderr


def test_what_is_no_number_of_seeds_drives_or_bytes_is_refused():
    for wrong in (
        ["--seeds", "0"], ["--drives", "32"], ["--fuzz", "many"], ["--sneeze"], ["--first", "-1"],
    ):  # fmt: skip
        status, _, told = soak(*wrong)
        assert status == 2 and wrong[0] in told, told


def test_what_is_no_length_of_a_life_is_refused():
    for wrong in ("0", "-3", "nan", "inf", "-inf", "1e300", "0.0001", "three"):
        status, _, told = soak("--seeds", 1, "--minutes=" + wrong)
        assert status == 2 and "--minutes: " + wrong in told, told
    status, told, _ = soak("--minutes", "-3")
    assert status == 2 and "every rule" not in told


def test_help_says_what_the_exit_status_means():
    status, told, _ = soak("--help")
    assert status == 0
    assert "--minutes" in told and "every rule held" in told


@needs_micropython
def test_rules_that_hold_are_told_with_hours_exchanges_and_faults():
    status, told, trouble = soak("--seeds", 3, "--minutes", 0.2, "--first", 2)
    assert status == 0, told + trouble
    assert "3 seeds" in told and "exchanges" in told and "faults:" in told and "real time" in told
    assert told.splitlines()[-1] == "every rule held in 3 seeds", told


@needs_micropython
def test_a_rule_that_is_broken_is_told_with_the_command_that_repeats_it(tmp_path):
    firmware = tmp_path / "firmware"
    shutil.copytree(TOP / "firmware", firmware)
    link = firmware / "hal" / "link" / "rs485.py"
    text = link.read_text()
    link.write_text(text.replace("_arm(self._duration_us)", "_arm(2 * self._duration_us)"))
    status, told, _ = soak("--seeds", 1, "--minutes", 0.2, "--firmware", firmware)
    assert status == 1, told
    assert "breaks the rule LINE: start interval" in told
    assert "again: ./tools/soak --seeds 1 --first 1 --minutes 0.2 --interpreter cpython" in told
    assert "1 of 1 seeds broke a rule" in told
    assert "> 02 0E" in told and "OFF1" in told  # the last telegrams, in words as well


@needs_micropython
def test_a_firmware_that_cannot_be_started_is_no_pass(tmp_path):
    status, told, _ = soak("--seeds", 1, "--minutes", 0.2, "--firmware", tmp_path)
    assert status == 4
    assert "1 were not lived to their end" in told, told


@needs_micropython
def test_the_receiver_is_fed():
    status, told, trouble = soak("--fuzz", 30_000)
    assert status == 0, told + trouble
    assert "bytes in" in told and "bytes a second" in told


@needs_micropython
def test_every_tenth_seed_is_lived_on_micropython_unless_another_is_named():
    window = ("--seeds", 2, "--first", 9, "--minutes", 0.1)
    _, told, _ = soak(*window)
    assert "on CPython 1, MicroPython 1" in told, told
    _, told, _ = soak(*window, "--interpreter", "cpython")
    assert "on CPython 2\n" in told, told


def test_what_a_run_needs_is_told_before_it_begins():
    assert soak("--needs", "--seeds", 5, "--minutes", 1)[1] == "cpython\n"
    assert soak("--needs", "--seeds", 100, "--minutes", 3)[1] == "cpython micropython\n"
    assert soak("--needs", "--seeds", 1, "--interpreter", "micropython")[1] == "micropython\n"
