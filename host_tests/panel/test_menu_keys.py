# SPDX-License-Identifier: MIT
"""Every key on every page of the menu, with fourteen keys and with eight: see `walk_bench`.

No key starts a motor there, none but STOP stops one or changes its speed, and wherever they have
led, STOP sends OFF1 to the drive that is shown. What a key does on a page is told by the test of
that page.
"""

from panel_bench import OFF1, row_1, starts
from uss.master import LISTENING, OFF
from walk_bench import (
    go,
    page_of,
    running,
    running_compact,
    standing,
    standing_compact,
    walk,
    warned,
    ways,
)  # fmt: skip

INTERPRETERS = "unix64"

MOTION_KEYS = ("START", "REVERSE", "JOG_RIGHT", "JOG_LEFT")
# Those that lead away come last.
OTHER_KEYS = (
    "UP", "DOWN", "NEXT", "PREVIOUS", "EDIT", "ADDRESS_UP", "ADDRESS_DOWN", "SET", "PARAM",
)  # fmt: skip
PAGES = 25  # there are at the least
PLACES_OF_A_PAGE = 2  # are tried
STOP_MS = 100
LISTEN_MS = 200  # longer, where the line was left: the panel listens first
BEGINS_ANEW_MS = 5_000
known = []  # of `tried`, which takes a while


def tried():
    """(begin, way, place) of some places of each page, with the motor running or standing."""
    if known:
        return known
    count, found = {}, known
    for begin, way, here, world in ways((running, warned)):
        page = page_of(world)
        count[page] = count.get(page, 0) + 1
        if count[page] <= PLACES_OF_A_PAGE:
            found.append((begin, way, here))
            if begin is running:
                found.append((standing, way, here))
    assert len(count) >= PAGES, sorted(count)
    return found


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


def test_a_walk_finds_the_pages():
    assert len(tried()) > 60


def press_every_key_everywhere(begin, really):
    """In the places where a panel came to that began so; really: how this one begins."""
    places = [(way, here) for one, way, here in tried() if one is begin]
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
