# SPDX-License-Identifier: MIT
"""Chooses what runs once with --coverage, and what runs on CPython for its lines (shares.py).

    build/pytest/bin/python -B host_tests/cpython/choose_lines.py

It runs the files that are for CPython there, with their lines noted. A function that takes longer
than SLOW_S is slow: it goes into slow_once.json.

Then it runs by itself each slow one, and each test of the panel, which is a program for
MicroPython and has its tests there. Of these it chooses, for lines_once.json, those that together
run each line that nothing else runs. The next test is always the one that adds the most lines a
second. One of the panel that takes longer than LONGEST_S is given up, with its lines. A file that
says INTERPRETERS itself stays as it is. All takes eight to twenty minutes.
"""

import ast
import json
import os
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

HOST_TESTS = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(HOST_TESTS)]

from runner import COVERAGE  # noqa: E402
from shares import CPYTHON, LINES_ONCE, SLOW_ONCE, TESTS  # noqa: E402
from tiers import ENVIRONMENT, TIERS, FileRun, interpreters, said  # noqa: E402

PANEL = "panel"
SLOW_S = 0.1
LONGEST_S = 6
START_S = 0.3  # of a process: nothing is won by a test that takes less
TIMEOUT_S = 120


def main(tests=TESTS):
    ENVIRONMENT[COVERAGE] = "1"
    files = [File(path) for path in sorted(tests.rglob("test_*.py"))]
    with ThreadPoolExecutor(os.cpu_count()) as pool:

        def run(parts, timeout_s=TIMEOUT_S):
            return list(pool.map(lambda part: Run(*part, timeout_s), parts))

        whole = run((file, file.names) for file in files if CPYTHON in file.tiers)
        short = run((each.file, each.short) for each in whole if each.slow)
        slow = run((each.file, [name]) for each in whole for name in each.slow)
        of_panel = [(file, [name]) for file in files if file.is_of_panel for name in file.names]
        panel = run(of_panel, LONGEST_S)
    seen = lines_of([each for each in whole if not each.slow] + short)
    chosen = cover([each for each in slow + panel if each.passed], seen)
    write(SLOW_ONCE, slow, tests)
    write(LINES_ONCE, chosen, tests)
    print(f"{told(slow)} are slow; {told(chosen)} run on CPython for their lines")


class File:
    """What is to be known of a test file before it runs."""

    def __init__(self, path):
        tree = ast.parse(path.read_bytes())
        tests = [node for node in tree.body if getattr(node, "name", "").startswith("test_")]
        self.path = path
        self.names = [node.name for node in tests if isinstance(node, ast.FunctionDef)]
        self.tiers = interpreters(tree, path)
        self.may_be_shared = not said(tree)
        self.is_of_panel = self.may_be_shared and path.parent.name == PANEL


class Run:
    """The run of some functions of a file on CPython, each of which has so much time."""

    def __init__(self, file, names, timeout_s):
        self.file, self.names = file, names
        self.verdicts = {}
        self.lines = set()
        publish = self.verdicts.__setitem__
        FileRun(TIERS[CPYTHON], file.path, names, timeout_s, publish, self._note_lines).run()
        self.seconds = sum(verdict.seconds for verdict in self.verdicts.values())
        self.passed = all(verdict.passed for verdict in self.verdicts.values())

    def _note_lines(self, path, numbers):
        self.lines.update((path, number) for number in numbers)

    @property
    def slow(self):
        if not self.file.may_be_shared:
            return []
        return [name for name in self.names if self.verdicts[name].seconds > SLOW_S]

    @property
    def short(self):
        return [name for name in self.names if name not in self.slow]


def lines_of(runs):
    """(file, number)"""
    return set().union(*(run.lines for run in runs))


def cover(runs, seen):
    """The runs that together run each line that any of them runs, but for those seen already."""
    left, chosen = {run: run.lines - seen for run in runs}, []
    while any(left.values()):
        best = max(left, key=lambda run: len(left[run]) / max(run.seconds, START_S))
        chosen.append(best)
        added = left.pop(best)
        for lines in left.values():
            lines -= added
    return chosen


def write(place, runs, tests):
    """File -> its functions."""
    table = {}
    for run in sorted(runs, key=lambda run: (run.file.path, run.names)):
        table.setdefault(run.file.path.relative_to(tests).as_posix(), []).extend(run.names)
    place.write_text(json.dumps(table, indent=1) + "\n", encoding="utf-8")


def told(runs):
    return f"{len(runs)} tests ({sum(run.seconds for run in runs):.0f} s)"


if __name__ == "__main__":
    main()
