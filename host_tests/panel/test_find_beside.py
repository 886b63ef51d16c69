# SPDX-License-Identifier: MIT
"""The operator's manual: further drives are found at the rate of the panel, beside its own."""

import json

import main
from boards.sim.drives.kinds import listed_drives, simulated
from boards.sim.world import World
from panel_bench import (
    comes_to,
    row_1,
    row_2,
    settled,
    starts,
    telegrams,
    wait_until_known,
)

OFF1 = 0x047E


def line_of(text, drives, **more):
    """A panel with these drives, on a line with more."""
    listed = listed_drives(text)
    addresses = [one.address for one in listed]
    world = World(
        main.start, addresses, settings={"drives": list(drives)}, kinds=simulated(listed), **more
    )
    world.run(3000)
    return world


def press(world, *keys):
    for key in keys:
        world.press(key)
        world.run(300)


def title(world):
    """Row 1, which has to say now and then that a motor runs."""
    while "HOLD" in settled(world)[0]:
        pass
    return row_1(world)


def opened(world):
    """PARAM held, FIND DRIVES, AT THIS RATE."""
    world.down("PARAM")
    world.run(1500)
    world.up("PARAM")
    world.run(300)
    for wanted in (">FIND DRIVES", ">AT THIS RATE"):
        while row_2(world) != wanted:
            press(world, "DOWN")
        press(world, "SET")
    assert (title(world), row_2(world)) == ("STOPS FOUND     ", ">SET=BEGIN"), world.lcd()


def searched(world):
    """Begin, and wait for the end. How long that takes, in ms."""
    began_us = world.clock.now_us
    press(world, "SET")
    percents = []
    while title(world).startswith("SEARCH "):
        percents.append(int(row_1(world)[7:].split("%")[0]))
        world.run(100)
    assert percents == sorted(percents), percents
    assert percents[0] < 10 and 90 < percents[-1] <= 100, percents
    return (world.clock.now_us - began_us) // 1000


def entries(world):
    """What was found: (row 1 without the place, row 2)."""
    found = []
    while True:
        press(world, "DOWN")
        if title(world).startswith("FOUND"):
            return found
        found.append((title(world)[:11].strip(), row_2(world)[1:]))


def stored(world):
    return json.loads(world.flash.files["settings.json"].decode())


def test_drives_are_found_beside_a_motor_that_runs_and_taken_one_by_one_or_all():
    world = line_of("1,3=g110,7=v20/4,9=mm440,12=mm3", (1,))
    wait_until_known(world)
    press(world, "START")
    world.run(4000)
    opened(world)
    assert searched(world) < 60_000
    found = [
        ("A3 READY", "G110 127+2"),
        ("A7 READY", "V20 4+2"),
        ("A9 READY", "MM420 4+2"),
        ("A12 READY", "MM3 3+2"),
    ]
    assert entries(world) == found
    press(world, "DOWN", "DOWN", "SET")  # the second one
    assert row_2(world) == "A7 ADDED", world.lcd()  # row 1 has the next one by now
    world.run(3000)
    del found[1]
    assert title(world).startswith("A9 READY"), world.lcd()
    while not title(world).startswith("FOUND"):
        press(world, "DOWN")
    assert row_2(world) == ">TAKE ALL 3", world.lcd()
    assert entries(world) == found
    press(world, "SET")
    assert "3 ADDED" in world.lcd()[1], world.lcd()
    world.run(4000)
    assert row_2(world) == "RUNNING      A1" and world.drives[1].state == "running", world.lcd()
    assert [drive.state for drive in world.drives.values()].count("ready") == 4
    for address in (7, 3, 9, 12):
        press(world, "ADDRESS_UP")
        world.run(3000)
        assert world.app.panel.selected.drive.address == address
        press(world, "START")
        world.run(4000)
        assert world.drives[address].state == "running", world.lcd()
    press(world, "ADDRESS_UP")
    assert starts(world) == 1
    world.down("STOP")
    world.run(4500)
    world.up("STOP")
    world.run(8000)
    assert stored(world)["drives"] == [1, 7, 3, 9, 12]
    assert stored(world)["kinds"] == {"3": "g110", "7": "v20/4", "12": "mm3"}
    world.check()


def test_stop_is_stop_and_ends_the_search():
    world = line_of("1,3=g110,20", (1,))
    wait_until_known(world)
    press(world, "START")
    world.run(4000)
    for wait_ms in (400, 2500, 7000):
        opened(world)
        press(world, "SET")
        world.run(wait_ms)
        pressed_us = world.clock.now_us
        press(world, "STOP")
        offs = [at_us for at_us, stw in telegrams(world, pressed_us, 1) if stw == OFF1]
        assert offs and offs[0] - pressed_us < 100_000, wait_ms
        world.run(6000)
        assert world.drives[1].hz() == 0 and not title(world).startswith("SEARCH"), world.lcd()
        press(world, "PARAM", "PARAM", "PARAM")
        wait_until_known(world)
        press(world, "START")
        world.run(4000)
        assert world.drives[1].state == "running"
    world.check()


def test_it_asks_nobody_before_set_and_stops_whom_it_finds():
    world = line_of("1,3=g110", (1,))
    other = world.drives[3]
    other.write(2014, 0, 0)
    for stw in (0x047E, 0x047F):
        other.process.accept((stw, 0x1000))
    opened(world)
    world.run(5000)
    assert other.state == "running"
    searched(world)
    world.run(4000)
    assert other.hz() == 0 and entries(world) == [("A3 RUNS", "G110 127+2")]
    world.check()


def test_what_is_not_taken_does_not_trip_while_the_list_is_shown():
    world = line_of("1,3=v20,5", (1,))
    opened(world)
    searched(world)
    world.run(20_000)
    states = [world.drives[address].state for address in (3, 5)]
    assert states == ["ready", "ready"], states
    press(world, "SET")
    world.run(4000)
    press(world, "ADDRESS_UP")
    wait_until_known(world)
    world.check()


def test_set_on_the_first_entry_takes_nobody_before_the_search_is_over():
    """Neither before one is found nor after that."""
    world = line_of("1,3=g110", (1,))
    opened(world)
    press(world, "SET", "SET")
    assert row_2(world) == ">0 FOUND", world.lcd()
    assert comes_to(world, ">1 FOUND"), world.lcd()
    press(world, "SET")
    assert title(world).startswith("SEARCH ") and row_2(world) == ">1 FOUND", world.lcd()
    assert [drive.address for drive in world.app.bus.turns.drives] == [1]
    world.check()


def test_a_search_that_takes_longer_than_a_minute_goes_on_without_a_key():
    world = line_of("1", (1,), baud=2400)
    opened(world)
    press(world, "SET")
    world.run(65_000)
    assert title(world).startswith("SEARCH ") and row_2(world) == ">0 FOUND", world.lcd()
    world.check()


def test_the_last_of_three_that_were_found_is_taken_alone():
    world = line_of("1,3=g110,5,6=mm3", (1,))
    opened(world)
    searched(world)
    press(world, "UP")
    assert title(world).startswith("A6 READY"), world.lcd()
    press(world, "SET")
    assert row_2(world) == "A6 ADDED", world.lcd()
    assert [drive.address for drive in world.app.bus.turns.drives] == [1, 6]
    world.check()


def test_the_first_one_for_which_there_is_no_room_is_named():
    """A panel has 31 drives at the most; while the others were looked for, 28 have come."""
    world = line_of("1,3=g110,5", (1,))
    opened(world)
    searched(world)
    for address in range(32):
        if address not in (1, 3, 5, 31):
            world.app.settings.add(address, "mm420")
    assert row_2(world) == ">TAKE ALL 2", world.lcd()
    world.app.settings.add(31, "mm420")
    press(world, "SET")
    assert row_2(world) == "A5 NOT ADDED", world.lcd()
    drives = [drive.address for drive in world.app.bus.turns.drives]
    assert drives == [1, 3] and world.app.settings.drives[-1] == 3, drives
    world.run(4000)
    assert row_2(world) == "READY        A1", world.lcd()
    world.check()


def test_where_nobody_else_is_it_says_so_and_a_minute_without_a_key_closes_it():
    world = line_of("1,2", (1, 2), baud=9600)
    opened(world)
    assert 20_000 < searched(world) < 60_000
    assert row_2(world) == ">NOBODY", world.lcd()
    press(world, "SET")
    assert row_2(world) == ">NOBODY", world.lcd()
    world.run(62_000)
    assert row_2(world) == "READY        A1", world.lcd()
    world.check()
