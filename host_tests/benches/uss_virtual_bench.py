# SPDX-License-Identifier: MIT
"""tools/uss in this very process, on a simulated line in virtual time: a day costs a second.

world = World({1: "mm420", 2: "g120/4"})
world.plc.commands({1: 0x047F})         # another master, which may pause
world.run(2.0)
told = world.uss("--kind", "mm420", "read", "P0700")    # as `uss_command_bench.Told`
world.drives[1].state
"""

import contextlib
import io
import signal
import sys
from types import SimpleNamespace

from boards.sim.clock import Clock, Event
from boards.sim.drives.drive import Drive
from boards.sim.drives.kinds import listed_drives, simulated
from boards.sim.line.wire import Wire
from tools.uss_command import finding, line, motor, tracing, watching
from uss.layout import VARIABLE
from uss_command_bench import Told, telegram

_path = list(sys.path)
from tools.uss_command import __main__ as uss_command  # noqa: E402

sys.path[:] = _path  # as a program it makes its own

LOOK_US = 1_000  # how often the laptop looks at its port
TIMED = finding, motor, tracing, watching
SIGNALS = signal.SIGTERM, signal.SIGHUP


class World:
    """kinds: {address: kind}, as on command lines. parameters: {address: {number: value}}."""

    def __init__(self, kinds, baud=19200, parameters=None):
        self.baud = baud
        self.clock = Clock()
        self.wire = Wire(self.clock, baud)
        self.drives = {}
        text = ",".join("%d=%s" % (address, kinds[address]) for address in kinds)
        for address, kind in simulated(listed_drives(text)).items():
            more = {"parameters": (parameters or {}).get(address, {})}
            self.drives[address] = Drive(self.clock, self.wire, address, **{**kind, **more})
        self.plc = Plc(self)
        self.interrupt_us = None  # then somebody presses Ctrl-C
        self.run(0.5)

    def run(self, seconds):
        self.clock.advance(int(seconds * 1_000_000))

    def after(self, seconds, action):
        """Do something while a command is at work."""
        self.clock.schedule(Event(action), self.clock.now_us + int(seconds * 1_000_000))

    def ctrl_c_after(self, seconds):
        self.interrupt_us = self.clock.now_us + int(seconds * 1_000_000)

    def uss(self, *words, baud=None, as_json=True):
        output, errors = io.StringIO(), io.StringIO()
        now_s = SimpleNamespace(monotonic=lambda: self.clock.now_us / 1e6)
        before = [(one, one.time) for one in TIMED], line.SerialLink
        handlers = [(number, signal.getsignal(number)) for number in SIGNALS]
        for one in TIMED:
            one.time = now_s
        line.SerialLink = lambda port, baud, watch=None: Laptop(self, baud, watch)
        options = ["--port", "virtual", "--baud", str(baud or self.baud)] + ["--json"] * as_json
        try:
            with contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors):
                status = uss_command.main(options + list(words))
        finally:
            line.SerialLink = before[1]
            for one, time in before[0]:
                one.time = time
            for number, handler in handlers:
                signal.signal(number, handler)
        return Told(status, output.getvalue(), errors.getvalue())

    def slept(self):
        """Called by the laptop, which looks at its port: Ctrl-C is noticed here."""
        if self.interrupt_us is not None and self.clock.now_us >= self.interrupt_us:
            self.interrupt_us = None
            raise KeyboardInterrupt

    def sent(self, since_us=0):
        """What the laptop has sent since, without mirror telegrams: [characters]."""
        return [
            characters
            for at_us, from_laptop, characters in self.wire.log.last(1000)
            if from_laptop and at_us >= since_us and not characters[2] & 0x40
        ]


class Laptop:
    """A `SerialLink` on the simulated line."""

    interrupts = False
    resolution_us = 2 * LOOK_US
    name = "laptop"
    is_panel = True
    is_cut = False
    stopped = ()

    def __init__(self, world, baud, watch):
        self.clock = self
        self.bus = None
        self.notices = []
        self.parity_errors = self.frame_errors = 0
        self.received_at = self.sent_at = 0
        self._world = world
        self._watch = watch
        self._baud = baud
        self._heard = []
        self._end_us = None
        world.wire.attach(self, baud)

    # --- the clock

    ticks_mask = (1 << 30) - 1

    def ticks_us(self):
        return self._world.clock.now_us & self.ticks_mask

    def ticks_ms(self):
        return self._world.clock.now_us // 1000 & self.ticks_mask

    def sleep_us(self, us):
        self._world.clock.advance(LOOK_US)
        self._world.slept()

    # --- the port

    def change_baud(self, baud):
        self._baud = baud
        self._world.wire.detach(self)
        self._world.wire.attach(self, baud)
        self._heard = []

    def send(self, buffer, count):
        data = bytes(buffer[:count])
        self._end_us = self._world.wire.talk(self, data, count).end_us
        if self._watch:
            self._watch(True, data, self._world.clock.now_us)

    def sending_us(self, now):
        if self._end_us is None:
            return 0
        left_us = self._end_us - self._world.clock.now_us
        if left_us > 0:
            return left_us
        self.sent_at = self._end_us & self.ticks_mask
        self._end_us = None
        return 0

    def hear(self, burst):
        if burst.baud != self._baud or burst.errors is not None:
            self.frame_errors += 1
        else:
            self._heard.append((burst.end_us, bytes(burst.data[: burst.count])))

    def receive(self, buffer, at):
        if not self._heard:
            return 0
        at_us, data = self._heard.pop(0)
        buffer[at : at + len(data)] = data
        self.received_at = at_us & self.ticks_mask
        if self._watch:
            self._watch(False, data, at_us)
        return len(data)

    def close(self):
        self._world.wire.detach(self)


class Plc:
    """Another master: it tells each drive the same again and again, while it is not paused."""

    name = "plc"
    PERIOD_US = 50_000

    def __init__(self, world):
        self.paused = True
        self._world = world
        self._telegrams = []
        self._turn = Event(self._talk)
        self._baud = None

    def commands(self, words, hsw=0x1000):
        """words: {address: STW}. It begins at once."""
        if self._baud is None:
            self._baud = self._world.baud
            self._world.wire.attach(self, self._baud)
        self._telegrams = [self._telegram(address, stw, hsw) for address, stw in words.items()]
        self.resume()

    def _telegram(self, address, stw, hsw):
        slave = self._world.drives[address].slave
        pkw_words = 0 if slave.pkw_words == VARIABLE else slave.pkw_words
        count = 2 * (pkw_words + slave.pzd_words)
        pzd = (stw << 16 | hsw).to_bytes(4, "big") + bytes(2 * slave.pzd_words - 4)
        head = bytes((2, count + 2, address)) + bytes(2 * pkw_words)
        return telegram((head + pzd).hex())

    def pause(self):
        self.paused = True
        self._world.clock.cancel(self._turn)

    def resume(self):
        self.paused = False
        self._world.clock.schedule(self._turn, self._world.clock.now_us)

    def hear(self, burst):
        """It takes no notice."""

    def _talk(self):
        said = self._telegrams.pop(0)
        self._telegrams.append(said)
        wire = self._world.wire
        wire.talk(self, said, len(said))
        self._world.clock.schedule(self._turn, self._world.clock.now_us + self.PERIOD_US)
