# SPDX-License-Identifier: MIT
"""Who looks on at the line: how long things take there, and the last telegrams."""

from uss.finding.witness import CYCLE, KEPT, NEVER, RESPONSE_DELAY, START_DELAY, Witness
from uss.receiver import SILENT
from uss.telegram import GOOD

CHARACTER_US = 1_000
MASK = (1 << 30) - 1


class Exchange:
    """What the engine has of a drive and of its receiver when an exchange is over."""

    def __init__(self, request, sent_at, reply, heard_at):
        self.request, self.size, self.sent_at = request, len(request), sent_at
        self.buffer, self.count, self.heard_at = reply, len(reply), heard_at


class Line:
    """A slow line, which a witness looks at. Its clock begins anew while it does."""

    def __init__(self, address=None):
        self.witness = Witness(CHARACTER_US, MASK, address)
        self.now = MASK - 30_000

    def exchange(
        self, address, start_us=2_000, response_us=3_000, finding=GOOD, size=14, count=14
    ):
        request = bytes((2, size - 2, address)) + bytes(range(3, size))
        reply = bytes(range(100, 100 + count))
        sent_at = self.now + start_us + size * CHARACTER_US
        self.now = sent_at + response_us + count * CHARACTER_US
        over = Exchange(request, sent_at & MASK, reply, self.now & MASK)
        self.witness.note(over, finding, over)

    def times(self, place):
        """The shortest and the longest, in milliseconds."""
        shortest_us, longest_us = self.witness.times[place : place + 2]
        return shortest_us / 1000, longest_us / 1000


def test_the_shortest_and_the_longest_of_each_time_are_kept():
    line = Line()
    assert list(line.witness.times) == [NEVER] * 6
    line.exchange(1)
    assert list(line.witness.times) == [NEVER] * 4 + [3_000, 3_000]
    for start_us, response_us in ((2_000, 3_000), (1_500, 5_000), (4_000, 2_500), (3_000, 4_000)):
        line.exchange(1, start_us, response_us)
    assert line.times(START_DELAY) == (1.5, 4)
    assert line.times(RESPONSE_DELAY) == (2.5, 5)
    # From the end of a request to the end of the next: two telegrams, the reply, the pause.
    assert line.times(CYCLE) == (14 + 3 + 1.5 + 14, 14 + 5 + 4 + 14)


def test_who_looks_at_one_drive_sees_its_times_alone():
    line = Line(2)
    for _ in range(2):
        line.exchange(1, start_us=9_000, response_us=8_000)
        line.exchange(2, start_us=2_000, response_us=3_000)
    assert line.times(START_DELAY) == (2, 2) and line.times(RESPONSE_DELAY) == (3, 3)
    assert line.times(CYCLE) == (2 * 28 + 22, 2 * 28 + 22)


def test_who_looks_at_all_drives_sees_the_cycle_of_the_first_one():
    line = Line()
    for address in (3, 1, 1, 3, 1, 1, 1):
        line.exchange(address)
    assert line.times(CYCLE) == (3 * 33, 3 * 33)


def test_what_was_not_seen_is_not_measured():
    """There is no start delay behind a drive that was silent, nor a response delay of it."""
    line = Line()
    line.exchange(1, finding=SILENT)
    line.exchange(2, start_us=9_000, response_us=9_000, finding=SILENT, count=0)
    line.exchange(1)
    assert line.times(START_DELAY) == (0, 0) and line.times(RESPONSE_DELAY) == (3, 3)
    line.exchange(2)
    assert line.times(START_DELAY) == (2, 2)


def test_before_the_first_telegram_there_was_no_other():
    """Whatever the clock shows when somebody begins to look: no start delay, and no cycle."""
    for now in (0, 5_000, MASK >> 2, MASK - 1_000):
        line = Line()
        line.now = now
        line.exchange(1)
        assert line.times(START_DELAY) == line.times(CYCLE) == (NEVER, NEVER), now
        line.exchange(1)
        assert line.times(START_DELAY) == (2, 2) and line.times(CYCLE) == (33, 33), now


def test_a_time_of_zero_counts_and_one_below_zero_does_not():
    """The clock and the link tell instants a little too late, or too soon."""
    line = Line()
    line.exchange(1, response_us=-3)
    assert line.witness.times[RESPONSE_DELAY + 1] == NEVER
    line.exchange(1, response_us=0)
    assert list(line.witness.times[RESPONSE_DELAY : RESPONSE_DELAY + 2]) == [0, 1]
    line.exchange(1, response_us=700)
    line.exchange(1, response_us=-1)
    assert list(line.witness.times[RESPONSE_DELAY : RESPONSE_DELAY + 2]) == [0, 700]
    for response_us, is_one in ((MASK >> 1, True), ((MASK >> 1) + 1, False)):
        line = Line()
        line.exchange(1, response_us=response_us)
        wanted = response_us if is_one else NEVER
        assert line.witness.times[RESPONSE_DELAY + 1] == wanted, response_us


def test_the_last_telegrams_are_kept_as_far_as_there_is_room():
    line = Line(1)
    witness = line.witness
    assert witness.finding == -1 and witness.request_count == witness.reply_count == 0
    for size, count in ((50, 61), (14, 12), (KEPT, KEPT), (KEPT + 1, KEPT - 1), (14, 0)):
        line.exchange(1, size=size, count=count)
        assert (witness.request_count, witness.reply_count) == (size, count)
        request = (bytes((2, size - 2, 1)) + bytes(range(3, size)))[:KEPT]
        assert bytes(witness.request)[:size] == request
        assert bytes(witness.reply)[:count] == bytes(range(100, 100 + count))[:KEPT]
        assert len(witness.request) == len(witness.reply) == KEPT
    assert witness.finding == GOOD


def test_telegrams_of_another_drive_and_those_that_come_while_it_is_held_change_nothing():
    line = Line(1)
    witness = line.witness
    line.exchange(1, size=14, count=12)
    line.exchange(2, size=20, count=18, finding=SILENT)
    assert (witness.finding, witness.request_count, witness.reply_count) == (GOOD, 14, 12)
    witness.is_held = True
    line.exchange(1, size=20, count=18, finding=SILENT)
    assert (witness.finding, witness.request_count, witness.reply_count) == (GOOD, 14, 12)
    assert bytes(witness.request)[:3] == b"\x02\x0c\x01" and witness.reply[13] == 0
    witness.is_held = False
    line.exchange(1, size=20, count=18, finding=SILENT)
    assert (witness.finding, witness.request_count, witness.reply_count) == (SILENT, 20, 18)
