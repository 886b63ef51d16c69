# SPDX-License-Identifier: MIT
"""The simulated drive under load: currents, voltages, heat, and the trips that come of them.

They are plausible, no more: the tests say which way each goes, and by how much where a rating
plate or a parameter tells. The drive is a MICROMASTER 440, which shows most; the motor is that of
the delivered parameters, 0.75 kW, 3.25 A.
"""

from boards.sim.drives.families import g110, g120, mm3, mm420, mm440, v20
from boards.sim.drives.parameters import MAXIMUM, MINIMUM, NUMBER
from boards.sim.drives.power.plant import CONSTANT, FAN, LINEAR
from drive_bench import ACKNOWLEDGE, HALF, OFF1, RUN
from drive_bench import Bench as AnyBench

FULL = 0x4000  # 50 Hz

RATINGS = (
    "rated_v", "rated_a", "rated_kw", "rated_hz", "rated_rpm", "magnetising_percent",
    "overload_percent", "heat_s", "reference_v", "reference_a", "reference_nm",
)  # fmt: skip


def Bench(parameters=None, **more):
    return AnyBench(parameters, family=mm440, **more)


def amps(bench):
    return bench.drive.read(27)


def running(load=50, kind=FAN, hsw=FULL, parameters=None, **more):
    """A bench whose motor has been at its speed for a while."""
    bench = Bench(parameters, **more)
    bench.drive.load(load, kind)
    bench.run(hsw)
    return bench


def near(value, expected, part=0.02):
    return abs(value - expected) <= part * abs(expected)


# --- readings ---------------------------------------------------------------------------------


def test_a_motor_that_is_not_driven_takes_nothing():
    bench = Bench()
    for number in (22, 25, 27, 31, 32, 36, 38):
        assert bench.drive.read(number) == 0, number
    assert bench.drive.read(26) == 560  # the DC link is charged all the same
    bench.drive.power_off()
    assert bench.drive.read(26) == 0


def test_readings_go_with_the_speed():
    # r0022 speed, r0025 voltage, r0027 current, r0031 torque, r0032 power
    bench = running(100, CONSTANT, HALF)
    half = [bench.drive.read(number) for number in (22, 25, 27, 31, 32)]
    assert half[0] == 750 and near(half[1], 115) and near(half[2], 3.25) and near(half[4], 0.375)
    bench.control(RUN, FULL)
    bench.wait(10)
    full = [bench.drive.read(number) for number in (22, 25, 27, 31, 32)]
    assert full[0] == 1500 and near(full[1], 230) and near(full[4], 0.75)
    assert near(full[2], half[2]) and near(full[3], half[3]) and near(full[3], 5.13)  # 9550 P / n
    assert 540 < bench.drive.read(26) < 560
    bench.control(RUN | 0x0800, FULL)
    bench.wait(20)
    assert near(bench.drive.read(31), -5.13) and near(bench.drive.read(32), 0.75)


def test_the_load_depends_on_the_speed_as_its_kind_says():
    torque = {}
    for kind in (CONSTANT, LINEAR, FAN):
        bench = running(80, kind, HALF)
        torque[kind] = bench.drive.read(31)
    assert near(torque[LINEAR], torque[CONSTANT] / 2)
    assert near(torque[FAN], torque[CONSTANT] / 4)


def test_an_idling_motor_still_magnetises():
    # P0320, 0: half of the rated current
    assert near(amps(running(0)), 3.25 / 2)
    assert near(amps(running(0, parameters={320: 30.0})), 3.25 * 0.3)
    assert near(amps(running(100)), 3.25)


def test_acceleration_takes_current_and_braking_feeds_back():
    bench = Bench({1120: 2.0, 1121: 2.0})
    bench.drive.load(50, CONSTANT, inertia_s=2.0)
    bench.control(OFF1)
    bench.control(RUN, FULL)
    bench.wait(1)
    speeding_up = amps(bench)
    assert bench.drive.read(26) < 560
    bench.wait(2)
    at_speed = amps(bench)
    assert speeding_up > at_speed * 1.5
    bench.control(OFF1)
    bench.wait(0.1)
    assert bench.drive.read(31) < 0 and bench.drive.read(26) > 600
    assert bench.drive.read(2110) == 911  # the Vdc-max controller, P1240
    bench.wait(2)
    assert bench.drive.read(26) == 560 and bench.drive.read(2110) == 0


def test_the_energy_meter():
    bench = running(100, CONSTANT)
    bench.drive.write(40, 0, 1)
    bench.wait(3600)
    assert near(bench.drive.read(39), 0.75, 0.001)
    bench.control(OFF1)
    bench.wait(3600)
    assert bench.drive.read(39) < 0.76
    bench.drive.write(40, 0, 1)
    assert bench.drive.read(39) == 0


def test_quantities_are_sent_as_process_data():
    # P2019: r0027 against P2002, r0026 and r0025 against P2001
    bench = Bench({(2019, 2): 27 << 16, (2019, 3): 26 << 16, 2012: 4, 2002: 6.5, 2001: 1000})
    bench.drive.load(100, CONSTANT)
    bench.exchange(0, 0, 0, 0, OFF1, 0, 0, 0)
    bench.exchange(0, 0, 0, 0, RUN, FULL, 0, 0)
    bench.wait(20)
    words = bench.exchange(0, 0, 0, 0, RUN, FULL, 0, 0)[4:]
    assert abs(words[2] - 0x2000) < 20  # 3.25 A of 6.5
    assert abs(words[3] / 16384 * 1000 - bench.drive.read(26)) < 0.1


def test_whatever_the_rating_plate_says_it_goes_on():
    # Every rating at both of its limits, in each family that has it: readings stay numbers.
    for family in (mm3, mm420, mm440, g110, v20, g120):
        rated = [row for row in family.SETTINGS if row[0] in RATINGS]
        rows = {row[NUMBER]: row for row in family.ROWS}
        for _, number, _ in rated:
            for limit in (MINIMUM, MAXIMUM):
                bench = AnyBench({family.LINK["off time"]: 0}, family=family)
                bench.drive.write(number, 0, rows[number][limit])
                pkw = [0] * (3 if bench.drive.layout[0] == 127 else bench.drive.layout[0])
                bench.exchange(*pkw + [OFF1, 0])
                bench.exchange(*pkw + [0x0C7F if family is mm3 else RUN, FULL])
                bench.wait(20)
                assert bench.exchange(*pkw + [OFF1, 0]), (family.NAME, number)
                for reading in family.READINGS:
                    value = bench.drive.read(reading)
                    assert value == value, (family.NAME, number, reading)


# --- overload ---------------------------------------------------------------------------------


def test_more_than_the_current_limit_warns_and_trips_after_a_second():
    # P0640 = 150 %: A0501 and ZSW bit 11, then F0001
    bench = running(100)
    bench.drive.load(300)
    assert bench.control(RUN, FULL)[0] & 0x0880 == 0x0080
    assert bench.drive.read(2110) == 501 and near(amps(bench), 1.5 * 3.25)
    bench.wait(0.5)
    assert bench.drive.state == "running"
    bench.wait(0.5)
    assert bench.drive.state == "fault" and bench.drive.read(947) == 1
    bench.control(ACKNOWLEDGE)
    assert bench.control(OFF1)[0] & 0x0809 == 0x0801


def test_a_short_overload_does_no_harm():
    bench = running(100)
    for _ in range(5):
        bench.drive.load(300)
        bench.wait(0.8)
        bench.drive.load(100)
        bench.wait(0.2)
    assert bench.drive.state == "running"


def test_a_motor_that_gets_too_hot_trips_and_has_to_cool():
    # I squared t, P0611 = 100 s: r0034, A0511 and ZSW bit 13 at 100 %, F0011 at 110 %
    bench = running(100, CONSTANT)
    bench.wait(1000)
    assert near(bench.drive.read(34), 100) and bench.drive.state == "running"
    bench.drive.load(130, CONSTANT)
    bench.wait(5)
    assert bench.control(RUN, FULL)[0] & 0x2080 == 0x0080
    assert 511 in [bench.drive.read(2110, i) for i in (0, 1)]
    bench.wait(18)
    assert bench.drive.state == "fault" and bench.drive.read(947) == 11
    assert bench.control(OFF1)[0] & 0x2008 == 0x0008
    bench.control(ACKNOWLEDGE)
    bench.control(OFF1)
    assert bench.drive.state == "fault"  # still hot
    bench.wait(30)
    bench.control(ACKNOWLEDGE)
    assert bench.control(OFF1)[0] & 0x2009 == 0x2001
    assert bench.drive.read(35) < 20 + 80 * 1.1


def test_it_trips_at_the_instant_whoever_asks():
    # Worked out when somebody asks: the motor that was not asked has coasted just as long.
    seldom, often = [running(140, CONSTANT, parameters={611: 30}) for _ in range(2)]
    for _ in range(500):
        often.wait(0.05)
        often.drive.hz()
    seldom.clock.advance_to(often.clock.now_us)
    for bench in (seldom, often):
        assert bench.drive.state == "fault" and bench.drive.read(947) == 11
    assert seldom.drive.read(948, 1) == often.drive.read(948, 1)
    assert abs(seldom.drive.hz() - often.drive.hz()) < 1e-6
    assert abs(seldom.drive.read(34) - often.drive.read(34)) < 1e-3


def test_overload_may_be_without_consequences():
    bench = running(300, switches={"overload_trips": False})
    bench.wait(1000)
    assert bench.drive.state == "running" and bench.drive.read(34) > 110


def test_a_ramp_that_is_too_fast_may_trip():
    # F0002, switched off as delivered
    for trips in (False, True):
        bench = Bench({1121: 0.5}, switches={"overvoltage_trips": trips})
        bench.drive.load(0, inertia_s=2.0)
        bench.run(FULL)
        bench.control(OFF1)
        bench.wait(0.2)
        assert bench.drive.state == ("fault" if trips else "stopping")
        assert bench.drive.read(947) == (2 if trips else 0)
    bench = Bench({1121: 10.0}, switches={"overvoltage_trips": True})
    bench.drive.load(0, inertia_s=2.0)
    bench.run(FULL)
    bench.control(OFF1)
    bench.wait(10)
    assert bench.drive.state == "ready"


def test_status_word_2_compares_current_and_voltage():
    # bit 3: P2170, percent of the rated current; bits 7 and 8: P2172, V
    for parameters, bits in (
        ({}, 0x0080), ({2170: 50.0}, 0x0088), ({2172: 500}, 0x0100),
        ({2172: 500, 2170: 50.0}, 0x0108),
    ):  # fmt: skip
        bench = running(50, FAN, FULL, parameters)
        assert bench.drive.read(53) & 0x0188 == bits, parameters
