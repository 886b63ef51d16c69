# SPDX-License-Identifier: MIT
"""Checks a bare Raspberry Pi Pico or Pico 2, with MicroPython on it, before it is wired.

The board is bare: no transceiver, no display, no keys; one short wire joins GP4 to GP5 (pins 6
and 7). Each check is a line, PASS or FAIL with its figure; what fails is explained. Nothing of it
stays on the chip, but what ran there is ended. Please send us the report, also if all is well:
nobody has run the firmware on a real chip yet.
"""

import argparse
import sys
from pathlib import Path

from serial.tools.list_ports import comports

TOP = Path(__file__).resolve().parents[2]
sys.path[0] = str(TOP)

from tools.bringing_up.checks import CHECKS, line_of  # noqa: E402
from tools.deploying.chip import Chip  # noqa: E402
from tools.deploying.errors import DeployError  # noqa: E402
from tools.deploying.ports import choose, waits_for_uf2  # noqa: E402

ON_CHIP = Path(__file__).with_name("on_chip.py")
PLACE = "bringup"  # a folder on the chip, for as long as this lasts
REPORT = "bringup.txt"
ASK = "The board is bare, and GP4 is joined to GP5? This sends on these pins. yes/no: "


def arguments(words):
    parser = argparse.ArgumentParser(
        prog="tools/bringup",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add = parser.add_argument
    add("--port", metavar="PATH", help="serial port of the Pico; needed when there are several")
    add("--yes", action="store_true", help="the board is bare: do not ask")
    add("--report", metavar="FILE", default=REPORT, help=f"where the report goes; {REPORT}")
    return parser.parse_args(words)


def files():
    """{path on the chip: bytes}: `chips/rp2.py` and `hal` of this tree, whatever is deployed."""
    found = {"chips/rp2.py": (TOP / "boards/chips/rp2.py").read_bytes()}
    for path in sorted((TOP / "firmware/hal").rglob("*.py")):
        found[path.relative_to(TOP / "firmware").as_posix()] = path.read_bytes()
    return {f"{PLACE}/{path}": data for path, data in found.items()}


def folders(paths):
    """Those that the files are in, the outermost first."""
    return sorted({"/".join(path.split("/")[:end]) for path in paths
                   for end in range(1, path.count("/") + 1)})  # fmt: skip


def remove(chip, paths):
    chip.load()
    for path in paths:
        if chip.call("look", [path]):
            chip.call("remove", path)
    chip.call("remove_empty", folders(paths)[::-1])


def run(chip, say):
    """Run all checks; how many failed."""
    wanted = files()
    chip.interrupt()
    chip.enter()
    chip.load()
    try:
        for folder in folders(wanted):
            chip.call("make_folder", folder)
        for path, data in wanted.items():
            chip.write(path, data)
        chip.execute(f"import sys\nsys.path.insert(0, '/{PLACE}')")
        chip.execute(ON_CHIP.read_text())
        return sum(not passes(chip, check, say) for check in CHECKS)
    finally:
        chip.interrupt()
        chip.enter()
        remove(chip, wanted)


def passes(chip, check, say):
    try:
        figure, right = check.judge(chip.call(check.function, *check.arguments))
    except DeployError as error:
        figure, right = str(error), False
    say(line_of(check, figure, right))
    if not right:
        say(f"      it should show that {check.proves}.")
        say(f"      What to do: {check.remedy}.")
    return right


def main():
    chosen = arguments(sys.argv[1:])
    lines = []

    def say(line):
        print(line, flush=True)
        lines.append(line)

    if not chosen.yes and input(ASK).strip() != "yes":
        return 1
    try:
        chip = Chip(chosen.port or choose(comports(), waits_for_uf2()))
        try:
            failed = run(chip, say)
        finally:
            chip.close()
    except DeployError as error:
        print(f"tools/bringup: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("tools/bringup: interrupted", file=sys.stderr)
        return 1
    say(f"{len(CHECKS) - failed} of {len(CHECKS)} checks passed.")
    Path(chosen.report).write_text("\n".join(lines) + "\n")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
