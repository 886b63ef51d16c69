# SPDX-License-Identifier: MIT
"""The panel's link over a port of the computer: a serial adapter, or a pty.

Fulfils the contract `link` of `hal`, polled. The port is a stream that never waits; adapter and
kernel keep characters back for milliseconds, and the link says so by its resolution.

    link = PortLink(port, clock, wire)

port: read(count) -> what has come, at most so much, or None; write(data). Nobody tells the link
that the line is cut: then nothing comes any more.
"""

from boards.sim.line.wire import BURST_LIMIT, Burst

LATE_US = 20_000  # adapters keep characters back for up to 16 ms
APART_US = 100_000  # characters so far apart are no telegram: told one by one in the log


def _nobody():
    """Stands for the listener until somebody wants to know what the link hears."""


class PortLink:
    """wire: tells the rate, and keeps the log; nothing is sent there."""

    interrupts = False
    resolution_us = LATE_US

    def __init__(self, port, clock, wire):
        self.on_activity = _nobody
        self.clock = clock
        self.received_at = 0
        self.sent_at = 0
        self._port = port
        self._mask = clock.ticks_mask
        self._log = wire.log
        self._ends = wire.ends
        self._sending = False
        self._started_at = 0
        self._duration_us = 0
        self._spoken = Burst(wire.ends, wire.character_us)
        self._heard = Burst(wire.ends, wire.character_us)
        self._heard_us = 0

    def send(self, buffer, count):
        self._note_heard()
        self._started_at = self.clock.ticks_us()
        self._duration_us = self._ends[count - 1] + 1
        self._sending = True
        self._port.write(bytes(buffer[:count]))
        self._spoken.begin(self.clock.now_us, 0)
        self._spoken.append(buffer, count)
        self._log.add(self._spoken, True)

    def sending_us(self, now):
        if not self._sending:
            return 0
        passed_us = (now - self._started_at) & self._mask
        if passed_us > self._mask >> 1:  # `now` was read before the sending began
            passed_us = 0
        if passed_us < self._duration_us:
            return self._duration_us - passed_us
        self._sending = False
        self.sent_at = (self._started_at + self._duration_us) & self._mask
        return 0

    def receive(self, buffer, at):
        came = self._port.read(len(buffer) - at)
        if not came:
            return 0
        count = len(came)
        buffer[at : at + count] = came
        self.received_at = self.clock.ticks_us()
        self._hear(came)
        return count

    def close(self):
        self._note_heard()
        self._sending = False

    def _hear(self, came):
        """Note it for the log, which wants telegrams: all that comes until the panel talks again
        is one.
        """
        heard = self._heard
        now_us = self.clock.now_us
        if now_us - self._heard_us > APART_US or heard.count + len(came) > BURST_LIMIT:
            self._note_heard()
        if not heard.count:
            heard.begin(now_us, 0)
        self._heard_us = now_us
        if len(came) <= BURST_LIMIT:
            heard.append(came, len(came))

    def _note_heard(self):
        heard = self._heard
        if heard.count:
            self._log.add(heard, False)
            heard.begin(0, 0)
