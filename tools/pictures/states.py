# SPDX-License-Identifier: MIT
"""What becomes of START, STOP and a jog key: the phases of a drive at the panel, one below the
other, and what leads from each to which. From the table in `panel.phases`.

What is sent and shown in a phase comes from the running panel.
"""

import re
from typing import NamedTuple

from panel import phases
from tools.pictures import running
from tools.pictures.svg import Picture, wrapped

ACROSS, EDGE = 460, 14
LEFT, RIGHT = 120, 300  # of the boxes
LANES = {"near": 100, "far": 22}  # ways down, left of the boxes
RAIL = ACROSS - 20  # the way back up
NAME, FONT, STEP, GAP = 14, 12, 15, 46
INSET, GLASS = 10, 20  # in a box; height of what the display says


class Phase(NamedTuple):
    """exits: (what happens, name of the phase to which it leads)."""

    name: str
    what: str
    exits: tuple


# How to come into a phase: what happens before, keys, and how long after.
WAYS = {
    "IDLE": ("", "", 0),
    "CHECKING": ("", "down START", 300),  # it lasts half a second
    "ASKING": ("param 1 P2014 0; wait 12000", "press START", 2000),
    "RUNNING": ("", "press START", 3000),
    "JOGGING": ("", "down JOG_RIGHT", 2000),
}
# Whichever is not straight on, or back by the rail: (from, to): the lane.
BY_LANE = {("CHECKING", "RUNNING"): "near", ("IDLE", "JOGGING"): "far"}


def table():
    """The phases as the docstring of `panel.phases` has them, and the sentence about STOP."""
    text = phases.__doc__
    head = re.search(r"^ +phase .*$", text, re.M)[0]
    columns = [head.index(word) for word in ("phase", "what", "ends")] + [None]
    rows, _, rest = text[text.index(head) + len(head) + 1 :].partition("\n\n")
    found = []
    for line in rows.split("\n"):
        cells = [line[a:b].strip() for a, b in zip(columns, columns[1:])]
        if cells[0]:
            found.append(cells)
        else:
            found[-1] = [f"{one} {more}".strip() for one, more in zip(found[-1], cells)]
    names = "|".join(cells[0] for cells in found)
    exits = re.compile(rf"[; ]*(.+?): ({names})\b")
    return [
        Phase(name, what, tuple(exits.findall(ends))) for name, what, ends in found
    ], rest.strip()


class Told(NamedTuple):
    """What the panel tells in a phase. stw: to the drive. row: of the display."""

    stw: str
    row: str


def told(name):
    """AssertionError: the way there leads elsewhere."""
    before, keys, ms = WAYS[name]
    world = running.panel()
    running.happen(world, before + ";" + keys)
    world.run(ms)
    assert world.app.panel.selected.phase == getattr(phases, name), name
    return Told(re.search(r"stw=(\w+)", world.drives[1].report())[1], world.lcd()[1].strip())


def states():
    rows, stop = table()
    picture = Picture(
        ACROSS,
        "START, STOP and JOG: the phases of a drive",
        " ".join(
            f"{row.name}: {row.what}." + "".join(f" {what}: {to}." for what, to in row.exits)
            for row in rows
        )
        + " "
        + stop,
    )
    boxes, y = {}, EDGE
    for row in rows:
        boxes[row.name] = (y, _box(picture, y, row))
        y = boxes[row.name][1] + GAP
    picture.down = y - GAP + EDGE
    back = []
    for row in rows:
        for what, to in row.exits:
            lane = BY_LANE.get((row.name, to))
            if lane:
                _by_lane(picture, LANES[lane], boxes[row.name], boxes[to], what)
            elif to == rows[0].name:
                back.append(_back(picture, boxes[row.name], what))
            else:
                _straight(picture, boxes[row.name], boxes[to], what)
    _rail(picture, boxes[rows[0].name], max(back), stop)
    return picture


def _box(picture, y, row):
    """A phase. Answers where it ends."""
    what = wrapped(row.what, RIGHT - LEFT - 2 * INSET, FONT)
    say = told(row.name)
    down = INSET + NAME + 6 + STEP * len(what) + 2 + GLASS + INSET
    picture.rect(LEFT, y, RIGHT - LEFT, down, "box", radius=8, edge="line")
    x, line = LEFT + INSET, y + INSET + NAME - 2
    picture.text(x, line, row.name, size=NAME, bold=True)
    picture.text(RIGHT - INSET, line, f"STW {say.stw}", "blue", FONT, "end", mono=True)
    line = picture.lines(x, line + 4 + STEP, what, STEP, colour="pale", size=FONT)
    line -= STEP - 8
    picture.rect(x, line, RIGHT - LEFT - 2 * INSET, GLASS, "glass", radius=2)
    picture.text(x + 8, line + 14, say.row, "dot", FONT, mono=True)
    return y + down


def _straight(picture, begin, end, what):
    """Between neighbours: down, or up beside that."""
    down = end[0] > begin[0]
    x = LEFT + (30 if down else 140)
    way = [(x, begin[1]), (x, end[0])] if down else [(x, begin[0]), (x, end[1])]
    picture.line(way, "ink", arrow=True)
    picture.text(x + 7, (way[0][1] + way[1][1]) / 2 + 4, what, size=FONT)


def _by_lane(picture, x, begin, end, what):
    """Down on the left, past those in between."""
    top, low = begin[1] - 22, end[0] + 22
    picture.line([(LEFT, top), (x, top), (x, low), (LEFT, low)], "ink", arrow=True)
    room = LEFT - EDGE if x < LEFT - 40 else x - LANES["far"] - 10
    lines = wrapped(what, room, FONT)
    if x < LEFT - 40:
        picture.lines(x + 2, top - 6 - STEP * (len(lines) - 1), lines, STEP, size=FONT)
    else:
        picture.lines(x - 6, top + 30, lines, STEP, size=FONT, anchor="end")


def _back(picture, begin, what):
    """From the right edge to the rail. Answers its height."""
    y = begin[1] - 20
    picture.line([(RIGHT, y), (RAIL, y)], "ink")
    lines = wrapped(what, RAIL - RIGHT - 14, FONT)
    picture.lines(RIGHT + 7, y - 6 - STEP * (len(lines) - 1), lines, STEP, size=FONT)
    return y


def _rail(picture, end, low, stop):
    """Up to the first phase, with the sentence about STOP."""
    y = end[1] - 20
    picture.line([(RAIL, low), (RAIL, y), (RIGHT, y)], "ink", arrow=True)
    lines = wrapped(stop, RAIL - RIGHT - 14, FONT, bold=True)
    top = y - 6 - STEP * (len(lines) - 1)
    picture.lines(RIGHT + 7, top, lines, STEP, colour="red", size=FONT, bold=True)
