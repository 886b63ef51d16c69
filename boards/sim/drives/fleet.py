# SPDX-License-Identifier: MIT
"""A line full of drives of many families and layouts: who they are, as data.

    drives = {
        address: Drive(clock, wire, address, **kind)
        for address, kind in kinds(31, wire.start_interval_us).items()
    }
    World(main.start, addresses=range(31), kinds=kinds(31, 1_146))

Every address has the same kind, and the same time to its reply, each time.
"""

# Lower layers first: an import inside an import inside an import takes stack.
from boards.sim.drives import parameters as drive_parameters  # noqa: F401
from boards.sim.drives.families import g110, g120, generic, mm3, mm420, mm440, v20

# Family, and what is set besides its commissioning. The layouts, PKW + PZD words, in their order:
# 4+2, 4+4, 3+2, 0+2, variable+2 (of three families), variable+4, 3+2, 4+8, variable+16, 4+2, 0+6.
KINDS = (
    (mm420, {}),
    (mm440, {2012: 4}),
    (mm3, {}),
    (g110, {2013: 0}),
    (g110, {}),
    (v20, {2014: 0}),
    (g120, {}),
    (mm440, {2013: 127, 2012: 4}),
    (mm420, {2013: 3}),
    (mm440, {2012: 8}),
    (generic, {2013: 127, 2012: 16}),
    (v20, {2013: 4, 2014: 0}),
    (generic, {2013: 0, 2012: 6}),
)

SLOWEST_US = 8_000  # after the fastest


def kinds(count, fastest_us, first=0):
    """What `Drive` is given at the addresses from `first` on: {address: keyword arguments}.

    fastest_us: the shortest time to a reply, two characters at least. None is supervised.
    """
    found = {}
    for i in range(count):
        family, parameters = KINDS[i % len(KINDS)]
        delay_us = fastest_us + i * 5_303 % SLOWEST_US
        found[first + i] = {
            "family": family,
            "parameters": parameters,
            "reply_delay_us": delay_us,
        }
    return found
