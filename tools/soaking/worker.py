# SPDX-License-Identifier: MIT
"""One process of a soak, on MicroPython: takes seeds from standard input, tells how they ended.
Behind a seed there may be minutes, or a count of bytes, for it alone. ABRUPTLY, 1: a life ends
with its minutes, and not with what the hand is about then.

    micropython tools/soaking/worker.py soak MINUTES [DRIVES TROUBLES ROAMS ABRUPTLY]
    micropython tools/soaking/worker.py fuzz BYTES

It answers lines of JSON: {"at": seconds} now and then, {"seed": ...} at the end of each.
"""

import gc
import json
import sys

from tools.soaking.fuzz import fuzz
from tools.soaking.judging.rules import Broken
from tools.soaking.soak import Soak
from tools.soaking.story import story

# By default MicroPython collects only when the heap is full, and searches long for its last holes.
COLLECT_AFTER = 2_000_000


def tell(**what):
    print(json.dumps(what))


def progress(seconds):
    tell(at=seconds)


def soak_seed(seed, minutes, drives="0", troubles="1", roams="1", abruptly="0"):
    soak = Soak(seed, int(drives) or None, int(troubles), roams != "0")
    soak.run(int(float(minutes) * 60), progress, abruptly != "0")
    broken, rule, told = soak.broken, None, []
    if broken is not None:
        rule = broken.args[0] if isinstance(broken, Broken) else "EXCEPTION"
        told = list(story(soak))
    tell(
        seed=seed,
        seconds=soak.seconds(),
        exchanges=soak.judge.exchanges,
        faults=soak.faults(),
        rule=rule,
        digest=soak.digest(),
        story=told,
    )


def fuzz_seed(seed, count):
    tell(seed=seed, **fuzz(int(count), seed))


DEEDS = {"soak": soak_seed, "fuzz": fuzz_seed}


def main(deed, *arguments):
    if hasattr(gc, "threshold"):
        gc.threshold(COLLECT_AFTER)
    for line in sys.stdin:
        seed, *own = line.split()
        DEEDS[deed](int(seed), *own, *arguments[len(own) :])
        gc.collect()


main(*sys.argv[1:])
