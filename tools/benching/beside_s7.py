# SPDX-License-Identifier: MIT
"""Exchanges a second beside the masters of an S7-1200 and an S7-200, and what the wire allows: the
table of tools/bench.md, of which tools/pictures/bench.py makes bars.

    section({115200: "229.8"})      # Markdown
    rows_of(page)                   # [Compared(115200, {"S7-1200": 35.6, ...}), ...]
"""

from typing import NamedTuple

CHARACTER_BITS = 11
CHARACTERS = 2 + 16 + 2 + 16  # of an exchange: start interval, request, the drive's time, reply
# Baud -> milliseconds between two telegrams to a drive: "scan interval" of the S7-1200, "poll
# time" of an active drive of the S7-200. From their system manuals.
MASTERS_MS = {
    "S7-1200": {9600: 116.3, 19200: 68.2, 38400: 44.1, 57600: 36.1, 115200: 28.1},
    "S7-200": {9600: 50, 19200: 35, 38400: 30, 57600: 25, 115200: 25},
}
OURS, WIRE = "this firmware", "the wire allows"
HEAD = ("baud", *MASTERS_MS, OURS, WIRE, "reached")
HEADING = "## Beside an S7"
PICTURE = "bench.svg"
TEXT = f"""\
Exchanges a second with one drive, telegrams of 16 characters. The wire allows so many if the drive
answers after 2 characters and the master never waits. The intervals of an S7-1200 (scan interval)
and an S7-200 (poll time of an active drive, while no parameter is read or written) are those of
their system manuals; they offer no 187500.

![These figures as bars](../.github/pictures/{PICTURE})"""


class Compared(NamedTuple):
    """rates: name of a master, or WIRE -> exchanges a second."""

    baud: int
    rates: dict


def limit(baud):
    """Exchanges a second that the wire allows."""
    return baud / (CHARACTERS * CHARACTER_BITS)


def rates(baud):
    """Those of the masters that have this rate, the quickest first."""
    return {name: 1000 / ms[baud] for name, ms in reversed(MASTERS_MS.items()) if baud in ms}


def section(ours):
    """The paragraphs of the page. ours: {baud: exchanges a second, as text}."""
    lines = [HEAD, ("---",) * len(HEAD)]
    for baud, rate in ours.items():
        others = [
            "%.1f" % rates(baud)[name] if name in rates(baud) else "-" for name in MASTERS_MS
        ]
        share = "%.0f %%" % (100 * float(rate) / limit(baud))
        lines.append((str(baud), *others, rate, "%.1f" % limit(baud), share))
    table = "\n".join("| " + " | ".join(cells) + " |" for cells in lines)
    return "\n\n".join([HEADING, table, TEXT])


def rows_of(page):
    """The table of a page that was written."""
    table = page.partition(HEADING + "\n\n")[2].partition("\n\n")[0]
    found = []
    for line in table.split("\n")[2:]:
        baud, *cells = [cell.strip() for cell in line.strip("|").split("|")]
        told = zip(HEAD[1:-1], cells)
        found.append(Compared(int(baud), {name: float(c) for name, c in told if c != "-"}))
    return found
