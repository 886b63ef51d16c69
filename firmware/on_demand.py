# SPDX-License-Identifier: MIT
"""Modules that are needed now and then: they come from the flash, and leave the memory again.

A chip that has the firmware as files holds in its memory what is loaded. Only what the main loop
needs all the time may stay there.

    settings = call("settings_file", "load", store)
    page = load("panel.pages.parameters").Parameters(panel)
    drop("panel.pages.parameters")
"""

import gc
import sys

ROOMY_BYTES = 80_000  # where so much is free, what a key may ask for any time stays loaded

_kept = ()  # names that `drop` leaves alone
_idle = []  # those that were dropped, where there is room: they leave one by one

# Of MicroPython itself. Whoever imports one makes it look into the file system first, which takes
# 3 ms, each time again unless it stands among the modules that are loaded.
BUILT_IN = ("array", "binascii", "deflate", "io", "json", "struct")


def keep(listed=None):
    """Load for good, if there is room, what the module `listed` names in NAMES: to load a module
    takes some milliseconds. What was kept before is not any more.
    """
    global _kept
    for name in BUILT_IN:
        if name not in sys.modules:
            sys.modules[name] = __import__(name)
    before, _kept = _kept, ()
    for name in before:  # of the panel before this one: what they take is free again
        drop(name)
    flush()
    gc.collect()
    if listed and (not hasattr(gc, "mem_free") or gc.mem_free() >= ROOMY_BYTES):
        names = load(listed).NAMES
        drop(listed)
        for name in names:
            load(name)
        _kept = names


def free_bytes():
    """The memory that is free, 0 if nobody knows. To count it takes a chip 10 ms."""
    return gc.mem_free() if hasattr(gc, "mem_free") else 0


def load(name):
    """The module."""
    module = sys.modules.get(name)
    if module is None:
        __import__(name)  # it answers the outermost package: to walk down from there takes long
        module = sys.modules[name]
    while name in _idle:
        _idle.remove(name)
    return module


def missing(names):
    """Those of them that are not in memory."""
    for name in _idle[:]:
        if name in names:
            _idle.remove(name)
    return [name for name in names if name not in sys.modules]


def drop(*names):
    """Forget them. Their memory is free as soon as nobody uses what was in them; where there is
    room, `tidy` does it, since to forget a page with all its modules would take some milliseconds.
    """
    if _kept:
        _idle.extend(names)  # whatever they are: `tidy` looks at them
    else:
        for name in names:
            _forget(name)


def tidy():
    """One of those that were dropped leaves the memory."""
    if _idle:
        name = _idle.pop()
        if name not in _kept:
            _forget(name)


def flush():
    """All of them leave it."""
    while _idle:
        tidy()


def _forget(name):
    if sys.modules.pop(name, None) is None:
        return
    package, _, module = name.rpartition(".")
    if package in sys.modules:
        try:
            delattr(sys.modules[package], module)
        except (AttributeError, KeyError):  # it is not there: to ask first takes as long once more
            pass


def call(name, function, *arguments):
    """What this function of the module answers."""
    try:
        return getattr(load(name), function)(*arguments)
    finally:
        drop(name)
