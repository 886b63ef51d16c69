# SPDX-License-Identifier: MIT
"""STOP on every page of the menu, found by walking it: see `walk_bench`.

The other keys: test_menu_keys.py.
"""

import os

import on_demand
from panel_bench import OFF1, row_2, settled, starts, telegrams
from uss.master import OFF
from walk_bench import is_parameter, running, silent, standing, wait_until_it_runs, warned, ways

MOTION_KEYS = ("START", "REVERSE", "JOG_RIGHT", "JOG_LEFT")
NO_LISTS = ("__init__", "engine", "words", "diagnosis")  # modules of the menu
LISTS_BESIDE = (
    "lookup.groups", "lookup.memory", "lookup.what", "commission.overview", "commission.course",
)  # fmt: skip
STOP_MS = 100
LISTEN_MS = 200  # longer, where the line was left: the panel listens first


def has_left(world):
    """Whether the line is left to others: no motor of this panel can run there."""
    return world.app.bus.phase == OFF


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
    after = starts(world), world.drives[1].hz()
    assert after == before, (where, before, after, world.lcd())


def press_stop(world, where):
    """OFF1 is on the wire at once, and the display goes on telling where one is."""
    pressed_us = world.clock.now_us
    stop_ms = STOP_MS + LISTEN_MS if has_left(world) else STOP_MS
    was_question = row_2(world).endswith("PARAM=NO")
    was_parameter = is_parameter(where[1][1])  # a refusal may hide it by now
    world.down("STOP")
    world.run(500)  # said from 300 ms on, and then drawn and shown
    settled(world)  # what is being written to the display can be read a moment later
    assert world.reads("STOP, HOLD: OFF3"), (where, world.lcd())
    world.up("STOP")
    offs = [at_us for at_us, stw in telegrams(world, pressed_us, 1) if stw == OFF1]
    assert offs and offs[0] - pressed_us < stop_ms * 1000, where
    world.run(400)
    assert world.drives[1].hz() == 0 and world.drives[1].state != "running", where
    if was_question:  # which STOP answers with no
        assert row_2(world)[-2:] == "A1", (where, world.lcd())
    elif was_parameter:
        for _ in range(40):  # what the drive has refused is said for three seconds
            if is_parameter(row_2(world)):
                break
            world.run(100)
        assert is_parameter(row_2(world)), (where, world.lcd())
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
        places = {running: 0, standing: 0, silent: 0, warned: 0}
        parameters = 0
        for begin, way, here, world in ways():
            places[begin] += 1
            is_line_left = has_left(world)
            if begin in (running, warned):
                run(world)
            parameters += is_parameter(here[1])
            if here[1].startswith(">"):  # any key answers a question
                press_motion_keys(world, (way, here))
            if begin is not silent and not is_line_left:
                run(world)
            press_stop(world, (way, here))
    finally:
        on_demand.load = load
    assert places[running] > 70 and places[standing] > 2 and places[silent] > 3, places
    assert places[warned] > 5 and parameters > 1, (places, parameters)
    for folder in ("", "/diagnosis"):
        for name in os.listdir("firmware/panel/menu" + folder):
            name = name.split(".")[0]
            if name not in NO_LISTS and not name.startswith("__"):
                module = "panel.menu" + folder.replace("/", ".") + "." + name
                assert module in loaded, "nobody gets to the list %s" % name
    for name in LISTS_BESIDE:
        assert "panel." + name in loaded, "nobody gets to the list %s" % name
