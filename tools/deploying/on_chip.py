# SPDX-License-Identifier: MIT
"""What tools/deploy makes the chip do: look at files, replace an old one by a new one, remove.

This file is MicroPython. tools/deploy sends it over the serial line, and it lives in the chip's
RAM until the next restart; no file of it stays there. Paths are relative to the top of the chip's
file system. Answers are printed and read back as Python literals.
"""

import binascii
import hashlib
import os

_FOLDER = 0x4000  # in the mode that os.stat tells
_PIECE = 512  # bytes


def look(paths):
    """[(path, bytes, SHA-256)] of those that are there; of a folder (path, -1, "")."""
    found = []
    for path in paths:
        try:
            status = os.stat(path)
        except OSError:
            continue
        if status[0] & _FOLDER:
            found.append((path, -1, ""))
        else:
            found.append((path, status[6], sha256(path)))
    return found


def sha256(path):
    total = hashlib.sha256()
    piece = bytearray(_PIECE)
    view = memoryview(piece)
    with open(path, "rb") as file:
        while True:
            count = file.readinto(piece)
            if not count:
                return binascii.hexlify(total.digest()).decode()
            total.update(view[:count])


def read(path):
    with open(path, "rb") as file:
        return file.read()


def names(ending):
    """The files at the top that end so."""
    return sorted([name for name in os.listdir() if name.endswith(ending)])


def free_blocks():
    """(bytes of a block, blocks that are free) of the file system."""
    status = os.statvfs(os.getcwd())
    return status[0], status[3]


def make_folder(path):
    """The folder and those above it, unless they are there."""
    for end in range(1, len(path) + 1):
        if end == len(path) or path[end] == "/":
            try:
                os.stat(path[:end])
            except OSError:
                os.mkdir(path[:end])


def replace(new, path):
    """`new` takes the place of `path` at once: littlefs promises that (README, Usage)."""
    os.rename(new, path)


def remove(path):
    os.remove(path)


def remove_empty(folders):
    """Those of the folders that are there and empty. An empty one would hide a frozen package."""
    for folder in folders:
        try:
            os.rmdir(folder)
        except OSError:
            pass


def stop_watchdog():
    """Whether one was running: CTRL register, bit ENABLE (RP2040 data sheet 4.7.6, RP2350 12.9).
    On an ESP32 nobody can tell; the panel that was ended has given it a day."""
    import sys

    import machine

    chip = sys.implementation._machine.rpartition(" with ")[2]
    control = {"RP2040": 0x40058000, "RP2350": 0x400D8000}.get(chip)
    if control is None:
        return False
    running = machine.mem32[control] >> 30 & 1
    machine.mem32[control + 0x3000] = 1 << 30  # the address that clears bits
    return bool(running)
