# SPDX-License-Identifier: MIT
"""The trial of a mutant: the tests that run its line, the nearest first, until one fails.

    trials = Trials(tree, reach, folder, patience_s)      # folder: for a copy of the tree
    verdict = trials.of(mutant)

What the chip alone runs is tried with the tests of the emulated Pico, on a firmware that is
built with the mutant in it.
"""

import subprocess
from contextlib import contextmanager
from itertools import groupby
from typing import NamedTuple

import tiers
from tools.mutating.mutants import read
from tools.mutating.reach import TIERS_TRIED, tests_of, tier_of
from tools.mutating.scratch import scratch

PICO = ("pico", "pico_again")  # a test file of the chip runs on the first of these that it has
FIRST_OF_A_FILE = 3  # so many of each test file run before the rest of any
# A function may take so many times as long as the longest of its file does without the mutant:
# others are busy too, and it may be the first of several that share what takes long.
TIMES = 8
PICO_TIMEOUT_S = 120  # as host_tests/pytest.ini has it
BUILD_TIMEOUT_S = 1800

# Builds the panel's firmware from a copy, in the copy's own build/, with its blocks. Some tests
# want plain MicroPython: no mutant is in that.
BUILD = """
top=$PWD
for part in begin folder packages micropython pytest emulator pico blocks; do
    . tools/fetch/$part.sh
done
get_pico_firmware stock && get_pico_firmware panel && get_blocks stock panel
"""


class Verdict(NamedTuple):
    """by: the test that found it, or "" if none did. reason: the line that tells why.
    tests: how many functions ran, or had to run if it survived."""

    by: str
    reason: str
    tests: int


class Trials:
    def __init__(self, tree, reach, folder, patience_s):
        self.tree = tree
        self.reach = reach
        self.copy = scratch(tree, folder)
        self.patience_s = patience_s
        self.passing = {}  # test that has found something -> whether it passes without

    def of(self, mutant):
        verdict = self._on_unix(mutant)
        if not verdict.by and self.reach.is_for_the_chip(mutant.path, mutant.line):
            with self._planted(mutant):
                verdict = self._on_chip(mutant)
        return verdict

    @contextmanager
    def _planted(self, mutant):
        path = self.copy / mutant.path
        source = read(path)
        path.write_text(mutant.applied(source), encoding="utf-8")
        try:
            yield
        finally:
            path.write_text(source, encoding="utf-8")

    def _on_unix(self, mutant):
        functions = self.reach.functions(mutant.path, mutant.line)
        for path, some in in_turns(functions):
            names = [function.name for function in some]
            while names:
                with self._planted(mutant):
                    found = self._failure_on_unix(path, names)
                if found is None:
                    break
                test, reason = found
                if self._passes(test, names):
                    return Verdict(test, reason, len(functions))
                names.remove(test.partition("::")[2])
        return Verdict("", "", len(functions))

    def _passes(self, test, names):
        """Whether it passes without a mutant, behind those of its file that ran before it."""
        path, _, name = test.partition("::")
        if name in names and test not in self.passing:
            names = names[: names.index(name) + 1]
            found = self._failure_on_unix(path, names)
            self.passing[test] = found is None or found[0] != test
        return self.passing.get(test, True)

    def _failure_on_unix(self, path, names):
        tier = tier_of(self.tree / path, TIERS_TRIED)
        timeout_s = TIMES * self.reach.longest_s(path) + self.patience_s
        return self._failure(tier, path, names, timeout_s)

    def _on_chip(self, mutant):
        if not (self.copy / "tools" / "fetch" / "pico.sh").exists():
            return Verdict("", "", 0)
        build = ["bash", "-c", BUILD]
        built = subprocess.run(
            build, cwd=self.copy, stdin=subprocess.DEVNULL, capture_output=True, text=True,
            timeout=BUILD_TIMEOUT_S,
        )  # fmt: skip
        if built.returncode:
            return Verdict("the build of the Pico's firmware", _last_line(built.stderr), 0)
        files = self._chip_tests(mutant)
        for path in files:
            tier = tier_of(self.copy / path, PICO)
            found = self._failure(tier, path, (), PICO_TIMEOUT_S)
            if found:
                return Verdict(*found, len(files))
        return Verdict("", "", len(files))

    def _chip_tests(self, mutant):
        """The test files of the Pico: first those that speak most of what the file is about."""
        about = mutant.path.split("/")[-2]
        paths = list(tests_of(self.copy, PICO))
        paths.sort(key=lambda path: -path.read_text(encoding="utf-8").lower().count(about))
        return [str(path.relative_to(self.copy)) for path in paths]

    def _failure(self, tier, path, names, timeout_s):
        """The first of these functions that fails, of all without names, and why; or None."""
        command = [*tiers.TIERS[tier].command, tiers.RUNNER, tier, path, *names]
        process = tiers.start(command, cwd=self.copy)
        name = "the file"
        for text, word, argument in tiers.reports(process, timeout_s):
            if word == "began":
                name = argument
            elif word == "failed":
                process.kill()
                return "%s::%s" % (path, name), _last_line(text)
            elif word == "ended" and argument:
                return "%s::%s" % (path, name), argument
        return None


def in_turns(functions):
    """(path, functions of it), so that the best come first and few processes are started."""
    first, rest = [], []
    counts = {}
    for function in functions:
        counts[function.path] = counts.get(function.path, 0) + 1
        (first if counts[function.path] <= FIRST_OF_A_FILE else rest).append(function)
    for some in first, rest:
        order = {path: at for at, path in reversed(list(enumerate(one.path for one in some)))}
        some.sort(key=lambda function: order[function.path])
        for path, group in groupby(some, key=lambda function: function.path):
            yield path, list(group)


def _last_line(text):
    """Of a traceback: what it says, or the line of an `assert`, which says more."""
    *_, before, last = ["", "", *text.strip().splitlines()]
    return (before if last.startswith("AssertionError") else last).strip()
