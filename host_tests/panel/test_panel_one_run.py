# SPDX-License-Identifier: MIT
"""The operator's manual, one START, one run: a motor whose mains were away for a moment stays off.

The drives here power up ready (`clean_power_up`), so that the ON which stands on the line starts
them again. What a single reply shows is the subject of uss/test_one_run.py.
"""

from panel_bench import (
    OFF1,
    ON,
    late,
    panel,
    row_2,
    running,
    starts,
    telegrams,
    wait_until_known,
)
from uss.pkw import DONE

AWAY_MS = (50, 100, 200, 400, 800)


def interrupted(world, ms, address=1):
    """The mains of a drive fail for so long; the instant at which it has booted again."""
    drive = world.drives[address]
    drive.switches.clean_power_up = True
    drive.power_off()
    world.run(ms)
    drive.power_on()
    while drive.state == "off":
        world.run(2)
    return world.clock.now_us


def assert_stays_off(world, since_us, address=1):
    """Nothing drives it but for the telegrams under way; it coasts, and stands until START."""
    drive = world.drives[address]
    world.run(200)
    for _ in range(100):
        world.run(20)
        assert drive.state != "running", drive.report()
    sent = [stw for at_us, stw in telegrams(world, since_us, address)]
    assert ON not in sent[2:], sent[:20]
    assert starts(world, address) <= 2
    world.run(4000)
    assert drive.hz() == 0 and drive.stw == OFF1, drive.report()


def test_a_motor_whose_mains_failed_for_a_moment_does_not_start_again():
    for ms in AWAY_MS:
        world = running()
        assert_stays_off(world, interrupted(world, ms))
        assert row_2(world) in ("STOPPED SELF A1", "DRIVE RESET  A1", "LINE FAILED  A1"), ms
        world.press("START")
        world.run(3000)
        assert world.drives[1].state == "running" and row_2(world) == "RUNNING      A1"
        world.check()


def test_a_motor_that_is_at_its_speed_again_at_once_is_stopped_too():
    """Its ramp takes no time: HIW never shows the standstill. The drive counts from 0 again."""
    world = panel(parameters={2014: 2000, 1120: 0.0})
    wait_until_known(world)
    world.press("START")
    world.run(6000)
    interrupted(world, 100)
    world.run(2500)
    assert world.drives[1].state != "running", world.drives[1].report()
    world.run(12_000)
    assert row_2(world) in ("DRIVE RESET  A1", "STOPPED SELF A1") and starts(world) == 2
    world.check()


def test_the_counter_is_read_again_after_an_answer_that_came_too_late():
    world = panel(parameters={2014: 2000, 1120: 0.0})
    wait_until_known(world)
    world.press("START")
    world.run(6000)
    late(world, 2024)
    world.run(6000)
    assert row_2(world) == "RUNNING      A1", world.lcd()
    interrupted(world, 100)
    world.run(2500)
    assert world.drives[1].state != "running", world.drives[1].report()
    world.check()


def test_the_counter_of_the_drive_may_wrap():
    """r2024 has 16 bits: after 65535 comes 0, and the motor runs on."""
    world = running()
    counters = world.drives[1].slave.counters()
    counters[0] = 65_400
    world.run(1500)
    assert counters[0] > 65_400
    world.run(5000)
    assert counters[0] < 1000 and row_2(world) == "RUNNING      A1", world.lcd()
    counters[0] = 0
    world.run(2500)
    assert row_2(world) in ("DRIVE RESET  A1", "STOPPING     A1"), world.lcd()
    world.check()


def test_a_count_that_the_loop_takes_late_lacks_no_telegram():
    """Those answered between the reply that tells it and the loop's look, as beside 30 drives."""
    world = running(baud=115200)
    survey = world.app.panel.selected.survey
    step = survey.step
    counts = []  # when they were there to be taken
    is_new = [True]

    def step_late(now, *more):
        job = survey._asked
        is_there = job is not None and job.number == 2024 and job.state == DONE
        if is_there and is_new[0]:
            counts.append(now)
        is_new[0] = not is_there
        is_second = is_there and len(counts) % 2 == 0
        if is_second and (now - counts[-1]) & world.clock.ticks_mask < 1_500_000:
            return  # every second one waits
        step(now, *more)

    survey.step = step_late
    world.run(20_000)
    assert len(counts) > 4
    assert row_2(world) == "RUNNING      A1" and starts(world) == 1, world.lcd()
    world.check()


def test_a_motor_out_of_sight_is_watched_as_well():
    world = running(addresses=(1, 2))
    world.press("ADDRESS_UP")
    world.run(2000)
    assert_stays_off(world, interrupted(world, 200))
    world.check()


def test_a_jog_after_the_mains_were_away_is_no_reason_to_take_it_back():
    """The drive was reset while it stood, before the key went down."""
    world = running()
    world.press("STOP")
    world.run(5000)
    interrupted(world, 100)
    world.run(100)
    world.down("JOG_RIGHT")
    world.run(4000)
    assert row_2(world) == "JOG RIGHT    A1", world.lcd()
    world.check()


def test_start_asks_where_the_drive_restarts_by_itself():
    for mode in (0, 1):
        world = panel(parameters={2014: 2000, 1210: mode})
        wait_until_known(world)
        world.press("START")
        world.run(2000)
        assert world.drives[1].state == "running"
    world = panel(parameters={2014: 2000, 1210: 3})
    wait_until_known(world)
    world.press("START")
    rows = set()
    for _ in range(80):
        world.run(100)
        rows.add(world.lcd())
    choice = "START=GO STOP=NO"
    for row in ("P1210=3: DRIVE  ", "STARTS BY ITSELF", "THE PANEL WILL  ", "STOP IT THEN    "):
        assert (row, choice) in rows, rows
    assert starts(world) == 0
    world.press("SET")  # it is no answer
    world.run(500)
    assert row_2(world) == "NOT STARTED  A1" and starts(world) == 0
    for _ in range(2):
        world.press("START")
        world.run(2500)
    assert world.drives[1].state == "running" and row_2(world) == "RUNNING      A1"
    world.press("STOP")
    world.run(5000)
    world.press("START")  # that is known by now, as long as nothing else is set there
    world.run(2000)
    assert world.drives[1].state == "running"
    world.press("STOP")
    world.run(5000)
    world.drives[1].write(1210, 0, 4)
    world.press("START")
    world.run(2000)
    assert row_2(world) == choice and starts(world) == 2
    world.check()


def test_who_looks_at_the_drive_does_not_hide_that_it_was_reset():
    """All is asked anew of a drive that is selected; what it had counted before still counts."""
    world = panel(addresses=(1, 2), parameters={2014: 2000, 1120: 60.0})
    world.press("ADDRESS_UP")
    wait_until_known(world)
    world.press("START")
    world.run(4500)
    world.press("ADDRESS_DOWN")
    world.run(3000)
    assert world.drives[2].state == "running"
    interrupted(world, 200, 2)
    world.press("ADDRESS_UP")
    world.run(20_000)
    assert world.drives[2].state != "running", row_2(world)
    world.check()


def test_a_dip_of_the_whole_plant_while_somebody_looks_through_the_addresses():
    addresses = (1, 2, 3, 4, 5, 6, 7, 8)
    world = panel(addresses=addresses, parameters={2014: 2000, 1120: 60.0})
    for _ in addresses:
        wait_until_known(world)
        world.press("START")
        world.run(1300)
        world.press("ADDRESS_UP")
    for drive in world.drives.values():
        drive.switches.clean_power_up = True
        drive.power_off()
    world.run(100)
    for drive in world.drives.values():
        drive.power_on()
    for _ in addresses:
        world.press("ADDRESS_UP")
        world.run(300)
    world.run(30_000)
    assert not [address for address in addresses if world.drives[address].state == "running"]
    world.check()


def test_a_drive_that_was_switched_on_just_before_start_and_is_reset():
    """Its counter was so low at START that it is higher again at the next reading."""
    for after_ms in (500, 600, 700, 800):
        world = panel(parameters={2014: 2000})
        drive = world.drives[1]
        drive.switches.clean_power_up = True
        drive.switches.boot_ms = 0
        world.run(1000)
        drive.power_off()
        world.run(1500)
        drive.power_on()
        world.run(500)
        world.press("START")
        world.run(after_ms)
        interrupted(world, 20)
        world.run(12_000)
        assert drive.state != "running", (after_ms, row_2(world))
        world.check()
