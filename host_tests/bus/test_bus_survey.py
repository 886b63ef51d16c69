# SPDX-License-Identifier: MIT
"""What a drive tells of itself before a start: when it is asked anew, what is never left out.

Parameters are changed behind the bus's back, as somebody at the drive does.
"""

from boards.sim.drives.families import g120, mm440
from bus_bench import QUICK, Bench, refusal
from uss import pkw
from uss.bus import NotStarted, Refused, TimedOut
from uss.errors import FallsSilent
from uss.families import G120, MM420, MM440
from uss.families.rows import COMMAND_SOURCE, DRIVE_SET, SUPERVISION, UNKNOWN, WORD
from uss.layout import Layout
from uss.scaling import Scale

USS = "is not under USS control: "

# Number, index, a value that means something else, what run() says, whether a jog is refused too.
WRONG = (
    (700, 0, 2, USS + "P0700[0] = 2, not 5", True),
    (719, 0, 11, USS + "P0719[0] = 11, not 0", True),
    (719, 0, 3, USS + "P0719[0] = 3, not 0", False),
    (840, 0, 722 << 16, USS + "P0840[0] = 722:0, not 2036:0", True),
    (1000, 0, 2, USS + "P1000[0] = 2, not 5", False),
    (1000, 0, 15, USS + "P1000[0] = 15, not 5", False),
    (1070, 0, 755 << 16, USS + "P1070[0] = 755:0, not 2018:1", False),
    (2200, 0, 1 << 16, USS + "P2200[0] = 1:0, not 0:0", False),
    (2019, 0, 55 << 16, "does not send its status word: P2019[0] = 55:0, not 52:0", True),
)


def set_at(motor, number, index, value):
    """What P0700 and P1000 connect stays as it is."""
    connected = [(source, motor.read(source)) for source in (840, 1070)]
    motor.write(number, index, value)
    for source, before in connected:
        if number != source:
            motor.write(source, 0, before)


def test_a_scale_that_was_told_saves_no_look_at_who_commands_and_who_supervises():
    bench = Bench(scale=Scale(50.0), parameters={2014: 0})
    assert "would run on" in refusal(NotStarted, bench.drive.run, 10.0)
    bench = Bench(scale=Scale(50.0), parameters={2014: 2_000, 700: 2})
    assert "is not under USS control" in refusal(NotStarted, bench.drive.run, 10.0)
    bench.end()


def test_what_the_drive_tells_goes_before_the_scale_that_was_told():
    bench = Bench(scale=Scale(60.0))
    bench.drive.run(25.0)
    bench.bus.wait(1)
    assert 24.9 < bench.motor().hz() < 25.1 and 24.9 < bench.drive.hertz < 25.1
    bench.end()
    kind = {"family": g120, "parameters": None}
    bench = Bench(family=G120, kinds={1: kind}, scale=Scale(reference_rpm=1000.0))
    assert bench.drive.survey.known_scale().reference_rpm == 1500.0
    bench.end()


def test_a_drive_that_does_not_say_what_it_is_asked_is_not_started():
    bench = Bench()
    bench.bus.wait(1)
    bench.motor().stale_replies = 10_000
    refusal(TimedOut, bench.drive.run, 10.0)
    assert bench.motor().starts == 0 and not bench.drive.engine.wanted


def test_what_was_known_is_asked_anew_when_the_drive_was_away():
    bench = Bench()
    assert bench.drive.survey.known_scale().reference_hertz == 50.0
    bench.motor().unplug()
    bench.bus.wait(2)
    bench.motor().write(2000, 0, 100.0)
    assert bench.drive.survey.scale.reference_hertz == 50.0
    bench.motor().plug()
    bench.bus.wait(2)
    assert bench.drive.survey.known_scale().reference_hertz == 100.0
    bench.end()


def test_what_means_something_else_refuses_a_start_and_is_named():
    for number, index, value, said, jog_too in WRONG:
        bench = Bench()
        set_at(bench.motor(), number, index, value)
        assert refusal(NotStarted, bench.drive.run, 10.0) == "drive 1 " + said
        if jog_too:
            assert refusal(NotStarted, bench.drive.jog_right) == "drive 1 " + said
        else:
            bench.drive.jog_right()
        assert bench.motor().starts == (0 if jog_too else 1), said
        bench.end()


def test_p0719_goes_before_p0700_and_p1000_and_what_they_connect():
    bench = Bench()
    for number, value in ((719, 55), (700, 2), (1000, 2)):
        bench.motor().write(number, 0, value)
    bench.drive.run(10.0)
    assert bench.drive.is_running
    bench.end()


def test_what_counts_is_the_data_set_that_is_active():
    bench = Bench(family=MM440, kinds={1: {"family": mm440, "parameters": QUICK}})
    motor = bench.motor()
    for number, value in ((700, 5), (1000, 5), (1070, 755 << 16)):
        motor.write(number, 1, value)
    motor.write(2000, 2, 100.0)
    bench.drive.run(10.0)
    bench.drive.stop()
    bench.bus.wait(1)
    active, readings = {50: 1, 51: 2}, motor.readings.value
    motor.parameters.reading = lambda *place: active.get(place[0]) or readings(*place)
    assert "P1070[1] = 755:0" in refusal(NotStarted, bench.drive.run, 10.0)
    assert bench.drive.survey.scale.reference_hertz == 100.0
    bench.end()


def test_an_actual_value_that_is_no_frequency_is_told_as_none():
    bench = Bench()
    set_at(bench.motor(), 2019, 1, 27 << 16)
    bench.drive.run(10.0)
    for name in ("hertz", "percent", "rpm"):
        text = refusal(ValueError, getattr, bench.drive, name)
        assert text == "drive 1 does not send its actual speed: P2019[1] = 27:0, not 21:0"
    bench.bus.wait(3)
    assert bench.drive.is_running and bench.drive.hiw is not None
    assert bench.drive.engine.near == 0  # no standstill is read out of it
    bench.end()


def test_a_row_without_its_index_has_the_value_of_a_drive_that_lacks_it_or_refuses_a_start():
    """For the active data set such a value is known; for P0700 it is not."""
    bench = Bench(family=with_row(DRIVE_SET, (700, 9, WORD, 0)))
    bench.drive.run(10.0)
    assert bench.drive.survey.values[DRIVE_SET] == 0
    bench.end()
    bench = Bench(family=with_row(COMMAND_SOURCE, (700, 9, WORD, None)))
    text = refusal(Refused, bench.drive.run, 10.0)
    assert text == "drive 1 refuses P0700[9]: no such index" and not bench.motor().starts
    bench.end()


def test_a_telegram_off_time_that_the_drive_lacks_is_told_by_the_program():
    bench = Bench(family=with_row(SUPERVISION, (1999, 0, WORD, 0)))
    text = refusal(NotStarted, bench.drive.run, 10.0)
    assert "does not tell its telegram-off time" in text
    bench.bus.supervise(bench.drive, 2_000)
    bench.drive.run(10.0)
    bench.end()


def with_row(row, asked):
    """A MICROMASTER 420 in which this is asked for a row of the survey."""

    class Odd(MM420):
        survey = MM420.survey[:row] + (asked,) + MM420.survey[row + 1 :]

    return Odd


def test_a_drive_that_falls_silent_on_what_it_lacks_is_started_all_the_same():
    bench = Bench()
    bench.motor().switches.silent_refusals = True
    bench.drive.run(10.0)
    assert bench.drive.is_running
    bench.end()


def test_a_row_that_silences_the_drive_refuses_a_start_where_its_value_must_be_known():
    bench = Bench(family=with_row(COMMAND_SOURCE, (999, 0, WORD, None)))
    bench.motor().switches.silent_refusals = True
    assert "P0999[0]" in refusal(FallsSilent, bench.drive.run, 10.0)
    assert not bench.motor().starts and not bench.drive.engine.wanted
    bench.end()


def asked_for(bench):
    """The parameters that were read, (number, index), in the order of the first telegrams."""
    asked = []
    for _, from_panel, characters in bench.wire.log.last(1000):
        if from_panel and characters[3] >> 4 == pkw.READ:
            number = (characters[3] & 0x07) << 8 | characters[4]
            place = number + (2000 if characters[5] & 0x80 else 0), characters[6]
            if place not in asked[-2:]:
                asked.append(place)
    return asked


def test_a_start_reads_each_setting_once_and_first_what_the_others_depend_on():
    """The counter, and what happens after the mains were away, are no matter of the library."""
    bench = Bench()
    bench.drive.survey.ask()
    asked = asked_for(bench)
    assert asked[:3] == [(2009, 0), (50, 0), (51, 1)]
    assert asked[3:] == [
        (700, 0), (1000, 0), (2000, 0), (1080, 0), (1082, 0), (2014, 0), (2019, 0), (2019, 1),
        (719, 0), (840, 0), (1070, 0), (2200, 0),
    ]  # fmt: skip
    bench.end()


def test_a_start_that_could_not_ask_leaves_nothing_known():
    bench = Bench()
    survey = bench.drive.survey
    assert survey.known_scale().reference_hertz == 50.0
    bench.motor().stale_replies = 10_000
    refusal(TimedOut, survey.ask)
    bench.motor().stale_replies = 0
    bench.motor().write(2000, 0, 100.0)
    assert survey.known_scale().reference_hertz == 100.0
    bench.end()


def test_what_a_drive_told_before_is_not_kept_when_it_tells_it_no_more():
    bench = Bench()
    survey = bench.drive.survey
    survey.ask()
    assert survey.off_time_ms() == 2_000
    bench.drive.family = with_row(SUPERVISION, (1999, 0, WORD, 0))
    survey.ask()
    assert survey.values[SUPERVISION] == UNKNOWN and survey.off_time_ms() is None
    bench.end()


def test_a_jog_needs_no_scale():
    mute = {2013: 0, 1058: 5.0, 1060: 1.0}
    bench = Bench(parameters=mute, layout=Layout(0, 2), unsupervised=True)
    assert "scale=Scale" in refusal(NotStarted, bench.drive.run, percent=10)
    bench.drive.jog_right()
    assert bench.drive.is_running
    bench.end()


def test_a_limit_holds_in_either_direction():
    bench = Bench(parameters={2014: 2_000, 1080: 5.0, 1082: 40.0, 1120: 1.0})
    assert "5.00 Hz" in refusal(ValueError, bench.drive.run, -4.0)
    assert "40.00 Hz" in refusal(ValueError, bench.drive.run, -41.0)
    for hertz in (-5.0, -40.0):
        bench.drive.run(hertz)
    bench.end()
