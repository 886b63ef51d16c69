# SPDX-License-Identifier: MIT
"""The telegram to a drive stands ready in a buffer, and only what has changed is written anew.

Whatever an operator, the line and the drive do: it must be the one that would be built from
scratch. A STOP that stayed out of it would be the worst of all defects.
"""

import random

from uss import pkw, pzd, telegram
from uss.drive import Drive
from uss.families import MM4
from uss.layout import Layout
from uss.receiver import SILENT
from uss.survey import Survey, spare_jobs

MASK = (1 << 30) - 1
LOST_US = 1_000_000
OFFS = (pzd.OFF1, pzd.OFF2, pzd.OFF3)
RUNS = (pzd.ON, pzd.ON_REVERSE, pzd.JOG_RIGHT, pzd.JOG_LEFT)
ZSWS = (0xFB31, 0xFB34, 0xFB34, 0xFB34, 0xFB78, 0xFB71)


class Pair:
    """The same happens to two drives. The second forgets its telegram before every exchange."""

    def __init__(self):
        self.drives = (Drive(5, MASK), Drive(5, MASK))
        self.now = 0

    def both(self, what, *arguments):
        for drive in self.drives:
            getattr(drive, what)(*arguments)

    def sent(self):
        """The two telegrams as they go on the line."""
        ready, anew = self.drives
        anew.steady = anew.sealed = anew.channel.idle = False
        for index in range(len(anew.request)):
            anew.request[index] = 0xEE
        anew._sent_stw = -1
        for drive in self.drives:
            drive.fill(self.now)
            if not drive.sealed:
                telegram.seal(drive.request, drive.address, drive.size - 4)
                drive.sealed = True
        return bytes(ready.request), bytes(anew.request)

    def answered(self, zsw):
        """A reply that answers the parameter task, if there is one, about every second time."""
        net = bytearray(16)
        asked = bytes(self.drives[0].request)
        if asked[3] >> 4 and random.randrange(2):
            net[3:11] = asked[3:11]
            net[3] = (1 << 4) | asked[3] & 0x07
        telegram.put_word(net, 11, zsw)
        for drive in self.drives:
            drive.take(net, 16, self.now)


def does_something(pair):
    """Something that may happen between two telegrams; mostly nothing does."""
    chance = random.randrange(40)
    if chance == 0:
        pair.both("start", random.randrange(0x4000), random.choice(RUNS))
    elif chance == 1:
        pair.both("stop", random.choice(OFFS))
    elif chance == 2:
        pair.both("turn", random.choice((pzd.ON, pzd.ON_REVERSE)))
    elif chance == 3:
        pair.both("acknowledge")
    elif chance == 4:
        pair.both("revoke")
    elif chance == 5:
        pair.both("lose")
    elif chance in (6, 7):
        hsw = random.randrange(0x4000)
        for drive in pair.drives:
            drive.hsw = hsw
    elif chance in (8, 9, 10):
        number = random.choice((700, 700, 1082, 2000))
        for drive in pair.drives:
            if not drive.channel.is_full():
                drive.ask(pkw.read(number))
    elif chance == 11:
        pair.both("hurry")


def test_the_telegram_that_stands_ready_is_the_one_that_would_be_built():
    kinds = set()
    for seed in range(40):
        random.seed(seed)
        pair = Pair()
        for step in range(500):
            for _ in range(random.randrange(3)):
                does_something(pair)
            ready, anew = pair.sent()
            assert ready == anew, (seed, step, ready, anew)
            kinds.add((ready[11] << 8 | ready[12], ready[3] >> 4))
            pair.now += random.choice((4_000, 4_000, 4_000, 400_000))
            if random.randrange(8):
                pair.answered(random.choice(ZSWS))
            else:
                pair.both("miss", 5, pair.now, LOST_US, MASK)
    for stw in OFFS + RUNS + (pzd.OFF1 | pzd.STW_ACKNOWLEDGE,):
        assert {(stw, 0), (stw, 1)} <= kinds, hex(stw)


def test_most_telegrams_are_not_built_at_all():
    pair = Pair()
    drive = pair.drives[0]
    for _ in range(3):
        pair.sent()
        pair.answered(0xFB31)
    assert drive.steady and drive.sealed and drive.channel.idle
    drive.stop()
    assert not drive.steady
    pair.sent()
    assert drive.request[12] == 0x7E


def test_a_drive_that_is_asked_for_everything_is_not_left_waiting():
    """Every row of the survey is asked for and answered, though the channel falls idle between."""
    drive = Drive(5, MASK)
    survey = Survey(drive, MM4, MASK, spare_jobs())
    net = bytearray(16)
    telegram.put_word(net, 11, 0xFB31)
    now = 0
    for _ in range(200):
        survey.step(now)
        drive.fill(now)
        net[3:11] = bytes(8)
        if drive.request[3] >> 4:
            net[3:11] = b"\x20" + drive.request[4:7] + b"\x42\x48\x00\x00"
            net[3] |= drive.request[3] & 0x07
        drive.take(net, 16, now)
        now += 4_000
    assert survey.complete


def test_words_that_were_written_half_are_written_anew():
    """The engine fails between STW and HSW, takes ON back and goes on: OFF1 has to be sent."""
    for failing_at in range(4):
        drive = ready_drive()
        drive.start(0x0CCD)
        paper = drive.request
        drive.request = Torn(paper, failing_at)
        try:
            drive.fill(0)
        except MemoryError:
            pass
        else:
            raise AssertionError("nothing failed")
        drive.request = paper
        drive.revoke()
        for _ in range(3):
            drive.fill(0)
            assert bytes(drive.request[11:15]) == b"\x04\x7e\x00\x00", drive.request


class Torn:
    """A buffer that takes so many characters and no more."""

    def __init__(self, buffer, takes):
        self._buffer = buffer
        self._left = takes

    def __setitem__(self, index, value):
        if not self._left:
            raise MemoryError
        self._left -= 1
        self._buffer[index] = value


def ready_drive():
    """A drive in contact that was sent OFF1 and has nothing else to be told."""
    drive = Drive(5, MASK)
    reply = bytearray(16)
    telegram.put_word(reply, 11, 0xFB31)
    telegram.seal(reply, 5, 12)
    for _ in range(3):
        drive.fill(0)
        drive.take(reply, 16, 0)
    return drive


def test_a_setpoint_that_is_no_word_is_refused():
    drive = ready_drive()
    for hsw, error in ((0x10000, ValueError), (-1, ValueError), (0.5, TypeError)):
        try:
            drive.start(hsw)
        except error:
            pass
        else:
            raise AssertionError(hsw)
        assert not drive.wanted


def test_each_change_is_in_the_very_next_telegram_of_a_drive_of_which_nothing_else_changes():
    drive = Drive(5, MASK, layout=Layout(4, 6))
    drive.take(bytes(24), 24, 0)
    drive.start(0x1000)
    reply = bytearray(24)
    telegram.put_word(reply, 11, 0xFB34)
    for change, place, word in (
        (lambda: None, 1, pzd.ON),
        (lambda: drive.turn(pzd.ON_REVERSE), 1, pzd.ON_REVERSE),
        (lambda: drive.turn(pzd.ON), 1, pzd.ON),
        (lambda: drive.control(0x0010, False), 1, 0x046F),
        (lambda: drive.control(0x8000, True), 1, 0x846F),
        (lambda: drive.control(0x0010, True), 1, 0x847F),
        (lambda: drive.control(0x8000, False), 1, pzd.ON),
        (lambda: drive.put(3, 0x1234), 3, 0x1234),
        (lambda: drive.put(6, 0x4321), 6, 0x4321),
        (lambda: drive.start(0x2000, pzd.JOG_LEFT), 1, pzd.JOG_LEFT),
        (lambda: drive.stop(), 1, pzd.OFF1),
        (lambda: drive.stop(pzd.OFF2), 1, pzd.OFF2),
        (lambda: drive.acknowledge(), 1, pzd.OFF2 | pzd.STW_ACKNOWLEDGE),
        (lambda: drive.start(0x30FF), 2, 0x30FF),
        (lambda: setattr(drive, "hsw", 0xFE01), 2, 0xFE01),
        (lambda: drive.stop(), 2, 0),
    ):
        for _ in range(3):
            drive.fill(0)
            drive.take(reply, 24, 0)
        change()
        drive.fill(0)
        assert telegram.get_word(drive.request, 9 + 2 * place) == word, (place, word)
        drive.take(reply, 24, 0)
    assert drive.answered_off() and not drive.is_on()
    # What was put stands in another layout as far as there is a place for it.
    for pkw_words, *expected in (
        (4, 0x1234, 0, 0, 0x4321, 0, 0), (4, 0x1234, 0, 0, 0x4321), (4, 0x1234), (3, 0x1234, 0),
        (0,), (4, 0, 0),
    ):  # fmt: skip
        pzd_words = 2 + len(expected)
        drive.miss(SILENT, 0, LOST_US, MASK)
        drive.become(Drive(5, MASK, layout=Layout(pkw_words, pzd_words)))
        assert drive.silent == drive.status == 0  # it has missed no telegram of this layout
        drive.fill(0)
        size = 2 * (pkw_words + pzd_words) + 4
        assert drive.size == size == len(drive.request)
        words = [telegram.get_word(drive.request, at) for at in range(3, size - 1, 2)]
        assert words == [0] * pkw_words + [pzd.OFF1, 0] + expected
        drive.take(bytes(size), size, 0)


def ready_and_sealed(address=5):
    """A drive in contact of which nothing is changing; its last telegram is whole."""
    drive = Drive(address, MASK)
    for _ in range(2):
        drive.fill(0)
        telegram.seal(drive.request, address, 12)
        drive.sealed = True
        drive.take(bytes(16), 16, 0)
    return drive


def test_a_telegram_is_foreseen_only_where_it_is_whole_and_to_the_same_address():
    room = bytearray(16)
    drive = ready_and_sealed()
    assert drive.foresee(room, False) is drive.request
    drive.sealed = False
    assert drive.foresee(room, False) is None
    for address in (3, 7):
        drive = ready_and_sealed()
        drive.move(address)
        assert drive.foresee(room, False) is None
    drive = ready_and_sealed()
    drive.stop()
    assert drive.foresee(room, False) is None


def test_a_start_ends_the_repetitions_of_a_stop():
    drive = ready_and_sealed()
    assert not drive.stopped_by_engine()
    drive.stop()
    drive.fill(0)
    drive.miss(SILENT, 0, LOST_US, MASK)
    assert drive.urgency() == 1 and not drive.stopped_by_engine()
    drive.start(0x1000)
    drive.fill(0)
    assert drive.urgency() == 0 and drive.is_on()
    drive.revoke()
    assert drive.stopped_by_engine()
    drive.stop()
    assert not drive.stopped_by_engine()
