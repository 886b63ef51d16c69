"""One seed of the soak: its world, a hand, a judge and an eye, for so many minutes.

    result = soak(7, 3)             # raises nothing; result.broken is None when all went well
"""

import main
from tools.soaking.hand import Hand
from tools.soaking.judge import Judge
from tools.soaking.reader import Reader
from tools.soaking.weather import Weather
from tools.soaking.worlds import Plan, SoakWorld

TOLD_S = 30  # of virtual time between two calls of `progress`


class Result:
    """seed, plan; broken: the exception that ended it, or None; and who took part."""

    def __init__(self, seed):
        self.seed = seed
        self.plan = None
        self.broken = None
        self.world = self.judge = self.reader = self.weather = self.hand = None

    def seconds(self):
        return self.world.clock.now_us // 1_000_000 if self.world else 0

    def exchanges(self):
        return self.judge.exchanges if self.judge else 0

    def faults(self):
        """How many of each kind: what failed beside the line, and on it."""
        found = dict(self.hand.faults) if self.hand else {}
        if self.hand:
            for kind, count in self.weather.count().items():
                if count:
                    found[kind] = count
        return found


def soak(seed, minutes, drives=None, progress=None):
    """drives: how many, None: as the seed has it. progress: called with the seconds so far."""
    result = Result(seed)
    try:
        result.plan = plan = Plan(seed, drives)
        result.world = world = SoakWorld(main.start, plan)
        result.judge = judge = Judge(world, plan)
        result.reader = reader = Reader(world, plan, judge)
        result.weather = judge.weather = weather = Weather(world, plan)
        result.hand = hand = Hand(world, plan, judge, reader, weather)
        seconds = int(minutes * 60)
        for until_s in range(TOLD_S, seconds, TOLD_S):
            hand.live(until_s)
            if progress is not None:
                progress(until_s)
        hand.live(seconds)
    except Exception as broken:
        result.broken = broken
    return result
