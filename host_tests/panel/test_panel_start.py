# SPDX-License-Identifier: MIT
"""The operator's manual, START: what is asked before a motor turns, and when it is refused."""

import main
from boards.sim.world import World
from panel import permits, risks, texts, wording
from panel.command import Command
from panel.control import Control, Desk
from panel.phases import ASKING, CHECKING, IDLE, JOGGING, RUNNING
from panel.reports.fault import NO_FAULT
from panel.stop_watch import NO_WATCH
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
from uss.families import GENERIC, MM3, MM440, rows


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
        assert command.why_in_vain(False, GIVEN_US + 5_700_000 & told.mask) == texts.DID_NOT_START


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


# --- one drive under the operator's hand, by itself ----------------------------------------------


class Scale:
    """Three steps of a word are a hundredth of a hertz."""

    def hsw(self, centihertz):
        return centihertz * 3

    def centihertz(self, word):
        return word // 3

    def limit_centihertz(self):
        return 5_000


class Machine(Told):
    """A drive that stands and has told all, its survey, its bus, and the settings of the panel."""

    address = 3
    tells_status = complete = settled = True
    silent = hiw = hsw = wanted = answered_stw = off_answers = unchecked = 0
    off, at, zsw = pzd.OFF1, pzd.READY, 0x0231
    fault_number, late = 11, None
    least, most = 0, 5_000
    was_running = unreadable = restarted = may = engine_stops = dirty = False
    setpoint_centihertz, lowest_centihertz, highest_centihertz = 1_000, 0, 5_000
    second_stop = "OFF3"
    unsupervised = half_at = ()
    family = MM440
    version = 1

    def __init__(self, **told):
        Told.__init__(self)
        self.drive = self.deadlines = self.channel = self.layout = self
        self.scaling = self.actual = Scale()
        self.pkw_words = 4
        self.values = [0] * rows.COUNT_OF_ROWS
        self.values[rows.SUPERVISION] = 1_000
        self.sent, self.rechecks, self.counted, self.steps, self.dropped = [], 0, 0, 0, 0
        for name in told:
            setattr(self, name, told[name])
        self.control = Control(self, self, Desk(self, self, self.mask))
        self.now_us = GIVEN_US
        self.turn_of_loop()

    # --- the drive

    def start(self, hsw, stw=ON):
        self.wanted, self.off, self.hsw, self.engine_stops = stw, pzd.OFF1, hsw, False
        self.sent.append(stw)

    def stop(self, off=pzd.OFF1):
        self.wanted, self.off, self.engine_stops = 0, off, False
        self.sent.append(off)

    def turn(self, stw):
        self.sent.append(("turn", stw))

    def acknowledge(self):
        self.sent.append("acknowledge")

    def state(self):
        return self.at

    def is_on(self):
        return self.wanted != 0 and not self.engine_stops

    def stopped_by_engine(self):
        return self.engine_stops

    def may_run(self):
        return self.may

    def first_late(self, drive):
        return self.late

    def is_full(self):
        return False

    def ask(self, job):
        job.state, job.low = pkw.DONE, self.fault_number

    # --- its survey

    def step(self, now_us, reread_us=0):
        self.reread_us = reread_us
        self.steps += 1

    def settle(self):
        pass

    def recheck(self):
        self.rechecks += 1

    def drop_recheck(self):
        self.dropped += 1

    def count_anew(self):
        self.counted += 1

    def is_settled(self):
        return self.settled

    def has_restarted(self):
        return self.restarted

    def off_time_ms(self):
        return self.values[rows.SUPERVISION]

    def lowest(self):
        return self.least

    def highest(self):
        return self.most

    own_highest = highest

    def is_percent(self):
        return False

    # --- what goes on

    def accept_unsupervised(self, address):
        self.unsupervised += (address,)

    def tell(self, row, value):
        self.values[row] = value
        self.version += 1

    def spin(self, does=True):
        self.at, self.zsw = (pzd.RUNNING, 0x0235) if does else (pzd.READY, 0x0231)
        self.may = does

    def turn_of_loop(self, ms=4):
        self.now_us = self.now_us + ms * 1_000 & self.mask
        self.control.ask(self.now_us)
        self.control.ask_on(self.now_us)
        self.control.watch(self.now_us)

    def turns_of_loop(self, count=20, ms=4):
        for _ in range(count):
            self.turn_of_loop(ms)

    def happened(self):
        """The events, the last first: text and number."""
        journal = self.control.desk.journal
        events = [journal.event(place) for place in range(journal.count)]
        assert all([event[1] == self.address for event in events])
        return [event[0] if not event[2] else (event[0], event[2]) for event in events]


def started(**told):
    drive = Machine(**told)
    drive.control.start()
    drive.turns_of_loop()
    drive.spin()
    drive.turn_of_loop()
    assert drive.control.phase == RUNNING and drive.sent == [ON], (drive.control.phase, drive.sent)
    return drive


def test_start_sends_on_when_the_drive_has_told_all_anew():
    drive = Machine(unchecked=1, dead_man_trips=2)
    assert drive.control.is_quiet() and not drive.control.is_active()
    assert not drive.control.needs_attention() and not drive.control.lost_running
    assert drive.control.fault is NO_FAULT  # 31 of what a drive never needs would be too much
    assert drive.control.stop_watch is NO_WATCH
    drive.control.start()
    drive.control.start()  # pressed again
    assert drive.control.phase == CHECKING and drive.control.is_starting()
    assert not drive.control.is_quiet()
    drive.turns_of_loop(40)
    assert (drive.sent, drive.rechecks, drive.counted) == ([], 1, 1)
    drive.unchecked, drive.settled = 0, False
    drive.turns_of_loop()
    assert drive.sent == []
    drive.settled = True
    drive.turns_of_loop()
    assert drive.sent == [ON] and drive.hsw == 3_000 and drive.control.phase == RUNNING
    assert drive.dropped == 1
    assert drive.happened() == [] and not drive.control.take_refusal()
    assert drive.control.is_starting() and drive.control.is_active()
    drive.turns_of_loop(100, 40)
    assert drive.sent == [ON]
    drive.turns_of_loop(40, 40)  # it does not run
    assert drive.sent == [ON, OFF1] and drive.control.phase == IDLE
    assert drive.control.notice == texts.DID_NOT_START
    assert drive.happened() == [texts.DID_NOT_START]


def test_a_drive_has_five_seconds_to_run_from_on_and_not_from_the_key():
    drive = Machine(unchecked=1)
    drive.control.start()
    drive.turns_of_loop(45, 100)
    drive.unchecked = 0
    drive.turns_of_loop(45, 100)
    assert drive.sent == [ON]
    drive.turns_of_loop(10, 100)
    assert drive.sent == [ON, OFF1]


def test_a_start_that_waits_too_long_or_outlives_a_hang_is_none():
    drive = Machine(unchecked=1)
    drive.control.start()
    drive.turns_of_loop(290, 40)
    assert drive.control.phase == CHECKING
    drive.turns_of_loop(20, 40)
    assert drive.control.phase == IDLE and drive.control.notice == texts.DID_NOT_START
    assert drive.control.take_refusal() == texts.REFUSED_CHECKING
    assert drive.control.take_refusal() == texts.NOTHING and drive.sent == []
    drive.control.start()
    assert drive.control.notice == texts.NOTHING
    drive.dead_man_trips = 1
    drive.unchecked = 0
    drive.turns_of_loop()
    assert drive.sent == [] and drive.control.notice == texts.PANEL_HUNG
    assert drive.happened() == [texts.PANEL_HUNG, texts.DID_NOT_START]


def test_a_start_asks_about_each_risk_that_nobody_has_taken():
    drive = Machine()
    drive.tell(rows.RESTART, 3)
    drive.tell(rows.SUPERVISION, 0)
    control = drive.control
    control.start()
    drive.turns_of_loop()
    assert (control.phase, control.question()) == (ASKING, risks.SUPERVISION) and drive.sent == []
    assert drive.dropped == 1
    assert not control.is_starting() and drive.happened() == [texts.DID_NOT_START]
    drive.late = drive
    control.accept_risk(risks.SUPERVISION, 0)
    drive.turns_of_loop()
    assert (control.phase, control.question()) == (ASKING, 1)
    control.accept_risk(1, 3)
    drive.turns_of_loop()
    assert drive.unsupervised == (3,) and control.accepts_unsupervised()
    assert (control.phase, control.question()) == (ASKING, 2) and not control.accepts(2, 3)
    control.accept_risk(2, 3)
    assert control.accepts(2, 3) and not control.accepts(2, 2)
    drive.turns_of_loop()
    assert drive.sent == [ON] and control.notice == texts.NOTHING
    control.stop()
    drive.tell(rows.RESTART, 4)
    drive.turns_of_loop()
    control.start()
    drive.turns_of_loop()
    assert control.phase == ASKING
    control.keep_quiet()  # another drive is shown
    assert control.phase == IDLE
    # Only P2014 = 0 is accepted for good: not a long one, nor that a drive is asked late.
    for row, value in ((risks.SUPERVISION, 5_000), (1, 0)):
        drive = started()
        drive.control.accept_risk(row, value)
        assert drive.unsupervised == () and drive.control.accepts(row, value)


def test_a_stop_is_sent_whatever_goes_on_and_acknowledges_what_was_seen():
    drive = started()
    control = drive.control
    control.stop()
    assert drive.sent == [ON, OFF1] and control.phase == IDLE and control.stop_watch.active
    assert not control.own_jog_ends() and drive.dropped == 2
    assert drive.happened() == [texts.STOP_KEY] and not control.needs_attention()
    drive.turn_of_loop()
    for _ in range(3):  # pressed again and again
        control.stop()
        drive.turn_of_loop(400)
    assert control.stop_watch.unconfirmed and control.needs_attention()
    assert drive.happened() == [texts.OTHER_UNCONFIRMED, texts.STOP_KEY]
    assert drive.sent == [ON] + [OFF1] * 4
    drive.spin(False)
    drive.off_answers += 3
    drive.turns_of_loop()
    assert not control.needs_attention() and not control.stop_watch.active
    control.notice = texts.LINE_FAILED
    control.stop_unseen()
    assert control.notice == texts.LINE_FAILED
    control.stop()
    assert control.notice == texts.NOTHING and "acknowledge" not in drive.sent
    drive.contact = False
    control.stop()
    assert control.absence_known
    drive.contact = True
    control.stop()
    assert not control.absence_known


def test_a_second_stop_ends_when_it_was_heard_and_the_motor_stands():
    off3 = pzd.OFF3
    drive = started(second_stop="OFF3")
    drive.control.second_stop()
    drive.control.stop_unseen()  # weakens nothing
    assert drive.sent[1:] == [off3, off3]
    for answered, runs, is_over in (
        (OFF1, False, False), (off3, True, False), (off3 | pzd.STW_ACKNOWLEDGE, False, True),
    ):  # fmt: skip
        drive.answered_stw = answered
        drive.spin(runs)
        drive.turn_of_loop()
        assert (drive.off == pzd.OFF1) == is_over, answered
    drive = started()
    drive.control.second_stop()
    drive.at, drive.answered_stw = pzd.FAULT, off3  # it stands for sure
    drive.turn_of_loop()
    assert drive.off == pzd.OFF1
    drive = started(second_stop="none")
    drive.control.second_stop()
    assert drive.sent == [ON] and drive.control.phase == RUNNING
    drive = started(second_stop="OFF2")
    drive.control.second_stop()
    assert drive.sent == [ON, pzd.OFF2] and drive.control.phase == IDLE


def test_a_jog_turns_as_long_as_its_key_is_held():
    drive = Machine()
    control = drive.control
    control.end_jog()
    assert drive.sent == []
    control.jog(pzd.JOG_LEFT)
    assert drive.sent == [pzd.JOG_LEFT] and control.phase == JOGGING and drive.counted == 1
    drive.spin()
    drive.turns_of_loop()
    control.start()
    assert control.take_refusal() == texts.REFUSED_JOG and control.phase == JOGGING
    control.reverse()
    assert control.take_refusal() == texts.REFUSED_JOG and not control.reversed
    assert not control.own_jog_ends()
    control.end_jog()
    assert drive.sent == [pzd.JOG_LEFT, OFF1] and control.own_jog_ends()
    control.jog(pzd.JOG_RIGHT)  # while it still ramps down
    assert drive.sent[2:] == [pzd.JOG_RIGHT] and not control.stop_watch.active
    control.end_jog()
    drive.spin(False)
    drive.off_answers += 3
    drive.turns_of_loop()
    assert not control.own_jog_ends() and drive.happened() == []
    control.stop()
    assert control.stop_watch.active and not control.own_jog_ends()
    drive.off_answers += 3
    drive.turns_of_loop()
    control.jog(pzd.JOG_RIGHT)
    drive.spin()
    drive.turns_of_loop()
    control.end_jog()
    control.start()  # while it still ramps down
    drive.turns_of_loop()
    assert control.phase == RUNNING and not control.own_jog_ends()
    control.stop()
    assert control.stop_watch.active and not control.own_jog_ends()
    drive.turns_of_loop()
    control.jog(pzd.JOG_RIGHT)  # it runs, and not by a jog
    assert control.take_refusal() == texts.REFUSED_RUNS and control.phase == IDLE


def test_the_direction_is_turned_at_once_and_kept():
    drive = Machine()
    for is_reversed in (True, False, True):
        drive.control.reverse()
        assert drive.control.reversed == is_reversed
        stw = MM440.on_reverse if is_reversed else MM440.on
        assert drive.sent[-1] == ("turn", stw)
    drive.control.start()
    drive.turns_of_loop()
    assert drive.sent[-1] == MM440.on_reverse


def test_what_somebody_changes_while_it_runs_is_remarked_and_ends_a_jog():
    for ms, remark, notice in (
        (0, texts.RUNS_FOR_EVER, texts.UNSUPERVISED), (30_000, texts.RUNS_LONG, texts.RUNS_LONG)
    ):  # fmt: skip
        drive = started()
        drive.tell(rows.SUPERVISION, ms)
        drive.turns_of_loop()
        assert drive.control.remark == remark and drive.sent == [ON]
        drive.tell(rows.SUPERVISION, 1_000)
        drive.turns_of_loop()
        assert drive.control.remark == texts.NOTHING
        drive = Machine()
        drive.control.jog(pzd.JOG_LEFT)
        drive.spin()
        drive.turns_of_loop()
        drive.tell(rows.SUPERVISION, ms)
        drive.turns_of_loop()
        assert drive.sent == [pzd.JOG_LEFT, OFF1] and drive.control.notice == notice
        assert drive.control.phase == IDLE and drive.happened() == [notice]
    values = [0] * rows.COUNT_OF_ROWS
    drive = started(unsupervised=(3,), values=values)  # what was so before is no news
    drive.tell(rows.RESTART, 0)
    drive.turns_of_loop()
    assert drive.control.remark == texts.NOTHING
    drive = started()
    drive.tell(rows.SUPERVISION, 65_000)
    drive.turns_of_loop()
    drive.control.stop()
    drive.spin(False)
    drive.turns_of_loop()
    assert drive.control.remark == texts.RUNS_LONG  # of the last run
    drive.tell(rows.SUPERVISION, 1_000)
    drive.control.start()
    drive.turns_of_loop()
    drive.spin()
    drive.turns_of_loop()
    assert drive.control.remark == texts.NOTHING and drive.control.phase == RUNNING


def test_what_the_engine_or_the_drive_itself_ends_is_over():
    drive = started()
    drive.engine_stops = True
    drive.turn_of_loop()
    assert drive.sent == [ON, OFF1] and drive.control.notice == texts.STOPPED_ITSELF
    drive = started()
    drive.wrong[rows.SETPOINT] = rows.SETPOINT_SOURCE
    drive.version += 1
    drive.turns_of_loop()
    assert drive.sent == [ON, OFF1] and drive.control.notice == texts.TAKEN_AWAY
    drive = started()
    drive.restarted = True
    drive.turn_of_loop()
    assert drive.sent == [ON, OFF1] and drive.control.notice == texts.DRIVE_RESET
    assert drive.control.phase == IDLE and drive.happened() == [texts.DRIVE_RESET]


def test_a_drive_that_was_lost_while_it_ran_is_an_alarm_until_it_is_heard():
    drive = started()
    control = drive.control
    drive.contact, drive.was_running = False, True
    drive.turn_of_loop()
    assert control.lost_running and control.needs_attention() and not control.runs()
    assert drive.happened()[-1] == texts.OTHER_LOST and control.is_active()
    drive.contact, drive.was_running = True, False
    drive.turn_of_loop()
    assert not control.lost_running and control.runs()
    assert not Machine(contact=False).control.lost_running  # it was never heard
    drive = Machine()
    drive.contact = False
    drive.turn_of_loop()
    assert not drive.control.lost_running and drive.happened() == []
    for contacts, silent, is_unheard in ((0, 2, False), (0, 3, True), (1, 3, False)):
        drive.contacts, drive.silent = contacts, silent
        assert drive.control.is_unheard() == is_unheard, (contacts, silent)


def test_the_actual_frequency_is_none_that_was_told_long_ago():
    drive = Machine(hiw=300)
    control = drive.control
    assert control.actual_centihertz() == 100 and not control.actual_is_beyond()
    for told in ({"contact": False}, {"silent": 3}, {"silent": 9}, {"actual": None}):
        for name in told:
            before = getattr(drive, name)
            setattr(drive, name, told[name])
            assert control.actual_centihertz() is None, told
            setattr(drive, name, before)
    drive.silent = 2
    assert control.actual_centihertz() == 100
    drive.hiw = pzd.BEYOND[0]
    assert control.actual_is_beyond()


def test_a_motor_that_runs_against_off_is_watched_unless_that_is_not_known():
    for told, watched in (({}, True), ({"complete": False}, False), ({"local": True}, False)):
        drive = Machine()
        if told.pop("local", False):
            drive.wrong[rows.COMMAND] = rows.COMMAND_SOURCE
        for name in told:
            setattr(drive, name, told[name])
        drive.spin()
        drive.turns_of_loop()
        assert drive.control.stop_watch.active == watched, told
        assert not drive.control.is_quiet() and drive.control.is_active()


def test_a_drive_is_quiet_until_something_changes():
    for change in (
        {"zsw": 0x0A31}, {"contact": False}, {"version": 9}, {"zsw": 0x0239},
    ):  # fmt: skip
        drive = Machine()
        assert drive.control.is_quiet()
        for name in change:
            setattr(drive, name, change[name])
        assert not drive.control.is_quiet(), change
    drive = Machine()
    drive.control.moved = True
    assert not drive.control.is_quiet() and not drive.control.is_unsaved()
    drive.dirty = True
    drive.turn_of_loop()
    assert drive.control.moved and drive.control.is_unsaved()
    drive.dirty = False
    drive.turn_of_loop()
    assert not drive.control.moved and drive.control.is_quiet()
    drive.control.stop()
    assert not drive.control.is_quiet()


def test_a_drive_of_which_something_may_still_come_is_not_quiet():
    for told in (
        {"zsw": 0x0239},  # a fault,
        {"zsw": 0x0235, "tells_status": False},  # it runs, perhaps,
        {"wanted": ON},
        {"off": pzd.OFF3},  # which nobody has heard yet,
        {"may": True},  # ON was sent, and its answer is still to come
        {"contact": False, "was_running": True},
    ):
        drive = Machine()
        drive.turns_of_loop()
        assert drive.control.is_quiet()
        for name in told:
            setattr(drive, name, told[name])
        for _ in range(3):
            drive.control.watch(drive.now_us)
            assert not drive.control.is_quiet(), told
    drive = Machine(contact=False)  # it was lost while it stood
    drive.turns_of_loop()
    assert drive.control.is_quiet()
    drive = Machine()
    drive.control.jog(pzd.JOG_LEFT)
    assert not drive.control.is_quiet()


def test_while_it_runs_its_settings_are_read_again_the_sooner_the_more_it_is_shown():
    drive = started()
    for asked_us, reread_us in ((None, 200_000), (2_000_000, 330_000)):
        if asked_us is None:
            drive.control.ask(drive.now_us)
        else:
            drive.control.ask(drive.now_us, asked_us)
        assert drive.reread_us == reread_us
    drive.complete = False
    drive.control.change(100)
    assert drive.control.take_refusal() == texts.REFUSED_CHECKING
    assert drive.control.setpoint.centihertz == 1_000
    drive.complete = True
    drive.control.change(100)
    assert drive.control.setpoint.centihertz == 1_100 and not drive.control.take_refusal()


def test_where_no_status_is_told_it_may_run_for_forty_seconds():
    known = list(rows.NOTHING_WRONG)
    known[rows.STATUS] = rows.STATUS_SENT
    assert not Machine(wrong=known).tells_status  # from the first moment on
    drive = started()
    drive.wrong[rows.STATUS] = rows.STATUS_SENT
    drive.version += 1
    drive.turn_of_loop()
    assert not drive.tells_status and drive.control.notice == texts.TAKEN_AWAY
    drive.wrong[rows.STATUS] = rows.RIGHT
    drive.tell(rows.STATUS_SENT, -1)  # it is not known any more: that says nothing
    drive.turn_of_loop()
    assert not drive.tells_status
    drive.at = pzd.READY  # by words that are none
    for ms in range(0, 60_000, 1_000):
        drive.turn_of_loop(1_000)
        if ms == 2_000:
            assert drive.control.needs_attention()
            drive.control.stop_watch.end()
    assert drive.control.is_active()
    drive.tell(rows.STATUS_SENT, 0)
    drive.spin(False)
    drive.off_answers += 3
    drive.turns_of_loop(39, 1_000)
    assert not drive.control.is_active()
    drive.turn_of_loop(999)
    assert not drive.control.is_quiet()
    drive.turn_of_loop(1)
    assert drive.control.is_quiet()


def test_a_fault_is_noted_once_and_acknowledged_when_it_was_seen():
    drive = Machine()
    control = drive.control
    assert not control.fault.active
    drive.at, drive.zsw = pzd.FAULT, 0x0238
    drive.turns_of_loop()
    assert control.fault.active and drive.happened() == [(texts.FAULT, 11)]
    drive.fault_number = 12  # by now it is another one
    drive.turns_of_loop(20, 100)
    assert drive.happened() == [(texts.FAULT, 12), (texts.FAULT, 11)]
    control.stop()
    assert drive.sent == [OFF1]  # nobody has seen it
    control.fault.show(1_000)
    control.stop_unseen()
    assert "acknowledge" not in drive.sent
    control.stop()
    assert drive.sent[-2:] == ["acknowledge", OFF1]
    drive.spin(False)
    drive.turn_of_loop()
    assert not control.fault.active and len(drive.happened()) == 2


def test_a_new_start_ends_the_alarm_of_the_stop_before():
    for starts_again in (False, True):
        drive = started()
        drive.control.stop()
        drive.spin(False)
        drive.may = True  # no answer so far
        drive.turns_of_loop(3, 1_000)
        assert drive.control.needs_attention()
        if starts_again:
            drive.control.start()
            drive.turns_of_loop()
            assert drive.control.phase == RUNNING
        else:
            drive.control.jog(pzd.JOG_RIGHT)
        assert not drive.control.needs_attention()


def test_a_step_that_took_the_news_of_the_setpoint_asks_nothing():
    drive = Machine()
    before = drive.steps
    assert not drive.control.ask(drive.now_us, 77) and drive.steps == before + 1
    assert drive.reread_us == 77
    drive.version += 1
    assert drive.control.ask(drive.now_us) and drive.steps == before + 1
    drive.complete = False
    drive.version += 1
    assert not drive.control.ask(drive.now_us) and drive.steps == before + 2
    drive.complete = True
    drive.control.ask_on(drive.now_us)
    assert drive.steps == before + 2  # nobody waits
    drive.settled = False
    drive.control.ask_on(drive.now_us)
    assert drive.steps == before + 3
    drive.settled, drive.unchecked = True, 1
    drive.control.start()
    assert not drive.control.ask(drive.now_us) and drive.steps == before + 3
    drive.turns_of_loop()
    before = drive.steps
    drive.control.ask_on(drive.now_us)  # START waits
    assert drive.steps == before + 1
    drive.unchecked = 0
    drive.turns_of_loop()
    drive.version += 1
    assert drive.wanted and drive.control.ask(drive.now_us)
    assert not drive.control.ask(drive.now_us)


def test_another_drive_that_is_shown_takes_the_refusal_and_not_the_start():
    drive = Machine(contact=False)
    drive.control.start()
    assert drive.control.phase == IDLE
    before = drive.dropped
    drive.control.keep_quiet()
    assert not drive.control.take_refusal() and drive.dropped == before + 1
    drive = Machine(unchecked=1)
    drive.control.start()
    drive.control.keep_quiet()
    drive.control.drop_question()
    assert drive.control.phase == CHECKING and drive.dropped == 0


def test_what_the_desk_knows_follows_its_list_and_its_line():
    drive = Machine(cycle_us=2_000_000)
    desk = Desk(drive, drive, drive.mask, texts.LINE_LOW)
    assert (desk.longest_off_time_ms, desk.off_time_ms) == (8_004, 6_100)
    drive.cycle_us = 0
    desk.follow_list()
    assert (desk.longest_off_time_ms, desk.off_time_ms) == (2_000, 1_000)
    control = Control(drive, drive, desk)
    assert not control.moved and not control.moving and not control.is_active()
    assert not control.absence_known
    drive.may = True  # it was heard running last
    assert control.is_active()
    drive.may = False
    control.start()
    assert control.take_refusal() == texts.LINE_LOW
    control.watch(drive.now_us)  # it answers
    assert desk.defect == texts.NOTHING
    control.start()
    assert not control.take_refusal()
    for defect in (texts.NO_CONTACT, texts.WRONG_DRIVE, texts.ADDRESS, texts.LINE_IN_USE):
        desk = Desk(drive, drive, drive.mask, defect)
        desk.note_answer()
        assert desk.defect == defect
    drive.half_at = (3,)
    assert control.is_half_written()


OBSTACLES = (  # to a START, the first that is told first
    ({"off": pzd.OFF3}, texts.REFUSED_STOPPING),
    ({"contact": False}, texts.REFUSED_SILENT),
    ({"half_at": (3,)}, texts.REFUSED_HALF_SET),
    ({"at": pzd.FAULT}, texts.REFUSED_FAULT),
    ({"complete": False, "unreadable": True}, texts.REFUSED_SCALING),
    ({"complete": False, "unreadable": False}, texts.REFUSED_CHECKING),
    (rows.STATUS, texts.REFUSED_STATUS),
    (rows.COMMAND, texts.REFUSED_COMMAND),
    (rows.SETPOINT, texts.REFUSED_SETPOINT),
    ({"least": 5_001, "most": 6_000}, texts.REFUSED_MINIMUM),
    ({"at": pzd.INHIBITED}, texts.REFUSED_INHIBITED),
)
SOURCES = {
    rows.STATUS: rows.STATUS_SENT, rows.COMMAND: rows.COMMAND_SOURCE,
    rows.SETPOINT: rows.SETPOINT_SOURCE,
}  # fmt: skip


def hinder(drive, obstacle):
    if isinstance(obstacle, dict):
        for name in obstacle:
            setattr(drive, name, obstacle[name])
    else:
        drive.wrong[obstacle] = SOURCES[obstacle]


def test_of_many_obstacles_to_a_start_the_first_is_told():
    drive = Machine()
    assert permits.why_not_start(drive.control) == texts.NOTHING
    for obstacle, reason in reversed(OBSTACLES):
        alone = Machine()
        for some in (alone, drive):
            hinder(some, obstacle)
            assert permits.why_not_start(some.control) == reason, obstacle
        told = permits.why_not_jog(alone.control)
        of_start_alone = reason in (texts.REFUSED_SETPOINT, texts.REFUSED_MINIMUM)
        assert told == (texts.NOTHING if of_start_alone else reason), obstacle
    for changes, reason in (
        ({"moving": True}, texts.WRITER_BUSY), ({"moved": True}, texts.REFUSED_UNSAVED)
    ):  # fmt: skip
        drive = Machine(dirty=True)
        for name in changes:
            setattr(drive.control, name, True)
        assert permits.why_not_start(drive.control) == reason
    drive.dirty = False
    assert permits.why_not_start(drive.control) == texts.NOTHING
    drive = Machine(at=pzd.NOT_READY, least=6_000)  # the highest counts where it is less
    assert permits.why_not_start(drive.control) == texts.REFUSED_NOT_READY
    for row in permits.REFUSED_SOURCES:
        assert permits.is_about_source(permits.REFUSED_SOURCES[row])
    assert not permits.is_about_source(texts.REFUSED_FAULT)


def test_a_jog_has_reasons_of_its_own():
    for told, supervision, reason in (
        ({"family": GENERIC}, 1_000, texts.REFUSED_NO_JOG),
        ({"wanted": ON}, 1_000, texts.REFUSED_RUNS),
        ({"at": pzd.RUNNING}, 1_000, texts.REFUSED_RUNS), ({}, 0, texts.REFUSED_UNSUPERVISED),
        ({}, 2_001, texts.REFUSED_LONG), ({"unchecked": 1}, 1_000, texts.REFUSED_CHECKING),
        ({"unsupervised": (3,)}, 0, texts.NOTHING), ({}, 2_000, texts.NOTHING),
    ):  # fmt: skip
        drive = Machine(**told)
        drive.tell(rows.SUPERVISION, supervision)
        assert permits.why_not_jog(drive.control) == reason, (told, supervision)


def test_the_state_of_a_drive_in_words():
    for told, words in (
        ({}, texts.READY), ({"at": pzd.NOT_READY}, texts.NOT_READY),
        ({"half_at": (3,)}, texts.HALF_SET), ({"complete": False}, texts.CHECKING),
        ({"complete": False, "at": pzd.INHIBITED}, texts.INHIBITED),
        ({"wanted": ON}, texts.STARTING), ({"at": pzd.FAULT, "wanted": ON}, texts.FAULT),
        ({"at": pzd.RUNNING, "wanted": ON}, texts.RUNNING),
        ({"at": pzd.RUNNING}, texts.STOPPING),
        ({"at": pzd.RUNNING, "wanted": pzd.JOG_RIGHT}, texts.JOGS_RIGHT),
        ({"at": pzd.RUNNING, "wanted": pzd.JOG_LEFT}, texts.JOGS_LEFT),
        ({"contact": False, "trouble": 0}, texts.NO_CONTACT),
        ({"contact": False, "trouble": 4}, texts.WRONG_CHECK),
    ):  # fmt: skip
        drive = Machine(**told)
        assert wording.text(drive.control) == words, (told, words)
        if drive.contact:
            drive.wrong[rows.STATUS] = rows.STATUS_SENT
            words = texts.STATUS_UNKNOWN
        else:
            words = drive.control.desk.defect = texts.LINE_LOW
        assert wording.text(drive.control) == words, told
    drive = Machine()
    drive.wrong[rows.COMMAND] = rows.COMMAND_SOURCE
    assert wording.text(drive.control) == texts.LOCAL
    drive.spin()
    assert wording.text(drive.control) == texts.RUNS_LOCALLY
    drive = Machine(at=pzd.INHIBITED)
    drive.control.notice = texts.LINE_FAILED
    assert wording.text(drive.control) == texts.LINE_FAILED
    drive = started()
    drive.tell(rows.SUPERVISION, 0)
    drive.turns_of_loop()
    assert wording.text(drive.control) == texts.RUNS_FOR_EVER
    for unconfirmed, words in ((True, b"A3 NOT STOPPED"), (False, b"A3 LOST,MAY RUN")):
        drive.control.stop_watch = Told()
        drive.control.stop_watch.unconfirmed = unconfirmed
        assert wording.alarm(drive.control) == words


def test_a_motor_at_its_lowest_frequency_runs_faster_than_it_is_told():
    drive = started()
    assert wording.remark(drive.control) == texts.NOTHING
    drive.least = 2_000
    drive.version += 1
    drive.turns_of_loop()
    assert wording.remark(drive.control) == texts.RUNS_FASTER
    for family, words in ((MM440, b"P2014"), (MM3, b"P%04d" % MM3.off_time_number)):
        assert words in wording.of(texts.RUNS_FOR_EVER, family)
