# SPDX-License-Identifier: MIT
"""The page without a server: files that any web server can hand out.

    build(Path("build/web"), ["--drives", "1,2=g110"])

MicroPython as WebAssembly runs the files of firmware/ and boards/sim/ in a worker of the page.
"""

import argparse
import json
import os
import shutil
import tempfile
from pathlib import Path

from tools.web.files import PAGE, page_files
from tools.web.options import Misused, Parser

TOP = Path(__file__).resolve().parents[2]
PACKAGES = TOP / "build/page/node_modules"
MICROPYTHON = PACKAGES / "@micropython/micropython-webassembly-pyscript"
INTERPRETER = ("micropython.mjs", "micropython.wasm")
SOURCES = ("firmware", "boards/sim", "tools/live", "tools/driving/decoding.py")
ENDINGS = (".py", ".tsv")
KIT = "firmware.json"
MARK = ".uss-panel"  # lies in a folder that this has made, and that it may make anew
LINK = 'name="link" content="%s"'
# A page without a server has no headers of its own.
POLICY = (
    '<meta http-equiv="Content-Security-Policy" content="default-src \'none\'; '
    "script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; img-src 'self' data:; "
    "connect-src 'self'; worker-src 'self'; base-uri 'none'; form-action 'none'\">"
)
USUAL = {"drives": "1,2,3", "baud": 19200, "keys": "direct", "seed": 0}


def build(folder, words):
    """words: options of the panel. Misused: one of them needs more than a browser, or the folder
    is somebody else's."""
    options = chosen(words)
    if folder.exists() and any(folder.iterdir()) and not (folder / MARK).exists():
        raise Misused("--static %s: there is something else in it" % folder)
    folder.parent.mkdir(parents=True, exist_ok=True)
    aside = Path(tempfile.mkdtemp(dir=folder.parent))
    try:
        fill(aside, options)
        os.chmod(aside, 0o755)
        if folder.exists():
            shutil.rmtree(folder)
        aside.rename(folder)
    finally:
        shutil.rmtree(aside, ignore_errors=True)
    print("USS panel: the page lies in %s; any web server can hand it out:" % folder)
    print("    python3 -m http.server --directory %s" % folder)


def chosen(words):
    parser = Parser(add_help=False, allow_abbrev=False, argument_default=argparse.SUPPRESS)
    parser.add_argument("--drives")
    parser.add_argument("--baud", type=int)
    parser.add_argument("--keys")
    parser.add_argument("--seed", type=int)
    found, rest = parser.parse_known_args(words)
    if rest:
        raise Misused("%s is not for --static: the page has a virtual board" % rest[0])
    return {**USUAL, **vars(found)}


def fill(folder, options):
    for name, path in page_files().items():
        shutil.copyfile(path, folder / name)
    for name in INTERPRETER:
        shutil.copyfile(MICROPYTHON / name, folder / name)
    page = (folder / PAGE).read_text(encoding="utf-8")
    page = page.replace(LINK % "socket", LINK % "worker")
    page = page.replace("<title>", POLICY + "\n    <title>", 1)
    (folder / PAGE).write_text(page, encoding="utf-8")
    kit = {"options": options, "files": dict(sorted(sources()))}
    (folder / KIT).write_text(json.dumps(kit), encoding="utf-8")
    (folder / MARK).touch()


def sources():
    """Each file that the panel needs: its path from the top, its text."""
    for place in SOURCES:
        path = TOP / place
        for file in sorted(path.rglob("*")) if path.is_dir() else [path]:
            if file.suffix in ENDINGS:
                yield file.relative_to(TOP).as_posix(), file.read_text(encoding="utf-8")
