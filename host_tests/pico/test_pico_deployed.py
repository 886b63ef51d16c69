# SPDX-License-Identifier: MIT
"""The panel as files on plain MicroPython, as tools/deploy leaves it: it lies in the chip's file
system and runs from its memory. How it gets there: test_pico_deploy.py."""

import os

from pico_bench import QUICK, says, stands, start, starts
from tools.emulator.flash_image import files_in
from tools.emulator.world import PicoWorld, temporary

INTERPRETERS = "pico pico_hard"

BOOT_MS = 15_000


def deployed():
    folder = temporary()
    write = "build/mpremote/bin/python -B tools/benching/deployed.py %s" % folder
    assert os.system(write) == 0
    try:
        return PicoWorld("stock", files=files_in(folder), parameters=QUICK)
    finally:
        os.system("rm -r %s" % folder)


def test_a_panel_that_was_deployed_runs_its_drive_and_stops_it():
    world = deployed()
    assert says(world, "READY", BOOT_MS)
    start(world)
    assert says(world, "F: 10.00")
    world.press("STOP")
    assert stands(world) and says(world, "READY") and starts(world) == 1
    assert not world.restarts
    world.check()
