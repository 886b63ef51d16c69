# SPDX-License-Identifier: MIT
"""What firmware/uss/README.md shows is run, and what it names is there.

Each block of Python is a program: with a `board`, and, unless it makes its own, a `bus` on which
`drive` answers at address 1. What is for PLC programmers, s7/README.md, has a test of its own.
"""

import sys

from boards.sim.drives.families import g110, mm440
from tools.examples.simulation import Stage, names
from uss import families
from uss.bus import Master

INTERPRETERS = "unix64|unix32 cpython"  # people run them on both

README = "firmware/uss/README.md"
QUICK = {2014: 2_000, 1120: 1.0, 1121: 1.0, 1058: 5.0, 1060: 1.0}
KINDS = {
    4: {"family": mm440, "parameters": {2014: 2_000, 2012: 4}},
    5: {"family": g110, "parameters": {2013: 0}},
}


def text():
    with open(README) as file:
        return file.read()


def blocks():
    """(heading, code) of each block of Python."""
    heading = ""
    code = None
    for line in text().split("\n"):
        if line.startswith("## "):
            heading = line[3:]
        if line == "```python":
            code = []
        elif line == "```":
            if code is not None:
                yield heading, "\n".join(code) + "\n"
            code = None
        elif code is not None:
            code.append(line)


def named_behind(start):
    """The words behind "drive." or "bus." in the text, but where that is the end of a name."""
    found = set()
    told = text()
    for mark in "/._":
        told = told.replace(mark + start, "")
    for piece in told.split(start)[1:]:
        end = 0
        while piece[end].isalpha() or piece[end].isdigit() or piece[end] == "_":
            end += 1
        found.add(piece[:end])
    return found


def play(code):
    """Run a block on a board of its own; answer what it printed, and the board."""
    stage = Stage((1, 2, 3, 4, 5), parameters=QUICK, kinds=KINDS)
    printed = []
    sys.modules["board"] = stage.board
    program = {"board": stage.board, "print": lambda *words: printed.append(words)}
    if "Master(" in code:
        exec(code, program)
    else:
        with Master(stage.board.make_link(19200)) as bus:
            program["bus"] = bus
            program["drive"] = bus.add(1, families.MM420)
            bus.wait(0.5)
            exec(code, program)
    del sys.modules["board"]
    stage.check()
    return printed, stage


def test_every_block_runs_and_leaves_no_motor_on():
    count = 0
    for heading, code in blocks():
        try:
            _, stage = play(code)
        except Exception:
            print("in the block under %r:" % heading)
            print(code)
            raise
        for drive in stage.drives.values():
            assert "stw=047F" not in drive.report(), heading
        count += 1
    assert count >= 14


def printed_under(heading, mark):
    """What the block prints that stands under a heading and has `mark` in it."""
    for found, code in blocks():
        if found == heading and mark in code:
            return play(code)[0]
    raise AssertionError("no such block")


def test_the_results_that_it_shows_are_those():
    printed = printed_under("Parameters", "refusal.number")
    assert printed[0] == (5,) and printed[1] == (50.0,)
    number, refusal = printed[-1]
    assert "%d %s" % (number, refusal) == "2 drive 1 refuses P1082[0]: beyond the limits"
    assert printed_under("The bus", "mirror") == [(True, False)]
    _, (found,), (will_trip,) = printed_under("The bus", "Scan(")
    assert found[1] == 12 and sorted(found) == [1, 2, 3, 4, 5]
    assert will_trip == {2: 2_000, 3: 2_000, 4: 2_000, 5: None}
    (speed, state, highest) = printed_under("In two minutes", "import board")[0]
    assert 24.9 < speed < 25.1 and state == "running" and highest == 50.0


def test_each_verb_that_it_names_is_listed_with_the_drive_or_the_bus():
    """By `dir`, and so by `help`: nothing is found there that only the engine has."""
    with Master(Stage((1,)).board.make_link(19200)) as bus:
        drive = bus.add(1, families.MM420)
        for thing, others in ((drive, ("COUNTERS", "py")), (bus, ())):
            name = type(thing).__name__.lower().replace("master", "bus")
            listed = dir(type(thing)) + list(thing.__dict__)
            verbs = named_behind(name + ".") - set(others)
            assert len(verbs) > 20 and not verbs - set(listed), verbs - set(listed)


def test_the_table_of_families_names_each():
    table = text().partition("\n## Families")[2]
    for family in families.FAMILIES:
        assert "`%s`" % family.__name__ in table, family


def test_the_table_of_examples_names_each():
    for name in names():
        assert "(../../tools/examples/%s.py)" % name in text(), name


def test_every_file_that_it_names_is_there():
    table = text().partition("| if you want to know |")[2]
    found = [word for word in table.split("`")[1::2] if word.endswith(".py")]
    assert len(found) > 15
    for name in found:
        open("firmware/uss/" + name).close()
