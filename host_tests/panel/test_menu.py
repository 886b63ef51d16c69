# SPDX-License-Identifier: MIT
"""The operator's manual, the menu: PARAM held for a second, UP and DOWN walk, SET, PARAM back."""

import json
import sys

import app
import main
from boards.sim.drives.kinds import listed_drives, simulated
from boards.sim.world import World
from panel import texts
from panel.keys import NAMES as ALL
from panel.keys import Acts, Keys
from panel.menu import BACK, PAGE, Entries
from panel.menu import accepted as accepted_list
from panel.menu import address as address_list
from panel.menu import code as code_page
from panel.menu import drive as drive_list
from panel.menu import find as find_list
from panel.menu import kind as kind_list
from panel.menu import main as main_list
from panel.menu import order as order_list
from panel.menu import settings as setting_list
from panel.menu import turns as turns_list
from panel.menu import value as value_list
from panel.menu import words as menu_words
from panel.menu.engine import Menu
from panel_bench import (
    LOOP_US,
    SlowClock,
    comes_to,
    panel,
    row_1,
    row_2,
    running,
    said,
    starts,
    telegrams,
    wait_until_known,
)  # fmt: skip
from spoilt_bench import spoil, with_a_wrong_check
from uss import families, pkw
from uss.families import MM440, V20
from uss.families.bop import on_bop
from uss.finding.mirror import Mirror
from uss.layout import Layout
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


def press(world, *keys):
    for key in keys:
        world.press(key)
        world.run(300)


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
        world.run(1000)
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


# --- the menu by itself: a panel and a list that note what they are told -------------------------


class Machine:
    """A drive, its control, and the watch of its STOP."""

    is_alarmed = unconfirmed = False

    def __init__(self, address):
        self.drive = self.stop_watch = self
        self.address = address
        self.stopped = 0

    def needs_attention(self):
        return self.is_alarmed

    def stop_unseen(self):
        self.stopped += 1


class Told:
    """A panel with drives 3, which is shown, and 12; and what it was told to do."""

    mask = 0xFFFFF
    page_turns = 0
    time_left = True

    def __init__(self):
        self.announcer = self
        self.controls = [Machine(3), Machine(12)]
        self.selected = self.controls[0]
        self.did, self.lists = [], []

    def has_time(self):
        return self.time_left

    def uncover(self):
        self.did.append("uncover")

    def say(self, now_ms, text):
        self.did.append(text)

    def show_page(self, now_ms, place):
        self.did.append(place)


class Own(Entries):
    """Three entries, the first of which is the argument; what it does is what its fields say."""

    entries, follows, taken, moves = 3, None, False, False
    does = seeks = False
    of_drive = None

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        self.did = []
        panel.lists.append(self)

    def first(self):
        return self.argument

    def count(self):
        return self.entries

    def heading(self, position):
        return b"OWN %d" % len(self.panel.lists)

    def words(self, position):
        return b"ENTRY %d" % position

    def is_busy(self):
        return self.does

    def is_searching(self):
        return self.seeks

    def search(self):
        self.did.append("search")

    def control_at(self, position):
        return self.of_drive

    def choose(self, position, now_ms):
        self.did.append(position)
        return self.follows

    def change(self, position, steps):
        self.did.append(steps)
        return self.moves

    def take_keys(self, acts):
        return self.taken

    def leave(self, now_ms):
        self.did.append("leave")

    def end(self):
        self.did.append("end")


class Module:
    """Where the list stands."""

    List = Own


class Full:
    """One for which there is no memory."""

    @staticmethod
    def List(panel, argument):
        raise MemoryError


class Opened:
    """The menu of such a panel, with that list in it."""

    def __init__(self, name="own", module=Module, at_ms=0):
        self.panel = Told()
        self.now_ms = at_ms
        self.name = "panel.menu." + name
        sys.modules[self.name] = module
        self.menu = Menu(self.panel, (name, 0))
        self.come()

    def come(self):
        sys.modules.setdefault(self.name, Module)
        for _ in range(9):
            if self.menu.is_busy:
                self.menu.work(self.now_ms)

    def press(self, *keys):
        for key in keys:
            acts = Acts(Keys(ALL, self.panel.mask))
            acts.pressed = acts.bit(key)
            self.menu.take_keys(acts, self.now_ms)

    def repeat(self, key, times):
        acts = Acts(Keys(ALL, self.panel.mask))
        acts.repeated, acts.repeats = acts.bit(key), times
        self.menu.take_keys(acts, self.now_ms)

    def step(self, ms=0):
        self.now_ms = self.now_ms + ms & self.panel.mask
        self.menu.step(None, self.now_ms)
        return not self.is_closed()

    def is_closed(self):
        return "uncover" in self.panel.did

    def rows(self):
        self.picture = [bytearray(b"." * 16), bytearray(b"." * 16)]
        self.menu.draw(self, self.now_ms)
        self.menu.draw_row_2(self, self.now_ms)
        return tuple([bytes(row).decode() for row in self.picture])

    def put(self, row, column, width, words):
        assert len(words) <= width, words
        self.picture[row][column : column + width] = words + b" " * (width - len(words))

    def place(self):
        return int(self.rows()[1][len(">ENTRY ") :])


def test_a_list_goes_round_by_either_pair_of_keys_and_by_the_address_keys_one_alone():
    for name, walks in (("own", False), ("address", True)):
        opened = Opened(name)
        for key, place in (
            ("DOWN", 1), ("DOWN", 2), ("DOWN", 0), ("UP", 2), ("UP", 1), ("NEXT", 2), ("NEXT", 0),
            ("PREVIOUS", 2), ("ADDRESS_UP", 0 if walks else 2), ("ADDRESS_UP", 1 if walks else 2),
            ("ADDRESS_DOWN", 0 if walks else 2), ("ADDRESS_DOWN", 2), ("EDIT", 2),
        ):  # fmt: skip
            opened.press(key)
            assert opened.place() == place, (name, key)
        opened.repeat("DOWN", 30)  # by one, however long it is held
        assert opened.place() == 0
        opened.menu.close()
        sys.modules.pop(opened.name, None)  # the list of that name is another one


def test_a_list_says_where_it_is_unless_it_has_one_entry_alone():
    opened = Opened()
    (own,) = opened.panel.lists
    assert opened.rows() == ("OWN 1        1/3", ">ENTRY 0        ")
    opened.press("UP")
    assert opened.rows() == ("OWN 1        3/3", ">ENTRY 2        ")
    own.entries = 2  # what was last in it has gone
    assert opened.rows() == ("OWN 1        2/2", ">ENTRY 1        ")
    opened.press("SET")
    own.entries = 1
    assert opened.rows() == ("OWN 1           ", ">ENTRY 0        ")
    opened.press("SET")
    assert own.did[-2:] == [1, 0]  # what is shown was chosen
    own.entries = 120
    assert opened.rows()[0] == "OWN 1      3/120"


def test_up_and_down_move_a_value_the_faster_the_longer_they_are_held():
    opened = Opened()
    (own,) = opened.panel.lists
    own.moves = True
    opened.press("UP", "DOWN")
    for times in (8, 9, 16, 17):
        opened.repeat("UP", times)
    opened.repeat("DOWN", 17)
    assert own.did == [1, -1, 1, 10, 10, 100, -100] and opened.place() == 0


def test_set_leads_to_another_list_and_param_back_to_where_that_was_chosen():
    opened = Opened()
    panel = opened.panel
    (own,) = panel.lists
    opened.press("DOWN", "SET")
    assert own.did[-1] == 1 and opened.rows() == ("OWN 1        2/3", ">ENTRY 1        ")
    own.follows = "own", 2
    panel.time_left = False
    opened.press("SET", "UP", "PARAM")  # it comes where there is time; until then no key counts
    opened.come()
    assert len(panel.lists) == 1 and opened.menu.is_busy and opened.place() == 1
    panel.time_left = True
    opened.come()
    assert not opened.menu.is_busy and opened.rows() == ("OWN 2        3/3", ">ENTRY 2        ")
    opened.press("PARAM")
    assert panel.lists[1].did == ["leave", "end"] and opened.place() == 1
    own.follows = BACK
    opened.press("SET")
    assert own.did[-2:] == ["leave", "end"] and panel.did == ["uncover"]


def test_a_list_may_take_the_keys_or_leave_by_them():
    opened = Opened()
    (own,) = opened.panel.lists
    own.taken = True
    opened.press("DOWN", "SET", "PARAM", "START")
    assert own.did == [] and opened.rows()[1] == ">ENTRY 0        "
    own.taken = BACK
    opened.press("EDIT")
    assert own.did == ["leave", "end"] and opened.is_closed()


def test_a_page_comes_when_the_lists_have_gone_one_by_one_the_one_shown_with_it():
    opened = Opened()
    panel = opened.panel
    panel.lists[0].follows = "own", 1
    opened.press("SET")
    opened.come()
    panel.lists[1].follows = PAGE, 7
    panel.time_left = False
    opened.press("SET", "PARAM", "DOWN")
    assert opened.menu.is_busy
    opened.menu.work(0)
    assert panel.lists[0].did[-1] == "end" and panel.did == [] and opened.place() == 1
    opened.menu.work(0)
    assert panel.did == []
    panel.time_left = True
    opened.menu.work(0)
    assert panel.did == [7] and panel.lists[1].did == [1]


def test_what_is_said_in_place_of_an_entry_has_three_seconds_or_until_a_key_is_pressed():
    for key in ("START", "REVERSE", "JOG_RIGHT", "JOG_LEFT"):
        opened = Opened(at_ms=Told.mask - 1_000)
        opened.press(key)
        told = ">NO: IN THE MENU"
        assert opened.step() and opened.rows()[1] == told
        opened.step(2_999)
        opened.repeat("EDIT", 1)
        assert opened.rows()[1] == told
        opened.step(1)
        assert opened.rows()[1] == ">ENTRY 0        "
        opened.press(key, "EDIT")
        assert opened.rows()[1] == ">ENTRY 0        "


def test_a_menu_is_open_for_a_minute_from_the_last_key_or_from_what_its_list_does():
    opened = Opened(at_ms=Told.mask - 70_000)
    assert opened.step() and opened.step(59_999)
    opened.repeat("DOWN", 1)
    assert opened.step(59_999)
    opened.press("EDIT")
    (own,) = opened.panel.lists
    own.does = True
    assert opened.step(59_999) and opened.step(500_000)
    own.does = False
    assert opened.step(59_999) and not opened.step(1)
    assert own.did[-1] == "end" and opened.panel.did == ["uncover"]


def test_an_alarm_of_the_drive_shown_closes_it_when_it_comes_and_else_has_every_other_turn():
    opened = Opened()
    opened.panel.selected.is_alarmed = True
    assert not opened.step()
    panel = Told()
    panel.selected.is_alarmed = True
    sys.modules[opened.name] = Module
    opened.panel, opened.menu = panel, Menu(panel, ("own", 0))
    opened.come()
    assert opened.step() and opened.step(1_000)  # it was there when that was opened
    for turn, row in ((0, "OWN 1        1/3"), (1, "A3 LOST,MAY RUN "), (2, "OWN 1        1/3")):
        panel.page_turns = turn
        assert opened.rows()[0] == row, turn
    panel.selected.is_alarmed = False
    assert opened.step()
    panel.page_turns = 1
    assert opened.rows()[0] == "OWN 1        1/3"
    panel.selected.is_alarmed = True
    assert not opened.step()


def test_stop_in_the_menu_stops_the_drive_that_its_entry_names_once_and_says_so():
    """The one that is shown has been stopped already."""
    for named, other, told in (
        (None, 0, "A3: STOP"), (0, 0, "A3: STOP"), (1, 1, "A3 A12: STOP"), ("gone", 0, "A3: STOP")
    ):  # fmt: skip
        opened = Opened()
        shown, second = opened.panel.controls
        gone = Machine(9)
        own = opened.panel.lists[0]
        own.of_drive = {None: None, 0: shown, 1: second, "gone": gone}[named]
        opened.press("STOP")
        assert (shown.stopped, second.stopped, gone.stopped) == (0, other, 0), named
        assert opened.rows()[1].rstrip() == ">" + told
    own.tells_stop = False
    opened.press("EDIT", "STOP")
    assert opened.rows()[1] == ">ENTRY 0        "


def test_a_list_for_which_there_is_no_memory_says_so_and_leaves_what_was_shown():
    opened = Opened(module=Full)
    assert opened.panel.did == [texts.NO_MEMORY, "uncover"] and not opened.menu.is_ready()
    opened = Opened()
    (own,) = opened.panel.lists
    own.follows = "own", 1
    opened.press("SET")
    sys.modules[opened.name] = Full
    opened.come()
    assert opened.panel.did == [texts.NO_MEMORY] and not opened.menu.is_busy
    assert opened.menu.is_ready() and opened.place() == 0


def test_a_menu_that_closes_ends_each_list_once_whatever_was_to_come():
    opened = Opened()
    panel = opened.panel
    panel.lists[0].follows = "own", 1
    opened.press("SET")
    opened.come()
    panel.lists[1].follows = "own", 1
    panel.lists[1].seeks = True
    assert opened.menu.is_busy
    opened.menu.work(0)
    assert panel.lists[1].did == ["search"]
    opened.press("SET")
    opened.menu.close()
    assert [own.did[-1] for own in panel.lists] == ["end"] * 2 and panel.did == ["uncover"]
    assert [own.did.count("end") for own in panel.lists] == [1, 1]
    assert not opened.menu.is_busy and not opened.menu.is_ready()
    assert opened.rows() == ("." * 16, "." * 16)


# --- its lists by themselves ---------------------------------------------------------------------


class Drive(Machine):
    """One that has told all, and what a list makes of it."""

    contact = complete = True
    off_ms, family, actual, in_percent = 0, MM440, None, False

    def __init__(self, address):
        Machine.__init__(self, address)
        self.survey = self

    def off_time_ms(self):
        return self.off_ms

    def actual_centihertz(self):
        return self.actual

    def is_percent(self):
        return self.in_percent


class Whole(Told):
    """A panel with its settings and its bus, on which an exchange takes 10 ms."""

    runs = has_other = is_full = False
    lock_code, wait_us = 2_046, 0

    def __init__(self, *addresses):
        Told.__init__(self)
        self.settings = self.bus = self.turns = self.deadlines = self.guard = self
        self.drives = addresses
        self.controls = self.list = [Drive(address) for address in addresses]
        self.selected = self.controls[0]
        self.repeats, self.unsupervised = {}, addresses

    def say(self, now_ms, text, *values):
        self.did.append(texts.of(text, *values))

    def any_runs(self):
        return self.runs

    def change(self, name, value):
        setattr(self, name, value)
        self.did.append(name)

    def begin_anew(self):
        self.did.append("anew")

    def heed_settings(self):
        self.did.append("heed")

    def unlock(self):
        self.did.append("unlock")

    def longest_cycle_us(self, entries):
        return 10_000 * len(entries) - 1

    def at(self, address):
        return ([drive for drive in self.controls if drive.address == address] or [None])[0]

    def has_command(self):
        return self.has_other

    def silence_wait_us(self):
        return self.wait_us

    def post(self, telegram):
        telegram.state = pkw.PENDING
        self.telegram = telegram
        self.did.append((telegram.node, telegram.size - 4))

    def add(self, address, kind):
        if self.is_full:
            raise ValueError
        self.did.append((address, kind))

    def close_menu(self):
        self.did.append("closed")


def test_a_drive_that_is_carried_goes_round_in_both_directions_and_is_kept_when_that_is_left():
    panel = Whole(3, 12, 7)
    shown = order_list.List(panel, None)
    assert not shown.change(0, -1)  # nothing is carried
    assert [shown.words(at) for at in range(shown.count())] == [b"A3", b"A12", b"A7"]
    assert shown.heading(0) == b"ORDER" and shown.control_at(1) is panel.controls[1]
    shown.choose(0, 0)
    for at, steps, order_of in (
        (0, -1, (12, 3, 7)), (1, -1, (12, 7, 3)), (2, -1, (3, 12, 7)), (0, 1, (12, 7, 3)),
        (2, 1, (12, 3, 7)), (1, 1, (3, 12, 7)), (0, -100, (12, 3, 7)),
    ):  # fmt: skip
        assert not shown.change(at, steps)  # the menu walks with it
        assert shown.words(0) == b"A3  UP DOWN" and shown.heading(0) == b"SET=KEEP"
        assert tuple([shown.control_at(place).address for place in range(3)]) == order_of
    shown.choose(1, 0)
    assert [shown.words(at) for at in range(3)] == [b"A12", b"A3", b"A7"] and panel.did == []
    shown.leave(0)
    assert panel.did == ["drives", "anew"] and panel.drives == (12, 3, 7)
    shown.leave(0)
    assert panel.did == ["drives", "anew"]  # it is that already
    panel.runs = True
    shown.choose(0, 0)
    assert panel.did[2:] == [texts.STOP_FIRST] and shown.heading(0) == b"ORDER"
    panel.drives = (3, 12, 7)
    shown.leave(0)
    assert panel.did[2:] == [texts.STOP_FIRST] * 2 and panel.drives == (3, 12, 7)


def test_the_turns_of_a_drive_are_kept_where_three_rounds_fit_into_each_telegram_off_time():
    """A round of six turns is taken for 60 ms here."""
    for off_ms, changes, told in (
        (0, {}, None), (1, {}, b"A12: P2014 SHORT"), (179, {}, b"A12: P2014 SHORT"),
        (180, {}, None), (180, {"complete": False}, texts.REFUSED_CHECKING),
        (180, {"complete": False, "contact": False}, None),
    ):  # fmt: skip
        panel = Whole(3, 12, 7)
        second = panel.controls[1]
        second.off_ms = off_ms
        for name in changes:
            setattr(second, name, changes[name])
        shown = turns_list.List(panel, None)
        assert not shown.change(0, 1) and shown.words(0) == b"A3  x1"
        shown.choose(0, 0)
        assert shown.heading(0) == b"SET=KEEP"
        for steps, times in ((1, 2), (1, 3), (100, 4), (1, 4), (-1, 3), (-9, 2), (-1, 1), (-1, 1)):
            assert shown.change(0, steps) and shown.words(0) == b"A3  x%d" % times
        for _ in range(3):
            shown.change(0, 1)
        shown.choose(0, 0)
        assert shown.heading(0) == b"TURNS"
        kept_ones = {} if told else {"3": 4}
        assert panel.did == ([told] if told else ["repeats", "anew"]), (off_ms, panel.did)
        assert panel.repeats == kept_ones and shown.words(0) == (b"A3  x1" if told else b"A3  x4")
    panel.did, panel.list = [], [None] * 6
    second.off_ms, second.contact = 1, True
    taken = ["repeats", "anew"]
    for key_steps, kept_ones, did in (
        (0, {"3": 4}, []), (-1, {"3": 3}, taken), (-9, {"3": 2}, taken), (-1, {}, taken),
        (0, {}, []),
    ):  # fmt: skip
        panel.did = []
        shown.choose(0, 0)
        if key_steps:
            shown.change(0, key_steps)
        shown.choose(0, 0)  # a shorter round is never worse
        assert (panel.repeats, panel.did) == (kept_ones, did), key_steps
    panel.runs, panel.did = True, []
    for _ in range(2):
        shown.choose(1, 0)
        shown.change(1, 1)
    assert panel.did == [texts.STOP_FIRST] and panel.repeats == {}


def typed(shown, digits):
    """Type a code: what is read before each SET, and where that leads to."""
    rows, leads = [], []
    for digit in digits:
        for _ in range(int(digit)):
            assert shown.change(0, 100)  # by one, however long the key is held
        rows.append(shown.words(0).decode())
        leads.append(shown.choose(0, 77))
    return rows, leads


def test_a_code_is_typed_digit_by_digit_and_read_only_where_it_is_new():
    panel = Whole(3)
    shown = code_page.List(panel, False)
    for steps, digit in ((-1, 9), (1, 0), (-9, 9), (1, 0)):
        assert shown.change(0, steps) and shown.words(0) == b"CODE %d___" % digit
    rows, leads = typed(shown, "2047")
    assert rows == ["CODE 2___", "CODE *0__", "CODE **4_", "CODE ***7"]
    assert leads == [None] * 4 and panel.did == [b"WRONG CODE"]
    rows, leads = typed(shown, "2046")  # it begins with the first digit again
    assert rows[0] == "CODE 2___" and leads == [None] * 3 + [BACK]
    assert panel.did[1:] == ["unlock", b"UNLOCKED"]
    for digits, lock_code, said_then in (("0310", 310, b"KEPT"), ("0000", 0, b"NO LOCK")):
        panel.did = []
        rows, leads = typed(code_page.List(panel, True), digits)
        assert rows == [("NEW CODE " + digits[:at] + "___")[:13] for at in range(1, 5)]
        assert leads == [None] * 3 + [BACK] and panel.lock_code == lock_code
        assert panel.did == ["lock_code", "heed", said_then]


def test_each_drive_that_was_accepted_is_taken_back_by_itself():
    panel = Whole(3, 12, 7)
    shown = accepted_list.List(panel, None)
    for place, left in ((1, (3, 7)), (1, (3,)), (0, ()), (0, ())):
        rows = [shown.words(at) for at in range(shown.count())]
        was = panel.unsupervised
        assert rows == ([b"A%d  SET=ASK" % one for one in was] or [b"NO DRIVE"])
        panel.did = []
        assert shown.choose(place, 0) is None
        assert panel.unsupervised == left
        assert panel.did == (["unsupervised", b"KEPT"] if was else [])


def test_a_speed_has_two_decimals_its_sign_and_its_unit():
    for actual, in_percent, row in (
        (None, False, texts.UNKNOWN_VALUE), (0, False, b"0.00 Hz"), (-5, False, b"-0.05 Hz"),
        (-1, True, b"-0.01 %"), (1_284, False, b"12.84 Hz"), (-10_099, True, b"-100.99 %"),
        (100, False, b"1.00 Hz"), (-99, False, b"-0.99 Hz"),
    ):  # fmt: skip
        drive = Drive(3)
        drive.actual, drive.in_percent = actual, in_percent
        assert menu_words.speed(drive) == row, (actual, row)


class Enquirer:
    """Asks a drive that answers what it is, in two telegrams."""

    made = None

    def __init__(self, *node):
        Enquirer.made = node
        self.node = self
        self.family, self.layout = MM440, MM440.layout
        self.taken = 0

    def question(self):
        return Mirror(7, bytes(26))

    def take(self, telegram):
        self.taken += 1
        return self.taken > 1


class EnquiryModule:
    """Where that stands."""

    Enquirer = Enquirer


LENGTHS = [10, 12, 4, 16, 14, 8, 6, 18, 20, 22, 24]  # net characters that are tried


def test_an_address_is_asked_in_all_lengths_round_and_round_until_somebody_answers():
    panel = Whole(3, 12)
    shown = address_list.List(panel, None)
    assert (shown.first(), shown.count()) == (3, 32)
    shown.step(3, 0)
    shown.step(3, 0)
    assert panel.did == [] and shown.words(3) == b"A3  IN THE LIST"
    assert shown.control_at(12) is panel.controls[1] and shown.control_at(13) is None
    for name, value in (("wait_us", 1), ("has_other", True)):  # first what must not wait
        setattr(panel, name, value)
        shown.step(7, 0)
        assert panel.did == []
        setattr(panel, name, getattr(Whole, name))
    for asked_so_far in range(1, 15):
        shown.step(7, 0)
        assert len(panel.did) == asked_so_far
        shown.step(7, 0)  # it is under way
        assert len(panel.did) == asked_so_far
        row = b"A7  NOBODY" if asked_so_far > 11 else b"A7  ..."
        assert shown.words(7) == row, asked_so_far
        shown.choose(7, 0)  # nobody is there to be taken
        assert shown.words(8) == b"A8  ..."
        panel.telegram.state = pkw.TIMED_OUT
    shown.step(7, 0)
    assert panel.did == [(7, length) for length in (LENGTHS + LENGTHS)[:15]]
    panel.telegram.state = pkw.DONE
    for _ in range(3):  # who answers is not asked any more
        shown.step(7, 0)
        assert len(panel.did) == 15 and shown.words(7) == b"A7  ANSWERS"
    shown.step(8, 0)  # another one begins with the first
    assert panel.did[15:] == [(8, 10)]
    assert shown.words(8) == b"A8  ..." and shown.words(7) == b"A7  ..."
    panel.telegram.state = pkw.TIMED_OUT
    shown.step(12, 0)
    assert len(panel.did) == 16 and shown.words(12) == b"A12 IN THE LIST"


def test_who_answers_is_asked_what_it_is_when_set_wants_it_and_taken_as_that():
    """It takes one length only if it is silent twice on another."""
    for silences, is_answered, is_full in (
        (0, True, False), (1, True, False), (2, False, False), (2, False, True)
    ):  # fmt: skip
        panel = Whole(3)
        panel.is_full = is_full
        shown = address_list.List(panel, None)
        shown.step(7, 0)
        panel.telegram.state = pkw.TIMED_OUT
        shown.step(7, 0)
        panel.telegram.state = pkw.DONE
        shown.step(7, 0)
        shown.choose(8, 0)  # nobody was found there
        shown.step(7, 0)
        assert panel.did == [(7, 10), (7, 12)] and shown.words(7) == b"A7  ANSWERS"
        shown.choose(7, 0)
        assert shown.words(7) == b"A7  ..."
        sys.modules["uss.finding.enquiry"] = EnquiryModule
        shown.step(7, 0)
        for is_last in [False] * (silences - 1 if silences == 2 else silences) + [True]:
            assert panel.did[-1] == (7, 14)  # a word more
            panel.telegram.state = pkw.DONE if is_last and is_answered else pkw.TIMED_OUT
            shown.step(7, 0)
        sys.modules.pop("uss.finding.enquiry", None)
        assert Enquirer.made == (7, 12, is_answered), (silences, Enquirer.made)
        for _ in range(2):
            assert panel.did[-1] == (7, 26)
            panel.telegram.state = pkw.DONE
            asked_so_far = len(panel.did)
            shown.step(7, 0)
        added = [b"A7 NOT ADDED"] if is_full else [(7, "mm440"), b"A7 ADDED"]
        assert panel.did[asked_so_far:] == ["closed"] + added


class Kinds(Whole):
    """A panel whose drive 3 is of a kind."""

    def __init__(self, family, layout, contact=True):
        Whole.__init__(self, 3, 12)
        drive = self.controls[0]
        drive.family, drive.layout, drive.contact = family, layout, contact

    def set_kind(self, address, kind):
        self.did.append((address, kind))

    def show(self, control):
        self.selected = control

    def remove(self):
        if self.runs:
            raise ValueError
        self.controls.remove(self.selected)


FAMILY, PKW, PZD, LINK = range(4)


def test_each_part_of_what_a_drive_is_can_be_chosen_as_its_family_has_it():
    bop = on_bop(MM440)
    for family, layout, row, first, count in (
        (MM440, Layout(4, 2), FAMILY, "FAMILY MM440", len(families.NAMES)),
        (bop, Layout(4, 2), FAMILY, "FAMILY MM440", len(families.NAMES)),
        (MM440, Layout(127, 2), PKW, "PKW 127 WORDS", len(MM440.pkw_choices)),
        (MM440, Layout(4, 3), PZD, "PZD 3 WORDS", len(MM440.pzd_choices) - 2),  # not 0, not 1
        (MM440, Layout(4, 2), LINK, "LINK RS-485", 2), (bop, Layout(4, 2), LINK, "LINK BOP", 2),
        (V20, Layout(4, 2), LINK, "LINK RS-485", 1),
    ):  # fmt: skip
        panel = Kinds(family, layout)
        drive = panel.controls[0]
        shown = kind_list.List(panel, (drive, row))
        assert shown.words(shown.first()).decode() == first and shown.count() == count, first
        assert shown.control_at(0) is drive
        assert texts.of(shown.title) == menu_words.KIND_TITLES[row]
        assert shown.choose(shown.first(), 0) is BACK and panel.did == []  # it is that
    panel = Kinds(MM440, Layout(4, 16))
    wrong = kind_list.List(panel, (panel.selected, PZD))
    assert wrong.first() == 0 and wrong.words(0) == b"PZD 2 WORDS"


def test_what_is_chosen_keeps_the_rest_as_far_as_that_can_be():
    bop, short = on_bop(MM440), Layout(127, 3, short=True)
    for family, layout, contact, row, wanted, kind in (
        (MM440, Layout(4, 2), True, PKW, "PKW 127 WORDS", "mm440/127"),
        (MM440, short, True, PKW, "PKW 3 WORDS", "mm440/3+3"),
        (MM440, short, True, PZD, "PZD 4 WORDS", "mm440/127s+4"),
        (bop, Layout(127, 2), True, PKW, "PKW 4 WORDS", "mm440-bop"),
        (MM440, Layout(127, 3), True, LINK, "LINK BOP", "mm440-bop/127+3"),
        (bop, Layout(127, 3), True, LINK, "LINK RS-485", "mm440/127+3"),
        (bop, Layout(127, 3), True, FAMILY, "FAMILY MM420", "mm420-bop/127+3"),
        (bop, Layout(127, 3), False, FAMILY, "FAMILY MM420", "mm420-bop"),
        (bop, Layout(127, 3), True, FAMILY, "FAMILY V20", "v20/127+3"),
        (MM440, Layout(4, 2), True, FAMILY, "FAMILY MM3", "mm3"),
    ):
        panel = Kinds(family, layout, contact)
        shown = kind_list.List(panel, (panel.selected, row))
        rows = [shown.words(place).decode() for place in range(shown.count())]
        panel.runs = True
        assert shown.choose(rows.index(wanted), 0) is None and panel.did == [texts.STOP_FIRST]
        panel.runs = False
        assert shown.choose(rows.index(wanted), 0) is None
        assert panel.did[1:] == [(3, kind), "anew"], (kind, panel.did)


def test_a_drive_of_the_list_is_shown_removed_or_told_what_it_is():
    panel = Kinds(MM440, Layout(127, 3))
    third, twelfth = panel.controls
    twelfth.actual = -5
    shown = drive_list.List(panel, third)
    rows = [shown.words(place).decode() for place in range(shown.count())]
    assert rows[:6] == ["SHOW IT", "REMOVE IT", "FAMILY MM440", "PKW 127 WORDS", "PZD 3 WORDS",
                        "LINK RS-485"] and len(rows) == 7  # fmt: skip
    assert shown.title == b"A3" and shown.control_at(5) is third
    leads = [shown.choose(place, 0) for place in range(2, 7)]
    assert leads == [("kind", (third, row)) for row in range(4)] + [None] and panel.did == []
    panel.selected = twelfth
    assert shown.choose(0, 0) is None and panel.selected is third and panel.did == ["closed"]
    panel.selected, panel.did, panel.runs = twelfth, [], True
    shown.choose(1, 0)
    assert panel.did == ["closed", b"A3 NOT REMOVED"] and panel.controls == [third, twelfth]
    panel.selected, panel.did, panel.runs = twelfth, [], False
    shown.choose(1, 0)
    assert panel.did == ["closed", b"A3 REMOVED"] and panel.selected is twelfth
    panel.did = []
    for place in (0, 1):  # it has gone already
        assert shown.choose(place, 0) is None and panel.did == []
    assert drive_list.List(panel, twelfth).words(6) == b"-0.05 Hz"


def test_drives_are_looked_for_at_all_rates_first_where_none_answers():
    panel = Whole(3, 12)
    panel.line_in_use = lambda: panel.has_other
    panel.offer_search = panel.did.append
    shown = find_list.List(panel, None)
    assert [shown.words(place) for place in range(shown.count())] == [
        b"AT THIS RATE", b"AT ALL RATES"
    ]  # fmt: skip
    for contacts, first in (((True, False), 0), ((False, True), 0), ((False, False), 1)):
        for drive, contact in zip(panel.controls, contacts):
            drive.contact = contact
        assert shown.first() == first, contacts
    assert shown.choose(0, 5) == ("beside", None) and panel.did == []
    assert shown.choose(1, 6) is None and panel.did == [6]
    panel.has_other = True  # another master talks: nobody is looked for beside it
    assert shown.choose(0, 7) is None and panel.did == [6, 7]


class Begun:
    """A panel with one drive, as the first list of the menu asks for it."""

    contact, pkw_words, family = True, 4, MM440
    lock_code = 0

    def __init__(self, **told):
        self.selected = self.drive = self.layout = self.survey = self.settings = self
        self.controls = [self]
        self.fault, self.warning = Alarm(), Alarm()
        self.locked_ms = []
        for name in told:
            setattr(self, name, told[name])

    def lock(self, now_ms):
        self.locked_ms.append(now_ms)


class Alarm:
    """A fault or a warning with this number; 0: nobody knows it yet."""

    def __init__(self, number=None, digits=4):
        self.active, self.number, self.digits = number is not None, number or 0, digits


def test_the_first_list_has_what_the_panel_and_its_drive_have_what_is_urgent_first():
    drives = ("DRIVES", "ANY ADDRESS", "FIND DRIVES", "SETTINGS", "SETS")
    several, diagnosis = ("ORDER", "TURNS"), ("DIAGNOSIS",)
    parameters, last = ("PARAMETERS", "COMMISSION", "FAULT MEMORY"), ("EVENTS", "ABOUT")
    usual = drives + diagnosis + parameters + last
    for told, wanted in (
        ({}, usual),
        ({"controls": [None] * 2}, drives + several + diagnosis + parameters + last),
        ({"pkw_words": 0}, drives + diagnosis + last),
        ({"contact": False}, ("WHY NO CONTACT",) + usual),
        ({"lock_code": 1}, usual + ("LOCK",)),
        ({"fault": Alarm(2)}, ("WHAT IS F0002",) + usual),
        ({"fault": Alarm(2), "family": families.MM3}, ("WHAT IS F002",) + usual),
        ({"fault": Alarm(0)}, usual),
        ({"warning": Alarm(501)}, ("WHAT IS A0501",) + usual),
        ({"warning": Alarm(5, 3)}, ("WHAT IS A005",) + usual),
        ({"warning": Alarm(0)}, usual),
        ({"fault": Alarm(2), "warning": Alarm(501)}, ("WHAT IS F0002",) + usual),
        ({"fault": Alarm(0), "warning": Alarm(501)}, ("WHAT IS A0501",) + usual),
        (
            {"fault": Alarm(1), "contact": False, "lock_code": 9_999},
            ("WHY NO CONTACT", "WHAT IS F0001") + usual + ("LOCK",),
        ),
    ):
        shown = main_list.List(Begun(**told), None)
        found = tuple([shown.words(row).decode() for row in range(shown.count())])
        assert found == wanted, (told, found)
        assert shown.heading(0) == b"MENU"


def test_set_in_the_first_list_leads_to_the_list_of_its_entry_or_locks():
    panel = Begun(controls=[None] * 2, contact=False, lock_code=7, fault=Alarm(12))
    shown = main_list.List(panel, None)
    leads = [shown.choose(row, 500) for row in range(shown.count() - 1)]
    names = (
        "drives", "address", "find", "settings", "sets.overview", "order", "turns",
        "diagnosis.overview", "lookup.groups", "commission.overview", "lookup.memory", "events",
        "about",
    )  # fmt: skip
    what = ("lookup.what", ("F", 12, b"F0012"))
    assert leads == [("contact", None), what] + [(name, None) for name in names], leads
    assert panel.locked_ms == []
    assert shown.choose(shown.count() - 1, 500) is None and panel.locked_ms == [500]
    shown = main_list.List(Begun(warning=Alarm(501)), None)
    assert shown.choose(0, 0) == ("lookup.what", ("A", 501, b"A0501"))


def test_the_settings_are_those_that_the_board_has_use_for_each_with_its_value():
    """A light that can be switched, and a plug for the log."""

    class Board:
        name = "SIMULATED"

    values = {
        "baud": 38_400, "second_stop": "none", "reply_timeout_ms": 20, "lost_ms": 1_000,
        "setpoint_centihertz": 1_005, "setpoint_step_centihertz": 10, "lowest_centihertz": 0,
        "highest_centihertz": 65_000, "key_delay_ms": 400, "key_repeat_ms": 120,
        "light_minutes": 1, "language": "de", "log": "JSON",
    }  # fmt: skip
    told = [
        "BAUD 38400", "2ND STOP none", "REPLY 20 ms", "LOST 1000 ms", "START 10.05 Hz",
        "STEP 0.10 Hz", "LOW 0.00 Hz", "HIGH 650.00 Hz", "KEY WAIT 400 ms", "KEY RATE 120 ms",
        "LIGHT 1 min", "LANG. Deutsch", "LOG JSON",
    ]  # fmt: skip
    more = [("code", True), ("accepted", None), ("keys", None)]
    panel = Begun(board=Board(), **values)
    for backlight, serial, lacks in (
        (True, True, ()), (None, True, ("LIGHT 1 min",)), (True, None, ("LOG JSON",)),
        (None, None, ("LIGHT 1 min", "LOG JSON")),
    ):  # fmt: skip
        panel.board.backlight, panel.board.serial = backlight, serial
        shown = setting_list.List(panel, None)
        found = [shown.words(row).decode() for row in range(shown.count())]
        wanted = [row for row in told if row not in lacks]
        assert found == wanted + ["LOCK CODE", "P2014=0 OK", "KEY TEST"], found
        leads = [shown.choose(row, 0) for row in range(shown.count())]
        assert leads[-3:] == more and shown.heading(0) == b"SETTINGS"
        for (name, row), words in zip(leads[:-3], wanted):
            assert name == "value" and words.startswith(row[1].decode().split("%")[0]), row
    panel.light_minutes = 0
    panel.board.backlight = True
    shown = setting_list.List(panel, None)
    assert shown.words(10) == b"LIGHT STAYS ON"
