# SPDX-License-Identifier: MIT
"""The operator's manual, a panel that nobody uses: its lock closes, its light goes off."""

import json

from panel.keys import Acts, Keys
from panel.keys.guard import Guard
from panel.pages import Page
from panel_bench import (
    OFF1,
    hold,
    press,
    row_1,
    row_2,
    starts,
    switched_on,
    telegrams,
    wait_until_known,
)

LOCKED = "LOCK: HOLD PARAM"
MASK = 0x3FFFFFFF
BAUD = 4_800  # minutes pass in these tests, and the fewer telegrams in them the sooner


def panel(addresses=(1,), **settings):
    world = switched_on(addresses, BAUD, settings)
    world.run(1500)
    wait_until_known(world)
    return world


def enter(world, code):
    """The digits of a code, in the page for it."""
    for digit in code:
        press(world, *["UP"] * int(digit), "SET")


def locked(addresses=(1,), code=2046):
    world = panel(addresses, lock_code=code)
    press(world, "REVERSE")
    assert row_2(world) == LOCKED, world.lcd()
    world.run(3500)
    return world


def open_settings(world):
    hold(world, "PARAM")
    while row_2(world) != ">SETTINGS":
        press(world, "DOWN")
    press(world, "SET")


def settled_row_1(world, text):
    """Whether it stands in row 1 soon, in turn with what is announced."""
    for _ in range(100):
        world.run(50)
        if row_1(world) == text:
            return True
    return False


def kept(world):
    return json.loads(world.flash.files["settings.json"].decode())


# --- the lock ------------------------------------------------------------------------------------


def test_a_closed_lock_leaves_start_stop_setpoint_and_the_choice_of_a_drive():
    world = locked((1, 2))
    press(world, "UP")
    assert row_1(world).startswith("S: 10.1"), world.lcd()
    press(world, "ADDRESS_UP")
    wait_until_known(world)
    assert row_2(world) == "READY        A2", world.lcd()
    press(world, "START")
    world.run(4000)
    assert world.drives[2].state == "running"
    pressed_us = world.clock.now_us
    press(world, "STOP")
    offs = [at_us for at_us, stw in telegrams(world, pressed_us, 2) if stw == OFF1]
    assert offs and offs[0] - pressed_us < 100_000
    world.run(4000)
    assert world.drives[2].hz() == 0
    world.drives[2].fault(11)
    world.run(3000)
    press(world, "STOP")  # acknowledges
    wait_until_known(world)
    world.check()


def test_a_closed_lock_refuses_everything_else_and_says_so():
    world = locked((1, 2))
    for key in ("REVERSE", "JOG_RIGHT", "JOG_LEFT", "PARAM"):
        hold(world, key, 700)
        assert row_2(world) == LOCKED, (key, world.lcd())
        world.run(3500)
        assert row_2(world) == "READY        A1", (key, world.lcd())
    hold(world, "ADDRESS_UP")  # any address
    assert row_2(world) == LOCKED, world.lcd()
    for key in ("EDIT", "SET", "NEXT", "PREVIOUS"):
        press(world, key)
    assert row_1(world).startswith("S: 10.0") and starts(world) == 0
    world.check()


def test_what_the_lock_refuses_is_taken_away_whether_it_was_pressed_or_repeats():
    names = ("PARAM", "STOP", "SET", "REVERSE", "UP", "JOG_LEFT", "START", "JOG_RIGHT")
    keys = Keys(names, MASK)
    guard = Guard(panel(lock_code=7).app.panel.settings, keys, MASK, None, True)
    left = ("STOP", "UP", "START")
    for obeys, others in ((True, left + ("SET",)), (False, left)):
        page = Page(None)
        page.obeys = obeys
        for refused in (names, others):
            acts = Acts(keys)
            acts.pressed = acts.repeated = keys.bits(refused)
            assert guard.holds_back(acts, page) == (refused is names)
            assert acts.pressed == acts.repeated == keys.bits(others), obeys


def test_a_jog_key_that_opens_no_jog_opens_none_when_the_lock_opens():
    world = locked()
    world.down("JOG_RIGHT")
    world.run(300)
    hold(world, "PARAM")
    enter(world, "2046")
    press(world, "PARAM")
    world.run(1000)
    assert starts(world) == 0
    world.up("JOG_RIGHT")
    world.run(300)
    world.down("JOG_RIGHT")
    world.run(1500)
    assert starts(world) == 1
    world.up("JOG_RIGHT")
    world.run(4000)
    assert world.drives[1].hz() == 0
    world.check()


def test_the_code_opens_the_lock():
    world = locked()
    hold(world, "PARAM")
    assert world.lcd() == ("UP DOWN SET=NEXT", ">CODE 0___      "), world.lcd()
    press(world, "UP", "UP", "SET", "DOWN")
    assert row_2(world) == ">CODE *9__", world.lcd()
    press(world, "UP", "SET")
    enter(world, "45")
    assert row_2(world) == "WRONG CODE", world.lcd()
    world.run(3500)
    assert row_2(world) == ">CODE 0___", world.lcd()
    enter(world, "2047")
    assert row_2(world) == "WRONG CODE", world.lcd()
    world.run(3500)
    enter(world, "2046")
    assert row_2(world) == "UNLOCKED", world.lcd()
    world.run(3500)
    assert row_2(world) == "READY        A1", world.lcd()
    press(world, "PARAM")
    assert row_2(world).startswith("P0700"), world.lcd()
    world.run(290_000)
    press(world, "NEXT")
    world.run(290_000)
    assert row_2(world).startswith("P1000"), world.lcd()
    world.run(15_000)  # five minutes after the last key
    press(world, "PARAM")
    assert row_2(world) == LOCKED, world.lcd()
    world.run(3500)
    assert row_2(world) == "READY        A1", world.lcd()
    world.check()


def test_a_code_is_set_by_key_and_the_menu_closes_the_lock():
    world = panel()
    open_settings(world)
    while row_2(world) != ">LOCK CODE":
        press(world, "DOWN")
    press(world, "SET", "UP", "SET", "SET")
    assert row_2(world) == ">NEW CODE 100_", world.lcd()
    press(world, "SET", "DOWN", "SET")
    assert row_2(world) == "KEPT", world.lcd()
    press(world, "PARAM")
    assert row_1(world).startswith("MENU"), world.lcd()  # not closed: who set it may go on
    press(world, "PARAM")
    world.run(3000)
    assert kept(world)["lock_code"] == 1009
    hold(world, "PARAM")
    press(world, "UP")
    assert row_2(world) == ">LOCK", world.lcd()
    press(world, "SET")
    assert row_2(world) == LOCKED, world.lcd()
    world.run(3500)
    assert row_2(world) == "READY        A1", world.lcd()
    press(world, "PARAM")
    assert row_2(world) == LOCKED, world.lcd()
    world.reset()  # so it is after power-on
    world.run(3000)
    hold(world, "PARAM")
    enter(world, "1009")
    open_settings(world)
    while row_2(world) != ">LOCK CODE":
        press(world, "DOWN")
    press(world, "SET", "SET", "SET", "SET", "SET")
    assert row_2(world) == "NO LOCK", world.lcd()
    world.run(3500)
    assert kept(world)["lock_code"] == 0
    world.reset()
    world.run(3000)
    press(world, "PARAM")
    assert row_2(world).startswith("P0700"), world.lcd()
    world.check()


def test_the_least_code_locks_like_any_other():
    world = locked(code=1)
    hold(world, "PARAM")
    enter(world, "0001")
    hold(world, "PARAM")
    press(world, "UP")
    assert row_2(world) == ">LOCK", world.lcd()
    press(world, "SET")
    world.run(3500)
    press(world, "PARAM")
    assert row_2(world) == LOCKED, world.lcd()
    world.check()


def test_a_question_takes_start_and_stop_while_the_lock_is_closed_and_writes_nothing():
    world = switched_on((1,), parameters={2014: 0}, settings={"lock_code": 5})
    world.run(1500)
    wait_until_known(world)
    press(world, "START")
    world.run(1500)
    assert row_2(world) == "SET=FIX START=GO", world.lcd()
    press(world, "SET")
    assert row_2(world) == LOCKED, world.lcd()
    press(world, "START")
    world.run(1000)
    assert row_2(world) == "SET=FIX START=GO", "START came while the question was hidden"
    assert world.drives[1].state == "ready"
    press(world, "START")
    world.run(4000)
    assert world.drives[1].state == "running" and world.drives[1].read(2014) == 0
    press(world, "STOP")
    world.run(4000)
    assert world.drives[1].hz() == 0
    world.check()


# --- the light -----------------------------------------------------------------------------------


def test_the_light_goes_off_without_a_key_and_on_with_any():
    world = panel(light_minutes=1)
    world.run(55_000)
    assert world.lcd_chip.lit
    press(world, "UP")
    world.run(58_000)
    assert world.lcd_chip.lit
    world.run(4_000)
    assert not world.lcd_chip.lit
    before = row_1(world)
    for key in ("UP", "START", "REVERSE", "JOG_LEFT", "PARAM"):
        world.down(key)  # who presses it has not seen what would start
        world.run(2000)
        assert world.lcd_chip.lit, key
        world.up(key)
        world.run(1000)
        assert row_1(world) == before and row_2(world) == "READY        A1", (key, world.lcd())
        world.run(65_000)
        assert not world.lcd_chip.lit
    assert starts(world) == 0
    press(world, "START", "START")
    world.run(4000)
    assert starts(world) == 1
    world.check()


def test_stop_acts_in_the_dark():
    world = panel(light_minutes=1)
    press(world, "START")
    world.run(65_000)
    assert not world.lcd_chip.lit and world.drives[1].state == "running"
    pressed_us = world.clock.now_us
    press(world, "STOP")
    offs = [at_us for at_us, stw in telegrams(world, pressed_us, 1) if stw == OFF1]
    assert offs and offs[0] - pressed_us < 100_000 and world.lcd_chip.lit
    world.run(4000)
    assert world.drives[1].hz() == 0
    world.check()


def test_an_alarm_makes_light_whichever_drive_is_shown():
    for address in (1, 2):
        world = panel((1, 2), light_minutes=1)
        world.run(65_000)
        assert not world.lcd_chip.lit
        world.drives[address].fault(11)
        world.run(3000)
        assert world.lcd_chip.lit, address
        world.run(65_000)
        assert world.lcd_chip.lit
        world.check()


def test_a_motor_that_may_run_unheard_makes_light_though_another_drive_is_shown():
    world = panel((1, 2, 3), light_minutes=1)
    press(world, "ADDRESS_UP")
    wait_until_known(world)
    press(world, "START", "ADDRESS_DOWN")
    world.run(65_000)
    assert not world.lcd_chip.lit and world.drives[2].state == "running"
    world.drives[2].unplug()
    world.run(3000)
    assert world.lcd_chip.lit, world.lcd()
    world.run(65_000)
    assert world.lcd_chip.lit, world.lcd()  # as long as nobody knows what the motor does
    world.drives[3].fault(11)  # another alarm on top of it
    world.run(65_000)
    assert world.lcd_chip.lit, world.lcd()
    hold(world, "STOP", 4500)  # of all drives, which this one does not confirm
    world.run(65_000)
    assert world.lcd_chip.lit, world.lcd()
    world.check()


def test_a_board_that_cannot_switch_its_light_has_no_such_setting():
    for has in (True, False):
        world = panel()
        if not has:
            del world.app.board.backlight
        open_settings(world)
        found = []
        while row_2(world) not in found:
            found.append(row_2(world))
            press(world, "DOWN")
        assert (">LIGHT STAYS ON" in found) == has, found


def test_the_light_and_the_lock_keep_their_own_time_and_neither_needs_the_other():
    """A minute and five, from the last key on; an alarm is as good as a key for the light alone.
    The clock may begin anew meanwhile."""
    for code, minutes, wrap_at_ms in ((0, 1, 400_000), (7, 0, 30_000), (7, 1, 200_000)):
        settings = panel(lock_code=code, light_minutes=minutes).app.panel.settings
        keys, lit = Keys(("STOP", "SET", "UP"), MASK), []
        begin_ms = MASK + 1 - wrap_at_ms
        guard = Guard(settings, keys, MASK, lit.append, False)
        closed = []
        for at_ms in range(0, 420_000, 500):
            now_ms = begin_ms + at_ms & MASK
            if at_ms == 50_000:
                guard.note_keys(now_ms)
            if guard.step(now_ms, at_ms in (80_000, 300_000)):
                closed.append(at_ms)
            is_dark = 140_000 <= at_ms < 300_000 or at_ms >= 360_000
            assert guard.dark == (minutes > 0 and is_dark), at_ms
            assert guard.locked == (code > 0 and at_ms >= 350_000), at_ms
        assert closed == ([350_000] if code else []), closed
        assert lit == ([False, True, False] if minutes else []), lit
        unlit = Guard(settings, keys, MASK, None, False)  # nothing that could be switched
        for now_ms in (0, 300_000):
            assert unlit.step(now_ms, False) == (code > 0 and now_ms > 0) and not unlit.dark
        guard.unlock()
        assert not guard.locked
        guard.lock()
        assert guard.locked == (code > 0)
        assert Guard(settings, keys, MASK, lit.append, True).locked == (code > 0)


# --- the keys ------------------------------------------------------------------------------------


def test_the_key_test_names_each_key_and_stop_acts():
    world = panel()
    press(world, "START")
    world.run(4000)
    open_settings(world)
    while row_2(world) != ">KEY TEST":
        press(world, "UP")
    press(world, "SET")
    assert row_2(world) == ">PRESS A KEY", world.lcd()
    for key in world.app.board.keypad.names:
        if key != "STOP":
            press(world, key)
            assert row_2(world) == ">" + key, world.lcd()
    assert world.drives[1].state == "running" and starts(world) == 1
    pressed_us = world.clock.now_us
    press(world, "STOP")
    assert row_2(world) == ">STOP", world.lcd()
    assert settled_row_1(world, "HOLD PARAM: ENDS")
    offs = [at_us for at_us, stw in telegrams(world, pressed_us, 1) if stw == OFF1]
    assert offs and offs[0] - pressed_us < 100_000
    world.run(4000)
    hold(world, "PARAM")
    assert row_1(world).startswith("SETTINGS"), world.lcd()
    world.check()


# --- what was accepted ---------------------------------------------------------------------------


def accepted(*addresses):
    """A panel that shows the drives which were accepted with P2014 = 0: all that it has."""
    settings = {"unsupervised": list(addresses)}
    world = switched_on(addresses, parameters={2014: 0}, settings=settings)
    world.run(1500)
    wait_until_known(world)
    open_settings(world)
    while row_2(world) != ">P2014=0 OK":
        press(world, "DOWN")
    press(world, "SET")
    return world


def test_what_was_accepted_is_taken_back_by_key():
    world = accepted(1, 2)
    press(world, "SET")
    world.run(3500)
    assert row_2(world) == ">A2  SET=ASK" and kept(world)["unsupervised"] == [2], world.lcd()
    press(world, "PARAM", "PARAM", "PARAM", "START")
    world.run(1500)
    assert row_2(world) == "SET=FIX START=GO", world.lcd()
    assert starts(world) == 0


def test_when_nothing_is_accepted_any_more_the_list_says_so_and_set_does_nothing():
    world = accepted(1)
    press(world, "SET")
    assert row_2(world) == "KEPT", world.lcd()
    world.run(3500)
    for _ in range(2):
        assert row_2(world) == ">NO DRIVE" and kept(world)["unsupervised"] == [], world.lcd()
        press(world, "SET")


def test_when_the_last_of_a_list_is_taken_back_the_one_before_is_shown():
    world = accepted(1, 2, 3)
    press(world, "UP")
    assert row_1(world).endswith("3/3") and row_2(world) == ">A3  SET=ASK", world.lcd()
    press(world, "SET")
    world.run(3500)
    assert row_1(world).endswith("2/2") and row_2(world) == ">A2  SET=ASK", world.lcd()
    press(world, "SET")
    world.run(3500)
    assert row_2(world) == ">A1  SET=ASK" and kept(world)["unsupervised"] == [1], world.lcd()
