# SPDX-License-Identifier: MIT
"""The line, as a command has it: it listens first, and asks drives without commanding them.

with Line(screen, settings, chosen) as line:    # PortError
    line.listen()                       # Failure: another master is heard
    node = line.node(1)                 # what answers there; Failure
    job = line.ask(node, pkw.read(700)) # Failure
                                        # its end: `leaving`

A telegram with a control word goes only to a drive that nothing can happen to by that (`permit`):
somebody has said that it is of a family that leaves a control word with bit 10 = 0 aside, or that
its motor stands. A SINAMICS G120 that runs trips by such a word, and no answer to a mirror
telegram, which is all that can be sent before, tells it from others.
"""

import functools
import operator

from uss_serial import Master, SerialLink

from tools.uss_command.errors import Failure
from tools.uss_command.facts import Facts
from tools.uss_command.leaving import leave
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
PIECE = 4  # so many characters are no noise
READS = 3  # a question that was lost three times in a row ends so; it may be asked again
EXCHANGE_S = 10.0  # no exchange takes so long at any rate
NO_REPLY = "drive %d does not answer at %d baud"
HINTS = (
    "; is its address right (try scan), its rate, its connector, "
    "and does the adapter send with even parity (8E1)?"
)
PARITY_HINT = "; %d characters came with a wrong parity or stop bit: another rate, or not 8E1?"
WHAT_IS_IT = (
    "what is drive %d? Say --kind mm440, or what it is (also in uss.toml), or --standing if its "
    "motor stands: a SINAMICS G120 that runs trips if somebody asks it beside its master. Nothing "
    "was sent"
)
G120_RUNS = (
    "a SINAMICS G120 that runs trips if somebody asks it beside its master: say --standing if the "
    "motor of drive %d stands. Nothing was sent"
)
DOES_IT_STAND = "Does the motor of drive %d stand? A SINAMICS G120 that runs would trip."
DO_THEY_STAND = (
    "Do the motors of all drives on this line stand? A SINAMICS G120 that runs would trip."
)
OTHERS_BEGAN = "another master has begun to talk on this line: nothing more was sent"
OTHER_LAYOUT = "drive %d has %s words, not %s, as --kind says"
NO_SUCH_DRIVE = "drive %d has %s words, which a %s cannot have: is it one?"


class Node:
    """What answers at an address: family, layout, `visit`, `facts`; at which rate, `baud`.

    confirmed: it has told that layout itself. had_fault: it was in a fault when it was met.
    """

    confirmed = had_fault = False
    baud = None

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
        """Its last status word in the specification's bits, or None."""
        if not self.visit.words:
            return None
        told, says = self.visit.words[0], self.family.zsw_says
        if says is None:
            return told
        return functools.reduce(
            operator.or_, [meant for mask, value, meant in says if told & mask == value], 0
        )

    @property
    def runs(self):
        return self.zsw is not None and self.zsw & pzd.ZSW_RUNNING != 0

    @property
    def has_fault(self):
        return self.zsw is not None and self.zsw & pzd.ZSW_FAULT != 0


class Line:
    """settings: `Settings`. chosen: options of the command line: `standing`, all motors stand;
    `stay`, whether to stay with drives that trip when they hear no more (`leaving`); `watch`, as
    of `SerialLink`. watch: instead of that.

    nodes: {(baud, address): node} of those that were asked. is_taken: another master was heard.
    stays: as `stay`; None: only with motors that run.
    """

    def __init__(self, screen, settings, chosen, watch=None):
        if not settings.port:
            raise Failure("which port? --port /dev/ttyUSB0, or USS_PORT, or port in uss.toml")
        self.screen = screen
        self.settings = settings
        self.standing = chosen.standing
        self.word = 0  # commands nothing
        self.nodes = {}
        self.is_taken = False
        self._chosen = chosen
        self._stands = set()  # addresses of which somebody has said so
        self._watch = watch or chosen.watch
        self._heard = 0
        self._listening = False
        self._late = 0  # characters of a reply that may come so late
        self.baud = settings.baud
        self.link = SerialLink(settings.port, self.baud, watch=self._see)
        self.mask = self.link.clock.ticks_mask
        self.bus = Master(self.link, self.baud, settings.reply_timeout_ms)
        self._buses = {self.baud: self.bus}

    def __enter__(self):
        return self

    def __exit__(self, kind, *_):
        try:
            if kind is None or issubclass(kind, (Failure, KeyboardInterrupt)):
                leave(self)
        finally:
            self.close()

    @property
    def commands(self):
        """Whether this is the master of its drives: `command`."""
        return self.word != 0

    @property
    def stays(self):
        return self._chosen.stay  # whoever ends this program from outside changes it

    def close(self):
        self.bus.close()

    def at(self, baud):
        """Go on at another rate. PortError."""
        if baud == self.baud:
            return
        self.link.change_baud(baud)
        self.link.bus = None
        if baud in self._buses:
            self.bus = self.link.bus = self._buses[baud]
        else:
            self.bus = Master(self.link, baud, self.settings.reply_timeout_ms)
            self._buses[baud] = self.bus
        self.baud = baud

    def _see(self, is_sent, characters, at_us):
        if not is_sent and self._listening:
            self._heard += len(characters)
        if self._watch is not None:
            self._watch(is_sent, characters, at_us)

    def listen(self, seconds=LISTEN_S):
        """Failure: somebody talks, so another master is there."""
        heard = self._hear(seconds)
        if heard:
            self.is_taken = True
            raise Failure(
                "another master talks on this line (%d characters in %.1f s): pause it, or look "
                "with sniff; nothing was sent" % (heard, seconds)
            )

    def rest(self, seconds, until=None):
        """Send nothing for so long, or until `until()`. Failure: another master has begun."""
        if self._hear(seconds, until) >= PIECE + self._late:
            self._give_up()

    def _hear(self, seconds, until=None):
        """How many characters come meanwhile."""
        self._listening, self._heard = True, 0
        try:
            self.bus.wait(seconds, until)
        finally:
            self._listening = False
        self.check_cut()
        return self._heard

    def check_cut(self):
        """Failure: the line is cut."""
        if self.link.is_cut:
            raise Failure(self.link.notices[-1])

    def exchange(self, question):
        """Send it and wait for its end; whether it was answered. Failure: the line is not ours, or
        the drive may not be asked."""
        if not isinstance(question, Mirror):
            self.permit(question.address)
        self.bus.post(question)
        self.bus.wait(EXCHANGE_S, lambda: question.state != PENDING or self._is_lost())
        self.check_cut()
        if question.state == PENDING or self.bus.foreign:
            self._give_up()
        self._late = 0 if question.state == DONE else len(question.request)
        return question.state == DONE

    def _give_up(self):
        self.is_taken = True
        raise Failure(OTHERS_BEGAN)

    def _is_lost(self):
        return self.link.is_cut or self.bus.foreign > 0

    # --- who may be asked -----------------------------------------------------------------------

    def may_ask(self, address):
        """Whether nothing can happen to its motor if it gets a control word with bit 10 = 0."""
        told = self.settings.kind(address)
        return self.standing or address in self._stands or told and told[0].takes_no_control

    def permit(self, address):
        """Failure: it may not be asked, and nobody at the terminal says that its motor stands."""
        if self.may_ask(address):
            return
        if not self.screen.confirms(DOES_IT_STAND % address):
            raise Failure((G120_RUNS if self.settings.kind(address) else WHAT_IS_IT) % address)
        self._stands.add(address)

    def permit_all(self, addresses):
        """Ask whoever is at the terminal about all of them; whether they may be asked."""
        may_ask = all(self.may_ask(address) for address in addresses)
        self.standing = self.standing or not may_ask and self.screen.confirms(DO_THEY_STAND)
        return may_ask or self.standing

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
        """The `Node` there: its family as the user says or as it tells, its layout as it tells.
        Failure."""
        self.permit(address)
        told = self.settings.kind(address)
        lengths = ()
        if told and self.settings.says_layout(address):
            family, layout = told
            if self.commands:
                return Node(address, family, layout, self.mask)  # STOP does not wait for questions
            lengths = (layout.net_count,)
        net_count, other = self.probe(address, lengths or NET_COUNTS)
        if net_count is None:
            raise self.no_reply(address, other)
        return self.enquire(address, net_count, other, told)

    def enquire(self, address, net_count, variable, told):
        """Ask a node what it is, with telegrams whose control word is `word`. told: what the user
        says, (family, layout), or None. Failure: it is not that."""
        enquirer = Enquirer(address, net_count, variable, everything=told is None)
        while True:
            question = enquirer.question(self.word)
            self.exchange(question)
            if enquirer.take(question):
                break
        found = enquirer.node
        if told:
            self._take_the_word(found, *told)
        node = Node(address, found.family, found.layout, self.mask, found.off_time_ms)
        node.visit.words = (found.zsw,) if found.zsw else ()
        node.confirmed = found.confirmed
        node.had_fault = node.has_fault
        node.baud = self.baud
        self.nodes[self.baud, address] = node
        return node

    def _take_the_word(self, found, family, layout):
        """Make of a node what the user says that it is. Failure: it cannot be.

        A layout that is not the drive's would have it take part of a parameter task for a control
        word.
        """
        words = "%d+%d" % (found.layout.pkw_words, found.layout.pzd_words)
        if self.settings.says_layout(found.address) and not found.layout.is_like(layout):
            if found.confirmed or not found.layout.pkw_words:
                said = "%d+%d" % (layout.pkw_words, layout.pzd_words)
                raise Failure(OTHER_LAYOUT % (found.address, words, said))
            found.layout = layout
        if not found.layout.suits(family):
            raise Failure(NO_SUCH_DRIVE % (found.address, words, family.name))
        found.family = family

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

    def left(self, drive):
        """The node that it is, commanded no more, unless it may run."""
        node = Node(drive.address, drive.family, drive.layout, self.mask)
        node.baud = self.baud
        try:
            self.bus.remove(drive)
        except ValueError:
            pass
        return node


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
