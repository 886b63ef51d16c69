# SPDX-License-Identifier: MIT
"""What the tests of parameter mode share: a hand that looks at parameters and changes them."""

import json

from panel_bench import panel, row_2, settled_row_2

WRITES = {2: "RAM", 14: "EEPROM"}  # AK of a task: where it writes a word to
ASKED = "SET=DO  PARAM=NO"
NAMES = ("P0700", "P1000", "P2011", "r2024", "r2025")


def wait_for(world, text, ms=9000):
    """Let time pass until row 2 begins with a text."""
    for _ in range(ms // 20):
        if settled_row_2(world).startswith(text):
            return
        world.run(20)
    raise AssertionError("%r does not come: %r" % (text, world.lcd()))


def show(world, name):
    """From the home page to a parameter."""
    world.press("PARAM")
    for _ in range(NAMES.index(name)):
        world.press("NEXT")
    wait_for(world, name + ":")
    world.run(200)
    return world


def parameter(name, **options):
    return show(panel(**options), name)


def edit(world, value):
    """EDIT, then UP or DOWN to a value."""
    world.press("EDIT")
    wait_for(world, "P")
    assert row_2(world)[12] == "↕", world.lcd()
    shown = int(row_2(world)[6:12])
    for _ in range(abs(value - shown)):
        world.press("UP" if value > shown else "DOWN")
    wait_for(world, "P")
    assert int(row_2(world)[6:12]) == value
    return world


def write(world, value):
    """A new value into RAM, with the question answered."""
    edit(world, value)
    world.press("SET")
    assert row_2(world) == ASKED, world.lcd()
    world.press("SET")


def write_eeprom(world, value):
    edit(world, value)
    world.press("SET")
    world.press("SET", 2000)


def writes(world, address=None):
    """Writes of the panel as (address, number, where, value), repetitions left out."""
    found = []
    for _, from_panel, characters in world.wire.log.last(1000):
        if from_panel and len(characters) == 16 and characters[3] >> 4 in WRITES:
            number = (characters[3] & 7) << 8 | characters[4]
            number += 2000 if characters[5] & 0x80 else 0
            row = (characters[2], number, WRITES[characters[3] >> 4], characters[10])
            if row not in found and address in (None, characters[2]):
                found.append(row)
    return found


def restart_drive(world, address=1):
    world.drives[address].power_off()
    world.run(200)
    world.drives[address].power_on()


def stored(world):
    return json.loads(world.flash.files["settings.json"])


def lose_answer(world, number, value, silent_ms=200):
    """SET, and the drive does what it is told, but its answer does not come through."""
    drive = world.drives[1]
    delay_us, drive.reply_delay_us = drive.reply_delay_us, 15_000
    world.down("SET")
    for _ in range(30_000):
        world.run(2)
        if drive.read(number) == value:
            break
    drive.unplug()
    world.up("SET")
    world.run(silent_ms)
    drive.reply_delay_us = delay_us
    drive.plug()


def rows_in_turn(world, ms=4000):
    seen = set()
    for _ in range(ms // 50):
        world.run(40)
        seen.add(settled_row_2(world))
    return seen
