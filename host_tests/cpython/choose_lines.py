# SPDX-License-Identifier: MIT
"""Chooses the tests of the panel that run on CPython, for the list of lines that did not run.

    build/pytest/bin/python -B host_tests/cpython/choose_lines.py

The panel is a program for MicroPython, and its tests run there. On CPython, where lines are noted,
each line of it runs once: this runs every test by itself, notes its lines and its time, and
writes lines_once.json anew. The next test is always the one that adds the most lines a second. One
that takes longer than LONGEST_S is left out, with its lines. It takes some ten minutes.
"""

import ast
import json
import os
import re
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

HOST_TESTS = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(HOST_TESTS)]

from tiers import ENVIRONMENT, RUNNER, TIERS, TOP, interpreters  # noqa: E402

CHOSEN = Path(__file__).parent / "lines_once.json"
FOLDER = "panel"
LONGEST_S = 2.6
START_S = 0.3  # of a process: nothing is won by a test that takes less
COMMAND = (*TIERS["cpython"].command, RUNNER, "cpython")
NOTED = re.compile(r"\x1elines (\S+) (.*)")
FAILED = "\x1efailed"


def main():
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        elsewhere = set().union(*(run.lines for run in pool.map(Run, list(others()))))
        runs = [run for run in pool.map(Run, *zip(*tests(), strict=True)) if run.passed]
    chosen = cover([run for run in runs if run.seconds <= LONGEST_S], elsewhere)
    table = {}
    for run in sorted(chosen, key=lambda run: (run.path, run.names)):
        table.setdefault(str(run.path.relative_to(HOST_TESTS)), []).extend(run.names)
    CHOSEN.write_text(json.dumps(table, indent=1) + "\n", encoding="utf-8")
    left = set().union(*(run.lines for run in runs)) - elsewhere
    left.difference_update(*(run.lines for run in chosen))
    seconds = sum(run.seconds for run in chosen)
    print(f"{len(chosen)} of {len(runs)} tests, {seconds:.0f} s; {len(left)} lines left out")


class Run:
    """The run of tests of a file: all of them, or one."""

    def __init__(self, path, *names):
        self.path, self.names = path, names
        began = time.monotonic()
        command = [*COMMAND, str(path.relative_to(TOP)), *names]
        environment = {**ENVIRONMENT, "USS_COVERAGE": "1"}
        done = subprocess.run(command, cwd=TOP, env=environment, capture_output=True, text=True)
        self.seconds = time.monotonic() - began
        self.passed = done.returncode == 0 and FAILED not in done.stdout
        self.lines = {
            (file, number)
            for file, numbers in NOTED.findall(done.stdout)
            for number in numbers.split()
        }


def others():
    """The files that run on CPython as a whole."""
    for path in sorted(HOST_TESTS.rglob("test_*.py")):
        if "cpython" in interpreters(ast.parse(path.read_bytes()), path):
            yield path


def tests():
    """(file, function) of the folder."""
    for path in sorted((HOST_TESTS / FOLDER).glob("test_*.py")):
        for node in ast.parse(path.read_bytes()).body:
            if isinstance(node, ast.FunctionDef) and node.name.startswith("test_"):
                yield path, node.name


def cover(runs, seen):
    """The runs that together run each line that any of them runs, but for those seen already."""
    seen, left, chosen = set(seen), list(runs), []
    while left:
        best = max(left, key=lambda run: len(run.lines - seen) / max(run.seconds, START_S))
        if best.lines <= seen:
            break
        left.remove(best)
        chosen.append(best)
        seen |= best.lines
    return chosen


if __name__ == "__main__":
    main()
