# SPDX-License-Identifier: MIT
"""What is wrong with a drive without contact stands on the display as what it is.

Silence, noise, another length, another address, a wrong check have each a cure of its own.
"""

from panel_bench import panel, row_2
from spoilt_bench import TROUBLES, spoil

INTERPRETERS = "unix64 unix32"


def test_a_drive_as_it_is_delivered_answers_in_another_length():
    """P2013 = 127, and every telegram is answered: nobody looks for a broken wire."""
    world = panel(parameters={2013: 127})
    seen = set()
    for _ in range(60):
        world.run(100)
        seen.add(row_2(world))
    assert "OTHER LENGTH A1" in seen and not any("NO CONTACT" in row for row in seen), seen
    world.press("START")
    assert not world.app.bus.turns.drives[0].is_on()
    world.drives[1].write(2013, 0, 4)
    world.run(6_000)
    assert row_2(world) == "READY        A1", row_2(world)


def test_each_trouble_has_its_words_on_the_display():
    for how, _, words, _ in TROUBLES:
        world = panel()
        world.run(1_000)
        assert row_2(world) == "READY        A1"
        spoil(world.wire, world.drives[1], how)
        world.run(2_500)
        for _ in range(20):
            world.run(100)
            assert row_2(world) == "%-12s A1" % words, (how.__name__, row_2(world))
