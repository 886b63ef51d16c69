# SPDX-License-Identifier: MIT
"""The operator's manual on the chip: from the first power-on, drives that nobody has told the
panel of, at rates that nobody knows, are found and run by keys alone."""

from boards.sim.drives.kinds import listed_drives, simulated
from pico_bench import row_2, says
from tools.emulator.world import PicoWorld

INTERPRETERS = "pico_again"

HUNT_MS = 30_000  # three rates


def found(text):
    """A panel without settings on a line with these drives; what it has found at three rates."""
    listed = listed_drives(text)
    addresses = [one.address for one in listed]
    world = PicoWorld("panel", addresses, kinds=simulated(listed), new=True)
    assert says(world, "FIND DRIVES?", 6_000), world.lcd()
    assert world.read_file("settings.json") is None
    world.press("SET")
    assert says(world, "3 RATES SET=GO")
    world.press("SET")
    assert says(world, "FOUND STOP=NO")
    assert world.run_until(lambda: row_2(world).endswith("[X]"), HUNT_MS), world.lcd()
    world.run(200)  # for the display
    rows = []
    while world.lcd() not in rows:
        rows.append(world.lcd())
        pressed(world, "DOWN", 200)
    return world, [tuple(row.strip() for row in two) for two in rows]


def pressed(world, key, ms):
    """A person presses a key, and reads what it has done."""
    world.press(key)
    world.run(ms)


def taken(world):
    pressed(world, "PARAM", 300)
    assert row_2(world) == "SET=YES PARAM=NO", world.lcd()
    pressed(world, "SET", 3_000)


def runs_and_stops(world, address):
    """START, the setpoint, STOP: whether the motor stands again."""
    drive = world.drives[address]
    world.press("START")
    world.run_until(lambda: drive.hz() or world.reads("START=GO"), 5_000)
    if not drive.hz():  # a risk: the person reads it, and START again accepts it
        world.run(1_000)
        world.press("START")
    assert world.run_until(lambda: drive.hz() >= 9.9, 12_000), (world.lcd(), drive.report())
    world.press("STOP")
    return world.run_until(lambda: drive.hz() == 0, 12_000)


def test_drives_at_two_rates_are_found_and_those_of_the_first_one_run():
    world, choices = found("1,3=g110,8=mm420/factory")
    assert choices == [
        ("A1 19200 MM420", "4+2    READY [X]"),
        ("A3 19200 G110", "127+2  READY [X]"),
        ("A0 9600 MM420", "127+2  READY [ ]"),
    ]
    taken(world)
    settings = world.settings()
    assert (settings["baud"], settings["drives"]) == (19200, [1, 3])
    assert settings["kinds"] == {"3": "g110"}
    for address in (1, 3):
        world.run(2_000)
        if "F0072" in row_2(world) or "F0070" in row_2(world):  # it heard nothing meanwhile
            pressed(world, "STOP", 2_000)
        assert says(world, "A%d" % address, 500) and runs_and_stops(world, address), world.lcd()
        pressed(world, "ADDRESS_UP", 500)
    assert not world.resets
    world.check()


def test_a_drive_as_delivered_is_taken_set_up_and_run_at_its_own_rate():
    world, choices = found("8=mm420/factory")
    assert choices == [("A0 9600 MM420", "127+2  READY [X]")]
    taken(world)
    settings = world.settings()
    assert (settings["baud"], settings["drives"]) == (9600, [0])
    assert says(world, "LOCAL        A0", 5_000), world.lcd()
    for number in ("P0700", "P1000"):  # commands and setpoint from this link
        pressed(world, "PARAM", 1_500)
        while not row_2(world).startswith(number):
            pressed(world, "NEXT", 1_000)
        pressed(world, "EDIT", 300)
        while row_2(world)[6:12].strip() != "5":
            pressed(world, "UP", 200)
        pressed(world, "SET", 500)
        pressed(world, "SET", 3_500)
        pressed(world, "PARAM", 1_000)
    assert says(world, "READY        A0", 3_000), world.lcd()
    assert runs_and_stops(world, 8), world.lcd()
    assert world.wire.baud == 19200 and world.station.baud == 9600 and not world.resets
    world.check()
