# SPDX-License-Identifier: MIT
"""The operator's manual, JOG, REVERSE, a held STOP: a motor turns only as long as it should."""

from panel.keys import Keys
from panel.keys.jog_keys import JogKeys
from panel.phases import IDLE, JOGGING
from panel.reports.fault import Fault
from panel_bench import (
    LOOP_US,
    all_running,
    panel,
    row_1,
    row_2,
    running,
    starts,
    telegrams,
    unsupervised,
)  # fmt: skip
from uss import pkw, pzd
from uss.drive import Drive
from uss.families import MM4

FAULT_ZSW, READY_ZSW = 0xFB38, 0xFB31
ON, ON_REVERSE, OFF1, OFF2, OFF3 = 0x047F, 0x0C7F, 0x047E, 0x047C, 0x047A
JOG_RIGHT, JOG_LEFT = 0x057E, 0x067E


def words(world, since_us, address=1):
    """The control words sent to a drive since an instant, each run of the same ones as one."""
    changes = []
    for _, stw in telegrams(world, since_us, address):
        if not changes or changes[-1] != stw:
            changes.append(stw)
    return changes


# --- JOG -----------------------------------------------------------------------------------------


def test_jog_turns_while_the_key_is_held_and_no_longer():
    for key, stw, sign, text in (
        ("JOG_RIGHT", JOG_RIGHT, 1, "JOG RIGHT    A1"),
        ("JOG_LEFT", JOG_LEFT, -1, "JOG LEFT     A1"),
    ):
        world = panel(loop_us=LOOP_US)
        began_us = world.clock.now_us
        world.down(key)
        world.run(2000)
        assert row_2(world) == text and abs(world.drives[1].hz() - sign * 5) < 0.01
        world.up(key)
        world.run(300)
        assert row_2(world) == "STOPPING     A1"
        world.run(3000)
        assert row_2(world) == "READY        A1" and world.drives[1].hz() == 0
        assert words(world, began_us) == [OFF1, stw, OFF1]
        world.check()


def test_the_release_of_jog_is_in_the_next_telegram_of_the_line():
    world = panel(addresses=tuple(range(1, 9)))
    world.run(3000)
    world.down("JOG_RIGHT")
    world.run(1000)
    released_us = world.clock.now_us
    world.up("JOG_RIGHT")
    world.run(200)
    off_us = [at_us for at_us, stw in telegrams(world, released_us, 1) if stw == OFF1][0]
    assert off_us - released_us < 24_000 + 2 * 30_000, off_us - released_us
    world.check()


def test_two_jog_keys_at_once_mean_none_until_one_is_pressed_anew():
    world = panel(loop_us=LOOP_US)
    world.down("JOG_RIGHT")
    world.run(1000)
    world.down("JOG_LEFT")
    world.run(300)
    assert row_2(world) == "STOPPING     A1"
    world.up("JOG_RIGHT")
    world.run(300)
    assert row_2(world) == "STOPPING     A1"  # the other one has been held too long
    world.up("JOG_LEFT")
    world.run(60)
    world.down("JOG_LEFT")
    world.run(300)
    assert row_2(world) == "JOG LEFT     A1"
    world.up("JOG_LEFT")
    both_us = world.clock.now_us + 1_000_000
    world.run(1000)
    world.down("JOG_LEFT")
    world.down("JOG_RIGHT")
    world.run(300)
    assert words(world, both_us) == [OFF1]
    world.check()


def test_the_other_jog_key_may_follow_while_the_first_jog_ramps_down():
    world = panel(loop_us=LOOP_US)
    began_us = world.clock.now_us
    world.press("JOG_RIGHT", 1500)
    world.down("JOG_LEFT")
    world.run(2500)
    assert abs(world.drives[1].hz() + 5) < 0.01 and starts(world) == 1
    assert words(world, began_us) == [OFF1, JOG_RIGHT, OFF1, JOG_LEFT]
    world.check()


def test_jog_of_a_drive_that_runs_is_refused():
    world = running()
    began_us = world.clock.now_us
    world.press("JOG_LEFT", 500)
    assert row_2(world) == "NO JOG: IT RUNS"
    assert words(world, began_us) == [ON]
    world.press("STOP")
    world.press("JOG_LEFT", 500)  # it slows down from its run, not from a jog
    assert row_2(world) == "NO JOG: IT RUNS"
    assert words(world, began_us) == [ON, OFF1]
    world.check()


def test_jog_is_refused_where_start_is():
    world = panel()
    world.drives[1].fault(1)
    world.run(300)
    world.press("JOG_LEFT")
    assert row_2(world) == "NO: FAULT"
    world = panel()
    world.drives[1].write(700, 0, 2)
    world.run(3000)
    world.press("JOG_LEFT")
    assert row_2(world) == "NO:P0700 NOT USS"
    world = panel(**unsupervised())
    world.drives[1].unplug()
    world.run(1500)
    world.press("JOG_LEFT")
    assert row_2(world) == "NO: NO CONTACT"
    assert starts(world) == 0


def test_jog_needs_no_setpoint_from_the_bus():
    """P1000: the speed of a jog is the drive's own."""
    world = panel()
    world.drives[1].write(1000, 0, 2)
    world.run(3000)
    world.down("JOG_RIGHT")
    world.run(2000)
    assert abs(world.drives[1].hz() - 5) < 0.01
    world.up("JOG_RIGHT")
    world.run(100)
    assert words(world, 0)[-1] == OFF1
    world.check()


def test_stop_beats_jog_and_the_key_must_go_up_first():
    world = panel(loop_us=LOOP_US)
    world.down("JOG_RIGHT")
    world.run(1000)
    world.press("STOP")
    stopped_us = world.clock.now_us
    world.run(3000)
    assert world.drives[1].hz() == 0 and words(world, stopped_us) == [OFF1]
    world.up("JOG_RIGHT")
    world.down("STOP")
    world.run(100)
    world.down("JOG_RIGHT")
    world.run(100)
    assert row_2(world) == "NO: STOP IS DOWN" and words(world, stopped_us) == [OFF1]
    world.check()


def test_a_jog_that_was_ended_does_not_come_back_with_any_other_key():
    world = panel(loop_us=LOOP_US)
    world.run(2_000)
    for jog in ("JOG_RIGHT", "JOG_LEFT"):
        world.down(jog)
        world.run(1_000)
        assert world.drives[1].hz() != 0, world.lcd()
        for key in ("STOP", "UP", "DOWN", "REVERSE", "REVERSE", "NEXT", "PREVIOUS", "SET"):
            world.press(key)
            world.run(1_500 if key == "STOP" else 200)
            assert world.drives[1].hz() == 0, (jog, key, world.lcd())
        world.up(jog)
        world.run(200)
    world.check()


class Jogged:
    """A drive that notes what the jog keys do with it."""

    def __init__(self):
        self.phase, self.done = IDLE, []

    def jog(self, stw):
        self.phase = JOGGING
        self.done.append(stw)

    def end_jog(self):
        self.phase = IDLE
        self.done.append(None)


def test_whichever_jog_key_comes_first_on_a_board_right_is_right():
    for names in (("STOP", "JOG_RIGHT", "JOG_LEFT"), ("STOP", "JOG_LEFT", "JOG_RIGHT")):
        keys = Keys(names, (1 << 30) - 1)
        jogs = JogKeys(keys.bit("JOG_RIGHT"), keys.bit("JOG_LEFT"))
        drive = Jogged()
        for now_ms in range(400):
            raw = {1: keys.bit("JOG_RIGHT"), 3: keys.bit("JOG_LEFT")}.get(now_ms // 80, 0)
            keys.update(raw, now_ms)
            jogs.step(keys, drive, True)
        assert drive.done == [JOG_RIGHT, None, JOG_LEFT, None], (names, drive.done)


def test_start_while_jog_is_held_is_refused():
    world = panel(loop_us=LOOP_US)
    world.down("JOG_RIGHT")
    world.run(500)
    world.press("START")
    assert row_2(world) == "NO: JOG IS DOWN"
    world.press("REVERSE")
    assert row_2(world) == "NO: JOG IS DOWN" and row_1(world).startswith("S: 10.0")
    world.up("JOG_RIGHT")
    world.run(4000)
    assert ON not in words(world, 0)
    world.check()


def test_a_jog_ends_when_another_drive_is_shown():
    world = panel(addresses=(1, 2))
    world.down("JOG_RIGHT")
    world.run(1000)
    world.press("ADDRESS_UP")
    world.run(3000)
    assert world.drives[1].hz() == 0 and starts(world, 2) == 0
    assert row_2(world) == "READY        A2"
    world.check()


def test_a_loop_that_hangs_while_jogging_stops_the_motor_within_400_ms():
    for polled in (False, True):
        world = panel(polled=polled, loop_us=LOOP_US)
        world.down("JOG_LEFT")
        world.run(1500)
        hung_us = world.clock.now_us
        if polled:
            world.run(0)
        world.hang(1000)
        world.run(300)
        first_us = [at_us for at_us, stw in telegrams(world, hung_us, 1) if stw == OFF1][0]
        assert first_us - hung_us <= 400_000 or polled, first_us - hung_us
        world.run(3000)  # the key is still down
        assert world.drives[1].hz() == 0 and row_2(world) == "PANEL HUNG   A1"
        assert words(world, hung_us + 1_000_000)[-1] == OFF1
        world.check()


def test_a_jog_does_not_come_back_with_the_line():
    world = panel(**unsupervised(), loop_us=LOOP_US)
    world.down("JOG_LEFT")
    world.run(1500)
    world.drives[1].unplug()
    world.run(2000)
    assert world.reads("NO CONTACT, MAY RUN")
    plugged_us = world.clock.now_us
    world.drives[1].plug()
    world.run(5000)
    assert words(world, plugged_us) == [OFF1] and world.drives[1].hz() == 0
    world.check()


def test_a_jog_key_that_is_jammed_at_power_on_turns_nothing():
    world = panel()
    world.down("JOG_RIGHT")
    world.reset()
    world.run(4000)
    assert {stw for _, stw in telegrams(world, 0)} == {OFF1}
    world.check()


def test_a_jog_that_a_matrix_could_not_tell_for_a_moment_does_not_come_back():
    """Three keys at corners of a rectangle look like four."""
    world = panel(keys="matrix", loop_us=LOOP_US)
    world.down("JOG_RIGHT")
    world.down("DOWN")
    world.run(1000)
    assert row_2(world) == "JOG RIGHT    A1"
    world.press("PARAM", 300)
    ended_us = world.clock.now_us
    world.run(3000)
    assert words(world, ended_us) == [OFF1] and world.drives[1].hz() == 0
    world.check()


def test_a_jog_that_the_drive_does_not_obey_is_taken_back():
    """P0010 keeps it from running; it must not begin when somebody ends the commissioning."""
    world = panel()
    world.drives[1].write(10, 0, 1)
    world.run(300)
    world.down("JOG_RIGHT")
    world.run(5500)
    assert row_2(world) == "NOT STARTED  A1"
    world.drives[1].write(10, 0, 0)
    world.run(3000)
    assert starts(world) == 0
    world.check()


# --- REVERSE -------------------------------------------------------------------------------------


def test_reverse_is_a_preselection_while_the_motor_stands():
    world = panel()
    world.press("REVERSE")
    world.run(1000)
    assert row_1(world) == "S:-10.0 F:  0.00" and words(world, 0) == [OFF1]
    world.press("START")
    world.run(4000)
    assert row_1(world) == "S:-10.0 F:-10.00" and words(world, 0) == [OFF1, ON_REVERSE]
    world.check()


def test_reverse_takes_a_running_motor_through_zero():
    world = running()
    began_us = world.clock.now_us
    world.press("REVERSE")
    world.run(5000)
    assert row_1(world) == "S:-10.0 F:-10.00" and row_2(world) == "RUNNING      A1"
    assert words(world, began_us) == [ON, ON_REVERSE] and starts(world) == 1
    world.press("UP")  # up is faster, whichever way
    world.run(500)
    assert row_1(world) == "S:-10.1 F:-10.10"
    world.press("REVERSE")
    world.run(5000)
    assert row_1(world) == "S: 10.1 F: 10.10"
    world.check()


def test_the_direction_can_be_seen_at_a_setpoint_of_zero():
    world = panel(settings={"setpoint_centihertz": 0})
    assert row_1(world) == "S:  0.0 F:  0.00"
    world.press("REVERSE")
    assert row_1(world) == "S: -0.0 F:  0.00"
    world.check()


def test_each_drive_has_a_direction_of_its_own():
    world = panel(addresses=(1, 2))
    world.press("REVERSE")
    world.press("ADDRESS_UP")
    assert row_1(world).startswith("S: 10.0")
    world.press("ADDRESS_DOWN")
    assert row_1(world).startswith("S:-10.0")
    world.check()


# --- STOP that is held ---------------------------------------------------------------------------


def test_stop_held_for_a_second_and_a_half_is_off3():
    world = running()
    pressed_us = world.clock.now_us
    world.down("STOP")
    world.run(500)
    assert row_2(world) == "STOP, HOLD: OFF3" and words(world, pressed_us)[-1] == OFF1
    world.run(1150)
    assert row_2(world) == "OFF3, HOLD: ALL" and words(world, pressed_us)[-1] == OFF3
    world.up("STOP")
    world.run(100)
    assert words(world, pressed_us)[-1] == OFF3  # until it stands
    world.run(3000)
    assert words(world, pressed_us) == [OFF1, OFF3, OFF1]
    assert row_2(world) == "READY        A1"
    world.press("START")
    world.run(4000)
    assert world.drives[1].state == "running"
    world.check()


def test_the_second_stop_is_a_setting():
    for setting, stw, text, after in (
        ("OFF2", OFF2, "STOP, HOLD: OFF2", "OFF2, HOLD: ALL"),
        ("none", OFF1, "STOP, HOLD: ALL", "STOP, HOLD: ALL"),
    ):
        world = running(settings={"second_stop": setting})
        pressed_us = world.clock.now_us
        world.down("STOP")
        world.run(500)
        assert row_2(world) == text
        world.run(1150)
        assert row_2(world) == after and stw in words(world, pressed_us)
        assert OFF3 not in words(world, pressed_us)
        world.up("STOP")
        world.run(10_000)
        assert row_2(world) == "READY        A1"
        world.check()


def test_a_second_stop_is_for_the_drive_that_was_shown_when_stop_went_down():
    world = all_running((1, 2))
    pressed_us = world.clock.now_us
    world.down("STOP")
    world.run(500)
    world.press("ADDRESS_UP")
    world.run(1500)
    assert OFF3 in words(world, pressed_us, 1) and words(world, pressed_us, 2) == [ON]
    world.check()


def test_start_is_refused_while_a_second_stop_goes_on():
    world = running()
    world.drives[1].write(1135, 0, 60.0)  # a slow quick stop
    world.press("STOP", 1600)
    world.press("START")
    assert row_2(world) == "NO: QUICK STOP"
    world.press("STOP")  # a tap does not weaken it
    world.run(500)
    assert words(world, 0)[-1] == OFF3
    world.check()


def test_a_second_stop_of_a_drive_that_stands_does_it_no_harm():
    world = panel()
    world.press("STOP", 1600)
    world.run(500)
    assert words(world, 0) == [OFF1, OFF3, OFF1] and row_2(world) == "READY        A1"
    world.check()


def test_a_second_stop_reaches_a_drive_that_was_away():
    world = running(**unsupervised())
    world.drives[1].unplug()
    world.run(1500)
    world.press("STOP", 1700)
    world.run(2000)
    plugged_us = world.clock.now_us
    world.drives[1].plug()
    world.run(6000)
    assert words(world, plugged_us) == [OFF3, OFF1] and world.drives[1].hz() == 0
    world.check()


# --- faults -------------------------------------------------------------------------------------


def test_a_fault_is_shown_by_its_number_and_acknowledged_by_stop():
    world = running()
    world.drives[1].fault(12)
    world.run(1500)
    assert row_2(world) == "FAULT F0012  A1"
    began_us = world.clock.now_us
    world.press("STOP")
    world.run(500)
    assert row_2(world) == "READY        A1"
    assert 0x04FE in words(world, began_us) and words(world, began_us)[-1] == OFF1
    world.check()


def test_a_fault_that_has_been_shown_for_long_is_acknowledged_as_well():
    """The clock of the chip cannot tell more than half of its period."""
    world = panel(ticks_mask=(1 << 24) - 1)
    world.drives[1].fault(1)
    world.run(9000)
    world.press("STOP")
    world.run(300)
    assert row_2(world) == "READY        A1"
    world.check()


def test_a_stop_in_the_moment_of_the_trip_leaves_the_fault_on_the_display():
    world = running()
    world.drives[1].fault(12)
    world.run(300)
    world.press("STOP")
    world.run(1500)
    assert row_2(world) == "FAULT F0012  A1"
    world.check()


def test_the_stop_of_all_acknowledges_no_fault_that_nobody_saw():
    world = all_running((1, 2))
    world.press("ADDRESS_UP", 60)
    world.press("ADDRESS_UP", 60)
    world.drives[2].fault(30)
    world.run(200)
    world.press("STOP", 4200)
    world.run(3000)
    assert world.drives[2].state == "fault"
    world.press("ADDRESS_UP")
    world.run(500)
    assert row_2(world) == "FAULT F0030  A2"
    world.check()


def test_a_drive_that_was_on_and_tripped_is_announced():
    world = all_running((1, 2))
    world.drives[2].fault(30)
    rows = set()
    for _ in range(40):
        world.run(100)
        rows.add(row_2(world))
    assert "A2 FAULT F0030" in rows, rows
    world.check()


def test_a_fault_whose_cause_stays_comes_back():
    """The acknowledgement is sent once; the drive decides."""
    world = panel()
    world.drives[1].fault(1)
    world.run(1500)
    world.press("STOP")
    world.drives[1].fault(2)
    world.run(1500)
    assert row_2(world) == "FAULT F0002  A1"
    world.check()


def test_a_jog_that_follows_a_slow_ramp_is_no_stop_that_failed():
    world = panel(loop_us=LOOP_US)
    world.drives[1].write(1061, 0, 650.0)
    world.press("JOG_RIGHT", 2000)
    world.run(60)
    assert row_2(world) == "STOPPING     A1"
    world.down("JOG_RIGHT")
    world.run(300)
    for _ in range(60):
        world.run(100)
        assert row_2(world) == "JOG RIGHT    A1", world.lcd()
    world.check()


def test_start_takes_over_from_a_jog_that_ramps_down():
    """From then on it runs by START, and no jog key stops it any more."""
    world = panel(loop_us=LOOP_US)
    world.drives[1].write(1061, 0, 650.0)
    world.press("JOG_RIGHT", 2000)
    world.run(60)
    assert row_2(world) == "STOPPING     A1", world.lcd()
    world.press("START")
    world.run(3000)
    assert row_2(world) == "RUNNING      A1", world.lcd()
    world.press("JOG_LEFT", 400)
    assert row_2(world) == "NO JOG: IT RUNS", world.lcd()
    world.run(4000)
    assert row_2(world) == "RUNNING      A1" and world.drives[1].state == "running"
    world.check()


def test_jog_does_not_weaken_a_second_stop():
    """Not even while what ramps down is a jog."""
    world = panel(loop_us=LOOP_US)
    world.drives[1].write(1061, 0, 650.0)
    world.drives[1].write(1135, 0, 60.0)
    world.press("JOG_RIGHT", 2000)
    world.press("STOP", 1600)
    world.press("JOG_RIGHT", 500)
    assert row_2(world) == "NO: QUICK STOP"
    assert words(world, 0)[-1] == OFF3
    world.check()


def test_jog_while_a_start_is_being_checked_is_refused():
    world = panel()
    world.down("START")
    world.run(40)
    world.press("JOG_LEFT", 300)
    world.up("START")
    assert row_2(world) == "NO JOG: IT RUNS"
    world.run(3000)
    assert words(world, 0) == [OFF1, ON] and starts(world) == 1
    world.check()


def test_a_stop_in_the_moment_of_the_next_trip_leaves_that_fault_on_the_display():
    world = running()
    world.drives[1].fault(12)
    world.run(1500)
    world.press("STOP")
    world.run(300)
    world.drives[1].fault(30)
    world.run(200)
    world.press("STOP")
    world.run(1500)
    assert row_2(world) == "FAULT F0030  A1"
    world.check()


def test_a_fault_that_took_the_place_of_another_is_shown():
    world = panel()
    world.drives[1].fault(12)
    world.run(1500)
    assert row_2(world) == "FAULT F0012  A1"
    world.drives[1].process.faults[0] = 30
    world.run(1000)
    assert row_2(world) == "FAULT F0030  A1"
    world.check()


def test_the_number_of_an_earlier_fault_is_not_shown_for_the_next():
    """The drive takes its time to answer; it was acknowledged and has tripped again by then."""
    asked = []

    def ask(job):
        job.state = pkw.PENDING
        asked.append(job)

    drive = Drive(1, 0x3FFFFFFF)
    drive.ask = ask
    drive.contact = True
    fault = Fault(drive, 0x3FFFFFFF, MM4)
    for drive.zsw in (FAULT_ZSW, READY_ZSW, FAULT_ZSW):
        fault.step(0)
    asked[0].state, asked[0].low = pkw.DONE, 12
    fault.step(1000)
    assert fault.number == 0
    fault.step(2000)
    asked[-1].state, asked[-1].low = pkw.DONE, 30
    fault.step(3000)
    assert len(asked) == 2 and fault.number == 30


# --- the jog keys by themselves ------------------------------------------------------------------


class Jogging:
    """A control that may jog or refuse to, and notes what it is told."""

    def __init__(self, refuses=False):
        self.phase, self.refuses, self.told = IDLE, refuses, []

    def jog(self, stw):
        self.told.append(stw)
        if not self.refuses:
            self.phase = JOGGING

    def end_jog(self):
        self.told.append("end")
        self.phase = IDLE


class Pair:
    """The two keys of a panel, besides others that are down now and then."""

    RIGHT, LEFT, OTHER = 2, 8, 5

    def __init__(self, **options):
        self.shown = Jogging(**options)
        self.keys = JogKeys(self.RIGHT, self.LEFT)
        self.down = self.pressed = 0

    def step(self, down, allowed=True, shown=None, other=0):
        self.pressed = (down | other) & ~self.down
        self.down = down | other
        self.keys.step(self, shown or self.shown, allowed)
        return self.shown.told[-1:], self.shown.phase == JOGGING


def test_a_jog_begins_with_a_press_of_one_key_alone_and_ends_with_anything_else():
    for key, stw, other_stw in (
        (Pair.RIGHT, pzd.JOG_RIGHT, pzd.JOG_LEFT), (Pair.LEFT, pzd.JOG_LEFT, pzd.JOG_RIGHT)
    ):  # fmt: skip
        both, ends = Pair.RIGHT | Pair.LEFT, (["end"], False)
        for ending in (
            {"down": 0}, {"down": both}, {"down": both - key}, {"down": key, "allowed": False},
            {"down": key, "shown": Jogging()}, {"down": 0, "other": Pair.OTHER},
        ):  # fmt: skip
            pair = Pair()
            assert pair.step(0, other=Pair.OTHER) == ([], False)
            for _ in range(2):  # the other keys may go up and down
                assert pair.step(key, other=Pair.OTHER) == pair.step(key) == ([stw], True)
            assert pair.shown.told == [stw]
            jogged = pair.step(**ending)
            if ending["down"] == both - key:  # the other key was pressed in the same moment
                assert jogged[1] and pair.shown.told[1:] == ["end", other_stw]
                continue
            assert jogged == ends, ending
            assert not ending.get("shown") or ending["shown"].told == []
            for _ in range(2):  # it has to go up first
                assert ending["down"] != key or pair.step(key) == ends, ending
            pair.step(0)
            assert pair.shown.told == [stw, "end"]
            assert pair.step(key) == ([stw], True)


def test_a_jog_key_that_is_pressed_where_it_may_not_is_none_later_either():
    pair = Pair()
    assert pair.step(Pair.RIGHT, allowed=False) == ([], False)
    assert pair.step(Pair.RIGHT) == ([], False)
    pair.step(0)
    assert pair.step(Pair.RIGHT | Pair.LEFT) == pair.step(Pair.LEFT) == ([], False)
    refusing = Pair(refuses=True)
    for _ in range(3):
        assert refusing.step(Pair.LEFT) == ([pzd.JOG_LEFT], False)
    refusing.step(0)
    assert refusing.shown.told == [pzd.JOG_LEFT]


def test_a_jog_that_something_else_has_ended_needs_another_press():
    """It is not ended a second time: nobody knows what the drive does by then."""
    pair = Pair()
    pair.step(Pair.LEFT)
    pair.shown.phase = IDLE
    for down in (Pair.LEFT, Pair.LEFT, 0):
        pair.step(down)
        assert pair.shown.told == [pzd.JOG_LEFT], down
    assert pair.step(Pair.LEFT) == ([pzd.JOG_LEFT], True) and len(pair.shown.told) == 2
