# SPDX-License-Identifier: MIT
"""The simulated drive's faults and warnings: what they do, what it remembers, what ends them.

P and r numbers are those of the MICROMASTER 4 lists; "SPEC" is the USS specification.
"""

from boards.sim.drives.families import g120, mm3, mm420, mm440, v20
from drive_bench import ACKNOWLEDGE, HALF, JOG_LEFT, JOG_RIGHT, OFF1, RUN, Bench, telegram

READ, WRITE, WORD = 0x1000, 0x2000, 0x1000
SECOND_PAGE = 0x8000  # IND of numbers from 2000 on


def faults(bench, count=8):
    """r0947."""
    return [bench.drive.read(947, i) for i in range(count)]


def warnings(bench):
    """r2110: two that are present, two that are gone."""
    return [bench.drive.read(2110, i) for i in range(4)]


def acknowledge(bench):
    bench.control(ACKNOWLEDGE)
    bench.control(OFF1)


# --- acknowledging: SPEC C-5.2.1, STW bit 7 ---------------------------------------------------


def test_a_fault_whose_cause_is_there_cannot_be_acknowledged():
    bench = Bench()
    bench.run()
    bench.drive.fault(4, lasting=True)
    acknowledge(bench)
    assert bench.drive.state == "fault" and faults(bench, 2) == [4, 0]
    bench.drive.clear_cause()
    assert bench.drive.state == "fault"  # nobody has acknowledged it since
    assert bench.control(OFF1)[0] & 0xFF == 0x78
    acknowledge(bench)
    assert bench.drive.state == "ready" and faults(bench, 4) == [0, 0, 4, 0]


def test_one_cause_of_two_is_enough():
    bench = Bench()
    bench.drive.fault(4, lasting=True)
    bench.drive.fault(85, lasting=True)
    bench.drive.clear_cause(4)
    acknowledge(bench)
    assert bench.drive.state == "fault" and faults(bench, 2) == [4, 85]
    bench.drive.clear_cause(85)
    acknowledge(bench)
    assert bench.drive.state == "ready"


def test_acknowledging_is_an_edge():
    bench = Bench()
    bench.control(ACKNOWLEDGE)
    bench.drive.fault(1)
    for _ in range(3):
        assert bench.control(ACKNOWLEDGE)[0] & 8
    bench.control(OFF1)
    assert not bench.control(ACKNOWLEDGE)[0] & 8
    assert bench.drive.state in ("inhibited", "ready")


def test_acknowledging_with_on_ends_in_the_inhibit():
    bench = Bench()
    bench.run()
    bench.drive.fault(1)
    assert bench.control(RUN | 0x80, HALF)[0] & 0x48 == 0x40
    assert bench.control(RUN, HALF)[0] & 0x48 == 0x40
    assert bench.drive.starts == 1


def test_the_word_that_acknowledges_lifts_the_inhibit_when_it_comes_again():
    # OFF1 with OFF2 and OFF3 inactive ends the inhibit, and no edge is asked for: 04FE says that
    # too. Whether the setpoint beside it changes has no part in it.
    for setpoints in ((0, 0, 0, 0), (0, 1, 2, 3)):
        bench = Bench()
        bench.control(OFF1)
        bench.drive.fault(1)
        words = [bench.control(ACKNOWLEDGE, hsw)[0] for hsw in setpoints]
        assert words == [0xFB71, 0xFB31, 0xFB31, 0xFB31], setpoints


def test_off_and_on_acknowledges_but_not_what_lasts():
    bench = Bench()
    bench.drive.fault(1)
    bench.drive.fault(4, lasting=True)
    bench.drive.power_off()
    bench.drive.power_on()
    assert bench.drive.state == "fault" and faults(bench, 4) == [4, 0, 1, 4]
    bench.drive.clear_cause()
    bench.drive.power_off()
    bench.drive.power_on()
    assert bench.drive.state == "inhibited" and faults(bench, 4) == [0, 0, 4, 0]


def test_p3981_acknowledges_unless_the_cause_lasts():
    bench = Bench({3: 4}, family=mm440)
    bench.control(OFF1)
    bench.drive.fault(1, lasting=True)
    bench.drive.write(3981, 0, 1)
    assert bench.drive.state == "fault" and bench.drive.read(3981) == 0
    bench.drive.clear_cause()
    bench.drive.write(3981, 0, 1)
    bench.control(OFF1)
    assert bench.drive.state == "ready"


def test_a_drive_without_mains_does_not_trip():
    bench = Bench()
    bench.drive.power_off()
    try:
        bench.drive.fault(1)
    except ValueError as error:
        assert error.args[0] == "drive 1 is off"
    else:
        raise AssertionError("it tripped")


# --- what it remembers ------------------------------------------------------------------------


def test_numbers_values_and_times_move_on_together():
    # r0947, r0949, r0948: run time in seconds, high word first (no clock is set).
    bench = Bench()
    bench.wait(100)
    bench.drive.fault(1, value=17)
    bench.drive.fault(
        2, value=18
    )  # before the acknowledgement: the second place, no time of its own
    bench.wait(70_000)
    acknowledge(bench)
    bench.drive.fault(3)
    assert faults(bench, 4) == [3, 0, 1, 2]
    assert [bench.drive.read(949, i) for i in range(4)] == [0, 0, 17, 18]
    assert [bench.drive.read(948, i) for i in range(6)] == [1, 70_100 - 65_536, 0, 0, 100, 0]
    assert bench.drive.read(952) == 3


def test_four_trips_are_kept():
    bench = Bench()
    for number in range(1, 7):
        bench.drive.fault(number, value=number)
        acknowledge(bench)
    assert faults(bench) == [0, 0, 6, 0, 5, 0, 4, 0]
    assert bench.drive.read(952) == 3


def test_a_v20_keeps_32_trips():
    # r0947, r0948 and r0949 have 64 places: two faults of each trip, and two words of its time.
    bench = Bench({2014: 0}, family=v20)
    for number in range(1, 36):
        bench.wait(100)
        bench.drive.fault(number, value=100 + number)
        if number == 10:
            bench.drive.fault(80)
        for stw in (ACKNOWLEDGE, OFF1):
            bench.exchange(0, 0, 0, stw, 0)
    kept = [0, 0]
    for number in range(35, 4, -1):
        kept += [number, 80 if number == 10 else 0]
    assert faults(bench, 64) == kept
    assert [bench.drive.read(949, place) for place in (2, 3, 62, 63)] == [135, 0, 105, 0]
    times = [bench.drive.read(948, place) for place in range(64)]
    assert times[::2] == [0] * 32 and times[1] == 0
    assert all([0 <= times[2 * i + 1] - 3600 + 100 * i < 100 for i in range(1, 32)]), times
    assert bench.drive.read(952) == 32


def test_p0952_forgets_all_but_the_present_trip():
    bench = Bench({3: 3})
    for number in (1, 2):
        bench.drive.fault(number, value=9)
        acknowledge(bench)
    bench.drive.fault(72, value=9)
    assert bench.drive.read(952) == 3
    bench.drive.write(952, 0, 0)
    assert faults(bench) == [72] + [0] * 7 and bench.drive.read(952) == 1
    assert [bench.drive.read(949, i) for i in range(8)] == [9] + [0] * 7
    assert bench.drive.state == "fault"  # forgetting is not acknowledging


def test_the_reply_to_what_clears_tells_what_is_left():
    """A write is answered with the present value: P0952 = 0 leaves the present trip, P2111 = 0 the
    warnings that are there, P0040 = 1 is 0 again.
    """
    bench = Bench({3: 3})
    bench.drive.fault(1)
    acknowledge(bench)
    bench.drive.fault(72)
    assert bench.task(READ | 952) == (WORD | 952, 0, 0, 2)
    assert bench.task(WRITE | 952) == (WORD | 952, 0, 0, 1)
    assert bench.task(READ | 952) == (WORD | 952, 0, 0, 1)
    for number in (504, 505):
        bench.drive.warn(number)
    bench.drive.warn(505, False)
    assert bench.task(READ | 111, SECOND_PAGE) == (WORD | 111, SECOND_PAGE, 0, 2)
    assert bench.task(WRITE | 111, SECOND_PAGE) == (WORD | 111, SECOND_PAGE, 0, 1)
    assert bench.task(WRITE | 40, 0, 0, 1) == (WORD | 40, 0, 0, 0)


def test_the_run_time_counts_while_there_are_mains():
    # r2114, seconds: high word, low word.
    bench = Bench()
    bench.wait(90_000)
    assert [bench.drive.read(2114, i) for i in (0, 1)] == [1, 90_000 - 65_536]
    bench.drive.power_off()
    bench.wait(1000)
    bench.drive.power_on()
    bench.wait(10)
    assert bench.drive.read(2114, 1) == 90_010 - 65_536


# --- warnings ---------------------------------------------------------------------------------


def test_a_warning_stops_nothing_and_goes_by_itself():
    bench = Bench()
    bench.run()
    bench.drive.warn(504)
    assert bench.control(RUN, HALF)[0] == 0xFBB4  # bit 7
    assert warnings(bench) == [504, 0, 0, 0] and bench.drive.read(2111) == 1
    bench.drive.warn(504, False)
    assert bench.control(RUN, HALF)[0] == 0xFB34
    assert warnings(bench) == [0, 0, 504, 0]


def test_two_warnings_are_shown_and_two_that_are_gone():
    bench = Bench()
    for number in (501, 502, 503):
        bench.drive.warn(number)
    assert warnings(bench) == [501, 502, 0, 0]
    bench.drive.warn(501, False)
    assert warnings(bench) == [502, 503, 501, 0]
    bench.drive.warn(503, False)
    assert warnings(bench) == [502, 0, 503, 501] and bench.drive.read(2111) == 3
    bench.drive.write(2111, 0, 0)
    assert warnings(bench) == [502, 0, 0, 0]


def test_both_jogs_are_warning_a0923():
    bench = Bench()
    bench.control(OFF1)
    assert bench.control(JOG_RIGHT | JOG_LEFT)[0] & 0x80
    assert warnings(bench)[0] == 923
    assert not bench.control(OFF1)[0] & 0x80
    assert warnings(bench) == [0, 0, 923, 0]


# --- what makes it trip by itself -------------------------------------------------------------


def test_an_external_fault_by_control_word_2():
    # P2106 = 2037:13, STW2 bit 13; 1 is in order. As delivered the bit says nothing.
    for source, trips in ((0x00010000, False), (2037 << 16 | 13, True)):
        bench = Bench({2012: 4, 2106: source})
        pkw = (0, 0, 0, 0)
        bench.exchange(*pkw + (OFF1, 0, 0, 0x2000))
        assert bench.drive.state == "ready"
        bench.exchange(*pkw + (OFF1, 0, 0, 0))
        assert (bench.drive.state == "fault") == trips
        if trips:
            assert bench.drive.read(947) == 85
            bench.exchange(*pkw + (ACKNOWLEDGE, 0, 0, 0))
            bench.exchange(*pkw + (OFF1, 0, 0, 0))
            assert bench.drive.state == "fault"  # the bit is still 0
            bench.exchange(*pkw + (ACKNOWLEDGE, 0, 0, 0x2000))
            bench.exchange(*pkw + (OFF1, 0, 0, 0x2000))
            assert bench.drive.state == "ready"


def test_mains_that_sag_trip_a_running_drive():
    bench = Bench()
    bench.control(OFF1)
    bench.drive.supply(230)
    assert bench.drive.state == "ready" and warnings(bench)[0] == 503
    bench.drive.supply(400)
    bench.run()
    bench.drive.supply(230)
    assert bench.drive.state == "fault" and bench.drive.read(947) == 3
    acknowledge(bench)
    assert bench.drive.state == "fault"  # they are still low
    bench.drive.supply(380)
    acknowledge(bench)
    assert bench.drive.state == "ready" and warnings(bench)[0] == 0


def test_every_family_has_its_own_numbers():
    for family, number, fault in (
        (mm3, 930, 9),
        (mm440, 947, 3),
        (v20, 947, 3),
        (g120, 945, 30003),
    ):
        bench = Bench({family.LINK["off time"]: 0}, family=family)
        pkw = [0] * (3 if family is not mm440 else 4)
        bench.exchange(*pkw + [OFF1, 0])
        bench.exchange(*pkw + [0x0C7F if family is mm3 else RUN, HALF])
        bench.drive.supply(100)
        assert bench.drive.state == "fault", family.NAME
        assert bench.drive.read(number) == fault, family.NAME


def test_the_telegram_failure_time_is_armed_by_the_first_good_telegram():
    # SPEC C-3.1; P2014, F0072. What a broadcast does to it is left open: a switch.
    bench = Bench({2014: 500})
    bench.wait(10)
    assert bench.drive.state == "inhibited"
    bench.control(OFF1)
    bench.wait(0.4)
    assert bench.drive.state == "ready"
    bench.wait(0.2)
    assert bench.drive.state == "fault" and faults(bench, 2) == [72, 0]
    acknowledge(bench)
    bench.wait(1)
    assert faults(bench, 4) == [72, 0, 72, 0]  # and every time again


def test_a_broadcast_may_or_may_not_be_such_a_telegram():
    # Of a V20 too, which waits for process data: a broadcast carries some.
    for family in (mm420, v20):
        for retriggers in (True, False):
            switches = {"broadcast_retriggers": retriggers}
            bench = Bench({2013: 4, 2014: 1000}, family=family, switches=switches)
            bench.control(OFF1)
            for _ in range(4):
                bench.wait(0.6)
                bench.send(telegram(0x20, 0x0005, 0, 0, 0, OFF1, 0x1111))
            assert (bench.drive.state == "ready") == retriggers, family.NAME
            bench.wait(1.1)
            assert bench.drive.state == "fault", family.NAME
