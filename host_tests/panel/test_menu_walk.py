# SPDX-License-Identifier: MIT
"""STOP on every page of the menu, found by walking it: no list of pages stands here.

The walk begins where a held PARAM leads, and knows what a person sees: an entry behind ">", its
place in a list (3/7), a question. DOWN and SET lead on. Each place is reached anew, with the motor
running, or, where the panel refuses that, standing.
"""

import os

import main
import on_demand
from boards.sim.world import World
from panel_bench import OFF1, row_1, row_2, settled, starts, telegrams, wait_until_known

INTERPRETERS = "unix64 unix32"

MOTION_KEYS = ("START", "REVERSE", "JOG_RIGHT", "JOG_LEFT")
NO_LISTS = ("__init__", "engine", "words")  # modules of the menu
STOP_MS = 100
DEEP = 40  # keys: no way is longer
QUICK = {1120: 0.1, 1121: 0.1, 2014: 2000}


def standing():
    world = World(main.start, (1, 2), parameters=QUICK, settings={"unsupervised": [2]})
    world.run(500)
    wait_until_known(world)
    return world


def running():
    world = standing()
    world.press("START")
    wait_until_it_runs(world)
    return world


def silent():
    """The drive shown has been away since it stood: the menu tells what to check."""
    world = standing()
    world.drives[1].unplug()
    world.run(1500)
    assert row_2(world) == "NO CONTACT   A1", world.lcd()
    return world


def wait_until_it_runs(world):
    for _ in range(30):
        if world.drives[1].state == "running" and abs(world.drives[1].hz() - 10) < 0.01:
            return
        world.run(50)
    raise AssertionError(world.lcd())


def go(begin, way):
    """A world whose menu was walked this way."""
    world = begin()
    world.down("PARAM")
    world.run(1100)
    world.up("PARAM")
    world.run(100)
    for key in way:
        walk(world, key)
    world.run(100)
    return world


def walk(world, key):
    world.press(key, 40)
    world.run(20)


def place(world):
    """(number of entries or None, row 2) of a place of the menu; None if it is none.

    Row 1 may be busy with an announcement: then the number is seen a little later.
    """
    row, count = row_2(world), None
    if row.startswith(">"):
        for _ in range(20):
            if "HOLD=ALL" not in settled(world)[0]:
                break
            world.run(100)
        tail = row_1(world)[11:].strip().split("/")
        if len(tail) == 2 and tail[1].isdigit():
            count = int(tail[1])
    elif not row.endswith("PARAM=NO"):
        return None
    return count, row_2(world)


def ways():
    """Each place once, as (begin, way, place, world that is there).

    The world comes back with the menu as it was: so it can walk on.
    """
    seen, open_ways = set(), [(running, ()), (silent, ())]
    while open_ways:
        begin, way = open_ways.pop(0)
        world = go(begin, way)
        while True:
            here = place(world)
            if here is None and begin is running:  # refused, perhaps since the motor runs
                open_ways.append((standing, way))
            if here is None or here in seen:
                break
            seen.add(here)
            yield begin, way, here, world
            assert len(way) < DEEP, way
            count, row = here
            if not row.startswith(">"):
                break
            open_ways.append((begin, way + ("SET",)))
            if not count and way[-1:] != ("SET",):  # a value is changed once
                break
            way += ("DOWN",)
            walk(world, "DOWN")


def run(world):
    """The motor runs, also where no key can do that."""
    if world.drives[1].state != "running":
        world.app.panel.selected.start()
        wait_until_it_runs(world)


def press_motion_keys(world, where):
    """None of them starts, reverses or jogs anything."""
    before = starts(world), world.drives[1].hz()
    for key in MOTION_KEYS:
        world.press(key, 60)
        world.run(60)
    assert (starts(world), world.drives[1].hz()) == before, (where, world.lcd())


def press_stop(world, where):
    """OFF1 is on the wire at once, and the display goes on telling where one is."""
    pressed_us = world.clock.now_us
    was_question = not row_2(world).startswith(">")
    world.down("STOP")
    world.run(500)  # said from 300 ms on, and then drawn and shown
    assert world.reads("STOP, HOLD: OFF3"), (where, world.lcd())
    world.up("STOP")
    offs = [at_us for at_us, stw in telegrams(world, pressed_us, 1) if stw == OFF1]
    assert offs and offs[0] - pressed_us < STOP_MS * 1000, where
    world.run(400)
    assert world.drives[1].hz() == 0 and world.drives[1].state != "running", where
    if was_question:  # which STOP answers with no
        assert row_2(world)[-2:] == "A1", (where, world.lcd())
    else:
        assert row_2(world).startswith(">"), (where, world.lcd())
    world.check()


def noting(loaded):
    """`on_demand.load`, which notes what it loads."""
    load = on_demand.load

    def load_and_note(name):
        loaded.add(name)
        return load(name)

    return load_and_note


def test_stop_acts_in_every_place_of_the_menu_and_nothing_starts_there():
    loaded, load = set(), on_demand.load
    on_demand.load = noting(loaded)
    try:
        places = {running: 0, standing: 0, silent: 0}
        for begin, way, here, world in ways():
            places[begin] += 1
            if begin is running:
                run(world)
            if here[1].startswith(">"):  # any key answers a question
                press_motion_keys(world, (way, here))
            if begin is not silent:
                run(world)
            press_stop(world, (way, here))
    finally:
        on_demand.load = load
    assert places[running] > 70 and places[standing] > 2 and places[silent] > 3, places
    for name in os.listdir("firmware/panel/menu"):
        name = name.split(".")[0]
        if name not in NO_LISTS and not name.startswith("__"):
            assert "panel.menu." + name in loaded, "nobody gets to the list %s" % name
