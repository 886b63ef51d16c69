# SPDX-License-Identifier: MIT
"""mirror and scan: who is on the line. Neither changes what a motor does."""

import time

from tools.uss_command.errors import FAILED, Failure, Misused
from tools.uss_command.leaving import SHARE
from tools.uss_command.line import Line, kind_text
from tools.uss_command.settings import numbers
from uss.finding.scan import NET_COUNTS, RATES
from uss.receiver import FINDINGS, SILENT
from uss.telegram import NODE_MAX

COLUMNS = ("address", "baud", "kind", "family", "net", "motor", "trips_after_ms")
NOT_ASKED = "not asked"
LISTEN_S = 1.0
PIECES = 10  # in which it listens, so that nodes hear something meanwhile
UNKNOWN_S = 0.25  # a node that does not tell when it trips is asked again after so long
CHARACTER_BITS = 11
LONGEST_CHARACTERS = 2 * (max(NET_COUNTS) + 4)  # of an exchange
RUNS = "drive %d runs: other rates are not tried, because it would hear noise"
MAY_RUN = (
    "address %d was sent mirror telegrams only, because a SINAMICS G120 that runs trips by "
    "others: --standing, if all motors stand, asks what it is, and tries other rates. If it has a "
    "P2014, it trips now, because it hears no more"
)
TOO_SLOW = "%d baud is not tried: drive %d would trip, because it waits %d ms for a telegram"


def add(commands):
    parser = commands.add_parser("mirror", help="send a telegram that a drive sends back: OK?")
    parser.set_defaults(run=mirror)
    parser = commands.add_parser("scan", help="find drives: addresses, rates, layouts, families")
    parser.add_argument("--addresses", default="0-31", metavar="LIST", help="(%(default)s)")
    parser.add_argument("--rates", metavar="LIST", help="such as 9600,19200, or all; (--baud)")
    parser.add_argument("--mirror-only", action="store_true", help="do not ask what they are")
    parser.set_defaults(run=scan)


def mirror(screen, settings, chosen):
    """OK with the length that came back, or why not."""
    address = settings.the_address()
    told = settings.kind(address)
    with Line(screen, settings, chosen) as line:
        line.listen()
        began_s = time.monotonic()
        lengths = (told[1].net_count,) if settings.says_layout(address) else NET_COUNTS
        net_count, other = line.probe(address, lengths)
        if net_count is None:
            raise line.no_reply(address, other)
        ms = (time.monotonic() - began_s) * 1000
    screen.event(
        "OK: drive %d, %d baud, %d net characters, %.0f ms" % (address, line.baud, net_count, ms),
        ok=True, address=address, baud=line.baud, net=net_count,
    )  # fmt: skip


def scan(screen, settings, chosen):
    addresses = numbers("--addresses", chosen.addresses, NODE_MAX)
    rates = rates_of(chosen.rates, settings.baud)
    if chosen.stay is None:
        chosen.stay = True  # no drive is left in a fault by a scan
    with Line(screen, settings, chosen) as line:
        hunt = Hunt(line, chosen.mirror_only)
        whole = len(rates) * len(addresses) * len(NET_COUNTS)
        if not chosen.mirror_only:
            line.permit_all(addresses)
        try:
            with screen.progress("scan", whole) as step:
                hunt.at(rates, addresses, step)
        except KeyboardInterrupt:
            screen.event("ended: what was found so far")
        rows = sorted(hunt.rows, key=lambda row: (row["address"], row["baud"]))
        remarks = list(hunt.remarks())
        screen.table(settings.port, COLUMNS, rows, unclear=hunt.unclear, remarks=remarks)
        if not screen.as_json:
            for remark in remarks:
                screen.event(remark)
        if not rows:
            raise Failure("nobody answers at %s baud" % ", ".join(map(str, rates)))
    return FAILED if hunt.unclear else 0


def rates_of(text, baud):
    if not text:
        return (baud,)
    if text == "all":
        return (baud,) + tuple(rate for rate in RATES if rate != baud)
    found = [int(word) if word.isdigit() else 0 for word in text.split(",")]
    if not set(found) <= set(RATES):
        raise Misused("--rates: %s is no list of rates of USS, such as 9600,19200" % text)
    return found


class Found:
    """Who answers at an address. node: None if only mirror telegrams were sent."""

    def __init__(self, line, address, net_count, node):
        self.baud = line.baud
        self.address = address
        self.node = node
        self._net_count = net_count
        self._asked_s = time.monotonic()

    def must_hear(self):
        """Whether it is time for another telegram, so that it does not trip."""
        off_time_ms = self.node.off_time_ms if self.node else None
        if off_time_ms == 0:
            return False
        wait_s = UNKNOWN_S if off_time_ms is None else off_time_ms / 1000 / SHARE
        return time.monotonic() - self._asked_s >= wait_s

    def ask(self, line):
        self._asked_s = time.monotonic()
        if self.node:
            line.visit(self.node)
        else:
            line.mirror(self.address, self._net_count)


class Hunt:
    """Looks for drives at one rate after the other. rows: those found. unclear: {address: why}."""

    def __init__(self, line, mirror_only):
        self.rows = []
        self.unclear = {}
        self._line = line
        self._mirror_only = mirror_only
        self._found = []
        self._too_slow = []  # (rate, address, ms)

    def at(self, rates, addresses, step):
        """Other rates are tried only while every motor that was found is seen to stand."""
        for rate in rates:
            if self._is_too_slow(rate):
                continue
            self._line.at(rate)
            for _ in range(PIECES):
                self._line.listen(LISTEN_S / PIECES)
                self._keep()
            self._at_this_rate(addresses, step)
            if not all(self._stands(found) for found in self._found):
                break

    def _stands(self, found):
        return not found.node.runs if found.node else self._line.standing

    def _is_too_slow(self, rate):
        """Whether a drive that was found would trip during a single exchange at this rate."""
        exchange_ms = self._line.settings.reply_timeout_ms
        exchange_ms += LONGEST_CHARACTERS * CHARACTER_BITS * 1000 // rate
        for found in self._found:
            off_time_ms = found.node.off_time_ms if found.node else None
            if off_time_ms and exchange_ms > off_time_ms // 2:
                self._too_slow.append((rate, found.address, off_time_ms))
                return True
        return False

    def _at_this_rate(self, addresses, step):
        """The usual length first, at every address, so that most are found soon."""
        line, here = self._line, set()
        for net_count in NET_COUNTS:
            for address in addresses:
                if address not in here:
                    finding = line.mirror(address, net_count)
                    if finding is None:
                        here.add(address)
                        self._found.append(self._meet(address, net_count))
                    elif finding != SILENT:
                        self.unclear[address] = FINDINGS[finding]
                self._keep()
                step()
        for address in here:
            self.unclear.pop(address, None)

    def _meet(self, address, net_count):
        line = self._line
        variable = line.mirror(address, net_count + 2) is None
        row = {"address": address, "baud": line.baud, "net": "any" if variable else net_count}
        self.rows.append(row)
        if self._mirror_only or not line.may_ask(address):
            row["kind"] = "" if self._mirror_only else NOT_ASKED
            return Found(line, address, net_count, None)
        node = line.enquire(address, net_count, variable, None)
        row["kind"], row["family"] = kind_text(node), node.family.name
        if node.layout.pzd_words:
            row["motor"] = "runs" if node.runs else "fault" if node.has_fault else "stands"
        row["trips_after_ms"] = node.off_time_ms
        return Found(line, address, net_count, node)

    def _keep(self):
        """Let those hear something that may trip for want of telegrams."""
        due = [found for found in self._found if found.must_hear()]
        here = self._line.baud
        for found in sorted(due, key=lambda found: found.baud):
            self._line.at(found.baud)
            found.ask(self._line)
        self._line.at(here)

    def remarks(self):
        for address in sorted(self.unclear):
            yield "address %d: %s: two drives with this address, or a fault of the line" % (
                address, self.unclear[address],
            )  # fmt: skip
        for found in self._found:
            if found.node is None and not self._mirror_only:
                yield MAY_RUN % found.address
            elif found.node and found.node.runs:
                yield RUNS % found.address
        for slow in self._too_slow:
            yield TOO_SLOW % slow
