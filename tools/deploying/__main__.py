# SPDX-License-Identifier: MIT
"""Copies the firmware onto a Raspberry Pi Pico or an ESP32 with MicroPython, and restarts it.

Ctrl-C ends what runs on the chip: a panel stops all its drives first. Only files that differ are
copied; settings.json and the files of others stay. Exit status: 0 the panel runs with this
firmware, or the dry run came to its end; 1 it failed; 2 wrong usage.
"""

import argparse
import sys
from pathlib import Path

from serial.tools.list_ports import comports

TOP = Path(__file__).resolve().parents[2]
sys.path[0] = str(TOP)

from tools.deploying.arrival import wait_for_panel  # noqa: E402
from tools.deploying.chip import Chip  # noqa: E402
from tools.deploying.deployment import Deployment, Options  # noqa: E402
from tools.deploying.errors import DeployError  # noqa: E402
from tools.deploying.image import BOARD, Firmware, module_of, mpy_cross  # noqa: E402
from tools.deploying.ports import choose, waits_for_uf2  # noqa: E402
from tools.deploying.targets import chip_of  # noqa: E402

VIRTUAL = "sim"


def arguments(words):
    boards = sorted(path.parent.name for path in TOP.glob(f"boards/*/{BOARD}"))
    parser = argparse.ArgumentParser(
        prog="tools/deploy",
        description=__doc__,
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


def firmware_for(chosen):
    if chosen.remove:
        return Firmware({}, chip_of((TOP / "boards" / chosen.board / BOARD).read_bytes()))
    firmware = Firmware.read(TOP, chosen.board, chosen.board_file)
    compiler = mpy_cross(firmware.chip)
    if compiler:
        firmware.compile(compiler)
    return firmware


def deploy(chosen, say):
    firmware = firmware_for(chosen)  # a mistake in it is told before any drive is stopped
    port = chosen.port or choose(comports(), waits_for_uf2(), firmware.chip)
    options = Options(chosen.dry_run, chosen.replace, bool(chosen.board_file))
    chip = Chip(port)
    try:
        Deployment(chip, firmware, options, say).run()
    finally:
        chip.close()
    if not (chosen.dry_run or chosen.remove):
        say("Waiting for the panel.")
        wait_for_panel(lambda: Chip(port))
        say("The panel runs.")


def tell_names(chosen):
    """The compiled files have short names for what is private to a file (`names`)."""
    firmware = Firmware.read(TOP, chosen.board, chosen.board_file)
    for path, short in firmware.short_names().items():
        for name in short:
            print(f"{module_of(path)}  {short[name]}  {name}")


def main():
    chosen = arguments(sys.argv[1:])
    try:
        if chosen.names:
            tell_names(chosen)
        else:
            deploy(chosen, lambda line: print(line, flush=True))
    except DeployError as error:
        print(f"tools/deploy: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("tools/deploy: interrupted", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
