# SPDX-License-Identifier: MIT
"""The panel's list of drives changes while it works: one comes, one goes, the others run on."""

import json

import main
from boards.sim.drives.kinds import expected, listed_drives, simulated
from boards.sim.world import World
from panel_bench import LOOP_US, all_running, panel, row_2, starts, wait_until_known


def panel_of(text, drives):
    """A panel with these addresses in its list, on a line with more drives."""
    listed = listed_drives(text)
    settings = {"kinds": expected([one for one in listed if one.address in drives])}
    settings["drives"] = list(drives)
    world = World(main.start, [one.address for one in listed], settings=settings,
                  kinds=simulated(listed))  # fmt: skip
    world.run(1000)
    wait_until_known(world)
    return world


def added(world, address, kind):
    world.app.panel.add(address, kind)
    world.run(500)
    wait_until_known(world)


def test_a_drive_that_is_added_is_shown_and_runs_beside_the_others():
    world = panel_of("1,7=g110,9=mm3", (1,))
    world.press("START")
    world.run(4000)
    added(world, 7, "g110")
    assert row_2(world) == "READY        A7" and world.drives[1].state == "running"
    world.press("START")
    world.run(4000)
    added(world, 9, "mm3")
    assert world.drives[7].state == "running" and starts(world, 9) == 0
    world.press("START")
    world.run(6000)
    assert [world.drives[address].state for address in (1, 7, 9)] == ["running"] * 3
    seen = set()
    for _ in range(60):
        world.run(100)
        seen.add(row_2(world))
    assert {"A1 RUN,HOLD=ALL", "A7 RUN,HOLD=ALL"} <= seen, seen
    world.down("STOP")
    world.run(4500)
    world.up("STOP")
    world.run(6000)
    assert [world.drives[address].hz() for address in (1, 7, 9)] == [0, 0, 0]
    world.check()


def test_what_was_added_is_there_after_a_reset():
    world = panel_of("1,7=g110", (1,))
    added(world, 7, "g110")
    world.run(3000)
    stored = json.loads(world.flash.files["settings.json"].decode())
    assert stored["drives"] == [1, 7] and stored["kinds"] == {"7": "g110"}
    world.reset()
    world.run(3000)
    world.press("ADDRESS_DOWN")
    wait_until_known(world)
    assert row_2(world) == "READY        A7"


def test_a_drive_that_is_removed_hears_nothing_any_more():
    world = panel(addresses=(1, 2, 3))
    world.press("ADDRESS_UP")
    wait_until_known(world)
    world.app.panel.remove()
    world.run(2000)
    assert row_2(world) == "READY        A3"
    before = world.drives[2].slave.counters()[0]
    world.run(2000)
    assert world.drives[2].slave.counters()[0] == before
    assert json.loads(world.flash.files["settings.json"].decode())["drives"] == [1, 3]
    for text in ("A1", "A3"):
        world.press("ADDRESS_UP")
        wait_until_known(world)
        assert row_2(world).endswith(text), world.lcd()
    world.check()


def test_one_that_runs_or_is_the_only_one_stays():
    world = all_running((1, 2))
    for _ in range(2):
        try:
            world.app.panel.remove()
        except ValueError as error:
            assert "running" in str(error)
        else:
            raise AssertionError("it was removed")
        world.press("ADDRESS_UP")
    assert len(world.app.panel.controls) == 2 and world.app.settings.drives == (1, 2)
    world = panel()
    try:
        world.app.panel.remove()
    except ValueError as error:
        assert "at the least" in str(error)
    else:
        raise AssertionError("it was removed")


def test_an_address_that_is_taken_or_none_is_refused_and_changes_nothing():
    world = panel(addresses=(1, 2))
    for address in (1, 2, 32, -1):
        try:
            world.app.panel.add(address, "mm440")
        except ValueError:
            continue
        raise AssertionError(address)
    world.run(1000)
    assert world.app.settings.drives == (1, 2) and not world.app.settings.dirty
    assert len(world.app.bus.turns.drives) == 2


def test_what_there_is_to_say_of_the_others_is_said_on():
    world = all_running((1, 2, 3), loop_us=LOOP_US)
    world.drives[1].fault(1)
    world.run(500)
    world.press("STOP")  # of drive 1, which is shown
    world.press("ADDRESS_UP")
    world.press("STOP")
    world.run(8000)
    world.app.panel.remove()
    seen = set()
    for _ in range(60):
        world.run(100)
        seen.add(row_2(world))
    assert "A1 FAULT F0001  ".strip() in {row.strip() for row in seen}, seen
    assert world.app.settings.drives == (1, 3)
    world.check()


def test_a_drive_that_is_asked_twice_in_a_round_is_asked_half_a_round_later_again():
    for repeats, asked in (
        ({}, [1, 2, 3, 4]),
        ({"4": 2}, [1, 2, 4, 3, 4]),
        ({"1": 2}, [1, 2, 1, 3, 4]),
        ({"2": 3}, [1, 2, 3, 2, 4, 2]),
        ({"1": 2, "3": 2}, [1, 3, 2, 1, 3, 4]),
    ):
        world = panel(addresses=(1, 2, 3, 4), settings={"repeats": repeats})
        in_turn = [drive.address for drive in world.app.bus.turns.list]
        assert in_turn == asked, (repeats, in_turn)


def test_the_turns_are_arranged_anew_with_each_drive_that_comes_or_goes():
    """So is the time for which a drive may be without a telegram: it grows with the round."""
    world = panel(addresses=(1, 2, 3), baud=1200, settings={"repeats": {"1": 2}})
    app = world.app
    roster, desk = app.panel.roster, app.panel.controls[0].desk

    def in_turn():
        return [drive.address for drive in app.bus.turns.list]

    assert in_turn() == [1, 2, 1, 3]
    off_times = [desk.longest_off_time_ms]
    control = roster.add(9, "mm440")
    assert in_turn() == [1, 2, 1, 3, 9] and roster.controls[-1] is control
    off_times.append(desk.longest_off_time_ms)
    roster.remove(roster.controls[1])
    assert in_turn() == [1, 3, 1, 9]
    off_times.append(desk.longest_off_time_ms)
    roster.remove(control)
    assert in_turn() == [1, 1, 3] and app.settings.drives == (1, 3)
    off_times.append(desk.longest_off_time_ms)
    four, five, four_again, three = off_times
    assert three < four == four_again < five, off_times


def test_drives_come_and_go_31_times():
    world = World(main.start, tuple(range(31)), settings={"drives": [0]})
    world.run(2000)
    for address in range(1, 31):
        world.app.panel.add(address, "mm440")
        world.run(200)
    assert world.app.settings.drives == tuple(range(31))
    world.run(5000)
    for _ in range(30):
        world.app.panel.remove()
        world.run(100)
    world.run(3000)
    assert len(world.app.settings.drives) == 1 and row_2(world).startswith("READY")
    world.check()
