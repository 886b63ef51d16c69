# SPDX-License-Identifier: MIT
"""Every address, 0...31: whether somebody answers there. SET takes that drive into the list.

The address that is shown is sent mirror telegrams in the lengths of all layouts, in the share of
the line's time that silent drives have. No drive acts on them (specification A-5.3). SET has the
drive asked what it is, which goes with OFF1: `enquiry`.
"""

from micropython import const

import on_demand
from panel import texts
from panel.menu import Entries, words
from uss.finding.mirror import Mirror
from uss.pkw import DONE, PENDING
from uss.telegram import NODE_MAX

# Net characters of all fixed layouts that a family has with 2...8 PZD words, the usual ones first.
# Who takes any length answers the first.
_LENGTHS = (10, 12, 4, 16, 14, 8, 6, 18, 20, 22, 24)
_NET_MAX = const(24 + 2)
_SILENCES = const(2)  # after which a drive takes one length only: one may have been lost


class List(Entries):
    title = words.ANY_ADDRESS

    _address = -1  # that is looked at: the first step begins with the one shown
    _sent = False
    _row = 0  # of _LENGTHS; it goes round and round until somebody answers
    _is_nobody = False  # it has been round once
    _net_count = 0  # of what came back
    _silences = 0
    _is_wanted = False  # SET was pressed
    _enquirer = None  # then it is asked what it is

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        self._mirror = Mirror(0, bytes(_NET_MAX))
        self._telegram = self._mirror  # the one that is under way, or was

    def _begin(self, address):
        """Look for a drive at another address."""
        self._address = address
        self._row = self._net_count = self._silences = 0
        self._is_nobody = self._is_wanted = False
        self._enquirer = None

    def first(self):
        return self.panel.selected.drive.address

    def count(self):
        return NODE_MAX + 1

    def words(self, position):
        what = words.ASKS
        if self._is_listed(position):
            what = words.IN_THE_LIST
        elif position == self._address and not self._is_wanted:
            if self._net_count:
                what = words.ANSWERS
            elif self._is_nobody:
                what = words.NOBODY
        return b"A%-2d %s" % (position, texts.of(what))

    def control_at(self, position):
        return self.control_of(position)

    def step(self, position, now_ms):
        """Ask the address that is shown."""
        if self._telegram.state == PENDING:
            return
        if position != self._address:
            self._begin(position)
        elif self._sent and self._take():
            self._add(now_ms)
            return
        self._sent = False
        bus = self.panel.bus
        if self._is_listed(position) or self._net_count and not self._is_wanted:
            return
        if not bus.turns.has_command() and not bus.deadlines.silence_wait_us():
            self._telegram = self._next()
            bus.turns.post(self._telegram)
            self._sent = True

    def choose(self, position, now_ms):
        if position == self._address and self._net_count and not self._is_listed(position):
            self._is_wanted = True

    def _next(self):
        """The next telegram."""
        if self._enquirer is not None:
            return self._enquirer.question()
        net_count = self._net_count + 2 if self._net_count else _LENGTHS[self._row]
        self._mirror.aim(self._address, net_count)
        return self._mirror

    def _take(self):
        """A telegram is over. Whether the drive has told everything."""
        telegram = self._telegram
        if self._enquirer is not None:
            return self._enquirer.take(telegram)
        is_answered = telegram.state == DONE
        if self._net_count:
            self._silences += 1
            if is_answered or self._silences >= _SILENCES:
                node = self._address, self._net_count, is_answered
                self._enquirer = on_demand.call("uss.finding.enquiry", "Enquirer", *node)
        elif is_answered:
            self._net_count = _LENGTHS[self._row]
        else:
            self._row = (self._row + 1) % len(_LENGTHS)
            self._is_nobody = self._is_nobody or not self._row
        return False

    def _add(self, now_ms):
        """Take it into the list as what it is."""
        panel, node = self.panel, self._enquirer.node
        panel.close_menu()
        try:
            kind = on_demand.call("uss.families.kinds", "text", node.family, node.layout)
            panel.add(self._address, kind)
            panel.say(now_ms, words.ADDED, self._address)
        except ValueError:  # 31 are there, or it has no PZD words to be commanded by
            panel.say(now_ms, words.NOT_ADDED, self._address)

    def _is_listed(self, address):
        return self.panel.bus.turns.at(address) is not None
