# SPDX-License-Identifier: MIT
"""Asks a node that was found for its layout, its family and when it trips. For `scan`.

The length of a node's telegrams may have several meanings: 12 net characters are 4 + 2 words,
3 + 3, or 0 + 6. So the enquiry asks for the parameters that hold the layout, in each of these
forms, until the drive confirms one. Which other parameters the drive has tells its family. Each
question is an ordinary telegram with OFF1, so that it stops a motor that somebody left running. In
a wrong form, bit 10 is 0 where the drive looks for its control word, so the drive obeys nothing.

    enquirer = Enquirer(3, 12, False)   # a node of address 3 that takes 12 net characters
    turns.post(enquirer.question())     # ... and when that is over:
    enquirer.take(question)             # True: that was the last one
    enquirer.node.family, enquirer.node.layout, enquirer.node.off_time_ms

A MICROMASTER 4 has these parameters twice, for its RS-485 terminals and for the BOP link. It is on
the one whose parameters tell the layout that it has, or else its address; if both do, P0700 says.
"""

from uss import families, pkw, pzd
from uss.families import GENERIC, can_be_set_to
from uss.layout import PZD_WORDS_MAX, VARIABLE, Layout
from uss.outside import DONE, TIMED_OUT, OutsideTelegram
from uss.receiver import SILENT
from uss.telegram import GOOD, NET, get_word, put_word

FRAME = 4  # characters of a telegram that are not net data
# Of PKE: replies have AK 0...8, and SP, which a status word has in bit 11, is 0 (A-4.3.3.1).
_AK_END, _SP = 0x9000, 0x08
NO_CHANNEL = -1  # instead of a value: the reply has no parameter channel in that place
TRIES = 6  # of one question: a drive's answers may lag
SILENCES = 2  # after so many silences to a question the drive has no answer to it

# In the order of trying: the family; a family whose parameters tell the layout and the
# telegram-off time; a parameter that this family has and those further down lack, or None. By
# name, because few of them must be loaded.
SIGNS = (
    ("MM4", "MM4", 2009),
    ("MM440", "MM4", 2009),  # with more PZD words
    ("V20", "MM4", 2023),
    ("G110", "MM4", None),
    ("G120", "G120", None),
    ("MM3", "MM3", 93),
    ("GENERIC", "MM4", None),  # with even more
)
_COMMAND_SOURCE, _BY_BOP_LINK = 700, 4

# PZD words of a drive with variable length, the most usual first.
USUAL_PZD_WORDS = (2, 4, 8, 1, 3, 5, 6, 7, 0, 16, 12, 10, 9, 11, 13, 14, 15)


class Node:
    """What answers at an address. net_count: the net characters that it takes. variable: it takes
    any number.

    layout, family: as `bus.add` takes them. off_time_ms: the node trips after so long without a
    telegram; 0: never, None: it does not tell. zsw: its status word in the last answer. confirmed:
    it has told that layout; if not, it is the most usual one of its length, and `family` is
    GENERIC.
    """

    def __init__(self, address, net_count, variable):
        self.address = address
        self.net_count = net_count
        self.variable = variable
        self.layout = layouts(net_count, variable)[0]
        self.family = GENERIC
        self.off_time_ms = None
        self.confirmed = False
        self.zsw = 0

    def __repr__(self):
        return "<%s %r>" % (self.family.name, self.layout)


class Enquirer:
    """Asks one node everything, or its layout alone. node: the `Node`, complete when `take` has
    said True."""

    def __init__(self, address, net_count, variable, everything=True):
        self.node = Node(address, net_count, variable)
        self._questions = enquiry(self.node, everything)
        self._place = next(self._questions)
        self._tries = self._silences = 0

    def question(self, off=pzd.OFF1):
        """The telegram to be sent next. off: the control word that the node is owed."""
        return Question(self.node.address, *self._place, off)

    def take(self, question):
        """A telegram is over. Whether it was the last one."""
        self._tries += 1
        if question.state != DONE:
            if question.finding == SILENT:
                self._silences += 1
            if self._silences < SILENCES and self._tries < TRIES:
                return False  # the question is sent once more
        self._tries = self._silences = 0
        self.node.zsw = question.zsw
        try:
            self._place = self._questions.send(question.value())
        except StopIteration:
            return True
        return False


def layouts(net_count, variable):
    """A list of the layouts that this length may mean, the most usual first."""
    if variable:
        return [Layout(VARIABLE, pzd_words) for pzd_words in USUAL_PZD_WORDS]
    words = net_count // 2
    pkw_words = [count for count in (4, 3, 0) if 0 <= words - count <= PZD_WORDS_MAX]
    return [Layout(count, words - count) for count in pkw_words] or [Layout(VARIABLE, 2)]


def enquiry(node, everything=True):
    """A generator of (layout, number, index) to read; number None: a telegram without a task. Send
    it the value, None if there is none, or NO_CHANNEL. At its end the fields of `node` hold what
    is known. everything: not only the layout.
    """
    usual = None
    for layout in layouts(node.net_count, node.variable):
        if not layout.pkw_words:
            usual = usual or layout
            break
        known = {}  # (number, index) -> value
        for name, told_by, sign in SIGNS:
            family, link = getattr(families, name), getattr(families, told_by)
            if not can_be_set_to(family, layout):
                continue
            if NO_CHANNEL in known.values():
                break
            links = []  # indices that it may be on
            for index in range(2 if family.has_bop_link else 1):
                if not (yield from _is_set_to(layout, known, link, index)):
                    continue
                if not everything:
                    node.layout = layout
                    node.confirmed = True
                    return
                links.append(index)
            if not links or sign and not (yield from _has(layout, known, sign)):
                continue
            index = links[0]
            if len(links) > 1:
                index = yield from _link(node.address, layout, known, link.address_number)
            node.layout = layout
            node.confirmed = True
            node.family = families.on_bop(family) if index else family
            off_time = yield layout, link.off_time_number, index
            if off_time not in (None, NO_CHANNEL):
                node.off_time_ms = off_time * link.off_time_unit_ms
            return
        if NO_CHANNEL not in known.values():
            usual = usual or layout
    node.layout = usual or node.layout
    yield node.layout, None, 0


def _ask(layout, known, number, index=0):
    """Read a parameter once."""
    place = number, index
    if place not in known:
        known[place] = yield layout, number, index
    return known[place]


def _has(layout, known, number):
    value = yield from _ask(layout, known, number)
    return value not in (None, NO_CHANNEL)


def _is_set_to(layout, known, link, index):
    """Whether the parameters of this link tell the layout, as far as there are such."""
    if index and known[link.pkw_words_number, 0] in (None, NO_CHANNEL):
        return False
    rows = (link.pkw_words_number, layout.pkw_words), (link.pzd_words_number, layout.pzd_words)
    for number, words in rows:
        if number is not None:
            value = yield from _ask(layout, known, number, index)
            if value != words:
                return False
    return True


def _link(address, layout, known, number):
    """The index of the link that it is on, of two that are set to the layout."""
    own = []
    for index in range(2):
        value = yield from _ask(layout, known, number, index)
        if value == address:
            own.append(index)
    if len(own) == 1:
        return own[0]
    source = yield from _ask(layout, known, _COMMAND_SOURCE)
    return 1 if source == _BY_BOP_LINK else 0


class Question(OutsideTelegram):
    """An ordinary telegram outside the list's turns, with an OFF and a parameter to read, or None.

    DONE: the node has answered; `job` holds the answer, or the refusal. TIMED_OUT: the node was
    silent, or, if `finding` is GOOD, its answer belongs to an older question.
    """

    def __init__(self, address, layout, number, index=0, off=pzd.OFF1):
        self.job = None if number is None else pkw.read(number, index)
        self.zsw = 0
        self._layout = layout
        self._speaks = True  # the reply may be that of a parameter channel
        self._form = layout.pkw_words * 2
        if layout.variable:
            self._form = pkw.VARIABLE_LENGTH | 2 * layout.longest
        net = bytearray(layout.net_count)
        if self.job is not None:
            net[:FRAME] = self.job.words[:FRAME]  # PKE and IND; the others are 0
        if layout.pzd_words:
            put_word(net, layout.net_count - layout.pzd_count, off)
        OutsideTelegram.__init__(self, address, net)

    def fits(self, net_count):
        """Whether a reply may have so many net characters."""
        return self._layout.fits(net_count)

    def may_reply_alike(self):
        """Whether the reply may be equal to the request."""
        return not self._layout.pzd_words

    def value(self):
        """The value that was read, None if there is none, or NO_CHANNEL."""
        job = self.job
        if job is not None and job.state == pkw.DONE:
            return job.integer_value()
        return None if self._speaks else NO_CHANNEL

    def take(self, buffer, count, now):
        self.finding = GOOD
        job = self.job
        pkw_count = count - FRAME - self._layout.pzd_count
        if self._layout.pzd_words:
            self.zsw = get_word(buffer, NET + pkw_count)
        if job is None or job.answer(buffer, NET, pkw_count, self._form):
            self.state = DONE
        else:
            # No reply yet, or one to somebody else's question: the list asks this drive as well.
            self._speaks = get_word(buffer, NET) < _AK_END and not buffer[NET] & _SP
            self.state = TIMED_OUT
