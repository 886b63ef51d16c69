# SPDX-License-Identifier: MIT
"""Finds which drives are on the line, and at which baud rate, by mirror telegrams.

A node sends a mirror telegram back as it came and does nothing else with it (specification A-4.3,
A-5.3). The net data are zeros: they hold no parameter task, and bit 10 is 0 wherever a control
word may stand. So even a node that took it for an ordinary telegram would obey nothing in it.

A node that was found, and that is not on the bus, is sent OFF1 at once and asked what it is
(`enquiry`), and when it trips for want of telegrams (P2014): the scan asks it often enough for
that until it is over. Then it will trip, unless you add it to the bus.

    scan = Scan(bus, clock.ticks_mask)
    while not scan.step(clock.ticks_us()):      # in your loop, which keeps the bus going
        ...
    for address, node in scan.nodes.items():
        bus.add(address, node.family, node.layout)

A node of fixed length answers only its own length. So the scan tries NET_COUNTS at every address,
the most usual length first. Each silent address costs a reply time-out each time; `longest_ms` is
the sum.
"""

from micropython import const

from uss.finding.enquiry import Enquirer, Question
from uss.errors import WHY_SILENT, NoContact, UssError
from uss.master import LISTENING, OFF, PAUSE_LOOK_US
from uss.pzd import ZSW_RUNNING
from uss.receiver import SILENT
from uss.silence import SHARE
from uss.telegram import NODE_MAX
from uss.outside import DONE, PENDING, Mirror
from uss.timing import BAUD_RATES, FRAME_CHARACTERS, Timing, elapsed

ADDRESSES = range(32)

# Net characters of the layouts that drives are delivered with, or usually set to (PKW + PZD
# words): 4 + 2, 3 + 2, 0 + 2, 4 + 4, 4 + 8, 0 + 4, 3 + 4.
NET_COUNTS = (12, 10, 4, 16, 24, 8, 14)
EVERY_NET_COUNT = range(2, 42, 2)  # of all fixed layouts: PKW 0, 3, 4 and PZD 0...16

# The rates in the order in which they are worth trying; those of every interface first.
RATES = (9600, 19200, 38400, 57600, 115200, 187500, 4800, 2400, 76800, 93750, 1200, 600, 300)

TRIES = const(3)  # telegrams to an address, if something came back, but not the telegram
ACCOUNT_US = const(10_000)  # the bus takes so long to charge a silence to the silent drives' share
KEEP_US = const(100_000)  # a node that does not tell when it trips is asked again after so long,
KEEP_SHARE = const(3)  # the others after this part of the time,
KEEP_MAX = const(2)  # but at most so many such nodes in a row
LAST_QUESTIONS = const(20)  # after `finish`


class Scan:
    """bus: a `Master` of `uss.bus`, or an engine. mask: the clock's period - 1. addresses: 0...31
    in the order of asking. net_counts: the lengths to try, in net characters, even, 2...250.
    enquire: False sends mirror telegrams only, and `nodes` and `will_trip` stay empty.

    Fields to look at:
    found      a dictionary: address -> net characters
    variable   a set of the addresses that take any length
    unclear    address -> finding of `receiver`, where something came that was no answer: two nodes
               have this address, or the line has a fault
    asked      mirror telegrams so far
    nodes      address -> `enquiry.Node`, of nodes that are not on the bus
    will_trip  address -> milliseconds, of those nodes that trip when they hear no more; None if
               the drive does not tell
    over       there is nothing more to ask
    stopped    a stop or `end` ended it

    The scan does not ask drives of the bus as long as they answer; they count as found. While one
    of them answers, the scan probes only in the share of the line's time that silent drives have,
    see `silence`; if the drives that run leave none, it waits. A stop of any of them ends the
    scan.
    """

    def __init__(self, bus, mask, addresses=ADDRESSES, net_counts=NET_COUNTS, enquire=True):
        self.found = {}
        self.variable = set()
        self.unclear = {}
        self.nodes = {}
        self.will_trip = {}
        self.asked = 0
        self.over = False
        self.stopped = False
        self._bus = engine_of(bus)
        self._mask = mask
        self._addresses = addresses
        self._net_counts = net_counts
        self._enquires = enquire
        self._stops = self._count_stops()
        self._position = 0  # counts through the addresses, once for every length
        self._address = 0  # that was probed last
        self._last_questions = LAST_QUESTIONS
        self._tries = 0
        self._another_length = False  # the next telegram is to show whether any length will do
        self._telegram = None  # the telegram that is under way
        self._take = None  # what is called with it when it is over
        self._silent_at = None  # when the last telegram that nobody answered was over
        self._kept = {}  # nodes found that are not on the bus: address -> when it was asked last
        self._kept_in_a_row = 0
        self._enquirer = None  # asks one of them what it is

    @property
    def longest_ms(self):
        """How long it takes, in ms, to probe every address if none answers, with the time that the
        drives of the bus take. Each node that is found takes about half a second more; where many
        trip soon, up to three times as long."""
        alone_us = longest_us(self._bus.timing, self._addresses, self._net_counts)
        return alone_us * (SHARE if self._has_contact() else 1) // 1000

    def progress(self, whole):
        """How much of `whole` is done, without the questions to nodes that are found."""
        places = len(self._addresses) * len(self._net_counts)
        return whole * min(self._position, places) // places

    def asked_nodes(self):
        """A list of (address, `enquiry.Node`) of those that have told what they are."""
        return [(one, self.nodes[one]) for one in sorted(self.nodes) if one != self._enquiring]

    def step(self, now):
        """Do what is next, which never takes long; True when the scan is over.

        now: reading of the clock in microseconds. The scan asks nothing as long as the bus
        listens. NoContact if the bus is off, or closed.
        """
        if self._bus.phase in WHY_SILENT and not self.over:
            raise NoContact(WHY_SILENT[self._bus.phase])
        if self._count_stops() != self._stops:
            self.end()
        if self.over:
            return True
        telegram = self._telegram
        if telegram is not None:
            if telegram.state == PENDING:
                return False
            self._telegram = None
            self._take(telegram, now)
        if self._bus.phase != LISTENING:
            self._go_on(now)
        return self.over

    def keep(self, now):
        """After it is over: go on asking the nodes that are not on the bus, so that they do not
        trip. To be called in place of `step`."""
        telegram = self._telegram
        if telegram is not None:
            if telegram.state == PENDING:
                return
            self._telegram = None
            self._kept_in_a_row = 0
            if telegram.address & NODE_MAX in self._kept:
                self._note(telegram, now)
        phase = self._bus.phase
        if phase == LISTENING or phase in WHY_SILENT or self._bus.deadlines.silence_wait_us():
            return
        self._keep(now)

    def finish(self):
        """Look for no more nodes: the scan is over as soon as those it has found were told OFF1
        and asked what they are, with LAST_QUESTIONS at the most."""
        self._position = len(self._addresses) * len(self._net_counts)
        self.stopped = True

    def end(self):
        """End the scan at once. A node that was found and not asked what it is may trip."""
        if self.over:
            return
        self.over = self.stopped = True
        for address in self._kept if self._enquires else ():
            if address not in self.nodes or address == self._enquiring:
                self.will_trip.setdefault(address, None)

    def _go_on(self, now):
        """Send the next telegram: to a node that was found, or to look for others."""
        if self._keep(now):
            return
        if self._silent_at is not None:
            if elapsed(now, self._silent_at, self._mask) < ACCOUNT_US:
                return
            self._silent_at = None
        if self._bus.deadlines.silence_wait_us():
            return
        if self._enquires and not self._another_length and self._enquire():
            return
        if self._is_searched():
            self.over = True
        else:
            self._ask()

    def _send(self, telegram, take):
        """Post a telegram; `take` is called when it is over. False: too many wait already."""
        try:
            self._bus.turns.post(telegram)
        except RuntimeError:
            return False
        self._telegram = telegram
        self._take = take
        return True

    # --- who is there ---------------------------------------------------------------------------

    def _is_searched(self):
        whole = len(self._addresses) * len(self._net_counts)
        return self._position >= whole and not self._another_length

    def _ask(self):
        """Send the next mirror telegram that can find something new."""
        if self._another_length:
            self._probe(self._address, self.found[self._address] + 2)
            return
        while not self._is_searched():
            row, place = divmod(self._position, len(self._addresses))
            address, net_count = self._addresses[place], self._net_counts[row]
            drive = self._bus.turns.at(address)
            if address in self.found:
                self._next()
            elif drive is None or not drive.contact and drive.silent:
                self._probe(address, net_count)
                return
            elif drive.contact:
                self.found[address] = drive.layout.net_count
                if drive.layout.variable:
                    self.variable.add(address)
            else:
                return  # a drive of the bus that had no turn yet: the list asks it soon

    def _probe(self, address, net_count):
        self._address = address
        if self._send(Mirror(address, bytes(net_count)), self._judge):
            self.asked += 1

    def _judge(self, mirror, now):
        """Judge what came back, and decide what to ask next."""
        address = mirror.node
        self._note_silence(mirror, now)
        self._tries += 1
        if self._another_length:
            self._another_length = False
            if mirror.state == DONE:
                self.variable.add(address)
            self._next()
        elif mirror.state == DONE:
            self.found[address] = mirror.size - FRAME_CHARACTERS
            self.unclear.pop(address, None)
            self._another_length = True
            if self._bus.turns.at(address) is None:
                self._kept[address] = now
        elif mirror.finding == SILENT:
            self._next()
        else:
            self.unclear[address] = mirror.finding
            if self._tries >= TRIES:
                self._next()

    def _next(self):
        self._position += 1
        self._tries = 0

    def _note_silence(self, telegram, now):
        if telegram.state != DONE and self._has_contact():
            self._silent_at = now

    # --- who was found: none is to trip while this goes on --------------------------------------

    def _keep(self, now):
        """Ask the node that waits longest again, if it is time; return whether one was asked."""
        late_us, address = -1, None
        for kept, asked_at in self._kept.items():
            if self._bus.turns.at(kept) is not None:
                continue  # it has been added since
            waits_us = elapsed(now, asked_at, self._mask) - self._keep_us(kept)
            if waits_us > late_us:
                late_us, address = waits_us, kept
        if address is None or self._kept_in_a_row >= KEEP_MAX:
            self._kept_in_a_row = 0
            return False
        node = self.nodes.get(address)
        if node is None or address == self._enquiring or not node.layout.pzd_words:
            telegram = Mirror(address, bytes(self.found[address]))
        else:  # a V20 trips unless it hears process data
            telegram = Question(address, node.layout, None)
        if self._send(telegram, self._note):
            self._kept_in_a_row += 1
        return True

    @property
    def _enquiring(self):
        """The address that is being asked what it is, or None."""
        return self._enquirer.node.address if self._enquirer else None

    def _keep_us(self, address):
        """After so long it is to be asked again."""
        if address == self._enquiring or address not in self.nodes:
            return KEEP_US
        off_time_ms = self.nodes[address].off_time_ms
        return KEEP_US if off_time_ms is None else max(off_time_ms * 1000 // KEEP_SHARE, KEEP_US)

    def _note(self, telegram, now):
        self._kept[telegram.address & NODE_MAX] = now
        self._note_silence(telegram, now)

    def _enquire(self):
        """Send the next question to a node that was found; False if none is left to ask."""
        if self._enquirer is None:
            left = [address for address in sorted(self._kept) if address not in self.nodes]
            if not left:
                return False
            address = left[0]
            enquirer = Enquirer(address, self.found[address], address in self.variable)
            self._enquirer = enquirer
            self.nodes[address] = enquirer.node
        if not self._last_questions:  # what it is sent last is OFF1 in its usual form
            node = self._enquirer.node
            self._send(Question(node.address, node.layout, None), self._give_up)
        elif self._send(self._enquirer.question(), self._take_answer) and self.stopped:
            self._last_questions -= 1
        return True

    def _give_up(self, question, now):
        self.will_trip[self._enquiring] = None
        self._enquirer = None

    def _take_answer(self, question, now):
        node = self._enquirer.node
        self._kept[node.address] = now
        self._note_silence(question, now)
        if self._enquirer.take(question):
            self._enquirer = None
            if node.off_time_ms == 0:
                self._kept.pop(node.address)
            else:
                self.will_trip[node.address] = node.off_time_ms

    # --- the bus --------------------------------------------------------------------------------

    def _has_contact(self):
        return any([drive.contact for drive in self._bus.turns.drives])

    def _count_stops(self):
        return sum([drive.stops for drive in self._bus.turns.drives])


class RateScan:
    """Looks for the baud rate of an unknown line, and for the drives on it.

    open_bus: function baud -> a `Master` without drives, on a link of that rate; the caller lets
    go of the one before and keeps the new one going. nothing_runs: ValueError unless it is True,
    because a drive hears noise at any rate but its own, and one that runs may trip for want of
    telegrams. bus: the `Master` that has the line so far, if there is one; the caller keeps it
    going until its phase is OFF. UssError unless each of its drives is seen to stand, and no other
    master is heard there. The scan puts it off before it tries the first rate; then those of its
    drives trip whose P2014 is set. The other arguments are those of `Scan`.

        scan = RateScan(open_bus, clock.ticks_mask, nothing_runs=True)
        while not scan.step(clock.ticks_us()): ...
        scan.baud, scan.found               # 19200, {3: 12}; None, {} when nobody answered

    At each rate the bus listens before it sends. If it hears another master, the scan is over and
    `line_in_use` is True. The scan ends at the first rate at which a node answers. `found`,
    `nodes` and `will_trip` are those of the `Scan` at the rate that is tried: address -> net
    characters, address -> `enquiry.Node`, address -> milliseconds. `unclear` tells of the rates at
    which something came that was no answer, rate -> `Scan.unclear`: for instance because all
    drives have the address that they are delivered with.
    """

    def __init__(
        self, open_bus, mask, nothing_runs=False, rates=RATES,
        addresses=ADDRESSES, net_counts=NET_COUNTS, enquire=True, bus=None,
    ):  # fmt: skip
        if nothing_runs is not True:
            raise ValueError("only when no motor runs on this line: say nothing_runs=True")
        for rate in rates:
            if rate not in BAUD_RATES:
                raise ValueError("baud rate %r is none of USS" % (rate,))
        self.baud = None
        self.found = self.nodes = self.will_trip = {}
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
        self._enquires = enquire
        self._bus = None
        self._left = engine_of(bus)  # the bus before, until it is off
        self._is_leaving = False
        self._foreign = 0  # `foreign` of the bus when it sent its first telegram

    @property
    def longest_ms(self):
        """How long it takes at the most, in ms, without the listening: when no node answers."""
        timings = [Timing(rate) for rate in self._rates]
        addresses, net_counts = self._addresses, self._net_counts
        return sum([longest_us(timing, addresses, net_counts) for timing in timings]) // 1000

    def step(self, now):
        """Do what is next; True when it is over. ValueError if the bus that was opened has drives.
        UssError if a drive of the bus before is not seen to stand, or another master is heard."""
        if self.over:
            return True
        if self._left is not None:
            self._leave()
        elif self.scan is None:
            self._open()
        elif self._hears_a_master():
            self.line_in_use = True
            self._bus.off()
            self.over = True
        elif self.scan.step(now):
            self._end_rate()
        return self.over

    def end(self):
        """End the scan at once; try no further rate."""
        self.over = True
        if self.scan:
            self.scan.end()

    def _leave(self):
        """Put the bus before off, if all its drives stand."""
        bus = self._left
        if bus.phase == OFF and (self._is_leaving or not bus.turns.drives):
            self._left = None
        elif not self._is_leaving:
            for drive in bus.turns.drives:
                if not drive.contact or drive.may_run() or drive.zsw & ZSW_RUNNING:
                    raise UssError("drive %d is not seen to stand: no other rate" % drive.address)
            if bus.is_line_in_use() or bus.is_line_shared():
                raise UssError("another master is on the line: no other rate")
            bus.off()
            self._is_leaving = True

    def _hears_a_master(self):
        """Whether another master was heard, before the first telegram or since."""
        bus = self._bus
        if not self.scan.asked:
            self._foreign = bus.foreign
        return bus.is_line_in_use() or bus.foreign != self._foreign

    def _open(self):
        self._bus = bus = engine_of(self._open_bus(self._rates[self._next]))
        if bus.turns.drives:
            raise ValueError("a bus with drives would send them telegrams that nobody knows yet")
        self.scan = scan = Scan(bus, self._mask, self._addresses, self._net_counts, self._enquires)
        self.found, self.nodes, self.will_trip = scan.found, scan.nodes, scan.will_trip

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


def engine_of(bus):
    """The engine of a `Master`, of `uss.bus` or of `uss.master`, which is one."""
    return getattr(bus, "engine", bus)


def longest_us(timing, addresses, net_counts, look_us=PAUSE_LOOK_US):
    """The time of mirror telegrams that nobody answers; an idle bus notices them look_us late."""
    waiting_us = look_us + timing.start_interval_us
    waiting_us += timing.reply_timeout_us + timing.character_us
    probes_us = sum([waiting_us + timing.telegram_us(net_count) for net_count in net_counts])
    return len(addresses) * probes_us
