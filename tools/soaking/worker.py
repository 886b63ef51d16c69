"""One process of a soak, on MicroPython: takes seeds from standard input, tells what became of them.

    micropython tools/soaking/worker.py soak MINUTES [DRIVES]       # then a seed a line
    micropython tools/soaking/worker.py fuzz BYTES

It answers lines of JSON: {"at": seconds} now and then, {"seed": ...} at the end of each.
"""

import gc
import json
import sys

from tools.soaking.fuzz import fuzz
from tools.soaking.rules import Broken
from tools.soaking.soak import soak
from tools.soaking.story import story

# Left alone, MicroPython fills the heap first, and takes long to look for its last holes.
COLLECT_AFTER = 2_000_000


def tell(**what):
    print(json.dumps(what))


def progress(seconds):
    tell(at=seconds)


def soak_seed(seed, minutes, drives=None):
    result = soak(seed, float(minutes), int(drives) if drives else None, progress)
    broken = result.broken
    lines = []
    rule = None
    if broken is not None:
        rule = broken.args[0] if isinstance(broken, Broken) else "EXCEPTION"
        lines = list(story(result))
        if not isinstance(broken, Broken):
            sys.print_exception(broken, sys.stderr)
    tell(
        seed=seed,
        seconds=result.seconds(),
        exchanges=result.exchanges(),
        faults=result.faults(),
        rule=rule,
        story=lines,
    )


def fuzz_seed(seed, count):
    tell(seed=seed, **fuzz(int(count), seed))


DEEDS = {"soak": soak_seed, "fuzz": fuzz_seed}


def main(deed, *arguments):
    gc.threshold(COLLECT_AFTER)
    for line in sys.stdin:
        DEEDS[deed](int(line), *arguments)
        gc.collect()


main(*sys.argv[1:])
