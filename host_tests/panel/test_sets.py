# SPDX-License-Identifier: MIT
"""The operator's manual, parameter sets: saved, compared, written back, into another drive.

What is cut off in the middle is tried in test_sets_cut_off.py.
"""

import sys

import catalogue
import on_demand
from boards.sim.drives import parameters
from boards.sim.drives.families import g110, mm3
from boards.sim.drives.parameters import rows_like
from lookup_bench import world_of
from panel import texts
from panel.keys import NAMES, Acts, Keys
from panel.menu import BACK
from panel.menu.sets import words
from panel.menu.sets.write import value
from panel.sets.writing import (
    ASKS,
    ASKS_CUT,
    BUS_AND_SOURCES,
    CHECKS,
    COMPARES,
    VERIFIES,
    WRITES,
    Write,
)
from panel_bench import LOOP_US, panel, row_1, row_2, said, settled, starts, wait_until_known
from sets_bench import (
    BAUD,
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
from uss import pkw
from uss.families import MM3, MM440

OTHER_RATING = [(206, b"41700000"), (207, b"42000000"), (208, b"000001F4")]


def half_way(world, rows=ROWS):
    """A set is on its way into drive 2 when that falls silent: it is written in part."""
    put(world, *rows)
    begin(world, "A1 MADE", "INTO A2 RAM")
    wait(world, "SET=WRITE")
    world.drives[2].unplug()
    press(world, "SET")
    wait(world, "NO CONTACT", ms=3000)  # as soon as the bus has lost it
    world.drives[2].plug()
    home(world)
    world.run(3000)
    assert marks(world) == [2]


def like(family, *rows):
    """A family for the simulation that has some rows of its own."""

    class Own:
        pass

    for name in dir(family):
        if name[:2] != "__":
            setattr(Own, name, getattr(family, name))
    Own.ROWS = rows_like(family.ROWS, rows)
    return Own


def one_g110(family=g110):
    """A panel with a SINAMICS G110, which has a fifth of the values of an MM440."""
    world = panel(baud=BAUD, kinds={1: {"family": family}}, settings={"kinds": {"1": "g110"}})
    wait_until_known(world)
    return world


def slow_line():
    """A panel with a MICROMASTER 3 at 1200 baud, where an exchange takes a third of a second."""
    world = panel(
        baud=1200, kinds={1: {"family": mm3}}, settings={"kinds": {"1": "mm3"}}, loop_us=LOOP_US
    )
    wait_until_known(world)
    return world


def answers_late(drive, times, *numbers):
    """So often a question about each of these gets the answer to the one before, until nobody
    waits any more.
    """
    accept, tries, last = drive.channel.accept, {}, [None]

    def accept_late(words, layout):
        number = words[0] & 0x7FF
        if words[0] != last[0]:
            last[0] = words[0]
            tries[number] = tries.get(number, 0) + 1
        is_late = number in numbers and tries[number] <= times
        drive.stale_replies = 10_000 if is_late else 0
        accept(words, layout)

    drive.channel.accept = accept_late


def tasks_of(drive):
    """A list: the drive notes there each task that comes, as (task, number)."""
    accept, heard = drive.channel.accept, []

    def accept_and_note(words, layout):
        came = words[0] >> 12, words[0] & 0x7FF
        if came[0] and [came] != heard[-1:]:
            heard.append(came)
        accept(words, layout)

    drive.channel.accept = accept_and_note
    return heard


def is_of_the_bus(number):
    return any([first <= number <= last for first, last in BUS_AND_SOURCES])


def too_big():
    data = bytearray(made([])[:-15])
    for number in range(8000):
        data += b"P%04d 0 U16 0000\n" % number
    return bytes(data)


def own_rating(drive):
    """Ratings of a file that are those of this drive."""
    kinds = [(number, drive.parameters.rows[number]) for number in (206, 207, 208)]
    words_of = [
        parameters.words_of(row[parameters.TYPE], drive.read(number)) for number, row in kinds
    ]
    return [(row[0], b"%04X%04X" % tuple(told)) for (_, row), told in zip(kinds, words_of)]


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


def test_saving_tells_how_far_it_is_and_how_long_it_still_takes():
    world = slow_line()
    sets(world)
    press(world, "SET", "SET")
    told = []
    while not row_2(world).startswith(">SAVED"):
        world.run(500)
        percent, left = row_1(world).split()[2], row_2(world)
        if left.endswith(" LEFT"):
            minutes, seconds = left[1:-5].split(":")
            assert len(seconds) == 2, left
            told.append((world.clock.now_us, int(percent[:-1]), int(minutes) * 60 + int(seconds)))
    assert told[0][1] < 5 and told[0][2] > 60, told[0]
    began_us, ended_us = told[0][0], world.clock.now_us
    for at_us, percent, left_s in told:
        assert abs(percent - 100 * (at_us - began_us) / (ended_us - began_us)) < 5
        assert percent < 50 or abs(left_s - (ended_us - at_us) / 1e6) < 2, (percent, left_s)
    for (_, _, left_s), (_, _, later_s) in zip(told, told[1:]):
        assert later_s - left_s < 5, (left_s, later_s)  # it does not grow


def test_what_a_drive_does_not_tell_at_once_is_asked_again():
    world = one_g110()
    answers_late(world.drives[1], 3, 206, 1120)
    text = world.flash.files[save(world)]
    assert b"rating 206 " in text and rows_of(text)[1120, 0] == "41200000", text
    world.check()


def test_what_a_drive_does_not_tell_at_all_is_left_out_and_counted():
    world = one_g110()
    answers_late(world.drives[1], 4, 1120, 1121)
    sets(world)
    press(world, "SET", "SET")
    assert wait(world, "SAVED", "BUT") == ">BUT 2 UNTOLD", world.lcd()
    rows = rows_of(world.flash.files["1.set"])
    assert (1120, 0) not in rows and (1121, 0) not in rows and (1082, 0) in rows
    world.check()


def test_a_value_is_as_wide_as_the_drive_has_it():
    """Another version of a drive may have another type than the catalogue knows."""
    family = like(
        g110,
        (1120, "a word", "U16", "", 1, 0, 650, 10, "CUT", 1, ""),
        (1800, "a double word", "U32", "", 1, 0, 99999, 70000, "CUT", 1, ""),
    )
    world = one_g110(family)
    lines = world.flash.files[save(world)].split(b"\n")
    assert b"P1120 0 U16 000A" in lines and b"P1800 0 U32 00011170" in lines, lines
    assert b"P1121 0 Float 41200000" in lines
    world.check()


def test_no_set_is_saved_where_the_drive_hides_some_of_it():
    world = one_g110()
    world.drives[1].switches.level_for_reading = True
    world.drives[1].write(3, 0, 1)
    sets(world)
    press(world, "SET", "SET")
    assert wait(world, "SAVED", "BUT", "P0003") == ">P0003 TOO LOW", world.lcd()
    home(world)
    assert files(world) == []
    family = like(mm3, (5, "a double word", "U32", "", 1, 0, 99999, 0, "CUT", 0, ""))
    world = panel(kinds={1: {"family": family}}, settings={"kinds": {"1": "mm3"}})
    wait_until_known(world)
    sets(world)
    press(world, "SET", "SET")
    assert wait(world, "SAVED", "BUT", "REPLY") == ">REPLY TOO LONG", world.lcd()
    home(world)
    assert files(world) == []


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
    assert settled(world) == ("NAME, SET=SAVE  ", ">[S]ET 1        "), world.lcd()
    press(world, "DOWN", "DOWN", "DOWN", "NEXT", "UP")
    assert row_2(world) == ">P[F]T 1", world.lcd()
    press(world, "PREVIOUS", "PREVIOUS")
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


def test_a_name_needs_a_letter():
    world = small()
    sets(world)
    press(world, "SET")
    for key, times in (("DOWN", 19), ("DOWN", 5), ("UP", 18), ("UP", 0), ("UP", 10)):
        for _ in range(times):  # to the blank in front of the A
            world.press(key, 60)
            world.run(60)
        press(world, "NEXT")
    assert row_2(world) == ">     [ ]", world.lcd()
    press(world, "SET")
    assert settled(world) == ("NAME, SET=SAVE  ", "NAME, SET=SAVE  "), world.lcd()
    world.run(3000)
    press(world, "UP", "SET")
    wait(world, "SAVED")
    assert b"\nname      A\n" in world.flash.files["1.set"]


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
    assert row_1(world) == "4 MAY CUT    1/5", world.lcd()  # P1000 has set P1070
    assert drive.read(1120) == 10.0 and drive.read(1000) == 2 and marks(world) == [2]
    assert {"THE BUS OFF, OR", "CHANGE THE Hz:"} <= {row[1:] for row in said(world, 9000)}
    press(world, "DOWN")
    assert settled(world)[1].rstrip() == ">2>5", world.lcd()
    press(world, "UP")
    world.press("SET")
    assert settled(world)[0].startswith("A2 WRITE"), world.lcd()
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
    """An EEPROM wears: each value that differs is written once."""
    for where, kept, worn in (("RAM", 10.0, 0), ("EEPROM", 2.5, len(ROWS))):
        world = two()
        put(world)
        writes = world.drives[2].eeprom_writes
        assert write(world, "A1 MADE", where=where) == "WRITTEN, EQUAL"
        assert world.drives[2].eeprom_writes - writes == worn, where
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


def test_a_value_reads_as_people_write_it():
    for kind, high, low, text in (
        (b"U16", 0, 0xFFFF, b"65535"),
        (b"I16", 0, 0x7FFF, b"32767"),
        (b"I16", 0, 0x8000, b"-32768"),
        (b"I16", 0, 0xFFFF, b"-1"),
        (b"U32", 0xFFFF, 0xFFFE, b"4294967294"),
        (b"U32", 1, 0x8000, b"98304"),
        (b"I32", 0x7FFF, 0xFFFF, b"2147483647"),
        (b"I32", 0x8000, 0, b"-2147483648"),
        (b"I32", 0xFFFF, 0xFFFE, b"-2"),
        (b"I32", 0, 0x9000, b"36864"),
        (b"Float", 0xC020, 0, b"-2.5"),
        (b"BICO", 52, 3, b"52:3"),
        (b"BI", 722, 0, b"722:0"),
    ):
        assert value(kind, high, low) == text, (kind, high, low)
    world = two()
    put(world, (731, 0, b"BICO", b"00340007"), (731, 1, b"BICO", b"FFFFFFFF"))
    begin(world, "A1 MADE", "COMPARE A2")
    assert wait(world, "DIFFER") == ">DIFFER: 2", world.lcd()
    press(world, "DOWN")
    assert row_1(world).startswith("P0731[0]") and row_2(world) == ">52:3>52:7", world.lcd()
    press(world, "DOWN")  # as much as there is room for
    assert row_1(world).startswith("P0731[1]") and row_2(world) == ">52:3>65535:6553"


def test_what_the_drive_lacks_or_does_not_answer_to_differs():
    for is_silent in (False, True):
        world = two()
        world.drives[2].switches.silent_refusals = is_silent
        put(world, (1199, 0, b"U16", b"0005"), *ROWS)
        begin(world, "A1 MADE", "COMPARE A2")
        assert wait(world, "DIFFER") == ">DIFFER: 3", world.lcd()
        press(world, "UP")
        assert row_1(world).startswith("P1199[0]") and row_2(world) == ">--->5", world.lcd()


def test_a_comparison_that_cannot_be_made_says_why():
    for times, outcome in ((3, "DIFFER: 2"), (4, "NO ANSWER")):
        world = two()
        put(world)
        answers_late(world.drives[2], times, 1120)
        begin(world, "A1 MADE", "COMPARE A2")
        assert finish(world) == outcome, (times, world.lcd())
    world = two()
    put(world, (1130, 0, b"Float", b"40000000"))  # needs level 2
    world.drives[2].write(3, 0, 1)
    world.drives[2].switches.level_for_reading = True
    begin(world, "A1 MADE", "COMPARE A2")
    assert finish(world) == "P0003 TOO LOW", world.lcd()


def test_a_comparison_tells_how_far_it_is():
    """What is left out because it is another drive's own counts as done."""
    numbers, indices = range(1001, 1016), range(3)  # fixed frequencies
    rows = [(number, index, b"Float", b"0" * 8) for number in numbers for index in indices]
    for left_out, first in ((0, 0), (60, 57)):
        world = two()
        put(world, *rows + [(800 + place, 0, b"BICO", b"0" * 8) for place in range(left_out)])
        begin(world, "A1 MADE", "COMPARE A2")
        told = []
        for _ in range(1000):
            row = row_1(world)
            if row.startswith("A2 COMPARE ") and "%" in row:
                told.append(int(row[len("A2 COMPARE ") :].split("%")[0]))
            elif told:
                break
            world.run(50)
        assert told == sorted(told), told
        assert first <= told[0] < first + 20 and 80 < told[-1] <= 100, told


class Pretended:
    """A work on a set that is as far as a test says."""

    def __init__(self, *_):
        self.asks, self.outcome, self.phase = False, None, COMPARES
        self.left_s, self.differs, self.listed = None, 0, ()

    def percent(self):
        return 41


def test_what_still_takes_minutes_is_told_in_minutes_and_seconds_and_with_what_differs():
    front = small().app.panel
    for name, where in (("Write", "panel.sets.writing"), ("Save", "panel.sets.saving")):
        module = on_demand.load(where)
        made = []

        def begun(*what):
            made.append(Pretended(*what))
            return made[0]

        usual = getattr(module, name)
        setattr(module, name, begun)
        try:
            if name == "Write":
                of_write = on_demand.load("panel.menu.sets.write")
                listed = of_write.List(front, (front.selected, "1.set", None))
            else:
                listed = on_demand.load("panel.menu.sets.save").List(front, front.selected)
                assert not listed.is_busy() and not listed.is_searching()
                listed.choose(0, 0)
        finally:
            setattr(module, name, usual)
        work = made[0]
        assert listed.is_busy() and listed.is_searching() and listed.words(0) == b"...", name
        for work.left_s, work.differs, told in (
            (0, 0, b"0:00 LEFT"), (59, 0, b"0:59 LEFT"), (60, 0, b"1:00 LEFT"),
            (119, 0, b"1:59 LEFT"), (125, 0, b"2:05 LEFT"), (3600, 0, b"60:00 LEFT"),
        ):  # fmt: skip
            assert listed.words(0) == told, (name, work.left_s, listed.words(0))
        if name == "Save":
            assert listed.heading(0) == b"A1 SAVE 41%"
            work.outcome = (b"SAVED: %d", 7)
            assert listed.words(0) == b"SAVED: 7" and not listed.is_busy()
            continue
        work.left_s, work.differs = 81, 3
        assert listed.words(0) == b"1:21 3 DIFF"
        for work.phase, told in (
            (CHECKS, b"A1 CHECK"), (COMPARES, b"A1 COMPARE 41%"),
            (WRITES, b"A1 WRITE 41%"), (VERIFIES, b"A1 COMPARE 41%"),
        ):  # fmt: skip
            assert listed.heading(0) == told and listed.count() == 1, listed.heading(0)
        work.outcome = (b"ALL EQUAL",)
        assert listed.heading(0) == b"A1" and listed.words(0) == b"ALL EQUAL"
        assert not listed.is_busy()


def test_a_question_that_nobody_answers_for_a_minute_writes_nothing():
    """While it compares the menu stays open, however long that takes; while it asks it closes."""
    world = two()
    put(world)
    begin(world, "A1 MADE", "INTO A2 RAM")
    wait(world, "SET=WRITE A2")
    world.run(55_000)
    assert row_2(world) == ">SET=WRITE A2", world.lcd()
    world.run(7_000)
    assert row_2(world) == "READY        A2", world.lcd()
    assert world.drives[2].read(1120) == 10.0 and marks(world) == []


def test_writing_tells_how_far_it_is_to_the_end_of_the_comparison_behind_it():
    world = slow_line()
    put(world, (2, 0, b"U16", b"0064"), (3, 0, b"U16", b"0065"), family=b"mm3")
    for number in (2, 3):
        world.drives[1].write(number, 0, 330)
    begin(world, "A1 MADE", "INTO A1", 1)
    wait(world, "SET=WRITE A1")
    world.press("SET")
    told = []
    for _ in range(400):
        heading, row = [text.rstrip() for text in settled(world)]
        if row == ">WRITTEN, EQUAL":
            break
        if heading not in told[-1:]:
            told.append(heading)
        world.run(50)
    assert told[-4:] == ["A1 WRITE 0%", "A1 WRITE 25%", "A1 COMPARE 50%", "A1 COMPARE 75%"], told


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
    put(world, (1130, 0, b"Float", b"40000000"), *ROWS)  # which needs level 2
    world.drives[2].write(3, 0, 1)
    begin(world, "A1 MADE", "INTO A2 RAM")
    wait(world, "SET=WRITE A2")
    assert ">P0003=3 FOR IT" in said(world, 6000)
    channel, written = world.drives[2].channel, []
    accept = channel.accept

    def accept_and_note(net, layout):
        if net[0] == 0x2003 and net not in written[-1:]:
            written.append(net)
        accept(net, layout)

    channel.accept = accept_and_note
    assert finish(world) == "WRITTEN, EQUAL", world.lcd()
    assert written == [[0x2003, 0, 0, 3], [0x2003, 0, 0, 1]], written
    assert world.drives[2].read(1120) == 2.5 and world.drives[2].read(3) == 1
    assert world.drives[2].read(1130) == 2.0
    world = small()
    put(world, (13, 0, b"U16", b"0190"), family=b"mm3")
    world.drives[1].write(9, 0, 1)
    begin(world, "A1 MADE", "INTO A1", 1)
    wait(world, "SET=WRITE A1", ">P0009")
    assert ">P0009=3 FOR IT" in said(world, 6000)
    assert finish(world) == "WRITTEN, EQUAL", world.lcd()
    assert world.drives[1].read(13) == 400 and world.drives[1].read(9) == 1


def test_a_drive_that_is_not_opened_says_why_and_has_half_a_set():
    world = two()
    put(world)
    world.drives[2].write(3, 0, 1)
    world.drives[2].write(927, 0, 7)  # all but USS may change it
    world.drives[2].switches.no_rights_error = 7
    begin(world, "A1 MADE", "INTO A2 RAM")
    assert finish(world) == "NOT CHANGEABLE", world.lcd()
    assert world.drives[2].read(1120) == 10.0 and marks(world) == [2]


def test_the_access_level_of_the_set_comes_last_and_opens_again_for_a_second_round():
    """P1000 sets P1070, which was equal before: it is put right in the second round."""
    rows = (
        (3, 0, b"U16", b"0002"),
        (1000, 0, b"U16", b"0005"),
        (1070, 0, b"BICO", b"02F30000"),
        (1120, 0, b"Float", b"40200000"),
    )
    for answer, values in (("PARAM", (3, 2, 2.5)), ("SET", (2, 5, 2.5))):
        world = two()
        drive = world.drives[2]
        put(world, *rows, address=2)
        drive.write(1000, 0, 2)
        drive.write(1070, 0, 755 << 16)
        begin(world, "A2 MADE", "INTO A2 RAM")
        wait(world, "SET=WRITE A2")
        press(world, "SET")
        wait(world, "SET=DO")
        assert row_1(world).startswith("2 MAY CUT"), world.lcd()
        press(world, answer)
        assert finish(world) == "WRITTEN, EQUAL", world.lcd()
        assert (drive.read(3), drive.read(1000), drive.read(1120)) == values, answer
        assert drive.read(1070) == 755 << 16


def test_a_set_that_was_made_elsewhere_resets_nothing():
    world = two()
    drive = world.drives[2]
    drive.write(1082, 0, 40.0)
    operations = [(10, 0, b"U16", b"001E"), (970, 0, b"U16", b"0001"), (971, 0, b"U16", b"0001")]
    put(world, *operations + ROWS, address=2)
    begin(world, "A2 MADE", "INTO A2 RAM")
    wait(world, "SET=WRITE A2")
    assert row_1(world).startswith("2 DIFFER"), world.lcd()
    saved = drive.eeprom_writes
    assert finish(world) == "WRITTEN, EQUAL", world.lcd()
    world.run(3000)
    assert (drive.read(10), drive.read(1082), drive.read(1120)) == (0, 40.0, 2.5)
    assert drive.eeprom_writes == saved


def test_a_program_that_is_told_no_writes_nothing():
    """At the buttons PARAM leaves the page instead."""
    world = two()
    put(world)
    show(world, 2)
    world.run(1000)
    work = Write(world.app.panel, world.app.panel.selected, "1.set", False)
    for now_ms in range(2000):
        if work.outcome:
            break
        if work.asks:
            work.answer = False
        work.step(now_ms)
        work.search()
        world.run(5)
    assert work.outcome == (words.NOTHING_WRITTEN,) and marks(world) == []
    assert world.drives[2].read(1120) == 10.0


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
        assert settled(world)[1] == ">DELETE IT      ", world.lcd()
        press(world, "PARAM")
        world.run(500)
        assert row_1(world).rstrip().endswith("/%d" % (1 + len(left))) == bool(left), world.lcd()
        home(world)


def test_a_set_that_has_gone_already_is_deleted_all_the_same():
    world = two()
    put(world)
    open_set(world, "A1 MADE")
    walk_to(world, "DELETE IT")
    world.flash.files.pop("1.set")
    press(world, "SET", "SET", "PARAM")
    world.run(500)
    assert settled(world) == ("SETS            ", ">SAVE A2        "), world.lcd()
    world.check()


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


def compared(world, *numbers, **options):
    """Those of these parameters that are compared with the drive shown, whose values are others.

    Twenty at a time, as a comparison lists no more.
    """
    found = []
    for at in range(0, len(numbers), 20):
        rows = [(number, 0, b"U16", b"ABCD") for number in numbers[at : at + 20]]
        put(world, *rows, **options)
        work = Write(world.app.panel, world.app.panel.selected, "1.set")
        for now_ms in range(2000):
            if work.outcome:
                break
            work.step(now_ms)
            work.search()
            world.run(5)
        assert work.outcome[0] in (words.DIFFER, words.ALL_EQUAL), work.outcome
        found += [row[0] for row in work.listed]
    return tuple(found)


def test_what_is_left_out_ends_where_it_is_said_to():
    """Beside each of those numbers there are values that every drive takes."""
    world = two()
    show(world, 2)
    world.run(1000)
    own = {"ratings": own_rating(world.drives[2])}
    # Another drive keeps its bus and its sources, and with the same rating not its motor.
    others = (
        304, 699, 720, 799, 928, 999, 1001, 1054, 1057, 1069, 1077, 1109, 1114, 1139, 1143, 2008,
        2052, 2102, 2107,
    )  # fmt: skip
    kept = (
        700, 701, 718, 719, 800, 927, 1000, 1055, 1056, 1070, 1076, 1110, 1113, 1140, 1142, 2009,
        2051, 2103, 2106,
    )  # fmt: skip
    assert compared(world, *sorted(others + kept), **own) == others
    # The same drive keeps nothing of that, but no set has its operations and passwords.
    never = (10, 11, 12, 40, 340, 952, 970, 971, 1900, 1910, 1960, 2111, 3900)
    others = (
        9, 13, 39, 41, 339, 341, 951, 953, 969, 972, 1899, 1901, 1909, 1911, 1959, 1961, 2110,
        2112, 3899, 3901,
    )  # fmt: skip
    assert compared(world, *sorted(others + never), address=2, **own) == others
    # With another rating it keeps motor and rating.
    others = (99, 101, 199, 400, 600, 641, 1799, 1826, 1899, 1927)
    kept = (100, 200, 399, 601, 640, 1800, 1825, 1901, 1926)
    options = {"address": 2, "ratings": OTHER_RATING}
    assert compared(world, *sorted(others + kept), **options) == others


def test_what_is_left_out_of_a_micromaster_3_ends_where_it_is_said_to():
    family = like(
        mm3,
        (111, "rated power", "U16", "", 1, 0, 65535, 75, "CUT", 0, ""),
        (112, "type", "U16", "", 1, 0, 65535, 1, "CUT", 0, ""),
    )
    world = panel(kinds={1: {"family": family}}, settings={"kinds": {"1": "mm3"}})
    wait_until_known(world)
    own = {"family": b"mm3", "ratings": [(111, b"0000004B"), (112, b"00000001")]}
    numbers = (5, 6, 7, 8, 71, 90, 91, 95, 96)
    assert compared(world, *numbers, address=2, **own) == (5, 8, 71, 90, 96)
    numbers = (70, 71, 89, 90, 100, 101, 102, 943, 944, 945, 970, 971, 972)
    others = (70, 90, 100, 102, 943, 945, 970, 972)
    assert compared(world, *numbers, family=b"mm3") == others
    assert compared(world, 71, 101, 944, **own) == (71, 101)


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


def test_the_least_frequency_of_a_micromaster_3_is_one_of_its_values():
    """P0012 locks the list of parameters elsewhere, and is in no set there."""
    world = small()
    drive = world.drives[1]
    drive.write(12, 0, 50)
    rows = rows_of(world.flash.files[save(world)])
    assert rows[12, 0] == "0032" and (944, 0) not in rows and (971, 0) not in rows, rows
    drive.write(12, 0, 0)
    begin(world, "A1 SET 1", "INTO A1", 1)
    assert finish(world) == "WRITTEN, EQUAL", world.lcd()
    assert drive.read(12) == 50


def test_a_directory_that_cannot_be_read_is_a_flash_that_keeps_nothing():
    world = small()
    sets(world)
    names = world.flash.listdir

    def fails(*arguments):
        raise OSError(5)

    world.flash.listdir = fails
    press(world, "SET", "SET")
    wait(world, "FLASH IS FULL")
    world.flash.listdir = names
    home(world)
    assert files(world) == [] and runs(world, 1)


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


def test_what_is_written_already_is_not_written_again_in_commissioning():
    """An EEPROM wears. The motor's rating (P304) waits until all else is written."""
    world = two()
    drive = world.drives[2]
    save(world, 2)
    drive.write(304, 0, 400)
    drive.write(1120, 0, 2.5)
    heard = tasks_of(drive)
    begin(world, "A2 SET 1", "INTO A2 EEPROM")
    assert finish(world) == "WRITTEN, EQUAL", world.lcd()
    writes = [number for task, number in heard if task >= pkw.WRITE_ELEMENT_DOUBLE_EEPROM]
    assert writes == [304, 1120, 304], writes
    world.check()


def test_what_a_drive_refuses_leaves_the_set_half_written():
    world = two()
    put(world, *ROWS + [(1082, 0, b"Float", b"7F800000")])
    row = write(world, "A1 MADE")
    assert row == "HALF, DIFFER 1", world.lcd()
    press(world, "DOWN")
    assert row_1(world).startswith("P1082[0]") and row_2(world) == ">50>inf", world.lcd()
    home(world)
    refuses_to_move(world)


def test_what_wants_commissioning_is_written_in_it_whatever_else_the_drive_refuses():
    """P0304 is refused outside commissioning; P0290 and P1082 are beyond their limits."""
    world = two()
    drive = world.drives[2]
    wrong = [(290, 0, b"U16", b"0009"), (1082, 0, b"Float", b"7F800000")]
    put(world, (304, 0, b"U16", b"0190"), *ROWS + wrong, ratings=own_rating(drive))
    assert write(world, "A1 MADE") == "HALF, DIFFER 2", world.lcd()
    assert drive.read(304) == 400 and drive.read(1120) == 2.5 and drive.read(10) == 0


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
    assert row_2(world) == ">SAVE A2", world.lcd()
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


def test_nothing_is_done_with_a_set_while_any_drive_runs():
    world = two()
    put(world)
    assert runs(world, 1)
    open_set(world, "A1 MADE")
    for what in ("COMPARE A2", "INTO A2 RAM", "INTO A2 EEPROM", "DELETE IT"):
        walk_to(world, what)
        press(world, "SET")
        assert settled(world)[1] == "STOP ALL FIRST  ", (what, world.lcd())
        world.run(3000)
        assert row_2(world) == ">" + what, world.lcd()
    assert files(world) == ["1.set"]
    world.check()


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


def test_param_in_front_of_the_flash_gives_up_saving_and_the_line_goes_on():
    """On a slow line that is seen: the flash waits until an exchange is over."""
    world = slow_line()
    sets(world)
    press(world, "SET")
    world.press("SET")
    for _ in range(1000):
        if world.app.panel.errand:
            break
        world.run(5)
    world.run(50)
    press(world, "PARAM")
    assert settled(world)[1] == ">SAVE A1        ", world.lcd()
    home(world)
    world.run(1000)
    assert list(world.flash.files) == ["settings.json"]
    sent_us = [at_us for at_us, from_panel, _ in world.wire.log.last(20) if from_panel]
    gaps_us = [late - early for early, late in zip(sent_us, sent_us[1:])]
    assert len(gaps_us) > 5 and max(gaps_us) < 500_000, gaps_us
    assert runs(world, 1), world.lcd()
    world.check()


def test_saving_is_given_up_where_the_flash_has_no_turn():
    """The flash has its turn when no motor runs. No key starts one here, a terminal may."""
    world = two()
    show(world, 1)
    sets(world)
    press(world, "SET")
    world.app.panel.controls[1].start()
    world.run(4000)
    assert world.drives[2].state == "running"
    press(world, "SET")
    world.run(14_000)
    assert row_2(world) == ">...", world.lcd()
    world.run(2000)
    assert settled(world)[1] == ">NO ANSWER      ", world.lcd()
    home(world)
    world.app.panel.controls[1].stop()
    world.run(5000)
    assert list(world.flash.files) == ["settings.json"]
    world.check()


def test_no_set_is_saved_while_its_own_motor_runs():
    world = small()
    sets(world)
    press(world, "SET", "SET")
    world.run(500)
    world.app.panel.selected.start()
    assert wait(world, "SAVED", "STOP ALL") == ">STOP ALL FIRST", world.lcd()
    home(world)
    assert files(world) == []


def test_memory_that_runs_out_while_a_set_is_saved_is_said():
    def starving(family, **options):
        for row in rows(family, **options):
            if row and row[catalogue.KEY] == b"P0031":
                raise MemoryError
            yield row

    world = small()
    sets(world)
    press(world, "SET")
    rows, catalogue.rows = catalogue.rows, starving
    try:
        press(world, "SET")
        assert wait(world, "SAVED", "NO ") == ">NO MEMORY LEFT", world.lcd()
    finally:
        catalogue.rows = rows
    home(world)
    assert files(world) == []
    save(world)
    world.check()


def test_a_flash_that_tells_no_names_has_no_sets():
    def broken(folder):
        raise OSError(5)

    world = small()
    put(world)
    world.flash.listdir = broken
    sets(world)
    assert settled(world) == ("SETS            ", ">SAVE A1        "), world.lcd()
    world.check()


def test_a_set_that_has_gone_before_it_is_read_is_listed_as_none_and_hides_no_other():
    world = small()
    put(world, family=b"mm3")
    store = world.app.panel.board.store
    names = store.names
    store.names = lambda ending: ["0.set"] + names(ending)
    sets(world)
    seen = []
    for _ in range(3):
        seen.append(settled(world)[1].rstrip())
        press(world, "DOWN")
    assert seen == [">SAVE A1", ">? 0.set", ">A1 MADE"], seen
    world.check()


def test_twenty_sets_are_kept_and_the_next_one_has_the_first_number_that_is_free():
    world = small()
    for number in range(1, 21):
        if number != 3:
            put(world, name="%d.set" % number)
    assert save(world) == "3.set" and len(files(world)) == 20
    sets(world)
    press(world, "SET", "SET")
    assert settled(world)[1] == "20 SETS, DELETE ", world.lcd()
    world.run(3000)
    assert settled(world) == ("NAME, SET=SAVE  ", ">[S]ET 1        "), world.lcd()
    assert len(files(world)) == 20


def test_no_set_is_saved_of_a_drive_without_a_table_or_without_parameters():
    for kind in ("generic", "g110/0"):
        world = world_of(kind)
        sets(world)
        press(world, "SET", "SET")
        assert settled(world)[1] == "NO TABLE OF IT  ", (kind, world.lcd())
        assert files(world) == []


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
    world.flash.files = {"a-pump-or-a-fan.set": b"hello"}
    sets(world)
    press(world, "DOWN")
    world.run(500)
    assert row_2(world) == ">? a-pump-or-a-f", world.lcd()
    press(world, "SET")
    assert row_1(world) == "a-pump-or-   1/4", world.lcd()
    world.check()


def test_a_file_with_the_line_ends_of_windows_counts():
    world = two()
    put(world)
    world.flash.files["pump.set"] = made(ROWS).replace(b"\n", b"\r\n")
    assert write(world, "A1 MADE") == "WRITTEN, EQUAL"


# --- the lists by themselves ---------------------------------------------------------------------


class Told:
    """A panel, the drive that it shows, and its flash with some sets in it."""

    address = 3
    is_half = runs = is_gone = False
    page_turns = 0
    errand = None

    def __init__(self, family=MM440, sets_kept=()):
        self.drive = self.survey = self.selected = self.board = self.store = self
        self.announcer = self.settings = self
        self.family = family
        self.kept = list(sets_kept)
        self.remembered, self.did = {}, []

    def is_half_written(self):
        return self.is_half

    def any_runs(self):
        return self.runs

    def say(self, now_ms, text, *values):
        self.did.append(texts.of(text, *values))

    def note_set(self, address):
        self.did.append(address)

    def names(self, ending):
        return list(self.kept)

    def remove(self, name):
        if self.is_gone:
            raise OSError(2)
        self.kept.remove(name)


def set_list(name, panel, argument=None):
    return on_demand.load("panel.menu.sets." + name).List(panel, argument)


def rows_shown(shown):
    return [shown.words(place).decode() for place in range(shown.count())]


def test_the_list_of_sets_begins_with_what_can_be_done_and_reads_one_head_at_a_time():
    panel = Told(sets_kept=("1.set", "2.set"))
    shown = set_list("overview", panel)
    assert rows_shown(shown) == ["SAVE A3", "...", "..."]
    files_of = on_demand.load("panel.menu.sets.overview").set_file
    head, files_of.read_head = files_of.read_head, head_of
    try:
        for rows in (["A7 PUMP 1", "..."], ["A7 PUMP 1", "? 2.set"]):
            assert shown.is_searching()
            shown.search()
            assert rows_shown(shown)[1:] == rows
        assert not shown.is_searching()
        shown.step(0, 0)
        assert not shown.is_searching()  # there is nothing new
        assert shown.choose(1, 0) == ("sets.one", ("1.set", b"PUMP 1"))
        assert shown.choose(0, 0) == ("sets.save", panel)
        panel.runs = True
        assert shown.choose(0, 0) is None and panel.did == [texts.STOP_FIRST]
        assert shown.choose(2, 0) == ("sets.one", ("2.set", b"2.set"))
        panel.is_half = True
        shown.step(0, 0)
        assert rows_shown(shown) == ["GIVE UP A3", "SAVE A3", "...", "..."]
        panel.runs = False
        assert shown.choose(1, 0) == ("sets.save", panel)
        assert shown.choose(3, 0) == ("sets.one", ("2.set", b"..."))
        name, (stakes, values, does) = shown.choose(0, 0)
        assert (name, stakes, values) == ("sets.ask", words.ASK_GIVE_UP, (3,))
        does(0)
        assert panel.did[1:] == [3]
        panel.is_half = False
        panel.kept = ["2.set"]
        shown.step(0, 0)
        panel.remembered["panel.menu.sets.overview"] = "2.set"  # one was deleted
        panel.kept = []
        shown.step(0, 0)
        assert rows_shown(shown) == ["SAVE A3"]
    finally:
        files_of.read_head = head


def head_of(store, name):
    if name != "1.set":
        raise ValueError

    class Head:
        address = 7
        name = b"PUMP 1"

    return Head


def test_a_set_can_be_written_where_the_family_of_the_drive_keeps_values():
    for family, ways in (
        (MM440, (("COMPARE A3", None), ("INTO A3 RAM", False), ("INTO A3 EEPROM", True))),
        (MM3, (("COMPARE A3", None), ("INTO A3", False))),
    ):
        panel = Told(family, ("1.set",))
        shown = set_list("one", panel, ("1.set", b"0123456789AB"))
        assert shown.title == b"0123456789"
        assert rows_shown(shown) == [row for row, _ in ways] + ["DELETE IT"]
        for place, (_, eeprom) in enumerate(ways):
            assert shown.choose(place, 0) == ("sets.write", (panel, "1.set", eeprom))
        panel.runs = True
        for place in range(shown.count()):
            assert shown.choose(place, 0) is None
        assert panel.did == [texts.STOP_FIRST] * shown.count()
        panel.runs = False
        for is_gone in (False, True):
            panel.is_gone, panel.errand, panel.remembered = is_gone, None, {}
            name, (stakes, values, does) = shown.choose(len(ways), 0)
            assert (name, stakes, values) == ("sets.ask", words.ASK_DELETE, ())
            assert panel.errand is None
            does(0)
            assert is_gone or panel.kept == ["1.set"]  # in a step of its own
            panel.errand()
            assert panel.kept == [] and len(panel.remembered) == 1


def test_a_question_about_a_set_says_in_turn_what_is_at_stake_and_set_is_yes():
    panel = Told()
    shown = set_list("ask", panel, (words.ASK_GIVE_UP, (3,), panel.did.append))
    rows = []
    for panel.page_turns in range(4):
        rows.append(shown.heading(0))
    assert rows == [b"A3: SET IS HALF", b"WRITTEN. ALLOW", b"START, JOG?", b"A3: SET IS HALF"]
    assert shown.words(0) == words.YES_OR_NO
    assert shown.choose(0, 77) is BACK and panel.did == [77]


class Work:
    """What saves a set; the panel has it."""

    outcome = left_s = None

    def __init__(self, panel, control, name):
        panel.work = self
        self.name, self.did = name, []

    def percent(self):
        return 41

    def step(self, now_ms):
        self.did.append(now_ms)

    def search(self):
        self.did.append("search")

    def end(self, text):
        self.did.append(text)


class SavingModule:
    """Where that stands."""

    Save = Work
    refusal = texts.NOTHING

    @staticmethod
    def why_not(panel, control):
        return SavingModule.refusal


def with_keys(*pressed):
    acts = Acts(Keys(NAMES, 0xFFFFF))
    acts.pressed = sum([acts.bit(key) for key in pressed])
    return acts


def naming():
    panel = Told()
    return panel, set_list("save", panel, panel)


def test_a_letter_goes_round_the_alphabet_and_the_place_round_the_name():
    panel, shown = naming()
    assert shown.heading(0) == b"NAME, SET=SAVE" and shown.words(0) == b"[S]ET 1"
    for steps, letter in ((100, b"T"), (-100, b"S"), (-1, b"R")):
        assert shown.change(0, steps) and shown.words(0) == b"[%s]ET 1" % letter
    letters = []
    for _ in range(38):
        shown.change(0, 1)
        letters.append(shown.words(0)[1:2])
    assert b"".join(letters) == b"STUVWXYZ0123456789- ABCDEFGHIJKLMNOPQR"
    assert not shown.take_keys(with_keys("SET")) and shown.take_keys(with_keys("NEXT"))
    assert shown.words(0) == b"R[E]T 1"
    for key, row in (("PREVIOUS", b"[R]ET 1"), ("PREVIOUS", b"RET 1    [ ]"),
                     ("NEXT", b"[R]ET 1")):  # fmt: skip
        assert shown.take_keys(with_keys(key)) and shown.words(0) == row


def test_a_set_is_saved_under_its_name_unless_something_is_against_it():
    loaded = sys.modules.get("panel.sets.saving")
    sys.modules["panel.sets.saving"] = SavingModule
    try:
        panel, shown = naming()
        SavingModule.refusal = words.TOO_MANY
        shown.choose(0, 0)
        SavingModule.refusal = texts.NOTHING
        assert panel.did == [words.TOO_MANY] and not shown.is_busy()
        shown.step(0, 5)
        shown.leave(0)
        shown.choose(0, 0)
        work = panel.work
        assert work.name == b"SET 1" and shown.is_busy() and shown.is_searching()
        assert shown.heading(0) == b"A3 SAVE 41%" and shown.change(0, 1)
        assert shown.words(0) == b"..."
        work.left_s = 21
        assert shown.words(0) == b"0:21 LEFT"
        shown.step(0, 6)
        shown.search()
        shown.choose(0, 0)  # it is being saved already
        assert panel.work is work and work.did == [6, "search"]
        assert shown.take_keys(with_keys("SET")) is None
        shown.leave(0)
        assert work.did[2:] == [words.NOTHING_WRITTEN]
        work.outcome = words.SAVED, 422
        shown.step(0, 7)
        shown.leave(0)
        assert shown.words(0) == b"SAVED: 422" and not shown.is_busy() and len(work.did) == 3
        assert shown.take_keys(with_keys("UP")) is None
        assert shown.take_keys(with_keys("SET")) is BACK
        before = dict(panel.remembered)
        shown.end()
        assert before == {} and list(panel.remembered) == ["panel.menu.sets.overview"]
    finally:
        sys.modules.pop("panel.sets.saving", None)
        if loaded:
            sys.modules["panel.sets.saving"] = loaded


class Writing(Work):
    """What compares and writes a set, as far as its list asks for that."""

    asks = opens = answer = None
    differs, cutting = 3, 2
    listed = ((1120, 0, b"Float", 0x4020, 0, 0x4120, 0), (731, 1, b"BICO", 52, 3, None, None))
    cutters = ((2010, 0, b"U16", 0, 7, 0, 6),)
    family = MM440

    def __init__(self, panel, control, name, eeprom):
        Work.__init__(self, panel, control, name)
        self.eeprom, self.phase = eeprom, ASKS

    def end(self, *told):
        self.did.append(told)


def being_written():
    panel = Told()
    module = on_demand.load("panel.sets.writing")
    usual, module.Write = module.Write, Writing
    try:
        return panel, set_list("write", panel, (panel, "1.set", True)), panel.work
    finally:
        module.Write = usual


def test_the_question_about_a_set_is_its_first_entry_and_what_differs_are_the_others():
    panel, shown, work = being_written()
    assert (work.name, work.eeprom) == ("1.set", True) and shown.control_at(0) is panel
    work.asks = True
    opens = words.OPENS % MM440.access
    for work.opens, turns in ((False, [b"SET=WRITE A3"] * 3),
                              (True, [opens, b"SET=WRITE A3", opens])):  # fmt: skip
        rows = []
        for panel.page_turns in range(3):
            rows.append(shown.words(0))
        assert rows == turns and shown.heading(0) == b"3 DIFFER", rows
    assert [(shown.heading(place), shown.words(place)) for place in range(1, shown.count())] == [
        (b"P1120[0]", b"10>2.5"), (b"P0731[1]", b"--->52:3")
    ]  # fmt: skip
    assert not shown.is_busy() and not shown.is_searching()
    shown.choose(1, 0)
    assert shown.take_keys(with_keys("PARAM")) is None and work.answer is None
    shown.choose(0, 0)
    assert work.answer is True


def test_what_cuts_the_bus_off_is_asked_about_by_itself_and_param_leaves_it_as_it_is():
    panel, shown, work = being_written()
    work.asks, work.phase = True, ASKS_CUT
    rows = []
    for panel.page_turns in range(4):
        rows.append(shown.words(0))
    assert rows == list(words.ASK_CUT) + [words.ASK_CUT[0]]
    assert (shown.heading(0), shown.count()) == (b"2 MAY CUT", 2)
    assert (shown.heading(1), shown.words(1)) == (b"P2010[0]", b"6>7")
    assert shown.take_keys(with_keys("UP", "SET")) is None and work.answer is None
    shown.choose(0, 0)
    assert work.answer is True
    assert shown.take_keys(with_keys("PARAM")) is True and work.answer is False
    work.asks = False
    assert shown.take_keys(with_keys("PARAM")) is None and shown.count() == 1
    work.answer = None
    shown.choose(0, 0)  # nothing is asked any more
    assert work.answer is None


def test_whoever_leaves_a_set_that_is_not_done_is_told_what_that_has_left():
    for is_half, told in ((False, (words.NOTHING_WRITTEN,)), (True, (words.HALF_WRITTEN, 3))):
        panel, shown, work = being_written()
        panel.is_half = is_half
        assert shown.is_busy() and shown.is_searching() and shown.count() == 1
        shown.step(0, 5)
        shown.search()
        shown.leave(0)
        assert work.did == [5, "search", told] and panel.did == [texts.of(*told)]
        assert shown.take_keys(with_keys("SET")) is None
        work.outcome = (words.DIFFER, 2)
        shown.leave(0)
        assert len(work.did) == 3 and shown.count() == 3 and shown.heading(0) == b"A3"
        assert shown.take_keys(with_keys("SET")) is BACK and not shown.is_busy()
        assert shown.take_keys(with_keys("DOWN")) is None
