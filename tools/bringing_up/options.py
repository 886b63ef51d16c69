# SPDX-License-Identifier: MIT
"""The command line of tools/bringup. As a program it only says what is wrong with one, or helps:
that needs nothing that has to be installed.
"""

import argparse
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path[0] = str(TOP)
sys.path.append(str(TOP / "firmware"))

from tools.bringing_up.checks import DISPLAY, DRIVE, TRANSCEIVER  # noqa: E402
from tools.command_line import Parser  # noqa: E402
from uss.timing import BAUD_RATES  # noqa: E402

REPORT = "bringup.txt"
DESCRIPTION = """\
Checks a Raspberry Pi Pico or Pico 2, with MicroPython on it, before and while it is wired.

First the board is bare: no transceiver, no display, no keys; one short wire joins GP4 to GP5
(pins 6 and 7), another one GP6 to GP3 (pins 9 and 5). Later, without these wires, --wired says
what is there. Each of sixteen checks is a line: PASS or FAIL with its figure, or NOT CHECKED and
why. What fails is explained. Nothing of it stays on the chip, but what ran there is ended. Please
send us the report, also if all is well: nobody has run the firmware on a real chip yet.
"""


def arguments(words):
    parser = Parser(
        prog="tools/bringup",
        description=DESCRIPTION,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add = parser.add_argument
    add("--port", metavar="PATH", help="serial port of the Pico; needed when there are several")
    add(
        "--wired",
        choices=(DISPLAY, TRANSCEIVER, DRIVE),
        action="append",
        help="this is there, and no jumper; may be given several times",
    )
    add("--address", type=int, default=1, choices=range(32), metavar="N",
        help="of the drive; it gets OFF1; 1")  # fmt: skip
    add("--baud", type=int, default=19_200, choices=BAUD_RATES, metavar="RATE",
        help="of the wired bus; 19200")  # fmt: skip
    add("--yes", action="store_true", help="it is as --wired says: do not ask")
    add("--report", metavar="FILE", default=REPORT, help=f"where the report goes; {REPORT}")
    return parser.parse_args(words)


if __name__ == "__main__":
    arguments(sys.argv[1:])
