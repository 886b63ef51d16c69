"""The bus engine takes no memory: it works in hard interrupts, where the heap is locked.

The simulated chip locks the heap while an interrupt runs, so whatever allocates there raises
MemoryError. On the 32-bit port small integers have 31 bits, as on the RP2040 and the ESP32.
"""

import main
from boards.sim.world import World
from uss import pkw

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
    drive = bus.drives[0]
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
