# SPDX-License-Identifier: MIT
"""The interpreters that a soak can run on: which of them runs a seed, and how it is started.

A seed runs the same on each of them; they differ in speed, and in the errors that they notice.
Only MicroPython locks its heap in interrupt handlers, so every tenth seed stays there. CPython is
1.5 times as fast. PyPy is seven times as fast once it is warm, which takes five seconds and more.
"""

import os
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
WORKER = "tools/soaking/worker.py"
CACHES = TOP / "build/pycache"
KEEPS_NOTHING = "PYTHONDONTWRITEBYTECODE"
MICROPYTHON, CPYTHON, PYPY = "micropython", "cpython", "pypy"

PYTHON = ("-u", "-s")  # -u: its output must not be buffered
COMMANDS = {
    MICROPYTHON: (TOP / "build/unix64/micropython", "-X", "heapsize=96M"),
    CPYTHON: (sys.executable, *PYTHON),
    PYPY: (TOP / "build/pypy/pypy3", *PYTHON),
}
NAMES = {MICROPYTHON: "MicroPython", CPYTHON: "CPython", PYPY: "PyPy"}

SHARE = 10  # one of so many seeds runs on MicroPython
WARM_MINUTES = 30  # of virtual time in a process; beyond that PyPy is faster


def is_here(name):
    return os.access(COMMANDS[name][0], os.X_OK)


def fastest(minutes):
    """The best one for a process with so many minutes of virtual time to run, installed or not."""
    return PYPY if minutes >= WARM_MINUTES else CPYTHON


def of_seed(seed, fast):
    """The interpreter that runs a seed, if `fast` runs most of them."""
    return fast if seed % SHARE else MICROPYTHON


def command(name, arguments):
    """Starts the worker."""
    return [*map(str, COMMANDS[name]), WORKER, *map(str, arguments)]


def environment(name, firmware, caches=CACHES):
    """The environment by which it finds its modules. firmware: the folder. caches: that for what
    it has compiled, for the panel loads some modules again and again."""
    if name == MICROPYTHON:
        return {**os.environ, "MICROPYPATH": "%s:%s:.frozen" % (firmware, TOP)}
    paths = (firmware, TOP, TOP / "host_tests/cpython")  # which has a module `micropython`
    found = {name: os.environ[name] for name in os.environ if name != KEEPS_NOTHING}
    found["PYTHONPATH"] = ":".join(map(str, paths))
    found["PYTHONPYCACHEPREFIX"] = str(caches)
    found["PYTHONHASHSEED"] = "0"  # the order of a set must not change from run to run
    return found
