# SPDX-License-Identifier: MIT
"""The engine comes in between two lines of what the loop does. Only CPython can do that.

In use:

    for bench, sent in interrupted(prepare, action):
        ...                                 # once for each line before which the engine worked
"""

import pickle
import sys

WHILES_US = (0, 1_500, 23_000, 70_000)  # nothing, a part of an exchange, one, several
ROOM = "firmware/uss/"


class Interruption:
    """As a context: before the `count`th line of the protocol, the engine works for `us`."""

    def __init__(self, bench, count, us):
        self.came = False
        self._bench = bench
        self._count = count
        self._us = us

    def __enter__(self):
        sys.settrace(self._call)
        return self

    def __exit__(self, *_):
        sys.settrace(None)

    def _call(self, frame, event, argument):
        return self._line if ROOM in frame.f_code.co_filename else None

    def _line(self, frame, event, argument):
        if event != "line":
            return self._line
        self._count -= 1
        if self._count == 0:
            self.came = True
            bench = self._bench
            bench.refreshing = False  # the loop stands still meanwhile
            bench.run(self._us)
            bench.refreshing = True
        return self._line


def again(prepare):
    """A function that answers what `prepare()` does, another one each time, in a tenth of the time
    that it takes. What a test wants to find again, it finds in the bench."""
    prepared = pickle.dumps(prepare())
    return lambda: pickle.loads(prepared)


def interrupted(prepare, action):
    """Carries `action(bench)` out with each interruption: yields the bench afterwards, and how
    many telegrams had been sent before."""
    prepare = again(prepare)
    for us in WHILES_US:
        count = 1
        while True:
            bench = prepare()
            sent = len(bench.sent)
            with Interruption(bench, count, us) as interruption:
                action(bench)
            if not interruption.came:
                assert count > 3, "nothing was interrupted"
                break
            yield bench, sent
            count += 1
