# SPDX-License-Identifier: MIT
"""What the bench runs inside the emulated chip, typed in at the raw prompt (measurements.py).

It builds the panel of the frozen modules, as the frozen main.py does, and steps it while it looks
at the clock and at the heap. It is not part of the firmware, and a host cannot import it.
"""

import gc
import json
import time
from array import array

import board

import main
from uss import pkw

BUCKET_US = 20  # of a table of durations
BUCKETS = 300  # what is longer is listed: as files, the heap has no room for more in one piece

idle_at = 0


def idle():
    """Takes the place of the board's `idle`, and notes when a step has done its work."""
    global idle_at
    idle_at = time.ticks_us()
    time.sleep_ms(1)


class Tasks:
    """Two jobs for each drive, so that one is on the line whenever another has ended."""

    def __init__(self, drives):
        self._jobs = [(drive, pkw.read(number)) for number in (700, 1082) for drive in drives]
        self._next = 0
        self.ended = 0

    def ask(self):
        """Ask the next job again if it has ended: each drive has its turn every so many steps."""
        drive, job = self._jobs[self._next]
        self._next = (self._next + 1) % len(self._jobs)
        if job.state != pkw.PENDING and not drive.channel.is_full():
            self.ended += job.state == pkw.DONE
            drive.ask(job)


def show(tables, longer):
    """Print tables of durations as JSON, row by row: there is no room for all in one piece."""
    for phase, table in enumerate(tables):
        print("," if phase else "", "[[0, 0]")
        for at, n in enumerate(table):
            if n:
                print(",", [at * BUCKET_US, n])
        for at in sorted(longer[phase]):
            print(",", [at * BUCKET_US, 1])
        print("]")


def steps(phase_ms, phases, collect_ms, tasks=False, settled_ms=0, apart=None):
    """Step the panel; print {"steps": [[[us, count], ...] for each phase], "collections_us"}.

    settled_ms: for so long before the first phase. apart: only so many phases have a table of
    their own; the last one is that of all others as well.
    tasks: each drive has a parameter task always pending; how many were done is "tasks".
    """
    ticks_us, ticks_ms, since = time.ticks_us, time.ticks_ms, time.ticks_diff
    last = (apart or phases) - 1
    tables = [array("H", bytes(2 * BUCKETS)) for _ in range(last + 1)]
    longer = [array("H") for _ in range(last + 1)]  # half of what a list takes
    collections = array("I")
    board.idle = idle
    app = main.start(board)
    asking = Tasks(app.bus.turns.drives if tasks else ())
    gc.collect()
    try:
        step_for(app, settled_ms)
        began = collected = ticks_ms()
        passed = 0
        while passed < phases * phase_ms:
            phase = min(passed // phase_ms, last)
            at = ticks_us()
            following = app.step()
            if following:  # to hand over is no step of the loop: no motor runs
                app = following
                continue
            took = since(idle_at, at) // BUCKET_US
            if took < BUCKETS:
                tables[phase][took] += 1
            else:
                longer[phase].append(took)
            if tasks:
                asking.ask()
            now = ticks_ms()
            passed = since(now, began)
            if collect_ms and since(now, collected) >= collect_ms:
                collected = now
                at = ticks_us()
                gc.collect()
                if len(collections) < 100:
                    collections.append(since(ticks_us(), at))
    finally:
        app.close()
    app = None
    gc.collect()
    print('{"collections_us": %s, "tasks": %d, "steps": [' % (list(collections), asking.ended))
    show(tables, longer)
    print("]}")


def memory(exchanges, settled_ms):
    """Heap taken while so many exchanges are made, no collection: by all of it, page at rest."""
    app = main.start(board)
    try:
        step_for(app, settled_ms)
        gc.collect()
        gc.disable()
        first = app.bus.turns.exchanges
        before = gc.mem_alloc()
        while (app.bus.turns.exchanges - first) & 0xFFFF < exchanges:
            app.step()
        taken = gc.mem_alloc() - before
        gc.enable()
        made = (app.bus.turns.exchanges - first) & 0xFFFF
        runs = app.panel.any_runs()
    finally:
        app.close()
    print(json.dumps({"taken": taken, "exchanges": made, "runs": runs}))


def step_for(app, ms):
    began = time.ticks_ms()
    while time.ticks_diff(time.ticks_ms(), began) < ms:
        app.step()


def collecting(ms, collect_ms):
    """The panel, a collection every so often, for people to press keys."""
    app = main.start(board)
    try:
        while ms > 0:
            step_for(app, collect_ms)
            gc.collect()
            ms -= collect_ms
    finally:
        app.close()


def hang(how, after_ms):
    """The panel, until its main loop hangs for good."""
    app = main.start(board)
    step_for(app, after_ms)
    print("HANGS")
    while how == "pass":
        pass
    while how == "sleep":
        time.sleep_ms(100)
    while how == "collect":
        gc.collect()


def saving(settle_ms, times, every_ms):
    """The panel, with new settings written into the flash so many times, each with a setpoint that
    is 0.1 Hz higher."""
    app = main.start(board)
    try:
        step_for(app, settle_ms)
        for _ in range(times):
            app.settings.setpoint_centihertz += 10  # the same data would not be written
            app.settings.dirty = True
            step_for(app, every_ms)
        dirty = app.settings.dirty
    finally:
        app.close()
    print(json.dumps({"unsaved": dirty}))
