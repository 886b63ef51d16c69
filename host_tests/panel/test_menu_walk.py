# SPDX-License-Identifier: MIT
"""Every key on every page of the menu, found by walking it: see `walk_bench`.

STOP acts in every place. No key starts a motor there, none but STOP stops one or changes its
speed, with fourteen keys and with eight, and wherever they have led, STOP sends OFF1 to the drive
that is shown. What a key does on a page is told by the test of that page.
"""

import os

import on_demand
from panel_bench import OFF1, row_1, row_2, settled, starts, telegrams
from uss.master import LISTENING, OFF
from walk_bench import (
    go,
    is_parameter,
    page_of,
    running,
    running_compact,
    silent,
    standing,
    standing_compact,
    wait_until_it_runs,
    walk,
    warned,
    ways,
)  # fmt: skip

MOTION_KEYS = ("START", "REVERSE", "JOG_RIGHT", "JOG_LEFT")
# Those that lead away come last.
OTHER_KEYS = (
    "UP", "DOWN", "NEXT", "PREVIOUS", "EDIT", "ADDRESS_UP", "ADDRESS_DOWN", "SET", "PARAM",
)  # fmt: skip
PAGES = 25  # there are at the least
PLACES_OF_A_PAGE = 2  # in which every key is tried
NO_LISTS = ("__init__", "engine", "words", "diagnosis")  # modules of the menu
LISTS_BESIDE = (
    "lookup.groups", "lookup.memory", "lookup.what", "commission.overview", "commission.course",
)  # fmt: skip
STOP_MS = 100
LISTEN_MS = 200  # longer, where the line was left: the panel listens first
BEGINS_ANEW_MS = 5_000


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


class Walk:
    """What a walk through the menu has found; it takes a while, and is done once."""

    def __init__(self):
        self.places = {running: 0, standing: 0, silent: 0, warned: 0}
        self.parameters = 0
        self.counts = {}  # page -> places of it, with a motor that can run
        self.tried = []  # (begin, way, place) of some of each page

    def note(self, begin, way, here, world):
        self.places[begin] += 1
        self.parameters += is_parameter(here[1])
        if begin not in (running, warned):
            return
        page = page_of(world)
        self.counts[page] = self.counts.get(page, 0) + 1
        if self.counts[page] <= PLACES_OF_A_PAGE:
            self.tried.append((begin, way, here))
            if begin is running:
                self.tried.append((standing, way, here))


done = []


def walked():
    if not done:
        walk_through()
    return done[0]


def walk_through():
    """Through all of the menu; in each place STOP acts, and no motion key does."""
    found = Walk()
    for begin, way, here, world in ways():
        found.note(begin, way, here, world)
        is_line_left = has_left(world)
        if begin in (running, warned):
            run(world)
        if here[1].startswith(">"):  # any key answers a question
            press_motion_keys(world, (way, here))
        if begin is not silent and not is_line_left:
            run(world)
        press_stop(world, (way, here))
    done.append(found)


def test_stop_acts_in_every_place_of_the_menu_and_nothing_starts_there():
    loaded, load = set(), on_demand.load
    on_demand.load = noting(loaded)
    try:
        walk_through()
    finally:
        on_demand.load = load
    places = walked().places
    assert places[running] > 70 and places[standing] > 2 and places[silent] > 3, places
    assert places[warned] > 5 and walked().parameters > 1, (places, walked().parameters)
    for folder in ("", "/diagnosis"):
        for name in os.listdir("firmware/panel/menu" + folder):
            name = name.split(".")[0]
            if name not in NO_LISTS and not name.startswith("__"):
                module = "panel.menu" + folder.replace("/", ".") + "." + name
                assert module in loaded, "nobody gets to the list %s" % name
    for name in LISTS_BESIDE:
        assert "panel." + name in loaded, "nobody gets to the list %s" % name


def test_a_walk_finds_the_pages():
    assert len(walked().counts) >= PAGES, sorted(walked().counts)
    assert len(walked().tried) > 60


def stops_what_is_shown(world, where):
    """STOP, wherever the keys have led: OFF1 to the drive shown."""
    if world.resets:  # THE PANEL BEGINS ANEW, since somebody has changed what that needs
        world.run(BEGINS_ANEW_MS)
    is_line_left = world.app.bus.phase in (OFF, LISTENING)
    pressed_us, address = world.clock.now_us, world.selected()
    world.press("STOP", 300)
    world.run(200)
    stw = bytes([OFF1 >> 8, OFF1 & 0xFF])  # wherever it stands: the layout may be another one now
    offs = [
        at_us
        for at_us, from_panel, characters in world.wire.log.last(100)
        if from_panel and at_us >= pressed_us and characters[2] == address
        if stw in bytes(characters[3:])
    ]
    within_us = 1000 * (STOP_MS + (LISTEN_MS if is_line_left else 0))
    assert offs and offs[0] - pressed_us < within_us, (where, world.lcd())


def starts_of(world):
    return [starts(world, address) for address in sorted(world.drives)]


def press_every_key(begin, way, here):
    world = go(begin, way)
    runs = world.drives[1].state == "running"
    before = starts_of(world)
    keys = OTHER_KEYS
    if here[1].startswith(">"):  # any key answers a question, and on a parameter's page START acts
        keys = MOTION_KEYS + OTHER_KEYS
    for key in keys:
        walk(world, key)
        world.run(80)
        where = (begin, way, here, key)
        assert starts_of(world) == before, (where, world.lcd())
        if runs:
            assert abs(world.drives[1].hz() - 10) < 0.5, (where, world.lcd())
    stops_what_is_shown(world, where)
    world.check()


def press_every_key_everywhere(begin, really):
    """In the places where a panel came to that began so; really: how this one begins."""
    places = [(way, here) for one, way, here in walked().tried if one is begin]
    assert len(places) > 30, len(places)
    for way, here in places:
        press_every_key(really, way, here)


def test_no_key_in_any_list_moves_a_motor_that_stands():
    press_every_key_everywhere(standing, standing)


def test_no_key_in_any_list_but_stop_does_anything_to_a_motor_that_runs():
    press_every_key_everywhere(running, running)


def test_so_it_is_with_eight_keys_while_the_motor_stands():
    press_every_key_everywhere(standing, standing_compact)


def test_so_it_is_with_eight_keys_while_the_motor_runs():
    press_every_key_everywhere(running, running_compact)


def test_the_keys_of_a_list():
    """UP and DOWN walk, and so do NEXT and PREVIOUS, round and round; SET opens; PARAM goes back;
    PARAM held, EDIT and the address keys do nothing; the motor keys say so.
    """
    world = go(standing, ())
    assert row_1(world) == "MENU        1/13", world.lcd()
    for key, place in (
        ("DOWN", "2/13"), ("NEXT", "3/13"), ("UP", "2/13"), ("PREVIOUS", "1/13"), ("UP", "13/13"),
        ("DOWN", "1/13"), ("EDIT", "1/13"), ("ADDRESS_UP", "1/13"), ("ADDRESS_DOWN", "1/13"),
    ):  # fmt: skip
        walk(world, key)
        world.run(100)
        assert row_1(world)[11:].strip() == place, (key, world.lcd())
    for key in MOTION_KEYS:
        walk(world, key)
        world.run(100)
        assert world.lcd()[1] == ">NO: IN THE MENU", (key, world.lcd())
    walk(world, "SET")
    world.run(200)
    assert row_1(world)[11:].strip() == "1/2", world.lcd()  # DRIVES
    walk(world, "PARAM")
    world.run(100)
    assert row_1(world) == "MENU        1/13", world.lcd()
    walk(world, "PARAM")
    world.run(200)
    assert world.lcd()[1] == "READY        A1 ", world.lcd()
    world.check()
