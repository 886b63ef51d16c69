# SPDX-License-Identifier: MIT
"""The operator's manual, drives that nobody has set up: found, taken, and run, by keys alone."""

import json
import sys

from boards.sim.drives.kinds import listed_drives, simulated
from panel_bench import panel, row_1, row_2, running, starts, switched_on


def line_of(text, drives=(1,), **more):
    """A panel that looks for these addresses, on a line with these drives."""
    listed = listed_drives(text)
    settings = dict(more.pop("settings", {}), drives=list(drives))
    addresses = [one.address for one in listed]
    world = switched_on(addresses, settings=settings, kinds=simulated(listed), **more)
    world.run(3000)
    return world


def offered(world):
    """Hold PARAM, choose FIND DRIVES, and say yes."""
    world.down("PARAM")
    world.run(1500)
    world.up("PARAM")
    world.run(200)
    for wanted in (">FIND DRIVES", ">AT ALL RATES"):
        while row_2(world) != wanted:
            world.press("DOWN")
            world.run(200)
        world.press("SET")
        world.run(300)
    assert row_2(world) == "SET=DO  PARAM=NO", world.lcd()
    world.press("SET")
    world.run(2500)
    assert row_1(world).startswith("FIND DRIVES "), world.lcd()


def hunted(world):
    """Begin, and wait for the end. How long it took, in ms."""
    began_us = world.clock.now_us
    world.press("SET")
    world.run(300)
    while "FOUND STOP=NO" in row_2(world):
        world.run(100)
    world.run(300)  # for the display
    return (world.clock.now_us - began_us) // 1000


def choices(world):
    """What was found: (row 1, row 2)."""
    found = []
    while world.lcd() not in found:
        found.append(world.lcd())
        world.press("DOWN")
        world.run(200)
    return [tuple(row.strip() for row in rows) for rows in found]


def stored(world):
    return json.loads(world.flash.files["settings.json"].decode())


def test_drives_of_several_families_layouts_and_rates_are_found():
    world = line_of("1,3=g110,5=mm3,7=v20/4,9=mm440/0,11=mm440/0+4,12=mm440/3+4,8=mm420/factory")
    offered(world)
    assert hunted(world) <= 30_000
    found = choices(world)
    assert found == [
        ("A1 19200 MM420", "4+2    FAULT [X]"),  # the panel has left it
        ("A3 19200 G110", "127+2  READY [X]"),
        ("A5 19200 MM3", "3+2    READY [X]"),
        ("A7 19200 V20", "4+2    READY [X]"),
        ("A9 19200 GENERIC", "0+2    READY [X]"),
        ("A11 19200 GENERI", "0+4    READY [X]"),
        ("A12 19200 MM420", "3+4    READY [X]"),
        ("A0 9600 MM420", "127+2  READY [ ]"),
    ], found
    world.press("PARAM")
    world.run(300)
    assert world.lcd() == ("TAKE 7 DRIVES?  ", "SET=YES PARAM=NO")
    world.press("SET")
    world.run(3000)
    settings = stored(world)
    assert settings["drives"] == [1, 3, 5, 7, 9, 11, 12] and settings["baud"] == 19200
    assert settings["kinds"] == {
        "3": "g110", "5": "mm3", "7": "v20/4", "9": "generic/0", "11": "generic/0+4",
        "12": "mm420/3+4",
    }  # fmt: skip
    for _ in settings["drives"]:  # a drive that was left alone has tripped
        world.run(4000)
        world.press("STOP")
        world.press("ADDRESS_UP")
    world.run(4000)
    for address in settings["drives"]:
        world.press("START")
        world.run(1500)
        if row_2(world).startswith("START=GO"):
            world.press("START")
        world.run(3000)
        assert world.drives[address].state == "running", (address, world.lcd())
        world.press("ADDRESS_UP")
        world.run(500)
    world.check()


def test_a_drive_as_delivered_is_taken_at_its_own_rate_and_address():
    world = line_of("8=mm420/factory", settings={"unsupervised": [1]})
    assert row_2(world) == "NO CONTACT   A1"
    offered(world)
    hunted(world)
    assert world.lcd() == ("A0 9600 MM420   ", "127+2  READY [X]")
    world.press("PARAM")
    world.run(200)
    world.press("SET")
    world.run(4000)
    settings = stored(world)
    assert (settings["baud"], settings["drives"]) == (9600, [0])
    assert settings["kinds"] == {"0": "mm420/127"} and settings["unsupervised"] == []
    assert row_2(world) == "LOCAL        A0", world.lcd()
    for number in ("P0700", "P1000"):  # at the buttons: commands and setpoint from this link
        world.press("PARAM")
        world.run(1500)
        while not row_2(world).startswith(number):
            world.press("NEXT")
            world.run(1000)
        world.press("EDIT")
        while row_2(world)[6:12].strip() != "5":
            world.press("UP")
            world.run(100)
        for _ in range(2):
            world.press("SET")
            world.run(500)
        world.run(3000)
        world.press("PARAM")
        world.run(1000)
    assert row_2(world) == "READY        A0", world.lcd()
    world.check()


def test_param_leads_back_from_every_page_and_changes_nothing():
    world = line_of("1,2")
    before = stored(world)
    offered(world)
    world.press("PARAM")
    world.run(3000)
    assert world.reads("S: 10.0 F:  0.00"), world.lcd()
    offered(world)
    hunted(world)
    while "[X]" in row_2(world):
        world.press("SET")
        world.press("DOWN")
        world.run(200)
    world.press("PARAM")
    world.run(3000)
    assert not world.reads("TAKE ") and stored(world)["drives"] == before["drives"]
    offered(world)
    hunted(world)
    world.press("PARAM")
    world.run(200)
    world.press("PARAM")
    world.run(3000)
    assert stored(world)["drives"] == before["drives"]
    world.check()


def test_stop_ends_the_search():
    world = line_of("1,2")
    offered(world)
    world.press("SET")
    world.run(4000)
    assert "FOUND STOP=NO" in row_2(world), world.lcd()
    world.press("STOP")
    world.run(500)
    assert "FOUND STOP=NO" not in row_2(world), world.lcd()
    sent = world.wire.log.count
    world.run(3000)
    assert world.wire.log.count == sent  # nothing is sent any more


def test_a_telegram_that_is_under_way_when_stop_ends_the_search_is_sent_to_its_end():
    world = line_of("1,2")
    offered(world)
    for step in range(12):
        world.press("SET")
        world.run(2000 + 7 * step)
        world.press("STOP")
        world.run(500)
        assert "FOUND STOP=NO" not in row_2(world), world.lcd()
        world.check()
        while not row_1(world).startswith("FIND DRIVES "):
            world.press("PARAM")
            world.run(3000)
            if row_2(world)[13:14] == "A":  # the panel
                offered(world)


def test_what_was_found_before_stop_can_still_be_taken():
    """And a motor that somebody has left running is stopped."""
    world = line_of("1,2=g110,4", drives=(1,))
    world.drives[2].write(2014, 0, 0)
    for stw in (0x047E, 0x047F):
        world.drives[2].process.accept((stw, 0x1000))
    world.run(5000)
    assert world.drives[2].state == "running", world.drives[2].report()
    offered(world)
    world.press("SET")
    while not row_2(world).startswith("2 FOUND"):
        world.run(20)
    world.press("STOP")
    world.run(1500)
    found = choices(world)
    assert [row[0] for row in found] == ["A1 19200 MM420", "A2 19200 G110"], found
    assert "RUNS" in found[1][1] and world.drives[2].stw == 0x047E, found
    world.run(6000)
    assert world.drives[2].hz() == 0
    world.press("PARAM")
    world.run(200)
    world.press("SET")
    world.run(3000)
    assert stored(world)["drives"] == [1, 2] and stored(world)["kinds"] == {"2": "g110"}
    world.check()


def test_how_long_it_takes_is_said_beforehand_and_holds():
    """If nobody answers; all rates together take minutes, most of them the slowest ones."""
    world = panel()
    world.drives[1].unplug()
    world.run(3000)
    offered(world)
    world.press("UP")
    world.run(300)
    all_s = int(row_1(world)[12:15])
    assert 340 < all_s < 500, world.lcd()
    world.press("UP")
    world.run(300)
    said_s = int(row_1(world)[12:15])
    assert 0.8 * said_s < hunted(world) / 1000 < said_s + 1.5 < 30, said_s


def test_the_search_leaves_the_memory():
    """A chip that has the firmware as files has no room for it beside a panel of 31 drives."""
    world = panel()
    offered(world)
    assert "search.search" in sys.modules
    hunted(world)
    world.press("PARAM")
    world.run(300)
    if world.lcd()[1].startswith("SET=YES"):
        world.press("SET")
    world.run(3000)
    assert row_2(world).endswith("A1"), world.lcd()
    left = [name for name in sys.modules if name.startswith("search.")]
    assert not left and "uss.finding.scan" not in sys.modules, left


def test_nobody_looks_for_drives_while_a_motor_runs():
    world = running()
    world.down("PARAM")
    world.run(1500)
    world.up("PARAM")
    for key in ("DOWN", "DOWN", "SET", "DOWN", "SET"):
        world.press(key)
        world.run(300)
    assert row_2(world) == "STOP ALL FIRST", world.lcd()
    assert world.drives[1].state == "running"
    world.check()


def test_no_key_of_the_search_moves_a_motor():
    world = line_of("1,2=mm440")
    offered(world)
    for _ in range(2):
        for key in ("START", "REVERSE", "JOG_RIGHT", "JOG_LEFT", "ADDRESS_UP", "NEXT", "EDIT"):
            world.press(key)
            world.run(300)
        if row_1(world).startswith("FIND"):
            hunted(world)
    assert starts(world, 1) == starts(world, 2) == 0
    for _, from_panel, characters in world.wire.log.last(1000):
        if from_panel and not characters[2] & 0x40:  # no mirror telegram
            assert b"\x04\x7f" not in characters and b"\x0c\x7f" not in characters


def test_where_nobody_answers_the_display_says_so():
    world = panel()
    world.drives[1].unplug()
    world.run(3000)
    world.press("STOP")
    offered(world)
    hunted(world)
    assert world.lcd() == ("NOBODY ANSWERED ", "WIRES? MAINS?   ")
    world.press("SET")
    world.run(300)
    assert row_1(world).startswith("FIND DRIVES ")


def test_all_rates_are_tried():
    world = line_of("1", baud=115200, settings={"baud": 115200})
    world.drives[1].unplug()
    world.run(3000)
    offered(world)
    assert row_2(world) == "4 RATES SET=GO", world.lcd()
    world.press("UP")
    world.run(300)
    assert row_2(world) == "13 RATES SET=GO", world.lcd()


def test_of_all_rates_the_usual_ones_come_first_and_stop_keeps_what_they_brought():
    world = line_of("1,8=mm420/factory")  # as delivered: address 0, 9600 baud
    offered(world)
    world.press("DOWN")
    world.run(300)
    assert row_2(world) == "13 RATES SET=GO", world.lcd()
    world.press("SET")
    world.run(25_000)
    world.press("STOP")
    world.run(3000)
    assert [rows[0].split()[:2] for rows in choices(world)] == [["A1", "19200"], ["A0", "9600"]]
    world.check()


def test_a_failure_while_it_searches_leaves_the_settings_as_they_were():
    world = line_of("1,2")
    before = stored(world)
    offered(world)
    world.press("SET")
    world.run(3000)
    world.reset()
    world.run(3000)
    assert stored(world) == before
    world.check()
