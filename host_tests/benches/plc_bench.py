# SPDX-License-Identifier: MIT
"""A PLC with the USS blocks, and drives on its line, in virtual time: for the tests of `s7`.

In use:

    plc = Plc((1, 2))                   # nodes 1 and 2, simulated drives
    plc.motor(1).RUN = True             # the inputs of the USS_CTRL of node 1
    plc.run(500)                        # scans, for so many milliseconds
    plc.outputs(1).RUN_EN
"""

from boards.sim.board import HardTimer
from boards.sim.chip.machine import UART, Chip, Pin
from boards.sim.clock import Clock
from boards.sim.drives.drive import Drive
from boards.sim.line.wire import Transceiver, Wire
from hal.link.rs485 import Rs485Link
from hal.pacer import Pacer
from uss.master import Master
from uss.s7 import TYPES, USS_CTRL, USS_INIT, Port
from uss.timing import Timing

BAUD = 19200
SCAN_US = 2_000
QUICK = {1120: 1.0, 1121: 1.0, 1135: 0.5}  # ramps, s

# Codes that nothing on this link leads to, and why; s7/README.md says so, too.
NEVER = {
    3: "parity",  # no UART of MicroPython tells of it: the character is wrong or missing
    14: "DB_PTR",  # the blocks need no memory of the program
}


class Inputs:
    """Of one USS_CTRL; every scan hands them to it."""

    def __init__(self, address):
        self.EN = True
        self.RUN = False
        self.OFF2 = False
        self.OFF3 = False
        self.F_ACK = False
        self.DIR = False
        self.DRIVE = address
        self.TYPE = 1
        self.SPEED_SP = 50.0


class Plc:
    """addresses: of the drives on the line and in ACTIVE, a USS_CTRL for each. kinds: of those
    that are no MICROMASTER 420 with these parameters, what the simulated `Drive` is made with.

    types: for TYPE. paced: the engine runs by interrupts. drives: the simulated ones by address.
    others: what else is to be called in each scan, functions.
    """

    def __init__(self, addresses=(1,), parameters=None, paced=False, kinds=None, types=TYPES):
        self.clock = Clock()
        self.wire = Wire(self.clock, BAUD)
        usual = {"parameters": QUICK if parameters is None else parameters}
        self.drives = {}
        for address in addresses:
            kind = (kinds or {}).get(address, usual)
            self.drives[address] = Drive(self.clock, self.wire, address, **kind)
        self.chip = Chip(self.clock, self.wire)
        self.paced = paced
        self.pacer = None
        self.port = Port(lambda baud: self.open_bus(baud), self.clock, types, polled=not paced)
        self.init = USS_INIT(self.port)
        self.inputs = {address: Inputs(address) for address in addresses}
        self.controls = {address: USS_CTRL(self.port) for address in addresses}
        self.others = []
        self.active = sum(1 << address for address in addresses)
        self.port.scan()
        self.init(EN=True, MODE=1, BAUD=BAUD, ACTIVE=self.active)
        assert self.init.DONE and self.init.ERROR == 0, self.init.ERROR

    def open_bus(self, baud):
        driver_enable = Pin(self.chip)
        uart = UART(self.chip, baud)
        Transceiver(self.wire, uart, driver_enable)
        timer = HardTimer(self.chip)
        link = Rs485Link(uart, driver_enable, timer, self.clock, baud, interrupts=self.paced)
        bus = Master(link, Timing(baud), self.clock.ticks_mask)
        if self.paced:
            self.pacer = Pacer(bus, link, self.clock, HardTimer(self.chip))
            self.pacer.start()
        return bus

    def motor(self, address=1):
        return self.inputs[address]

    def outputs(self, address=1):
        return self.controls[address]

    def drive(self, address=1):
        """The simulated one."""
        return self.drives[address]

    def scan(self):
        """One scan of the program."""
        self.port.scan()
        for address, control in self.controls.items():
            inputs = self.inputs[address]
            control(
                EN=inputs.EN,
                RUN=inputs.RUN,
                OFF2=inputs.OFF2,
                OFF3=inputs.OFF3,
                F_ACK=inputs.F_ACK,
                DIR=inputs.DIR,
                DRIVE=inputs.DRIVE,
                TYPE=inputs.TYPE,
                SPEED_SP=inputs.SPEED_SP,
            )
        for other in self.others:
            other()

    def run(self, ms):
        """Scans, one after the other, for so long."""
        until_us = self.clock.now_us + ms * 1000
        while self.clock.now_us < until_us:
            self.scan()
            self.clock.advance(SCAN_US)

    def hang(self, ms):
        """The program does nothing for so long; interrupts do."""
        self.clock.advance(ms * 1000)

    def start(self, address=1, ms=1_500):
        """Have contact, then switch RUN on and let the motor reach its speed."""
        self.run(300)
        self.motor(address).RUN = True
        self.run(ms)
        assert self.drive(address).state == "running", self.drive(address).state

    def check(self):
        """The rules of the line were kept."""
        assert not self.wire.violations(), self.wire.violations()
        assert not self.chip.handler_errors, self.chip.handler_errors
