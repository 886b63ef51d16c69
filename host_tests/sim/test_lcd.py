# SPDX-License-Identifier: MIT
"""Data sheet of the simulated display controller: what it does, and what it complains about."""

from boards.sim.chip.lcd import (
    BUSY,
    NO_CELL,
    NO_FUNCTION_SET,
    POWER_ON_US,
    SHORT_CYCLE,
    SHORT_PULSE,
    TOO_SOON,
    UNKNOWN,
    UNSTEADY,
    Lcd,
)
from boards.sim.chip.machine import Pin
from boards.sim.world import World
from lcd_bench import HOURGLASS, UP_AND_DOWN, LcdBench

BLANK = " " * 16


def started():
    bench = LcdBench()
    bench.start()
    assert bench.lcd.complaints() == [] and bench.lcd.text() == (BLANK, BLANK)
    return bench


def rules(bench):
    """What was complained about, without the instants."""
    return [complaint.split(" us: ")[1] for complaint in bench.lcd.complaints()]


def refused(error, function, *arguments):
    try:
        function(*arguments)
    except error:
        return True
    return False


# --- what it shows -------------------------------------------------------------------------------


def test_after_power_on_it_is_dark_and_its_memory_is_not_empty():
    lcd = LcdBench().lcd
    assert lcd.text() == (BLANK, BLANK)
    assert bytes(lcd.ddram) != b" " * 80 and bytes(lcd.cgram) != bytes(64)


def test_initialised_by_the_book_it_shows_what_is_written():
    bench = started()
    bench.letters(b"S: 10.0 F: 10.00")
    bench.command(0xC0)
    bench.letters(b"RUNNING")
    assert bench.lcd.text() == ("S: 10.0 F: 10.00", "RUNNING         ")
    assert bench.lcd.characters == 23 and bench.lcd.clears == 1
    assert bench.lcd.complaints() == []


def test_the_rows_have_40_characters_and_follow_each_other():
    bench = started()
    bench.letters(b"1" + 39 * b"-" + b"2" + 39 * b"=" + b"0")
    assert bench.lcd.text() == ("0" + 15 * "-", "2" + 15 * "=")


def test_every_character_code_has_a_look():
    """ROM A00: a yen sign instead of the backslash, arrows instead of ~ and delete."""
    bench = started()
    bench.letters(b"A\x5cz{|}\x7e\x7f\xdf\xff\x00\x10\x80\xa1\xe0 ")
    assert bench.lcd.text()[0] == "A¥z{|}→←°█▒▒▒▒▒ "
    bench.command(0x80)
    bench.letters(b"\xe1\xef\xf5\xe2\xe4\xee\xfd\xa5")
    assert bench.lcd.text()[0][:8] == "äöüßµñ÷·"


def test_rom_a02_has_the_letters_of_europe():
    bench = started()
    bench.lcd.rom = "A02"
    bench.letters(b"\x5c~\xc4\xd6\xdc\xe4\xf6\xfc\xdf\xe9")
    assert bench.lcd.text()[0] == "\\~ÄÖÜäöüßé      "


def test_a_character_of_ones_own_is_known_by_its_dots():
    bench = started()
    bench.command(0x40 + 8)
    bench.letters(HOURGLASS + UP_AND_DOWN)
    bench.command(0x80)
    bench.letters(b"\x01\x02\x03\x09\x0a")  # 8...15 are 0...7 once more
    assert bench.lcd.text()[0] == "⧗↕▒⧗↕" + " " * 11
    bench.lcd.cgram[8] = 0xFF  # the upper three bits are no dots
    assert bench.lcd.text()[0][0] == "⧗"
    bench.lcd.cgram[8] = 0x1E
    assert bench.lcd.text()[0][0] == "▒"
    assert bench.lcd.dots == 16 and bench.lcd.complaints() == []


def test_dark_it_keeps_what_it_shows():
    bench = started()
    bench.letters(b"HELLO")
    bench.command(0x08)
    assert bench.lcd.text() == (BLANK, BLANK)
    bench.command(0x0C)
    assert bench.lcd.text()[0] == "HELLO" + " " * 11


def test_shifting_moves_the_picture_and_home_brings_it_back():
    bench = started()
    bench.letters(b"HELLO")
    bench.command(0x18)
    assert bench.lcd.text()[0] == "ELLO" + " " * 12
    bench.command(0x1C)
    bench.command(0x1C)
    assert bench.lcd.text()[0] == " HELLO" + " " * 10
    bench.command(0x02, 2_160)
    bench.letters(b"J")
    assert bench.lcd.text()[0] == "JELLO" + " " * 11
    assert bench.lcd.homes == 1 and bench.lcd.clears == 1


def test_the_address_moves_by_itself_either_way_or_by_a_command():
    bench = started()
    bench.letters(b"AB")
    bench.command(0x10)  # one to the left
    bench.letters(b"C")
    bench.command(0x14)  # one to the right
    bench.command(0x04)  # to the left by itself
    bench.letters(b"FED")
    assert bench.lcd.text()[0] == "ADEF" + " " * 12
    bench.command(0x07)  # to the right, and the picture to the left
    bench.command(0x80)
    bench.letters(b"A")
    assert bench.lcd.text()[0] == "DEF" + " " * 13


def test_clear_makes_all_blank_and_undoes_shift_and_direction():
    bench = started()
    bench.letters(b"HELLO")
    bench.command(0x18)
    bench.command(0x04)
    bench.command(0x01, 2_160)
    bench.letters(b"AB")
    assert bench.lcd.text() == ("AB" + " " * 14, BLANK)


def test_the_number_of_lines_can_be_set_only_after_a_change_of_the_width():
    bench = started()
    bench.command(0x20)
    assert bench.lcd.two_lines
    bench.command(0x30)  # 8 bits from here on
    bench.nibble(0, 2)
    bench.clock.advance(53)
    bench.command(0x20)
    assert not bench.lcd.two_lines and bench.lcd.text()[1] == BLANK
    bench.letters(b"1" + 78 * b"-" + b"2" + b"0")
    assert bench.lcd.text()[0] == "0" + 15 * "-" and bench.lcd.ddram[79] == ord("2")
    assert bench.lcd.complaints() == []


def test_it_keeps_everything_while_the_microcontroller_resets():
    bench = started()
    bench.letters(b"HELLO")
    bench.register_select(1)
    bench.enable(1)  # reset in the middle of a pulse: E falls, that counts
    bench.restart()
    assert bench.lcd.half >= 0 and bench.lcd.text()[0] == "HELLO" + " " * 11
    assert bench.lcd.complaints() == []
    bench.lcd.let_go()
    bench.lcd.let_go()
    bench.enable(1)  # nobody is there to see it
    assert bench.lcd.complaints() == []


def test_without_power_it_forgets():
    bench = started()
    bench.letters(b"HELLO")
    bench.lcd.power_on()
    assert bench.lcd.eight_bits and bench.lcd.text() == (BLANK, BLANK)
    bench.start()
    assert bench.lcd.complaints() == []


# --- what it complains about ---------------------------------------------------------------------


def test_a_write_before_its_power_on_time_is_over():
    bench = LcdBench()
    bench.clock.advance(POWER_ON_US - 2)
    bench.nibble(0, 3)
    assert bench.lcd.complaints() == ["at %d us: %s" % (POWER_ON_US - 1, TOO_SOON)]
    assert bench.lcd.instructions == 0


def test_the_waits_of_the_initialisation_are_demanded():
    for waits_us in ((4_098, 200), (5_000, 98)):
        bench = LcdBench()
        bench.clock.advance(POWER_ON_US)
        for wait_us in waits_us:
            bench.nibble(0, 3)
            bench.clock.advance(wait_us)
        bench.nibble(0, 3)
        assert rules(bench) == [BUSY], waits_us


def test_every_execution_time_is_demanded():
    """Register, code, time until the next byte: that, and a microsecond less."""
    for register, code, time_us in (
        (0, 0x80, 53), (0, 0x06, 53), (0, 0x0C, 53), (0, 0x28, 53), (0, 0x14, 53),
        (0, 0x40, 53), (1, 0x41, 61), (0, 0x01, 2_160), (0, 0x02, 2_160),
    ):  # fmt: skip
        for early_us in (0, 1):
            bench = started()
            bench.byte(register, code, time_us - 1 - early_us)  # the next pulse takes 1 us
            bench.nibble(0, 8)
            assert rules(bench) == [BUSY] * early_us, (register, code)
            assert bench.lcd.half == (-1 if early_us else 8)  # too early is lost


def test_a_pulse_without_duration_and_the_next_one_at_once():
    bench = started()
    bench.enable(1)
    bench.enable(0)
    assert rules(bench) == [SHORT_PULSE]
    bench.enable(1)
    assert rules(bench) == [SHORT_PULSE, SHORT_CYCLE]


def test_a_line_that_changes_while_e_is_high():
    for which in range(5):
        bench = started()
        lines = bench.data + (bench.register_select,)
        bench.enable(1)
        bench.clock.advance(1)
        lines[which](1 - lines[which]())
        bench.enable(0)
        assert rules(bench) == [UNSTEADY], which


def test_a_write_before_the_function_set():
    bench = LcdBench()
    bench.clock.advance(POWER_ON_US)
    bench.command(0x0C, 100)  # a driver that believes in 4 bits from the beginning
    assert rules(bench) == [NO_FUNCTION_SET, BUSY]
    bench = LcdBench()
    bench.clock.advance(POWER_ON_US)
    for nibble, wait_us in ((3, 4_100), (3, 100), (3, 53), (2, 53)):
        bench.nibble(0, nibble)
        bench.clock.advance(wait_us)
    bench.command(0x0C)  # 4 bits, but how many lines?
    bench.letters(b"A")
    assert rules(bench) == [NO_FUNCTION_SET] * 2


def test_a_code_that_is_no_instruction():
    bench = started()
    bench.command(0x00)
    assert rules(bench) == [UNKNOWN]


def test_a_character_where_there_is_no_memory():
    for address in (0x28, 0x3F, 0x68, 0x7F):
        bench = started()
        bench.command(0x80 | address)
        bench.letters(b"A")
        assert rules(bench) == [NO_CELL], address
        bench.letters(b"A")  # it goes on counting
        assert bench.lcd.complaints()


def test_complaints_are_bounded_and_tell_the_first():
    bench = started()
    bench.command(0x00)
    for _ in range(50):
        bench.enable(1)
        bench.enable(0)
    assert len(bench.lcd.complaints()) == 16 and rules(bench)[0] == UNKNOWN


# --- in the world --------------------------------------------------------------------------------


class Idle:
    """A firmware that does nothing."""

    def __init__(self, board):
        self.step = board.idle


def test_the_world_passes_the_complaints_on():
    world = World(Idle)
    world.run(100)
    world.check()
    enable = Pin(world.chip)
    world.lcd_chip.wire(Pin(world.chip), enable, tuple(Pin(world.chip) for _ in range(4)))
    enable(1)
    enable(0)
    try:
        world.check()
    except AssertionError as error:
        assert "display: at " in str(error) and SHORT_PULSE in str(error)
    else:
        raise AssertionError("nobody complained")


def test_the_display_outlives_a_reset_of_the_chip():
    boards = []

    def start(board):
        boards.append(board)
        return Idle(board)

    world = World(start)
    picture = bytearray(b"FIRST LIFE      " * 2)
    while not boards[0].display.show(picture):
        world.run(2)
    world.reset()
    assert world.lcd() == ("FIRST LIFE      ",) * 2
    picture = bytearray(b"SECOND LIFE     " * 2)
    while not boards[1].display.show(picture):
        world.run(2)
    assert world.lcd() == ("SECOND LIFE     ",) * 2
    assert not boards[0].display.show(bytearray(32))  # its pins are dead
    assert world.lcd() == ("SECOND LIFE     ",) * 2
    world.check()


# --- the clock's part ----------------------------------------------------------------------------


def test_nobody_sleeps_longer_than_the_contract_allows():
    clock = LcdBench().clock
    before_us = clock.now_us
    clock.sleep_us(100)
    clock.sleep_us(0)
    assert clock.now_us == before_us + 100
    assert refused(ValueError, clock.sleep_us, 101)


def test_each_controller_has_a_memory_of_its_own():
    bench = LcdBench()
    other = Lcd(bench.clock)
    bench.start()
    bench.letters(b"A")
    assert bench.lcd.characters == 1 and other.characters == 0 and not other.is_on
