# SPDX-License-Identifier: MIT
"""What may be on the simulated line besides one drive: an echo, a second master, many drives."""

from boards.sim.chip.machine import UART, Chip, Pin
from boards.sim.clock import Clock
from boards.sim.drives import fleet
from boards.sim.drives.drive import Drive
from boards.sim.drives.families import g110, mm3
from boards.sim.line.intruder import Intruder
from boards.sim.line.wire import Transceiver, Wire
from boards.sim.world import Surroundings
from drive_bench import OFF1, Bench, telegram

REQUEST = telegram(1, 0, 0, 0, 0, OFF1, 0)
REPLY = telegram(1, 0, 0, 0, 0, 0xFB31, 0)


class Panel:
    """A chip with a UART and a switched driver at a line with a drive."""

    def __init__(self, echo, reply_delay_us=None, baud=19200):
        self.clock = Clock()
        self.wire = Wire(self.clock, baud)
        self.wire.echo = echo
        self.chip = Chip(self.clock, self.wire)
        self.uart = UART(self.chip, baud)
        self.driver_enable = Pin(self.chip)
        Transceiver(self.wire, self.uart, self.driver_enable)
        self.drive = Drive(self.clock, self.wire, 1, reply_delay_us=reply_delay_us)
        self.interrupts = []
        self.uart.irq(self.note, UART.IRQ_RXIDLE, hard=True)
        self.chunks = [bytearray(64) for _ in range(4)]
        self.counts = []

    def note(self, uart):
        self.counts.append(uart.readinto(self.chunks[len(self.counts)]))

    def heard(self):
        return [bytes(chunk[:count]) for chunk, count in zip(self.chunks, self.counts)]

    def exchange(self):
        self.counts = [0][:0]
        self.clock.advance(self.wire.start_interval_us)
        self.driver_enable.on()
        self.uart.write(REQUEST)
        self.clock.advance(self.wire.ends[len(REQUEST) - 1])
        self.driver_enable.off()
        self.clock.advance(100_000)
        return self.heard()


def test_without_an_echo_only_the_reply_is_heard():
    panel = Panel(echo=False)
    assert panel.exchange() == [REPLY]
    assert panel.exchange() == [REPLY]
    assert panel.wire.violations() == []


def test_with_an_echo_the_own_telegram_is_heard_before_the_reply():
    # The first character of a reply that keeps the rules is over 33 bits after the request, the
    # interrupt comes after 32: two bursts, however soon the reply comes.
    for delay_us in (1_146, 1_719, 5_000):
        assert Panel(echo=True, reply_delay_us=delay_us).exchange() == [REQUEST, REPLY]
    assert Panel(echo=True, reply_delay_us=1_000).exchange() == [REQUEST + REPLY]


def test_the_echo_may_come_and_go():
    panel = Panel(echo=True, reply_delay_us=5_000)
    assert panel.exchange() == [REQUEST, REPLY]
    panel.wire.echo = False
    assert panel.exchange() == [REPLY]
    panel.wire.echo = True
    assert panel.exchange() == [REQUEST, REPLY]
    assert panel.wire.violations() == [] and panel.chip.handler_errors == []


def test_the_echo_comes_in_character_by_character():
    panel = Panel(echo=True)
    panel.uart.irq(None)
    panel.clock.advance(10_000)
    panel.driver_enable.on()
    panel.uart.write(REQUEST)
    for i in range(len(REQUEST)):
        assert panel.uart.any() == i
        panel.clock.advance_to(10_000 + panel.wire.ends[i])
    assert panel.uart.any() == len(REQUEST)


def test_a_second_master_talks_now_and_then():
    bench = Bench()
    foreign = telegram(5, 0, 0, 0, 0, OFF1, 0)
    intruder = Intruder(bench.clock, bench.wire, foreign, period_us=100_000)
    bench.wait(1)
    assert bench.heard == []
    intruder.begin()
    bench.wait(1.05)
    assert intruder.sent == 10 and [data for _, data in bench.heard] == [foreign] * 10
    intruder.end()
    bench.wait(1)
    assert intruder.sent == 10 and bench.wire.violations() == []
    # It does not care who is talking: that is a breach of the rules, and the drive hears nothing.
    intruder.begin()
    bench.wait(0.095)
    assert bench.ask(REQUEST) != REPLY
    assert "intruder talks while master talks" in bench.wire.violations()[0]


# --- many drives ------------------------------------------------------------------------------


def pkw_of(drive):
    return [0] * min(drive.layout[0], 3 if drive.layout[0] == 127 else 4)


def test_a_fleet_of_all_families_and_layouts():
    bench = Bench({2011: 31})
    drives = {
        address: Drive(bench.clock, bench.wire, address, **kind)
        for address, kind in fleet.kinds(31, bench.wire.start_interval_us).items()
    }
    assert len({drive.family.NAME for drive in drives.values()}) == 7
    assert len({drive.layout for drive in drives.values()}) >= 9
    assert len({drive.reply_delay_us for drive in drives.values()}) == 31
    for address, drive in drives.items():
        assert drive.address == address
        words = pkw_of(drive) + ([OFF1] + [0] * 15)[: drive.layout[1]]
        asked_us = bench.clock.now_us
        reply = bench.ask(telegram(address, *words))
        assert len(reply) == len(words) * 2 + 4, address
        took_us = bench.heard[0][0] - asked_us
        expected_us = bench.wire.start_interval_us + bench.wire.ends[len(reply) - 1]
        assert abs(took_us - expected_us - drive.reply_delay_us) <= 1
        assert drive.state == "ready"
    assert bench.wire.violations() == []


def test_a_world_has_drives_of_different_kinds():
    kinds = {
        2: {"family": mm3},
        3: {"family": g110, "parameters": {2013: 0}, "reply_delay_us": 4_000},
    }
    world = Surroundings(Clock(), (1, 2, 3), 19200, None, 0, kinds=kinds)
    names = [world.drives[address].family.NAME for address in (1, 2, 3)]
    assert names == ["MICROMASTER 420", "MICROMASTER 3", "SINAMICS G110"]
    assert world.drives[3].layout == (0, 2) and world.drives[3].reply_delay_us == 4_000
    # Without parameters of their own they are supervised, each in its family's unit.
    assert world.drives[1].read(2014) == 2_000 and world.drives[2].read(93) == 2
    assert world.drives[3].read(2014) == 0
