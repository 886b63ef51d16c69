# SPDX-License-Identifier: MIT
"""The pacer: whoever calls, the engine is entered once at a time and never left asleep."""

import main
from boards.sim.world import World
from hal import pacer as pacing
from hal.pacer import OVERDUE_US, ROUNDS_MAX, WAKE_US, Pacer
from uss.master import SENDING


class Clock:
    ticks_mask = (1 << 30) - 1

    def __init__(self):
        self.now = 0
        self.meanwhile = None

    def ticks_us(self):
        if self.meanwhile:
            self.meanwhile()
        return self.now & self.ticks_mask


class Timer:
    ONE_SHOT = 0

    def __init__(self):
        self.period = None

    def init(self, mode, period, tick_hz, callback):
        assert mode == self.ONE_SHOT and tick_hz == 1_000_000
        self.period = period
        self.callback = callback

    def deinit(self):
        self.period = None


class Link:
    interrupts = True
    on_activity = None
    closed = False

    def close(self):
        self.closed = True


class Engine:
    """Asks to be called again after 700 us; does what the test wants meanwhile."""

    def __init__(self):
        self.entries = 0
        self.inside = 0
        self.recovered = 0
        self.meanwhile = None
        self.due_us = 700
        self.overtaken = False

    def is_overtaken(self, now):
        return self.overtaken

    def poll(self, now):
        self.entries += 1
        self.inside += 1
        assert self.inside == 1, "entered twice at once"
        if self.meanwhile:
            self.meanwhile()
        self.inside -= 1
        return self.due_us

    def recover(self, now):
        self.inside = 0
        self.recovered += 1


class InterruptedPacer(Pacer):
    """Lets the clock's `meanwhile` happen before every change of a field, too."""

    def __init__(self, engine, link, clock, timer):
        object.__setattr__(self, "clock", clock)
        Pacer.__init__(self, engine, link, clock, timer)

    def __setattr__(self, name, value):
        if self.clock.meanwhile:
            self.clock.meanwhile()
        object.__setattr__(self, name, value)


class Bench:
    def __init__(self, timer=True, pacer=Pacer, stack_bytes=0):
        self.clock, self.engine, self.link = Clock(), Engine(), Link()
        if stack_bytes:
            self.link.stack_bytes = stack_bytes
        self.timer = Timer() if timer else None
        self.pacer = pacer(self.engine, self.link, self.clock, self.timer)
        self.pacer.start()

    def let_timer_fire(self):
        self.clock.now += self.timer.period
        self.timer.callback(self.timer)


def test_the_timer_is_set_to_what_the_engine_asks():
    bench = Bench()
    assert bench.engine.entries == 1 and bench.timer.period == 700
    bench.let_timer_fire()
    assert bench.engine.entries == 2 and bench.timer.period == 700
    for due_us, period in ((0, 20), (19, 20), (20, 20), (21, 21), (20_000, 20_000)):
        bench.engine.due_us = due_us
        bench.let_timer_fire()
        assert bench.timer.period == period, "below 20 us it may fire before it is armed"


class Depth:
    """So deep the program is when an interrupt comes, in place of the interpreter's stack."""

    def __init__(self, depth_bytes):
        self.depth_bytes = depth_bytes
        self._real = pacing.stack_use

    def __enter__(self):
        pacing.stack_use = lambda: self.depth_bytes
        return self

    def __exit__(self, *_):
        pacing.stack_use = self._real


STACK_BYTES, DEEP_BYTES = 7_936, 5_500


def test_an_interrupt_that_finds_no_stack_puts_the_engine_off():
    bench = Bench(stack_bytes=STACK_BYTES)
    with Depth(DEEP_BYTES) as program:
        bench.timer.period = None
        bench.link.on_activity()
        assert bench.engine.entries == 1 and bench.timer.period == WAKE_US
        bench.let_timer_fire()
        assert bench.engine.entries == 1 and bench.timer.period == WAKE_US
        program.depth_bytes = 0  # the program has come back from there
        bench.let_timer_fire()
    assert bench.engine.entries == 2 and bench.timer.period == 700
    assert bench.pacer.put_off == 2 and bench.engine.recovered == 0


def test_the_engine_has_2800_bytes_of_the_stack_for_itself():
    for deep_bytes, entries in ((0, 2), (5_135, 2), (5_136, 2), (5_137, 1), (7_936, 1)):
        bench = Bench(stack_bytes=7_936)
        with Depth(deep_bytes):
            bench.link.on_activity()
        assert bench.engine.entries == entries, deep_bytes
        assert bench.pacer.put_off == 2 - entries


def test_an_interrupt_that_is_put_off_is_served_a_millisecond_later_though_nothing_else_is_due():
    bench = Bench(stack_bytes=STACK_BYTES)
    bench.engine.due_us = 20 * WAKE_US
    bench.let_timer_fire()
    with Depth(DEEP_BYTES):
        bench.link.on_activity()
    assert bench.engine.entries == 2 and bench.timer.period == 1_000
    bench.let_timer_fire()
    assert bench.engine.entries == 3 and bench.timer.period == 20 * WAKE_US


def test_its_counters_have_16_bits():
    bench = Bench(stack_bytes=STACK_BYTES)
    pacer = bench.pacer
    pacer.runs = pacer.put_off = 0xFFFE
    for wanted in (0xFFFF, 0, 1):
        for depth_bytes in (0, DEEP_BYTES):
            with Depth(depth_bytes):
                bench.link.on_activity()
        assert (pacer.runs, pacer.put_off) == (wanted, wanted)


def test_an_interrupt_while_the_engine_is_put_off_is_not_forgotten():
    bench = Bench(stack_bytes=STACK_BYTES)
    with Depth(DEEP_BYTES):
        bench.clock.meanwhile = bench.pacer.run
        bench.link.on_activity()
        bench.clock.meanwhile = None
    assert bench.engine.entries == 1
    bench.let_timer_fire()
    assert bench.engine.entries == 2


def test_where_the_stack_is_long_nobody_looks():
    bench = Bench()
    with Depth(DEEP_BYTES):
        bench.link.on_activity()
    assert bench.engine.entries == 2 and bench.pacer.put_off == 0


def test_without_a_timer_the_main_loop_tries_again():
    bench = Bench(timer=False, stack_bytes=STACK_BYTES)
    with Depth(DEEP_BYTES):
        bench.pacer.tend()
    assert bench.engine.entries == 1
    bench.pacer.tend()
    assert bench.engine.entries == 2


def test_a_timer_that_will_come_early_enough_is_not_set_again():
    """To set it takes long, and each exchange moves the instant only further away."""
    bench = Bench()
    for after_us in (100, 200, 200):
        bench.timer.period = None
        bench.clock.now += after_us
        bench.link.on_activity()
        assert bench.timer.period is None
    assert bench.engine.entries == 4
    bench.clock.now += 200  # the 700 us since it was set are over
    bench.timer.callback(bench.timer)
    assert bench.engine.entries == 4 and bench.timer.period == 500  # nothing was due yet
    bench.let_timer_fire()
    assert bench.engine.entries == 5 and bench.timer.period == 700


def test_a_timer_that_comes_when_it_is_wanted_is_not_set_again_and_one_a_microsecond_later_is():
    for due_us, sets in ((700, False), (600, False), (599, True), (601, False)):
        bench = Bench()
        bench.timer.period = None
        bench.clock.now += 100
        bench.engine.due_us = due_us
        bench.link.on_activity()
        assert bench.timer.period == (due_us if sets else None), due_us
    for passed_us, sets in ((699, False), (700, True)):  # it comes in this microsecond
        bench = Bench()
        bench.timer.period = None
        bench.clock.now += passed_us
        bench.link.on_activity()
        assert bench.timer.period == (700 if sets else None), passed_us


def test_a_timer_that_comes_too_early_is_set_to_what_is_left_to_the_microsecond():
    for passed_us, entries, period in ((698, 1, 20), (600, 1, 100), (699, 1, 20), (700, 2, 700)):
        bench = Bench()
        runs = bench.pacer.runs
        bench.clock.now += passed_us
        bench.timer.callback(bench.timer)
        assert (bench.engine.entries, bench.timer.period) == (entries, period), passed_us
        assert bench.pacer.runs == runs + entries - 1


def test_a_timer_that_would_come_too_late_is_set_again():
    bench = Bench()
    bench.engine.due_us = 300
    bench.link.on_activity()
    assert bench.timer.period == 300
    bench.let_timer_fire()
    assert bench.engine.entries == 3


def test_a_timer_that_got_lost_is_set_again_by_the_next_interrupt():
    bench = Bench()
    bench.clock.now += 701
    bench.timer.period = None
    bench.link.on_activity()
    assert bench.timer.period == 700


def test_after_a_stop_and_a_start_the_timer_is_set():
    bench = Bench()
    bench.pacer.stop()
    assert bench.timer.period is None
    bench.pacer.start()
    assert bench.timer.period == 700


def test_activity_on_the_link_enters_the_engine():
    bench = Bench()
    bench.link.on_activity()
    assert bench.engine.entries == 2


def test_an_interrupt_inside_the_engine_has_it_entered_once_more():
    bench = Bench()
    calls = [2]

    def interrupted():
        if calls[0]:
            calls[0] -= 1
            bench.pacer.run()

    bench.engine.meanwhile = interrupted
    bench.pacer.run()
    assert bench.engine.entries == 1 + 3


def test_interrupts_without_end_do_not_keep_the_loop_out():
    bench = Bench()
    bench.engine.meanwhile = bench.pacer.run
    bench.pacer.run()
    assert bench.engine.entries == 1 + 4
    assert bench.timer.period == 700
    bench.engine.meanwhile = None
    bench.let_timer_fire()
    assert bench.engine.entries == 2 + ROUNDS_MAX, "what is due is not put off"


def test_a_timer_that_fires_while_it_is_set_does_not_leave_the_engine_asleep():
    """In the last of several rounds the one-shot may be used up before anyone may enter."""
    bench = Bench()
    init, rounds = bench.timer.init, [ROUNDS_MAX]
    bench.engine.due_us = 5

    def fire_at_once(mode, period, tick_hz, callback):
        init(mode, period, tick_hz, callback)
        if rounds[0]:
            rounds[0] -= 1
            bench.clock.now += period
            bench.timer.period = None
            callback(bench.timer)

    bench.timer.init = fire_at_once
    bench.pacer.run()
    assert rounds == [0] and bench.timer.period is not None
    entries = bench.engine.entries
    bench.let_timer_fire()
    assert bench.engine.entries == entries + 1


def test_interrupts_without_end_are_served_by_the_timer_in_the_end():
    bench = Bench()
    bench.engine.due_us = 20_000  # nothing of its own is due for long
    bench.engine.meanwhile = bench.pacer.run
    bench.pacer.run()
    bench.engine.meanwhile = None
    entries = bench.engine.entries
    bench.let_timer_fire()
    if bench.engine.entries == entries:  # it was set for 700 us, before it was needed after 1000
        bench.let_timer_fire()
    assert bench.engine.entries == entries + 1 and bench.clock.now <= WAKE_US


def test_an_interrupt_wherever_it_falls_after_the_last_round_leaves_no_engine_asleep():
    """The timer is set then, and nobody may set it in the middle of that."""
    point = 0
    while is_interrupted_after_the_rounds(point):
        point += 1
    assert point >= 8, "too few points: %d" % point


def is_interrupted_after_the_rounds(point):
    """Let an interrupt fall there, after which nothing is due for long; answer False when the
    engine was left before it came to that."""
    bench = Bench(pacer=InterruptedPacer)
    engine, left = bench.engine, [point]
    engine.due_us = 20 * WAKE_US
    fires(bench)
    before = engine.entries
    engine.meanwhile = bench.pacer.run

    def interrupt():
        if engine.entries == before + ROUNDS_MAX and not engine.inside:
            engine.meanwhile, engine.due_us = None, 50
            left[0] -= 1
            if left[0] == -1:
                bench.link.on_activity()

    bench.clock.meanwhile = interrupt
    bench.pacer.run()
    bench.clock.meanwhile = None
    engine.due_us = 20 * WAKE_US
    for _ in range(4):  # each time it may come too early, once
        entries = engine.entries
        for _ in range(2):
            if engine.entries == entries:
                assert bench.timer.period, "asleep, at point %d" % point
                fires(bench)
        assert engine.entries == entries + 1, "late, at point %d" % point
    return left[0] < 0


def fires(bench):
    """The one-shot timer comes, and comes no more unless somebody sets it."""
    bench.clock.now += bench.timer.period
    bench.timer.period = None
    bench.timer.callback(bench.timer)


def test_no_interrupt_is_forgotten_wherever_it_falls_while_the_timer_is_served():
    """It would cost the bus a time-out: the reply has come, and nobody takes it."""
    for passed_us in (600, 700):  # the timer comes 100 us too early to enter the engine, in time
        point = 0
        while is_interrupted_at(point, passed_us):
            point += 1
        assert point >= 8, "too few points: %d" % point


def is_interrupted_at(point, passed_us):
    """Let an interrupt fall there, after which the engine is soon to be entered again; answer
    False when the timer was served before it came to that."""
    bench = Bench(pacer=InterruptedPacer)
    bench.clock.now += 100
    bench.link.on_activity()
    bench.clock.now += passed_us
    left, entries = [point], []

    def interrupt():
        left[0] -= 1
        if left[0] == -1:
            bench.engine.due_us = 50
            entries.append(bench.engine.entries)
            bench.link.on_activity()

    bench.clock.meanwhile = interrupt
    bench.timer.callback(bench.timer)
    bench.clock.meanwhile = None
    if entries:
        assert bench.engine.entries > entries[0], "forgotten at point %d" % point
        entries[0] = bench.engine.entries
        assert bench.timer.period <= 50, "entered again too late, at point %d" % point
        bench.let_timer_fire()
        assert bench.engine.entries > entries[0], "never entered again, at point %d" % point
    return bool(entries)


def test_ctrl_c_inside_the_engine_goes_on_its_way_and_the_engine_too():
    bench = Bench(timer=False)

    def interrupted():
        bench.engine.meanwhile = None
        raise KeyboardInterrupt

    bench.engine.meanwhile = interrupted
    try:
        bench.pacer.tend()
    except KeyboardInterrupt:
        bench.pacer.tend()
        assert bench.engine.entries == 3 and bench.engine.recovered == 1
        return
    raise AssertionError("Ctrl-C got lost")


def test_no_interrupt_comes_in_while_the_engine_recovers_from_ctrl_c():
    bench = Bench()
    recover, entries = bench.engine.recover, []

    def interrupted():
        bench.engine.meanwhile = None
        raise KeyboardInterrupt

    def recover_interrupted(now):
        before = bench.engine.entries
        bench.link.on_activity()
        entries.append(bench.engine.entries - before)
        recover(now)

    bench.engine.meanwhile = interrupted
    bench.engine.recover = recover_interrupted
    bench.clock.now += 700 + 2 * OVERDUE_US
    try:
        bench.pacer.tend()
    except KeyboardInterrupt:
        assert entries == [0]
        bench.let_timer_fire()
        assert bench.engine.entries == 3
        return
    raise AssertionError("Ctrl-C got lost")


def test_ctrl_c_that_lands_in_an_interrupt_reaches_the_main_loop():
    """The handler must not raise: MicroPython would disable it for good."""
    bench = Bench()

    def interrupted():
        bench.engine.meanwhile = None
        raise KeyboardInterrupt

    bench.engine.meanwhile = interrupted
    bench.let_timer_fire()
    bench.link.on_activity()
    assert bench.engine.entries == 3
    try:
        bench.pacer.tend()
    except KeyboardInterrupt:
        bench.pacer.tend()
        return
    raise AssertionError("Ctrl-C got lost")


class PendingCtrlC:
    """True or false; whoever asks first is interrupted, as MicroPython does at its jumps."""

    def __init__(self, value):
        self._value = value
        self._pending = True

    def __bool__(self):
        if self._pending:
            self._pending = False
            raise KeyboardInterrupt
        return self._value


def interrupt(pacer, inside):
    """Ctrl-C comes in the moment in which the pacer asks whether somebody is inside the engine."""
    pacer._inside = PendingCtrlC(inside)


def is_inside(pacer):
    return pacer._inside


def test_ctrl_c_at_the_first_jump_of_a_handler_reaches_the_main_loop():
    bench = Bench()
    recover = bench.engine.recover

    def recover_interrupted(now):
        bench.link.on_activity()  # it has to wait
        recover(now)

    bench.engine.recover = recover_interrupted
    interrupt(bench.pacer, False)
    bench.let_timer_fire()
    assert bench.engine.recovered == 1 and bench.engine.entries == 1
    assert hears_ctrl_c(bench)
    bench.let_timer_fire()
    assert bench.engine.entries == 2


def test_ctrl_c_at_the_first_jump_of_a_handler_that_has_to_wait_reaches_the_main_loop():
    """It interrupts the engine: that goes on undisturbed, and is entered once more."""
    bench = Bench()

    def interrupted():
        bench.engine.meanwhile = None
        interrupt(bench.pacer, True)
        bench.link.on_activity()
        assert is_inside(bench.pacer), "the engine was open to others while somebody was inside"

    bench.engine.meanwhile = interrupted
    bench.pacer.run()
    assert bench.engine.entries == 3 and bench.engine.recovered == 0
    assert hears_ctrl_c(bench)


def hears_ctrl_c(bench):
    """Whether the main loop does, once."""
    heard = 0
    for _ in range(2):
        try:
            bench.pacer.tend()
        except KeyboardInterrupt:
            heard += 1
    return heard == 1


def test_a_timer_that_cannot_be_set_is_tried_again_by_the_main_loop():
    bench = Bench()
    init = bench.timer.init

    def fail(mode, period, tick_hz, callback):
        raise OSError("no alarm left")

    bench.timer.init = fail
    bench.let_timer_fire()
    assert isinstance(bench.pacer.failure, OSError)
    bench.timer.init = init
    bench.clock.now += 2 * OVERDUE_US
    bench.pacer.tend()
    assert bench.timer.period == 700


def test_an_exception_is_kept_in_and_the_engine_begins_anew():
    bench = Bench()

    def fail():
        raise ValueError("on purpose")

    bench.engine.meanwhile = fail
    bench.pacer.run()
    assert bench.engine.recovered == 1
    assert str(bench.pacer.failure) == "on purpose"
    bench.engine.meanwhile = None
    bench.let_timer_fire()  # it was set before, and comes 300 us too early
    assert bench.engine.entries == 2 and bench.timer.period == 300
    bench.let_timer_fire()
    assert bench.engine.entries == 3


def test_an_engine_that_failed_is_entered_again_after_a_millisecond():
    bench = Bench()
    bench.engine.due_us = 20_000
    bench.let_timer_fire()

    def fail():
        raise ValueError("on purpose")

    bench.engine.meanwhile = fail
    bench.pacer.run()
    bench.engine.meanwhile = None
    assert bench.timer.period == 1_000
    bench.let_timer_fire()
    assert bench.engine.entries == 4 and bench.engine.recovered == 1


def test_where_it_cannot_even_begin_anew_that_is_kept_and_the_main_loop_tries_again():
    for thrown in (ValueError, KeyboardInterrupt):
        bench = Bench()

        def fail(thrown=thrown):
            raise thrown("on purpose")

        def fail_again(now):
            raise OSError("nor this")

        recover = bench.engine.recover
        bench.engine.meanwhile, bench.engine.recover = fail, fail_again
        bench.pacer.run()
        assert str(bench.pacer.failure) == "nor this"
        bench.engine.meanwhile, bench.engine.recover = None, recover
        recover(bench.clock.now)
        entries = bench.engine.entries
        bench.clock.now += 2 * OVERDUE_US
        try:
            bench.pacer.tend()
        except KeyboardInterrupt:
            assert thrown is KeyboardInterrupt
        assert bench.engine.entries == entries + 1


def test_a_timer_that_never_comes_is_noticed_by_the_main_loop():
    for early_us in (0, 1_000_000):  # the counter of the clock begins anew meanwhile
        bench = Bench()
        bench.clock.now = -early_us
        bench.link.on_activity()
        bench.clock.now += 700 + 50_000
        assert bench.pacer.tend() is False and bench.engine.entries == 2
        bench.clock.now += 1
        assert bench.pacer.tend() is True and bench.engine.entries == 3
        assert bench.pacer.tend() is False and bench.engine.entries == 3


def test_the_main_loop_enters_the_engine_that_is_overtaken():
    bench = Bench()
    asked = []
    bench.engine.is_overtaken = lambda now: asked.append(now) or bench.engine.overtaken
    bench.clock.now = 17
    assert bench.pacer.tend() is False and bench.engine.entries == 1
    bench.engine.overtaken = True
    for entries in (2, 3):
        assert bench.pacer.tend() is True and bench.engine.entries == entries
    assert asked == [17] * 3


def test_without_a_timer_every_turn_of_the_main_loop_enters_the_engine():
    bench = Bench(timer=False)
    for _ in range(5):
        bench.pacer.tend()
    assert bench.engine.entries == 6


def test_after_stop_nothing_enters_the_engine_and_the_link_is_closed():
    bench = Bench()
    callback, timer = bench.timer.callback, bench.timer
    bench.pacer.stop()
    callback(timer)
    bench.pacer.tend()
    bench.pacer.run()
    bench.link.on_activity()
    assert bench.engine.entries == 1 and bench.link.closed
    assert bench.timer.period is None


def test_a_panel_whose_port_has_neither_interrupt_nor_timer_works():
    def start(board):
        board.timer = None
        return main.start(board)

    world = World(start, polled=True)
    world.run(1000)
    world.press("START")
    world.run(4000)
    assert world.lcd() == ("S: 10.0 F: 10.00", "RUNNING      A1 ")
    world.press("STOP")
    world.run(8000)
    assert world.drives[1].hz() == 0
    world.check()


def test_a_lost_timer_interrupt_delays_the_bus_and_stops_nothing():
    """As when MicroPython's queue of soft callbacks overflows."""
    world = World(main.start)
    world.run(1000)
    world.press("START")
    world.run(3000)
    bus = world.app.bus
    for _ in range(20):
        while bus.phase == SENDING:
            world.run(2)
        world.app.board.timer.deinit()
        world.run(150)
    world.run(500)
    assert world.lcd()[1] == "RUNNING      A1 " and world.app.bus.failures == 0
    world.check()
