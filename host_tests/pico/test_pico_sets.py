# SPDX-License-Identifier: MIT
"""A parameter set on the chip: from a drive into the flash, and back into it from there."""

from boards.sim.drives.families import g110
from panel_bench import row_2
from pico_bench import panel

INTERPRETERS = "pico"

SET_MS = 180_000


def press(world, *keys):
    for key in keys:
        world.press(key)
        world.run(300)


def walk_to(world, entry):
    for _ in range(20):
        if row_2(world).startswith(">" + entry):
            return
        press(world, "DOWN")
    raise AssertionError("no %s: %r" % (entry, world.lcd()))


def open_sets(world):
    world.press("PARAM", 1500)
    world.run(500)
    walk_to(world, "SETS")
    press(world, "SET")
    world.run(500)


def wait(world, *texts):
    """Let time pass until the entry begins with one of these."""
    entries = [">" + text for text in texts]
    began = world.run_until(
        lambda: any([row_2(world).startswith(entry) for entry in entries]), SET_MS
    )
    assert began, world.lcd()
    world.run(300)
    return row_2(world)


def test_a_set_is_saved_and_written_back():
    world = panel(
        baud=57600,
        kinds={1: {"family": g110, "parameters": {2014: 2_000}}},
        settings={"kinds": {"1": "g110"}},
    )
    drive = world.drives[1]
    open_sets(world)
    walk_to(world, "SAVE A1")
    press(world, "SET", "SET")
    wait(world, "SAVED")
    press(world, "SET", "PARAM", "PARAM")
    ramp_s = drive.read(1120)
    drive.write(1120, 0, ramp_s + 7)
    world.cut_power(world.clock.now_us + 1_000)  # it lies in the flash
    assert world.run_until(lambda: bool(world.restarts), 3_000)
    assert world.run_until(lambda: row_2(world).startswith("READY"), 5_000), world.lcd()
    open_sets(world)
    walk_to(world, "A1 SET 1")
    press(world, "SET")
    walk_to(world, "INTO A1 RAM")
    press(world, "SET")
    wait(world, "SET=WRITE A1", "P0003=3 FOR IT")
    press(world, "SET")
    assert wait(world, "WRITTEN", "HALF", "DIFFER", "NO") == ">WRITTEN, EQUAL", world.lcd()
    assert drive.read(1120) == ramp_s
    assert "half_written" in world.settings() and not world.settings()["half_written"]
    world.check()
