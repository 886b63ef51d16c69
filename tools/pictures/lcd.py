# SPDX-License-Identifier: MIT
"""The display as it looks: 2 x 16 characters in their dots, in a `Picture`.

seen = seen_of(world.lcd_chip)          # what is in the display's memory now
draw(picture, 20, 20, 2, seen)          # 2: a dot is so wide
"""

from typing import NamedTuple

from tools.pictures.rom import COLUMNS, OWN, ROWS, rom, rows_of

ACROSS, DOWN = 16, 2
TALL = 1.17  # a dot of a module 1602 is 0.56 mm wide and 0.66 mm high
PITCH = COLUMNS + 1  # from one character to the next, in dots
ROW_PITCH = ROWS + 1
DOT = 0.9  # of its square
RIM, BEZEL = 4, 4  # in dots: glass around the characters, and the frame around that
GLASS_ACROSS = ACROSS * PITCH - 1 + 2 * RIM
GLASS_DOWN = DOWN * ROW_PITCH - 1 + 2 * RIM
KNOWN = rom()


class Seen(NamedTuple):
    """What a display shows. rows: as a person reads them. codes: 32 characters. cgram: 64 bytes,
    the dots of those below 10h."""

    rows: tuple
    codes: bytes
    cgram: bytes


def seen_of(chip):
    """chip: the simulated controller, which is on and has not moved its picture."""
    first = len(chip.ddram) // DOWN
    codes = chip.ddram[:ACROSS] + chip.ddram[first : first + ACROSS]
    return Seen(chip.text(), bytes(codes), bytes(chip.cgram))


def size(scale):
    """(width, height) of the display with its frame."""
    return ((GLASS_ACROSS + 2 * BEZEL) * scale, (GLASS_DOWN + 2 * BEZEL) * scale * TALL)


def draw(picture, x, y, scale, seen):
    """The display, with its frame's upper left corner at (x, y)."""
    across, down = size(scale)
    picture.rect(x, y, across, down, "bezel", radius=3)
    x, y = x + BEZEL * scale, y + BEZEL * scale * TALL
    picture.rect(x, y, GLASS_ACROSS * scale, GLASS_DOWN * scale * TALL, "glass", radius=1.5)
    inside = x + RIM * scale, y + RIM * scale * TALL, (scale, scale * TALL)
    picture.symbol("cells", "".join(_square(u, v, COLUMNS, ROWS) for u, v in _places()))
    picture.use([("cells", 0, 0)], "cell", *inside)
    drawn = []
    for code, (u, v) in zip(seen.codes, _places(), strict=True):
        rows = rows_of(code, seen.cgram, KNOWN)
        if any(rows):
            name = f"c{code:02X}" if code >= OWN else "own" + bytes(rows).hex()
            picture.symbol(name, _dots(rows))
            drawn.append((name, u, v))
    picture.use(drawn, "dot", *inside)


def _places():
    """Where the characters are, in dots."""
    return [(column * PITCH, row * ROW_PITCH) for row in range(DOWN) for column in range(ACROSS)]


def _dots(rows):
    """The lit dots of a character as a path."""
    return "".join(
        _square(column, place, DOT, DOT)
        for place, row in enumerate(rows)
        for column in range(COLUMNS)
        if row >> (COLUMNS - 1 - column) & 1
    )


def _square(x, y, across, down):
    return f"M{x} {y}h{across}v{down}h-{across}z"
