# SPDX-License-Identifier: MIT
"""What a release is made of: each part makes its files in a folder.

    for part in PARTS: part.make(top, folder)       # Missing: why it cannot be made here

The same tree gives the same bytes: archives have the date of the changes, not of today.
"""

import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from tools.releasing import mip
from tools.releasing.version import changes, version

SUMS, NOTES = "SHA256SUMS", "NOTES.md"
BOARDS = {"pico": "panel", "pico2": "pico2"}  # name of the board -> of the file in build/pico
STAMP = (2026, 1, 1, 0, 0, 0)  # of all that is in an archive
EPOCH = "1767225600"  # the same, for pip
WHEEL = ("firmware/uss", "firmware/LICENSE", "tools/pc", "tools/port")  # what it is made of
SETTINGS = "tools/examples/settings"


class Missing(Exception):
    """Why a part cannot be made here."""


class Part(NamedTuple):
    name: str
    what: str
    make: Callable  # top, folder -> None


def run(command, **options):
    """What it printed. Missing: it failed, and why by its last line."""
    ended = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options)
    said = ended.stdout.decode("utf-8", "replace").strip()
    if ended.returncode:
        raise Missing(said.rpartition("\n")[2] or f"status {ended.returncode}")
    return said


# ---- the parts --------------------------------------------------------------------------------


def firmware(board):
    def make(top, folder):
        output = folder / f"panel-{board}-{version(top)}.uf2"
        command = [top / "tools/uf2", "--board", board, "--output", output]
        # What it says of its progress is for the person; the last line of an error, too.
        ended = subprocess.run(command, stdout=subprocess.DEVNULL, check=False)
        if ended.returncode:
            raise Missing(f"./tools/uf2 --board {board} says why")

    return make


def wheel(top, folder):
    """For pip. What setuptools leaves behind stays out of the tree."""
    with tempfile.TemporaryDirectory() as made:
        for path in WHEEL:
            source, copy = top / path, Path(made, path)
            copy.parent.mkdir(parents=True, exist_ok=True)
            if source.is_dir():
                shutil.copytree(source, copy, ignore=shutil.ignore_patterns("__pycache__"))
            else:
                shutil.copy(source, copy)
        pip = [sys.executable, "-m", "pip", "wheel", "--disable-pip-version-check", "--no-deps"]
        environment = {**os.environ, "SOURCE_DATE_EPOCH": EPOCH}
        run([*pip, "--wheel-dir", folder, Path(made, "tools/pc")], env=environment)


def library(top, folder):
    """For mip: unpack it into a folder of a web server, or give mpremote its package.json."""
    files = {path: (top / "firmware" / path).read_bytes() for path in mip.paths(top)}
    files[mip.FILE] = mip.package(top).encode()
    files["LICENSE"] = (top / "firmware/LICENSE").read_bytes()
    archive(folder / f"uss-mip-{version(top)}.zip", files)


def settings(top, folder):
    there = sorted((top / SETTINGS).iterdir())
    archive(
        folder / f"settings-{version(top)}.zip", {path.name: path.read_bytes() for path in there}
    )


def page(top, folder):
    """The panel in a browser, as a folder of files that need no server of ours."""
    with tempfile.TemporaryDirectory() as made:
        run([top / "tools/panel", "--web", "--static", made])
        paths = sorted(path for path in Path(made).rglob("*") if path.is_file())
        files = {path.relative_to(made).as_posix(): path.read_bytes() for path in paths}
    archive(folder / f"panel-page-{version(top)}.zip", files)


PARTS = (
    *(Part(board, f"the firmware for the {board}", firmware(board)) for board in BOARDS),
    Part("pip", "the library for pip", wheel),
    Part("mip", "the library for mip", library),
    Part("settings", "example files of settings", settings),
    Part("page", "the panel in a browser", page),
)


# ---- what is beside them ----------------------------------------------------------------------


def archive(path, files):
    """files: {name: bytes}."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as packed:
        for name in sorted(files):
            head = zipfile.ZipInfo(name, STAMP)
            head.compress_type = zipfile.ZIP_DEFLATED
            head.external_attr = 0o644 << 16
            packed.writestr(head, files[name])


def sums(folder):
    """A line for each file, as sha256sum writes and checks them."""
    for path in sorted(folder.iterdir()):
        if path.name not in (SUMS, NOTES):
            yield f"{hashlib.sha256(path.read_bytes()).hexdigest()}  {path.name}\n"


def finish(top, folder):
    """Checksums, and what has changed."""
    (folder / SUMS).write_text("".join(sums(folder)))
    number, text = changes(top)
    (folder / NOTES).write_text(f"USS panel {number}\n\n{text}", encoding="utf-8")
