# SPDX-License-Identifier: MIT
"""The soak lives a seed alike on either interpreter: the same telegrams, faults and pictures."""

import json
import subprocess

import pytest

from tiers import TOP
from tools.soaking import interpreters

INTERPRETERS = "host"

MINUTES = 0.3
SEEDS = (4, 9, 13, 26, 31)  # clean, rough, wild; one drive and several; direct and matrix; polled


def lives(name, deed="soak", length=MINUTES, seeds=SEEDS):
    """What the worker says of each seed."""
    done = subprocess.run(
        interpreters.command(name, (deed, length)),
        input="".join("%d\n" % seed for seed in seeds),
        cwd=TOP,
        env=interpreters.environment(name, TOP / "firmware"),
        capture_output=True,
        text=True,
        check=True,
    )
    said = map(json.loads, done.stdout.splitlines())
    return [life for life in said if "seed" in life]


@pytest.fixture(scope="module")
def on_micropython():
    if not interpreters.is_here("micropython"):
        pytest.skip("there is no MicroPython: tools/test")
    return lives("micropython")


def test_a_seed_is_the_same_life_on_micropython_and_cpython(on_micropython):
    assert lives("cpython") == on_micropython
    assert all(life["exchanges"] > 100 for life in on_micropython)


def test_the_number_of_a_life_tells_one_from_another(on_micropython):
    digests = {life["digest"] for life in on_micropython}
    assert len(digests) == len(SEEDS), digests


def test_the_receiver_is_fed_alike(on_micropython):
    fed = lives("cpython", "fuzz", 20_000, (1, 2))
    assert fed == lives("micropython", "fuzz", 20_000, (1, 2))


def test_every_tenth_seed_stays_on_micropython():
    chosen = [interpreters.of_seed(seed) for seed in range(1, 101)]
    assert chosen.count("micropython") == 10 and chosen.count("cpython") == 90
