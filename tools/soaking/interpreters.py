# SPDX-License-Identifier: MIT
"""The interpreters that a soak can run on: which of them runs a seed, and how it is started.

A seed runs the same on each of them; they differ in speed, and in the errors that they notice.
Only MicroPython locks its heap in interrupt handlers, so every tenth seed stays there. CPython is
twice as fast as Debian's. PyPy is not among them: it was slower than CPython, also after an hour.
"""

import os
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
WORKER = "tools/soaking/worker.py"
CACHES = TOP / "build/pycache"
KEEPS_NOTHING = "PYTHONDONTWRITEBYTECODE"
MICROPYTHON, CPYTHON = "micropython", "cpython"

COMMANDS = {
    MICROPYTHON: (TOP / "build/unix64/micropython", "-X", "heapsize=96M"),
    CPYTHON: (sys.executable, "-u", "-s"),  # -u: its output must not be buffered
}
NAMES = {MICROPYTHON: "MicroPython", CPYTHON: "CPython"}

SHARE = 10  # one of so many seeds runs on MicroPython


def is_here(name):
    return os.access(COMMANDS[name][0], os.X_OK)


def of_seed(seed):
    return CPYTHON if seed % SHARE else MICROPYTHON


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
