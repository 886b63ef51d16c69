# SPDX-License-Identifier: MIT
"""Compares what should be on the chip with what is there, and plans what to do; it does nothing
itself.

The chip keeps a list of what was copied onto it, LIST: {"files": {path: [SHA-256, ...]}}. A file
there is ours if its SHA-256 is the listed one. All other files belong to others: their board.py
stays, and any other file is a conflict if we would overwrite it, or if MicroPython would take it
before one of ours.

    plan = Plan(files, read_list(text), look)       # look: {path: Found} of all in `paths`
"""

import hashlib
import json
from typing import NamedTuple

from tools.deploying.image import BOARD, MAIN

LIST = "deployed.json"
NEW = ".new"  # the ending of a file that is being written

# These are the panel's or the user's, even if a list names them.
NEVER = ("boot.py", "settings.json", "settings.json.new", "settings.json.bad")

# MicroPython looks for app.py before app.mpy, and for both before the app that is frozen in. As
# long as this file is there, no main.py starts the panel, not even one that is frozen in and
# cannot be removed.
GATE = "app.py"
GATE_TEXT = b"""\
# Put here by tools/deploy while it copies the firmware, and removed when all of it is there.
raise ImportError("the firmware was not copied to its end: run tools/deploy again")
"""

SPARE_BLOCKS = 16  # for folders, LIST, the gate and the file system's own needs


class Found(NamedTuple):
    size: int  # bytes; -1: a folder
    sha256: str


def sha256(data):
    return hashlib.sha256(data).hexdigest()


def read_list(data):
    """{path: [SHA-256]} from the text of LIST; empty if there is none or it is damaged."""
    try:
        files = json.loads(data)["files"]
        return {path: list(hashes) for path, hashes in files.items() if is_ours_to_list(path)}
    except (ValueError, KeyError, TypeError, AttributeError):
        return {}


def is_ours_to_list(path):
    parts = path.split("/")
    return path not in NEVER and path != LIST and "" not in parts and ".." not in parts


def write_list(*files):
    """The text of LIST for one or several {path: [SHA-256]}, joined."""
    joined = {}
    for some in files:
        for path, hashes in some.items():
            joined[path] = sorted({*joined.get(path, ()), *hashes})
    return json.dumps({"files": joined}, sort_keys=True).encode()


def folders(files):
    """Every folder that the paths go through."""
    found = set()
    for path in files:
        parts = path.split("/")
        found |= {"/".join(parts[:end]) for end in range(1, len(parts))}
    return found


def paths(files, listed):
    """Every path that has to be looked at."""
    wanted = {LIST, LIST + NEW, GATE, GATE + NEW}
    for path in {*files, *listed}:
        wanted |= {path, path + NEW, *rivals(path)}
    return sorted(wanted)


def rivals(path):
    """The files that MicroPython would take instead of the module at `path`, if they were
    there."""
    if path == MAIN:
        return []
    module, _, ending = path.rpartition(".")
    folder = [] if module.endswith("/__init__") else [module]
    return folder + [module + ".py"] * (ending == "mpy")


class Plan:
    """files: {path: bytes} that should be there; found: {path: Found} what is.

    copy         {path: bytes} that differ
    remove       paths: ours and no longer part, left by an interruption, or to be replaced
    conflicts    paths of others that are in the way
    keeps_board  a board.py of somebody else's is there, and stays
    new_list     {path: [SHA-256]} that LIST is to hold, and list_text, as it stands there
    """

    def __init__(self, files, listed, found, list_text=b"", replace=False, new_board=False):
        self.found = found
        self.listed = listed
        self.files = dict(files)
        self.keeps_board = BOARD in files and not new_board and self._is_of_others(BOARD)
        if self.keeps_board:
            del self.files[BOARD]
        conflicts = self._conflicts(new_board)
        self.replaced = [path for path in conflicts if replace and found[path].size >= 0]
        self.conflicts = [path for path in conflicts if path not in self.replaced]
        self.copy = {
            path: data
            for path, data in self.files.items()
            if path not in found or found[path].sha256 != sha256(data)
        }
        self.remove = self._remove()
        own_board = () if not new_board else (BOARD,)
        self.new_list = {
            path: [sha256(data)] for path, data in self.files.items() if path not in own_board
        }
        self.list_text = write_list(self.new_list) if self.new_list else b""
        self.list_differs = list_text != self.list_text

    @property
    def gate_is_closed(self):
        """Whether an earlier copying was not finished."""
        return self._holds(GATE, GATE_TEXT)

    @property
    def nothing_to_do(self):
        left = {LIST + NEW, GATE + NEW} | ({GATE} - {*self.files})
        return not (self.copy or self.remove or self.list_differs or left & {*self.found})

    def folders_to_leave(self):
        """The folders of what was ours that no file is wanted in, the innermost first."""
        return sorted(folders(self.listed) - folders(self.files), reverse=True)

    def blocks_wanted(self, block_bytes):
        """How many blocks of the file system this needs at once, at the most."""

        def blocks(size):
            return size // (block_bytes - 8) + 1  # littlefs: pointers in every block but the first

        room = lowest = 0
        for path in self.remove:
            room += blocks(self.found[path].size)
        for path, data in self.copy.items():
            room -= blocks(len(data))
            lowest = min(lowest, room)
            if path in self.found:
                room += blocks(self.found[path].size)
        return SPARE_BLOCKS - lowest

    def _is_of_others(self, path):
        found = self.found.get(path)
        if found is None:
            return False
        if path in self.files and found.sha256 == sha256(self.files[path]):
            return False
        return found.sha256 not in self.listed.get(path, ())

    def _holds(self, path, data):
        return path in self.found and self.found[path].sha256 == sha256(data)

    def _conflicts(self, new_board):
        in_the_way = set()
        for path in self.files:
            in_the_way |= {path, *rivals(path)} & {*self.found}
        if self.gate_is_closed:
            in_the_way.discard(GATE)
        if new_board:
            in_the_way.discard(BOARD)
        return sorted(path for path in in_the_way if self._is_of_others(path))

    def _remove(self):
        """Files of ours that are no longer part, files that an interruption left, and files to be
        replaced.
        """
        gone = {
            path
            for path in self.listed
            if path in self.found and path not in self.files and not self._is_of_others(path)
        }
        gone |= {path + NEW for path in {*self.files, *self.listed} if path + NEW in self.found}
        gone |= {path for path in self.replaced if path not in self.files}
        # LIST and the gate are written anew, and what was left of them goes with that.
        return sorted(gone - {GATE, GATE + NEW})
