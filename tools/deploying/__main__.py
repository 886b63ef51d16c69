# SPDX-License-Identifier: MIT
"""Copies the firmware onto a chip with MicroPython, and restarts it: tools/deploy --help."""

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
from tools.deploying.kept import KEPT, compile_once  # noqa: E402
from tools.deploying.options import arguments  # noqa: E402
from tools.deploying.ports import choose, waits_for_uf2  # noqa: E402
from tools.deploying.targets import chip_of  # noqa: E402


def firmware_for(chosen):
    if chosen.remove:
        return Firmware({}, chip_of((TOP / "boards" / chosen.board / BOARD).read_bytes()))
    firmware = Firmware.read(TOP, chosen.board, chosen.board_file)
    compiler = mpy_cross(firmware.chip)
    if compiler:
        compile_once(firmware, compiler, TOP / KEPT)
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
