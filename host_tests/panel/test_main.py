# SPDX-License-Identifier: MIT
"""The firmware's first file: finds the board, honours the escape key, stops the drives."""

import sys

import main
from boards.sim.clock import Event
from boards.sim.line.intruder import Intruder
from boards.sim.world import World
from panel_bench import panel, unsupervised, wait_until


class Switch:
    """A virtual board that main() finds as the module `board`, and how its loop ends."""

    def __init__(self, held=None, ends_after_ms=3000, error=KeyboardInterrupt):
        self.started = []
        self.world = World(self.keep)
        self.board = self.started.pop()
        if held:
            self.world.down(held)
        self.board.idle = self.idle
        self.end_us = self.world.clock.now_us + ends_after_ms * 1000
        self.error = error

    def keep(self, board):
        self.started.append(board)
        return self

    def idle(self):
        self.world.clock.advance(2000)
        if self.error and self.world.clock.now_us >= self.end_us:
            error, self.error = self.error, None
            raise error

    def power_on(self):
        """Run main() to its end; answer whether that is the prompt."""
        sys.modules["board"] = self.board
        try:
            main.main()
        except ValueError:
            return False
        finally:
            del sys.modules["board"]
        return True


def test_the_panel_runs_until_ctrl_c_and_then_everything_is_quiet():
    switch = Switch()
    assert switch.power_on()
    switch.world.clock.advance(200_000)
    sent = switch.world.wire.log.count
    switch.world.clock.advance(1_000_000)
    assert sent > 100 and switch.world.wire.log.count == sent
    switch.world.check()


def test_after_ctrl_c_the_display_does_not_go_on_saying_what_no_longer_holds():
    switch = Switch(ends_after_ms=4000)
    world = switch.world
    world.clock.schedule(Event(lambda: world.down("START")), world.clock.now_us + 1_500_000)
    assert switch.power_on()
    assert world.lcd() == ("PANEL STOPPED   ", "NO CONTROL      ")


def test_a_display_that_fails_does_not_keep_the_panel_from_ending():
    switch = Switch()

    def fail(_picture):
        raise ValueError

    failure = Event(lambda: setattr(switch.board.display, "show", fail))
    switch.world.clock.schedule(failure, switch.world.clock.now_us + 1_000_000)
    assert not switch.power_on()
    sent = switch.world.wire.log.count
    switch.world.clock.advance(1_000_000)
    assert switch.world.wire.log.count == sent


class SlowDisplay:
    """It shows all of a picture with the piece of this number."""

    def __init__(self, pieces):
        self.pieces, self.shown = pieces, 0

    def show(self, _picture):
        self.shown += 1
        return self.shown == self.pieces


def test_the_last_picture_is_given_a_hundred_pieces_and_no_more_than_it_needs():
    for pieces, shown in ((1, 1), (7, 7), (100, 100), (101, 100)):
        world = World(main.start)
        world.app.board.display = display = SlowDisplay(pieces)
        rests = []
        idle = world.app.board.idle
        world.app.board.idle = lambda: rests.append(display.shown) or idle()
        world.app.close()
        assert display.shown == shown
        # Between two of them is a turn of the loop.
        assert [rest for rest in rests if rest] == list(range(1, shown + (pieces > 100)))


def test_ctrl_c_ends_in_a_maintenance_mode_without_watchdog():
    switch = Switch()
    bites = []
    switch.world.chip.on_bite = lambda: bites.append(switch.world.clock.now_us)
    assert switch.power_on()
    switch.world.clock.advance(10_000_000)
    assert not bites


def test_a_panel_that_failed_is_restarted_by_the_watchdog():
    switch = Switch(error=ValueError("a defect of the firmware"))
    bites = []
    switch.world.chip.on_bite = lambda: bites.append(switch.world.clock.now_us)
    assert not switch.power_on()
    ended_us = switch.world.clock.now_us
    switch.world.clock.advance(2_001_000)
    assert len(bites) == 1 and bites[0] <= ended_us + 2_000_000


def test_ctrl_c_while_the_bus_is_being_started_leaves_no_interrupt_behind():
    switch = Switch()
    switch.board.timer.init = interrupting(switch.board.timer.init)
    assert switch.power_on()
    sent = switch.world.wire.log.count
    switch.world.clock.advance(1_000_000)
    assert switch.world.wire.log.count == sent


def test_ctrl_c_again_and_again_does_not_keep_the_drives_from_being_stopped():
    switch = Switch(ends_after_ms=4000)
    again = switch.idle
    world = switch.world
    world.clock.schedule(Event(lambda: world.down("START")), world.clock.now_us + 1_000_000)

    def impatient():
        again()
        if switch.error is None:
            raise KeyboardInterrupt

    switch.board.idle = impatient
    assert switch.power_on()
    assert world.drives[1].state == "stopping"
    sent = world.wire.log.count
    world.clock.advance(1_000_000)
    assert world.wire.log.count == sent


def test_a_second_ctrl_c_wherever_it_strikes_leaves_no_motor_running():
    for name in ("_go_on", "stop_all", "close", "stop"):
        world = World(main.start)
        world.run(1000)
        world.press("START")
        world.run(2000)
        app = world.app
        owner = {"stop_all": app.bus, "close": app.bus, "stop": app.pacer}.get(name, app)
        interrupt(owner, name)
        app.close()
        assert world.drives[1].state == "stopping", name
        sent = world.wire.log.count
        world.clock.advance(1_000_000)
        assert world.wire.log.count == sent, name


def interrupting(function):
    """The function, but that Ctrl-C strikes when it is called for the first time."""
    calls = []

    def interrupted(**arguments):
        calls.append(1)
        if len(calls) == 1:
            raise KeyboardInterrupt
        return function(**arguments)

    return interrupted


def interrupt(owner, name):
    """Ctrl-C strikes at the beginning of the first call of a method, and of the third."""
    method = getattr(owner, name)
    calls = []

    def interrupted(*arguments):
        calls.append(name)
        if len(calls) in (1, 3):
            raise KeyboardInterrupt
        return method(*arguments)

    setattr(owner, name, interrupted)


def test_ctrl_c_stops_a_drive_that_runs_before_anything_else_ends():
    switch = Switch(ends_after_ms=4000)
    world = switch.world
    world.clock.schedule(Event(lambda: world.down("START")), world.clock.now_us + 1_500_000)
    assert switch.power_on()
    assert world.drives[1].state == "stopping"
    world.check()


def test_a_drive_that_does_not_answer_does_not_keep_the_program_from_ending():
    switch = Switch(ends_after_ms=4000)
    world = switch.world
    world.clock.schedule(Event(lambda: world.down("START")), world.clock.now_us + 1_500_000)
    world.clock.schedule(Event(world.drives[1].unplug), switch.end_us - 20_000)
    assert switch.power_on()
    assert world.clock.now_us - switch.end_us < 1_500_000
    sent = world.wire.log.count
    world.clock.advance(1_000_000)
    assert world.wire.log.count == sent


def test_down_held_at_power_on_leaves_the_chip_at_the_prompt():
    switch = Switch(held="DOWN")
    assert switch.power_on()
    switch.world.clock.advance(2_000_000)
    assert switch.world.wire.log.count == 0


def test_another_key_held_at_power_on_does_not():
    switch = Switch(held="START")
    assert switch.power_on()
    assert switch.world.wire.log.count > 0


def test_a_board_without_the_escape_key_has_no_escape():
    class Keypad:
        names = ("START", "STOP")

        def read(self, most=-1):
            return 3

    assert main.escape_wanted(Keypad()) is False


def test_closing_waits_until_every_drive_of_a_long_list_was_sent_off():
    """Eight drives at 1200 baud: a round takes longer than two seconds. P2014 = 0."""
    world = panel(baud=1200, **unsupervised(1, 2, 3, 4, 5, 6, 7, 8))
    world.run(30_000)
    for address in range(1, 9):
        drive = world.drives[address]
        while drive.state != "running":
            world.press("START")  # again where this line takes too long to read all settings
            wait_until(world, lambda: drive.state == "running", 20_000)
            assert world.clock.now_us < 1_500_000_000, world.lcd()
        world.press("ADDRESS_UP")
    world.app.close()
    world.clock.advance(20_000_000)
    for drive in world.drives.values():
        assert drive.state == "ready", drive.report()
    world.check()


def test_closing_does_not_wait_on_a_line_that_another_master_uses():
    world = World(main.start)
    intruder = Intruder(world.clock, world.wire, b"\x02\x02\x01\x01", 40_000)
    intruder.begin()
    world.run(1_000)
    assert world.app.bus.is_line_in_use()
    assert closed_after_us(world) < 300_000  # for the picture
    assert not [1 for _, from_panel, _ in world.wire.log.last(1000) if from_panel]


def test_closing_at_once_tells_every_drive_to_stop():
    """It may have been left running by whoever used the line before."""
    world = World(main.start, addresses=(1, 2))
    world.run(20)
    assert world.wire.log.count == 0 and closed_after_us(world) < 500_000
    sent = [each[2] for _, from_panel, each in world.wire.log.last(1000) if from_panel]
    assert sorted(sent) == [1, 2]
    world.check()


def closed_after_us(world):
    began_us = world.clock.now_us
    world.app.close()
    return world.clock.now_us - began_us


def test_closing_a_short_list_does_not_wait_for_drives_that_are_away():
    world = panel(addresses=(1, 2))
    world.drives[1].unplug()
    world.drives[2].unplug()
    began_us = world.clock.now_us
    world.app.close()
    assert world.clock.now_us - began_us < 2_000_000
    world.check()
