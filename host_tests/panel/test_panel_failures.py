# SPDX-License-Identifier: MIT
"""The operator's manual, when something fails: the drive, the line, the panel, its clock."""

import main
from boards.sim.chip.machine import Timer
from boards.sim.world import World
from panel_bench import (
    ERROR,
    LOOP_US,
    OFF1,
    ON,
    all_running,
    comes_to,
    panel,
    row_1,
    row_2,
    running,
    said,
    starts,
    telegrams,
    unsupervised,
)  # fmt: skip

# --- when the drive stops by itself --------------------------------------------------------------


def test_a_drive_that_trips_does_not_start_again_when_the_fault_is_gone():
    world = running()
    world.drives[1].fault(1)
    world.run(500)
    assert row_2(world) == "FAULT F0001  A1"
    stws = [stw for _, stw in telegrams(world, world.clock.now_us - 300_000, 1)]
    assert len(stws) > 5 and set(stws) == {OFF1}
    world.drives[1].power_off()
    world.run(3000)
    world.drives[1].power_on()
    world.run(5000)
    assert starts(world) == 1 and world.drives[1].hz() == 0
    world.check()


# --- a line that fails ---------------------------------------------------------------------------


def test_unplugged_while_it_runs_the_display_does_not_pretend():
    world = running()
    world.drives[1].unplug()
    world.run(900)
    world.run(300)
    assert world.reads("NO CONTACT, MAY RUN")
    assert "10.00" not in row_1(world)
    world.press("STOP")  # nobody knows whether it hears that
    world.run(500)
    assert world.reads("NO CONTACT, MAY RUN")
    world.run(1000)
    assert world.lcd() == ("NO CONTACT,     ", "STOP UNCONFIRMED")
    world.drives[1].plug()
    world.run(2000)
    assert row_2(world) == "FAULT F0072  A1"
    world.check()


def test_a_drive_that_took_on_and_was_never_heard_again_may_run():
    """It is unplugged between the telegram with ON and its answer, and the panel hangs."""
    for hang_ms in (0, 400):
        world = panel()
        world.down("START")
        while not telegrams(world, 0) or telegrams(world, 0)[-1][1] != ON:
            world.hang(1)
            world.app.step()
        world.hang(2)
        world.drives[1].unplug()
        world.up("START")
        world.hang(hang_ms)
        world.run(1500)
        assert world.drives[1].state == "running"
        assert world.reads("NO CONTACT, MAY RUN"), world.lcd()


def test_an_alarm_is_not_hidden_by_what_is_said_about_a_key():
    world = running()
    world.drives[1].unplug()
    world.run(1500)
    world.press("START")
    assert world.reads("NO CONTACT, MAY RUN")
    world.press("STOP")
    world.run(1500)
    world.press("START")
    assert row_2(world) == "STOP UNCONFIRMED"


def test_plugged_in_again_nothing_starts_by_itself():
    world = running(**unsupervised())
    world.drives[1].unplug()
    world.run(3000)
    assert world.drives[1].state == "running"  # nobody told it
    plugged_us = world.clock.now_us
    world.drives[1].plug()
    world.run(12000)
    assert world.drives[1].hz() == 0 and starts(world) == 1
    assert row_2(world) == "LINE FAILED  A1"
    for _, stw in telegrams(world, plugged_us, 1):
        assert stw == OFF1
    world.press("START")
    world.run(2000)
    assert row_2(world) == "RUNNING      A1" and starts(world) == 2
    world.check()


def test_a_drive_that_comes_later_is_found_and_not_started():
    world = World(main.start)
    world.drives[1].unplug()
    world.run(2000)
    assert set(said(world, 4000)) == {"NO CONTACT   A1", "A1 MAY RUN"}
    world.drives[1].plug()
    world.run(1000)
    assert row_2(world) == "READY        A1" and starts(world) == 0
    world.check()


def test_a_supervised_drive_trips_when_the_line_is_cut_and_is_acknowledged_by_stop():
    """P2014: the drive stops by itself. F0072 is read off it, STOP acknowledges, START starts."""
    world = running()
    world.drives[1].unplug()
    world.run(3000)
    assert world.drives[1].state == "fault" and world.drives[1].hz() == 0
    world.drives[1].plug()
    world.run(2000)
    assert row_2(world) == "FAULT F0072  A1"
    world.press("STOP")
    world.run(300)
    assert row_2(world) == "READY        A1" and starts(world) == 1
    world.press("START")
    world.run(2000)
    assert row_2(world) == "RUNNING      A1" and starts(world) == 2
    world.check()


def test_a_gap_of_half_a_second_is_no_loss():
    world = running()
    world.drives[1].unplug()
    world.run(500)
    world.drives[1].plug()
    world.run(500)
    assert row_2(world) == "RUNNING      A1" and starts(world) == 1
    world.check()


# --- a panel that fails --------------------------------------------------------------------------


def test_a_panel_that_hangs_before_its_first_step_is_restarted():
    world = World(main.start)
    world.hang(2_600)
    assert world.resets == 1
    world.run(2_000)
    assert world.reads("WATCHDOG RESTART")
    world.check()


def test_a_panel_that_hangs_while_it_opens_the_line_is_restarted():
    def start(board):
        make_link = board.make_link

        def hangs_once(baud):
            if not board.reset_cause:
                board.clock.advance(2_500_000)
            return make_link(baud)

        board.make_link = hangs_once
        return main.start(board)

    world = World(start)
    world.run(100)
    assert world.resets == 1
    world.run(2_000)
    assert world.reads("WATCHDOG RESTART")
    world.run(5_000)
    assert row_2(world) == "READY        A1"
    world.check()


def test_a_main_loop_that_hangs_stops_the_motor_within_400_ms():
    for polled in (False, True):
        world = running(polled=polled)
        hung_us = world.clock.now_us
        world.hang(2000)
        offs = [at_us for at_us, stw in telegrams(world, hung_us, 1) if stw == OFF1]
        # 400 ms is the promise; the loop says that it is alive in every second step, of 2 ms.
        assert offs and 296_000 <= offs[0] - hung_us <= 350_000, offs[0] - hung_us
        after = [stw for at_us, stw in telegrams(world, offs[0], 1)]
        assert ON not in after
        world.run(12000)
        assert world.drives[1].hz() == 0 and starts(world) == 1
        world.check()


def test_after_a_hang_the_panel_says_so_and_waits_for_start():
    world = running()
    world.hang(1000)
    world.run(12000)
    assert row_2(world) == "PANEL HUNG   A1" and starts(world) == 1
    world.press("START")
    world.run(2000)
    assert row_2(world) == "RUNNING      A1"
    world.check()


def test_every_drive_is_stopped_when_the_loop_hangs():
    world = all_running((1, 2, 3), loop_us=LOOP_US)
    hung_us = world.clock.now_us
    world.hang(1000)
    for address in (1, 2, 3):
        offs = [at_us for at_us, stw in telegrams(world, hung_us, address) if stw == OFF1]
        assert offs and offs[0] - hung_us <= 400_000 + 2 * 22_000
    world.check()


def test_a_hang_that_nothing_interrupts_stops_the_motor_when_it_is_over():
    """The timers are dead, and the loop itself has kept the line going: after the hang the first
    telegram already says OFF1."""
    world = running()
    for peripheral in world.chip.peripherals:
        if isinstance(peripheral, Timer):
            peripheral.die()
    world.run(500)
    assert row_2(world) == "RUNNING      A1"
    hung_us = world.clock.now_us
    world.hang(400)
    world.run(500)
    sent = [stw for _, stw in telegrams(world, hung_us, 1)]
    assert sent and ON not in sent, sent
    assert starts(world) == 1


def test_start_between_two_hangs_does_not_outlive_the_second():
    """The dead man has tripped already when START is obeyed; it holds all the same."""
    world = running()
    world.press("STOP")
    world.run(5000)
    app = world.app
    control = app.panel.selected
    read, hung = app.board.keypad.read, [False]

    def hang_in_the_step():
        if not hung[0]:
            hung[0] = True
            world.clock.advance(400_000)  # refreshed 400 ms ago: the dead man trips
            control.drive.start(0x0CCD)
        return read()

    app.board.keypad.read = hang_in_the_step
    app.step()
    del app.board.keypad.read
    hung_us = world.clock.now_us
    world.hang(1500)
    assert ON not in [stw for _, stw in telegrams(world, hung_us)]
    world.run(3000)
    assert starts(world) == 1 and world.drives[1].hz() == 0


def test_an_engine_that_gets_nothing_done_restarts_the_chip():
    """It is entered all the time and fails all the time, so that no OFF1 gets out."""

    def fail(now):
        raise ERROR

    world = running()
    world.app.bus.poll = fail
    world.run(1000)
    assert world.reads("NO CONTACT, MAY RUN")  # not the last state
    world.run(4000)
    assert world.resets == 1
    world.run(10000)
    assert world.drives[1].hz() == 0 and starts(world) == 1


def test_a_transmission_that_never_ends_is_given_up_and_tried_again():
    world = running()
    link = world.app.link
    sending_us = link.sending_us
    link.sending_us = lambda now: 1
    world.run(300)
    assert row_2(world) == "RUNNING      A1"  # a disturbance
    link.sending_us = sending_us
    world.run(1000)
    assert row_2(world) == "RUNNING      A1"
    link.sending_us = lambda now: 1
    world.run(1500)
    assert world.reads("NO CONTACT, MAY RUN")
    world.run(5000)
    assert world.resets >= 1
    world.run(10000)
    assert world.drives[1].hz() == 0 and starts(world) == 1


def test_a_loop_that_hangs_for_good_restarts_the_chip():
    world = running()
    world.hang(5000)
    assert world.resets == 1
    world.run(10000)
    assert world.drives[1].hz() == 0 and starts(world) == 1
    assert row_2(world) == "READY        A1"
    world.check()


def test_saving_the_settings_spoils_no_telegram():
    """Writing flash holds up all interrupts for a tenth of a second and more."""
    for seed in range(1, 13):
        print("seed", seed)
        world = panel(addresses=(1, 2), seed=seed)
        world.run(world.random(0, 60))
        good = [drive.counters[0] for drive in world.app.bus.turns.drives]
        world.app.settings.accept_unsupervised(2)
        began_us = world.clock.now_us
        while world.app.settings.dirty:
            world.run(2)
        assert 100_000 < world.clock.now_us - began_us < 400_000
        world.run(2000)
        assert b'"unsupervised": [2]' in world.flash.files["settings.json"]
        for drive, before in zip(world.app.bus.turns.drives, good):
            assert drive.counters[0] > before + 20 and not any(drive.counters[1:])
        world.check()


def test_a_command_that_comes_with_the_pause_goes_before_the_settings():
    """Its telegram would be under way while the flash is written, and hold the line for too long:
    nothing would end it in time.
    """
    for seed in range(1, 13):
        print("seed", seed)
        world = panel(addresses=(1, 2), seed=seed)
        world.run(world.random(0, 60))
        bus, step_panel = world.app.bus, world.app.step_panel
        told = []

        def stop_in_the_pause(*step, bus=bus, step_panel=step_panel, told=told):
            if bus.paused and not told:
                told.append(bus.turns.drives[1].stop())
            return step_panel(*step)

        world.app.step_panel = stop_in_the_pause
        world.app.settings.accept_unsupervised(2)
        world.run(2000)
        assert told and not world.app.settings.dirty
        world.check()


def test_a_start_while_the_settings_are_being_saved_is_not_lost():
    world = panel()
    world.app.settings.accept_unsupervised(1)
    world.down("START")
    world.run(1000)
    world.up("START")
    world.run(3000)
    assert world.drives[1].state == "running" and not world.app.settings.dirty
    world.check()


def test_flash_is_not_written_while_a_motor_runs_and_the_line_goes_on_meanwhile():
    """Also where the line had paused for it already when the motor was started."""
    world = running()
    app, done = world.app, []
    paused_us = world.clock.now_us
    app.bus.pause()
    app.panel.errand = lambda: done.append(world.drives[1].hz())
    app.settings.accept_unsupervised(1)
    world.run(3_000)
    assert world.drives[1].state == "running" and not done and app.settings.dirty
    sent_us = [at_us for at_us, _ in telegrams(world, paused_us, 1)]
    gaps_us = [later - earlier for earlier, later in zip([paused_us] + sent_us, sent_us)]
    assert max(gaps_us) < 200_000, gaps_us
    world.press("STOP", 300)
    world.run(6_000)
    assert done == [0] and app.panel.errand is None and not app.settings.dirty
    world.press("START")
    world.run(2_000)
    assert world.drives[1].state == "running"
    world.check()


def test_a_panel_that_the_watchdog_restarted_says_so():
    world = panel()
    assert not world.reads("WATCHDOG")
    world.hang(2500)
    assert world.resets == 1
    world.run(1000)
    assert row_2(world) == "WATCHDOG RESTART"
    world.run(4000)
    assert row_2(world) == "READY        A1"


def test_a_panel_that_was_switched_on_has_nothing_to_say_about_the_watchdog():
    world = panel()
    world.reset()
    world.run(1000)
    assert not world.reads("WATCHDOG")


def test_a_reset_ends_in_a_stopped_motor_and_no_start():
    world = running()
    reset_us = world.clock.now_us
    world.reset()
    world.run(12000)
    assert world.drives[1].hz() == 0 and starts(world) == 1
    assert row_2(world) == "READY        A1"
    for _, stw in telegrams(world, reset_us):
        assert stw == OFF1
    world.check()


def test_a_reset_in_the_middle_of_a_telegram_blocks_nothing():
    for offset_us in range(0, 22_000, 1_000):
        world = running()
        world.clock.advance(offset_us)
        world.reset()
        assert comes_to(world, "READY        A1")
        world.run(1000)
        assert row_2(world) == "READY        A1" and starts(world) == 1
        cut = [text for text in world.wire.violations() if "driver" not in text]
        assert not cut, cut


def test_an_error_in_the_program_stops_the_drives_first():
    """Ctrl-C or an exception: the motor is told to stop before the program ends."""
    for error in (KeyboardInterrupt, ValueError):
        world = World(main.start)
        world.run(1000)
        world.press("START")
        world.run(3000)
        left_us = world.clock.now_us
        leave(world.app, error)
        sent = telegrams(world, left_us, 1)
        offs = [at_us for at_us, stw in sent if stw == OFF1]
        assert offs[0] - left_us < 50_000 and sent[-1][1] == OFF1
        last_us = world.wire.log.last(1)[0][0]
        world.hang(1500)  # no interrupt is left that could send; then the watchdog bites
        assert world.wire.log.last(1)[0][0] == last_us
        assert world.drives[1].state in ("stopping", "ready")
        world.check()


def leave(app, error):
    """Let `error` end the main loop as it would on the chip."""

    class Broken:
        names = app.board.keypad.names

        def read(self, most=-1):
            raise error("on purpose")

    app.board.keypad = Broken()
    try:
        main.loop(app)
    except error:
        return
    raise AssertionError("the error got lost")


def fail(drive, times):
    """Let `drive` fail so many times at the replies to come. The heap is locked then: nothing is
    made there."""
    take = drive.take
    left = [times]

    def fail_to_take(buffer, count, now):
        if left[0]:
            left[0] -= 1
            raise ERROR
        take(buffer, count, now)

    drive.take = fail_to_take


def test_an_exception_in_the_bus_engine_stops_the_motor_and_is_shown():
    world = running()
    bus = world.app.bus
    fail(bus.turns.drives[0], 3)
    world.run(12000)
    assert bus.failures == 3
    assert world.drives[1].hz() == 0 and starts(world) == 1
    assert row_2(world) == "BUS ERROR    A1"


# --- the clock wraps -----------------------------------------------------------------------------


def test_ticks_that_wrap_in_the_middle_of_an_exchange_disturb_nothing():
    """The counter wraps once at each instant of an exchange while the motor runs."""
    for bits in (24, 30):
        mask = (1 << bits) - 1
        for offset_us in range(0, 24_000, 2_400):
            world = running(
                ticks_start=mask - 5_250_000 - offset_us, ticks_mask=mask, loop_us=LOOP_US
            )
            wrapped_us = 5_250_000 + offset_us
            assert world.clock.now_us < wrapped_us
            world.run(300)
            assert world.clock.now_us > wrapped_us
            assert row_2(world) == "RUNNING      A1" and starts(world) == 1
            assert world.app.bus.dead_man_trips == 0
            world.check()


def test_a_short_period_wraps_many_times_in_an_hour():
    """2**24 us is 16.8 s."""
    world = running(ticks_mask=(1 << 24) - 1)
    world.run(120_000)
    assert row_2(world) == "RUNNING      A1" and starts(world) == 1
    world.press("STOP")
    world.run(8000)
    assert row_2(world) == "READY        A1"
    world.check()


def test_a_gap_that_the_loop_has_slept_through_was_the_line():
    world = running(settings={"lost_ms": 100})
    world.drives[1].unplug()
    world.hang(180)
    world.drives[1].plug()
    world.hang(80)
    assert world.app.bus.turns.drives[0].contact and world.app.bus.dead_man_trips == 0
    world.run(6000)
    assert row_2(world) == "LINE FAILED  A1"
    world.check()


def test_a_drive_that_is_lost_while_it_ramps_down_may_run():
    world = running(**unsupervised())
    world.drives[1].write(1121, 0, 60.0)
    world.press("STOP")
    world.run(300)
    world.drives[1].unplug()
    world.run(1500)
    assert row_1(world) == "NO CONTACT,     "
    world.check()


def test_a_panel_that_hangs_while_it_prepares_a_start_starts_nothing():
    """A key counts 20 ms after it went down, acts in the next step, and a START is prepared in the
    steps behind that."""
    for ms in range(22, 60, 2):
        world = panel()
        world.down("START")
        world.run(ms)
        world.hang(1000)
        world.up("START")
        world.run(1000)
        assert row_2(world).startswith("PANEL HUNG"), (ms, row_2(world))
        world.run(3000)
        assert starts(world) == 0
        world.check()
