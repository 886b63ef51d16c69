# SPDX-License-Identifier: MIT
"""The front of a panel: its display after power-on, and its keys, fourteen or eight."""

from panel.keys.compact import FUNCTIONS
from tools.pictures import lcd, running
from tools.pictures.svg import Picture

ACROSS, EDGE, GAP = 460, 12, 5
CAP, CAPTION, SECOND, STEP = 42, 11, 10.5, 14  # height of a key; fonts and the next line
SCALE = 3.8  # of the display
# How the keys are arranged. One that stands there twice is twice as wide.
FOURTEEN = (
    ("START", "STOP", "STOP", "REVERSE"),
    ("JOG_LEFT", "JOG_RIGHT", "UP", "ADDRESS_UP"),
    ("PARAM", "EDIT", "DOWN", "ADDRESS_DOWN"),
    ("PREVIOUS", "NEXT", "SET", "SET"),
)
EIGHT = (("START", "STOP", "REVERSE", "JOG"), ("UP", "DOWN", "P", "FN"))
PLACES = 4
COLOURED = {"START": ("go", "white"), "STOP": ("stop", "white")}
PLAIN = ("cap", "on cap")
SHIFTS = ("", "^ ", "^^ ")  # as the display shows that FN was pressed


def fourteen():
    """The front with fourteen keys."""
    return _front("direct", FOURTEEN, "Fourteen keys", {})


def eight():
    """The front with eight keys, and below each what it is behind FN."""
    below = {
        key: [shift + name for shift, name in zip(SHIFTS, row, strict=True) if shift and name]
        for key, row in FUNCTIONS.items()
    }
    return _front("compact", EIGHT, "Eight keys, below each what it is behind FN", below)


def _front(wired, rows, keys, below):
    """below: lines under a key."""
    seen = lcd.seen_of(running.panel(wired).lcd_chip)
    names = ", ".join(dict.fromkeys(key for row in rows for key in row))
    picture = Picture(
        ACROSS,
        "The panel after power-on",
        f"The display says {seen.rows[0].strip()} and {seen.rows[1].strip()}. {keys}: {names}.",
    )
    picture.down = _height(rows, below)
    picture.rect(1, 1, ACROSS - 2, picture.down - 2, "plate", radius=14)
    across, tall = lcd.size(SCALE)
    lcd.draw(picture, (ACROSS - across) / 2, EDGE + 6, SCALE, seen)
    place = (ACROSS - 2 * EDGE + GAP) / PLACES
    y = EDGE + 6 + tall + 16
    for row in rows:
        for at, key in enumerate(row):
            if key in row[:at]:
                continue
            x = EDGE + at * place
            _key(picture, x, y, row.count(key) * place - GAP, key)
            picture.lines(
                x + (place - GAP) / 2,
                y + CAP + STEP,
                below.get(key, ()),
                STEP,
                colour="on plate",
                size=SECOND,
                anchor="middle",
            )
        y += _row_height(row, below)
    return picture


def _row_height(row, below):
    return CAP + GAP + STEP * max(len(below.get(key, ())) for key in row)


def _height(rows, below):
    keys = sum(_row_height(row, below) for row in rows)
    return EDGE + 6 + lcd.size(SCALE)[1] + 16 + keys + EDGE


def _key(picture, x, y, across, key):
    cap, letters = COLOURED.get(key, PLAIN)
    picture.rect(x, y, across, CAP, cap, radius=6)
    middle = x + across / 2, y + CAP / 2 + CAPTION * 0.36
    picture.text(*middle, key, letters, CAPTION, "middle", bold=True)
