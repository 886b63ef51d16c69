# SPDX-License-Identifier: MIT
"""What the tests of the panel share: a panel on the virtual board, hands and eyes for it.

The same firmware as on the chip, in virtual time.
"""

import main
from boards.sim.world import World


def panel(**options):
    """A panel that was switched on a second ago."""
    world = World(main.start, **options)
    world.run(1000)
    return world


def running(**options):
    """A panel whose drive 1 has been started and has reached its setpoint."""
    world = panel(**options)
    world.press("START")
    world.run(4000)
    assert world.drives[1].state == "running", world.drives[1].report()
    return world


def all_running(addresses):
    """A panel whose drives have all been started and have reached their setpoints."""
    world = panel(addresses=addresses)
    for _ in addresses:
        world.press("START")
        world.press("ADDRESS_UP")
        world.run(200)
    world.run(4000)
    for drive in world.drives.values():
        assert drive.state == "running", drive.report()
    return world


def unsupervised(*addresses):
    """Options of a panel whose drives run on without telegrams, P2014 = 0, as was accepted."""
    addresses = addresses or (1,)
    return {
        "addresses": addresses,
        "parameters": {2014: 0},
        "settings": {"unsupervised": list(addresses)},
    }


def row_1(world):
    return world.lcd()[0]


def row_2(world):
    return world.lcd()[1].rstrip()


def settled_row_2(world):
    """Row 2 as a person reads it: a picture that changes needs some steps of the main loop."""
    seen = None
    while seen != row_2(world):
        seen = row_2(world)
        world.run(10)
    return seen


def starts(world, address=1):
    """How often the motor has been set going."""
    return int(world.drives[address].report().split("starts=")[1].split()[0])


def telegrams(world, since_us, address=None):
    """Telegrams of the panel since an instant, as (instant, control word)."""
    sent = []
    for at_us, from_panel, characters in world.wire.log.last(1000):
        if len(characters) < 16:
            continue  # cut off by a reset
        if from_panel and at_us >= since_us and address in (None, characters[2]):
            sent.append((at_us, characters[11] << 8 | characters[12]))
    return sent


ON, OFF1 = 0x047F, 0x047E
ERROR = ValueError("on purpose")  # made beforehand: the heap is locked in an interrupt
