# SPDX-License-Identifier: MIT
"""Data sheet of the simulated line at a port: what a master there may do, and what it costs.

At 19200 baud a character takes 573 us, a telegram of 16 characters 9.2 ms.
"""

from boards.port.clock import RealClock
from boards.port.line import PortMaster, PtyMaster
from boards.sim.clock import Clock
from boards.sim.dice import Dice
from boards.sim.drives.drive import Drive
from boards.sim.line.faults import LineFaults
from boards.sim.line.wire import Wire

READ_P0700 = b"\x02\x0e\x01\x12\xbc\x00\x00\x00\x00\x00\x00\x04\x7e\x00\x00\xd9"
WRITE_P2011 = b"\x02\x0e\x01\x20\x0b\x80\x00\x00\x00\x00\x07\x04\x7e\x00\x00\xdb"  # address 7
TELEGRAM_US = 9_166
CHARACTER_US = 573
REPLY_US = 3 * CHARACTER_US  # the drive's delay
GOOD, REJECTED, PARITY, START = 2024, 2025, 2028, 2029


class Line:
    """A drive, and a master at a port of this kind; `said` is what has been written to it."""

    def __init__(self, kind, addresses=(1,), baud=19200):
        self.clock = Clock()
        self.wire = Wire(self.clock, baud)
        self.drives = [Drive(self.clock, self.wire, address) for address in addresses]
        self.said = []
        self.notes = []
        self.seen = []  # the address of the drive when each of these began
        self.master = kind(self.wire, self._written, self._noted, self._look)
        self.clock.advance(100_000)

    def _written(self, data):
        self.said.append((self.clock.now_us, data))

    def _noted(self, burst, from_master, seen):
        self.notes.append((burst.start_us, from_master, burst.count))
        self.seen.append(seen)

    def _look(self):
        return self.drives[0].address

    def gets(self, data, flaws=None):
        self.master.received(data, flaws)

    def counts(self, *numbers):
        return [self.drives[0].read(number) for number in numbers]

    def answers(self):
        """How many replies have been written since the last question."""
        count = len(self.said)
        self.said = []
        return count


def test_on_a_pty_a_telegram_takes_its_time_on_the_simulated_line():
    line = Line(PtyMaster)
    began_us = line.clock.now_us
    line.gets(READ_P0700)
    line.clock.advance(100_000)
    ((at_us, reply),) = line.said
    assert reply[:2] == b"\x02\x0e" and len(reply) == 16
    expected_us = began_us + 2 * TELEGRAM_US + REPLY_US
    assert expected_us <= at_us <= expected_us + 10


def test_at_a_low_rate_the_reply_begins_to_come_before_it_is_over():
    line = Line(PtyMaster, baud=1200)
    line.gets(READ_P0700)
    line.clock.advance(1_000_000)
    came_us = [at_us for at_us, _ in line.said]
    reply = b"".join(data for _, data in line.said)
    assert reply[:2] == b"\x02\x0e" and len(reply) == 16
    assert max(b - a for a, b in zip(came_us, came_us[1:])) < 30_000
    assert came_us[-1] - came_us[0] > 100_000  # 147 ms on the line
    line.gets(READ_P0700)
    line.clock.advance(1_000_000)
    assert b"".join(data for _, data in line.said) == 2 * reply


def test_behind_a_port_the_line_has_taken_the_time_already():
    line = Line(PortMaster)
    began_us = line.clock.now_us
    line.gets(READ_P0700)
    line.clock.advance(100_000)
    ((at_us, reply),) = line.said
    assert len(reply) == 16 and at_us <= began_us + REPLY_US + 10


def test_a_telegram_may_come_character_by_character():
    for kind, pause_us in ((PtyMaster, CHARACTER_US), (PortMaster, CHARACTER_US)):
        line = Line(kind)
        for character in READ_P0700:
            line.gets(bytes((character,)))
            line.clock.advance(pause_us)
        line.clock.advance(100_000)
        assert line.answers() == 1, kind
        assert line.counts(GOOD, REJECTED) == [1, 0]


def test_an_adapter_may_keep_half_of_it_back_for_16_ms():
    line = Line(PortMaster)
    line.gets(READ_P0700[:7])
    line.clock.advance(16_000)
    line.gets(READ_P0700[7:])
    line.clock.advance(100_000)
    assert line.answers() == 1 and line.counts(GOOD, REJECTED) == [1, 0]


def test_half_a_telegram_is_none_and_the_next_one_is_good():
    for kind in (PtyMaster, PortMaster):
        line = Line(kind)
        line.gets(READ_P0700[:7])
        line.clock.advance(200_000)
        assert line.answers() == 0
        line.gets(READ_P0700)
        line.clock.advance(100_000)
        assert line.answers() == 1 and line.counts(GOOD) == [1], kind


def test_two_telegrams_at_once_have_no_pause_between_them():
    for kind in (PtyMaster, PortMaster):
        line = Line(kind)
        line.gets(2 * READ_P0700)
        line.clock.advance(200_000)
        assert line.answers() == 1
        assert line.counts(GOOD, REJECTED, START) == [1, 1, 1], kind


def test_a_master_that_is_too_fast_behind_a_reply_is_waited_for():
    line = Line(PtyMaster)
    for _ in range(5):
        line.gets(READ_P0700)
        while not line.said:
            line.clock.advance(100)
        line.answers()
    assert line.counts(GOOD, REJECTED) == [5, 0]
    assert not line.wire.violations()


def test_who_talks_into_a_reply_loses_both_and_hears_nothing_that_was_not_said():
    line = Line(PtyMaster)
    line.gets(READ_P0700)
    line.clock.advance(TELEGRAM_US + REPLY_US + 2_000)
    line.gets(READ_P0700)
    line.clock.advance(100_000)
    ((_, heard),) = line.said
    assert len(heard) == 3  # so many were over
    assert line.counts(GOOD) == [1]
    line.answers()
    line.gets(READ_P0700)
    line.clock.advance(100_000)
    ((_, reply),) = line.said
    assert reply[:3] == heard and len(reply) == 16
    assert line.counts(GOOD) == [2]


def test_nor_does_he_at_a_low_rate_where_the_reply_comes_in_pieces():
    line = Line(PtyMaster, baud=1200)
    line.gets(READ_P0700)
    line.clock.advance(1_000_000)
    reply = b"".join(data for _, data in line.said)
    line.answers()
    line.gets(READ_P0700)
    line.clock.advance(16 * TELEGRAM_US + 16 * REPLY_US + 50_000)
    line.gets(READ_P0700)
    line.clock.advance(1_000_000)
    heard = b"".join(data for _, data in line.said)
    assert 3 <= len(heard) < 8 and reply.startswith(heard)


def test_a_character_with_a_wrong_bit_is_not_handed_over():
    for kind, request_us in ((PtyMaster, TELEGRAM_US), (PortMaster, 0)):
        line = Line(kind)
        faults = LineFaults(line.wire, Dice(7, 1).random)
        line.gets(READ_P0700)
        line.clock.advance(request_us + 100)
        faults.strike("flip", 1)
        line.clock.advance(100_000)
        ((_, heard),) = line.said
        assert len(heard) == 15, kind


def test_what_was_seen_when_a_telegram_began_is_told_when_it_is_over():
    for kind in (PtyMaster, PortMaster):
        line = Line(kind)
        line.gets(WRITE_P2011)
        line.clock.advance(100_000)
        assert line.answers() == 1 and line.drives[0].address == 7
        line.gets(READ_P0700)
        line.clock.advance(100_000)
        assert line.seen == [1, 1, 7], kind


def test_garbage_is_counted_once_and_hurts_nobody():
    for kind in (PtyMaster, PortMaster):
        line = Line(kind)
        for _ in range(20):
            line.gets(b"\x55")
            line.clock.advance(CHARACTER_US)
        line.clock.advance(100_000)
        assert line.counts(GOOD, REJECTED, START) == [0, 1, 1], kind
        line.gets(READ_P0700)
        line.clock.advance(100_000)
        assert line.counts(GOOD) == [1], kind


def test_a_second_after_a_flood_the_drive_answers():
    flood = bytes(range(256)) * 16
    for baud in (9600, 19200, 115200):
        line = Line(PtyMaster, baud=baud)
        for _ in range(20):  # 80 kB, which are 84 s of a line at 9600
            line.gets(flood)
            line.clock.advance(10_000)
        assert line.master.lost > 70_000
        line.clock.advance(1_000_000)
        line.gets(READ_P0700)
        line.clock.advance(100_000)
        assert line.counts(GOOD) == [1], baud


def test_what_a_line_has_time_for_is_not_lost():
    for baud in (1200, 19200):
        line = Line(PtyMaster, baud=baud)
        line.gets(bytes(256))  # the longest telegram there is
        assert line.master.lost == 0
        line.clock.advance(10_000_000)
        assert sum(count for _, _, count in line.notes) == 256


def test_a_wrong_parity_bit_spoils_the_telegram():
    line = Line(PortMaster)
    line.gets(READ_P0700, bytes(5) + b"\x01" + bytes(10))
    line.clock.advance(100_000)
    assert line.answers() == 0
    assert line.counts(GOOD, REJECTED, PARITY) == [0, 1, 1]


def test_what_an_adapter_echoes_is_no_request():
    line = Line(PortMaster)
    line.gets(READ_P0700)
    line.clock.advance(3_000)
    ((_, reply),) = line.said
    line.gets(reply[:5])
    line.clock.advance(12_000)
    line.gets(reply[5:] + READ_P0700)
    line.clock.advance(100_000)
    assert line.answers() == 2
    assert line.counts(GOOD, REJECTED) == [2, 0]


def test_an_unplugged_drive_cuts_its_reply():
    line = Line(PtyMaster)
    line.gets(READ_P0700)
    line.clock.advance(TELEGRAM_US + REPLY_US + 5 * CHARACTER_US + 10)
    line.drives[0].unplug()
    ((_, reply),) = line.said
    assert len(reply) == 5


def test_every_telegram_is_told_when_it_is_over():
    line = Line(PtyMaster)
    line.gets(READ_P0700)
    line.clock.advance(100_000)
    (asked_us, from_master, count), (answered_us, from_drive, _) = line.notes
    assert from_master and not from_drive and count == 16
    assert asked_us < answered_us


def test_the_clock_follows_a_true_one_and_may_be_ahead_of_it():
    true = [5_000_000]
    clock = RealClock(lambda: true[0])
    assert clock.now_us == 0
    true[0] += 1_500
    assert clock.ticks_us() == 1_500 and clock.ticks_ms() == 1
    clock.sleep_us(100)
    assert clock.now_us == 1_600
    clock.follow()
    assert clock.now_us == 1_600
    true[0] += 200
    clock.follow()
    assert clock.now_us == 1_700


def test_the_clock_tells_how_long_nothing_happens():
    true = [0]
    clock = RealClock(lambda: true[0])
    wire = Wire(clock, 19200)
    Drive(clock, wire, 1)
    assert clock.next_us() == 1_000_000
    master = PtyMaster(wire, lambda data: None)
    master.received(READ_P0700)
    assert 0 < clock.next_us() <= TELEGRAM_US
    true[0] += 20_000
    assert clock.next_us() == 0
