# SPDX-License-Identifier: MIT
"""When the callbacks of an ESP32 come: the profile of its port, on which the panel is tried.

Figures are those of MicroPython's ports/esp32: IRQ_RXIDLE is a timer of two characters, of 12 bits
each and 500 us at least, whose second tick counts; every callback waits for the interpreter.
"""

import main
from boards.sim.clock import Clock, Event
from boards.sim.line.wire import Transceiver, Wire
from boards.sim.ports.chips import CHIPS
from boards.sim.ports.machine import Port
from boards.sim.ports.soft import COLLECTION_EVERY_US, COLLECTION_US, LATE_US, SoftChip
from boards.sim.ports.world import PortWorld
from boards.sim.ports.world import Wire as Enable

INTERPRETERS = "unix64 unix32"  # CPython's imports need its own `sys`

SEEDS = range(20)


class Talker:
    """A station that talks when it is told to."""

    name = "drive"

    def hear(self, *_):
        pass


class Bench:
    """A chip with a UART and a timer. came: when their callbacks came, in us."""

    def __init__(self, baud, random=None):
        self.clock = Clock()
        self.wire = Wire(self.clock, baud)
        self.chip = SoftChip(self.clock, self.wire, random)
        self.port = Port(CHIPS["ESP32S3"], self.chip)
        self.came = []
        options = {"bits": 8, "parity": 0, "stop": 1, "rxbuf": 512, "txbuf": 512}
        self.uart = self.port.UART(1, baud, tx=17, rx=18, **options)
        self.uart.irq(handler=self.note, trigger=self.uart.IRQ_RXIDLE)
        Transceiver(self.wire, self.uart, Enable())

    def note(self, _):
        self.came.append(self.clock.now_us)

    def hear(self, count):
        """Somebody sends so many characters; when the last stop bit is over."""
        talker = Talker()
        self.wire.attach(talker, self.uart.baud)
        return self.wire.talk(talker, bytes(count), count).end_us


def dice(seed):
    """A function of (low, high), as a chip takes it."""
    state = [seed * 7919 + 1]

    def random(low, high):
        state[0] = state[0] * 1103515245 + 12345 & 0x7FFFFFFF
        return low + (state[0] >> 8) % (high - low + 1)

    return random


def test_the_end_of_a_burst_is_told_500_us_or_two_characters_after_it_at_the_least():
    for baud, least_us in ((9_600, 2_500), (19_200, 1_250), (38_400, 625), (115_200, 500)):
        for count in (1, 16, 64):
            bench = Bench(baud)
            end_us = bench.hear(count)
            bench.clock.advance(200_000)
            late_us = bench.came[0] - LATE_US[1] - end_us
            assert least_us <= late_us <= 2 * least_us + 1, (baud, count, late_us)
            assert len(bench.came) == 1, (baud, count, bench.came)


def test_a_callback_waits_for_the_interpreter():
    waits_us = []
    for seed in SEEDS:
        bench = Bench(115_200, dice(seed))
        timer = bench.port.Timer(1)
        timer.init(mode=timer.ONE_SHOT, period=5, callback=bench.note)
        bench.clock.advance(20_000)
        (came_us,) = bench.came
        waits_us.append(came_us - 5_000)
    assert LATE_US[0] <= min(waits_us) < 300 and 600 < max(waits_us) <= LATE_US[1], waits_us


def test_a_collection_holds_every_callback_up():
    bench = Bench(115_200)
    timer = bench.port.Timer(1)
    timer.init(mode=timer.ONE_SHOT, period=1, callback=bench.note)
    bench.hear(4)
    bench.chip.hold()
    bench.clock.advance(COLLECTION_US)
    assert not bench.came
    bench.chip.let_go()
    assert bench.came == [COLLECTION_US, COLLECTION_US]


def test_the_panel_is_tried_under_collections_of_12_ms():
    world = PortWorld(main.start, "boards/esp32s3/board.py")
    world.run(1_000)
    held_ms = [0]

    def look():
        held_ms[0] += world.port.chip.frozen
        world.clock.schedule(again, world.clock.now_us + 1_000)

    again = Event(look)
    look()
    world.run(7_000)
    assert COLLECTION_US == 12_000 and COLLECTION_EVERY_US == 700_000
    assert 100 <= held_ms[0] <= 130, held_ms
