# SPDX-License-Identifier: MIT
"""tools/mutants: which mutants of a small tree it makes, and what it says of them."""

import os
import re
import shutil
import subprocess
import sys

import pytest

from tiers import TOP

INTERPRETERS = "host"

BUILD = TOP / "build"
needs_cosmic_ray = pytest.mark.skipif(
    not (BUILD / "mutating").exists() or not (BUILD / "unix64").exists(),
    reason="there is no cosmic-ray here: tools/mutants",
)

VALVE = '''"""A valve."""


def opens(percent):
    """Whether it opens."""
    return percent > 50


def steps(percent):
    at = 0
    while at < percent:
        at += 10
    return at


def spare():
    return 3
'''

ITS_TESTS = """from valve import opens, steps


def test_a_valve_opens_above_the_half():
    assert opens(51) and not opens(50)


def test_a_valve_goes_on_in_whole_steps():
    assert steps(95) == 100
"""

SHARED = """

known = []


def known_steps():
    if not known:
        for _ in range(30_000_000):  # more than a second
            pass
        known.append(steps(95))
    return known[0]


def test_a_valve_comes_to_an_end():
    assert known_steps() > 0
""" + "".join(
    """

def test_a_valve_goes_beyond_%d():
    assert known_steps() > steps(%d)
"""
    % (percent, percent)
    for percent in (55, 65, 75)
)

OPENS_AT_THE_HALF = "firmware/valve.py:6:19:ReplaceComparisonOperator_Gt_GtE:0"
ONE_STEP_MORE = "firmware/valve.py:11:13:ReplaceComparisonOperator_Lt_LtE:0"
STANDS_STILL = "firmware/valve.py:12:8:RemoveStatement:0"
SPARE = "firmware/valve.py:17:11:ReplaceNumber:0"


@pytest.fixture
def tree(tmp_path):
    """A tree of the project's form, with one file of each kind."""
    for path, text in {
        "firmware/valve.py": VALVE,
        "boards/README.md": "",
        "host_tests/benches/valve_bench.py": "",
        "host_tests/valve/test_valve.py": ITS_TESTS,
    }.items():
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(text)
    shutil.copy(TOP / "host_tests/runner.py", tmp_path / "host_tests")
    return tmp_path


def mutants(*words):
    done = subprocess.run(
        [sys.executable, "-I", "-B", TOP / "tools" / "mutating", *map(str, words)],
        capture_output=True,
        text=True,
    )
    return done.returncode, done.stdout, done.stderr


def of(tree, *names):
    """What it says of mutants that have names."""
    words = [word for name in names for word in ("--mutant", name)]
    return mutants("--tree", tree, "--only", "firmware", "--patience", 1, *words)


@needs_cosmic_ray
def test_a_mutant_that_a_test_finds_is_told_with_the_test_and_the_reason(tree):
    status, told, trouble = of(tree, OPENS_AT_THE_HALF)
    assert status == 0, told + trouble
    assert "    -    return percent > 50\n    +    return percent >= 50\n" in told
    assert "found by host_tests/valve/test_valve.py::test_a_valve_opens_above_the_half" in told
    assert "the tests found 1 of 1 mutants" in told and "processor time" in told


@needs_cosmic_ray
def test_a_mutant_that_no_test_finds_survives_and_the_command_tries_it_again(tree):
    status, told, _ = of(tree, ONE_STEP_MORE)
    assert status == 1 and "SURVIVED, tests that run it: 1" in told, told
    assert "again: ./tools/mutants --mutant " + ONE_STEP_MORE in told
    with open(tree / "host_tests/valve/test_valve.py", "a") as tests:
        tests.write("\n\ndef test_a_valve_is_where_it_was_sent():\n    assert steps(20) == 20\n")
    status, told, _ = of(tree, ONE_STEP_MORE)
    assert status == 0 and "test_a_valve_is_where_it_was_sent: assert" in told, told


@needs_cosmic_ray
def test_a_mutant_that_hangs_is_found(tree):
    status, told, _ = of(tree, STANDS_STILL)
    assert status == 0 and "the interpreter hung and was killed after 1 s" in told, told


@needs_cosmic_ray
def test_a_test_that_waits_for_what_its_file_shares_does_not_hang(tree):
    """One function does the work for all, and the others, which seem quick, are tried first."""
    with open(tree / "host_tests/valve/test_valve.py", "a") as tests:
        tests.write(SHARED)
    status, told, _ = of(tree, ONE_STEP_MORE)
    assert status == 1 and "SURVIVED, tests that run it: 5" in told, told


FAILS_LATER = """

import sys


def test_a_valve_shuts():
    assert opens(51) and "noting" in sys.argv[0]
"""


@needs_cosmic_ray
def test_a_test_that_fails_without_the_mutant_as_well_has_not_found_it(tree):
    """This one passed when its lines were noted; it may fail behind another one alone."""
    tests = ITS_TESTS.replace("opens(51) and not opens(50)", "opens(51)") + FAILS_LATER
    (tree / "host_tests/valve/test_valve.py").write_text(tests)
    status, told, trouble = of(tree, OPENS_AT_THE_HALF)
    assert status == 1 and "SURVIVED, tests that run it: 2" in told, told + trouble
    (tree / "host_tests/valve/test_valve.py").write_text(ITS_TESTS + FAILS_LATER)
    status, told, trouble = of(tree, OPENS_AT_THE_HALF)
    assert status == 0 and "test_a_valve_opens_above_the_half" in told, told + trouble


@needs_cosmic_ray
def test_a_line_that_no_test_runs_is_told(tree):
    status, told, _ = of(tree, SPARE)
    assert status == 1 and "SURVIVED, tests that run it: 0" in told, told


@needs_cosmic_ray
def test_a_seed_gives_the_same_mutants_again(tree):
    words = ("--tree", tree, "--only", "firmware", "--patience", 1, "--count", 3)
    first = mutants(*words, "--jobs", 1)[1]
    seed = re.search(r"seed (\d+): the tests found \d of 3 mutants", first)[1]
    again = mutants(*words, "--jobs", 1, "--seed", seed)[1]
    named = r"^\d: (firmware/valve.py:\S+)$"
    assert re.findall(named, first, re.M) == re.findall(named, again, re.M)
    assert len(set(re.findall(named, first, re.M))) == 3, first


@needs_cosmic_ray
def test_the_tree_itself_stays_as_it_is(tree):
    of(tree, OPENS_AT_THE_HALF, SPARE)
    assert (tree / "firmware/valve.py").read_text() == VALVE
    assert sorted(os.listdir(tree)) == ["boards", "build", "firmware", "host_tests"]


@needs_cosmic_ray
def test_what_is_no_change_is_no_mutant(tree):
    """Nor are docstrings: all that can be changed of this file is a number."""
    (tree / "firmware/valve.py").write_text('"""1 < 2."""\n\nVALVES = 3\n')
    (tree / "host_tests/valve/test_valve.py").write_text("import valve\n")
    status, told, trouble = mutants("--tree", tree, "--only", "firmware", "--count", 20)
    assert "the tests found 0 of 1 mutants" in told, told + trouble
    assert "VALVES = 4" in told or "VALVES = 2" in told


@needs_cosmic_ray
def test_to_return_nothing_at_the_end_is_to_return_nothing(tree):
    """A mutant without that would be the same program; one without it in the middle is not."""
    (tree / "firmware/valve.py").write_text(
        """def name(open, shut):
    if open:
        return None
    if shut:
        print(shut)
    return None
"""
    )
    (tree / "host_tests/valve/test_valve.py").write_text("import valve\n")
    told = mutants("--tree", tree, "--only", "firmware", "--count", 50)[1]
    assert "valve.py:3:8:RemoveStatement" in told and "valve.py:6:4:" not in told, told


def test_what_cannot_be_understood_is_refused_before_anything_is_fetched():
    for wrong in (
        ["--count", "0"], ["--jobs", "many"], ["--seed", "-1"], ["--sneeze"], ["--only", "tools"],
        ["--only", "firmware/no_such_file.py"], ["--patience", "0"], ["--mutant", "uss"],
    ):  # fmt: skip
        status, _, told = mutants("--check", *wrong)
        assert status == 2 and wrong[0] in told, told


@needs_cosmic_ray
def test_a_mutant_that_does_not_exist_is_refused(tree):
    status, _, told = of(tree, SPARE.replace("17", "18"))
    assert status == 2 and "--mutant: there is no firmware/valve.py:18" in told, told
    status, _, told = of(tree, SPARE.replace("ReplaceNumber", "Sneeze"))
    assert status == 2 and "is no name of a mutant" in told, told


def test_help_says_what_the_exit_status_means():
    status, told, _ = mutants("--help")
    assert status == 0 and "--count" in told and "some survived" in told
