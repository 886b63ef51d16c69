# SPDX-License-Identifier: MIT
"""A parameter set whose link or power is cut, whenever: never is half a set taken for whole.

Twins of the panel live through the cuts, each from the moment on at which it differs.
"""

import random

from panel_bench import row_2
from sets_bench import (
    begin,
    files,
    finish,
    home,
    made,
    marks,
    press,
    put,
    refuses_to_move,
    rows_of,
    save,
    sets,
    small,
    two,
    wait,
)  # fmt: skip
from twin import twin

INTERPRETERS = "cpython"  # it forks

SEED = 17
CUTS = 20  # one in each twentieth of the time that it takes
LENGTHS_MS = (60, 300, 1500, 3000)


def each_cut(world, lasts_ms, after):
    """What `after` returns in a twin of the world whose drive is cut off and back again."""
    random.seed(SEED)
    print("seed %d" % SEED)
    for _ in range(CUTS):
        begin_ms, for_ms = random.randrange(lasts_ms) // CUTS, random.choice(LENGTHS_MS)
        yield twin(cut_off, world, begin_ms, for_ms, after)
        world.run(lasts_ms // CUTS)


def cut_off(world, begin_ms, for_ms, after):
    drive = max(world.drives.items())[1]
    world.run(begin_ms)
    drive.unplug()
    world.run(for_ms)
    drive.plug()
    return after(world)


def lasts_ms(world, end):
    """How long it takes until `end(world)` returns."""
    began_us = world.clock.now_us
    end(world)
    return (world.clock.now_us - began_us) // 1000


# --- the link -----------------------------------------------------------------------------------


def test_while_a_set_is_written_it_leaves_no_half_one_that_counts_as_whole():
    world = two()
    drive = world.drives[2]
    save(world)
    whole = world.flash.files["1.set"]
    rows = [
        (number, index, b"Float", b"40A00000")
        for number, index in sorted(rows_of(whole))
        if 1001 <= number <= 1015 or 1080 <= number <= 1092 and number != 1082
    ]
    rows = [row for row in rows if len(rows_of(whole)[row[:2]]) == 8]
    assert len(rows) > 40
    world.flash.files["1.set"] = made(rows)
    for number, index, _, _ in rows:
        drive.write(number, index, 1.0)
    begin(world, "A1 MADE", "INTO A2 RAM")
    wait(world, "SET=WRITE A2")
    world.press("SET")

    def is_half(world):
        finish(world)
        home(world)
        world.run(2000)
        drive = world.drives[2]
        written = [row for row in rows if drive.read(row[0], row[1]) == 5.0]
        is_marked = bool(marks(world))
        if is_marked:
            refuses_to_move(world)
        else:
            assert len(written) == len(rows)
        world.check()
        return is_marked

    half = list(each_cut(world, twin(lasts_ms, world, is_written), is_half))
    assert 5 <= sum(half) < CUTS, half


def is_written(world):
    assert finish(world) == "WRITTEN, EQUAL", world.lcd()


def test_while_a_set_is_saved_it_leaves_no_file_or_a_whole_one():
    world = small()
    sets(world)
    press(world, "SET", "SET")
    whole = twin(saved, world)

    def is_unsaved(world):
        wait(world, "SAVED:", "NO CONTACT", "NO ANSWER")
        home(world)
        world.run(2000)
        found = [world.flash.files[name] for name in files(world)]
        assert [rows_of(one) for one in found] in ([], [rows_of(whole)])
        return not found

    unsaved = list(each_cut(world, twin(lasts_ms, world, saved), is_unsaved))
    assert 5 <= sum(unsaved) < CUTS, unsaved


def saved(world):
    wait(world, "SAVED:")
    home(world)
    return world.flash.files["1.set"]


# --- the power ----------------------------------------------------------------------------------


def test_at_any_step_of_the_mark_it_starts_no_motor():
    """Each single step of the file system from the yes to the end of the writing: the mark is set
    before the first value, and taken away behind the last one.
    """
    world = two()
    put(world)
    begin(world, "A1 MADE", "INTO A2 RAM")
    wait(world, "SET=WRITE")
    step, is_cut, kinds = 0, True, set()
    while is_cut:
        is_cut, kind = twin(write_with_a_power_cut, world, step)
        kinds.add(kind)
        step += 1
    assert step > 8, step
    # Nothing written; written, and the mark is still there; written and settled.
    assert kinds == {(False, False, False), (True, True, True), (True, True, False)}, kinds


def write_with_a_power_cut(world, step):
    """(whether there was such a step, (whether some is written, whether all is, the mark))."""
    world.flash.cut_at = world.flash.steps + step
    resets = world.resets
    press(world, "SET")
    world.run(6000)
    drive = world.drives[2]
    has_some = drive.read(1120) != 10.0 or drive.read(1080, 1) != 0
    has_all = drive.read(1120) == 2.5 and drive.read(1080, 1) == 5.0
    kind = has_some, has_all, bool(marks(world))
    if marks(world):
        home(world)
        refuses_to_move(world)
    else:  # nothing was written yet, or all of it
        assert has_all or not has_some, step
    world.check()
    return world.resets > resets, kind


def test_at_any_step_of_saving_it_leaves_no_set_or_a_whole_one():
    world = small()
    sets(world)
    step, is_cut, left = 0, True, []
    while is_cut:
        is_cut, file = twin(save_with_a_power_cut, world, step)
        left.append(file)
        step += 1
    assert step > 8 and left[0] is None, step
    assert set(left) == {None, left[-1]} and left[-1], left


def save_with_a_power_cut(world, step):
    """(whether there was such a step, the file that is left or None)."""
    world.flash.cut_at = world.flash.steps + step
    resets = world.resets
    press(world, "SET", "SET")
    for _ in range(600):
        if world.resets > resets or row_2(world).startswith(">SAVED:"):
            break
        world.run(100)
    world.run(3000)
    home(world)
    assert row_2(world).startswith("READY"), world.lcd()
    return world.resets > resets, world.flash.files.get("1.set")
