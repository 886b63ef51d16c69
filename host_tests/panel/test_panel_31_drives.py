# SPDX-License-Identifier: MIT
"""A panel with 31 drives: no step of the main loop may look at all of them, nor miss one for long.

Every drive is on the line and answers; the master's list has each of them once.
"""

import main
from panel.control import Control
from panel_bench import (
    LOOP_US,
    SlowWorld,
    panel,
    row_2,
    starts,
    telegrams,
    unsupervised,
    wait_until_known,
)  # fmt: skip

ADDRESSES = tuple(range(1, 32))
SETTLE_MS = 10_000  # each has told its settings by then


class Counted:
    """The looks at drives, step by step: the most that one step has taken."""

    NAMES = ("ask", "watch", "is_active", "stop_unseen")

    def __init__(self, world):
        self.most = 0
        self._step = world.app.step_panel
        self._seen = set()
        self._methods = [getattr(Control, name) for name in self.NAMES]
        for name, method in zip(self.NAMES, self._methods):
            setattr(Control, name, self._counting(method))
        world.app.step_panel = self._count

    def _counting(self, method):
        def counted(control, *arguments):
            self._seen.add(control.drive.address)
            return method(control, *arguments)

        return counted

    def _count(self, *arguments):
        self._seen = set()
        answer = self._step(*arguments)
        self.most = max(self.most, len(self._seen))
        return answer

    def end(self):
        for name, method in zip(self.NAMES, self._methods):
            setattr(Control, name, method)


def settled():
    world = panel(baud=115200, loop_us=LOOP_US, **unsupervised(*ADDRESSES))
    world.run(SETTLE_MS)
    return world


def start(world, *addresses):
    """START for some drives, one after the other."""
    while world.app.panel.selected.drive.address != addresses[-1]:
        if world.app.panel.selected.drive.address in addresses:
            wait_until_known(world)
            world.press("START")
            world.run(1_000)
        world.press("ADDRESS_UP", 30)
    wait_until_known(world)
    world.press("START")
    world.run(3_000)
    for address in addresses:
        assert world.drives[address].state == "running", world.drives[address].report()


def test_no_step_looks_at_more_than_two_drives():
    world = settled()
    counted = Counted(world)
    try:
        start(world, 2, 17)
        world.press("STOP", 5_000)  # all of them
        world.run(8_000)
    finally:
        counted.end()
    assert 0 < counted.most <= 2
    world.check()


def test_a_stop_held_for_four_seconds_reaches_all_and_soon_those_that_run():
    world = settled()
    start(world, 3, 29)
    pressed_us = world.clock.now_us
    world.press("STOP", 5_000)
    assert row_2(world) == "ALL DRIVES: STOP"
    last_on_us = max(at_us for at_us, stw in telegrams(world, pressed_us, 3) if stw & 1)
    assert 3_900_000 < last_on_us - pressed_us < 4_250_000
    for address in ADDRESSES:
        sent = telegrams(world, pressed_us + 4_250_000, address)
        assert sent and not [stw for _, stw in sent if stw & 1], address
    world.run(8_000)
    for address in ADDRESSES:
        assert world.drives[address].hz() == 0
    assert not world.app.panel.any_runs()
    world.check()


def test_another_drive_that_runs_or_is_lost_is_announced_wherever_it_stands_in_the_list():
    for address in (2, 31):
        world = settled()
        start(world, address)
        world.press("ADDRESS_DOWN" if address == 2 else "ADDRESS_UP")  # 1 is shown
        seen = set()
        for _ in range(40):
            world.run(100)
            seen.add(row_2(world))
        assert "A%d RUN,HOLD=ALL" % address in seen
        world.drives[address].unplug()
        seen = set()
        for _ in range(60):
            world.run(100)
            seen.add(row_2(world))
        assert "A%d LOST,MAY RUN" % address in seen
        assert world.app.panel.any_runs()
        world.check()


def test_whether_any_runs_is_known_soon_after_one_does():
    world = settled()
    assert not world.app.panel.any_runs()
    start(world, 16)
    world.press("ADDRESS_UP")
    assert world.app.panel.any_runs()
    world.run(1_000)
    assert world.app.panel.any_runs()
    world.press("ADDRESS_DOWN")
    world.press("STOP")
    world.run(8_000)
    world.press("ADDRESS_UP")
    world.run(1_500)
    assert not world.app.panel.any_runs()
    world.check()


def test_a_start_that_is_not_through_in_twelve_seconds_is_given_up_though_the_drive_told_all():
    """Another drive is shown, the loop is slow, and each look before ON is left to a turn of its
    own. A START pressed 20 s ago is forgotten; the motor must not turn.
    """
    world = SlowWorld(main.start, addresses=ADDRESSES, baud=115200, seed=1)
    world.run(30_000)
    wait_until_known(world)
    world.press("START")
    world.run(600)  # it has told nearly all by then
    world.press("ADDRESS_UP")
    rows = set()
    for _ in range(300):
        world.run(100)
        rows.add(row_2(world).rstrip())
    assert "A1 NOT STARTED" in rows
    assert starts(world) == 0
    world.check()
