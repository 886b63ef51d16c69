# SPDX-License-Identifier: MIT
"""Where the simulated drive's setpoint comes from, what limits it, and how the motor follows.

P and r numbers are those of the MICROMASTER 4 lists. Limits, ramps, reversal and jogging are in
test_simulated_drive_motor.py.
"""

from boards.sim.drives.families import mm440
from drive_bench import HALF, JOG_LEFT, OFF1, RUN, Bench, telegram

UP, DOWN = 0x2000, 0x4000  # bits of STW
BY_POTENTIOMETER = {1000: 1, 1120: 10.0, 1121: 10.0}  # 5 Hz a second


def hz(bench):
    """Frequency of the motor, and r1050."""
    return round(bench.drive.hz(), 2), round(bench.drive.read(1050), 2)


# --- the motor potentiometer: P1000 = 1, STW bits 13 and 14 -----------------------------------


def test_the_motor_potentiometer_is_turned_by_two_bits():
    bench = Bench(BY_POTENTIOMETER, family=mm440)
    bench.run()
    assert hz(bench) == (5, 5)  # P1040
    bench.control(RUN | UP)
    bench.wait(2)
    bench.control(RUN)
    assert 14.9 < hz(bench)[1] < 15.3  # at the rate of P1120
    bench.wait(5)
    turned = hz(bench)
    assert turned[0] == turned[1]
    bench.control(RUN | UP | DOWN)
    bench.wait(5)
    assert hz(bench) == turned  # both: it stands still
    bench.control(RUN | DOWN)
    bench.wait(1)
    bench.control(RUN)
    bench.wait(1)
    assert 9.7 < hz(bench)[1] < 10.3


def test_it_has_ends():
    # P1082 on one side; on the other 0 Hz, or the left with P1032 = 0.
    for right_only, low_hz in ((1, 0), (0, -50)):
        parameters = dict(BY_POTENTIOMETER)
        parameters[1032] = right_only
        bench = Bench(parameters)
        bench.run()
        bench.control(RUN | UP)
        bench.wait(20)
        assert hz(bench) == (50, 50)
        bench.control(RUN | DOWN)
        bench.wait(60)
        assert hz(bench) == (low_hz, low_hz)


def test_it_begins_at_p1040_or_where_it_was():
    for kept, expected in ((0, 5), (1, 20)):
        parameters = dict(BY_POTENTIOMETER)
        parameters[1031] = kept
        bench = Bench(parameters)
        bench.run()
        bench.control(RUN | UP)
        bench.wait(30)
        bench.control(RUN | DOWN)
        bench.wait(6)
        bench.control(OFF1)
        bench.wait(20)
        bench.run()
        assert abs(bench.drive.hz() - expected) < 0.3, kept
        if kept:
            bench.drive.power_off()
            bench.drive.power_on()
            assert abs(bench.drive.read(1040) - 20) < 0.3


def test_p1040_moves_it_while_it_runs():
    bench = Bench(BY_POTENTIOMETER)
    bench.run()
    bench.drive.write(1040, 0, 30.0)
    bench.wait(10)
    assert hz(bench) == (30, 30)


def test_it_only_turns_while_it_is_the_setpoint_of_a_running_motor():
    bench = Bench(BY_POTENTIOMETER)
    bench.control(OFF1 | UP)
    bench.wait(5)
    assert hz(bench) == (0, 5)
    bench.control(JOG_LEFT | UP)
    bench.wait(5)
    assert hz(bench)[0] == -5
    bench = Bench()
    bench.control(OFF1)
    bench.control(RUN | UP, HALF)
    bench.wait(10)
    assert hz(bench) == (25, 5)


def test_it_does_not_depend_on_how_often_somebody_asks():
    seldom, often = Bench(BY_POTENTIOMETER), Bench(BY_POTENTIOMETER)
    for bench in (seldom, often):
        bench.run()
        bench.control(RUN | UP)
    for _ in range(700):
        often.wait(0.0051)
        often.drive.hz()
    seldom.clock.advance_to(often.clock.now_us)
    assert seldom.drive.hz() == often.drive.hz() and hz(seldom)[1] == hz(often)[1] > 20


# --- other sources ----------------------------------------------------------------------------


def test_fixed_frequencies_are_selected_by_control_word_2():
    # P1000 = 3: STW2 bits 0 to 3 choose P1001 to P1004, several add up.
    bench = Bench({1000: 3, 1001: 10.0, 1002: -4.0, 1003: 20.0, 1004: 1.0, 2012: 4})
    bench.exchange(0, 0, 0, 0, OFF1, 0, 0, 0)
    for selection, expected in ((0, 0), (1, 10), (2, -4), (3, 6), (4, 20), (8, 1), (0xF, 27)):
        bench.exchange(0, 0, 0, 0, RUN, HALF, 0, selection)
        bench.wait(20)
        assert bench.drive.hz() == expected and bench.drive.read(1024) == expected, selection


# --- what limits it ---------------------------------------------------------------------------


def test_skip_frequencies():
    # P1091 ... P1094 with P1101 on both sides: never a setpoint within, both directions.
    bench = Bench({1091: 20.0, 1092: 40.0, 1101: 2.0, 2009: 1})
    bench.control(OFF1)
    for wanted, given in (
        (17.9, 17.9), (18.1, 18), (20, 18), (21.9, 18), (22, 22), (39, 38), (-20, -18), (-23, -23),
    ):  # fmt: skip
        bench.control(RUN, round(wanted * 100) & 0xFFFF)
        assert abs(bench.drive.read(20) - given) < 0.001, wanted
        bench.wait(20)
        assert abs(bench.drive.hz() - given) < 0.001


def test_reversing_may_be_forbidden():
    # P1110 = 1:0: to the left is 0 Hz, or P1080.
    for minimum_hz in (0.0, 5.0):
        bench = Bench({1110: 0x00010000, 1080: minimum_hz})
        bench.control(OFF1)
        for stw, hsw in ((RUN | 0x0800, HALF), (RUN, 0xE000), (RUN | 0x0800, 0)):
            bench.control(stw, hsw)
            bench.wait(20)
            assert bench.drive.hz() == minimum_hz
        bench.control(RUN | 0x0800, 0xE000)
        bench.wait(20)
        assert bench.drive.hz() == 25


# --- the motor without pulses -----------------------------------------------------------------


def test_a_motor_coasts_as_long_as_its_inertia_lets_it():
    # 5 s from 50 Hz as it comes; a flywheel takes longer.
    for coast_s, left_hz in ((5.0, 15), (20.0, 22.5)):
        bench = Bench()
        bench.drive.plant.coast_s = coast_s
        bench.run()
        bench.control(0x047C)  # OFF2
        began_us = bench.clock.now_us
        bench.clock.advance_to(began_us + 1_000_000)
        assert abs(bench.drive.hz() - left_hz) < 0.5
        bench.wait(coast_s)
        assert bench.drive.hz() == 0


def test_flying_start():
    # P1200: a motor that still turns is caught, or forced to 0 Hz first.
    for catches in (0, 1):
        bench = Bench({1200: catches})
        bench.drive.plant.coast_s = 50.0
        bench.run()
        bench.control(RUN & ~8, HALF)
        bench.wait(2)
        bench.control(RUN, HALF)
        assert bench.drive.state == "running" and bench.drive.starts == 2
        assert (22 < bench.drive.hz() < 25) if catches else bench.drive.hz() < 0.5
        bench.wait(10)
        assert bench.drive.hz() == 25


def test_a_holding_brake_shows_in_bit_12():
    # P1215. Without one the bit is 1, as every recording has it.
    for brake, standing, turning in ((0, 0x1000, 0x1000), (1, 0x1000, 0)):
        bench = Bench({1215: brake})
        assert bench.control(OFF1)[0] & 0x1000 == standing
        assert bench.control(RUN, HALF)[0] & 0x1000 == turning


def test_the_state_of_the_drive_as_a_number():
    # r0002: 0 commissioning, 1 ready, 2 fault, 4 running, 5 stopping
    bench = Bench()
    assert bench.drive.read(2) == 1
    bench.run()
    assert bench.drive.read(2) == 4
    bench.control(OFF1)
    assert bench.drive.read(2) == 5
    bench.drive.fault(1)
    assert bench.drive.read(2) == 2
    assert Bench({10: 1}).drive.read(2) == 0


# --- what the documents leave open ------------------------------------------------------------


def test_another_state_at_power_up():
    bench = Bench(switches={"clean_power_up": True})
    assert bench.drive.read(52) == 0xFB31 and bench.drive.state == "ready"
    assert bench.control(RUN, HALF)[0] & 0xFF == 0x34  # it has seen OFF1 already


def test_another_status_word_in_standby():
    bench = Bench(switches={"bare_standby": True})
    assert bench.control(OFF1)[0] == 0x0731
    assert bench.control(RUN, HALF)[0] == 0xFA34


def test_what_a_broadcast_needs():
    everything = (0x0007, 0xFFFF, 0, 0)
    setpoint = (0x0005, 0, 0, 0)
    for switches, enable, stw, taken in (
        ({}, setpoint, 0, True),
        ({"broadcast_bit_10": True}, setpoint, 0, False),
        ({"broadcast_bit_10": True}, setpoint, OFF1, True),
        ({}, everything, 0, False),
        ({}, (0, 0, 0, 0), OFF1, False),
        ({"broadcast_without_flag": True}, (0, 0, 0, 0), OFF1, True),
        ({"broadcast_without_flag": True}, (0, 0, 0, 0), 0, False),
    ):
        bench = Bench(switches=switches)
        bench.control(OFF1)
        bench.send(telegram(0x20, *enable + (stw, 0x1234)))
        bench.wait(0.1)
        assert (bench.drive.read(2018, 1) == 0x1234) == taken, (switches, enable, stw)
