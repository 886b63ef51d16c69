# SPDX-License-Identifier: MIT
"""The display behind an I2C backpack: the same pictures, and a panel that outlives its cable."""

import random

from boards.sim.chip.machine import heap_lock, heap_unlock
from boards.sim.clock import Clock
from hal.display.probe import answers, free
from lcd_bench import HOURGLASS, LOOP_US, READY, RUNNING, UP_AND_DOWN, BackpackBench

REFRESH_MS = 8_000  # so often all is written anew
REFRESH_US = REFRESH_MS * 1000
START_MS = 200  # until the first picture is seen
AGAIN_MS = 500
PIECE_US = 1_000  # of the bus, at 100 kHz


def shown(codes):
    """A picture as a person reads it."""
    return "".join(chr(code) for code in codes)


def running(glyphs=b"", **options):
    """A display that shows RUNNING, at rest."""
    bench = BackpackBench(**options)
    bench.boot(glyphs)
    assert bench.run(bytearray(RUNNING), START_MS) and bench.text() == shown(RUNNING)
    bench.check()
    return bench


def taken(bench):
    """How many bytes went over the bus so far."""
    return bench.chip_of_backpack.bytes_taken


def test_a_backpack_is_found_by_its_acknowledgement():
    bench = BackpackBench()
    i2c = bench.make_i2c()
    assert answers(i2c, 0x27) and not answers(i2c, 0x3F)
    bench.chip_of_backpack.plugged = False
    assert not answers(i2c, 0x27)


def test_looking_for_it_lights_it_and_writes_nothing():
    bench = BackpackBench()
    assert answers(bench.make_i2c(), 0x27)
    assert bench.chip_of_backpack.lit and bench.written() == 0


class HeldLine:
    """SDA, which a backpack holds low until it has had so many clocks; and SCL."""

    def __init__(self, clocks):
        self.clocks = clocks
        self.clock = Clock()
        self.changes = []  # of SCL: (when, level)
        self.data, self.pulse = Wire(self.level), Wire(self.put)

    def level(self):
        return sum(level for _, level in self.changes) >= self.clocks

    def put(self, level):
        self.changes.append((self.clock.now_us, level))


class Wire:
    def __init__(self, value):
        self.value = value


def test_a_backpack_that_holds_the_wires_is_clocked_until_it_lets_go():
    """Nine clocks are all that a transfer can wait for; 5 us each way make 100 kHz."""
    for held, clocks in ((0, 0), (1, 1), (5, 5), (9, 9), (1000, 9)):
        line = HeldLine(held)
        free(line.data, line.pulse, line.clock.sleep_us)
        assert [level for _, level in line.changes] == [0, 1] * clocks, held
        instants = [at_us for at_us, _ in line.changes]
        assert instants == [5 * place for place in range(1, 2 * clocks + 1)], held
        # One look more finds that it has let go, and nobody waits after that.
        assert line.clock.now_us == (10 * clocks + 5 if held < 9 else 90), held


def test_the_light_goes_off_and_on_and_the_picture_stays():
    bench = running(HOURGLASS)
    chip, display = bench.chip_of_backpack, bench.display
    written = bench.written()
    display.backlight(False)
    assert not chip.lit and bench.written() == written
    assert bench.run(bytearray(READY), START_MS) and bench.text() == shown(READY)
    bench.run(bytearray(READY), REFRESH_MS + 500)  # all of it is written anew
    assert not chip.lit and bench.text() == shown(READY)
    display.backlight(True)
    assert chip.lit and bench.text() == shown(READY)
    bench.check()


def test_the_light_may_change_between_two_characters_that_stand_side_by_side():
    """The byte for the light tells the controller that a command follows, and none does."""
    for lit in (False, True):
        bench = running()
        picture = bytearray(RUNNING)
        picture[3] = ord("#")
        assert bench.run(picture, 30)
        bench.display.backlight(lit)
        picture[4] = ord("#")
        assert bench.run(picture, 30) and bench.text() == shown(picture)
        assert bench.chip_of_backpack.lit == lit
        bench.check()


def test_a_backpack_that_is_away_when_the_light_goes_off_comes_back_dark():
    bench = running()
    bench.chip_of_backpack.plugged = False
    bench.display.backlight(False)
    bench.chip_of_backpack.plugged = True
    assert bench.run(bytearray(READY), START_MS + 2 * AGAIN_MS) and bench.text() == shown(READY)
    assert not bench.chip_of_backpack.lit
    bench.check()


def test_the_first_picture_after_power_on():
    """Nothing is seen before it is whole, and nothing is claimed before it is seen."""
    bench = BackpackBench()
    bench.boot(HOURGLASS + UP_AND_DOWN)
    picture = bytearray(b"\x00" + RUNNING[1:])
    while not bench.turn(picture):
        assert bench.text() in (" " * 32, "⧗" + shown(RUNNING[1:]))
        assert bench.clock.now_us < START_MS * 1000
    assert bench.text() == "⧗" + shown(RUNNING[1:]) and bench.chip_of_backpack.lit
    bench.check()


def test_the_light_never_flickers():
    bench = running()
    picture = bytearray(RUNNING)
    until_us = bench.clock.now_us + REFRESH_US
    while bench.clock.now_us < until_us:
        picture[bench.clock.now_us >> 8 & 31] ^= 1
        bench.turn(picture)
        assert bench.chip_of_backpack.lit


def test_at_rest_nothing_goes_over_the_bus():
    bench = running()
    before = taken(bench)
    assert bench.run(bytearray(RUNNING), REFRESH_MS // 2)
    assert taken(bench) == before


def test_only_what_differs_goes_over_the_bus():
    """Positions that change: bytes on the bus, 4 for each command or character, and one more
    whenever one follows the other. The last thing before was a command: the display on."""
    for positions, count in (
        ((0,), 9),
        ((31,), 9),
        ((3, 4), 13),
        ((3, 5), 19),
        ((15, 16), 19),
        ((0, 1, 2, 3, 4), 25),
    ):
        bench = running()
        picture = bytearray(RUNNING)
        for position in positions:
            picture[position] = ord("#")
        before = taken(bench)
        assert bench.run(picture, 30)
        assert taken(bench) - before == count, positions
        assert bench.text() == shown(picture)


def test_a_piece_takes_a_millisecond_of_the_bus():
    """Through power-on, changes and a refresh."""
    bench = BackpackBench()
    bench.boot(HOURGLASS * 8)
    picture = bytearray(RUNNING)
    longest_us = 0
    while bench.clock.now_us < 2 * REFRESH_US:
        picture[bench.clock.now_us // LOOP_US * 7 % 32] = 0x30 + bench.clock.now_us % 10
        began_us = bench.clock.now_us
        bench.display.show(picture)
        longest_us = max(longest_us, bench.clock.now_us - began_us)
        bench.clock.advance(LOOP_US)
    assert PIECE_US // 2 < longest_us <= PIECE_US
    assert bench.lcd.clears == 0
    bench.check()


def test_whatever_is_shown_arrives():
    seed = 20240608
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
    assert bench.run(picture, 150) and bench.text() == shown(picture)
    bench.check()


def test_showing_takes_no_heap():
    bench = running(HOURGLASS)
    write_to = bench.write_to

    def unlocked(address, data):
        heap_unlock()  # the simulated bus may take some
        try:
            write_to(address, data)
        finally:
            heap_lock()

    bench.write_to = unlocked
    picture, turns = bytearray(RUNNING), 0
    until_us = bench.clock.now_us + REFRESH_US + 200_000
    heap_lock()
    try:
        while bench.clock.now_us < until_us:
            turns += 1
            if turns & 15 == 0:
                picture[turns & 31] = 0x30 | turns >> 5 & 7
                picture[turns >> 4 & 31] ^= 1
            bench.turn(picture)
    finally:
        heap_unlock()
    assert bench.run(picture, 150) and bench.text() == shown(picture)
    bench.check()


class Reset(Exception):
    pass


def reset_after(bench, count):
    """The microcontroller resets when the backpack has acknowledged `count` bytes more."""
    write = bench.write_to
    left = [count]

    def write_to(address, data):
        for code in data:
            if not left[0]:
                raise Reset
            left[0] -= 1
            write(address, bytes((code,)))

    bench.write_to = write_to


def test_a_reset_after_every_single_byte():
    """The backpack holds what it was told last, the driver begins anew."""
    count = 0
    while True:
        bench = BackpackBench()
        bench.boot(HOURGLASS)
        reset_after(bench, count)
        try:
            bench.run(bytearray(RUNNING), 120)
            bench.run(bytearray(b"\x00" + READY[1:]), 40)
        except Reset:
            bench.restart()
            bench.boot(HOURGLASS)
            assert bench.run(bytearray(b"\x00" + READY[1:]), START_MS), count
            assert bench.text() == "⧗" + shown(READY[1:]), count
            # What became of a nibble that was cut short may be complained about, but not seen.
            assert bench.lcd.clears == 0, count
            count += 1
            continue
        break
    assert count > 250


# --- the cable -----------------------------------------------------------------------------------


def test_a_backpack_that_is_unplugged_does_not_stop_the_panel():
    bench = running()
    bench.chip_of_backpack.plugged = False
    assert not bench.run(bytearray(READY), 5_000)
    # A look every half a second, each with the I2C made anew; no more than that.
    assert 9 <= bench.display.failures <= 11 and bench.made == bench.display.failures + 1


def test_it_is_looked_for_half_a_second_after_each_failure_and_then_has_40_ms():
    """What comes first is one byte, the light: it shows whether the backpack is there."""
    bench = running()
    backpack, display, clock = bench.chip_of_backpack, bench.display, bench.clock
    backpack.plugged = False
    assert not display.show(READY) and display.failures == 1
    for failures in (2, 3):
        clock.advance(500_000)
        assert not display.show(READY) and display.failures == failures - 1
        clock.advance(1)
        assert not display.show(READY) and display.failures == failures
    backpack.plugged = True
    before = taken(bench)
    for wait_us, count in ((500_000, 0), (1, 1), (40_000, 1), (1, 4)):
        clock.advance(wait_us)
        assert not display.show(READY) and taken(bench) - before == count, (wait_us, count)
    assert bench.run(READY, START_MS) and display.failures == 3


def test_it_is_set_up_anew_when_it_is_plugged_in_again():
    """It had no power meanwhile, and the display neither."""
    for away_ms in (AGAIN_MS - 10, 3_000):
        bench = running(HOURGLASS)
        bench.chip_of_backpack.plugged = False
        bench.run(bytearray(READY), away_ms)
        bench.chip_of_backpack.power_on()
        bench.chip_of_backpack.plugged = True
        picture = bytearray(b"\x00" + READY[1:])
        assert bench.run(picture, AGAIN_MS + START_MS), away_ms
        assert bench.text() == "⧗" + shown(READY[1:]), away_ms
        bench.check()  # not even the first look has hurried a display that has just got power


def test_a_single_transfer_that_fails_heals_within_a_second():
    bench = running()
    bench.chip_of_backpack.plugged = False
    picture = bytearray(READY)
    assert not bench.turn(picture) and bench.display.failures == 1
    bench.chip_of_backpack.plugged = True
    assert bench.run(picture, AGAIN_MS + START_MS) and bench.text() == shown(READY)
    assert bench.display.failures == 1


def test_its_failures_are_counted_with_16_bits():
    bench = running()
    bench.chip_of_backpack.plugged = False
    bench.display.failures = 0xFFFE
    for wanted in (0xFFFF, 0, 1):
        bench.display.backlight(False)
        assert bench.display.failures == wanted


def test_a_failure_is_noticed_at_rest_by_the_next_refresh():
    bench = running()
    bench.chip_of_backpack.plugged = False
    assert not bench.run(bytearray(RUNNING), REFRESH_MS + 100)
    assert bench.display.failures


def test_garbled_characters_heal():
    bench = running()
    for cell in range(80):
        bench.lcd.ddram[cell] ^= 0x55
    assert bench.text() != shown(RUNNING)
    bench.run(bytearray(RUNNING), REFRESH_MS + START_MS)
    assert bench.text() == shown(RUNNING)
    bench.check()


def test_a_refresh_is_not_seen():
    bench = running(HOURGLASS)
    homes = bench.lcd.homes
    until_us = bench.clock.now_us + 3 * REFRESH_US
    while bench.clock.now_us < until_us:
        assert bench.turn(bytearray(RUNNING)) and bench.text() == shown(RUNNING)
    assert bench.lcd.homes >= homes + 2 and bench.lcd.clears == 0
    bench.check()


def test_a_change_does_not_wait_for_the_refresh():
    for turns in range(0, 100, 7):
        bench = running(HOURGLASS + UP_AND_DOWN)
        picture, homes = bytearray(RUNNING), bench.lcd.homes
        while bench.lcd.homes == homes:
            bench.turn(picture)
        for _ in range(turns):
            bench.turn(picture)
        picture[14] ^= 0x01
        claimed = any([bench.turn(picture) for _ in range(3)])  # "home" takes one of these
        assert claimed and bench.text() == shown(picture), turns
        bench.run(picture, START_MS)
        assert bench.text() == shown(picture)
        assert bench.lcd.cgram[:16] == HOURGLASS + UP_AND_DOWN
        bench.check()


def test_a_picture_that_never_rests_is_refreshed_as_well():
    """A character that changes in each turn takes all that a piece can write."""
    bench = running(HOURGLASS + UP_AND_DOWN)
    lcd, picture, homes = bench.lcd, bytearray(RUNNING), bench.lcd.homes
    while lcd.homes == homes:
        bench.turn(picture)
    for cell in range(80):
        lcd.ddram[cell] ^= 0x55
    for index in range(16):
        lcd.cgram[index] ^= 0x1F
    lcd.is_on = False
    until_us = bench.clock.now_us + 3 * START_MS * 1000
    while bench.clock.now_us < until_us:
        picture[14] ^= 0x01
        bench.turn(picture)
    assert bench.text()[:14] == shown(RUNNING[:14]) and bench.text()[15:] == shown(RUNNING[15:])
    assert lcd.cgram[:16] == HOURGLASS + UP_AND_DOWN
    bench.check()


def test_what_goes_over_the_bus_first():
    """Each nibble with E and without; before the first one P0, so that it stands before E rises.
    P3 is the light."""
    bench = BackpackBench()
    bench.boot()
    sent, write_to = [], bench.write_to

    def noting(address, data):
        sent.append((bench.clock.now_us, address, bytes(data)))
        write_to(address, data)

    bench.write_to = noting
    began_us = bench.clock.now_us
    for wait_us in (40_000, 1, 5_000, 5_000):
        bench.clock.advance(wait_us)
        bench.display.show(RUNNING)
    assert sent[0][:2] == (began_us + 40_001, 0x27)
    assert [data.hex() for _, _, data in sent] == [
        "383c38",
        "3c38" + "3c38" + "2c28" + "2c28" + "8c88",
        "0c08" + "6c68" + "0c08" + "2c28",
    ]
