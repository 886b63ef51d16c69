# SPDX-License-Identifier: MIT
"""The operator's manual, any parameter: by number, group or as a favourite, read and changed."""

import json
import sys

import catalogue
import main
import on_demand
from boards.sim.drives.kinds import listed_drives, simulated
from boards.sim.world import World
from lookup_bench import (
    choose,
    forget_modules,
    go_to,
    hold,
    lines,
    look_up,
    press,
    speak,
    type_digits,
    wait,
    wait_for_value,
    world_of,
)
from panel.keys import NAMES, Acts, Keys
from panel.lookup import Search, groups, memory, value, what
from panel.lookup import name_of as table_of
from panel.lookup.answers import FIRST, TYPED
from panel.lookup.editing import Editing
from panel.lookup.parameter import Parameter
from panel.lookup.sight import Sight
from panel.lookup.words import IS_FAVOURITE
from panel.pages.parameter_words import EDIT_FIRST, REFUSALS
from panel.pages.table import PAGES, PARAMETER
from panel.reading import Reading
from panel.screen import Screen
from panel_bench import LOOP_US, row_1, row_2, running, settled_row_2, starts, taken_at_ms
from pkw_bench import AskedDrive
from uss import families, pkw
from uss.drive import Drive

YES_OR_NO = "SET=DO  PARAM=NO"


def keep(world, number, value):
    """The drive has this value under a number, whatever its limits are."""
    world.drives[1].parameters.store(number, 0, value, False)
    world.run(800)


def step_until(world, condition):
    """The main loop goes on until it is so, and not one step further."""
    for _ in range(1000):
        if condition():
            return
        world.app.step()
    raise AssertionError(world.lcd())


def drawn(page):
    """Both rows of a page, on a display of its own."""
    screen = Screen("A00")
    page.draw(screen, 0)
    page.draw_row_2(screen, 0)
    return tuple([row.rstrip() for row in screen.rows()])


# --- looking -------------------------------------------------------------------------------------


def test_names_and_units_are_written_as_in_the_language_of_the_panel():
    world = world_of()
    speak(world, "de")
    hold(world, "PARAM", 1400)
    world.run(500)
    choose(world, "PARAMETER")
    world.run(1500)
    for _ in range(40):
        if row_2(world) == ">NACH NUMMER":
            break
        press(world, "UP")
    press(world, "SET")
    wait(world, "P0")
    type_digits(world, "0035")
    press(world, "SET")
    world.run(500)
    assert wait_for_value(world).endswith("°C"), world.lcd()
    said = lines(world)
    assert "Motortemperatur" in said, said
    speak(world, "en")
    press(world, "UP", "DOWN")
    assert "Motor temp." in lines(world)
    world.check()


def test_the_output_current_is_read_by_its_number_while_the_motor_runs():
    world = world_of()
    look_up(world, 27)
    assert world.lcd()[1] == "r0027      0.00A", world.lcd()
    assert lines(world) == {"Output current", "A1"}
    press(world, "START")
    world.run(4000)
    assert world.drives[1].state == "running"
    assert float(row_2(world)[5:-1]) > 0.5, world.lcd()
    press(world, "STOP")
    world.run(3000)
    assert world.drives[1].state != "running"
    press(world, "PARAM")
    world.run(200)
    assert row_2(world) == "READY        A1"
    world.check()


def test_a_unit_that_begins_with_a_digit_keeps_off_the_number():
    world = world_of("g120")
    look_up(world, 311)
    assert world.lcd()[1] == "P0311     1395.0", world.lcd()  # it has no room
    world = world_of("mm420")
    look_up(world, 22)
    assert world.lcd()[1] == "r0022    0 1/min", world.lcd()
    world.check()


def test_a_group_is_walked_both_ways_and_round():
    world = world_of()
    go_to(world, "PARAMETERS", "Ramps")
    wait(world, "P1120")
    assert wait_for_value(world) == "P1120[0]  10.00s"
    there = [row_2(world)[:5]]
    while True:
        press(world, "NEXT")
        world.run(800)
        if row_2(world)[:5] == there[0]:
            break
        there.append(row_2(world)[:5])
    assert there[:2] == ["P1120", "P1121"] and len(there) > 5, there
    back = []
    for _ in there:
        press(world, "PREVIOUS")
        world.run(1500)
        back.append(row_2(world)[:5])
    assert back == there[::-1], (there, back)
    world.check()


def test_no_other_index_is_gone_to_while_the_first_one_of_a_group_is_looked_for():
    world = world_of()
    go_to(world, "PARAMETERS")
    while not row_2(world).startswith(">Ramps"):
        press(world, "DOWN")
    search = sys.modules["panel.lookup"].Search
    look, search.step = search.step, lambda search: None  # that takes for ever
    try:
        press(world, "SET", "UP", "UP")
    finally:
        search.step = look
    wait(world, "P1120[0]  10.00s")
    world.check()


def test_while_the_first_one_of_a_group_is_looked_for_there_are_dots():
    panel = world_of().app.panel
    panel.remembered["panel.lookup.parameter"] = b"1120-1124", FIRST
    page = Parameter(panel)
    assert drawn(page) == ("", "")
    acts = Acts(Keys(("NEXT", "EDIT"), 0x3FFFFFFF))
    acts.pressed = acts.bit("NEXT")  # there is none yet that could be gone on from
    seen = []
    for _ in range(1000):
        page.take_keys(acts, 0)
        if not page.is_coming():
            break
        page.step(None, 0)
        seen.append(drawn(page))
    assert len(seen) > 3 and set(seen[:-1]) == {("...", "")}, seen
    assert seen[-1] == ("Ramp-up time", "P1120[0]       ?"), seen


def test_a_step_looks_for_six_pieces_at_the_most_and_for_none_when_it_turns_to_another():
    """To begin, or to turn to what was found, takes as long as a step may take."""
    look = Search.step
    for has_taken, most in ((False, 6), (True, 1)):
        panel = world_of().app.panel
        panel.has_taken = lambda us, it_has=has_taken: it_has
        panel.remembered["panel.lookup.parameter"] = b"1120-1124", FIRST
        page = Parameter(panel)
        looks = []

        def count(search, looks=looks):
            looks[-1] += 1
            return look(search)

        Search.step = count
        try:
            while page.is_coming():
                looks.append(0)
                page.step(None, 0)
        finally:
            Search.step = look
        assert looks[:2] == [0, 0] and looks[-1] == 0, looks
        assert max(looks) == most and min(looks[2:-1]) >= 1, looks


def test_whatever_is_looked_for_is_looked_for_in_pieces():
    """A step of the loop has no time for a whole search."""
    world = world_of()
    panel, keys, rows = world.app.panel, Keys(("SET",), 0x3FFFFFFF), catalogue.rows
    world.drives[1].fault(1)
    world.run(3000)
    pieces = set()

    def note(family, numbers=catalogue.ALL, kind="P", paced=False):
        pieces.add((kind, paced))
        return rows(family, numbers, kind, paced)

    def wait_for_a_search(kind, step):
        for _ in range(200):
            if pieces:
                break
            step()
            world.run(20)
        assert pieces == {(kind, True)}, (kind, pieces)
        pieces.clear()

    catalogue.rows = note
    try:
        wait_for_a_search("G", lambda: groups.List(panel, None))
        wait_for_a_search("F", lambda: what.List(panel, ("F", 1, b"F0001")))
        faults = memory.List(panel, None)
        wait_for_a_search("F", lambda: faults.step(0, 0))
        panel.remembered["panel.lookup.parameter"] = catalogue.ALL, 700
        page = Parameter(panel)

        def step():
            page.step(keys, 0)
            page.work(0)

        wait_for_a_search("P", step)
        wait_for_a_search("V", step)  # for what the value is called
        shown = Sight(panel)
        shown.table = "mm440"
        for number in (700, 52):
            shown.row = catalogue.find("mm440", number)
            shown.form = value.Form(shown.row, pkw.WORD)
            pieces.clear()
            wait_for_a_search("V", lambda: Editing(shown))
    finally:
        catalogue.rows = rows


def test_a_number_with_more_digits_than_places_has_an_exponent():
    world = world_of()
    look_up(world, 1120)
    for number, row in (
        (9_999_998_976.0, "P1120 9999998976"), (-1e11, "P1120     -1e+11"),
        (-1.2341e12, "P1120 -1.234e+12"),
    ):  # fmt: skip
        keep(world, 1120, number)
        assert row_2(world) == row, world.lcd()


def test_a_long_value_gives_up_decimals_and_then_its_index():
    world = world_of()
    look_up(world, 1120)
    for number, row in (
        (12345.67, "P1120[0] 12345.7"),
        (123456.7, "P1120[0]  123457"),
        (12345678.0, "P1120[0]12345678"),
        (123456792.0, "P1120  123456792"),
    ):
        keep(world, 1120, number)
        assert row_2(world) == row, world.lcd()
    world.check()


def test_what_a_value_is_called_and_its_limits_take_turns_with_the_name():
    world = world_of()
    look_up(world, 700)
    assert row_2(world) == "P0700[0]       5"
    assert lines(world) == {"Command source", "USS on COM link", "A1 0...6"}
    look_up(world, 1300)
    for number, said in ((0, {"V/f linear"}), (18, set()), (23, {"Torque + encoder"})):
        keep(world, 1300, number)
        found = lines(world)
        assert said < found and len(found) == len(said) + 2, (number, found)
    look_up(world, 1120)
    assert lines(world) == {"Ramp-up time", "A1 0...650s"}
    world.check()


def test_limits_and_their_unit_are_shown_as_far_as_the_row_has_room():
    panel = world_of().app.panel
    shown = Sight(panel)
    panel.announcer.page_turns = 1  # the name was there before
    for number, row in (
        (1120, b"A1 0...650s"),
        (305, b"A1 0.01...10000A"),
        (311, b"A1 0...40000"),  # 1/min
        (27, b"A1"),
        (356, b"A1"),  # no mH of the address
    ):
        shown.row = catalogue.find("mm440", number)
        assert shown.row_1() == row, shown.row_1()


def test_an_index_stands_behind_the_number_where_there_are_two_of_them_or_more():
    shown = Sight(world_of().app.panel)
    for shown.number, row in (
        (27, b"r0027          ?"),
        (2010, b"P2010[0]       ?"),  # two
        (1120, b"P1120[0]       ?"),  # three
    ):
        shown.row = catalogue.find("mm440", shown.number)
        assert shown.row_2(0) == row, shown.row_2(0)


def test_the_name_is_the_first_of_what_takes_turns():
    world = world_of()
    look_up(world, 1120)
    for _ in range(2):
        while row_1(world).rstrip() != "A1 0...650s":
            world.run(50)
        press(world, "UP")
        assert row_1(world).rstrip() == "Ramp-up time", world.lcd()
    world.check()


def test_up_and_down_go_to_another_index():
    world = world_of()
    look_up(world, 2019)
    assert row_2(world) == "P2019[0]    52:0"
    press(world, "UP")
    wait(world, "P2019[1]    21:0")
    press(world, "DOWN", "DOWN")
    wait(world, "P2019[7]     0:0")
    press(world, "UP")
    wait(world, "P2019[0]    52:0")
    look_up(world, 1910)
    press(world, "UP")
    assert row_2(world) == "NOT AN ARRAY", world.lcd()
    look_up(world, 207)  # of this one the number is not sure: the drive decides
    press(world, "UP")
    assert row_2(world) == "NO SUCH INDEX", world.lcd()
    wait(world, "r0207[1]   -----")
    world.check()


def test_a_number_that_the_drive_lacks():
    world = world_of()
    look_up(world, 9999)
    assert row_2(world) == "NO SUCH PARAM."
    wait(world, "P9999[0]   -----")
    assert lines(world) == {"NOT IN THE LIST", "A1"}
    press(world, "EDIT")
    assert row_2(world) == "NOT READ YET"
    world.check()


def test_a_value_that_is_refused_later_is_not_shown_any_more():
    world = world_of()
    look_up(world, 27)
    assert row_2(world) == "r0027      0.00A", world.lcd()
    del world.drives[1].parameters.rows[27]
    wait(world, "NO SUCH PARAM.")
    wait(world, "r0027      -----")


def test_param_leaves_a_number_that_is_typed_and_stop_stops():
    world = world_of()
    press(world, "START")
    world.run(4000)
    go_to(world, "PARAMETERS", "BY NUMBER")
    wait(world, "P0")
    assert "NUMBER  SET=SHOW" in lines(world)
    for key, row in (("DOWN", "P09000"), ("UP", "P00000"), ("UP", "P01000")):
        press(world, key)
        wait(world, row)
    press(world, "START")
    assert row_2(world) == "NO: SET OR PARAM"
    press(world, "STOP")
    world.run(2000)
    assert world.drives[1].state != "running" and starts(world) == 1
    assert row_2(world).startswith("r0000"), world.lcd()  # what was typed is gone
    press(world, "PARAM")
    world.run(200)
    assert row_2(world) == "READY        A1"
    world.check()


# --- changing ------------------------------------------------------------------------------------


def test_the_ramp_is_set_to_2_5_seconds_in_the_eeprom():
    world = world_of()
    drive = world.drives[1]
    look_up(world, 1120)
    press(world, "EDIT")
    wait(world, "NEW 010.00s")
    assert lines(world) == {"P1120[0]  10.00s", "A1 0...650s"}
    press(world, "PREVIOUS", "DOWN", "NEXT", "UP", "UP", "NEXT")
    type_digits(world, "5")
    wait(world, "NEW 002.50s")
    assert drive.read(1120) == 10 and drive.eeprom_writes == 0
    hold(world, "SET", 2200)
    assert row_2(world) == "WRITTEN (EEPROM)", world.lcd()
    assert drive.read(1120) == 2.5 and drive.eeprom_writes == 1
    wait(world, "P1120[0]   2.50s")
    drive.power_off()
    world.run(200)
    drive.power_on()
    world.run(3000)
    assert drive.read(1120) == 2.5
    world.check()


def typing(**options):
    world = world_of(**options)
    go_to(world, "PARAMETERS", "BY NUMBER")
    wait(world, "P0")
    return world


def up_taken_at_ms(world):
    inspection = sys.modules["panel.lookup.inspection"].Inspection  # loaded anew for each world
    return taken_at_ms(inspection, lambda: press(world, "UP"))


def test_the_digit_blinks_also_if_its_key_was_pressed_when_the_clock_showed_0():
    (now_ms,) = up_taken_at_ms(typing())
    world = typing(ticks_start=-1000 * now_ms)
    assert up_taken_at_ms(world) == [0]
    rows = set()
    for _ in range(80):
        rows.add(settled_row_2(world))
        world.run(10)
    assert rows == {"P01000", "P0_000"}, rows


def test_the_digit_that_would_change_blinks():
    world = world_of(loop_us=LOOP_US)
    go_to(world, "PARAMETERS", "BY NUMBER")
    wait(world, "P0")
    for keys, rows in (
        (("UP",), ("P01000", "P0_000")),
        (("NEXT", "NEXT", "NEXT"), ("P01000", "P0100_")),
        (("NEXT",), ("P01000", "P_1000")),  # round
        (("NEXT", "NEXT", "UP", "NEXT", "UP", "UP"), ("P01120", "P011_0")),
        (("SET", "EDIT", "UP"), ("NEW 011.00s", "NEW 01_.00s")),
        (("NEXT",), ("NEW 011.00s", "NEW 011._0s")),
    ):
        for key in keys:
            press(world, key)
            world.run(700 if key == "SET" else 0)
        seen, changes, last = {}, 0, rows[0]
        for _ in range(80):  # twice on and off
            row = settled_row_2(world)
            seen[row] = seen.get(row, 0) + 1
            changes += row != last
            last = row
            world.run(10)
        assert set(seen) == set(rows) and changes >= 3, (seen, changes)
        there, away = [seen[row] for row in rows]
        assert away < there < 3 * away, seen  # it is away for a quarter of a second of 0.8
    world.check()


def test_set_pressed_shortly_writes_into_the_ram_alone():
    world = world_of()
    look_up(world, 1121)
    press(world, "UP", "EDIT")
    wait(world, "NEW 010.00s")
    press(world, "UP", "SET")
    assert row_2(world) == "WRITTEN (RAM)"
    wait(world, "P1121[1]  11.00s")
    drive = world.drives[1]
    assert (drive.read(1121, 0), drive.read(1121, 1)) == (10, 11) and drive.eeprom_writes == 0
    world.check()


def test_another_key_beside_a_held_set_makes_nothing_permanent_and_no_favourite():
    world = world_of()
    look_up(world, 1120)
    for keys in ((), ("EDIT", "UP")):
        press(world, *keys)
        world.down("SET")
        world.run(400)
        press(world, "STOP")
        world.run(3000)
        world.up("SET")
        assert "FAVOURITE" not in row_2(world) and "EEPROM" not in row_2(world), world.lcd()
        world.run(3500)
    assert "favourites" not in json.loads(world.flash.files["settings.json"])
    assert world.drives[1].read(1120) == 11 and world.drives[1].eeprom_writes == 0
    world.check()


def test_a_held_set_makes_nothing_permanent_once_the_line_has_failed():
    world = world_of()
    look_up(world, 1120)
    press(world, "EDIT", "UP")
    world.down("SET")
    wait(world, "WRITTEN (RAM)")
    drive = world.app.panel.selected.drive
    world.drives[1].unplug()
    step_until(world, lambda: not drive.contact)
    world.drives[1].plug()
    step_until(world, lambda: drive.contact)
    world.run(3000)
    assert row_2(world) != "WRITTEN (EEPROM)" and world.drives[1].eeprom_writes == 0
    world.check()


def test_the_drive_decides_about_limits():
    world = world_of()
    look_up(world, 1120)
    press(world, "EDIT")
    for key, row in (("DOWN", "NEW 019.00s"), ("UP", "NEW 010.00s")):  # the others stay
        press(world, key)
        wait(world, row)
    press(world, "PREVIOUS", "PREVIOUS")
    type_digits(world, "9")
    wait(world, "NEW 910.00s")
    press(world, "SET")
    wait(world, "BEYOND LIMITS")
    wait(world, "NEW 910.00s")  # what was typed is still there
    press(world, "PARAM")
    wait(world, "P1120[0]  10.00s")
    assert world.drives[1].read(1120) == 10
    world.check()


def test_no_telegram_off_time_is_written_with_which_the_drive_would_trip():
    world = world_of()
    look_up(world, 2014)
    before = world.drives[1].read(2014)
    press(world, "EDIT")
    for place, digit in zip((8, 7, 6, 5, 4), "10000"):  # from the ones on
        for _ in range(10):
            if row_2(world)[place] == digit:
                break
            press(world, "UP")
        press(world, "PREVIOUS")
    wait(world, "NEW 00001")
    press(world, "SET")
    assert row_2(world) == "BELOW LIMIT NOW", world.lcd()
    assert world.drives[1].read(2014) == before
    press(world, "DOWN")
    wait(world, "NEW 00000")
    press(world, "SET")  # 0 trips nothing: the motor runs on for ever, so it asks
    assert row_2(world) == YES_OR_NO, world.lcd()
    world.check()


def test_a_choice_by_its_text_asks_first_where_it_is_risky():
    world = world_of()
    drive = world.drives[1]
    look_up(world, 700)
    press(world, "EDIT")
    world.run(1000)
    assert world.lcd() == ("USS on COM link ", "NEW            5")
    press(world, "DOWN", "DOWN")
    assert world.lcd() == ("Terminals       ", "NEW            2")
    press(world, "SET")
    assert row_2(world) == YES_OR_NO
    asked = {"A1: P0700[0]", "= 2", "PANEL MAY LOSE", "THE DRIVE BY IT"}
    assert lines(world) == asked
    press(world, "PARAM")
    assert drive.read(700) == 5 and row_2(world) == "NEW            2"
    press(world, "DOWN", "SET")
    assert "= 1" in lines(world)
    press(world, "PARAM", "UP", "SET", "SET")
    wait(world, "WRITTEN (RAM)")
    assert drive.read(700) == 2
    world.check()


def test_the_question_about_a_value_of_two_words_names_the_whole_value():
    world = world_of()
    look_up(world, 2000)
    press(world, "EDIT", "UP", "SET")
    assert row_2(world) == YES_OR_NO, world.lcd()
    asked = {"A1: P2000[0]", "= 51.00", "SETPOINTS MAY", "CHANGE THEIR HZ"}
    assert lines(world) == asked
    press(world, "SET")
    wait(world, "WRITTEN (RAM)")
    assert world.drives[1].read(2000) == 51
    world.check()


def test_edit_right_after_a_write_begins_with_what_was_written():
    world = world_of()
    look_up(world, 1120)
    press(world, "EDIT", "UP")
    log = world.wire.log
    step_until(world, lambda: bytes(log.last(1)[0][2][3:5]) == b"\x14\x60")  # P1120 is asked for,
    world.run(30)  # and then not for half a second
    world.press("SET")
    world.press("EDIT")
    wait(world, "NEW 011.00s")
    assert world.drives[1].read(1120) == 11
    world.check()


def test_what_is_risky_by_the_catalogue_is_asked_first_in_every_family_that_has_its_table():
    everyone = list(families.FAMILIES)
    everyone += [families.on_bop(family) for family in everyone if family.has_bop_link]
    tables = [(family, table_of(family)) for family in everyone]
    assert [family for family, table in tables if not table] == [families.GENERIC], tables
    for family, table in tables:
        for row in catalogue.rows(table) if table else ():
            number = catalogue.number(row)
            assert not row[catalogue.ASKS] or number in family.ask_first, (family.name, number)


def test_edit_again_types_a_choice_that_has_no_text():
    world = world_of()
    look_up(world, 700)
    press(world, "EDIT", "EDIT")
    wait(world, "NEW 5")
    press(world, "EDIT")
    wait(world, "NEW 0005")
    press(world, "EDIT")
    wait(world, "P0700[0]       5")
    world.check()


def test_the_texts_are_walked_from_their_ends_where_the_value_has_none():
    """And only once all of them are there; UP and DOWN walk them, no other key."""
    world = world_of(loop_us=LOOP_US)
    look_up(world, 1300)
    world.app.panel.has_taken = lambda us: True  # so each step looks for one piece
    for key, rows in (
        ("UP", ("V/f linear", "NEW            0")),
        ("DOWN", ("Torque + encoder", "NEW           23")),
    ):
        keep(world, 1300, 18)
        world.press("EDIT", 40)
        for _ in range(30):
            world.press(key, 30)
            if row_2(world)[13:] != " 18":
                break
        assert (row_1(world).rstrip(), row_2(world)) == rows, world.lcd()
        press(world, "PARAM", "EDIT")
        world.run(1000)
        press(world, "NEXT")
        assert world.lcd() == (" " * 16, "NEW           18"), world.lcd()
        press(world, "PARAM")
    world.check()


def test_edit_pressed_twice_does_not_wait_for_the_texts():
    world = world_of()
    look_up(world, 700)
    world.app.panel.has_taken = lambda us: True  # so each step looks for one piece
    world.press("EDIT", 40)
    world.press("EDIT", 40)
    wait(world, "NEW 5")
    world.run(500)
    world.check()


def test_bits_are_read_and_changed_one_by_one():
    world = world_of()
    look_up(world, 52)
    bits = int(row_2(world)[5:].strip("h "), 16)
    assert row_2(world) == "r0052      %04Xh" % bits
    press(world, "EDIT")
    world.run(500)
    names = []
    for bit in range(16):
        world.run(300)
        assert row_2(world) == "r0052.%02d       %d" % (bit, bits >> bit & 1), world.lcd()
        names.append(row_1(world).rstrip())
        press(world, "NEXT")
    assert names[:3] == ["Ready to start", "Ready", "Running"] and names[14] == "Runs right"
    for key in ("UP", "SET"):
        press(world, key)
        assert row_2(world) == "READ ONLY"
        press(world, "NEXT")  # takes that away
    press(world, *("NEXT",) * 5)
    assert row_2(world) == "r0052.07       0", world.lcd()
    world.drives[1].warn(600)
    wait(world, "r0052.07       1")  # nobody changes it, so it is what it is now
    press(world, "PARAM")
    look_up(world, 927)
    before = world.drives[1].read(927)
    assert before == 0b1111
    for key, wanted in (("DOWN", 0b1101), ("UP", 0b1111)):
        press(world, "EDIT", "NEXT", key, key)
        assert row_2(world) == "P0927.01       %d" % (wanted >> 1 & 1)
        wait(world, "P0927.01-------")  # it blinks: not in force yet
        press(world, "SET")
        assert row_2(world) == YES_OR_NO
        press(world, "SET")
        wait(world, "WRITTEN (RAM)")
        assert world.drives[1].read(927) == wanted
        wait(world, "P0927")
    world.check()


def test_a_bit_without_a_text_has_an_empty_row():
    world = world_of()
    look_up(world, 927)
    press(world, "EDIT", "NEXT", "NEXT", "NEXT")
    world.run(500)
    assert world.lcd() == ("USS on COM link ", "P0927.03       1")
    press(world, "NEXT")
    world.run(500)
    assert world.lcd() == (" " * 16, "P0927.04       0")
    world.check()


def test_while_the_text_of_a_bit_or_a_choice_is_looked_for_there_are_dots():
    for number, row, text in (
        (927, "P0927.00       1", "CB, PROFIBUS"), (700, "NEW            5", "USS on COM link"),
    ):  # fmt: skip
        world = world_of()
        look_up(world, number)
        search = sys.modules["panel.lookup"].Search
        look, search.step = search.step, lambda search: None  # that takes for ever
        try:
            press(world, "EDIT")
            assert (row_1(world).rstrip(), row_2(world)) == ("...", row), world.lcd()
        finally:
            search.step = look
        world.run(500)
        assert (row_1(world).rstrip(), row_2(world)) == (text, row), world.lcd()
        world.check()


def test_a_double_word_has_thirty_two_bits():
    """How wide a value is the drive says."""
    world = world_of()
    parameters = world.drives[1].parameters
    row = parameters.rows[927]
    parameters.rows[927] = row[:2] + ("U32", "", 1, 0, 0xFFFFFFFF) + row[7:]
    look_up(world, 927)
    for bits in (0xF, 0x8001000F):
        keep(world, 927, bits)
        assert row_2(world) == "P0927  %08Xh" % bits
    press(world, "EDIT")
    shown = []
    for _ in range(33):
        shown.append((row_2(world)[6:8], row_2(world)[-1]))
        press(world, "PREVIOUS")
    bits = [0] + list(range(31, -1, -1))
    assert shown == [("%02d" % bit, str(0x8001000F >> bit & 1)) for bit in bits], shown
    assert row_2(world)[5:8] == ".31"
    press(world, "PREVIOUS", "UP", "SET", "SET")
    wait(world, "WRITTEN (RAM)")
    assert parameters.get(927) == 0xC001000F
    world.check()


def test_what_is_typed_is_dropped_when_the_drive_tells_the_value_in_another_width():
    world = world_of()
    parameters = world.drives[1].parameters
    row = parameters.rows[927]
    look_up(world, 927)
    press(world, "EDIT", "EDIT")
    assert row_2(world) == "NEW 000F", world.lcd()
    parameters.rows[927] = row[:2] + ("U32", "", 1, 0, 0xFFFFFFFF) + row[7:]
    wait(world, "P0927  0000000Fh")
    world.check()


def test_a_value_is_typed_in_hexadecimal():
    world = world_of()
    look_up(world, 1120)
    press(world, "EDIT", "EDIT")
    wait(world, "NEW 41200000")
    assert row_2(world) == "NEW 41200000", "without its unit"
    press(world, "DOWN")
    wait(world, "NEW 4120000F")
    press(world, "UP", *("PREVIOUS",) * 5)
    press(world, "UP")
    wait(world, "NEW 41300000")
    press(world, "SET")
    wait(world, "WRITTEN (RAM)")
    assert world.drives[1].read(1120) == 11
    world.check()


def test_what_has_too_many_digits_is_typed_in_hexadecimal_at_once():
    world = world_of()
    look_up(world, 1120)
    for number, row in (
        (999_999_936.0, "NEW 999999936.00"), (1_000_000_000.0, "NEW 4E6E6B28"),
        (1e10, "NEW 501502F9"),
    ):  # fmt: skip
        keep(world, 1120, number)
        shown = row_2(world)
        press(world, "EDIT")
        wait(world, row)
        press(world, "PARAM")
        world.run(100)
        assert row_2(world) == shown and shown[-1] != "h", world.lcd()
    world.check()


def test_a_value_reads_as_its_type_has_it_and_is_as_wide_as_the_drive_tells_it():
    word, double, half = pkw.WORD, pkw.DOUBLE, pkw.float_to_words(2.5)
    for kind, form, width, high, low, read in (
        (b"U16", b"", word, 0, 0xFFFF, b"65535"),
        (b"I16", b"", word, 0, 0xFFFF, b"-1"),
        (b"I16", b"", word, 0, 0x7FFF, b"32767"),
        (b"I16", b"", word, 0, 0x8000, b"-32768"),
        (b"U32", b"", double, 0xFFFF, 0xFFFE, b"4294967294"),
        (b"I32", b"", double, 0xFFFF, 0xFFFE, b"-2"),
        (b"U16", b"", double, 1, 0, b"65536"),
        (b"BICO", b"", double, 52, 3, b"52:3"),
        (b"BICO", b"", word, 0, 3, b"3"),
        (b"Float", b"2", double) + half + (b"2.50",),
        (b"Float", b"", double) + half + (b"2.500",),
        (b"Float", b"2", word, 0, 5, b"5"),
        (b"U16", b"x", word, 0, 0xAB, b"00ABh"),
        (b"U16", b"b52", word, 0, 0xAB, b"00ABh"),
        (b"U32", b"x", double, 0, 0xAB, b"000000ABh"),
        (b"U16", b"v700", word, 0, 0xAB, b"171"),
    ):
        row = catalogue.find("mm440", 1120)
        row[catalogue.TYPE], row[catalogue.FORM] = kind, form
        shown = value.Form(row, width)
        assert shown.words(high, low) == read, (kind, form, shown.words(high, low))
        assert shown.list == (form if form[:1] in (b"v", b"b") else b"")
    for width, words, read in ((double, half, b"2.500"), (word, (0, 5), b"5")):
        assert value.Form(None, width).words(*words) == read, "nobody knows its type"


def test_a_whole_number_is_typed_with_the_places_and_the_sign_of_its_type():
    word, double = pkw.WORD, pkw.DOUBLE
    for family, number, width, bits, typed in (
        ("mm440", 2014, word, 2000, b"02000"),  # U16
        ("mm440", 208, double, 230, b"0000000230"),  # U32
        ("mm440", 208, double, 0xFFFFFFFF, b"4294967295"),
        ("g120", 300, word, 5, b"+00005"),  # I16
        ("g120", 300, word, 0xFFFF, b"-00001"),
        ("g120", 300, word, 0x8000, b"-32768"),
        ("g120", 1240, word, 3, b"+3"),  # 0...3
        ("g120", 2124, double, 7, b"+0000000007"),  # I32
        ("g120", 2124, double, 0xFFFF0000, b"-0000065536"),
    ):
        form = value.Form(catalogue.find(family, number), width)
        shown, place = form.typed(bits >> 16, bits & 0xFFFF)
        assert (bytes(shown), place) == (typed, len(typed) - 1), (family, number, shown, place)
        assert form.bits(shown) == bits, (family, number, shown)


def test_a_value_that_is_edited_and_not_changed_is_what_was_read_in_each_way_to_change_it():
    word, double = pkw.WORD, pkw.DOUBLE
    shown = Sight(world_of().app.panel)
    shown.table = "mm440"
    for number, width, bits, ways in (
        (700, word, 5, 3),  # by its text, digit by digit, in hexadecimal
        (927, word, 0x8001, 2),  # bit by bit, in hexadecimal
        (927, double, 0x80010003, 2),
        (1120, double, 0x41280000, 2),
        (2019, double, 0x00340001, 2),
        (208, double, 0xFFFF0001, 0),  # only to be read, and it has no bits
        (52, word, 0x8001, 1),  # of this one each bit is shown
    ):
        shown.row = catalogue.find("mm440", number)
        shown.form = value.Form(shown.row, width)
        shown.high, shown.low = bits >> 16, bits & 0xFFFF
        edited = Editing(shown)
        for _ in range(ways):
            assert edited.bits() == bits, (number, edited.way, edited.bits())
            edited.next_way()
        assert edited.way is None, number


def test_a_unit_stands_behind_what_is_typed_where_it_has_room():
    shown = Sight(world_of().app.panel)
    for unit, row in ((b"kW", b"NEW 0000000230kW"), (b"rpm", b"NEW 0000000230")):
        shown.row = catalogue.find("mm440", 208)
        shown.row[catalogue.KEY], shown.row[catalogue.UNIT] = b"P0208", unit
        shown.form, shown.low = value.Form(shown.row, pkw.DOUBLE), 230
        assert Editing(shown).row(False) == row, Editing(shown).row(False)
        assert shown.form.fitting(0, 230, 3 + len(unit)) == b"230" + unit
        assert shown.form.fitting(0, 230, 2 + len(unit)) == b"230"


def test_a_number_beyond_its_type_is_refused():
    word, double = pkw.WORD, pkw.DOUBLE
    for family, number, width, last, beyond in (
        ("mm440", 2014, word, b"65535", b"65536"),
        ("mm440", 2014, word, b"00000", b"-0001"),
        ("mm440", 208, double, b"4294967295", b"4294967296"),
        ("g120", 300, word, b"+32767", b"+32768"),
        ("g120", 300, word, b"-32768", b"-32769"),
        ("g120", 2124, double, b"+2147483647", b"+2147483648"),
    ):
        form = value.Form(catalogue.find(family, number), width)
        form.bits(last)
        try:
            bits = form.bits(beyond)
        except ValueError:
            continue
        raise AssertionError("%s P%04d: %r is %X" % (family, number, beyond, bits))
    world = world_of()
    look_up(world, 2014)
    before = world.wire.log.count
    press(world, "EDIT", *("PREVIOUS",) * 4)
    type_digits(world, "9")
    wait(world, "NEW 92000")
    press(world, "SET")
    assert row_2(world) == "BEYOND LIMITS", world.lcd()
    sent = world.wire.log.last(world.wire.log.count - before)
    assert not [row for row in sent if row[1] and row[2][3] >> 4 not in (0, 1)]  # only reads
    world.check()


def test_a_floating_point_number_is_typed_with_as_many_decimals_as_there_is_room_for():
    """Of an unknown drive it has three, and a sign."""
    form = value.Form(None, pkw.DOUBLE)
    for number, typed, place in (
        (0.5, b"+000000.500", 6),
        (-1234567.0, b"-1234567.000", 7),
        (123456792.0, b"+123456792.00", 9),
        (-999999936.0, b"-999999936.00", 9),
    ):
        shown = form.typed(*pkw.float_to_words(number))
        assert (bytes(shown[0]), shown[1]) == (typed, place), shown
        assert len(typed) <= value.TYPED_MAX
    form = value.Form(catalogue.find("mm440", 1120), pkw.DOUBLE)  # 0...650, two decimals
    for number, typed, place in (
        (10.0, b"010.00", 2), (650.0, b"650.00", 2), (12345.678, b"12345.68", 4),
        (-5.0, b"-005.00", 3),  # whatever the drive tells
    ):  # fmt: skip
        shown = form.typed(*pkw.float_to_words(number))
        assert (bytes(shown[0]), shown[1]) == (typed, place), shown
    row = catalogue.find("mm440", 1120)
    row[catalogue.FORM] = b"0"  # without a point
    form = value.Form(row, pkw.DOUBLE)
    for number, typed in ((10.0, b"010"), (12345.6, b"12346"), (-5.0, b"-005")):
        shown = form.typed(*pkw.float_to_words(number))
        assert (bytes(shown[0]), shown[1]) == (typed, len(typed) - 1), shown
    row[catalogue.FORM] = b"6"
    shown = value.Form(row, pkw.DOUBLE).typed(*pkw.float_to_words(123456792.0))
    assert (bytes(shown[0]), shown[1]) == (b"123456792.00", 8), shown


def test_a_connector_is_typed_as_number_and_index():
    world = world_of()
    look_up(world, 731)
    assert row_2(world) == "P0731[0]    52:3"
    press(world, "EDIT")
    wait(world, "NEW 00052:003")
    press(world, "UP", "NEXT", "NEXT", "NEXT")
    type_digits(world, "1")
    wait(world, "NEW 00053:004")
    press(world, "SET")
    wait(world, "P0731[0]    53:4")
    assert world.drives[1].read(731) == 53 << 16 | 4
    world.check()


def test_a_sign_is_a_place_as_well():
    world = world_of()
    look_up(world, 1001)
    assert row_2(world) == "P1001[0]  0.00Hz"
    press(world, "EDIT")
    wait(world, "NEW +000.00Hz")
    type_digits(world, "7")
    press(world, "PREVIOUS", "PREVIOUS", "PREVIOUS")
    for row in ("NEW -007.00Hz", "NEW +007.00Hz", "NEW -007.00Hz"):
        press(world, "UP")
        wait(world, row)
    press(world, "SET")
    wait(world, "P1001[0] -7.00Hz")
    assert world.drives[1].read(1001) == -7
    world.check()


def test_a_reading_is_not_edited_and_set_alone_changes_nothing():
    world = world_of()
    look_up(world, 27)
    press(world, "EDIT")
    assert row_2(world) == "READ ONLY"
    press(world, "SET")
    assert row_2(world) == "PRESS EDIT FIRST"
    world.check()


def test_stop_while_a_value_is_typed_stops_at_once_and_writes_nothing():
    world = world_of()
    press(world, "START")
    world.run(4000)
    look_up(world, 1120)
    press(world, "EDIT", "UP")
    wait(world, "NEW 011.00s")
    world.down("STOP")
    world.run(400)
    assert world.reads("STOP, HOLD: OFF3"), world.lcd()
    world.up("STOP")
    world.run(11_000)
    assert world.drives[1].state != "running" and world.drives[1].read(1120) == 10
    assert row_2(world) == "P1120[0]  10.00s"
    press(world, "SET")  # nothing is edited any more
    assert row_2(world) == "PRESS EDIT FIRST" and world.drives[1].read(1120) == 10
    world.check()


def test_param_that_ends_the_typing_and_is_held_opens_no_menu():
    world = world_of()
    look_up(world, 1120)
    press(world, "EDIT", "UP")
    hold(world, "PARAM", 1400)
    assert row_2(world) == "P1120[0]  10.00s", world.lcd()
    world.check()


def test_set_together_with_another_key_is_no_clear_wish():
    world = world_of()
    look_up(world, 1120)
    press(world, "EDIT", "UP")
    for key in ("NEXT", "EDIT"):
        for down in ("SET", key):
            world.down(down)
        world.run(200)
        for down in ("SET", key):
            world.up(down)
        world.run(1000)
        wait(world, "NEW 011.00s")  # the other key does nothing either
    assert world.drives[1].read(1120) == 10
    world.check()


def test_what_is_still_looked_for_can_neither_be_edited_nor_walked_from():
    world = world_of()
    look_up(world, 1120)
    world.app.panel.has_taken = lambda us: True  # so each step looks for one piece
    for key in ("NEXT", "PREVIOUS", "EDIT"):
        world.press(key, 30)
    wait(world, "NOT READ YET")
    wait(world, "P1121[0]  10.00s")  # one further, and nothing is edited
    world.check()


def test_another_index_ends_the_search_for_the_next_parameter():
    world = world_of()
    look_up(world, 1120)
    world.app.panel.has_taken = lambda us: True  # so each step looks for one piece
    for key in ("NEXT", "UP"):
        world.press(key, 30)
    wait(world, "P1120[1]  10.00s")
    world.run(1000)
    assert lines(world, 4000) == {"Ramp-up time", "A1 0...650s"}
    world.check()


def test_a_value_of_which_the_list_has_not_told_yet_what_it_is_cannot_be_edited():
    world = world_of(addresses=(1, 2))
    look_up(world, 1120)
    search = sys.modules["panel.lookup"].Search
    look, search.step = search.step, lambda search: None  # that takes for ever
    try:
        press(world, "ADDRESS_UP")
        wait(world, "P1120[0]  10.000")
        assert lines(world, 3000) == {"...", "A2"}
        press(world, "EDIT")
        assert row_2(world) == "NOT READ YET", world.lcd()
    finally:
        search.step = look
    wait(world, "P1120[0]  10.00s")
    world.check()


def test_no_motor_starts_while_a_value_is_typed():
    world = world_of()
    look_up(world, 1120)
    press(world, "EDIT")
    for key in ("START", "REVERSE", "JOG_RIGHT", "JOG_LEFT"):
        press(world, key)
        assert row_2(world) == "NO: SET OR PARAM", key
    assert starts(world) == 0
    world.run(61_000)
    assert row_2(world) == "P1120[0]  10.00s"  # nobody has gone on for a minute
    world.check()


# --- other families ------------------------------------------------------------------------------


def test_of_an_unknown_family_every_number_is_read_and_written():
    world = world_of(known="generic")
    look_up(world, 1120)
    assert row_2(world) == "P1120[0]  10.000", world.lcd()
    press(world, "EDIT")
    wait(world, "NEW +000010.000")
    press(world, "UP", "SET")
    wait(world, "P1120[0]  11.000")
    press(world, "EDIT", "EDIT")
    wait(world, "NEW 41300000")
    press(world, "PARAM", "DOWN")
    wait(world, "P1120[254] -----")  # nobody knows how many there are
    press(world, "UP")
    wait(world, "P1120[0]  11.000")
    press(world, "PREVIOUS")
    wait(world, "P1119")
    look_up(world, 1)
    for _ in range(2):
        press(world, "PREVIOUS")
        wait(world, "P0000")  # nothing is before it
    look_up(world, 304)
    press(world, "EDIT", "UP")
    wait(world, "NEW 00231")
    press(world, "SET")
    world.run(1000)
    assert world.drives[1].read(1120) == 11
    world.check()


def test_a_micromaster_3_has_no_indices():
    world = world_of("mm3")
    look_up(world, 12)
    assert row_2(world).startswith("P0012  "), world.lcd()
    press(world, "UP")
    assert row_2(world) == "NOT AN ARRAY"
    world.check()


def test_on_the_bop_link_a_parameter_of_the_link_begins_with_the_index_of_that_link():
    world = world_of("mm440-bop", settings={"favourites": {"mm440": [27]}})
    go_to(world, "PARAMETERS", "FAVOURITES")
    wait(world, "r0027")  # a drive has the same on either link
    for number, row in ((2010, "P2010[1] "), (1120, "P1120[0] ")):
        look_up(world, number)
        assert row_2(world).startswith(row), world.lcd()
    world.check()


def test_a_drive_without_a_parameter_channel_tells_nothing_and_is_asked_for_nothing():
    """The menu leads here from another one only."""
    drives = simulated(listed_drives("1=mm440,2=mm420/0"))
    settings = {"kinds": {"1": "mm440", "2": "mm420/0"}}
    world = World(main.start, (1, 2), kinds=drives, settings=settings)
    world.run(1000)
    look_up(world, 1120)
    press(world, "ADDRESS_UP")
    world.run(4000)
    assert world.lcd()[1] == "P1120          ?", world.lcd()
    press(world, "EDIT")
    assert row_2(world) == "NOT READ YET", world.lcd()
    press(world, "ADDRESS_DOWN")
    wait(world, "P1120[0]  10.00s")
    world.check()


def test_the_elements_of_a_g120_go_with_the_tasks_for_arrays():
    """But for the first; those of a MICROMASTER go like any value."""
    for kind, number, of_the_second in (("g120", 945, {6}), ("mm440", 947, {1})):
        world = world_of(kind)
        look_up(world, number)
        for index, wanted in enumerate(({1}, of_the_second)):
            if index:
                press(world, "UP")
            wait_for_value(world)
            assert row_2(world).startswith("r%04d[%d] " % (number, index)), world.lcd()
            tasks = {
                sent[3] >> 4
                for _, from_panel, sent in world.wire.log.last(100)
                if from_panel and sent[3] & 7 == number >> 8
                and sent[4] == number & 0xFF and sent[6] == index
            }  # fmt: skip
            assert tasks == wanted, (kind, index, tasks)
        world.check()


def test_another_drive_has_another_value():
    world = world_of(addresses=(1, 2))
    world.drives[2].write(1120, 0, 7)
    look_up(world, 1120)
    assert row_2(world) == "P1120[0]  10.00s"
    press(world, "ADDRESS_UP")
    wait(world, "P1120[0]   7.00s")
    assert "A2 0...650s" in lines(world)
    for key in ("ADDRESS_UP", "NEXT"):  # in one moment: both do what they do
        world.down(key)
    world.run(100)
    for key in ("ADDRESS_UP", "NEXT"):
        world.up(key)
    wait(world, "P1121[0]  10.00s")
    assert "A1 0...650s" in lines(world)
    world.check()


def test_a_drive_that_is_lost_tells_nothing_and_ends_the_typing():
    world = world_of()
    look_up(world, 1120)
    press(world, "EDIT")
    world.drives[1].unplug()
    world.run(2500)
    assert row_2(world) == "P1120[0]       ?", world.lcd()
    world.drives[1].plug()
    wait(world, "P1120[0]  10.00s")
    world.check()


def test_an_alarm_has_both_rows_and_what_it_leaves_is_not_read_as_the_parameter():
    world = running()
    look_up(world, 1120)
    page = Parameter(world.app.panel)
    assert page.whole
    world.drives[1].unplug()
    world.run(1500)
    assert world.lcd() == ("NO CONTACT,     ", "MAY RUN      A1 ")
    assert not page.whole
    screen = Screen("A00")
    for row in (0, 1):
        screen.put(row, 0, 16, b"0123456789ABCDEF")
    page.draw(screen, 0)
    assert tuple(screen.rows()) == ("0123456789ABCDEF", "            CDEF"), screen.rows()


def test_a_drive_turned_to_while_the_panel_hangs_is_the_one_that_is_read():
    """The hang has taken the key away from the page, which finds the drive all the same."""
    world = world_of(addresses=(1, 2))
    world.drives[2].write(1120, 0, 7)
    look_up(world, 1120)
    world.down("ADDRESS_UP")
    step_until(world, lambda: world.selected() == 2)
    world.up("ADDRESS_UP")
    world.hang(330)  # shorter than until a key repeats
    wait(world, "PANEL HUNG")
    wait(world, "P1120[0]   7.00s")
    world.check()


# --- favourites ----------------------------------------------------------------------------------


def test_what_is_typed_stays_when_the_drive_falls_silent_on_the_number():
    world = world_of()
    look_up(world, 1120)
    wait_for_value(world)
    hear = world.drives[1].slave.hear

    def hear_selectively(burst):
        is_asked = burst.data[3] & 0xF0 and burst.data[4] == 1120 & 0xFF
        return None if is_asked else hear(burst)

    press(world, "EDIT", "NEXT", "UP")
    typed = row_2(world)
    world.drives[1].slave.hear = hear_selectively
    wait(world, "NO REPLY TO IT")
    world.run(5_000)
    assert row_2(world)[:4] == typed[:4], world.lcd()
    world.drives[1].slave.hear = hear
    press(world, "SET")
    world.run(500)
    assert abs(world.drives[1].read(1120) - 10.1) < 0.001, world.lcd()
    world.check()


def test_favourites_begin_as_parameter_mode_and_set_held_adds_and_removes():
    world = world_of()
    go_to(world, "PARAMETERS", "FAVOURITES")
    there = []
    for _ in range(5):
        there.append(wait_for_value(world)[:5])
        press(world, "NEXT")
    assert there == ["P0700", "P1000", "P2011", "r2024", "r2025"], there
    look_up(world, 1120)
    hold(world, "SET", 1800)
    assert row_2(world) == "FAVOURITE", world.lcd()
    world.run(2000)
    stored = json.loads(world.flash.files["settings.json"])
    assert stored["favourites"] == {"mm440": [700, 1000, 2011, 2024, 2025, 1120]}
    go_to(world, "PARAMETERS", "FAVOURITES")
    press(world, "PREVIOUS")
    wait(world, "P1120")
    hold(world, "SET", 1800)
    assert row_2(world) == "NO FAVOURITE NOW"
    world.run(2000)
    stored = json.loads(world.flash.files["settings.json"])
    assert stored["favourites"] == {"mm440": [700, 1000, 2011, 2024, 2025]}
    press(world, "NEXT")  # from one that is none any more
    wait(world, "P0700")
    press(world, "PARAM", "PARAM")
    wait(world, "P0700:     5 A1")  # parameter mode is what it was
    world.check()


def test_where_there_are_no_favourites_it_begins_with_the_first_number():
    world = world_of(settings={"favourites": {"mm440": []}})
    go_to(world, "PARAMETERS", "FAVOURITES")
    wait(world, "r0000")
    press(world, "NEXT")
    wait(world, "r0000")
    world.check()


def test_there_is_room_for_thirty_two_favourites():
    """Those of all families together."""
    others = {"g120": [3, 4], "mm420": [5]}
    world = world_of(settings={"favourites": dict(others, mm440=list(range(28)))})
    on_demand.keep()
    on_demand.drop("settings_file")  # a test before this one may have left it
    look_up(world, 1120)
    for said in ("FAVOURITE", "FAVOURITES FULL"):
        hold(world, "SET", 1800)
        assert row_2(world) == said, world.lcd()
        assert "settings_file" not in sys.modules
        press(world, "NEXT")
        wait(world, "P112")
    world.run(2000)
    kept = json.loads(world.flash.files["settings.json"])["favourites"]
    assert kept == dict(others, mm440=list(range(28)) + [1120]), kept
    world.check()


def test_a_question_that_finds_no_room_is_not_on_its_way():
    """Others have asked the drive as much as it can keep: who knows that asks again later."""
    reading, drive = Reading(), Drive(1, (1 << 30) - 1)
    assert reading.ask(drive, 700) and reading.asked
    reading.drop()
    while not drive.channel.is_full():
        drive.ask(pkw.read(1000))
    assert not reading.ask(drive, 700) and not reading.asked and reading.take() is None


# --- the page by itself --------------------------------------------------------------------------


class Alone(AskedDrive):
    """The page of a drive, which is asked, and answers what and when the test says."""

    mask = 0x3FFFFFFF
    pkw_words, address, page_turns = 4, 7, 0
    off_time_ms = 1_500

    def __init__(self, number, numbers=catalogue.ALL, family=families.MM440, began_ms=0):
        AskedDrive.__init__(self)
        self.selected = self.drive = self.survey = self.layout = self.desk = self
        self.announcer = self.settings = self
        self.family, self.favourites, self.began_ms = family, {}, began_ms
        self.remembered = {"panel.lookup.parameter": (numbers, number)}
        self.keys = Keys(NAMES, self.mask)
        self.said, self.covers = [], []
        self.page = Parameter(self)
        self.look_on()

    def look_on(self):
        """Whatever is looked for in the catalogue is found."""
        while self.page.is_busy:
            self.page.work(self.began_ms)

    def is_undisturbed(self, _for_us):
        return True

    def has_taken(self, _us):
        return False

    def say(self, _now_ms, *said):
        self.said.append(said[0])

    def change(self, name, value):
        setattr(self, name, value)

    def needs_attention(self):
        return False

    def cover(self, page):
        self.covers.append(page)

    def asks(self, ms, *down):
        """Whether the drive is asked in the step at this time; down: keys that are down."""
        before = len(self.asked)
        self.keys.down = self.keys.bits(down)
        self.page.step(self.keys, self.began_ms + ms & self.mask)
        self.look_on()
        return len(self.asked) > before

    def question(self):
        job = self.asked[-1]
        return job.task, job.number, job.index

    def answer(self, ms, value=0, state=pkw.DONE, width=pkw.WORD):
        job = self.asked[-1]
        job.state, job.width, job.error = state, width, 0
        if width == pkw.DOUBLE:
            job.high, job.low = pkw.float_to_words(value)
        else:
            job.low = value
        return self.asks(ms)

    def press(self, ms, *names):
        self.keys.pressed = self.keys.bits(names)
        self.page.take_keys(Acts(self.keys), self.began_ms + ms & self.mask)
        self.look_on()
        return self.row(ms)

    def row(self, ms=0):
        screen = Screen()
        self.page.draw_row_2(screen, self.began_ms + ms & self.mask)
        return screen.rows()[1].rstrip()

    def lines(self):
        """What row 1 says in its first three turns."""
        found, screen = [], Screen()
        for turn in (0, 1, 2):
            self.page_turns = turn
            self.page.draw(screen, 0)
            found.append(screen.rows()[0].rstrip())
        self.page_turns = 0
        return found


def told(number, number_told, **options):
    """Its drive has told a value at once."""
    alone = Alone(number, **options)
    assert alone.asks(0) and not alone.answer(0, number_told)
    return alone


def test_the_next_question_follows_500_ms_after_an_answer_and_one_of_another_index_at_once():
    alone = Alone(700, began_ms=Alone.mask - 600)  # the clock begins anew meanwhile
    assert alone.row() == "P0700[0]       ?"
    assert alone.asks(0) and alone.question() == (pkw.READ, 700, 0) and not alone.asks(400)
    for ms in (500, 1_100):
        assert not alone.answer(ms, 5) and alone.row() == "P0700[0]       5"
        assert not alone.asks(ms + 499) and alone.asks(ms + 500)
    alone.answer(1_700, 5)
    assert alone.press(1_701, "UP") == "P0700[1]       ?"
    assert alone.asks(1_702) and alone.question() == (pkw.READ, 700, 1)
    assert alone.press(1_703, "DOWN") == "P0700[0]       ?" and alone.asks(1_704)
    assert alone.press(1_705, "DOWN") == "P0700[2]       ?"  # it has three
    alone.full = True
    assert not alone.asks(1_706)
    alone.full = False
    assert alone.asks(1_707) and alone.question() == (pkw.READ, 700, 2)


def test_what_is_typed_is_dropped_a_minute_after_the_last_key():
    for began_ms in (1, Alone.mask - 70_000):
        alone = Alone(TYPED, began_ms=began_ms)
        assert alone.press(0, "UP") == "P01000"
        alone.asks(59_999)
        assert alone.row() == "P01000"
        alone.asks(60_000)
        assert alone.row() == "r0000          ?", alone.row()
        alone = told(2010, 6, began_ms=began_ms)
        alone.press(10, "EDIT")
        alone.press(20, "EDIT")
        alone.press(30_000, "UP")
        alone.asks(89_999)
        assert alone.row(89_999).startswith("NEW"), alone.row()
        alone.asks(90_000)
        assert alone.row(90_000).startswith("P2010"), alone.row()


def test_the_digit_is_away_for_the_last_250_of_800_ms():
    alone = Alone(TYPED, began_ms=70_000)
    for since_ms in (0, 1_000):
        alone.press(since_ms, "NEXT")
        alone.press(since_ms, "PREVIOUS")
        for ms, row in ((0, "P00000"), (549, "P00000"), (550, "P0_000"), (799, "P0_000"),
                        (800, "P00000"), (1_349, "P00000"), (1_350, "P0_000")):  # fmt: skip
            assert alone.row(since_ms + ms) == row, ms


def test_a_set_that_is_held_for_1500_ms_alone_makes_a_favourite():
    for began_ms in (0, Alone.mask - 700):
        alone = told(1120, 5, began_ms=began_ms)
        alone.press(10, "SET")
        assert alone.said == [EDIT_FIRST]
        alone.asks(20, "SET")
        alone.asks(1_509, "SET")
        assert alone.favourites == {}
        alone.asks(1_510, "SET")
        alone.asks(9_000, "SET")
        assert alone.said[1:] == [IS_FAVOURITE]
        assert alone.favourites["mm440"][-1] == 1120
        alone.press(9_010, "SET")
        alone.asks(9_020)  # it was let go
        alone.asks(9_030, "SET")
        alone.asks(20_000, "SET")
        alone.press(20_010, "SET")
        alone.press(20_020, "STOP")
        alone.asks(30_000, "SET")
        alone.press(30_010, "SET", "STOP")
        alone.asks(40_000, "SET")
        assert alone.favourites["mm440"][-1] == 1120
        alone.press(40_010, "SET")
        alone.asks(41_510, "SET")
        assert 1120 not in alone.favourites["mm440"]


def test_a_telegram_off_time_shorter_than_the_bus_needs_is_not_asked_about():
    for least_ms, refused in ((5, False), (6, True)):
        alone = told(2014, 4)
        alone.off_time_ms = least_ms
        alone.press(10, "EDIT")
        assert alone.press(20, "UP") == "NEW 00005ms"
        alone.press(30, "SET")
        assert alone.said == [REFUSALS[200]] * refused
        assert len(alone.covers) == (0 if refused else 1)  # the question about it


def test_a_refusal_is_said_when_it_begins():
    alone = told(2010, 6)
    ms = 500
    for state, more, row in (
        (pkw.UNANSWERED, 1, "P2010[0]   -----"), (pkw.UNANSWERED, 0, "P2010[0]   -----"),
        (pkw.DONE, 0, "P2010[0]       6"), (pkw.TIMED_OUT, 0, "P2010[0]       ?"),
        (pkw.REFUSED, 1, "P2010[0]   -----"),
    ):  # fmt: skip
        assert alone.asks(ms)
        before = len(alone.said)
        alone.answer(ms, 6, state)
        assert len(alone.said) - before == more and alone.row() == row, (state, alone.row())
        ms += 500


def test_another_index_has_nothing_of_the_one_before():
    alone = told(700, 5)
    unnamed = ["Command source", "A7 0...6", "Command source"]
    named = ["Command source", "USS on COM link", "A7 0...6"]
    assert alone.lines() == named
    assert alone.asks(500) and not alone.answer(510, state=pkw.REFUSED)
    assert alone.row() == "P0700[0]   -----" and len(alone.said) == 1
    assert alone.press(520, "UP") == "P0700[1]       ?" and alone.lines() == unnamed
    assert alone.asks(521) and not alone.answer(530, state=pkw.REFUSED)
    assert alone.row() == "P0700[1]   -----" and len(alone.said) == 2
    assert alone.asks(1_030) and not alone.answer(1_040, 5)
    assert alone.row() == "P0700[1]       5" and alone.lines() == named
    assert alone.press(1_050, "DOWN") == "P0700[0]       ?" and alone.lines() == unnamed
    assert alone.asks(1_051)
    alone.press(1_052, "UP")
    assert alone.answer(1_053, 2) and alone.row() == "P0700[1]       ?"  # that was asked before
    assert alone.question() == (pkw.READ, 700, 1) and alone.lines() == unnamed


def test_while_the_next_parameter_is_looked_for_an_answer_is_taken_and_nothing_is_asked():
    alone = told(700, 5)
    assert alone.asks(500)
    look_on, alone.look_on = alone.look_on, lambda: None  # that takes long
    alone.press(510, "NEXT")
    assert not alone.answer(520, 2) and alone.row() == "P0700[0]       2"
    assert not alone.asks(5_000)
    alone.look_on = look_on
    look_on()
    assert alone.row().startswith("P0701[0]") and alone.asks(5_001)
    assert alone.question() == (pkw.READ, 701, 0)


def test_a_step_that_has_taken_long_looks_for_one_piece_and_one_that_a_reply_may_end_sooner():
    look, pieces = Search.step, []

    def count(search):
        pieces[-1] += 1
        return look(search)

    for free_us, taken_us, most in (
        (4_000, 1_999, 6), (4_000, 2_000, 1), (3_999, 899, 6), (3_999, 900, 1)
    ):  # fmt: skip
        alone = told(700, 5)
        alone.is_undisturbed = lambda for_us, free_us=free_us: for_us <= free_us
        alone.has_taken = lambda us, taken_us=taken_us: us <= taken_us
        alone.look_on = lambda: None
        alone.press(10, "PREVIOUS")
        Search.step = count
        pieces.clear()
        try:
            while alone.page.is_busy:
                pieces.append(0)
                alone.page.work(10)
        finally:
            Search.step = look
        assert max(pieces) == most, (free_us, taken_us, pieces)


def test_thirteen_characters_that_are_typed_leave_no_place_in_front_of_them():
    for number, row in (
        (-999999936.0, "NEW-999999936.00"), (-1234567.0, "NEW -1234567.000"),
        (0.5, "NEW +000000.500"),
    ):  # fmt: skip
        alone = Alone(1120, family=families.GENERIC)
        assert alone.asks(0) and not alone.answer(0, number, width=pkw.DOUBLE)
        assert alone.press(10, "EDIT") == row, alone.row()


# --- memory --------------------------------------------------------------------------------------


def test_what_the_page_wants_comes_while_one_chooses_a_module_in_a_step_that_has_time():
    panel = world_of().app.panel
    has_time, load, loaded = [], on_demand.load, []
    panel.has_time = lambda: bool(has_time)

    def fail(name):
        raise MemoryError

    try:
        for on_demand.load, count in ((loaded.append, len(PAGES[PARAMETER][2])), (fail, 1)):
            has_time.clear()
            shown = groups.List(panel, None)
            for _ in range(1000):  # the groups themselves do not wait
                shown.search()
            assert not loaded and shown.count() > 10 and shown.is_searching()
            has_time.append(True)
            for step in range(count):
                assert shown.is_searching(), step
                shown.search()
            assert not shown.is_searching()  # without memory the page says so
            assert loaded == list(PAGES[PARAMETER][2][: len(loaded)])
            loaded.clear()
    finally:
        on_demand.load = load


def test_the_page_leaves_the_memory():
    world = world_of()
    forget_modules()
    go_to(world, "PARAMETERS")
    world.run(2000)
    assert set(PAGES[PARAMETER][2]) <= set(sys.modules)  # they come while one chooses
    press(world, "PARAM", "PARAM")
    look_up(world, 700)
    assert "panel.lookup.inspection" in sys.modules and "catalogue" in sys.modules
    press(world, "EDIT", "DOWN", "SET")
    assert row_2(world) == YES_OR_NO, world.lcd()
    press(world, "PARAM", "PARAM", "PARAM")
    world.run(3000)
    left = {name for name in sys.modules if name.startswith(("panel.lookup", "catalogue"))}
    assert left == set(), left
    world.check()
