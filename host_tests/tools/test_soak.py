# SPDX-License-Identifier: MIT
"""A short soak: some seeds, some seconds each. `./tools/soak` is the long one.

The whole panel with an operator who presses random keys, drives, faults of line, drives and panel;
a judge who sees keys, line and display, and asks the firmware nothing. The rules stand in
tools/soaking/judging/rules.py.
"""

from boards.sim.clock import Clock
from boards.sim.drives.switches import SWITCHES
from boards.sim.line.wire import Wire
from tools.soaking.dice import Dice
from tools.soaking.fuzz import fuzz
from tools.soaking.judging.announced import ANY, MAY_RUN, OFF, RUNS, TRIPPED, number_in, said_in
from tools.soaking.judging.case import Case
from tools.soaking.judging.reader import subject_in
from tools.soaking.judging.rules import RULES, Broken
from tools.soaking.judging.runs import is_standstill
from tools.soaking.judging.tape import REPLY, Tape
from tools.soaking.soak import Soak
from tools.soaking.story import story
from tools.soaking.worlds import switched

NOT_TRACED = """
    test_every_rule_holds
    test_a_seed_repeats_to_the_telegram
    test_the_receiver_stands_anything
"""

SEEDS = (1, 2, 3, 6, 9, 11)  # clean, rough, wild; one drive and several; direct and matrix; polled
SECONDS = 25


class Talker:
    def __init__(self, name, is_panel=False):
        self.name = name
        self.is_panel = is_panel

    def hear(self, burst):
        pass


def test_every_rule_holds():
    for seed in SEEDS:
        soak = Soak(seed)
        soak.run(SECONDS)
        assert soak.broken is None, "\n".join(story(soak))
        assert soak.judge.exchanges > 200


def test_a_start_that_nobody_pressed_is_noticed():
    soak = Soak(13, drives=1)
    soak.hand.run(1_500)
    soak.world.app.panel.controls[0]._obey(0)  # as if START had been pressed
    soak.world.app.bus.turns.drives[0].start(0x1000)  # behind the back of whoever judges
    try:
        soak.hand.run(500)
    except Broken as broken:
        soak.broken = broken
    assert soak.broken is not None and soak.broken.args[0] == "START", soak.broken
    told = list(story(soak))
    assert RULES["START"] in told[0], told
    assert [line for line in told if "A%d ON" % soak.plan.addresses[0] in line], told


def test_a_reply_that_somebody_talked_into_may_have_been_taken_or_not():
    clock = Clock()
    wire = Wire(clock, 19200)
    tape = Tape(wire)
    panel, drive, twin = Talker("panel", True), Talker("drive 1"), Talker("drive 1's twin")
    for station in (panel, drive, twin):
        wire.attach(station)
    telegram = bytes((0x02, 0x0E, 0x01) + 12 * (0,) + (0x0D,))
    replies = []
    for twin_after_us in (None, 4_000):
        wire.talk(panel, telegram, 16)
        clock.advance(15_000)
        wire.talk(drive, telegram, 16)
        if twin_after_us:
            clock.advance(twin_after_us)
            wire.talk(twin, telegram, 16)
        clock.advance(30_000)
        replies.append([row for row in tape.news() if tape.kind[row] == REPLY])
        blurred_ms = (clock.now_us - tape.blurred_us) // 1000
    assert len(replies[0]) == 1 and len(replies[1]) == 0
    assert 20 <= blurred_ms < 30, blurred_ms


def test_a_spoilt_reply_whose_check_fits_by_chance_is_noted():
    clock = Clock()
    wire = Wire(clock, 19200)
    tape = Tape(wire)
    panel, drive = Talker("panel", True), Talker("drive 1")
    for station in (panel, drive):
        wire.attach(station)
    telegram = bytes((0x02, 0x0E, 0x01) + 12 * (0,) + (0x0D,))
    for stray, fits in ((0x0D, True), (0x0C, False)):
        reply = telegram[:3] + bytes((stray,)) + telegram[3:]  # its BCC comes as the 17th
        tape.chance_us = None
        wire.talk(panel, telegram, 16)
        clock.advance(15_000)
        wire.talk(drive, reply, 17)
        clock.advance(30_000)
        assert [row for row in tape.news() if tape.kind[row] == REPLY] == []
        assert (tape.chance_us is not None) == fits, stray


class Motor:
    """A drive that has just started."""

    starts = 1

    def __init__(self, address, stw):
        self.address = address
        self.stw = stw


def test_a_motor_is_the_panels_unless_garbage_started_it():
    soak = Soak(1)
    judge = soak.judge
    for faults, stw, is_blamed in ((None, 0x0E1F, True), ((), 0x0E1F, False), ((), 0x047F, True)):
        soak.weather.faults = faults
        judge.drives = [Motor(soak.plan.addresses[0], stw)]
        judge.starts = [0]
        try:
            judge.judge_motors(20_000_000)
            blamed = False
        except Broken as broken:
            blamed = broken.args[0] == "TURNS"
        assert blamed == is_blamed, (faults, stw)


def test_a_world_may_have_every_switch_of_the_drive_set():
    drawn = {}
    for seed in range(400):
        drawn.update(switched(Dice(seed)))
    assert set(drawn) == {row[0] for row in SWITCHES}


def test_a_drive_that_stands_though_nobody_ordered_it_is_told_from_one_that_turns_round():
    case = Case()
    case.stw, case.hsw = 0x047F, 0x2000
    hiws = (0x0000, 0x1FF0, 0x2000, 0x1000, 0x0010)  # from rest to the setpoint, and to rest
    assert [is_standstill(case, hiw) for hiw in hiws] == [False, False, False, False, True]
    case.stw, case.reached = 0x0C7F, False  # REVERSE
    hiws = (0x2000, 0x0010, 0xE000, 0x0000)  # right, through 0, left, and to rest
    assert [is_standstill(case, hiw) for hiw in hiws] == [False, False, False, True]


def test_what_an_announcement_says_of_whom_is_read_from_the_display():
    assert said_in("A3 RUN,HOLD=ALL ") == (3, (RUNS,))
    assert said_in("A31 FAULT F0001 ") == (31, (TRIPPED, OFF))
    assert said_in("A7 LINE FAILED  ") == (7, (OFF,))
    assert said_in("LOST,MAY RUN: 12") == (ANY, (MAY_RUN,))
    assert number_in(("S: 10.0 F: 10.00", "LOST,MAY RUN: 12")) == 12
    for other in ("RUNNING      A1 ", "P0700:     5 A1 ", "A", "                "):
        assert said_in(other) is None, other


def test_two_drives_that_run_unseen_are_both_to_be_announced():
    soak = Soak(13, drives=3)
    soak.hand.run(3_000)
    addresses = soak.plan.addresses
    witness, reader = soak.judge.witness, soak.reader
    witness.shown = addresses[0]
    for address in addresses[1:]:
        witness.cases[address].zsw = 0xFB34
    reader.rows = ("S: 10.0 F:  0.00", "A%d RUN,HOLD=ALL " % addresses[1])
    now = soak.world.clock.now_us
    told = None
    for _ in range(500):
        now += 40_000
        for address in addresses:
            witness.cases[address].answered_us = witness.cases[address].heard_us = now
        try:
            reader.announced.look(now)
        except Broken as broken:
            told = broken
            break
    assert told is not None and told.args[0] == "ANNOUNCED", told
    assert told.args[1].startswith("drive %d, it runs" % addresses[2]), told


def test_what_a_question_is_about_is_read_from_the_display():
    assert subject_in("A1: P0700=6     ") == (1, 700, 6)
    assert subject_in("A31: P2011=17   ") == (31, 2011, 17)
    for other in ("A1: P07 F:  0.00", "A1: P0700=      ", "PANEL MAY LOSE  ", "S:-10.0 F: -0.29"):
        assert subject_in(other) is None, other


def test_where_the_panel_can_control_no_drive_it_has_nothing_to_prove():
    soak = Soak(721)  # two drives, both with telegrams that this panel does not speak
    assert not any(soak.reader.is_able(address) for address in soak.plan.addresses)
    soak.hand.put_in_order()
    soak.hand.prove_control()


def test_a_seed_repeats_to_the_telegram():
    one, other = Soak(7), Soak(7)
    one.run(6)
    other.run(6)
    assert one.world.wire.log.last(50) == other.world.wire.log.last(50)
    assert one.hand.deeds == other.hand.deeds


def test_the_receiver_stands_anything():
    for seed in range(1, 4):
        fed = fuzz(8_000, seed)
        assert fed["broken"] is None, fed
        assert fed["good"] > 20, fed
