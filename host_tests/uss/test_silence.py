# SPDX-License-Identifier: MIT
"""Drives that do not answer cost the others a fifth of the line's time at the most, all together.

A telegram that nobody answers takes as long as the reply is waited for: 20 ms by the
specification, 60 ms and more behind a USB adapter. Drives that run go before that: two telegrams
to one of them are less than a third of its telegram-off time apart.
"""

from round_bench import Bench, Node
from uss import pkw
from uss.outside import Mirror
from uss.silence import SPENT_MASK
from uss.timing import Timing

TIMEOUTS_MS = (20, 60, 500)
PRESENT = 2
LISTED = 31
MINUTE_US = 60_000_000


class SlowTiming(Timing):
    """That of a line on which replies are waited for longer."""

    timeout_ms = 20

    def __init__(self, baud):
        Timing.__init__(self, baud, self.timeout_ms * 1000)


def bench_of(timeout_ms, present=PRESENT, listed=LISTED, **more):
    """A bus on which only the first few drives of the list are there."""
    import round_bench

    SlowTiming.timeout_ms = timeout_ms
    round_bench.Timing = SlowTiming
    try:
        bench = Bench([Node(address) for address in range(1, listed + 1)], **more)
    finally:
        round_bench.Timing = Timing
    for address in range(present + 1, listed + 1):
        bench.nodes[address].plugged = False
    bench.contact()
    return bench


class Moody(Node):
    """Silent on every second telegram."""

    calls = 0

    def answer(self, characters):
        reply = Node.answer(self, characters)
        if reply:
            self.calls += 1
        return reply if self.calls % 2 else None


def silence_us(bench):
    """What a telegram takes that nobody answers."""
    timing = bench.timing
    waited_us = timing.reply_timeout_us + timing.character_us
    return timing.start_interval_us + timing.telegram_us(12) + waited_us


def spent_us(bench, since, until=None):
    """Time of the line between two places of the log that went to drives that are not there."""
    sent = bench.sent[since:until]
    total_us = 0
    for telegram, following in zip(sent, sent[1:]):
        if telegram.address in bench.nodes and not bench.nodes[telegram.address].plugged:
            total_us += following.at - telegram.at
    return total_us, sent[-1].at - sent[0].at


def gaps(bench, address, since):
    instants = [telegram.at for telegram in bench.sent[since:] if telegram.address == address]
    return [after - before for before, after in zip(instants, instants[1:])]


def started(bench, address, off_time_ms):
    bench.master.deadlines.supervise(bench.drives[address], off_time_ms)
    bench.drives[address].start(0x1000)
    bench.run(1_000_000)
    assert bench.nodes[address].zsw == 0xFB34
    return len(bench.sent)


# --- the share ----------------------------------------------------------------------------------


def test_together_they_take_a_fifth_of_the_lines_time():
    for timeout_ms in TIMEOUTS_MS:
        bench = bench_of(timeout_ms)
        bench.run(1_000_000)
        since = len(bench.sent)
        bench.run(MINUTE_US)
        spent, total_us = spent_us(bench, since)
        print("%d ms: %.1f %%" % (timeout_ms, 100 * spent / total_us))
        assert spent < total_us // 5 + 2 * silence_us(bench), (timeout_ms, spent, total_us)
        assert spent > total_us // 7, (timeout_ms, spent, total_us)  # and they have it


def test_those_that_were_never_heard_do_not_hold_up_the_first_that_answers():
    """From the first reply on: the list is not worked through before."""
    bench = bench_of(500, present=1)
    since = len(bench.sent)
    bench.run(10_000_000)
    assert max(gaps(bench, 1, since)) < 1_100_000
    assert bench.addresses(since).count(1) > 100


def test_where_nobody_answers_and_nobody_may_run_the_line_is_all_theirs():
    bench = bench_of(60, present=0, listed=5)
    bench.run(3_000_000)
    since = len(bench.sent)
    bench.run(3_000_000)
    assert len(bench.sent) - since > 3_000_000 // (silence_us(bench) + 5_000)
    assert set(bench.addresses(since)) == {1, 2, 3, 4, 5}


def test_those_that_are_switched_on_together_are_found_one_behind_the_other():
    """A drive that answers owes nothing."""
    bench = bench_of(60)
    bench.run(20_000_000)
    for node in bench.nodes.values():
        node.plugged = True
    began = bench.now
    bench.run_until(lambda: all([drive.contact for drive in bench.master.turns.drives]))
    assert bench.now - began < 2_500_000


def test_each_of_them_is_found_within_five_seconds_or_what_the_share_allows():
    for timeout_ms in TIMEOUTS_MS:
        bench = bench_of(timeout_ms)
        bench.run(3_000_000)
        started(bench, 1, 2_000)
        allowed_us = max(5_000_000, 5 * (LISTED - PRESENT) * silence_us(bench) * 101 // 100)
        for address in (3, 17, 31):
            bench.run(2_345_678)
            bench.nodes[address].plugged = True
            began = bench.now
            bench.run_until(lambda: bench.drives[address].contact, allowed_us)
            print("%d ms, A%d: %d ms" % (timeout_ms, address, (bench.now - began) // 1000))


def test_they_are_found_beside_one_that_may_run_and_is_silent():
    """Its turns are its own: it does not use up what the others share."""
    bench = bench_of(60, present=1, listed=5)
    bench.run(3_000_000)
    started(bench, 1, 2_000)
    bench.nodes[1].plugged = False
    bench.run(5_000_000)
    assert bench.drives[1].was_running
    since = len(bench.sent)
    bench.run(20_000_000)
    for address in (2, 3, 4, 5):
        assert max(gaps(bench, address, since)) < 5_000_000
    assert max(gaps(bench, 1, since)) < 333_333
    bench.nodes[4].plugged = True
    bench.run_until(lambda: bench.drives[4].contact, 5_000_000)


def test_one_that_was_found_does_not_keep_the_turn_of_the_others():
    """It is the only one in the round by then: whenever the loop looks, it is being asked."""
    bench = bench_of(20, present=1, listed=3)
    bench.run(3_000_000)
    found, is_under_way = bench.drives[2], bench.master.turns.is_under_way
    bench.master.turns.is_under_way = lambda drive: (
        drive is found and drive.contact or is_under_way(drive)
    )
    bench.nodes[2].plugged = True
    bench.run_until(lambda: found.contact, 5_000_000)
    bench.nodes[1].plugged = False
    bench.run_until(lambda: not bench.drives[1].contact, 3_000_000)
    since = len(bench.sent)
    bench.run(20_000_000)
    for address in (1, 3):
        assert bench.addresses(since).count(address) > 5, address


def test_a_stop_of_all_is_repeated_three_times_to_those_that_rest():
    """Ahead of their share; then they have that again."""
    bench = bench_of(60)
    bench.run(3_000_000)
    since = len(bench.sent)
    bench.master.stop_all()
    bench.run(MINUTE_US)
    spent, total_us = spent_us(bench, since)
    stops_us = 4 * (LISTED - PRESENT) * silence_us(bench)
    print("%.1f s, of them %.1f s for the STOP" % (spent / 1e6, stops_us / 1e6))
    assert spent < total_us // 5 + stops_us
    told = bench.addresses(since)[: 8 * LISTED]
    for address in range(PRESENT + 1, LISTED + 1):
        assert told.count(address) >= 4, address


def test_what_waits_for_a_drive_that_is_gone_gives_it_no_more_turns():
    bench = bench_of(60)
    for address in (3, 4, 5):
        bench.drives[address].want_turns(True)
    bench.run(3_000_000)
    since = len(bench.sent)
    bench.run(20_000_000)
    spent, total_us = spent_us(bench, since)
    assert spent < total_us // 5 + 2 * silence_us(bench)


def test_a_drive_that_the_list_spares_keeps_no_turn_from_the_silent_ones_and_comes_back_at_once():
    """It answers; but somebody else asks it just now."""
    bench = bench_of(20, listed=4)
    bench.run(3_000_000)
    silence, drive = bench.master.deadlines.silence, bench.drives[2]
    silence.spare(drive)
    since = len(bench.sent)
    bench.run(5_000_000)
    asked = bench.addresses(since)
    assert asked[1:].count(2) == 0 and asked.count(3) > 5 and asked.count(4) > 5
    assert silence.rests[2]
    silence.spare(None)
    assert not silence.rests[2]
    bench.run(50_000)
    assert 2 in bench.addresses()[-3:]


def test_whom_the_list_spares_rests_at_once_unless_it_may_run_and_comes_back_at_once():
    bench = bench_of(20, listed=4)
    bench.run(3_000_000)
    turns, drives = bench.master.turns, bench.drives
    silence = bench.master.deadlines.silence

    def resting():
        asked = turns.round[: turns.round_count]
        assert [drive for drive in turns.list if not silence.rests[drive.address]] == asked
        assert silence.resting == sum(silence.rests)
        return [address for address in range(32) if silence.rests[address]]

    assert resting() == [3, 4]
    for spared, wanted in ((1, [1, 3, 4]), (1, [1, 3, 4]), (2, [2, 3, 4]), (None, [3, 4])):
        silence.spare(drives.get(spared))
        assert resting() == wanted and silence.spared is drives.get(spared)
    drives[1].start(0x1000)
    silence.spare(drives[1])
    assert resting() == [3, 4]
    silence.spare(drives[2])
    turns.remove(drives[2])  # and another one gets its address
    turns.add(2)
    drives[2].contact, drives[2].silent = False, 5
    assert resting() == [3, 4]
    silence.spare(None)
    assert resting() == [3, 4]


def test_those_that_rest_are_asked_in_turn_when_there_is_room():
    """One at a time: the next one when that telegram is over, by its silence or by an answer."""
    bench = bench_of(20, present=1, listed=5)
    bench.run(3_000_000)
    turns, silence = bench.master.turns, bench.master.deadlines.silence
    silent = [bench.drives[address] for address in (2, 3, 4, 5)]
    bench.refreshing = False  # nobody else gives turns
    bench.run(100_000)

    def given():
        return [drive.address for drive in silent if drive.insist]

    order = []
    for _ in range(8):
        silence.wait_us = 1
        silence.give_turn()
        assert given() == [], "time is owed"
        silence.wait_us = -(len(order) & 1)
        silence.give_turn()
        for _ in range(2):
            silence.give_turn()
            assert len(given()) == 1, given()
        order += given()
        bench.run(200_000)
        assert given() == [] and not turns.is_under_way(silent[0])
        silence.give_turn()  # this one sees that it is over
        assert given() == []
    first = order.index(2)
    assert order[first : first + 5] == [2, 3, 4, 5, 2] and set(order) == {2, 3, 4, 5}, order


def test_a_drive_that_was_removed_holds_up_nobody_any_more():
    """Not in the middle of its turn either; and who asks addresses that are not listed waits for
    their share, not for its next turn."""
    bench = bench_of(20, present=1, listed=3)
    bench.run(5_000_000)
    bench.run_until(lambda: bench.addresses()[-1] == 2)
    bench.master.turns.remove(bench.drives[2])
    since = len(bench.sent)
    bench.run(5_000_000)
    assert bench.addresses(since).count(3) > 5 and bench.addresses(since)[2:].count(2) == 0
    bench.run_until(lambda: bench.addresses()[-1] == 3)
    bench.run(1_000_000)
    bench.master.turns.remove(bench.drives[3])
    waits = []
    for address in (7, 8, 9):
        mirror = Mirror(address, bytes(12))
        bench.master.turns.post(mirror)
        bench.run_until(lambda: mirror.state == pkw.TIMED_OUT)
        bench.run(50_000)
        waits.append(bench.master.deadlines.silence_wait_us())
        bench.run(1_000_000)
    assert 0 < max(waits) < 10 * silence_us(bench), waits


def test_what_a_silence_costs_is_charged_to_who_has_not_answered():
    """All of it is counted; but the share pays nothing for a drive that may run, except for
    telegrams outside the list."""
    bench = bench_of(20, listed=4)
    bench.run(1_000_000)
    silence, running, silent = bench.master.deadlines.silence, bench.drives[1], bench.drives[3]
    running.was_running = True
    beside = Mirror(1, bytes(12))
    mask = SPENT_MASK
    silence.count, silence.spent_us, silence.shared_us = 0xFFFD, mask - 2_000, mask - 1_500
    for drive, us, count, spent, shared in (
        (silent, 500, 0xFFFE, mask - 1_500, mask - 1_000),
        (running, 700, 0xFFFF, mask - 800, mask - 1_000),
        (beside, 801, 0, 0, mask - 199),
        (silent, 199, 1, 199, mask),
        (silent, 40_001, 2, 40_200, 40_000),
    ):
        silence.charge(drive, us)
        counted = silence.count, silence.spent_us, silence.shared_us
        assert counted == (count, spent, shared), (drive, counted)


def test_what_is_owed_for_a_silence_is_five_times_what_it_took_and_two_silences_at_the_most():
    """Room that was not used counts, as much as two silences take, and no more."""
    bench = bench_of(20, listed=4)
    bench.run(1_000_000)
    silence, drive = bench.master.deadlines.silence, bench.drives[3]
    one_us = silence_us(bench)
    assert silence.silent_exchange_us == one_us
    for each in bench.drives.values():
        each.silent = 3
    for before_us, spent_us, wait_us in (
        (0, 1_000, 5_000), (7, 1_000, 5_007), (-7, 1_000, 4_993), (0, 0, 0),
        (-2 * one_us, 1_000, 5_000 - 2 * one_us), (-2 * one_us - 1, 1_000, 5_000 - 2 * one_us),
        (1 - 2 * one_us, 1_000, 5_001 - 2 * one_us), (-9_000_000, 1_000, 5_000 - 2 * one_us),
        (-2 * one_us, one_us, 3 * one_us), (0, 2 * one_us - 1, 10 * one_us - 5),
        (0, 2 * one_us, 10 * one_us), (0, 2 * one_us + 1, 10 * one_us),
        (9 * one_us, one_us, 10 * one_us), (0, 1 << 29, 10 * one_us),
    ):  # fmt: skip
        for charged_us in (0, SPENT_MASK, SPENT_MASK - 500):
            silence.charged_us = silence.shared_us = charged_us
            silence.charge(drive, spent_us)
            silence.wait_us = before_us
            silence.settle()
            assert silence.wait_us == wait_us, (before_us, spent_us, silence.wait_us)
            assert silence.charged_us == silence.shared_us


def test_few_that_stay_silent_are_asked_once_in_seven_tenths_of_a_second():
    """All of them together; one that is silent for the first times does not wait for that."""
    for listed in (3, 4, 6, 31):
        bench = bench_of(20, listed=listed)
        bench.run(5_000_000)
        silence = bench.master.deadlines.silence
        assert silence.resting == listed - PRESENT
        for silent, wait_us in ((3, 5_000), (4, max(700_000 // (listed - PRESENT), 5_000))):
            for address in range(PRESENT + 1, listed + 1):
                bench.drives[address].silent = silent
            silence.wait_us = 0
            silence.charged_us = silence.shared_us
            silence.charge(bench.drives[3], 1_000)
            silence.settle()
            assert silence.wait_us == wait_us, (listed, silent, silence.wait_us)


def test_nothing_is_owed_where_nobody_loses_time_by_it():
    """The last one that answers does, and one that may run; and it begins with nothing again."""
    for contact, was_running, wait_us in (
        (True, False, 5_500), (False, True, 5_500), (True, True, 5_500), (False, False, 0),
    ):  # fmt: skip
        bench = bench_of(20, present=2, listed=2)
        silence = bench.master.deadlines.silence
        for address in (1, 2):
            one, other = bench.drives[address], bench.drives[3 - address]
            other.contact = other.was_running = False
            one.contact, one.was_running = contact, was_running
            silence.wait_us = 500
            silence.charged_us = silence.shared_us
            silence.charge(Mirror(9, bytes(12)), 1_000)
            silence.settle()
            assert silence.wait_us == wait_us, (contact, was_running, address)
            assert silence.charged_us == silence.shared_us


def test_a_drive_that_was_never_asked_has_a_turn_before_it_rests_unless_time_is_owed():
    for wait_us, silent, contact, was_running, rests in (
        (0, 0, False, False, 0), (-1, 0, False, False, 0), (1, 0, False, False, 1),
        (0, 1, False, False, 1), (1, 1, True, False, 0), (1, 1, False, True, 0),
    ):  # fmt: skip
        bench = bench_of(20)
        silence = bench.master.deadlines.silence
        drive = bench.master.turns.add(0)
        resting = silence.resting
        drive.silent, drive.contact, drive.was_running = silent, contact, was_running
        silence.wait_us = wait_us
        for _ in range(2):
            silence.look_after(drive)
            assert silence.rests[0] == rests, (wait_us, silent, contact, was_running)
            assert silence.resting == resting + rests
        silence.wait_us = 0
        drive.silent = 0
        silence.look_after(drive)
        assert silence.rests[0] == rests, "one that rests goes on until something changes"
        for other in bench.master.turns.drives:
            other.contact = other.was_running = False
        silence.look_after(drive)
        assert not silence.rests[0], "where nobody answers, nobody rests"


# --- drives that run ----------------------------------------------------------------------------


def test_a_drive_that_runs_has_its_telegrams_beside_29_silent_ones():
    for timeout_ms, off_time_ms in ((20, 0), (20, 600), (60, 0), (60, 2_000), (500, 2_000)):
        bench = bench_of(timeout_ms)
        since = started(bench, 1, off_time_ms)
        bench.run(MINUTE_US)
        longest_us = max(gaps(bench, 1, since))
        third_us = (off_time_ms or 1_000) * 1000 // 3
        print("%d ms, P2014 = %d: %d ms" % (timeout_ms, off_time_ms, longest_us // 1000))
        assert longest_us < third_us, (timeout_ms, off_time_ms, longest_us)
        assert bench.drives[1].is_on()


def test_a_silence_that_would_be_longer_than_that_is_not_risked():
    """Half a second, beside a drive that trips after one: the silent ones have to wait."""
    bench = bench_of(500)
    bench.run(5_000_000)
    assert bench.master.deadlines.first_late(bench.drives[1]) is None  # it never trips
    since = started(bench, 1, 1_000)
    assert bench.master.deadlines.first_late(bench.drives[1]) is bench.drives[1]
    bench.run(10_000_000)
    assert set(bench.addresses(since)) == {1, 2}
    assert max(gaps(bench, 1, since)) < 333_333
    bench.nodes[31].plugged = True
    bench.drives[1].stop()
    bench.run_until(lambda: bench.drives[31].contact, 5 * 29 * silence_us(bench))


def test_who_never_trips_is_late_beside_nobody():
    bench = bench_of(500)
    deadlines, drives = bench.master.deadlines, bench.drives
    started(bench, 2, 0)
    bench.run(1_000_000)
    assert deadlines.gap_us(drives[1]) > bench.master.turns.lost_us // 3
    assert deadlines.bound_us(drives[1]) == bench.master.turns.lost_us // 3
    assert deadlines.first_late(drives[1]) is None
    deadlines.supervise(drives[1], 1_000)
    assert deadlines.bound_us(drives[1]) == 1_000_000 // 3
    assert deadlines.first_late(drives[1]) is drives[1]


def test_one_that_never_trips_may_be_late_now_and_then_for_their_sake():
    """It is lost after 0.3 s, and is to be asked three times in that; a silence takes longer."""
    bench = bench_of(90, listed=6)
    bench.master.turns.lost_us = 300_000
    bench.run(3_000_000)
    since = started(bench, 1, 0)
    bench.run(20_000_000)
    late = [gap_us for gap_us in gaps(bench, 1, since) if gap_us > 100_000]
    assert 4 < len(late) < 20 and max(late) < 200_000, late
    for address in (3, 4, 5, 6):
        assert max(gaps(bench, address, since)) < 4 * (1_000_000 + 6 * silence_us(bench)), address
    assert bench.drives[1].is_on()


def test_where_they_are_too_many_for_their_bound_the_silent_ones_are_still_asked():
    """Thirty that run, a third of a second each: the line cannot carry that, and says so."""
    bench = bench_of(20, present=30)
    for address in range(1, 31):
        bench.master.deadlines.supervise(bench.drives[address], 1_000)
        bench.drives[address].start(0x1000)
    bench.run(3_000_000)
    assert bench.master.deadlines.first_late(bench.drives[1]) is bench.drives[1]
    bench.nodes[31].plugged = True
    bench.run_until(lambda: bench.drives[31].contact, 5_000_000)


def test_drives_at_rest_go_behind_those_that_run_while_silent_ones_are_told_to_stop():
    """Those would trip as well, and are late; but theirs is only a fault to acknowledge."""
    bench = bench_of(20, present=27)
    for address in range(1, 28):
        bench.master.deadlines.supervise(bench.drives[address], 800 if address < 4 else 1_000)
    bench.run(2_000_000)
    for address in (1, 2, 3):
        bench.drives[address].start(0x1000)
    bench.run(1_000_000)
    since = len(bench.sent)
    silent = range(23, 32)
    for address in silent:
        bench.nodes[address].plugged = False
    for _ in range(6):  # somebody stops them again and again
        for address in silent:
            bench.drives[address].stop()
        bench.run(300_000)
    longest_us = [max(gaps(bench, address, since) or [bench.now]) for address in (1, 2, 3)]
    assert max(longest_us) < 800_000, longest_us
    assert all([bench.drives[address].is_on() for address in (1, 2, 3)])


# --- what is promised ---------------------------------------------------------------------------


def test_no_gap_is_longer_than_the_bus_has_promised():
    """Beside drives that run, that stand and that are silent, and while one falls silent."""
    for present, running, listed, timeout_ms in (
        (1, 1, 1, 20), (2, 1, 31, 60), (5, 5, 31, 20), (31, 3, 31, 20), (31, 12, 31, 20),
        (31, 31, 31, 20), (20, 14, 31, 60), (4, 2, 4, 500),
    ):  # fmt: skip
        bench = bench_of(timeout_ms, present, listed)
        drives = [bench.drives[address] for address in range(1, running + 1)]
        for drive in drives:
            bench.master.deadlines.supervise(drive, 2_000)
        bench.run(3_000_000)
        for drive in drives[1:]:
            drive.start(0x1000)
        bench.run(1_000_000)
        promised_us = bench.master.deadlines.gap_us(drives[0])
        late = bench.master.deadlines.first_late(drives[0])
        drives[0].start(0x1000)
        bench.run(500_000)
        since = len(bench.sent)
        bench.run(10_000_000)
        if running < present:
            bench.nodes[present].plugged = False
        bench.run(2_000_000)
        for drive in drives:
            longest_us = max(gaps(bench, drive.address, since))
            where = (present, running, listed, timeout_ms, longest_us, promised_us)
            assert longest_us < promised_us or late is None and longest_us < 666_666, where
            assert late is None or longest_us < 2_000_000, where
        assert (late is None) == (promised_us < 666_666), (present, running, promised_us)


def measured_us(bench, us=1_000_000):
    """What an answered exchange takes at present, on the average; `us` pass meanwhile."""
    turns, silence = bench.master.turns, bench.master.deadlines.silence
    began, count, silences, spent = bench.now, turns.exchanges, silence.count, silence.spent_us
    bench.run(us)
    count = turns.exchanges - count - (silence.count - silences)
    return (bench.now - began - (silence.spent_us - spent)) // count


def promise_us(bench, running, exchange_us, look_us=4_000):
    """The gap where so many run and none is silent: the loop sees in two looks and 16 ms that a
    drive is late; theirs are two telegrams of three; one was just sent to somebody else. And a
    silence."""
    others_us = (running + 1) * exchange_us // 2 + exchange_us
    return 2 * look_us + 16_000 + running * exchange_us + others_us + silence_us(bench)


def is_about(us, expected_us):
    return abs(us - expected_us) < expected_us // 40


def test_the_promise_is_made_of_exchanges_as_long_as_they_are():
    """They are measured, without what silent drives take; not where the bus waits for its cycle
    time, and not where a measurement has too few of them."""
    for delay_us, plugged in ((None, 4), (18_000, 4), (18_000, 3), (5_000, 3)):
        bench = Bench([Node(address, delay_us=delay_us) for address in (1, 2, 3, 4)])
        bench.nodes[4].plugged = plugged == 4
        bench.contact()
        bench.run(4_000_000)
        deadlines, drive = bench.master.deadlines, bench.drives[1]
        expected_us = promise_us(bench, 1, measured_us(bench)) - silence_us(bench)
        if plugged == 3:  # and the silent ones have a fifth of the line
            expected_us = expected_us * 5 // 4
        expected_us += silence_us(bench)
        assert is_about(deadlines.gap_us(drive), expected_us), (delay_us, plugged)
        bench.master.turns.cycle_us = 200_000
        bench.run(3_000_000)
        assert is_about(deadlines.gap_us(drive), expected_us), (delay_us, plugged)
    slow = Bench([Node(1, delay_us=18_000), Node(2, delay_us=18_000)], baud=2400)
    slow.contact()
    slow.run(3_000_000)
    quickest_us = slow.timing.exchange_us(12, slow.timing.start_interval_us)
    assert measured_us(slow, 10_000_000) > quickest_us + 10_000
    promised_us = slow.master.deadlines.gap_us(slow.drives[1])
    assert is_about(promised_us, promise_us(slow, 1, quickest_us))


def test_the_promise_grows_with_every_drive_that_runs_until_the_list_alone_does():
    bench = Bench([Node(address, delay_us=5_000) for address in range(1, 11)])
    bench.contact()
    bench.run(2_000_000)
    deadlines, turns = bench.master.deadlines, bench.master.turns
    for running in range(10):
        drive = bench.drives[running + 1]
        exchange_us = measured_us(bench)
        expected_us = promise_us(bench, running + 1, exchange_us)
        if running + 1 >= 7:  # two thirds of the list: it goes round, and more every fourth time
            expected_us = 10 * exchange_us * 4 // 3 + silence_us(bench)
        promised_us = deadlines.gap_us(drive)
        assert is_about(promised_us, expected_us), (running, promised_us, expected_us)
        assert turns.lists_between == (3 if running >= 7 else 1), running
        # It trips after three times that: a millisecond less, and it would be late.
        deadlines.supervise(drive, 3 * promised_us // 1000)
        assert deadlines.first_late(drive) is drive
        deadlines.supervise(drive, 3 * promised_us // 1000 + 2)
        assert deadlines.first_late(drive) is None
        deadlines.supervise(drive, 0)
        drive.start(0x1000)
    turns.cycle_us = 300_000  # then the list alone may not do
    bench.run(1_000_000)
    assert turns.lists_between == 1 and deadlines.gap_us(drive) > expected_us + 50_000
    bench.nodes[10].plugged = False  # an exchange with it takes longer from now on
    turns.cycle_us = 0
    bench.run(3_000_000)
    exchange_us = measured_us(bench)
    expected_us = (9 * exchange_us + silence_us(bench)) * 4 // 3 + silence_us(bench)
    assert is_about(deadlines.gap_us(bench.drives[1]), expected_us)


def test_one_that_was_lost_before_it_was_seen_to_run_counts_as_one_that_runs():
    """Until its STOP is answered; an exchange with it takes as long as a silence."""
    bench = Bench([Node(address) for address in range(1, 11)])
    bench.contact()
    bench.nodes[1].follows = False
    bench.drives[1].start(0x1000)
    bench.run(100_000)
    bench.nodes[1].plugged = False
    bench.run(1_500_000)
    bench.drives[1].stop()
    bench.run(3_000_000)
    assert bench.drives[1].was_running and not bench.drives[1].contact
    exchange_us = measured_us(bench)
    expected_us = promise_us(bench, 2, exchange_us)
    expected_us += (silence_us(bench) - exchange_us) * 3 // 2
    assert is_about(bench.master.deadlines.gap_us(bench.drives[2]), expected_us)
    bench.nodes[1].plugged = True
    bench.run(1_000_000)
    expected_us = promise_us(bench, 1, exchange_us)
    assert is_about(bench.master.deadlines.gap_us(bench.drives[2]), expected_us)


def test_a_loop_that_is_slow_promises_less_and_sees_as_soon_who_runs():
    for look_us in (20_000, 30_000, 48_000, 60_000, 100_000):
        bench = Bench([Node(address) for address in range(1, 11)])
        bench.contact()
        bench.refreshing = False
        looked = [0]

        def look_now_and_then():
            if bench.now - looked[0] >= look_us:
                looked[0] = bench.now
                bench.master.refresh(bench.now)

        bench.loop = look_now_and_then
        bench.run(2_000_000)
        exchange_us = measured_us(bench)
        for running in (0, 1, 2):
            promised_us = bench.master.deadlines.gap_us(bench.drives[running + 1])
            expected_us = promise_us(bench, running + 1, exchange_us, look_us)
            assert is_about(promised_us, expected_us), (look_us, running)
            bench.drives[running + 1].start(0x1000)
            bench.run(400_000)
        bench.loop = None  # quick again: what was slow is soon forgotten
        bench.refreshing = True
        bench.run(1_000_000)
        promised_us = bench.master.deadlines.gap_us(bench.drives[4])
        assert is_about(promised_us, promise_us(bench, 4, exchange_us)), look_us


def room_us(bench):
    """The longest silence that the bus would risk."""
    deadlines = bench.master.deadlines
    short, long = -1_000_000, 2_000_000
    while long - short > 1:
        middle = (short + long) // 2
        if deadlines.silence_wait_us(middle) > 10_000_000:
            long = middle
        else:
            short = middle
    return long + silence_us(bench)


def test_the_silence_that_is_risked_is_what_those_that_run_leave_of_their_bound_or_a_quarter():
    """A quarter of what they need, where they leave less. The bound of those that never trip is
    doubled where nobody was silent for more than a second."""
    for off_time_ms, bound_us in ((0, 666_666), (2_000, 666_666), (700, 233_333), (400, 133_333)):
        bench = Bench([Node(address) for address in range(1, 13)])
        bench.contact()
        bench.run(2_000_000)
        for running in (1, 2, 3, 4, 5):
            bench.master.deadlines.supervise(bench.drives[running], off_time_ms)
            bench.drives[running].start(0x1000)
            needed_us = promise_us(bench, running, measured_us(bench)) - silence_us(bench)
            expected_us = max(bound_us - needed_us, needed_us // 4)
            assert abs(room_us(bench) - expected_us) < 1_000 + expected_us // 50, running
        bench.master.stop_all()
        bench.run(500_000)
        assert room_us(bench) > 1_000_000  # none runs: as long as you like
    bench = bench_of(20, listed=4)  # with silent ones it is not doubled
    started(bench, 1, 0)
    bench.run(2_000_000)
    needed_us = promise_us(bench, 1, measured_us(bench)) - silence_us(bench)
    assert abs(room_us(bench) - (333_333 - needed_us)) < 4_000


def test_a_drive_in_a_hurry_gets_its_telegrams_as_late_as_can_be():
    """Its bound less what was promised; and then a single one, so the list goes on."""
    for running in (1, 2, 3):
        bench = bench_of(20, present=31)
        for address in range(10, 10 + running):
            since = started(bench, address, 1_000)
        bench.run(1_000_000)
        exchange_us = measured_us(bench)
        late_us = 333_333 - bench.master.deadlines.gap_us(bench.drives[10])
        since = len(bench.sent)
        bench.run(8_000_000)
        for address in range(10, 10 + running):
            these = sorted(gaps(bench, address, since))
            assert these[0] > 4 * exchange_us, (running, these[0])
            assert late_us < these[len(these) // 2] < late_us + 3 * exchange_us, running
            assert these[-1] < late_us + 4 * exchange_us, (running, these[-1])


def test_a_drive_whose_time_is_too_short_for_any_line_gets_every_second_telegram():
    bench = bench_of(20, present=10)
    started(bench, 3, 60)
    bench.run(1_000_000)
    since = len(bench.sent)
    bench.run(1_000_000)
    assert max(gaps(bench, 3, since)) < 2 * measured_us(bench) + 1_000


def test_extra_telegrams_are_fewer_only_where_two_thirds_may_have_their_turns_too_late():
    """With one of them behind every turn, and a silence, a round of ten takes 0.47 s."""
    for off_time_ms, running, between in ((1_465, 10, 1), (1_415, 10, 3), (1_415, 7, 3),
                                          (1_415, 6, 1), (10_000, 10, 1)):  # fmt: skip
        bench = bench_of(20, present=10)
        for address in range(1, running + 1):
            bench.master.deadlines.supervise(bench.drives[address], off_time_ms)
            bench.drives[address].start(0x1000)
        bench.run(1_500_000)
        assert bench.master.turns.lists_between == between, (off_time_ms, running)


def test_a_drive_at_rest_is_asked_in_its_time_where_several_are_told_to_stop_in_vain():
    """Not where a single one is; nor one that never trips; and behind one that runs."""
    for silent in (1, 2):
        bench = bench_of(20, present=31)
        for address in (5, 7):
            bench.master.deadlines.supervise(bench.drives[address], 1_000)
        bench.drives[7].start(0x1000)
        bench.run(1_000_000)
        unplugged = (30, 31)[:silent]
        for address in unplugged:
            bench.nodes[address].plugged = False
        bench.run(2_000_000)
        since = len(bench.sent)
        for _ in range(30):
            for address in unplugged:
                bench.drives[address].stop()
            bench.run(200_000)
        longest_us = [max(gaps(bench, address, since) or [6_000_000]) for address in (5, 6, 7)]
        assert (longest_us[0] < 700_000) == (silent > 1), longest_us
        assert longest_us[1] > 1_500_000 and longest_us[2] < 333_333, longest_us
        bench.run(5_000_000)  # nobody is told any more: the list does
        since = len(bench.sent)
        bench.run(5_000_000)
        assert min(gaps(bench, 5, since)) > 600_000


def test_a_drive_takes_its_time_and_its_rest_along_to_another_address():
    bench = bench_of(20, listed=4)
    bench.run(3_000_000)
    deadlines, turns, drives = bench.master.deadlines, bench.master.turns, bench.drives
    deadlines.supervise(drives[1], 900)
    turns.readdress(drives[1], 11)
    turns.readdress(drives[3], 13)
    assert deadlines.bound_us(drives[1]) == 300_000
    for new in (11, 13):
        bench.nodes[new] = Node(new)
    since = len(bench.sent)
    bench.run_until(lambda: drives[3].contact, 5_000_000)
    bench.run(5_000_000)
    asked = bench.addresses(since)
    assert asked.count(4) > 5 and asked.count(11) > 70 and asked.count(13) > 70
    assert not {1, 3} & set(asked)
    turns.remove(drives[1])
    for address in (1, 11):  # the next ones there have none yet
        drive = turns.add(address)
        assert deadlines.bound_us(drive) == turns.lost_us // 3
        bench.run(500_000)
    turns.remove(drives[4])
    assert not deadlines.silence.resting


def test_a_drive_that_runs_is_named_when_another_one_would_make_it_late():
    bench = bench_of(20, present=31)
    deadlines, drives = bench.master.deadlines, bench.drives
    for address in range(1, 32):
        deadlines.supervise(drives[address], 10_000)
    deadlines.supervise(drives[7], 350)
    assert deadlines.first_late(drives[1]) is None
    assert deadlines.first_late(drives[7]) is drives[7] or deadlines.gap_us(drives[7]) < 116_666
    started(bench, 7, 350)
    for address in range(8, 15):
        drives[address].start(0x1000)
    bench.run(500_000)
    assert deadlines.first_late(drives[1]) is drives[7]
    drives[7].stop()
    bench.run(500_000)
    assert deadlines.first_late(drives[1]) is None


def test_a_telegram_that_nobody_may_answer_waits_for_its_share():
    """Asked before a mirror telegram to an address of which nothing is known."""
    bench = bench_of(60)
    bench.run(3_000_000)
    waits = []
    bench.loop = lambda: waits.append(bench.master.deadlines.silence_wait_us())
    bench.run(5_000_000)
    assert max(waits) <= 5 * (silence_us(bench) + 2_000) and min(waits) == 0
    started(bench, 1, 200)  # no silence of 60 ms and more leaves it a third of that
    del waits[:]
    bench.run(1_000_000)
    assert min(waits) > 1_000_000


# --- the round goes on where it was --------------------------------------------------------------


def test_nobody_loses_a_turn_to_drives_that_leave_the_round_and_come_back():
    """At 4800 baud a round of 31 lasts longer than a drive may be silent: each miss loses it. The
    one behind it in the list was skipped each time, and was never asked."""
    for moody in ((5,), (5, 6), (1, 17, 31), tuple(range(2, 32, 3))):
        kinds = [Moody if address in moody else Node for address in range(1, LISTED + 1)]
        bench = Bench([kind(address) for address, kind in enumerate(kinds, 1)], baud=4800)
        bench.run(20_000_000)
        first = len(bench.sent)
        bench.run(60_000_000)
        asked = [telegram.address for telegram in bench.sent[first:]]
        counts = [asked.count(address) for address in range(1, LISTED + 1)]
        steady = [count for address, count in enumerate(counts, 1) if address not in moody]
        assert min(counts) > 0 and max(steady) - min(steady) <= 2 + len(moody), (moody, counts)
