# SPDX-License-Identifier: MIT
"""The bus for a program of one's own: what a maker writes, and what becomes of the motor."""

from boards.sim.drives.bop_link import on_bop as on_bop_link
from boards.sim.drives.families import g110, g120, generic, mm3, mm420, mm440, v20
from boards.sim.drives.families.texts import DATA_TYPES
from bus_bench import QUICK, Bench, refusal
from hal.pacer import Pacer
from spoilt_bench import TROUBLES, spoil
from tools.examples.simulation import Stage
from uss import bits, pkw, pzd
from uss.bus import MAY_RUN, NO_CONTACT, Master
from uss.drive import COUNTERS
from uss.errors import FallsSilent, NoContact, NotStarted, Refused, TimedOut, UssError
from uss.families import G110, G120, GENERIC, MM3, MM420, MM440, V20, on_bop
from uss.families.rows import WORD
from uss.finding.scan import Scan
from uss.layout import VARIABLE, Layout
from uss.master import CLOSED, OFF
from uss.outside import Mirror
from uss.scaling import Scale
from uss.tasks import descriptions


def near(value, wanted, within=0.02):
    assert abs(value - wanted) <= within, (value, wanted)


def took_s(bench, action, *arguments):
    """How many seconds an action takes on the line."""
    since_us = bench.clock.now_us
    action(*arguments)
    return (bench.clock.now_us - since_us) / 1_000_000


# --- to run -------------------------------------------------------------------------------------


def test_a_drive_runs_at_a_frequency_and_tells_its_speed():
    bench = Bench()
    drive = bench.drive
    bench.bus.wait(0.5)
    assert took_s(bench, drive.run, 25.0) < 0.5  # it says at once that it runs
    assert drive.engine.near == 326  # 2 % of 4000h, by which a standstill is noticed
    assert bench.bus.wait(3, lambda: drive.hertz > 24.9)
    near(drive.hertz, 25.0)
    near(drive.percent, 50.0)
    assert drive.is_running and drive.state == "running"
    near(bench.motor().hz(), 25.0)
    bench.end()


def test_percent_is_of_the_reference_frequency():
    bench = Bench()
    bench.drive.run(percent=40)
    bench.bus.wait(2)
    near(bench.drive.hertz, 20.0)
    bench.end()


def test_a_negative_speed_turns_left():
    bench = Bench()
    bench.drive.run(-10.0)
    bench.bus.wait(2)
    near(bench.drive.hertz, -10.0)
    near(bench.motor().hz(), -10.0)
    bench.end()


def test_a_new_speed_of_a_motor_that_runs_is_on_the_line_at_once():
    bench = Bench()
    bench.drive.run(10.0)
    bench.bus.wait(1)
    before_us = bench.clock.now_us
    bench.drive.run(20.0)
    assert bench.clock.now_us == before_us  # it asks for nothing
    bench.bus.wait(1)
    near(bench.drive.hertz, 20.0)
    assert bench.motor().starts == 1
    bench.end()


def test_with_p2009_the_words_are_in_hundredths_of_a_hertz():
    bench = Bench(parameters={2014: 2_000, 1120: 1.0, 1121: 1.0, 2009: 1})
    bench.drive.run(12.34)
    bench.bus.wait(2)
    near(bench.drive.hertz, 12.34, 0.005)
    near(bench.drive.percent, 24.68)
    assert bench.drive.engine.near == 100  # 2 % of 5000, by which a standstill is noticed
    near(bench.drive.rpm, 60 / 2 * 12.34, 0.5)
    near(bench.drive.hertz, 12.34, 0.005)  # as before it was asked for its motor
    bench.end()


def test_one_speed_is_wanted_and_no_more():
    bench = Bench()
    for speeds in ({}, {"hertz": 1.0, "percent": 2.0}, {"percent": 2.0, "rpm": 3.0}):
        assert "one speed" in refusal(ValueError, bench.drive.run, **speeds)
    assert not bench.motor().starts


def test_a_speed_beyond_the_limits_of_the_drive_is_refused():
    bench = Bench(parameters={2014: 2_000, 1080: 5.0, 1082: 40.0})
    text = refusal(ValueError, bench.drive.run, 41.0)
    assert text == "41.00 Hz is beyond the limit of drive 1: P1082[0] = 40.00 Hz"
    assert "P1080[0] = 5.00 Hz" in refusal(ValueError, bench.drive.run, 2.0)
    assert "P1082" in refusal(ValueError, bench.drive.run, percent=-90)
    bench.drive.run(40.0)
    for speed in (45.0, 1e9):
        refusal(ValueError, bench.drive.run, speed)
    for speed in (float("inf"), float("-inf"), float("nan")):
        assert refusal(ValueError, bench.drive.run, speed) == "a speed of %r" % speed
    refusal(ValueError, bench.drive.run, percent=201)
    assert refusal(TypeError, bench.drive.run, "fast") == "a speed is a number, not 'fast'"
    bench.bus.wait(1)
    assert bench.drive.is_on()  # a wrong speed changes nothing
    bench.end()


def test_the_limits_themselves_are_no_speeds_beyond_them():
    """Also where the nearest word of PZD2 is a little beyond."""
    bench = Bench(parameters={2014: 2_000, 1080: 3.3, 1082: 33.3})
    for hertz, count in ((3.3, 1081), (33.3, 10912)):
        bench.drive.run(hertz)
        assert bench.drive.engine.hsw == count
    bench.end()


def test_jog_turns_until_stop():
    bench = Bench(parameters={2014: 2_000, 1058: 4.0, 1059: 3.0, 1060: 1.0, 1061: 1.0})
    drive = bench.drive
    drive.jog_right()
    bench.bus.wait(1)
    near(drive.hertz, 4.0)
    drive.jog_right()  # this changes nothing
    near(drive.hertz, 4.0)
    drive.stop()
    bench.bus.wait(1)
    assert drive.state == "ready"
    drive.jog_left()
    bench.bus.wait(1)
    near(drive.hertz, -3.0)
    bench.end()


def test_a_motor_that_runs_does_not_jog():
    bench = Bench()
    bench.drive.run(10.0)
    bench.bus.wait(1)
    assert "is running" in refusal(NotStarted, bench.drive.jog_left)
    assert bench.drive.is_on()
    bench.end()


def test_a_jog_sends_no_setpoint_whatever_the_motor_ran_at_before():
    bench = Bench()
    drive = bench.drive
    drive.run(10.0)
    drive.stop()
    bench.bus.wait(1)
    for jog in (drive.jog_right, drive.jog_left):
        jog()
        bench.bus.wait(0.1)
        sent = [row[2] for row in bench.wire.log.last(4) if row[1]]
        assert [characters[-3:-1] for characters in sent] == [b"\0\0"] * 2, sent
        drive.stop()
        bench.bus.wait(1)
    bench.end()


def test_set_gives_a_motor_that_runs_another_speed_and_starts_none():
    bench = Bench()
    drive = bench.drive
    assert drive.set(10.0) is False
    drive.run(10.0)
    assert drive.set(percent=40) is True
    bench.bus.wait(1)
    near(drive.hertz, 20.0)
    refusal(ValueError, drive.set, 99.0)
    drive.stop()
    assert drive.set(10.0) is False
    bench.bus.wait(1)
    assert not drive.is_running and bench.motor().starts == 1
    drive.jog_right()
    assert drive.set(10.0) is False  # its speed is the drive's own
    drive.stop()
    bench.bus.wait(2)
    drive.run(10.0)
    drive.survey.forget()  # so that it has to ask
    bench.at(0.05, drive.stop)
    assert drive.set(20.0) is False and not drive.is_on()
    bench.end()


def test_what_checks_nothing_is_found_in_the_engine_alone():
    drive = Bench().drive
    for name in ("start", "turn"):
        assert hasattr(drive.engine, name) and not hasattr(drive, name)
    assert refusal(ValueError, drive.stop, pzd.ON) and not drive.is_on()


# --- to stop ------------------------------------------------------------------------------------


def test_stop_is_in_the_next_telegram():
    bench = Bench((1, 2, 3))
    bench.bus.drives[1].run(10.0)
    bench.bus.wait(1)
    since_us = bench.clock.now_us
    bench.bus.drives[1].stop()
    bench.bus.wait(0.05)
    sent = [row for row in bench.wire.log.last(20) if row[0] >= since_us and row[1]]
    assert sent[0][2][2] == 2 and bench.stws(2, since_us)[0] == pzd.OFF1
    bench.end()


def test_a_program_sets_the_bits_of_the_control_word_that_the_bus_has_no_use_for():
    bench = Bench()
    drive = bench.drive
    bench.bus.wait(0.5)
    for bits_of_stw, on, word in (
        (0x2000, True, 0x247E),
        (0x0028, False, 0x2456),
        (0x0008, True, 0x245E),
        (0x2000, False, 0x045E),
    ):
        drive.control(bits_of_stw, on)
        bench.bus.wait(0.1)
        assert bench.stws(1)[-1] == word
    text = refusal(ValueError, drive.control, 0x2801, True)
    assert text == "STW bits 0801h are no matter of control()"
    bench.end()


def test_off2_lets_the_motor_coast_and_off3_brakes():
    for stop, word in (("off2", pzd.OFF2), ("off3", pzd.OFF3)):
        bench = Bench()
        bench.drive.run(20.0)
        bench.bus.wait(1)
        getattr(bench.drive, stop)()
        bench.bus.wait(0.1)
        assert bench.stws(1)[-1] == word
        bench.end()


def test_after_off2_or_off3_a_drive_runs_again_once_it_stands():
    bench = Bench(parameters={2014: 2_000, 1120: 1.0, 1135: 2.0})
    bench.drive.run(20.0)
    bench.bus.wait(1)
    bench.drive.off3()
    bench.bus.wait(0.2)
    assert "still stopping" in refusal(NotStarted, bench.drive.run, 20.0)
    bench.bus.wait(3)
    assert bench.drive.state == "inhibited"
    bench.drive.run(20.0)
    bench.bus.wait(1)
    assert bench.drive.is_running
    bench.end()


def test_stop_all_sends_each_drive_its_own_off1():
    bench = Bench((1, 2, 3))
    for drive in bench.bus.drives:
        drive.run(10.0)
    bench.bus.wait(1)
    since_us = bench.clock.now_us
    bench.bus.stop_all()
    bench.bus.wait(0.1)
    for drive in bench.bus.drives:
        assert bench.stws(drive.address, since_us + 20_000)[0] == pzd.OFF1 and not drive.is_on()
    bench.end()


def test_a_broadcast_stops_all_at_once():
    bench = Bench((1, 2, 3))
    for drive in bench.bus.drives:
        drive.run(10.0)
    bench.bus.wait(1)
    bench.bus.broadcast_stop()
    bench.bus.wait(0.03)
    for address in (1, 2, 3):
        assert bench.motor(address).report().find("state=stopping") > 0
    assert bench.bus.wait(3, lambda: not any(drive.is_running for drive in bench.bus.drives))
    bench.end()


def test_where_a_family_takes_no_broadcast_each_is_stopped_by_itself():
    bench = Bench((1,))
    other = bench.bus.add(9, GENERIC)
    bench.drive.run(10.0)
    bench.bus.wait(1)
    assert "USS drive" in refusal(ValueError, bench.bus.broadcast_stop)
    assert bench.drive.engine.wanted == 0 and other.engine.stops == 1
    bench.end()


# --- no surprise start --------------------------------------------------------------------------


def test_a_drive_that_is_silent_is_not_started_then_or_later():
    bench = Bench()
    bench.motor().unplug()
    assert refusal(NoContact, bench.drive.run, 10.0) == "drive 1 does not answer"
    bench.motor().plug()
    bench.bus.wait(3)
    assert bench.drive.state == "ready" and not bench.motor().starts
    bench.end()


def test_a_drive_with_a_fault_says_which_and_wants_it_acknowledged():
    bench = Bench()
    bench.bus.wait(0.5)
    assert took_s(bench, getattr, bench.drive, "fault") == 0  # without one nothing is read
    bench.motor().fault(1)
    bench.bus.wait(0.2)
    assert bench.drive.fault == 1 and bench.drive.state == "fault"
    text = refusal(NotStarted, bench.drive.run, 10.0)
    assert text == "drive 1 has tripped with F0001: acknowledge() when its cause is gone"
    bench.drive.acknowledge()
    bench.drive.run(10.0)
    assert bench.drive.fault == 0
    bench.end()


def test_what_stopped_by_itself_or_was_lost_wants_a_stop_before_it_runs_again():
    """So that a program that sets a speed again and again never starts a motor by that."""
    bench = Bench()
    bench.drive.run(10.0)
    bench.bus.wait(1)
    bench.motor().unplug()
    bench.bus.wait(1.5)
    assert bench.drive.state == MAY_RUN and not bench.drive.is_running
    assert "does not answer" in refusal(NoContact, getattr, bench.drive, "hertz")
    bench.motor().plug()
    bench.bus.wait(1)
    for _ in range(3):
        assert "stop() says that you know" in refusal(NotStarted, bench.drive.run, 10.0)
    bench.drive.stop()
    bench.drive.run(10.0)
    bench.bus.wait(1)
    assert bench.drive.is_running
    drive = bench.drive
    bench.motor().fault(1)
    bench.bus.wait(2)
    assert "stop() says that you know" in refusal(NotStarted, drive.run, 10.0)
    bench.bus.remove(drive)
    assert refusal(NoContact, drive.run, 10.0) == "drive 1 is not on the bus"
    bench.end()


def test_a_drive_that_takes_its_commands_from_elsewhere_is_not_started():
    for number, value in ((700, 2), (1000, 2)):
        bench = Bench(parameters={2014: 2_000, number: value})
        text = refusal(NotStarted, bench.drive.run, 10.0)
        assert text == "drive 1 is not under USS control: P%04d[0] = %d, not 5" % (number, value)
        bench.end()


def test_a_drive_that_is_held_by_off2_from_elsewhere_is_not_started():
    bench = Bench()
    bench.bus.wait(0.5)
    bench.drive._may_start = lambda: False  # what a terminal does to the status word
    since_us = bench.clock.now_us
    text = refusal(NotStarted, bench.drive.run, 10.0)
    assert text == "drive 1 is inhibited, or stopped by OFF2 or OFF3 from elsewhere"
    assert 1_000_000 < bench.clock.now_us - since_us < 1_600_000  # a second, and the questions
    bench.end()


def test_a_jog_needs_no_setpoint_from_the_bus():
    bench = Bench(parameters={2014: 2_000, 1000: 2})
    bench.drive.jog_right()
    bench.bus.wait(1)
    assert bench.drive.is_running
    bench.end()


def test_a_drive_that_would_run_on_if_the_program_died_is_not_started():
    bench = Bench(parameters={2014: 0, 1120: 1.0})
    text = refusal(NotStarted, bench.drive.run, 10.0)
    assert "would run on if this program died: P2014[0] = 0" in text
    bench.drive.supervise(1.5)
    assert bench.motor().read(2014) == 1500
    bench.drive.run(10.0)
    bench.clock.advance(2_000_000)  # the program hangs, and the drive helps itself
    bench.bus.wait(1)
    assert bench.drive.fault in (70, 72)
    bench.end()


def test_a_program_that_says_nothing_of_it_wants_a_drive_that_would_not_run_on():
    bench = Bench(parameters={2014: 0, 1120: 1.0}, unsupervised=True)
    bench.bus.remove(bench.drive)
    bench.bus.add(1, MM420)
    assert "would run on if this program died" in refusal(NotStarted, bench.drive.run, 10.0)
    bench.end()


def test_a_drive_that_trips_soon_gets_more_turns_than_the_list_gives_it():
    """A round of twelve drives takes 560 ms at 9600 baud, and this one trips after 400."""
    twelve = tuple(range(1, 13))
    bench = Bench(twelve, baud=9600, kinds={1: {"parameters": {2014: 400, 1120: 1.0}}})
    bench.bus.wait(1)
    bench.drive.acknowledge()
    bench.drive.run(10.0)
    assert sent_within_us(bench) == 133_333
    bench.bus.wait(3)
    assert bench.drive.is_running and bench.drive.fault == 0
    bench.end()


def test_so_does_one_that_cannot_be_asked_when_its_owner_says_so():
    mute = {2014: 400, 1120: 1.0, 2013: 0}
    twelve = tuple(range(1, 13))
    bench = Bench(twelve, baud=9600, kinds={1: {"parameters": mute}})
    bench.bus.remove(bench.drive)
    drive = bench.bus.add(1, G110, Layout(0, 2))
    bench.bus.supervise(drive, 400)
    drive.run(percent=20)
    bench.bus.wait(2)
    assert drive.is_running
    bench.end()
    mute = {2014: 2_000, 1120: 1.0, 2013: 0}
    bench = Bench(twelve, baud=9600, kinds={1: {"parameters": mute}})
    bench.bus.remove(bench.drive)
    drive = bench.bus.add(1, G110, Layout(0, 2))
    bench.bus.supervise(drive, 2_000)
    drive.run(percent=20)
    bench.motor().write(2014, 0, 400)  # by its keypad
    bench.bus.supervise(drive, 400)  # it counts from now on, also of a drive that runs
    bench.bus.wait(2)
    assert drive.is_running
    bench.end()


def test_one_that_would_run_on_is_started_when_its_owner_says_that_it_may():
    bench = Bench(parameters={2014: 0}, unsupervised=True)
    bench.drive.run(10.0)
    bench.bus.wait(0.5)
    assert bench.drive.is_running
    bench.end()


def test_a_drive_that_does_not_start_is_told_to_stop_so_that_it_does_not_start_later():
    bench = Bench(parameters={2014: 2_000, 10: 1})
    bench.bus.wait(0.5)
    since_us = bench.clock.now_us
    assert "is it being commissioned" in refusal(NotStarted, bench.drive.run, 10.0)
    assert 5_000_000 < bench.clock.now_us - since_us < 5_600_000  # so long it may take
    bench.bus.wait(0.1)
    assert bench.stws(1)[-1] == pzd.OFF1
    bench.motor().write(10, 0, 0)
    bench.bus.wait(1)
    assert not bench.motor().starts
    bench.end()


def test_a_drive_that_is_lost_or_trips_as_it_starts_says_so():
    for happens in ("unplug", "fault"):
        bench = Bench()
        start, motor = bench.drive.engine.start, bench.motor()

        def start_and_fail(hsw, stw, start=start, motor=motor, happens=happens):
            start(hsw, stw)
            if happens == "fault":
                motor.fault(1)
            else:
                motor.unplug()

        bench.drive.engine.start = start_and_fail
        text = refusal(NotStarted, bench.drive.run, 10.0)
        assert text == "drive 1 did not start: it was lost, or tripped", text
        bench.bus.close()
        bench.check()


def test_stop_beats_a_start_that_still_waits():
    bench = Bench()
    bench.bus.wait(0.5)
    for seconds in (0.02, 0.1, 0.15):
        bench.at(seconds, bench.drive.stop)
        assert "told to stop meanwhile" in refusal(NotStarted, bench.drive.run, 10.0)
    bench.bus.wait(1)
    assert not bench.drive.is_running
    bench.motor().write(10, 0, 1)  # it takes its time to start
    bench.at(1.5, bench.drive.stop)
    since_us = bench.clock.now_us
    assert "told to stop meanwhile" in refusal(NotStarted, bench.drive.run, 10.0)
    assert bench.clock.now_us - since_us in range(1_500_000, 1_600_000)  # nobody waits for more
    bench.end()


def test_stop_beats_a_start_that_reads_the_rating_of_the_motor():
    bench = Bench()
    bench.bus.wait(0.5)
    for step in range(1, 24):
        bench.at(0.02 * step, bench.drive.stop)
        told = refusal(NotStarted, bench.drive.run, None, None, 300)
        assert "told to stop meanwhile" in told, (step, told)
        bench.bus.wait(0.5)
        assert not bench.drive.is_running and not bench.motor().starts, step
    bench.end()


def test_stop_beats_a_start_that_waits_for_an_answer():
    for stop in (pzd.OFF1, pzd.OFF2):
        bench = Bench(parameters={2014: 5_000})  # it does not trip meanwhile
        bench.bus.wait(0.5)
        bench.motor().unplug()
        bench.bus.wait(2)
        assert not bench.drive.contact
        bench.at(0.01, lambda: bench.drive.stop(stop))
        bench.at(0.02, bench.motor().plug)
        refusal(NotStarted, bench.drive.run, 10.0)
        bench.bus.wait(1)
        assert not bench.drive.is_running and not bench.motor().starts
        bench.end()


def test_a_drive_that_leaves_the_bus_while_its_start_is_prepared_is_not_told_to_run():
    for step in range(30, 46):  # the last of what it reads comes at 0.45 s
        bench = Bench()
        bench.bus.wait(0.5)
        drive = bench.drive
        bench.at(0.01 * step, lambda: bench.bus.remove(drive))
        assert "not on the bus" in refusal(NoContact, drive.run, None, None, 300)
        assert not drive.engine.wanted, step
        bench.bus.close()


def test_a_start_wants_room_in_the_telegrams():
    bench = Bench(parameters={2014: 2_000, 2012: 1}, layout=Layout(4, 1))
    assert "Layout(4, 1)" in refusal(NotStarted, bench.drive.run, 10.0)
    bench.drive.jog_right()
    bench.bus.wait(0.5)
    assert bench.drive.is_running
    assert "PZD2" in refusal(ValueError, getattr, bench.drive, "percent")
    bench.end()
    bench = Bench(parameters={2014: 2_000, 2012: 0}, layout=Layout(4, 0))
    assert "Layout(4, 0)" in refusal(NotStarted, bench.drive.jog_right)
    bench.end()


def test_without_a_step_for_300_ms_every_motor_is_stopped():
    bench = Bench((1, 2), paced=True)
    for drive in bench.bus.drives:
        drive.run(10.0)
    bench.bus.wait(1)
    bench.clock.advance(500_000)  # the program is busy elsewhere; interrupts go on
    for drive in bench.bus.drives:
        assert drive.engine.stopped_by_engine() and bench.stws(drive.address)[-1] == pzd.OFF1
    bench.bus.wait(2)
    assert not any(drive.is_running for drive in bench.bus.drives)
    bench.end()


def test_a_loop_that_does_not_call_for_300_ms_stops_its_motors_without_interrupts_too():
    bench = Bench((1, 2))
    for drive in bench.bus.drives:
        drive.run(10.0)
    bench.bus.wait(1)
    bench.clock.advance(310_000)
    bench.bus.step()
    for drive in bench.bus.drives:
        assert drive.engine.stopped_by_engine() and not drive.is_on()
    bench.bus.wait(2)
    assert not any(drive.is_running for drive in bench.bus.drives)
    assert "step() was not called" in refusal(NotStarted, bench.drive.run, 10.0)
    bench.drive.stop()
    bench.drive.run(10.0)
    bench.end()


def test_whatever_idle_raises_stops_every_motor():
    for paced in (False, True):
        bench = Bench((1, 2), paced=paced)
        idle_calls = []

        def fail(idle_calls=idle_calls):
            idle_calls.append(1)
            raise OSError("the disk is full")

        try:
            with bench.bus:
                for drive in bench.bus.drives:
                    drive.run(10.0)
                bench.bus._idle = fail
                bench.bus.wait(1)
        except OSError:
            pass
        assert len(idle_calls) == 1 and bench.bus.engine.phase == CLOSED
        for address in (1, 2):
            assert bench.stws(address)[-1] == pzd.OFF1
        bench.check()


def test_the_telegram_off_time_is_told_in_seconds_and_within_reason():
    bench = Bench()
    for seconds in (0.2, -1, 66, 2000, float("nan")):
        assert "takes seconds, 0.3...65" in refusal(ValueError, bench.drive.supervise, seconds)
    assert bench.motor().read(2014) == 2_000
    bench.drive.supervise(0)
    assert bench.motor().read(2014) == 0
    for seconds, within_us in ((0.3, 100_000), (0.6, 200_000), (65.0, 21_666_666)):
        bench.drive.supervise(seconds)
        assert bench.motor().read(2014) == seconds * 1000
        assert sent_within_us(bench) == within_us  # at once, also if the motor runs
    bench.bus.cycle_us = 500_000
    assert "1.5...65" in refusal(ValueError, bench.drive.supervise, 1.0)
    for off_time_ms in (-1, 2.0, 65_001, 70_000):
        assert "in ms" in refusal(ValueError, bench.bus.supervise, bench.drive, off_time_ms)
    bench.bus.supervise(bench.drive, 65_000)
    bench.bus.supervise(bench.drive, 0)
    bench.end()


def test_the_telegram_off_time_is_that_of_the_link_that_the_bus_is_on():
    bench = of_family(on_bop(MM420), on_bop_link(mm420), {})
    before = bench.motor().read(2014, 0)
    bench.drive.supervise(1.5)
    assert bench.motor().read(2014, 1) == 1500 and bench.motor().read(2014, 0) == before
    bench.end()


def sent_within_us(bench):
    """In so long a drive of the bus gets its next telegram while its motor may run."""
    return bench.bus.engine.deadlines.bound_us(bench.drive.engine)


def test_a_family_that_counts_in_seconds_is_not_told_never_by_rounding():
    bench = of_family(MM3, mm3, {93: 2, 2: 10, 3: 10})
    bench.drive.supervise(0.4)
    assert bench.drive.read(93) == 1
    bench.drive.supervise(6)
    assert bench.drive.read(93) == 6 and sent_within_us(bench) == 2_000_000
    bench.end()


def test_another_master_on_the_line_is_left_alone():
    bench = Bench()

    def talk():
        bench.wire.talk(bench.motor(), b"\x02\x06\x07\x00\x00\x00\x00\x03", 8)
        bench.at(0.05, talk)

    talk()
    since_us = bench.clock.now_us
    assert refusal(NoContact, bench.drive.run, 10.0) == "another master is on the line"
    waited_us = bench.clock.now_us - since_us
    turns_us = 3 * bench.bus.engine.turns.longest_cycle_us()
    assert 0 <= waited_us - 1_000_000 - turns_us < 2_000  # a second to listen, and three tries
    assert refusal(NoContact, bench.bus.mirror, 1) == "another master is on the line"
    assert bench.stws(1) == [] and bench.bus.is_line_in_use() and bench.bus.foreign > 5
    bench = Bench()
    bench.bus.wait(0.5)
    assert bench.drive.contact and not bench.bus.is_line_in_use() and bench.bus.foreign == 0


def test_a_line_that_echoes_what_is_sent_is_known_by_that():
    for echo in (True, False):
        bench = Bench()
        bench.wire.echo = echo
        bench.bus.wait(0.5)
        assert bench.drive.contact and bench.bus.has_echo() is echo
        bench.bus.close()


def test_bus_off_gives_the_line_away_and_on_takes_it_back():
    bench = Bench()
    bench.drive.run(10.0)
    bench.bus.wait(0.5)
    bench.bus.off()
    assert bench.bus.wait(1, bench.bus.is_silent) and bench.bus.engine.phase == OFF
    assert bench.stws(1)[-1] == pzd.OFF1
    assert bench.motor().state == "stopping" and not bench.drive.is_running  # nobody says so
    assert refusal(NoContact, bench.drive.read, 700) == "the bus is off"
    bench.bus.on()
    assert bench.drive.read(700) == 5
    bench.end()


def test_nobody_waits_for_a_bus_that_is_off_or_closed_or_a_drive_that_was_removed():
    for leave, reason in (
        (lambda bench: bench.bus.off(), "the bus is off"),
        (lambda bench: bench.bus.close(), "the bus is closed"),
        (lambda bench: bench.bus.remove(bench.drive), "drive 1 is not on the bus"),
    ):
        bench = Bench((1, 2))
        drive = bench.drive
        bench.bus.wait(0.5)
        leave(bench)
        if reason == "the bus is off":
            assert bench.bus.wait(1, bench.bus.is_silent)
        assert drive.state == NO_CONTACT and not drive.contact and not drive.is_running
        assert drive.zsw is None and drive.hiw is None
        for action in (
            lambda drive=drive: drive.read(700),
            lambda drive=drive: drive.run(10.0),
            drive.jog_right,
            lambda drive=drive: drive.do(pkw.read(700)),
            lambda drive=drive: drive.hertz,
            lambda drive=drive: drive.fault,
        ):
            since_us = bench.clock.now_us
            assert refusal(NoContact, action) == reason
            assert bench.clock.now_us == since_us
        if reason.startswith("the bus"):
            assert refusal(NoContact, bench.bus.mirror, 1) == reason
            assert refusal(NoContact, bench.bus.post, Mirror(1)) == reason
            scan = Scan(bench.bus, bench.clock.ticks_mask)
            assert refusal(NoContact, scan.step, bench.clock.ticks_us()) == reason
    bench.end()


def test_who_waits_while_somebody_puts_the_bus_off_or_takes_the_drive_away_hears_of_it():
    for paced in (False, True):
        bench = Bench((1, 2), paced=paced)
        bench.bus.wait(0.5)
        bench.motor().stale_replies = 10_000
        bench.at(0.2, bench.bus.off)
        assert refusal(NoContact, bench.drive.read, 700) == "the bus is off"
        bench.bus.on()
        drive = bench.bus.drives[1]
        drive.read(700)
        bench.motor(2).stale_replies = 10_000
        bench.at(0.2, lambda bench=bench, drive=drive: bench.bus.remove(drive))
        assert "is not on the bus" in refusal(NoContact, drive.read, 701)
        bench.bus.close()
        assert refusal(NoContact, bench.bus.wait, 1) == "the bus is closed"

        bench = Bench(paced=paced)
        bench.at(0.6, bench.bus.off)
        bench.motor().write(10, 0, 1)  # it does not start
        refusal(UssError, bench.drive.run, 10.0)
        assert not bench.drive.is_on()
        bench.bus.close()
        bench.check()


def test_a_start_that_waits_while_idle_closes_the_bus_says_that_it_is_closed():
    stage = Stage((1,), parameters={2014: 2_000, 10: 1})  # it does not start

    def idle():
        stage.clock.advance(900)
        if drive.engine.wanted:
            bus.close()

    bus = Master(stage.board.make_link(stage.wire.baud), baud=stage.wire.baud, idle=idle)
    drive = bus.add(1, MM420)
    assert refusal(NoContact, drive.run, 10.0) == "the bus is closed"
    assert bus.engine.phase == CLOSED and stage.drives[1].starts == 0
    stage.check()


# --- what it does -------------------------------------------------------------------------------


def test_without_contact_there_is_no_speed_to_tell():
    bench = Bench()
    assert bench.drive.state == NO_CONTACT
    bench.motor().unplug()
    for name in ("hertz", "percent", "rpm", "fault"):
        assert "does not answer" in refusal(NoContact, getattr, bench.drive, name)


def test_the_first_question_waits_for_contact_and_settings():
    bench = Bench()
    assert took_s(bench, bench.drive.do, pkw.read(700)) < 0.9  # as soon as it answers
    near(bench.drive.hertz, 0.0)
    assert bench.drive.contact
    bench.end()


def test_a_drive_that_was_exchanged_is_asked_anew():
    bench = Bench()
    bench.drive.run(percent=50)
    bench.bus.wait(1)
    near(bench.drive.hertz, 25.0)
    bench.drive.stop()
    bench.motor().unplug()
    bench.bus.wait(1.5)
    bench.motor().write(2000, 0, 100.0)
    bench.motor().plug()
    bench.bus.wait(2.5)
    bench.drive.acknowledge()
    bench.drive.run(percent=10)
    bench.bus.wait(1)
    near(bench.drive.hertz, 10.0)
    bench.end()


def test_a_drive_without_parameter_channel_is_told_what_its_speeds_mean():
    mute = {2013: 0, 1120: 1.0}
    bench = Bench(parameters=mute, layout=Layout(0, 2))
    assert "scale=Scale" in refusal(NotStarted, bench.drive.run, percent=50)
    assert "what 100 % is" in refusal(ValueError, getattr, bench.drive, "percent")
    text = refusal(UssError, bench.drive.read, 700)
    assert text == "drive 1 has no parameter channel: Layout(0, 2)"
    scale = Scale(50.0, pole_pairs=2)
    bench = Bench(parameters=mute, layout=Layout(0, 2), scale=scale)
    drive = bench.drive
    text = refusal(NotStarted, drive.run, rpm=300)
    assert "does not tell its telegram-off time" in text and "unsupervised=True" in text
    bench.bus.supervise(drive, 0)
    refusal(NotStarted, drive.run, rpm=300)  # its owner says that it never trips
    bench.bus.supervise(drive, 2_000)
    drive.run(rpm=300)
    bench.bus.wait(1)
    near(drive.hertz, 10.0)
    near(drive.rpm, 300.0, 1)
    near(drive.percent, 20.0)
    bench.motor().fault(1)
    bench.bus.wait(0.2)
    assert drive.fault == -1
    bench.end()


def test_a_g110_without_parameters_needs_no_scale_for_percent():
    bench = of_family(G110, g110, {2013: 0, 1120: 1.0}, layout=Layout(0, 2), unsupervised=True)
    bench.drive.run(percent=20)
    bench.bus.wait(1)
    near(bench.drive.percent, 20.0)
    assert "not known" in refusal(ValueError, getattr, bench.drive, "hertz")
    bench.motor().fault(1)
    bench.bus.wait(0.2)
    bench.drive.stop()
    bench.drive.acknowledge()
    bench.drive.run(percent=20)  # nothing is read meanwhile: it waits for the end of the fault
    assert bench.drive.is_running
    bench.end()


# --- other families -----------------------------------------------------------------------------


def of_family(family, simulated, parameters, **options):
    """A bench whose drive is of another family."""
    kind = {"family": simulated, "parameters": parameters}
    return Bench((1,), family, kinds={1: kind}, **options)


def test_an_mm440_tells_its_speed_and_is_told_one():
    bench = of_family(MM440, mm440, QUICK)
    bench.drive.run(rpm=-600)
    bench.bus.wait(1)
    near(bench.drive.rpm, -600, 1)
    near(bench.drive.hertz, -20.0)
    bench.end()


def test_an_mm3_turns_left_by_a_bit_and_has_no_sign():
    bench = of_family(MM3, mm3, {93: 2, 2: 10, 3: 10})
    bench.drive.run(-10.0)
    bench.bus.wait(1)
    assert bench.stws(1)[-1] == 0x147F
    near(bench.drive.hertz, -10.0, 0.05)
    near(bench.motor().hz(), -10.0, 0.05)
    bench.drive.run(rpm=300)
    bench.bus.wait(1)
    assert bench.stws(1)[-1] == 0x0C7F
    near(bench.drive.rpm, 300, 2)
    assert bench.drive.read(91) == 1
    bench.end()


def test_an_mm3_that_turns_left_may_stand_still_meanwhile():
    """Its actual value has no sign, so nobody can tell from it that it has stopped by itself."""
    bench = of_family(MM3, mm3, {93: 2, 2: 10, 3: 10})
    bench.drive.run(-10.0)
    bench.bus.wait(1)
    for most_steps, hertz in ((0, 0.0), (500, -10.0)):
        bench.motor().write(13, 0, most_steps)  # the highest frequency
        bench.bus.wait(1)
        near(bench.drive.hertz, hertz, 0.05)
        assert bench.drive.is_running and bench.drive.is_on()
    assert bench.motor().starts == 1
    bench.end()


def test_an_mm3_may_count_its_frequencies_in_hundredths_of_a_hertz():
    bench = of_family(MM3, mm3, {93: 2, 2: 10, 3: 10, 95: 1})
    for number in (13, 81, 94):
        bench.drive.write(number, 5000, sure=True)
    assert "P0013[0] = 50.00 Hz" in refusal(ValueError, bench.drive.run, 60.0)
    bench.drive.run(rpm=600)
    bench.bus.wait(3)
    near(bench.drive.hertz, 20.0, 0.05)
    near(bench.motor().hz(), 20.0, 0.05)
    bench.end()


def test_a_g110_and_a_v20_have_variable_telegrams():
    for family, simulated in ((G110, g110), (V20, v20)):
        bench = of_family(family, simulated, QUICK)
        bench.drive.run(-10.0)
        bench.bus.wait(1)
        near(bench.drive.hertz, -10.0, 0.05)
        assert bench.drive.read(700) == 5
        assert bench.drive.write(1120, 3.0) == 3.0
        bench.end()


def test_a_g120_counts_in_revolutions_and_does_not_jog():
    bench = of_family(G120, g120, None)
    drive = bench.drive
    assert refusal(NotStarted, drive.jog_right) == "a SINAMICS G120 has no jog"
    drive.run(rpm=150)
    assert bench.bus.wait(5, lambda: drive.rpm > 145)
    bench.bus.wait(1)
    near(drive.percent, 10.0, 0.1)
    near(bench.motor().hz(), 5.0, 0.1)
    drive.run(rpm=-150)
    assert bench.bus.wait(9, lambda: drive.rpm < -145)
    text = refusal(ValueError, drive.run, rpm=100_000 / 60)
    assert "1/min is beyond the limit of drive 1: P1082[0]" in text
    bench.end()


def test_a_drive_of_which_nothing_is_known_runs_by_percent():
    bench = Bench(family=GENERIC, unsupervised=True)
    bench.drive.run(percent=20)
    bench.bus.wait(1)
    near(bench.drive.percent, 20.0)
    assert "not known" in refusal(ValueError, bench.drive.run, 10.0)
    assert bench.drive.read(700) == 5
    assert bench.drive.read(1082, kind=float) == 50.0
    assert "nobody knows" in refusal(ValueError, bench.drive.supervise, 1.0)
    bench.motor().fault(1)
    bench.bus.wait(0.2)
    assert bench.drive.fault == -1
    bench.drive.stop()
    assert "tripped with a fault" in refusal(NotStarted, bench.drive.run, percent=20)
    bench.end()


# --- parameters ---------------------------------------------------------------------------------


def test_read_brings_words_as_integers_and_double_words_as_floats():
    bench = Bench()
    assert bench.drive.read(700) == 5
    near(bench.drive.read(1082), 50.0, 0)
    assert bench.drive.read(2010, index=1) == bench.motor().read(2010, 1)
    assert bench.drive.read(2019) == 52 << 16
    assert tasks_sent(bench) == {pkw.READ}  # no description: of this family it is known
    bench.end()


def tasks_sent(bench, since_us=0):
    """The AKs that the bus has sent since then, NO_TASK besides."""
    sent = [row[2] for row in bench.wire.log.last(1000) if row[1] and row[0] >= since_us]
    return {characters[3] >> 4 for characters in sent} - {pkw.NO_TASK}


def test_a_parameter_is_not_read_or_written_as_what_it_is_not():
    bench = Bench()
    drive = bench.drive
    for number, value, kind, text in (
        (1082, 40, int, "P1082[0] of drive 1 is a float, not of kind int"),
        (700, 5, float, "P0700[0] of drive 1 is a word, not of kind float"),
        (2019, 0, float, "P2019[0] of drive 1 is an integer, not of kind float"),
        (1120, 5, str, "kind is int or float"),
    ):
        assert text in refusal(ValueError, drive.read, number, kind=kind)
        assert text in refusal(ValueError, drive.write, number, value, kind=kind, sure=True)
    assert drive.read(1082, kind=float) == 50.0 and drive.read(700, kind=int) == 5
    assert bench.motor().read(1082) == 50.0 and bench.motor().read(700) == 5
    bench.end()


def test_where_the_family_does_not_say_what_a_double_word_is_the_drive_does():
    """By its description of the parameter; without one, whoever reads says it."""
    bench = of_family(GENERIC, generic, {}, unsupervised=True)
    drive = bench.drive
    assert drive.read(1082) == 50.0 and drive.read(2019, index=1) == 0x340000
    text = refusal(ValueError, drive.read, 2019, 1, float)
    assert text == "P2019[1] of drive 1 is an integer, not of kind float: leave kind= out"
    bench.bus.wait(0.1)
    since_us = bench.clock.now_us
    assert drive.read(1082) == 50.0  # it has said what this is
    rows = bench.wire.log.last(1000)
    assert {row[2][3] >> 4 for row in rows if row[1] and row[0] >= since_us} == {pkw.READ}
    bench.motor().unplug()
    bench.bus.wait(2)
    bench.motor().plug()
    bench.bus.wait(2)
    since_us = bench.clock.now_us
    assert drive.read(1082) == 50.0  # it may be another one
    assert tasks_sent(bench, since_us) == {pkw.READ, pkw.READ_DESCRIPTION}
    assert "is a float, not of kind int" in refusal(ValueError, drive.write, 1082, 40, kind=int)
    assert drive.write(1082, 45) == 45.0 and bench.motor().read(1082) == 45.0
    bench.end()
    bench = of_family(GENERIC, terse(), {}, unsupervised=True)
    assert bench.drive.read(1082) == 0x42480000
    assert bench.drive.read(1082, kind=float) == 50.0
    assert bench.drive.write(1082, 45, kind=float) == 45.0
    bench.end()


def test_a_double_word_with_a_sign_is_an_integer_as_well():
    drive = of_family(GENERIC, generic, {}, unsupervised=True).drive
    told = DATA_TYPES["U32"]
    DATA_TYPES["U32"] = descriptions.I32
    try:
        assert "is an integer" in refusal(ValueError, drive.read, 2019, 1, float)
    finally:
        DATA_TYPES["U32"] = told


def terse():
    """The drive of the specification, without descriptions."""

    class Terse:
        pass

    for name in dir(generic):
        setattr(Terse, name, getattr(generic, name))
    Terse.CHANNEL = dict(generic.CHANNEL)
    Terse.CHANNEL["tasks"] = (1, 2, 3, 6, 7, 8)
    return Terse


def test_of_a_drive_that_was_never_heard_nothing_is_known():
    """Nothing known is not zero: at 0 some bits would be alarms."""
    bench = Bench()
    drive = bench.drive
    bench.motor().unplug()
    bench.bus.wait(1)
    assert bits.names(drive.zsw, MM420.zsw_bits) == ["UNKNOWN"]
    assert drive.zsw is None and drive.hiw is None and drive.word(1) is None
    assert not bits.may_start(drive.zsw)
    refusal(ValueError, drive.word, 3)
    bench.motor().plug()
    bench.bus.wait(1)
    assert "READY_TO_SWITCH_ON" in bits.names(drive.zsw, MM420.zsw_bits)
    assert bits.may_start(drive.zsw) and drive.hiw == 0
    bench.motor().unplug()
    bench.bus.wait(2)
    assert bits.names(drive.zsw, MM420.zsw_bits) == ["UNKNOWN"]
    bench.end()


def test_an_element_of_an_array_goes_by_the_tasks_for_arrays_where_no_others_take_an_index():
    """Specification C-4.2.2. Only of a MICROMASTER 4 it is known that its other tasks take one."""
    for family, simulated, tasks in (
        (GENERIC, generic, {6, 7, 12}),
        (V20, v20, {6, 7, 12}),
        (MM420, mm420, {1, 2, 14}),
    ):
        bench = of_family(family, simulated, {}, unsupervised=True)
        first = family.first_index
        index = first + 1
        drive = bench.drive
        bench.bus.wait(0.5)
        before_us = bench.clock.now_us
        assert drive.read(2010, index=index) == bench.motor().read(2010, 1)
        for eeprom in (False, True):
            value = drive.read(2010, index=index) ^ 1
            assert drive.write(2010, value, index=index, eeprom=eeprom, sure=True) == value
            assert bench.motor().read(2010, 1) == value
        assert tasks_sent(bench, before_us + 1) == tasks, family
        if family is GENERIC:
            refused = refusal(Refused, drive.do, pkw.read(2010, index))
            assert "no such index" in refused
        bench.end()


def test_write_finds_out_what_the_parameter_is():
    bench = Bench()
    assert bench.drive.write(1120, 5) == 5.0  # a float in the drive, an integer in the program
    assert bench.drive.write(971, 1.0) == 1  # and the other way round
    assert bench.drive.write(1082, 45.5, kind=float) == 45.5
    assert bench.motor().read(1120) == 5.0 and bench.motor().read(1082) == 45.5
    assert "takes integers" in refusal(ValueError, bench.drive.write, 971, 0.5)
    bench.end()


def test_a_double_word_may_be_an_integer():
    bench = Bench()
    assert bench.drive.read(2019) == 52 << 16
    assert bench.drive.write(2019, 21 << 16, index=2, sure=True) == 21 << 16
    assert bench.motor().read(2019, 2) == 21 << 16
    bench.end()


def test_a_family_of_ones_own_is_a_few_lines():
    class Odd(MM420):
        name = "ODD"
        survey = ((1998, 0, WORD, None),) + MM420.survey[1:]  # neither does it have P1998
        fault_number = 1999  # nor P1999
        fault_format = "E%d"

    bench = Bench(family=Odd)
    bench.drive.run(10.0)
    assert bench.drive.is_running
    bench.motor().fault(1)
    bench.bus.wait(0.2)
    assert bench.drive.fault == -1
    bench.bus.close()
    bench.bus.close()  # a second time changes nothing
    bench.check()


def test_a_family_without_tasks_for_the_eeprom_says_what_saves_instead():
    bench = Bench(family=MM3)
    try:
        bench.drive.write(2, 5, eeprom=True)
    except ValueError as reason:
        assert str(reason) == (
            "no task of MICROMASTER 3 writes the EEPROM: write parameter 971 afterwards"
        ), reason
    else:
        raise AssertionError("it was tried")


def test_ram_is_lost_with_the_power_and_eeprom_is_not():
    bench = Bench()
    bench.drive.write(1120, 5.0)
    bench.drive.write(1121, 6.0, eeprom=True)
    bench.motor().power_off()
    bench.motor().power_on()
    assert bench.motor().read(1121) == 6.0 and bench.motor().read(1120) != 5.0
    bench.end()


def test_a_refusal_has_a_number_and_words():
    bench = Bench()
    try:
        bench.drive.write(1082, 900.0)
    except Refused as refused:
        assert refused.number == 2
        assert str(refused) == "drive 1 refuses P1082[0]: beyond the limits"
        assert refused.job.number == 1082
    assert "no such parameter" in refusal(Refused, bench.drive.read, 1999)
    bench.end()


def test_a_drive_that_answers_but_not_to_the_task_times_out():
    bench = Bench()
    bench.drive.read(700)
    bench.motor().stale_replies = 10_000
    text = refusal(TimedOut, bench.drive.read, 1082)
    assert text == "drive 1 does not answer about P1082[0]"
    bench.end()


def test_a_question_that_silences_the_drive_stops_no_motor():
    """It is withdrawn long before contact would be lost, and says so; the next one is answered."""
    bench = Bench()
    bench.motor().switches.silent_refusals = True
    drive = bench.drive
    drive.run(10.0)
    contacts = drive.engine.contacts
    for ask in (
        lambda: drive.read(999),
        lambda: drive.write(999, 5.0, kind=float),
        lambda: drive.write(999, 5.0, kind=float, eeprom=True),
        lambda: drive.read(999),
    ):
        before_us = bench.clock.now_us
        text = refusal(FallsSilent, ask)
        assert text == (
            "drive 1 falls silent when it is asked about P0999[0], and answers without"
        ), text
        assert bench.clock.now_us - before_us < 500_000, "half of the lost time"
        assert drive.contact and drive.engine.contacts == contacts and drive.is_running
        assert drive.read(1082) == 50.0
    assert issubclass(FallsSilent, TimedOut)
    assert bench.motor().starts == 1 and bench.motor().state == "running"
    bench.end()


def test_a_drive_that_was_away_is_asked_anew():
    """What was wrong before is old news: at least one telegram goes out before anybody fails."""
    bench = Bench()
    drive = bench.drive
    drive.read(700)
    bench.motor().unplug()
    refusal(NoContact, drive.read, 1082)
    bench.bus.wait(5)
    bench.motor().plug()
    assert drive.read(1082) == 50.0
    bench.motor().unplug()
    refusal(NoContact, drive.read, 1082)
    sent = drive.silent
    assert refusal(NoContact, drive.read, 1082) == "drive 1 does not answer"
    assert drive.silent == sent + 3
    bench.end()


def test_the_counters_of_a_silent_drive_may_wrap_while_somebody_waits_for_it():
    bench = Bench()
    bench.motor().unplug()
    refusal(NoContact, bench.drive.read, 700)
    no_reply = COUNTERS.index("no_reply")
    bench.drive.counters[no_reply] = 0xFFFE
    silent = bench.drive.silent
    assert took_s(bench, refusal, NoContact, bench.drive.read, 700) < 0.5
    assert bench.drive.silent == silent + 3 and bench.drive.counters[no_reply] == 1


def test_nobody_waits_for_contact_with_a_drive_that_is_taken_off_meanwhile():
    bench = Bench((1, 2))
    bench.motor().unplug()
    bench.bus.wait(1)
    bench.at(0.01, lambda: bench.bus.remove(drive))
    drive = bench.drive
    since_us = bench.clock.now_us
    assert refusal(NoContact, drive.read, 700) == "drive 1 is not on the bus"
    assert bench.clock.now_us - since_us < 15_000
    bench.end()


def test_a_start_of_a_silent_drive_takes_back_no_off2_or_off3():
    bench = Bench()
    bench.bus.wait(0.5)
    bench.drive.off3()
    bench.bus.wait(0.2)
    bench.motor().unplug()
    bench.bus.wait(1.5)
    stops = bench.drive.engine.stops
    refusal(NoContact, bench.drive.run, 10.0)
    assert bench.drive.engine.off == pzd.OFF3 and bench.drive.engine.stops == stops


def test_one_of_many_silent_drives_is_asked_at_once_when_somebody_waits_for_it():
    bench = Bench(tuple(range(1, 31)))
    bench.bus.wait(1)
    for motor in bench.drives.values():
        motor.unplug()
    bench.bus.wait(4)
    for address in (17, 29, 5):
        bench.motor(address).plug()
        since_us = bench.clock.now_us
        assert bench.bus.drives[address - 1].read(700) == 5
        assert bench.clock.now_us - since_us < 300_000


def test_a_drive_that_is_lost_in_between_does_not_answer():
    bench = Bench()
    bench.drive.read(700)
    bench.motor().unplug()
    assert refusal(NoContact, bench.drive.read, 1082) == "drive 1 does not answer"


def test_what_may_cost_the_bus_its_drive_wants_to_be_sure():
    bench = Bench()
    text = refusal(ValueError, bench.drive.write, 700, 2)
    assert text.startswith("P0700[0] may take drive 1 away from this bus")
    assert bench.motor().read(700) == 5
    bench.drive.write(700, 2, sure=True)
    assert "not under USS control" in refusal(NotStarted, bench.drive.run, 10.0)
    bench.end()


def test_a_speed_means_the_new_thing_after_the_reference_was_written():
    bench = Bench()
    bench.drive.run(percent=20)
    bench.bus.wait(1)
    bench.drive.stop()
    bench.bus.wait(1)
    bench.drive.write(2000, 25.0, sure=True)
    bench.drive.run(percent=20)
    bench.bus.wait(1)
    near(bench.drive.hertz, 5.0)
    bench.end()


def test_whoever_has_no_time_asks_and_looks_later():
    bench = Bench()
    job = pkw.read(1082)
    bench.drive.ask(job)
    assert job.state == pkw.PENDING
    assert bench.bus.wait(1, lambda: job.state == pkw.DONE) and job.float_value() == 50.0
    bench.end()


def test_any_job_can_be_waited_for():
    bench = Bench()
    assert bench.drive.do(pkw.read(700)).integer_value() == 5
    bench.end()


def test_a_motor_that_may_run_keeps_its_address():
    bench = Bench()
    bench.drive.run(10.0)
    text = refusal(UssError, bench.drive.write, 2011, 5, sure=True)
    assert text.startswith("drive 1 may be running") and bench.motor().read(2011) == 1
    assert bench.drive.write(1120, 2.0) == 2.0  # what is no address goes to the drive
    assert "not in this operating state" in refusal(
        Refused, bench.drive.write, 2014, 5_000, sure=True
    )
    bench.motor().unplug()
    bench.bus.wait(2)  # it is lost, and may run still
    assert refusal(UssError, bench.drive.write, 2011, 5, sure=True) == text
    bench.motor().plug()
    bench.drive.stop()
    bench.bus.wait(2)
    assert bench.drive.write(2011, 5, sure=True) == 5
    bench.bus.readdress(bench.drive, 5)
    assert bench.drive.read(700) == 5
    bench.end()


def test_a_kind_that_the_family_knows_better_is_refused():
    bench = Bench()
    for number, value, kind in ((1120, 5, int), (2019, 0, float), (1120, 5, str)):
        assert "kind" in refusal(
            ValueError, bench.drive.write, number, value, 0, False, kind, True
        )
    assert bench.motor().read(1120) == 1.0
    bench.end()


# --- the bus ------------------------------------------------------------------------------------


def test_the_same_calls_work_by_interrupts():
    bench = Bench((1, 2), paced=True)
    one, two = bench.bus.drives
    one.run(10.0)
    two.run(-5.0)
    bench.bus.wait(1)
    near(one.hertz, 10.0)
    near(two.hertz, -5.0)
    assert one.write(1120, 2.0) == 2.0
    bench.end()


def test_a_board_without_receive_interrupt_will_do():
    """Nor is a timer needed: each step does what is due."""
    for has_pacer in (False, True):
        bench = Bench((1, 2), polled=True)
        if has_pacer:
            bench.bus.pace(Pacer, None)
        bench.drive.run(10.0)
        bench.bus.wait(1)
        near(bench.drive.hertz, 10.0)
        bench.end()


def test_ctrl_c_that_strikes_in_an_interrupt_ends_the_program_all_the_same():
    bench = Bench(paced=True)
    bench.drive.run(10.0)
    engine = bench.drive.engine
    take, ctrl_c = engine.take, KeyboardInterrupt()

    def pressed(buffer, count, now):  # in an interrupt nothing may allocate
        raise ctrl_c

    engine.take = pressed
    try:
        bench.bus.wait(1)
    except KeyboardInterrupt:
        engine.take = take
    else:
        raise AssertionError("Ctrl-C is lost")
    assert not bench.drive.is_on()
    bench.end()


def test_a_drive_that_stands_in_the_list_twice_is_asked_twice_as_often():
    bench = Bench((1, 2))
    one = bench.drive
    assert bench.bus.add(1) is one
    assert [drive.address for drive in bench.bus.engine.turns.list] == [1, 2, 1]
    bench.bus.wait(2)
    near(one.counters[0] / bench.bus.drives[1].counters[0], 2.0, 0.1)
    bench.end()


def test_a_parameter_of_one_of_many_drives_does_not_wait_for_rounds_of_the_list():
    bench = Bench(tuple(range(1, 13)))
    assert bench.bus.wait(3, lambda: all([drive.contact for drive in bench.bus.drives]))
    bench.bus.wait(bench.bus.round_us() / 2_000_000)
    assert took_s(bench, bench.drive.read, 700) < 0.1
    bench.end()


def test_a_drive_that_was_read_has_no_more_turns_than_the_others_afterwards():
    bench = Bench((1, 2, 3))
    bench.drive.read(700)
    refusal(Refused, bench.drive.read, 1999)
    before = [drive.counters[0] for drive in bench.bus.drives]
    bench.bus.wait(2)
    turns = [drive.counters[0] - count for drive, count in zip(bench.bus.drives, before)]
    assert max(turns) - min(turns) <= 2, turns
    bench.end()


def test_the_bus_has_the_sums_of_the_counters_and_all_the_bits():
    bench = Bench((1, 2))
    assert bench.bus.wait(1, lambda: all([drive.contact for drive in bench.bus.drives]))
    assert bench.bus.status() == 0
    bench.motor(2).unplug()
    bench.bus.wait(2)
    figures = zip(*[drive.counters for drive in bench.bus.drives])
    assert bench.bus.counters() == [sum(pair) for pair in figures] and bench.bus.counters()[5] > 5
    assert bench.bus.status() == bench.bus.drives[1].status == 0x80
    for drive, status in zip(bench.bus.drives, (0x88, 0x90)):
        drive.engine.status = status
    assert bench.bus.status() == 0x98
    bench.end()


def test_the_list_is_edited_while_the_bus_runs():
    bench = Bench((1, 2, 3))
    one, two, three = bench.bus.drives
    bench.bus.wait(0.5)
    bench.bus.arrange((one, two, one, three))
    before = [drive.counters[0] for drive in (one, two, three)]
    bench.bus.wait(2)
    turns = [drive.counters[0] - count for drive, count in zip((one, two, three), before)]
    near(turns[0] / turns[1], 2.0, 0.1)
    near(turns[2] / turns[1], 1.0, 0.1)
    one.run(10.0)
    assert "may be running" in refusal(ValueError, bench.bus.remove, one)
    bench.bus.remove(three)
    assert bench.bus.drives == [one, two]
    assert refusal(ValueError, bench.bus.remove, three) == "drive 3 is not on this bus"
    since_us = bench.clock.now_us
    bench.bus.wait(0.5)
    assert bench.stws(3, since_us) == []
    assert "no turn" in refusal(ValueError, bench.bus.arrange, (one,))
    bench.end()


def test_a_drive_moves_to_another_address():
    bench = Bench((1, 2))
    one, two = bench.bus.drives
    one.write(2011, 5, eeprom=True, sure=True)
    bench.bus.readdress(one, 5)
    assert one.address == 5 and one.read(2011) == 5
    assert "taken" in refusal(ValueError, bench.bus.readdress, two, 5)
    bench.end()


def test_a_round_may_have_a_fixed_time_and_an_exchange_be_repeated():
    bench = Bench((1, 2))
    bench.bus.cycle_us = 100_000
    bench.bus.wait(0.5)
    before = bench.drive.counters[0]
    bench.bus.wait(2)
    assert bench.bus.cycle_us == 100_000 and 19 <= bench.drive.counters[0] - before <= 21
    assert bench.bus.retries == 0
    bench.bus.retries = 2
    bench.motor().unplug()
    since_us = bench.clock.now_us
    bench.bus.wait(0.5)
    sent = [row[2][2] for row in bench.wire.log.last(40) if row[0] >= since_us and row[1]]
    first = sent.index(1)
    assert bench.bus.retries == 2 and sent[first : first + 4] == [1, 1, 1, 2]
    bench.end()


def test_a_round_is_as_long_as_its_telegrams_or_as_it_was_fixed():
    """A telegram of 4 + 2 words is 16 characters; before each there are two of silence."""
    bus = Bench((1, 2)).bus
    character_us = 11_000_000 / 19_200
    near(bus.round_us(), 2 * 2 * (16 + 2) * character_us, 10)
    bus.add(1)
    near(bus.round_us(), 3 * 2 * (16 + 2) * character_us, 10)
    bus.cycle_us = 200_000
    assert bus.round_us() == 200_000
    bus.cycle_us = 50_000
    assert bus.round_us() > 60_000


def test_a_family_has_its_layouts():
    bench = Bench((), parameters={})
    assert bench.bus.add(3, G110).layout.variable
    text = refusal(ValueError, bench.bus.add, 4, MM420, Layout(4, 8))
    assert text == "a MICROMASTER 420 has no Layout(4, 8)"
    assert "not 0...31" in refusal(ValueError, bench.bus.add, 32)


def test_drives_are_added_in_any_order_of_their_addresses():
    bench = Bench((), parameters={})
    five, three, seven = [bench.bus.add(address, MM420) for address in (5, 3, 7)]
    assert [drive.address for drive in bench.bus.drives] == [5, 3, 7]
    assert [bench.bus.add(address) for address in (3, 7, 5)] == [three, seven, five]


def test_what_is_no_drive_is_not_added():
    bench = Bench()
    add = bench.bus.add
    assert "integer" in refusal(TypeError, add, "1")
    assert "uss.families" in refusal(TypeError, add, 4, "MM420")
    assert "layout=Layout(4, 2)" in refusal(TypeError, add, 4, MM420, (4, 2))
    assert "scale=Scale(50.0)" in refusal(TypeError, add, 4, MM420, None, 50.0)
    assert refusal(ValueError, add, 1, G110) == "drive 1 is a MICROMASTER 420 already"
    assert "has Layout(4, 2) already" in refusal(ValueError, add, 1, MM420, Layout(4, 4))
    assert add(1, MM420) is bench.drive and len(bench.bus.drives) == 1
    bench.end()


def test_a_bus_takes_only_what_it_can_keep():
    bench = Bench()
    for retries in (-1, 256, 1.5, "2", None):
        refusal(ValueError, setattr, bench.bus, "retries", retries)
    for cycle_us in (-1, 0.5, "2", None):
        refusal(ValueError, setattr, bench.bus, "cycle_us", cycle_us)
    assert bench.bus.retries == 0 and bench.bus.cycle_us == 0
    for retries in (255, 0):
        bench.bus.retries = retries
        assert bench.bus.retries == retries
    bench.end()


def test_a_wait_is_as_long_as_it_is_told_in_rests_of_a_tenth_of_a_millisecond():
    stage = Stage(())
    bus = Master(stage.board.make_link(19200))
    for seconds, us in ((0, 100), (0.001, 1_000), (0.00101, 1_100)):
        assert took_s(stage, bus.wait, seconds) == us / 1_000_000, seconds
    assert took_s(stage, bus.rest) == 0.0001
    bus.close()


def test_a_link_has_one_master_at_a_time():
    bench = Bench()
    assert "close() that one first" in refusal(ValueError, Master, bench.link)
    bench.bus.close()
    other = Master(bench.link)
    bench.bus.close()  # that it is closed twice does not take the link from the other
    assert "close() that one first" in refusal(ValueError, Master, bench.link)
    other.close()


def test_a_closed_bus_leaves_line_and_chip_alone():
    for paced in (False, True):
        bench = Bench(paced=paced)
        bench.bus.wait(0.3)
        stations = bench.wire.names()
        bench.bus.close()
        assert len(bench.wire.names()) == len(stations) - 1, (stations, bench.wire.names())
        entered = []
        bench.bus.engine.poll = lambda now, entered=entered: entered.append(now)
        bench.clock.advance(1_000_000)
        assert not entered
        bench.check()


def test_mirror_tells_who_is_there():
    bench = Bench((1, 7))
    bench.bus.remove(bench.bus.drives[1])
    assert [node for node in (1, 3, 7) if bench.bus.mirror(node)] == [1, 7]
    bench.end()
    bench = of_family(MM3, mm3, {})
    assert bench.bus.mirror(1)  # in telegrams as long as its own
    bench.end()


def test_a_mirror_telegram_is_given_up_where_the_bus_is_put_off_before_its_turn():
    bench = Bench()
    bench.bus.wait(0.5)
    bench.bus.off()
    assert refusal(NoContact, bench.bus.mirror, 1) == "the bus is off"
    bench.end()


def scanned(drives, addresses=range(32), **options):
    """A line on which nobody is known, address -> (family, parameters); the stage, the bus, what a
    scan has found."""
    kinds = {
        address: {"family": family, "parameters": parameters}
        for address, (family, parameters) in drives.items()
    }
    stage = Stage(tuple(drives), kinds=kinds, **options)
    bus = Master(stage.board.make_link(stage.wire.baud), baud=stage.wire.baud)
    scan = Scan(bus, stage.clock.ticks_mask, addresses)
    while not scan.step(bus.clock.ticks_us()):
        bus.rest()
        stage.clock.advance(900)
    return stage, bus, scan


def test_a_scan_trips_nobody_and_says_who_will():
    """A drive that has heard a telegram trips when it hears no more, some before it is over."""
    drives = {
        1: (mm420, {2014: 2_000}),
        2: (mm420, {2014: 0}),
        9: (mm440, {2014: 600, 2012: 4}),
        17: (v20, {2014: 700}),
        30: (g120, {2040: 500}),
    }
    stage, bus, scan = scanned(drives)
    assert scan.asked > 100
    assert [drive.state for drive in stage.drives.values()] == ["ready"] * 5, [
        drive.report() for drive in stage.drives.values()
    ]
    for drive in stage.drives.values():
        assert drive.stw == 0x047E and drive.starts == 0
    assert scan.will_trip == {1: 2_000, 9: 600, 17: 700, 30: 500}
    for address, node in scan.nodes.items():
        bus.add(address, node.family, node.layout)
    bus.wait(3)
    assert [drive.state for drive in bus.drives] == ["ready"] * 5
    bus.close()


def test_a_scan_says_what_it_has_found_in_a_form_that_add_takes():
    wanted = {
        0: (mm420, {}, MM420, (4, 2)),
        1: (mm440, {2012: 4}, MM420, (4, 4)),
        2: (mm3, {}, MM3, (3, 2)),
        3: (g110, {2013: 0}, GENERIC, (0, 2)),
        4: (g110, {}, G110, (VARIABLE, 2)),
        5: (v20, {2014: 0}, V20, (VARIABLE, 2)),
        6: (g120, {}, G120, (VARIABLE, 2)),
        7: (mm440, {2013: 127, 2012: 4}, MM420, (VARIABLE, 4)),
        8: (mm420, {2013: 3}, MM420, (3, 2)),
        9: (mm440, {2012: 8}, MM440, (4, 8)),
        10: (generic, {2013: 127, 2012: 9}, GENERIC, (VARIABLE, 9)),
        11: (mm420, {2013: 3, 2012: 3}, MM420, (3, 3)),
    }
    drives = {address: (row[0], row[1]) for address, row in wanted.items()}
    stage, bus, scan = scanned(drives, range(13))
    for address, (_, _, family, layout) in wanted.items():
        node = scan.nodes[address]
        told = (node.layout.pkw_words, node.layout.pzd_words)
        assert (node.family, told) == (family, layout), (address, node)
        assert repr(node) == "<%s %r>" % (family.name, node.layout)
        bus.add(address, node.family, node.layout)
    assert sorted(scan.nodes) == sorted(wanted)
    assert bus.wait(3, lambda: all([drive.contact for drive in bus.drives]))
    bus.close()
    stage.check()


def test_a_scan_tells_which_link_of_a_micromaster_4_it_has_found():
    """By the layout that index 0 or 1 tells, by the address, or by P0700."""
    com_420, com_440 = mm420, mm440
    bop_420, bop_440 = on_bop_link(mm420), on_bop_link(mm440)
    wanted = {
        0: (bop_440, {2013: 4}, on_bop(MM420), (4, 2)),  # address 0 and 4 + 2 words, on either
        1: (bop_420, {}, on_bop(MM420), (4, 2)),
        2: (bop_440, {(2013, 1): 127, (2012, 1): 4}, on_bop(MM420), (VARIABLE, 4)),
        3: (bop_420, {2013: 4}, on_bop(MM420), (4, 2)),
        4: (bop_440, {2013: 4, 2011: 4}, on_bop(MM420), (4, 2)),
        5: (com_420, {(2013, 1): 4, (2011, 1): 5}, MM420, (4, 2)),
        6: (com_440, {(2013, 1): 4}, MM420, (4, 2)),
        7: (bop_440, {(2012, 1): 8}, on_bop(MM440), (4, 8)),
        8: (bop_420, {(2013, 1): 3, (2014, 1): 900}, on_bop(MM420), (3, 2)),
        9: (bop_420, {(2013, 1): 0}, GENERIC, (0, 2)),
    }
    drives = {address: (row[0], row[1]) for address, row in wanted.items()}
    stage, bus, scan = scanned(drives, range(10))
    for address, (_, _, family, layout) in wanted.items():
        node = scan.nodes[address]
        told = (node.layout.pkw_words, node.layout.pzd_words)
        assert (node.family, told) == (family, layout), (address, node)
    assert scan.will_trip == {8: 900, 9: None}, scan.will_trip
    bus.close()
    stage.check()


def test_a_drive_that_keeps_silent_on_what_it_does_not_know_is_asked_what_it_is_all_the_same():
    drives = {3: (mm3, {}), 5: (v20, {2014: 700}), 7: (g110, {})}
    kinds = {
        address: {"family": row[0], "parameters": row[1], "switches": {"silent_refusals": True}}
        for address, row in drives.items()
    }
    stage = Stage(tuple(drives), kinds=kinds)
    bus = Master(stage.board.make_link(stage.wire.baud), baud=stage.wire.baud)
    scan = Scan(bus, stage.clock.ticks_mask, range(8))
    while not scan.step(bus.clock.ticks_us()):
        bus.rest()
    assert [scan.nodes[address].family for address in (3, 5, 7)] == [MM3, V20, G110]
    assert [drive.state for drive in stage.drives.values()] == ["ready"] * 3
    bus.close()


def test_leaving_the_bus_stops_every_drive():
    bench = Bench((1, 2))
    with bench.bus:
        for drive in bench.bus.drives:
            drive.run(10.0)
        bench.bus.wait(1)
    assert bench.bus.engine.phase == CLOSED
    assert not any([drive.is_running for drive in bench.bus.drives])  # nobody says so any more
    for address in (1, 2):
        assert bench.stws(address)[-1] == pzd.OFF1
    sent = bench.bus.engine.turns.exchanges
    bench.clock.advance(1_000_000)
    assert bench.bus.engine.turns.exchanges == sent
    bench.check()


def test_an_exception_and_ctrl_c_stop_them_too_wherever_they_strike():
    for paced in (False, True):
        bench = Bench((1, 2), paced=paced)
        try:
            with bench.bus:
                bench.drive.run(10.0)
                bench.at(0.7, bench.interrupt)
                bench.at(0.75, bench.interrupt)  # and again, while it closes
                bench.bus.wait(60)
        except KeyboardInterrupt:
            pass
        else:
            raise AssertionError("Ctrl-C was swallowed")
        assert bench.stws(1)[-1] == pzd.OFF1 and bench.bus.engine.phase == CLOSED
        assert not bench.wire.violations()


def test_a_drive_that_counts_as_lost_late_does_not_keep_the_program_for_so_long():
    """Ten seconds without a reply, and it still counts as in contact."""
    bench = Bench((1, 2))
    bench.bus.engine.turns.lost_us = 10_000_000
    bench.drive.run(10.0)
    bench.bus.wait(0.5)
    bench.motor().unplug()
    since_us = bench.clock.now_us
    bench.bus.close()
    assert 900_000 < bench.clock.now_us - since_us < 1_400_000
    assert bench.bus.engine.phase == CLOSED and bench.stws(1)[-1] == pzd.OFF1
    sent = bench.bus.engine.turns.exchanges
    bench.clock.advance(1_000_000)
    assert bench.bus.engine.turns.exchanges == sent


def test_a_drive_that_does_not_answer_its_off_does_not_keep_the_program():
    bench = Bench((1, 2))
    bench.drive.run(10.0)
    bench.bus.wait(0.5)
    bench.motor().unplug()
    before_us = bench.clock.now_us
    bench.bus.close()
    assert bench.clock.now_us - before_us < 2_500_000
    assert bench.stws(1)[-1] == pzd.OFF1


def test_a_failure_in_the_engine_is_not_hidden_and_takes_every_on_back():
    bench = Bench()
    bench.drive.run(10.0)
    bench.bus.wait(0.5)
    bench.drive.engine.take = None
    try:
        bench.bus.wait(1)
    except TypeError:
        pass
    else:
        raise AssertionError("swallowed")
    assert bench.bus.engine.failures == 1 and not bench.drive.is_on()


def test_how_long_a_reply_may_take_and_a_silence_last_is_up_to_the_program():
    for options, answers, silent_s in (({}, False, 1.0), ({"reply_timeout_ms": 50}, True, 1.0),
                                       ({"lost_ms": 400}, False, 0.4)):  # fmt: skip
        stage = Stage((1,))
        bus = Master(stage.board.make_link(19200), 19200, **options)
        drive = bus.add(1, MM420)
        assert bus.wait(2, lambda drive=drive: drive.contact)
        stage.drives[1].reply_delay_us = 18_000  # by the specification it has 20 ms
        assert bus.wait(0.5) and drive.contact and not drive.silent
        stage.drives[1].reply_delay_us = 40_000
        assert not bus.wait(silent_s - 0.1, lambda drive=drive: not drive.contact)
        assert bus.wait(0.3, lambda drive=drive: not drive.contact) != answers, options
        bus.close()


def test_the_link_has_a_clock_and_the_rate_is_one_of_uss():
    bench = Bench(())
    link = bench.board.make_link(19200)
    bus = Master(link)
    assert bus.clock is bench.board.clock
    assert bus.engine.timing.baud == 19200 and bus.engine.timing.reply_timeout_us == 20_000
    assert bus.engine.turns.lost_us == 1_000_000
    assert "12345" in refusal(ValueError, Master, link, baud=12345)


# --- what is wrong with the line ----------------------------------------------------------------


def test_each_trouble_has_an_exception_that_says_so():
    for how, trouble, _, told in TROUBLES:
        bench = Bench()
        bench.bus.wait(1)
        spoil(bench.wire, bench.motor(), how)
        bench.bus.wait(2)
        text = refusal(NoContact, bench.drive.read, 700)
        assert told in text, (how.__name__, text)
        try:
            bench.drive.read(700)
        except NoContact as reason:
            assert reason.trouble == bench.drive.trouble == trouble
        silent = bench.drive.silent
        refusal(NoContact, bench.drive.read, 700)
        assert bench.drive.silent == silent + 3, how.__name__  # three tries, whatever comes back
