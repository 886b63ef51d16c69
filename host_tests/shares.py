# SPDX-License-Identifier: MIT
"""What of a file runs on which tier with --coverage, as in CI: what takes long, once.

A function that takes long shows next to nothing new on the second interpreter and the third. Two
tables, functions by their files, say what runs where; cpython/choose_lines.py writes them:

    slow_once.json   these take long: they run on one tier of their file, the first of FIRST
    lines_once.json  these run on CPython as well: no other runs some line of the firmware there

What is in no table, because it is new say, runs on each tier of its file. A file that says
INTERPRETERS itself runs on each of those as a whole: somebody has meant it.
"""

import json

from tiers import ON_CHIP, OR, TOP, said

TESTS = TOP / "host_tests"
SLOW_ONCE = TESTS / "cpython" / "slow_once.json"
LINES_ONCE = TESTS / "cpython" / "lines_once.json"
CPYTHON = "cpython"
FIRST = (*ON_CHIP.split(OR), CPYTHON)


class NotHere(Exception):
    """A table names a function that its file does not have."""


def shares(path, tree, functions, tiers, here):
    """Tier -> those of the functions that run there.

    tiers: those of the file; here: all that are there.
    """
    found = {tier: set(functions) for tier in tiers}
    if said(tree):
        return found
    first = next((tier for tier in FIRST if tier in found), None)
    slow = listed(SLOW_ONCE, path, functions)
    for tier in found.keys() - {first}:
        found[tier] -= slow
    for_lines = listed(LINES_ONCE, path, functions)
    if for_lines and CPYTHON in here:
        found[CPYTHON] = found.get(CPYTHON, set()) | for_lines
    return found


def listed(table, path, functions):
    """The functions of the file that the table names."""
    if not path.is_relative_to(TESTS):
        return set()
    every = json.loads(table.read_text(encoding="utf-8"))
    names = set(every.get(path.relative_to(TESTS).as_posix(), ()))
    for name in names - set(functions):
        raise NotHere(f"{table.name} names {name}, which is not here")
    return names
