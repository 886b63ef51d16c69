# SPDX-License-Identifier: MIT
"""Stations of several baud rates on one line: who talks at another rate makes noise."""

from boards.sim.chip.machine import UART, Chip, Pin
from boards.sim.clock import Clock
from boards.sim.drives.drive import Drive
from boards.sim.drives.families import v20
from boards.sim.line.wire import GARBLE, Transceiver, Wire
from drive_bench import OFF1, telegram
from tools.examples.simulation import Stage
from uss.bus import Master
from uss.finding.scan import RateScan

REQUEST = telegram(1, 0, 0, 0, 0, OFF1, 0)
CHARACTER_US = 1146  # at 9600 baud


class Station:
    """It talks at any rate, and notes the rate and the end of what it hears."""

    def __init__(self, wire, baud, name="master"):
        self.name = name
        self.wire = wire
        self.heard = []
        wire.attach(self, baud)

    def hear(self, burst):
        self.heard.append((burst.baud, bytes(burst.data[: burst.count]), burst.end_us))

    def asks(self, characters, wait_us=200_000):
        """The replies."""
        del self.heard[:]
        self.wire.talk(self, characters, len(characters))
        self.wire.clock.advance(wait_us)
        return [(baud, reply[2]) for baud, reply, _ in self.heard]


def line():
    """A line of 19200 baud on which drive 2 is at 9600 baud."""
    wire = Wire(Clock(), 19200)
    drives = [Drive(wire.clock, wire, 1), Drive(wire.clock, wire, 2, {2010: 6})]
    return wire, drives


def test_each_drive_answers_at_its_own_rate_and_hears_noise_at_the_other():
    wire, drives = line()
    for baud, answers, is_deaf in ((19200, 0, 1), (9600, 1, 0)):
        master = Station(wire, baud)
        before = [list(drive.slave.counters()) for drive in drives]
        for address in (1, 2):
            request = telegram(address, 0, 0, 0, 0, OFF1, 0)
            expected = [(baud, address)] if address == answers + 1 else []
            assert master.asks(request) == expected, (baud, address)
        counters = [drive.slave.counters() for drive in drives]
        assert counters[answers][1] == before[answers][1]
        assert counters[answers][0] == before[answers][0] + 1
        assert counters[is_deaf][0] == before[is_deaf][0]
        assert counters[is_deaf][2] > before[is_deaf][2]
        wire.detach(master)
    assert wire.violations() == []


def test_a_telegram_takes_the_time_of_its_talkers_rate():
    wire, _ = line()
    master, other = Station(wire, 9600), Station(wire, 19200, "other")
    wire.talk(master, REQUEST, len(REQUEST))
    wire.clock.advance(50_000)
    assert other.heard == [(9600, REQUEST, 16 * 11_000_000 // 9600)]


def test_the_silence_before_a_telegram_is_judged_by_its_talkers_rate():
    wire, _ = line()
    slow, fast = Station(wire, 9600, "slow"), Station(wire, 19200, "fast")
    for station, silence_us in ((fast, 1146), (slow, 2292), (fast, 1146), (slow, 2000)):
        wire.clock.advance_to(max(wire.clock.now_us, wire.busy_until_us()) + silence_us)
        wire.talk(station, REQUEST[:8], 8)
    assert len(wire.violations()) == 1
    told = "slow talks after 2000 us of silence, the start interval is 2292 us"
    assert wire.violations()[0].endswith(told)


def test_a_new_rate_holds_from_the_next_telegram_on():
    wire, drives = line()
    fast, slow = Station(wire, 19200), Station(wire, 9600, "slow")
    del drives[1]
    change = telegram(1, 0x200A, 0x8000, 0, 6, OFF1, 0)  # P2010[0] = 6: 9600 baud
    assert fast.asks(change) == [(19200, 1)]
    assert drives[0].slave.baud == 9600
    assert fast.asks(REQUEST) == []
    assert (9600, 1) in slow.asks(REQUEST)


def test_a_uart_of_another_rate_gets_garbage():
    wire = Wire(Clock(), 19200)
    chip = Chip(wire.clock, wire)
    uart = UART(chip, 19200)
    Transceiver(wire, uart, Pin(chip))
    for baud, received in ((19200, REQUEST), (9600, GARBLE[:16])):
        station = Station(wire, baud)
        wire.talk(station, REQUEST, len(REQUEST))
        wire.clock.advance(50_000)
        buffer = bytearray(40)
        assert uart.readinto(buffer) == 16 and bytes(buffer[:16]) == received
        wire.detach(station)
    assert GARBLE[0] != 2, "no telegram begins like this"


def test_a_program_finds_drives_as_delivered_whatever_their_rate():
    for kind, baud, address in (({}, 9600, 0), ({"family": v20}, 38400, 1)):
        kind["factory"] = True
        stage = Stage((8,), kinds={8: kind})
        buses = []

        def open_bus(rate, board=stage.board, buses=buses):
            if buses:
                buses[-1].close()
            buses.append(Master(board.make_link(rate), baud=rate, idle=board.idle))
            return buses[-1]

        scan = RateScan(
            open_bus, stage.clock.ticks_mask, nothing_runs=True, rates=(19200, 9600, 38400),
            addresses=(0, 1, 8), enquire=False,
        )  # fmt: skip
        while not scan.step(stage.board.clock.ticks_us()) and stage.clock.now_us < 60_000_000:
            buses[-1].wait(0.002)
        assert (scan.baud, list(scan.found)) == (baud, [address])
        stage.check()
