# SPDX-License-Identifier: MIT
"""The simulated drive as a drive: commands, states, ramps and limits, faults.

Section numbers are those of the USS specification ("SPEC"), P and r numbers those of the
MICROMASTER 420 parameter list.
"""

from drive_bench import ACKNOWLEDGE, HALF, JOG_LEFT, JOG_RIGHT, OFF1, RUN, Bench, telegram

# --- states: SPEC C-5.2.1 ---------------------------------------------------------------------


def test_from_power_up_to_running_and_back():
    bench = Bench()
    drive = bench.drive
    # Nothing received: OFF2 and OFF3 active, inhibited, a warning (live MM440, S1).
    assert (drive.state, drive.read(52)) == ("inhibited", 0xFBC1)
    # ON does not lift the inhibit, OFF1 does.
    assert bench.control(RUN, HALF) == (0xFA71, 0)
    assert bench.control(OFF1) == (0xFB31, 0) and drive.state == "ready"
    # Pulses disabled: ready to run.
    assert bench.control(RUN & ~8)[0] == 0xFB32 and drive.state == "ready to run"
    assert bench.control(OFF1)[0] == 0xFB31
    assert drive.starts == 0
    # Running, first below the setpoint by more than P2164.
    assert bench.control(RUN, HALF)[0] == 0xFA34 and drive.state == "running"
    bench.wait(5)
    assert bench.control(RUN, HALF) == (0xFB34, HALF)
    # OFF1: down the ramp with pulses, then ready.
    assert bench.control(OFF1, HALF)[0] == 0xFB34 and drive.state == "stopping"
    bench.wait(2)
    assert bench.control(OFF1, HALF)[0] == 0xFA34
    bench.wait(3)
    assert bench.control(OFF1, HALF) == (0xFA31, 0) and drive.state == "ready"
    assert drive.starts == 1


def test_off1_can_be_taken_back():
    bench = Bench()
    bench.run()
    bench.control(OFF1, HALF)
    bench.wait(2)
    bench.control(RUN, HALF)
    bench.wait(3)
    assert bench.control(RUN, HALF) == (0xFB34, HALF)
    assert bench.drive.starts == 1  # it never stood still


def test_off2_coasts_and_inhibits():
    bench = Bench()
    bench.run()
    zsw, hiw = bench.control(0x047D, HALF)  # OFF2 with ON = 1
    assert zsw & 0xFF == 0x61 and bench.drive.state == "inhibited"
    assert 0 < hiw <= HALF
    before = bench.drive.hz()
    bench.wait(0.5)
    assert 0 < bench.drive.hz() < before
    bench.wait(10)
    assert bench.drive.hz() == 0
    assert bench.control(RUN, HALF)[0] == 0xFA71  # still inhibited: OFF1 first
    assert bench.control(OFF1, HALF)[0] == 0xFA31
    assert bench.drive.starts == 1
    assert bench.control(RUN, HALF)[0] == 0xFA34
    assert bench.drive.starts == 2


def test_off3_stops_quickly_inhibits_and_cannot_be_taken_back():
    bench = Bench()  # P1135 = 5 s for 50 Hz
    bench.run()
    assert bench.control(0x047B, HALF)[0] & 0xFF == 0x14  # OFF3 with ON = 1
    bench.wait(1)
    assert bench.control(RUN, HALF)[0] & 0xFF == 0x14 and bench.drive.state == "stopping"
    bench.wait(1.6)
    assert bench.drive.hz() == 0 and bench.drive.state == "inhibited"
    assert bench.control(RUN, HALF)[0] == 0xFA71
    assert bench.control(OFF1)[0] == 0xFB31
    # Nor by a new ON while it stops.
    bench.run()
    bench.control(0x047A, HALF)
    assert bench.control(RUN, HALF)[0] & 0xFF == 0x14 and bench.drive.state == "stopping"
    bench.wait(5)
    bench.control(OFF1)
    # With the pulses disabled as well it coasts.
    bench.run()
    assert bench.control(0x0473, HALF)[0] & 0xFF == 0x51 and bench.drive.state == "inhibited"
    bench.wait(5)
    bench.control(OFF1)
    # From standstill it inhibits at once.
    assert bench.control(0x047A)[0] == 0xFB51
    assert bench.drive.starts == 3


def test_pulses_disabled_while_running_coasts_and_stays_ready_to_run():
    bench = Bench()
    bench.run()
    assert bench.control(RUN & ~8, HALF)[0] & 0xFF == 0x32
    bench.wait(1)
    assert bench.drive.state == "ready to run" and 10 < bench.drive.hz() < 25
    assert bench.control(RUN, HALF)[0] & 0xFF == 0x34
    assert bench.drive.starts == 2
    bench.wait(10)
    assert bench.drive.hz() == 25
    bench.control(OFF1, HALF)
    assert bench.control(OFF1 & ~8, HALF)[0] & 0xFF == 0x31  # while it stops: ready
    assert bench.drive.state == "ready" and bench.drive.hz() > 0


def test_the_ramp_generator_obeys_its_three_bits():
    bench = Bench()
    bench.run()
    bench.control(RUN & ~0x40, HALF)  # setpoint 0: down the ramp
    bench.wait(1)
    held = bench.control(RUN & ~0x20, HALF)[1]  # frozen
    bench.wait(5)
    assert bench.control(RUN & ~0x20, HALF)[1] == held
    assert 18 < bench.drive.hz() < 21
    bench.control(RUN, HALF)
    bench.wait(5)
    assert bench.drive.hz() == 25
    assert bench.control(RUN & ~0x10, HALF)[1] == 0  # output forced to 0
    assert bench.drive.state == "running" and bench.drive.starts == 1


def test_without_bit_6_the_ramp_generator_is_given_0():
    # r0020 and r1119 are what it is given, and ZSW bit 8 compares with that.
    bench = Bench()
    bench.run()
    held = RUN & ~0x40

    def given(stw):
        return [bench.task(0x1000 | number, 0, 0, 0, stw, HALF)[2] for number in (20, 1119)]

    assert given(RUN) == [0x41C8, 0x41C8]  # 25.0
    assert bench.control(held, HALF)[0] == 0xFA34  # the motor is yet to come down
    assert given(held) == [0, 0]
    bench.wait(6)
    assert bench.control(held, HALF) == (0xFB34, 0)
    assert bench.drive.read(1078) == 25  # the setpoint is there, and is not used
    assert bench.control(RUN, HALF)[0] == 0xFA34
    bench.wait(6)
    bench.control(OFF1, HALF)
    bench.wait(6)
    assert bench.control(OFF1, HALF)[0] == 0xFA31
    assert bench.control(OFF1 & ~0x40, HALF)[0] == 0xFB31
    # A jog is no other than a setpoint; nor does P1080 hold the ramp's input up.
    bench.drive.write(1080, 0, 10.0)
    bench.control(OFF1)
    bench.control(JOG_RIGHT)
    assert bench.drive.read(1119) == 10
    bench.control(JOG_RIGHT & ~0x40)
    assert bench.drive.read(1119) == 0


def test_invalid_process_data_change_nothing():
    # SPEC C-5.2.1: bit 10 = 0, the old process data stay in force.
    bench = Bench()
    bench.run()
    for stw in (0x0000, 0x007E, 0xFB31):
        assert bench.control(stw, 0) == (0xFB34, HALF)
    assert bench.drive.read(54) == RUN


def test_commissioning_blocks_on():
    # P0010 other than 0. The ON bit that stood there meanwhile starts nothing afterwards.
    bench = Bench({10: 1})
    bench.control(OFF1)
    assert bench.control(RUN, HALF)[0] == 0xFA31
    bench.control(JOG_RIGHT)
    bench.control(RUN, HALF)
    bench.drive.write(10, 0, 0)
    assert bench.control(RUN, HALF)[0] == 0xFA31
    assert bench.drive.starts == 0
    bench.control(OFF1)
    bench.control(RUN, HALF)
    assert bench.drive.starts == 1


def test_another_command_source_ignores_the_control_word():
    # P0700 = 2, terminals: ZSW and HIW are still sent.
    bench = Bench({700: 2})
    assert bench.control(OFF1)[0] == 0xFB31
    assert bench.control(RUN, HALF) == (0xFA31, 0)
    assert bench.drive.starts == 0
    bench.drive.write(700, 0, 5)  # and the ON that stands there does not count as an edge
    assert bench.control(RUN, HALF) == (0xFA31, 0)
    assert bench.drive.starts == 0


def test_losing_the_command_source_stops_the_motor():
    bench = Bench()
    bench.run()
    bench.drive.write(700, 0, 2)
    assert bench.control(RUN, HALF)[0] & 0xFF == 0x34 and bench.drive.state == "stopping"
    bench.wait(6)
    assert bench.drive.state == "ready"


def test_another_setpoint_source_ignores_the_main_setpoint():
    for source, hz in ((2, 0), (1, 5), (5, 25), (25, 25), (15, 30), (51, 30)):
        bench = Bench({1000: source})
        bench.run()
        assert bench.drive.hz() == hz, source


# --- jogging: P1058 ... P1061 -----------------------------------------------------------------


def test_jog_runs_while_it_is_held():
    bench = Bench()  # P1058 = P1059 = 5 Hz, P1060 = P1061 = 10 s
    bench.control(OFF1)
    bench.control(JOG_RIGHT)
    bench.wait(1.5)
    assert bench.drive.hz() == 5 and bench.drive.state == "running"
    bench.control(JOG_LEFT)  # the direction changes without a stop
    bench.wait(2.5)
    assert bench.drive.hz() == -5
    bench.control(OFF1)
    assert bench.drive.state == "stopping"
    bench.wait(1)
    assert bench.drive.hz() == 0 and bench.drive.state == "ready"
    assert bench.drive.starts == 1


def test_jog_has_its_own_frequencies_and_ramps():
    bench = Bench({1058: 10.0, 1059: 20.0, 1060: 5.0, 1061: 2.5})
    bench.control(OFF1)
    bench.control(JOG_LEFT)
    bench.wait(1)
    assert -11 < bench.drive.hz() < -9.9
    bench.wait(1)
    assert bench.drive.hz() == -20
    bench.control(OFF1)
    bench.wait(0.9)
    assert bench.drive.hz() < 0
    bench.wait(0.1)
    assert bench.drive.state == "ready"


def test_jog_pressed_again_goes_on_and_on_takes_over():
    bench = Bench()
    bench.control(OFF1)
    bench.control(JOG_RIGHT)
    bench.wait(1.5)
    bench.control(OFF1)
    bench.wait(0.5)
    bench.control(JOG_RIGHT)  # while its own ramp goes down
    bench.wait(1.5)
    assert bench.drive.hz() == 5 and bench.drive.state == "running"
    bench.control(RUN, HALF)
    bench.wait(10)
    assert bench.drive.hz() == 25
    assert bench.drive.starts == 1
    bench.control(OFF1, HALF)
    bench.control(JOG_RIGHT, HALF)  # on the ramp of OFF1 it means nothing
    assert bench.drive.state == "stopping"
    bench.wait(10)
    assert bench.drive.state == "ready"


def test_jog_with_the_pulses_disabled():
    bench = Bench()
    bench.control(OFF1)
    bench.control(JOG_RIGHT & ~8)
    assert bench.drive.starts == 0
    bench.control(OFF1)
    bench.control(JOG_RIGHT)
    bench.wait(1)
    assert bench.control(JOG_RIGHT & ~8)[0] & 0xFF == 0x31
    assert bench.drive.state == "ready"


def test_both_jogs_at_once_warn_and_hold():
    # A0923: warning bit 7, the speed stays as it is.
    bench = Bench()
    bench.control(OFF1)
    assert bench.control(JOG_RIGHT | JOG_LEFT)[0] == 0xFBB1
    assert bench.drive.starts == 0
    bench.control(OFF1)
    bench.control(JOG_RIGHT)
    bench.wait(0.5)
    assert bench.control(JOG_RIGHT | JOG_LEFT)[0] & 0xFF == 0xB4
    held = bench.drive.hz()
    bench.wait(3)
    assert bench.drive.hz() == held and 2 < held < 4


def test_jog_does_not_disturb_a_running_motor_and_needs_an_edge():
    bench = Bench()
    bench.run()
    bench.control(RUN | 0x0100, HALF)
    assert bench.drive.hz() == 25
    bench = Bench()
    bench.control(JOG_RIGHT)  # the first telegram of all only lifts the inhibit
    bench.control(JOG_RIGHT)
    assert bench.drive.starts == 0


# --- setpoint and ramps: P1080, P1082, P1120, P1121, P2000 ------------------------------------


def test_ramp_times_are_for_the_maximum_frequency():
    bench = Bench({1120: 10.0, 1121: 4.0})
    bench.control(OFF1)
    bench.send(telegram(1, 0, 0, 0, 0, RUN, 0x4000))
    for tenths in range(1, 100):
        bench.wait(0.1)
        assert abs(bench.drive.hz() - tenths / 2) < 1e-9
    bench.wait(0.1)
    assert bench.drive.hz() == 50 and bench.drive.read(52) == 0xFF34  # bit 10: at P1082
    bench.send(telegram(1, 0, 0, 0, 0, OFF1, 0))
    bench.wait(2)
    assert abs(bench.drive.hz() - 25) < 1e-9
    bench.clock.advance(1_999_999)
    assert bench.drive.state == "stopping"
    bench.clock.advance(1)
    assert bench.drive.state == "ready" and bench.drive.hz() == 0


def test_a_ramp_time_of_0_jumps():
    bench = Bench({1120: 0.0, 1121: 0.0})
    bench.control(OFF1)
    bench.control(RUN, HALF)
    assert bench.drive.hz() == 25
    bench.control(OFF1)
    assert bench.drive.hz() == 0 and bench.drive.state == "ready"


def test_the_motor_does_not_depend_on_how_often_it_is_asked():
    calm, busy = Bench(), Bench()
    for bench in (calm, busy):
        bench.control(OFF1)
        bench.control(RUN, HALF)
    end_us = calm.clock.now_us + 3_333_333
    while busy.clock.now_us < end_us - 50_000:
        busy.control(RUN, HALF)
    for bench in (calm, busy):
        bench.clock.advance_to(end_us)
    assert calm.drive.hz() == busy.drive.hz()


def test_a_reversal_goes_through_zero_without_a_stop():
    bench = Bench({1120: 10.0, 1121: 5.0})
    bench.run()
    bench.send(telegram(1, 0, 0, 0, 0, RUN | 0x0800, HALF))
    bench.wait(2.5)  # 25 Hz down on P1121
    assert bench.drive.hz() == 0 and bench.drive.state == "running"
    assert bench.drive.read(52) == 0xFA34
    bench.wait(2.5)  # up on P1120
    assert abs(bench.drive.hz() + 12.5) < 1e-9
    assert bench.drive.read(52) == 0xBA34  # bit 14 = 0: left
    bench.wait(2.5)
    assert bench.control(RUN | 0x0800, HALF) == (0xBB34, 0xE000)
    assert bench.control(RUN | 0x0800, 0xE000)[0] == 0xBA34  # both signs cancel each other
    bench.wait(10)
    assert bench.control(RUN | 0x0800, 0xE000) == (0xFB34, HALF)
    assert bench.drive.starts == 1


def test_limits_of_the_setpoint():
    # P1080 and P1082 bound the size in both directions; 0 runs at P1080.
    bench = Bench({1080: 5.0, 1082: 40.0})
    bench.control(OFF1)
    for stw, hsw, hz in (
        (RUN, 0x7FFF, 40), (RUN, 0x4000, 40), (RUN, 0x2000, 25), (RUN, 0x0001, 5), (RUN, 0, 5),
        (RUN | 0x0800, 0, -5), (RUN, 0xFFFF, -5), (RUN, 0xE000, -25), (RUN, 0x8000, -40),
    ):  # fmt: skip
        bench.control(stw, hsw)
        bench.wait(30)
        assert bench.drive.hz() == hz, hex(hsw)
        assert bench.drive.read(20) == hz
        assert bench.control(stw, hsw)[0] & 0x0500 == (0x0500 if abs(hz) == 40 else 0x0100)
    bench.control(OFF1)
    bench.wait(10)
    assert bench.drive.hz() == 0  # OFF1 goes through the minimum


def test_scaling_of_setpoint_and_actual_value():
    # 4000h = 100 % of P2000, two's complement (S2, OI440); every setpoint comes back as sent.
    bench = Bench({1120: 0.0, 1121: 0.0, 1082: 650.0, 2000: 60.0, 2164: 0.0})
    bench.control(OFF1)
    for hsw, hz in (
        (0x4000, 60), (0x2000, 30), (0x0001, 60 / 16384), (0xC000, -60), (0x8000, -120),
        (0x7FFF, 119.99634), (0x0666, 5.9985),
    ):  # fmt: skip
        zsw, hiw = bench.control(RUN, hsw)
        assert hiw == hsw and abs(bench.drive.hz() - hz) < 0.0001
        assert zsw == (0xBB34 if hz < 0 else 0xFB34)


def test_scaling_in_hundredths_of_a_hertz():
    # P2009 = 1 (S4): 03E8h = 10.00 Hz, FC18h = -10.00 Hz.
    bench = Bench({1120: 0.0, 1121: 0.0, 2009: 1})
    bench.control(OFF1)
    for hsw, hz in ((0x03E8, 10), (0xFC18, -10), (0x0001, 0.01), (5000, 50)):
        assert bench.control(RUN, hsw)[1] == hsw
        assert bench.drive.hz() == hz


def test_the_actual_value_does_not_overflow():
    bench = Bench({1120: 0.0, 1121: 0.0, 1082: 650.0, 2000: 50.0})
    bench.control(OFF1)
    bench.control(RUN, 0x7FFF)
    bench.drive.write(2000, 0, 1.0)
    bench.drive.write(1040, 0, 650.0)
    bench.drive.write(1000, 0, 1)
    assert bench.control(RUN, 0)[1] == 0x7FFF
    bench.drive.write(1040, 0, -650.0)
    assert bench.control(RUN, 0)[1] == 0x8000


def test_more_process_data_words():
    # P2012 = 4 with P2019 as delivered: ZSW, HIW, nothing, ZSW2 (S1: 06E0 at standstill).
    bench = Bench({2012: 4})
    reply = bench.ask(telegram(1, 0, 0, 0, 0, OFF1, 0, 0x1234, 0x5678))
    assert reply == telegram(1, 0, 0, 0, 0, 0xFB31, 0, 0, 0x06E0)
    assert [bench.drive.read(2018, i) for i in range(4)] == [OFF1, 0, 0x1234, 0x5678]
    bench.drive.write(2019, 2, 20 << 16)  # r0020, the setpoint, in the third word
    bench.ask(telegram(1, 0, 0, 0, 0, RUN, 0x4000, 0, 0))
    bench.wait(11)
    reply = bench.ask(telegram(1, 0, 0, 0, 0, RUN, 0x4000, 0, 0))
    # |f| above P2167, P1080 and P2155; at the setpoint; ramping finished
    assert reply == telegram(1, 0, 0, 0, 0, 0xFF34, 0x4000, 0x4000, 0x06D6)


def test_no_process_data_words():
    bench = Bench({2012: 0})
    assert bench.ask(telegram(1, 0x12BC, 0, 0, 0)) == telegram(1, 0x12BC, 0, 0, 5)
    assert bench.drive.state == "inhibited"


# --- faults: r0947 ----------------------------------------------------------------------------


def test_a_fault_is_acknowledged_by_an_edge_and_needs_a_new_start():
    bench = Bench()
    bench.run()
    bench.drive.fault(1)
    assert bench.control(RUN, HALF)[0] & 0xFF == 0x78 and bench.drive.state == "fault"
    assert bench.task(0x13B3)[3] == 1  # r0947[0]
    bench.wait(10)
    assert bench.drive.hz() == 0
    assert bench.control(RUN | 0x80, HALF)[0] & 0xFF == 0x71  # acknowledged: inhibited
    assert bench.control(RUN, HALF)[0] & 0xFF == 0x71  # ON still stands
    assert bench.control(OFF1, HALF)[0] & 0xFF == 0x31
    assert bench.drive.starts == 1
    assert bench.control(RUN, HALF)[0] & 0xFF == 0x34
    # A bit 7 that stands is not an edge.
    bench.control(RUN | 0x80, HALF)
    bench.drive.fault(2)
    assert bench.control(OFF1 | 0x80, HALF)[0] & 0xFF == 0x78
    assert bench.control(OFF1, HALF)[0] & 0xFF == 0x78
    assert bench.control(ACKNOWLEDGE, HALF)[0] & 0xFF == 0x71
    assert bench.control(OFF1, HALF)[0] & 0xFF == 0x31


def test_fault_history():
    # Two places for each trip; the second for a fault before the first was acknowledged.
    bench = Bench()
    bench.control(OFF1)
    for numbers in ((1,), (3, 85, 3, 11), (2,)):
        for number in numbers:
            bench.drive.fault(number)
        bench.control(ACKNOWLEDGE)
        bench.control(OFF1)
    assert [bench.drive.read(947, i) for i in range(8)] == [0, 0, 2, 0, 3, 85, 1, 0]
    bench.drive.fault(72)
    assert bench.task(0x63B3, 0)[3] == 72
    bench.drive.power_off()
    bench.drive.power_on()  # acknowledges as well
    assert [bench.drive.read(947, i) for i in range(4)] == [0, 0, 72, 0]
    assert bench.drive.state == "inhibited"
