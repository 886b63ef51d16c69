# SPDX-License-Identifier: MIT
"""A master on the simulated chip, and up to 31 simulated drives of all families and layouts.

The master alone, without a panel: the engine works by interrupts, `run` is the main loop.

    fleet = Fleet()
    fleet.run(1000)                     # ms
    fleet.start_all()
    fleet.drives[5], fleet.motors[5]    # the master's drive, and the simulated one behind it
    fleet.cycle_us(20)                  # measured, over so many rounds
"""

from boards.sim.board import HardTimer
from boards.sim.chip.machine import UART, Chip, Pin
from boards.sim.clock import Clock
from boards.sim.drives import fleet
from boards.sim.drives.drive import Drive
from boards.sim.line.wire import Transceiver, Wire
from hal.link.bursts import IDLE_BITS
from hal.link.rs485 import Rs485Link
from hal.pacer import Pacer
from uss import families
from uss.layout import Layout
from uss.master import LOST_US, Master
from uss.timing import Timing

LOOP_US = 2_000

# Simulated family -> the master's.
FAMILIES = {
    "MICROMASTER 3": families.MM3,
    "MICROMASTER 420": families.MM420,
    "MICROMASTER 440": families.MM440,
    "SINAMICS G110": families.G110,
    "SINAMICS V20": families.V20,
    "SINAMICS G120": families.G120,
}


class Fleet:
    """kinds: of the drives, {address: keyword arguments of a simulated drive}; 31 of all kinds if
    None. interrupts: whether the UART has any. listed: False leaves them out of the master's
    list. lost_us: without a reply for so long, contact with a drive is lost.
    """

    def __init__(self, kinds=None, baud=19200, interrupts=True, listed=True, lost_us=LOST_US):
        self.clock = clock = Clock()
        self.wire = wire = Wire(clock, baud)
        self.chip = chip = Chip(clock, wire)
        self.motors = {}
        for address, kind in (kinds or fleet.kinds(31, wire.start_interval_us)).items():
            self.motors[address] = Drive(clock, wire, address, any_baud=True, **kind)
        uart = UART(chip, baud)
        driver_enable = Pin(chip)
        Transceiver(wire, uart, driver_enable)
        self.link_delay_us = IDLE_BITS * 1_000_000 // baud
        link = Rs485Link(uart, driver_enable, HardTimer(chip), clock, baud, interrupts)
        self.timing = Timing(baud)
        self.master = Master(link, self.timing, clock.ticks_mask, lost_us)
        self.drives = {}
        for address, motor in self.motors.items() if listed else ():
            self.drives[address] = self.master.turns.add(address, Layout(*motor.layout))
        self.pacer = Pacer(self.master, link, clock, HardTimer(chip))
        self.pacer.start()

    def family(self, address):
        return FAMILIES.get(self.motors[address].family.NAME, families.GENERIC)

    def run(self, ms):
        """Let time pass; the main loop comes round every 2 ms."""
        until = self.clock.now_us + round(ms * 1000)
        while self.clock.now_us < until:
            self.master.refresh(self.clock.ticks_us())
            self.pacer.tend()
            self.clock.advance(LOOP_US)

    def run_until(self, condition, limit_ms=20_000):
        until = self.clock.now_us + limit_ms * 1000
        while not condition():
            assert self.clock.now_us < until, "it did not come so far"
            self.run(2)

    def start_all(self, but=()):
        """ON to all of them, half of their reference frequency."""
        for address, drive in self.drives.items():
            if address not in but:
                drive.start(0x2000, self.family(address).on)
        running = [motor for address, motor in self.motors.items() if address not in but]
        self.run_until(lambda: all([motor.state == "running" for motor in running]))

    def predicted_us(self):
        """A round of the list, from the layouts and the drives' delays."""
        exchanges = []
        for drive in self.master.turns.list:
            net_count = drive.layout.net_count
            delay_us = self.motors[drive.address].reply_delay_us
            exchanges.append((net_count, net_count, delay_us))
        return self.timing.cycle_us(exchanges, self.link_delay_us)

    def cycle_us(self, rounds):
        """A round of the list, measured over so many."""
        first = self.drives[0]
        began = self._next_turn(first)
        for _ in range(rounds):
            ended = self._next_turn(first)
        return (ended - began) / rounds

    def _next_turn(self, drive):
        """When the next good reply of this drive was taken, to 2 ms."""
        good = drive.counters[0]
        self.run_until(lambda: drive.counters[0] != good)
        return self.clock.now_us

    def requests(self, since, address):
        """Telegrams of the master to this address among those since the log had `since`."""
        telegrams = self.wire.log.last(self.wire.log.count - since)
        return len([1 for _, mine, characters in telegrams if mine and characters[2] == address])

    def check(self):
        """AssertionError: a rule of the line was broken, or an interrupt handler failed."""
        assert not self.wire.violations(), self.wire.violations()[:3]
        assert not self.chip.handler_errors and self.pacer.failure is None, self.pacer.failure
        assert self.master.failures == 0
