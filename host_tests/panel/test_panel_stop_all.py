# SPDX-License-Identifier: MIT
"""STOP held for all drives, most of which do not answer: nobody trips for want of telegrams.

A telegram that nobody answers takes 90 ms here. The first STOP to 28 drives takes two seconds and
a half, in which the drives that answer must have theirs.
"""

import main
from boards.sim.world import World
from panel_bench import telegrams, wait_until_known

ADDRESSES = tuple(range(1, 31))


def many_silent(there, p2014=1000):
    """A panel of 30 drives; those that are there trip after P2014 and have slow ramps."""
    world = World(
        main.start,
        addresses=there,
        parameters={2014: p2014, 1121: 50.0},
        settings={"drives": list(ADDRESSES), "reply_timeout_ms": 60},
    )
    world.run(40_000)
    return world


def stopped(there, p2014=1000, later_ms=0):
    """Drive 1 runs, the next one is shown, and STOP is held for all drives. Since when, in us."""
    world = many_silent(there, p2014)
    wait_until_known(world)
    world.run(later_ms)
    world.press("START")
    world.run(6_000)
    assert world.drives[1].state == "running", world.drives[1].report()
    world.press("ADDRESS_UP")
    world.run(1_000)
    world.press("STOP", 4_050)
    return world, world.clock.now_us - 50_000


def longest_gap_ms(world, since_us, address):
    instants = [at_us for at_us, _ in telegrams(world, since_us, address)]
    return max(b - a for a, b in zip(instants, instants[1:])) // 1000


def test_a_drive_that_ramps_down_has_its_telegrams_meanwhile():
    world, since_us = stopped((1, 2))
    world.run(5_000)
    assert longest_gap_ms(world, since_us, 1) < 1000 // 3
    assert world.drives[1].state == "stopping"  # it ramps down, and does not coast
    world.run(10_000)
    for address in (1, 2):
        assert "fault=-" in world.drives[address].report(), world.drives[address].report()
    world.check()


def test_a_drive_at_rest_does_not_trip_for_that_either():
    """Seven of them; for ten, each of which has to hear something every second, there is no room
    beside the STOPs to 20 that are silent."""
    there = ADDRESSES[:7]
    for later_ms in (0, 70, 140):  # at whatever place of the round STOP comes
        world, _ = stopped(there, later_ms=later_ms)
        world.run(15_000)
        for address in there:
            assert "fault=-" in world.drives[address].report(), world.drives[address].report()
        world.check()


def test_all_are_told_once_before_a_silent_one_is_told_again():
    """The two that answer have their telegrams in between: they cost little of the time."""
    world, since_us = stopped((1, 2))
    world.run(3_500)
    silent = [at for at in ADDRESSES if at > 2]
    first_us = {}
    order = []
    for at_us, from_panel, characters in world.wire.log.last(1000):
        if from_panel and at_us >= since_us and characters[2] in silent:
            order.append(characters[2])
            first_us.setdefault(characters[2], at_us)
    assert set(first_us) == set(silent), sorted(first_us)
    assert max(first_us.values()) - since_us < 3_400_000, max(first_us.values()) - since_us
    assert len(set(order[:29])) >= 28, order
