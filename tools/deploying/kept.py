# SPDX-License-Identifier: MIT
"""Keeps what was compiled, so that the same image is made once. To find its short names and to
compile its 190 files takes two seconds.

    compile_once(firmware, mpy_cross(firmware.chip), TOP / KEPT)

An image is known by all that it is made of: sources, options, the compiler, and the code here that
tells these what to do. It is a file, whole or not there: its first line is the digest of the rest.
"""

import hashlib
import json
import os
import sys
import tempfile
from base64 import b64decode, b64encode
from contextlib import suppress
from pathlib import Path

KEPT = "build/deploying"  # a folder, from the top of the tree
IMAGES = 6  # the last ones used, of 0.4 MB each: there are four boards
MADE_BY = ("image.py", "kept.py", "names.py", "targets.py")  # in this folder


def compile_once(firmware, compiler, folder):
    """`firmware.compile(compiler)`, or what that has made before. Where nobody may write, nothing
    is kept.
    """
    image = folder / key(firmware, compiler)
    made = _read(image)
    if made is None:
        firmware.compile(compiler)
        with suppress(OSError):
            folder.mkdir(parents=True, exist_ok=True)
            _write(image, firmware.compiled)
            _forget_old(folder)
    else:
        firmware.compiled = made
        with suppress(OSError):
            os.utime(image)  # it is the last one used


def key(firmware, compiler):
    """The name of the file for this image."""
    here = Path(__file__).parent
    parts = {path: _digest(source) for path, source in firmware.programs().items()}
    code = [_digest((here / name).read_bytes()) for name in MADE_BY]
    program = _digest(compiler.program.read_bytes())
    return _digest(json.dumps([parts, code, program, compiler.options, sys.version]).encode())


def _digest(content):
    return hashlib.sha256(content).hexdigest()


def _read(image):
    """{path: bytes}, None where there is no whole file."""
    try:
        digest, _, content = image.read_bytes().partition(b"\n")
    except OSError:
        return None
    if _digest(content).encode() != digest:
        return None
    return {path: b64decode(data) for path, data in json.loads(content).items()}


def _write(image, compiled):
    """Two who do that at once each put a whole file there."""
    texts = {path: b64encode(data).decode() for path, data in compiled.items()}
    content = json.dumps(texts).encode()
    handle, unfinished = tempfile.mkstemp(dir=image.parent)
    with open(handle, "wb") as file:
        file.write(_digest(content).encode() + b"\n" + content)
    os.replace(unfinished, image)


def _forget_old(folder):
    """All but the last images, and what others have left unfinished."""
    used = sorted(folder.iterdir(), key=lambda path: path.stat().st_mtime_ns)
    for path in used[:-IMAGES]:
        path.unlink(missing_ok=True)
