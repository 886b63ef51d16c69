"""The tiers: the interpreters that every test file runs on, and the processes that run it there.

A tier is one interpreter; runner.py is what runs inside it. `survey` asks each tier for its
version, `run_file` runs functions of one file on one tier and publishes a verdict for each, also
when the process crashes or hangs in the middle: then the function at fault fails, and the ones
after it run in a new process. This module knows nothing of pytest; conftest.py uses it.
"""

import os
import re
import selectors
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import NamedTuple

from runner import MARK

TOP = Path(__file__).resolve().parent.parent
RUNNER = "host_tests/runner.py"
SURVEY_TIMEOUT_S = 20


class Tier(NamedTuple):
    name: str
    command: tuple[str, ...]
    remedy: str  # the command that lets tools/test have the tier


def _micropython(name: str) -> tuple[str, ...]:
    return (f"{TOP}/build/{name}/micropython", "-X", "heapsize=64M")


TIERS = {
    tier.name: tier
    for tier in (
        Tier("unix64", _micropython("unix64"), "apt-get install micropython"),
        Tier("unix32", _micropython("unix32"), "apt-get install gcc-multilib make python3"),
        Tier("coverage", _micropython("coverage"), "apt-get install gcc libc6-dev make python3"),
        # Alone with the standard library, printing at once, leaving no caches in firmware/.
        Tier("cpython", (sys.executable, "-I", "-u", "-B", "-X", "utf8"), ""),
    )
}


class Verdict(NamedTuple):
    passed: bool
    output: str  # what the function printed
    reason: str  # the traceback, or what became of the process
    seconds: float


class Survey(NamedTuple):
    versions: dict[str, str]  # tiers that are here -> what they run on
    missing: dict[str, str]  # the others -> why


def survey() -> Survey:
    """Asks every tier what it is, and so learns which are here and are what they promise."""
    found = Survey({}, {})
    for tier in TIERS.values():
        try:
            answer = subprocess.run(
                [*tier.command, RUNNER, tier.name],
                cwd=TOP,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                timeout=SURVEY_TIMEOUT_S,
            )
        except FileNotFoundError:
            found.missing[tier.name] = f"there is no {tier.command[0]}"
        except (OSError, subprocess.TimeoutExpired) as error:
            found.missing[tier.name] = str(error)
        else:
            heard = found.versions if answer.returncode == 0 else found.missing
            heard[tier.name] = answer.stdout.strip()
    return found


class FileRun:
    """The run of functions of one file on one tier, in one process or, after a crash, in more.

    `publish(name, verdict)` is called for every function, `note_lines(file, numbers)` with the
    lines that the coverage tier saw. `run` is meant for a thread; `stop` may come from another.
    """

    def __init__(self, tier, path, names, timeout_s, publish, note_lines):
        self.tier = tier
        self.path = path.relative_to(TOP) if path.is_relative_to(TOP) else path
        self.left = list(names)
        self.timeout_s = timeout_s
        self.publish = publish
        self.note_lines = note_lines
        self.process = None
        self.stopped = False

    def run(self):
        while self.left and not self.stopped:
            self._run_process()

    def stop(self):
        self.stopped = True
        if self.process:
            self.process.kill()

    def _run_process(self):
        """Runs what is left, until the process ends. At least one verdict comes of it."""
        self.process = subprocess.Popen(
            [*self.tier.command, RUNNER, self.tier.name, str(self.path), *self.left],
            cwd=TOP,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
        )
        with self.process:
            end_of_story = self._follow_process()
        if self.stopped:
            return
        self._conclude(*end_of_story)

    def _follow_process(self):
        """Turns reports into verdicts; returns what was under way when the process ended.

        The verdict on a function is held back until the next report, because a process that dies
        after its last function makes that function fail too.
        """
        current = verdict = None
        output, began = "", 0.0
        for text, word, argument in _reports(self.process, self.timeout_s):
            if verdict and word != "lines":
                self._close(current, verdict)
                current = verdict = None
            if word == "began":
                current, output, began = argument, "", time.monotonic()
            elif word == "raised":
                output = text
            elif word in ("passed", "failed"):
                seconds = time.monotonic() - began
                passed = word == "passed"
                verdict = Verdict(passed, text if passed else output, "" if passed else text, seconds)
            elif word == "lines":
                file, _, numbers = argument.partition(" ")
                self.note_lines(file, map(int, numbers.split()))
        raise AssertionError("reports end with an end")
