# SPDX-License-Identifier: MIT
"""Asks a node that was found for its layout, its family and when it trips. For `scan`.

The length of a node's telegrams may have several meanings: 12 net characters are 4 + 2 words,
3 + 3, or 0 + 6. So the enquiry asks for the parameters that hold the layout, in each of these
forms, until the drive confirms one. Which other parameters the drive has tells its family. Each
question is an ordinary telegram with OFF1, so that it stops a motor that somebody left running. In
a wrong form, bit 10 is 0 where the drive looks for its control word, so the drive obeys nothing.

    node = Node(12, False)
    questions = enquiry(node)           # a generator: yields (layout, number), is sent the value
    layout, number = next(questions)
    layout, number = questions.send(4)  # ... until StopIteration
    node.family, node.layout, node.off_time_ms
"""

from uss import pkw, pzd
from uss.families import G110, G120, GENERIC, MM3, MM4, MM440, V20, can_be_set_to
from uss.layout import PZD_WORDS_MAX, VARIABLE, Layout
from uss.outside import DONE, TIMED_OUT, OutsideTelegram
from uss.telegram import GOOD, NET, put_word

FRAME = 4  # characters of a telegram that are not net data
NO_CHANNEL = -1  # instead of a value: the reply has no parameter channel in that place

# In the order of trying: the family; a family whose parameters tell the layout and the
# telegram-off time; a parameter that this family has and those further down lack, or None.
SIGNS = (
    (MM4, MM4, 2009),
    (MM440, MM4, 2009),  # with more PZD words
    (V20, MM4, 2023),
    (G110, MM4, None),
    (G120, G120, None),
    (MM3, MM3, 93),
    (GENERIC, MM4, None),  # with even more
)

# PZD words of a drive with variable length, the most usual first.
USUAL_PZD_WORDS = (2, 4, 8, 1, 3, 5, 6, 7, 0, 16, 12, 10, 9, 11, 13, 14, 15)


class Node:
    """What answers at an address. net_count: the net characters that it takes. variable: it takes
    any number.

    layout, family: as `bus.add` takes them. off_time_ms: the node trips after so long without a
    telegram; 0: never, None: it does not tell. If the drive confirms no layout, `layout` is the
    most usual one of its length and `family` is GENERIC.
    """

    def __init__(self, net_count, variable):
        self.net_count = net_count
        self.variable = variable
        self.layout = layouts(net_count, variable)[0]
        self.family = GENERIC
        self.off_time_ms = None

    def __repr__(self):
        return "<%s %r>" % (self.family.name, self.layout)


def layouts(net_count, variable):
    """A list of the layouts that this length may mean, the most usual first."""
    if variable:
        return [Layout(VARIABLE, pzd_words) for pzd_words in USUAL_PZD_WORDS]
    words = net_count // 2
    pkw_words = [count for count in (4, 3, 0) if 0 <= words - count <= PZD_WORDS_MAX]
    return [Layout(count, words - count) for count in pkw_words] or [Layout(VARIABLE, 2)]


def enquiry(node):
    """A generator of (layout, number) to read; number None: a telegram without a task. Send it the
    value, None if there is none, or NO_CHANNEL. At its end the fields of `node` hold what is
    known.
    """
    usual = None
    for layout in layouts(node.net_count, node.variable):
        if not layout.pkw_words:
            usual = usual or layout
            break
        known = {}  # number -> value
        for family, link, sign in SIGNS:
            if not can_be_set_to(family, layout):
                continue
            rows = (
                (link.pkw_words_number, layout.pkw_words),
                (link.pzd_words_number, layout.pzd_words),
                (sign, None),
            )
            for number, wanted in rows:
                if number is None:
                    continue
                if number not in known:
                    known[number] = yield layout, number
                value = known[number]
                if value in (None, NO_CHANNEL) or wanted not in (None, value):
                    break
            else:
                node.layout = layout
                node.family = family
                off_time = yield layout, link.off_time_number
                if off_time is not None:
                    node.off_time_ms = off_time * link.off_time_unit_ms
                return
        if NO_CHANNEL not in known.values():
            usual = usual or layout
    node.layout = usual or node.layout
    yield node.layout, None


class Question(OutsideTelegram):
    """An ordinary telegram to a node outside the list, with OFF1 and a parameter to read, or None.

    DONE: the node has answered; `job` holds the answer, or the refusal. TIMED_OUT: the node was
    silent, or, if `finding` is GOOD, its answer belongs to an older question.
    """

    def __init__(self, address, layout, number):
        self.job = None if number is None else pkw.read(number)
        self._layout = layout
        self._speaks = True  # the reply may be that of a parameter channel
        self._form = layout.pkw_words * 2
        if layout.variable:
            self._form = pkw.VARIABLE_LENGTH | 2 * layout.longest
        net = bytearray(layout.net_count)
        if self.job is not None:
            net[:FRAME] = self.job.words[:FRAME]  # PKE and IND; the others are 0
        if layout.pzd_words:
            put_word(net, layout.net_count - layout.pzd_count, pzd.OFF1)
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
        if job is None or job.answer(buffer, NET, pkw_count, self._form):
            self.state = DONE
        else:
            self._speaks = buffer[NET] == buffer[NET + 1] == 0  # AK 0: no reply yet
            self.state = TIMED_OUT
