# SPDX-License-Identifier: MIT
"""The panel on the virtual board, for pictures of what it shows. Time is virtual, and each run is
like any other.

    world = panel()                             # its home page, two drives that stand
    happen(world, "fault 1 F0001; wait 2000")   # commands of the script language
    press(world, "PARAM held, DOWN x3, SET")    # keys as the operator's manual writes them
    world.lcd()                                 # ("BAUD 19200  1/16", ...
"""

import main
from boards.sim.drives.kinds import listed_drives, simulated
from boards.sim.script import Script
from boards.sim.world import World

DRIVES = "1=mm440,2=g110"
SETTINGS = {"kinds": {"1": "mm440", "2": "g110"}}
READY_MS = 4_000  # the splash is over, and both drives have told all that the panel asks for
HELD_MS = 1_400  # PARAM opens the menu after a second
REST_MS = 200  # between keys
SETTLED_MS = 1_500  # until the display shows what came of them


def panel(keys="direct", ms=READY_MS):
    """keys: how they are wired, see `World`. ms: since power-on."""
    drives = listed_drives(DRIVES)
    addresses = tuple(drive.address for drive in drives)
    world = World(main.start, addresses, kinds=simulated(drives), settings=SETTINGS, keys=keys)
    world.run(ms)
    return world


def happen(world, commands):
    """Commands of the script language, with ";" between them."""
    Script(world, show=lambda line: None).run(commands.split(";"))


def press(world, keys, settled_ms=SETTLED_MS):
    """Keys with commas between them: `KEY`, `KEY x3`, `KEY held`, or `5 s` to wait.
    `KEY kept down`: it is still down in the end.
    """
    for part in keys.split(", "):
        name, _, how = part.partition(" ")
        if how == "s":
            world.run(int(float(name) * 1000))
        elif how == "kept down":
            world.down(name)
        elif how == "held":
            world.down(name)
            world.run(HELD_MS)
            world.up(name)
            world.run(REST_MS)
        else:
            for _ in range(int(how[1:]) if how else 1):
                world.press(name)
                world.run(REST_MS)
    world.run(settled_ms)
