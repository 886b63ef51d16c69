# SPDX-License-Identifier: MIT
"""What runs where with --coverage: what takes long once, each line once (shares.py)."""

import ast
import json
import subprocess
import sys

import choose_lines
import pytest

import shares
from tiers import CACHES, ENVIRONMENT, TOP, interpreters, said

INTERPRETERS = "host"

PLAIN = "def test_short(): pass\ndef test_slow(): pass\n"
HERE = ("unix64", "unix32", "cpython")


@pytest.fixture
def tables(tmp_path, monkeypatch):
    """Writes both, for the test files in tmp_path."""

    def write(slow=None, lines=None):
        (tmp_path / "slow_once.json").write_text(json.dumps(slow or {}))
        (tmp_path / "lines_once.json").write_text(json.dumps(lines or {}))

    monkeypatch.setattr(shares, "TESTS", tmp_path)
    monkeypatch.setattr(shares, "SLOW_ONCE", tmp_path / "slow_once.json")
    monkeypatch.setattr(shares, "LINES_ONCE", tmp_path / "lines_once.json")
    return write


@pytest.fixture
def shown(tmp_path):
    """What runs of a file: "unix64: test_short", a line for each tier."""

    def show(path, source=PLAIN, here=HERE):
        tree = ast.parse(source)
        names = [node.name for node in tree.body if isinstance(node, ast.FunctionDef)]
        tiers = [
            next(tier for tier in word.split("|") if tier in here)
            for word in interpreters(tree, tmp_path / path)
            if set(word.split("|")) & set(here)
        ]
        found = shares.shares(tmp_path / path, tree, names, tiers, here)
        return [f"{tier}: {' '.join(sorted(names))}" for tier, names in found.items()]

    return show


EVERYWHERE = [f"{tier}: test_short test_slow" for tier in HERE]


def test_what_is_in_no_table_runs_everywhere(tables, shown):
    tables()
    assert shown("uss/test_a.py") == EVERYWHERE


def test_what_takes_long_runs_with_the_small_integers_of_a_chip(tables, shown):
    tables(slow={"uss/test_a.py": ["test_slow"]})
    assert shown("uss/test_a.py") == [
        "unix64: test_short",
        "unix32: test_short test_slow",
        "cpython: test_short",
    ]
    assert shown("uss/test_b.py") == EVERYWHERE


def test_or_on_the_first_interpreter_that_its_file_has_and_the_machine(tables, shown):
    tables(slow={"uss/test_a.py": ["test_slow"], "sim/test_a.py": ["test_slow"]})
    on_unix64 = ["unix64: test_short test_slow", "cpython: test_short"]
    assert shown("sim/test_a.py") == on_unix64
    assert shown("uss/test_a.py", here=("unix64", "cpython")) == on_unix64
    assert shown("uss/test_a.py", here=("cpython",)) == ["cpython: test_short test_slow"]


def test_for_its_lines_it_runs_on_cpython_as_well(tables, shown):
    table = {"uss/test_a.py": ["test_slow"]}
    tables(slow=table, lines={**table, "panel/test_p.py": ["test_short"]})
    assert shown("uss/test_a.py") == [
        "unix64: test_short",
        "unix32: test_short test_slow",
        "cpython: test_short test_slow",
    ]
    assert shown("panel/test_p.py") == ["unix32: test_short test_slow", "cpython: test_short"]
    assert shown("panel/test_p.py", here=("unix32",)) == ["unix32: test_short test_slow"]


def test_a_file_that_names_its_interpreters_runs_on_them_as_a_whole(tables, shown):
    tables(slow={"uss/test_a.py": ["test_slow"]}, lines={"uss/test_a.py": ["test_slow"]})
    named = 'INTERPRETERS = "unix64 unix32"\n'
    assert shown("uss/test_a.py", named + PLAIN) == EVERYWHERE[:2]


def test_a_name_that_no_function_has_any_more_is_told(tables, shown):
    tables(slow={"uss/test_a.py": ["test_gone"]})
    with pytest.raises(shares.NotHere, match=r"slow_once\.json names test_gone"):
        shown("uss/test_a.py")


def test_the_tables_name_what_is_there():
    for table in (shares.SLOW_ONCE, shares.LINES_ONCE):
        for path, names in json.loads(table.read_text()).items():
            tree = ast.parse((shares.TESTS / path).read_bytes())
            assert not said(tree), path
            assert set(names) <= {getattr(node, "name", "") for node in tree.body}, path


ANYBODY = {"CI": "", "USS_STRICT": ""}  # who may lack a tier
TABLES = """
import pathlib, shares
shares.TESTS = pathlib.Path(__file__).parent
shares.SLOW_ONCE = shares.TESTS / "slow_once.json"
shares.LINES_ONCE = shares.TESTS / "lines_once.json"

from tiers import TIERS
for name in [name for name in TIERS if not TIERS[name].everywhere]:
    del TIERS[name]
"""


@pytest.fixture
def collected(tmp_path, tables):
    """What pytest says that it would run, with these tables."""
    (tmp_path / "tables.py").write_text(TABLES)
    (tmp_path / "test_it.py").write_text(PLAIN)

    def collect(*arguments, **written):
        tables(**written)
        run = subprocess.run(
            [sys.executable, "-BX", CACHES, "-m", "pytest", "-c", TOP / "host_tests/pytest.ini"]
            + ["--rootdir", tmp_path, "-p", "no:cacheprovider", "-p", "conftest", "-p", "tables"]
            + ["-q", "--collect-only", tmp_path, *arguments],
            env={**ENVIRONMENT, **ANYBODY, "PYTHONPATH": f"{TOP / 'host_tests'}:{tmp_path}"},
            cwd=tmp_path, capture_output=True, text=True,
        )  # fmt: skip
        return run.stdout

    return collect


def test_pytest_does_so_with_coverage_alone(collected):
    slow = {"test_it.py": ["test_slow"]}
    assert collected(slow=slow).count("::test_slow\n") == collected().count("::test_short\n") > 0
    told = collected("--coverage", slow=slow)
    assert told.count("::test_slow\n") == 1 < told.count("::test_short\n"), told
    assert "::test_slow\n" in collected("--coverage", "-k", "cpython and slow", slow=slow)


def test_pytest_refuses_a_table_that_is_not_true_any_more(collected):
    told = collected("--coverage", lines={"test_it.py": ["test_gone"]})
    assert "lines_once.json names test_gone, which is not here" in told, told


# ---- choosing -------------------------------------------------------------------------------

IMPORTS = "import time\nfrom uss.timing import Timing, elapsed\n"
BRIEF = "def test_brief(): pass\n"
LONG = "def test_long(): time.sleep(0.4)\n"
LONG_FOR_A_LINE = "def test_long_for_a_line(): time.sleep(0.4); elapsed(3, 1, 255)\n"
LINES = "def test_lines(): Timing(9600).telegram_us(4)\n"
FEWER_LINES = "def test_fewer_lines(): Timing(9600)\n"
FAILS = "def test_fails(): Timing(9600).residual_us(4); raise ValueError\n"


def test_what_is_slow_and_what_alone_runs_a_line_is_chosen(tmp_path, tables, monkeypatch, capsys):
    for path, source in {
        "uss/test_a.py": BRIEF + LONG + LONG_FOR_A_LINE,
        "uss/test_named.py": 'INTERPRETERS = "cpython"\n' + LONG,
        "panel/test_p.py": BRIEF + FEWER_LINES + LINES + FAILS,
    }.items():
        (tmp_path / path).parent.mkdir(exist_ok=True)
        (tmp_path / path).write_text(IMPORTS + source)
    monkeypatch.setattr(choose_lines, "SLOW_S", 0.3)
    monkeypatch.setattr(choose_lines, "SLOW_ONCE", shares.SLOW_ONCE)
    monkeypatch.setattr(choose_lines, "LINES_ONCE", shares.LINES_ONCE)
    monkeypatch.setitem(ENVIRONMENT, choose_lines.COVERAGE, "")
    choose_lines.main(tmp_path)
    assert json.loads(shares.SLOW_ONCE.read_text()) == {
        "uss/test_a.py": ["test_long", "test_long_for_a_line"]
    }
    assert json.loads(shares.LINES_ONCE.read_text()) == {
        "panel/test_p.py": ["test_lines"],
        "uss/test_a.py": ["test_long_for_a_line"],
    }
    told = capsys.readouterr().out
    assert told.startswith("2 tests (1 s) are slow; 2 tests (0 s) run on CPython"), told
