# SPDX-License-Identifier: MIT
"""The operator's manual, parameter sets: saved, compared, written back, into another drive.

What is cut off in the middle is tried in test_sets_cut_off.py.
"""

from boards.sim.drives.families import mm3
from panel.sets.writing import BUS_AND_SOURCES
from panel_bench import panel, row_1, row_2, said, settled, starts, wait_until_known
from sets_bench import (
    ROWS,
    begin,
    catalogued,
    complete_mm440,
    files,
    finish,
    has,
    home,
    made,
    make_each_value_another,
    marks,
    open_set,
    press,
    put,
    refuses_to_move,
    rows_of,
    save,
    sets,
    show,
    small,
    two,
    wait,
    walk_to,
    write,
)  # fmt: skip

OTHER_RATING = [(206, b"41700000"), (207, b"42000000"), (208, b"000001F4")]


def half_way(world, rows=ROWS):
    """A set is on its way into drive 2 when that falls silent: it is written in part."""
    put(world, *rows)
    begin(world, "A1 MADE", "INTO A2 RAM")
    wait(world, "SET=WRITE")
    world.drives[2].unplug()
    press(world, "SET")
    wait(world, "NO CONTACT")
    world.drives[2].plug()
    home(world)
    world.run(3000)
    assert marks(world) == [2]


def is_of_the_bus(number):
    return any([first <= number <= last for first, last in BUS_AND_SOURCES])


def too_big():
    data = bytearray(made([])[:-15])
    for number in range(8000):
        data += b"P%04d 0 U16 0000\n" % number
    return bytes(data)


def runs(world, address=2):
    show(world, address)
    wait_until_known(world)
    press(world, "START")
    world.run(4000)
    return world.drives[address].state == "running"


# --- by keys ------------------------------------------------------------------------------------


def test_a_set_of_one_drive_is_saved_and_written_into_another():
    world = two()
    one, other = world.drives[1], world.drives[2]
    one.write(1120, 0, 2.5)
    one.write(1080, 1, 5.0)
    one.write(731, 0, 52 << 16 | 7)
    one.write(918, 0, 7)
    one.write(304, 0, 400)
    one.write(2014, 0, 3000)
    kept, level = other.read(2014), other.read(3)
    name = save(world)
    assert name == "1.set"
    rows = rows_of(world.flash.files[name])
    assert rows[1120, 0] == "40200000" and rows[731, 0] == "00340007", rows
    begin(world, "A1 SET 1", "INTO A2 RAM")
    wait(world, "SET=WRITE A2")
    assert marks(world) == []
    assert finish(world) == "WRITTEN, EQUAL", world.lcd()
    assert (other.read(1120), other.read(1080, 1), other.read(731)) == (2.5, 5.0, 52 << 16 | 7)
    assert other.read(304) == 400  # which needs commissioning
    assert (other.read(10), other.read(3)) == (0, level)
    assert (other.read(918), other.read(2014), other.read(2011)) == (3, kept, 2)
    home(world)
    world.run(2000)
    assert marks(world) == []
    assert runs(world)
    world.check()


def test_a_set_has_all_parameters_of_an_mm440_and_all_their_indices():
    family = complete_mm440()
    world = two(kinds={1: {"family": family}, 2: {"family": family}})
    one, other = world.drives[1], world.drives[2]
    make_each_value_another(one)
    name = save(world)
    rows = rows_of(world.flash.files[name])
    wanted = catalogued()
    assert len(wanted) == 1100 and sorted(rows) == sorted(wanted)
    assert all([has(one, row, rows[row]) for row in rows])
    assert write(world, "A1 SET 1", where="EEPROM") == "WRITTEN, EQUAL", world.lcd()
    kept = [row for row in rows if not has(other, row, rows[row])]
    assert (2011, 0) in kept and all([is_of_the_bus(number) for number, _ in kept]), kept
    world.check()


def test_how_saving_has_ended_is_told_until_set_goes_back_to_the_sets():
    world = two()
    sets(world)
    walk_to(world, "SAVE A1")
    press(world, "SET", "SET")
    told = wait(world, "SAVED")
    press(world, "NEXT", "DOWN")
    assert settled(world)[1].rstrip() == told, world.lcd()
    press(world, "SET")
    assert settled(world)[1].startswith(">SAVE A1"), world.lcd()
    world.check()


def test_a_name_is_given_letter_by_letter():
    world = two()
    sets(world)
    press(world, "SET")
    assert world.lcd() == ("NAME, SET=SAVE  ", ">[S]ET 1        "), world.lcd()
    press(world, "DOWN", "DOWN", "DOWN", "NEXT", "UP", "PREVIOUS", "PREVIOUS")
    assert row_2(world) == ">PFT 1    [ ]", world.lcd()
    press(world, "SET")
    world.run(4000)
    assert row_1(world).startswith("A1 SAVE ") and row_1(world).rstrip().endswith("%")
    assert row_2(world).endswith("LEFT"), world.lcd()
    assert wait(world, "SAVED") == ">SAVED: 422", world.lcd()
    press(world, "SET", "SET")  # back, and to the list
    home(world)
    sets(world)
    walk_to(world, "A1 PFT 1")
    press(world, "SET")
    assert world.lcd() == ("PFT 1        1/4", ">COMPARE A1     "), world.lcd()
    world.check()


def test_a_set_goes_back_to_its_drive_with_what_cuts_the_panel_off_last():
    world = two()
    drive = world.drives[2]
    save(world, 2)
    before = {key: list(values) for key, values in drive.parameters.ram.items()}
    drive.write(1120, 0, 1.0)
    drive.write(1000, 0, 2)
    drive.write(2014, 0, 0)
    drive.write(2000, 0, 60.0)
    begin(world, "A2 SET 1", "INTO A2 RAM")
    wait(world, "SET=WRITE A2")
    press(world, "SET")
    wait(world, "SET=DO")
    assert row_1(world).startswith("4 MAY CUT"), world.lcd()  # P1000 has set P1070
    assert drive.read(1120) == 10.0 and drive.read(1000) == 2 and marks(world) == [2]
    assert {"THE BUS OFF, OR", "CHANGE THE Hz:"} <= {row[1:] for row in said(world, 9000)}
    press(world, "DOWN")
    assert settled(world)[1].rstrip() == ">2>5", world.lcd()
    press(world, "UP", "SET")
    assert finish(world) == "WRITTEN, EQUAL", world.lcd()
    assert drive.parameters.ram == before
    assert runs(world) if home(world) is None else False
    world.check()


def test_what_cuts_the_panel_off_may_be_left_as_it_is():
    world = two()
    drive = world.drives[2]
    save(world, 2)
    drive.write(1120, 0, 1.0)
    drive.write(2014, 0, 0)
    begin(world, "A2 SET 1", "INTO A2 RAM")
    wait(world, "SET=WRITE A2")
    press(world, "SET")
    wait(world, "SET=DO")
    press(world, "PARAM")
    assert finish(world) == "WRITTEN, EQUAL", world.lcd()
    assert (drive.read(1120), drive.read(2014)) == (10.0, 0)
    home(world)
    world.run(3000)
    assert marks(world) == []


def test_ram_or_eeprom_is_what_was_chosen():
    for where, kept in (("RAM", 10.0), ("EEPROM", 2.5)):
        world = two()
        put(world)
        assert write(world, "A1 MADE", where=where) == "WRITTEN, EQUAL"
        world.drives[2].power_off()
        world.run(200)
        world.drives[2].power_on()
        assert world.drives[2].read(1120) == kept, where


def test_compare_shows_what_differs_and_writes_nothing():
    world = two()
    put(world, *ROWS + [(1082, 0, b"Float", b"42480000")])
    begin(world, "A1 MADE", "COMPARE A2")
    assert wait(world, "DIFFER") == ">DIFFER: 2", world.lcd()
    seen = []
    for _ in range(2):
        press(world, "DOWN")
        seen.append((row_1(world)[:11].rstrip(), row_2(world)))
    assert seen == [("P1080[1]", ">0>5"), ("P1120[0]", ">10>2.5")], seen
    assert world.drives[2].read(1120) == 10.0 and marks(world) == []
    press(world, "PARAM")
    walk_to(world, "COMPARE A2")
    world.drives[2].write(1080, 1, 5.0)
    world.drives[2].write(1120, 0, 2.5)
    press(world, "SET")
    assert finish(world) == "ALL EQUAL", world.lcd()


def test_a_comparison_tells_how_far_it_is():
    world = two()
    numbers, indices = range(1001, 1016), range(3)  # fixed frequencies
    rows = [(number, index, b"Float", b"0" * 8) for number in numbers for index in indices]
    put(world, *rows)
    begin(world, "A1 MADE", "COMPARE A2")
    told = []
    for _ in range(1000):
        row = row_1(world)
        if row.startswith("A2 COMPARE ") and "%" in row:
            told.append(int(row[len("A2 COMPARE ") :].split("%")[0]))
        elif told:
            break
        world.run(50)
    assert told == sorted(told) and told[0] < 20 and 80 < told[-1] <= 100, told


def test_nothing_is_written_without_a_yes():
    world = two()
    put(world)
    begin(world, "A1 MADE", "INTO A2 RAM")
    wait(world, "SET=WRITE A2")
    press(world, "PARAM")
    assert settled(world)[1].rstrip() == "NOTHING WRITTEN", world.lcd()
    home(world)
    world.run(1000)
    assert world.drives[2].read(1120) == 10.0 and marks(world) == []


def test_a_low_access_level_is_opened_after_a_question_and_closed_again():
    world = two()
    put(world)
    world.drives[2].write(3, 0, 1)
    begin(world, "A1 MADE", "INTO A2 RAM")
    wait(world, "SET=WRITE A2")
    assert ">P0003=3 FOR IT" in said(world, 6000)
    assert finish(world) == "WRITTEN, EQUAL", world.lcd()
    assert world.drives[2].read(1120) == 2.5 and world.drives[2].read(3) == 1


def test_a_set_is_deleted_after_a_question():
    world = two()
    put(world)
    for answer, left in (("PARAM", ["1.set"]), ("SET", [])):
        open_set(world, "A1 MADE")
        walk_to(world, "DELETE IT")
        press(world, "SET")
        assert world.lcd() == ("DELETE IT?      ", ">SET=DO PARAM=NO"), world.lcd()
        press(world, answer)
        world.run(500)
        assert files(world) == left
        home(world)


# --- rule 13 ------------------------------------------------------------------------------------


def test_another_drive_keeps_bus_and_sources_and_with_another_rating_its_motor():
    kept = [
        (304, 0, b"U16", b"0190"), (700, 0, b"U16", b"0002"), (840, 0, b"BICO", b"02D20000"),
        (918, 0, b"U16", b"0009"), (1000, 0, b"U16", b"0002"), (1070, 0, b"BICO", b"02F30000"),
        (2009, 0, b"U16", b"0001"), (2010, 0, b"U16", b"0009"), (2011, 0, b"U16", b"0009"),
        (2013, 0, b"U16", b"007F"), (2014, 0, b"U16", b"0000"), (2019, 1, b"BICO", b"001B0000"),
    ]  # fmt: skip
    world = two()
    before = {row[:2]: world.drives[2].read(*row[:2]) for row in kept}
    rows = sorted(kept + ROWS)
    put(world, *rows, ratings=OTHER_RATING)
    assert write(world, "A1 MADE") == "WRITTEN, EQUAL", world.lcd()
    assert world.drives[2].read(1120) == 2.5
    assert {row[:2]: world.drives[2].read(*row[:2]) for row in kept} == before
    # With its own rating it takes the motor's data, too.
    home(world)
    save(world, 2)
    own = world.flash.files["2.set"].split(b"\n")
    rating = [line.split()[1:] for line in own if line.startswith(b"rating")]
    ratings = [(int(number), value) for number, value in rating]
    assert ratings, own[:9]
    put(world, *rows, ratings=ratings)
    assert write(world, "A1 MADE") == "WRITTEN, EQUAL", world.lcd()
    assert world.drives[2].read(304) == 400 and world.drives[2].read(1000) == 5


def test_another_drive_takes_what_a_setpoint_means_after_a_question():
    """P2000 asks first, as what cuts the panel off does; but it goes with the setpoints."""
    world = two()
    put(world, (2000, 0, b"Float", b"42700000"), *ROWS)
    begin(world, "A1 MADE", "INTO A2 RAM")
    wait(world, "SET=WRITE A2")
    press(world, "SET")
    wait(world, "SET=DO")
    assert row_1(world).startswith("1 MAY CUT") and world.drives[2].read(2000) == 50.0
    press(world, "SET")
    assert finish(world) == "WRITTEN, EQUAL", world.lcd()
    assert world.drives[2].read(2000) == 60.0 and world.drives[2].read(1120) == 2.5


def test_a_set_of_another_family_is_refused():
    world = two()
    put(world, family=b"mm420")
    for what in ("COMPARE A2", "INTO A2 EEPROM"):
        begin(world, "A1 MADE", what)
        assert finish(world) == "IT IS OF MM420", world.lcd()
        home(world)
    assert world.drives[2].read(1120) == 10.0 and marks(world) == []


def test_a_family_without_eeprom_tasks_and_with_three_words():
    kinds = {1: {"family": mm3}}
    world = panel(kinds=kinds, settings={"kinds": {"1": "mm3"}})
    wait_until_known(world)
    save(world)
    world.drives[1].write(2, 0, 330)
    begin(world, "A1 SET 1", "INTO A1", 1)
    assert finish(world) == "WRITTEN, EQUAL", world.lcd()
    assert world.drives[1].read(2) == 100
    world.check()


# --- a set that is written in part --------------------------------------------------------------


def test_a_drive_with_half_a_set_does_not_start_not_even_after_a_restart():
    world = two()
    half_way(world)
    refuses_to_move(world)
    world.reset()
    world.run(3000)
    refuses_to_move(world)
    world.cut_power()
    world.run(3000)
    refuses_to_move(world)
    assert runs(world, 1)  # the others do
    world.check()


def test_it_starts_again_when_the_set_is_complete():
    world = two()
    half_way(world)
    row = write(world, "A1 MADE")
    assert row == "WRITTEN, EQUAL", row
    home(world)
    world.run(3000)
    assert marks(world) == [] and runs(world)


def test_it_starts_again_when_a_set_was_compared_with_it_and_is_equal():
    world = two()
    half_way(world)
    begin(world, "A1 MADE", "COMPARE A2")
    row = finish(world)
    assert row.startswith("DIFFER"), row
    home(world)
    refuses_to_move(world)
    world.drives[2].write(1080, 1, 5.0)
    world.drives[2].write(1120, 0, 2.5)
    begin(world, "A1 MADE", "COMPARE A2")
    assert finish(world) == "ALL EQUAL"
    home(world)
    world.run(3000)
    assert marks(world) == [] and runs(world)


def test_another_set_that_is_equal_says_nothing_of_the_one_that_is_half_written():
    world = two()
    half_way(world)
    put(world, (1080, 1, b"Float", b"00000000"), name="2.set", name_inside=b"OTHER")
    world.drives[2].write(1080, 1, 0.0)
    begin(world, "A1 OTHER", "COMPARE A2")
    assert finish(world) == "ALL EQUAL"
    home(world)
    assert marks(world) == [2]
    refuses_to_move(world)
    world.reset()
    world.run(3000)
    begin(world, "A1 OTHER", "INTO A2 RAM")
    assert finish(world) == "ALL EQUAL"
    home(world)
    refuses_to_move(world)
    row = write(world, "A1 MADE")  # the panel knows after a restart, too, which one it was
    assert row == "WRITTEN, EQUAL", row
    home(world)
    world.run(3000)
    assert marks(world) == [] and runs(world)


def test_it_starts_again_when_it_is_given_up_by_a_question():
    world = two()
    half_way(world)
    for answer in ("PARAM", "SET"):
        show(world, 2)
        sets(world)
        walk_to(world, "GIVE UP A2")
        press(world, "SET")
        assert row_2(world) == ">SET=DO PARAM=NO"
        press(world, answer)
        home(world)
        if answer == "PARAM":
            refuses_to_move(world)
    world.run(3000)
    assert marks(world) == [] and runs(world)


def test_what_a_drive_refuses_leaves_the_set_half_written():
    world = two()
    put(world, *ROWS + [(1082, 0, b"Float", b"7F800000")])
    row = write(world, "A1 MADE")
    assert row == "HALF, DIFFER 1", world.lcd()
    press(world, "DOWN")
    assert row_1(world).startswith("P1082[0]") and row_2(world) == ">50>inf", world.lcd()
    home(world)
    refuses_to_move(world)


def test_leaving_the_page_in_the_middle_leaves_it_half_written():
    world = two()
    save(world, 1)
    world.drives[1].write(1120, 0, 2.5)
    begin(world, "A1 SET 1", "INTO A2 EEPROM")
    world.drives[2].write(1120, 0, 1.0)
    wait(world, "SET=WRITE A2")
    press(world, "SET")
    world.run(1500)
    press(world, "PARAM")
    assert settled(world)[1].rstrip() == "A2: HALF A SET", world.lcd()
    world.run(3000)
    home(world)
    refuses_to_move(world)


def test_stop_acts_while_a_set_is_written_and_nothing_starts():
    world = two()
    assert runs(world, 1)
    show(world, 2)
    sets(world)
    press(world, "SET")
    assert settled(world)[1].rstrip() == "STOP ALL FIRST", world.lcd()
    world.run(3000)
    home(world)
    show(world, 1)
    press(world, "STOP")
    world.run(4000)
    put(world)
    begin(world, "A1 MADE", "INTO A2 RAM")
    for key in ("START", "REVERSE", "JOG_RIGHT"):
        press(world, key)
    stops = world.app.panel.selected.drive.stops
    press(world, "STOP")
    assert world.app.panel.selected.drive.stops == stops + 1
    assert finish(world) == "WRITTEN, EQUAL"
    assert starts(world, 2) == 0


def test_no_set_goes_into_a_drive_that_runs():
    world = two()
    put(world)
    begin(world, "A1 MADE", "INTO A2 RAM")
    wait(world, "SET=WRITE A2")
    world.app.panel.selected.start()  # no key can do that here
    world.run(4000)
    assert wait(world, "STOP ALL FIRST")
    assert world.drives[2].read(1120) == 10.0 and marks(world) == []


def test_a_mark_follows_the_drive_to_another_address():
    world = two()
    half_way(world)
    world.app.settings.readdress(2, 9)
    world.run(1000)
    assert marks(world) == [9]


# --- trouble ------------------------------------------------------------------------------------


def test_a_full_flash_is_said_and_leaves_the_other_sets():
    world = small()
    save(world)
    whole = world.flash.files["1.set"]
    world.flash.blocks_max = 2 + sum(-(-len(one) // 64) for one in world.flash.files.values())
    sets(world)
    press(world, "SET", "SET")
    wait(world, "FLASH IS FULL")
    home(world)
    assert files(world) == ["1.set"] and world.flash.files["1.set"] == whole


def test_a_bad_file_is_told_by_what_is_wrong_and_changes_nothing():
    good = made(ROWS)
    lines = good.split(b"\n")
    bad = (
        (b"", "INCOMPLETE"),
        (b"hello\n", "IS NO SET"),
        (bytes(range(256)) * 20, "IS NO SET"),
        (good[: len(good) // 3], "INCOMPLETE"),
        (b"\n".join(lines[:-2]) + b"\n", "INCOMPLETE"),  # the last line has not come
        (good[:-4], "DAMAGED"),  # nor the end of it
        (good.replace(b"40A0", b"40A1"), "DAMAGED"),
        (good.replace(b"P1120 0", b"P1120 x"), "DAMAGED"),
        (b"\n".join(lines[:6] + lines[7:]), "DAMAGED"),  # a row is missing
        (good + good, "DAMAGED"),
        (made(list(reversed(ROWS))), "DAMAGED"),
        (made(ROWS + ROWS[1:]), "DAMAGED"),
        (made(ROWS, address=77), "DAMAGED"),
        (too_big(), "TOO BIG"),
    )
    world = two()
    for data, _ in bad:
        world.flash.files["1.set"] = data
        sets(world)
        press(world, "DOWN")
        world.run(500)
        assert row_2(world) in (">? 1.set", ">A1 MADE"), world.lcd()
        home(world)
    for data, text in bad:
        world.flash.files["1.set"] = data
        show(world, 2)
        sets(world)
        press(world, "DOWN", "SET")
        walk_to(world, "INTO A2 RAM")
        press(world, "SET")
        assert finish(world) == text, (data[:80], world.lcd())
        home(world)
        assert marks(world) == [] and world.drives[2].read(1120) == 10.0
    world.check()


def test_a_file_with_the_line_ends_of_windows_counts():
    world = two()
    put(world)
    world.flash.files["pump.set"] = made(ROWS).replace(b"\n", b"\r\n")
    assert write(world, "A1 MADE") == "WRITTEN, EQUAL"
