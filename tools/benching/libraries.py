# SPDX-License-Identifier: MIT
"""The protocol library beside others for drives and meters, under CPython, in one process.

TurboCtl speaks USS to one kind of pump; MinimalModbus, PyModbus and uModbus speak Modbus RTU,
which many drives take as well. Each has a transport in memory, which answers at once, and does the
same:

    parse       a reply of ten words is there: check it, take the words out
    exchange    build a request, hand it to the transport, take the reply, check it, take all out

A reply of ten words has 24 characters in USS (4 PKW and 6 PZD words) and 25 in Modbus (registers).
Started by __main__.py with the Python of build/libraries; by hand

    build/libraries/bin/python tools/benching/libraries.py quick

prints a line of JSON. It does not judge the figures: rows.py has the bar.
"""

import importlib.metadata
import json
import statistics
import struct
import sys
import time
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(TOP / "firmware"), str(TOP / "host_tests" / "cpython")]

import minimalmodbus  # noqa: E402
import pymodbus.client  # noqa: E402
from turboctl.telegram import api  # noqa: E402
from turboctl.telegram.telegram import TelegramBuilder, TelegramReader  # noqa: E402
from umodbus.client.serial import rtu  # noqa: E402
from umodbus.client.serial.redundancy_check import CRCError, add_crc  # noqa: E402

from uss import pkw, telegram  # noqa: E402
from uss.bus import Master  # noqa: E402
from uss.layout import Layout  # noqa: E402
from uss.timing import Timing  # noqa: E402

ADDRESS = 1
NUMBERS = (3, 11)  # parameters that are read in turn: two that the pump of TurboCtl has
TIMES = 7  # each is measured so often, in turn with the others; the median counts
ROUNDS, QUICK_ROUNDS = 1_000, 100
BAUD = 187500  # the fastest of USS; in memory it makes no difference

TIMING = Timing(BAUD)
TELEGRAM_US = TIMING.telegram_us(20)
PAUSE_US = TIMING.start_interval_us  # before a reply, and before a request

# Of the reply: ZSW, HIW, PZD3...PZD6; the parameter's value is PZD2. The Modbus device has the
# same ten words in its registers.
PZD = (0x0204, 1000, 45, 12, 0, 48)
VALUE = 1000


def uss_reply(number):
    net = struct.pack(">HHI6H", pkw.WORD << 12 | number, 0, VALUE, *PZD)
    return sealed(net, ADDRESS)


def sealed(net, address):
    reply = bytearray(telegram.NET) + net + bytes(1)
    telegram.seal(reply, address, len(net))
    return bytes(reply)


REPLIES = {number: uss_reply(number) for number in NUMBERS}
REPLIES[0] = sealed(bytes(8) + struct.pack(">6H", *PZD), ADDRESS)
WORDS = list(struct.unpack(">10H", REPLIES[NUMBERS[0]][telegram.NET : -1]))
REGISTERS = add_crc(struct.pack(">BBB10H", ADDRESS, 3, 20, *WORDS))


class Port:
    """What the others take for a serial port: it has the whole reply as soon as it is written to.
    An address in USS is 0 for TurboCtl, which knows no other."""

    is_open = True
    port = "memory"
    baudrate = BAUD
    timeout = 1.0

    def __init__(self, answer):
        self._answer = answer
        self._reply = b""

    def write(self, request):
        self._reply = self._answer(request)
        return len(request)

    def read(self, count=1):
        taken, self._reply = self._reply[:count], self._reply[count:]
        return taken

    @property
    def in_waiting(self):
        return len(self._reply)

    def open(self):
        pass

    close = flush = reset_input_buffer = reset_output_buffer = open


class Link:
    """A link as `hal` wants it, whose time is that of the telegrams: it goes on by each."""

    interrupts = True
    foreseen = True
    resolution_us = 0
    ticks_mask = (1 << 30) - 1
    sent_at = received_at = 0

    def __init__(self):
        self.clock = self
        self._now = 0
        self._reply = b""

    def ticks_us(self):
        return self._now

    def sleep_us(self, us):
        self._now += us

    def send(self, request, count):
        self._reply = REPLIES[request[4]]  # by the low byte of PKE; 0: no task
        self.sent_at = sent_at = self._now + TELEGRAM_US & self.ticks_mask
        self.received_at = received_at = sent_at + PAUSE_US + TELEGRAM_US & self.ticks_mask
        self._now = received_at + PAUSE_US & self.ticks_mask

    def sending_us(self, now):
        return 0

    def receive(self, buffer, at):
        count = len(self._reply)
        buffer[at : at + count] = self._reply
        self._reply = b""
        return count

    def close(self):
        pass


class Uss:
    """This library: `uss.bus` and the engine behind it, as its README shows them."""

    reply = REPLIES[NUMBERS[0]]
    package = None

    def __init__(self):
        link = Link()
        self.bus = Master(link, BAUD)
        self.bus.add(ADDRESS, layout=Layout(4, 6))
        self.drive = self.bus.drives[0].engine
        while not self.drive.contact:
            self.bus.step()
            link.sleep_us(1000)
        self.job, self.following = [pkw.read(number) for number in NUMBERS]
        self.drive.ask(self.job)
        self.drive.ask(self.following)
        self.bus.step()

    def parse(self, reply):
        if telegram.judge(reply, len(reply), ADDRESS, 20) != telegram.GOOD:
            raise ValueError("no telegram")
        return [telegram.get_word(reply, at) for at in range(telegram.NET, 23, 2)]

    def exchange(self):
        """Each telegram carries the next question, and each reply the answer to the one before."""
        self.bus.step()
        drive, job = self.drive, self.job
        if job.state != pkw.DONE:
            raise ValueError("no answer")
        value = job.integer_value()
        self.job, self.following = self.following, job
        drive.ask(job)
        word = drive.word
        return [value, drive.zsw, drive.hiw, word(3), word(4), word(5), word(6)]


class TurboCtl:
    """A master of USS for the TURBOVAC pumps."""

    reply = sealed(struct.pack(">HHI6H", pkw.WORD << 12 | NUMBERS[0], 0, VALUE, *PZD), 0)
    package = "turboctl"

    def __init__(self):
        self.port = Port(lambda request: self.reply)

    def parse(self, reply):
        read = TelegramReader(TelegramBuilder().from_bytes(reply).build("reply"))
        return self._values(read)

    def exchange(self):
        _, read = api.read_parameter(self.port, NUMBERS[0])
        return self._values(read)

    def _values(self, read):
        numbers = read.frequency, read.temperature, read.current, read.voltage
        return [read.parameter_value, read.telegram.flag_bits.value, *numbers]


class MinimalModbus:
    """Its own functions for a reply have no public name."""

    reply = REGISTERS
    package = "minimalmodbus"

    def __init__(self):
        self.instrument = minimalmodbus.Instrument(Port(lambda request: REGISTERS), ADDRESS)

    def parse(self, reply):
        payload = minimalmodbus._extract_payload(reply, ADDRESS, minimalmodbus.MODE_RTU, 3)
        kind = minimalmodbus._Payloadformat.REGISTERS
        return minimalmodbus._parse_payload(payload, 3, 0, None, 0, 10, 0, False, 0, kind)

    def exchange(self):
        return self.instrument.read_registers(0, 10)


class PyModbus:
    """Its client that waits; the one for asyncio does the same work and that of a loop besides."""

    reply = REGISTERS
    package = "pymodbus"

    def __init__(self):
        self.client = pymodbus.client.ModbusSerialClient("memory", baudrate=BAUD)
        self.client.socket = Port(lambda request: REGISTERS)

    def parse(self, reply):
        return self.client.framer.handleFrame(reply, ADDRESS, 0)[1].registers

    def exchange(self):
        return self.client.read_holding_registers(0, count=10, device_id=ADDRESS).registers


class UModbus:
    reply = REGISTERS
    package = "umodbus"

    def __init__(self):
        self.port = Port(lambda request: REGISTERS)
        self.request = rtu.read_holding_registers(ADDRESS, 0, 10)

    def parse(self, reply):
        return rtu.parse_response_adu(reply, self.request)

    def exchange(self):
        return rtu.send_message(rtu.read_holding_registers(ADDRESS, 0, 10), self.port)


CONTESTANTS = (Uss, TurboCtl, MinimalModbus, PyModbus, UModbus)

# What a contestant raises on a spoilt reply; PyModbus finds no telegram and has no registers.
REFUSALS = (ValueError, CRCError, minimalmodbus.InvalidResponseError, AttributeError)


def check(contestant):
    """RuntimeError unless it takes the right values out of a good reply, and none out of a bad."""
    name = type(contestant).__name__
    reply = contestant.reply
    values = WORDS
    if isinstance(contestant, TurboCtl):
        bits = "".join(reversed(f"{PZD[0]:016b}"))
        values = [VALUE, bits, *PZD[1:4], PZD[5]]
    if contestant.parse(reply) != values:
        raise RuntimeError("%s parses %r" % (name, contestant.parse(reply)))
    exchanged = [VALUE, *PZD] if isinstance(contestant, Uss) else values
    for _ in range(4):
        if contestant.exchange() != exchanged:
            raise RuntimeError("%s reads %r" % (name, contestant.exchange()))
    spoilt = bytearray(reply)
    spoilt[12] ^= 0x10
    try:
        values = contestant.parse(bytes(spoilt))
    except REFUSALS:
        return
    raise RuntimeError("%s takes %r from a spoilt reply" % (name, values))


def duration_us(rounds, function, *arguments):
    """Of one call, in the processor's time: others may use it as well, and a library may sleep."""
    began = time.process_time()
    for _ in range(rounds):
        function(*arguments)
    return (time.process_time() - began) / rounds * 1_000_000


def measure(rounds):
    """{name: {"version": text, "parse_us": median, "exchange_us": median}}"""
    contestants = [make() for make in CONTESTANTS]
    for contestant in contestants:
        check(contestant)
    parses = [[] for _ in contestants]
    exchanges = [[] for _ in contestants]
    for _ in range(TIMES):
        for index, contestant in enumerate(contestants):
            parses[index].append(duration_us(rounds, contestant.parse, contestant.reply))
            exchanges[index].append(duration_us(rounds, contestant.exchange))
    return {
        type(contestant).__name__: {
            "version": contestant.package and importlib.metadata.version(contestant.package),
            "parse_us": statistics.median(parses[index]),
            "exchange_us": statistics.median(exchanges[index]),
        }
        for index, contestant in enumerate(contestants)
    }


if __name__ == "__main__":
    print(json.dumps(measure(QUICK_ROUNDS if sys.argv[1] == "quick" else ROUNDS)))
