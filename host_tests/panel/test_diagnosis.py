# SPDX-License-Identifier: MIT
"""Diagnosis by keys: the pages of the menu, and why drive 4 does not answer."""

import main
from boards.sim.drives.families import mm440
from boards.sim.drives.kinds import listed_drives, simulated
from boards.sim.world import World
from panel.menu.diagnosis import mirror as mirror_test
from panel.menu.diagnosis import telegrams as telegram_list
from panel_bench import (
    OFF1,
    comes_to,
    panel,
    row_2,
    running,
    said,
    settled,
    starts,
    telegrams,
)
from round_bench import framed
from spoilt_bench import (
    cut_off,
    garbled,
    longer,
    of_another_address,
    silent,
    spoil,
    with_a_wrong_check,
)
from uss import pkw
from uss.drive import COUNTERS
from uss.finding.witness import CYCLE, RESPONSE_DELAY
from uss.master import LISTENING, OFF
from uss.tasks.descriptions import NAME, read_description
from uss.telegram import MIRROR, NET

FOUR = (1, 2, 3, 4)
PARAMETER_CHANGED = 0x0800  # bit 11 of PKE, which is no part of the number


def open_menu(world, *entries):
    """Hold PARAM, and choose one entry after the other."""
    world.press("PARAM", 1200)
    world.run(300)
    for entry in entries:
        walk_to(world, entry)
        world.press("SET")
        world.run(300)


def walk_to(world, entry):
    """DOWN until row 2 begins so, behind the mark of the menu."""
    walk(world, lambda: settled(world)[1].startswith(">" + entry), entry)


def title(world):
    """Row 1 without the place, once nothing is announced there."""
    for _ in range(40):
        row = settled(world)[0]
        if "HOLD=ALL" not in row:
            break
        world.run(100)
    return row[:11].rstrip()


def read(world, wanted):
    """Row 2 of the entry that has this title."""
    walk(world, lambda: title(world) == wanted, wanted)
    return settled(world)[1][1:].rstrip()


def walk(world, arrived, what):
    for _ in range(40):
        if arrived():
            return
        world.press("DOWN", 40)
    raise AssertionError("no %s: %r" % (what, world.lcd()))


def test_stop_is_for_the_drive_that_is_shown_and_for_the_one_that_is_looked_at():
    """A page of the bus looks at none."""
    for shown, entries, is_open, stopped in (
        (1, ("A3",), False, (1, 3)),
        (3, ("A1",), False, (3, 1)),
        (1, ("A3", "COUNTERS"), False, (1, 3)),
        (1, ("A3", "COUNTERS"), True, (1, 3)),
        (1, ("A3", "TIMES"), True, (1, 3)),
        (1, ("A3", "TELEGRAMS"), True, (1, 3)),
        (1, ("A3", "MIRROR TEST"), True, (1, 3)),
        (1, ("BUS COUNTERS",), True, (1,)),
        (1, ("THE PANEL",), False, (1,)),
    ):
        world = running(addresses=(1, 2, 3))
        world.press("ADDRESS_DOWN")
        world.run(2_500)
        world.press("START")
        world.run(3_000)
        assert world.drives[3].state == "running"
        if shown == 1:
            world.press("ADDRESS_UP")
            world.run(300)
        open_menu(world, "DIAGNOSIS", *entries[:-1])
        walk_to(world, entries[-1])
        if is_open:
            world.press("SET")
            world.run(300)
        world.press("STOP")
        world.run(200)
        words = ">%s: STOP" % " ".join(["A%d" % address for address in stopped])
        assert row_2(world) == words, (entries, world.lcd())
        world.run(4_000)
        for address in stopped:
            assert world.drives[address].state == "ready", (entries, address)
        world.check()


# --- the pages ----------------------------------------------------------------------------------


def test_the_counters_of_a_drive_are_those_of_the_specification_with_their_rates():
    world = running(addresses=(1, 2))
    open_menu(world, "DIAGNOSIS", "A2", "COUNTERS")
    assert title(world) == "A2 GOOD", world.lcd()
    for ms in (0, 1_300):
        world.run(ms)
        assert row_2(world).endswith("   .../min"), world.lcd()  # too early for a rate
    world.run(700)
    assert not row_2(world).endswith("   .../min"), world.lcd()
    world.run(8_000)
    counted, rate = row_2(world)[1:].split()
    drive = world.app.bus.turns.at(2)
    assert abs(int(counted) - drive.counters[0]) <= 2, world.lcd()
    assert 1300 <= int(rate[: -len("/min")]) <= 1450, world.lcd()  # every second of 46 a second
    names = []
    for _ in range(7):
        names.append(title(world).split()[1])
        world.press("DOWN", 40)
    assert names == ["GOOD", "START", "LENGTH", "BCC", "ADDRESS", "NOREPLY", "RESIDUE"], names
    read(world, "A2 NOREPLY")
    assert row_2(world).endswith("   .../min"), world.lcd()
    world.drives[2].unplug()
    world.run(5_000)
    counted, rate = row_2(world)[1:].split()
    assert int(counted) >= 3 and int(rate[: -len("/min")]) > 0, world.lcd()
    world.check()


def test_the_counters_of_the_bus_are_those_of_all_drives_and_what_the_bus_itself_counts():
    world = panel(addresses=(1, 2))
    open_menu(world, "DIAGNOSIS", "BUS COUNTERS")
    world.run(4_000)
    assert title(world) == "BUS GOOD"
    counted, rate = row_2(world)[1:].split()
    assert int(rate[:-4]) > 2_600, world.lcd()
    good = sum(drive.counters[0] for drive in world.app.bus.turns.drives)
    assert abs(int(counted) - good) <= 3
    world.drives[2].unplug()
    world.run(2_000)
    sent = int(read(world, "BUS SENT").split()[0])
    assert abs(sent - world.app.bus.turns.exchanges) <= 3, world.lcd()
    for wanted in ("BUS FOREIGN", "BUS FAILED", "BUS HUNG"):
        assert read(world, wanted).split()[0] == "0", world.lcd()
    bus = world.app.bus
    bus.foreign, bus.failures, bus.dead_man_trips = 1, 2, 3
    for wanted, counted in (("BUS FOREIGN", "1"), ("BUS FAILED", "2"), ("BUS HUNG", "3")):
        assert read(world, wanted).split()[0] == counted, world.lcd()
    world.check()


RESIDUE = COUNTERS.index("residual")  # of which a whole line never has any


def test_a_counter_has_16_bits_and_its_rate_goes_on_when_it_begins_anew():
    world = panel(baud=4800)  # a minute passes, and the fewer telegrams in it the sooner
    counters = world.app.bus.turns.at(1).counters
    open_menu(world, "DIAGNOSIS", "A1", "COUNTERS")
    for first, then, seconds, grown in (
        (0xFFFE, 0xFFFF, 6, 1), (0xFFFE, 1, 6, 3), (0, 811, 6, 811), (0, 0x8001, 40, 0x8001),
    ):  # fmt: skip
        counters[RESIDUE] = first
        read(world, "A1 RESIDUE")
        world.run(1000 * seconds)  # and some 300 ms have passed since the entry was chosen
        counters[RESIDUE] = then
        world.run(100)
        counted, rate = row_2(world)[1:].split()
        assert int(counted) == then, world.lcd()
        a_minute = grown * 60 // seconds
        assert a_minute * 0.9 <= int(rate[:-4]) <= a_minute, (grown, world.lcd())
        world.press("DOWN", 40)
    world.check()


def test_the_sum_of_all_drives_has_16_bits_like_their_counters():
    world = panel(addresses=(1, 2))
    open_menu(world, "DIAGNOSIS", "BUS COUNTERS")
    read(world, "BUS RESIDUE")
    for first, second, told in ((0x8001, 0x8002, "3"), (1, 0xFFFF, "0"), (1, 0xFFFE, "65535")):
        for address, counted in ((1, first), (2, second)):
            world.app.bus.turns.at(address).counters[RESIDUE] = counted
        world.run(100)
        assert row_2(world)[1:].split()[0] == told, world.lcd()
    world.check()


def test_the_times_are_those_of_the_line():
    world = panel(addresses=(1, 2))
    open_menu(world, "DIAGNOSIS", "A1", "TIMES")
    world.run(3_000)
    least, most = [float(ms) for ms in read(world, "A1 CYCLE")[:-3].split("-")]
    assert 40 <= least <= most <= 50, world.lcd()  # two exchanges of 22 ms
    least, most = [float(ms) for ms in read(world, "A1 START")[:-3].split("-")]
    assert 1.1 <= least <= most < 5, world.lcd()
    least, most = [float(ms) for ms in read(world, "A1 REPLY")[:-3].split("-")]
    assert 1.6 <= least <= most < 2.0, world.lcd()  # after three characters
    world.drives[1].reply_delay_us = 12_000
    world.run(2_000)
    least, most = [float(ms) for ms in read(world, "A1 REPLY")[:-3].split("-")]
    assert least < 2 and 11.8 <= most <= 12.3, world.lcd()
    world.press("PARAM")
    world.run(300)
    assert world.app.bus.witness is None
    world.press("PARAM")
    world.run(300)
    walk_to(world, "BUS TIMES")
    world.press("SET")
    world.run(2_000)
    assert read(world, "BUS CYCLE").endswith(" ms")
    world.check()


def test_a_menu_that_closes_ends_what_its_list_has_begun():
    """Nobody listens to the line any more, and the bus is at work again."""
    world = panel()
    for way in (("BUS TIMES",), ("A1", "TELEGRAMS"), ("BUS OFF",)):
        open_menu(world, "DIAGNOSIS", *way)
        bus = world.app.bus
        if way == ("BUS OFF",):
            world.press("SET")
            world.run(500)
            sent = world.wire.log.count
            world.run(500)
            assert world.wire.log.count == sent, world.lcd()
        else:
            assert bus.witness is not None, way
        world.app.panel.close_menu()
        assert bus.witness is None, way
        world.run(500)
    assert world.wire.log.count > sent


def test_a_time_of_a_second_and_more_has_no_decimals():
    """Four drives at 1200 bit/s: an exchange takes a quarter of a second."""
    world = panel(addresses=FOUR, baud=1200)
    open_menu(world, "DIAGNOSIS", "BUS TIMES")
    world.run(8_000)
    shown = read(world, "BUS CYCLE")
    least, most = [int(ms) for ms in shown[:-3].split("-")]
    assert shown.endswith(" ms") and 340 <= least <= 360 and 1_370 <= most <= 1_410, shown
    for most_us, told in ((999_949, "999.9-999.9 ms"), (999_951, "1000-1000 ms")):
        times = world.app.bus.witness.times
        times[CYCLE] = times[CYCLE + 1] = most_us
        world.run(100)
        assert row_2(world)[1:] == told, world.lcd()
    world.check()


def test_a_time_below_a_second_is_told_to_the_nearest_tenth_of_a_millisecond():
    world = panel()
    world.drives[1].unplug()  # so nothing else is measured meanwhile
    world.run(2_000)
    open_menu(world, "DIAGNOSIS", "BUS TIMES")
    assert read(world, "BUS REPLY") == "NONE YET"
    times = world.app.bus.witness.times
    for least_us, most_us, told in (
        (49, 50, "0.0-0.1 ms"), (1_949, 1_950, "1.9-2.0 ms"), (9_949, 9_950, "9.9-10.0 ms"),
        (12_349, 456_751, "12.3-456.8 ms"),
    ):  # fmt: skip
        times[RESPONSE_DELAY], times[RESPONSE_DELAY + 1] = least_us, most_us
        world.run(100)
        assert row_2(world)[1:] == told, world.lcd()
    world.check()


def test_a_start_delay_behind_a_drive_that_does_not_answer_is_not_measured():
    """Nobody has seen the end of a reply there."""
    world = panel(addresses=(1, 2))
    world.drives[2].unplug()
    world.run(2_000)
    open_menu(world, "DIAGNOSIS", "A1", "TIMES")
    world.run(3_000)
    least, most = [float(ms) for ms in read(world, "A1 START")[:-3].split("-")]
    assert 1.1 <= least <= most < 5, world.lcd()
    world.check()


def test_the_last_telegrams_are_shown_in_words_and_in_hexadecimal():
    world = running()
    open_menu(world, "DIAGNOSIS", "A1", "TELEGRAMS")
    world.run(500)
    world.press("SET")  # they stay as they are
    world.run(200)
    assert title(world) == "A1 HELD"
    shown = []
    for _ in range(4 + 3 + 5 + 3):
        shown.append(settled(world)[1][1:].rstrip())
        world.press("DOWN", 40)
        world.run(100)
    assert "STW 047F ON" in shown and "HSW 0CCD 20%" in shown, shown
    assert "GOOD" in shown and [row for row in shown if row.startswith("ZSW FB34 RUNS")], shown
    assert [row for row in shown if row.startswith("HIW 0CC")], shown
    assert [row for row in shown if row.startswith("PWE ")], shown
    wire = [(sent, bytes(characters)) for _, sent, characters in world.wire.log.last(400)]
    for at, is_sent in ((4, True), (12, False)):  # four words before each, and what was found
        characters = bytes.fromhex("".join(shown[at : at + 3]))
        assert (is_sent, characters) in wire, shown
    world.press("SET")
    world.run(200)
    assert title(world) in ("A1 SENT", "A1 HEARD")
    world.press("PARAM")
    world.run(300)
    assert world.app.bus.witness is None
    world.check()


def test_what_a_parameter_task_says_is_there_in_words():
    world = panel()
    open_menu(world, "DIAGNOSIS", "A1", "TELEGRAMS")
    seen = set()
    for _ in range(300):
        world.run(30)
        seen.add(row_2(world)[1:])
    assert [row for row in seen if row[:6] in ("READ P", "READ r")], seen
    world.check()


def test_a_parameter_task_is_told_with_its_number_and_index_on_every_page():
    """Six bits of IND say which 2000 numbers are meant. The drive has none of these."""
    world = panel()
    open_menu(world, "DIAGNOSIS", "A1", "TELEGRAMS")
    drive = world.app.bus.turns.at(1)
    for page in (0, 1, 2, 4, 8, 16, 32):
        job, told = pkw.read(2000 * page + 7, 3), "READ P%04d[3]" % (2000 * page + 7)
        for _ in range(200):
            if job.state != pkw.PENDING:
                drive.ask(job)
            world.run(30)
            if row_2(world)[1:] == told:
                break
        else:
            raise AssertionError("never said: " + told)
    world.check()


def comes_up(world, job, told):
    """Whether row 2 tells it while drive 1 is given this task again and again."""
    drive = world.app.bus.turns.at(1)
    for _ in range(100):
        if job.state != pkw.PENDING:
            drive.ask(job)
        world.run(30)
        if row_2(world)[1:] == told:
            return True
    return False


def test_a_task_and_what_the_drive_says_to_it_are_told_in_words():
    """At a rate that leaves time to read: each telegram is shown for as long as it takes."""
    world = panel(baud=4800)
    open_menu(world, "DIAGNOSIS", "A1", "TELEGRAMS")
    tasks = (
        (pkw.read(1000), "READ P1000[0]", "IS P1000[0]"),
        (pkw.write_word(1000, 5), "WRITE P1000[0]", "IS P1000[0]"),
        (pkw.write_double(1120, 0, 1), "WRITE P1120[1]", "ERROR 3"),
        (pkw.write_word(1000, 5, eeprom=True), "STORE P1000[0]", "IS P1000[0]"),
        (pkw.write_double(1120, 0, 1, eeprom=True), "STORE P1120[1]", "ERROR 3"),
        (pkw.Job(pkw.COUNT_ELEMENTS, 1120), "READ P1120[0]", "IS P1120[0]"),
    )
    for job, sent, _ in tasks:
        assert comes_up(world, job, sent), (sent, world.lcd())
    read(world, "A1 HEARD")
    world.press("DOWN", 40)  # behind the finding
    for job, sent, heard in tasks:
        assert comes_up(world, job, heard), (sent, heard, world.lcd())
    world.drives[1].write(927, 0, 7)
    assert comes_up(world, pkw.write_word(1000, 5), "NO RIGHTS"), world.lcd()
    world.check()


def test_the_words_of_a_task_are_where_the_drive_has_them():
    for words in (3, 4, 127):
        kind = "mm440/%d" % words
        world = panel(
            baud=4800, kinds=simulated(listed_drives("1=" + kind)), settings={"kinds": {"1": kind}}
        )
        open_menu(world, "DIAGNOSIS", "A1", "TELEGRAMS")
        read(world, "A1 HEARD")
        world.press("DOWN", 40)
        assert comes_up(world, pkw.write_word(1000, 9999), "ERROR 2"), (words, world.lcd())
        world.press("DOWN", 40)
        told = "PWE 0000 0041" if words == 4 else "PWE 0041 0000"
        assert comes_up(world, pkw.write_word(1000, 65), told), (words, world.lcd())
        world.check()


def held(**options):
    """A panel that holds the last telegrams of drive 1, at the first entry, and its `Witness`."""
    world = panel(**options)
    open_menu(world, "DIAGNOSIS", "A1", "TELEGRAMS")
    world.press("SET")
    world.run(100)
    assert settled(world)[0].startswith("A1 HELD     1/"), world.lcd()
    return world, world.app.bus.witness


def put(characters, words):
    """These words as the net data of a telegram that is held."""
    for place, word in enumerate(words):
        characters[NET + 2 * place], characters[NET + 2 * place + 1] = word >> 8, word & 0xFF


def entry(world, steps=0):
    """The entry so many steps further on."""
    for _ in range(steps):
        world.press("DOWN", 40)
    world.run(100)
    return settled(world)[1][1:].rstrip()


def test_a_task_is_told_as_what_it_does_to_the_parameter():
    """Eight of them write, four into the EEPROM as well."""
    world, witness = held()
    for task in range(16):
        put(witness.request, (task << 12 | 1999, 99))
        does = "WRITE" if task in (2, 3, 7, 8) else "STORE" if task in (11, 12, 13, 14) else "READ"
        told = does + " P1999[99]" if task else "NO TASK"
        assert entry(world) == told, (task, world.lcd())
    for task, told in ((1, "READ P127999.."), (2, "WRITE P127999.."), (11, "STORE P127999..")):
        put(witness.request, (task << 12 | 1999, 0xFF63))
        assert entry(world) == told, world.lcd()  # cut at its end it would tell another index
    for index in (254, 255):
        put(witness.request, (1 << 12 | PARAMETER_CHANGED, index))
        assert entry(world) == "READ P0000[%d]" % index, world.lcd()
    entry(world, 8)
    for reply in range(16):
        put(witness.reply, (reply << 12 | 700, 0, 5, 17))
        told = {0: "NO TASK", 7: "ERROR 17", 8: "NO RIGHTS"}.get(reply, "IS P0700[0]")
        assert entry(world) == told, (reply, world.lcd())


def test_control_word_and_main_values_are_told_in_hexadecimal_and_in_words():
    world, witness = held()
    commands = (
        (0x047E, " OFF1"), (0x047C, " OFF2"), (0x047A, " OFF3"), (0x047F, " ON"),
        (0x0C7F, " ON"), (0x057E, " JOG"), (0x067E, " JOG"), (0x04FE, ""), (0x0000, ""),
    )  # fmt: skip
    states = (
        (0xFB31, "READY"), (0xFB34, "RUNS"), (0xFB3C, "FAULT"), (0xFB70, "INHIB"), (0, "WAITS"),
    )  # fmt: skip
    values = (
        (0x4000, "100"), (0xC000, "-100"), (0x0CCD, "20"), (0, "0"), (0x7FFF, "200"),
        (0x8000, "-200"), (81, "0"), (82, "1"), (0xFFAF, "0"), (0xFFAE, "-1"), (0x2000, "50"),
    )  # fmt: skip
    entry(world, 2)
    for word, told in commands:
        put(witness.request, (0, 0, 0, 0, word, 0x1111))
        assert entry(world) == "STW %04X%s" % (word, told), world.lcd()
    entry(world, 1)
    for value, percent in values:
        put(witness.request, (0, 0, 0, 0, 0x2222, value))
        assert entry(world) == "HSW %04X %s%%" % (value, percent), world.lcd()
    entry(world, 7)
    for word, told in states:
        put(witness.reply, (0, 0, 0, 0, word, 0x1111))
        assert entry(world) == "ZSW %04X %s" % (word, told), world.lcd()
    entry(world, 1)
    for value, percent in values:
        put(witness.reply, (0, 0, 0, 0, 0x2222, value))
        assert entry(world) == "HIW %04X %s%%" % (value, percent), world.lcd()


def test_of_a_long_telegram_the_first_42_characters_are_kept_and_told():
    """A word that ends behind the last of them is not."""
    kind = "mm440/127"
    world, witness = held(
        kinds=simulated(listed_drives("1=" + kind)), settings={"kinds": {"1": kind}}
    )
    kept = ("STW 047F ON", "HSW 4000 100%", "ZSW FB34 RUNS", "HIW 2000 50%")
    for pkw_words, told in ((16, kept), (17, kept), (18, ("...",) * 4)):
        sent = framed(1, bytes(range(2 * pkw_words)) + b"\x04\x7f\x40\x00")
        heard = framed(1, bytes(range(99, 99 + 2 * pkw_words)) + b"\xfb\x34\x20\x00")
        witness.request[:] = (sent + bytes(2))[:42]
        witness.reply[:] = (heard + bytes(2))[:42]
        witness.request_count = witness.reply_count = len(sent)
        shown = [entry(world, 1) for _ in range(21)]
        last = shown.pop()  # the list goes round: this is the first entry
        assert last.startswith("NO TASK"), shown
        assert tuple(shown[1:3] + shown[12:14]) == told, shown
        for at, telegram in ((3, sent), (14, heard)):
            assert bytes.fromhex("".join(shown[at : at + 6])) == telegram[:42], (at, shown)
        assert shown[9] == "GOOD", shown


def test_an_entry_that_is_not_there_any_more_is_the_last_one_that_is():
    """On the chip the telegrams go on while somebody looks at the last ones."""
    world = panel()
    open_menu(world)
    shown = telegram_list.List(world.app.panel, world.app.panel.selected)
    assert (shown.count(), shown.words(0)) == (5, b"NONE YET")
    headings = [shown.heading(place) for place in (0, 3, 4, 99)]
    assert headings == [b"A1 SENT", b"A1 SENT", b"A1 HEARD", b"A1 HEARD"], headings
    world.run(200)
    assert shown.count() == 15
    assert shown.words(15) == shown.words(99) == shown.words(14) != shown.words(13)
    shown.end()


def test_a_telegram_without_a_parameter_channel_has_no_task():
    kinds = {1: {"family": mm440, "parameters": {2013: 127, 2014: 2_000}}}
    world = panel(kinds=kinds, settings={"kinds": {"1": "mm440/127s"}})
    open_menu(world, "DIAGNOSIS", "A1", "TELEGRAMS")
    read(world, "A1 HEARD")
    for _ in range(2):  # the task and its value
        world.press("DOWN", 40)
        told = set()
        for _ in range(200):
            world.run(15)
            told.add(row_2(world)[1:])
        assert "NO TASK" in told, told
    world.check()


def test_behind_a_long_answer_there_is_no_room_for_the_status_word():
    """42 characters are kept: those of a parameter's name are few enough, not its description."""
    kind = "generic/127"
    world = panel(kinds=simulated(listed_drives("1=" + kind)), settings={"kinds": {"1": kind}})
    open_menu(world, "DIAGNOSIS", "A1", "TELEGRAMS")
    read(world, "A1 HEARD")
    for _ in range(3):
        world.press("DOWN", 40)
    assert row_2(world)[1:].startswith("ZSW "), world.lcd()
    assert not comes_up(world, read_description(2010, NAME), "..."), world.lcd()
    assert comes_up(world, read_description(2010), "..."), world.lcd()
    world.check()


def test_what_the_receiver_makes_of_a_reply_stands_behind_the_task():
    found = {
        silent: "NO REPLY", garbled: "NO TELEGRAM", cut_off: "CUT OFF", longer: "20 CHARACTERS",
        of_another_address: "OTHER ADDRESS", with_a_wrong_check: "WRONG BCC",
    }  # fmt: skip
    for how, told in found.items():
        world = panel()
        open_menu(world, "DIAGNOSIS", "A1", "TELEGRAMS")
        spoil(world.wire, world.drives[1], how)
        world.run(300)
        assert read(world, "A1 HEARD") == told, (how.__name__, world.lcd())


def test_the_mirror_test_counts_what_comes_back():
    world = running(addresses=(1, 2))
    open_menu(world, "DIAGNOSIS", "A2", "MIRROR TEST")
    assert title(world)[:9] == "A2 MIRROR"
    world.run(5_000)
    good, _, _, sent = row_2(world)[1:].split()
    assert good == sent and 18 <= int(sent) <= 22, world.lcd()  # four a second
    world.drives[2].unplug()
    world.press("SET")
    world.run(5_000)
    good, _, _, sent = row_2(world)[1:].split()
    assert good == "0" and int(sent) >= 3, world.lcd()
    assert world.drives[1].state == "running" and starts(world, 2) == 0
    world.check()


def mirrors(world, since_us=0):
    """What the panel has sent as mirror telegrams, the newest last."""
    log = world.wire.log.last(1000)
    return [data for at_us, sent, data in log if sent and at_us > since_us and data[2] & MIRROR]


def test_the_mirror_test_begins_at_0_and_begins_anew_with_set():
    world = panel()
    open_menu(world, "DIAGNOSIS")
    since_us = world.clock.now_us
    walk_to(world, "A1")
    world.press("SET")
    world.run(300)
    walk_to(world, "MIRROR TEST")
    for _ in range(2):
        world.press("SET", 40)
        assert comes_to(world, ">3 OK OF 3")
        assert len(mirrors(world, since_us)) == 3
        since_us = world.clock.now_us
    world.check()


def test_the_mirror_test_of_a_silent_drive_leaves_the_line_to_those_that_answer():
    """Four mirrors in a second would take 40 % of the time at this rate."""
    world = panel(addresses=(1, 2), baud=2400)
    world.drives[2].unplug()
    world.run(3_000)
    open_menu(world, "DIAGNOSIS", "A2", "MIRROR TEST")
    since_us = world.clock.now_us
    world.run(10_000)
    assert 5 < len(mirrors(world, since_us)) < 20, len(mirrors(world, since_us))
    world.check()


def test_the_mirror_test_counts_as_far_as_row_2_has_room():
    """To 9999, of both: that takes 42 minutes, or here a line on which each comes back at once."""
    world = panel()
    open_menu(world)  # its words are there
    sent = []

    def post(mirror):
        sent.append(mirror)
        mirror.state = pkw.DONE

    world.app.bus.turns.post = post
    shown = mirror_test.List(world.app.panel, world.app.panel.selected)
    now_ms = 0
    for _ in range(10_050):
        shown.step(0, now_ms)
        now_ms = now_ms + 250 & world.app.panel.mask
    assert len(sent) == 9999 and shown.words(0) == b"9999 OK OF 9999", (len(sent), shown.words(0))


def test_a_mirror_telegram_has_other_characters_everywhere_and_would_command_nothing():
    """Whatever the layout: bit 10 of STW is 0."""
    for kind, pzd_count in (("mm440", 4), ("mm3", 4), ("mm440/3+4", 8), ("mm440/127+3", 6)):
        world = panel(kinds=simulated(listed_drives("1=" + kind)), settings={"kinds": {"1": kind}})
        open_menu(world, "DIAGNOSIS", "A1", "MIRROR TEST")
        world.run(500)
        net = mirrors(world)[-1][3:-1]
        assert len(set(net)) >= len(net) - 1, (kind, net)
        assert not net[-pzd_count] & 0x04, (kind, net)
        world.check()


def test_the_panel_tells_why_it_started_and_what_memory_is_free():
    world = panel()
    open_menu(world, "DIAGNOSIS", "THE PANEL")
    assert read(world, "RESTART") == "POWER OR RESET"
    assert settled(world)[0] == "RESTART      1/2", world.lcd()
    assert read(world, "HEAP FREE") == "SET=COUNT"
    world.press("SET")
    world.run(200)
    count, unit = row_2(world)[1:].split()
    assert int(count) > 0 and unit == "BYTES"
    world.press("PARAM")
    world.press("PARAM")
    world.press("PARAM")
    world.run(200)
    world.hang(3_000)
    world.run(3_000)
    open_menu(world, "DIAGNOSIS", "THE PANEL")
    assert read(world, "RESTART") == "WATCHDOG"


def test_to_count_the_memory_waits_for_no_motor():
    world = running()
    open_menu(world, "DIAGNOSIS", "THE PANEL")
    read(world, "HEAP FREE")
    world.press("SET")
    world.run(100)
    assert world.reads("STOP ALL FIRST"), world.lcd()


# --- bus off ------------------------------------------------------------------------------------


def off_world(**options):
    world = panel(**options)
    world.run(3_000)
    open_menu(world, "DIAGNOSIS", "BUS OFF")
    world.press("SET")
    world.run(1_000)
    return world


def test_bus_off_leaves_the_line_and_param_takes_it_back_listening_first():
    world = off_world(addresses=(1, 2))
    assert settled(world) == ("PARAM=BACK      ", ">LINE IS FREE   "), world.lcd()
    left_us = world.clock.now_us
    world.run(90_000)  # longer than a menu stays open
    assert not telegrams(world, left_us) and world.reads("LINE IS FREE"), world.lcd()
    world.press("PARAM", 40)
    assert world.app.bus.phase == LISTENING
    world.run(1_000)
    assert {stw for _, stw in telegrams(world, left_us)} == {OFF1}
    for _ in range(2):
        world.press("PARAM")
    world.run(10_000)
    assert not world.resets and world.reads("FAULT F0072"), world.lcd()  # by its P2014
    world.check()


def test_bus_off_says_what_it_may_cost_and_asks():
    for kind, number in (("mm440", "P2014"), ("mm3", "P0093")):
        world = panel(kinds=simulated(listed_drives("1=" + kind)), settings={"kinds": {"1": kind}})
        world.run(3_000)
        open_menu(world, "DIAGNOSIS", "BUS OFF")
        assert settled(world) == (number + " MAY TRIP  ", ">SET=LEAVE LINE "), world.lcd()
        world.press("PARAM")
        world.run(500)
        assert world.app.bus.phase != OFF


def test_bus_off_is_refused_while_a_motor_runs():
    world = running(addresses=(1, 2))
    open_menu(world, "DIAGNOSIS", "BUS OFF")
    world.press("SET")
    world.run(300)
    assert world.reads("STOP ALL FIRST") and world.drives[1].state == "running", world.lcd()
    assert world.app.bus.phase != OFF


def test_while_the_line_is_left_no_key_starts_anything():
    world = off_world()
    for key in ("START", "REVERSE", "JOG_RIGHT", "JOG_LEFT"):
        world.press(key)
        world.run(500)
        assert world.reads("NO: IN THE MENU"), world.lcd()
    world.run(4_000)
    assert world.reads("LINE IS FREE") and starts(world) == 0, world.lcd()
    world.press("PARAM")
    world.run(3_000)
    assert starts(world) == 0
    world.check()


def test_stop_takes_the_line_back_and_is_sent():
    world = off_world()
    pressed_us = world.clock.now_us
    world.press("STOP")
    world.run(300)
    sent = telegrams(world, pressed_us, 1)
    assert sent and sent[0][1] == OFF1 and sent[0][0] - pressed_us < 250_000, sent
    assert world.reads("MAY TRIP") and not world.reads("LINE IS FREE"), world.lcd()
    world.check()


def test_a_menu_that_closes_takes_the_line_back():
    world = off_world()
    world.app.panel.close_menu()
    world.run(3_000)
    assert world.app.bus.turns.at(1).contact
    world.check()


# --- why does drive 4 not answer? ---------------------------------------------------------------


def unplugged():
    world = World(main.start, FOUR)
    world.drives[4].unplug()
    return world


def shown_4(world):
    """The panel shows drive 4, which has been asked for a while."""
    world.run(4_000)
    world.press("ADDRESS_DOWN")
    world.run(500)
    return world


def heard_of_4(world):
    """What the last telegrams say was heard of drive 4."""
    open_menu(world, "DIAGNOSIS", "A4", "TELEGRAMS")
    world.run(1_000)
    return read(world, "A4 HEARD")


def test_a_wire_is_broken():
    """Nothing is heard of it, there or anywhere else; the others answer."""
    world = shown_4(unplugged())
    assert [row for row in said(world, 4_000) if row == "NO CONTACT   A4"], world.lcd()
    assert heard_of_4(world) == "NO REPLY", world.lcd()
    world.press("PARAM")
    world.run(300)
    walk_to(world, "MIRROR TEST")
    world.press("SET")
    world.run(8_000)
    assert row_2(world).startswith(">0 OK OF "), world.lcd()
    for _ in range(4):
        world.press("PARAM")
    open_menu(world, "WHY NO CONTACT")
    assert title(world) == "A4 HEARD" and world.reads("NOTHING"), world.lcd()
    walk_to(world, "PLUG AND WIRES")
    world.drives[4].plug()
    world.run(8_000)
    walk_to(world, "IT ANSWERS NOW")
    world.check()


def test_its_address_is_another_one():
    """P2011 = 5: address 5 answers, which is not in the list."""
    world = shown_4(World(main.start, (1, 2, 3, 5), settings={"drives": [1, 2, 3, 4]}))
    assert heard_of_4(world) == "NO REPLY", world.lcd()
    for _ in range(4):
        world.press("PARAM")
    open_menu(world, "WHY NO CONTACT", "P2011 = 4")  # SET goes to ANY ADDRESS
    for answer in ("A4  IN THE LIST", "A5  ANSWERS"):
        for _ in range(60):
            world.run(100)
            if row_2(world) == ">" + answer:
                break
        assert row_2(world) == ">" + answer, world.lcd()
        world.press("DOWN", 40)
    world.check()


def test_its_pkw_words_are_others():
    """P2013 = 127: it answers, in telegrams of another length, and the panel takes that over."""
    world = shown_4(World(main.start, FOUR, kinds=simulated(listed_drives("4=mm420/127"))))
    found = heard_of_4(world)
    assert found in ("14 CHARACTERS", "GOOD"), world.lcd()
    world.run(15_000)
    assert read(world, "A4 HEARD") == "GOOD", world.lcd()
    assert world.app.settings.kinds == {"4": "mm420/127"}
    world.check()
