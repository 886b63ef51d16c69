# SPDX-License-Identifier: MIT
"""Ordinary telegrams to a drive that command nothing: bit 10 of their control word is 0.

A drive leaves the process data of such a telegram aside (specification C-5.2.1, "control by PLC"),
so that what its own master has told it last stays in force. Its parameter channel works as ever.
One family differs: a SINAMICS G120 that runs trips when bit 10 drops.
"""

from uss import telegram
from uss.channel import Channel
from uss.outside import DONE, OutsideTelegram
from uss.telegram import NET, get_word


class Visit(OutsideTelegram):
    """layout: of the drive. words: the PZD words of its last reply. good, bad: replies, misses."""

    def __init__(self, address, layout, mask):
        OutsideTelegram.__init__(self, address, bytes(layout.net_max))
        self.layout = layout
        self.channel = Channel(mask, layout.pkw_words, layout.longest)
        self.words = ()
        self.good = self.bad = 0
        self.in_a_row = 0  # misses
        self.heard = bytearray()  # the last reply

    def fill(self, now):
        count = self.channel.fill(self.request, NET, now) if self.layout.pkw_words else 0
        end = NET + count + self.layout.pzd_count
        self.request[NET + count : end] = bytes(self.layout.pzd_count)
        self.size = telegram.seal(self.request, self.address, count + self.layout.pzd_count)
        self.sealed = True

    def fits(self, net_count):
        return self.layout.fits(net_count)

    def may_reply_alike(self):
        return not self.layout.pzd_words

    def take(self, buffer, count, now):
        at = count - 1 - self.layout.pzd_count
        self.words = tuple(get_word(buffer, place) for place in range(at, count - 1, 2))
        if self.layout.pkw_words:
            self.channel.take(buffer, NET, at - NET)
        self.good += 1
        self.in_a_row = 0
        self.finding = telegram.GOOD
        self.state = DONE

    def miss(self, finding, now, lost_us, mask):
        OutsideTelegram.miss(self, finding, now, lost_us, mask)
        self.bad += 1
        self.in_a_row += 1
        if self.layout.pkw_words:
            self.channel.miss(now, self.in_a_row)
