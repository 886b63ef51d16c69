# SPDX-License-Identifier: MIT
"""The panel on the virtual board, for pictures of what it shows. Time is virtual, and each run is
like any other.

    world = panel()                         # its home page, two drives that stand
    do(world, "press START\nwait 3000")
    world.lcd()                             # ("S: 10.0 F: 10.00", "RUNNING      A1 ")
"""

import main
from boards.sim.drives.kinds import listed_drives, simulated
from boards.sim.script import Script
from boards.sim.world import World

DRIVES = "1=mm440,2=g110"
SETTINGS = {"kinds": {"1": "mm440", "2": "g110"}}
READY_MS = 4_000  # the splash is over, and both drives have told all that the panel asks for


def panel(keys="direct"):
    """keys: how they are wired, see `World`."""
    drives = listed_drives(DRIVES)
    addresses = tuple(drive.address for drive in drives)
    world = World(main.start, addresses, kinds=simulated(drives), settings=SETTINGS, keys=keys)
    world.run(READY_MS)
    return world


def do(world, script):
    """Commands of the script language. AssertionError: a rule of line or display was broken."""
    Script(world).run(script.split("\n"))
    world.check()
