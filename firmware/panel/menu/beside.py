# SPDX-License-Identifier: MIT
"""Further drives at the rate of the panel, which goes on controlling its own meanwhile.

    STOPS FOUND  1/1        SET begins: whatever is found is told to stop, and asked what it is
    >SET=BEGIN

    SEARCH 41%   1/3        the first entry; the others are what was found. STOP is STOP, as
    >2 FOUND                everywhere, and ends the search as well

    A7 READY     2/3        address and state; family, PKW and PZD words. SET takes it
    >V20 127+2

    FOUND        1/3        SET takes all
    >TAKE ALL 2

While drives answer, it asks only in the share of the line's time that silent drives have: see
`uss.finding.scan`. Until the list is left, what was found is asked often enough not to trip.
"""

from micropython import const

import on_demand
from panel import texts
from panel.menu import Entries, words
from uss import pzd

# The scan wants microseconds, and only to tell how much time has passed: 1024 for a millisecond,
# in a period of a minute.
_MS_MASK = const(0xFFFF)
_US_PER_MS_SHIFT = const(10)
_MASK = const(0x3FFFFFF)
_PERCENT = const(100)


class List(Entries):
    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        self._scan = None

    def heading(self, position):
        if self._scan is None:
            return texts.of(words.STOPS_FOUND)
        nodes = self._nodes()
        if 0 < position <= len(nodes):
            address, node = nodes[position - 1]
            return b"A%d %s" % (address, texts.of(texts.FOUND_STATES[pzd.state(node.zsw)]))
        if self._scan.over:
            return texts.of(words.FOUND)
        return texts.of(words.SEARCH_PERCENT, self._scan.progress(_PERCENT))

    def count(self):
        return 1 + len(self._nodes())

    def words(self, position):
        nodes = self._nodes()
        if self._scan is None:
            return texts.of(words.SET_BEGIN)
        if 0 < position <= len(nodes):
            node = nodes[position - 1][1]
            family, layout = node.family.__name__.encode(), node.layout
            return b"%s %d+%d" % (family, layout.pkw_words, layout.pzd_words)
        if not self._scan.over:
            return texts.of(words.SO_MANY_FOUND, len(nodes))
        return texts.of(words.TAKE_ALL, len(nodes)) if nodes else texts.of(words.NOBODY)

    def step(self, position, now_ms):
        scan = self._scan
        if scan is None:
            return
        now_us = (now_ms & _MS_MASK) << _US_PER_MS_SHIFT
        if scan.over:
            scan.keep(now_us)
        else:
            scan.step(now_us)

    def is_busy(self):
        return self._scan is not None and not self._scan.over

    def choose(self, position, now_ms):
        nodes = self._nodes()
        if self._scan is None:
            self._begin(now_ms)
        elif 0 < position <= len(nodes):
            self._take(nodes[position - 1 : position], now_ms)
        elif self._scan.over and nodes:
            self._take(nodes, now_ms)
            self.panel.close_menu()

    def _begin(self, now_ms):
        try:
            scan = on_demand.load("uss.finding.scan")
            self._scan = scan.Scan(self.panel.bus, _MASK)
        except MemoryError:
            self.panel.say(now_ms, texts.NO_MEMORY)
        for name in ("scan", "enquiry"):
            on_demand.drop("uss.finding." + name)

    def _nodes(self):
        """(address, `enquiry.Node`) of each that was found and asked, and is not in the list."""
        if self._scan is None:
            return []
        nodes, turns = self._scan.asked_nodes(), self.panel.bus.turns
        return [one for one in nodes if turns.at(one[0]) is None]

    def _take(self, nodes, now_ms):
        """Into the list of the panel. The drive that is shown stays the same."""
        panel = self.panel
        shown = panel.selected
        for address, node in nodes:
            kind = on_demand.call("uss.families.kinds", "text", node.family, node.layout)
            try:
                panel.add(address, kind)
            except ValueError:  # there are 31
                panel.say(now_ms, words.NOT_ADDED, address)
                break
        else:
            if len(nodes) == 1:  # row 1 speaks of the next one already
                panel.say(now_ms, words.ADDED, nodes[0][0])
            else:
                panel.say(now_ms, words.ALL_ADDED, len(nodes))
        panel.show(shown)
