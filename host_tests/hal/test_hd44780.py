# SPDX-License-Identifier: MIT
"""The display driver on the simulated controller: all is shown, nothing is written for nothing."""

import random

from boards.sim.chip.machine import heap_lock, heap_unlock
from boards.sim.clock import Clock
from hal.display.hd44780 import Hd44780
from lcd_bench import HOURGLASS, LOOP_US, READY, RUNNING, UP_AND_DOWN, LcdBench

REFRESH_MS = 8_000  # so often all is written anew
REFRESH_US = REFRESH_MS * 1000
HEALED_MS = REFRESH_MS + 100  # the longest time that something wrong is seen
START_MS = 100  # until the first picture is seen


def shown(codes):
    """A picture as a person reads it."""
    return "".join(chr(code) for code in codes)


def running(**options):
    """A display that shows RUNNING, at rest."""
    bench = LcdBench(**options)
    bench.boot()
    assert bench.run(bytearray(RUNNING)) and bench.text() == shown(RUNNING)
    assert bench.lcd.complaints() == []
    return bench


# --- the first picture ---------------------------------------------------------------------------


def test_the_first_picture_after_power_on():
    """Nothing is seen before it is whole, and nothing is claimed before it is seen."""
    bench = LcdBench()
    bench.boot()
    picture = bytearray(RUNNING)
    while not bench.turn(picture):
        assert bench.text() in (" " * 32, shown(RUNNING))
        assert bench.clock.now_us < START_MS * 1000
    assert bench.text() == shown(RUNNING)
    assert bench.lcd.complaints() == [] and bench.lcd.clears == 0


def test_the_first_picture_is_written_once():
    """The sequence, what leads to the dots and to either row, and the display on."""
    bench = LcdBench()
    bench.boot(HOURGLASS + UP_AND_DOWN)
    assert bench.run(bytearray(RUNNING), START_MS)
    assert bench.lcd.dots == 16 and bench.lcd.characters == 32
    assert bench.lcd.instructions == 7 + 1 + 2 + 1


def test_a_picture_that_is_all_zeros_is_not_shown_before_it_is_written():
    bench = LcdBench()
    bench.boot(HOURGLASS)
    picture = bytearray(32)
    while not bench.turn(picture):
        pass
    assert bench.text() == "⧗" * 32 and bench.clock.now_us < START_MS * 1000


def test_characters_of_ones_own():
    bench = LcdBench()
    bench.boot(HOURGLASS + UP_AND_DOWN)
    assert bench.run(bytearray(b"\x00 WAIT  \x01 CHANGE" + b" " * 16))
    assert bench.text() == "⧗ WAIT  ↕ CHANGE" + " " * 16
    assert bench.lcd.complaints() == []


def test_eight_characters_are_the_most():
    bench = LcdBench()
    bench.boot(HOURGLASS * 8)
    assert bench.run(bytearray(bytes(range(8)) * 4)) and bench.text() == "⧗" * 32
    for length in (1, 7, 9, 63, 65, 72):
        try:
            bench.display.define(bytes(length))
        except ValueError:
            continue
        raise AssertionError("%d bytes were taken" % length)


def test_the_clock_may_wrap_during_the_initialisation():
    mask = 0xFFFFFF
    for before_us in range(0, 60_000, 1_777):
        bench = running(ticks_start=mask - before_us, ticks_mask=mask)
        assert bench.lcd.complaints() == [], before_us


def test_the_slowest_loop_makes_no_difference():
    bench = LcdBench()
    bench.boot()
    while not bench.turn(bytearray(RUNNING)):
        bench.clock.advance(300_000)
    assert bench.text() == shown(RUNNING) and bench.lcd.complaints() == []


# --- differences ---------------------------------------------------------------------------------


def test_at_rest_nothing_is_written():
    bench = running()
    before = bench.written()
    assert bench.run(bytearray(RUNNING), REFRESH_MS // 2)
    assert bench.written() == before


def test_only_what_differs_is_written():
    """Positions that change: bytes on the bus, one for each, one for each place to go to."""
    for positions, bytes_written in (
        ((0,), 2),
        ((31,), 2),
        ((3, 4), 3),
        ((3, 5), 4),
        ((14, 15), 3),
        ((15, 16), 4),  # the end of a row does not lead to the next one
        ((0, 1, 2, 3, 4), 6),
    ):
        bench = running()
        picture = bytearray(RUNNING)
        for position in positions:
            picture[position] = ord("#")
        before = bench.written()
        assert bench.run(picture, 20)
        assert bench.written() - before == bytes_written, positions
        assert bench.text() == shown(picture)


def test_a_piece_is_small_and_takes_less_than_a_millisecond():
    """Through power-on, changes and a refresh."""
    bench = LcdBench()
    bench.boot(HOURGLASS * 8)
    picture = bytearray(RUNNING)
    largest = 0
    while bench.clock.now_us < 2 * REFRESH_US:
        picture[bench.clock.now_us // LOOP_US * 7 % 32] += 1
        before, began_us = bench.written(), bench.clock.now_us
        bench.display.show(picture)
        largest = max(largest, bench.written() - before)
        # What the computing takes stands in tools/bench.md; here only the waiting counts.
        assert bench.clock.now_us - began_us <= 600
        bench.clock.advance(LOOP_US)
        for position in range(32):
            picture[position] = 0x20 | picture[position] & 0x1F
    assert largest == Hd44780.bytes_per_piece
    assert bench.lcd.complaints() == [] and bench.lcd.clears == 0


def test_a_change_in_the_first_row_is_seen_with_the_next_piece():
    """Wherever the last one was, and however few cells a piece looks at."""
    bench = running()
    bench.display.cells_per_piece = 16
    picture = bytearray(RUNNING)
    for last in range(32):
        for cell in range(16):
            picture[last] ^= 0x01
            assert bench.run(picture, 20)
            picture[cell] ^= 0x02
            assert bench.turn(picture) and bench.text() == shown(picture), (last, cell)


def test_a_first_row_that_never_rests_does_not_starve_the_second():
    bench = running()
    picture = bytearray(RUNNING)
    picture[16:] = b"STOPPING     A2 "
    for turn in range(10):
        for column in range(16):
            picture[column] = 0x30 + (turn + column) % 10
        assert not bench.turn(picture)
    assert bench.lcd.text()[1] == "STOPPING     A2 "


def test_whatever_is_shown_arrives():
    seed = 20240607
    print("seed", seed)
    random.seed(seed)
    bench = running()
    picture = bytearray(RUNNING)
    for _ in range(300):
        for _ in range(random.getrandbits(4)):
            picture[random.getrandbits(5)] = 0x41 + random.getrandbits(4)
        for _ in range(random.getrandbits(3)):
            claimed = bench.turn(picture)
            assert claimed == (bench.text() == shown(picture))
    assert bench.run(picture, 20) and bench.text() == shown(picture)
    assert bench.lcd.complaints() == []


def test_showing_takes_no_heap():
    bench = LcdBench()
    bench.boot(HOURGLASS)
    picture, turns = bytearray(RUNNING), 0
    heap_lock()
    try:
        while bench.clock.now_us < REFRESH_US + 200_000:
            turns += 1
            if turns & 15 == 0:
                picture[turns & 31] = 0x30 | turns >> 5 & 7
                picture[turns >> 4 & 31] ^= 1
            bench.turn(picture)
    finally:
        heap_unlock()
    assert bench.run(picture, 20) and bench.lcd.dots == 16 and bench.lcd.complaints() == []


# --- the microcontroller restarts, the display does not ------------------------------------------


class Reset(Exception):
    pass


class Cutter:
    """Resets the microcontroller just before the level of a pin changes for the nth time."""

    def __init__(self, bench, at):
        self.count = 0
        self.at = at
        for pin in (bench.enable, bench.register_select) + bench.data:
            pin.on_change = self.before(pin.on_change)

    def before(self, on_change):
        def changed(level):
            if self.count == self.at:
                raise Reset
            self.count += 1
            on_change(level)

        return changed


def before_a_reset(at):
    """Power-on and two pictures, cut off before change `at` of a pin, if there are so many."""
    bench = LcdBench()
    cutter = Cutter(bench, at)
    bench.boot(HOURGLASS)
    try:
        bench.run(bytearray(RUNNING), 80)
        bench.run(bytearray(b"\x00" + READY[1:]), 10)
    except Reset:
        return bench
    assert bench.text() == "⧗" + shown(READY[1:]) and cutter.count <= at
    return None


def test_a_reset_at_every_single_change_of_a_pin():
    at = 0
    while True:
        bench = before_a_reset(at)
        if bench is None:
            break
        bench.restart()
        bench.boot(HOURGLASS)
        assert bench.run(bytearray(b"\x00 STOPPED" + b" " * 23), START_MS), at
        assert bench.text() == "⧗ STOPPED" + " " * 23, at
        assert bench.lcd.complaints() == [] and bench.lcd.clears == 0, at
        at += 1
    assert at > 400


def test_the_old_picture_stays_until_the_new_one_is_written_over_it():
    bench = running()
    bench.restart()
    bench.boot()
    picture = bytearray(RUNNING)
    while not bench.turn(picture):
        assert bench.text() == shown(RUNNING)
    assert bench.lcd.complaints() == [] and bench.lcd.clears == 0


def test_the_initialisation_works_from_every_state():
    """4 or 8 bits, any nibble waiting for its other half, and everything else out of order."""
    for eight_bits, half in [(True, -1)] + [(False, half) for half in range(-1, 16)]:
        bench = running()
        lcd = bench.lcd
        lcd.eight_bits = eight_bits
        lcd.half = half
        lcd.is_on = lcd.two_lines = False
        lcd.shifts = lcd.in_cgram = True
        lcd.increment = -1
        lcd.first_column = 7
        lcd.address = 0x3F
        bench.restart()
        bench.boot()
        assert bench.run(bytearray(READY), START_MS), half
        assert bench.text() == shown(READY), half
        assert lcd.complaints() == [] and lcd.clears == 0, half


# --- interference --------------------------------------------------------------------------------


def pulse(bench):
    """A pulse on E by itself: a nibble that nobody sent."""
    bench.enable(1)
    bench.clock.advance(1)
    bench.enable(0)
    bench.clock.advance(100)


def heals(bench):
    """Goes on changing the picture until everything must be right again, and then is watched."""
    picture = bytearray(RUNNING)
    for turn in range(HEALED_MS // 50):
        picture[11] = 0x30 + turn % 10
        bench.run(picture, 50)
    before = len(bench.lcd.complaints())
    for turn in range(10):
        picture[12] = 0x30 + turn
        assert bench.run(picture, 50) and bench.text() == shown(picture)
    return len(bench.lcd.complaints()) == before


def test_swapped_nibbles_heal():
    for pulses in (1, 2, 3):
        bench = running()
        for _ in range(pulses):
            pulse(bench)
        assert heals(bench), pulses


def test_garbled_characters_heal():
    bench = running()
    for cell in range(80):
        bench.lcd.ddram[cell] ^= 0x55
    bench.lcd.cgram[3] ^= 0xFF
    assert bench.text() != shown(RUNNING)
    assert heals(bench) and bench.lcd.complaints() == []


def test_garbled_dots_heal():
    bench = LcdBench()
    bench.boot(UP_AND_DOWN)
    picture = bytearray(32)
    bench.run(picture)
    bench.lcd.cgram[3] ^= 0xFF
    assert bench.text() == "▒" * 32
    bench.run(picture, HEALED_MS)
    assert bench.text() == "↕" * 32


def test_a_picture_that_moved_or_went_dark_heals():
    for command in (0x18, 0x1C, 0x08, 0x0F, 0x04, 0x07, 0x40, 0x30, 0x23):
        bench = running()
        bench.command(command)
        assert heals(bench), "%02X" % command


def test_a_display_that_lost_its_power_for_a_moment_heals():
    bench = running()
    bench.lcd.power_on()
    assert heals(bench)


def test_a_refresh_is_not_seen():
    """Looked at after every turn, through some of them: always right, always claimed."""
    bench = LcdBench()
    bench.boot(HOURGLASS)
    picture = bytearray(b"\x00" + RUNNING[1:])
    assert bench.run(picture, START_MS)
    instructions, homes = bench.lcd.instructions, bench.lcd.homes
    until_us = bench.clock.now_us + 5 * REFRESH_US
    while bench.clock.now_us < until_us:
        assert bench.turn(picture) and bench.text() == "⧗" + shown(RUNNING[1:])
    assert bench.lcd.homes >= homes + 4 and bench.lcd.instructions > instructions
    assert bench.lcd.complaints() == [] and bench.lcd.clears == 0


def test_a_refresh_finds_its_place_wherever_the_last_change_was():
    for position in range(32):
        bench = running()
        picture = bytearray(RUNNING)
        picture[position] = ord("#")
        assert bench.run(picture, 20)
        for cell in range(80):
            bench.lcd.ddram[cell] ^= 0x55
        assert bench.run(picture, HEALED_MS) and bench.text() == shown(picture), position


def test_a_change_during_a_refresh_is_seen_soon_and_claimed_only_then():
    for after_us in range(0, 60_000, 2_000):
        bench = running()
        homes = bench.lcd.homes
        while bench.lcd.homes == homes:
            bench.turn(bytearray(RUNNING))
        bench.run(bytearray(RUNNING), after_us // 1000)
        picture, turns = bytearray(READY), 0
        while not bench.turn(picture):
            turns += 1
            assert turns < 20 and bench.text() != shown(READY)
        assert bench.text() == shown(READY) and bench.lcd.complaints() == []


def in_a_refresh(turns):
    """A display in the middle of a refresh: so many turns after it was sent home."""
    bench = LcdBench()
    bench.boot(HOURGLASS + UP_AND_DOWN)
    picture = bytearray(RUNNING)
    assert bench.run(picture, START_MS)
    homes = bench.lcd.homes
    while bench.lcd.homes == homes:
        bench.turn(picture)
    for _ in range(turns):
        bench.turn(picture)
    return bench


def test_a_change_does_not_wait_for_the_refresh():
    """It is seen with the first piece that can be written, wherever the refresh is."""
    for turns in range(12):
        for place in (0, 10, 11, 16, 27):
            bench = in_a_refresh(turns)
            picture = bytearray(RUNNING)
            for cell in range(place, place + 5):
                picture[cell] ^= 0x01
            claimed = any([bench.turn(picture) for _ in range(3)])  # "home" takes one of these
            assert claimed and bench.text() == shown(picture), (turns, place)
            assert bench.run(picture, 100) and bench.text() == shown(picture)
            assert bench.lcd.cgram[:16] == HOURGLASS + UP_AND_DOWN
            assert bench.lcd.complaints() == []


def test_a_picture_that_never_rests_is_refreshed_as_well():
    """All of it differs in each turn: each code is now even, now odd."""
    bench = LcdBench()
    bench.boot(HOURGLASS + UP_AND_DOWN)
    picture = bytearray(RUNNING)
    assert bench.run(picture, START_MS)
    lcd = bench.lcd
    for cell in range(80):
        lcd.ddram[cell] ^= 0x55
    for index in range(16):
        lcd.cgram[index] ^= 0x1F
    bench.command(0x08)
    until_us = bench.clock.now_us + HEALED_MS * 1000
    while bench.clock.now_us < until_us:
        for cell in range(32):
            picture[cell] ^= 0x01
        bench.turn(picture)
    assert [ord(letter) | 1 for letter in bench.text()] == [code | 1 for code in RUNNING]
    assert lcd.cgram[:16] == HOURGLASS + UP_AND_DOWN
    assert lcd.complaints() == []


def test_garbled_dots_heal_while_the_picture_changes():
    for every in range(1, 30):
        bench = in_a_refresh(0)
        for index in range(16):
            bench.lcd.cgram[index] ^= 0x1F
        picture = bytearray(RUNNING)
        for turn in range(60):
            if turn % every == 0:
                picture[14] = 0x30 + turn % 10
                picture[27] ^= 0x01
            bench.turn(picture)
        assert bench.lcd.cgram[:16] == HOURGLASS + UP_AND_DOWN, every
        assert bench.run(picture, 20) and bench.text() == shown(picture)
        assert bench.lcd.complaints() == []


# --- to the microsecond --------------------------------------------------------------------------


class Line:
    """A pin; `log` has (instant, name, level) each time that one is set."""

    def __init__(self, name, clock, log):
        self.name, self.clock, self.log = name, clock, log

    def value(self, level):
        self.log.append((self.clock.now_us, self.name, level))


class Lines:
    """A driver on pins that note what is done to them."""

    def __init__(self):
        self.clock, self.log = Clock(), []
        select, enable = self.line("RS"), self.line("E")
        data = tuple(self.line("D%d" % bit) for bit in (4, 5, 6, 7))
        self.display = Hd44780(select, enable, data, self.clock)

    def line(self, name):
        return Line(name, self.clock, self.log)

    def pulses(self):
        """(instant, register, four bits) of each pulse so far."""
        levels, pulses = {}, []
        for at_us, name, level in self.log:
            levels[name] = level
            if (name, level) == ("E", 1):
                bits = sum(levels["D%d" % bit] << bit - 4 for bit in (4, 5, 6, 7))
                pulses.append((at_us, levels["RS"], bits))
        return pulses

    def count(self):
        return len(self.pulses())

    def show(self, picture, us):
        """For so long, with a look in each microsecond; whether all is shown."""
        until_us = self.clock.now_us + us
        shown = False
        while self.clock.now_us < until_us:
            shown = self.display.show(picture)
            if self.clock.now_us < until_us:
                self.clock.advance(1)
        return shown


def test_the_controller_is_set_up_no_sooner_than_the_data_sheet_allows_and_no_later():
    """Time from the pulse before, register, four bits; a pulse takes 1 us, a look another."""
    lines = Lines()
    lines.display.define(HOURGLASS)
    assert lines.show(RUNNING, 60_000)
    pulses = lines.pulses()
    before = [0] + [at_us for at_us, _, _ in pulses]
    steps = [(at_us - last, bits) for last, (at_us, _, bits) in zip(before, pulses)]
    assert steps[:11] == [
        (40_001, 3), (4_102, 3), (101, 3), (101, 2),
        (101, 2), (1, 8), (1 + 101 + 54, 0), (1, 6), (54 + 53, 0), (1, 2),
        (2_160 + 2 + 53, 4),
    ]  # fmt: skip
    assert {register for _, register, _ in pulses[:12]} == {0}
    # The dots, with the way to them; either row, with the way to it; last, the display is on.
    written = pulses[10:]
    assert [register for _, register, _ in written] == (
        [0, 0] + [1] * 16 + ([0, 0] + [1] * 32) * 2 + [0, 0]
    )
    codes = [a[2] << 4 | b[2] for a, b in zip(written[::2], written[1::2])]
    rows = [0x80] + list(RUNNING[:16]) + [0xC0] + list(RUNNING[16:])
    assert codes == [0x40] + list(HOURGLASS) + rows + [0x0C]
    # A command takes 53 us, a character or a row of dots 61; between two pieces is a look.
    for (at_us, register, _), (next_us, _, _) in zip(written[1:-1:2], written[2::2]):
        wait_us = 62 if register else 54
        assert next_us - at_us in (wait_us, wait_us + 1), at_us


def test_two_rows_of_sixteen_whose_lines_begin_low_and_are_set_only_where_they_change():
    lines = Lines()
    assert (lines.display.rows, lines.display.columns) == (2, 16)
    levels = {}
    for _, name, level in lines.log:
        levels[name] = level
    assert levels == {name: 0 for name in ("RS", "E", "D4", "D5", "D6", "D7")}
    begun = len(lines.log)
    assert lines.show(RUNNING, 60_000)
    raised_us = 0
    for at_us, name, level in lines.log[begun:]:
        assert level in (0, 1)
        assert name == "RS" or levels[name] != level, (at_us, name)
        levels[name] = level
        if name == "E":
            assert level or at_us - raised_us == 1
            raised_us = at_us


def refreshed():
    """A display at rest; and the instant from which its next refresh counts."""
    lines = Lines()
    assert lines.show(RUNNING, 60_000)
    return lines, lines.pulses()[10][0]


def test_a_display_at_rest_is_refreshed_after_eight_seconds():
    lines, since_us = refreshed()
    count = lines.count()
    lines.clock.advance(since_us + 8_000_000 - lines.clock.now_us)
    assert lines.display.show(RUNNING) and lines.count() == count
    lines.clock.advance(1)
    assert lines.display.show(RUNNING) and lines.count() == count + 1
    assert lines.pulses()[-1][1:] == (0, 3)


def test_from_seven_seconds_on_a_refresh_begins_behind_a_change():
    """As soon as all of that is shown: not before, and not while some of it is left."""
    for after_us, cells, pulses in (
        (7_000_000, 1, 4),
        (7_000_001, 1, 4 + 1),
        (7_000_001, 7, 2 + 2 * 7 + 1),  # 8 bytes, the most that one piece has
        (7_000_001, 8, 2 + 2 * 7),
    ):
        lines, since_us = refreshed()
        count = lines.count()
        lines.clock.advance(since_us + after_us - lines.clock.now_us)
        picture = b"#" * cells + RUNNING[cells:]
        assert lines.display.show(picture) == (cells < 8)
        assert lines.count() - count == pulses, (after_us, cells, lines.count() - count)


def test_a_refresh_between_two_pieces_of_a_change_goes_to_its_place_first():
    """It has sent the controller home meanwhile, away from the next cell that differs."""
    lines, since_us = refreshed()
    lines.clock.advance(since_us + 8_000_000 - lines.clock.now_us)
    picture = b"#" * 16 + RUNNING[16:]
    count = lines.count()
    assert not lines.display.show(picture)
    lines.clock.advance(1)
    assert lines.show(picture, 20_000)
    bits = [each for _, _, each in lines.pulses()[count:]]
    assert bits[:2] == [8, 0] and bits[2:16] == [2, 3] * 7
    assert bits[16:26] == [3, 3, 3, 2, 2, 8, 0, 6, 0, 2] and bits[26:30] == [8, 7, 2, 3]


def test_a_picture_that_changes_all_the_time_has_two_pieces_of_three_of_a_refresh():
    """Bytes of each piece. What leads to the display being on again waits for no change."""
    lines, since_us = refreshed()
    picture, sizes = bytearray(RUNNING), []
    lines.clock.advance(since_us + 8_000_001 - lines.clock.now_us)
    for turn in range(20):
        count = lines.count()
        picture[5] = 0x41 + turn
        lines.display.show(picture)
        sizes.append((lines.count() - count) / 2)
        lines.clock.advance(4_200)
    assert sizes == [0.5, 2.5, 2] + [2, 2, 8] * 4 + [2, 2, 7, 3, 2], sizes
