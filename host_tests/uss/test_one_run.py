# SPDX-License-Identifier: MIT
"""One START, one run: a motor that had its speed and stands still is not left to start again.

What each reply shows of it, as the engine sees it (`Drive.take`). Mains that come back within
a second, with a drive behind them: panel/test_panel_one_run.py.
"""

from master_bench import Bus
from uss import pzd
from uss.drive import Drive
from uss.telegram import put_word, seal

MASK = (1 << 30) - 1
READY, RUNNING = 0xFB31, 0xFB34
EXCHANGE_US = 30_000
FULL = pzd.FULL_SCALE
HALF = FULL // 2


def word(part):
    """A part of the full scale as a word of PZD2."""
    return round(part * FULL) & 0xFFFF


def running(hsw=HALF, stw=pzd.ON, hiw=None):
    """A bus whose drive runs and has reached its setpoint."""
    bus = Bus()
    bus.run(200_000)
    bus.drives[0].start(hsw, stw)
    bus.zsw[1] = RUNNING
    bus.run(EXCHANGE_US)
    bus.hiw[1] = hsw if hiw is None else hiw
    bus.run(EXCHANGE_US)
    assert bus.drives[0].is_on()
    return bus


def is_taken_back(bus, us=3 * EXCHANGE_US):
    """Whether OFF1 follows, after the one telegram that may be on the wire already."""
    since = len(bus.sent)
    bus.run(us)
    sent = bus.stws(1, since)
    taken = pzd.OFF1 in sent
    assert taken == bus.drives[0].stopped_by_engine()
    if taken:
        assert sent[2:] == [pzd.OFF1] * len(sent[2:]), sent
    return taken


def test_a_motor_that_had_its_speed_and_stands_is_stopped():
    bus = running()
    bus.hiw[1] = 0
    assert is_taken_back(bus)
    bus.hiw[1] = HALF  # whatever it shows later, it takes a new START
    bus.run(1_000_000)
    assert bus.stws(1, -10) == [pzd.OFF1] * 10
    bus.drives[0].start(HALF)
    bus.run(EXCHANGE_US)
    assert bus.drives[0].is_on()


def test_either_way_and_within_one_percent_of_zero():
    for hsw, stw, hiw in (
        (HALF, pzd.ON, HALF),
        (HALF, pzd.ON_REVERSE, -HALF & 0xFFFF),
        (-HALF & 0xFFFF, pzd.ON, -HALF & 0xFFFF),
        (-HALF & 0xFFFF, pzd.ON_REVERSE, HALF),
    ):
        for rest in (0, word(0.009), word(-0.009)):
            bus = running(hsw, stw, hiw)
            bus.hiw[1] = rest
            assert is_taken_back(bus), (hex(hsw), hex(stw), hex(rest))
        for rest in (word(0.011), word(-0.011), word(0.3), -hiw & 0xFFFF):
            bus = running(hsw, stw, hiw)
            bus.hiw[1] = rest
            assert not is_taken_back(bus), (hex(hsw), hex(stw), hex(rest))


def is_one_run(hsw, first, then, stw=pzd.ON, full_scale=FULL):
    """Whether a drive whose HIW is `first` in one reply and `then` in the next is left with ON."""
    drive = Drive(1, MASK)
    reply = bytearray(16)
    put_word(reply, 11, READY)
    drive.tell_speed(full_scale)
    drive.fill(0)
    drive.take(reply, 16, 0)
    drive.start(hsw, stw)
    put_word(reply, 11, RUNNING)
    for hiw in (first, then):
        drive.fill(0)
        put_word(reply, 13, hiw & 0xFFFF)
        drive.take(reply, 16, 0)
    return not drive.stopped_by_engine()


def test_the_figures_to_one_count_of_the_actual_value():
    """Reached within 2 %, 326 counts of 4000h; standing within 1 %; looked after from 5 % on."""
    for sign, stw in ((1, pzd.ON), (-1, pzd.ON), (-1, pzd.ON_REVERSE)):
        hsw = HALF * (1 if stw == pzd.ON_REVERSE else sign) & 0xFFFF
        at = sign * HALF
        for first, then, is_left in (
            (at - 326, 0, False), (at - 327, 0, True), (at + 326, 0, False), (at + 327, 0, True),
            (at, 163, False), (at, 164, True), (at, -163, False), (at, -164, True),
        ):  # fmt: skip
            assert is_one_run(hsw, first, then, stw) == is_left, (sign, stw, first, then)
        for hsw, is_left in ((814, True), (815, False)):
            assert is_one_run(sign * hsw & 0xFFFF, sign * hsw, 0) == is_left, (sign, hsw)
    for full_scale, first, is_left in ((1000, 980, False), (1000, 979, True), (1999, 962, False),
                                       (1999, 961, True), (0, 1000, True)):  # fmt: skip
        assert is_one_run(1000, first, 0, full_scale=full_scale) == is_left, (full_scale, first)


def exchange(drive, *hiws):
    """Its replies say that it runs, and these actual values."""
    reply = bytearray(16)
    put_word(reply, 11, RUNNING)
    for hiw in hiws:
        drive.fill(0)
        seal(drive.request, 1, 12)
        drive.sealed = True
        put_word(reply, 13, hiw)
        drive.take(reply, 16, 0)


def test_what_hiw_is_may_be_told_while_it_runs():
    drive = Drive(1, MASK)
    drive.tell_speed(0)
    exchange(drive, 0)
    drive.start(HALF)
    exchange(drive, HALF, 0)
    assert drive.is_on()
    drive.tell_speed(FULL)
    exchange(drive, HALF)
    assert drive.is_on()
    exchange(drive, 0)
    assert not drive.is_on()


def test_a_setpoint_that_was_foreseen_has_to_be_reached_as_well():
    drive = Drive(1, MASK)
    exchange(drive, 0)
    drive.start(HALF)
    exchange(drive, HALF)
    drive.hsw = HALF + 0x1000
    foreseen = drive.foresee(bytearray(16), False)
    assert foreseen[13:15] == bytes(((HALF + 0x1000) >> 8, 0))
    drive.follow(foreseen, 0)
    reply = bytearray(16)
    put_word(reply, 11, RUNNING)
    for hiw, is_on in ((0, True), (HALF + 0x1000, True), (0, False)):
        put_word(reply, 13, hiw)
        drive.take(reply, 16, 0)
        assert drive.is_on() == is_on, hiw


def test_a_motor_that_has_not_come_up_to_its_setpoint_is_left_alone():
    """It may be on its way, or be held below it by a limit of its own."""
    for reached in (0, word(0.1), word(0.47), word(0.53), -HALF & 0xFFFF):
        bus = running(hiw=reached)
        bus.hiw[1] = 0
        assert not is_taken_back(bus), hex(reached)
    for reached in (word(0.485), word(0.515)):
        bus = running(hiw=reached)
        bus.hiw[1] = 0
        assert is_taken_back(bus), hex(reached)


def test_a_standstill_that_was_told_is_none():
    """Below 5 % of the full scale, and on the way from one setpoint to another."""
    for part, taken in ((0, False), (0.049, False), (-0.049, False), (0.051, True), (-0.06, True)):
        bus = running(word(part))
        bus.hiw[1] = 0
        assert is_taken_back(bus) == taken, part
    bus = running()
    bus.drives[0].turn(pzd.ON_REVERSE)
    bus.run(EXCHANGE_US)
    bus.hiw[1] = 0
    assert not is_taken_back(bus)
    bus.hiw[1] = -HALF & 0xFFFF
    assert not is_taken_back(bus)
    bus.hiw[1] = 0
    assert is_taken_back(bus)


def test_a_new_setpoint_has_to_be_reached_once():
    bus = running()
    bus.drives[0].hsw = FULL
    bus.run(EXCHANGE_US)
    bus.hiw[1] = 0
    assert not is_taken_back(bus)
    bus.hiw[1] = FULL
    assert not is_taken_back(bus)
    bus.hiw[1] = 0
    assert is_taken_back(bus)


def test_bits_4_to_6_may_stop_it_and_let_it_go_on():
    """Their owner takes the setpoint away; that is no reason to take ON back."""
    for bit in (4, 5, 6):
        bus = running()
        bus.drives[0].control(1 << bit, False)
        bus.run(EXCHANGE_US)
        bus.hiw[1] = 0
        assert not is_taken_back(bus), bit
        bus.drives[0].control(1 << bit, True)
        assert not is_taken_back(bus), bit
        bus.hiw[1] = HALF
        assert not is_taken_back(bus), bit
        bus.hiw[1] = 0
        assert is_taken_back(bus), bit


def test_a_jog_has_no_setpoint_to_be_reached():
    bus = Bus()
    bus.run(200_000)
    bus.drives[0].start(HALF, pzd.JOG_RIGHT)
    bus.zsw[1] = RUNNING
    for hiw in (HALF, 0, HALF, 0):
        bus.hiw[1] = hiw
        assert not is_taken_back(bus)
    bus.zsw[1] = READY
    assert is_taken_back(bus)


def test_the_full_scale_may_be_another_and_the_actual_value_no_speed():
    """P2009 = 1: the words count in 0.01 Hz, and 100 % is P2000, here 50 Hz."""
    bus = Bus()
    bus.run(200_000)
    drive = bus.drives[0]
    for full_scale, hsw, rest, taken in (
        (5000, 250, 50, True),
        (5000, 250, 51, False),
        (5000, 249, 0, False),
        (0, HALF, 0, False),
    ):
        drive.tell_speed(full_scale)
        drive.stop()
        bus.zsw[1] = READY
        bus.run(3 * EXCHANGE_US)
        drive.start(hsw)
        bus.zsw[1] = RUNNING
        bus.hiw[1] = hsw
        bus.run(3 * EXCHANGE_US)
        bus.hiw[1] = rest
        assert is_taken_back(bus) == taken, (full_scale, hsw, rest)


def test_nothing_else_is_taken_for_a_standstill_at_any_setpoint():
    """Every hundredth word as a setpoint, reached to the count: only |HIW| <= 1 % counts."""
    bus = Bus()
    bus.run(200_000)
    drive = bus.drives[0]
    request = bytearray(20)
    for hsw in range(0, 0x10000, 397):
        for hiw in (0x7FFF, 0x8000, 164, -164 & 0xFFFF, 163, -163 & 0xFFFF):
            drive.start(hsw)
            for _ in range(2):  # the OFF of the round before goes first
                drive.fill(0)
            for value in (hsw, hiw):
                request[11], request[12] = RUNNING >> 8, RUNNING & 0xFF
                request[13], request[14] = value >> 8, value & 0xFF
                drive.take(request, 16, 0)
            magnitude = abs(pzd.signed(hsw))
            if abs(magnitude - 815) <= 1 or abs(magnitude - abs(pzd.signed(hiw))) <= 326:
                continue
            taken = abs(pzd.signed(hiw)) <= 163 and 2 * magnitude >= 5 * 326
            assert drive.stopped_by_engine() == taken, (hex(hsw), hex(hiw))
