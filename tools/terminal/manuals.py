# SPDX-License-Identifier: MIT
"""What the manuals say of the live panel, of a command, a key or a text of the display: the help.

    manuals.strokes()               # [("a small letter, an arrow", "taps the key ...")]
    manuals.explained("unplug")     # the rows that have this word in their first cell

The manuals are the one place where these facts stand; a person reads them here in the terminal.
"""

import re
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
TOOLS, PANEL = "tools/README.md", "firmware/panel/README.md"
HELP = (TOOLS, "Scripts"), (PANEL, "The keys"), (PANEL, "What the display says")
STROKES = "you type"  # the head of the table of strokes
LINK = re.compile(r"\[([^]]*)\]\([^)]*\)")
BAR = "\0"  # stands for a bar that divides no cells


def rows(manual, heading):
    """The rows of all tables under a heading, as lists of cells, without their heads."""
    text = (TOP / manual).read_text(encoding="utf-8")
    start = re.search(rf"^(#+) {re.escape(heading)}$", text, re.M)
    text = text[start.end() :]
    end = re.search(rf"^#{{1,{len(start[1])}}} ", text, re.M)
    return tables(text[: end.start()] if end else text)


def tables(text):
    found, head = [], None
    for line in text.splitlines():
        if not line.startswith("|"):
            head = None
            continue
        cells = [readable(cell) for cell in line.replace(r"\|", BAR).strip("|").split("|")]
        if head is None:
            head = cells[0]
        elif not set(line) <= set("|-: "):
            found.append([head] + cells)
    return found


def readable(cell):
    """A cell without the marks of a manual."""
    return LINK.sub(r"\1", cell).replace("`", "").replace("**", "").replace(BAR, "|").strip()


def strokes():
    """What a person may type in the live panel: [(strokes, what they do)]."""
    found = rows(TOOLS, "The live panel")
    return [(cells[1], cells[2]) for cells in found if cells[0] == STROKES]


def explained(word):
    """[(first cell, what it means)] of each row whose first cell has this word, or these."""
    word = word.strip()
    pattern = re.compile(rf"(?<![\w-]){re.escape(word)}(?![\w-])", 0 if word.isupper() else re.I)
    found = []
    if word:
        for manual, heading in HELP:
            for cells in rows(manual, heading):
                if len(cells) > 2 and pattern.search(cells[1]):
                    found.append((cells[1], cells[2]))
    return found
