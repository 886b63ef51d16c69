# SPDX-License-Identifier: MIT
"""What tools/deploy has compiled is kept (tools/deploying/kept.py): it is never old, never half,
and never too much."""

import shutil
from pathlib import Path
from threading import Barrier, Thread

import pytest

from tools.deploying import kept
from tools.deploying.errors import DeployError
from tools.deploying.image import Firmware

INTERPRETERS = "host"

SOURCES = {"main.py": b"import app", "board.py": b"pins = 1", "app.py": b"_turns = 1"}


class Compiler:
    """Counts what it compiles. program: a file, as mpy-cross is one."""

    options = ("-O3",)

    def __init__(self, program):
        self.program = program
        self.compiled = 0

    def __call__(self, path, source):
        self.compiled += 1
        if b"broken" in source:
            raise DeployError(path)
        return self.program.read_bytes() + repr(self.options).encode() + source


@pytest.fixture
def compiler(tmp_path):
    program = tmp_path / "mpy-cross"
    program.write_bytes(b"M\x06\x00\x1f")
    return Compiler(program)


@pytest.fixture
def folder(tmp_path):
    return tmp_path / "build" / "deploying"


def compiled(compiler, folder, **changes):
    """What is compiled of the sources, and how many files were: 0 when all of it was kept.

    changes: {module: source}.
    """
    before = compiler.compiled
    made = Firmware(SOURCES | {name + ".py": source for name, source in changes.items()})
    kept.compile_once(made, compiler, folder)
    return made.compiled, compiler.compiled - before


def fresh(compiler, folder, **changes):
    """What is compiled where nothing was kept."""
    return compiled(compiler, folder.parent / "empty", **changes)[0]


def test_the_same_image_is_compiled_once(compiler, folder):
    first, count = compiled(compiler, folder)
    assert count == 1 and list(first) == ["app.mpy"]
    assert compiled(compiler, folder) == (first, 0)


def test_another_source_is_compiled(compiler, folder):
    compiled(compiler, folder)
    for changes in ({"app": b"_turns = 2"}, {"menu": b"_x = 1"}):
        made, count = compiled(compiler, folder, **changes)
        assert count and made == fresh(compiler, folder, **changes)
    assert compiled(compiler, folder)[1] == 0  # the first image is there, too


def test_a_board_file_has_a_say_in_the_short_names_of_all(compiler, folder):
    before, _ = compiled(compiler, folder)
    made, count = compiled(compiler, folder, board=b"_turns = _a = 1")
    assert count and made != before


def test_another_option_and_another_compiler_compile_anew(compiler, folder):
    before, _ = compiled(compiler, folder)
    compiler.options = ("-O0",)
    optioned, count = compiled(compiler, folder)
    assert count and optioned != before
    compiler.program.write_bytes(b"M\x07\x00\x1f")
    made, count = compiled(compiler, folder)
    assert count and made not in (before, optioned)


@pytest.mark.parametrize("name", kept.MADE_BY)
def test_other_code_that_makes_the_image_compiles_anew(name, compiler, folder, monkeypatch):
    here = folder.parent.parent / "deploying"
    here.mkdir()
    for each in kept.MADE_BY:
        shutil.copy(Path(kept.__file__).parent / each, here)
    compiled(compiler, folder)
    monkeypatch.setattr(kept, "__file__", str(here / "kept.py"))
    assert compiled(compiler, folder)[1] == 0
    (here / name).write_text("something else")
    assert compiled(compiler, folder)[1]


@pytest.mark.parametrize(
    "damage", [lambda whole: whole[:-9], lambda whole: whole[:9], bytes.upper]
)
def test_a_damaged_image_is_compiled_anew(damage, compiler, folder):
    first, _ = compiled(compiler, folder)
    (image,) = folder.iterdir()
    image.write_bytes(damage(image.read_bytes()))
    assert compiled(compiler, folder) == (first, 1)
    assert compiled(compiler, folder) == (first, 0)


def test_what_cannot_be_compiled_is_said_each_time(compiler, folder):
    for _ in range(2):
        with pytest.raises(DeployError, match=r"app\.py"):
            compiled(compiler, folder, app=b"broken")


def test_two_at_once_both_have_it_and_leave_one_image(compiler, folder):
    both, made = Barrier(2, timeout=10), []

    def slow(path, source):
        both.wait()  # neither has finished when the other one begins
        return compiler(path, source)

    slow.program, slow.options = compiler.program, compiler.options

    def compile_one():
        firmware = Firmware(SOURCES)
        kept.compile_once(firmware, slow, folder)
        made.append(firmware.compiled)

    threads = [Thread(target=compile_one) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert made == [fresh(compiler, folder)] * 2
    assert len(list(folder.iterdir())) == 1
    assert compiled(compiler, folder) == (made[0], 0)


def test_where_nobody_may_write_it_is_compiled_each_time(compiler, folder):
    folder.parent.write_text("no folder")
    first = compiled(compiler, folder)
    assert first[1] == 1 and compiled(compiler, folder) == first


def test_the_last_ones_used_are_kept_and_no_more(compiler, folder):
    compiled(compiler, folder)
    for number in range(3 * kept.IMAGES):
        compiled(compiler, folder, app=b"_turns = %d" % (number + 2))
        (folder / f"left by one that was broken off {number}").touch()
        assert compiled(compiler, folder)[1] == 0  # it is used each time
    assert len(list(folder.iterdir())) <= kept.IMAGES + 1
