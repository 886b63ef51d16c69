# SPDX-License-Identifier: MIT
"""Examples of tools/examples on the chip: a program of one's own, on the firmware people flash."""

import os

from pico_bench import QUICK, stands
from tools.emulator.world import PicoWorld

INTERPRETERS = "pico"

# As `mpremote run` does it, but without a host: after power-on alone.
BOOT = b"""
import board
if not board.reset_cause:
    exec(open("example.py").read(), {"__name__": "__main__"})
"""


# The ten seconds for which the examples run: fewer, for the emulated chip takes longer for them.
ONE_DRIVE = (b"range(10)", b"range(3)")
THREE_DRIVES = (b"range(100)", b"range(40)")


def read(path, shorter=None):
    with open(path, "rb") as file:
        program = file.read()
    if shorter is not None:
        assert program.count(shorter[0]) == 1, path
        program = program.replace(*shorter)
    return program


def on_chip(name, shorter=None, **options):
    """A chip that runs an example instead of the panel."""
    example = read("tools/examples/%s.py" % name, shorter)
    files = {"boot.py": BOOT, "example.py": example}
    return PicoWorld("panel", files=files, parameters=QUICK, **options)


def turns(world, hertz, ms, address=1):
    return world.run_until(lambda: abs(world.drives[address].hz() - hertz) < 0.1, ms)


def test_one_drive_runs_and_stops():
    world = on_chip("one_drive", ONE_DRIVE)
    assert turns(world, 25.0, 10_000), world.drives[1].report()
    assert stands(world, ms=20_000)
    world.check()


def test_three_drives_follow_each_other():
    world = on_chip("three_drives", THREE_DRIVES, addresses=(1, 2, 3))
    assert turns(world, 30.0, 10_000) and turns(world, 15.0, 3_000, 2), world.drives[2].report()
    assert stands(world, ms=20_000) and stands(world, 2) and stands(world, 3)
    world.check()


def test_own_program_works_by_interrupts_and_obeys_its_keys():
    world = on_chip("own_program")
    world.run(3_000)
    world.press("START")
    assert turns(world, 40.0, 10_000), world.drives[1].report()
    world.press("STOP")
    assert stands(world)
    world.press("START")
    assert turns(world, 40.0, 10_000) and not world.resets
    world.check()


def test_plain_micropython_starts_with_a_program_of_ones_own():
    """What firmware/uss/README.md has copied to it, as sources."""
    files = {"board.py": "boards/pico/board.py", "chips/rp2.py": "boards/chips/rp2.py"}
    for folder in (
        "uss",
        "uss/bus",
        "uss/families",
        "uss/fast",
        "uss/finding",
        "uss/going_on",
        "hal",
        "hal/display",
        "hal/link",
    ):
        for name in os.listdir("firmware/" + folder):
            if name.endswith(".py"):
                files[folder + "/" + name] = "firmware/%s/%s" % (folder, name)
    files = {path: read(files[path]) for path in files}
    files["one_drive.py"] = read("tools/examples/one_drive.py", ONE_DRIVE)
    files["main.py"] = (
        b"import gc, board\ngc.collect()\nimport uss.bus\ngc.collect()\n"
        b"import one_drive\none_drive.main(board)\n"
    )
    world = PicoWorld("stock", files=files, parameters=QUICK)
    assert turns(world, 25.0, 15_000), world.drives[1].report()
    assert stands(world, ms=20_000)
    world.check()
