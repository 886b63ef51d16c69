# SPDX-License-Identifier: MIT
"""Exchanges a second as bars, beside an S7-1200, an S7-200 and what the wire allows: the table of
tools/bench.md. `./tools/bench` draws it anew when it writes that.
"""

from pathlib import Path

from tools.benching import beside_s7
from tools.pictures.svg import Picture, wrapped

PAGE = Path(__file__).resolve().parents[1] / "bench.md"
ACROSS, EDGE = 460, 14
BEGIN, END = 104, 392  # of the bars
BAR, GAP, BETWEEN = 18, 5, 24
HEAD, FONT, SMALL = 14, 12, 11
COLOURS = {"S7-1200": "line", "S7-200": "violet", beside_s7.OURS: "green"}
NOTE = (
    "The full width is what the wire allows at that rate: one drive, 16 characters each way, a "
    "reply after 2 characters. S7: intervals of their system manuals. This firmware: on an "
    "emulated Raspberry Pi Pico."
)


def bench():
    rows = beside_s7.rows_of(PAGE.read_text(encoding="utf-8"))
    told = (
        f"{row.baud} baud: " + ", ".join(f"{name} {rate}" for name, rate in row.rates.items())
        for row in rows
    )
    picture = Picture(
        ACROSS, "Exchanges a second beside an S7-1200 and an S7-200", "; ".join(told) + ". " + NOTE
    )
    picture.text(EDGE, EDGE + HEAD - 2, "Exchanges a second", size=HEAD, bold=True)
    y = EDGE + HEAD + BETWEEN
    for row in rows:
        y = _group(picture, y, row) + BETWEEN
    y = picture.lines(
        EDGE, y, wrapped(NOTE, ACROSS - 2 * EDGE, SMALL), SMALL + 4, colour="pale", size=SMALL
    )
    picture.down = y - SMALL - 4 + EDGE
    return picture


def _group(picture, y, row):
    """The bars of a rate. Answers where they end."""
    limit = row.rates[beside_s7.WIRE]
    picture.text(EDGE, y, f"{row.baud} baud", size=FONT + 1, bold=True)
    picture.text(ACROSS - EDGE, y, f"{beside_s7.WIRE} {limit}", "pale", FONT, anchor="end")
    y += 8
    for name, rate in row.rates.items():
        if name == beside_s7.WIRE:
            continue
        picture.rect(BEGIN, y, END - BEGIN, BAR, "box", edge="line")
        picture.rect(BEGIN, y, (END - BEGIN) * min(1, rate / limit), BAR, COLOURS[name])
        ours = name == beside_s7.OURS
        picture.text(BEGIN - 8, y + 13, name, size=FONT, anchor="end", bold=ours)
        picture.text(ACROSS - EDGE, y + 13, f"{rate}", size=FONT, anchor="end", bold=ours)
        y += BAR + GAP
    return y
