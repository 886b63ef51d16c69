# SPDX-License-Identifier: MIT
"""The engine comes in between two lines of what the loop does, or a line throws. Only CPython can
do that.

In use:

    for bench, sent in interrupted(prepare, action):
        ...                                 # for each line before which the engine worked

    for bench in thrown(prepare, action):
        ...                                 # for each line that threw an exception

After most lines everything is as it was after another one, and so is what comes of it. That is
gone through once.
"""

import pickle
import sys

WHILES_US = (0, 1_500, 23_000, 70_000)  # nothing, a part of an exchange, one, several
STEP_US = 10_000
ROOM = "firmware/uss/"


class Thrown(Exception):
    pass


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
            sys.settrace(None)
            self.came = True
            bench = self._bench
            bench.refreshing = False  # the loop stands still meanwhile
            bench.run(self._us)
            bench.refreshing = True
        return self._line


class Throwing:
    """As a context: the `count`th line of the protocol throws."""

    def __init__(self, count):
        self._count = count

    def __enter__(self):
        sys.settrace(self._call)

    def __exit__(self, *_):
        sys.settrace(None)

    def _call(self, frame, event, argument):
        return self._line if ROOM in frame.f_code.co_filename else None

    def _line(self, frame, event, argument):
        if event == "line":
            self._count -= 1
            if self._count == 0:
                sys.settrace(None)
                raise Thrown
        return self._line


def again(prepare):
    """A function that answers what `prepare()` does, another one each time, in a tenth of the time
    that it takes. What a test wants to find again, it finds in the bench."""
    prepared = pickle.dumps(prepare())
    return lambda: pickle.loads(prepared)


class States:
    """Where nothing differs, nothing will: what comes of a state is looked at once."""

    def __init__(self):
        self._seen = set()

    def is_new(self, *state):
        state = pickle.dumps(state)
        if state in self._seen:
            return False
        self._seen.add(state)
        return True


def interrupted(prepare, action):
    """Carries `action(bench)` out with each interruption: yields the bench afterwards, and how
    many telegrams had been sent before. What the action returns belongs to the state: what the
    test looks at and the bench may have done with."""
    prepare = again(prepare)
    states = States()
    for us in WHILES_US:
        count = 1
        while True:
            bench = prepare()
            sent = len(bench.sent)
            with Interruption(bench, count, us) as interruption:
                result = action(bench)
            if not interruption.came:
                assert count > 3, "nothing was interrupted"
                break
            if states.is_new(bench, sent, result):
                yield bench, sent
            count += 1


def thrown(prepare, action, after=None):
    """Carries `action(bench)` out with an exception at each line of the protocol: yields the bench
    after each, and after `after(bench)`."""
    prepare = again(prepare)
    states = States()
    count = 1
    while True:
        bench = prepare()
        try:
            with Throwing(count):
                action(bench)
        except Thrown:
            if after:
                after(bench)
            if states.is_new(bench):
                yield bench
            count += 1
            continue
        assert count > 50, "nothing was thrown"
        return


def recovered(prepare, us):
    """Each line that the protocol comes to in the `us` after `prepare` throws: yields the bench
    when the engine has recovered, as `hal.pacer` has it. In steps, for the way to the line is gone
    again for each."""

    def recover(bench):
        bench.master.recover(bench.now & bench.mask)
        bench.due = bench.now

    bench = prepare()
    for _ in range(0, us, STEP_US):
        yield from thrown(lambda: bench, lambda bench: bench.run(STEP_US), recover)
        bench.run(STEP_US)
