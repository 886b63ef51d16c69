# SPDX-License-Identifier: MIT
"""The home page takes no memory, so that no collection ever interrupts it: the heap is locked.

The firmware runs with the heap locked from the first instruction of a step to the last; only the
simulated world around it may take heap. On the 32-bit port small integers have 31 bits, as on the
chips.
"""

from micropython import heap_lock, heap_unlock

from panel_bench import LOOP_US, panel, row_1, row_2, running

MINUTES = 10


def lock(world, ms):
    """Run the firmware so long with the heap locked."""
    clock = world.clock
    advance_to = clock.advance_to

    def unlocked(at_us):
        heap_unlock()
        try:
            advance_to(at_us)
        finally:
            heap_lock()

    until_us = clock.now_us + ms * 1000
    clock.advance_to = unlocked
    try:
        while clock.now_us < until_us:
            heap_lock()
            try:
                world.app.step()
            finally:
                heap_unlock()
    finally:
        clock.advance_to = advance_to


def test_ten_minutes_of_the_home_page_take_no_memory():
    world = panel()
    world.press("START")
    world.run(2000)
    lock(world, MINUTES * 60_000)
    assert row_2(world) == "RUNNING      A1"
    world.check()


def test_nor_do_frequencies_that_change_or_three_drives_of_which_one_is_announced():
    world = panel(addresses=(1, 2, 3), keys="matrix", loop_us=LOOP_US)
    world.run(2000)  # what is read for the first time takes memory
    world.press("START")
    world.press("ADDRESS_UP")
    lock(world, 20_000)
    world.press("ADDRESS_DOWN")
    world.press("STOP")
    lock(world, 10_000)
    world.drives[3].unplug()
    world.run(3_000)  # who looks for another layout is loaded now
    lock(world, 20_000)
    world.check()


def test_nor_do_percent_and_the_output_current_in_place_of_the_frequency():
    world = running()
    for presses, unit in ((1, "%"), (3, "A")):
        for _ in range(presses):
            world.press("NEXT")
        world.run(5_000)
        lock(world, 20_000)
        assert row_1(world).rstrip().endswith(unit), world.lcd()
    world.check()


def test_a_page_that_takes_memory_would_be_noticed():
    world = panel()
    step = world.app.step_panel
    world.app.step_panel = lambda *arguments: (step(*arguments), bytearray(16))
    try:
        lock(world, 10)
    except MemoryError:
        return
    raise AssertionError("sixteen bytes were taken and nobody noticed")


def test_a_drive_that_nobody_has_started_takes_little_memory():
    """A table of fields grows in leaps: one field more would cost each of 31 drives 16 bytes."""
    world = panel(addresses=(1, 2, 3))
    world.run(3000)
    shown, *others = world.app.panel.controls
    assert shown is world.app.panel.selected
    for control in others:
        assert len(control.__dict__) == 8, sorted(control.__dict__)
