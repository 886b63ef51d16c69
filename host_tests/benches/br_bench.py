# SPDX-License-Identifier: MIT
"""A PLC with the blocks of the B&R project, and drives on its line: for the tests of `br`.

In use:

    plc = Plc((1, 2))                   # simulated G110s 1 and 2, in the sequence, started
    plc.wanted(1).Run = True            # DriveSetup[1].PZD
    plc.run(500)                        # scans, for so many milliseconds
    plc.told(1).StatusWord.DriveRunning
"""

from boards.sim.board import HardTimer
from boards.sim.chip.machine import UART, Chip, Pin
from boards.sim.clock import Clock
from boards.sim.drives.drive import Drive
from boards.sim.drives.families import g110
from boards.sim.line.wire import Transceiver, Wire
from hal.link.rs485 import Rs485Link
from uss.br import DriveController
from uss.master import Master
from uss.timing import Timing

BAUD = 19200  # the rate of the source
SCAN_US = 2_000
QUICK = {1120: 1.0, 1121: 1.0, 1135: 0.5, 2014: 0}  # ramps, s


class Plc:
    """addresses: of the simulated G110s, which are the sequence too. kinds: of those that are
    something else, what the simulated `Drive` is made with; families: as of DriveController."""

    def __init__(self, addresses=(1,), kinds=None, families=None):
        self.clock = Clock()
        self.wire = Wire(self.clock, BAUD)
        usual = {"family": g110, "parameters": QUICK}
        self.drives = {}
        for address in addresses:
            kind = (kinds or {}).get(address, usual)
            self.drives[address] = Drive(self.clock, self.wire, address, **kind)
        self.chip = Chip(self.clock, self.wire)
        self.controller = DriveController(self.open_bus, self.clock, families)
        self.sequence(*addresses)
        for address in addresses:
            self.wanted(address).Freq = 25.0
        self.controller()
        self.controller.Cmd.Start = True
        self.controller()
        self.controller.Cmd.Start = False

    def open_bus(self):
        driver_enable = Pin(self.chip)
        uart = UART(self.chip, BAUD)
        Transceiver(self.wire, uart, driver_enable)
        timer = HardTimer(self.chip)
        self.link = Rs485Link(uart, driver_enable, timer, self.clock, BAUD, interrupts=False)
        return Master(self.link, Timing(BAUD), self.clock.ticks_mask)

    def sequence(self, *addresses):
        """ControllSequence: these, then 255."""
        self.controller.DriveSequence.ControllSequence[1:] = list(addresses) + [255] * (
            255 - len(addresses)
        )

    def wanted(self, address=1):
        return self.controller.DriveSetup[address].PZD

    def lengths(self, address=1):
        return self.controller.DriveSetup[address].Lengh

    def told(self, address=1):
        return self.controller.DriveData[address]

    @property
    def status(self):
        return self.controller.Status

    def run(self, ms):
        """Scans, one after the other, for so long."""
        until_us = self.clock.now_us + ms * 1000
        while self.clock.now_us < until_us:
            self.controller()
            self.clock.advance(SCAN_US)

    def acknowledge_errors(self):
        self.controller.Cmd.ErrorAcknowledge = True
        self.run(4)
        self.controller.Cmd.ErrorAcknowledge = False

    def start(self, address=1, ms=2_000):
        """Have contact, then switch Run on and let the motor reach its speed."""
        self.run(500)
        self.wanted(address).Run = True
        self.run(ms)
        assert self.drives[address].state == "running", self.drives[address].state

    def check(self):
        """The rules of the line were kept."""
        assert not self.wire.violations(), self.wire.violations()
        assert not self.chip.handler_errors, self.chip.handler_errors
