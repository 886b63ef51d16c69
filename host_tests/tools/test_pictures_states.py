# SPDX-License-Identifier: MIT
"""The picture of the phases, and whether the panel goes from each to the others as it says."""

import pytest

from panel import phases
from tools.pictures import running
from tools.pictures.states import WAYS, states, table

INTERPRETERS = "host"

UNSUPERVISED = "param 1 P2014 0; wait 12000"
# (phase, what happens): in the script language, from the home page on, and how long until then.
HAPPENS = {
    ("IDLE", "START"): ("down START; wait 300", 0),
    ("IDLE", "a jog key"): ("down JOG_LEFT; wait 300", 0),
    ("CHECKING", "all is confirmed"): ("down START; wait 300", 2_000),
    ("CHECKING", "there is a risk"): (UNSUPERVISED + "; down START; wait 300", 2_000),
    ("CHECKING", "there is an obstacle"): ("down START; wait 200; param 1 P2200 1", 2_000),
    ("ASKING", "START"): (UNSUPERVISED + "; press START; wait 3000; down START; wait 60", 0),
    ("ASKING", "any other key, another risk"): (
        UNSUPERVISED + "; press START; wait 3000; press UP; wait 300",
        0,
    ),
    ("RUNNING", "it leads to nothing, or the engine took it back"): (
        "press START; wait 3000; unplug 1",
        2_000,
    ),
    ("JOGGING", "its key goes up, or likewise"): ("down JOG_LEFT; wait 500; up JOG_LEFT", 300),
}
NAMES = {getattr(phases, row.name): row.name for row in table()[0]}


def seen(world):
    return NAMES[world.app.panel.selected.phase]


def test_the_table_has_every_phase():
    assert (
        [row.name for row in table()[0]]
        == [name for name in vars(phases) if name.isupper()]
        == list(WAYS)
    )


def test_everything_that_may_happen_is_tried():
    assert [(row.name, what) for row in table()[0] for what, _ in row.exits] == list(HAPPENS)


@pytest.mark.parametrize("begin, what", HAPPENS)
def test_what_happens_leads_to_the_phase_of_the_table(begin, what):
    row = next(row for row in table()[0] if row.name == begin)
    commands, ms = HAPPENS[begin, what]
    world = running.panel()
    passed = [seen(world)]
    for command in commands.split("; ") + ["wait 20"] * (ms // 20):
        running.happen(world, command)
        if seen(world) != passed[-1]:
            passed.append(seen(world))
    assert passed[-2:] == [begin, dict(row.exits)[what]]


@pytest.mark.parametrize("name", WAYS)
def test_stop_leads_from_each_to_idle(name):
    before, keys, ms = WAYS[name]
    world = running.panel()
    running.happen(world, before + ";" + keys)
    world.run(ms)
    assert seen(world) == name
    world.press("STOP")
    assert seen(world) == "IDLE"
    assert table()[1] == "STOP leads from each of them to IDLE."


def test_the_picture_says_all_of_it():
    shown = " ".join(box.text for box in states().texts)
    rows, stop = table()
    for row in rows:
        for words in (row.name, row.what, *(what for what, _ in row.exits), stop):
            assert words in shown, words
    assert "STW 047F" in shown and "RUNNING      A1" in shown
