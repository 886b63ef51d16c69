# SPDX-License-Identifier: MIT
"""The bus engine takes no memory: it works in hard interrupts, where the heap is locked.

The simulated chip locks the heap while an interrupt runs, so whatever allocates there raises
MemoryError. On the 32-bit port small integers have 31 bits, as on the RP2040 and the ESP32.
"""

import gc
import sys

import micropython

import main
from boards.sim.drives.families import generic
from boards.sim.world import World
from fleet_bench import Fleet
from hal.link.self_directed import SelfDirectedLink
from uss import pkw, pzd
from uss.drive import ATTENTION, Drive
from uss.families.status import TranslatedDrive
from uss.fast import python
from uss.layout import Layout
from uss.master import Master
from uss.outside import Broadcast, Mirror, Special
from uss.timing import Timing

INTERPRETERS = "unix64 unix32"

EXCHANGES = 10_000


def heap_is_locked():
    try:
        bytearray(16)
    except MemoryError:
        return True
    return False


def parameter_jobs():
    """16 and 32 bits and floating point, read and written, RAM and EEPROM, and refused."""
    while True:
        yield pkw.read(2000), 50.0
        yield pkw.read(700), 5
        yield pkw.write_float(1120, 8.25), 8.25
        yield pkw.write_float(1121, 9.5, eeprom=True), 9.5
        yield pkw.read(1120), 8.25
        yield pkw.read(2019, 0), 0x00340000  # a connector: r0052, needs all 32 bits
        yield pkw.read(2024, 0), None
        yield pkw.write_word(3, 2, eeprom=True), 2
        yield pkw.write_float(1120, -1.0), pkw.REFUSED
        yield pkw.read(1999), pkw.REFUSED


def check(job, expected):
    if expected is pkw.REFUSED:
        assert job.state == pkw.REFUSED, job
    else:
        assert job.state == pkw.DONE, job
        if expected is not None:
            is_float = isinstance(expected, float)
            value = job.float_value() if is_float else job.integer_value()
            assert value == expected, (job, value)


def test_ten_thousand_exchanges_with_the_heap_locked():
    world = World(main.start, baud=57600)
    world.run(1000)
    world.press("START")
    bus = world.app.bus
    entries = [0, 0]
    poll = bus.poll

    def counted(now):
        entries[0] += 1
        if entries[0] % 100 == 0:
            entries[1] += heap_is_locked()
        return poll(now)

    bus.poll = counted
    drive = bus.turns.drives[0]
    good = world.drives[1].read(2024, 0)
    done = 0
    jobs = parameter_jobs()
    job, expected = next(jobs)
    drive.ask(job)
    while world.drives[1].read(2024, 0) - good < EXCHANGES:
        world.run(2)
        if job.state != pkw.PENDING:
            check(job, expected)
            done += 1
            job, expected = next(jobs)
            drive.ask(job)
    assert entries[1] > entries[0] // 100 - 10, entries
    assert done > EXCHANGES // 10
    assert world.drives[1].state == "running"
    assert bus.failures == 0 and world.app.pacer.failure is None
    world.check()


def test_an_engine_that_takes_memory_would_be_noticed():
    """The check can fail: a poll that allocates in the interrupt is caught and counted."""
    world = World(main.start)
    world.run(1000)
    bus = world.app.bus
    poll = bus.poll

    def wasteful(now):
        bytearray(100)
        return poll(now)

    bus.poll = wasteful
    world.run(100)
    assert bus.failures > 0 and isinstance(world.app.pacer.failure, MemoryError)


# --- every layout, and everything that a bus does -----------------------------------------------

LAYOUTS = [(pkw_words, pzd_words) for pkw_words in (0, 3, 4, 127) for pzd_words in range(17)][1:]


def fleet_of(layouts):
    """Drives of these layouts, the first at address 0."""
    kinds = {}
    for address, (pkw_words, pzd_words) in enumerate(layouts):
        parameters = {2013: pkw_words, 2012: pzd_words}
        kinds[address] = {"family": generic, "parameters": parameters, "reply_delay_us": 1_300}
    return Fleet(kinds, baud=115200)


def all_ask(fleet):
    """Everybody with a parameter channel is asked something, again and again."""
    jobs = {}

    def again():
        for address, drive in fleet.drives.items():
            job = jobs.get(address)
            if drive.layout.pkw_words and not (job and job.state == pkw.PENDING):
                jobs[address] = pkw.read(2011)
                drive.ask(jobs[address])

    return again


def check_locked(fleet, work, ms):
    """Let time pass, and do `work()` now and then; in the engine the heap was locked each time."""
    master = fleet.master
    entries = [0, 0]
    poll = master.poll

    def counted(now):
        entries[0] += 1
        entries[1] += heap_is_locked()
        return poll(now)

    master.poll = counted
    for _ in range(ms // 10):
        work()
        fleet.run(10)
    assert entries[0] > ms // 10 and entries[1] > 0.8 * entries[0], entries
    fleet.check()


def test_no_layout_takes_memory():
    for first in range(0, len(LAYOUTS), 23):
        layouts = LAYOUTS[first : first + 23]
        fleet = fleet_of(layouts)
        fleet.run(500)
        for drive in fleet.master.turns.drives:
            if drive.layout.pzd_words:
                drive.start(0x1000)
            for place in range(3, drive.layout.pzd_words + 1):
                drive.put(place, 0x1111 * place & 0xFFFF)
        check_locked(fleet, all_ask(fleet), 1_500)
        for drive in fleet.master.turns.drives:
            assert drive.counters[0] > 3 and not any(drive.counters[1:]), (drive, drive.counters)


def test_nothing_that_a_bus_does_takes_memory():
    """Retries, back-off, turns for the off time, a fixed cycle, an echo; telegrams outside the
    list; drives that come and go, off and on."""
    fleet = Fleet(baud=115200)
    master = fleet.master
    fleet.run(1_000)
    fleet.start_all(but=(3, 4))
    master.retries = 2
    master.turns.cycle_us = 400_000
    master.deadlines.supervise(fleet.drives[1], 400)
    fleet.motors[3].unplug()
    fleet.motors[5].unplug()
    ask = all_ask(fleet)
    step = [0]

    def work():
        ask()
        step[0] += 1
        singles = (
            Mirror(9),
            Broadcast((pzd.OFF1, 0), {2: 0xFFFF}),
            Special(9, b"\x01\x02"),
            Special(None, b"\x01"),
        )
        if step[0] % 20 == 0 and not 120 < step[0] < 310:
            master.turns.post(singles[step[0] // 20 % 4])
        if step[0] % 50 == 0:
            fleet.wire.echo = not fleet.wire.echo
        if step[0] == 120:
            master.off()
        if step[0] == 300:
            master.on()
        if step[0] % 8 == 0:
            fleet.drives[step[0] // 8 % 31].acknowledge()

    check_locked(fleet, work, 6_000)


# --- how much it takes once ---------------------------------------------------------------------

WORD = 4 if sys.maxsize < 1 << 32 else 8
MASK = (1 << 30) - 1


class Nowhere:
    """A link that is never used."""

    interrupts = True


def taken(make):
    """Bytes of heap that stay taken by what `make` makes."""
    make()  # whatever is made only once is there
    gc.collect()
    before = gc.mem_alloc()
    made = make()
    gc.collect()
    after = gc.mem_alloc()
    return after - before if made else 0


def test_a_drive_takes_less_than_600_bytes():
    """On the 32-bit build, in the layout that most drives have."""
    shared = bytearray(ATTENTION)
    used = taken(lambda: [Drive(1, MASK, shared) for _ in range(100)]) / 100
    print("%d bytes" % used)
    assert used < 600 * WORD // 4


def test_a_status_word_with_other_bits_takes_no_heap():
    says = ((0x0001, 0x0001, pzd.ZSW_READY), (0x0800, 0x0800, pzd.ZSW_RUNNING))
    drive = TranslatedDrive(says, 1, MASK, None, Layout(4, 2))
    reply = bytearray(16)
    reply[11] = 0x88
    micropython.heap_lock()
    try:
        drive.take(reply, 16, 1000)
    finally:
        micropython.heap_unlock()
    assert (drive.zsw, drive.word(1)) == (pzd.ZSW_RUNNING, 0x8800)


def test_the_loops_without_machine_code_take_no_heap():
    """A port that compiles none runs these in interrupts."""
    request, received = bytearray(24), bytearray(64)
    micropython.heap_lock()
    try:
        python.frame(request, 24, 1)
        python.copy(request, received, 0, 24)
        answers = python.is_reply(received, 24, request)
    finally:
        micropython.heap_unlock()
    assert not answers and received[:24] == request


def test_a_drive_that_is_doubted_takes_no_more():
    """An interrupt that comes while the table of its fields grows finds some missing, and what it
    writes is lost: a STOP, for one."""
    drive = Drive(1, MASK)
    micropython.heap_lock()
    try:
        drive.doubt()
    finally:
        micropython.heap_unlock()
    assert drive.doubted


def test_a_bus_with_31_drives_takes_less_than_32_kb():
    def make(layouts):
        master = Master(Nowhere(), Timing(19200), MASK)
        for address in range(31):
            master.turns.add(address, Layout(*layouts[address % len(layouts)]))
        return master

    for layouts in (((4, 2),), ((4, 2), (3, 2), (127, 6), (4, 16), (0, 2))):
        used = taken(lambda: make(layouts))
        print("%d bytes" % used)
        assert used < 32_768 * WORD // 4


# --- a telegram that is on its way while the clock wraps -----------------------------------------


class WrappingClock:
    """The RP2040's: its last tick is the largest small integer of a chip."""

    ticks_mask = (1 << 30) - 1

    def __init__(self):
        self.now_us = 0

    def ticks_us(self):
        return self.now_us


class SendingUart:
    """What a link that needs no driver enable asks of a UART that sends."""

    IRQ_RXIDLE = 1

    def irq(self, handler, trigger, hard=False):
        pass

    def write(self, buffer, count):
        pass


def test_a_telegram_is_sent_across_the_wrap_of_the_clock_without_memory():
    clock = WrappingClock()
    link = SelfDirectedLink(SendingUart(), clock, 19200, 1_000, 2_000)
    telegram = bytearray(16)
    for before_us in range(0, 20_000, 500):
        clock.now_us = clock.ticks_mask - before_us
        micropython.heap_lock()
        try:
            link.send(telegram, 16)
        finally:
            micropython.heap_unlock()
        left_us = (link.sent_at - clock.now_us) & clock.ticks_mask
        assert 16 * 572 <= left_us <= 16 * 573, (before_us, left_us)
