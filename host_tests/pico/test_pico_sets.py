# SPDX-License-Identifier: MIT
"""A parameter set on the chip: from a drive into the flash, and back into it from there.

And ten of the largest.
"""

from boards.sim.drives.families import g110, mm3
from panel_bench import row_2
from pico_bench import panel, press
from sets_bench import (
    catalogued,
    complete_mm440,
    has,
    made,
    make_each_value_another,
    rows_of,
)  # fmt: skip

INTERPRETERS = "pico"

SET_MS = 180_000
LOOK_MS = 100
CUTS = 3  # instants at which power goes, spread over the flash operations of one saving
ROOM_BYTES = 900 * 1024  # that is left beside ten sets


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
    for _ in range(SET_MS // LOOK_MS):
        if any([row_2(world).startswith(entry) for entry in entries]):
            break
        world.run(LOOK_MS)
    else:
        raise AssertionError(world.lcd())
    world.run(300)
    return row_2(world)


def panel_of_a_g110(**options):
    return panel(
        baud=57600,
        kinds={1: {"family": g110, "parameters": {2014: 2_000}}},
        settings={"kinds": {"1": "g110"}},
        **options,
    )


def test_a_set_is_saved_and_lies_in_the_flash():
    world = panel_of_a_g110()
    open_sets(world)
    walk_to(world, "SAVE A1")
    press(world, "SET", "SET")
    wait(world, "SAVED")
    saved = rows_of(world.read_file("1.set"))
    assert all([has(world.drives[1], row, saved[row]) for row in saved]) and len(saved) > 80
    world.cut_power(world.clock.now_us + 1_000)
    assert world.run_until(lambda: bool(world.restarts), 3_000)
    assert world.run_until(lambda: row_2(world).startswith("READY"), 5_000), world.lcd()
    open_sets(world)
    walk_to(world, "A1 SET 1")
    assert rows_of(world.read_file("1.set")) == saved
    world.check()


def test_a_set_is_written_into_the_drive():
    rows = [(1080, 0, b"Float", b"40A00000"), (1120, 0, b"Float", b"40200000")]
    world = panel_of_a_g110(files={"1.set": made(rows, family=b"g110")})
    drive = world.drives[1]
    open_sets(world)
    walk_to(world, "A1 MADE")
    press(world, "SET")
    walk_to(world, "INTO A1 RAM")
    press(world, "SET")
    wait(world, "SET=WRITE A1", "P0003=3 FOR IT")
    press(world, "SET")
    assert wait(world, "WRITTEN", "HALF", "DIFFER", "NO") == ">WRITTEN, EQUAL", world.lcd()
    assert (drive.read(1080), drive.read(1120)) == (5.0, 2.5)
    assert "half_written" in world.settings() and not world.settings()["half_written"]
    world.check()


def test_ten_sets_of_an_mm440_with_all_that_it_has_are_on_the_flash():
    """Nine were copied there; the panel saves the tenth, of a drive that has all parameters and
    all indices of the catalogue.
    """
    wanted = catalogued()
    rows = []
    for number, index in sorted(wanted):
        is_word = wanted[number, index] in ("U16", "I16")
        kind, value = (b"U16", b"1A2B") if is_word else (b"U32", b"1A2B3C4D")
        rows.append((number, index, kind, value))
    nine = {"%d.set" % number: made(rows, name=b"0123456789") for number in range(1, 10)}
    world = panel(
        baud=115200,
        kinds={1: {"family": complete_mm440(), "parameters": {2014: 2_000}}},
        settings={"kinds": {"1": "mm440"}},
        files=nine,
    )
    drive = world.drives[1]
    make_each_value_another(drive)
    open_sets(world)
    assert world.lcd()[0].endswith("1/10"), world.lcd()
    press(world, "SET", "SET")
    assert wait(world, "SAVED", "FLASH", "NO") == ">SAVED: 1100", world.lcd()
    press(world, "PARAM")
    assert world.lcd()[0].endswith("1/11"), world.lcd()
    saved = rows_of(world.read_file("10.set"))
    assert sorted(saved) == sorted(wanted) and len(saved) == 1100
    assert all([has(drive, row, saved[row]) for row in saved])
    for name in nine:
        assert world.read_file(name) == nine[name], name
    world.check()
    world.repl.open(ms=10_000)
    printed, _ = world.repl.execute("import os\ns = os.statvfs('/')\nprint(s[0] * s[3])")
    print("left: %d KiB" % (int(printed) // 1024))
    assert int(printed) > ROOM_BYTES, printed


def saving_mm3():
    """A panel that has just been told to save the set of a MICROMASTER 3."""
    world = panel(kinds={1: {"family": mm3}}, settings={"kinds": {"1": "mm3"}}, parameters={})
    open_sets(world)
    walk_to(world, "SAVE A1")
    press(world, "SET")
    before = len(world.flash_log)
    world.press("SET")
    return world, before


def test_power_that_goes_while_a_set_is_saved_leaves_none_or_a_whole_one():
    world, before = saving_mm3()
    wait(world, "SAVED")
    whole = world.read_file("1.set")
    assert whole.split(b"\n")[-2].startswith(b"end 26 "), whole[-80:]
    operations = world.flash_log[before:]
    assert len(operations) >= CUTS
    kept = []
    for cut in range(CUTS):
        at_us, _, lasts_us = operations[cut * (len(operations) - 1) // (CUTS - 1)]
        world, _ = saving_mm3()
        world.cut_power(at_us + lasts_us * (1 + cut % 3) // 4)
        assert world.run_until(lambda: bool(world.restarts), 60_000)
        assert world.run_until(lambda: row_2(world).startswith("READY"), 5_000), world.lcd()
        kept.append(world.read_file("1.set"))
        assert kept[-1] in (None, whole), cut
        world.check()
    assert kept[0] is None, kept
