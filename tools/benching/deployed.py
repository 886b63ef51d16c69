# SPDX-License-Identifier: MIT
"""Writes the firmware for a Pico into a folder, as tools/deploy copies it onto the chip.

In use:

    build/mpremote/bin/python -B tools/benching/deployed.py FOLDER
"""

import shutil
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path[0] = str(TOP)

from tools.deploying.image import Firmware, mpy_cross  # noqa: E402
from tools.deploying.kept import KEPT, compile_once  # noqa: E402


def write(folder):
    firmware = Firmware.read(TOP, "pico")
    compiler = mpy_cross()
    if compiler is None:
        sys.exit("there is no mpy-cross for this machine: what lies as files is not measured")
    compile_once(firmware, compiler, TOP / KEPT)
    shutil.rmtree(folder, ignore_errors=True)
    for path, content in firmware.compiled_files().items():
        target = folder / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(content)


if __name__ == "__main__":
    write(Path(sys.argv[1]))
