# SPDX-License-Identifier: MIT
"""The operator's manual, the menu: PARAM held for a second, UP and DOWN walk, SET, PARAM back."""

import json
import sys

import app
import main
from boards.sim.drives.kinds import listed_drives, simulated
from boards.sim.world import World
from panel import texts
from panel.menu import BACK
from panel.menu import value as value_list
from panel.menu import words as menu_words
from panel_bench import (
    LOOP_US,
    SlowClock,
    comes_to,
    panel,
    press,
    row_1,
    row_2,
    running,
    said,
    starts,
    telegrams,
    wait_until_known,
)  # fmt: skip
from spoilt_bench import spoil, with_a_wrong_check
from uss.telegram import MIRROR
from version import VERSION

OFF1 = 0x047E
KEYS = ("UP", "DOWN", "NEXT", "PREVIOUS", "EDIT", "ADDRESS_UP", "START", "REVERSE", "JOG_LEFT")


def menu(world):
    """Open the menu."""
    world.down("PARAM")
    world.run(1500)
    world.up("PARAM")
    world.run(300)
    assert row_2(world) == ">DRIVES", world.lcd()


def entries(world):
    """What the list has that is shown: row 2 of each."""
    found = []
    while row_2(world) not in found:
        found.append(row_2(world))
        press(world, "DOWN")
    return [row[1:].strip() for row in found]


def test_it_opens_and_closes():
    world = panel(addresses=(1, 2))
    menu(world)
    assert row_1(world) == "MENU        1/13", world.lcd()
    assert entries(world) == [
        "DRIVES", "ANY ADDRESS", "FIND DRIVES", "SETTINGS", "SETS", "ORDER", "TURNS", "DIAGNOSIS",
        "PARAMETERS", "COMMISSION", "FAULT MEMORY", "EVENTS", "ABOUT",
    ]  # fmt: skip
    press(world, "PARAM")
    assert row_2(world) == "READY        A1", world.lcd()
    menu(world)
    world.run(61_000)
    assert row_2(world) == "READY        A1", world.lcd()  # nobody has used it for a minute
    world.check()


def test_it_opens_and_its_lists_do_however_slow_the_chip_is():
    """A step in which it is too late for a module must not put off those that follow."""
    for reading_us in (100, 200, 300, 400, 500):
        world = panel(clock=SlowClock(), loop_us=LOOP_US)
        wait_until_known(world)
        world.clock.reading_us = reading_us
        menu(world)
        press(world, "UP", "UP", "UP", "UP", "UP", "SET")
        world.run(1200)
        assert row_1(world) == "PARAMETERS  1/22", (reading_us, world.lcd())
        press(world, "SET")
        world.run(1000)
        assert row_1(world) == "NUMBER  SET=SHOW", (reading_us, world.lcd())
        world.check()


def test_it_tells_what_this_is():
    world = panel()
    menu(world)
    press(world, "UP", "SET")
    assert row_1(world).startswith("ABOUT"), world.lcd()
    assert entries(world) == ["VERSION " + VERSION, "LICENCE: MIT", "SIMULATED"]


def test_the_drives_at_a_glance_and_one_of_them_shown():
    world = panel(addresses=(1, 2, 3))
    wait_until_known(world)
    press(world, "START")
    world.run(4000)
    world.drives[3].fault(1)
    world.run(3000)
    menu(world)
    press(world, "SET")
    seen = {}
    for _ in range(200):  # row 1 is that of announcements as well
        world.run(50)
        seen[row_1(world).strip()] = row_2(world)
    assert seen["10.00 Hz     1/3"] == ">A1  RUNNING", seen
    assert entries(world) == ["A1  RUNNING", "A2  READY", "A3  FAULT"]
    press(world, "SET")
    assert entries(world) == [
        "SHOW IT", "REMOVE IT", "FAMILY MM420", "PKW 4 WORDS", "PZD 2 WORDS", "LINK RS-485",
        "10.00 Hz",
    ]  # fmt: skip
    press(world, "PARAM", "DOWN", "SET", "SET")
    wait_until_known(world)
    assert "READY        A2" in said(world, 2_000) and world.drives[1].state == "running"
    world.check()


def test_where_the_last_drive_of_the_list_has_gone_the_one_before_it_is_there():
    """A program may remove one while somebody looks."""
    for key in ("STOP", "SET"):
        world = panel(addresses=(1, 2, 3))
        wait_until_known(world)
        menu(world)
        press(world, "SET", "UP")
        assert row_2(world).startswith(">A3 "), world.lcd()
        shown, last = world.app.panel.controls[0], world.app.panel.controls[2]
        world.app.panel.show(last)
        world.app.panel.remove()
        world.app.panel.show(shown)
        world.press(key)
        world.run(300)
        assert row_2(world) == {"STOP": ">A1 A2: STOP", "SET": ">SHOW IT"}[key], world.lcd()
        world.check()


def test_a_motor_that_turns_backwards_has_a_sign_in_the_menu():
    world = running(settings={"setpoint_centihertz": 1284})
    press(world, "REVERSE")
    world.run(8000)
    menu(world)
    press(world, "SET", "SET", "UP")
    assert row_2(world) == ">-12.84 Hz", world.lcd()
    world.check()


def test_a_drive_is_removed_unless_it_runs():
    world = panel(addresses=(1, 2))
    wait_until_known(world)
    press(world, "START")
    world.run(3000)
    menu(world)
    press(world, "SET", "SET", "DOWN", "SET")
    assert row_2(world) == "A1 NOT REMOVED", world.lcd()
    world.run(4000)
    press(world, "STOP")
    world.run(4000)
    menu(world)
    press(world, "SET", "SET", "DOWN", "SET")
    assert row_2(world) == "A1 REMOVED", world.lcd()
    world.run(4000)
    assert row_2(world) == "READY        A2"
    assert json.loads(world.flash.files["settings.json"].decode())["drives"] == [2]
    menu(world)
    press(world, "SET", "SET", "DOWN", "SET")  # it is the only one
    assert row_2(world) == "A2 NOT REMOVED", world.lcd()
    world.check()


def setting(world, start):
    """Open SETTINGS, and the entry that starts like this."""
    menu(world)
    while row_2(world) != ">SETTINGS":
        press(world, "DOWN")
    press(world, "SET")
    seen = []
    while not row_2(world).startswith(">" + start):
        assert row_2(world) not in seen, seen
        seen.append(row_2(world))
        press(world, "DOWN")
    press(world, "SET")
    assert row_2(world).startswith(">" + start), world.lcd()


def kept(world):
    """What the settings file says."""
    return json.loads(world.flash.files["settings.json"].decode())


def test_every_setting_is_shown_with_its_value_and_its_unit():
    world = panel(settings={"highest_centihertz": 8765})
    menu(world)
    press(world, "DOWN", "DOWN", "DOWN", "SET")
    assert entries(world)[:11] == [
        "BAUD 19200", "2ND STOP OFF3", "REPLY 20 ms", "LOST 1000 ms", "START 10.00 Hz",
        "STEP 0.10 Hz", "LOW 0.00 Hz", "HIGH 87.65 Hz", "KEY WAIT 400 ms", "KEY RATE 120 ms",
        "LIGHT STAYS ON",
    ]  # fmt: skip


def test_the_panel_begins_anew_with_a_setting_that_the_bus_or_the_setpoint_begins_with():
    """The others act at once."""
    world = panel()
    wait_until_known(world)
    front, anew = world.app.panel, []
    front.begin_anew = lambda: anew.append(row[0])
    for row in menu_words.SETTINGS:
        shown = value_list.List(front, row)
        before = shown.words(0)
        for steps in (1, -1):
            if shown.words(0) == before:
                shown.change(0, steps)
        assert shown.choose(0, 0) == BACK and shown.words(0) != before, row
    texts.speak("en")
    assert anew == [
        "baud", "second_stop", "reply_timeout_ms", "lost_ms", "setpoint_centihertz",
        "lowest_centihertz", "highest_centihertz",
    ]  # fmt: skip


def test_there_is_no_setting_for_what_the_board_has_not():
    def start(board):
        board.backlight = board.serial = None
        return main.start(board)

    world = World(start)
    world.run(1000)
    lists(world, "SETTINGS")
    shown = entries(world)
    assert "BAUD 19200" in shown and "LANG. English" in shown, shown
    assert not [row for row in shown if row.startswith(("LIGHT", "LOG"))], shown


def test_a_setting_is_changed_within_its_limits_and_kept():
    world = panel()
    setting(world, "STEP")
    assert row_1(world) == "UP DOWN SET=KEEP"
    assert row_2(world) == ">STEP 0.10 Hz", world.lcd()
    press(world, "UP", "UP")
    assert row_2(world) == ">STEP 0.12 Hz"
    press(world, "PARAM")  # as it was
    press(world, "SET")
    assert row_2(world) == ">STEP 0.10 Hz", world.lcd()
    for _ in range(12):
        press(world, "DOWN")
    assert row_2(world) == ">STEP 0.01 Hz", world.lcd()
    press(world, "SET")
    assert row_2(world) == "KEPT", world.lcd()
    press(world, "PARAM", "PARAM")
    world.run(4000)
    assert kept(world)["setpoint_step_centihertz"] == 1
    press(world, "DOWN")  # it acts at once
    world.run(200)
    assert row_1(world).startswith("S: 10.0 "), world.lcd()
    for _ in range(5):
        press(world, "DOWN")
    assert row_1(world).startswith("S:  9.9 "), world.lcd()
    world.check()


def test_a_setting_of_the_bus_acts_when_the_panel_has_begun_anew():
    world = panel()
    setting(world, "BAUD")
    press(world, "UP")
    assert row_2(world) == ">BAUD 38400", world.lcd()
    world.down("SET")
    said = set()
    for _ in range(100):
        world.run(10)
        said.add(" ".join(" ".join(world.lcd()).split()))
    world.up("SET")
    assert "THE PANEL BEGINS ANEW" in said, said
    world.run(4000)
    assert row_2(world) == "NO CONTACT   A1", world.lcd()  # the drive has another rate
    assert kept(world)["baud"] == 38400
    setting_back = ("SET", "DOWN", "SET")
    menu_from_search(world)
    press(world, *setting_back)
    world.run(4000)
    press(world, "STOP")  # it has tripped meanwhile: nobody spoke at its rate
    wait_until_known(world)
    assert kept(world)["baud"] == 19200 and starts(world) == 0


def menu_from_search(world):
    """SETTINGS, of a panel whose drive is silent: its menu begins elsewhere."""
    world.down("PARAM")
    world.run(1500)
    world.up("PARAM")
    world.run(300)
    while row_2(world) != ">SETTINGS":
        press(world, "DOWN")
    press(world, "SET")


def test_the_lowest_setpoint_does_not_pass_the_highest():
    """A file that says so has the defaults for both at the next power-on."""
    world = World(main.start, settings={"lowest_centihertz": 1000, "highest_centihertz": 1002})
    world.run(3000)
    setting(world, "LOW")
    press(world, "UP", "UP", "UP", "UP")
    assert row_2(world) == ">LOW 10.02 Hz", world.lcd()
    press(world, "PARAM", "DOWN", "SET", "DOWN", "DOWN", "DOWN", "DOWN")
    assert row_2(world) == ">HIGH 10.00 Hz", world.lcd()


def test_how_soon_and_how_fast_a_key_repeats_is_a_setting():
    """And a key that is held for a second is held for a second, whatever that is."""
    for delay_ms, repeat_ms in ((400, 120), (900, 500), (200, 40), (900, 40)):
        world = World(main.start, settings={"key_delay_ms": delay_ms, "key_repeat_ms": repeat_ms})
        world.run(3000)
        before = row_1(world)
        world.down("UP")
        world.run(delay_ms + repeat_ms // 2)
        world.up("UP")
        world.run(300)
        assert (before[:7], row_1(world)[:7]) == ("S: 10.0", "S: 10.2"), world.lcd()
        world.down("PARAM")
        world.run(950)
        assert not row_1(world).startswith("MENU"), delay_ms
        world.run(650)
        assert row_1(world).startswith("MENU"), delay_ms
        world.up("PARAM")


def test_no_setting_is_changed_while_a_motor_runs():
    world = running()
    menu(world)
    press(world, "DOWN", "DOWN", "DOWN", "SET", "SET", "UP", "SET")
    assert row_2(world) == "STOP ALL FIRST", world.lcd()
    world.run(4000)
    assert row_2(world) == ">BAUD 38400" and world.app.settings.baud == 19200, world.lcd()
    assert world.drives[1].state == "running"


def test_what_acts_at_once_is_changed_beside_a_motor_that_runs():
    world = running()
    setting(world, "KEY RATE")
    press(world, "DOWN", "SET")
    assert row_2(world) == "KEPT", world.lcd()
    world.run(4000)
    assert world.drives[1].state == "running" and kept(world).get("key_repeat_ms") is None
    press(world, "STOP")
    world.run(9000)
    assert kept(world)["key_repeat_ms"] == 119  # saved when it stands
    world.check()


def test_beside_a_motor_that_runs_keys_light_and_words_can_be_set_and_nothing_of_the_bus():
    world = running()
    settings = world.app.settings
    for name, acts, key, row in (
        ("baud", False, "UP", ">BAUD 38400"),
        ("second_stop", False, "UP", ">2ND STOP OFF2"),
        ("reply_timeout_ms", False, "UP", ">REPLY 21 ms"),
        ("lost_ms", False, "UP", ">LOST 1001 ms"),
        ("setpoint_centihertz", False, "UP", ">START 10.01 Hz"),
        ("setpoint_step_centihertz", True, "UP", ">STEP 0.11 Hz"),
        ("lowest_centihertz", False, "UP", ">LOW 0.01 Hz"),
        ("highest_centihertz", False, "DOWN", ">HIGH 649.99 Hz"),
        ("key_delay_ms", True, "UP", ">KEY WAIT 401 ms"),
        ("key_repeat_ms", True, "UP", ">KEY RATE 121 ms"),
        ("light_minutes", True, "UP", ">LIGHT 1 min"),
        ("log", True, "UP", ">LOG JSON"),
        ("language", True, "UP", ">LANG. Deutsch"),  # before the one above, and last here
    ):
        before = getattr(settings, name)
        if name == "baud":
            setting(world, "BAUD")
        else:
            press(world, *{"log": ("DOWN", "DOWN"), "language": ("UP",)}.get(name, ("DOWN",)))
            press(world, "SET")
        press(world, key)
        assert row_2(world) == row, world.lcd()
        press(world, "SET")
        assert (getattr(settings, name) != before) == acts, (name, world.lcd())
        if not acts:
            assert row_2(world) == "STOP ALL FIRST", (name, world.lcd())
            press(world, "PARAM")
    assert world.drives[1].state == "running"


def test_stop_acts_everywhere_in_the_menu_and_no_other_key_moves_a_motor():
    settings = ("DOWN", "DOWN", "DOWN", "SET")
    for way in (
        (), ("SET",), ("SET", "SET"), ("SET", "SET", "DOWN", "DOWN", "SET"), ("DOWN", "SET"),
        settings, settings + ("SET",), ("UP", "SET"),
    ):  # fmt: skip
        world = running()
        menu(world)
        press(world, *way)
        before = world.drives[1].hz()
        for key in KEYS:
            press(world, key)
        assert world.drives[1].hz() == before and starts(world) == 1, way
        pressed_us = world.clock.now_us
        world.down("STOP")
        world.run(500)
        assert world.reads("STOP, HOLD: OFF3"), (way, world.lcd())
        world.up("STOP")
        offs = [at_us for at_us, stw in telegrams(world, pressed_us, 1) if stw == OFF1]
        assert offs and offs[0] - pressed_us < 100_000, way
        world.run(4000)
        assert world.drives[1].hz() == 0
        world.check()


def lists(world, name):
    """Open this list of the menu."""
    menu(world)
    while row_2(world) != ">" + name:
        press(world, "DOWN")
    press(world, "SET")


def test_no_panel_begins_anew_beside_a_motor_that_runs():
    world = running()
    app_before = world.app
    world.app.panel.wants = "app"
    world.run(1000)
    assert world.app is app_before and row_2(world) == "RUNNING      A1", world.lcd()
    assert world.drives[1].state == "running"
    world.check()


def test_the_order_of_the_drives_is_that_of_the_address_keys():
    world = panel(addresses=(1, 2, 3))
    lists(world, "ORDER")
    assert world.lcd() == ("ORDER        1/3", ">A1             "), world.lcd()
    press(world, "DOWN", "DOWN", "SET")
    assert world.lcd() == ("SET=KEEP     3/3", ">A3  UP DOWN    "), world.lcd()
    press(world, "UP", "SET")
    assert entries(world) == ["A3", "A2", "A1"]
    press(world, "PARAM")
    assert world.reads("THE PANEL BEGINS ANEW") or world.reads("EMERGENCY STOP"), world.lcd()
    world.run(3000)
    seen = []
    for _ in range(4):
        wait_until_known(world)
        seen.append(row_2(world)[-2:])
        press(world, "ADDRESS_UP")
    assert seen == ["A1", "A3", "A2", "A1"] and kept(world)["drives"] == [1, 3, 2]
    press(world, "ADDRESS_DOWN")
    lists(world, "ORDER")
    press(world, "UP", "SET", "UP", "SET", "PARAM")  # and back
    world.run(3000)
    assert kept(world)["drives"] == [1, 2, 3]
    assert max(starts(world, address) for address in (1, 2, 3)) == 0
    world.check()


def test_a_drive_that_is_carried_goes_round_and_a_menu_that_closes_keeps_nothing():
    world = panel(addresses=(1, 2, 3))
    lists(world, "ORDER")
    press(world, "SET", "DOWN", "SET")
    assert world.lcd() == ("ORDER        2/3", ">A1             "), world.lcd()
    press(world, "SET", "UP", "UP", "SET")
    assert row_1(world) == "ORDER        3/3"
    assert entries(world) == ["A1", "A2", "A3"]
    world.run(62_000)
    assert kept(world)["drives"] == [1, 2, 3]
    assert row_2(world) == "READY        A1", world.lcd()
    world.check()


def asked(world, address, ms=4000):
    """How many telegrams this drive gets in a second."""
    since_us = world.clock.now_us
    world.run(ms)
    return len(telegrams(world, since_us, address)) * 1000 / ms


def test_a_drive_that_stands_several_times_in_the_list_is_asked_more_often():
    world = panel(addresses=(1, 2, 3, 4))
    wait_until_known(world)
    world.run(10_000)  # all are known
    lists(world, "TURNS")
    press(world, "DOWN", "SET", "UP", "UP")
    assert world.lcd() == ("SET=KEEP     2/4", ">A2  x3         "), world.lcd()
    press(world, "SET")
    world.run(4000)
    wait_until_known(world)
    assert kept(world)["repeats"] == {"2": 3}
    world.run(10_000)
    rates = [asked(world, address) for address in (2, 3, 4)]
    assert 2.5 < rates[0] / rates[1] < 3.5 and 0.8 < rates[1] / rates[2] < 1.2, rates
    list_of = [drive.address for drive in world.app.bus.turns.list]
    assert sorted(list_of) == [1, 2, 2, 2, 3, 4]
    spans = [place for place, address in enumerate(list_of + list_of) if address == 2]
    assert max(after - before for before, after in zip(spans, spans[1:])) <= 3, list_of
    lists(world, "TURNS")
    press(world, "DOWN", "SET", "DOWN", "DOWN", "SET")
    world.run(4000)
    assert kept(world)["repeats"] == {}
    world.check()


def test_nobody_stands_in_the_list_less_than_once_or_more_than_four_times():
    world = panel(addresses=(1, 2))
    lists(world, "TURNS")
    press(world, "SET")
    for keys, told in (("DOWN", "x1"), ("UP", "x2"), (5 * "UP ", "x4"), ("DOWN", "x3")):
        press(world, *keys.split())
        assert row_2(world) == ">A1  " + told, (keys, world.lcd())
    press(world, "PARAM")
    assert row_2(world) == ">TURNS" and not kept(world).get("repeats"), world.lcd()


def test_turns_follow_a_drive_that_comes_goes_or_gets_another_address():
    world = World(main.start, (1, 2, 3, 9), settings={"drives": [1, 2, 3], "repeats": {"2": 2}})
    world.run(3000)
    wait_until_known(world)
    turns = world.app.bus.turns
    assert sorted([drive.address for drive in turns.list]) == [1, 2, 2, 3]
    world.app.panel.add(9, "mm420")
    world.run(3000)
    assert sorted([drive.address for drive in turns.list]) == [1, 2, 2, 3, 9]
    world.app.panel.show(world.app.panel.controls[1])
    world.app.panel.remove()
    world.run(3000)
    assert [drive.address for drive in turns.list] == [1, 3, 9]
    assert kept(world)["repeats"] == {} and kept(world)["drives"] == [1, 3, 9]
    world.check()


def test_who_is_asked_more_often_waits_until_it_is_known_how_soon_each_drive_trips():
    """Drive 2 has just been switched on again."""
    world = panel(addresses=(1, 2))
    wait_until_known(world)
    world.drives[2].power_off()
    lists(world, "TURNS")
    press(world, "SET", "UP")
    world.run(2000)
    world.drives[2].power_on()
    while not world.app.bus.turns.at(2).contact:
        world.run(20)
    world.press("SET")
    world.run(200)
    assert row_2(world) == "NO: STILL CHECKS", world.lcd()
    assert not kept(world).get("repeats")
    world.run(8000)
    press(world, "SET", "UP", "SET")
    world.run(3000)
    assert kept(world)["repeats"] == {"1": 2}, world.lcd()
    world.check()


def turns_taken(off_ms):
    """What is said when drive 1 of four is to be asked twice as often, and drive 3 trips then."""
    world = World(
        main.start, (1, 2, 3, 4), kinds={3: {"parameters": {2014: off_ms}}},
        parameters={2014: 5000}, settings={"unsupervised": [3]},
    )  # fmt: skip
    world.run(8_000)
    lists(world, "TURNS")
    press(world, "SET", "UP", "SET")
    return world, row_2(world)


def test_three_rounds_of_late_answers_have_room_in_the_telegram_off_time_of_each_drive():
    world = panel()
    turns = world.app.bus.turns
    needed_ms = 3 * (turns.longest_cycle_us(5 * [turns.at(1)]) // 1000 + 1)
    short = "A3: P2014 SHORT"
    for off_ms, told in ((1, short), (needed_ms - 1, short), (needed_ms, ""), (0, "")):
        world, row = turns_taken(off_ms)
        assert row == told or not told and "SHORT" not in row, (off_ms, world.lcd())
        world.run(4000)
        assert kept(world).get("repeats", {}) == ({} if told else {"1": 2}), off_ms


def test_a_round_that_becomes_shorter_is_taken_though_it_is_too_long_still():
    world = World(
        main.start, (1, 2, 3, 4), kinds={3: {"parameters": {2014: 300}}},
        parameters={2014: 5000}, settings={"repeats": {"1": 4}},
    )  # fmt: skip
    world.run(15_000)
    lists(world, "TURNS")
    press(world, "SET", "DOWN", "SET")
    world.run(3000)
    assert kept(world)["repeats"] == {"1": 3}, world.lcd()


def test_nobody_is_asked_so_often_that_another_one_trips():
    world = World(
        main.start, (1, 2, 3, 4), kinds={3: {"parameters": {2014: 600}}}, parameters={2014: 5000}
    )
    world.run(15_000)
    lists(world, "TURNS")
    press(world, "SET", "UP")
    press(world, "SET")
    assert row_2(world) == "A3: P2014 SHORT", world.lcd()
    world.run(4000)
    assert not kept(world).get("repeats") and row_2(world) == ">A1  x1", world.lcd()
    world.check()


def test_an_order_is_not_kept_while_a_motor_runs_that_somebody_has_started_at_the_drive():
    world = panel(addresses=(1, 2))
    wait_until_known(world)
    world.run(3000)
    lists(world, "ORDER")
    press(world, "SET", "DOWN", "SET")
    world.drives[2].write(700, 0, 2)
    world.drives[2].process.zsw = lambda: 0xFB34
    world.run(1000)
    press(world, "PARAM")
    assert row_2(world) == "STOP ALL FIRST", world.lcd()
    world.run(3000)
    assert world.app.settings.drives == (1, 2) and row_2(world) == ">ORDER", world.lcd()


def test_order_and_turns_are_not_changed_while_a_motor_runs():
    for name in ("ORDER", "TURNS"):
        world = panel(addresses=(1, 2))
        wait_until_known(world)
        press(world, "START")
        world.run(4000)
        lists(world, name)
        press(world, "SET")
        if name == "TURNS":
            press(world, "UP", "SET")
        assert world.reads("STOP ALL FIRST"), (name, world.lcd())
        assert world.drives[1].state == "running"
        world.run(3000)
        press(world, "PARAM")  # nothing was changed, so there is nothing to stop for
        assert row_2(world) == ">" + name, world.lcd()
        world.check()


def test_a_value_that_was_not_changed_is_left_alone_and_no_panel_begins_anew():
    """Not even beside a motor that runs: there is nothing to stop for."""
    world = running()
    setting(world, "BAUD")
    press(world, "UP", "DOWN", "SET")
    assert row_2(world) == ">BAUD 19200" and row_1(world).startswith("SETTINGS"), world.lcd()
    assert world.drives[1].state == "running" and starts(world) == 1
    world.check()


def test_order_and_turns_are_there_where_there_are_two_drives_or_more():
    for addresses, are_there in (((1,), False), ((1, 2), True)):
        world = panel(addresses=addresses)
        menu(world)
        shown = entries(world)
        assert ("ORDER" in shown, "TURNS" in shown) == (are_there, are_there), shown
        assert shown[:5] == ["DRIVES", "ANY ADDRESS", "FIND DRIVES", "SETTINGS", "SETS"], shown


def test_a_drive_without_pkw_words_has_no_parameters_in_the_menu():
    world = World(
        main.start, (1, 2), kinds=simulated(listed_drives("1=mm420/0,2")),
        settings={"kinds": {"1": "mm420/0"}},
    )  # fmt: skip
    world.run(3000)
    for key, has in ((None, False), ("ADDRESS_UP", True)):
        if key:
            press(world, key)
            wait_until_known(world)
        menu(world)
        shown = entries(world)
        for name in ("PARAMETERS", "COMMISSION", "FAULT MEMORY"):
            assert (name in shown) == has, (key, shown)
        assert "EVENTS" in shown and "DIAGNOSIS" in shown, shown
        press(world, "PARAM")


def test_set_on_the_speed_of_a_drive_leads_nowhere():
    world = panel(addresses=(1, 2))
    wait_until_known(world)
    menu(world)
    press(world, "SET", "DOWN", "SET", "UP")
    assert world.lcd() == ("A2           7/7", ">0.00 Hz        "), world.lcd()
    press(world, "SET")
    assert world.lcd() == ("A2           7/7", ">0.00 Hz        "), world.lcd()


def test_an_alarm_closes_it():
    world = running()
    menu(world)
    press(world, "SET")
    world.drives[1].unplug()
    world.run(3000)
    assert world.reads("MAY RUN") and not world.reads("DRIVES"), world.lcd()


def told(world, ms=3000):
    """Wait until it is known whether somebody answers at the address that is shown."""
    world.run(200)
    for _ in range(ms // 50):
        if not row_2(world).endswith("..."):
            return
        world.run(50)
    raise AssertionError(world.lcd())


def test_a_drive_of_any_family_layout_and_link_is_taken_from_its_address_as_what_it_is():
    for kind, as_what in (
        ("mm440/4+8", "mm440/4+8"),
        ("mm440/127+5", "mm440/127+5"),
        ("mm420/3+4", "mm420/3+4"),
        ("mm440-bop", "mm420-bop"),
        ("v20", "v20"),
        ("g110/4+3", "g110/4+3"),
        ("g120", "g120"),
        ("mm3", "mm3"),
        ("g110/0", "generic/0"),
        ("generic/3+6", "mm440/3+6"),  # it has the same parameters
    ):
        kinds = simulated(listed_drives("7=" + kind))
        world = World(main.start, (1, 7), settings={"drives": [1]}, kinds=kinds)
        world.run(3000)
        world.down("ADDRESS_UP")
        world.run(1400)
        world.up("ADDRESS_UP")
        world.run(100)
        while not row_2(world).startswith(">A7 "):
            press(world, "ADDRESS_UP")
        told(world)
        assert row_2(world) == ">A7  ANSWERS", (kind, world.lcd())
        press(world, "SET")
        for _ in range(60):
            world.run(100)
            if not row_2(world).startswith(">"):
                break
        world.run(200)  # for the display
        assert row_2(world) == "A7 ADDED", (kind, world.lcd())
        wait_until_known(world)
        world.run(200)
        found = world.app.settings.kinds.get("7")
        assert found == as_what, (kind, found)
        assert row_2(world) == "READY        A7" and starts(world, 7) == 0, (kind, world.lcd())
        world.check()


def test_a_drive_of_any_fixed_length_answers_at_its_address():
    """Of each length that a family has with 2...8 PZD words one."""
    layouts = ("3+2", "4+2", "0+2", "4+4", "4+3", "0+4", "0+3", "3+6", "4+6", "4+7", "4+8")
    text = ",".join(["%d=mm440/%s" % (2 + place, one) for place, one in enumerate(layouts)])
    kinds = simulated(listed_drives(text))
    world = World(main.start, tuple(range(1, 13)), settings={"drives": [1]}, kinds=kinds)
    world.run(1000)
    lists(world, "ANY ADDRESS")
    for place, layout in enumerate(layouts):
        press(world, "ADDRESS_UP")
        assert comes_to(world, ">A%-2d ANSWERS" % (2 + place)), (layout, world.lcd())


def test_a_drive_that_takes_any_length_is_known_for_that_though_an_answer_is_lost():
    """Two lengths that it answers tell: 10 net characters, and 12."""
    lost = []

    def lose_one(reply):
        if reply[2] & MIRROR and len(reply) == 12 + 4 and not lost:
            lost.append(reply)
            return with_a_wrong_check(reply)
        return reply

    kinds = simulated(listed_drives("2=mm440/127+5"))
    world = World(main.start, (1, 2), settings={"drives": [1]}, kinds=kinds)
    spoil(world.wire, world.drives[2], lose_one)
    world.run(3000)
    lists(world, "ANY ADDRESS")
    press(world, "ADDRESS_UP")
    assert comes_to(world, ">A2  ANSWERS"), world.lcd()
    press(world, "SET")
    assert row_2(world) == ">A2  ...", world.lcd()
    assert comes_to(world, "A2 ADDED"), world.lcd()
    assert lost and world.app.settings.kinds["2"] == "mm440/127+5", world.app.settings.kinds


def test_a_drive_that_nobody_can_command_is_not_added():
    kinds = simulated(listed_drives("7=mm440"))
    kinds[7]["parameters"] = {2012: 0, 2014: 0}
    world = World(main.start, (1, 7), settings={"drives": [1]}, kinds=kinds)
    world.run(3000)
    world.down("ADDRESS_DOWN")
    world.run(1400)
    world.up("ADDRESS_DOWN")
    while not row_2(world).startswith(">A7 "):
        press(world, "ADDRESS_UP")
    told(world)
    press(world, "SET")
    for _ in range(60):
        world.run(100)
        if not row_2(world).startswith(">"):
            break
    world.run(200)
    assert row_2(world) == "A7 NOT ADDED", world.lcd()
    assert world.app.settings.drives == (1,) and "7" not in world.app.settings.kinds
    world.check()


def test_an_alarm_closes_it_also_while_a_picture_of_it_is_drawn():
    for step in range(24):
        world = running()
        menu(world)
        world.run(3 * step)
        world.drives[1].unplug()
        world.run(2500)
        assert world.reads("MAY RUN") and not world.reads("DRIVES"), world.lcd()
        world.check()


def test_who_turns_to_another_address_while_a_drive_is_asked_takes_the_other_one():
    kinds = simulated(listed_drives("7=mm440,8=mm3"))
    for ms in (50, 200, 350):
        world = World(main.start, (1, 7, 8), settings={"drives": [1]}, kinds=kinds)
        world.run(3000)
        world.down("ADDRESS_UP")
        world.run(1400)
        world.up("ADDRESS_UP")
        while not row_2(world).startswith(">A7 "):
            press(world, "ADDRESS_UP")
        told(world)
        world.press("SET")
        world.run(ms)  # A7 is being asked what it is
        press(world, "ADDRESS_UP")
        told(world)
        assert row_2(world) == ">A8  ANSWERS", (ms, world.lcd())
        press(world, "SET")
        for _ in range(60):
            world.run(100)
            if row_2(world) == "A8 ADDED":
                break
        assert row_2(world) == "A8 ADDED", (ms, world.lcd())
        world.run(2000)
        assert world.app.settings.kinds["8"] == "mm3" and "7" not in world.app.settings.kinds, ms
        world.check()


def test_an_address_key_that_is_held_leaves_the_list_and_counts_through_all_addresses():
    world = World(main.start, (1, 4, 6), settings={"drives": [1]},
                  kinds={6: {"parameters": {2013: 127, 2014: 2000}}})  # fmt: skip
    world.run(3000)
    world.down("ADDRESS_UP")
    world.run(1400)
    assert row_1(world).startswith("ANY ADDRESS"), world.lcd()
    world.run(400)
    world.up("ADDRESS_UP")
    world.run(2000)
    seen = {}
    for _ in range(32):
        told(world)
        seen[row_2(world)[1:4].strip()] = row_2(world)[5:].strip()
        press(world, "ADDRESS_UP")
    assert len(seen) == 32, seen
    assert (seen["A1"], seen["A4"], seen["A6"]) == ("IN THE LIST", "ANSWERS", "ANSWERS"), seen
    assert list(seen.values()).count("NOBODY") == 29, seen
    for address in (4, 6):
        while not row_2(world).startswith(">A%d " % address):
            press(world, "ADDRESS_UP")
        world.run(1000)
        press(world, "SET")
        for _ in range(30):
            world.run(100)
            if row_2(world) == "A%d ADDED" % address:
                break
        assert row_2(world) == "A%d ADDED" % address, world.lcd()
        world.run(4000)
        press(world, "STOP")  # it has tripped since it was asked and left alone
        wait_until_known(world)
        assert row_2(world) == "READY        A%d" % address
        world.down("ADDRESS_UP")
        world.run(1400)
        world.up("ADDRESS_UP")
    world.run(4000)
    stored = json.loads(world.flash.files["settings.json"].decode())
    assert stored["drives"] == [1, 4, 6] and stored["kinds"] == {"6": "mm420/127"}
    assert starts(world) == starts(world, 4) == starts(world, 6) == 0
    world.check()


def test_set_takes_only_a_drive_that_answers_and_is_not_in_the_list():
    world = panel(addresses=(1, 2))
    lists(world, "ANY ADDRESS")
    for key, shown in ((None, ">A1  IN THE LIST"), ("UP", ">A0  NOBODY")):
        if key:
            press(world, key)
        assert comes_to(world, shown), world.lcd()
        press(world, "SET")
        assert row_2(world) == shown, world.lcd()
        world.run(2000)
        assert row_2(world) == shown and world.app.settings.drives == (1, 2), world.lcd()


def test_an_address_is_asked_in_the_share_of_the_line_that_silent_drives_have():
    """A fifth of its time: so nobody is asked more than five or six times in a second."""
    world = panel()
    lists(world, "ANY ADDRESS")
    press(world, "UP")
    assert comes_to(world, ">A0  NOBODY"), world.lcd()
    since_us = world.clock.now_us
    world.run(5000)
    log = world.wire.log.last(1000)
    asked = [data for at_us, sent, data in log if sent and at_us > since_us and data[2] & MIRROR]
    assert 20 < len(asked) < 40, len(asked)


def test_addresses_are_looked_at_beside_a_motor_that_runs():
    world = World(main.start, (1, 4), settings={"drives": [1]})
    world.run(3000)
    press(world, "START")
    world.run(3000)
    world.down("ADDRESS_UP")
    world.run(12_000)
    world.up("ADDRESS_UP")
    assert world.drives[1].state == "running" and row_1(world), world.lcd()
    press(world, "STOP")
    world.run(6000)
    assert world.drives[1].hz() == 0
    world.check()


def chosen(world, what, wanted, setting=None):
    """Choose for drive 1 what it is, and wait for the panel, which begins anew. setting: what
    somebody changes at the drive, too: number and value."""
    menu(world)
    press(world, "SET", "SET")
    go_to(world, what)
    press(world, "SET")
    go_to(world, wanted)
    press(world, "SET")
    if setting:
        world.drives[1].write(setting[0], 0, setting[1])
    world.run(4000)
    stored = world.flash.files.get("settings.json", b'{"kinds": {}}')
    return json.loads(bytes(stored).decode())["kinds"].get("1", "mm420")


def go_to(world, start, most=40):
    for _ in range(most):
        if row_2(world).startswith(">" + start):
            return
        press(world, "DOWN")
    raise AssertionError((start, world.lcd()))


def test_family_layout_and_link_of_a_drive_are_chosen():
    """What the next family can have, too, stays; what only one family has is not offered."""
    kinds = simulated(listed_drives("1=mm440"))
    world = World(main.start, (1,), kinds=kinds)
    world.run(1000)
    wait_until_known(world)
    assert chosen(world, "FAMILY", "FAMILY MM440") == "mm440"
    assert row_2(world) == "READY        A1", world.lcd()
    assert chosen(world, "PZD", "PZD 6 WORDS", (2012, 6)) == "mm440/4+6"
    assert row_2(world) == "READY        A1", world.lcd()
    assert chosen(world, "PKW", "PKW 127 WORDS", (2013, 127)) == "mm440/127+6"
    assert row_2(world) == "READY        A1", world.lcd()
    assert chosen(world, "FAMILY", "FAMILY V20") == "v20/127+6"
    assert chosen(world, "FAMILY", "FAMILY MM430") == "mm430/127+6"
    assert chosen(world, "LINK", "LINK BOP") == "mm430-bop/127+6"
    assert chosen(world, "FAMILY", "FAMILY MM440") == "mm440-bop/127+6"
    press(world, "START")
    assert row_2(world) == "NO:P0700 NOT USS", world.lcd()
    press(world, "PARAM")  # it is not P0700 that is wrong, but what the panel was told
    assert chosen(world, "LINK", "LINK RS-485") == "mm440/127+6"
    assert chosen(world, "FAMILY", "FAMILY MM3") == "mm3"
    assert starts(world) == 0
    world.check()


def test_other_pzd_words_leave_the_requests_short_and_other_pkw_words_do_not():
    settings = {"kinds": {"1": "mm440/127s"}}
    world = World(main.start, (1,), kinds=simulated(listed_drives("1=mm440")), settings=settings)
    world.drives[1].write(2013, 0, 127)
    world.run(2000)
    wait_until_known(world)
    assert chosen(world, "PZD", "PZD 4 WORDS", (2012, 4)) == "mm440/127s+4"
    assert chosen(world, "PKW", "PKW 4 WORDS", (2013, 4)) == "mm440/4+4"
    assert chosen(world, "PKW", "PKW 127 WORDS", (2013, 127)) == "mm440/127+4"


def test_without_contact_a_family_comes_with_its_own_layout_and_link():
    """Nobody knows whether the ones that it had are right."""
    settings = {"kinds": {"1": "mm440", "2": "mm440-bop/4+6"}}
    kinds = simulated(listed_drives("1=mm440,2=mm440-bop"))
    world = World(main.start, (1, 2), kinds=kinds, settings=settings)
    world.drives[2].unplug()
    world.run(1000)
    wait_until_known(world)
    menu(world)
    press(world, "SET", "DOWN", "SET")
    for what in ("FAMILY", "FAMILY V20"):
        go_to(world, what)
        press(world, "SET")
    world.run(4000)
    assert kept(world)["kinds"] == {"1": "mm440", "2": "v20"}


def test_choosing_begins_with_the_first_where_the_drive_has_what_its_family_has_not():
    """It was found by trying: the family in the list is the wrong one."""
    settings = {"kinds": {"1": "mm420"}}
    world = World(
        main.start, (1,), kinds=simulated(listed_drives("1=mm440/4+8")), settings=settings
    )
    for _ in range(60):
        world.run(1000)
        if world.app.panel.selected.drive.contact:
            break
    world.run(1000)
    menu(world)
    press(world, "SET", "SET")
    go_to(world, "PZD 8")
    press(world, "SET")
    assert world.lcd() == ("PZD WORDS    1/3", ">PZD 2 WORDS    "), world.lcd()


def test_each_choice_is_one_that_the_family_has():
    for kind, offered in (
        ("mm3", (1, 1, 1)),
        ("mm420", (4, 3, 2)),
        ("mm440-bop", (4, 7, 2)),
        ("g110", (4, 3, 1)),
        ("v20", (4, 7, 1)),
        ("g120", (4, 7, 1)),
        ("generic", (4, 15, 1)),
    ):
        world = World(
            main.start, (1,), kinds=simulated(listed_drives("1=" + kind)),
            settings={"kinds": {"1": kind}},
        )  # fmt: skip
        world.run(2000)
        menu(world)
        press(world, "SET", "SET")
        for what, count in zip(("PKW", "PZD", "LINK"), offered):
            go_to(world, what)
            as_it_is = row_2(world)
            press(world, "SET")
            assert row_2(world) == as_it_is, (kind, what, world.lcd())  # where the list begins
            assert len(entries(world)) == count, (kind, what, entries(world))
            press(world, "SET")  # it is that already
            assert row_2(world) == as_it_is and row_1(world).startswith("A1"), (kind, what)


def test_what_a_drive_is_does_not_change_while_a_motor_runs():
    world = running()
    before = world.app.settings.kinds
    for what, wanted in (("FAMILY", "FAMILY V20"), ("PKW", "PKW 0"), ("LINK", "LINK BOP")):
        menu(world)
        press(world, "SET", "SET")
        go_to(world, what)
        press(world, "SET")
        go_to(world, wanted)
        press(world, "SET")
        assert row_2(world) == "STOP ALL FIRST", (what, world.lcd())
        press(world, "PARAM", "PARAM", "PARAM", "PARAM")
        assert world.app.settings.kinds == before == {} and world.drives[1].state == "running"
    world.check()


def test_without_contact_the_menu_begins_with_the_reason():
    world = panel()
    world.drives[1].unplug()
    world.run(3000)
    world.down("PARAM")
    world.run(1500)
    world.up("PARAM")
    world.run(300)
    assert row_2(world) == ">WHY NO CONTACT", world.lcd()


def test_an_alarm_that_was_there_before_does_not_lock_it():
    """A drive at another rate never confirms a STOP, and the rate is changed in the menu."""
    world = panel(baud=9600, settings={"baud": 19200})
    world.run(3000)
    press(world, "STOP")
    world.run(2000)
    assert row_2(world) == "STOP UNCONFIRMED", world.lcd()
    world.down("PARAM")
    world.run(1500)
    world.up("PARAM")
    seen = set()
    for _ in range(30):
        world.run(100)
        seen.add(world.lcd())
    assert all([rows[1].startswith(">") for rows in seen]), seen
    assert any([rows[0].startswith("A1 NOT STOPPED") for rows in seen]), seen
    titles = []
    for _ in range(100):  # the title comes in turn with it, again and again
        world.run(100)
        titles.append(row_1(world).startswith("MENU "))
    assert 35 < titles.count(True) < 65 and True in titles[-40:], titles


def test_a_panel_that_nobody_has_set_up_offers_to_find_drives():
    world = panel()
    world.flash.files.clear()
    world.reset()
    world.run(4000)
    assert row_2(world) == "SET=DO  PARAM=NO", world.lcd()
    press(world, "PARAM")
    assert row_2(world) == "READY        A1", world.lcd()
    world.run(5000)
    assert row_2(world) == "READY        A1", world.lcd()


def test_the_panel_does_not_leave_a_motor_that_was_started_while_it_asked_about_the_search():
    """At its terminals: SET is refused then."""
    world = panel()
    wait_until_known(world)
    lists(world, "FIND DRIVES")
    press(world, "DOWN", "SET")
    assert row_2(world) == "SET=DO  PARAM=NO", world.lcd()
    world.drives[1].write(700, 0, 2)
    world.drives[1].process.zsw = lambda: 0xFB34
    world.run(200)
    press(world, "SET")
    assert row_2(world) == "STOP ALL FIRST", world.lcd()
    world.run(1000)
    assert world.app.panel.wants is None and telegrams(world, world.clock.now_us - 100_000)


# --- the panel begins anew -----------------------------------------------------------------------


def interrupted_start(world, at):
    """The next panel that starts is ended by Ctrl-C, before its bus is at work or right after."""
    start = app.App.start

    def start_and_end(one):
        if at == "after":
            start(one)
        raise KeyboardInterrupt

    app.App.start = start_and_end
    world.app.panel.wants = "app"
    try:
        world.run(2000)
        raise AssertionError("it was to be ended")
    except KeyboardInterrupt:
        world.app.close()  # as `main.loop` does
    finally:
        app.App.start = start


def test_ctrl_c_while_the_panel_begins_anew_leaves_no_telegram_behind():
    for at in ("before", "after"):
        world = panel()
        interrupted_start(world, at)
        world.clock.advance(100_000)
        sent = world.wire.log.count
        world.clock.advance(1_000_000)
        assert world.wire.log.count == sent, at


class Watched:
    """An app; `most` is how many modules came into memory in one step at the most."""

    def __init__(self, app):
        self.app = app
        self.panel = app.panel
        self.most = 0
        self._seen = list(sys.modules)

    def step(self):
        self.app.step()
        modules = list(sys.modules)
        if modules != self._seen:
            self.most = max(self.most, len(set(modules) - set(self._seen)))
            self._seen = modules
        return self


def test_no_step_of_the_loop_waits_for_two_modules_of_the_menu():
    world = panel()
    world.app = watched = Watched(world.app)
    for entry in range(5):
        menu(world)
        press(world, *(entry * ("DOWN",) + ("SET", "DOWN", "DOWN", "SET", "UP")))
        while not row_1(world).startswith("S:"):
            press(world, "PARAM")
    assert watched.most == 1
    world.check()


def test_stop_is_for_the_drive_that_is_shown_and_for_the_one_in_row_2():
    world = panel(addresses=(1, 2, 3))
    wait_until_known(world)
    press(world, "START", "ADDRESS_DOWN")
    wait_until_known(world)
    press(world, "START", "ADDRESS_UP")  # A1 and A3 run, and A1 is shown again
    world.run(3000)
    menu(world)
    press(world, "STOP")
    assert row_2(world) == ">A1: STOP", world.lcd()
    assert world.drives[3].state == "running"
    world.run(4000)

    press(world, "PARAM", "START")
    world.run(3000)
    menu(world)
    press(world, "SET", "UP")
    assert row_2(world) == ">A3  RUNNING", world.lcd()
    press(world, "STOP")
    assert row_2(world) == ">A1 A3: STOP", world.lcd()
    world.run(4000)
    assert world.drives[1].state == world.drives[3].state == "ready"
    world.check()


def test_stop_is_for_the_drive_in_row_2_in_each_list_of_drives():
    for way, second in (
        (("SET", "UP", "SET"), "SHOW IT"),
        (("SET", "UP", "SET", "DOWN", "DOWN", "SET"), "FAMILY MM420"),
        ("ORDER", "A3"),
        ("TURNS", "A3  x1"),
    ):
        world = panel(addresses=(1, 2, 3))
        wait_until_known(world)
        press(world, "START", "ADDRESS_DOWN")
        wait_until_known(world)
        press(world, "START", "ADDRESS_UP")
        world.run(3000)
        if type(way) is str:
            lists(world, way)
            press(world, "UP")
        else:
            menu(world)
            press(world, *way)
        assert row_2(world) == ">" + second, (way, world.lcd())
        press(world, "STOP")
        assert row_2(world) == ">A1 A3: STOP", (way, world.lcd())
        world.run(4000)
        assert world.drives[1].state == world.drives[3].state == "ready", way
        world.check()


def test_stop_names_the_drive_that_an_address_key_has_shown_on_its_way_to_any_address():
    world = panel(addresses=(1, 2))
    wait_until_known(world)
    press(world, "START")
    world.run(3000)
    world.press("ADDRESS_UP", 1500)
    world.run(300)
    assert row_1(world).startswith(("ANY ADDRESS", "A1 RUN")), world.lcd()
    press(world, "STOP")
    assert row_2(world) == ">A2: STOP", world.lcd()
    while "A1  IN THE LIST" not in row_2(world):
        press(world, "UP")
    press(world, "STOP")
    assert row_2(world) == ">A2 A1: STOP", world.lcd()
    world.run(4000)
    assert world.drives[1].state == "ready"
    world.check()


def test_a_menu_closes_a_minute_after_the_last_key_and_the_address_keys_do_not_walk_it():
    world = panel()
    wait_until_known(world)
    menu(world)
    for _ in range(2):
        world.run(40_000)
        press(world, "ADDRESS_UP", "ADDRESS_DOWN", "ADDRESS_DOWN")
        assert row_2(world) == ">DRIVES", world.lcd()
    world.run(57_000)
    assert row_2(world) == ">DRIVES", world.lcd()
    world.run(4_000)
    assert row_2(world) == "READY        A1", world.lcd()


def test_a_key_that_moves_a_motor_says_that_the_menu_is_open():
    world = panel()
    wait_until_known(world)
    menu(world)
    for key in ("START", "REVERSE", "JOG_RIGHT", "JOG_LEFT"):
        press(world, key)
        assert row_2(world) == ">NO: IN THE MENU", (key, world.lcd())
        press(world, "DOWN")
        assert "NO:" not in row_2(world), world.lcd()  # the next key takes it away
    press(world, "START")
    world.run(2_300)
    assert row_2(world) == ">NO: IN THE MENU", world.lcd()
    world.run(700)
    assert "NO:" not in row_2(world) and row_2(world).startswith(">"), world.lcd()
    assert starts(world) == 0 and world.drives[1].state == "ready"
    world.check()


def test_whoever_removes_another_drive_still_has_the_one_shown_that_he_had():
    world = panel(addresses=(1, 2, 3))
    wait_until_known(world)
    press(world, "START")
    world.run(3000)
    menu(world)
    press(world, "SET", "DOWN", "SET", "DOWN", "SET")
    assert world.lcd()[1].startswith("A2 REMOVED"), world.lcd()
    press(world, "STOP")
    world.run(4000)
    assert world.drives[1].state == "ready" and row_2(world) == "READY        A1", world.lcd()
    world.check()
