# SPDX-License-Identifier: MIT
"""The simulated drive on the line: what it takes for a telegram, when it answers and gives up.

Section numbers are those of the USS specification (E20125-D0001-S302-A1-7600, "SPEC").
"""

from drive_bench import ACKNOWLEDGE, HALF, OFF1, RUN, Bench, telegram

# --- receiving: SPEC, A-6 ----------------------------------------------------------


def test_every_single_bit_error_meets_silence_and_starts_nothing():
    # SPEC. The telegram would start the motor.
    bench = Bench()
    bench.control(OFF1)
    good = telegram(1, 0, 0, 0, 0, RUN, HALF)
    for place in range(len(good)):
        for bit in range(8):
            bad = bytearray(good)
            bad[place] ^= 1 << bit
            assert bench.ask(bad) is None, (place, bit)
    assert bench.drive.state == "ready" and bench.drive.starts == 0
    # r2029 start, r2031 length: 8 each. r2030 BCC: the rest, but for the 6 of the ADR that made it
    # a telegram for somebody else.
    assert bench.counters() == [1, 122, 0, 0, 0, 8, 106, 8]
    assert bench.ask(good) is not None and bench.drive.starts == 1


def test_a_bcc_without_the_stx_meets_silence():
    # The mistake seen most in the field: SPEC counts the STX.
    bench = Bench()
    bad = bytearray(telegram(1, 0, 0, 0, 0, OFF1, 0))
    bad[-1] ^= 2
    assert bench.ask(bad) is None
    assert bench.drive.read(2030) == 1


def test_a_telegram_starts_after_two_characters_of_silence():
    # SPEC, at every rate a panel is used with.
    for baud in (1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200):
        bench = Bench(baud=baud)
        request = telegram(1, 0, 0, 0, 0, OFF1, 0)
        foreign = telegram(2, 0, 0, 0, 0, OFF1, 0)
        bench.send(foreign)
        bench.send(request, bench.wire.start_interval_us)
        bench.wait(1)
        assert len(bench.heard) == 1, baud
        bench.send(foreign)
        bench.send(request, bench.wire.character_us)  # too early: not a start, only noise
        bench.send(request, bench.wire.character_us)  # and the line has not been idle since
        bench.wait(1)
        assert len(bench.heard) == 1, baud
        assert bench.drive.read(2029) == 1  # counted once
        assert bench.ask(request)


def test_a_telegram_inside_another_ones_data_is_not_seen():
    # SPEC: 02h may stand anywhere, only the pause makes it a start.
    inner = telegram(1, 0, 0, 0, 0, RUN, HALF)
    words = [inner[i] << 8 | inner[i + 1] for i in range(0, 16, 2)]
    bench = Bench()
    bench.control(OFF1)
    assert bench.ask(telegram(2, *words)) is None
    assert bench.drive.state == "ready"


def test_gaps_are_allowed_up_to_half_the_compressed_time():
    # SPEC: 1.5 * (12 + 3) characters from the STX on; 4296 us of gaps at 19200 bit/s.
    request = telegram(1, 0, 0, 0, 0, OFF1, 0)
    for place in range(1, 16):
        for gap_us, answered in ((4290, True), (4310, False)):
            bench = Bench()
            bench.send(request[:place])
            bench.send(request[place:], gap_us)
            bench.wait(0.05)
            assert bool(bench.heard) == answered, (place, gap_us)
            assert bench.ask(request)


def test_gaps_in_a_telegram_of_variable_length():
    # SPEC A-5.2.1.2: the time follows from what LGE says.
    request = telegram(1, 0, 0, 0, OFF1, 0)  # 10 net characters: 6.5 characters of gaps
    for place, gap_us, answered in (
        (1, 3700, True), (2, 3700, True), (2, 3750, False), (9, 3700, True), (9, 3750, False),
    ):  # fmt: skip
        bench = Bench({2013: 127})
        bench.send(request[:place])
        bench.send(request[place:], gap_us)
        bench.wait(0.3)
        assert bool(bench.heard) == answered, (place, gap_us)
        assert bench.ask(request)


def test_behind_a_telegram_that_took_too_long_a_pause_is_needed():
    bench = Bench()
    request = telegram(1, 0, 0, 0, 0, OFF1, 0)
    bench.send(request[:8])
    bench.send(request[8:], 5000)
    bench.send(request, 300)
    bench.wait(0.1)
    assert bench.heard == [] and bench.counters() == [0] * 8  # no counter shows residual time
    assert bench.ask(request)


def test_a_telegram_may_come_in_character_by_character():
    request = telegram(1, 0, 0, 0, 0, OFF1, 0)
    bench = Bench()
    bench.send(request[:1])
    for place in range(1, 16):
        bench.send(request[place : place + 1], 280)
    bench.wait(0.05)
    assert len(bench.heard) == 1


def test_lge_has_to_fit_the_layout():
    # SPEC, C-7: request and reply have the same, fixed length.
    bench = Bench()
    for lge in range(256):
        if lge != 14:
            bad = bytearray(telegram(1, 0, 0, 0, 0, OFF1, 0))
            bad[1] = lge
            bad[-1] ^= lge ^ 14
            assert bench.ask(bad) is None
    assert bench.counters() == [0, 255, 0, 0, 0, 0, 0, 255]
    for words in (4, 5, 7, 8):
        assert bench.ask(telegram(1, *[0] * words)) is None


def test_telegrams_of_others_are_not_counted():
    # The specification does not say; other layouts on the same bus would raise the length counter.
    bench = Bench()
    for others in (telegram(2, 0, 0, 0, 0, OFF1, 0), telegram(3, OFF1, 0), telegram(0x85, 1)):
        assert bench.ask(others) is None
    assert bench.counters() == [0] * 8


def test_characters_behind_a_telegram_are_noise():
    bench = Bench()
    assert bench.ask(telegram(1, 0, 0, 0, 0, OFF1, 0) + b"\x02\x0e")
    assert bench.counters() == [1, 1, 0, 0, 0, 1, 0, 0]


def test_two_talkers_at_once_meet_silence():
    bench = Bench()

    class Intruder:
        name = "intruder"

        def hear(self, burst):
            pass

    intruder = Intruder()
    bench.wire.attach(intruder)
    request = telegram(1, 0, 0, 0, 0, OFF1, 0)
    bench.clock.advance(5000)
    bench.wire.talk(bench, request, 16)
    bench.clock.advance(6000)
    bench.wire.talk(intruder, request, 16)
    bench.wait(0.05)
    assert bench.drive.read(2024) == 0 and bench.drive.read(2025) >= 1
    assert bench.ask(request)


def test_at_another_baud_rate_everything_is_a_frame_error():
    # One for each time that the line was idle, by the drive's own rate.
    bench = Bench({2010: 6})  # 9600 on a line of 19200
    for count in range(1, 6):
        bench.wait(0.01)
        assert bench.ask(telegram(1, 0, 0, 0, 0, OFF1, 0)) is None
        assert bench.counters() == [0, count, count, 0, 0, 0, 0, 0]
    bench.send(telegram(1, 0, 0, 0, 0, OFF1, 0))
    bench.send(telegram(1, 0, 0, 0, 0, OFF1, 0))  # no pause for a drive at half the rate
    assert bench.drive.read(2026) == 6
    bench.drive.write(2010, 0, 7)
    assert bench.ask(telegram(1, 0, 0, 0, 0, OFF1, 0))


def test_the_error_status_word_tells_what_went_wrong_since_the_last_good_telegram():
    # SPEC, item 4.
    good = telegram(1, 0, 0, 0, 0, OFF1, 0)
    bench = Bench({2014: 200})
    for bad, status in (
        (b"\x03", 0x08), (good[:-1] + b"\x00", 0x10), (b"\x02\x03\x01\x00", 0x40),
        (good[:9], 0x20),
    ):  # fmt: skip
        bench.ask(good)
        assert bench.drive.error_status == 0
        bench.send(bad)
        bench.wait(0.05)
        assert bench.drive.error_status == status, bad
    bench.wait(1)
    assert bench.drive.error_status == 0xA0, "the telegram failure time as well"
    assert bench.drive.watchdog_errors == 1 and bench.drive.residual_time_errors == 1


def test_a_telegram_that_never_ends_is_counted_when_its_time_is_over():
    bench = Bench()
    bench.send(telegram(1, 0, 0, 0, 0, OFF1, 0)[:9])  # 12,891 us from the STX on
    bench.clock.advance(8_300)
    assert bench.drive.residual_time_errors == 0
    bench.clock.advance(200)
    assert bench.drive.residual_time_errors == 1


def test_the_reply_comes_after_three_characters():
    # Measured on a MICROMASTER 420: 13.8 ms at 2400 bit/s (S4). SPEC allows 2 characters to 20 ms.
    for baud in (2400, 9600, 19200, 115200):
        bench = Bench(baud=baud)
        bench.send(telegram(1, 0, 0, 0, 0, OFF1, 0))
        asked_us = bench.clock.now_us
        bench.wait(1)
        delay_us = bench.heard[0][0] - asked_us
        assert 33_000_000 / baud <= delay_us <= 33_000_000 / baud + 1
        assert bench.wire.violations() == []


def test_the_reply_delay_can_be_set():
    bench = Bench()
    for delay_us in (1200, 19_900, 25_000):  # the last one breaks the specification's 20 ms
        bench.drive.reply_delay_us = delay_us
        del bench.heard[:]
        bench.send(telegram(1, 0, 0, 0, 0, OFF1, 0))
        asked_us = bench.clock.now_us
        bench.wait(0.1)
        assert bench.heard[0][0] == asked_us + delay_us


def test_a_mirror_telegram_comes_back_and_does_nothing():
    # SPEC. It would start the motor and write P0700.
    bench = Bench()
    bench.control(OFF1)
    mirror = telegram(0x41, 0x22BC, 0, 0, 2, RUN, HALF)
    assert bench.ask(mirror) == mirror
    assert bench.drive.state == "ready" and bench.drive.read(700) == 5
    assert bench.ask(telegram(0x42, 0, 0, 0, 0, RUN, HALF)) is None
    assert bench.counters()[:2] == [2, 0]


def test_each_address_answers_to_itself_only():
    # SPEC: 0 to 31; 0 is an address like any other.
    for address in (0, 1, 5, 31):
        bench = Bench(address=address)
        for adr in range(256):
            answered = bench.ask(telegram(adr, 0, 0, 0, 0, OFF1, 0)) is not None
            assert answered == (adr in (address, address | 0x40)), (address, adr)


# --- broadcast: SPEC A-3 and appendix ---------------------------------------------------------


def test_a_broadcast_changes_what_its_enable_array_names():
    bench = Bench()
    bench.control(OFF1, 0x1000)
    steps = (
        # SPB1: the main setpoint for all, nothing else
        ((0x0005, 0, 0, 0, 0x0000, 0x2000), 0x047E, 0x2000),
        # flag bit a.0 missing: not for anybody
        ((0x0006, 0xFFFF, 0, 0, 0x047F, 0x3000), 0x047E, 0x2000),
        # V54: enables nothing
        ((0x0000, 0, 0, 0, 0x047F, 0x3000), 0x047E, 0x2000),
        # V55: the whole control word and the setpoint
        ((0x0007, 0xFFFF, 0, 0, 0x047F, 0x1000), 0x047F, 0x1000),
        # bit 5 alone: ramps held at the same instant
        ((0x0003, 0x0020, 0, 0, 0x0000, 0x0000), 0x045F, 0x1000),
        # SPB2: ramps released
        ((0x0003, 0x0020, 0, 0, 0x0020, 0x0000), 0x047F, 0x1000),
        # V17: OFF1 for all
        ((0x0003, 0x0001, 0, 0, 0x047E, 0x0000), 0x047E, 0x1000),
        # V53: OFF2 for all
        ((0x0003, 0x0002, 0, 0, 0x047C, 0x0000), 0x047C, 0x1000),
    )
    for words, stw, hsw in steps:
        assert bench.ask(telegram(0x20, *words)) is None
        assert [bench.drive.read(2018, i) for i in (0, 1)] == [stw, hsw], words
    assert bench.drive.starts == 1


def test_a_broadcast_is_never_a_parameter_task():
    bench = Bench()
    bench.ask(telegram(0x20, 0x22BD, 0, 0, 2, OFF1, 0))
    assert bench.task(0)[0] == 0
    assert bench.drive.read(700) == 5
    assert bench.drive.read(2024) == 2  # but it counts as a good telegram


def test_a_broadcast_needs_four_parameter_words():
    bench = Bench({2013: 0})
    bench.ask(telegram(1, OFF1, 0))
    bench.ask(telegram(0x20, 0x0007, 0xFFFF))
    assert bench.drive.read(2018, 0) == OFF1


# --- telegram failure time: SPEC C-3.1, P2014 -------------------------------------------------


def test_telegram_failure_trips_and_coasts():
    bench = Bench({2014: 200})
    bench.wait(1)
    assert bench.drive.state == "inhibited"  # it waits for the first telegram
    bench.control(OFF1)
    bench.control(RUN, HALF)
    for _ in range(30):
        bench.wait(0.15)
        bench.control(RUN, HALF)
    assert bench.drive.hz() > 10
    bench.send(telegram(1, 0, 0, 0, 0, RUN, HALF))
    bench.clock.advance(199_999)
    assert bench.drive.state == "running"
    bench.clock.advance(1)
    assert bench.drive.state == "fault" and bench.drive.read(947, 0) == 72
    hz = bench.drive.hz()
    bench.wait(0.5)
    assert 0 < bench.drive.hz() < hz
    # The line comes back: nothing starts by itself.
    for _ in range(5):
        assert bench.control(RUN, HALF)[0] & 0xFF == 0x78
    bench.control(ACKNOWLEDGE)
    assert bench.control(OFF1)[0] & 0xFF == 0x31
    assert bench.drive.starts == 1


def test_only_a_telegram_for_it_retriggers_the_supervision():
    bench = Bench({2014: 100})
    good = telegram(1, 0, 0, 0, 0, OFF1, 0)
    bad = good[:-1] + b"\x00"
    for last, trips in (
        (good, False), (telegram(0x41, 0, 0, 0, 0, OFF1, 0), False),
        (telegram(0x20, 0, 0, 0, 0, OFF1, 0), False), (bad, True),
        (telegram(2, 0, 0, 0, 0, OFF1, 0), True),
    ):  # fmt: skip
        bench.drive.power_off()
        bench.drive.power_on()
        bench.ask(good)
        bench.wait(0.06)
        bench.send(last)
        bench.wait(0.06)
        assert (bench.drive.state == "fault") == trips, last


def test_supervision_follows_its_parameter():
    bench = Bench()
    bench.control(OFF1)
    bench.wait(100)
    assert bench.drive.state == "ready"  # 0: off
    bench.task(0x200E, 0x8000, 0, 500)  # P2014 = 500 ms over the bus: counts from that telegram on
    bench.wait(0.6)
    assert bench.drive.read(947, 0) == 72
    bench.control(ACKNOWLEDGE)
    bench.control(OFF1)
    bench.drive.write(2014, 0, 0)
    bench.wait(100)
    assert bench.drive.state == "ready"


# --- the connector ----------------------------------------------------------------------------


def test_unplugged_it_goes_on_as_it_was_told():
    bench = Bench()
    bench.run()
    bench.drive.unplug()
    assert bench.ask(telegram(1, 0, 0, 0, 0, OFF1, 0)) is None
    bench.wait(100)
    assert bench.drive.hz() == 25 and not bench.drive.plugged
    bench.drive.plug()
    assert bench.control(OFF1)[0] & 0xFF == 0x34
    bench = Bench({2014: 500})
    bench.run(seconds=0.4)
    bench.drive.unplug()
    bench.wait(1)
    assert bench.drive.state == "fault"


def test_pulling_the_plug_cuts_the_reply():
    bench = Bench()
    bench.send(telegram(1, 0, 0, 0, 0, OFF1, 0))
    bench.clock.advance(5000)
    bench.drive.unplug()
    bench.wait(0.1)
    assert len(bench.heard[0][1]) == 5  # 3 characters of delay, then what went out in 3282 us
    bench.drive.plug()
    bench.drive.plug()
    assert bench.ask(telegram(1, 0, 0, 0, 0, OFF1, 0))
