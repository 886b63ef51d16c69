# SPDX-License-Identifier: MIT
"""Data sheet of the simulated line: characters to the microsecond, and the rules of the line."""

from boards.sim.chip.machine import heap_lock, heap_unlock
from boards.sim.clock import Clock, Event
from boards.sim.line.wire import GARBLE, LOG_CHARACTERS, LOG_TELEGRAMS, VIOLATION_LIMIT, Wire

INTERPRETERS = "unix64 unix32 cpython"  # what takes no heap depends on the size of integers

TELEGRAM = bytes(range(0x10, 0x20))  # 16 characters
BAUD_RATES = (1200, 2400, 4800, 9600, 19200, 38400, 57600, 76800, 93750, 115200, 187500)


class Station:
    """Notes what it hears, and the beginning of it."""

    def __init__(self, wire, name):
        self.name = name
        self.clock = wire.clock
        self.heard = []
        self.begun = []
        wire.attach(self)

    def watch(self, burst):
        self.begun.append(self.clock.now_us)

    def hear(self, burst):
        self.heard.append((self.clock.now_us, bytes(burst.data[: burst.count])))


class Panel(Station):
    has_driver_enable = True
    is_panel = True


class Listener:
    """A station with nothing but ears."""

    def __init__(self):
        self.count = 0

    def hear(self, burst):
        self.count += burst.count


def line(baud=19200, station=Station):
    clock = Clock()
    wire = Wire(clock, baud)
    return clock, wire, station(wire, "one"), Station(wire, "two")


def panel_line(baud=19200):
    return line(baud, Panel)


def at(clock, at_us, function, *arguments):
    """Call `function` at that instant, while the clock is being advanced."""
    clock.schedule(Event(lambda: function(*arguments)), at_us)


def spoilt(characters, first=0):
    """What a collision makes of them, behind `first` others of the telegram."""
    return bytes(one ^ GARBLE[first + at] for at, one in enumerate(characters))


def refused(error, function, *arguments):
    try:
        function(*arguments)
    except error:
        return True
    return False


# Characters


def test_a_character_is_eleven_bits():
    for baud in BAUD_RATES:
        wire = Wire(Clock(), baud)
        for i in range(256):
            assert wire.ends[i] == (i + 1) * 11_000_000 // baud
        assert wire.character_us - 1 < 11_000_000 / baud <= wire.character_us
        assert wire.start_interval_us - 1 < 22_000_000 / baud <= wire.start_interval_us


def test_a_burst_takes_its_characters_and_nothing_more():
    clock, wire, one, two = line(19200)
    burst = wire.talk(one, TELEGRAM, 16)
    assert (burst.start_us, burst.end_us) == (0, 9166)  # 16 * 11 / 19200 s
    clock.advance(9165)
    assert two.heard == []
    clock.advance(1)
    assert two.begun == [0]
    assert two.heard == [(9166, TELEGRAM)]


def test_a_character_has_arrived_when_its_stop_bit_is_over():
    for baud in BAUD_RATES:
        clock, wire, one, _ = line(baud)
        clock.advance(777)
        burst = wire.talk(one, bytes(256), 256)
        for i in range(256):
            end_us = 777 + wire.ends[i]
            assert burst.arrived(end_us - 1) == i
            assert burst.arrived(end_us) == i + 1
        assert burst.arrived(777) == 0
        assert burst.arrived(burst.end_us + 10**9) == 256


def test_its_exclusive_or_is_that_of_its_characters_whatever_was_said_before():
    clock, wire, one, _ = line()
    for said, check in (
        (b"\x01\x02\x04", 0x07),
        (b"\x01\x02\x04", 0x07),
        (b"\x01\x02\x08", 0x0B),
        (b"\x01\x02", 0x03),
        (b"\x01\x02\x08", 0x0B),
        (b"\x01\x02\x08\x00\x10", 0x1B),
        (b"\x01\x02\x08\x00", 0x0B),
    ):
        burst = wire.talk(one, said, len(said))
        assert burst.exclusive_or() == check, said
        clock.advance(10_000)


def test_everybody_but_the_talker_hears():
    clock, wire, one, two = line()
    three = Listener()
    wire.attach(three)
    wire.talk(two, TELEGRAM, 5)
    clock.advance(10_000)
    assert one.heard == [(2864, TELEGRAM[:5])]
    assert two.heard == [] and two.begun == []
    assert three.count == 5


def test_characters_written_while_the_burst_goes_on_follow_without_a_gap():
    clock, wire, one, two = line()
    first = wire.talk(one, TELEGRAM, 4)
    clock.advance(1000)
    assert wire.talk(one, TELEGRAM[4:], 12) is first
    assert first.end_us == wire.ends[15]
    clock.advance(20_000)
    assert two.heard == [(9166, TELEGRAM)]
    assert wire.violations() == []


def test_a_prolonged_telegram_keeps_its_driver_enabled_for_longer():
    clock, wire, panel, two = panel_line()
    wire.drive(panel, True)
    wire.talk(panel, TELEGRAM, 4)
    wire.talk(panel, TELEGRAM, 4)
    clock.advance(wire.ends[7])
    wire.drive(panel, False)
    assert wire.violations() == [] and two.heard == [(4583, TELEGRAM[:4] + TELEGRAM[:4])]


def test_a_burst_has_1_to_260_characters():
    clock, wire, one, _ = line()
    assert refused(ValueError, wire.talk, one, TELEGRAM, 0)
    assert refused(ValueError, wire.talk, one, bytes(261), 261)
    wire.talk(one, bytes(260), 260)
    assert refused(ValueError, wire.talk, one, TELEGRAM, 0)
    assert refused(ValueError, wire.talk, one, TELEGRAM, 1)


# Coming and going


def test_a_silenced_station_has_sent_the_characters_that_were_complete():
    clock, wire, one, two = line()
    burst = wire.talk(one, TELEGRAM, 16)
    clock.advance(wire.ends[4] + 100)
    wire.silence(one)
    assert (burst.count, burst.end_us) == (5, clock.now_us)
    assert two.heard == [(clock.now_us, TELEGRAM[:5])]
    clock.advance(20_000)
    assert len(two.heard) == 1
    assert wire.log.last(9) == [(0, False, TELEGRAM[:5])]


def test_a_burst_cut_in_its_first_character_is_heard_by_nobody():
    clock, wire, one, two = line()
    wire.talk(one, TELEGRAM, 16)
    clock.advance(wire.ends[0] - 1)
    wire.silence(one)
    clock.advance(20_000)
    assert two.heard == [] and wire.log.last(9) == []


def test_the_silence_after_a_cut_begins_with_the_cut():
    clock, wire, one, two = line()
    wire.talk(one, TELEGRAM, 16)
    clock.advance(1000)
    wire.silence(one)
    clock.advance(1100)
    wire.talk(two, TELEGRAM, 16)
    assert wire.violations() == [
        "at 2100: two talks after 1100 us of silence, the start interval is 1146 us"
    ]


def test_a_station_without_a_plug_neither_hears_nor_reaches_anybody():
    clock, wire, one, two = line()
    wire.detach(two)
    wire.detach(two)
    wire.talk(one, TELEGRAM, 16)
    clock.advance(20_000)
    assert wire.talk(two, TELEGRAM, 16) is None
    wire.silence(two)
    clock.advance(20_000)
    assert two.heard == [] and one.heard == []
    wire.attach(two)
    wire.talk(one, TELEGRAM, 3)
    clock.advance(20_000)
    assert two.heard == [(40_000 + 1718, TELEGRAM[:3])]


def test_pulling_the_plug_cuts_what_is_being_sent():
    clock, wire, one, two = line()
    wire.talk(one, TELEGRAM, 16)
    clock.advance(wire.ends[9])
    wire.detach(one)
    clock.advance(20_000)
    assert two.heard == [(wire.ends[9], TELEGRAM[:10])]


def test_who_is_plugged_in_during_a_burst_hears_from_the_next_one_on():
    clock, wire, one, two = line()
    wire.talk(one, TELEGRAM, 16)
    clock.advance(1000)
    late = Station(wire, "late")
    clock.advance(20_000)
    assert len(two.heard) == 1 and late.heard == []
    wire.talk(one, TELEGRAM, 16)
    clock.advance(20_000)
    assert len(late.heard) == 1


def test_a_station_is_attached_once():
    _, wire, one, _ = line()
    assert refused(ValueError, wire.attach, one)


# The start interval: two characters of silence before a telegram


def test_the_first_telegram_may_come_at_once():
    _, wire, one, _ = line()
    burst = wire.talk(one, TELEGRAM, 16)
    assert wire.violations() == [] and burst.silence_us == 1_000_000


def test_two_characters_of_silence_are_enough_and_less_is_a_violation():
    for baud in BAUD_RATES:
        for silence_us, kept in (
            (22_000_000 // baud, True),  # may be short by the rounding of the instants
            (-(-22_000_000 // baud) - 2, False),
        ):
            clock, wire, one, two = line(baud)
            wire.talk(one, TELEGRAM, 16)
            clock.advance(wire.ends[15] + silence_us)
            burst = wire.talk(two, TELEGRAM, 16)
            assert burst.silence_us == silence_us
            assert (wire.violations() == []) == kept
            assert wire.violation_count() == (0 if kept else 1)


def test_a_short_silence_is_reported_with_instant_station_and_figure():
    clock, wire, one, two = line(9600)
    wire.talk(one, TELEGRAM, 16)
    clock.advance(20_000)
    wire.talk(two, TELEGRAM, 16)
    assert wire.violations() == [
        "at 20000: two talks after 1667 us of silence, the start interval is 2292 us"
    ]


# One talker at a time


def test_two_talkers_garble_each_other():
    clock, wire, one, two = line()
    three = Station(wire, "three")
    first = wire.talk(one, TELEGRAM, 16)
    clock.advance(wire.ends[9])
    second = wire.talk(two, TELEGRAM, 4)
    assert first.garbled and second.garbled
    clock.advance(20_000)
    # What had arrived before the collision was good.
    one_heard = TELEGRAM[:10] + spoilt(TELEGRAM[10:], 10)
    two_heard = spoilt(TELEGRAM[:4])
    assert three.heard == [(5729 + 2291, two_heard), (9166, one_heard)]
    assert one.heard == three.heard[:1] and two.heard == three.heard[1:]
    assert wire.violations() == [
        "at 5729: two talks while one talks, 3437 us before the end of its last stop bit"
    ]


def test_a_third_talker_mends_nothing():
    clock, wire, one, two = line()
    three = Station(wire, "three")
    wire.talk(one, TELEGRAM, 16)
    clock.advance(100)
    wire.talk(two, TELEGRAM, 16)
    clock.advance(100)
    wire.talk(three, TELEGRAM, 16)
    wire.talk(three, TELEGRAM, 1)
    clock.advance(20_000)
    assert one.heard == [
        (100 + 9166, spoilt(TELEGRAM)),
        (200 + 9739, spoilt(TELEGRAM + TELEGRAM[:1])),
    ]
    assert wire.violation_count() == 2


def test_no_piece_of_a_collision_cancels_out_in_the_bcc():
    for first in range(255):
        check = 0
        for at in range(first, 255):
            check ^= GARBLE[at]
            assert check, (first, at)


def test_a_burst_after_a_collision_is_clean():
    clock, wire, one, two = line()
    wire.talk(one, TELEGRAM, 16)
    wire.talk(two, TELEGRAM, 16)
    clock.advance(20_000)
    assert not wire.talk(two, TELEGRAM, 16).garbled
    clock.advance(20_000)
    assert one.heard[-1][1] == TELEGRAM
    assert wire.violation_count() == 1


def test_who_starts_at_the_very_end_of_a_burst_does_not_collide():
    # Whether or not the burst's own event comes first: the silence is short, nothing is garbled.
    for early in (False, True):
        clock, wire, one, two = line()
        if early:
            at(clock, 9166, wire.talk, two, TELEGRAM, 16)
        wire.talk(one, TELEGRAM, 16)
        if not early:
            at(clock, 9166, wire.talk, two, TELEGRAM, 16)
        clock.advance(30_000)
        assert two.heard == [(9166, TELEGRAM)] and one.heard == [(18332, TELEGRAM)]
        assert wire.violations() == [
            "at 9166: two talks after 0 us of silence, the start interval is 1146 us"
        ]


def test_who_goes_on_at_the_very_end_of_its_own_burst_begins_another_one():
    clock, wire, one, two = line()
    at(clock, 9166, wire.talk, one, TELEGRAM, 3)
    wire.talk(one, TELEGRAM, 16)
    clock.advance(30_000)
    assert two.heard == [(9166, TELEGRAM), (9166 + 1718, TELEGRAM[:3])]
    assert wire.violation_count() == 1 and wire.log.count == 2


# The driver enable of a station that has one


def test_a_driver_that_is_on_for_its_telegram_only_breaks_no_rule():
    for spare_us in (0, 573):  # one character at 19200 baud
        clock, wire, panel, two = panel_line()
        wire.drive(panel, True)
        clock.advance(spare_us)
        wire.talk(panel, TELEGRAM, 16)
        clock.advance(9166 + spare_us)
        wire.drive(panel, False)
        clock.advance(100_000)
        assert wire.violations() == []
        assert two.heard == [(9166 + spare_us, TELEGRAM)]


def test_a_driver_may_go_off_at_the_very_end_of_the_last_stop_bit():
    # Whether or not the burst's own event comes first.
    for early in (False, True):
        clock, wire, panel, two = panel_line()
        wire.drive(panel, True)
        if early:
            at(clock, 9166, wire.drive, panel, False)
        wire.talk(panel, TELEGRAM, 16)
        if not early:
            at(clock, 9166, wire.drive, panel, False)
        clock.advance(20_000)
        assert wire.violations() == [] and two.heard == [(9166, TELEGRAM)]


def test_characters_sent_without_the_driver_do_not_reach_the_line():
    clock, wire, panel, two = panel_line()
    clock.advance(50_000)
    burst = wire.talk(panel, TELEGRAM, 16)
    assert burst.end_us == 59_166  # for the UART they are sent all the same
    wire.talk(panel, TELEGRAM, 1)
    wire.drive(panel, True)
    clock.advance(500)
    wire.drive(panel, False)
    clock.advance(20_000)
    assert two.heard == [] and two.begun == [] and wire.log.last(9) == []
    assert wire.violations() == [
        "at 50000: one talks with its driver disabled, 9166 us of characters are lost"
    ]


def test_a_driver_that_goes_off_too_early_cuts_the_telegram():
    clock, wire, panel, two = panel_line()
    wire.drive(panel, True)
    wire.talk(panel, TELEGRAM, 16)
    clock.advance(9165)
    wire.drive(panel, False)
    clock.advance(20_000)
    assert two.heard == [(9165, TELEGRAM[:15])]
    assert wire.violations() == [
        "at 9165: one disables its driver 1 us before the end of its last stop bit"
    ]


def test_a_driver_that_goes_off_more_than_a_character_late_is_a_violation():
    clock, wire, panel, _ = panel_line()
    for _ in range(2):
        wire.drive(panel, True)
        wire.talk(panel, TELEGRAM, 16)
        clock.advance(9166 + 574)
        wire.drive(panel, False)
        clock.advance(260)
        wire.drive(panel, True)
        clock.advance(573)
        wire.drive(panel, False)
        clock.advance(9427)
    assert wire.violations() == [
        "at 9740: one has its driver enabled 574 us after its last stop bit, allowed are 573 us",
        "at 29740: one has its driver enabled 574 us after its last stop bit, allowed are 573 us",
    ]


def test_a_driver_that_comes_on_more_than_a_character_early_is_a_violation():
    clock, wire, panel, _ = panel_line()
    wire.drive(panel, True)
    clock.advance(574)
    wire.talk(panel, TELEGRAM, 16)
    clock.advance(9166 + 1000)
    wire.drive(panel, False)
    assert wire.violations() == [
        "at 574: one has its driver enabled 574 us before the first start bit, allowed are 573 us",
        "at 10740: one has its driver enabled 1000 us after its last stop bit, allowed are 573 us",
    ]


def test_a_driver_that_stays_on_is_found_when_somebody_looks():
    clock, wire, panel, _ = panel_line()
    wire.drive(panel, True)
    clock.advance(573)
    assert wire.violations() == []
    clock.advance(1)
    assert wire.violations() == ["at 574: one has its driver enabled for 574 us without sending"]
    clock.advance(1000)
    wire.drive(panel, False)
    assert wire.violation_count() == 1  # the same breach is noted once
    wire.drive(panel, True)
    clock.advance(574)
    wire.drive(panel, False)
    assert wire.violation_count() == 2


def test_a_driver_that_is_on_garbles_what_others_send():
    clock, wire, panel, two = panel_line()
    clock.advance(5000)
    wire.drive(panel, True)
    wire.talk(panel, TELEGRAM, 16)
    clock.advance(9166 + 1200)
    wire.talk(two, TELEGRAM, 16)
    clock.advance(1000)
    wire.drive(panel, False)
    clock.advance(20_000)
    assert panel.heard == [(15366 + 9166, spoilt(TELEGRAM))]
    assert wire.violations() == [
        "at 15366: two talks while one holds its driver enabled, since 10366 us",
        "at 16366: one has its driver enabled 2200 us after its last stop bit, allowed are 573 us",
    ]


def test_a_driver_that_comes_on_while_another_talks_garbles_the_rest():
    clock, wire, panel, two = panel_line()
    wire.talk(two, TELEGRAM, 16)
    clock.advance(wire.ends[11])
    wire.drive(panel, True)
    clock.advance(100)
    wire.drive(panel, False)
    clock.advance(20_000)
    assert panel.heard == [(9166, TELEGRAM[:12] + spoilt(TELEGRAM[12:], 12))]
    assert wire.violations() == [
        "at 6875: one enables its driver while two talks, 2291 us before its end"
    ]


def test_a_driver_that_comes_on_at_the_very_end_of_a_burst_garbles_nothing():
    # Whether or not the burst's own event comes first.
    for early in (False, True):
        clock, wire, panel, two = panel_line()
        if early:
            at(clock, 9166, wire.drive, panel, True)
        wire.talk(two, TELEGRAM, 16)
        if not early:
            at(clock, 9166, wire.drive, panel, True)
        clock.advance(9500)
        wire.drive(panel, False)
        assert panel.heard == [(9166, TELEGRAM)] and wire.violations() == []


def test_a_driver_is_not_needed_after_a_cut():
    clock, wire, panel, _ = panel_line()
    wire.drive(panel, True)
    wire.talk(panel, TELEGRAM, 16)
    clock.advance(3000)
    wire.silence(panel)
    clock.advance(574)
    wire.drive(panel, False)
    assert wire.violation_count() == 1


def test_a_reset_in_the_middle_of_a_telegram_breaks_no_rule():
    clock, wire, panel, two = panel_line()
    wire.drive(panel, True)
    wire.talk(panel, TELEGRAM, 16)
    clock.advance(3000)
    wire.silence(panel)
    wire.drive(panel, False)
    clock.advance(20_000)
    assert two.heard == [(3000, TELEGRAM[:5])] and wire.violations() == []


# The books


def test_the_first_100_violations_are_told_and_all_are_counted():
    clock, wire, one, _ = line()
    for _ in range(VIOLATION_LIMIT + 51):
        wire.talk(one, TELEGRAM, 1)
        clock.advance(600)
    assert wire.violation_count() == VIOLATION_LIMIT + 50
    assert len(wire.violations()) == VIOLATION_LIMIT
    assert wire.violations()[0].startswith("at 600: one talks after 28 us of silence")
    assert wire.violations()[-1].startswith("at 60000: ")


def test_the_log_tells_the_last_telegrams_and_who_sent_them():
    clock, wire, panel, two = panel_line()
    assert wire.log.last(5) == []
    wire.drive(panel, True)
    wire.talk(panel, b"\x02\x03\x04", 3)
    clock.advance(1718)
    wire.drive(panel, False)
    clock.advance(5000)
    wire.talk(two, TELEGRAM, 16)
    clock.advance(20_000)
    assert wire.log.last(1) == [(6718, False, TELEGRAM)]
    assert wire.log.last(5) == [(0, True, b"\x02\x03\x04"), (6718, False, TELEGRAM)]


def sent(number, length):
    return bytes((number * 7 + i) & 0xFF for i in range(length))


def test_the_log_keeps_1000_telegrams():
    clock, wire, one, _ = line()
    for number in range(LOG_TELEGRAMS + 500):
        wire.talk(one, sent(number, 16), 16)
        clock.advance(11_000)
    told = wire.log.last(5000)
    assert len(told) == LOG_TELEGRAMS
    for number in range(500, LOG_TELEGRAMS + 500):
        assert told[number - 500] == (number * 11_000, False, sent(number, 16))
    assert wire.log.last(3) == told[-3:]


def test_the_log_keeps_fewer_long_telegrams_but_never_a_wrong_one():
    clock, wire, one, _ = line(115200)
    for number in range(300):
        wire.talk(one, sent(number, 256), 256)
        clock.advance(30_000)
    told = wire.log.last(1000)
    kept = LOG_CHARACTERS // 256
    assert [entry[2] for entry in told] == [sent(n, 256) for n in range(300 - kept, 300)]


def test_talking_takes_no_heap_whatever_rule_it_breaks():
    clock = Clock()
    wire = Wire(clock, 19200)
    panel = Listener()
    panel.has_driver_enable = True
    other = Listener()
    wire.attach(panel)
    wire.attach(other)
    heap_lock()
    try:
        for _ in range(1200):
            wire.drive(panel, True)
            wire.talk(panel, TELEGRAM, 16)
            clock.advance(9166)
            wire.drive(panel, False)
            clock.advance(2000)
            wire.talk(other, TELEGRAM, 16)
            clock.advance(20_000)
        assert wire.violation_count() == 0
        wire.talk(panel, TELEGRAM, 16)
        clock.advance(100)
        wire.drive(panel, True)
        clock.advance(1000)
        wire.talk(other, TELEGRAM, 16)
        wire.silence(other)
        clock.advance(20_000)
        wire.talk(panel, TELEGRAM, 16)
        wire.talk(other, TELEGRAM, 16)
        wire.drive(panel, False)
        clock.advance(20_000)
    finally:
        heap_unlock()
    assert other.count == 1200 * 16 and panel.count == 1200 * 16 + 16
    assert len(wire.violations()) == 6


def test_the_line_works_past_the_small_integers_of_the_32_bit_build():
    clock, wire, one, two = line()
    start_us = (1 << 30) - 5000
    clock.advance(start_us)
    wire.talk(one, TELEGRAM, 16)
    clock.advance(20_000)
    wire.talk(two, TELEGRAM, 16)
    clock.advance(20_000)
    assert two.heard == [(start_us + 9166, TELEGRAM)]
    assert one.heard == [(start_us + 29166, TELEGRAM)]
    assert wire.log.last(2) == [(start_us, False, TELEGRAM), (start_us + 20_000, False, TELEGRAM)]
    assert wire.violations() == []
