# SPDX-License-Identifier: MIT
"""Simulated drives at a port, in real time: what tools/drive serves.

    line = DriveLine(port, {1: {"family": mm440}}, 19200, log=print)
    while True:
        if line.serve(keyboard):
            keyboard.read()

It has the face that the script language asks of a world (`drives`, `wire`, `run` ...), so that
the same commands work on it, those of the panel apart.
"""

import select
import time

from boards.port.clock import RealClock
from boards.port.line import PortMaster, PtyMaster
from boards.sim.drives.drive import Drive
from boards.sim.line.wire import Wire
from tools.driving import decoding
from tools.port.serial_port import LineCut, PortError

AGAIN_S = 1.0  # a port that has gone is looked for so often
LONGEST_WAIT_US = 1_000_000

LOST = "%d characters are lost: they came faster than a line of %d baud carries them"
NO_PANEL = "there is no panel here, only drives"
OF_THE_PANEL = ("press", "hold", "down", "up", "lcd", "expect", "hang", "reset", "power")


class DriveLine:
    """port: a `SerialPort` or `Pty` that is open. kinds: {address: keyword arguments of `Drive`}.

    log: a function that is given a line for every telegram, or None. say: one for what happens to
    the port.
    """

    refused = {command: NO_PANEL for command in OF_THE_PANEL}

    def __init__(self, port, kinds, baud, log=None, say=print):
        self.clock = RealClock(lambda: time.monotonic_ns() // 1000)
        self.wire = Wire(self.clock, baud)
        self.drives = {}
        self._port = port
        self._log = log
        self._say = say
        self._gone_at = None
        for address, kind in kinds.items():
            self.drives[address] = Drive(self.clock, self.wire, address, **kind)
        station = PtyMaster if port.is_pty else PortMaster
        noted = (self._note, self._look) if log else ()
        self._master = station(self.wire, self._write, *noted)

    def run(self, ms):
        """Serve for so long, whatever is typed."""
        until_us = self.clock.true_us() + 1000 * ms
        left_us = 1000 * ms
        while left_us > 0:
            self.serve(None, min(left_us, LONGEST_WAIT_US) / 1e6)
            left_us = until_us - self.clock.true_us()

    def serve(self, keyboard=None, longest_s=LONGEST_WAIT_US / 1e6):
        """Wait for something to happen, and let it. Answers whether `keyboard` can be read."""
        wait_s = max(0, min(self.clock.next_us() / 1e6, longest_s))
        awaited = [keyboard] if keyboard is not None else []
        if self._gone_at is not None:
            self._look_again()
        else:
            awaited.append(self._port)
        ready, _, _ = select.select(awaited, (), (), wait_s)
        self.clock.follow()
        if self._gone_at is None and self._port in ready:
            self._read()
        elif self._master.lost:
            self._say(LOST % (self._master.lost, self.wire.baud))
            self._master.lost = 0
        return keyboard in ready

    def _read(self):
        try:
            data, flaws = self._port.read()
        except LineCut as cut:
            self._lost(cut)
            return
        if data:
            self._master.received(data, flaws)

    def _write(self, data):
        if self._gone_at is not None:
            return
        try:
            self._port.write(data)
        except LineCut as cut:
            self._lost(cut)

    def _lost(self, cut):
        self._port.close()
        self._gone_at = time.monotonic()
        self._say("%s has gone (%s): the drives hear nothing" % (self._port.path, cut))

    def _look_again(self):
        if time.monotonic() - self._gone_at < AGAIN_S:
            return
        self._gone_at = time.monotonic()
        try:
            self._port.open()
        except PortError:
            return
        self._gone_at = None
        self._say("%s is back" % self._port.path)

    def _look(self):
        return {drive.address: decoding.Setup(drive) for drive in self.drives.values()}

    def _note(self, burst, from_master, setups):
        characters, damaged = decoding.said(burst)
        self._log(decoding.line(burst.start_us, from_master, characters, setups or {}, damaged))
