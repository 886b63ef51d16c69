# SPDX-License-Identifier: MIT
"""What the display shows on each page of the panel, and which keys lead there."""

from functools import cache
from typing import NamedTuple

from panel.menu.main import LISTS
from tools.pictures import lcd, running
from tools.pictures.svg import Picture, wrapped

ACROSS, EDGE, GAP, BETWEEN = 460, 12, 12, 18
COLUMNS = 2
COLUMN = (ACROSS - 2 * EDGE - GAP * (COLUMNS - 1)) / COLUMNS
SCALE = COLUMN / lcd.size(1)[0]
NAME, KEYS, STEP = 13, 11, 15


class Tile(NamedTuple):
    """keys: from the home page on, with two drives that stand. before, behind: what else happens
    before and behind that, in the script language. ms: since power-on, if not the home page.
    """

    name: str
    keys: str = ""
    before: str = ""
    behind: str = ""
    ms: int = running.READY_MS


PAGES = (
    Tile("Power-on", ms=500),
    Tile("Home page"),
    Tile("A motor runs", "START, 3 s"),
    Tile("The other direction", "START, 3 s, REVERSE, 4 s"),
    Tile("STOP, as long as it is held", "STOP kept down"),
    Tile("A jog, as long as its key is held", "JOG_RIGHT kept down"),
    Tile("Another value: motor current", "START, 3 s, NEXT x4, 3 s"),
    Tile("Another drive", "ADDRESS_UP"),
    Tile("Setpoint, digit by digit", "EDIT, NEXT, UP x2"),
    Tile("Parameter mode", "PARAM, NEXT"),
    Tile("A value is being changed", "PARAM, NEXT, EDIT, UP"),
    Tile("Is it to be written?", "PARAM, NEXT, EDIT, UP, SET"),
    Tile("START asks", "START, 2 s", before="param 1 P2014 0; wait 12000"),
    Tile("START says why not", "START", before="param 1 P2200 1; wait 12000"),
    Tile("A drive has tripped", before="fault 1 F0001; wait 2000"),
    Tile("What that means", "PARAM held, SET", before="fault 1 F0001; wait 2000"),
    Tile("A drive warns", before="warn 1 A0501; wait 2500"),
    Tile("Nobody answers", before="unplug 1; wait 2500"),
    Tile("A drive is lost while it runs", "START, 3 s", behind="unplug 1; wait 2500"),
    Tile("Another drive runs", "START, 3 s, ADDRESS_UP"),
)
INSIDE = (  # some of what the lists lead to
    Tile("A drive of the list", "PARAM held, SET, SET"),
    Tile("A setting", "PARAM held, DOWN x3, SET, SET, UP"),
    Tile("Counters of drive 1", "PARAM held, DOWN x7, SET, DOWN x4, SET, SET, DOWN x3, 3 s"),
    Tile(
        "Any parameter",
        "PARAM held, DOWN x8, SET, SET, UP, NEXT, UP, NEXT, UP x2, SET, 2 s",
    ),
    Tile("A step of commissioning", "PARAM held, DOWN x9, SET, 1 s, DOWN x2, SET, 3 s, DOWN x6"),
    Tile("A set gets a name", "PARAM held, DOWN x4, SET, SET"),
)


def pages():
    return _picture(
        "The pages of the panel",
        "What the display shows, and which keys lead there from the home page.",
        PAGES,
    )


def menu():
    return _picture(
        "The menu of the panel",
        "Its lists, some of what is inside, and which keys lead there from the home page.",
        [Tile("The menu", "PARAM held"), *lists(), *INSIDE],
    )


def lists():
    """A tile for each list of a panel with several drives."""
    for place, (text, _) in enumerate(LISTS):
        way = ["", "DOWN, "][place] if place < 2 else f"DOWN x{place}, "
        yield Tile(text.decode("latin-1"), f"PARAM held, {way}SET")


def _picture(title, words, tiles):
    displays = [seen(tile) for tile in tiles]
    told = "; ".join(
        f"{tile.name}: {' / '.join(row.strip() for row in shown.rows)}"
        for tile, shown in zip(tiles, displays, strict=True)
    )
    picture = Picture(ACROSS, title, f"{words} {told}.")
    y = EDGE
    for at in range(0, len(tiles), COLUMNS):
        row = tiles[at : at + COLUMNS]
        ways = [wrapped(tile.keys, COLUMN, KEYS) for tile in row]
        top = y + STEP * (1 + max(map(len, ways)))
        for column, (tile, way) in enumerate(zip(row, ways, strict=True)):
            x = EDGE + column * (COLUMN + GAP)
            picture.text(x, y + STEP - 3, tile.name, "ink", NAME, bold=True)
            picture.lines(x, y + 2 * STEP - 3, way, STEP, colour="pale", size=KEYS)
            lcd.draw(picture, x, top + 2, SCALE, displays[at + column])
        y = top + 2 + lcd.size(SCALE)[1] + BETWEEN
    picture.down = y - BETWEEN + EDGE
    return picture


@cache
def seen(tile):
    """What the display shows then."""
    world = running.panel(ms=tile.ms)
    if tile.before:
        running.happen(world, tile.before)
    if tile.keys:
        running.press(world, tile.keys)
    if tile.behind:
        running.happen(world, tile.behind)
    world.check()
    return lcd.seen_of(world.lcd_chip)
