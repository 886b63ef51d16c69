"""A short soak: some seeds, some seconds each. `./tools/soak` is the long one.

The whole panel with an operator who presses random keys, drives, faults of line, drives and panel;
a judge who sees keys, line and display, and asks the firmware nothing (tools/soaking/rules.py).
"""

from tools.soaking.fuzz import fuzz
from tools.soaking.rules import RULES, Broken
from tools.soaking.soak import Soak
from tools.soaking.story import story

NOT_TRACED = "test_every_rule_holds test_the_receiver_stands_anything"

SEEDS = (1, 2, 3, 6, 9, 11)  # clean, rough, wild; one drive and several; direct and matrix; polled
SECONDS = 25


def test_every_rule_holds():
    for seed in SEEDS:
        soak = Soak(seed)
        soak.run(SECONDS)
        assert soak.broken is None, "\n".join(story(soak))
        assert soak.judge.exchanges > 200


def test_a_start_that_nobody_pressed_is_noticed():
    soak = Soak(13, drives=1)
    soak.hand.run(1_500)
    soak.world.app.bus.drives[0].start(0x1000)  # behind the back of whoever judges
    try:
        soak.hand.run(500)
    except Broken as broken:
        soak.broken = broken
    assert soak.broken is not None and soak.broken.args[0] == "START", soak.broken
    told = list(story(soak))
    assert RULES["START"] in told[0], told
    assert [line for line in told if "A%d ON" % soak.plan.addresses[0] in line], told


def test_a_seed_repeats_to_the_telegram():
    one, other = Soak(7), Soak(7)
    one.run(6)
    other.run(6)
    assert one.world.wire.log.last(50) == other.world.wire.log.last(50)
    assert one.hand.deeds == other.hand.deeds


def test_the_receiver_stands_anything():
    for seed in range(1, 4):
        fed = fuzz(8_000, seed)
        assert fed["broken"] is None, fed
        assert fed["good"] > 20, fed
