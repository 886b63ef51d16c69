# SPDX-License-Identifier: MIT
"""The menu, found by walking it: no list of pages stands here.

The walk begins where a held PARAM leads, and knows what a person sees: an entry behind ">", its
place in a list (3/7), a question, a parameter. DOWN and SET lead on. Each place is reached anew,
with the motor running, or, where the panel refuses that, standing.
"""

import main
from boards.sim.world import World
from panel_bench import row_1, row_2, settled, wait_until_known
from sets_bench import made

DEEP = 40  # keys: no way is longer
ON_ITS_WAY = ("", ">...")
QUICK = {1120: 0.1, 1121: 0.1, 2014: 2000}
# How a panel with eight keys has the functions of the fourteen.
COMPACT = {
    "PARAM": ("P",), "SET": ("FN", "P"), "EDIT": ("FN", "FN", "P"), "NEXT": ("FN", "UP"),
    "PREVIOUS": ("FN", "DOWN"), "ADDRESS_UP": ("FN", "FN", "UP"),
    "ADDRESS_DOWN": ("FN", "FN", "DOWN"), "JOG_RIGHT": ("JOG",), "JOG_LEFT": ("JOG",),
}  # fmt: skip


def standing(keys="direct"):
    world = World(main.start, (1, 2), parameters=QUICK, settings={"unsupervised": [2]}, keys=keys)
    world.flash.files["1.set"] = made([(1120, 0, b"Float", b"3F800000")], family=b"mm420")
    world.run(500)
    wait_until_known(world)
    return world


def standing_compact():
    return standing("compact")


def running(keys="direct"):
    world = standing(keys)
    world.press("START")
    wait_until_it_runs(world)
    return world


def running_compact():
    return running("compact")


def silent():
    """The drive shown has been away since it stood: the menu tells what to check."""
    world = standing()
    world.drives[1].unplug()
    world.run(1500)
    assert row_2(world) == "NO CONTACT   A1", world.lcd()
    return world


def warned():
    """The drive shown has a warning: the menu tells what it means."""
    world = running()
    world.drives[1].warn(600)
    world.run(1500)
    return world


def wait_until_it_runs(world):
    before = None
    for _ in range(30):
        hz = world.drives[1].hz()
        if world.drives[1].state == "running" and abs(hz - 10) < 0.01 and hz == before:
            return
        before = hz
        world.run(50)
    raise AssertionError(world.lcd())


def go(begin, way):
    """A world whose menu was walked this way."""
    world = begin()
    world.press(key_of(world, "PARAM")[0], 1100)
    world.run(100)
    for key in way:
        walk(world, key)
    world.run(100)
    return world


def walk(world, key):
    """Use one of the fourteen."""
    for one in key_of(world, key):
        world.press(one, 40)
        world.run(20)


def key_of(world, key):
    """What is pressed for it, one after the other."""
    return COMPACT.get(key, (key,)) if "FN" in world.keypad.names else (key,)


def place(world):
    """(number of entries or None, row 2) of a place of the menu; None if it is none.

    Row 1 may be busy with an announcement: then the number is seen a little later.
    """
    for _ in range(40):  # it may be on its way
        if settled(world)[1].rstrip() not in ON_ITS_WAY:
            break
        world.run(50)
    row, count = row_2(world), None
    if row.startswith(">"):
        for _ in range(20):
            if "HOLD=ALL" not in settled(world)[0]:
                break
            world.run(100)
        tail = row_1(world)[11:].strip().split("/")
        if len(tail) == 2 and tail[1].isdigit():
            count = int(tail[1])
    elif not row.endswith("PARAM=NO") and not is_parameter(row):
        return None
    # What is counted or measured is another row each time: there the title tells.
    title = row_1(world)
    moves = count and title[:3] in ("A1 ", "A2 ", "BUS", "HEA") and title[3:11].strip()
    return count, ">" + title if moves else row_2(world)


def is_parameter(row):
    """P1120[0]  10.00s"""
    return row[:1] in ("P", "r") and row[1:5].isdigit()


def page_of(world):
    """What a place is a place of: its title without numbers, or what is asked."""
    row = row_2(world)
    if is_parameter(row):
        return "parameter"
    title = row if row.endswith("PARAM=NO") else row_1(world)[:11]
    return "".join([letter for letter in title if not letter.isdigit()]).strip()


def ways(begins=(running, silent, warned)):
    """Each place once, as (begin, way, place, world that is there). begins: how worlds begin.

    The world comes back with the menu as it was: so it can walk on.
    """
    seen, open_ways = set(), [(begin, ()) for begin in begins]
    while open_ways:
        begin, way = open_ways.pop(0)
        world = go(begin, way)
        while True:
            here = place(world)
            if here is None and begin in (running, warned):  # refused, perhaps since it runs
                open_ways.append((standing, way))
            if here is None or here in seen:
                break
            seen.add(here)
            yield begin, way, here, world
            assert len(way) < DEEP, way
            count, row = here
            if not row.startswith(">"):
                break
            if "/" not in row or way[-1:] == ("SET",):  # of many that only tell, the first one
                open_ways.append((begin, way + ("SET",)))
            if not count and way[-1:] != ("SET",):  # a value is changed once
                break
            way += ("DOWN",)
            walk(world, "DOWN")
