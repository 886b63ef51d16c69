# SPDX-License-Identifier: MIT
"""A world with drives of several kinds: what they are, and what the panel's settings say."""

import json

import main
from boards.sim.drives.families import NAMES, named
from boards.sim.drives.kinds import expected, listed_drives, simulated
from boards.sim.world import SETTINGS_FILE, World

SUPERVISED_MS = 2_000  # at the least


def world_of(text, **more):
    """A world as ./tools/panel --drives makes it."""
    listed = listed_drives(text)
    addresses = [one.address for one in listed]
    settings = {"kinds": expected(listed)}
    return World(main.start, addresses, settings=settings, kinds=simulated(listed), **more)


def test_the_settings_name_the_drives_and_their_kinds():
    world = world_of("1,2=g110,3=v20/4,8=mm420/factory")
    stored = json.loads(world.flash.files[SETTINGS_FILE].decode())
    assert stored["drives"] == [1, 2, 3]
    assert stored["kinds"] == {"2": "g110", "3": "v20/4"}
    assert [world.drives[address].address for address in (1, 2, 3, 8)] == [1, 2, 3, 0]


def test_where_every_drive_is_as_delivered_the_settings_name_none():
    assert "drives" not in world_of("8=mm420/factory").stored


def test_every_family_supervises_its_line():
    for name in NAMES:
        for layout in ("",) if name == "mm3" else ("", "/0", "/3"):
            drive = world_of("1=%s%s" % (name, layout)).drives[1]
            link = named(name).LINK
            ms = drive.read(link["off time"]) * link["unit us"] // 1000
            assert ms >= SUPERVISED_MS, (name, layout)


def test_a_drive_as_delivered_supervises_what_its_factory_has_set():
    for name, value in (("mm420", 0), ("mm440", 0), ("g110", 0), ("mm3", 0), ("v20", 2000)):
        drive = world_of("1,8=%s/factory" % name).drives[8]
        assert drive.read(named(name).LINK["off time"]) == value, name


def test_a_drive_at_another_rate_does_not_disturb_the_others():
    for seed in (0, 1):
        world = world_of("1,2,8=mm420/factory,9=v20/factory", seed=seed)
        world.run(3_000)
        assert world.lcd()[1].startswith("READY"), world.lcd()
        for address in (8, 9):
            counters = world.drives[address].slave.counters()
            assert counters[0] == 0 and counters[1]  # it waits for a pause of its own rate
        world.check()


def test_at_its_own_rate_it_answers_at_its_own_address():
    world = world_of("8=mm420/factory", baud=9600, parameters={2013: 4})
    world.drives[8].write(2011, 0, 1)
    world.run(3_000)
    assert world.drives[8].slave.counters()[0] > 10
    assert not world.reads("NO CONTACT"), world.lcd()
