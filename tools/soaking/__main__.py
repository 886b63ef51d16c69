# SPDX-License-Identifier: MIT
"""tools/soak: many seeds, two processes, one line of progress, and what came of them.

    python3 tools/soaking --seeds N --minutes M [--first SEED] [--drives N] [--jobs N]
    python3 tools/soaking --fuzz BYTES [--first SEED] [--jobs N]

The work is done by worker.py on MicroPython, a process for each job. Standard library only,
CPython 3.11 or newer.
"""

import argparse
import json
import os
import queue
import subprocess
import sys
import threading
import time
from collections import Counter
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
WORKER = "tools/soaking/worker.py"
INTERPRETER = TOP / "build/unix64/micropython"
HEAP = "heapsize=96M"
PORTION = 250_000  # bytes of a seed that fuzzes
BROKEN, NOT_UNDERSTOOD, CRASHED = 1, 2, 4


def parser():
    arguments = argparse.ArgumentParser(
        prog="tools/soak",
        description="The whole panel in virtual time: an operator who presses random keys, "
        "drives, seeded faults, and the rules that must hold at every step.",
        epilog="Exit status: 0 every rule held, 1 one was broken, 2 wrong arguments, 3 there is "
        "no MicroPython, 4 a process failed.",
    )
    arguments.add_argument("--seeds", type=at_least_one, default=20, metavar="N", help="(20)")
    arguments.add_argument(
        "--minutes", type=float, default=3, metavar="M", help="virtual time of each seed (3)"
    )
    arguments.add_argument("--first", type=int, default=1, metavar="SEED", help="(1)")
    arguments.add_argument(
        "--drives", type=at_least_one, metavar="N", help="1...31 (each seed has its own number)"
    )
    arguments.add_argument(
        "--jobs", type=at_least_one, default=2, metavar="N", help="processes at a time (2)"
    )
    arguments.add_argument(
        "--fuzz", type=at_least_one, metavar="BYTES", help="feed the receiver instead"
    )
    arguments.add_argument(
        "--firmware", metavar="FOLDER", default=TOP / "firmware", help="another copy of firmware/"
    )
    arguments.add_argument("--check", action="store_true", help=argparse.SUPPRESS)
    return arguments


def at_least_one(word):
    number = int(word)
    if number < 1:
        raise argparse.ArgumentTypeError("%s is not at least 1" % word)
    return number


class Worker:
    """A process with its own thread, which gives it seeds and hands on what it says."""

    def __init__(self, wanted, arguments, seeds, said):
        self.seeds = seeds
        self.said = said
        command = [INTERPRETER, "-X", HEAP, WORKER, *map(str, arguments)]
        paths = (wanted.firmware, TOP, ".frozen")
        self.process = subprocess.Popen(
            command,
            cwd=TOP,
            env={**os.environ, "MICROPYPATH": ":".join(map(str, paths))},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        threading.Thread(target=self.run, daemon=True).start()

    def run(self):
        try:
            while True:
                seed = self.seeds.get_nowait()
                print(seed, file=self.process.stdin, flush=True)
                while self.hand_on(self.process.stdout.readline()):
                    pass
        except (queue.Empty, BrokenPipeError):
            pass
        self.process.stdin.close()
        self.said.put((self, {"ended": self.process.wait()}))

    def hand_on(self, line):
        """Whether the seed goes on."""
        if not line:
            raise BrokenPipeError
        what = json.loads(line)
        self.said.put((self, what))
        return "at" in what


class Tally:
    """What has been done so far."""

    def __init__(self, count, minutes):
        self.count = count
        self.minutes = minutes
        self.began = time.monotonic()
        self.running = {}  # worker -> seconds of the seed that it is at
        self.done = 0
        self.seconds = 0
        self.exchanges = 0
        self.faults = Counter()
        self.broken = []

    def take(self, worker, what):
        self.running.pop(worker, None)
        if "at" in what:
            self.running[worker] = what["at"]
        elif "seed" in what:
            self.done += 1
            self.seconds += what["seconds"]
            self.exchanges += what["exchanges"]
            self.faults.update(what["faults"])
            if what["rule"]:
                self.broken.append(what)

    def line(self):
        seconds = self.seconds + sum(self.running.values())
        return "%d of %d seeds, %.1f h of virtual time, %d times real time, %d broken" % (
            self.done, self.count, seconds / 3600, seconds / self.took_s(), len(self.broken),
        )  # fmt: skip

    def took_s(self):
        return max(time.monotonic() - self.began, 0.001)

    def summary(self):
        yield "%d seeds, %.2f h of virtual time, %d exchanges" % (
            self.done, self.seconds / 3600, self.exchanges,
        )  # fmt: skip
        counted = ("%s %d" % (kind, count) for kind, count in sorted(self.faults.items()))
        yield "faults: %s" % (", ".join(counted) or "none")
        took_s = self.took_s()
        yield "took %d:%02d min, %d times real time" % (
            took_s // 60, took_s % 60, self.seconds / took_s,
        )  # fmt: skip


def start(wanted, seeds, arguments):
    """The workers, at work, and the queue into which they speak."""
    waiting = queue.SimpleQueue()
    for seed in seeds:
        waiting.put(seed)
    said = queue.SimpleQueue()
    jobs = min(wanted.jobs, len(seeds))
    return {Worker(wanted, arguments, waiting, said) for _ in range(jobs)}, said


def sayings(workers, said):
    """What they say, until all have ended."""
    while workers:
        worker, what = said.get()
        if "ended" in what:
            workers.remove(worker)
        yield worker, what


def soak(wanted):
    arguments = ["soak", wanted.minutes] + ([wanted.drives] if wanted.drives else [])
    seeds = range(wanted.first, wanted.first + wanted.seeds)
    workers, said = start(wanted, seeds, arguments)
    tally = Tally(wanted.seeds, wanted.minutes)
    crashed = 0
    for worker, what in sayings(workers, said):
        tally.take(worker, what)
        crashed = crashed or what.get("ended", 0)
        if what.get("rule"):
            show_line("")
            print("\n".join(what["story"]))
            print("again: %s" % again(wanted, what["seed"]), flush=True)
        show_line(tally.line())
    show_line("")
    for line in tally.summary():
        print(line)
    for what in tally.broken:
        print("seed %d: %s" % (what["seed"], what["rule"]))
    return CRASHED if crashed else BROKEN if tally.broken else 0


def again(wanted, seed):
    drives = " --drives %d" % wanted.drives if wanted.drives else ""
    return "./tools/soak --seeds 1 --first %d --minutes %g%s" % (seed, wanted.minutes, drives)


def show_line(text):
    """One line that is written over, where somebody looks on."""
    if sys.stderr.isatty():
        print("\r\x1b[K" + text, end="", file=sys.stderr, flush=True)


def fuzz(wanted):
    began = time.monotonic()
    count = min(wanted.fuzz, PORTION)
    seeds = range(wanted.first, wanted.first + -(-wanted.fuzz // PORTION))
    fed = Counter()
    broken = crashed = 0
    for _, what in sayings(*start(wanted, seeds, ["fuzz", count])):
        crashed = crashed or what.pop("ended", 0)
        seed = what.pop("seed", None)
        reason = what.pop("broken", None)
        fed.update(what)
        if reason:
            broken = BROKEN
            show_line("")
            print("seed %d: %s" % (seed, reason))
            print("again: ./tools/soak --fuzz %d --first %d" % (count, seed), flush=True)
        show_line("%d of %d bytes" % (fed["bytes"], wanted.fuzz))
    show_line("")
    took_s = time.monotonic() - began
    print(
        "%d bytes in %d exchanges, of whose replies %d were good"
        % (fed["bytes"], fed["exchanges"], fed["good"])
    )
    print("took %d s, %d bytes a second" % (took_s, fed["bytes"] / took_s))
    return CRASHED if crashed else broken


def main():
    wanted = parser().parse_args()
    if wanted.drives and wanted.drives > 31:
        parser().error("--drives %d: 31 at the most" % wanted.drives)
    if wanted.check:
        return 0
    return fuzz(wanted) if wanted.fuzz else soak(wanted)


if __name__ == "__main__":
    sys.exit(main())
