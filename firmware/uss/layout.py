# SPDX-License-Identifier: MIT
"""How the net data of a drive's telegrams are divided: PKW words, then PZD words.

    PKW  0, 3 or 4 words, or VARIABLE: as many as a task or its reply needs, 3 at the least; or
         none, where both sides may leave them out while there is no task
    PZD  0...16 words, the same number both ways

Both are agreed with each drive before the bus starts and may differ from drive to drive
(specification A-4.2.2, C-3.1, C-7): P2013 and P2012 of a MICROMASTER 4. With a fixed length
request and reply are equally long. Together they are 126 words at the most.

    Layout(4, 2)                # STANDARD
    Layout(VARIABLE, 4)         # P2013 = 127, P2012 = 4
    Layout(VARIABLE, 2, short=True)     # without a task STW and HSW alone
"""

from micropython import const

VARIABLE = const(127)
PKW_WORDS = (0, 3, 4, VARIABLE)
PZD_WORDS_MAX = const(16)
WORDS_MAX = const(126)
_LEAST_PKW_WORDS = const(3)  # every task and reply has PKE, IND and one word of PWE
_TEXT_PKW_WORDS = const(10)  # PKE, IND and a text of 16 characters
ENABLE_WORDS = const(4)  # the PKW area of a broadcast holds the enable array (appendix)


class Layout:
    """pkw_words: 0, 3, 4 or VARIABLE. pzd_words: 0...16.

    longest: with VARIABLE, the most PKW words of a request, 3...126; the drive's request buffer
    has room for them. The drive's answer may have any length.

    short: with VARIABLE, a request without a task has no PKW words. An exchange takes half of the
    time. No document promises that a drive takes such requests: try it.

    ValueError if there is no such layout, or it has no words.

    net_count: net characters of a request without a task. pzd_count: characters of the PZD.
    net_max: net characters of the longest request.
    """

    def __init__(self, pkw_words=4, pzd_words=2, longest=_TEXT_PKW_WORDS, short=False):
        if pkw_words not in PKW_WORDS:
            raise ValueError("PKW of %r words is none of %s" % (pkw_words, PKW_WORDS))
        if pzd_words not in range(PZD_WORDS_MAX + 1):
            raise ValueError("PZD of %r words is not 0...%d" % (pzd_words, PZD_WORDS_MAX))
        if pkw_words + pzd_words == 0:
            raise ValueError("a telegram of 0 PKW and 0 PZD words says nothing")
        self.pkw_words = pkw_words
        self.pzd_words = pzd_words
        self.variable = pkw_words == VARIABLE
        self.short = short
        if short and not (self.variable and pzd_words):
            raise ValueError("only PKW words of variable length beside PZD words are left out")
        idle_words = 0 if short else _LEAST_PKW_WORDS if self.variable else pkw_words
        self.longest = longest if self.variable else pkw_words
        if self.variable and not _LEAST_PKW_WORDS <= longest <= WORDS_MAX - pzd_words:
            raise ValueError("%r PKW words and %d PZD words" % (longest, pzd_words))
        self.pzd_count = 2 * pzd_words
        self.net_count = 2 * (idle_words + pzd_words)
        self.net_max = 2 * (self.longest + pzd_words)

    def fits(self, net_count):
        """Whether a reply may have so many net characters."""
        if not self.variable:
            return net_count == self.net_count
        if net_count == self.net_count:
            return True
        return net_count & 1 == 0 and net_count >= self.pzd_count + 2 * _LEAST_PKW_WORDS

    def is_like(self, other):
        """Whether drives with the two layouts take the same telegrams."""
        return (
            self.pkw_words == other.pkw_words
            and self.pzd_words == other.pzd_words
            and self.short == other.short
        )

    def suits(self, family):
        """Whether drives of the family can have such telegrams."""
        return self.pkw_words in family.pkw_choices and self.pzd_words in family.pzd_choices

    def takes_broadcast(self):
        """Whether the enable array of a broadcast fits: it needs a PKW area of four words."""
        return self.pkw_words == ENABLE_WORDS and self.pzd_words > 0

    def __repr__(self):
        short = ", short=True" if self.short else ""
        return "Layout(%d, %d%s)" % (self.pkw_words, self.pzd_words, short)


STANDARD = Layout(4, 2)
