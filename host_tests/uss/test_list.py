# SPDX-License-Identifier: MIT
"""The circulating list: repeats, editing while it goes round, a fixed cycle time, retries."""

import random

from round_bench import Bench, Node
from uss import pzd
from uss.layout import Layout
from uss.receiver import SILENT

SEED = 20
LAYOUTS = (
    (4, 2), (3, 2), (0, 2), (4, 4), (127, 2), (4, 16), (0, 1), (3, 0), (0, 16), (127, 6),
)  # fmt: skip


def nodes(count):
    return [Node(address) for address in range(1, count + 1)]


def refused(what, *arguments):
    """The words with which something is refused."""
    try:
        what(*arguments)
    except ValueError as error:
        return str(error)
    raise AssertionError("taken: %r" % (arguments,))


# --- the list -----------------------------------------------------------------------------------


def test_a_round_is_as_it_was_arranged():
    """The list of specification A-5.1: 0 1 3 5 0 1 7 21."""
    order = (0, 1, 3, 5, 0, 1, 7, 21)
    bench = Bench([Node(address) for address in (0, 1, 3, 5, 7, 21)])
    bench.master.turns.arrange([bench.drives[address] for address in order])
    bench.run(1_000_000)
    assert len(bench.sent) > 24
    assert bench.addresses()[:24] == list(order) * 3


def test_a_drive_that_stands_in_the_list_ten_times_gets_ten_turns():
    bench = Bench(nodes(3))
    one, two, three = bench.master.turns.drives
    bench.master.turns.arrange([one] * 10 + [two, three])
    bench.run(2_000_000)
    addresses = bench.addresses()[:60]
    assert [addresses.count(each) for each in (1, 2, 3)] == [50, 5, 5]


def test_255_entries_go_round_and_no_more_are_taken():
    bench = Bench(nodes(31))
    drives = bench.master.turns.drives
    entries = [drives[index * 7 % 31] for index in range(255)]
    bench.master.turns.arrange(entries)
    assert "255" in refused(bench.master.turns.arrange, entries + [drives[0]])
    assert "255" in refused(bench.master.turns.add, 1)
    bench.run_until(lambda: len(bench.sent) >= 520, 20_000_000)
    wanted = [drive.address for drive in entries]
    assert bench.addresses()[:510] == wanted + wanted


def test_a_list_of_strangers_and_one_without_a_drive_are_refused():
    """A drive without a turn would never be heard of again."""
    bench, other = Bench(nodes(2)), Bench(nodes(2))
    before = list(bench.master.turns.list)
    refused(bench.master.turns.arrange, [])
    refused(bench.master.turns.arrange, [bench.drives[1]])
    refused(bench.master.turns.arrange, [bench.drives[1], bench.drives[2], other.drives[2]])
    assert bench.master.turns.list == before
    bench.run(300_000)
    assert set(bench.addresses()) == {1, 2}


def test_the_list_is_arranged_anew_at_any_instant_of_an_exchange():
    """The exchange under way ends as ever; the next telegram is one of the new list."""
    for offset_us in range(0, 24_000, 571):
        bench = Bench(nodes(3))
        one, two, three = bench.master.turns.drives
        bench.run(300_000 + offset_us)
        sent = len(bench.sent)
        bench.master.turns.arrange([three, one, one, two, one])
        bench.run(250_000)
        assert bench.addresses(sent)[:10] == [3, 1, 1, 2, 1] * 2, offset_us
        for drive in bench.master.turns.drives:
            assert not any(drive.counters[1:]), (offset_us, drive.counters)


def test_a_random_hand_edits_the_list_of_a_bus_that_runs():
    print("seed", SEED)
    random.seed(SEED)
    bench = Bench(nodes(12))
    master = bench.master
    bench.contact()
    for _ in range(60):
        drives = master.turns.drives
        count = 1 + random.getrandbits(5)
        entries = drives + [drives[random.getrandbits(8) % 12] for _ in range(count)]
        for place in range(len(entries)):
            other = random.getrandbits(8) % len(entries)
            entries[place], entries[other] = entries[other], entries[place]
        master.turns.arrange(entries)
        sent = len(bench.sent)
        bench.run(random.getrandbits(20))
        wanted = [drive.address for drive in entries] * 5
        addresses = bench.addresses(sent)
        assert addresses == wanted[: len(addresses)]
    for drive in master.turns.drives:
        assert not any(drive.counters[1:]), drive.counters


def test_a_drive_that_is_taken_away_is_not_asked_any_more():
    bench = Bench(nodes(3))
    bench.run(300_000)
    two = bench.drives[2]
    bench.master.turns.remove(two)
    assert two not in bench.master.turns.drives and two not in bench.master.turns.list
    sent = len(bench.sent)
    bench.run(300_000)
    assert set(bench.addresses(sent)) == {1, 3}
    again = bench.master.turns.add(2)
    bench.run(300_000)
    assert again.contact and again is not two


def test_the_drive_whose_exchange_goes_on_may_be_taken_away():
    for offset_us in range(0, 48_000, 997):
        bench = Bench(nodes(2))
        bench.run(300_000 + offset_us)
        sent = len(bench.sent)
        bench.master.turns.remove(bench.drives[2])
        bench.run(200_000)
        assert 2 not in bench.addresses(sent) and bench.drives[1].contact
        assert not any(bench.drives[1].counters[1:])


def test_a_list_without_drives_is_silence_until_one_is_added():
    bench = Bench(nodes(1))
    bench.run(300_000)
    bench.master.turns.remove(bench.drives[1])
    bench.run(50_000)
    sent = len(bench.sent)
    bench.run(1_000_000)
    assert len(bench.sent) == sent
    drive = bench.master.turns.add(1)
    bench.run(1_000_000)
    assert drive.contact


def test_a_drive_that_runs_or_may_run_is_not_taken_away():
    bench = Bench(nodes(2))
    bench.run(300_000)
    drive = bench.drives[1]
    drive.start(0x1000)
    refused(bench.master.turns.remove, drive)  # before the first telegram says ON
    bench.run(200_000)
    refused(bench.master.turns.remove, drive)
    bench.nodes[1].follows = False  # it ramps down
    drive.stop()
    bench.run(200_000)
    refused(bench.master.turns.remove, drive)
    bench.nodes[1].plugged = False
    bench.run(3_000_000)
    refused(bench.master.turns.remove, drive)  # no contact: it may run still
    bench.nodes[1].plugged = bench.nodes[1].follows = True
    bench.run(4_000_000)
    bench.master.turns.remove(drive)
    assert bench.master.turns.drives == [bench.drives[2]]


# --- layouts ------------------------------------------------------------------------------------


def test_drives_of_all_layouts_are_asked_in_turn():
    bench = Bench([Node(5 + row, *layout) for row, layout in enumerate(LAYOUTS)])
    bench.run(2_000_000)
    for drive in bench.master.turns.drives:
        assert drive.contact and drive.counters[0] > 3, drive.address
        assert not any(drive.counters[1:]), (drive.address, drive.counters)


def test_a_drive_without_process_data_cannot_be_started():
    bench = Bench([Node(1, 4, 0), Node(2, 0, 1)])
    bench.run(300_000)
    refused(bench.drives[1].start, 0x1000)
    bench.drives[2].start(0)
    bench.run(200_000)
    assert bench.sent[-1].characters[3:5] == b"\x04\x7f" or bench.sent[-1].address == 1
    assert bench.stws(2)[-1] == pzd.ON


def test_the_same_address_with_another_layout_is_refused():
    bench = Bench(nodes(1))
    refused(bench.master.turns.add, 1, Layout(3, 2))
    assert len(bench.master.turns.list) == 1


# --- fixed cycle --------------------------------------------------------------------------------


def beginnings(bench, address, since=0):
    """When the rounds began: the instants of the telegrams to the first of the list."""
    return [telegram.at for telegram in bench.sent[since:] if telegram.address == address]


def test_rounds_begin_a_fixed_time_after_each_other():
    bench = Bench(nodes(3))
    bench.master.turns.cycle_us = 150_000
    bench.run(5_000_000)
    instants = beginnings(bench, 1)
    assert len(instants) > 30
    for before, after in zip(instants, instants[1:]):
        assert 0 <= after - before - 150_000 <= 10, (before, after)


def test_within_a_round_nothing_waits():
    bench = Bench(nodes(3))
    bench.master.turns.cycle_us = 150_000
    bench.run(1_000_000)
    bench.master.turns.cycle_us = 0
    bench.run(300_000)
    bench.master.turns.cycle_us = 150_000
    bench.run(300_000)
    sent = len(bench.sent)
    bench.run(1_000_000)
    exchange_us = bench.timing.exchange_us(12, 1719)
    instants = [(telegram.at, telegram.address) for telegram in bench.sent[sent:]]
    for before, after in zip(instants, instants[1:]):
        if after[1] != 1:
            assert after[0] - before[0] <= exchange_us + 5


def test_a_round_that_takes_longer_than_the_cycle_is_followed_at_once():
    bench = Bench(nodes(8))
    bench.master.turns.cycle_us = 100_000
    bench.run(2_000_000)
    instants = beginnings(bench, 1)
    round_us = 8 * bench.timing.exchange_us(12, 1719)
    for before, after in zip(instants, instants[1:]):
        assert after - before <= round_us + 40
    bench.nodes[3].plugged = False  # a single long round does not shift all that follow
    bench.master.turns.cycle_us = 250_000
    bench.run(5_000_000)
    sent = len(bench.sent)
    bench.run(3_000_000)
    instants = beginnings(bench, 1, sent)
    for before, after in zip(instants, instants[1:]):
        assert 0 <= after - before - 250_000 <= 10


def test_a_round_that_began_late_delays_none_behind_it():
    """A command took the line when the round should have begun."""
    bench = Bench(nodes(3))
    bench.master.turns.cycle_us = 150_000
    bench.run_until(lambda: bench.sent)
    began = bench.sent[0].at
    for place in range(1, 20):
        bench.run_to(began + place * 150_000 - 4_000)
        bench.drives[2].stop()
        bench.run(30_000)
        instants = beginnings(bench, 1)
        assert 0 <= instants[-1] - began - place * 150_000 <= 22_000, instants[-1]
    bench.run(300_000)
    late_us = (beginnings(bench, 1)[-1] - began) % 150_000
    assert late_us <= 10


def test_no_cycle_is_missed_when_the_clock_wraps():
    bench = Bench(nodes(2), mask=(1 << 24) - 1)
    bench.master.turns.cycle_us = 3_000_000
    bench.run(60_000_000)
    instants = beginnings(bench, 1)
    assert len(instants) >= 19
    for before, after in zip(instants, instants[1:]):
        assert 0 <= after - before - 3_000_000 <= 10


# --- retries ------------------------------------------------------------------------------------


def test_an_exchange_without_a_valid_reply_is_repeated_at_once():
    for retries in (0, 1, 2, 5):
        bench = Bench(nodes(3))
        bench.contact()
        bench.master.retries = retries
        bench.nodes[2].plugged = False
        sent = len(bench.sent)
        bench.run(1_000_000)
        addresses = bench.addresses(sent)
        first = addresses.index(2)
        wanted = [2] * (1 + retries) + [3, 1, 2, 3, 1]  # and once only in the rounds to come
        assert addresses[first : first + len(wanted)] == wanted, (retries, addresses)


def test_a_retry_that_is_answered_ends_it():
    bench = Bench(nodes(2))
    bench.contact()
    bench.master.retries = 3
    answer = bench.nodes[2].answer
    heard = []

    def every_second(characters):
        heard.append(characters)
        return answer(characters) if len(heard) % 2 == 0 else None

    bench.nodes[2].answer = every_second
    bench.run_until(lambda: bench.sent[-1].address == 1)
    sent = len(bench.sent)
    bench.run(1_000_000)
    addresses = bench.addresses(sent)
    assert addresses[:6] == [2, 2, 1, 2, 2, 1]
    drive = bench.drives[2]
    assert drive.contact and drive.silent <= 1 and drive.counters[SILENT] >= 5


def test_every_try_is_counted():
    bench = Bench(nodes(1))
    bench.contact()
    bench.master.retries = 2
    bench.nodes[1].plugged = False
    bench.run_until(lambda: bench.drives[1].silent == 1)
    sent = len(bench.sent)
    bench.run_until(lambda: bench.drives[1].silent == 3)
    assert bench.drives[1].counters[SILENT] == 3
    assert len(bench.sent) - sent <= 3
