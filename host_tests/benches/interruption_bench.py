# SPDX-License-Identifier: MIT
"""The engine comes in between two lines of what the loop does, or a line throws. Only CPython can
do that.

In use:

    for bench, sent in interrupted(prepare, action):
        ...                                 # for each line before which the engine worked

    for bench, lines in thrown(prepare, action):
        ...                                 # for each line that threw an exception

After most lines the bench is as it is after another line. Then the same would follow, so it is
yielded once.
"""

import pickle
import sys
from collections import Counter

WHILES_US = (0, 1_500, 23_000, 70_000)  # nothing, a part of an exchange, one, several
STEP_US = 10_000  # of what an exception comes into
ROOM = "firmware/uss/"


class Thrown(Exception):
    pass


class AtLine:
    """As a context: before the `count`th line of the protocol, `do()`. came: whether it came to
    that."""

    def __init__(self, count, do):
        self.came = False
        self._count = count
        self._do = do

    def __enter__(self):
        sys.settrace(self._call)
        return self

    def __exit__(self, *_):
        sys.settrace(None)

    def _call(self, frame, event, argument):
        return self._line if ROOM in frame.f_code.co_filename else None

    def _line(self, frame, event, argument):
        if event == "line":
            self._count -= 1
            if self._count == 0:
                sys.settrace(None)
                self.came = True
                self._do()
        return self._line


def engine_works(bench, us):
    bench.refreshing = False  # the loop stands still meanwhile
    bench.run(us)
    bench.refreshing = True


def throw():
    raise Thrown


def again(prepare):
    """A function that answers what `prepare()` does, another one each time, in a tenth of the time
    that it takes. What a test wants to find again, it finds in the bench."""
    prepared = pickle.dumps(prepare())
    return lambda: pickle.loads(prepared)


def interrupted(prepare, action):
    """Carries `action(bench)` out with each interruption: yields the bench afterwards, and how
    many telegrams had been sent before. The action returns what the test looks at besides: that
    belongs to the state as well."""
    prepare = again(prepare)
    seen = set()
    for us in WHILES_US:
        count = 1
        while True:
            bench = prepare()
            sent = len(bench.sent)
            with AtLine(count, lambda bench=bench, us=us: engine_works(bench, us)) as line:
                result = action(bench)
            if not line.came:
                assert count > 3, "nothing was interrupted"
                break
            state = pickle.dumps((bench, sent, result))
            if state not in seen:
                seen.add(state)
                yield bench, sent
            count += 1


def thrown(prepare, action, after=None):
    """Carries `action(bench)` out with an exception at each line of the protocol, and
    `after(bench)`: yields the bench then, and how many lines led to that."""
    prepare = again(prepare)
    states = Counter()
    count = 1
    while True:
        bench = prepare()
        try:
            with AtLine(count, throw):
                action(bench)
        except Thrown:
            if after:
                after(bench)
            states[pickle.dumps(bench)] += 1
            count += 1
            continue
        break
    assert count > 50, "nothing was thrown"
    for state, lines in states.items():
        yield pickle.loads(state), lines


def recovered(prepare, us):
    """Each line that the protocol comes to in the `us` after `prepare` throws: yields the bench
    when the engine has recovered, as `hal.pacer` has it.

    It goes in steps: to throw at a line, all lines of its step before it have to run again.
    """

    def recover(bench):
        bench.master.recover(bench.now & bench.mask)
        bench.due = bench.now

    bench = prepare()
    for _ in range(0, us, STEP_US):
        for after, _ in thrown(lambda: bench, lambda bench: bench.run(STEP_US), recover):
            yield after
        bench.run(STEP_US)
