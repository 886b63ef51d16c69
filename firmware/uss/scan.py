# SPDX-License-Identifier: MIT
"""Finds who is on the line, and at which baud rate, by mirror telegrams, which nobody acts on.

A node sends a mirror telegram back as it came and does nothing else with it (specification A-4.3,
A-5.3). The net data are zeros: no parameter task, and wherever a control word may stand its bit 10
is 0, so that even a node that took it for an ordinary telegram would obey nothing in it.

    scan = Scan(bus, clock.ticks_mask)
    while not scan.step(clock.ticks_us()):      # in the own loop, which keeps the bus going
        ...
    scan.found                                  # {3: 12}: node 3 takes 12 net characters

A node of fixed length answers only its own one: most usual first, NET_COUNTS are tried at every
address. Whoever is silent costs a reply time-out each time; `longest_ms` says it all together.
"""

from micropython import const

from uss.errors import NoContact
from uss.master import CLOSED, LISTENING, OFF, PAUSE_LOOK_US
from uss.receiver import SILENT
from uss.single import DONE, PENDING, Mirror
from uss.timing import BAUD_RATES, FRAME_CHARACTERS, Timing, elapsed

ADDRESSES = range(32)

# Net characters of the layouts that drives are delivered with, or usually set to (PKW + PZD
# words): 4 + 2, 3 + 2, 0 + 2, 4 + 4, 4 + 8.
NET_COUNTS = (12, 10, 4, 16, 24)
EVERY_NET_COUNT = range(2, 42, 2)  # of all fixed layouts: PKW 0, 3, 4 and PZD 0...16

# The rates in the order in which they are worth trying; those of every interface first.
RATES = (9600, 19200, 38400, 57600, 115200, 187500, 4800, 2400, 76800, 93750, 1200, 600, 300)

TRIES = const(3)  # when something came back, but not the telegram
SHARE = const(10)  # one part in so many of the line's time, when drives are in contact


class Scan:
    """bus: a `Master`. mask: the clock's period - 1. addresses: 0...31 in the order of asking.
    net_counts: the lengths to try, in net characters, even, 2...250.

    Fields to look at: `found`, a dictionary address -> net characters; `variable`, a set of those
    that take any length; `unclear`, address -> finding of `receiver`, where something came that
    was no answer: two nodes of one address, or a fault on the line; `asked`, telegrams so far;
    `over`, all is asked.

    Drives of the bus are found without being asked as long as they answer. While one of them does,
    the scan takes a tenth of the line's time.
    """

    def __init__(self, bus, mask, addresses=ADDRESSES, net_counts=NET_COUNTS):
        self.found = {}
        self.variable = set()
        self.unclear = {}
        self.asked = 0
        self.over = False
        self._bus = bus
        self._mask = mask
        self._addresses = addresses
        self._net_counts = net_counts
        self._position = 0  # in the addresses, once for every length
        self._tries = 0
        self._another_length = False  # the next telegram is to show whether any length will do
        self._mirror = None  # the telegram that is under way
        self._ended_at = 0  # when the last one was through
        self._rest_us = 0  # so long the line belongs to the drives

    @property
    def longest_ms(self):
        """How long all of it takes, in ms, when nobody answers; with what the drives take."""
        total_us = 0
        for net_count in self._net_counts:
            total_us += len(self._addresses) * _probe_us(self._bus.timing, net_count)
        return total_us * (SHARE if self._has_contact() else 1) // 1000

    def step(self, now):
        """Do what is next, which never takes long; True when all is asked.

        now: reading of the clock in microseconds. Nothing is asked as long as the bus listens.
        NoContact: the bus is off, or closed.
        """
        if self._bus.phase in (OFF, CLOSED) and not self.over:
            raise NoContact("the bus is %s" % ("off" if self._bus.phase == OFF else "closed"))
        mirror = self._mirror
        if mirror is not None:
            if mirror.state == PENDING:
                return False
            self._mirror = None
            self._ended_at = now
            self._judge(mirror)
        elif self._rest_us and elapsed(now, self._ended_at, self._mask) >= self._rest_us:
            self._rest_us = 0
        if not self.over and not self._rest_us and self._bus.phase != LISTENING:
            self._ask()
        return self.over

    def _ask(self):
        """Send the next telegram that is worth it."""
        while self._position < len(self._addresses) * len(self._net_counts):
            row, place = divmod(self._position, len(self._addresses))
            address, net_count = self._addresses[place], self._net_counts[row]
            drive = self._listed(address)
            if self._another_length:
                self._send(address, self.found[address] + 2)
                return
            if address in self.found:
                self._go_on()
            elif drive is None or not drive.contact and drive.silent:
                self._send(address, net_count)
                return
            elif drive.contact:
                self.found[address] = drive.layout.net_count
                if drive.layout.variable:
                    self.variable.add(address)
            else:
                return  # it was not asked yet; the list will soon have come round to it
        self.over = True

    def _send(self, address, net_count):
        mirror = Mirror(address, bytes(net_count))
        try:
            self._bus.post(mirror)
        except RuntimeError:  # other telegrams outside the list wait already
            return
        self._mirror = mirror
        self.asked += 1
        if self._has_contact():
            self._rest_us = (SHARE - 1) * _probe_us(self._bus.timing, net_count)

    def _judge(self, mirror):
        """What came back, and what to ask next."""
        address = mirror.node
        self._tries += 1
        if self._another_length:
            self._another_length = False
            if mirror.state == DONE:
                self.variable.add(address)
            self._go_on()
        elif mirror.state == DONE:
            self.found[address] = mirror.size - FRAME_CHARACTERS
            self.unclear.pop(address, None)
            self._another_length = True
        elif mirror.finding == SILENT:
            self._go_on()
        else:
            self.unclear[address] = mirror.finding
            if self._tries >= TRIES:
                self._go_on()

    def _go_on(self):
        self._position += 1
        self._tries = 0

    def _listed(self, address):
        for drive in self._bus.drives:
            if drive.address == address:
                return drive
        return None

    def _has_contact(self):
        for drive in self._bus.drives:
            if drive.contact:
                return True
        return False


class RateScan:
    """Looks for the baud rate of a line on which nothing is known, and who is there.

    open_bus: function baud -> a `Master` without drives, on a link of that rate; the caller lets
    go of the one before and keeps the new one going. nothing_runs: ValueError unless it is True. A
    drive hears noise at any rate but its own, and one that runs may trip for want of telegrams.

        scan = RateScan(open_bus, clock.ticks_mask, nothing_runs=True)
        while not scan.step(clock.ticks_us()): ...
        scan.baud, scan.found               # 19200, {3: 12}; None, {} when nobody answered

    At each rate the bus listens before it sends. When it hears anybody talk, the scan is over and
    `line_in_use` is True. It ends at the first rate at which somebody answers. `unclear` tells of
    the rates before it at which something came that was no answer, rate -> `Scan.unclear`: where
    all drives have the address that they are delivered with, for instance.
    """

    def __init__(
        self, open_bus, mask, nothing_runs=False, rates=RATES,
        addresses=ADDRESSES, net_counts=NET_COUNTS,
    ):  # fmt: skip
        if nothing_runs is not True:
            raise ValueError("only when no motor runs on this line: say nothing_runs=True")
        for rate in rates:
            if rate not in BAUD_RATES:
                raise ValueError("baud rate %r is none of USS" % (rate,))
        self.baud = None
        self.unclear = {}
        self.line_in_use = False
        self.over = False
        self.scan = None  # the `Scan` at the rate that is tried
        self._open_bus = open_bus
        self._mask = mask
        self._rates = rates
        self._next = 0
        self._addresses = addresses
        self._net_counts = net_counts
        self._bus = None
        self._foreign = 0  # what the bus had counted when it sent its first telegram

    @property
    def found(self):
        """As of `Scan`: who answered, address -> net characters."""
        return self.scan.found if self.scan else {}

    @property
    def longest_ms(self):
        """How long it takes at the most, in ms, besides listening: when nobody answers at all."""
        total_us = 0
        for rate in self._rates:
            timing = Timing(rate)
            for net_count in self._net_counts:
                total_us += len(self._addresses) * _probe_us(timing, net_count)
        return total_us // 1000

    def step(self, now):
        """Do what is next; True when it is over. ValueError: the bus opened has drives."""
        if self.over:
            return True
        if self.scan is None:
            self._open()
        elif self._hears_a_master():
            self.line_in_use = True
            self._bus.off()
            self.over = True
        elif self.scan.step(now):
            self._end_rate()
        return self.over

    def _hears_a_master(self):
        """Whether one talks before the first telegram, or was heard since."""
        bus = self._bus
        if not self.scan.asked:
            self._foreign = bus.foreign
        return bus.is_line_in_use() or bus.foreign != self._foreign

    def _open(self):
        self._bus = bus = self._open_bus(self._rates[self._next])
        if bus.drives:
            raise ValueError("a bus with drives would send them telegrams that nobody knows yet")
        self.scan = Scan(bus, self._mask, self._addresses, self._net_counts)

    def _end_rate(self):
        rate = self._rates[self._next]
        self._next += 1
        if self.scan.unclear:
            self.unclear[rate] = self.scan.unclear
        if self.scan.found:
            self.baud = rate
            self.over = True
        elif self._next == len(self._rates):
            self.over = True
        else:
            self.scan = None


def _probe_us(timing, net_count):
    """What a mirror telegram costs that nobody answers; on an idle bus it is noticed late."""
    sending_us = timing.start_interval_us + timing.telegram_us(net_count)
    return PAUSE_LOOK_US + sending_us + timing.reply_timeout_us + timing.character_us
