# SPDX-License-Identifier: MIT
"""What the tests of the catalogue at the panel share: a hand that walks the menu and types."""

import sys

import on_demand
from boards.sim.drives.kinds import listed_drives, simulated
from panel_bench import hold, press, row_1, row_2, settled_row_2, switched_on, wait_until_known


def world_of(kind="mm440", settings=None, addresses=(1,), known=None, **options):
    """A panel with drives of a kind; known: what its settings call them."""
    listed = ",".join(["%d=%s" % (address, kind) for address in addresses])
    stored = {"kinds": {str(address): known or kind for address in addresses}}
    stored.update(settings or {})
    kinds = simulated(listed_drives(listed))
    world = switched_on(addresses, kinds=kinds, settings=stored, **options)
    world.run(1000)
    wait_until_known(world)
    return world


def speak(world, language):
    """As the settings do when somebody chooses it."""
    panel = world.app.panel
    panel.settings.change("language", language)
    panel.heed_settings()


def go_to(world, *entries):
    """Open the menu, and choose these entries one after the other."""
    hold(world, "PARAM", 1400)
    for entry in entries:
        world.run(500)
        choose(world, entry)


def choose(world, entry):
    for _ in range(60):
        if row_2(world).startswith(">" + entry):
            press(world, "SET")
            return
        press(world, "DOWN")
    raise AssertionError("%s is not in the menu: %r" % (entry, world.lcd()))


def type_digits(world, digits):
    """From the digit that blinks on, one after the other: each goes up until it is right."""
    for place, digit in enumerate(digits):
        if place:
            press(world, "NEXT")
        for _ in range(int(digit, 16)):
            world.press("UP", 60)
            world.run(60)


def look_up(world, number):
    """PARAMETERS, BY NUMBER; and the value is there."""
    go_to(world, "PARAMETERS")
    for _ in range(40):
        if row_2(world) == ">BY NUMBER":
            break
        press(world, "UP")
    press(world, "SET")
    wait(world, "P0")
    type_digits(world, "%04d" % number)
    press(world, "SET")
    world.run(500)
    wait_for_value(world)


def wait_for_value(world):
    for _ in range(100):
        row = settled_row_2(world)
        if row[:5] != "P0000" and not row.endswith("?"):
            return row
        world.run(50)
    raise AssertionError(world.lcd())


def wait(world, text, ms=9000):
    """Let time pass until row 2 begins with a text."""
    for _ in range(ms // 20):
        if settled_row_2(world).startswith(text):
            return
        world.run(20)
    raise AssertionError("%r does not come: %r" % (text, world.lcd()))


def lines(world, ms=9000):
    """What a person reads in row 1 in turn."""
    found, last = set(), ""
    for _ in range(ms // 100):
        world.run(100)
        row = row_1(world).rstrip()
        if row == last:  # else it may be half of one
            found.add(row)
        last = row
    return found


def entries(world):
    """The list that is shown, as (heading, entry); what is announced in row 1 has to wait."""
    found, count = [], 1
    while len(found) < count:
        heading, place = settled_heading(world)
        if "/" in place:
            count = int(place.split("/")[1])
        found.append((heading, row_2(world)[1:]))
        press(world, "DOWN")
    return found


def settled_heading(world):
    """The name of the list that is shown, and the place in it."""
    for _ in range(200):
        world.run(50)
        row = row_1(world)
        if "FAULT F" not in row and "HOLD=ALL" not in row:
            world.run(50)
            if row == row_1(world):
                return row[:11].rstrip(), row[11:]
    raise AssertionError(world.lcd())


def forget_modules():
    """What a test before this one may have left in memory is not there."""
    on_demand.keep()
    for name in list(sys.modules):
        if name.startswith(("panel.lookup", "panel.menu", "catalogue")):
            on_demand.drop(name)
