# SPDX-License-Identifier: MIT
"""tools/mutants: makes mutants of the firmware, and tells which of them the tests find.

    python3 tools/mutating [--count N] [--seed N] [--only PATH ...] [--mutant NAME ...] [--jobs N]

mutants.py makes them, reach.py knows which tests run a line, trials.py runs these. CPython 3.11
or newer, cosmic-ray in build/mutating, and MicroPython in build/unix64.
"""

import argparse
import queue
import random
import re
import resource
import sys
import threading
import time
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path[:1] = map(str, (TOP, TOP / "host_tests", TOP / "host_tests" / "cpython"))

from tools.command_line import Parser, count  # noqa: E402

USUAL = ("firmware/uss", "firmware/panel", "firmware/app.py", "firmware/hal")
SURVIVED, WRONG = 1, 2
COUNT_MAX = 100_000


def parser():
    arguments = Parser(
        prog="tools/mutants",
        description="Makes mutants of the firmware, each with one small bug, and runs the tests "
        "that run its line, until one fails.",
        epilog="Exit status: 0 the tests found every mutant, 1 some survived, 2 wrong arguments, "
        "3 something is missing.",
    )
    add = arguments.add_argument
    add("--count", type=count(1, COUNT_MAX), default=100, metavar="N", help="(100)")
    add("--seed", type=count(0, 2**60), metavar="N", help="the same mutants again")
    add(
        "--only",
        action="append",
        metavar="PATH",
        help="a file or folder of firmware/ (%s)" % " ".join(USUAL),
    )
    add(
        "--mutant",
        action="append",
        type=name,
        metavar="NAME",
        help="this one, as a run has named it",
    )
    add("--jobs", type=count(1, 100), default=2, metavar="N", help="mutants at a time (2)")
    add(
        "--patience",
        type=count(1, 3600),
        default=15,
        metavar="S",
        help="a test that takes so many seconds more than usual hangs (15)",
    )
    add("--tree", metavar="FOLDER", type=Path, default=TOP, help="another tree than this one")
    add("--check", action="store_true", help=argparse.SUPPRESS)
    return arguments


def name(word):
    """Type of an argument: the name of a mutant."""
    if not re.fullmatch(r"[^:]+:\d+:\d+:\w+:\d+", word):
        raise argparse.ArgumentTypeError("%s is no name of a mutant" % word)
    return word


def files(tree, only):
    """The source files at these paths, from the top of the tree. ValueError if there are none."""
    found = set()
    for word in only:
        path = (tree / word).resolve()
        inside = {path} if path.is_file() else set(path.rglob("*.py"))
        inside = {one for one in inside if one.suffix == ".py"}
        if not inside or not path.is_relative_to(tree / "firmware"):
            raise ValueError("--only: %s is no file or folder of the firmware" % word)
        found |= inside
    return {str(path.relative_to(tree)) for path in found}


def mutants_of(wanted):
    """The mutants that are to be tried. ValueError if a name is none."""
    from tools.mutating import mutants

    if not wanted.mutant:
        paths = files(wanted.tree, wanted.only or USUAL)
        return mutants.chosen(wanted.tree, paths, wanted.count, wanted.seed)
    named = [mutants.named(name) for name in wanted.mutant]
    for mutant in named:
        try:
            mutant.applied(mutants.read(wanted.tree / mutant.path))
        except (OSError, LookupError):
            raise ValueError("--mutant: there is no " + str(mutant)) from None
    return named


class Tally:
    """What has been done so far, and what comes of it."""

    def __init__(self, wanted, count):
        self.wanted = wanted
        self.count = count
        self.done = 0
        self.survivors = []
        self.began = time.monotonic()

    def take(self, mutant, verdict, took_s):
        self.done += 1
        if verdict.by:
            told = "found by %s: %s" % (verdict.by, verdict.reason or "no reason is told")
        else:
            self.survivors.append(mutant)
            told = "SURVIVED, tests that run it: %d" % verdict.tests
        show_line("")
        print("%d: %s" % (self.done, str(mutant)))
        source = (self.wanted.tree / mutant.path).read_text(encoding="utf-8")
        print("\n".join("    " + line for line in mutant.difference(source)))
        print("    %s (%.1f s)" % (told, took_s), flush=True)
        show_line("%d of %d mutants, %d survived, %s left" % (
            self.done, self.count, len(self.survivors), minutes(self.left_s()),
        ))  # fmt: skip

    def left_s(self):
        return (time.monotonic() - self.began) / self.done * (self.count - self.done)

    def summary(self):
        own, others = map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
        cpu_s = sum(one.ru_utime + one.ru_stime for one in (own, others))
        for mutant in self.survivors:
            yield "again: ./tools/mutants --mutant " + str(mutant)
        seed = "" if self.wanted.mutant else "seed %d: " % self.wanted.seed
        found = self.done - len(self.survivors)
        yield "%sthe tests found %d of %d mutants" % (seed, found, self.done)
        took = minutes(time.monotonic() - self.began)
        yield "took %s, and %s of processor time" % (took, minutes(cpu_s))


def minutes(seconds):
    return "%d:%02d min" % divmod(round(seconds), 60)


def show_line(text):
    """Show one line of progress that is written over, on a terminal."""
    if sys.stderr.isatty():
        print("\r\x1b[K" + text, end="", file=sys.stderr, flush=True)


def work(trials, waiting, told):
    """A thread: tries mutants until there are no more."""
    try:
        while True:
            mutant = waiting.get_nowait()
            began = time.monotonic()
            told.put((mutant, trials.of(mutant), time.monotonic() - began))
    except queue.Empty:
        pass
    except BaseException as error:
        told.put(error)


def run(wanted, found):
    from tools.mutating.reach import Reach
    from tools.mutating.trials import Trials

    room = wanted.tree / "build" / "mutants"
    show_line("looking which tests run which line")
    reach = Reach(wanted.tree, room)
    reach.learn(
        wanted.jobs,
        lambda done, files: show_line(
            "which tests run which line: %d of %d files" % (done, files)
        ),
    )
    waiting, told = queue.SimpleQueue(), queue.SimpleQueue()
    for mutant in found:
        waiting.put(mutant)
    tally = Tally(wanted, len(found))
    for number in range(min(wanted.jobs, len(found))):
        trials = Trials(wanted.tree, reach, room / str(number + 1), wanted.patience)
        threading.Thread(target=work, args=(trials, waiting, told), daemon=True).start()
    for _ in found:
        said = told.get()
        if isinstance(said, BaseException):
            raise said
        tally.take(*said)
    show_line("")
    print("\n".join(tally.summary()))
    return SURVIVED if tally.survivors else 0


def main():
    arguments = parser()
    wanted = arguments.parse_args()
    wanted.tree = wanted.tree.resolve()
    if wanted.seed is None:
        wanted.seed = random.randrange(1_000_000)
    try:
        files(wanted.tree, wanted.only or USUAL)
        if wanted.check:
            return 0
        found = mutants_of(wanted)
    except ValueError as error:
        arguments.error(str(error))
    return run(wanted, found)


if __name__ == "__main__":
    sys.exit(main())
