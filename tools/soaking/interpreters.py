# SPDX-License-Identifier: MIT
"""The interpreters that a soak can run on: which of them lives a seed, and how it is started.

A seed is the same life on each of them; they differ in speed, and in what they notice. MicroPython
alone locks its heap in interrupt handlers, so every tenth seed stays there. CPython is half as
fast again. PyPy is seven times as fast once it is warm, which takes five seconds and more.
"""

import os
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
WORKER = "tools/soaking/worker.py"
MICROPYTHON, CPYTHON, PYPY = "micropython", "cpython", "pypy"

# -u: what it says is waited for. -B: firmware/ stays as it is.
PYTHON = ("-u", "-B", "-s")
COMMANDS = {
    MICROPYTHON: (TOP / "build/unix64/micropython", "-X", "heapsize=96M"),
    CPYTHON: (sys.executable, *PYTHON),
    PYPY: (TOP / "build/pypy/pypy3", *PYTHON),
}
NAMES = {MICROPYTHON: "MicroPython", CPYTHON: "CPython", PYPY: "PyPy"}

SHARE = 10  # every so many seeds one is lived on MicroPython
WARM_MINUTES = 30  # of virtual time in a process: from there on PyPy is ahead


def is_here(name):
    return os.access(COMMANDS[name][0], os.X_OK)


def fastest(minutes):
    """Whichever suits a process with so many minutes of virtual time before it, here or not."""
    return PYPY if minutes >= WARM_MINUTES else CPYTHON


def of_seed(seed, fast):
    """The one that lives a seed, where `fast` lives most of them."""
    return fast if seed % SHARE else MICROPYTHON


def command(name, arguments):
    """Starts the worker."""
    return [*map(str, COMMANDS[name]), WORKER, *map(str, arguments)]


def environment(name, firmware):
    """What it finds its modules by. firmware: the folder."""
    if name == MICROPYTHON:
        return {**os.environ, "MICROPYPATH": "%s:%s:.frozen" % (firmware, TOP)}
    paths = (firmware, TOP, TOP / "host_tests/cpython")  # which has a module `micropython`
    # The order of a set must not change from run to run.
    return {**os.environ, "PYTHONPATH": ":".join(map(str, paths)), "PYTHONHASHSEED": "0"}
