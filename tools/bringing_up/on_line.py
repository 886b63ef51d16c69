# SPDX-License-Identifier: MIT
"""The checks of tools/bringup that need the bus's UART and state machine. This file is
MicroPython, for an RP2040 or RP2350; on_chip.py has the others.

Each function answers its figures, and `checks.py` judges them. Two jumpers join GP4 to GP5 and
GP6 to GP3, unless the docstring says that a transceiver is there.
"""

import gc
import os
import time

import machine
from machine import Pin
from rp2_pulses import CYCLES_PER_COUNT, Gauge, fall_to_fall, high

from chips import rp2

SEND, RECEIVE, DRIVER_ENABLE, DRIVER_JUMPER = 4, 5, 6, 3
BURSTS = (16, 24, 25, 32, 64, 200)
TELEGRAM = 16  # characters
MARGIN_US = 3_000
SCRATCH = "bringup.tmp"

# Of a PL011, from its first register on: ARM DDI 0183, 3.2.
DATA, FLAGS, CONTROL, MASK, RAW, CLEAR = 0x00, 0x18, 0x30, 0x38, 0x3C, 0x44
LOOPBACK = 1 << 7  # of CONTROL
TIMEOUT = 1 << 6  # of MASK, RAW, CLEAR: the receive time-out
EMPTY = 1 << 4  # of FLAGS: the receiver's FIFO

# Hits of the cache through which the chip reads its flash; behind it stand all reads.
CACHE_HITS = {"RP2040": 0x1400_000C, "RP2350": 0x400C_800C}[rp2.CHIP]

COUNTS_PER_BIT = 32
BITS_MEASURED = 3  # of an STX, from its start bit to its second falling edge
OFF1 = b"\x02\x0e\x00\0\0\0\0\0\0\0\0\x04\x7e\0\0"  # a telegram but for address and BCC

ticks_us, ticks_diff = time.ticks_us, time.ticks_diff


class Line:
    """The link at a rate, and when its interrupt came."""

    def __init__(self, baud):
        self.baud = baud
        self.came_at = 0
        self.came = 0
        driver = rp2.low(DRIVER_ENABLE)
        self.link = rp2.make_link(SEND, RECEIVE, driver, rp2.Clock(), baud)
        self.heard = bytearray(300)
        self.link.on_activity = self.note

    def note(self):
        self.came_at = ticks_us()
        self.came += 1

    def send(self, data):
        """How many characters came back, whether they are these, and how long after the last stop
        bit the interrupt came, in us; -1: it did not come."""
        self.came = 0
        self.link.send(data, len(data))
        self.wait()
        late_us = ticks_diff(self.came_at, self.link.sent_at) if self.came else -1
        count = max(self.link.receive(self.heard, 0), 0)
        return count, self.heard[:count] == data, late_us

    def wait(self):
        """Until what is being sent has been heard, interrupt and all."""
        time.sleep_us(self.link.sending_us(ticks_us()) + 80_000_000 // self.baud + MARGIN_US)

    def listen(self, ms):
        """How many characters come in so long."""
        count = 0
        for _ in range(ms // 10):
            time.sleep_ms(10)
            count += max(self.link.receive(self.heard, 0), 0)
        return count


def on_a_line(baud, work):
    """What `work` answers of a Line, which is closed afterwards."""
    line = Line(baud)
    try:
        return work(line)
    finally:
        line.link.close()


def register(offset):
    return machine.mem32[rp2.UART_REGISTERS + offset]


def put(offset, value):
    machine.mem32[rp2.UART_REGISTERS + offset] = value


def receive_timeout():
    """Eight characters by internal loopback, which nobody takes: whether the time-out comes; after
    it was cleared, whether it is there again at once, and 64 bits later."""
    return on_a_line(115_200, _receive_timeout)


def _receive_timeout(line):
    control, mask = register(CONTROL), register(MASK)
    put(MASK, 0)  # or MicroPython would take them
    put(CONTROL, control | LOOPBACK)
    for code in range(8):
        put(DATA, code)
    time.sleep_us(160_000_000 // line.baud)
    came = register(RAW) & TIMEOUT > 0
    put(CLEAR, TIMEOUT)
    at_once = register(RAW) & TIMEOUT > 0
    time.sleep_us(64_000_000 // line.baud)
    later = register(RAW) & TIMEOUT > 0
    while not register(FLAGS) & EMPTY:
        register(DATA)
    put(CONTROL, control)
    put(MASK, mask)
    return came, at_once, later


def bursts(bauds):
    """For each rate and burst: baud, characters sent, those that came back, whether right,
    interrupt after us."""
    answer = []
    for baud in bauds:
        answer += on_a_line(
            baud,
            lambda line: [(line.baud, count) + line.send(bytes(range(count))) for count in BURSTS],
        )
    return answer


def codes():
    """All 256 characters at 115200: how many came back, whether right, error bits of the UART."""
    return on_a_line(115_200, _codes)


def _codes(line):
    mask = register(MASK)
    put(MASK, 0)  # MicroPython would take the characters and forget their errors
    came, right, errors = 0, True, 0
    for first in range(0, 256, 32):
        line.link.send(bytes(range(first, first + 32)), 32)
        line.wait()
        expected = first
        while not register(FLAGS) & EMPTY:
            taken = register(DATA)
            right = right and taken & 0xFF == expected
            errors |= taken >> 8
            expected += 1
        came += expected - first
    put(MASK, mask)
    return came, right, errors


def driver_pulses(bauds):
    """For each rate, telegrams, the driver's pulses, and the shortest and the longest of them in
    32nds of a bit. A collection falls into the second telegram, writing a file into the third."""
    return [(baud,) + on_a_line(baud, _driver_pulses) for baud in bauds]


def _driver_pulses(line):
    gauge = Gauge(high, DRIVER_JUMPER, CYCLES_PER_COUNT * COUNTS_PER_BIT * line.baud)
    seen = []
    for disturb in (int, gc.collect, write):
        line.link.send(bytes(TELEGRAM), TELEGRAM)
        disturb()
        line.wait()
        seen += gauge.counts()
        line.link.receive(line.heard, 0)
    gauge.close()
    return 3, len(seen), min(seen, default=0), max(seen, default=0)


def write():
    with open(SCRATCH, "wb") as file:
        file.write(bytes(1024))
    os.remove(SCRATCH)


class Turns:
    """Bursts, each sent by the interrupt of the one before: the way of a bus."""

    def __init__(self, line, count):
        self.left = count
        self.link = line.link
        self.heard = line.heard
        self.data = bytes(range(TELEGRAM))
        self.ended_at = 0

    def turn(self):
        self.link.receive(self.heard, 0)
        self.ended_at = ticks_us()
        if self.left:
            self.left -= 1
            self.link.send(self.data, TELEGRAM)


def turns(count):
    """So many bursts at 115200 in turn: how many were left over, how long they took in us; reads
    of the flash and those that its cache had, 0 where they are not counted."""
    return on_a_line(115_200, lambda line: _turns(line, count))


def _turns(line, count):
    turns = Turns(line, count)
    turn = turns.turn
    line.link.on_activity = turn
    machine.mem32[CACHE_HITS] = 0  # any write clears them
    machine.mem32[CACHE_HITS + 4] = 0
    began = ticks_us()
    turn()
    time.sleep_ms(count * 4)
    line.link.on_activity = line.note
    hits, reads = machine.mem32[CACHE_HITS], machine.mem32[CACHE_HITS + 4]
    return turns.left, ticks_diff(turns.ended_at, began), reads & 0x3FFF_FFFF, hits & 0x3FFF_FFFF


def unread():
    """400 characters that nobody reads; then 16 more: how many of these came, whether right."""
    return on_a_line(115_200, _unread)


def _unread(line):
    for _ in range(2):
        line.link.send(bytes(200), 200)
        time.sleep_ms(25)
    while line.link.receive(line.heard, 0) > 0:
        pass
    return line.send(bytes(range(16)))[:2]


def heard_while_driving(baud):
    """A transceiver, the bus open: characters heard in a second with the driver on."""
    return on_a_line(baud, _heard_while_driving)


def _heard_while_driving(line):
    driver = Pin(DRIVER_ENABLE, Pin.OUT, value=1)
    count = line.listen(1_000)
    driver.value(0)
    return count


def heard_in_silence(baud):
    """A transceiver, nobody talks: characters heard in 10 s with the driver off."""
    return on_a_line(baud, lambda line: line.listen(10_000))


def bit_of(address, baud):
    """OFF1 to a drive behind the transceiver: the rate, characters of its reply, and the length of
    three bits of that in ns; 0: none was seen."""
    return on_a_line(baud, lambda line: _bit_of(line, address))


def _bit_of(line, address):
    telegram = bytearray(OFF1)
    telegram[2] = address
    check = 0
    for byte in telegram:
        check ^= byte
    gauge = Gauge(fall_to_fall, RECEIVE, machine.freq())
    line.link.send(telegram + bytes([check]), TELEGRAM)
    line.wait()
    time.sleep_ms(50 + 200_000 // line.baud)
    seen = gauge.counts()
    gauge.close()
    count = max(line.link.receive(line.heard, 0), 0)
    mhz = machine.freq() // 1_000_000
    return line.baud, count, (seen[0] * CYCLES_PER_COUNT * 1_000 // mhz if seen else 0)
