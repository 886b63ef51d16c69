# SPDX-License-Identifier: MIT
"""The command line of tools/deploy. As a program it only says what is wrong with one, or helps:
that needs nothing that has to be installed.
"""

import argparse
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path[0] = str(TOP)

from tools.command_line import Parser  # noqa: E402
from tools.deploying.image import BOARD  # noqa: E402

VIRTUAL = "sim"
DESCRIPTION = """\
Copies the firmware onto a Raspberry Pi Pico or an ESP32 with MicroPython, and restarts it.

Ctrl-C ends what runs on the chip: a panel stops all its drives first. Only files that differ are
copied; settings.json and the files of others stay. Exit status: 0 the panel runs with this
firmware, or the dry run came to its end; 1 it failed; 2 wrong usage.
"""


def arguments(words):
    boards = sorted(path.parent.name for path in TOP.glob(f"boards/*/{BOARD}"))
    parser = Parser(
        prog="tools/deploy",
        description=DESCRIPTION,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add = parser.add_argument
    add(
        "--port",
        metavar="PATH",
        help="serial port of the chip; for one of several, or behind a USB adapter",
    )
    real = [name for name in boards if name != VIRTUAL]
    add("--board", default="pico", choices=real, help="a folder of boards/; pico unless named")
    add("--board-file", metavar="FILE", help=f"a {BOARD} of your own, over any that is there")
    add("--replace", action="store_true", help="also files of others that are in the way")
    add("--remove", action="store_true", help="take away what tools/deploy has copied")
    add("--dry-run", action="store_true", help="only say what would be done; stops the drives too")
    add("--names", action="store_true", help="say what the short names in a traceback stand for")
    chosen = parser.parse_args(words)
    if chosen.board_file and not Path(chosen.board_file).is_file():
        parser.error(f"--board-file: there is no file {chosen.board_file}")
    if chosen.remove and (chosen.board_file or chosen.replace):
        parser.error("--remove goes with none of --board-file, --replace")
    return chosen


if __name__ == "__main__":
    arguments(sys.argv[1:])
