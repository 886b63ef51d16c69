# SPDX-License-Identifier: MIT
"""Data sheet of the virtual clock: order, exactness, wrapping counters, no heap."""

import random

from boards.sim.chip.machine import heap_lock, heap_unlock
from boards.sim.clock import Clock, Event

INTERPRETERS = "unix64 unix32 cpython"  # what takes no heap depends on the size of integers


class Recorder:
    """Notes the instants at which its event happens."""

    def __init__(self, clock, name="", book=None):
        self.clock = clock
        self.name = name
        self.book = book if book is not None else []
        self.event = Event(self.note)

    def note(self):
        self.book.append((self.clock.now_us, self.name))


def recorders(clock, names):
    book = []
    return book, [Recorder(clock, name, book).event for name in names]


def refused(error, function, *arguments):
    try:
        function(*arguments)
    except error:
        return True
    return False


def test_an_event_happens_once_at_its_instant():
    clock = Clock()
    book, (a,) = recorders(clock, "a")
    clock.schedule(a, 1000)
    clock.advance(999)
    assert book == [] and a.armed and clock.now_us == 999
    clock.advance(1)
    assert book == [(1000, "a")] and not a.armed
    clock.advance(5000)
    assert book == [(1000, "a")] and clock.now_us == 6000


def test_events_happen_in_order_of_their_instants():
    clock = Clock()
    book, (a, b, c) = recorders(clock, "abc")
    clock.schedule(b, 20)
    clock.schedule(c, 30)
    clock.schedule(a, 10)
    clock.advance(100)
    assert book == [(10, "a"), (20, "b"), (30, "c")]


def test_events_of_one_instant_happen_in_the_order_of_scheduling():
    clock = Clock()
    book, (a, b, c) = recorders(clock, "abc")
    for event in (c, a, b):
        clock.schedule(event, 10)
    clock.advance(10)
    assert book == [(10, "c"), (10, "a"), (10, "b")]


def test_arming_an_armed_event_moves_it_behind_those_of_the_same_instant():
    clock = Clock()
    book, (a, b) = recorders(clock, "ab")
    clock.schedule(a, 10)
    clock.schedule(b, 10)
    clock.schedule(a, 10)
    clock.advance(10)
    assert book == [(10, "b"), (10, "a")]


def test_an_instant_gone_by_means_now():
    clock = Clock()
    book, (a,) = recorders(clock, "a")
    clock.advance(500)
    clock.schedule(a, 100)
    assert a.at_us == 500
    clock.advance(0)
    assert book == [(500, "a")]


def test_a_cancelled_event_does_not_happen_and_can_be_armed_again():
    clock = Clock()
    book, (a, b, c) = recorders(clock, "abc")
    for event in (a, b, c):
        clock.schedule(event, 10)
    clock.cancel(b)
    clock.cancel(b)
    assert not b.armed
    clock.advance(10)
    assert book == [(10, "a"), (10, "c")]
    clock.schedule(b, 20)
    clock.advance(10)
    assert book[2:] == [(20, "b")]


def test_a_callback_may_arm_its_own_event_again():
    clock = Clock()
    beats = []

    def beat():
        beats.append(clock.now_us)
        clock.schedule(metronome, clock.now_us + 250)

    metronome = Event(beat)
    clock.schedule(metronome, 250)
    clock.advance(1000)
    assert beats == [250, 500, 750, 1000]


def test_a_callback_may_cancel_what_is_due_at_the_same_instant():
    clock = Clock()
    book, (victim,) = recorders(clock, "v")
    killer = Event(lambda: clock.cancel(victim))
    clock.schedule(killer, 10)
    clock.schedule(victim, 10)
    clock.advance(20)
    assert book == []


def test_what_a_callback_schedules_for_now_happens_at_once():
    clock = Clock()
    book, (a, b) = recorders(clock, "ab")
    starter = Event(lambda: clock.schedule(b, clock.now_us))
    clock.schedule(starter, 10)
    clock.schedule(a, 10)
    clock.advance(10)
    assert book == [(10, "a"), (10, "b")]


def test_a_callback_cannot_advance_the_clock():
    clock = Clock()
    answers = []
    book, (later,) = recorders(clock, "l")
    clock.schedule(Event(lambda: answers.append(refused(RuntimeError, clock.advance, 5))), 10)
    clock.schedule(later, 20)
    clock.advance(30)
    assert answers == [True]
    assert book == [(20, "l")] and clock.now_us == 30


def test_time_does_not_run_backwards():
    clock = Clock()
    clock.advance(10)
    assert refused(ValueError, clock.advance_to, 9)
    assert refused(ValueError, clock.advance, -1)
    clock.advance_to(10)
    assert clock.now_us == 10


def test_an_exception_in_a_callback_ends_the_advance_at_its_instant():
    clock = Clock()
    book, (later,) = recorders(clock, "l")

    def fail():
        raise ZeroDivisionError

    clock.schedule(Event(fail), 10)
    clock.schedule(later, 20)
    assert refused(ZeroDivisionError, clock.advance, 30)
    assert clock.now_us == 10 and later.armed
    clock.advance_to(30)
    assert book == [(20, "l")]


def test_the_chip_counts_from_any_start():
    clock = Clock(ticks_start=123_456_789)
    assert clock.ticks_us() == 123_456_789
    assert clock.ticks_ms() == 123_456
    clock.advance(211)
    assert clock.now_us == 211
    assert clock.ticks_us() == 123_457_000
    assert clock.ticks_ms() == 123_457


def test_the_chips_counters_wrap_at_any_power_of_two():
    for bits in range(1, 31):
        mask = (1 << bits) - 1
        for start in (0, 1, mask // 2, mask - 1, mask, 1000 * mask + 999, 5 * 10**12):
            clock = Clock(start, mask)
            for now in (0, 1, 999, 1000, 70_000, (1 << 30) - 1, 1 << 30, 5 * 10**9):
                clock.advance_to(now)
                assert clock.ticks_us() == (start + now) & mask
                assert clock.ticks_ms() == (start + now) // 1000 & mask


def test_a_mask_that_is_no_power_of_two_less_one_is_refused():
    for mask in (0, -1, 10, 0x7FFFFFFF):
        assert refused(ValueError, Clock, 0, mask)


def test_time_goes_on_past_the_small_integers_of_the_32_bit_build():
    clock = Clock()
    clock.advance((1 << 30) - 10)  # 17.9 minutes
    book, (a, b, c) = recorders(clock, "abc")
    clock.schedule(b, (1 << 30) + 5)
    clock.schedule(c, 1 << 40)
    clock.schedule(a, (1 << 30) - 5)
    clock.advance_to(1 << 40)
    assert book == [((1 << 30) - 5, "a"), ((1 << 30) + 5, "b"), (1 << 40, "c")]


def test_scheduling_and_advancing_take_no_heap():
    clock = Clock(ticks_start=0x3FFFFFFF)
    happened = bytearray(1)

    def count():
        happened[0] += 1

    events = [Event(count) for _ in range(8)]
    heap_lock()
    try:
        for event in events:
            clock.schedule(event, 1_073_000_000)
            clock.schedule(event, 500)
        clock.cancel(events[3])
        clock.cancel(events[3])
        clock.schedule(events[4], 1_000_000_000)
        clock.advance(1000)
        clock.ticks_us()
        clock.ticks_ms()
        clock.advance_to(1_073_000_000)
        clock.ticks_us()
        clock.ticks_ms()
    finally:
        heap_unlock()
    assert happened[0] == 7


class NaiveClock:
    """The same promises, kept in the most obvious way: a list, sorted afresh each time."""

    def __init__(self):
        self.now_us = 0
        self.book = []
        self.due = []  # (at_us, order of scheduling, name)
        self.order = 0

    def schedule(self, name, at_us):
        self.cancel(name)
        self.order += 1
        self.due.append((max(at_us, self.now_us), self.order, name))

    def cancel(self, name):
        self.due = [entry for entry in self.due if entry[2] != name]

    def advance(self, us):
        end = self.now_us + us
        while self.due and min(self.due)[0] <= end:
            first = min(self.due)
            self.due.remove(first)
            self.now_us = first[0]
            self.book.append((first[0], first[2]))
        self.now_us = end


def random_run(seed):
    random.seed(seed)
    clock = Clock()
    naive = NaiveClock()
    names = "abcdefghij"
    book, events = recorders(clock, names)
    for _ in range(300):
        which = random.getrandbits(8) % len(names)
        what = random.getrandbits(2)
        if what < 2:
            at_us = clock.now_us - 5 + random.getrandbits(5)
            clock.schedule(events[which], at_us)
            naive.schedule(names[which], at_us)
        elif what == 2:
            clock.cancel(events[which])
            naive.cancel(names[which])
        else:
            us = random.getrandbits(4)
            clock.advance(us)
            naive.advance(us)
    assert clock.now_us == naive.now_us
    assert len(book) > 20
    assert book == naive.book


def test_what_is_coming_can_be_seen_in_order():
    clock = Clock()
    _, events = recorders(clock, "ab")
    assert list(clock.coming()) == []
    clock.schedule(events[0], 30)
    clock.schedule(events[1], 10)
    assert [at_us for at_us, _ in clock.coming()] == [10, 30]
    assert [callback for _, callback in clock.coming()][0] is events[1].callback
    clock.advance(20)
    assert [at_us for at_us, _ in clock.coming()] == [30]


def test_random_runs_agree_with_a_naive_clock():
    for seed in range(100):
        try:
            random_run(seed)
        except AssertionError:
            print("seed", seed)
            raise
