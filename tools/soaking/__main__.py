# SPDX-License-Identifier: MIT
"""tools/soak: runs many seeds in two processes, shows one line of progress, and tells the results.

    python3 tools/soaking --seeds N --minutes M [--first SEED] [--drives N] [--jobs N]
    python3 tools/soaking --fuzz BYTES [--first SEED] [--jobs N]

worker.py does the work, on the interpreters of interpreters.py. This needs nothing but CPython
3.11 or newer.
"""

import argparse
import json
import math
import queue
import subprocess
import sys
import threading
import time
from collections import Counter
from pathlib import Path

sys.path[0] = str(Path(__file__).resolve().parents[2])

from tools.command_line import Parser, count  # noqa: E402
from tools.progress import Progress  # noqa: E402
from tools.soaking import interpreters  # noqa: E402
from tools.soaking.interpreters import NAMES, TOP  # noqa: E402

PORTION = 250_000  # bytes for each seed of --fuzz
BROKEN, MISSING, CRASHED = 1, 3, 4
SEEDS_MAX = 1_000_000
MINUTES_MAX = 1_000_000


def parser():
    arguments = Parser(
        prog="tools/soak",
        description="The whole panel in virtual time: an operator who presses random keys, "
        "drives, seeded faults, and the rules that must hold at every step.",
        epilog="Exit status: 0 every rule held, 1 one was broken, 2 wrong arguments, 3 an "
        "interpreter is missing, 4 a process failed.",
    )
    add = arguments.add_argument
    add("--seeds", type=count(1, SEEDS_MAX), default=20, metavar="N", help="(20)")
    add("--minutes", type=minutes, default=3, metavar="M", help="virtual time of each seed (3)")
    add("--first", type=count(0, 2**60), default=1, metavar="SEED", help="(1)")
    add("--drives", type=count(1, 31), metavar="N", help="1...31 (each seed has its own number)")
    add(
        "--two-troubles",
        action="store_true",
        help="several drives run, and two things fail at once, in every second thing that happens",
    )
    add(
        "--at-home",
        action="store_true",
        help="the operator opens neither the menu nor the search, so that more else happens",
    )
    add("--jobs", type=count(1, 1000), default=2, metavar="N", help="processes at a time (2)")
    add("--fuzz", type=count(1, 10**12), metavar="BYTES", help="feed the receiver instead")
    add(
        "--interpreter",
        choices=NAMES,
        help="for all seeds (every tenth seed on MicroPython, the others on CPython)",
    )
    add("--firmware", metavar="FOLDER", default=TOP / "firmware", help="another copy of firmware/")
    add("--needs", action="store_true", help=argparse.SUPPRESS)  # what it runs on, for tools/soak
    return arguments


def minutes(word):
    """Type of an argument: minutes, at least a second."""
    try:
        number = float(word)
    except ValueError:
        raise argparse.ArgumentTypeError("%s is no number" % word) from None
    if not (math.isfinite(number) and 1 <= number * 60 <= MINUTES_MAX * 60):
        raise argparse.ArgumentTypeError(
            "%s is no time: 0.02 (a second) to %d minutes" % (word, MINUTES_MAX)
        )
    return number


class Worker:
    """A thread that gives seeds to its processes and passes on their answers.

    processes: one for each interpreter, from the first seed on that runs on it.
    """

    def __init__(self, wanted, arguments, seeds, said):
        self.wanted = wanted
        self.arguments = arguments
        self.seeds = seeds
        self.said = said
        self.processes = {}
        threading.Thread(target=self.run, daemon=True).start()

    def run(self):
        try:
            while True:
                seed, name = self.seeds.get_nowait()
                process = self.process(name)
                print(seed, file=process.stdin, flush=True)
                while self.hand_on(name, process.stdout.readline()):
                    pass
        except (queue.Empty, BrokenPipeError):
            pass
        statuses = [abs(self.end(process)) for process in self.processes.values()]
        self.said.put((self, {"ended": max(statuses, default=0)}))

    def process(self, name):
        if name not in self.processes:
            self.processes[name] = subprocess.Popen(
                interpreters.command(name, self.arguments),
                cwd=TOP,
                env=interpreters.environment(name, self.wanted.firmware),
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                text=True,
            )
        return self.processes[name]

    def end(self, process):
        try:
            process.stdin.close()
        except BrokenPipeError:
            pass
        return process.wait()

    def hand_on(self, name, line):
        """Whether the seed goes on."""
        if not line:
            raise BrokenPipeError
        what = json.loads(line)
        what["interpreter"] = name
        self.said.put((self, what))
        return "at" in what


class Tally:
    """What has been done so far."""

    def __init__(self, count, seed_s):
        self.count = count
        self.seed_s = seed_s  # virtual time of each
        self.began = time.monotonic()
        self.progress = Progress(count)
        self.running = {}  # worker -> virtual seconds of its present seed
        self.done = 0
        self.seconds = 0
        self.exchanges = 0
        self.faults = Counter()
        self.interpreters = Counter()
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
            self.interpreters[what["interpreter"]] += 1
            if what["rule"]:
                self.broken.append(what)

    def line(self):
        running = sum(self.running.values())
        seconds = self.seconds + running
        left = self.progress.left(self.done + running / self.seed_s)
        return "%d of %d seeds, %s%.1f h of virtual time, %d times real time, %d broken" % (
            self.done, self.count, left and left + ", ", seconds / 3600,
            seconds / self.took_s(), len(self.broken),
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
        yield "took %d:%02d min, %d times real time, on %s" % (
            took_s // 60, took_s % 60, self.seconds / took_s, lived_on(self.interpreters),
        )  # fmt: skip
        yield self.verdict()

    def verdict(self):
        """The result, in words."""
        missing = self.count - self.done
        if self.broken:
            said = "%d of %d seeds broke a rule" % (len(self.broken), self.done)
        else:
            said = "every rule held in %d seeds" % self.done
        if missing:
            said += ", but %d were not lived to their end" % missing
        return said


def lived_on(counts):
    """Such as "CPython 18, MicroPython 2"."""
    return ", ".join("%s %d" % (NAMES[name], count) for name, count in counts.items()) or "nothing"


def lives(wanted):
    """Each seed with the interpreter that should run it, here or not."""
    seeds = -(-wanted.fuzz // PORTION) if wanted.fuzz else wanted.seeds
    for seed in range(wanted.first, wanted.first + seeds):
        yield seed, wanted.interpreter or interpreters.of_seed(seed)


def start(wanted, arguments):
    """The workers, started, and the queue of their answers."""
    waiting = queue.SimpleQueue()
    chosen = list(lives(wanted))
    for seed_and_name in chosen:
        waiting.put(seed_and_name)
    said = queue.SimpleQueue()
    jobs = min(wanted.jobs, len(chosen))
    return {Worker(wanted, arguments, waiting, said) for _ in range(jobs)}, said


def sayings(workers, said):
    """The workers' answers, until all have ended."""
    while workers:
        worker, what = said.get()
        if "ended" in what:
            workers.remove(worker)
        yield worker, what


def soak(wanted):
    troubles, roams = 1 + wanted.two_troubles, 1 - wanted.at_home
    arguments = ["soak", wanted.minutes, wanted.drives or 0, troubles, roams]
    workers, said = start(wanted, arguments)
    tally = Tally(wanted.seeds, 60 * wanted.minutes)
    crashed = 0
    for worker, what in sayings(workers, said):
        tally.take(worker, what)
        crashed = crashed or what.get("ended", 0)
        if what.get("rule"):
            show_line("")
            print("\n".join(what["story"]))
            print("again: %s" % again(wanted, what), flush=True)
        show_line(tally.line())
    show_line("")
    for line in tally.summary():
        print(line)
    for what in tally.broken:
        print("seed %d: %s" % (what["seed"], what["rule"]))
    return CRASHED if crashed else BROKEN if tally.broken else 0


def again(wanted, what):
    drives = " --drives %d" % wanted.drives if wanted.drives else ""
    troubles = " --two-troubles" if wanted.two_troubles else ""
    home = " --at-home" if wanted.at_home else ""
    return "./tools/soak --seeds 1 --first %d --minutes %r%s%s%s --interpreter %s" % (
        what["seed"], wanted.minutes, drives, troubles, home, what["interpreter"],
    )  # fmt: skip


def show_line(text):
    """Show one line of progress that is written over, on a terminal."""
    if sys.stderr.isatty():
        print("\r\x1b[K" + text, end="", file=sys.stderr, flush=True)


def fuzz(wanted):
    began = time.monotonic()
    portion = min(wanted.fuzz, PORTION)
    fed = Counter()
    broken = crashed = 0
    for _, what in sayings(*start(wanted, ["fuzz", portion])):
        crashed = crashed or what.pop("ended", 0)
        seed = what.pop("seed", None)
        reason = what.pop("broken", None)
        name = what.pop("interpreter", None)
        fed.update(what)
        if reason:
            broken = BROKEN
            show_line("")
            print("seed %d: %s" % (seed, reason))
            command = "./tools/soak --fuzz %d --first %d --interpreter %s"
            print("again: " + command % (portion, seed, name), flush=True)
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
    if wanted.needs:
        print(*sorted({name for _, name in lives(wanted)}))
        return 0
    if wanted.interpreter and not interpreters.is_here(wanted.interpreter):
        print("tools/soak: no %s is here" % NAMES[wanted.interpreter], file=sys.stderr)
        return MISSING
    return fuzz(wanted) if wanted.fuzz else soak(wanted)


if __name__ == "__main__":
    sys.exit(main())
