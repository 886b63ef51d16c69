# SPDX-License-Identifier: MIT
"""A drive on a line, and a bus master by hand: what the tests of the simulated drive share.

It uses nothing of the panel's protocol code: telegrams are put together here, from the
specification.

    bench = Bench({1120: 5.0})              # a drive, commissioned so
    bench.control(OFF1)                     # (ZSW, HIW)
    bench.task(0x12BC)                      # PKW words of the reply: read P0700
"""

import struct

from boards.sim.clock import Clock
from boards.sim.drives.drive import Drive
from boards.sim.line.wire import Wire

# Control words.
OFF1, RUN = 0x047E, 0x047F
ACKNOWLEDGE = 0x04FE
JOG_RIGHT, JOG_LEFT = 0x057E, 0x067E

NO_BOOT = {"boot_ms": 0}

HALF = 0x2000  # 50 % of P2000: 25 Hz


def telegram(adr, *words):
    """A telegram of these net data words."""
    characters = [2, 2 * len(words) + 2, adr]
    for word in words:
        characters += [word >> 8, word & 0xFF]
    bcc = 0
    for character in characters:
        bcc ^= character
    return bytes(characters + [bcc])


def from_hex(text):
    return bytes([int(pair, 16) for pair in text.split()])


def float_words(value):
    return struct.unpack(">HH", struct.pack(">f", value))


def with_more(parameters, more):
    """Both, those of `more` where a number is in both."""
    parameters = dict(parameters)
    parameters.update(more or {})
    return parameters


class Bench:
    """A drive on a line, and a master that keeps the rules unless told otherwise.

    It boots at once, unless `switches` say otherwise: most tests look at what comes after that.
    """

    name = "master"

    def __init__(self, parameters=None, address=1, baud=19200, **more):
        self.clock = Clock()
        self.wire = Wire(self.clock, baud)
        more["switches"] = dict(NO_BOOT, **(more.get("switches") or {}))
        self.drive = Drive(self.clock, self.wire, address, parameters, **more)
        self.heard = []
        self.wire.attach(self)

    def hear(self, burst):
        self.heard.append((burst.start_us, bytes(burst.data[: burst.count])))

    def wait(self, seconds):
        self.clock.advance(round(seconds * 1_000_000))

    def send(self, data, silence_us=None):
        """Put characters on the line after a pause; returns at the end of the last stop bit."""
        self.clock.advance(self.wire.start_interval_us if silence_us is None else silence_us)
        self.wire.talk(self, data, len(data))
        self.clock.advance_to(self.clock.now_us + self.wire.ends[len(data) - 1])

    def ask(self, data):
        """The reply to a telegram, None if there is none; returns when it is over, or too late."""
        del self.heard[:]
        self.send(data)
        too_late_us = self.clock.now_us + 60_000 + self.wire.ends[255]
        while not self.heard and self.clock.now_us < too_late_us:
            self.clock.advance(self.wire.character_us)
        return self.heard[0][1] if self.heard else None

    def exchange(self, *words):
        """The net data words of the reply to these, in whatever layout; None without a reply."""
        reply = self.ask(telegram(self.drive.address, *words))
        if reply is None:
            return None
        return [reply[i] << 8 | reply[i + 1] for i in range(3, len(reply) - 1, 2)]

    def control(self, stw, hsw=0):
        """ZSW and HIW in answer to a control word and a setpoint."""
        return struct.unpack(">HH", self.ask(telegram(1, 0, 0, 0, 0, stw, hsw))[-5:-1])

    def task(self, pke, ind=0, pwe1=0, pwe2=0, stw=OFF1, hsw=0):
        """The PKW words in answer to a parameter task."""
        return struct.unpack(">4H", self.ask(telegram(1, pke, ind, pwe1, pwe2, stw, hsw))[3:11])

    def run(self, hsw=HALF, seconds=20):
        """Start it, and wait until it has its speed."""
        self.control(OFF1)
        self.control(RUN, hsw)
        self.wait(seconds)

    def counters(self):
        """r2024 ... r2031."""
        return [self.drive.read(number) for number in range(2024, 2032)]
