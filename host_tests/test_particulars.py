# SPDX-License-Identifier: MIT
"""What a drive tells of itself before a start: when it is asked anew, what is never left out."""

from bus_bench import Bench, refusal
from uss.bus import NotStarted, TimedOut
from uss.scaling import Scale


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


def test_a_drive_that_does_not_say_what_it_is_asked_is_not_started():
    bench = Bench()
    bench.bus.wait(1)
    bench.motor().stale_replies = 10_000
    refusal(TimedOut, bench.drive.run, 10.0)
    assert bench.motor().starts == 0 and not bench.drive.wanted


def test_what_was_known_is_asked_anew_when_the_drive_was_away():
    bench = Bench()
    assert bench.drive.particulars.known_scale().reference_hertz == 50.0
    bench.motor().unplug()
    bench.bus.wait(2)
    bench.motor().write(2000, 0, 100.0)
    assert bench.drive.particulars.scale.reference_hertz == 50.0
    bench.motor().plug()
    bench.bus.wait(2)
    assert bench.drive.particulars.known_scale().reference_hertz == 100.0
    bench.end()
