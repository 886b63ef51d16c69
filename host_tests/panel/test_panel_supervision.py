# SPDX-License-Identifier: MIT
"""The operator's manual, P2014 = 0: a drive that would run on when the panel dies is not run
without its operator's word.
"""

import json

from panel import risks, texts
from panel.keys import NAMES, Acts, Keys
from panel.pages.risk import RiskQuestion
from panel.phases import ASKING, CHECKING, IDLE, JOGGING, RUNNING
from panel.screen import Screen
from panel.supervision import longest_off_time_ms, off_time_ms
from panel_bench import (
    LOOP_US,
    ON,
    page_back,
    panel,
    row_1,
    row_2,
    settled,
    settled_row_2,
    starts,
    telegrams,
    unsupervised,
    wait_until,
    wait_until_known,
)  # fmt: skip
from uss.families import GENERIC, MM3, MM440, rows

OFF3 = 0x047A
ASKED = "SET=FIX START=GO"
OTHER_KEYS = ("STOP", "REVERSE", "JOG_RIGHT", "JOG_LEFT", "UP", "DOWN", "ADDRESS_UP",
              "ADDRESS_DOWN", "PARAM", "NEXT", "PREVIOUS", "EDIT")  # fmt: skip


def unset(**options):
    """A panel whose drives have P2014 = 0, as delivered."""
    return panel(parameters={2014: 0}, **options)


def asked(**options):
    """The same, START pressed, the question on the display."""
    world = unset(**options)
    world.press("START")
    wait_for(world, ASKED)
    world.run(1200)  # time to read it
    return world


def wait_for(world, text, ms=9000):
    """Let time pass until row 2 begins with a text."""
    for _ in range(ms // 20):
        if row_2(world).startswith(text):
            return
        world.run(20)
    raise AssertionError("%r does not come: %r" % (text, world.lcd()))


def accepted(world):
    return json.loads(world.flash.files["settings.json"]).get("unsupervised", [])


def test_jog_is_refused():
    for key in ("JOG_RIGHT", "JOG_LEFT"):
        world = unset()
        world.press(key, 1000)
        assert row_2(world) == "NO JOG: P2014=0"
        world.run(1000)
        assert starts(world) == 0
        world.check()


def test_start_asks():
    world = unset()
    world.press("START")
    wait_for(world, ASKED, 1000)
    assert row_1(world) == "P2014=0: IT RUNS"
    world.run(1600)
    assert world.lcd() == ("ON IF PANEL DIES", ASKED)
    world.run(1500)
    assert world.lcd() == ("P2014=0: IT RUNS", ASKED)
    world.run(8000)
    assert row_2(world) == ASKED and starts(world) == 0
    assert ON not in [stw for _, stw in telegrams(world, 0)]
    world.check()


def test_a_supervised_drive_is_started_without_a_question():
    world = panel(parameters={2014: 500})
    world.press("START")
    for _ in range(60):
        world.run(20)
        assert row_2(world) != ASKED
    assert starts(world) == 1
    world.check()


def test_start_asks_in_parameter_mode_too():
    world = unset(loop_us=LOOP_US)
    world.press("PARAM")
    world.press("START")
    wait_for(world, ASKED, 1000)
    world.press("PARAM")
    assert row_2(world) == "P0700:     5 A1" and starts(world) == 0
    world.check()


def test_set_has_the_drive_supervised_and_does_not_start_it():
    world = asked()
    world.press("SET")
    wait_for(world, "WRITTEN (RAM)", 1000)
    assert world.drives[1].read(2014) == 1000
    world.run(4000)
    assert starts(world) == 0 and accepted(world) == []
    world.press("START")
    world.run(3000)
    assert world.drives[1].state == "running" and row_2(world) == "RUNNING      A1"
    world.check()


def test_set_that_is_held_does_not_write_the_eeprom():
    """The question says nothing of it."""
    world = asked()
    world.press("SET", 4000)
    world.run(500)
    world.drives[1].power_off()
    world.drives[1].power_on()
    assert world.drives[1].read(2014) == 0
    world.check()


def test_the_time_written_is_three_rounds_of_the_bus_and_a_second_at_least():
    """Telegram, reply time-out, reply that takes as long as it may: all of it three times."""
    for baud, drives, reply_timeout_ms in ((19200, 1, 20), (57600, 3, 20), (9600, 31, 20),
                                           (9600, 31, 60), (2400, 8, 20)):  # fmt: skip
        settings = {"reply_timeout_ms": reply_timeout_ms}
        world = unset(addresses=tuple(range(1, drives + 1)), baud=baud, settings=settings)
        telegram_ms = 16 * 11_000 / baud
        rounds_ms = 3 * drives * (2.5 * telegram_ms + reply_timeout_ms)
        world.press("ADDRESS_DOWN")
        wait_for(world, "READY        A%d" % drives, 60_000)
        world.press("START")
        wait_for(world, ASKED, 60_000)
        world.run(1200)
        world.press("SET")
        wait_for(world, "WRITTEN (RAM)", 10_000)
        off_ms = world.drives[drives].read(2014)
        assert max(1000, rounds_ms - 100) <= off_ms <= max(1000, 1.1 * rounds_ms + 200), (
            baud, drives, off_ms, rounds_ms)  # fmt: skip
        assert world.drives[1].read(2014) == (off_ms if drives == 1 else 0)
        world.check()


def test_a_drive_that_was_set_stops_when_the_panel_dies():
    world = asked()
    world.press("SET")
    world.run(500)
    world.press("START")
    world.run(4000)
    assert world.drives[1].state == "running"
    world.drives[1].unplug()
    world.run(1500)
    assert world.drives[1].state == "fault"
    world.check()


def test_a_refusal_of_the_drive_is_told():
    for number, value, text in ((927, 7, "NO WRITE RIGHTS"), (3, 2, "P0003 TOO LOW")):
        world = asked()
        world.drives[1].write(number, 0, value)
        world.press("SET")
        wait_for(world, text, 1000)
        assert world.drives[1].read(2014) == 0 and starts(world) == 0
        if number == 3:  # the panel offers to raise it
            world.press("PARAM")
            world.run(500)
        world.press("START")
        wait_for(world, ASKED, 4000)
        world.check()


def test_start_accepts_and_starts():
    world = asked()
    world.press("START")
    world.run(3000)
    assert row_2(world) == "RUNNING      A1" and starts(world) == 1
    assert accepted(world) == [1] and world.drives[1].read(2014) == 0
    world.check()


def test_what_was_accepted_is_not_asked_again():
    """Not after a stop, not after a reset, and jogging is allowed as well."""
    world = asked()
    world.press("START")
    world.run(3000)
    world.press("STOP")
    world.run(5000)
    for _ in range(2):
        world.press("START")
        world.run(3000)
        assert row_2(world) == "RUNNING      A1"
        world.press("STOP")
        world.run(5000)
        world.press("JOG_LEFT", 2000)
        assert world.drives[1].hz() < 0
        world.run(4000)
        world.reset()
        world.run(1500)
    world.check()


def test_what_was_accepted_counts_for_that_drive_only():
    world = asked(addresses=(1, 2), loop_us=LOOP_US)
    world.press("START")
    world.run(3000)
    assert [starts(world, address) for address in (1, 2)] == [1, 0]
    world.press("ADDRESS_UP")
    world.press("JOG_RIGHT", 500)
    assert row_2(world) == "NO JOG: P2014=0"
    world.press("START")
    wait_for(world, ASKED)
    world.press("STOP")
    world.run(500)
    assert starts(world, 2) == 0 and accepted(world) == [1]
    world.check()


def test_what_was_accepted_before_stays_accepted():
    world = panel(**unsupervised(1, 2), loop_us=LOOP_US)
    world.drives[1].write(2014, 0, 0)
    world.press("START")
    world.run(3000)
    assert starts(world) == 1 and accepted(world) == [1, 2]
    world.check()


def test_what_was_accepted_stays_with_a_drive_that_moves():
    world = panel(**unsupervised())
    for key in ("PARAM", "NEXT", "NEXT", "EDIT", "UP", "SET", "SET"):
        world.run(300)
        world.press(key)
    world.run(300)
    page_back(world)
    world.run(500)
    assert row_2(world) == "READY        A2"
    world.press("START")
    world.run(3000)
    assert row_2(world) == "RUNNING      A2" and accepted(world) == [2]
    world.check()


def test_any_other_key_does_nothing_and_start_asks_again():
    for key in OTHER_KEYS:
        world = asked(addresses=(1, 2), loop_us=LOOP_US)
        world.press(key)
        world.run(2000)
        assert row_1(world) == "S: 10.0 F:  0.00", (key, world.lcd())
        assert row_2(world)[13:] == "A1" and row_2(world)[:5] in ("NOT S", "READY"), world.lcd()
        assert [starts(world, address) for address in (1, 2)] == [0, 0]
        assert world.drives[1].read(2014) == 0 and accepted(world) == []
        world.press("START")
        wait_for(world, ASKED, 1000)
        world.check()


def test_two_keys_at_once_are_no_answer():
    for other in ("SET", "UP", "STOP"):
        world = asked()
        world.down(other)
        world.press("START")
        world.up(other)
        world.run(3000)
        assert starts(world) == 0 and accepted(world) == [], other
        assert world.drives[1].read(2014) == 0
        world.check()


def test_a_start_that_is_held_is_no_second_start():
    world = unset()
    world.press("START", 8000)
    assert row_2(world) == ASKED and starts(world) == 0 and accepted(world) == []
    world.check()


def test_a_start_that_is_tapped_twice_accepts_nothing():
    """Nobody reads the question in half a second."""
    for pause_ms in (100, 200, 300, 400, 500):
        world = unset()
        world.press("START")
        world.run(pause_ms)
        world.press("START")
        world.run(2000)
        assert starts(world) == 0 and accepted(world) == [], pause_ms
        world.check()


def test_stop_answers_no_and_acts():
    world = asked()
    since_us = world.clock.now_us
    world.down("STOP")
    world.run(100)
    assert row_1(world) == "S: 10.0 F:  0.00"
    world.run(1300)
    assert row_2(world) == "STOP, HOLD: OFF3"
    world.run(300)
    assert row_2(world) == "OFF3, HOLD: ALL"
    assert OFF3 in [stw for _, stw in telegrams(world, since_us)]
    world.up("STOP")
    world.run(1000)
    assert row_2(world) == "READY        A1" and starts(world) == 0
    world.check()


def test_stop_that_is_pressed_while_the_drive_is_asked_takes_the_question_away():
    world = unset()
    world.press("START", 40)
    world.press("STOP")
    for _ in range(50):
        world.run(50)
        assert row_2(world) != ASKED
    world.check()


def test_another_drive_that_is_shown_meanwhile_is_not_asked_about():
    """Nor is a question put that nobody waits for any more, when the first one is shown again."""
    world = unset(addresses=(1, 2))
    world.run(2000)
    world.press("START", 40)
    world.press("ADDRESS_UP")
    for _ in range(60):
        world.run(50)
        assert settled(world)[1].rstrip() in ("READY        A2", "A1 NOT STARTED")
    world.press("ADDRESS_DOWN", 40)
    world.run(1500)
    assert row_2(world) == "NOT STARTED  A1"
    world.run(1000)
    assert row_2(world) == "NOT STARTED  A1"
    world.check()


def test_a_question_that_was_left_is_not_answered_by_the_next_start():
    """That START asks: the operator has not been told yet."""
    world = unset(addresses=(1, 2))
    world.press("START", 40)
    world.press("ADDRESS_UP")
    world.run(3000)
    world.press("ADDRESS_DOWN", 40)
    world.press("START")
    world.run(2000)
    assert row_2(world) == ASKED and starts(world) == 0 and accepted(world) == []
    world.check()


def test_nothing_is_accepted_while_stop_is_down():
    """STOP of another drive is held; this one's question comes up, and START beside STOP."""
    world = unset(addresses=(1, 2))
    world.press("START", 40)
    world.press("ADDRESS_UP")
    world.run(1000)
    world.down("STOP")
    world.run(100)
    world.press("ADDRESS_DOWN")
    world.run(100)
    world.press("START")
    world.run(1000)
    assert starts(world) == 0 and accepted(world) == []
    world.check()


def test_a_start_beside_a_stop_that_a_hang_has_swallowed_accepts_nothing():
    """STOP has not taken the question away yet when START is seen."""
    world = asked()
    world.down("START")
    world.app.step()
    world.down("STOP")
    for _ in range(100):
        if world.app.panel.stop_key.is_down:
            break
        world.app.step()
    world.hang(400)
    world.run(100)
    world.up("STOP")
    world.run(200)
    assert row_2(world) == "NO: STOP IS DOWN", world.lcd()
    world.run(1000)
    assert starts(world) == 0 and accepted(world) == []
    world.check()


def test_a_drive_that_was_started_after_another_is_the_one_that_is_asked_about():
    world = unset(addresses=(1, 2))
    world.run(2000)
    world.press("START", 40)
    world.press("ADDRESS_UP")
    world.press("START")
    wait_for(world, ASKED)
    world.run(1200)
    world.press("START")
    world.run(3000)
    assert [starts(world, address) for address in (1, 2)] == [0, 1]
    assert accepted(world) == [2]
    world.check()


def test_an_alarm_takes_the_question_away():
    world = asked()
    world.drives[1].process.words = lambda count: [0xFB34, 0x0CCD]
    for _ in range(300):
        world.run(20)
        if row_2(world) == "STOP UNCONFIRMED":
            break
    assert row_2(world) == "STOP UNCONFIRMED"
    world.press("START")
    world.run(500)
    assert accepted(world) == []


def test_a_question_of_a_drive_that_has_gone_silent_starts_nothing_later():
    world = asked()
    world.drives[1].unplug()
    world.run(2000)
    world.press("START")
    world.run(2000)
    world.drives[1].plug()
    world.run(5000)
    assert starts(world) == 0
    world.check()


def test_a_reset_forgets_the_question():
    world = asked()
    world.reset()
    world.run(3000)
    assert row_2(world) == "READY        A1" and accepted(world) == [] and starts(world) == 0
    world.press("SET")
    world.run(500)
    assert world.drives[1].read(2014) == 0
    world.check()


def test_a_drive_that_was_lost_is_looked_at_anew():
    """P2014 was put back to 0 at the drive while it was away."""
    world = panel(parameters={2014: 20_000})
    world.drives[1].unplug()
    world.run(2000)
    world.drives[1].write(2014, 0, 0)
    world.drives[1].plug()
    world.run(1000)
    world.press("START")
    wait_for(world, ASKED, 2000)
    world.check()


def test_the_last_moment_counts():
    """P2014 changed right before START: the drive is asked, not the memory."""
    for before, after in ((2000, 0), (0, 2000)):
        world = panel(parameters={2014: before})
        world.run(2000)
        world.drives[1].write(2014, 0, after)
        world.press("START")
        world.run(1500)
        assert (row_2(world) == ASKED) == (after == 0), world.lcd()
        assert starts(world) == (1 if after else 0)
        world.check()


def test_a_question_that_nobody_answers_goes_away():
    world = unset()
    world.press("START")
    wait_for(world, ASKED)
    world.run(29_000)
    assert row_2(world) == ASKED
    world.run(2_000)
    assert row_2(world) == "NOT STARTED  A1"
    world.press("START")
    world.run(500)
    assert starts(world) == 0
    world.check()


def test_the_time_that_is_offered_fits_the_bus():
    for cycle_us, offered_ms in (
        (0, 1000),
        (60_000, 1000),
        (400_000, 1300),
        (2_000_000, 6100),
        (21_000_000, 63_100),
        (60_000_000, 65_000),
    ):
        assert off_time_ms(cycle_us) == offered_ms, off_time_ms(cycle_us)


def test_a_drive_with_a_short_off_time_is_asked_more_often_than_the_list_has_it():
    """A round of 16 drives takes 0.8 s at 9600 baud; this one trips after 1.5 s."""
    world = panel(addresses=tuple(range(1, 17)), baud=9600, parameters={2014: 1_500, 1120: 1.0})
    world.run(8_000)
    world.press("START")
    world.run(4_000)
    since_us = world.clock.now_us
    world.run(4_000)
    instants = [at_us for at_us, stw in telegrams(world, since_us, 1)]
    gaps = [after - before for before, after in zip(instants, instants[1:])]
    assert max(gaps) < 500_000, gaps
    assert world.drives[1].state == "running"
    world.check()


def test_a_long_time_is_asked_about_with_its_seconds():
    """65535 ms: a motor would run on for more than a minute after its panel has died."""
    world = panel(parameters={2014: 65_535})
    wait_until_known(world)
    world.press("JOG_RIGHT", 1000)
    assert row_2(world) == "NO: P2014 LONG" and starts(world) == 0
    world.press("START")
    wait_for(world, ASKED)
    rows = set()
    for _ in range(50):
        world.run(100)
        rows.add(row_1(world))
    assert {"P2014=65535: IT", "RUNS ON 65.6 s", "IF PANEL DIES"} <= {row.strip() for row in rows}
    assert starts(world) == 0
    world.press("SET")
    wait_for(world, "WRITTEN (RAM)", 1000)
    assert world.drives[1].read(2014) == 1000 and starts(world) == 0
    world.press("START")
    world.run(2000)
    assert world.drives[1].state == "running"
    world.check()


def test_which_times_are_long():
    """More than 2 s, or than four rounds of the bus in which every answer comes late."""
    for drives, baud, p2014_ms, is_long in (
        (1, 19200, 2000, False),
        (1, 19200, 2001, True),
        (8, 4800, 2001, False),
        (8, 4800, 60_000, True),
    ):
        world = panel(
            addresses=tuple(range(1, drives + 1)), baud=baud, parameters={2014: p2014_ms}
        )
        wait_until_known(world)
        world.press("START")
        world.run(8000)
        assert (row_2(world) == ASKED) == is_long, (drives, p2014_ms, world.lcd())
        assert starts(world) == (0 if is_long else 1)
        world.check()


def test_a_long_time_is_accepted_as_it_is_and_until_the_panel_restarts():
    world = panel(parameters={2014: 10_000})
    wait_until_known(world)
    world.press("START")
    wait_for(world, ASKED)
    world.run(1200)
    world.press("START")
    world.run(3000)
    assert row_2(world) == "RUNNING      A1" and accepted(world) == []
    world.press("STOP")
    world.run(5000)
    world.press("START")
    world.run(2000)
    assert row_2(world) == "RUNNING      A1"
    world.press("STOP")
    world.run(5000)
    for p2014_ms in (10_001, 0):
        world.drives[1].write(2014, 0, p2014_ms)
        world.press("START")
        wait_for(world, ASKED)
        world.press("UP")
    world.drives[1].write(2014, 0, 10_000)
    world.reset()
    world.run(2000)
    world.press("START")
    wait_for(world, ASKED)
    world.check()


def test_who_accepted_that_it_runs_on_for_ever_accepts_any_time():
    world = panel(parameters={2014: 65_535}, settings={"unsupervised": [1]})
    wait_until_known(world)
    world.press("START")
    world.run(3000)
    assert row_2(world) == "RUNNING      A1"
    world.check()


def test_a_time_that_changes_while_it_runs_is_said():
    for p2014_ms, text in ((0, "RUN, P2014=0 A1"), (65_535, "P2014 LONG   A1")):
        world = panel(parameters={2014: 1000})
        wait_until_known(world)
        world.press("START")
        world.run(4000)
        world.drives[1].write(2014, 0, p2014_ms)
        world.run(6500)
        assert settled_row_2(world) == text and world.drives[1].state == "running"
        world.drives[1].write(2014, 0, 1500)
        world.run(6500)
        assert settled_row_2(world) == "RUNNING      A1"
        world.check()


def test_a_drive_that_has_just_been_selected_is_jogged_once_it_has_told_its_p2014():
    """What the panel knew of it may be old: the key has to be pressed again."""
    world = panel(addresses=(1, 2), loop_us=LOOP_US)
    world.run(40_000)
    world.drives[2].write(2014, 0, 0)
    world.run(10_000)
    world.press("ADDRESS_UP")
    world.down("JOG_LEFT")
    world.run(100)
    assert row_2(world) == "NO: STILL CHECKS"
    world.run(4000)
    assert starts(world, 2) == 0
    world.up("JOG_LEFT")
    world.run(100)
    world.press("JOG_LEFT", 500)
    assert row_2(world) == "NO JOG: P2014=0" and starts(world, 2) == 0
    world.check()


def test_a_jog_ends_when_its_drive_turns_out_to_be_unsupervised():
    world = panel()
    wait_until_known(world)
    world.run(1000)
    world.down("JOG_LEFT")
    world.run(1000)
    assert row_2(world) == "JOG LEFT     A1"
    world.drives[1].write(2014, 0, 0)
    world.run(8000)
    assert row_2(world) == "P2014=0      A1" and world.drives[1].hz() == 0
    world.up("JOG_LEFT")
    world.run(500)
    assert starts(world) == 1
    world.check()


def test_a_question_asks_about_what_is_and_not_about_what_was():
    world = panel(parameters={2014: 5000})
    wait_until_known(world)
    world.press("START")
    wait_for(world, ASKED)
    assert settled(world)[0].strip() == "P2014=5000: IT"
    world.drives[1].write(2014, 0, 7000)
    wait_until(world, lambda: row_1(world).strip() == "P2014=7000: IT", 4000)
    assert row_1(world).strip() == "P2014=7000: IT", world.lcd()
    world.drives[1].write(2014, 0, 0)
    for _ in range(200):
        world.run(20)
        if row_1(world) == "P2014=0: IT RUNS":
            break
    world.press("START")  # too soon to have read that
    world.run(500)
    assert row_2(world) == ASKED and starts(world) == 0
    world.drives[1].write(2014, 0, 1000)
    world.run(4000)
    assert row_2(world) == "NOT STARTED  A1" and accepted(world) == []
    world.press("START")
    world.run(3000)
    assert starts(world) == 1
    world.check()


def test_a_p2014_that_only_start_has_read_is_known_to_the_bus():
    """It decides how soon the drive is asked again while it runs."""
    world = panel(parameters={2014: 2000})
    wait_until_known(world)
    for p2014_ms in (1500, 1200, 1600, 1300):
        world.run(3000)
        world.drives[1].write(2014, 0, p2014_ms)
        world.press("START")
        world.run(3000)
        assert starts(world) and world.drives[1].state == "running"
        bus = world.app.bus
        assert bus.deadlines.bound_us(bus.turns.drives[0]) == p2014_ms * 1000 // 3, p2014_ms
        world.press("STOP")
        world.run(6000)
    world.check()


def test_a_start_is_asked_about_behind_the_question_of_a_parameter():
    """SET in the moment of START ended the panel: the risk of a START was looked up for a question
    that was not about it."""
    world = panel(addresses=(1, 2))
    wait_until_known(world)
    world.drives[2].write(2014, 0, 0)
    world.press("START")
    world.run(3000)
    world.press("ADDRESS_UP")
    world.run(1500)
    world.press("PARAM")
    world.run(800)
    for key, ms in (("EDIT", 200), ("UP", 200), ("START", 20), ("SET", 300)):
        world.press(key)
        world.run(ms)
    assert row_2(world) == "SET=DO  PARAM=NO"
    world.run(3000)
    assert row_2(world) == "SET=DO  PARAM=NO"  # nobody has answered it
    world.press("PARAM")
    world.run(500)
    assert row_2(world) == ASKED
    world.run(1000)
    world.press("START")
    world.run(3000)
    assert world.drives[2].state == "running"
    world.check()


# --- the risks by themselves ---------------------------------------------------------------------


class Told:
    """What the risks ask of a control, its desk and its drive."""

    pkw_words = 4
    longest_off_time_ms = 2_000
    address = 7
    late = None
    unsupervised = False

    def __init__(self, ms=1_000, restart=1, family=MM440):
        self.survey = self.desk = self.bus = self.deadlines = self.drive = self.layout = self
        self.ms, self.family = ms, family
        self.values = [-1] * rows.COUNT_OF_ROWS
        self.values[rows.SUPERVISION] = ms
        self.values[rows.RESTART] = restart
        self.accepted = {}

    def off_time_ms(self):
        return self.ms

    def first_late(self, drive):
        assert drive is self
        return self.late

    def accepts(self, row, value):
        return self.accepted.get(row) == value

    def accepts_unsupervised(self):
        return self.unsupervised


SUPERVISION, LATENESS, RESTART = range(3)


def open_risks(control):
    return [row for row in range(len(risks.RISKS)) if risks.is_open(control, row)]


def test_a_motor_may_run_on_for_two_seconds_or_four_rounds_of_the_bus():
    for cycle_us, longest_ms in ((1_000, 2_000), (498_999, 2_000), (500_000, 2_004),
                                 (999_999, 4_000), (1_000_000, 4_004)):  # fmt: skip
        assert longest_off_time_ms(cycle_us) == longest_ms, cycle_us


def test_a_risk_is_there_from_the_first_value_on_that_is_one():
    for ms, is_open, exposure_ms in (
        (1, False, 0), (2_000, False, 0), (2_001, True, 2_001), (65_535, True, 65_535),
    ):  # fmt: skip
        control = Told(ms)
        assert open_risks(control) == [SUPERVISION] * is_open, ms
        assert risks.exposure_ms(control) == exposure_ms
    assert open_risks(Told(0)) == [SUPERVISION]
    assert risks.exposure_ms(Told(0)) > 65_535 * 10  # for ever is longer than any P2014
    for restart, is_open in ((-1, False), (0, False), (1, False), (2, True), (6, True)):
        assert open_risks(Told(restart=restart)) == [RESTART] * is_open, restart
    control = Told()
    control.late = Told()
    assert open_risks(control) == [LATENESS] and risks.measure(control, LATENESS) == 7


def test_a_risk_that_was_taken_is_one_again_when_it_is_another():
    control = Told(5_000, 2)
    assert open_risks(control) == [SUPERVISION, RESTART]
    control.accepted = {SUPERVISION: 5_000, RESTART: 2}
    assert open_risks(control) == []
    control.ms, control.values[rows.RESTART] = 6_000, 3
    assert open_risks(control) == [SUPERVISION, RESTART]
    control.unsupervised = True  # and with it any P2014
    assert open_risks(control) == [RESTART]
    control.ms = 0
    assert open_risks(control) == [RESTART]


def test_a_question_has_the_values_of_its_risk():
    control = Told(2_301, 3)
    for ms, values in (
        (2_301, (2014, 2_301, 2, 4)), (2_300, (2014, 2_300, 2, 3)), (17_950, (2014, 17_950, 18, 0))
    ):  # fmt: skip
        told = risks.ask(Told(ms), SUPERVISION)
        assert told[2] and told[:2] + told[3:] == (texts.ASK_LONG, values, ms), told
    assert risks.ask(control, RESTART) == (texts.ASK_RESTART, (3,), False, 3)
    control.late = Told()
    assert risks.ask(control, LATENESS) == (texts.ASK_LATE, (7,), False, 7)
    told = risks.ask(Told(0), SUPERVISION)
    assert told[2] and told[:2] + told[3:] == (texts.ASK_UNSUPERVISED, (2014,), 0), told
    assert risks.ask(Told(0, family=MM3), SUPERVISION)[1] == (MM3.off_time_number,)
    # Without a parameter channel, or where nobody knows which it is, SET puts nothing right.
    for control in (Told(0), Told(5_000), Told(0, family=GENERIC)):
        if control.family is MM440:
            control.pkw_words = 0
        text, values, can_fix, value = risks.ask(control, SUPERVISION)
        assert (text, values, value) == (texts.ASK_UNTOLD, (), control.ms) and not can_fix


# --- the question by itself ----------------------------------------------------------------------


class Asked(Told):
    """What the question asks of its panel as well, whose keys and whose time the test has."""

    mask = 0xFFFF
    message = None
    page_turns = 0
    is_down = False
    must_supervise = False

    def __init__(self, ms=0, restart=1, risk=SUPERVISION, **panel):
        Told.__init__(self, ms, restart)
        for name in panel:
            setattr(self, name, panel[name])
        self.selected = self.stop_key = self.board = self.announcer = self
        self.phase, self.risk = ASKING, risk
        self.happened = []
        self.page = RiskQuestion(self)
        self.screen = Screen()

    def question(self):
        return self.risk

    def needs_attention(self):
        return False

    def drop_question(self):
        self.happened.append("dropped")

    def uncover(self):
        self.happened.append("gone")

    def cover(self, page):
        self.happened.append(page)

    def accept_risk(self, risk, value):
        self.happened.append(("accepted", risk, value))

    def say(self, _now_ms, text):
        self.happened.append(text)

    def write(self, _now_ms, control, *what):
        self.happened.append(what)

    def step(self, now_ms):
        self.happened.clear()
        self.page.step(None, now_ms)
        return self.happened

    def press(self, now_ms, key):
        keys = Keys(NAMES, self.mask)
        keys.pressed = keys.bit(key)
        self.happened.clear()
        self.page.take_keys(Acts(keys), now_ms)
        return self.happened

    def choice(self):
        self.page.draw(self.screen, 0)
        return self.screen.rows()[1].rstrip()


class Desk:
    """That of a drive: its telegram-off time on this bus."""

    longest_off_time_ms = 2_000

    def __init__(self, least_ms):
        self.off_time_ms = least_ms


GONE = ["dropped", "gone"]


def test_start_takes_a_risk_that_was_there_to_be_read_for_a_second():
    for risk, ms, restart, value in ((SUPERVISION, 0, 1, 0), (RESTART, 1_000, 3, 3)):
        control = Asked(ms, restart, risk)
        assert control.press(9, "START") == [] and control.step(10) == []
        assert control.press(1_009, "START") == []
        assert control.press(1_010, "START") == GONE + [("accepted", risk, value)]
    control = Asked()
    control.step(0)
    control.is_down = True
    assert control.press(1_000, "START") == GONE + [texts.REFUSED_STOP]
    control = Asked()
    control.step(0)
    assert control.press(5, "PARAM") == GONE


def test_set_writes_the_least_time_that_the_bus_bears_in_the_steps_of_the_drive():
    for family, least_ms, value in (
        (MM440, 1_000, 1_000), (MM440, 1_001, 1_001), (MM3, 1_000, 1), (MM3, 1_001, 2),
    ):  # fmt: skip
        control = Asked(family=family)
        control.desk = Desk(least_ms)
        control.step(0)
        assert control.choice() == "SET=FIX START=GO"
        what = (family.off_time_number, family.link_index, value)
        assert control.press(1_000, "SET") == GONE + [what]
    control = Asked(1_000, 3, RESTART)
    control.step(0)
    assert control.choice() == "START=GO STOP=NO"
    assert control.press(1_000, "SET") == GONE  # it puts nothing right there


def test_where_a_drive_must_be_supervised_start_takes_that_risk_never():
    for pkw_words, choice in ((4, "SET=FIX STOP=NO"), (0, "IT CANNOT START")):
        control = Asked(must_supervise=True, pkw_words=pkw_words)
        control.step(0)
        assert control.choice() == choice
        assert control.press(1_000, "START") == GONE + [texts.REFUSED_UNWATCHED]
    control = Asked(1_000, 3, RESTART, must_supervise=True)
    control.step(0)
    assert control.choice() == "START=GO STOP=NO"
    assert control.press(1_000, "START") == GONE + [("accepted", RESTART, 3)]


def test_a_question_goes_with_what_it_asks_about_and_is_asked_anew_about_another_value():
    control = Asked(5_000)
    assert control.step(0) == []
    control.ms = 6_000
    (page,) = control.step(10)
    assert page is not control.page and isinstance(page, RiskQuestion)
    control.ms = 5_000
    assert control.step(20) == []
    control.ms = 1_000
    assert control.step(30) == GONE
    control.ms = 5_000
    control.accepted = {SUPERVISION: 5_000}
    assert control.step(40) == GONE
    control.accepted = {}
    assert control.step(50) == []
    for control.phase in (IDLE, CHECKING, RUNNING, JOGGING):
        assert control.step(60) == GONE
    control.phase = ASKING
    assert control.step(29_999) == [] and control.step(30_000) == GONE
