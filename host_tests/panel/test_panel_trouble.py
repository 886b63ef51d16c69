# SPDX-License-Identifier: MIT
"""What is wrong with a drive without contact stands on the display as what it is.

Silence, noise, another length, another address, a wrong check have each a cure of its own.
"""

from panel_bench import panel, row_1, row_2, starts
from spoilt_bench import TROUBLES, spoil


def test_a_drive_whose_telegrams_have_another_length_is_found_and_not_started():
    """P2013 = 127 as it is delivered, and every telegram is answered: no wire is broken."""
    world = panel(parameters={2013: 127})
    seen = set()
    for _ in range(60):
        world.run(100)
        seen.add(row_2(world))
    assert not any("NO CONTACT" in row for row in seen), seen
    assert row_2(world) == "READY        A1" and starts(world) == 0
    assert world.app.settings.kinds == {"1": "mm420/127"}
    for pkw_words, text in ((4, "F:"), (3, "%F:"), (0, "%F:"), (127, "F:")):
        world.drives[1].write(2013, 0, pkw_words)
        world.run(8_000)
        assert row_2(world) == "READY        A1" and text in row_1(world), (pkw_words, world.lcd())
    assert starts(world) == 0
    world.check()


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
