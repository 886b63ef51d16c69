# SPDX-License-Identifier: MIT
"""What the board finds wrong with its bus before the first telegram: the display says so, and
nothing is started."""

import main
from boards.sim.world import World
from hal.link.rp2_check import DEFECTS
from panel import texts
from panel_bench import OFF1, panel, row_2, said, starts, telegrams, wait_until_known

STUCK = ("driver", "uart")  # these stay whatever a drive says


def found(defect, silent=False):
    """A panel whose link has found this defect; it was switched on a second ago. silent: its drive
    never answers."""

    def start(board):
        make_link = board.make_link

        def make(baud):
            link = make_link(baud)
            link.defect = defect
            return link

        board.make_link = make
        return main.start(board)

    world = World(start)
    if silent:
        world.drives[1].unplug()
    world.run(1000)
    return world


def words(defect):
    return texts.DEFECTS[defect].decode()


def test_each_defect_has_its_words():
    assert set(texts.DEFECTS) == set(DEFECTS)
    assert len(set(texts.DEFECTS.values())) == len(texts.DEFECTS)
    assert all(len(text) <= texts.STATE_WIDTH for text in texts.DEFECTS.values())


def test_the_display_says_it_after_the_splash_and_in_place_of_no_contact():
    for defect in DEFECTS:
        world = found(defect, silent=True)
        assert words(defect) in said(world, 2_000), defect
        world.run(8_000)
        assert "%-13sA1" % words(defect) in said(world, 3_000), defect


def test_start_and_jog_are_refused_whatever_the_drive_says():
    for defect in STUCK:
        world = found(defect)
        wait_until_known(world)
        world.press("START")
        assert words(defect) in said(world, 1_000), defect
        world.press("JOG_RIGHT", 1_000)
        world.run(10_000)
        assert starts(world) == 0, defect
        world.check()


def test_stop_is_sent_all_the_same():
    world = found("driver")
    wait_until_known(world)
    since_us = world.clock.now_us
    world.press("STOP")
    world.run(200)
    assert [stw for _, stw in telegrams(world, since_us, 1)][0] == OFF1


def test_a_line_that_is_low_is_forgotten_when_a_drive_answers():
    """The bias may come with the supply of a drive, later than the panel."""
    world = found("line")
    wait_until_known(world)
    world.press("START")
    world.run(4_000)
    assert world.drives[1].state == "running", world.lcd()
    world.press("STOP")
    world.run(4_000)
    world.drives[1].unplug()
    world.run(3_000)
    assert row_2(world).startswith("NO CONTACT")


def test_a_restart_by_the_watchdog_is_said_besides():
    world = found("uart")
    world.hang(2_600)
    rows = said(world, 12_000)
    assert "WATCHDOG RESTART" in rows and words("uart") in rows, rows


def test_a_board_that_finds_nothing_starts():
    for world in (found(""), panel()):  # the virtual board's link does not even look
        wait_until_known(world)
        world.press("START")
        world.run(4_000)
        assert world.drives[1].state == "running", world.lcd()
