# SPDX-License-Identifier: MIT
"""A panel that begins anew: the one before has left the memory by then.

With 31 drives a chip has no room for two. What a collector takes for a pointer may hold much of
the old one all the same: with 64 bits hardly any word looks like one by chance.
"""

import gc

import app
from panel_bench import panel, wait_until

INTERPRETERS = "unix64"

DRIVE_BYTES = 700


def test_there_are_never_two_panels_in_memory():
    world = panel(addresses=tuple(range(31)))
    wait_until(world, lambda: not world.app.panel.any_runs(), 5_000)
    taken = []
    begin = app.App.__init__

    def begin_and_note(one, board):
        gc.collect()
        taken.append(gc.mem_alloc())
        begin(one, board)

    gc.collect()
    before = gc.mem_alloc()
    app.App.__init__ = begin_and_note
    try:
        world.app.panel.wants = "app"
        world.run(1500)
    finally:
        app.App.__init__ = begin
    assert len(taken) == 1 and taken[0] < before - 31 * DRIVE_BYTES, (before, taken)
