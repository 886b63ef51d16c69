# SPDX-License-Identifier: MIT
"""What -k passes over before it reads it: only what it cannot mean (selection.py)."""

import subprocess
import sys

import pytest

import selection
from selection import CHIP, Selection, expression_of, files_of, needs
from tiers import CACHES, TIERS, TOP

INTERPRETERS = "host"

PLAIN = "def test_one(): pass\ndef test_home_two(): pass\n"
HOST = 'INTERPRETERS = "host"\n'
VALUES = HOST + "@pytest.mark.parametrize('x', NAMES)\ndef test_it(x): pass\n"


@pytest.fixture
def file(tmp_path):
    def make(text, name="test_file.py"):
        path = tmp_path / name
        path.write_text(text)
        return path

    return make


@pytest.mark.parametrize(
    ("expression", "tiers"),
    [
        ("", "unix64 unix32 cpython"),
        ("home", "unix64 unix32 cpython"),
        ("HOME", "unix64 unix32 cpython"),
        ("home and unix32", "unix32"),
        ("home and not unix32", "unix64 cpython"),
        ("test_file", "unix64 unix32 cpython"),
        ("unix", "unix64 unix32"),
        ("away", ""),
        ("not one", "unix64 unix32 cpython"),
        ("not file", ""),
        ("one and two", ""),
    ],
)
def test_the_tiers_of_a_plain_file(file, expression, tiers):
    assert Selection(expression).tiers(file(PLAIN)) == tiers.split()


def test_a_file_names_its_tiers(file):
    path = file('INTERPRETERS = "pico pico_again"\n' + PLAIN)
    assert Selection("again").tiers(path) == ["pico_again"]
    assert Selection("unix64").tiers(path) == []


def test_a_file_names_tiers_of_which_one_is_enough(file):
    path = file('INTERPRETERS = "unix32|unix64 cpython"\n' + PLAIN)
    assert Selection("unix").tiers(path) == ["unix32", "unix64"]
    assert Selection("unix64").tiers(path) == ["unix64"]


def test_a_file_of_the_panel_runs_on_one_micropython(tmp_path):
    (tmp_path / "panel").mkdir()
    path = tmp_path / "panel" / "test_file.py"
    path.write_text(PLAIN)
    assert Selection("home").tiers(path) == ["unix32", "unix64"]


@pytest.mark.parametrize("expression", ["value", "not value", "a and not b", "host and value"])
def test_values_may_have_any_name(file, expression):
    assert Selection(expression).tiers(file(VALUES)) == ["host"]
    assert Selection(expression).tiers(file(VALUES), surely=True) == (
        ["host"] if expression == "not value" else []
    )


def test_a_function_that_is_not_there_is_no_value(file):
    assert Selection("test_other").tiers(file(VALUES)) == []
    assert Selection("test_it").tiers(file(VALUES)) == ["host"]


def test_where_the_expression_stands():
    for words in (["-k", "a b"], ["x", "-ka b"], ["-k=a b", "x"]):
        assert expression_of(words) == "a b"
    assert expression_of(["-x"]) == expression_of(["-k"]) == ""


def test_the_files_that_a_command_line_names(file, tmp_path):
    one = file(PLAIN)
    assert list(files_of(["-x", f"{one}::unix64::test_one"])) == [one.resolve()]
    assert list(files_of([str(tmp_path)])) == [one.resolve()]
    assert len(list(files_of(["-k", "nothing of that name"]))) > 200


def test_an_emulated_pico_is_needed_by_those_who_name_it(file):
    assert needs([str(file(PLAIN))]) == {"unix64", "unix32", "cpython"}
    assert needs([str(file(HOST + "WORLD = 'PicoWorld'\ndef test_a(): pass\n"))]) == {"host", CHIP}
    assert "pico" in needs([]) and CHIP in needs([])
    assert "pico" not in needs(["-k", "test_bcc_counts_stx"])
    assert CHIP not in needs(["-k", "test_bcc_counts_stx"])


def test_an_expression_that_is_none_needs_everything():
    with pytest.raises(ValueError):
        Selection("and and")
    told = subprocess.run(
        [sys.executable, "-B", selection.__file__, "-k", "and and"], capture_output=True, text=True
    )
    assert set(told.stdout.split()) == {*TIERS, CHIP}


WITHOUT_PICO = """
from tiers import TIERS
for name in [name for name in TIERS if not TIERS[name].everywhere]:
    del TIERS[name]
"""


def test_pytest_finds_the_same_with_and_without(tmp_path):
    """Whatever is chosen is collected: a strict run passes over nothing."""
    (tmp_path / "without_pico.py").write_text(WITHOUT_PICO)  # to ask them takes seconds
    expression = "bcc and not unix32 or test_timing and wrap"
    told = []
    for environment in ({}, {"USS_STRICT": "1"}):
        run = subprocess.run(
            [sys.executable, "-BX", CACHES, "-m", "pytest", "-c", TOP / "host_tests/pytest.ini"]
            + ["--rootdir", TOP / "host_tests", "-p", "no:cacheprovider", "-p", "without_pico"]
            + ["-q", "--collect-only", "-k", expression, TOP / "host_tests" / "uss"],
            env={"PYTHONPATH": f"{TOP / 'host_tests'}:{tmp_path}", **environment},
            capture_output=True, text=True,
        )  # fmt: skip
        lines = run.stdout.splitlines()
        told.append([line for line in lines if "::" in line and not line.startswith("tier ")])
    assert told[0] == told[1] and len(told[0]) > 3
