# SPDX-License-Identifier: MIT
"""The operator's manual, events: what has happened since power-on, and how long ago."""

import main
from boards.sim.drives.families import mm3, mm440
from boards.sim.world import World
from lookup_bench import entries, go_to, press, settled_heading, wait, world_of
from panel import texts
from panel.menu import events as event_list
from panel.menu.events import age
from panel.reports.fault import DriveWarning, Fault
from panel.reports.journal import NOBODY, Journal
from panel_bench import row_1, row_2, wait_until_known
from pkw_bench import AskedDrive
from uss import pkw, pzd
from uss.families import GENERIC, MM3, MM440, V20


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


def test_the_journal_keeps_the_last_16_events_and_counts_on_when_the_clock_wraps():
    journal = Journal(0xFFFF)
    now_ms = 0xFF00
    journal.tick(now_ms)
    for number in range(1, 20):
        journal.note(b"FAULT", 3, number)
        for _ in range(10):
            now_ms += 1_000
            journal.tick(now_ms & 0xFFFF)
    assert journal.count == 16
    assert journal.event(0)[:3] == (b"FAULT", 3, 19)
    assert journal.event(15)[:3] == (b"FAULT", 3, 4)
    ages = [journal.event(place)[3] for place in range(16)]
    assert ages == list(range(10, 161, 10)), ages
    journal.note(b"PANEL HUNG")
    assert journal.event(0)[1] == NOBODY


def test_a_second_has_gone_when_a_thousand_milliseconds_have():
    journal = Journal(0xFFFF)
    journal.tick(500)
    journal.note(b"FAULT", 3, 11)
    assert journal.count == 1 and journal.event(0) == (b"FAULT", 3, 11, 0)
    for now_ms, age_s in ((1_499, 0), (1_500, 1), (2_499, 1), (5_600, 5), (6_499, 5), (6_500, 6)):
        journal.tick(now_ms)
        assert journal.event(0)[3] == age_s, now_ms
    journal.note(b"PANEL HUNG")
    assert journal.event(0) == (b"PANEL HUNG", NOBODY, 0, 0) and journal.event(1)[3] == 6


class Told:
    """A drive of this family, and a panel that shows it beside others."""

    def __init__(self, address, family):
        self.drive = self.survey = self.selected = self
        self.address, self.family = address, family
        self.controls = [self]
        self.journal = Journal(0xFFFF)


def test_an_event_has_the_drive_its_words_and_what_set_leads_to():
    """Who is not in the list any more has the words of the drive that is shown."""
    panel = Told(3, MM440)
    other = Told(12, MM3)
    panel.controls.append(other)
    shown = event_list.List(panel)
    assert (shown.count(), shown.heading(0), shown.words(0)) == (1, b"EVENTS", b"NONE YET")
    assert shown.control_at(0) is None and shown.choose(0, 0) is None
    what = "lookup.what", ("F", 11, b"F0011")
    for event, heading, words, control, leads in (
        ((texts.FAULT, 3, 11), b"A3 0:00", b"FAULT F0011", panel, what),
        ((texts.FAULT, 12, 2), b"A12 0:00", b"FAULT F002", other, None),
        ((texts.FAULT, 7, 52), b"A7 0:00", b"FAULT F0052", None, None),
        ((texts.UNSUPERVISED, 3), b"A3 0:00", b"P2014=0", panel, None),
        ((texts.UNSUPERVISED, 12), b"A12 0:00", b"P0093=0", other, None),
        ((texts.UNSUPERVISED, 0), b"A0 0:00", b"P2014=0", None, None),
        ((b" OF SIXTEEN WORDS", 3), b"A3 0:00", b"OF SIXTEEN WORD", panel, None),
        ((texts.PANEL_HUNG,), b"P 0:00", b"PANEL HUNG", None, None),
    ):
        panel.journal.note(*event)
        assert (shown.heading(0), shown.words(0)) == (heading, words), event
        assert (shown.control_at(0), shown.choose(0, 0)) == (control, leads), event
    assert shown.count() == 8 and shown.words(7) == b"FAULT F0011"
    assert shown.choose(7, 0) == what


# --- the number of a fault or a warning, by itself -----------------------------------------------


def stepped(report, *times_ms):
    for now_ms in times_ms:
        report.step(now_ms * 1_000 & 0x3FFFFFF)
    return report.active, report.number


def test_the_number_of_a_fault_is_asked_for_twice_a_second_as_long_as_it_is_there():
    drive = AskedDrive()
    fault = Fault(drive, 0x3FFFFFF, MM440)
    assert stepped(fault, 67_000) == (False, 0) and drive.asked == []
    drive.zsw = pzd.ZSW_FAULT
    drive.full = True
    assert stepped(fault, 67_001) == (True, 0) and drive.asked == []
    drive.full = False
    assert stepped(fault, 67_002, 67_003) == (True, 0)
    assert [(job.number, job.index) for job in drive.asked] == [(947, 0)]
    drive.answer(11)
    assert stepped(fault, 67_100, 67_501) == (True, 11) and len(drive.asked) == 1
    assert stepped(fault, 67_502) == (True, 11) and len(drive.asked) == 2
    drive.answer(12)  # by now it is another one
    assert stepped(fault, 67_600) == (True, 12)
    stepped(fault, 68_002)
    drive.answer(state=pkw.TIMED_OUT)
    assert stepped(fault, 68_100) == (True, 12)
    stepped(fault, 68_501)
    assert len(drive.asked) == 3
    stepped(fault, 68_502)
    assert len(drive.asked) == 4
    for state in (pkw.REFUSED, pkw.UNANSWERED):
        before = len(drive.asked)
        begun_ms = 68_502 if state == pkw.REFUSED else 78_502
        drive.answer(77, state)
        assert stepped(fault, begun_ms + 1, begun_ms + 9_999) == (True, 12), state
        assert len(drive.asked) == before
        stepped(fault, begun_ms + 10_000)
        assert len(drive.asked) == before + 1, state


def test_a_fault_that_is_over_has_no_number_and_an_answer_about_it_does_not_count():
    for over in ({"zsw": 0}, {"contact": False}, {"tells_status": False}):
        drive = AskedDrive()
        drive.zsw = pzd.ZSW_FAULT
        fault = Fault(drive, 0x3FFFFFF, MM440)
        assert stepped(fault, 0) == (True, 0)
        drive.answer(11)
        assert stepped(fault, 10, 510) == (True, 11) and len(drive.asked) == 2
        fault.show(1_000)
        assert fault.was_shown()
        for name in over:
            setattr(drive, name, over[name])
        assert stepped(fault, 520) == (False, 0) and not fault.was_shown(), over
        drive.answer(12)
        assert stepped(fault, 530, 5_000) == (False, 0) and len(drive.asked) == 2
        drive.zsw, drive.contact, drive.tells_status = pzd.ZSW_FAULT, True, True
        assert stepped(fault, 5_001) == (True, 0)  # at once
        assert len(drive.asked) == 3
        drive.answer(13)
        assert stepped(fault, 5_002) == (True, 13)


def test_a_fault_was_shown_when_it_has_been_there_for_a_second():
    drive = AskedDrive()
    fault = Fault(drive, 0x3FFFFFF, MM440)
    fault.show(5_000)
    assert not fault.was_shown()  # it is none yet
    drive.zsw = pzd.ZSW_FAULT
    stepped(fault, 0)
    fault.show(400)
    fault.show(599)
    assert not fault.was_shown()
    fault.show(1)
    assert fault.was_shown()
    fault.show(1_000)
    assert fault.was_shown()


def test_a_warning_is_that_of_the_drive_that_is_shown():
    first, second = AskedDrive(), AskedDrive()
    warning = DriveWarning(first, 0x3FFFFFF, MM440)
    first.zsw = pzd.ZSW_WARNING
    assert stepped(warning, 0) == (True, 0) and first.asked[0].number == 2110
    first.answer(501)
    assert stepped(warning, 1) == (True, 501) and warning.digits == 4
    warning.turn_to(second, GENERIC)
    assert (warning.active, warning.number, warning.digits) == (False, 0, 0)
    second.zsw = pzd.ZSW_WARNING | pzd.ZSW_FAULT
    assert stepped(warning, 2, 3) == (True, 0) and second.asked == []  # nobody knows which has it
    for family, digits in ((MM3, 3), (V20, 0), (MM440, 4)):
        warning.turn_to(second, family)
        assert warning.digits == digits == Fault(second, 0x3FFFFFF, family).digits
    second.zsw = pzd.ZSW_FAULT
    assert stepped(warning, 4, 5) == (False, 0)
