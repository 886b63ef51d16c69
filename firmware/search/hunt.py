# SPDX-License-Identifier: MIT
"""Looks for drives at one baud rate after the other: what was found, and how far it has come.

Only for a line on which no motor runs: a drive hears noise at any rate but its own, and one that
runs may trip for want of telegrams (rule 18 of the design). At each rate the bus listens before it
sends; another master ends the hunt.

    hunt = Hunt(board, (9600, 19200, 38400), 20)
    while not hunt.step(now_us): ...    # the pacer is tended in it
    hunt.found                          # [Found(...), ...]
    hunt.close()
"""

from micropython import const

from uss import pzd
from uss.leave import leave, persist
from uss.master import LISTEN_US, LISTENING, RESTING, Master
from uss.finding.scan import ADDRESSES, NET_COUNTS, Scan, longest_us
from uss.timing import Timing
from hal.pacer import Pacer

_MILLION = const(1_000_000)
_PERCENT = const(100)
_LOOP_US = const(1_000)


def seconds_for(rates, reply_timeout_us, done_percent=0):
    """How long these rates take if nobody answers. done_percent: so much of the first is done."""
    left_us = rate_us = 0
    for rate in reversed(rates):
        timing = Timing(rate, reply_timeout_us)
        rate_us = LISTEN_US + longest_us(timing, ADDRESSES, NET_COUNTS, _LOOP_US)
        left_us += rate_us
    return -(-(left_us - rate_us // _PERCENT * done_percent) // _MILLION)


class Found:
    """baud, address; family and layout as `enquiry` found them; state: one of `pzd`; off_time_ms:
    the drive trips after so long without a telegram, 0: never, None: it does not tell.
    """

    def __init__(self, baud, address, node):
        self.baud = baud
        self.address = address
        self.family = node.family
        self.layout = node.layout
        self.state = pzd.state(node.zsw)
        self.off_time_ms = node.off_time_ms


class Hunt:
    """board: of `hal`. rates: in the order of trying. reply_timeout_ms: as the settings have it.

    found: a list. baud: the rate that is tried. line_in_use: another master was heard, which has
    ended it. ends: it looks for no more. over: it has come to its end, or was ended.
    """

    def __init__(self, board, rates, reply_timeout_ms):
        self.found = []
        self.baud = rates[0]
        self.line_in_use = False
        self.ends = False
        self.over = False
        self._board = board
        self._rates = rates
        self._place = 0
        self._reply_timeout_us = reply_timeout_ms * 1000
        self._bus = None
        self._pacer = None
        self._scan = None
        self._foreign = 0  # heard before our first telegram

    def count(self):
        """How many drives have answered."""
        return len(self.found) + (len(self._scan.found) if self._scan else 0)

    def seconds_left(self):
        """How long it still takes if no further drive answers."""
        done = self._scan.progress(_PERCENT) if self._scan is not None else 0
        return seconds_for(self._rates[self._place :], self._reply_timeout_us, done)

    def step(self, now_us):
        """Do what is next, which never takes long; answer whether it is over."""
        if self.over:
            return True
        if self._bus is None:
            self._open(now_us)
            return False
        bus = self._bus
        bus.refresh(now_us)
        self._pacer.tend()
        if not self._scan.asked:
            self._foreign = bus.foreign
        if bus.is_line_in_use() or bus.foreign != self._foreign:
            self.line_in_use = True
            self.end()
        elif bus.phase != LISTENING and self._scan.step(now_us):
            self._end_rate()
        elif bus.phase == RESTING:
            self._pacer.run()  # else an idle bus notices a telegram some milliseconds late
        return self.over

    def finish(self):
        """Look for no more. It is over as soon as each drive that was found has had its OFF1."""
        self.ends = True
        if self._scan is None or not self._scan.asked:
            self.end()
        else:
            self._scan.finish()

    def end(self):
        """End it at once: what was found so far stays."""
        if self._scan is not None:
            self._scan.end()
            self._keep()
        self.over = True
        self.close()

    def close(self):
        """Leave the line, when the telegram that is under way is over."""
        if self._pacer is not None:
            leave(self._bus, self._board.clock, self._go_on)
            persist(self._pacer.stop)
        self._bus = self._pacer = self._scan = None

    def _go_on(self):
        self._pacer.tend()
        self._board.watchdog.feed()
        self._board.idle()

    def _open(self, now_us):
        board = self._board
        self.baud = self._rates[self._place]
        link = board.make_link(self.baud)
        mask = board.clock.ticks_mask
        self._bus = bus = Master(link, Timing(self.baud, self._reply_timeout_us), mask)
        self._pacer = Pacer(bus, link, board.clock, board.timer)
        self._scan = Scan(bus, mask, ADDRESSES, NET_COUNTS)
        bus.refresh(now_us)
        self._pacer.start()

    def _end_rate(self):
        self._keep()
        self.close()
        self._place += 1
        self.over = self.ends or self._place == len(self._rates)

    def _keep(self):
        nodes = self._scan.nodes
        self.found += [Found(self.baud, address, nodes[address]) for address in sorted(nodes)]
