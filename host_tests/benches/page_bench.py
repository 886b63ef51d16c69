# SPDX-License-Identifier: MIT
"""A manual as tests read it: its text, its sections, its blocks."""

import re

from tiers import TOP

MADE = {"build", ".git", ".pytest_cache"}  # folders in which nothing is ours
MANUALS = sorted(
    path.as_posix()
    for path in (found.relative_to(TOP) for found in TOP.rglob("*.md"))
    if not MADE.intersection(path.parts)
)


def text(manual):
    return (TOP / manual).read_text(encoding="utf-8")


def prose(manual):
    """Without the blocks of examples, in which a bracket is no link and # no heading."""
    found = re.sub(r"^```.*?^```", "", text(manual), flags=re.M | re.S)
    return "\n".join(line for line in found.split("\n") if not line.startswith("    "))


def section(manual, title):
    """What stands under a heading, down to the next one of its kind."""
    level = re.search(rf"^(#+) {re.escape(title)}$", text(manual), re.M)
    assert level, (manual, title)
    rest = text(manual)[level.end() :]
    end = re.search(rf"^#{{1,{len(level[1])}}} ", rest, re.M)
    return rest[: end.start()] if end else rest


def indented(page):
    """The indented blocks of a manual, without the indent."""
    blocks = re.findall(r"(?:^    .*\n(?:\n(?=    ))?)+", page, re.M)
    return [re.sub("^    ", "", block, flags=re.M) for block in blocks]


def pattern(text):
    """A text of the display as a pattern: a number may be any, blanks count once."""
    words = [re.escape(word) for word in text.decode("latin-1").split()]
    words = [word.replace("%04X", "[0-9A-F]{4}") for word in words]
    return re.sub("%0?[0-9]?d", r"\\d+", r"\s*".join(words)).replace("%s", ".+").replace("%%", "%")
