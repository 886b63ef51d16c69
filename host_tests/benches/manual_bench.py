# SPDX-License-Identifier: MIT
"""The screens of the panel's manuals, made by running the panel.

A block of the manual that has keys in its first line, and below them one display or several:

    PARAM held: DOWN: SET
    +------------------+   +------------------+
    | MENU        1/13 |   | MENU        2/13 |
    | >DRIVES          |   | >ANY ADDRESS     |
    +------------------+   +------------------+

It begins at the home page of a panel with two drives that stand. Each part between the colons is
pressed, and what the display says then is its picture, from left to right. A part is keys with
commas between them, `KEY held`, `KEY x3`, or `5 s`; or it is a row of SITUATIONS, one of which may
begin with another panel.

A block that begins with MENU is the tree of the menu, as such a panel has it.
"""

import main
from boards.sim.drives.kinds import listed_drives, simulated
from boards.sim.world import World
from lookup_bench import entries, go_to, hold
from panel_bench import wait_until_known
from tools.pictures import running

EDGE = "+------------------+"
GAP = "   "
SETTLED_MS = 600
TREE = "MENU"
LONG_MAX, LONG = 20, 4  # of a list with more than 20 entries the first 4
KEYS = (
    "START", "STOP", "REVERSE", "JOG_RIGHT", "JOG_LEFT", "UP", "DOWN", "ADDRESS_UP",
    "ADDRESS_DOWN", "PARAM", "EDIT", "NEXT", "PREVIOUS", "SET",
)  # fmt: skip


def two_drives():
    listed = "1=mm440,2=g110"
    stored = {"kinds": {"1": "mm440", "2": "g110"}}
    world = World(main.start, (1, 2), kinds=simulated(listed_drives(listed)), settings=stored)
    world.run(1_000)
    wait_until_known(world)
    return world


def it_trips(world):
    world.drives[1].fault(1)
    world.run(2_000)


def it_warns(world):
    world.drives[1].warn(501)
    world.run(2_500)


def it_is_unplugged(world):
    world.drives[1].unplug()
    world.run(2_500)


def as_delivered(_world):
    """Another panel: its only drive is one that nobody has set up."""
    kinds = simulated(listed_drives("1=mm420/factory"))
    world = World(main.start, (1,), kinds=kinds, settings={"drives": [1]})
    world.run(7_000)
    return world


SITUATIONS = {
    "A MICROMASTER 420 as delivered": as_delivered,
    "Drive 1 trips": it_trips,
    "Drive 1 warns": it_warns,
    "Nobody answers at address 1": it_is_unplugged,
}


def blocks(text):
    """(place of the first line, its parts) of each block of screens."""
    lines = text.split("\n")
    for place, line in enumerate(lines[:-4]):
        if line[:4] == "    " and lines[place + 1][4:].startswith(EDGE):
            parts = [part.strip() for part in line.strip().split(": ")]
            if all([_is_known(part) for part in parts]):
                yield place, parts


def _is_known(part):
    if part in SITUATIONS:
        return True
    for key in part.split(", "):
        words = key.split()
        if not words or words[0] not in KEYS and words[-1] != "s":
            return False
    return True


def do(world, part):
    """A part of the first line; the panel that it is about from now on."""
    if part in SITUATIONS:
        return SITUATIONS[part](world) or world
    running.press(world, part, SETTLED_MS)
    return world


def picture(displays):
    """Displays beside each other, as lines."""
    rows = [EDGE] * len(displays)
    lines = [GAP.join(rows)]
    for row in range(2):
        lines.append(GAP.join(["| %s |" % shown[row] for shown in displays]))
    return lines + lines[:1]


def tree():
    """The lines of the menu: its lists and what is in them, and what is in a drive's."""
    world = two_drives()
    hold(world, "PARAM", running.HELD_MS)
    lines = [TREE]
    for _, entry in entries(world):
        lines.append("  " + entry)
        inside = _inside(entry)
        for place, below in enumerate(inside):
            if place == LONG and len(inside) > LONG_MAX:
                lines.append("    and so on, %d in all" % len(inside))
                break
            lines.append("    " + below)
            if below.startswith("A1  R"):
                lines += ["      " + one for one in _inside(entry, below)]
    return lines


def _inside(*way):
    """The entries of a list, to which these entries lead."""
    world = two_drives()
    go_to(world, *way)
    world.run(1500)
    found = []
    for _, entry in entries(world):
        if entry not in found:  # eight times NO FAULT
            found.append(entry)
    return found


def made(text):
    """The manual with the screens that the panel shows now, and how many there are."""
    lines = text.split("\n")
    if "    " + TREE in lines:
        begin = lines.index("    " + TREE)
        lines[begin : lines.index("", begin)] = ["    " + line for line in tree()]
    text = "\n".join(lines)
    count = 0
    for place, parts in blocks(text):
        world, displays = two_drives(), []
        for part in parts:
            world = do(world, part)
            displays.append(world.lcd())
        count += len(displays)
        lines[place + 1 : place + 5] = ["    " + line for line in picture(displays)]
    return "\n".join(lines), count
