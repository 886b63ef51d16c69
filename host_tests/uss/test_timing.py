# SPDX-License-Identifier: MIT
"""The times of the line (specification A-5.1.2, A-6; MICROMASTER operating instructions)."""

from uss.timing import BAUD_RATES, Timing, characters_us, elapsed

# bit/s, start interval in ms as the specification (table 5.1) or the MM420 manual prints it.
START_INTERVALS_MS = (
    (2400, 9.20), (4800, 4.60), (9600, 2.30), (19200, 1.15), (38400, 0.58), (57600, 0.38),
    (76800, 0.29), (93750, 0.24), (115200, 0.19), (187500, 0.12),
)  # fmt: skip

# bit/s, residual run time in ms for 4, 10, 12, 16 and 252 net characters: 1.5 (n + 3) characters.
RESIDUALS_MS = (
    (300, (385.0, 715.0, 825.0, 1045.0, 14025.0)),
    (2400, (48.13, 89.38, 103.1, 130.6, 1753.0)),
    (9600, (12.03, 22.34, 25.78, 32.66, 438.3)),
    (19200, (6.016, 11.17, 12.89, 16.33, 219.1)),
    (187500, (0.616, 1.144, 1.320, 1.672, 22.44)),
)


def test_the_start_interval_is_two_characters_as_the_manuals_print_it():
    for baud, printed_ms in START_INTERVALS_MS:
        start_us = Timing(baud).start_interval_us
        assert start_us == -(-22_000_000 // baud)
        assert abs(start_us / 1000 - printed_ms) < 0.04, baud


def test_the_residual_run_time_allows_half_as_much_again():
    for baud, printed in RESIDUALS_MS:
        line = Timing(baud)
        for net_count, printed_ms in zip((4, 10, 12, 16, 252), printed):
            # The figures count from the end of STX; the receiver counts from its beginning.
            residual_us = line.residual_us(net_count) - line.character_us
            assert abs(residual_us / 1000 / printed_ms - 1) < 0.001, (baud, net_count)


def test_a_telegram_of_16_characters_at_19200_takes_9_17_ms():
    assert Timing(19200).telegram_us(12) == characters_us(19200, 16) == 9167


def test_an_exchange_is_interval_request_delay_reply():
    line = Timing(19200)
    assert line.exchange_us(12, 1719) == 1146 + 9167 + 1719 + 9167


def test_a_round_waits_for_the_reply_that_does_not_come():
    """As behind a broadcast, and where a drive is off: until no reply can begin any more."""
    line = Timing(19200)
    answered_us, silent_us = 1146 + 9167 + 1719 + 9167, 9167 + 1146 + 20_000 + 573
    assert line.cycle_us(()) == 0 and line.cycle_us(((12, 0, None),)) == silent_us
    assert line.cycle_us(((12, 12, 1719), (12, 0, None))) == answered_us + silent_us


def test_only_the_rates_of_uss_are_taken():
    for baud in BAUD_RATES:
        Timing(baud)
    for baud in (0, 14400, 230400, None):
        try:
            Timing(baud)
        except ValueError:
            continue
        raise AssertionError("%r was accepted" % (baud,))


def test_time_goes_on_across_the_wrap():
    for bits in (16, 24, 30):
        mask = (1 << bits) - 1
        assert elapsed(5, mask - 4, mask) == 10
        assert elapsed(1000, 400, mask) == 600


def test_an_instant_that_is_still_to_come_has_not_passed():
    """An interrupt may note an instant after the loop has read its clock."""
    mask = (1 << 30) - 1
    assert elapsed(100, 103, mask) == 0
    assert elapsed(mask, 2, mask) == 0


def test_a_slow_line_waits_twice_the_pause_that_a_drive_must_keep():
    for baud, timeout_us in ((300, 146_668), (1200, 36_668), (2400, 20_000), (19200, 20_000)):
        line = Timing(baud)
        assert line.reply_timeout_us == timeout_us == max(20_000, 2 * line.start_interval_us)
    assert Timing(300, 200_000).reply_timeout_us == 200_000
    assert BAUD_RATES[:4] == (300, 600, 1200, 2400)
    assert len(set(BAUD_RATES)) == 13 and list(BAUD_RATES) == sorted(BAUD_RATES)
