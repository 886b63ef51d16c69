# SPDX-License-Identifier: MIT
"""The library as a package for mip: firmware/package.json, and the same with whole addresses.

    python3 tools/releasing/mip.py                  # writes firmware/package.json anew

mpremote takes a package.json from a folder of the forge, or from a file, and looks for its files
beside it. So does a recent mip of MicroPython; mip 0.3.0, Debian's, wants whole addresses: `base`.
"""

import json
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
if __name__ == "__main__":
    sys.path[0] = str(TOP)

from tools.releasing.version import version  # noqa: E402

FOLDERS = ("uss", "hal")
FILE = "package.json"


def paths(top=TOP):
    """The files of the library, from firmware/ on."""
    firmware = Path(top) / "firmware"
    found = [path for folder in FOLDERS for path in (firmware / folder).rglob("*.py")]
    return sorted(path.relative_to(firmware).as_posix() for path in found)


def package(top=TOP, base=""):
    """The text of package.json. base: what stands before each path: https://host/folder/"""
    urls = ",\n".join(f"    {json.dumps([path, base + path])}" for path in paths(top))
    head = f'"version": {json.dumps(version(top))},\n  "deps": [],'
    return f'{{\n  {head}\n  "urls": [\n{urls}\n  ]\n}}\n'


def main():
    (TOP / "firmware" / FILE).write_text(package())


if __name__ == "__main__":
    main()
