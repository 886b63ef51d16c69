# SPDX-License-Identifier: MIT
"""The soak finds planted bugs: a copy of the firmware with one thing wrong breaks the right rule.

Each row of tools/soaking/mutations.py is soaked with the seed that is known to find it, then with
others whose operator is given to the same: a change of firmware or simulation may have made
another life of that one. The same lives, as long as that took, break no rule without the bugs. A
seed is the same life on every interpreter (test_soak_interpreters.py); these are lived on CPython,
for its speed. Where a change takes the text of a row away this fails: give the row its new text.
Better seeds are looked for by

    PYTHONPATH=. build/pytest/bin/python host_tests/tools/test_soak_mutations.py NAME
"""

import itertools
import json
import os
import queue
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

import pytest

from tiers import STANDS_BACK
from tools.soaking import interpreters
from tools.soaking.interpreters import TOP
from tools.soaking.mutations import MUTATIONS

INTERPRETERS = "host"

MINUTES = 2
SEEDS = 200  # that are looked through for better ones
OTHERS = 24  # that a test tries
PARTS = 2  # of the lives in the firmware as it is: a test may take two minutes
ANY_DRIVES, ONE_TROUBLE = 0, 1


class Hunt(NamedTuple):
    seed: int  # of the life in which the bug was found, or of the last one
    minutes: float  # that it lasted
    told: list  # what the soak said instead of the right rule, lines; none if it was found


def soaked(folder, lives, roams, abruptly=False):
    """What the soak says of each life, a seed and its minutes, with the firmware in
    folder/firmware. abruptly: it ends with its minutes, not with what the hand is about."""
    caches = interpreters.CACHES if folder == TOP else folder / "pycache"
    arguments = ["soak", MINUTES, ANY_DRIVES, ONE_TROUBLE, int(roams), int(abruptly)]
    done = subprocess.Popen(
        [*STANDS_BACK, *interpreters.command(interpreters.CPYTHON, arguments)],
        cwd=TOP,
        env=interpreters.environment(interpreters.CPYTHON, folder / "firmware", caches),
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    try:
        for seed, minutes in lives:
            print(seed, minutes, file=done.stdin, flush=True)
            said = {"at": 0}
            while "at" in said:
                said = json.loads(done.stdout.readline())
            yield said
    finally:
        done.kill()
        done.communicate()


class Planting:
    """A copy of the firmware in a folder, into which one bug after the other is planted.

    What CPython has compiled stays there: an import takes what has the time and the size of its
    source, so each planting has a time of its own.
    """

    times = itertools.count(1)

    def __init__(self, folder):
        self.folder = folder
        shutil.copytree(TOP / "firmware", folder / "firmware")

    def plant(self, mutation):
        mutation.apply(self.folder / "firmware")
        time = next(self.times)
        for name, _, _ in mutation.changes:
            os.utime(self.folder / "firmware" / name, (time, time))

    def weed(self, mutation):
        for name, _, _ in mutation.changes:
            shutil.copy2(TOP / "firmware" / name, self.folder / "firmware" / name)


def hunted(mutation, plantings):
    """plantings: a queue of those that are free."""
    told = []
    planting = plantings.get()
    try:
        planting.plant(mutation)
        lives = [(seed, MINUTES) for seed in (mutation.seed, *mutation.seeds(OTHERS))]
        for said in soaked(planting.folder, lives, mutation.roams):
            seed, minutes = said["seed"], (said["seconds"] + 2) / 60  # both are rounded down
            if said["rule"] in mutation.rules:
                return Hunt(seed, minutes, [])
            told += said["story"][:2]
    finally:
        planting.weed(mutation)
        plantings.put(planting)
    return Hunt(seed, minutes, told or ["every rule held"])


class Pool(ThreadPoolExecutor):
    """As many lives at a time as there are processors. plantings: a queue of those free."""

    def __init__(self, make_folder):
        at_once = os.cpu_count() or 1
        super().__init__(at_once)
        self.plantings = queue.SimpleQueue()
        for _ in range(at_once):
            self.plantings.put(Planting(make_folder("planting")))


@pytest.fixture(scope="module")
def pool(tmp_path_factory):
    with Pool(tmp_path_factory.mktemp) as pool:
        yield pool
        pool.shutdown(cancel_futures=True)


@pytest.fixture(scope="module")
def hunts(request, pool):
    """By name, a future of each planted bug that is to be tested."""
    wanted = [
        item.callspec.params["mutation"]
        for item in request.session.items
        if getattr(item, "function", None) is test_a_planted_bug_is_found
    ]
    return {one.name: pool.submit(hunted, one, pool.plantings) for one in wanted}


@pytest.mark.parametrize("mutation", MUTATIONS, ids=lambda mutation: mutation.name)
def test_a_planted_bug_is_found(mutation, hunts):
    told = hunts[mutation.name].result().told
    assert not told, "\n".join(told)


@pytest.fixture(scope="module")
def controls(pool, hunts):
    """By roams and part, a future of what broke a rule without a bug."""
    every = itertools.product((True, False), range(PARTS))
    return {chosen: pool.submit(lived, *chosen, hunts) for chosen in every}


def lived(roams, part, hunts):
    """Stories of those of the same lives that broke a rule in the firmware as it is."""
    lives = lives_of((one for one in MUTATIONS if one.roams == roams), hunts)[part::PARTS]
    assert lives
    said = soaked(TOP, lives, roams, abruptly=True)
    return [one["story"] for one in said if one["rule"]]


def lives_of(mutations, hunts):
    """In which they were found, as long as that took; where nobody hunts, all of them."""
    lives = {}
    for mutation in mutations:
        seed, minutes = mutation.seed, MINUTES
        if mutation.name in hunts:
            seed, minutes, _ = hunts[mutation.name].result()
        lives[seed] = max(minutes, lives.get(seed, 0))
    return sorted(lives.items())


@pytest.mark.parametrize("part", range(PARTS))
@pytest.mark.parametrize("roams", [True, False])
def test_the_same_lives_find_nothing_in_the_firmware_as_it_is(roams, part, controls):
    stories = controls[roams, part].result()
    assert not stories, "\n".join(map("\n".join, stories))


def test_the_manual_says_how_many_they_are():
    manual = (TOP / "tools" / "README.md").read_text(encoding="utf-8")
    assert f"plant {len(MUTATIONS)} bugs" in manual


def test_a_text_that_is_gone_is_told(tmp_path):
    mutation = MUTATIONS[0]
    name, old, _ = mutation.changes[0]
    shutil.copytree(TOP / "firmware", tmp_path / "firmware")
    path = tmp_path / "firmware" / name
    path.write_text(path.read_text().replace(old, ""))
    with pytest.raises(LookupError, match=mutation.name):
        mutation.apply(tmp_path / "firmware")


def find_seeds(names):
    """Print for each mutation the first seed that finds it, and after how many seconds."""
    wanted = [one for one in MUTATIONS if one.name in names or not names]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        pool.map(find_seed, wanted)


def find_seed(mutation):
    with tempfile.TemporaryDirectory() as folder:
        planting = Planting(Path(folder))
        planting.plant(mutation)
        lives = [(seed, MINUTES) for seed in mutation.seeds(SEEDS)]
        for said in soaked(planting.folder, lives, mutation.roams):
            if said["rule"]:
                print(mutation.name, said["seed"], said["rule"], said["seconds"], flush=True)
            if said["rule"] in mutation.rules:
                return
    print(mutation.name, "was not found", flush=True)


if __name__ == "__main__":
    find_seeds(sys.argv[1:])
