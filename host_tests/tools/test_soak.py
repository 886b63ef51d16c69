# SPDX-License-Identifier: MIT
"""A short soak: some seeds, some seconds each. `./tools/soak` is the long one.

The whole panel with an operator who presses random keys, drives, faults of line, drives and panel;
a judge who sees keys, line and display, and asks the firmware nothing. The rules stand in
tools/soaking/judging/rules.py.
"""

import sys

import on_demand
from boards.sim.clock import Clock
from boards.sim.drives.drive import Drive
from boards.sim.drives.families import g120, mm3, mm440
from boards.sim.drives.switches import SWITCHES
from boards.sim.line.wire import Wire
from tools.soaking.dice import Dice
from tools.soaking.fuzz import fuzz
from tools.soaking.judging.announced import (
    ANY,
    MAY_RUN,
    OFF,
    RUNS,
    TRIPPED,
    UNHEARD,
    UNSURE,
    is_looked_up,
    number_in,
    said_in,
)
from tools.soaking.judging.case import Case
from tools.soaking.judging.drive_settings import Values
from tools.soaking.judging.facts import NEVER, start_us
from tools.soaking.judging.families import FAMILIES, VARIABLE, Kind, Sight, kinds_of
from tools.soaking.judging.looked_up import is_wrong
from tools.soaking.judging.reader import subject_in, tells_unconfirmed
from tools.soaking.judging.rules import RULES, Broken
from tools.soaking.judging.runs import begin_again, is_standstill, judge_rise
from tools.soaking.judging.shares import Shares
from tools.soaking.judging.tape import LENGTH, MIRRORED, REPLY, RETURNED, Tape
from tools.soaking.soak import Soak
from tools.soaking.story import story
from tools.soaking.worlds import Plan, switched

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


def test_set_may_raise_a_setpoint_where_the_display_has_digits_and_nowhere_else():
    soak = Soak(13, drives=1)
    hand, case = soak.hand, soak.judge.cases[soak.plan.addresses[0]]
    hand.run(2_000)

    def may_raise():
        before_us = case.raised_us
        hand.press("SET")
        hand.run(2_000)
        return case.raised_us > before_us

    assert not may_raise()
    hand.press("EDIT")
    hand.run(5_000)
    assert soak.reader.rows[1].startswith("NEW"), soak.reader.rows
    assert may_raise()
    assert not may_raise(), "the digits are gone"


def test_up_may_take_effect_in_the_first_telegram_after_a_line_that_was_blocked():
    soak = Soak(13, drives=1)
    address = soak.plan.addresses[0]
    case = soak.judge.cases[address]
    case.raised_us, case.highest_hsw = 0, 0x2000
    case.sent_us, now = 500_000, 1_040_000  # a node has talked since
    judge_rise(soak.judge.witness, case, 0x2100, now, "here")
    assert case.highest_hsw == 0x2100
    case.sent_us = 1_000_000  # that telegram had the old setpoint, long after the key
    try:
        judge_rise(soak.judge.witness, case, 0x2200, now, "here")
    except Broken as broken:
        assert broken.args[0] == "RISES", broken
    else:
        raise AssertionError("nobody noticed")


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
    assert [is_standstill(case, hiw, 0x0C7F) for hiw in hiws] == [False, False, False, False, True]
    case.stw, case.reached = 0x0C7F, False  # REVERSE
    hiws = (0x2000, 0x0010, 0xE000, 0x0000)  # right, through 0, left, and to rest
    assert [is_standstill(case, hiw, 0x0C7F) for hiw in hiws] == [False, False, False, True]


def test_what_an_announcement_says_of_whom_is_read_from_the_display():
    assert said_in("A3 RUN,HOLD=ALL ") == (3, (RUNS,))
    assert said_in("A31 FAULT F0001 ") == (31, (TRIPPED, OFF))
    assert said_in("A7 LINE FAILED  ") == (7, (OFF,))
    assert said_in("LOST,MAY RUN: 12") == (ANY, (MAY_RUN, UNSURE))
    assert said_in("A30 MAY RUN     ") == (30, (UNHEARD, UNSURE))
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


def test_a_stop_without_an_answer_is_an_alarm_on_the_page_and_in_the_menu():
    assert tells_unconfirmed(("S: 10.0 F: -----", "STOP UNCONFIRMED"), 0)
    assert tells_unconfirmed(("A0 NOT STOPPED  ", ">BUS TIMES      "), 0)
    assert not tells_unconfirmed(("A10 NOT STOPPED ", ">BUS TIMES      "), 0)
    assert not tells_unconfirmed(("DIAGNOSIS   2/35", ">BUS TIMES      "), 0)


def test_what_a_question_is_about_is_read_from_the_display():
    assert subject_in("A1: P0700=6     ") == (1, 700, 6)
    assert subject_in("A31: P2011=17   ") == (31, 2011, 17)
    for other in ("A1: P07 F:  0.00", "A1: P0700=      ", "PANEL MAY LOSE  ", "S:-10.0 F: -0.29"):
        assert subject_in(other) is None, other


def test_the_page_of_a_parameter_is_compared_with_the_drive():
    drive = Drive(Clock(), Wire(Clock(), 19200), 1)
    name = "Ramp-up time    "
    assert not is_wrong((name, "P1120     10.00s"), drive)
    assert is_wrong((name, "P1120     10.10s"), drive)
    for other in ("P1120          ?", "P1120      -----", "P1120 TOO LON---"):
        assert not is_wrong((name, other), drive), other


def test_an_answer_of_what_a_drive_is_makes_no_contact():
    """Somebody talks into the last answer: it was heard as little as an answer of another kind."""
    soak = Soak(13, drives=1)
    soak.hand.run(2_000)
    judge, (address,) = soak.judge, soak.plan.addresses
    case, kind = judge.cases[address], judge.witness.kinds[address]
    tape = judge.tape
    row = [one for one in range(LENGTH) if tape.kind[one] == REPLY and tape.end_us[one]][-1]
    for is_told, flawless, following in ((True, True, True), (False, False, True)):
        tape.end_us[row] = case.heard_us + 1_000
        tape.flawless[row] = flawless
        judge.unsettled = [(row, case, kind, 0xFB31, case.requests, False, is_told)]
        judge.settle_replies(soak.world.clock.now_us + 1_000_000)
        assert case.is_told == following, (is_told, flawless)


def test_a_doubted_drive_answers_though_its_last_answer_was_spoilt_and_a_round_takes_long():
    """It may be asked what it is. One that has fallen silent in contact may not yet."""
    soak = Soak(13, drives=1)
    soak.hand.run(2_000)
    judge, (address,) = soak.judge, soak.plan.addresses
    witness, tape, case = judge.witness, judge.tape, judge.cases[address]
    now = tape.at_us[0] = soak.world.clock.now_us
    tape.address[0], tape.is_blank = address, lambda row: True
    case.answered_us = case.heard_us = now - 2 * witness.lost_us
    case.contact_us, case.is_told = NEVER, False
    for late_us, misses, is_allowed in ((now, 1, True), (now, 2, True), (NEVER, 1, False)):
        witness.late_us = late_us
        case.heard_requests = case.requests - misses
        try:
            judge.judge_mirror(0, tape)
        except Broken as broken:
            assert broken.args[0] == "MIRROR" and not is_allowed, broken
        else:
            assert is_allowed, (late_us, misses)


def test_a_refused_start_is_pressed_again_when_the_panel_must_know_the_drive():
    soak = Soak(13, drives=1)
    hand, clock, (address,) = soak.hand, soak.world.clock, soak.plan.addresses
    begun_us = clock.now_us
    soak.judge.witness.knows = lambda case, address, now: now > begun_us + 60_000_000
    hand.run_until_known(address)
    assert 60_000_000 <= clock.now_us - begun_us < 61_000_000


def test_a_telegram_that_a_drive_is_to_send_back_is_no_request():
    clock = Clock()
    wire = Wire(clock, 19200)
    tape = Tape(wire)
    panel, drive = Talker("panel", True), Talker("drive 1")
    for station in (panel, drive):
        wire.attach(station)
    telegram = bytes((0x02, 0x0C, 0x41) + 10 * (0,) + (0x4F,))
    wire.talk(panel, telegram, 14)
    clock.advance(15_000)
    wire.talk(drive, telegram, 14)
    clock.advance(30_000)
    rows = list(tape.news())
    assert [tape.kind[row] for row in rows] == [MIRRORED, RETURNED]
    assert [tape.address[row] for row in rows] == [1, 1]
    assert [tape.count[row] for row in rows] == [5, 5] and tape.is_blank(rows[0])


def test_the_layout_changes_only_to_one_that_has_come_back():
    kind = Kind("mm420", 4, 2)
    assert kind.send(6, 0) and kind.send(6, 1) and not kind.send(5, 0)
    assert kind.may_be_reply(6) and not kind.may_be_reply(5)
    kind.returned(5, True)
    assert kind.send(5, 0) and kind.words == {3} and not kind.send(6, 0)
    kind.restarted()
    assert kind.sight() is None and kind.send(6, 0) and kind.words == {4}
    kind.returned(5, True)
    kind.answered()
    assert not kind.send(5, 0)
    kind.returned(5, True)
    kind.returned(6, True)  # it takes a longer one, too
    assert kind.send(5, 0) and kind.words == {VARIABLE} and kind.may_be_reply(6)
    assert not kind.send(2, 0)


def test_what_the_settings_name_is_what_the_panel_is_taken_to_know():
    kinds = kinds_of({"kinds": {"3": "g120", "5": "mm440/4+4", "7": "mm3"}}, (1, 3, 5, 7))
    told = {one: (kinds[one].words, kinds[one].pzd_words) for one in kinds}
    assert told == {1: ({4}, 2), 3: ({VARIABLE}, 2), 5: ({4}, 4), 7: ({3}, 2)}


def test_percent_is_where_nobody_can_read_what_it_is_of():
    for name, pkw_words, percent in (
        ("mm420", 4, False), ("mm440", VARIABLE, False), ("g110", 3, True), ("v20", 0, True),
        ("mm3", 3, False), ("g120", VARIABLE, True), ("generic", 4, True),
    ):  # fmt: skip
        sight = Sight(FAMILIES[name], pkw_words)
        assert sight.is_percent == percent, name
        assert sight.reads_words == (pkw_words != 0 and name != "generic"), name


def test_limits_are_told_in_the_unit_that_the_panel_shows():
    world = Soak(1).world
    told = {}
    for name, module, pkw_words in (
        ("mm440", mm440, 4), ("mm440", mm440, 3), ("mm3", mm3, 3), ("g120", g120, VARIABLE),
        ("g120", g120, 3),
    ):  # fmt: skip
        drive = Drive(world.clock, Wire(world.clock, 19200), 1, family=module)
        values = Values(drive, Sight(FAMILIES[name], pkw_words))
        told[name, pkw_words] = (values.is_percent, values.highest_hz, values.reference_hz)
    assert told == {
        ("mm440", 4): (False, 50, 50),
        ("mm440", 3): (True, 650, 100),
        ("mm3", 3): (False, 50, 50),
        ("g120", VARIABLE): (True, 100, 100),
        ("g120", 3): (True, 650, 100),
    }


def test_worlds_have_every_family_in_every_layout():
    found = set()
    for seed in range(400):
        plan = Plan(seed, 3)
        if plan.has_families:
            found |= {(kind["family"].NAME, kind["layout"][0]) for kind in plan.kinds.values()}
    assert {name for name, _ in found} >= {
        "MICROMASTER 420", "MICROMASTER 440", "MICROMASTER 3", "SINAMICS G110", "SINAMICS V20",
        "SINAMICS G120", "drive of the specification",
    }  # fmt: skip
    assert {words for name, words in found if name != "MICROMASTER 3"} == {0, 3, 4, VARIABLE}


def test_where_the_panel_can_control_no_drive_it_has_nothing_to_prove():
    soak = Soak(721)  # two drives, both of other families than the panel is told
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


def test_a_drive_that_lags_on_a_slow_line_is_given_the_time_to_tell_its_settings():
    """Seed 44: 31 drives at 4800 baud. P0719 was put right, and read again after two minutes."""
    hand = Soak(44).hand
    drive = hand.drives[0]
    drive.stale_replies = 2
    assert hand.known_s(drive) > 17 * 3 * 31 * 0.09
    hand = Soak(1, drives=1).hand
    hand.drives[0].stale_replies = 0
    assert hand.known_s(hand.drives[0]) <= 8, "no longer than for all else"


def test_a_motor_that_started_twice_may_be_stopped_whenever_that_is_noticed():
    """r2024 of a drive that is not shown is read every 12 s, if there are 30 of them."""
    soak = Soak(13, drives=1)
    soak.hand.run(2_000)
    judge, address = soak.judge, soak.plan.addresses[0]
    case, now = judge.cases[address], soak.world.clock.now_us
    case.stw, case.ran, case.on_us = 0x047F, True, now - 30_000_000
    case.heard_us = case.answered_us = now
    assert not judge.has_reason(case, now, False)
    begin_again(case, now - 29_000_000)
    assert not judge.has_reason(case, now, False), "it was started once"
    begin_again(case, now - 14_000_000)
    assert judge.has_reason(case, now, False)


def test_a_start_of_long_ago_is_no_reason_for_a_motor_to_turn():
    for drives, baud, seconds in ((1, 19200, 14), (10, 19200, 15)):
        plan = Plan(1, drives)
        plan.baud, plan.listed = baud, plan.addresses
        assert 12 < start_us(plan) / 1_000_000 < seconds


def commissioning():
    """A witness of a drive that stands, and the address of that."""
    soak = Soak(13, drives=1)
    soak.hand.run(2_000)
    return soak.judge.witness, soak.plan.addresses[0]


def in_step(witness, number, row_2):
    witness.sees_menu()
    rows = ("P%04d       7/23" % number, ">%-15s" % row_2)
    witness.commissioned.read(rows, witness.clock.now_us)


def asked(witness, address, number, value, is_dangerous=False):
    now = witness.clock.now_us
    return witness.commissioned.has_asked(address, number, value, is_dangerous, now)


def test_a_step_is_asked_for_when_set_says_yes_to_its_value_and_not_before():
    witness, address = commissioning()
    in_step(witness, 700, "2 NEEDS 5")
    assert witness.commissioned.is_open(witness.clock.now_us)
    witness.commissioned.key("SET", witness.clock.now_us)
    assert not asked(witness, address, 700, 5, True)
    in_step(witness, 700, "5 SET=YES")
    assert not asked(witness, address, 700, 5, True)
    witness.commissioned.key("SET", witness.clock.now_us)
    assert asked(witness, address, 700, 5, True)
    assert not asked(witness, address, 700, 6, True), "another value"
    assert not asked(witness, address, 1000, 5, True), "another step"


def test_what_means_another_speed_is_asked_for_twice():
    witness, address = commissioning()
    sixty, ramp = 0x42700000, 0x41280000  # 60.0 and 10.5
    in_step(witness, 2000, "06[0].00")
    witness.commissioned.key("SET", witness.clock.now_us)
    assert not asked(witness, address, 2000, sixty, True)
    in_step(witness, 2000, "RESCALES SPEED")
    witness.commissioned.key("SET", witness.clock.now_us)
    assert asked(witness, address, 2000, sixty, True)
    in_step(witness, 1120, "01[0].50")
    witness.commissioned.key("SET", witness.clock.now_us)
    assert asked(witness, address, 1120, ramp), "and anything else once"


def test_set_asks_for_no_step_while_the_motor_runs():
    witness, address = commissioning()
    case = witness.cases[address]
    case.stw, case.zsw, case.on_us = 0x047F, 0xFB34, witness.clock.now_us - 2_000_000
    assert witness.shown == address
    in_step(witness, 700, "5 SET=YES")
    witness.commissioned.key("SET", witness.clock.now_us)
    assert not asked(witness, address, 700, 5, True)


def test_a_step_of_commissioning_is_not_the_page_of_a_parameter():
    assert is_looked_up(("Ramp-up time", "P1120[0]  10.00s"))
    assert not is_looked_up(("P1120      17/23", ">IS 10.00s"))
    assert not is_looked_up(("P1120*     17/23", "IT IS RIGHT"))


def told(witness, rows):
    """What the judge says of an event in the list, or None."""
    try:
        witness.happened.read(rows, witness.clock.now_us)
    except Broken as broken:
        return broken.args[0]


def test_an_event_has_the_instant_at_which_it_was():
    witness, address = commissioning()
    world, happened = witness.world, witness.happened
    fault = ("A%d 0:%02d     1/7", ">FAULT F0001    ")

    def rows(seconds):
        return (fault[0] % (address, seconds), fault[1])

    world.run(8_000)
    happened.reply(address, 0xFB78, world.clock.now_us)
    world.run(2_000)
    happened.reply(address, 0xFB31, world.clock.now_us)
    world.run(20_000)
    assert told(witness, rows(21)) is None
    assert told(witness, rows(7)) == told(witness, rows(29)) == "SHOWN"
    assert told(witness, ("A%d 0:21     1/7" % (address + 1), fault[1])) == "SHOWN"
    stop = "A%d 0:05     1/7" % address, ">STOP KEY       "
    assert told(witness, stop) == "SHOWN"
    happened.key("STOP", world.clock.now_us - 5_000_000)
    assert told(witness, stop) is None


def test_a_seed_begins_without_what_the_one_before_it_has_loaded():
    """Else it would be another life behind another seed: to load a module takes a step."""
    on_demand.load("panel.menu.about")
    Soak(7)
    assert "panel.menu.about" not in sys.modules


def test_a_silent_drive_that_is_asked_what_it_is_is_not_neglected():
    """It answers such questions, in another layout than that of its list, and nothing else."""
    soak = Soak(13, drives=1)
    soak.hand.run(2_000)
    witness, shares = soak.judge.witness, Shares(soak.judge.witness)
    case, now = witness.cases[soak.plan.addresses[0]], soak.world.clock.now_us + 60_000_000
    case.question_us = now - 500_000
    shares.look(now)
    case.question_us = NEVER
    try:
        shares.look(now)
    except Broken as broken:
        assert broken.args[0] == "NEGLECTED"
    else:
        raise AssertionError("nobody noticed")


def test_a_drive_that_the_panel_may_have_heard_running_may_take_more_than_the_share():
    """It is asked again and again while it is silent. One that was never heard is not."""
    soak = Soak(13, drives=2)
    soak.hand.run(3_000)
    witness = soak.judge.witness
    shown, address = soak.plan.addresses
    case = witness.cases[address]
    case.zsw, case.heard_us, case.answered_us = 0xFB34, NEVER, soak.world.clock.now_us
    for replies in (1, 0):
        case.taken, now = replies, case.answered_us + 10_000_000
        shares = Shares(witness)
        try:
            for _ in range(1_000):
                now += 40_000
                witness.cases[shown].answered_us = now
                witness.cases[shown].sent_us = case.sent_us = now
                shares.ask(case, address, None, now)
                shares.look(now)
                shares.ask(witness.cases[shown], shown, None, now + 20_000)
                shares.answered()
        except Broken as broken:
            assert replies == 0 and "silent drives take" in broken.args[1], (replies, broken)
        else:
            assert replies == 1, "nobody noticed"


def test_a_reply_since_power_on_that_the_panel_may_not_have_taken_makes_nobody_lost():
    """It says MAY RUN as of a drive that was never heard, and lets it rest as such a one."""
    soak = Soak(13, drives=2)
    soak.hand.run(3_000)
    witness, reader = soak.judge.witness, soak.reader
    shown, address = soak.plan.addresses
    case, now = witness.cases[address], soak.world.clock.now_us
    witness.shown, case.zsw, case.ran_us = shown, 0xFB34, now
    case.answered_us, case.heard_us, case.lost_us = now, witness.boot_us - 1, now + 1
    reader.rows = ("S: 10.0 F:  0.00", "A%d MAY RUN" % address)
    shares = Shares(witness)
    for _ in range(500):
        now += 40_000
        witness.cases[shown].answered_us = witness.cases[shown].heard_us = now
        reader.announced.look(now)
        case.asked_us = case.answered_us + 1
        shares.ask(case, address, None, now)
    case.heard_us = witness.boot_us + 1
    try:
        for _ in range(500):
            now += 40_000
            witness.cases[shown].answered_us = witness.cases[shown].heard_us = now
            reader.announced.look(now)
    except Broken as broken:
        assert broken.args[0] == "ANNOUNCED"
    else:
        raise AssertionError("nobody noticed")


def test_a_count_on_the_display_may_be_as_old_as_its_picture_and_no_older():
    soak = Soak(13, drives=1)
    soak.hand.run(2_000)
    witness, (address,) = soak.judge.witness, soak.plan.addresses
    case, now = witness.cases[address], soak.world.clock.now_us
    case.heard = case.taken = 100
    rows = "A%d GOOD     1/7" % address, ">  100  2880/min"
    witness.diagnosed.read(rows, True, now)
    case.heard = case.taken = 110
    now += witness.seen_us - 1
    witness.diagnosed.read(rows, True, now)
    try:
        witness.diagnosed.read(rows, True, now + witness.seen_us)
    except Broken as broken:
        assert broken.args[0] == "SHOWN"
    else:
        raise AssertionError("nobody noticed")


def test_a_drive_that_answers_and_takes_a_longer_telegram_may_be_asked_in_any_layout():
    kind = Kind("mm440", VARIABLE, 4)
    assert not kind.may_ask(5)
    kind.mirror(8)
    assert kind.may_ask(7) and not kind.may_ask(5)  # in its own length, behind a longer one
    kind.returned(8, True)
    assert kind.may_ask(5)


def test_what_the_menu_asks_an_address_waits_on_a_line_that_others_talk_on():
    soak = Soak(13, drives=1)
    soak.hand.run(2_000)
    witness, now = soak.judge.witness, soak.world.clock.now_us
    witness.menu_us = witness.late_us = now
    assert witness.may_look(now + 1_000_000) and not witness.may_look(now + 4_000_000)
    witness.late_us = now + 3_000_000
    assert witness.may_look(now + 4_000_000) and not witness.may_look(now + 60_000_000)
