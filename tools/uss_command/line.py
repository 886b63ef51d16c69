# SPDX-License-Identifier: MIT
"""The line, as a command has it: it listens first, and asks drives without commanding them.

with Line(settings) as line:            # PortError
    line.listen()                       # Failure: another master is heard
    node = line.node(1)                 # what answers there; Failure
    job = line.ask(node, pkw.read(700)) # Failure
"""

from uss_serial import Master, SerialLink

from tools.uss_command.errors import Failure
from tools.uss_command.facts import Facts
from tools.uss_command.visit import Visit
from uss import families, pkw, pzd
from uss.bus.pkw_errors import error_text
from uss.errors import UssError
from uss.finding.enquiry import Enquirer
from uss.finding.scan import NET_COUNTS
from uss.layout import Layout
from uss.outside import DONE, PENDING, Mirror
from uss.receiver import FINDINGS, SILENT
from uss.tasks.arrays import with_array_task

LISTEN_S = 0.4
TRIES = 5  # telegrams without a valid reply in a row: nobody is there
PROBES = 2  # an adapter may lose a telegram
READS = 3  # a question that was lost three times in a row ends so; it may be asked again
EXCHANGE_S = 10.0  # no exchange takes so long at any rate
NO_REPLY = "drive %d does not answer at %d baud"
HINTS = (
    "; is its address right (try scan), its rate, its connector, "
    "and does the adapter send with even parity (8E1)?"
)
PARITY_HINT = "; %d characters came with a wrong parity or stop bit: another rate, or not 8E1?"
ANY_LENGTH = (
    "drive %d takes telegrams of any length, as a SINAMICS G120 does; a G120 that runs trips if "
    "somebody asks it beside its master. Say --kind %d=v20 (or what it is), or --standing if its "
    "motor stands"
)
G120_RUNS = (
    "a SINAMICS G120 that runs trips if somebody asks it beside its master: say --standing if the "
    "motor of drive %d stands"
)


class Node:
    """What answers at an address: family, layout, `visit`, `facts`."""

    def __init__(self, address, family, layout, mask, off_time_ms=None):
        self.address = address
        self.family = family
        self.layout = layout
        self.facts = Facts(family)
        self.visit = Visit(address, layout, mask)
        self.off_time_ms = off_time_ms  # it trips after so long without a telegram; None: unknown
        self._mask = mask

    def forget(self):
        """Begin anew with a drive that was lost."""
        good, bad = self.visit.good, self.visit.bad
        self.visit = Visit(self.address, self.layout, self._mask)
        self.visit.good, self.visit.bad = good, bad

    @property
    def zsw(self):
        return self.visit.words[0] if self.visit.words else None

    @property
    def runs(self):
        return self.zsw is not None and self.zsw & pzd.ZSW_RUNNING != 0


class Line:
    """settings: `Settings`. standing: the user says that all motors stand. watch: as of
    `SerialLink`."""

    def __init__(self, settings, standing=False, watch=None):
        self.settings = settings
        self.standing = standing
        self.word = 0  # commands nothing
        self._watch = watch
        self._heard = 0
        self._listening = False
        self._open(settings.baud)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def _open(self, baud):
        if not self.settings.port:
            raise Failure("which port? --port /dev/ttyUSB0, or USS_PORT, or port in uss.toml")
        self.baud = baud
        self.link = SerialLink(self.settings.port, baud, watch=self._see)
        self.bus = Master(self.link, baud, self.settings.reply_timeout_ms)
        self.mask = self.link.clock.ticks_mask

    def close(self):
        self.bus.close()

    def reopen(self, baud):
        """Go on at another rate."""
        self.close()
        self._open(baud)

    def _see(self, is_sent, characters, at_us):
        if not is_sent and self._listening:
            self._heard += len(characters)
        if self._watch is not None:
            self._watch(is_sent, characters, at_us)

    def listen(self, seconds=LISTEN_S):
        """Failure: somebody talks, so another master is there."""
        self._listening, self._heard = True, 0
        self.bus.wait(seconds)
        self._listening = False
        self._check_cut()
        if self._heard:
            raise Failure(
                "another master talks on this line (%d characters in %.1f s): pause it, or look "
                "with sniff; nothing was sent" % (self._heard, seconds)
            )

    def _check_cut(self):
        if self.link.is_cut:
            raise Failure(self.link.notices[-1])

    def exchange(self, telegram):
        """Send it and wait for its end; whether it was answered. Failure: the line is not ours."""
        self.bus.post(telegram)
        self.bus.wait(EXCHANGE_S, lambda: telegram.state != PENDING or self._is_lost())
        self._check_cut()
        if telegram.state == PENDING or self.bus.foreign:
            raise Failure("another master has begun to talk on this line: nothing more was sent")
        return telegram.state == DONE

    def _is_lost(self):
        return self.link.is_cut or self.bus.foreign > 0

    # --- who is there ---------------------------------------------------------------------------

    def mirror(self, address, net_count):
        """None if the telegram came back, else the receiver's finding. If something else came,
        which may only be late, it is sent again.
        """
        finding = SILENT
        for _ in range(READS):
            telegram = Mirror(address, bytes(net_count))
            if self.exchange(telegram):
                return None
            finding = telegram.finding
            if finding == SILENT:
                break
        return finding

    def probe(self, address, net_counts=NET_COUNTS):
        """(net characters that a node takes, whether it takes others too), or (None, finding)."""
        worst = SILENT
        for net_count in net_counts * PROBES:
            finding = self.mirror(address, net_count)
            if finding is None:
                return net_count, self.mirror(address, net_count + 2) is None
            if finding != SILENT:
                worst = finding
        return None, worst

    def node(self, address):
        """The `Node` there: what the user says, or what it tells. Failure."""
        told = self.settings.kind(address)
        if told:
            self._check_g120(address, told[0])
            return Node(address, told[0], told[1], self.mask)
        net_count, other = self.probe(address)
        if net_count is None:
            raise self.no_reply(address, other)
        if other and not self.standing:
            raise Failure(ANY_LENGTH % (address, address))
        return self.enquire(address, net_count, other)

    def _check_g120(self, address, family):
        if not family.takes_no_control and not self.standing:
            raise Failure(G120_RUNS % address)

    def enquire(self, address, net_count, variable):
        """Ask a node what it is, with telegrams whose control word is `word`."""
        enquirer = Enquirer(address, net_count, variable)
        while True:
            question = enquirer.question(self.word)
            self.exchange(question)
            if enquirer.take(question):
                break
        told = enquirer.node
        node = Node(address, told.family, told.layout, self.mask, told.off_time_ms)
        node.visit.words = (told.zsw,)
        return node

    def no_reply(self, address, finding=SILENT):
        """The Failure that says why there is no answer."""
        text = NO_REPLY % (address, self.baud)
        wrong = self.link.parity_errors + self.link.frame_errors
        if wrong:
            return Failure(text + PARITY_HINT % wrong)
        if finding == SILENT:
            return Failure(text + HINTS)
        return Failure("drive %d: %s" % (address, FINDINGS[finding]))

    # --- what it says ---------------------------------------------------------------------------

    def visit(self, node):
        """One telegram that commands nothing; whether it was answered."""
        return self.exchange(node.visit)

    def see(self, node):
        """Visit it until it answers. Failure."""
        for _ in range(TRIES):
            if self.visit(node):
                return
        raise self.no_reply(node.address, node.visit.finding)

    def ask(self, node, job):
        """Carry out a job of `pkw`; return it: DONE or REFUSED. Failure: no answer."""
        if not node.layout.pkw_words:
            raise Failure("drive %d has no parameter channel (0 PKW words)" % node.address)
        if node.family.has_array_tasks:
            job = with_array_task(job, node.family)
        for _ in range(1 if job.writes() else READS):
            node.visit.channel.ask(job)
            while job.state == PENDING:
                self.visit(node)
                if node.visit.in_a_row >= TRIES:
                    raise self.no_reply(node.address, node.visit.finding)
            if job.state in (pkw.DONE, pkw.REFUSED):
                return job
        label = node.facts.label(job.number, job.index)
        text = "drive %d does not answer about %s" % (node.address, label)
        if job.writes():
            text += "; whether it was written is not known: read it"
        raise Failure(text)

    def do(self, node, job):
        """As `ask`. Failure: it was refused."""
        self.ask(node, job)
        if job.state == pkw.REFUSED:
            label = node.facts.label(job.number, job.index)
            raise Failure("drive %d refuses %s: %s" % (node.address, label, error_text(job.error)))
        return job

    # --- its motor ------------------------------------------------------------------------------

    def command(self):
        """From now on this is the master: questions carry OFF1, whatever the drive is."""
        self.standing = True
        self.word = pzd.OFF1

    def drive(self, node, unsupervised=False):
        """The node as a `uss.bus.Drive`, which is commanded from now on. Failure."""
        drive = self.bus.add(node.address, node.family, node.layout, unsupervised=unsupervised)
        drive.engine.ask_soon()
        self.bus.wait(2.0, lambda: drive.contact or drive.silent >= TRIES)
        if not drive.contact:
            raise self.no_reply(node.address)
        return drive


def in_words(action, *arguments, **named):
    """Call it; what the library raises becomes a Failure."""
    try:
        return action(*arguments, **named)
    except (UssError, ValueError) as error:
        raise Failure(str(error)) from None


def kind_text(node):
    """ "mm440/4+4": what --kind takes."""
    from uss.families import kinds

    family = getattr(node.family, "com", None) or node.family
    text = kinds.text(family, node.layout)
    if family is not node.family:
        name, slash, words = text.partition("/")
        text = name + "-bop" + slash + words
    return text


def layout_of(pkw_words, pzd_words):
    return Layout(pkw_words, pzd_words)


GENERIC = families.GENERIC
