# SPDX-License-Identifier: MIT
"""A panel with drives of any family, layout and link: `panel_of("1=g110/0,2=mm440-bop")`."""

from boards.sim.drives.kinds import expected, listed_drives, simulated
from panel_bench import starts, switched_on, wait_until_known


def is_untold(kind):
    """Whether nobody can read its telegram-off time: it has no parameter channel, or no family."""
    return kind.startswith("generic") or "/0" in kind


def panel_of(text, **more):
    """A panel that was switched on a while ago, with these drives as ./tools/panel has them."""
    listed = listed_drives(text)
    settings = dict(more.pop("settings", {}), kinds=expected(listed))
    addresses = [one.address for one in listed]
    world = switched_on(addresses, settings=settings, kinds=simulated(listed), **more)
    world.run(1000)
    wait_until_known(world)
    return world


def start(world, kind, address=1):
    """Press START, and again where the drive does not tell its telegram-off time."""
    world.press("START")
    if is_untold(kind):
        world.run(1500)
        assert world.lcd()[1] == "START=GO STOP=NO", (kind, world.lcd())
        assert starts(world, address) == 0
        world.press("START")
    world.run(4000)
