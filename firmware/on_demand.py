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

ROOMY_BYTES = 100_000  # where so much is free, what a key may ask for any time stays loaded

_kept = ()  # names that `drop` leaves alone


def keep(names):
    """Load these modules for good, if there is room: to load one takes some milliseconds."""
    global _kept
    before, _kept = _kept, ()
    for name in before:  # of the panel before this one: what they take is free again
        drop(name)
    gc.collect()
    if not hasattr(gc, "mem_free") or gc.mem_free() >= ROOMY_BYTES:
        for name in names:
            load(name)
        _kept = names


def load(name):
    """The module."""
    module = sys.modules.get(name)
    if module is None:
        __import__(name)  # it answers the outermost package: to walk down from there takes long
        module = sys.modules[name]
    return module


def missing(names):
    """Those of them that are not in memory."""
    return [name for name in names if name not in sys.modules]


def drop(name):
    """Forget it. Its memory is free as soon as nobody uses what was in it."""
    if name in _kept:
        return
    sys.modules.pop(name, None)
    package, _, module = name.rpartition(".")
    if package in sys.modules and hasattr(sys.modules[package], module):
        delattr(sys.modules[package], module)


def call(name, function, *arguments):
    """What this function of the module answers."""
    try:
        return getattr(load(name), function)(*arguments)
    finally:
        drop(name)
