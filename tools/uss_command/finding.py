# SPDX-License-Identifier: MIT
"""mirror and scan: who is on the line. Neither changes what a motor does."""

import time

from tools.uss_command.errors import FAILED, Failure, Misused
from tools.uss_command.line import Line, kind_text
from tools.uss_command.settings import numbers
from uss.finding.scan import NET_COUNTS, RATES
from uss.receiver import FINDINGS, SILENT
from uss.telegram import NODE_MAX

COLUMNS = ("address", "baud", "kind", "family", "net", "motor", "trips_after_ms")
NOT_ASKED = "not asked: any length, so perhaps a G120 (--standing)"
LISTEN_S = 1.0
KEEP_S = 0.1  # nodes that were found are asked so often, so that none trips meanwhile
LATE_TRIP = "drive %d trips (%s) %s ms from now, because it hears no more: P2014; ack clears that"
RUNS = "drive %d runs: other rates are not tried, because it would hear noise"


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
    with Line(settings, chosen.standing, chosen.watch) as line:
        line.listen()
        began_s = time.monotonic()
        lengths = (told[1].net_count,) if told else NET_COUNTS
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
    with Line(settings, chosen.standing, chosen.watch) as line:
        hunt = Hunt(line, chosen.mirror_only)
        whole = len(rates) * len(addresses) * len(NET_COUNTS)
        try:
            with screen.progress("scan", whole) as step:
                for rate in rates:
                    if rate != line.baud:
                        line.reopen(rate)
                    line.listen(LISTEN_S)
                    hunt.at_this_rate(addresses, step)
                    if hunt.running:
                        break
        except KeyboardInterrupt:
            screen.event("ended: what was found so far")
    rows = sorted(hunt.rows, key=lambda row: (row["address"], row["baud"]))
    screen.table(settings.port, COLUMNS, rows, unclear=hunt.unclear)
    if not screen.as_json:
        for line_of_text in hunt.remarks():
            screen.event(line_of_text)
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


class Hunt:
    """Looks for drives at one rate after the other. rows: those found. unclear: {address: why}.
    running: the addresses of motors that were seen to run."""

    def __init__(self, line, mirror_only):
        self.rows = []
        self.unclear = {}
        self.running = []
        self._line = line
        self._mirror_only = mirror_only
        self._tripping = []  # (address, fault, ms)

    def at_this_rate(self, addresses, step):
        """The usual length first, at every address, so that most are found soon."""
        line, found, supervised = self._line, {}, []
        self._kept_s = time.monotonic()
        for net_count in NET_COUNTS:
            for address in addresses:
                if address not in found:
                    finding = line.mirror(address, net_count)
                    if finding is None:
                        found[address] = self._found(address, net_count, supervised)
                    elif finding != SILENT:
                        self.unclear[address] = FINDINGS[finding]
                self._keep(supervised)
                step()
        for address in found:
            self.unclear.pop(address, None)
        for node in supervised:
            fault = node.family.off_time_fault
            name = node.family.fault_format % fault if fault else "a fault"
            self._tripping.append((node.address, name, node.off_time_ms))

    def _found(self, address, net_count, supervised):
        line = self._line
        variable = line.mirror(address, net_count + 2) is None
        row = {"address": address, "baud": line.baud, "net": "any" if variable else net_count}
        self.rows.append(row)
        if self._mirror_only or variable and not line.standing:
            row["kind"] = "" if self._mirror_only else NOT_ASKED
            return row
        node = line.enquire(address, net_count, variable)
        row["kind"], row["family"] = kind_text(node), node.family.name
        row["motor"] = "runs" if node.runs else "stands" if node.layout.pzd_words else ""
        row["trips_after_ms"] = node.off_time_ms
        if node.runs:
            self.running.append(address)
        if node.off_time_ms:
            supervised.append(node)
        return row

    def _keep(self, supervised):
        """Ask those that trip for want of telegrams again."""
        if time.monotonic() - self._kept_s >= KEEP_S:
            for node in supervised:
                self._line.visit(node)
            self._kept_s = time.monotonic()

    def remarks(self):
        for address in sorted(self.unclear):
            yield "address %d: %s: two drives with this address, or a fault of the line" % (
                address, self.unclear[address],
            )  # fmt: skip
        for address in self.running:
            yield RUNS % address
        for trip in self._tripping:
            yield LATE_TRIP % trip
