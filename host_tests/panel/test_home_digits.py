# SPDX-License-Identifier: MIT
"""The operator's manual, the home page: the setpoint digit by digit, EDIT, and SET takes it.

NEW 010.00Hz A1: NEXT and PREVIOUS go to another digit, which blinks; UP and DOWN change it. Only
SET puts it into force.
"""

import sys

from panel.keys import Acts, Keys
from panel.pages.digits import Digits
from panel_bench import (
    LOOP_US,
    OFF1,
    panel,
    row_1,
    row_2,
    running,
    starts,
    taken_at_ms,
    telegrams,
    wait_until_known,
)  # fmt: skip

LEFT_ALONE = ("EDIT", "PARAM", "STOP", "ADDRESS_UP", "ADDRESS_DOWN")
REFUSED = ("START", "REVERSE", "JOG_RIGHT", "JOG_LEFT")


def press(world, *keys):
    for key in keys:
        world.press(key)
    world.run(100)


def digits(world):
    """Row 2 as it is while no digit is away."""
    for _ in range(40):
        world.run(20)
        if row_2(world).startswith("NEW") and "_" not in row_2(world):
            return row_2(world)
    raise AssertionError(world.lcd())


def editing(world):
    """EDIT was pressed, and nothing else."""
    press(world, "EDIT")
    assert digits(world).startswith("NEW"), world.lcd()
    return world


def type_in(world, text):
    """Each of the five digits is set with UP, from the hundreds on: 017.50."""
    press(world, "PREVIOUS", "PREVIOUS")
    for at, wanted in enumerate(text):
        if wanted != ".":
            for _ in range((int(wanted) - int(digits(world)[4 + at])) % 10):
                press(world, "UP")
            press(world, "NEXT")
    assert digits(world)[4:10] == text, world.lcd()


def ready(**options):
    world = panel(**options)
    wait_until_known(world)
    return world


def test_a_setpoint_is_typed_in_and_taken_by_set():
    world = editing(ready())
    assert world.lcd()[0] == "S: 10.0 F:  0.00" and digits(world) == "NEW 010.00Hz A1"
    type_in(world, "017.50")
    assert row_1(world) == "S: 10.0 F:  0.00"  # nothing has taken effect yet
    press(world, "SET")
    assert world.lcd() == ("S: 17.5 F:  0.00", "READY        A1 ")
    press(world, "START")
    world.run(5000)
    assert abs(world.drives[1].hz() - 17.5) < 0.01 and row_1(world) == "S: 17.5 F: 17.50"
    world.check()


def test_the_digit_that_would_change_blinks():
    world = editing(ready())
    seen = {}
    for keys, shown in (((), "01_.00"), (("NEXT",), "010._0"), (("NEXT",), "010.0_"),
                        (("NEXT",), "_10.00"), (("PREVIOUS", "PREVIOUS"), "010._0")):  # fmt: skip
        press(world, *keys)
        for _ in range(80):  # twice on and off
            world.run(20)
            row = row_2(world)[4:10]
            seen[row] = seen.get(row, 0) + 20
        assert set(seen) == {shown, "010.00"}, seen
        assert 400 <= seen[shown] <= 600, seen  # for a quarter of a second of 0.8
        seen.clear()


def next_taken_at_ms(world):
    digits_page = sys.modules["panel.pages.digits"].Digits  # it is loaded anew for each world
    return taken_at_ms(digits_page, lambda: press(world, "NEXT"))


def test_it_blinks_also_if_the_key_was_pressed_when_the_clock_showed_0():
    (now_ms,) = next_taken_at_ms(editing(ready()))
    world = editing(ready(ticks_start=-1000 * now_ms))
    assert next_taken_at_ms(world) == [0]
    rows = set()
    for _ in range(80):
        world.run(20)
        rows.add(row_2(world)[4:10])
    assert rows == {"010.00", "010._0"}, rows


def test_a_digit_goes_round_and_repeats_while_its_key_is_held():
    world = editing(ready())
    press(world, "DOWN")
    assert digits(world)[4:10] == "019.00"
    press(world, "UP", "UP")
    assert digits(world)[4:10] == "011.00"
    world.press("UP", 1000)
    assert digits(world)[4:10] == "017.00"
    press(world, "SET")
    assert row_1(world) == "S: 17.0 F:  0.00"


def test_a_running_motor_follows_at_set_and_not_before():
    world = editing(running())
    press(world, "UP", "UP", "UP")
    world.run(5000)
    assert abs(world.drives[1].hz() - 10) < 0.01 and row_1(world) == "S: 10.0 F: 10.00"
    press(world, "SET")
    world.run(3000)
    assert abs(world.drives[1].hz() - 13) < 0.01 and starts(world) == 1
    world.check()


def test_whatever_else_ends_it_leaves_the_setpoint_as_it_was():
    for key in LEFT_ALONE:
        world = editing(ready(addresses=(1, 2), loop_us=LOOP_US))
        press(world, "UP", key)
        world.run(500)
        other = key.startswith("ADDRESS")
        assert world.lcd()[0] == "S: 10.0 F:  0.00", (key, world.lcd())
        assert row_2(world) == ("READY        A2" if other else "READY        A1"), key
        press(world, "SET")
        if other:
            press(world, key)
        assert row_1(world) == "S: 10.0 F:  0.00", (key, world.lcd())
        editing(world)
        assert digits(world)[4:10] == "010.00", key  # what was not taken is forgotten
        world.check()


def test_an_address_key_leads_to_the_next_drive_round_and_held_into_no_menu():
    for first, key, then in (
        (1, "ADDRESS_UP", 2), (3, "ADDRESS_UP", 1), (1, "ADDRESS_DOWN", 3), (3, "ADDRESS_DOWN", 2),
    ):  # fmt: skip
        world = ready(addresses=(1, 2, 3))
        if first == 3:
            press(world, "ADDRESS_DOWN")
            wait_until_known(world)
        editing(world)
        world.press(key, 2000)
        world.run(500)
        assert row_2(world) == "READY        A%d" % then, (first, key, world.lcd())
        world.check()


def test_half_a_minute_without_a_key_ends_it():
    world = editing(ready())
    press(world, "UP")
    world.run(25_000)
    press(world, "UP")
    world.run(29_000)
    assert digits(world)[4:10] == "012.00"
    world.run(2_000)
    assert world.lcd() == ("S: 10.0 F:  0.00", "READY        A1 ")
    press(world, "SET")
    assert row_1(world) == "S: 10.0 F:  0.00"


# --- the page by itself --------------------------------------------------------------------------


class Alone:
    """The page of the digits, whose keys and whose time are those of the test."""

    def __init__(self, shown, began_ms=0):
        self.shown, self.began_ms = shown, began_ms
        self.page = Digits(shown)
        self.is_over = False
        shown.uncover = self.end

    def end(self):
        self.is_over = True

    def press(self, ms, *names):
        keys = Keys(self.shown.board.keypad.names, self.shown.mask)
        keys.pressed = keys.bits(names)
        self.page.take_keys(Acts(keys), self.began_ms + ms & self.shown.mask)

    def lasts(self, ms):
        """Whether it is still shown, so long after it began."""
        self.page.step(None, self.began_ms + ms & self.shown.mask)
        return not self.is_over

    def row(self, ms):
        self.page.draw(self.shown.screen, self.began_ms + ms & self.shown.mask)
        return self.shown.screen.rows()[1][:13]


def test_the_half_minute_begins_with_the_page_and_anew_with_each_key():
    shown = ready().app.panel
    for began_ms in (0, shown.mask - 9_000):  # the clock begins anew meanwhile
        alone = Alone(shown, began_ms)
        assert alone.lasts(0) and alone.lasts(29_999) and not alone.lasts(30_000)
        alone = Alone(shown, began_ms)
        assert alone.lasts(0)
        alone.press(20_000, "NEXT")
        assert alone.lasts(49_999) and not alone.lasts(50_000)


def test_the_digit_is_away_for_the_last_250_of_800_ms_after_a_key():
    alone = Alone(ready().app.panel, 70_000)
    away, there = "NEW 01_.00Hz ", "NEW 010.00Hz "
    assert alone.row(700) == there  # it has not begun
    alone.lasts(0)
    for ms, row in ((0, there), (549, there), (550, away), (799, away), (800, there),
                    (1_349, there), (1_350, away)):  # fmt: skip
        assert alone.row(ms) == row, ms
    alone.press(1_400, "UP")
    assert alone.row(1_400) == alone.row(1_949) == "NEW 011.00Hz "
    assert alone.row(1_950) == "NEW 01_.00Hz "


def test_the_places_are_those_of_a_setpoint_of_three_digits_and_two_decimals():
    alone = Alone(ready().app.panel)
    for keys, row in (
        (("UP",), "011.00"), (("NEXT", "UP"), "011.10"), (("NEXT", "DOWN"), "011.19"),
        (("NEXT", "UP"), "111.19"), (("NEXT", "DOWN"), "101.19"), (("PREVIOUS",), "101.19"),
        (("DOWN",), "001.19"), (("PREVIOUS", "UP"), "001.10"),
    ):  # fmt: skip
        for key in keys:
            alone.press(0, key)
        assert alone.row(0)[4:10] == row, keys


def test_a_limit_that_has_just_been_read_counts_at_set():
    """The motor stands: what the operator sees is below that limit, and is raised to it."""
    world = ready()
    shown = world.app.panel
    control = shown.selected
    survey = control.survey
    lowest = survey.lowest()
    alone = Alone(shown)
    survey.lowest = lambda: 1_500
    survey.version += 1
    alone.press(0, "UP")
    alone.press(0, "SET")
    assert alone.is_over and control.setpoint.centihertz == 1_500 > lowest
    assert shown.message == b"LIMIT: 15.00"


def test_param_that_leaves_it_and_is_held_opens_no_menu():
    world = editing(ready())
    world.press("PARAM", 2000)
    world.run(100)
    assert row_2(world) == "READY        A1"


def test_stop_stops_at_once():
    world = editing(running())
    press(world, "UP")
    pressed_us = world.clock.now_us
    world.press("STOP")
    sent = telegrams(world, pressed_us, 1)
    assert sent[0][1] != OFF1 or sent[0][0] - pressed_us < 40_000
    assert any(stw == OFF1 and at_us - pressed_us < 40_000 for at_us, stw in sent), sent
    world.run(3000)
    assert world.drives[1].hz() == 0 and row_2(world) == "READY        A1"
    assert row_1(world) == "S: 10.0 F:  0.00"
    world.check()


def test_a_stop_that_is_held_goes_on_to_the_second_stop():
    world = editing(running())
    world.down("STOP")
    world.run(1700)
    assert row_2(world) == "OFF3, HOLD: ALL"
    world.up("STOP")
    world.run(3000)
    assert world.drives[1].hz() == 0
    world.check()


def test_nothing_starts_jogs_or_reverses_while_a_setpoint_is_not_settled():
    for key in REFUSED:
        world = editing(ready())
        press(world, "UP", key)
        assert row_2(world) == "NO: SET OR PARAM", (key, world.lcd())
        world.press(key, 1000)
        world.run(2000)
        assert starts(world) == 0 and world.drives[1].hz() == 0, key
        assert row_1(world) == "S: 10.0 F:  0.00", key
        press(world, "SET", "START")
        world.run(4000)
        assert abs(world.drives[1].hz() - 11) < 0.01, key
        world.check()


def test_a_jog_that_is_held_ends():
    world = ready(loop_us=LOOP_US)
    world.down("JOG_RIGHT")
    world.run(1500)
    assert world.drives[1].hz() > 0
    press(world, "EDIT")
    world.run(3000)
    assert world.drives[1].hz() == 0 and row_2(world).startswith("NEW")
    world.check()


def test_a_start_before_edit_runs_with_what_was_shown():
    world = ready()
    world.press("START")
    press(world, "EDIT", "UP", "UP")
    world.run(4000)
    assert abs(world.drives[1].hz() - 10) < 0.01
    assert digits(world)[4:10] == "012.00"
    world.check()


def test_a_value_beyond_a_limit_becomes_the_limit_and_that_is_said():
    world = editing(ready(parameters={2014: 2000, 1080: 5.25, 1082: 40.0}))
    type_in(world, "060.00")
    press(world, "SET")
    assert row_2(world) == "LIMIT: 40.00" and row_1(world) == "S: 40.0 F:  0.00"
    editing(world)
    type_in(world, "002.00")
    press(world, "SET")
    assert row_2(world) == "LIMIT: 5.25", world.lcd()
    assert row_1(world) == "S:  5.3 F:  0.00", world.lcd()
    world.check()


def test_the_limits_of_the_settings_count_too():
    settings = {"highest_centihertz": 3000, "lowest_centihertz": 575}
    world = editing(ready(settings=settings))
    type_in(world, "999.99")
    press(world, "SET")
    assert row_2(world) == "LIMIT: 30.00" and row_1(world) == "S: 30.0 F:  0.00"
    editing(world)
    type_in(world, "000.00")
    press(world, "SET")
    assert row_2(world) == "LIMIT: 5.75", world.lcd()
    assert row_1(world) == "S:  5.8 F:  0.00", world.lcd()


def test_set_with_the_value_in_force_raises_nothing():
    """A motor that runs below P1080 is not raised to it by a SET that changes nothing."""
    world = running()
    world.drives[1].write(1080, 0, 20.0)
    world.run(3000)
    since_us = world.clock.now_us
    editing(world)
    press(world, "SET")
    world.run(1000)
    assert row_1(world).startswith("S: 10.0"), world.lcd()
    assert len(telegrams(world, since_us, 1)) > 10
    world.check()


def test_it_is_the_magnitude_and_reverse_gives_the_direction():
    world = ready()
    press(world, "REVERSE")
    editing(world)
    assert digits(world) == "NEW-010.00Hz A1"
    press(world, "UP", "SET")
    assert row_1(world) == "S:-11.0 F:  0.00"
    press(world, "START")
    world.run(4000)
    assert abs(world.drives[1].hz() + 11) < 0.01
    world.check()


def test_it_is_in_percent_where_the_panel_is():
    world = ready(kinds={1: {"parameters": {2013: 0}}}, settings={"kinds": {"1": "mm420/0"}})
    assert row_1(world) == "S: 10.0%F:  0.00", world.lcd()
    editing(world)
    assert digits(world) == "NEW 010.00%  A1"
    press(world, "UP", "SET")
    assert row_1(world) == "S: 11.0%F:  0.00"


def test_an_alarm_ends_it():
    world = editing(running())
    press(world, "UP")
    world.drives[1].unplug()
    world.run(2000)
    assert world.lcd() == ("NO CONTACT,     ", "MAY RUN      A1 "), world.lcd()
    press(world, "SET")
    world.drives[1].plug()
    world.run(4000)
    assert row_1(world).startswith("S: 10.0"), world.lcd()


def test_a_question_of_a_start_ends_it():
    world = ready(parameters={2014: 0})
    world.press("START", 30)
    world.press("EDIT", 30)
    world.run(1500)
    assert row_2(world) == "SET=FIX START=GO", world.lcd()
    press(world, "STOP")
    assert row_2(world) == "READY        A1"
    assert starts(world) == 0
    world.check()


def test_a_fault_is_said_in_turn():
    world = editing(running())
    world.drives[1].fault(1)
    seen = set()
    for _ in range(150):
        world.run(20)
        seen.add(row_2(world))
    assert "A1 FAULT F0001" in seen, seen
    assert any(row.startswith("NEW") for row in seen)


def test_a_drive_that_runs_and_does_not_tell_its_settings_keeps_its_setpoint():
    world = running()
    control = world.app.panel.selected
    editing(world)
    press(world, "UP")
    control.survey.complete = False
    press(world, "SET")
    assert row_2(world) == "NO: STILL CHECKS", world.lcd()
    assert row_1(world) == "S: 10.0 F: 10.00"
    world.check()


def test_keys_together_with_set_are_no_clear_wish():
    world = editing(ready())
    world.down("UP")
    world.down("SET")
    world.run(100)
    world.up("UP")
    world.up("SET")
    world.run(100)
    assert row_1(world) == "S: 10.0 F:  0.00" and digits(world)[:3] == "NEW"


def test_no_memory_for_it_is_said():
    import on_demand

    world = ready()
    load = on_demand.load

    def no_room(name):
        if name == "panel.pages.digits":
            raise MemoryError
        return load(name)

    on_demand.load = no_room
    try:
        press(world, "EDIT")
    finally:
        on_demand.load = load
    assert row_2(world) == "NO MEMORY LEFT"
    world.check()
