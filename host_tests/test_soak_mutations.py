"""The soak finds planted bugs: a copy of the firmware with one thing wrong breaks the right rule.

Each row of tools/soaking/mutations.py is soaked with the seed that is known to find it. A change
of the firmware that takes the text of a row away fails here: give the row its new text.
`PYTHONPATH=. python3 host_tests/test_soak_mutations.py [NAME ...]` looks for other seeds.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest
from tools.soaking.mutations import MUTATIONS

INTERPRETERS = "host"

TOP = Path(__file__).resolve().parent.parent
MICROPYTHON = TOP / "build" / "unix64" / "micropython"
MINUTES = 2
SEEDS = range(1, 61)


def soaked(folder, seeds, minutes):
    """What the soak says of each seed, with the firmware in folder/firmware."""
    paths = (folder / "firmware", TOP, ".frozen")
    done = subprocess.Popen(
        [MICROPYTHON, "-X", "heapsize=96M", "tools/soaking/worker.py", "soak", str(minutes)],
        cwd=TOP,
        env={**os.environ, "MICROPYPATH": ":".join(map(str, paths))},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    with done:
        for seed in seeds:
            print(seed, file=done.stdin, flush=True)
            said = {"at": 0}
            while "at" in said:
                said = json.loads(done.stdout.readline())
            yield said


def mutated(mutation, folder):
    shutil.copytree(TOP / "firmware", folder / "firmware")
    mutation.apply(folder / "firmware")
    return folder


@pytest.mark.skipif(not MICROPYTHON.exists(), reason="there is no MicroPython: tools/test")
@pytest.mark.parametrize("mutation", MUTATIONS, ids=lambda mutation: mutation.name)
def test_a_planted_bug_is_found(mutation, tmp_path):
    (said,) = soaked(mutated(mutation, tmp_path), [mutation.seed], MINUTES)
    assert said["rule"] in mutation.rules, "\n".join(said["story"]) or "every rule held"


@pytest.mark.skipif(not MICROPYTHON.exists(), reason="there is no MicroPython: tools/test")
@pytest.mark.parametrize("seed", sorted({mutation.seed for mutation in MUTATIONS}))
def test_the_same_seeds_find_nothing_in_the_firmware_as_it_is(seed):
    (said,) = soaked(TOP, [seed], MINUTES)
    assert said["rule"] is None, "\n".join(said["story"])


def test_a_text_that_is_gone_is_told(tmp_path):
    mutation = MUTATIONS[0]
    name, old, _ = mutation.changes[0]
    shutil.copytree(TOP / "firmware", tmp_path / "firmware")
    path = tmp_path / "firmware" / name
    path.write_text(path.read_text().replace(old, ""))
    with pytest.raises(LookupError, match=mutation.name):
        mutation.apply(tmp_path / "firmware")


def find_seeds(names):
    """Print for each mutation the first seeds that find it, and after how many seconds."""
    for mutation in MUTATIONS:
        if names and mutation.name not in names:
            continue
        with tempfile.TemporaryDirectory() as folder:
            found = []
            for said in soaked(mutated(mutation, Path(folder)), SEEDS, MINUTES):
                if said["rule"]:
                    found.append((said["seed"], said["rule"], said["seconds"]))
                if len([1 for _, rule, _ in found if rule in mutation.rules]) == 2:
                    break
            print(mutation.name, found, flush=True)


if __name__ == "__main__":
    find_seeds(sys.argv[1:])
