# SPDX-License-Identifier: MIT
"""Every key on every page of the menu, found by walking it: see `walk_bench`.

STOP acts in every place. No key starts a motor there, none but STOP stops one or changes its
speed, with fourteen keys and with eight, and wherever they have led, STOP sends OFF1 to the drive
that is shown. What a key does on a page is told by the test of that page.
"""

import os
from collections import Counter, namedtuple

import on_demand
from panel_bench import OFF1, row_1, row_2, settled, starts, telegrams
from uss.master import LISTENING, OFF
from walk_bench import (
    go,
    is_parameter,
    page_of,
    places,
    running,
    running_compact,
    silent,
    standing,
    standing_compact,
    visit,
    wait_until_it_runs,
    walk,
    warned,
)  # fmt: skip

INTERPRETERS = "cpython"  # it forks

MOTION_KEYS = ("START", "REVERSE", "JOG_RIGHT", "JOG_LEFT")
# Those that lead away come last.
OTHER_KEYS = (
    "UP", "DOWN", "NEXT", "PREVIOUS", "EDIT", "ADDRESS_UP", "ADDRESS_DOWN", "SET", "PARAM",
)  # fmt: skip
PAGES = 50  # there are at the least
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


# begin, way, here: as in `walk_bench.places`. page: of the menu. loaded: modules, so far.
Place = namedtuple("Place", "begin way here page loaded")
done = []
loaded = set()
load = on_demand.load


def walked():
    """The places of the menu. To go through them takes a while, and is done once."""
    if not done:
        on_demand.load = load_and_note
        try:
            done.extend(places((running, silent, warned), look))
        finally:
            on_demand.load = load
    return done


def load_and_note(name):
    loaded.add(name)
    return load(name)


def look(begin, way, here, world):
    """In this place STOP acts, and no motion key does."""
    found = Place(begin, way, here, page_of(world), set(loaded))
    is_line_left = has_left(world)
    if begin in (running, warned):
        run(world)
    if here[1].startswith(">"):  # any key answers a question
        press_motion_keys(world, (way, here))
    if begin is not silent and not is_line_left:
        run(world)
    press_stop(world, (way, here))
    return found


def tried():
    """Some places of each page, with a motor that runs."""
    counts = Counter()
    for found in walked():
        if found.begin is running:
            counts[found.page] += 1
            if counts[found.page] <= PLACES_OF_A_PAGE:
                yield found


def test_stop_acts_in_every_place_of_the_menu_and_nothing_starts_there():
    counts = Counter(found.begin for found in walked())
    parameters = sum(is_parameter(found.here[1]) for found in walked())
    assert counts[running] > 70 and counts[standing] > 2 and counts[silent] > 3, counts
    assert counts[warned] > 5 and parameters > 1, (counts, parameters)


def test_a_walk_comes_to_every_list():
    on_the_ways = set().union(*[found.loaded for found in walked()])
    for folder in ("", "/diagnosis"):
        for name in os.listdir("firmware/panel/menu" + folder):
            name = name.split(".")[0]
            if name not in NO_LISTS and not name.startswith("__"):
                module = "panel.menu" + folder.replace("/", ".") + "." + name
                assert module in on_the_ways, "nobody gets to the list %s" % name
    for name in LISTS_BESIDE:
        assert "panel." + name in on_the_ways, "nobody gets to the list %s" % name


def test_a_walk_finds_the_pages():
    pages = {found.page for found in tried()}
    assert len(pages) >= PAGES, sorted(pages)
    assert len(list(tried())) > 80


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


def press_every_key_everywhere(begin):
    """In the places that the walk came to, with a panel that begins so."""
    heres = {found.way: found.here for found in tried()}

    def press(world, way):
        press_every_key(world, begin, way, heres[way])

    visit(begin, heres, press)


def press_every_key(world, begin, way, here):
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


def test_no_key_in_any_list_moves_a_motor_that_stands():
    press_every_key_everywhere(standing)


def test_no_key_in_any_list_but_stop_does_anything_to_a_motor_that_runs():
    press_every_key_everywhere(running)


def test_so_it_is_with_eight_keys_while_the_motor_stands():
    press_every_key_everywhere(standing_compact)


def test_so_it_is_with_eight_keys_while_the_motor_runs():
    press_every_key_everywhere(running_compact)


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
