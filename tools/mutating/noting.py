# SPDX-License-Identifier: MIT
"""Runs the tests of one file, and tells which statements each of them has run.

    micropython noting.py HOST_TESTS/FILE.py COUNT      # or python3

The working directory is a tree whose firmware notes its lines (reach.py): COUNT statements, each
with a number. For each function comes a line: MARK, its name, milliseconds, whether it passed,
and a character for each statement, of which "\\x01" means that it ran. The first one, "import",
is the file itself.
"""

import sys

MARK = "\x1e"
NOTES = "__lines_that_ran__"
COLLECT_AFTER = 4_000_000


def main(path, count):
    import builtins
    import gc

    notes = bytearray(int(count))
    setattr(builtins, NOTES, notes)
    folder, _, name = path.rpartition("/")
    first = [folder, "", "firmware", "host_tests/benches"]
    if sys.implementation.name == "micropython":
        gc.threshold(COLLECT_AFTER)
        sys.path[:] = first + [".frozen"]
    else:
        sys.path[:] = first + ["host_tests/cpython"] + sys.path[1:]
    module = __import__(name[: -len(".py")])
    tell("import", 0, True, notes)
    for name in sorted(dir(module)):
        if name.startswith("test_"):
            run(name, getattr(module, name), notes)


def run(name, function, notes):
    import time

    for at in range(len(notes)):
        notes[at] = 0
    passed = False
    began = time.time()
    try:
        function()
        passed = True
    except BaseException as error:
        unlock_heap()
        print(repr(error))
    tell(name, (time.time() - began) * 1000, passed, notes)


def unlock_heap():
    """A test that failed with the heap locked leaves it locked."""
    import micropython

    while True:
        try:
            return bytearray(1)
        except MemoryError:
            micropython.heap_unlock()  # CPython has neither the lock nor this


def tell(name, took_ms, passed, notes):
    print("%s %s %d %d %s" % (MARK, name, took_ms, passed, notes.decode()))


if __name__ == "__main__":
    main(*sys.argv[1:])
