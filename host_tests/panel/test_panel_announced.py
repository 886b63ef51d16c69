# SPDX-License-Identifier: MIT
"""The operator's manual, what is said of drives that are not shown: every trouble, one by one.

States are said as long as they hold, events until STOP acknowledges them. With n drives in trouble
each of them is said for a second and more in every 2 n s.
"""

import main
from boards.sim.world import World
from panel import texts
from panel.announcer import NOTHING, Announcer
from panel.neighbours import Neighbours
from panel.pages.home import Home
from panel.phases import ASKING, IDLE, JOGGING
from panel.screen import Screen
from panel_bench import (
    LOOP_US,
    SlowWorld,
    all_running,
    page_back,
    panel,
    row_1,
    row_2,
    running,
    said,
    settled,
    starts,
    unsupervised,
    wait_until_known,
)  # fmt: skip
from uss import pzd
from uss.families import MM440

ASKED = "SET=FIX START=GO"


def silent(addresses, plugged, **options):
    """A panel of which only these drives are there since it was switched on."""
    world = World(main.start, addresses=addresses, **options)
    for address in addresses:
        if address not in plugged:
            world.drives[address].unplug()
    world.run(4_000)
    return world


def all_started(addresses):
    """A panel whose drives run all, however many."""
    world = panel(addresses=addresses, loop_us=LOOP_US)
    world.run(3_000)
    for address in addresses:
        show(world, address)
        world.press("START")
        world.run(2_000)
    world.run(2_000)
    for drive in world.drives.values():
        assert drive.state == "running", drive.report()
    return world


def show(world, address):
    while world.app.panel.selected.drive.address != address:
        world.press("ADDRESS_UP", 40)
        world.run(60)


def wait_for(world, text):
    """Until row 2 begins with a text."""
    for _ in range(500):
        if settled(world)[1].startswith(text):
            return
        world.run(40)
    raise AssertionError("%r does not come: %r" % (text, world.lcd()))


def start(world, address):
    show(world, address)
    wait_until_known(world)
    world.press("START")
    world.run(4_000)
    assert world.drives[address].state == "running", world.drives[address].report()


def wait_for_rest(world, address):
    for _ in range(1_000):
        world.run(20)
        if world.drives[address].hz() == 0 and world.drives[address].state == "ready":
            return
    raise AssertionError(world.drives[address].report())


# --- every drive ---------------------------------------------------------------------------------


def test_a_drive_that_does_not_matter_hides_none_that_does():
    """Drive 3 is unplugged, and cannot confirm a STOP of all. Then a motor is lost."""
    for heard in (False, True):
        world = panel(addresses=(1, 2, 3)) if heard else World(main.start, addresses=(1, 2, 3))
        world.drives[3].unplug()
        world.run(3_000)
        world.press("STOP", 4_500)
        world.run(2_000)
        start(world, 1)
        show(world, 2)
        world.run(500)
        world.drives[1].write(2014, 0, 0)
        world.drives[1].unplug()
        world.run(5_000)
        rows = said(world, 4_000)
        assert rows["A1 LOST,MAY RUN"] >= 1_000, rows
        assert ("A3 MAY RUN" in rows) != heard and "A3 NOT STOPPED" not in rows, rows
        assert abs(world.drives[1].hz() - 10) < 0.01
        world.check()


def test_an_alarm_hides_no_drive_that_runs_trips_or_was_taken_back():
    world = all_started((1, 2, 3, 4))
    world.drives[1].unplug()
    world.drives[3].fault(7)
    world.run(3_000)
    show(world, 4)
    world.press("STOP")
    world.run(5_000)
    rows = said(world, 6_000)
    for row in ("A1 LOST,MAY RUN", "A2 RUN,HOLD=ALL", "A3 FAULT F0007", "READY        A4"):
        assert rows.get(row, 0) >= 1_000, rows
    assert len(rows) == 4, rows
    world.check()


def test_of_two_drives_that_are_lost_stopping_one_hides_none():
    """STOP cannot be heard: nobody knows whether either of them stands."""
    world = all_running((1, 2, 3), loop_us=LOOP_US)
    world.drives[1].unplug()
    world.drives[2].unplug()
    show(world, 3)
    world.run(2_500)
    rows = said(world, 4_000)
    assert rows["A1 LOST,MAY RUN"] >= 1_000 and rows["A2 LOST,MAY RUN"] >= 1_000, rows
    show(world, 1)
    world.press("STOP")
    world.run(1_500)
    rows = said(world, 4_000)
    assert rows["A2 LOST,MAY RUN"] >= 1_000 and rows["STOP UNCONFIRMED"] >= 1_000, rows
    assert rows["A3 RUN,HOLD=ALL"] >= 1_000, rows
    show(world, 3)
    world.run(1_500)
    rows = said(world, 4_000)
    assert rows["A1 NOT STOPPED"] >= 1_000 and rows["A2 LOST,MAY RUN"] >= 1_000, rows
    world.check()


def test_with_n_drives_in_trouble_each_is_said_for_a_second_in_every_2_n_seconds():
    addresses = (1, 2, 3, 4, 5, 6)
    world = all_started(addresses)
    troubles = ("A1 LOST,MAY RUN", "A2 LOST,MAY RUN", "A3 RUN,HOLD=ALL", "A4 FAULT F0011",
                "A5 FAULT F0012")  # fmt: skip
    world.drives[1].unplug()
    world.drives[2].unplug()
    world.drives[4].fault(11)
    world.drives[5].fault(12)
    show(world, 6)
    world.press("STOP")
    world.run(9_000)
    for _ in range(5):
        rows = said(world, 2_000 * len(troubles))
        for row in troubles:
            assert rows.get(row, 0) >= 1_000, (row, rows)
        assert rows["READY        A6"] >= 1_000
    world.check()


def test_a_slow_loop_says_each_of_them_for_a_second_as_well():
    """Steps and pictures are late there, which is at the expense of the page."""
    texts = ("A2 FAULT F0011", "A3 FAULT F0012", "A4 FAULT F0013")
    world = SlowWorld(main.start, addresses=(1, 2, 3, 4), seed=1)
    world.run(4_000)
    for address, number in ((2, 11), (3, 12), (4, 13)):
        world.drives[address].fault(number)
    world.run(8_000)
    world.down("STOP")  # they go to row 1, beside what STOP does
    read_us = [dict.fromkeys(texts, 0)]  # in each round of them
    us = began_us = world.clock.now_us
    for _ in range(24_000):
        before_us, us = us, world.clock.now_us
        row = row_1(world).rstrip()
        if row in texts:
            read_us[-1][row] += us - before_us
        elif min(read_us[-1].values()):
            read_us.append(dict.fromkeys(texts, 0))
        world.run(5)
    rounds = read_us[1:-1]
    assert min(min(read.values()) for read in rounds) >= 1_000_000, rounds
    assert len(rounds) + 2 >= (us - began_us) // (2_000_000 * len(texts)), len(rounds)
    world.check()


def test_the_most_dangerous_ones_come_first():
    world = all_started((1, 2, 3, 4, 5))
    world.drives[1].fault(11)
    world.drives[3].unplug()
    world.drives[4].unplug()
    world.run(2_000)
    show(world, 4)
    world.press("STOP")
    show(world, 5)
    world.run(8_000)
    ranks = ("A4 NOT STOPPED", "A3 LOST,MAY RUN", "A2 RUN,HOLD=ALL", "A1 FAULT F0011")
    order = []
    for _ in range(250):
        row = settled(world)[1].rstrip()
        if row in ranks and order[-1:] != [row]:
            order.append(row)
    first = order.index(ranks[0])
    assert tuple(order[first : first + 4]) == ranks, order
    world.check()


def test_a_trip_of_a_drive_that_was_not_on_is_said_as_well():
    world = panel(addresses=(1, 2))
    world.drives[2].fault(12)
    world.run(500)
    rows = said(world, 4_000)
    assert rows["A2 FAULT F0012"] >= 2_000 and rows["READY        A1"] >= 1_000, rows
    show(world, 2)
    world.run(1_500)
    world.press("STOP")
    show(world, 1)
    world.run(1_500)
    assert set(said(world, 4_000)) == {"READY        A1"}
    world.check()


def test_an_event_is_said_until_it_is_acknowledged():
    """The line of a motor that is not shown failed for a while, and its drive took no notice."""
    world = all_running((1, 2))
    show(world, 1)
    world.drives[2].write(2014, 0, 0)
    world.drives[2].unplug()
    world.run(2_000)
    world.drives[2].plug()
    world.run(12_000)
    assert world.drives[2].state == "ready"
    world.press("STOP")  # that is for the drive shown
    world.run(10_000)
    rows = said(world, 4_000)
    assert rows["A2 LINE FAILED"] >= 2_000 and rows["READY        A1"] >= 1_000, rows
    show(world, 2)
    world.press("STOP")
    show(world, 1)
    world.run(1_500)
    assert set(said(world, 4_000)) == {"READY        A1"}
    world.check()


def test_a_jog_acknowledges_nothing():
    world = running()
    world.drives[1].write(2014, 0, 0)
    world.drives[1].unplug()
    world.run(2_000)
    world.drives[1].plug()
    wait_for_rest(world, 1)
    world.run(8_000)
    assert row_2(world) == "LINE FAILED  A1", world.lcd()
    world.drives[1].write(2014, 0, 2_000)
    world.run(4_000)
    world.press("JOG_RIGHT", 2_000)
    wait_for_rest(world, 1)
    world.run(2_000)
    assert row_2(world) == "LINE FAILED  A1" and starts(world) == 2, world.lcd()
    world.press("STOP")
    world.run(1_000)
    assert row_2(world) == "READY        A1", world.lcd()
    world.check()


def test_a_drive_that_would_run_on_too_long_by_now_is_said_to():
    """Somebody has changed P2014 while it runs, and it is not shown."""
    world = panel(addresses=(1, 2), parameters={2014: 1_000}, loop_us=LOOP_US)
    world.run(3_000)
    start(world, 2)
    show(world, 1)
    for off_ms, row in ((0, "A2 RUN, P2014=0"), (65_535, "A2 P2014 LONG"),
                        (1_000, "A2 RUN,HOLD=ALL")):  # fmt: skip
        world.drives[2].write(2014, 0, off_ms)
        world.run(12_000)
        rows = said(world, 4_000)
        assert set(rows) == {row, "READY        A1"}, rows
    world.check()


def test_what_somebody_changes_while_it_runs_is_said_in_parameter_mode():
    """In turn with the parameter: its time-out, and a lowest frequency above the setpoint."""
    for number, value, row in ((2014, 0, "A1 RUN, P2014=0"), (2014, 65_535, "A1 P2014 LONG"),
                               (1080, 20.0, "A1 BELOW P1080")):  # fmt: skip
        world = running(parameters={2014: 2_000})
        world.press("PARAM")
        world.drives[1].write(number, 0, value)
        world.run(8_000)
        rows = said(world, 10_000)
        assert set(rows) == {row, "P0700:     5 A1"}, rows
        world.press("STOP")
        world.run(9_000)
        assert set(said(world, 4_000)) == {"P0700:     5 A1"}
        world.check()


def test_a_warning_takes_turns_with_the_parameter():
    for started in (running, panel):
        world = started(parameters={2014: 2_000})
        world.press("PARAM")
        world.drives[1].warn(501)
        world.run(2_000)
        rows = said(world, 6_000)
        assert set(rows) == {"WARN A0501   A1", "P0700:     5 A1"}, rows
        assert min(rows.values()) > 2_000, rows
        world.drives[1].warn(501, False)
        world.run(2_000)
        assert set(said(world, 4_000)) == {"P0700:     5 A1"}
        world.check()


# --- many of a kind ------------------------------------------------------------------------------


def test_more_than_four_of_a_kind_share_a_text():
    for count in (4, 5, 11):
        addresses = tuple(range(1, count + 2))
        world = panel(addresses=addresses, baud=57600)
        for address in addresses[:-1]:
            world.drives[address].fault(address)
        show(world, addresses[-1])
        world.run(4_000)
        rows = said(world, 2_000 * count)
        own = "READY        A%d" % addresses[-1]
        if count > 4:
            assert set(rows) == {"DRIVES FAULT: %d" % count, own}, rows
        else:
            assert set(rows) == {"A%d FAULT F%04d" % (a, a) for a in addresses[:-1]} | {own}, rows
        world.check()


def test_many_that_share_a_text_put_off_none_of_another_kind():
    addresses = (1, 2, 3, 4, 5, 6, 7)
    world = panel(addresses=addresses, baud=57600)
    start(world, 6)
    for address in addresses[:5]:
        world.drives[address].fault(address)
    show(world, 7)
    world.run(4_000)
    rows = said(world, 10_000)
    assert set(rows) == {"DRIVES FAULT: 5", "A6 RUN,HOLD=ALL", "READY        A7"}, rows
    assert rows["A6 RUN,HOLD=ALL"] >= 2_000, rows
    world.check()


def test_of_many_that_share_a_text_the_one_shown_is_said_by_itself_where_its_page_does_not():
    """STOP acknowledges what has been on the display; so the number is to be there."""
    addresses = (1, 2, 3, 4, 5, 6)
    world = panel(addresses=addresses, baud=57600)
    for address in addresses:
        world.drives[address].fault(address)
    world.press("PARAM")
    world.run(4_000)
    for address in (1, 2):
        rows = said(world, 8_000)
        own = {"DRIVES FAULT: %d" % (7 - address), "A%d FAULT F%04d" % (address, address)}
        assert set(rows) == own | {"P0700:     5 A%d" % address}, rows
        assert rows["A%d FAULT F%04d" % (address, address)] >= 2_000, rows
        assert own <= set(said(world, 6_000)), "again and again"
        wait_for(world, "A%d FAULT" % address)
        world.press("STOP")
        world.run(500)  # what is not true any more is not said to its end
        assert not settled(world)[1].startswith("A%d FAULT" % address), world.lcd()
        world.run(500)
        assert world.drives[address].state == "ready"
        world.press("ADDRESS_UP")
        world.run(4_000)
    world.check()


def test_where_many_are_not_so_many_any_more_each_is_said_from_where_that_was_left():
    """The home page tells that drive 1 has tripped, so there they are four."""
    world = panel(addresses=(1, 2, 3, 4, 5))
    world.press("PARAM")
    page_back(world)  # its modules are there from now on
    for address in (1, 2, 3, 4, 5):
        world.drives[address].fault(11)
    for said_last, following in ((3, "A4 FAULT F0011"), (4, "A5 FAULT F0011")):
        world.run(4_000)
        wait_for(world, "A%d FAULT" % said_last)
        world.press("PARAM")
        wait_for(world, "DRIVES FAULT: 5")
        page_back(world)
        wait_for(world, "A")
        assert row_2(world) == following, (said_last, world.lcd())
    world.check()


def test_one_more_of_a_kind_for_a_moment_puts_none_of_them_off():
    """The message that START is refused hides that drive 1 has tripped: then there are five."""
    tripped = (2, 3, 4, 5)
    for said_then in tripped:
        world = silent((1, 2, 3, 4, 5, 6), (1, 2, 3, 4, 5))
        for address in (1,) + tripped:
            world.drives[address].fault(11)
        world.run(6_000)
        while not row_2(world).startswith("A%d FAULT" % said_then):
            world.run(40)
        world.press("START")
        unsaid_ms = dict.fromkeys(tripped, 0)
        read_ms = {}
        for _ in range(30_000 // 40):
            world.run(40)
            texts = [row.rstrip() for row in world.lcd()]
            read_ms = {text: read_ms.get(text, 0) + 40 for text in texts}
            for address in tripped:
                unsaid_ms[address] += 40
                for text in ("A%d FAULT F0011" % address, "DRIVES FAULT: 5"):
                    if read_ms.get(text, 0) >= 1_000:
                        unsaid_ms[address] = 0
            assert max(unsaid_ms.values()) <= 12_000, (said_then, unsaid_ms)
        world.check()


def test_drives_that_were_never_heard_share_one_text_and_are_no_alarm_each():
    addresses = tuple(range(1, 32))
    world = silent(addresses, (1, 2), baud=115200)
    world.run(12_000)
    rows = said(world, 12_000)
    assert set(rows) == {"MAY RUN: 29", "READY        A1"} and rows["MAY RUN: 29"] >= 2_000, rows
    world.press("STOP", 4_500)  # all of them
    world.run(6_000)
    rows = said(world, 12_000)
    assert set(rows) == {"MAY RUN: 29", "READY        A1"} and rows["MAY RUN: 29"] >= 2_000, rows
    world.check()


def test_how_many_they_are_has_one_digit_or_two():
    for count in (9, 10):
        world = silent(tuple(range(1, count + 2)), (1,), baud=115200)
        rows = said(world, 5_000)
        assert set(rows) == {"MAY RUN: %d" % count, "READY        A1"}, rows
        world.check()


def test_a_drive_that_was_not_heard_since_a_reset_may_run():
    world = panel(addresses=(1, 2), parameters={2014: 0}, settings={"unsupervised": [2]})
    start(world, 2)
    world.drives[2].unplug()
    world.run(100)
    world.reset()
    world.run(3_000)
    assert abs(world.drives[2].hz() - 10) < 0.01
    rows = said(world, 4_000)
    assert rows["A2 MAY RUN"] >= 2_000 and rows["READY        A1"] >= 1_000, rows
    world.drives[2].plug()
    world.run(10_000)
    assert set(said(world, 4_000)) == {"READY        A1"} and world.drives[2].hz() == 0
    world.check()


def test_stop_acknowledges_a_drive_that_was_never_heard():
    world = silent((1, 2), (1,))
    assert "A2 MAY RUN" in said(world, 4_000)
    show(world, 2)
    assert "A2 MAY RUN" in said(world, 4_000)
    world.press("STOP")
    show(world, 1)
    world.run(1_500)
    assert set(said(world, 4_000)) == {"READY        A1"}
    world.check()


# --- nothing hides it ----------------------------------------------------------------------------


def test_stop_never_ends_what_is_said_of_a_motor_that_was_heard_running_last():
    world = all_running((1, 2), loop_us=LOOP_US)
    world.drives[1].unplug()
    show(world, 1)
    world.run(1_500)
    for _ in range(3):
        world.press("STOP")
        world.run(1_500)
        assert world.reads("STOP UNCONFIRMED")
        world.press("ADDRESS_UP")
        rows = said(world, 3_000)
        assert rows["A1 NOT STOPPED"] >= 1_000, rows
        world.press("ADDRESS_UP")
        world.run(300)
    world.drives[1].plug()
    world.run(2_000)  # it tripped, and says that it stands
    assert not world.reads("UNCONFIRMED") and not world.reads("MAY RUN")
    world.check()


def test_the_own_alarm_stays_when_another_drive_is_spoken_of():
    world = all_running((1, 2))
    world.drives[1].unplug()
    show(world, 1)
    world.press("STOP")
    world.run(2_000)
    rows = set()
    for _ in range(60):
        first, second = settled(world)
        if second == "A2 RUN,HOLD=ALL ":
            rows.add(first)
    assert rows == {"STOP UNCONFIRMED"}, rows
    world.check()


def test_keys_that_are_refused_again_and_again_hide_nothing():
    world = all_running((1, 2))
    world.drives[1].unplug()
    show(world, 2)
    world.run(2_500)
    rows = {}
    for _ in range(8):
        world.press("JOG_RIGHT", 40)
        world.run(60)
        assert row_2(world) == "NO JOG: IT RUNS"
        for _ in range(20):
            world.run(20)
            rows[row_1(world)] = rows.get(row_1(world), 0) + 20
    assert rows["A1 LOST,MAY RUN "] >= 1_600, rows
    world.check()


def test_nor_does_a_stop_that_is_held():
    world = all_running((1, 2))
    world.drives[1].unplug()
    show(world, 2)
    world.run(2_500)
    world.down("STOP")
    rows = {}
    for _ in range(100):
        world.run(40)
        rows[row_1(world)] = rows.get(row_1(world), 0) + 40
    assert rows["A1 LOST,MAY RUN "] >= 2_000, rows
    assert row_2(world) == "OFF3, HOLD: ALL"
    world.check()


def test_a_question_hides_no_trip_of_the_drive_that_it_is_about():
    world = panel(parameters={2014: 0}, loop_us=LOOP_US)
    world.press("START")
    world.run(1_500)
    assert row_2(world) == ASKED
    world.drives[1].fault(1)
    rows = {}
    for _ in range(200):
        world.run(20)
        assert row_2(world) == ASKED
        rows[row_1(world)] = rows.get(row_1(world), 0) + 20
    assert rows["A1 FAULT F0001  "] >= 2_000, rows
    assert rows["P2014=0: IT RUNS"] + rows["ON IF PANEL DIES"] >= 1_000, rows
    world.press("STOP")  # no, and it has been seen
    world.run(1_000)
    assert row_2(world) == "READY        A1"
    world.check()


def test_nor_what_another_drive_does():
    world = panel(addresses=(1, 2), parameters={2014: 0}, settings={"unsupervised": [2]})
    start(world, 2)
    show(world, 1)
    world.press("START")
    world.run(1_500)
    assert row_2(world) == ASKED
    rows = set()
    for _ in range(200):
        world.run(20)
        rows.add(row_1(world))
    assert "A2 RUN,HOLD=ALL " in rows, rows
    world.check()


# --- what has been seen --------------------------------------------------------------------------


def test_a_message_hides_no_fault_of_the_drive_shown():
    world = panel()
    world.drives[1].fault(3)
    world.run(300)
    world.press("START", 60)
    rows = set()
    for _ in range(100):
        world.run(20)
        assert row_2(world) == "NO: FAULT"
        rows.add(row_1(world))
    assert "A1 FAULT F0003  " in rows, rows
    world.check()


def test_stop_acknowledges_what_has_been_on_the_display_for_a_second():
    for shown_ms, state in ((500, "fault"), (1_500, "ready")):
        world = panel()
        world.drives[1].fault(3)
        world.run(100 + shown_ms)
        world.press("STOP")
        world.run(500)
        assert world.drives[1].state == state, shown_ms
        world.check()


def test_drawing_changes_nothing_but_the_picture():
    world = panel(addresses=(1, 2))
    shown = world.app.panel
    world.drives[1].fault(3)
    while not shown.selected.fault.active:
        world.run(1)
    fault = shown.selected.fault
    before = dict(fault.__dict__)
    home = Home(shown)
    for now_ms in range(0, 10_000, 100):
        home.draw(shown.screen, now_ms)
    assert fault.__dict__ == before
    world.check()


def test_with_one_drive_more_they_are_said_together_at_once():
    """Four that run are said one after the other, five together, and then the page has long turns.
    The first of those turns came before anything was said: the drive that had just missed its own
    turn was unsaid for longer than two seconds for each of them.
    """
    for delay_ms in (0, 700, 1400):
        world = panel(addresses=(1, 2, 3, 4, 5, 6))
        for _ in range(5):
            wait_until_known(world)
            world.press("START")
            world.run(4000 + delay_ms)
            world.press("ADDRESS_UP")
            world.run(200)
        rows = said(world, 2_600)
        assert rows.get("RUN,HOLD=ALL: 5", 0) >= 600, (delay_ms, rows)
        world.press("PARAM")  # nor does a page that is new put it off
        together = said(world, 5_400)
        assert "RUN,HOLD=ALL: 5" in together, (delay_ms, together)
        world.check()


class Neighbour:
    """A drive that is not shown and does not stand quietly; it has nothing to tell."""

    def __init__(self):
        self.watched = 0

    def ask(self, now_us, reread_us):
        return False

    def is_quiet(self):
        return False

    def watch(self, now_us):
        self.watched += 1

    def keep_quiet(self):
        pass

    def is_active(self):
        return False


class Observed:
    """Stands for the panel and its announcer. slow: each step has taken long already."""

    def __init__(self, slow):
        self.slow = slow
        self.looked_at = []

    def has_taken(self, us):
        return self.slow

    def look(self, place):
        self.looked_at.append(place)


def test_a_drive_that_took_a_whole_step_to_watch_is_announced_in_the_next():
    for slow, steps in ((False, 2), (True, 3)):
        controls, observed = [Neighbour() for _ in range(3)], Observed(slow)
        neighbours = Neighbours(controls, observed, observed)
        neighbours.show(0)
        for step in range(1, 4 * steps + 1):
            neighbours.step(0)
            assert len(observed.looked_at) == step // steps, (slow, step, observed.looked_at)
        assert sorted(observed.looked_at) == [1, 1, 2, 2], (slow, observed.looked_at)
        assert [control.watched for control in controls] == [0, 2, 2], slow


# --- warnings ------------------------------------------------------------------------------------


def test_a_warning_and_its_number_are_shown_at_standstill_and_while_it_runs():
    world = panel()
    for state in ("READY        A1", "RUNNING      A1"):
        world.drives[1].warn(501, True)
        world.run(500)
        rows = said(world, 6_000)
        assert set(rows) == {state, "WARN A0501   A1"}, rows
        assert min(rows.values()) >= 2_000, rows
        world.drives[1].warn(501, False)
        world.run(500)
        assert set(said(world, 4_000)) == {state}
        world.press("START")
        world.run(4_000)
    world.check()


def test_a_fault_has_its_row_to_itself_though_the_drive_warns_as_well():
    world = running()
    world.drives[1].warn(501, True)
    world.run(1500)
    assert [row for row in said(world, 4000) if "A0501" in row], world.lcd()
    world.drives[1].fault(1)
    world.run(1500)
    assert set(said(world, 5000)) == {"FAULT F0001  A1"}, world.lcd()
    world.drives[1].unplug()
    world.run(2000)
    assert row_2(world) == "NO CONTACT   A1", world.lcd()  # and no number of a fault behind it
    world.check()


def test_the_number_of_a_warning_that_is_followed_by_another_is_that_of_the_one_that_is_there():
    world = panel(addresses=(1, 2))
    world.drives[1].warn(501, True)
    world.drives[2].warn(504, True)
    world.run(1_000)
    assert "WARN A0501   A1" in said(world, 4_000)
    world.drives[1].warn(502, True)
    world.drives[1].warn(501, False)
    world.run(1_000)
    assert set(said(world, 4_000)) == {"READY        A1", "WARN A0502   A1"}
    show(world, 2)
    world.run(1_000)
    assert set(said(world, 4_000)) == {"READY        A2", "WARN A0504   A2"}
    world.check()


def test_a_drive_that_does_not_tell_the_number_of_its_warning_is_not_given_that_of_another():
    world = panel(addresses=(1, 2))
    world.drives[1].warn(501, True)
    world.drives[2].warn(504, True)
    world.run(1_000)
    assert "WARN A0501   A1" in said(world, 4_000)
    world.drives[2].stale_replies = 10_000
    show(world, 2)
    world.run(1_000)
    rows = said(world, 4_000)
    assert "WARN         A2" in rows and "WARN A0501   A2" not in rows, rows


def test_a_drive_that_falls_silent_on_the_number_of_its_warning_is_not_asked_all_the_time():
    world = running()
    slave, asked = world.drives[1].slave, []
    hear = slave.hear

    def hear_selectively(burst):
        characters = bytes(burst.data[: burst.count])
        if characters[3:5] == b"\x10\x6e" and characters[5] & 0x80:  # r2110, read
            asked.append(burst.start_us)
            return None
        return hear(burst)

    slave.hear = hear_selectively
    world.drives[1].warn(501, True)
    rows = said(world, 9_000)
    assert set(rows) == {"RUNNING      A1", "WARN         A1"}, rows
    assert len(asked) == 3, asked  # and then it is withdrawn
    assert abs(world.drives[1].hz() - 10) < 0.1
    world.check()


# --- and the loop goes on ------------------------------------------------------------------------


def test_a_stop_of_all_takes_no_time_from_the_dead_man():
    """31 drives are told one after the other, a step of the loop each, a slow one here."""
    world = panel(addresses=tuple(range(1, 32)), baud=115200, **_runs_on(31))
    world.run(4_000)
    start(world, 1)
    board, bus = world.app.board, world.app.bus
    usual_idle = board.idle
    board.idle = lambda: (usual_idle(), world.clock.advance(4_000))
    for wait_ms in range(0, 40, 5):  # whatever the loop is at when it begins
        world.run(wait_ms)
        world.press("STOP", 4_500)
        world.run(500)
    assert bus.dead_man_trips == 0
    world.check()


def _runs_on(count):
    options = unsupervised(*range(1, count + 1))
    del options["addresses"]
    return options


# --- the announcer by itself: when it says what --------------------------------------------------


class Told:
    """What the announcer asks of a control and its drive. Nothing is the matter with it so far."""

    whole = False  # likewise of a page
    remark = notice = texts.NOTHING
    unconfirmed = lost_running = active = absence_known = False
    phase = IDLE
    contacts = 1
    zsw = number = shown_ms = 0
    digits = 4
    family = MM440

    def __init__(self, address, **trouble):
        self.drive = self.survey = self.fault = self.stop_watch = self.setpoint = self
        self.address = address
        self.trouble(**trouble)

    def trouble(self, **trouble):
        for name in trouble:
            setattr(self, name, trouble[name])

    def is_unheard(self):
        return not self.contacts

    def needs_attention(self):
        return self.lost_running or self.unconfirmed

    def runs(self):
        return self.zsw & pzd.ZSW_RUNNING != 0

    is_on = runs

    def is_below(self):
        return False

    def show(self, passed_ms):
        self.shown_ms += passed_ms


RUNS = {"zsw": pzd.ZSW_RUNNING}
TROUBLES = (  # the most dangerous first: what is said of drive 3, and of five
    ({"unconfirmed": True}, "A3 NOT STOPPED", "NOT STOPPED: 5"),
    ({"lost_running": True}, "A3 LOST,MAY RUN", "LOST,MAY RUN: 5"),
    (dict(RUNS, remark=texts.RUNS_LONG), "A3 P2014 LONG", "RUN, P2014 ?: 5"),
    (RUNS, "A3 RUN,HOLD=ALL", "RUN,HOLD=ALL: 5"),
    ({"active": True, "number": 11}, "A3 FAULT F0011", "DRIVES FAULT: 5"),
    ({"notice": texts.LINE_FAILED}, "A3 LINE FAILED", "DRIVES OFF: 5"),
    ({"contacts": 0}, "A3 MAY RUN", "MAY RUN: 5"),
)


class Teller:
    """An announcer that has the time, and a picture every `step_ms`; it has looked at all.

    The drive with the first of these addresses is shown, and its page tells what that does.
    """

    def __init__(self, *controls, step_ms=50):
        self.controls = [Told(1)] + list(controls)
        self.announcer = Announcer(self.controls, 0xFFFF)
        self.now_ms = 0xFF00  # the clock begins anew meanwhile
        self.step_ms = step_ms
        self.page = Told(0)
        self.told = True
        self.shown = 0

    def row(self):
        """What is said now; an empty row while it is the page's turn."""
        if self.announcer.kind == NOTHING:
            return ""
        screen = Screen()
        screen.put(1, 0, texts.ROW_WIDTH, b"x" * texts.ROW_WIDTH)  # of the page
        self.announcer.draw(screen, 1)
        return screen.rows()[1].rstrip()

    def step(self):
        for position in range(len(self.controls)):
            self.announcer.look(position)
        self.announcer.begin(self.shown, self.page, self.told, self.now_ms)
        self.now_ms = self.now_ms + self.step_ms & 0xFFFF

    def until(self, row):
        """Until this is said, within ten seconds; an empty row: until it is the page's turn."""
        for _ in range(10_000 // self.step_ms):
            if self.row() == row:
                return
            self.step()
        raise AssertionError("%r is not said, but %r" % (row, self.row()))

    def said(self, ms):
        """[(what is said, for how long)], one after the other: the last one is not over yet."""
        found = []
        for _ in range(0, ms, self.step_ms):
            self.step()
            row = self.row()
            if not found or found[-1][0] != row:
                found.append((row, 0))
            found[-1] = (row, found[-1][1] + self.step_ms)
        return found


def rows_said(teller, ms):
    """What is said in that time, in the order in which it is."""
    return [row for row, _ in teller.said(ms) if row]


def test_each_trouble_has_its_words_and_from_five_drives_on_a_shared_text():
    for trouble, alone, together in TROUBLES:
        rows = rows_said(Teller(Told(3, **trouble)), 8_000)
        assert rows[:2] == [alone, alone], rows
        if "contacts" not in trouble:
            four = Teller(*[Told(address, **trouble) for address in (3, 4, 5, 16)])
            rows = rows_said(four, 12_000)
            four = [alone.replace("A3", "A%d" % address) for address in (3, 4, 5, 16)]
            assert rows[:5] == four + four[:1], rows
        five = Teller(*[Told(address, **trouble) for address in (3, 4, 5, 6, 7)])
        rows = rows_said(five, 15_000)
        assert rows[:2] == [together, together], rows
    unheard = Teller(Told(3, contacts=0), Told(4, contacts=0))
    assert rows_said(unheard, 6_000)[:1] == ["MAY RUN: 2"]
    remarked = Teller(Told(16, remark=texts.RUNS_FOR_EVER, **RUNS))
    assert rows_said(remarked, 1_000) == ["A16 RUN, P2014=0"]
    tripped = Teller(*[Told(address, active=True) for address in range(2, 12)])
    assert rows_said(tripped, 2_000) == ["DRIVES FAULT: 10"]


def test_the_most_dangerous_trouble_is_said_first_and_then_all_in_turn():
    drives = [Told(3, **trouble) for trouble, _, _ in reversed(TROUBLES)]
    order = [alone for _, alone, _ in TROUBLES]
    assert rows_said(Teller(*drives), 16_000)[:8] == order + order[:1]
    two_of_each = [Told(at, **trouble) for trouble, _, _ in TROUBLES[:6] for at in (3, 4)]
    rows = rows_said(Teller(*two_of_each), 25_000)
    order = [row.replace("A3", "A%d" % at) for _, row, _ in TROUBLES[:6] for at in (3, 4)]
    assert rows[:13] == order + order[:1], rows


def test_after_many_that_share_a_text_a_drive_at_the_end_of_the_list_has_its_turn_as_well():
    many = [Told(2 + place, **RUNS) for place in range(5)]
    rows = rows_said(Teller(*many, Told(7, active=True, number=11)), 10_000)
    assert rows[:3] == ["RUN,HOLD=ALL: 5", "A7 FAULT F0011", "RUN,HOLD=ALL: 5"], rows


def test_an_announcement_has_1300_ms_and_the_page_what_the_round_leaves_it():
    """At least 600 ms, and no more than that where one of them is an alarm."""
    for count, trouble, page_ms in (
        (1, RUNS, 600), (4, RUNS, 600), (5, RUNS, 4_700), (2, {"contacts": 0}, 2_500),
        (30, {"contacts": 0}, 4_700), (5, {"active": True}, 600), (5, {"lost_running": True}, 600),
        (5, {"unconfirmed": True}, 600), (5, {"notice": texts.LINE_FAILED}, 4_700),
    ):  # fmt: skip
        teller = Teller(*[Told(2 + place, **trouble) for place in range(count)])
        lengths = [ms for _, ms in teller.said(15_000)][1:-1]
        assert lengths[:3] == [1_300, page_ms, 1_300], (count, trouble, lengths)
    # Two texts in a round; and one more of the drive shown, where its page does not tell.
    both = [Told(2 + place, **RUNS) for place in range(5)]
    both += [Told(7 + place, contacts=0) for place in range(5)]
    assert [ms for _, ms in Teller(*both).said(15_000)][1:4] == [1_300, 1_700, 1_300]
    notes = [Told(2 + place, notice=texts.LINE_FAILED) for place in range(5)]
    own = Teller(*notes)
    own.shown, own.told = 1, False
    own.said(20_000)
    rows = ["DRIVES OFF: 5", "", "A2 LINE FAILED", ""]
    found = [row for row in own.said(15_000) if row[1] in (1_300, 1_700)]
    assert {row for row, _ in found} == set(rows) and len(found) >= 8, found


def test_what_came_late_is_made_up_for():
    """A slow loop says as much in a minute; the page goes on as often."""
    for step_ms, most in ((50, 32), (300, 32)):
        teller = Teller(Told(2, **RUNS), step_ms=step_ms)
        assert len(rows_said(teller, 60_000)) == most, (step_ms, most)
        assert teller.announcer.page_turns == most - 1  # after each of them
        assert min([ms for row, ms in teller.said(20_000)[1:-1] if row]) >= 1_300
    # Half a second late and more: that counts anew.
    for step_ms, turns in ((50, 19), (400, 19), (1_000, 14)):
        teller = Teller(step_ms=step_ms)
        teller.said(30_000)
        assert teller.announcer.page_turns == turns, (step_ms, teller.announcer.page_turns)
    teller = Teller()  # the first turn is over a second and a half after the first picture
    turns = []
    for ms in (1_500, 50, 1_450, 50):
        teller.said(ms)
        turns.append(teller.announcer.page_turns)
    assert turns == [0, 1, 1, 2], turns


def test_a_turn_that_is_499_ms_late_shortens_the_next_and_one_of_500_does_not():
    for times, turns in (
        ((0, 1_499, 1_500, 2_999, 3_000), [0, 0, 1, 1, 2]),
        ((0, 1_999, 2_999, 3_000), [0, 1, 1, 2]),
        ((0, 2_000, 3_000, 3_499, 3_500), [0, 1, 1, 1, 2]),
    ):
        announcer, page = Announcer([Told(1)], 0xFFFF), Told(0)
        found = []
        for now_ms in times:
            announcer.begin(0, page, True, 0xFF00 + now_ms & 0xFFFF)
            found.append(announcer.page_turns)
        assert found == turns, (times, found)
    # And so with the page between two announcements of 1300 ms, which has 600.
    for late_ms, page_ms in ((0, 600), (499, 101), (500, 600)):
        teller = Teller(Told(2, **RUNS))
        teller.until("A2 RUN,HOLD=ALL")
        began_ms = teller.now_ms - teller.step_ms & 0xFFFF
        found = []
        for ms in (1_299, 1_300 + late_ms, late_ms + 1_300 + page_ms - 1, 0):
            teller.now_ms = began_ms + (ms or late_ms + 1_300 + page_ms) & 0xFFFF
            teller.step()
            found.append(teller.row() != "")
        assert found == [True, False, False, True], (late_ms, found)


def test_an_address_and_a_count_have_one_digit_up_to_nine_and_every_text_has_room():
    for address, trouble, row in (
        (9, {"active": True, "number": 11}, "A9 FAULT F0011"),
        (10, {"active": True, "number": 7}, "A10 FAULT F0007"),
        (9, {"notice": texts.DID_NOT_START}, "A9 NOT STARTED"),
        (10, {"notice": texts.STOPPED_ITSELF}, "A10 STOPPED SELF"),
        (9, dict(RUNS, remark=texts.RUNS_LONG), "A9 P2014 LONG"),
        (10, dict(RUNS, remark=texts.RUNS_LONG), "A10 P2014 LONG"),
        (10, {"lost_running": True}, "A10 LOST,MAY RUN"),
    ):  # fmt: skip
        rows = rows_said(Teller(Told(address, **trouble)), 1_000)
        assert rows == [row], rows
    for count, row in ((9, "DRIVES FAULT: 9"), (10, "DRIVES FAULT: 10")):
        tripped = [Told(2 + place, active=True) for place in range(count)]
        assert rows_said(Teller(*tripped), 1_000) == [row]


def test_a_page_that_has_come_has_a_turn_at_once_but_not_again_and_again():
    teller = Teller(*[Told(2 + place, **RUNS) for place in range(5)])
    teller.said(1_300 + 6_000)  # said, and the page has had most of its turn
    teller.until("")
    teller.said(4_500)
    assert not teller.row() and teller.announcer.page_turns > 0
    teller.page = Told(0)
    found = teller.said(50)
    assert teller.announcer.page_turns == 0
    found = teller.said(3_000)
    assert found[:2] == [("", 550), ("RUN,HOLD=ALL: 5", 1_300)], found
    quiet = Teller(*[Told(2 + place) for place in range(5)])
    quiet.said(10_000)
    for drive in quiet.controls[1:]:  # trouble comes with the page
        drive.trouble(**RUNS)
    quiet.page = Told(0)
    found = quiet.said(3_000)
    assert found[:2] == [("", 600), ("RUN,HOLD=ALL: 5", 1_300)], found
    found = []
    for _ in range(40):
        teller.page = Told(0)
        found += teller.said(300)
    assert len([row for row, _ in found if row]) >= 8, found


def test_the_drive_that_was_shown_before_has_the_next_announcement():
    """Its own page has told all of it so far."""
    controls = [Told(1, **RUNS), Told(2)]
    announcer, page = Announcer(controls, 0xFFFF), Told(0)
    for now_ms in range(0, 1_000, 50):
        announcer.begin(0, page, True, now_ms)
    for now_ms in range(1_000, 1_650, 50):
        assert announcer.kind == NOTHING
        announcer.begin(1, page, True, now_ms)
    assert announcer.kind != NOTHING and announcer.control is controls[0]


def test_a_drive_that_has_come_to_be_shown_waits_no_longer_than_its_turn():
    """Of those that share a text it is said by itself as well, so the page has less."""
    teller = Teller(*[Told(2 + place, notice=texts.LINE_FAILED) for place in range(5)])
    teller.told = False
    teller.until("DRIVES OFF: 5")
    teller.until("")
    teller.shown = 1
    assert teller.said(10_000)[0] in (("", 1_650), ("", 1_700))


def test_what_is_over_is_not_said_any_more():
    for trouble, alone, together in TROUBLES[:6]:
        over = {name: getattr(Told, name) for name in trouble}
        drive = Told(3, **trouble)
        teller = Teller(drive)
        teller.until(alone)
        drive.trouble(**over)
        teller.step()
        assert teller.row() == "" and rows_said(teller, 5_000) == [], alone
        drives = [Told(3 + place, **trouble) for place in range(5)]
        teller = Teller(*drives)
        teller.until(together)
        drives[4].trouble(**over)
        teller.step()
        assert teller.row() == "" and rows_said(teller, 3_000)[0] == alone, together


def test_what_its_page_tells_is_not_said_of_the_drive_shown():
    teller = Teller()
    shown = teller.controls[0]
    for trouble, _, _ in TROUBLES[:6]:
        shown.trouble(**trouble)
        assert rows_said(teller, 4_000) == [], trouble
        shown.trouble(**{name: getattr(Told, name) for name in trouble})
    # A page that tells the frequencies alone leaves these to be said.
    for trouble, alone, _ in TROUBLES[2:6]:
        teller.told = False
        shown.trouble(**trouble)
        rows = [] if "RUN," in alone else [alone.replace("A3", "A1")] * 2
        assert rows_said(teller, 4_000)[:2] == rows, trouble
        shown.trouble(**{name: getattr(Told, name) for name in trouble})
    # What was changed matters as long as it is on and runs.
    for is_on, zsw in ((True, 0), (False, pzd.ZSW_RUNNING)):
        shown.trouble(is_on=lambda on=is_on: on, zsw=zsw, remark=texts.RUNS_LONG)
        assert rows_said(teller, 4_000) == [], is_on
    shown.trouble(is_on=shown.runs, zsw=0, remark=texts.NOTHING)
    shown.trouble(notice=texts.LINE_FAILED, phase=ASKING)  # the question says why
    assert rows_said(teller, 4_000) == []
    shown.trouble(phase=JOGGING)  # which acknowledges nothing
    assert "A1 LINE FAILED" in rows_said(teller, 4_000)
    shown.trouble(notice=texts.NOTHING, phase=IDLE)
    # One that has both rows leaves all.
    for trouble, alone, _ in TROUBLES[:6]:
        teller.page = Told(0)
        teller.page.whole = True
        shown.trouble(**trouble)
        assert alone.replace("A3", "A1") in rows_said(teller, 4_000), trouble
        shown.trouble(**{name: getattr(Told, name) for name in trouble})


def test_stop_has_acknowledged_a_drive_that_was_never_heard():
    assert rows_said(Teller(Told(3, contacts=0, absence_known=True)), 5_000) == []
    # Nor is one that has not been silent for long yet, or that was in contact before.
    assert rows_said(Teller(Told(3, contacts=0, is_unheard=lambda: False)), 5_000) == []
    assert rows_said(Teller(Told(3, is_unheard=lambda: True)), 5_000) == []


def test_a_fault_counts_as_shown_as_long_as_it_stands_there():
    """In the announcement, or on the page of its drive; a shared text tells no number."""
    tripped = Told(3, active=True, number=11)
    teller = Teller(tripped)
    teller.until("A3 FAULT F0011")
    assert tripped.shown_ms == 0
    teller.said(1_300)
    assert not teller.row() and tripped.shown_ms == 1_300
    teller.said(400)
    assert tripped.shown_ms == 1_300 and teller.controls[0].shown_ms > 400
    many = [Told(3 + place, active=True) for place in range(5)]
    rows_said(Teller(*many), 10_000)
    assert [drive.shown_ms for drive in many] == [0] * 5


def test_a_drive_that_is_added_or_removed_moves_what_is_said_of_the_others():
    tripped = [Told(address, active=True, number=11) for address in (2, 3, 4)]
    teller = Teller(*tripped)
    assert not Teller().announcer.has_alarm()
    teller.until("A4 FAULT F0011")
    teller.controls.append(Told(9))
    teller.announcer.make_room()
    assert teller.row() == "" and teller.announcer.has_alarm()
    del teller.controls[2]
    teller.announcer.close_up(2)
    rows = rows_said(teller, 8_000)
    assert rows[:3] == ["A2 FAULT F0011", "A4 FAULT F0011", "A2 FAULT F0011"], rows
    for _ in range(2):
        teller.announcer.close_up(1)
        del teller.controls[1]
    assert not teller.announcer.has_alarm() and rows_said(teller, 4_000) == []


def test_a_drive_that_is_added_or_removed_begins_the_page_anew():
    teller = Teller()
    for is_added in (True, False):
        while teller.announcer.page_turns < 2:
            teller.step()
        if is_added:
            teller.controls.append(Told(9))
            teller.announcer.make_room()
        else:
            del teller.controls[1]
            teller.announcer.close_up(1)
        teller.step()
        assert teller.announcer.page_turns == 0, is_added


# --- the drives that are not shown: what is done with each in its turn ---------------------------


class Other:
    """A control that notes what is done with it. It has to be watched, and is at rest."""

    contact = True
    quiet = active = news = False

    def __init__(self, place, done):
        self.drive = self
        self.place, self.done = place, done

    def ask(self, now_us, reread_us):
        assert reread_us == 2_000_000
        self.done.append(("ask", self.place))
        news, self.news = self.news, False
        return news

    def watch(self, now_us):
        self.done.append(("watch", self.place))

    def keep_quiet(self):
        self.done.append(("keep quiet", self.place))

    def is_quiet(self):
        return self.quiet

    def is_active(self):
        return self.active


class Beside:
    """The neighbours of the first of so many drives; what is done in each step."""

    taken_us = 0  # by each step so far

    def __init__(self, count):
        self.done = []
        self.controls = [Other(place, self.done) for place in range(count)]
        self.neighbours = Neighbours(self.controls, self, self)

    def look(self, place):
        self.done.append(("look", place))

    def heed(self, control):
        self.done.append(("heed", control.place))

    def has_taken(self, us):
        return self.taken_us >= us

    def step(self):
        del self.done[:]
        self.neighbours.step(1)
        return list(self.done)

    def steps(self, count):
        return [self.step() for _ in range(count)]


def asked_of(place):
    return [[("ask", place)], [("watch", place), ("keep quiet", place), ("look", place)]]


def test_each_drive_that_is_not_shown_is_asked_and_then_watched():
    beside = Beside(4)
    for _ in range(2):
        for place in (1, 2, 3):
            assert beside.steps(2) == asked_of(place)
    beside.steps(2)
    beside.neighbours.show(2)  # the one that was shown is the next one
    assert beside.steps(2) == asked_of(0)
    assert beside.steps(2) == asked_of(1)
    assert beside.steps(2) == asked_of(3)
    assert beside.step() == [("ask", 0)]
    beside.neighbours.show(0)  # what was begun is not gone on with
    assert beside.steps(2) == asked_of(2)
    assert beside.steps(2) == asked_of(3)


def test_a_drive_that_has_told_something_is_asked_again_in_its_next_turn():
    beside = Beside(4)
    assert beside.steps(2) == asked_of(1)
    beside.controls[2].news = True
    assert beside.step() == [("ask", 2), ("heed", 2)]
    assert beside.steps(2) == asked_of(2)
    assert beside.steps(2) == asked_of(3)


def test_a_drive_with_nothing_new_has_one_step_and_is_heard_of_if_it_is_silent():
    beside = Beside(3)
    for control in beside.controls:
        control.quiet = True
    beside.controls[2].contact = False
    assert beside.steps(3) == [[("ask", 1)], [("ask", 2), ("look", 2)], [("ask", 1)]]
    beside.taken_us = 1_500  # that was enough for a step: the next one watches it
    assert beside.step() == [("ask", 2)]
    assert beside.step() == [("watch", 2), ("keep quiet", 2)]
    assert beside.step() == [("look", 2)]
    beside.taken_us = 1_499
    assert beside.steps(2) == [[("ask", 1)], [("ask", 2), ("look", 2)]]
    beside.controls[1].quiet = False
    assert beside.steps(2) == asked_of(1)


def test_a_watch_that_took_a_step_is_forgotten_with_the_drive_that_is_shown():
    beside = Beside(3)
    beside.taken_us = 1_500
    assert beside.steps(2) == [[("ask", 1)], [("watch", 1), ("keep quiet", 1)]]
    beside.neighbours.show(1)
    beside.taken_us = 0
    assert beside.steps(2) == asked_of(0)


def test_they_are_at_rest_when_each_of_them_was_found_so():
    for quiet in (False, True):
        beside = Beside(4)
        for control in beside.controls:
            control.quiet = quiet
        at_rest = []
        for _ in range(3):
            at_rest.append(beside.neighbours.are_at_rest())
            beside.steps(1 if quiet else 2)
        assert at_rest == [False] * 3 and beside.neighbours.are_at_rest(), quiet
        beside.controls[2].quiet, beside.controls[2].active = False, True
        for _ in range(10):
            beside.step()
            if beside.done[:1] == [("watch", 2)]:
                break
        for _ in range(12):
            assert not beside.neighbours.are_at_rest()
            beside.step()
        beside.controls[2].active = False
        beside.steps(7)
        assert beside.neighbours.are_at_rest()
        beside.neighbours.show(1)
        assert not beside.neighbours.are_at_rest()
    assert Beside(1).neighbours.are_at_rest()
    beside = Beside(2)
    assert not beside.neighbours.are_at_rest()
    beside.steps(2)
    assert beside.neighbours.are_at_rest()
    beside.neighbours.show(1)
    assert not beside.neighbours.are_at_rest()
