# SPDX-License-Identifier: MIT
"""What the tests of `uss.bus` share: a virtual board, drives on its line, and a bus with them.

    bench = Bench()                         # one drive, address 1; its ramps take a second
    bench.drive.run(10.0)
    bench.motor().report()                  # the simulated drive behind it
    refusal(NotStarted, bench.drive.run, 10.0)

`bench.drives` are the simulated drives by address, `bench.bus.drives` those of the bus.
"""

from hal.pacer import Pacer
from tools.examples.simulation import Stage
from uss.bus import Master
from uss.families import MM420

QUICK = {2014: 2_000, 1120: 1.0, 1121: 1.0}  # supervised; ramps of a second from 0 to 50 Hz
IDLE_US = 900  # what a program does besides while it waits: ten times as fast to simulate as 0


class Bench(Stage):
    """paced: the bus works by interrupts and a `Pacer`. layout, scale, unsupervised: as of
    Master.add. The others are those of Stage."""

    def __init__(
        self,
        addresses=(1,),
        family=MM420,
        paced=False,
        layout=None,
        scale=None,
        unsupervised=False,
        **options,
    ):
        options.setdefault("parameters", QUICK)
        Stage.__init__(self, addresses, **options)
        self.link = self.board.make_link(self.wire.baud)
        self.bus = Master(self.link, baud=self.wire.baud, idle=self._idle)
        if paced:
            self.bus.pace(Pacer, self.board.timer)
        for address in addresses:
            self.bus.add(address, family, layout, scale, unsupervised)

    @property
    def drive(self):
        return self.bus.drives[0]

    def motor(self, address=1):
        """The simulated drive."""
        return self.drives[address]

    def stws(self, address, since_us=0):
        """The control words that were sent to it, of telegrams with two PZD words."""
        return [
            characters[-5] << 8 | characters[-4]
            for at_us, from_panel, characters in self.wire.log.last(1000)
            if from_panel and characters[2] == address and at_us >= since_us
        ]

    def end(self):
        """Close the bus; no rule of the line was broken, no interrupt failed."""
        self.bus.close()
        self.check()

    def _idle(self):
        self.clock.advance(IDLE_US)


def refusal(expected, action, *arguments, **options):
    """The text of the exception that an action ends with; AssertionError when it does not."""
    try:
        action(*arguments, **options)
    except expected as exception:
        return str(exception)
    raise AssertionError("%s was not raised" % expected.__name__)
