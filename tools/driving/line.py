# SPDX-License-Identifier: MIT
"""Simulated drives at a port, in real time: what tools/drive serves.

    line = DriveLine(port, {1: {"family": mm440}}, 19200, log=print)
    while True:
        if line.serve(keyboard):
            keyboard.read()

It has the attributes that the script language needs of a world (`drives`, `wire`, `run` ...), so
the same commands work on it, except those of the panel.
"""

import select
import time

from boards.port.clock import RealClock
from boards.port.line import PortMaster, PtyMaster
from boards.sim.drives.drive import Drive
from boards.sim.line.wire import Wire
from tools.driving import decoding
from tools.port.lasting_port import LastingPort

LONGEST_WAIT_US = 1_000_000

LOST = "%d characters are lost: they came faster than a line of %d baud carries them"
NO_PANEL = "there is no panel here, only drives"
OF_THE_PANEL = (
    "press", "hold", "down", "up", "setpoint", "lcd", "expect", "hang", "reset", "power",
)  # fmt: skip


class DriveLine:
    """port: a `SerialPort` or `Pty` that is open. kinds: {address: keyword arguments of `Drive`}.

    log: a function that gets a line for every telegram, or None. say: a function that gets a line
    for each change of the port.
    """

    refused = {command: NO_PANEL for command in OF_THE_PANEL}

    def __init__(self, port, kinds, baud, log=None, say=print):
        self.clock = RealClock(lambda: time.monotonic_ns() // 1000)
        self.wire = Wire(self.clock, baud)
        self.drives = {}
        self._port = LastingPort(port, self._told)
        self._log = log
        self._say = say
        for address, kind in kinds.items():
            self.drives[address] = Drive(self.clock, self.wire, address, **kind)
        station = PtyMaster if port.is_pty else PortMaster
        noted = (self._note, self._look) if log else ()
        self._master = station(self.wire, self._port.write, *noted)

    def run(self, ms):
        """Serve for so long, and ignore the keyboard."""
        until_us = self.clock.true_us() + 1000 * ms
        left_us = 1000 * ms
        while left_us > 0:
            self.serve(None, min(left_us, LONGEST_WAIT_US) / 1e6)
            left_us = until_us - self.clock.true_us()

    def serve(self, keyboard=None, longest_s=LONGEST_WAIT_US / 1e6):
        """Wait for the next event, and handle it. Return whether `keyboard` can be read."""
        wait_s = max(0, min(self.clock.next_us() / 1e6, longest_s))
        awaited = [keyboard] if keyboard is not None else []
        if self._port.is_open:
            awaited.append(self._port)
        else:
            self._port.look_again()
        ready, _, _ = select.select(awaited, (), (), wait_s)
        self.clock.follow()
        if self._port.is_open and self._port in ready:
            self._read()
        elif self._master.lost:
            self._say(LOST % (self._master.lost, self.wire.baud))
            self._master.lost = 0
        return keyboard in ready

    def _read(self):
        data, flaws = self._port.read()
        if data:
            self._master.received(data, flaws)

    def _told(self, cut):
        what = "has gone (%s): the drives hear nothing" % cut if cut else "is back"
        self._say("%s %s" % (self._port.port.path, what))

    def _look(self):
        return {drive.address: decoding.Setup(drive) for drive in self.drives.values()}

    def _note(self, burst, from_master, setups):
        characters, damaged = decoding.said(burst)
        self._log(decoding.line(burst.start_us, from_master, characters, setups or {}, damaged))
