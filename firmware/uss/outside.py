# SPDX-License-Identifier: MIT
"""Telegrams outside the circulating list: mirror, broadcast, special (specification A-4.3, A-5.3).

You build one and hand it to `Turns.post`, and the bus sends it as soon as there is room. Its state
tells what became of it: NEW, PENDING, DONE or TIMED_OUT, as of a parameter job. None of them
starts a motor: no drive acts on a mirror telegram, `Broadcast` refuses a start bit, and special
telegrams mean nothing to a drive.

    probe = outside.Mirror(5)
    bus.turns.post(probe)               # ... later:
    probe.state == outside.DONE         # node 5 is there

    outside.stop_all(bus)               # OFF1 to all at once, where all of them take broadcasts
"""

from micropython import const

from uss import pzd, telegram
from uss.layout import ENABLE_WORDS, PZD_WORDS_MAX
from uss.finding.mirror import Mirror, OutsideTelegram
from uss.pkw import DONE, NEW, PENDING, TIMED_OUT
from uss.telegram import BROADCAST, NET, NODE_MAX, SPECIAL

__all__ = ("DONE", "NEW", "PENDING", "TIMED_OUT", "Mirror", "Broadcast", "Special", "stop_all")

STW_CONTROL = const(0x0400)
OFTEN = const(0xFFFF)  # `silent` of a telegram without a reply, so that it is not repeated

# The enable array of a broadcast (appendix): its words a, b, c and d stand in place of the PKW
# words.
ENABLE_FLAG = const(0x0001)  # in a: this is a broadcast; bit i: PZD i may be taken over
UNMASKED = const(0xFFFF)
ENABLED_PLACES = const(15)  # PZD 16 is never taken over


class Broadcast(OutsideTelegram):
    """Process data for all drives of one layout at the same time (A-3, C-5.2.3 and appendix).

    words: 1...16 PZD words, STW first; every drive must have so many, and 4 PKW words. takes: what
    the drives take over of them, {place: mask}, place 1...15; of PZD 1, 4 and 5 bit by bit, of the
    others only UNMASKED. They keep all their other words and bits. No drive answers: DONE says
    that the telegram was sent and that the line was left alone for the response delay after it.
    ValueError if it would start motors or take control away, or if it cannot be sent so.
    """

    def __init__(self, words, takes):
        if not 1 <= len(words) <= PZD_WORDS_MAX:
            raise ValueError("%d PZD words" % len(words))
        enable = ENABLE_FLAG
        for place, mask in takes.items():
            if not 1 <= place <= min(len(words), ENABLED_PLACES):
                raise ValueError("PZD%r is not taken from a broadcast" % (place,))
            if place not in (1, 4, 5) and mask != UNMASKED:
                raise ValueError("PZD%d is taken as a whole" % place)
            enable |= 1 << place
        taken = takes.get(1, 0)
        if taken & words[0] & pzd.STW_RUN:
            raise ValueError("a broadcast starts no motors: STW %04Xh" % words[0])
        if not words[0] & STW_CONTROL:
            raise ValueError("STW %04Xh gives up control" % words[0])
        net = bytearray(2 * (ENABLE_WORDS + len(words)))
        telegram.put_word(net, 0, enable)
        for index in range(3):
            telegram.put_word(net, 2 + 2 * index, takes.get((1, 4, 5)[index], 0))
        for index in range(len(words)):
            telegram.put_word(net, 2 * (ENABLE_WORDS + index), words[index])
        OutsideTelegram.__init__(self, BROADCAST, net)

    def fits(self, net_count):
        """Never: no drive answers."""
        return False

    def may_reply_alike(self):
        """Never: what comes is not a reply, but may be an echo."""
        return False

    def miss(self, finding, now, lost_us, mask):
        self.silent = OFTEN
        self.state = DONE


class Special(OutsideTelegram):
    """Net data of a kind of its own, for a node that knows them (A-5.3.1).

    node: 0...31, or None for all nodes of that kind, which then do not answer. net: 1...252
    characters. reply_count: net characters of the reply, None for any number. hook(net, count):
    the engine calls it, if given, with the reply's net data in the first `count` characters of
    `net`; it must not allocate. Once DONE, `reply_count` says how many characters of `reply` came.
    """

    def __init__(self, node, net, reply_count=None, hook=None):
        if node is not None and not 0 <= node <= NODE_MAX:
            raise ValueError("node %r is not 0...31" % (node,))
        OutsideTelegram.__init__(self, SPECIAL | (BROADCAST if node is None else node), net)
        self.reply = bytearray(telegram.NET_COUNT_MAX)
        self.reply_count = 0
        self._awaited_count = reply_count
        self._to_all = node is None
        self._hook = hook

    def fits(self, net_count):
        """Whether a reply may have so many net characters."""
        if self._to_all:
            return False
        if self._awaited_count is None:
            return net_count <= telegram.NET_COUNT_MAX
        return net_count == self._awaited_count

    def take(self, buffer, count, now):
        net_count = count - 4
        if not self.fits(net_count):
            self.miss(telegram.BAD_LENGTH, now, 0, 0)
            return
        for index in range(net_count):
            self.reply[index] = buffer[NET + index]
        self.reply_count = net_count
        if self._hook:
            self._hook(self.reply, net_count)
        self.state = DONE

    def miss(self, finding, now, lost_us, mask):
        OutsideTelegram.miss(self, finding, now, lost_us, mask)
        if self._to_all:
            self.silent = OFTEN
            self.state = DONE


def stop_all(bus):
    """Send OFF1 to every drive in a single telegram ahead of all others, then to each one its own.

    For drives that take broadcasts, which few document. ValueError unless all have 4 PKW words and
    the same PZD words; each drive is sent its own OFF1 even then.
    """
    bus.stop_all()
    layouts = [drive.layout for drive in bus.turns.drives]
    for layout in layouts:
        if not layout.takes_broadcast() or layout.pzd_words != layouts[0].pzd_words:
            raise ValueError("%r beside %r: no common broadcast" % (layout, layouts[0]))
    if layouts:
        words = [pzd.OFF1] + [0] * (layouts[0].pzd_words - 1)
        broadcast = Broadcast(words, {1: pzd.STW_RUN})
        broadcast.ahead = True
        try:
            bus.turns.post(broadcast)
        except RuntimeError:
            pass  # such a broadcast already waits to be sent
