# SPDX-License-Identifier: MIT
"""The lists of the diagnosis by themselves, to the millisecond."""

from menu_bench import PostingBus
from panel import texts
from panel.keys import Acts, Keys
from panel.menu.diagnosis import counters as counter_list
from panel.menu.diagnosis import health, off
from panel.menu.diagnosis import mirror as mirror_test
from panel.menu.diagnosis import overview as overview_list
from panel.menu.diagnosis import telegrams as telegram_list
from panel.menu.diagnosis import times as time_list
from panel.menu.diagnosis import words as diagnosis_words
from pkw_bench import characters
from round_bench import framed
from uss import pkw
from uss.drive import COUNTERS
from uss.families import MM440
from uss.layout import Layout
from uss.master import LISTENING, OFF
from uss.receiver import SILENT
from uss.telegram import GOOD


class Told:
    """A drive and the survey of it, as the lists ask for them."""

    net_count, pzd_words, pzd_count = 12, 2, 4
    family = MM440
    contact = True
    trouble = 0

    defect = b""

    def __init__(self, address):
        self.drive = self.survey = self.layout = self.desk = self
        self.address = address
        self.request = bytes((2, 14, address)) + bytes(13)
        self.size = len(self.request)
        self.counters = [100 * address + row for row in range(len(COUNTERS))]


class Line(PostingBus):
    """A panel with two drives, its bus, and what they do."""

    mask = 0xFFFFF
    exchanges, foreign, failures, dead_man_trips = 11, 22, 33, 44
    phase = LISTENING
    has_motor = reset_cause = False
    character_us = 573
    count, buffer = 16, bytes(16)  # of a reply
    witness = None

    def __init__(self):
        self.bus = self.turns = self.deadlines = self.board = self.timing = self
        self.controls = [Told(3), Told(12)]
        self.selected = self.controls[0]
        self.did = []

    def any_runs(self):
        return self.has_motor

    def say(self, now_ms, text):
        self.did.append((now_ms, text))

    def note(self, telegram):
        self.did.append(telegram)

    def off(self):
        self.did.append("off")

    def on(self):
        self.did.append("on")


def test_the_first_list_has_four_entries_of_the_line_and_one_of_each_drive():
    line = Line()
    third, twelfth = line.controls
    third.contact, third.trouble = False, 1
    twelfth.contact, twelfth.defect = False, texts.LINE_LOW
    shown = overview_list.List(line, None)
    assert [(shown.words(row), shown.control_at(row), shown.choose(row, 0))
            for row in range(shown.count())] == [
        (b"BUS COUNTERS", None, ("diagnosis.counters", None)),
        (b"BUS TIMES", None, ("diagnosis.times", None)),
        (b"BUS OFF", None, ("diagnosis.off", None)),
        (b"THE PANEL", None, ("diagnosis.health", None)),
        (b"A3  LINE NOISE", third, ("diagnosis.overview", third)),
        (b"A12 " + texts.LINE_LOW, twelfth, ("diagnosis.overview", twelfth)),
    ]  # fmt: skip
    assert shown.heading(0) == shown.heading(5) == b"DIAGNOSIS"
    of_drive = overview_list.List(line, twelfth)
    names = ("counters", "times", "telegrams", "mirror")
    told = (b"COUNTERS", b"TIMES", b"TELEGRAMS", b"MIRROR TEST")
    assert of_drive.count() == 4
    for row in range(4):
        assert (of_drive.heading(row), of_drive.words(row)) == (b"A12", told[row])
        assert of_drive.control_at(row) is twelfth
        assert of_drive.choose(row, 0) == ("diagnosis." + names[row], twelfth)


def test_the_times_are_those_of_one_drive_or_of_all():
    """The cycle of all is that of the drive that comes first."""
    line = Line()
    third, twelfth = line.controls
    telegram_us = 16 * line.character_us
    for argument, who, told in (
        (None, b"BUS", (b"55.3-55.3 ms", b"2.0-20.0 ms", b"1.6-7.0 ms")),
        (third, b"A3", (b"55.3-55.3 ms", b"2.0-2.0 ms", b"1.6-1.8 ms")),
        (twelfth, b"A12", (b"65.5-65.5 ms", b"10.0-20.0 ms", b"5.0-7.0 ms")),
    ):
        shown = time_list.List(line, argument)
        assert shown.count() == 3 and shown.control_at(1) is argument
        assert [shown.words(row) for row in range(3)] == [b"NONE YET"] * 3
        line.heard_at = line.mask - 50_000  # the clock begins anew meanwhile
        for drive, start_us, reply_us in (
            (third, 5_000, 1_600), (twelfth, 10_000, 5_000),
            (third, 2_000, 1_800), (twelfth, 20_000, 7_000),
        ):  # fmt: skip
            line.sent_at = line.heard_at + start_us + telegram_us & line.mask
            line.heard_at = line.sent_at + reply_us + telegram_us & line.mask
            line.witness.note(drive, GOOD, line)
        names = [who + name for name in (b" CYCLE", b" START", b" REPLY")]
        assert [shown.heading(row) for row in range(3)] == names
        assert tuple([shown.words(row) for row in range(3)]) == told, who
        shown.end()
        assert line.witness is None


def test_a_telegram_is_told_in_as_many_words_as_it_has():
    """A reply that is not good has its characters alone."""
    line = Line()
    drive = line.controls[1]
    net = (0x13E8, 0x0001, 0x0000, 0x0041, 0x047F, 0x4000, 0x1111)
    task, value, control = b"READ P1000[1]", b"PWE 0000 0041", b"STW 047F ON"
    for layout, told, rows in (
        (Layout(4, 2), (task, value, control, b"HSW 4000 100%"), 3),
        (Layout(3, 2), (task, b"PWE 0041 0000", control, b"HSW 4000 100%"), 2),
        (Layout(4, 3), (task, value, control, b"HSW 4000 100%"), 3),
        (Layout(4, 1), (task, value, control), 2),
        (Layout(4, 0), (task, value), 2),
        (Layout(0, 2), (control, b"HSW 4000 100%"), 2),
    ):
        words = list(net[: 4 + layout.pzd_words])
        if layout.pkw_words == 3:
            del words[2]
        if layout.pkw_words == 0:
            del words[:4]
        telegram = framed(12, characters(*words))
        drive.layout = layout
        shown = telegram_list.List(line, drive)
        assert shown.control_at(0) is drive and shown.words(0) == b"NONE YET"
        drive.request, drive.size = telegram, len(telegram)
        line.buffer, line.count = telegram, len(telegram)
        for finding, found, more in ((SILENT, b"NO REPLY", 0), (GOOD, b"GOOD", len(told))):
            line.sent_at = line.heard_at = 0
            line.witness.note(drive, finding, line)
            entries = [shown.words(row) for row in range(shown.count())]
            assert len(entries) == len(told) + rows + 1 + more + rows, entries
            assert tuple(entries[: len(told)]) == told and entries[len(told) + rows] == found
            for at in (len(told), len(entries) - rows):
                assert bytes.fromhex(b"".join(entries[at : at + rows]).decode()) == telegram
            sent = len(told) + rows
            headings = [shown.heading(row) for row in range(len(entries))]
            assert headings == [b"A12 SENT"] * sent + [b"A12 HEARD"] * (len(entries) - sent)
        shown.choose(0, 0)
        line.witness.note(drive, SILENT, line)
        assert shown.heading(0) == b"A12 HELD" and shown.count() == len(entries)
        shown.choose(5, 0)
        line.witness.note(drive, SILENT, line)
        assert shown.heading(0) == b"A12 SENT" and shown.words(len(told) + rows) == b"NO REPLY"
        shown.end()
        assert line.witness is None


def test_a_rate_is_that_of_the_time_since_its_entry_was_chosen_two_seconds_at_the_least():
    line = Line()
    drive = line.controls[1]
    shown = counter_list.List(line, drive)
    begin_ms = line.mask - 999  # the clock begins anew meanwhile
    for at_ms, counted, told in (
        (0, 60_000, "60000   .../min"), (1_999, 60_020, "60020   .../min"),
        (2_000, 60_020, "60020   600/min"), (2_001, 60_020, "60020   599/min"),
        (30_000, 60_020, "60020    40/min"), (30_000, 34_464, "34464 80000/min"),
        (60_000, 34_464, "34464 40000/min"), (60_000, 14_464, "14464 20000/min"),
    ):  # fmt: skip
        drive.counters[3] = counted
        shown.step(3, begin_ms + at_ms & line.mask)
        assert shown.words(3) == told.encode(), (at_ms, shown.words(3))
    assert shown.words(2) == b" 1202   .../min"  # that entry is not chosen
    for row, at_ms, told in ((2, 90_000, " 1202"), (3, 95_000, "14464")):  # each begins anew
        shown.step(row, begin_ms + at_ms & line.mask)
        assert shown.words(row) == told.encode() + b"   .../min"
        shown.step(row, begin_ms + at_ms + 2_000 & line.mask)
        assert shown.words(row) == told.encode() + b"     0/min"


def test_each_counter_of_a_drive_and_of_the_bus_stands_at_its_own_name():
    line = Line()
    of_drive, of_bus = counter_list.List(line, line.controls[1]), counter_list.List(line, None)
    assert (of_drive.count(), of_bus.count()) == (7, 11)
    assert of_drive.control_at(0) is line.controls[1] and of_bus.control_at(0) is None
    for row, name in enumerate(diagnosis_words.COUNTERS):
        assert of_drive.heading(row) == b"A12 " + name and of_bus.heading(row) == b"BUS " + name
        assert of_drive.words(row) == b"%5d   .../min" % (1_200 + row)
        assert of_bus.words(row) == b"%5d   .../min" % (300 + 1_200 + 2 * row)
    told = [(of_bus.heading(row), of_bus.words(row)[:5]) for row in range(7, 11)]
    names = (b"BUS SENT", b"BUS FOREIGN", b"BUS FAILED", b"BUS HUNG")
    assert told == list(zip(names, (b"   11", b"   22", b"   33", b"   44"))), told


def test_a_mirror_goes_every_250_ms_and_the_next_when_the_last_is_over():
    """Behind a task for a drive, and when silent drives have had their share of the line."""
    line = Line()
    shown = mirror_test.List(line, line.controls[1])
    assert shown.heading(0) == b"A12 MIRROR TEST" and shown.control_at(0) is line.controls[1]
    begin_ms = line.mask - 400
    for at_ms, state, changes, sent, told in (
        (0, None, {}, 1, "0 OK OF 0"), (900, None, {}, 1, "0 OK OF 0"),
        (901, pkw.DONE, {}, 2, "1 OK OF 1"), (905, pkw.TIMED_OUT, {}, 2, "1 OK OF 2"),
        (1_150, None, {}, 2, "1 OK OF 2"), (1_151, None, {"wait_us": 1}, 2, "1 OK OF 2"),
        (1_160, None, {"wait_us": 0, "has_other": True}, 2, "1 OK OF 2"),
        (1_170, None, {"has_other": False}, 3, "1 OK OF 2"),
        (1_171, pkw.DONE, {}, 3, "2 OK OF 3"), (1_419, None, {}, 3, "2 OK OF 3"),
        (1_420, None, {}, 4, "2 OK OF 3"),
    ):  # fmt: skip
        for name in changes:
            setattr(line, name, changes[name])
        if state is not None:
            line.did[-1].state = state
        shown.step(0, begin_ms + at_ms & line.mask)
        assert (len(line.did), shown.words(0)) == (sent, told.encode()), at_ms
    shown.choose(0, 0)
    assert shown.words(0) == b"0 OK OF 0"


def test_the_line_is_left_once_and_taken_back_once():
    line = Line()
    keys = Keys(("STOP", "START"), line.mask)
    shown = off.List(line)

    def reads():
        return shown.heading(0), shown.words(0), shown.is_busy()

    asks = (b"P2014 MAY TRIP", b"SET=LEAVE LINE", False)
    line.has_motor = True
    shown.choose(0, 77)
    assert line.did == [(77, texts.STOP_FIRST)] and reads() == asks
    line.has_motor, line.did = False, []
    shown.end()
    assert line.did == []
    for way_back in ("STOP", "PARAM"):
        for _ in range(2):  # a second SET does nothing
            shown.choose(0, 77)
            assert line.did == ["off"] and reads() == (b"BUS OFF", b"STOPS DRIVES", True)
        line.phase = OFF
        assert reads() == (b"PARAM=BACK", b"LINE IS FREE", True)
        acts = Acts(keys)
        acts.pressed = keys.bit("START")
        assert not shown.take_keys(acts) and line.did == ["off"]
        if way_back == "STOP":
            acts.pressed = keys.bit("STOP")
            assert not shown.take_keys(acts)  # the menu has it, too
        for _ in range(2):
            shown.end()
        assert line.did == ["off", "on"] and reads() == asks
        line.phase, line.did = LISTENING, []


def test_memory_is_counted_by_set_on_its_own_entry_beside_no_motor():
    line = Line()
    shown = health.List(line)
    assert shown.count() == 2
    line.has_motor = True
    for position, did in ((0, []), (1, [(77, texts.STOP_FIRST)])):
        shown.choose(position, 77)
        assert line.did == did and shown.words(1) == b"SET=COUNT"
    line.has_motor = False
    shown.choose(0, 77)
    assert shown.words(1) == b"SET=COUNT"
    shown.choose(1, 77)
    count, unit = shown.words(1).split()
    assert int(count) > 0 and unit == b"BYTES" and len(line.did) == 1
    for cause, told in ((False, b"POWER OR RESET"), (True, b"WATCHDOG")):
        line.reset_cause = cause
        assert shown.words(0) == told
