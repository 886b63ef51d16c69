# SPDX-License-Identifier: MIT
"""A link of `hal` on a serial port of this computer.

    link = SerialLink("/dev/ttyUSB0", 19200)        # PortError: says in words what is wrong
    link.notices                                    # lines for people, such as: it has gone

The port is held by another small program, `keeper`, which stops the motors if this one hangs or
dies. The bus is driven by the thread that calls `bus.step`, `bus.wait`, `drive.run` and so on; no
other thread may call them. It is this thread that must not stand still for 300 ms.
"""

import collections
import json
import subprocess
import sys
import threading
import time
from pathlib import Path

import uss_serial.frames as frames
from uss_serial.frames import framed, read_frame
from uss_serial.port.errors import PortError

LATE_US = 20_000  # adapters keep characters back for up to 16 ms
ALIVE_US = 50_000  # the keeper is told so often that the program polls
REST_S = 0.0005
OPENING_S = 10.0
CLOSING_S = 15.0  # the keeper may have drives to stop
CHARACTER_BITS = 11
NODE_MAX = 31


class Clock:
    """The clock of `hal`. `sleep_us` ends early when something has come."""

    ticks_mask = (1 << 30) - 1

    def __init__(self):
        self.woken = threading.Event()

    def ticks_us(self):
        return time.monotonic_ns() // 1000 & self.ticks_mask

    def ticks_ms(self):
        return time.monotonic_ns() // 1_000_000 & self.ticks_mask

    def sleep_us(self, us):
        if self.woken.wait(max(us / 1e6, REST_S)):
            self.woken.clear()


class SerialLink:
    """port: its path or name, or a URL of pyserial. baud: a rate of USS.

    Fields to look at: `is_cut`, it has gone for the moment; `parity_errors`, `frame_errors`,
    characters that were dropped, where the system tells them (Linux); `stopped`, the addresses
    that the keeper has sent OFF1 in the program's place; `notices`, what happened to the port.
    watch: None, or a function of (is_sent, characters, microseconds of time.monotonic), called in
    the thread of the bus for all that goes out and comes in.
    """

    interrupts = False
    resolution_us = LATE_US

    def __init__(self, port, baud, watch=None):
        self.port = port
        self.baud = baud
        self.watch = watch
        self.bus = None  # the `Master` that has this link; it sets this
        self.clock = Clock()
        self.on_activity = None
        self.received_at = self.sent_at = 0
        self.is_cut = False
        self.parity_errors = self.frame_errors = 0
        self.stopped = ()
        self.notices = []
        self._came = collections.deque()  # (microseconds, characters), from the reading thread
        self._sending = False
        self._started_us = self._duration_us = self._alive_us = 0
        self._keeper = start_keeper()
        self._answer = None  # of the keeper to OPEN
        self._answered = threading.Event()
        threading.Thread(target=self._listen, daemon=True).start()
        self._open()

    # --- of the contract `link` -----------------------------------------------------------------

    def send(self, buffer, count):
        self.send_as(bytes(buffer[:count]), self._pzd_words(buffer[2]))

    def send_as(self, telegram, pzd_words):
        """Send a telegram that is none of the bus, with so many PZD words at its end."""
        now_us = self._started_us = time.monotonic_ns() // 1000
        self._duration_us = len(telegram) * CHARACTER_BITS * 1_000_000 // self.baud + 1
        self._sending = True
        self._alive_us = now_us
        told = frames.NOT_TOLD if pzd_words is None else pzd_words
        self._say(frames.TELEGRAM, frames.INSTANT.pack(now_us) + bytes((told,)) + telegram)
        if self.watch is not None:
            self.watch(True, telegram, now_us)

    def sending_us(self, now):
        if not self._sending:
            return 0
        passed_us = time.monotonic_ns() // 1000 - self._started_us
        if passed_us < self._duration_us:
            return self._duration_us - passed_us
        self._sending = False
        self.sent_at = self._started_us + self._duration_us & self.clock.ticks_mask
        return 0

    def receive(self, buffer, at):
        now_us = time.monotonic_ns() // 1000
        if now_us - self._alive_us >= ALIVE_US:
            self._alive_us = now_us
            self._say(frames.ALIVE, frames.INSTANT.pack(now_us))
        if not self._came:
            return 0
        came_us, data = self._came.popleft()
        room = len(buffer) - at
        if len(data) > room:
            self._came.appendleft((came_us, data[room:]))
            data = data[:room]
        buffer[at : at + len(data)] = data
        self.received_at = came_us & self.clock.ticks_mask
        if data and self.watch is not None:
            self.watch(False, data, came_us)
        return len(data)

    def change_baud(self, baud):
        """Go on at another rate, with another `Master`. PortError."""
        self._sending = False
        self.baud = baud
        self._answer = None
        self._answered.clear()
        self._open()
        self._came.clear()

    def close(self):
        """Give the port away. Drives that this program has left running are sent OFF1."""
        self._sending = False
        try:
            self._keeper.stdin.close()
        except OSError:
            pass
        try:
            self._keeper.wait(CLOSING_S)
        except subprocess.TimeoutExpired:
            self._keeper.kill()

    # --- the keeper -----------------------------------------------------------------------------

    def _open(self):
        """PortError."""
        opening = {"port": self.port, "baud": self.baud}
        self._say(frames.OPEN, json.dumps(opening).encode())
        self._answered.wait(OPENING_S)
        if self._answer is None or self._answer[0] != frames.OPENED:
            self.close()
            why = self._answer[1].decode() if self._answer else ""
            raise PortError(why or "%s does not open" % self.port)

    def _pzd_words(self, address):
        """The PZD words of a telegram of the bus to this address; None: nobody has told."""
        if self.bus is None:
            return None
        if address > NODE_MAX:
            return 0
        drive = getattr(self.bus, "engine", self.bus).turns.at(address)
        return drive.layout.pzd_words if drive is not None else 0

    def _say(self, letter, content):
        try:
            self._keeper.stdin.write(framed(letter, content))
            self._keeper.stdin.flush()
        except (OSError, ValueError):
            self._lose("the small program that holds it is no more")

    def _lose(self, why):
        if not self.is_cut:
            self.is_cut = True
            self.notices.append("%s has gone (%s): the line is cut" % (self.port, why))

    def _listen(self):
        """In a thread of its own."""
        while True:
            try:
                frame = read_frame(self._keeper.stdout)
            except (OSError, ValueError):
                frame = None
            if frame is None:
                break
            self._take(*frame)
        self._answered.set()
        self._lose("the small program that holds it is no more")

    def _take(self, letter, content):
        if letter == frames.DATA:
            self._came.append((frames.INSTANT.unpack_from(content)[0], content[8:]))
            self.clock.woken.set()
        elif letter == frames.WRONG:
            parity, frame = frames.COUNTS.unpack(content)
            self.parity_errors += parity
            self.frame_errors += frame
        elif letter == frames.CUT:
            self._lose(content.decode())
        elif letter == frames.BACK:
            self.is_cut = False
            self.notices.append("%s is back" % self.port)
        elif letter == frames.STOPPED:
            self.stopped = tuple(content)
        else:
            self._answer = letter, content
            self._answered.set()


def start_keeper():
    """The keeper as a process of its own, which no signal of a terminal reaches."""
    apart = {"start_new_session": True}
    if sys.platform == "win32":
        apart = {"creationflags": subprocess.CREATE_NEW_PROCESS_GROUP}
    return subprocess.Popen(
        [sys.executable, "-B", str(Path(__file__).with_name("keeper.py"))],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        **apart,
    )
