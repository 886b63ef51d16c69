# SPDX-License-Identifier: MIT
"""The operator's manual, events: what has happened since power-on, and how long ago."""

import main
from boards.sim.drives.families import mm3, mm440
from boards.sim.world import World
from lookup_bench import entries, go_to, press, settled_heading, wait, world_of
from panel import texts
from panel.menu.events import age
from panel.reports.journal import EVENTS, NOBODY, Journal
from panel_bench import row_1, row_2, wait_until_known


def run_motor(world):
    press(world, "START")
    world.run(3000)
    assert world.drives[1].state == "running", world.lcd()


def events(world):
    """What the list tells, as (drive, event)."""
    go_to(world, "EVENTS")
    world.run(500)
    told = [(heading.split()[0], entry.rstrip()) for heading, entry in entries(world)]
    press(world, "PARAM", "PARAM")
    return told


def test_what_stopped_a_motor_stands_in_the_list_the_last_first():
    world = world_of("mm420", addresses=(1, 2))
    run_motor(world)
    press(world, "STOP")
    world.run(3000)
    run_motor(world)
    world.drives[1].fault(1)
    wait(world, "FAULT F0001")
    world.run(1500)
    press(world, "STOP")
    world.run(1500)
    told = events(world)
    assert told[-1] == ("A1", "STOP KEY"), told
    assert told.count(("A1", "STOP KEY")) == 1, told  # the second one found a motor that stood
    assert ("A1", "FAULT F0001") in told, told
    assert told.index(("A1", "FAULT F0001")) < len(told) - 1, told
    world.check()


def test_nothing_has_happened_yet():
    world = world_of("mm420")
    go_to(world, "EVENTS")
    world.run(500)
    assert row_1(world).startswith("EVENTS ")
    assert row_2(world).rstrip() == ">NONE YET", world.lcd()
    press(world, "SET")
    assert row_2(world).rstrip() == ">NONE YET", world.lcd()
    world.check()


def test_a_drive_that_was_lost_while_it_ran():
    world = world_of("mm420")
    run_motor(world)
    world.drives[1].unplug()
    world.run(4000)
    world.drives[1].plug()
    world.run(4000)
    assert ("A1", "LOST,MAY RUN") in events(world)
    world.check()


def test_a_panel_that_the_watchdog_has_restarted_says_so():
    world = world_of("mm420")
    world.hang(2600)
    world.run(6000)
    assert events(world) == [("P", "WATCHDOG RESTART"[:15])]
    world.check()


def test_set_tells_what_a_fault_means():
    world = world_of("mm420")
    run_motor(world)
    world.drives[1].fault(1)
    wait(world, "FAULT F0001")
    world.run(1500)
    go_to(world, "EVENTS", "FAULT F0001")
    world.run(800)
    assert "Overcurrent" in row_2(world), world.lcd()
    world.check()


def test_set_tells_nothing_of_a_drive_that_is_not_shown_nor_of_the_panel():
    """Another family may have another meaning for the number."""
    world = world_of("mm420", addresses=(1, 2))
    world.hang(2600)
    world.run(6000)
    run_motor(world)
    world.drives[1].fault(1)
    wait(world, "FAULT F0001")
    world.run(1500)
    press(world, "STOP", "ADDRESS_UP")
    world.run(1500)
    for event in ("FAULT F0001", "WATCHDOG"):
        go_to(world, "EVENTS")
        world.run(500)
        while not row_2(world).startswith(">" + event):
            press(world, "DOWN")
        before = row_2(world)
        press(world, "SET")
        world.run(800)
        assert row_2(world) == before, (event, world.lcd())
        press(world, "PARAM", "PARAM")
    world.check()


def test_an_event_reads_as_the_family_of_its_drive_writes_it():
    """It may be another one than the drive shown has; and it stays when its drive is removed."""
    world = World(
        main.start, (1, 2), kinds={1: {"family": mm440}, 2: {"family": mm3}},
        settings={"kinds": {"1": "mm440", "2": "mm3"}},
    )  # fmt: skip
    world.run(1000)
    wait_until_known(world)
    press(world, "ADDRESS_UP")
    wait_until_known(world)
    world.drives[2].fault(2)
    world.run(1500)
    press(world, "ADDRESS_UP")
    world.run(1500)
    world.app.panel.journal.note(texts.UNSUPERVISED, 2)
    assert events(world) == [("A2", "P0093=0"), ("A2", "FAULT F002")]
    press(world, "ADDRESS_UP")
    world.app.panel.remove()
    world.run(1500)
    assert events(world) == [("A2", "P2014=0"), ("A2", "FAULT F0002")]
    world.check()


def test_how_long_ago_it_was():
    world = world_of("mm420")
    run_motor(world)
    press(world, "STOP")
    world.run(65_000)
    go_to(world, "EVENTS")
    world.run(500)
    drive, ago = settled_heading(world)[0].split()
    assert drive == "A1" and "1:05" <= ago <= "1:15", world.lcd()
    assert [age(each) for each in (0, 59, 3_599, 3_600, 86_399, 86_400, 1_000_000)] == [
        b"0:00", b"0:59", b"59:59", b"1h00", b"23h59", b"1d00h", b"11d13h",
    ]  # fmt: skip


def test_an_hour_is_an_hour():
    journal = Journal(0xFFFF)
    journal.tick(0)
    journal.note(b"FAULT")
    for second in range(1, 3_601):
        journal.tick(second * 1_000 & 0xFFFF)
    assert journal.event(0)[3] == 3_600


def test_the_journal_keeps_the_last_events_and_counts_on_when_the_clock_wraps():
    journal = Journal(0xFFFF)
    now_ms = 0xFF00
    journal.tick(now_ms)
    for number in range(1, EVENTS + 4):
        journal.note(b"FAULT", 3, number)
        for _ in range(10):
            now_ms += 1_000
            journal.tick(now_ms & 0xFFFF)
    assert journal.count == EVENTS
    assert journal.event(0)[:3] == (b"FAULT", 3, EVENTS + 3)
    assert journal.event(EVENTS - 1)[:3] == (b"FAULT", 3, 4)
    ages = [journal.event(place)[3] for place in range(EVENTS)]
    assert ages == list(range(10, 10 * EVENTS + 1, 10)), ages
    journal.note(b"PANEL HUNG")
    assert journal.event(0)[1] == NOBODY
