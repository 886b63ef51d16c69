# SPDX-License-Identifier: MIT
"""An emulated Pico on a line with drives of several kinds."""

from boards.sim.drives.kinds import expected, listed_drives, simulated
from tools.emulator.world import PicoWorld

INTERPRETERS = "pico"


def test_its_settings_say_which_drives_stand_on_its_line():
    listed = listed_drives("1,2=g110,3=v20/4,8=mm420/factory")
    world = PicoWorld(
        addresses=[one.address for one in listed],
        settings={"kinds": expected(listed)},
        kinds=simulated(listed),
    )
    stored = world.settings()
    assert stored["drives"] == [1, 2, 3]
    assert stored["kinds"] == {"2": "g110", "3": "v20/4"}
    assert [world.drives[n].layout for n in (1, 2, 3)] == [(4, 2), (127, 2), (4, 2)]
    world.run(3_000)
    assert world.drives[1].slave.counters()[0] > 10
    noise = world.drives[8].slave.counters()
    assert noise[0] == 0 and noise[2] > 0
    world.check()
