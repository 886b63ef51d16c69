"""The operator's manual, as tests: keys are pressed, the display is read, the shaft is watched.

Everything runs on the virtual board, in virtual time, with the same firmware as on the chip.
"""

import main
from boards.sim.world import World
from uss import pkw


def panel(**options):
    """A panel that was switched on a second ago."""
    world = World(main.start, **options)
    world.run(1000)
    return world


def running(**options):
    """A panel whose drive 1 has been started and has reached its setpoint."""
    world = panel(**options)
    world.press("START")
    world.run(4000)
    assert world.drives[1].state == "running", world.drives[1].report()
    return world


def row_1(world):
    return world.lcd()[0]


def row_2(world):
    return world.lcd()[1].rstrip()


def starts(world, address=1):
    """How often the motor has been set going."""
    return int(world.drives[address].report().split("starts=")[1].split()[0])


def telegrams(world, since_us, address=None):
    """Telegrams of the panel since an instant, as (instant, control word)."""
    sent = []
    for at_us, from_panel, characters in world.wire.log.last(1000):
        if len(characters) < 16:
            continue  # cut off by a reset
        if from_panel and at_us >= since_us and address in (None, characters[2]):
            sent.append((at_us, characters[11] << 8 | characters[12]))
    return sent


ON, OFF1 = 0x047F, 0x047E
ERROR = ValueError("on purpose")  # made beforehand: the heap is locked in an interrupt


# --- switching on -------------------------------------------------------------------------------


def test_after_power_on_the_panel_says_what_it_is_not():
    world = World(main.start)
    world.run(200)
    assert world.reads("USS PANEL IS NO EMERGENCY STOP")
    world.check()


def test_a_second_later_it_shows_setpoint_frequency_state_and_address():
    world = panel()
    assert world.lcd() == ("S: 10.0 F:  0.00", "READY        A1 ")
    world.check()


def test_the_first_telegram_to_any_drive_is_off1_with_the_control_bit():
    world = panel(addresses=(1, 2, 3))
    for address in (1, 2, 3):
        assert telegrams(world, 0, address)[0][1] == OFF1
    for _, stw in telegrams(world, 0):
        assert stw == OFF1
    world.check()


def test_the_panel_listens_before_it_talks():
    world = panel()
    first_us = telegrams(world, 0)[0][0]
    assert 200_000 <= first_us <= 1_000_000  # 100 ms boot, 100 ms of silence heard
    world.check()


# --- start and stop -----------------------------------------------------------------------------


def test_start_turns_the_motor_and_stop_stops_it():
    world = panel()
    world.press("START")
    world.run(5000)
    assert world.lcd() == ("S: 10.0 F: 10.00", "RUNNING      A1 ")
    assert abs(world.drives[1].hz() - 10) < 0.01
    world.press("STOP")
    world.run(500)
    assert row_2(world) == "STOPPING     A1"
    world.run(7500)
    assert world.lcd() == ("S: 10.0 F:  0.00", "READY        A1 ")
    assert world.drives[1].hz() == 0 and starts(world) == 1
    world.check()


def test_the_same_without_a_receive_interrupt():
    world = running(polled=True)
    assert world.lcd() == ("S: 10.0 F: 10.00", "RUNNING      A1 ")
    world.press("STOP")
    world.run(8000)
    assert world.drives[1].hz() == 0 and row_2(world) == "READY        A1"
    world.check()


def test_it_works_at_every_rate_the_drive_knows():
    for baud in (1200, 2400, 4800, 9600, 19200, 38400, 57600):
        for polled in (False, True):
            world = World(main.start, baud=baud, polled=polled)
            world.run(8000)
            world.press("START")
            world.run(8000)  # on a slow line it takes seconds to ask the drive
            assert row_2(world) == "RUNNING      A1", (baud, polled)
            world.press("STOP")
            world.run(8000)
            assert row_2(world) == "READY        A1", (baud, polled)
            world.check()


def test_up_and_down_move_the_setpoint_while_the_motor_turns():
    world = running()
    for _ in range(5):
        world.press("UP", 60)
        world.run(60)
    assert row_1(world).startswith("S: 10.5")
    world.run(1000)
    assert row_1(world) == "S: 10.5 F: 10.50"
    world.press("DOWN", 60)
    world.run(1000)
    assert row_1(world) == "S: 10.4 F: 10.40"
    world.check()


def test_a_key_that_is_held_repeats_and_soon_moves_faster():
    world = panel()
    world.press("UP", 380)
    world.run(60)
    assert row_1(world).startswith("S: 10.1")  # 400 ms before the first repeat
    world.press("UP", 60)
    world.run(100)
    world.press("UP", 1480)  # the press, 8 repeats of 0.1 Hz, and the ninth of 1 Hz
    world.run(60)
    assert row_1(world).startswith("S: 12.1"), row_1(world)
    world.check()


def test_the_setpoint_stays_within_the_limits_of_the_drive():
    world = panel()
    world.drives[1].write(1080, 0, 9.5)
    world.drives[1].write(1082, 0, 10.5)
    world.run(3000)
    world.press("UP", 3000)
    assert row_1(world).startswith("S: 10.5")
    world.press("DOWN", 3000)
    world.run(100)
    assert row_1(world).startswith("S:  9.5")
    world.check()


def test_a_motor_that_turns_left_is_shown_with_a_sign():
    world = running()
    world.press("STOP")
    world.run(8000)
    drive = world.app.bus.drives[0]
    drive.start(0x10000 - 0x0CCD)  # an own program may reverse by the sign of the setpoint
    world.run(5000)
    assert row_1(world) == "S: 10.0 F:-10.00"
    world.check()


def test_start_while_the_motor_runs_down_lets_it_run_up_again():
    world = running()
    world.press("STOP")
    world.run(500)
    world.press("START")
    world.run(3000)
    assert row_2(world) == "RUNNING      A1"
    world.check()


def test_stop_beats_start():
    world = panel()
    world.down("STOP")
    world.run(100)
    world.press("START")
    assert row_2(world) == "NO: STOP IS DOWN"
    world.up("STOP")
    world.run(3000)
    assert starts(world) == 0
    world.down("STOP")  # both in the same moment
    world.down("START")
    world.run(100)
    world.up("STOP")
    world.up("START")
    world.run(3000)
    assert starts(world) == 0
    world.check()


def test_stop_is_in_the_next_telegram_but_one_at_the_latest():
    """STOP pressed to OFF on the line: debounce and two exchanges, with 31 drives in the list."""
    world = panel(addresses=tuple(range(1, 32)))
    world.run(8000)
    exchange_us = 2 * 9167 + 2 * 1719
    for offset_ms in range(0, 44, 4):
        world.press("START")
        world.run(1000 + offset_ms)
        assert row_2(world) == "RUNNING      A1"
        pressed_us = world.clock.now_us
        world.press("STOP")
        offs = [at_us for at_us, stw in telegrams(world, pressed_us, 1) if stw == OFF1]
        assert offs and offs[0] - pressed_us <= 24_000 + 2 * exchange_us, offs[:1]
        world.run(1000)
    world.check()


def test_a_stop_is_sent_however_soon_start_follows():
    """Both within one exchange of a slow line: the drive is told to stop all the same."""
    for offset_ms in range(0, 200, 20):
        world = panel(baud=2400)
        world.run(2000)
        world.press("START")
        world.run(6000)
        world.run(offset_ms)
        pressed_us = world.clock.now_us
        world.press("STOP", 30)
        world.run(30)
        world.press("START", 30)
        world.run(3000)
        assert OFF1 in [stw for _, stw in telegrams(world, pressed_us, 1)], offset_ms
        assert telegrams(world, pressed_us, 1)[-1][1] == ON
        world.check()


def test_a_stop_that_noise_destroys_is_repeated_out_of_turn():
    addresses = tuple(range(1, 17))
    world = panel(addresses=addresses)
    world.run(4000)
    world.press("START")
    world.run(4000)
    for address in addresses[1:]:
        world.drives[address].unplug()
    world.run(2000)
    drive = world.drives[1]
    drive.unplug()  # the first telegrams with OFF1 do not reach it
    pressed_us = world.clock.now_us
    world.press("STOP", 100)
    assert drive.state == "running"
    drive.plug()
    world.run(100)  # one of 16 silent drives takes 30 ms, a round half a second
    assert drive.state == "stopping"
    own, all_of_them = telegrams(world, pressed_us, 1), telegrams(world, pressed_us)
    assert len(own) >= 3 and len(all_of_them) >= 2 * len(own) - 1  # the others have their turns
    world.check()


def test_stop_held_down_since_power_on_beats_start():
    """Jammed, or its wire is broken."""
    world = panel()
    world.down("STOP")
    world.reset()
    world.run(1000)
    world.press("START")
    assert row_2(world) == "NO: STOP IS DOWN"
    world.run(5000)
    assert starts(world) == 0
    world.check()


def test_start_during_the_splash_starts_nothing():
    """Nobody has seen which drive it would be, and how fast."""
    world = World(main.start)
    world.run(500)
    world.press("START")
    world.run(3000)
    assert starts(world) == 0 and row_2(world) == "READY        A1"
    world.check()


def test_a_bouncing_key_counts_once():
    world = panel()
    for _ in range(6):
        world.down("UP")
        world.run(6)
        world.up("UP")
        world.run(6)
    world.press("UP")
    world.run(60)
    assert row_1(world).startswith("S: 10.1")
    world.check()


def test_a_start_key_that_is_jammed_at_power_on_starts_nothing():
    world = panel()
    world.down("START")
    world.reset()
    world.run(3000)
    assert starts(world) == 0
    world.up("START")
    world.run(100)
    world.press("START")
    world.run(1000)
    assert starts(world) == 1
    world.check()


# --- what STOP promises -------------------------------------------------------------------------


def test_a_stop_that_nobody_confirms_is_an_alarm():
    world = running()
    world.drives[1].unplug()
    world.press("STOP")
    world.run(700)
    assert row_2(world) != "STOP UNCONFIRMED"
    world.run(400)
    assert row_2(world) == "STOP UNCONFIRMED"
    world.drives[1].plug()
    world.run(500)
    assert row_2(world) == "STOPPING     A1"
    world.run(6000)
    assert row_2(world) == "READY        A1"
    world.check()


def test_a_stop_that_the_drive_does_not_obey_is_an_alarm():
    """Somebody has taken the drive away from this bus while it ran."""
    world = running()
    words = world.drives[1]._process.words
    world.drives[1]._process.words = lambda count: [0xFB34, 0x0CCD]  # it runs on and says so
    world.press("STOP")
    world.run(800)
    assert row_2(world) == "STOPPING     A1"
    world.run(300)
    assert row_2(world) == "STOP UNCONFIRMED"
    world.drives[1]._process.words = words
    world.run(5000)
    assert row_2(world) == "READY        A1"
    world.check()


def test_an_off1_that_nobody_pressed_is_watched_as_well():
    """The dead man has sent it, and the drive does not obey."""
    world = running()
    world.drives[1]._process.words = lambda count: [0xFB34, 0x0CCD]
    world.hang(1000)
    world.run(2500)
    assert row_2(world) == "STOP UNCONFIRMED"


def test_an_answer_from_before_stop_confirms_nothing():
    """The drive stands still and answers; it is unplugged, STOP is pressed."""
    world = panel()
    world.drives[1].unplug()
    world.run(100)
    world.press("STOP")
    world.run(700)
    assert world.app.bus.drives[0].contact
    world.run(400)
    assert row_2(world) == "STOP UNCONFIRMED"


def test_a_long_list_is_no_reason_for_an_alarm():
    """Eight drives at 1200 baud: it takes seconds until a drive has told that it slows down."""
    addresses = (1, 2, 3, 4, 5, 6, 7, 8)
    world = panel(addresses=addresses, baud=1200)
    world.drives[1].write(1121, 0, 30.0)
    world.run(60_000)
    world.press("START")
    world.run(20_000)
    assert world.drives[1].state == "running"
    world.press("STOP")
    while world.drives[1].state == "stopping" or row_2(world) == "STOPPING     A1":
        world.run(100)
        assert row_2(world) != "STOP UNCONFIRMED"
    world.check()


def test_a_word_that_trembles_is_not_taken_for_a_motor_that_slows_down():
    world = running()
    count = [0]

    def trembling(wanted):
        count[0] += 1
        return [0xFB34, 0x0CCD - count[0] % 3]

    world.drives[1]._process.words = trembling
    world.press("STOP")
    world.run(3500)
    assert row_2(world) == "STOP UNCONFIRMED"


def test_a_motor_that_slows_down_and_then_does_not_is_an_alarm():
    """Somebody has set the ramp to a standstill: 650 s."""
    world = running()
    world.press("STOP")
    world.run(500)
    assert row_2(world) == "STOPPING     A1"
    drive = world.drives[1]
    words = drive._process.words
    hiw = words(2)[1]
    drive._process.words = lambda wanted: [words(wanted)[0] | 4, hiw]
    world.run(2500)
    assert row_2(world) == "STOPPING     A1"
    world.run(1000)
    assert row_2(world) == "STOP UNCONFIRMED"


def test_the_slowest_ramp_of_a_drive_is_no_alarm():
    for p2000, p2009 in ((50.0, 0), (650.0, 0), (50.0, 1)):
        world = panel()
        world.drives[1].write(1121, 0, 650.0)
        world.drives[1].write(2000, 0, p2000)
        world.drives[1].write(2009, 0, p2009)
        world.run(3000)
        world.press("START")
        world.run(4000)
        world.press("STOP")
        for _ in range(200):
            world.run(100)
            assert row_2(world) == "STOPPING     A1", (p2000, p2009)
        world.check()


def test_stop_is_repeated_until_the_drive_hears_it():
    world = running()
    world.drives[1].unplug()
    world.press("STOP")
    world.run(3000)
    stws = [stw for _, stw in telegrams(world, world.clock.now_us - 2_900_000, 1)]
    assert len(stws) > 50 and set(stws) == {OFF1}
    world.drives[1].plug()
    world.run(8000)
    assert world.drives[1].hz() == 0
    world.check()


def test_stop_held_for_four_seconds_stops_all_drives():
    world = panel(addresses=(1, 2, 3))
    for _ in range(3):
        world.press("START")
        world.press("ADDRESS_UP")
        world.run(200)
    world.run(4000)
    for address in (1, 2, 3):
        assert world.drives[address].state == "running"
    world.press("STOP", 3900)
    assert [world.drives[address].hz() > 9 for address in (1, 2, 3)] == [False, True, True]
    world.run(100)
    world.press("STOP", 4100)
    assert row_2(world) == "ALL DRIVES: STOP"
    world.run(8000)
    for address in (1, 2, 3):
        assert world.drives[address].hz() == 0
        assert starts(world, address) == 1
    world.check()


# --- several drives -----------------------------------------------------------------------------


def test_another_address_starts_and_stops_nothing():
    world = running(addresses=(1, 2, 5))
    world.press("ADDRESS_UP")
    world.run(1600)
    for _ in range(40):  # the display tells of drive 1 and of the state of drive 2 in turn
        if row_2(world) == "READY        A2":
            break
        world.run(100)
    assert row_2(world) == "READY        A2"
    world.run(2000)
    assert world.drives[1].state == "running" and abs(world.drives[1].hz() - 10) < 0.01
    assert starts(world, 2) == 0
    world.press("ADDRESS_DOWN")
    world.run(100)
    assert row_2(world) == "RUNNING      A1"
    world.press("ADDRESS_DOWN")  # the list goes round
    world.run(100)
    assert world.app.panel.selected.drive.address == 5
    world.press("ADDRESS_UP")
    assert world.app.panel.selected.drive.address == 1
    assert starts(world, 5) == 0 and starts(world, 2) == 0 and starts(world, 1) == 1
    world.check()


def test_a_drive_that_runs_unseen_is_announced():
    world = running(addresses=(1, 2))
    world.press("ADDRESS_UP")
    seen = set()
    for _ in range(60):
        world.run(100)
        seen.add(row_2(world))
    assert "A1 RUN,HOLD=ALL" in seen and "READY        A2" in seen
    world.check()


def test_each_drive_has_a_setpoint_of_its_own():
    world = panel(addresses=(1, 2))
    world.press("UP", 60)
    world.run(60)
    world.press("ADDRESS_UP")
    world.run(100)
    assert row_1(world).startswith("S: 10.0")
    world.press("ADDRESS_DOWN")
    world.run(100)
    assert row_1(world).startswith("S: 10.1")
    world.check()


# --- when START is refused ----------------------------------------------------------------------


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
    assert row_2(world) == "FAULT        A1"
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
    world = panel(baud=2400)  # a slow line: reading the settings takes a second
    assert row_2(world) == "CHECKING     A1"
    refused(world, "NO: STILL CHECKS")


def test_start_of_a_drive_that_keeps_its_scaling_to_itself_is_refused():
    """It refuses to tell P2009: what a setpoint would mean is unknown."""
    world = World(main.start)
    parameters = world.drives[1]._parameters
    parameters.rows = {row: parameters.rows[row] for row in parameters.rows if row != 2009}
    world.run(2000)
    assert row_2(world) == "CHECKING     A1"
    refused(world, "NO: SCALING ???")


def test_start_of_an_inhibited_drive_is_refused():
    """OFF2 at the drive's own terminal, say: its inhibit stays while the cause does."""
    world = panel()
    world.drives[1]._process.zsw = lambda: 0xFB71
    world.run(300)
    assert row_2(world) == "INHIBITED    A1"
    refused(world, "NO: INHIBITED")
    world = panel()
    world.drives[1]._process.zsw = lambda: 0xFB30
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


def test_a_start_of_which_the_drive_changes_its_mind_is_taken_back():
    """P0700 is changed after ON has been sent and before the motor turns."""
    world = panel()
    world.drives[1].write(10, 0, 1)  # it does not start yet
    world.press("START")
    world.run(500)
    assert row_2(world) == "STARTING     A1"
    world.drives[1].write(700, 0, 2)
    world.run(2500)
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
        assert longest_us <= 2 * cycle_us, (baud, longest_us, cycle_us)
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
    assert row_2(world) == "READY        A2"
    world.press("ADDRESS_DOWN")
    world.run(100)
    assert row_2(world) == "FAULT        A1" and starts(world) == 0
    world.check()


def test_the_settings_of_a_drive_that_was_away_are_read_anew():
    world = panel()
    world.drives[1].unplug()
    world.run(2000)
    world.drives[1].write(700, 0, 2)
    world.drives[1].plug()
    survey = world.app.panel.selected.survey
    while not world.app.bus.drives[0].contact:
        world.run(2)
    world.run(4)
    assert not survey.complete and survey.scaling is None
    world.run(1500)
    assert row_2(world) == "LOCAL        A1"
    world.check()


def test_a_drive_that_runs_on_other_commands_is_said_to():
    world = running()
    world.drives[1].write(700, 0, 2)
    world.drives[1]._process.words = lambda count: [0xFB34, 0x0CCD]
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
    world = running()
    parameters = world.drives[1]._parameters
    parameters.rows = {row: parameters.rows[row] for row in parameters.rows if row != 1080}
    world.run(3000)
    world.press("UP")
    assert row_1(world) == "S: 10.0 F: 10.00" and row_2(world) == "NO: STILL CHECKS"
    world.check()


def test_the_time_after_which_a_drive_is_lost_is_that_of_the_settings():
    for lost_ms in (300, 3000):
        world = panel(settings={"lost_ms": lost_ms})
        world.drives[1].unplug()
        world.run(lost_ms - 100)
        assert world.app.bus.drives[0].contact and row_2(world) != "NO CONTACT   A1"
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
    drive = world.app.bus.drives[0]
    for _ in range(50):
        while not drive.channel.is_full():
            drive.ask(pkw.read(1120))
        world.run(20)
    assert row_2(world) == "READY        A1"
    world.check()


def test_stop_takes_back_a_start_whose_drive_is_still_being_asked():
    for baud in (2400, 9600):
        world = panel(baud=baud)
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
    words = world.drives[1]._process.words
    for hiw in (0x7FFF, 0x8000):
        world.drives[1]._process.words = lambda wanted: [words(wanted)[0], hiw]
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


# --- other things the display says --------------------------------------------------------------


def test_a_warning_of_the_drive_is_shown_while_it_runs():
    world = running()
    zsw = world.drives[1]._process.zsw
    world.drives[1]._process.zsw = lambda: zsw() | 0x80
    world.run(300)
    assert row_2(world) == "RUNNING WARN A1"
    world.check()


def test_another_drive_that_was_lost_or_does_not_stop_is_announced():
    world = running(addresses=(1, 12))
    world.drives[1].unplug()
    world.press("ADDRESS_UP")
    seen = set()
    for _ in range(60):
        world.run(100)
        seen.add(row_2(world))
    assert "A1 LOST,MAY RUN" in seen and "READY        A12" in seen
    world.press("ADDRESS_DOWN")
    world.press("STOP")
    world.press("ADDRESS_UP")
    seen = set()
    for _ in range(60):
        world.run(100)
        seen.add(row_2(world))
    assert "A1 NOT STOPPED" in seen and "A1 LOST,MAY RUN" not in seen
    world.check()


def test_another_master_on_the_line_is_shown_and_not_fought():
    class OtherMaster:
        name = "other master"

        def hear(self, burst):
            pass

    world = World(main.start)
    other = OtherMaster()
    world.wire.attach(other)
    for _ in range(40):
        world.wire.talk(other, b"\x02\x06\x05\x04\x7e\x00\x00\x7b", 8)
        world.run(50)
    assert row_2(world) == "LINE IN USE" and telegrams(world, 0) == []
    world.run(1500)  # it falls silent
    assert row_2(world) == "READY        A1"
    world.check()


def test_damaged_settings_are_said_and_the_defaults_used():
    world = World(main.start, settings={"setpoint_centihertz": -1})
    world.run(1000)
    assert row_2(world) == "SETTINGS DAMAGED"
    world.run(3000)
    assert world.lcd() == ("S: 10.0 F:  0.00", "READY        A1 ")
    world.check()


# --- when the drive stops by itself -------------------------------------------------------------


def test_a_drive_that_trips_does_not_start_again_when_the_fault_is_gone():
    world = running()
    world.drives[1].fault(1)
    world.run(500)
    assert row_2(world) == "FAULT        A1"
    stws = [stw for _, stw in telegrams(world, world.clock.now_us - 300_000, 1)]
    assert len(stws) > 5 and set(stws) == {OFF1}
    world.drives[1].power_off()
    world.run(3000)
    world.drives[1].power_on()
    world.run(5000)
    assert starts(world) == 1 and world.drives[1].hz() == 0
    world.check()


# --- a line that fails --------------------------------------------------------------------------


def test_unplugged_while_it_runs_the_display_does_not_pretend():
    world = running()
    world.drives[1].unplug()
    world.run(900)
    world.run(300)
    assert world.reads("NO CONTACT, MAY RUN")
    assert "10.00" not in row_1(world)
    world.press("STOP")  # acknowledges
    world.run(100)
    assert not world.reads("MAY RUN")
    assert row_2(world) == "NO CONTACT   A1"
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
    world = running()
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
    assert row_2(world) == "NO CONTACT   A1"
    world.drives[1].plug()
    world.run(1000)
    assert row_2(world) == "READY        A1" and starts(world) == 0
    world.check()


def test_a_gap_of_half_a_second_is_no_loss():
    world = running()
    world.drives[1].unplug()
    world.run(500)
    world.drives[1].plug()
    world.run(500)
    assert row_2(world) == "RUNNING      A1" and starts(world) == 1
    world.check()


# --- a panel that fails -------------------------------------------------------------------------


def test_a_main_loop_that_hangs_stops_the_motor_within_400_ms():
    for polled in (False, True):
        world = running(polled=polled)
        hung_us = world.clock.now_us
        world.hang(2000)
        offs = [at_us for at_us, stw in telegrams(world, hung_us, 1) if stw == OFF1]
        assert offs and 298_000 < offs[0] - hung_us <= 350_000, offs[:1]  # 400 ms is the promise
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
    world = panel(addresses=(1, 2, 3))
    for _ in range(3):
        world.press("START")
        world.press("ADDRESS_UP")
        world.run(200)
    world.run(4000)
    hung_us = world.clock.now_us
    world.hang(1000)
    for address in (1, 2, 3):
        offs = [at_us for at_us, stw in telegrams(world, hung_us, address) if stw == OFF1]
        assert offs and offs[0] - hung_us <= 400_000 + 2 * 22_000
    world.check()


def test_start_between_two_hangs_does_not_outlive_the_second():
    """The dead man has tripped already when START is obeyed; it holds all the same."""
    world = panel()
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
    assert starts(world) == 0


def test_an_engine_that_gets_nothing_done_restarts_the_chip():
    """It is entered all the time and fails all the time, so that no OFF1 gets out."""

    class Link:
        def __init__(self, link):
            self._link = link
            self.send = self.fail

        def __getattr__(self, name):
            return getattr(self._link, name)

        def fail(self, buffer, count):
            raise ERROR

    world = running()
    bus = world.app.bus
    bus._link = Link(bus._link)
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
        world.run(8000)
        assert row_2(world) == "READY        A1" and starts(world) == 1
        cut = [text for text in world.wire.violations if "driver" not in text]
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

        def read(self):
            raise error("on purpose")

    app.board.keypad = Broken()
    try:
        main.loop(app)
    except error:
        return
    raise AssertionError("the error got lost")


class Failing:
    """Stands before a receiver and fails some times. The heap is locked: nothing is made here."""

    def __init__(self, receiver, times):
        self.take = receiver.take
        self.due_us = receiver.due_us
        self.buffer = receiver.buffer
        self.times = times
        self._receiver = receiver

    @property
    def heard_at(self):
        return self._receiver.heard_at

    def open(self, address, net_count, residual_us, sent_at):
        if self.times:
            self.times -= 1
            raise ERROR
        self._receiver.open(address, net_count, residual_us, sent_at)


def test_an_exception_in_the_bus_engine_stops_the_motor_and_is_shown():
    world = running()
    bus = world.app.bus
    bus._receiver = Failing(bus._receiver, 3)
    world.run(12000)
    assert bus.failures == 3
    assert world.drives[1].hz() == 0 and starts(world) == 1
    assert row_2(world) == "BUS ERROR    A1"


# --- the clock wraps ----------------------------------------------------------------------------


def test_ticks_that_wrap_in_the_middle_of_an_exchange_disturb_nothing():
    """The counter wraps once at each instant of an exchange while the motor runs."""
    for bits in (24, 30):
        mask = (1 << bits) - 1
        for offset_us in range(0, 24_000, 2_400):
            world = running(ticks_start=mask - 5_250_000 - offset_us, ticks_mask=mask)
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


# --- other worlds -------------------------------------------------------------------------------


def test_other_delays_and_loop_times_change_nothing():
    for seed in range(1, 13):
        print("seed", seed)
        world = panel(seed=seed, addresses=(1, 7), polled=bool(seed & 1))
        world.press("START")
        world.run(5000)
        assert row_2(world) == "RUNNING      A1"
        world.press("STOP")
        world.run(8000)
        assert world.drives[1].hz() == 0 and starts(world) == 1
        world.check()
