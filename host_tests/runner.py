# SPDX-License-Identifier: MIT
"""Runs the test functions of one file, on MicroPython or on CPython, and reports each as it ends.

pytest starts it (conftest.py, tiers.py), one process for each file and tier. By hand, from the
top of the tree:

    build/unix32/micropython host_tests/runner.py unix32 host_tests/uss/test_telegram.py [NAME ...]

Without names of functions it runs all of the file; without a file it only tells what it runs on.
Before anything else it proves that the interpreter is what the tier promises.
"""

import gc
import io
import os
import sys

# A report is a line that begins with this character (ASCII "record separator"), so that it cannot
# be mistaken for what a test prints. Between "began" and "passed" or "failed" stands what the
# function printed; the traceback stands between "raised" and "failed".
MARK = "\x1e"

# What each tier promises: implementation, bits of an integer that needs no heap.
PROMISES = {
    "unix64": ("micropython", 63),
    "unix32": ("micropython", 31),
    "cpython": ("cpython", 0),
    "pico": ("micropython", 63),
    "pico_again": ("micropython", 63),
    "pico_hard": ("micropython", 63),
    "pico_hard_again": ("micropython", 63),
}

# The tiers with an emulated Pico: which build of the firmware it has, what callbacks the timers of
# that take, and what the chip does otherwise than usual (tools/emulator/README.md).
AGAIN = {"receive_timeout": "again"}
PICOS = {
    "pico": ("", "soft", {}),
    "pico_again": ("", "soft", AGAIN),
    "pico_hard": ("_hard", "hard", {}),
    "pico_hard_again": ("_hard", "hard", AGAIN),
}

# What the emulated Pico is made of, besides firmware; tools/test puts it there.
PICO_FILES = (
    "build/emulator/bootrom.bin",
    "build/emulator/node_modules/rp2040js/package.json",
)

# On the chip: what it runs, and what callbacks its timers take.
TELL = """
import sys, machine
print(sys.version.split("; ")[1].split(" on ")[0])
try:
    machine.Timer(period=1000, callback=print, hard=True).deinit()
    print("hard")
except TypeError:
    print("soft")
"""

# Bytes between two collections. Fewer, and a test with many objects collects most of the time;
# more, and MicroPython takes ever longer to find the last holes in its heap.
COLLECT_AFTER = 8_000_000

# The 32-bit Unix port has 40 KB of stack, and each import within an import takes over 4 KB of it.
# What lies deep is imported first, so that it does not come below all that a test imports.
DEEP = ("uss.master", "main")

# Relative to the top of the tree, which is the working directory. compiled.py makes the other one.
IMPORT_FOLDERS = ("", "firmware", "host_tests/benches")
COMPILED_FOLDER = "build/compiled"

# In the environment: the tree whose modules are compiled there; that lines are to be noted.
COMPILED, COVERAGE = "USS_COMPILED", "USS_COVERAGE"


def main(tier, path=None, *names):
    sys.path[:] = search_path()
    version = prove(tier)
    if tier in PICOS:
        from tools.emulator import chip, world

        world.build, timers, model = PICOS[tier]
        chip.usual.update(model)
        version = pico(timers) if path is None else version
    if path is None:
        print(version)
        return
    notes = tier == "cpython" and os.getenv(COVERAGE)
    if notes:
        import line_notes

        line_notes.begin()
    if hasattr(gc, "threshold"):
        gc.threshold(COLLECT_AFTER)
    folder, _, file_name = path.rpartition("/")
    if folder not in IMPORT_FOLDERS:
        sys.path.insert(0, folder)
    if tier == "unix32":
        for name in DEEP:
            __import__(name)
    module = __import__(file_name[: -len(".py")])
    for name in names or test_functions(module):
        run(name, getattr(module, name))
    if notes:
        for path, numbers in line_notes.seen():
            report("lines", path, *map(str, sorted(numbers)))


def report(*words):
    print(MARK + " ".join(words))


def run(name, function):
    report("began", name)
    try:
        function()
    except BaseException as error:  # sys.exit() in a test is a failure too
        unlock_heap()
        report("raised", name)
        print_traceback(error)
        report("failed", name)
    else:
        report("passed", name)


def test_functions(module):
    return sorted(name for name in dir(module) if name.startswith("test_"))


# ---- the interpreter ------------------------------------------------------------------------


def search_path():
    if sys.implementation.name == "micropython":
        folders = list(IMPORT_FOLDERS) + [".frozen"]
        if os.getenv(COMPILED) == os.getcwd():  # that of another tree is not this program
            folders[:0] = [COMPILED_FOLDER + "/" + folder for folder in IMPORT_FOLDERS]
        return folders
    return list(IMPORT_FOLDERS) + ["host_tests/cpython"] + sys.path


def prove(tier):
    """Returns a line about the interpreter; ends the process when it is not as promised."""
    found = (sys.implementation.name, small_integer_bits())
    if found != PROMISES[tier]:
        print("this is not %s: %r wanted, %r found" % (tier, PROMISES[tier], found))
        sys.exit(1)
    if found[0] == "cpython":
        return "CPython " + sys.version.split()[0]
    return "%s, small integers of %d bits" % (sys.version.split("; ")[-1], found[1])


def pico(timers):
    """Boots the emulated Pico and returns a line about it; ends the process when it does not, or
    when its timers are others."""
    import json

    from tools.emulator.world import PROGRAMS, PicoWorld, program_path

    for path in PICO_FILES + tuple(program_path(name) for name in PROGRAMS):
        try:
            open(path).close()
        except OSError:
            print("there is no " + path)
            sys.exit(1)
    with open(PICO_FILES[1]) as package:
        emulator = json.load(package)["version"]
    world = PicoWorld("stock", addresses=())
    world.repl.open()
    told, error = world.repl.execute(TELL)
    if error:
        print("the emulated Pico does not run: " + error)
        sys.exit(1)
    version, found = told.split("\r\n")[:2]
    if found != timers:
        print("this is not the firmware with %s timers: %s has %s" % (timers, version, found))
        sys.exit(1)
    line = "%s with %s timers on an emulated RP2040 (rp2040js %s)"
    return line % (version, timers, emulator)


def small_integer_bits():
    """Measures it: the first power of two that needs the heap, while the heap is locked."""
    import micropython

    if not hasattr(micropython, "heap_lock"):
        return 0
    power = 1
    bits = 2  # 1 needs two bits, one of them for the sign
    micropython.heap_lock()
    try:
        while True:
            power += power
            bits += 1
    except MemoryError:
        return bits
    finally:
        micropython.heap_unlock()


def unlock_heap():
    """A test that failed with the heap locked leaves it locked, but the report needs the heap."""
    import micropython

    while True:
        try:
            return bytearray(1)
        except MemoryError:
            micropython.heap_unlock()


# ---- tracebacks -----------------------------------------------------------------------------


def print_traceback(error):
    """Prints the traceback with the source lines, and without the frames of this file."""
    if sys.implementation.name == "cpython":
        import traceback

        traceback.print_exception(type(error), error, error.__traceback__.tb_next, file=sys.stdout)
        return
    text = io.StringIO()
    sys.print_exception(error, text)
    told = text.getvalue().replace(COMPILED_FOLDER + "/", "")  # of what could not be compiled
    for line in told.split("\n"):
        if not line.startswith('  File "'):
            print(line)
            continue
        path, number = line[len('  File "') :].split('", line ')
        if path != sys.argv[0]:
            print(line)
            print("    " + source_line(path, int(number.split(",")[0])))


def source_line(path, number):
    try:
        with open(path) as source:
            for _ in range(number - 1):
                source.readline()
            return source.readline().strip()
    except OSError:
        return "(no source)"


if __name__ == "__main__":
    main(*sys.argv[1:])
