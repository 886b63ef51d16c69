# SPDX-License-Identifier: MIT
"""One seed of the soak: its world, a hand, a judge and an eye.

In use:

    soak = Soak(7)
    soak.run(180)                   # seconds of virtual time; raises nothing
    soak.broken                     # None, or what ended it
"""

import sys

# Lower layers first, or the 32-bit build runs out of stack.
import boards.sim.drives.families.mm420
import boards.sim.drives.parameter_channel
import boards.sim.drives.parameters
import boards.sim.world  # noqa: F401
import main
import on_demand
import tools.soaking.technician  # noqa: F401
import tools.soaking.worlds  # noqa: F401
import uss.drive
from tools.soaking.fingers import TimeIsUp
from tools.soaking.hand import Hand
from tools.soaking.judging.judge import Judge
from tools.soaking.judging.reader import Reader
from tools.soaking.judging.rules import Broken
from tools.soaking.weather import Weather
from tools.soaking.withdrawn import Withdrawn
from tools.soaking.worlds import Plan, SoakWorld

LOADED_FIRST = tuple(sys.modules)
# Packages that are loaded on demand, or have such modules.
ON_DEMAND = ("catalogue", "panel", "search", "settings_file", "uss")

TOLD_S = 30  # of virtual time between two calls of `progress`


def unload():
    """Forget what the seed before this one has loaded on demand: to find a module there takes a
    panel other steps than to load it, and a seed is the same life behind whichever other one.
    """
    on_demand.keep()
    for name in tuple(sys.modules):
        if name not in LOADED_FIRST and name.partition(".")[0] in ON_DEMAND:
            on_demand.drop(name)


class Soak:
    """Fields: seed, plan, world, judge, reader, weather, hand.

    drives: how many; None: the seed decides. troubles, roams: see `Plan`. broken: the exception
    that ended it, or None.
    """

    def __init__(self, seed, drives=None, troubles=1, roams=True):
        self.seed = seed
        self.broken = None
        unload()
        self.plan = plan = Plan(seed, drives, troubles, roams)
        self.world = world = SoakWorld(main.start, plan)
        self.judge = judge = Judge(world, plan)
        Withdrawn(uss.drive.Drive, judge.tape, world.clock)
        self.reader = reader = Reader(world, plan, judge.witness)
        self.weather = judge.witness.weather = weather = Weather(world, plan)
        self.hand = Hand(world, plan, judge, reader, weather)

    def run(self, seconds, progress=None, abruptly=False):
        """Run until `seconds` are over in its world, and to the end of the hand's turn, or end
        abruptly. progress: called with the seconds so far.
        """
        if abruptly:
            self.hand.ends_us = seconds * 1_000_000
        try:
            for until_s in range(TOLD_S, seconds, TOLD_S):
                self.hand.live(until_s)
                if progress is not None:
                    progress(until_s)
            self.hand.live(seconds)
        except TimeIsUp:
            pass
        except Exception as broken:
            self.broken = broken

    def seconds(self):
        return self.world.clock.now_us // 1_000_000

    def digest(self):
        """A number for the whole run, the same on every interpreter."""
        reports = [drive.report() for drive in self.world.drives.values()]
        return self.world.digest.with_more(
            self.hand.deeds, sorted(self.faults().items()), reports,
            isinstance(self.broken, Broken) and self.broken.args,
        )  # fmt: skip

    def faults(self):
        """How many faults of each kind there were, on the line and elsewhere."""
        found = dict(self.hand.faults)
        for kind, count in self.weather.count().items():
            if count:
                found[kind] = count
        return found
