# SPDX-License-Identifier: MIT
"""A panel on a real line: the virtual board, but for its UART, which is a port of the computer.

The display, the keys and the chip around the firmware are simulated as ever, but in real time. At
the port are real drives, or simulated ones that another program serves.

    world = PortWorld(main.start, port, (1, 2), 19200, clock=RealClock(stopwatch))
    world.run(1000)                 # takes a second
    world.close()                   # OFF1 to every drive, before anything else
    world.unconfirmed()             # addresses of drives that have not answered it

port: as link.py has it, and wait(ms): returns when something has come, or so much later;
name: for people; is_cut.
"""

from boards.sim.board import Board
from boards.port.link import PortLink
from boards.sim.script import ORDER
from boards.sim.world import World

STEP_MS = 1  # between two steps of the main loop, while nothing comes
HANG_STEP_MS = 20

# Of the script language what is done to the panel; all else is done to simulated drives.
TO_THE_PANEL = (
    "press", "hold", "down", "up", "setpoint", "wait", "lcd", "expect", "bus", "hang", "reset",
    "power",
)  # fmt: skip
NOT_SIMULATED = "no drive is simulated here: the line is a real one"


class PortBoard(Board):
    """The main loop paces the bus: nothing of this computer interrupts it."""

    def __init__(self, port, wire, *others):
        Board.__init__(self, *others)
        self.timer = None
        self._port = port
        self._wire = wire

    def make_link(self, baud):
        return PortLink(self._port, self.clock, self._wire)

    def idle(self):
        self._port.wait(STEP_MS)
        self.clock.follow()


class PortWorld(World):
    """addresses: of the drives that the panel looks for. Others as of `World`."""

    refused = {command: NOT_SIMULATED for command in ORDER if command not in TO_THE_PANEL}

    def __init__(self, start, port, addresses, baud, clock, settings=None, **others):
        self.port = port
        self._closed = False
        self.notices = []
        settings = dict(settings or {}, drives=list(addresses))
        World.__init__(self, start, (), baud, settings, clock=clock, **others)

    @property
    def place(self):
        return self.port.name + (" (LINE CUT)" if self.port.is_cut else "")

    def make_board(self, loop_us, cause):
        return PortBoard(
            self.port, self.wire, self.chip, self.lcd_chip, self.keypad, self.store, False, None,
            cause, self.usb,
        )  # fmt: skip

    def run(self, ms):
        """Let so many milliseconds pass, the firmware stepping: they really pass."""
        World.run(self, ms)
        notices, self.port.notices = self.port.notices, []
        self.notices += notices

    def close(self):
        if not self._closed:
            self._closed = True
            World.close(self)

    def hang(self, ms):
        until_us = self.clock.true_us() + ms * 1000
        while self.clock.true_us() < until_us and not self._bitten:
            self.port.wait(HANG_STEP_MS)
            self.clock.follow()
        if self._bitten:
            self.reset()
        self.run(max(0, until_us - self.clock.true_us()) // 1000)

    def unconfirmed(self):
        """After `close`: the addresses of the drives that have not answered OFF1."""
        return [
            drive.address
            for drive in self.app.bus.turns.drives
            if not (drive.contact and drive.answered_off())
        ]
