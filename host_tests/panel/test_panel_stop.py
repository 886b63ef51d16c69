# SPDX-License-Identifier: MIT
"""The operator's manual, STOP: it is always sent, repeated, and watched until the motor rests."""

import main
from boards.sim.world import World
from panel import texts
from panel.keys.stop_key import StopKey
from panel.stop_watch import StopWatch
from panel_bench import (
    LOOP_US,
    OFF1,
    all_running,
    panel,
    row_2,
    running,
    said,
    settled,
    settled_row_2,
    starts,
    telegrams,
    wait_until_known,
)  # fmt: skip
from uss import pzd


def test_a_stop_that_nobody_confirms_is_an_alarm():
    world = running()
    world.drives[1].unplug()
    world.press("STOP")
    world.run(700)
    assert row_2(world) != "STOP UNCONFIRMED"
    world.run(400)
    assert row_2(world) == "STOP UNCONFIRMED"
    world.drives[1].plug()
    world.run(500)
    assert row_2(world) == "STOPPING     A1"
    world.run(6000)
    assert row_2(world) == "READY        A1"
    world.check()


def test_a_stop_that_the_drive_does_not_obey_is_an_alarm():
    """Somebody has taken the drive away from this bus while it ran."""
    world = running()
    words = world.drives[1].process.words
    world.drives[1].process.words = lambda count: [0xFB34, 0x0CCD]  # it runs on and says so
    world.press("STOP")
    world.run(800)
    assert row_2(world) == "STOPPING     A1"
    world.run(300)
    assert row_2(world) == "STOP UNCONFIRMED"
    world.drives[1].process.words = words
    world.run(5000)
    assert row_2(world) == "READY        A1"
    world.check()


def test_an_off1_that_nobody_pressed_is_watched_as_well():
    """The dead man has sent it, and the drive does not obey."""
    world = running()
    world.drives[1].process.words = lambda count: [0xFB34, 0x0CCD]
    world.hang(1000)
    world.run(2500)
    assert row_2(world) == "STOP UNCONFIRMED"


def test_a_drive_that_was_heard_at_rest_after_its_last_on_needs_no_answer():
    """It stands still and answers; it is unplugged, STOP is pressed."""
    world = panel()
    world.drives[1].unplug()
    world.press("STOP")
    world.run(4_000)
    assert row_2(world) == "NO CONTACT   A1"
    world.check()


def test_one_that_was_started_since_then_does():
    world = running()
    world.press("STOP")
    world.run(8_000)
    world.press("START")
    world.run(1_000)
    world.drives[1].unplug()
    world.press("STOP")
    world.run(1_200)
    assert row_2(world) == "STOP UNCONFIRMED"
    world.check()


def test_so_does_one_that_was_never_heard():
    world = World(main.start)
    world.drives[1].unplug()
    world.run(2_000)
    world.press("STOP")
    world.run(700)
    assert row_2(world) == "NO CONTACT   A1"
    world.run(500)
    assert row_2(world) == "STOP UNCONFIRMED"
    world.check()


def test_a_long_list_is_no_reason_for_an_alarm():
    """Eight drives at 1200 baud: it takes seconds until a drive has told that it slows down."""
    addresses = (1, 2, 3, 4, 5, 6, 7, 8)
    world = panel(addresses=addresses, baud=1200)
    world.drives[1].write(1121, 0, 30.0)
    world.run(60_000)
    world.press("START")
    world.run(20_000)
    assert world.drives[1].state == "running"
    world.press("STOP")
    while world.drives[1].state == "stopping" or row_2(world) == "STOPPING     A1":
        world.run(100)
        assert row_2(world) != "STOP UNCONFIRMED"
    world.check()


def test_a_word_that_trembles_is_not_taken_for_a_motor_that_slows_down():
    world = running()
    count = [0]

    def trembling(wanted):
        count[0] += 1
        return [0xFB34, 0x0CCD - count[0] % 3]

    world.drives[1].process.words = trembling
    world.press("STOP")
    world.run(3500)
    assert row_2(world) == "STOP UNCONFIRMED"


def test_a_motor_that_slows_down_and_then_does_not_is_an_alarm():
    """Somebody has set the ramp to a standstill: 650 s."""
    world = running()
    world.press("STOP")
    world.run(500)
    assert row_2(world) == "STOPPING     A1"
    drive = world.drives[1]
    words = drive.process.words
    hiw = words(2)[1]
    drive.process.words = lambda wanted: [words(wanted)[0] | 4, hiw]
    world.run(2500)
    assert row_2(world) == "STOPPING     A1"
    world.run(1000)
    assert row_2(world) == "STOP UNCONFIRMED"


def test_a_motor_that_slows_down_and_falls_silent_is_an_alarm_before_contact_is_lost():
    world = running(settings={"lost_ms": 5000})
    world.press("STOP")
    world.run(500)  # it ramps down
    world.drives[1].unplug()
    world.run(2_000)
    assert not world.reads("STOP UNCONFIRMED")
    world.run(1_500)
    assert world.reads("STOP UNCONFIRMED"), world.lcd()


def test_the_slowest_ramp_of_a_drive_is_no_alarm():
    for p2000, p2009 in ((50.0, 0), (650.0, 0), (50.0, 1)):
        world = panel()
        world.drives[1].write(1121, 0, 650.0)
        world.drives[1].write(2000, 0, p2000)
        world.drives[1].write(2009, 0, p2009)
        world.run(3000)
        world.press("START")
        world.run(4000)
        world.press("STOP")
        for _ in range(200):
            world.run(100)
            assert row_2(world) == "STOPPING     A1", (p2000, p2009)
        world.check()


def test_stop_is_repeated_until_the_drive_hears_it():
    world = running()
    world.drives[1].unplug()
    world.press("STOP")
    world.run(3000)
    stws = [stw for _, stw in telegrams(world, world.clock.now_us - 2_900_000, 1)]
    assert len(stws) > 50 and set(stws) == {OFF1}
    world.drives[1].plug()
    world.run(8000)
    assert world.drives[1].hz() == 0
    world.check()


def test_stop_held_for_four_seconds_stops_all_drives():
    world = all_running((1, 2, 3), loop_us=LOOP_US)
    world.press("STOP", 3900)
    assert [world.drives[address].hz() > 9 for address in (1, 2, 3)] == [False, True, True]
    world.run(100)
    world.press("STOP", 4100)
    assert row_2(world) == "ALL DRIVES: STOP"
    world.run(8000)
    for address in (1, 2, 3):
        assert world.drives[address].hz() == 0
        assert starts(world, address) == 1
    world.check()


def test_those_that_run_are_stopped_first_and_then_all_once_more():
    world = panel(addresses=(1, 2, 3))
    for _ in range(2):
        world.press("ADDRESS_UP")
        wait_until_known(world)
        world.press("START")
    world.run(4_000)
    world.press("ADDRESS_UP")
    wait_until_known(world)
    states = [world.drives[address].state for address in (1, 2, 3)]
    assert states == ["ready", "running", "running"], states
    world.down("STOP")  # the first one is shown
    world.run(3_000)
    told = []
    for control in world.app.panel.controls:
        control.stop_unseen = lambda address=control.drive.address: told.append(address)
    world.run(1_200)
    assert told == [3, 2, 3, 2, 1], told


def test_a_stop_that_is_held_says_what_it_does_next_and_a_short_one_does_not():
    world = running(loop_us=LOOP_US)
    world.down("STOP")
    at_ms = 0
    for until_ms, text in (
        (280, "STOPPING     A1"), (400, "STOP, HOLD: OFF3"), (1_450, "STOP, HOLD: OFF3"),
        (1_600, "OFF3, HOLD: ALL"), (3_950, "OFF3, HOLD: ALL"), (4_100, "ALL DRIVES: STOP"),
    ):  # fmt: skip
        world.run(until_ms - at_ms)
        at_ms = until_ms
        assert row_2(world) == text, (at_ms, world.lcd())


def test_stop_pressed_again_and_again_does_not_put_the_alarm_off():
    world = running()
    world.drives[1].unplug()
    for _ in range(4):
        world.press("STOP", 100)
        world.run(170)
    assert row_2(world) == "STOP UNCONFIRMED"
    world.check()


def test_that_all_drives_were_stopped_is_said_after_stop_was_let_go():
    world = all_running((1, 2))
    world.press("STOP", 4200)
    world.run(1500)
    assert row_2(world) == "ALL DRIVES: STOP"
    world.run(2000)
    assert row_2(world)[13:] == "A1"
    world.check()


def test_a_stop_that_nobody_confirms_is_seen_while_stop_is_held():
    world = running()
    world.drives[1].unplug()
    world.down("STOP")
    world.run(1300)
    assert world.lcd() == ("STOP UNCONFIRMED", "STOP, HOLD: OFF3")
    world.check()


def test_another_drive_is_announced_by_both_digits_of_its_address():
    world = all_running((1, 12))
    rows = set()
    for _ in range(80):
        world.run(40)
        rows.add(settled(world)[1].rstrip())
    assert rows == {"RUNNING      A1", "A12 RUN,HOLD=ALL"}, rows
    world.check()


# --- a drive that sends something else as its status word ----------------------------------------

NOTHING, SPEED, WORD_20, STATUS = 0, 0x00150000, 0x00140000, 0x00340000  # for P2019[0]
ALWAYS_ON = 0x10000  # for P0840: 1:0, so that OFF1 is not obeyed


def rows_until(world, text, ms):
    """What row 2 says until it says this."""
    rows = []
    for _ in range(ms // 20):
        rows.append(settled_row_2(world))
        if rows[-1] == text:
            return rows
        world.run(20)
    raise AssertionError((text, set(rows)))


def test_a_drive_that_sends_no_status_word_confirms_no_stop():
    for source in (NOTHING, SPEED, WORD_20):
        world = running(parameters={2014: 2000})
        world.drives[1].write(2019, 0, source)
        world.drives[1].write(840, 0, ALWAYS_ON)
        world.press("STOP")
        rows_until(world, "STOP UNCONFIRMED", 6000)
        assert world.drives[1].state == "running", world.drives[1].report()
        world.run(2000)
        rows = said(world, 5000)
        assert "STOP UNCONFIRMED" in rows and not any("FAULT" in row for row in rows), rows
        world.drives[1].write(840, 0, 0x07F40000)
        world.drives[1].write(2019, 0, STATUS)  # now it tells that it stands
        world.run(8000)
        assert "STOP UNCONFIRMED" not in said(world, 5000), world.lcd()
        assert world.drives[1].hz() == 0
        world.check()


def test_a_drive_that_has_told_for_long_that_it_stands_is_not_doubted_later():
    """In forty seconds what each drive sends has been read again: until then it is doubted."""
    for rest_ms, is_doubted in ((5_000, True), (42_000, False)):
        world = running(parameters={2014: 2000})
        world.press("STOP")
        world.run(rest_ms)
        world.drives[1].write(2019, 0, NOTHING)
        rows = said(world, 5000)
        assert "P2019[0] ??? A1" in rows and ("STOP UNCONFIRMED" in rows) == is_doubted, rows
        world.check()


def test_a_drive_that_sends_no_status_word_may_run_when_it_is_lost():
    for source in (NOTHING, SPEED):
        world = panel()
        wait_until_known(world)
        world.drives[1].write(2019, 0, source)
        rows_until(world, "P2019[0] ??? A1", 6000)
        world.drives[1].unplug()
        world.run(3000)
        assert settled(world)[0].startswith("NO CONTACT,"), world.lcd()
        assert "MAY RUN" in settled(world)[1], world.lcd()
        world.check()


def test_a_drive_not_shown_that_sends_no_status_word_confirms_no_stop():
    """It is asked seldom: the alarm comes once the panel has read P2019[0]."""
    world = all_running((1, 2))
    world.drives[1].write(2019, 0, NOTHING)
    world.drives[1].write(840, 0, ALWAYS_ON)
    world.press("STOP", 100)
    world.press("ADDRESS_UP")
    world.run(40_000)
    assert world.drives[1].state == "running"
    rows = said(world, 8000)
    assert any(row == "A1 NOT STOPPED" for row in rows), rows
    world.check()


def test_the_second_stop_is_not_weakened_without_a_status_word():
    world = running(parameters={2014: 2000, 1135: 20.0})
    world.drives[1].write(2019, 0, NOTHING)
    rows_until(world, "P2019[0] ??? A1", 15_000)
    world.press("STOP", 1700)
    world.run(3000)
    assert {stw for _, stw in telegrams(world, world.clock.now_us - 1_000_000, 1)} == {0x047A}
    world.check()


# --- the watch by itself: to the millisecond -----------------------------------------------------


class Told:
    """What the watch asks of a drive, which turns at 1000 steps of HIW and answers each OFF1."""

    contact = tells_status = True
    contacts = 1
    silent = 0
    rests = False

    def __init__(self, hiw=1000):
        self.hiw = hiw
        self.off_answers = 0xFFFE  # its counter begins anew meanwhile

    def state(self):
        return pzd.READY if self.rests else pzd.RUNNING

    def may_run(self):
        return not self.rests

    def answer(self, times=3):
        self.off_answers = self.off_answers + times & 0xFFFF


class Stopped:
    """A drive that was stopped now, and is watched."""

    def __init__(self, **told):
        self.drive = Told(told.pop("hiw", 1000))
        for name in told:
            setattr(self.drive, name, told[name])
        self.now_us = 0xF00000  # and so does the clock
        self.watch = StopWatch(self.drive, 0xFFFFFF)
        self.after(0)

    def after(self, ms):
        self.now_us = self.now_us + ms * 1000 & 0xFFFFFF
        self.watch.step(self.now_us)
        return self.watch.active, self.watch.unconfirmed


GOES_ON, ALARM, OVER = (True, False), (True, True), (False, False)


def test_a_stop_has_a_second_to_show():
    for answers, silent in ((0, 0), (0, 3), (3, 0), (1, 3), (2, 3)):
        stopped = Stopped(silent=silent)
        stopped.drive.answer(answers)
        assert stopped.after(999) == GOES_ON and stopped.after(1) == ALARM, (answers, silent)
        stopped.drive.answer()
        stopped.drive.rests = True
        assert stopped.after(10) == OVER and stopped.after(5_000) == OVER
    for answers, silent in ((1, 0), (2, 0), (2, 2)):  # others are asked as well: that takes long
        stopped = Stopped(silent=silent)
        stopped.drive.answer(answers)
        assert stopped.after(2_000) == GOES_ON, (answers, silent)
        stopped.drive.answer(3 - answers)
        assert stopped.after(10) == ALARM


def test_what_was_heard_before_the_stop_confirms_nothing():
    stopped = Stopped(rests=True)
    assert stopped.after(900) == GOES_ON
    stopped.drive.answer(1)
    assert stopped.after(10) == OVER
    stopped.watch.begin()
    assert stopped.after(0) == GOES_ON and stopped.after(900) == GOES_ON


def test_a_drive_out_of_contact_needs_to_have_been_heard_at_rest():
    for contacts, rests, outcome in ((1, True, OVER), (1, False, ALARM), (0, True, ALARM)):
        stopped = Stopped(contact=False, contacts=contacts, rests=rests, silent=9)
        assert stopped.after(999) == GOES_ON and stopped.after(1) == outcome, (contacts, rests)


def test_words_that_are_no_status_confirm_nothing():
    stopped = Stopped(tells_status=False)
    stopped.drive.rests = True
    stopped.drive.may_run = lambda: True
    stopped.drive.answer()
    assert stopped.after(999) == GOES_ON and stopped.after(1) == ALARM


def test_who_slows_down_by_four_steps_in_three_seconds_obeys():
    for sign in (1, -1):
        stopped = Stopped(hiw=sign * 1000 & 0xFFFF)
        stopped.drive.answer()
        stopped.after(10)
        for speed in (996, 992, 900, 896):
            stopped.drive.answer()
            stopped.drive.hiw = sign * speed & 0xFFFF
            assert stopped.after(990 if speed == 996 else 2_990) == GOES_ON, speed
        assert stopped.after(4_000) == GOES_ON  # what was not heard is not judged by
        stopped.drive.answer()
        stopped.drive.hiw = sign * 892 & 0xFFFF
        assert stopped.after(0) == GOES_ON
        for wait_ms, speed, outcome in ((1_500, 892, GOES_ON), (1_499, 889, GOES_ON),
                                        (1, 889, ALARM)):  # fmt: skip
            stopped.drive.answer()
            stopped.drive.hiw = sign * speed & 0xFFFF  # three steps are none
            assert stopped.after(wait_ms) == outcome
        stopped.drive.answer()
        stopped.drive.hiw = sign * 888 & 0xFFFF
        assert stopped.after(10) == GOES_ON  # it does all the same
        stopped.drive.answer(2)
        assert stopped.after(4_000) == GOES_ON  # nobody knows yet
        stopped.drive.silent = 3
        assert stopped.after(10) == ALARM


def test_who_seems_to_slow_down_has_three_seconds_as_long_as_it_seems_so():
    for back, outcome in ((997, GOES_ON), (1000, ALARM), (1001, ALARM)):
        stopped = Stopped()
        for hiw in (1000, 997):
            stopped.drive.answer()
            stopped.drive.hiw = hiw
            stopped.after(10)
        stopped.drive.hiw = 997
        stopped.drive.answer()
        assert stopped.after(1_500) == GOES_ON
        stopped.drive.hiw = back
        stopped.drive.answer()
        assert stopped.after(10) == outcome, back
        assert stopped.after(1_480) == ALARM


def test_a_watch_that_has_ended_says_nothing():
    stopped = Stopped()
    stopped.drive.answer()
    assert stopped.after(1_000) == ALARM
    stopped.watch.end()
    assert stopped.after(5_000) == OVER
    stopped.watch.begin()
    assert stopped.after(0) == GOES_ON and stopped.after(1_000) == ALARM


# --- the STOP key by itself: to the millisecond --------------------------------------------------


class Commanded:
    """A control that notes what it is told."""

    def __init__(self, active=False):
        self.active = active
        self.told = []

    def is_active(self):
        return self.active

    def stop(self):
        self.told.append("stop")

    def second_stop(self):
        self.told.append("second")

    def stop_unseen(self):
        self.told.append("unseen")


class Held:
    """The key of a panel with three drives, the second of which is shown."""

    BIT = 4
    down = pressed = 0

    def __init__(self, second_stop="OFF3"):
        self.controls = [Commanded(), Commanded(), Commanded(True)]
        self.said = []
        self.key = StopKey(self.BIT, self.controls, second_stop, 0xFFFF, self.say)
        self.now_ms = 0xFFFF - 700  # the clock begins anew meanwhile

    def say(self, now_ms, text):
        self.said.append((now_ms, text))

    def step(self, ms=0, down=None, pressed=0, shown=1):
        """What the display is to say, and whether nothing may start."""
        self.now_ms = self.now_ms + ms & 0xFFFF
        self.down = self.down if down is None else down
        self.pressed = pressed
        self.key.step(self, self.controls[shown], self.now_ms)
        return self.key.text, self.key.is_down

    def press(self):
        return self.step(0, 7, self.BIT)  # other keys may be down as well

    def told(self):
        return [control.told for control in self.controls]


def test_a_stop_that_is_held_sends_the_second_stop_after_1500_ms_and_stops_all_after_4000():
    for second_stop, before, after in (
        ("OFF3", texts.HOLD_FOR_OFF3, texts.OFF3_HOLD_FOR_ALL),
        ("OFF2", texts.HOLD_FOR_OFF2, texts.OFF2_HOLD_FOR_ALL),
        ("none", texts.HOLD_FOR_ALL, texts.HOLD_FOR_ALL),
    ):
        held = Held(second_stop)
        assert held.press() == (texts.NOTHING, True) and held.told() == [[], ["stop"], []]
        for ms, text in ((299, texts.NOTHING), (1, before), (1_199, before)):
            assert held.step(ms) == (text, True) and held.told()[1] == ["stop"]
        # It is for the drive that was shown when the key went down.
        for ms, text in ((1, after), (2_499, after)):
            assert held.step(ms, shown=0) == (text, True)
            assert held.told() == [[], ["stop", "second"], []]
        assert held.key.left == 0 and held.said == []
        for ms in (1, 10, 3_000):
            assert held.step(ms) == (texts.ALL_STOPPED, True)
            assert held.key.left == 6 and len(held.said) == 1
        assert held.said[0][1] == texts.ALL_STOPPED
        assert held.step(10, 3) == (texts.NOTHING, False)
        assert held.told() == [[], ["stop", "second"], []]


def test_a_slow_step_leaves_nothing_out_of_what_a_held_stop_does():
    held = Held()
    held.press()
    assert held.step(4_000) == (texts.ALL_STOPPED, True)
    assert held.told()[1] == ["stop", "second"] and held.key.left == 6


def test_each_press_of_stop_begins_anew():
    held = Held()
    for _ in range(2):
        held.press()
        held.step(1_499)
        assert held.step(1, 0) == (texts.NOTHING, False)
    held.press()
    held.step(1_000)
    held.press()  # it went up and down in one step
    assert held.step(1_499)[0] == texts.HOLD_FOR_OFF3
    assert held.told()[1] == ["stop"] * 4


def test_a_stop_that_was_down_at_power_on_sends_nothing_and_forbids_to_start():
    held = Held()
    for ms in (0, 1_500, 4_000, 9_000):
        assert held.step(ms, held.BIT) == (texts.STOP_IS_DOWN, True)
    assert held.told() == [[], [], []] and held.key.left == 0
    assert held.step(9, 0) == (texts.NOTHING, False)
    assert held.step(9, 3) == (texts.NOTHING, False)  # other keys
    held.press()
    assert held.told() == [[], ["stop"], []]


def test_of_all_drives_those_that_run_are_stopped_first_and_then_each():
    held = Held()
    held.press()
    held.step(4_000)
    held.key.stop_next()
    assert [told[-1:] for told in held.told()] == [[], ["second"], ["unseen"]]
    for _ in range(2):  # these do not run
        held.key.stop_next()
    assert [told.count("unseen") for told in held.told()] == [0, 0, 1] and held.key.left == 3
    for counts in ([0, 0, 2], [0, 1, 2], [1, 1, 2]):
        held.key.stop_next()
        assert [told.count("unseen") for told in held.told()] == counts
    assert held.key.left == 0


def test_a_stop_that_is_down_again_without_a_press_does_not_go_on_with_the_last_one():
    """Such as one that could not be told in between: it has to be pressed to send anything."""
    for held_ms in (100, 2_000, 5_000):
        held = Held()
        held.press()
        held.step(held_ms)
        told = [list(one) for one in held.told()]
        held.step(10, 0)
        for ms in (1, 1_500, 4_000):
            assert held.step(ms, held.BIT) == (texts.STOP_IS_DOWN, True)
        assert held.told() == told, held_ms
