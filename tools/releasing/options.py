# SPDX-License-Identifier: MIT
"""The command line of tools/release. As a program it only says what is wrong with one, or helps:
that needs nothing that has to be installed.
"""

import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path[0] = str(TOP)

from tools.command_line import Parser  # noqa: E402

NAMES = ("pico", "pico2", "pip", "mip", "settings", "page")


def arguments(words):
    parser = Parser(
        prog="tools/release",
        description="Makes the files of a release, with their checksums: firmware, page, and the "
        "packages of the library.",
        epilog="Exit status: 0 all is there, 1 a part could not be made, 2 wrong arguments.",
    )
    add = parser.add_argument
    add("--output", metavar="FOLDER", default=str(TOP / "build/release"), help="(build/release)")
    add("--only", action="append", choices=NAMES, metavar="PART", help=" ".join(NAMES))
    add("--tag", metavar="vN", help="fail unless this is the tag of the version")
    return parser.parse_args(words)


if __name__ == "__main__":
    arguments(sys.argv[1:])
