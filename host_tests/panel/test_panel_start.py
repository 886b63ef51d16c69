# SPDX-License-Identifier: MIT
"""The operator's manual, START: what is asked before a motor turns, and when it is refused."""

import main
from boards.sim.world import World
from panel import texts
from panel.command import Command
from panel_bench import (
    LOOP_US,
    OFF1,
    ON,
    panel,
    row_1,
    row_2,
    running,
    said,
    settled_row_2,
    starts,
    telegrams,
    unsupervised,
    wait_until_known,
)  # fmt: skip
from uss import pkw, pzd
from uss.families import rows


def refused(world, reason):
    before = starts(world)
    world.press("START")
    assert row_2(world) == reason, row_2(world)
    world.run(6000)
    assert starts(world) == before
    world.check()


def test_start_of_a_silent_drive_is_refused():
    world = panel()
    world.drives[1].unplug()
    world.run(1500)
    assert row_2(world) == "NO CONTACT   A1" and row_1(world) == "S: 10.0 F: -----"
    refused(world, "NO: NO CONTACT")


def test_start_of_a_drive_with_a_fault_is_refused():
    world = panel()
    world.drives[1].fault(1)
    world.run(300)
    assert row_2(world) == "FAULT F0001  A1"
    refused(world, "NO: FAULT")


def test_start_of_a_drive_that_takes_its_commands_elsewhere_is_refused():
    world = panel()
    world.drives[1].write(700, 0, 2)
    world.run(3000)
    assert row_2(world) == "LOCAL        A1"
    refused(world, "NO:P0700 NOT USS")


def test_start_of_a_drive_that_takes_its_setpoint_elsewhere_is_refused():
    world = panel()
    world.drives[1].write(1000, 0, 2)
    world.run(3000)
    refused(world, "NO:P1000 NOT USS")


def test_start_of_a_drive_whose_scaling_is_still_unknown_is_refused():
    world = panel(baud=2400, loop_us=LOOP_US)  # a slow line: reading the settings takes a second
    assert row_2(world) == "CHECKING     A1"
    refused(world, "NO: STILL CHECKS")


def test_start_of_a_drive_that_keeps_its_scaling_to_itself_is_refused():
    """It refuses to tell P2009: what a setpoint would mean is unknown."""
    world = World(main.start)
    parameters = world.drives[1].parameters
    parameters.rows = {row: parameters.rows[row] for row in parameters.rows if row != 2009}
    world.run(2000)
    assert row_2(world) == "CHECKING     A1"
    refused(world, "NO: SCALING ???")


def test_start_of_an_inhibited_drive_is_refused():
    """OFF2 at the drive's own terminal, say: its inhibit stays while the cause does."""
    world = panel()
    world.drives[1].process.zsw = lambda: 0xFB71
    world.run(300)
    assert row_2(world) == "INHIBITED    A1"
    refused(world, "NO: INHIBITED")
    world = panel()
    world.drives[1].process.zsw = lambda: 0xFB30
    world.run(300)
    assert row_2(world) == "NOT READY    A1"
    refused(world, "NO: NOT READY")


def test_start_asks_the_drive_what_the_setpoint_means():
    """P2000 changed in the last moment: 10 Hz are 10 Hz from the first telegram with ON."""
    for before, after in ((50.0, 650.0), (650.0, 50.0)):
        world = panel()
        world.drives[1].write(1082, 0, 650.0)
        world.drives[1].write(2000, 0, before)
        world.run(3000)
        world.drives[1].write(2000, 0, after)
        world.press("START")
        for _ in range(300):
            world.run(10)
            assert world.drives[1].hz() < 10.1
        assert abs(world.drives[1].hz() - 10) < 0.1
        world.check()


def test_a_start_that_waited_through_a_hang_is_void():
    world = panel()
    world.drives[1].stale_replies = 30  # it takes its time to tell its settings
    world.press("START")
    assert row_2(world) == "STARTING     A1"
    world.hang(400)
    world.drives[1].stale_replies = 0
    world.run(3000)
    assert row_2(world) == "PANEL HUNG   A1" and starts(world) == 0
    world.check()


def test_a_start_that_has_waited_for_twelve_seconds_is_given_up():
    """The drive tells its settings too slowly: by then nobody expects the motor to turn."""
    world = panel()
    wait_until_known(world)
    world.drives[1].stale_replies = 40
    world.press("START")
    world.run(11_500)
    assert row_2(world) == "STARTING     A1" and starts(world) == 0
    world.run(700)
    assert row_2(world) == "NO: STILL CHECKS"
    world.run(30_000)
    assert starts(world) == 0
    world.drives[1].stale_replies = 0
    world.run(3000)
    world.press("START")
    world.run(3000)
    assert starts(world) == 1
    world.check()


def test_at_the_lowest_rate_a_drive_tells_its_settings_in_time():
    world = World(main.start, baud=1200, **unsupervised(1, 2, 3))
    world.run(3000)
    wait_until_known(world, 120_000)
    world.press("START")
    world.run(12_000)
    assert starts(world) == 1
    world.check()


def test_a_start_of_which_the_drive_changes_its_mind_is_taken_back():
    """P0700 is changed after ON has been sent and before the motor turns."""
    world = panel()
    world.drives[1].write(10, 0, 1)  # it does not start yet
    world.press("START")
    world.run(500)
    assert row_2(world) == "STARTING     A1"
    world.drives[1].write(700, 0, 2)
    world.run(4000)  # before it has been STARTING for 5 s
    assert row_2(world) == "TAKEN AWAY   A1"
    world.check()


def test_a_drive_that_takes_its_setpoint_from_elsewhere_is_stopped():
    world = running()
    world.drives[1].write(1000, 0, 2)
    world.run(2500)
    assert OFF1 == telegrams(world, 0, 1)[-1][1]
    world.run(6000)
    assert row_2(world) == "TAKEN AWAY   A1" and world.drives[1].hz() == 0
    world.check()


def test_a_start_takes_little_of_the_line_from_a_drive_that_runs():
    """While one drive is asked for its settings, the others are polled at half their rate."""
    for baud in (9600, 19200, 57600):
        world = running(addresses=(1, 2), baud=baud)
        instants = [at_us for at_us, _ in telegrams(world, 0, 1)][-20:]
        cycle_us = max(after - before for before, after in zip(instants, instants[1:]))
        pressed_us = world.clock.now_us
        world.press("ADDRESS_UP")
        world.press("START")
        world.run(3000)
        assert world.drives[2].state == "running"
        instants = [at_us for at_us, _ in telegrams(world, pressed_us, 1)]
        longest_us = max(after - before for before, after in zip(instants, instants[1:]))
        # The ON itself goes before the list as well.
        assert longest_us <= 2 * cycle_us + cycle_us // 2, (baud, longest_us, cycle_us)
        world.check()


def test_a_stop_goes_before_the_start_of_another_drive():
    world = panel(addresses=(1, 2), baud=2400)
    world.run(8000)
    world.press("START")
    assert row_2(world) == "STARTING     A1"
    world.press("ADDRESS_UP")
    pressed_us = world.clock.now_us
    world.press("STOP")
    world.run(500)
    first_us = telegrams(world, pressed_us, 2)[0][0]
    exchange_us = 2 * 73_400 + 3 * 4_600
    assert first_us - pressed_us <= 24_000 + 2 * exchange_us
    world.check()


def test_two_drives_may_be_started_one_right_after_the_other():
    world = panel(addresses=(1, 2), baud=9600)
    world.run(2000)
    world.press("START")
    world.press("ADDRESS_UP")
    world.press("START")
    world.run(4000)
    assert [world.drives[address].state for address in (1, 2)] == ["running", "running"]
    world.check()


def test_a_start_refused_while_another_drive_is_shown_is_not_said_of_that_one():
    world = panel(addresses=(1, 2), baud=2400)
    world.run(8000)
    world.press("START")
    world.press("ADDRESS_UP")
    world.drives[1].fault(1)
    world.run(3000)
    rows = said(world, 4000)
    assert set(rows) == {"READY        A2", "A1 FAULT F0001"}, rows
    world.press("ADDRESS_DOWN")
    world.run(100)
    assert row_2(world) == "FAULT F0001  A1" and starts(world) == 0
    world.check()


def test_the_settings_of_a_drive_that_was_away_are_read_anew():
    world = panel(**unsupervised())
    world.drives[1].unplug()
    world.run(2000)
    world.drives[1].write(700, 0, 2)
    world.drives[1].plug()
    survey = world.app.panel.selected.survey
    while not world.app.bus.turns.drives[0].contact:
        world.run(2)
    world.run(4)
    assert not survey.complete and survey.scaling is None
    world.run(1500)
    assert row_2(world) == "LOCAL        A1"
    world.check()


def test_a_drive_that_runs_on_other_commands_is_said_to():
    world = running()
    world.drives[1].write(700, 0, 2)
    world.drives[1].process.words = lambda count: [0xFB34, 0x0CCD]
    world.reset()
    world.run(4000)
    assert row_2(world) == "RUNS LOCALLY A1"


def test_the_setpoint_is_never_more_than_its_word_can_say():
    world = panel(settings={"setpoint_centihertz": 60_000})
    world.drives[1].write(1082, 0, 650.0)
    world.drives[1].write(2000, 0, 10.0)
    world.run(3000)
    assert row_1(world).startswith("S: 20.0")  # 19.99 Hz
    world.drives[1].write(2009, 0, 1)
    world.run(3000)
    assert row_1(world).startswith("S:327.7")
    world.check()


def test_the_setpoint_stays_within_the_limits_of_the_settings():
    world = panel(settings={"lowest_centihertz": 900, "highest_centihertz": 1100})
    world.press("UP", 3000)
    assert row_1(world).startswith("S: 11.0")
    world.press("DOWN", 3000)
    assert row_1(world).startswith("S:  9.0")
    world.check()


def test_the_setpoint_does_not_move_while_it_cannot_be_sent():
    """A drive that stops telling its settings while it runs: what is shown is what is sent."""
    world = running(loop_us=LOOP_US)
    parameters = world.drives[1].parameters
    parameters.rows = {row: parameters.rows[row] for row in parameters.rows if row != 1080}
    world.run(3000)
    world.press("UP")
    assert row_1(world) == "S: 10.0 F: 10.00" and row_2(world) == "NO: STILL CHECKS"
    world.check()


def test_what_is_shown_is_what_is_sent_though_the_limits_are_not_told_any_more():
    world = panel(parameters={2014: 2000, 1080: 20.0})
    world.press("START")
    world.run(6000)
    assert row_1(world) == "S: 20.0 F: 20.00"
    world.drives[1].stale_replies = 100_000
    world.run(8000)
    assert row_1(world).startswith("S: 20.0") and abs(world.drives[1].hz() - 20) < 0.01
    world.check()


def test_start_in_the_splash_is_told_that_it_does_not_count():
    world = World(main.start)
    world.run(300)
    world.press("START")
    assert row_2(world) == "NO: PRESS AGAIN"
    world.run(3000)
    assert starts(world) == 0


def test_another_key_ends_the_splash_and_refuses_nothing():
    world = World(main.start)
    world.run(300)
    splash = world.lcd()
    world.press("UP")
    assert world.lcd() != splash and not row_2(world).startswith("NO:"), world.lcd()
    world.run(3000)
    assert row_1(world) == "S: 10.0 F:  0.00" and row_2(world) == "READY        A1"


def test_the_time_after_which_a_drive_is_lost_is_that_of_the_settings():
    for lost_ms in (300, 3000):
        world = panel(settings={"lost_ms": lost_ms})
        world.drives[1].unplug()
        world.run(lost_ms - 100)
        assert world.app.bus.turns.drives[0].contact and row_2(world) != "NO CONTACT   A1"
        world.run(300)
        assert row_2(world) == "NO CONTACT   A1"


def test_the_wait_for_a_reply_is_that_of_the_settings():
    for reply_timeout_ms, text in ((20, "NO CONTACT   A1"), (60, "READY        A1")):
        world = World(main.start, settings={"reply_timeout_ms": reply_timeout_ms})
        world.drives[1].reply_delay_us = 45_000
        world.run(3000)
        assert row_2(world) == text


def test_other_parameter_jobs_do_not_disturb_the_panel():
    """An own program fills the queue of the drive."""
    world = panel()
    drive = world.app.bus.turns.drives[0]
    for _ in range(50):
        while not drive.channel.is_full():
            drive.ask(pkw.read(1120))
        world.run(20)
    assert row_2(world) == "READY        A1"
    world.check()


def test_stop_takes_back_a_start_whose_drive_is_still_being_asked():
    for baud in (2400, 9600):
        world = panel(baud=baud, loop_us=LOOP_US)
        world.run(4000)
        world.press("START", 40)
        assert row_2(world) == "STARTING     A1"
        world.press("STOP", 40)
        world.run(6000)
        assert starts(world) == 0 and row_2(world) == "READY        A1"
        assert ON not in [stw for _, stw in telegrams(world, 0)]
        world.check()


def test_stop_acknowledges_what_is_said_about_the_drive():
    world = running()
    world.hang(1000)
    world.run(5000)
    assert row_2(world) == "PANEL HUNG   A1"
    world.press("STOP")
    world.run(200)
    assert row_2(world) == "READY        A1"
    world.check()


def test_start_is_not_obeyed_late():
    """The line fails while the drive is being asked; a START of seconds ago is void."""
    world = panel()
    world.down("START")
    world.run(30)
    world.drives[1].unplug()
    world.run(500)
    world.up("START")
    world.hang(1000)
    world.drives[1].plug()
    world.run(5000)
    assert starts(world) == 0
    world.check()


def test_start_of_a_drive_too_fast_to_be_told_is_refused():
    """P1080 above 200 % of P2000: HSW and HIW cannot say its frequency."""
    for p2000, p2009 in ((50.0, 0), (50.0, 1)):
        world = panel()
        world.drives[1].write(1082, 0, 650.0)
        world.drives[1].write(1080, 0, 400.0)
        world.drives[1].write(2000, 0, p2000)
        world.drives[1].write(2009, 0, p2009)
        world.run(3000)
        refused(world, "NO: P1080 > 200%")


def test_a_frequency_that_the_word_cannot_say_is_not_shown_as_one_it_can():
    world = running()
    words = world.drives[1].process.words
    for hiw in (0x7FFF, 0x8000):
        world.drives[1].process.words = lambda wanted: [words(wanted)[0], hiw]
        world.run(300)
        assert row_1(world) == "S: 10.0 F: >>>>>"


def test_the_setpoint_comes_back_when_a_limit_goes_away():
    world = panel()
    world.drives[1].write(1080, 0, 40.0)
    world.run(3000)
    assert row_1(world).startswith("S: 40.0")
    world.drives[1].write(1080, 0, 0.0)
    world.run(3000)
    assert row_1(world).startswith("S: 10.0")
    world.check()


def test_what_is_changed_at_the_drive_is_noticed_and_used():
    """P2000 doubled behind the bus's back: 10 Hz are 10 Hz all the same."""
    world = panel()
    world.drives[1].write(2000, 0, 100.0)
    world.run(3000)
    world.press("START")
    world.run(4000)
    assert row_1(world) == "S: 10.0 F: 10.00" and abs(world.drives[1].hz() - 10) < 0.02
    world.check()


def test_hundredths_of_a_hertz_are_understood():
    """P2009 = 1: PZD2 is the frequency itself."""
    world = panel()
    world.drives[1].write(2009, 0, 1)
    world.run(3000)
    world.press("START")
    world.run(4000)
    assert row_1(world) == "S: 10.0 F: 10.00"
    assert world.wire.log.last(2)[0][2][13:15] == b"\x03\xe8"
    world.check()


def test_a_drive_that_does_not_start_is_not_left_waiting_with_on():
    """P0010 blocks ON. It must not take effect when somebody finishes commissioning."""
    world = panel()
    world.drives[1].write(10, 0, 1)
    world.press("START")
    world.run(4000)
    assert row_2(world) == "STARTING     A1"
    world.run(2000)
    assert row_2(world) == "NOT STARTED  A1"
    world.drives[1].write(10, 0, 0)
    world.run(3000)
    assert starts(world) == 0
    world.check()


def test_start_of_a_drive_that_runs_changes_nothing():
    """Not even when it would be asked about by now."""
    world = running()
    world.drives[1].write(2014, 0, 0)
    world.press("START")
    for _ in range(40):
        world.run(50)
        assert settled_row_2(world) in ("RUNNING      A1", "RUN, P2014=0 A1"), world.lcd()
    assert starts(world) == 1
    world.check()


def test_a_drive_that_ran_before_is_not_left_waiting_with_on_either():
    world = running()
    world.press("STOP")
    world.run(5000)
    world.drives[1].write(10, 0, 1)  # commissioning: it does not run
    world.run(300)
    world.press("START")
    world.run(6500)
    assert row_2(world) == "NOT STARTED  A1"
    world.drives[1].write(10, 0, 0)
    world.run(3000)
    assert starts(world) == 1
    world.check()


def test_a_start_that_was_taken_back_asks_the_drive_nothing_more():
    world = panel()
    world.down("START")
    world.run(150)  # it begins in the turns that follow
    drive = world.app.bus.turns.drives[0]
    assert drive.asking
    world.press("STOP", 20)
    assert not drive.asking
    world.check()


def test_a_source_of_zero_is_another_source():
    """P0700 = 0 is the factory setting, P1000 = 0 no setpoint at all: neither is this bus."""
    for number, reason in ((700, "NO:P0700 NOT USS"), (1000, "NO:P1000 NOT USS")):
        world = panel()
        world.drives[1].write(number, 0, 0)
        world.run(3000)
        refused(world, reason)


def test_a_lowest_frequency_above_the_highest_is_no_matter():
    """The drive never runs faster than P1082, and a telegram can say that."""
    world = panel()
    world.drives[1].write(2000, 0, 10.0)
    world.drives[1].write(1080, 0, 30.0)
    world.drives[1].write(1082, 0, 15.0)
    world.run(3000)
    world.press("START")
    world.run(4000)
    assert starts(world) == 1 and row_1(world).startswith("S: 15.0"), world.lcd()
    world.check()


def test_what_was_set_at_a_drive_out_of_sight_is_known_when_it_is_shown():
    world = World(main.start, addresses=(1, 2), parameters={1000: 2, 2014: 2000})
    world.run(5000)
    world.drives[2].write(1000, 0, 5)
    world.press("ADDRESS_UP")
    world.run(500)
    world.press("START")
    world.run(1000)
    assert row_2(world) == "RUNNING      A2"
    world.press("STOP")
    world.run(12000)
    world.press("ADDRESS_DOWN")
    world.run(2000)
    world.drives[2].write(2014, 0, 0)  # it would run on if the panel died
    world.press("ADDRESS_UP")
    world.run(500)
    world.press("JOG_RIGHT", 500)
    assert starts(world, 2) == 1
    world.check()


# --- an obeyed START by itself -------------------------------------------------------------------


class Told:
    """What a command asks of its drive, the survey of it, and its bus."""

    contact = True
    contacts = 5
    dead_man_trips = failures = version = 0
    cycle_us = 100_000
    mask = 0x3FFFFFFF

    def __init__(self):
        self.bus = self.turns = self
        self.wrong = list(rows.NOTHING_WRONG)
        self.is_running = False

    def longest_cycle_us(self):
        return self.cycle_us

    def state(self):
        return pzd.RUNNING if self.is_running else pzd.READY


GIVEN_US = 0x3FFFFFF0  # the clock begins anew meanwhile


def given(**options):
    told = Told()
    for name in options:
        setattr(told, name, options[name])
    command = Command(told, told, told)
    command.settle_in()
    command.give(GIVEN_US, told.dead_man_trips)
    return told, command


def test_a_start_is_given_up_after_twelve_seconds_and_ten_rounds():
    for cycle_us, most_ms in ((100_000, 12_000), (1_200_000, 12_000), (1_500_000, 15_000)):
        _, command = given(cycle_us=cycle_us)
        for ms, is_overdue in ((0, False), (most_ms - 1, False), (most_ms, True)):
            at_us = GIVEN_US + ms * 1_000 & 0x3FFFFFFF
            assert command.is_overdue(at_us) == is_overdue, (cycle_us, ms)
    _, command = given(mask=0xFFFFFF)  # a clock that begins anew after 16 s
    assert not command.is_overdue(GIVEN_US + 4_190_000 & 0xFFFFFF)
    assert command.is_overdue(GIVEN_US + 4_200_000 & 0xFFFFFF)


def test_what_took_a_start_back_is_told_by_what_has_happened_since():
    for changes, notice in (
        ({}, texts.STOPPED_ITSELF),
        ({"failures": 1}, texts.ENGINE_FAILED),
        ({"dead_man_trips": 1, "failures": 1}, texts.PANEL_HUNG),
        ({"contact": False, "dead_man_trips": 1}, texts.LINE_FAILED),
        ({"contacts": 6, "failures": 1}, texts.LINE_FAILED),
    ):
        told, command = given()
        assert not command.is_stale()
        for name in changes:
            setattr(told, name, changes[name])
        assert command.why_stopped() == notice, changes
        assert command.is_stale() == ("dead_man_trips" in changes)
        command.give(GIVEN_US, told.dead_man_trips)  # pressed again: that is over
        assert not command.is_stale()
        if told.contact:
            assert command.why_stopped() == texts.STOPPED_ITSELF


def test_on_that_leads_to_nothing_is_taken_back_after_five_seconds():
    for runs_once in (False, True):
        told, command = given()
        command.send(GIVEN_US)
        for ms in (0, 4_999):
            assert not command.why_in_vain(False, GIVEN_US + ms * 1_000 & told.mask)
        if runs_once:
            told.is_running = True
            assert not command.why_in_vain(False, GIVEN_US + 4_999_500 & told.mask)
            told.is_running = False
        notice = command.why_in_vain(False, GIVEN_US + 5_000_000 & told.mask)
        assert notice == (texts.NOTHING if runs_once else texts.DID_NOT_START)
        command.send(GIVEN_US)
        assert command.why_in_vain(False, GIVEN_US + 5_000_000 & told.mask) == texts.DID_NOT_START


def test_on_that_somebody_else_has_taken_away_is_taken_back_once_that_is_known():
    for row, start, jog in (
        (rows.COMMAND, True, True), (rows.STATUS, True, True), (rows.SETPOINT, True, False),
        (rows.ACTUAL, False, False),
    ):  # fmt: skip
        told, command = given()
        assert not command.has_judged() and not command.why_in_vain(False, GIVEN_US)
        assert command.has_judged()
        told.wrong[row] = rows.COMMAND_SOURCE
        assert not command.why_in_vain(False, GIVEN_US)  # what is known is judged already
        told.version = 1
        assert not command.has_judged()
        notices = [command.why_in_vain(jogs, GIVEN_US) for jogs in (False, True)]
        taken = {True: texts.TAKEN_AWAY, False: texts.NOTHING}
        assert notices == [taken[start], taken[jog]], row
        told.wrong[row] = rows.RIGHT
        told.version = 2
        assert not command.why_in_vain(False, GIVEN_US)
