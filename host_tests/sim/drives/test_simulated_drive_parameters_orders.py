# SPDX-License-Identifier: MIT
"""What a simulated drive does because a parameter was written: it saves, resets, calculates.

Some of it takes its time, in which the drive says nothing and hears nothing. OI440 is the
MICROMASTER 440 Operating Instructions, V20 those of the SINAMICS V20; V44 to V46 are derived
vectors. How long it takes, what is calculated and what P3900 resets is general knowledge.
"""

from boards.sim.drives.families import g120, mm3, mm420, mm440, v20
from drive_bench import HALF, OFF1, RUN, Bench, float_words, from_hex, telegram

P0010_IS_30 = from_hex("02 0E 01 20 0A 00 00 00 00 00 1E 04 7E 00 00 43")  # V45
P0970_IS_1 = from_hex("02 0E 01 23 CA 00 00 00 00 00 01 04 7E 00 00 9F")  # V46
P0971_IS_1 = from_hex("02 0E 01 23 CB 00 00 00 00 00 01 04 7E 00 00 9E")  # V44
NOTHING = telegram(1, 0, 0, 0, 0, OFF1, 0)


def power_cycle(bench):
    bench.drive.power_off()
    bench.drive.power_on()


def silence(bench, ask=NOTHING, longest_s=100):
    """Ask again and again until there is a reply; the seconds that took, in steps of a tenth."""
    start_us = bench.clock.now_us
    while bench.clock.now_us < start_us + longest_s * 1_000_000:
        if bench.ask(ask):
            return (bench.clock.now_us - start_us) / 1e6
        bench.wait(0.02)
    raise AssertionError("silent for %d s" % longest_s)


# --- silence ----------------------------------------------------------------------------------


def test_a_factory_reset_takes_ten_seconds_of_silence():
    bench = Bench({1120: 3.0})
    bench.drive.write(1121, 0, 4.0)
    bench.ask(P0010_IS_30)
    reply = bench.ask(P0970_IS_1)
    assert reply[3:11] == from_hex("13 CA 00 00 00 00 00 01")  # taken: then it is busy
    assert bench.drive.silent
    heard = bench.drive.read(2024)
    assert bench.ask(NOTHING) is None and bench.drive.read(2024) == heard
    bench.wait(9)
    assert bench.drive.silent and bench.drive.read(1120) == 3.0
    bench.wait(1)
    # All of P0970, P0010, the ramp times and the layout are as they were delivered.
    assert [bench.drive.read(n) for n in (970, 10, 1120, 1121, 700)] == [0, 0, 10.0, 10.0, 2]
    assert bench.drive.layout == (127, 2)
    assert bench.drive.address == 1 and bench.ask(NOTHING)  # these outlive it
    power_cycle(bench)
    assert bench.drive.read(1120) == 10.0 and bench.drive.address == 1


def test_how_long_it_takes_is_a_switch():
    for seconds in (0, 0.5, 60):
        bench = Bench({10: 30}, switches={"silence_s": {970: seconds}})
        assert bench.ask(P0970_IS_1)
        assert abs(silence(bench, telegram(1, 0, 0, 0, OFF1, 0)) - seconds) < 0.3, seconds
        assert bench.drive.read(970) == 0 and not bench.drive.silent


def test_it_may_begin_before_the_reply():
    bench = Bench({10: 30}, switches={"silent_at_once": True})
    assert bench.ask(P0970_IS_1) is None
    bench.wait(11)
    assert bench.drive.read(10) == 0 and bench.ask(NOTHING)


def test_the_failure_time_waits_meanwhile():
    bench = Bench({2014: 500, 10: 1})
    assert bench.task(0x2154, 0, 0, 1)[3] == 1  # P0340
    bench.wait(5)
    assert bench.drive.state != "fault" and not bench.drive.silent
    bench.wait(0.4)
    assert bench.drive.state != "fault"  # from here on it runs again
    bench.wait(0.2)
    assert bench.drive.state == "fault" and bench.drive.read(947) == 72


def test_the_motor_goes_on_as_it_was_told_last():
    bench = Bench(switches={"silence_s": {971: 3}})
    bench.run()
    bench.ask(telegram(1, 0x23CB, 0, 0, 1, RUN, HALF))
    bench.wait(0.1)
    assert bench.drive.silent and bench.ask(NOTHING) is None
    bench.wait(1)
    assert bench.drive.hz() == 25  # it has not heard OFF1
    bench.wait(2)
    bench.ask(NOTHING)
    assert bench.drive.state == "stopping"


def test_a_power_cut_ends_it():
    bench = Bench({10: 30, 1120: 3.0})
    bench.ask(P0970_IS_1)
    bench.wait(3)
    power_cycle(bench)
    assert not bench.drive.silent and bench.ask(NOTHING)
    bench.wait(20)
    assert bench.drive.read(1120) == 3.0 and bench.drive.read(970) == 0


def test_the_keypad_starts_it_too():
    bench = Bench({1120: 3.0})
    bench.drive.write(970, 0, 1)
    bench.drive.write(971, 0, 1)  # and this waits its turn
    assert bench.drive.silent and bench.drive.read(1120) == 3.0
    bench.wait(10)
    assert bench.drive.read(1120) == 10.0
    assert bench.drive.read(971) == 0 and not bench.drive.silent


# --- what is reset ----------------------------------------------------------------------------


def test_a_reset_needs_its_commissioning_step():
    # P0010 = 30, else error 17; the motor stands, since P0010 is not 0.
    bench = Bench()
    assert bench.task(0x23CA, 0, 0, 1)[3] == 17
    bench.task(0x200A, 0, 0, 1)
    assert bench.task(0x23CA, 0, 0, 1)[3] == 17
    bench.task(0x200A, 0, 0, 30)
    assert bench.task(0x23CA, 0, 0, 1) == (0x13CA, 0, 0, 1)


def test_what_a_reset_leaves_alone_differs():
    # V20: P2010, P2021 and P2023; the address goes back to 1. P0970 = 21 is for user defaults too.
    bench = Bench({10: 30, 2021: 9, 1120: 3.0}, address=5, family=v20)
    words = [0x23CA, 0, 21, OFF1, 0]
    assert bench.exchange(*words)[:3] == [0x13CA, 0, 21]
    bench.wait(10)
    assert [bench.drive.read(n) for n in (2010, 2011, 2021, 1120, 2014)] == [7, 1, 9, 10.0, 2000]
    assert bench.drive.address == 1
    bench = Bench({10: 30}, address=5, switches={"keeps_link": False})
    bench.exchange(0x23CA, 0, 0, 1, OFF1, 0)
    bench.wait(10)
    assert [bench.drive.read(n) for n in (2010, 2011)] == [6, 0]  # 9600, and nobody is called 0
    assert bench.ask(telegram(0, 0, 0, 0, OFF1, 0)) is None


def test_other_families_reset_by_other_numbers():
    bench = Bench({2: 50}, family=mm3)
    assert bench.exchange(0x23B0, 0, 1, OFF1, 0)[:3] == [0x13B0, 0, 1]  # P944
    bench.wait(10)
    assert bench.drive.read(2) == 100 and bench.drive.address == 1
    bench = Bench({10: 30, 1120: 3.0}, family=g120)
    bench.exchange(0x23CA, 0, 1, OFF1, 0)
    bench.wait(10)
    assert bench.drive.read(1120) == 10.0 and bench.drive.read(15) == 12


# --- quick commissioning ----------------------------------------------------------------------


def test_motor_data_belong_to_quick_commissioning():
    # C alone: P0010 = 1, else error 17; 29, a download, opens everything.
    bench = Bench(family=mm440)
    assert bench.task(0x2130, 0, 0, 400)[3] == 17
    for step, answer in ((30, 17), (2, 17), (1, 400), (29, 400)):
        bench.task(0x200A, 0, 0, step)
        bench.task(0)
        assert bench.task(0x2130, 0, 0, 400)[3] == answer, step
        bench.control(RUN, HALF)
        assert bench.drive.starts == 0, step
        bench.control(OFF1)


def test_p3900_ends_it():
    for how, ramp, input_1, rounding in ((1, 3.0, 1, 0.0), (2, 3.0, 1, 5.0), (3, 3.0, 0, 5.0)):
        bench = Bench({10: 1, 305: 6.5, 1120: 3.0, 701: 0, 1130: 5.0})
        assert bench.task(0x276C, 0x8000, 0, how) == (0x176C, 0x8000, 0, how)
        bench.wait(10)
        read = bench.drive.read
        assert (read(1120), read(701), read(1130)) == (ramp, input_1, rounding), how
        assert read(3900) == read(10) == 0
        assert read(305) == 6.5 and read(2002) == 6.5 and 2.0 < read(350) < 2.1
        assert bench.ask(telegram(1, 0, 0, 0, 0, OFF1, 0))
        power_cycle(bench)
        assert read(2002) != 6.5  # all that was in RAM: P0971 would have kept it


def test_p3900_needs_p0010():
    assert Bench().task(0x276C, 0x8000, 0, 1)[3] == 17


def test_p0340_calculates_each_data_set():
    bench = Bench({10: 1, (304, 1): 400, (305, 1): 2.0, (310, 1): 60.0}, family=mm440)
    assert bench.task(0x7154, 1, 0, 1) == (0x4154, 1, 0, 1)
    bench.wait(5)
    assert bench.drive.read(340, 1) == 0
    assert [bench.drive.read(2000, i) for i in range(3)] == [50.0, 60.0, 50.0]
    assert bench.drive.read(350, 0) == 4.0 and 11.5 < bench.drive.read(350, 1) < 11.6


def test_pole_pairs_and_slip_follow_from_the_rating_plate():
    bench = Bench({311: 2800}, family=mm440)
    assert bench.drive.read(313) == 1
    assert abs(bench.drive.read(330) - 6.667) < 0.001
    bench.drive.write(311, 0, 1395)
    assert bench.drive.read(313) == 2 and abs(bench.drive.read(330) - 7.0) < 0.001


# --- RAM and EEPROM ---------------------------------------------------------------------------


def test_p0971_is_over_when_it_is_back_at_0():
    bench = Bench(switches={"silence_s": {971: 2}})
    bench.task(0x3460, 0, *float_words(3.0))
    writes = bench.drive.eeprom_writes
    assert bench.ask(P0971_IS_1)
    bench.wait(1)
    assert bench.drive.eeprom_writes == writes and bench.drive.read(971) == 1
    bench.wait(1)
    assert bench.drive.eeprom_writes == writes + 1
    assert bench.task(0x13CB) == (0x13CB, 0, 0, 0)
    power_cycle(bench)
    assert bench.drive.read(1120) == 3.0


def test_saving_cut_short_saves_nothing():
    bench = Bench(switches={"silence_s": {971: 2}})
    bench.task(0x3460, 0, *float_words(3.0))
    bench.ask(P0971_IS_1)
    bench.wait(1)
    power_cycle(bench)
    assert bench.drive.read(1120) == 10.0 and bench.drive.read(971) == 0


def test_an_order_is_never_kept():
    # Tasks 11...14 put values into the EEPROM; P0971 = 1 in there would save at each power-up.
    bench = Bench(switches={"silence_s": {971: 2}})
    assert bench.task(0xE3CB, 0, 0, 1)[3] == 1
    power_cycle(bench)
    assert bench.drive.read(971) == 0 and not bench.drive.silent


# --- what only goes to 0 ----------------------------------------------------------------------


def test_counts_that_are_cleared():
    # P0952, P2111: error 6 for anything but 0 (PROFIBUS profile: may only be reset).
    bench = Bench({3: 4}, family=mm440)
    assert bench.task(0x23B8, 0, 0, 1)[3] == 6
    assert bench.task(0x23B8, 0, 0, 9)[3] == 2
    assert bench.task(0x206F, 0x8000, 0, 1)[3] == 6
    assert bench.task(0x23B8, 0, 0, 0) == (0x13B8, 0, 0, 0)
    assert bench.task(0x43B8, 0x0001)[3] == 0x2006  # element 1 says so: bit 13


def test_p3981_acknowledges_on_each_micromaster_4():
    for family in (mm420, mm440, v20):
        bench = Bench({3: 4, 2014: 0}, family=family)
        pkw = [0] * (3 if bench.drive.layout[0] == 127 else 4)
        bench.exchange(*pkw + [OFF1, 0])
        bench.drive.fault(1)
        value = [1] if len(pkw) == 3 else [0, 1]
        bench.exchange(*[0x27BD, 0x8000] + value + [OFF1, 0])
        assert bench.exchange(*pkw + [OFF1, 0])[-2] & 0xFF == 0x31, family.NAME


# --- which protocol ---------------------------------------------------------------------------


def test_a_v20_that_was_set_to_modbus_is_deaf_from_power_up_on():
    bench = Bench(family=v20)
    assert bench.exchange(0x2017, 0x8000, 2, OFF1, 0)[:3] == [0x1017, 0x8000, 2]
    nothing = telegram(1, 0, 0, 0, OFF1, 0)
    assert bench.ask(nothing)
    power_cycle(bench)
    assert bench.ask(nothing)  # it was in RAM alone
    bench.drive.write(2023, 0, 2)
    power_cycle(bench)
    assert bench.ask(nothing) is None
    bench.drive.write(2023, 0, 1)
    assert bench.ask(nothing) is None
    power_cycle(bench)
    assert bench.ask(nothing)
