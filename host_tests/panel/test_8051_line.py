# SPDX-License-Identifier: MIT
"""What an earlier 8051 panel for the same drives did wrong, and this one does right: the line.

Each of its 21 known defects has a test that shows the right behaviour on the whole panel; the
first line of the test names the defect. Here are 7 to 10, 16, 17, 20 and 21, which show on the
line. Those of keys and display are in test_8051_panel.py.

Replies are changed between the drive and the line by a `Spoiler`. The UART of the RP2040 hands a
character with wrong parity over as if it were good, so that a character is never missing for it.
"""

import main
from boards.sim.drives.families import mm420
from boards.sim.world import World
from panel_bench import OFF1, ON, panel, row_1, row_2, running, telegrams
from receiver_bench import REPLY, TCH, Line
from settings_file import load
from uss import pkw
from uss.drive import COUNTERS
from uss.receiver import WAITING
from uss.telegram import GOOD
from uss.timing import BAUD_RATES

# ZSW and HIW. The second and the third are what a spoiled reply claims instead of the first.
RIGHT = (0xFB34, 0x0CCD)  # 10 Hz of 50 Hz
STANDING = (0xFB31, 0x0000)
LEFT = (0xBB34, 0xF333)


class Spoiler:
    """Sits in a drive's plug and changes what it sends: change(characters) -> characters.

    count: how many replies it has seen; spoiled: in how many of them it changed something.
    """

    def __init__(self, drive, change):
        self.count = 0
        self.spoiled = 0
        self._change = change
        self._drive = drive
        self._wire = drive.wire
        drive.wire = self

    def talk(self, station, data, count):
        reply = bytes(data[:count])
        changed = self._change(reply)
        self.count += 1
        self.spoiled += changed != reply
        return self._wire.talk(station, changed, len(changed)) if changed else None

    def remove(self):
        self._drive.wire = self._wire


def sealed(characters):
    """With the BCC that belongs to it."""
    check = 0
    for character in characters[:-1]:
        check ^= character
    return characters[:-1] + bytes((check,))


def with_words(reply, at, *words):
    """With other words from character `at` on, and the BCC as it was."""
    characters = []
    for word in words:
        characters += [word >> 8, word & 0xFF]
    return reply[:at] + bytes(characters) + reply[at + len(characters) :]


def claims(reply, zsw_and_hiw):
    """With another ZSW and HIW, and the BCC as it was."""
    return with_words(reply, 11, *zsw_and_hiw)


def once(change):
    """A change of the next reply only."""
    left = [1]

    def change_once(reply):
        if not left:
            return reply
        left.clear()
        return change(reply)

    return change_once


def bus_drive(world):
    """The drive as the panel's bus master keeps it."""
    return world.app.bus.turns.drives[0]


def known(world):
    """ZSW and HIW that the panel goes by."""
    return bus_drive(world).zsw, bus_drive(world).hiw


def counted(world, name):
    return bus_drive(world).counters[COUNTERS.index(name)]


def failures(world):
    """Exchanges that brought no valid reply."""
    return sum(bus_drive(world).counters) - counted(world, "good")


# --- which replies count -------------------------------------------------------------------------

# What is wrong with a reply whose BCC is right; what it is counted as; how it is made.
FOREIGN = (
    ("the next address", "address", lambda reply: sealed(reply[:2] + b"\x02" + reply[3:])),
    ("a mirror telegram", "address", lambda reply: sealed(reply[:2] + b"\x41" + reply[3:])),
    ("a broadcast", "address", lambda reply: sealed(reply[:2] + b"\x21" + reply[3:])),
    ("two words less", "length", lambda reply: sealed(b"\x02\x0a" + reply[2:3] + reply[7:])),
    ("a word more", "length", lambda reply: sealed(b"\x02\x10" + reply[2:] + bytes(2))),
    ("LGE too small", "length", lambda reply: sealed(b"\x02\x0c" + reply[2:])),
)  # fmt: skip


def standing_and(change):
    return lambda reply: change(sealed(claims(reply, STANDING)))


def test_a_reply_with_another_address_or_length_is_not_taken():
    """Defect 7: neither ADR nor LGE of a reply was looked at."""
    for what, counter, change in FOREIGN:
        world = running()
        good, before = counted(world, "good"), counted(world, counter)
        spoiler = Spoiler(world.drives[1], standing_and(change))
        world.run(500)
        assert spoiler.spoiled > 10 and counted(world, counter) - before > 10, what
        assert counted(world, "good") - good <= 1, what  # one may have been under way
        assert known(world) == RIGHT, what
        assert row_1(world) == "S: 10.0 F: -----", what  # not known for the time being
        spoiler.remove()
        world.run(500)
        assert world.lcd() == ("S: 10.0 F: 10.00", "RUNNING      A1 "), what
        world.check()


# How a reply to "read P1120" may not fit the question: PKE and IND of it.
UNFITTING = (
    ("another number", 0x245F, 0x0000),
    ("another page", 0x2460, 0x8000),
    ("another index", 0x2460, 0x0001),
    ("an element of an array", 0x5460, 0x0000),
    ("no task", 0x0460, 0x0000),
    ("something undefined", 0xF460, 0x0000),
)


def misanswering(pke, ind):
    """A change of the replies that carry P1120."""

    def change(reply):
        if reply[3:7] != b"\x24\x60\x00\x00":
            return reply
        return sealed(with_words(reply, 3, pke, ind))

    return change


def test_an_answer_with_another_number_index_or_kind_is_none():
    """Defect 7: PKE, IND and AK were not compared with the question."""
    for what, pke, ind in UNFITTING:
        world = panel()
        spoiler = Spoiler(world.drives[1], misanswering(pke, ind))
        job = pkw.read(1120)
        bus_drive(world).ask(job)
        world.run(1000)
        assert spoiler.spoiled > 5 and job.state == pkw.PENDING, what
        spoiler.remove()
        world.run(500)
        assert job.state == pkw.DONE and job.float_value() == 10.0, what
        world.check()


def test_nothing_of_a_reply_with_a_wrong_bcc_is_used():
    """Defect 8: the direction was taken from it, so that the sign flickered."""
    world = running()
    turn = [0]

    def every_second(reply):
        turn[0] ^= 1
        return claims(reply, LEFT) if turn[0] else reply

    spoiler = Spoiler(world.drives[1], every_second)
    bad = counted(world, "bcc")
    for _ in range(200):
        world.run(10)
        assert known(world) == RIGHT
        assert row_1(world) == "S: 10.0 F: 10.00"
    assert counted(world, "bcc") - bad >= spoiler.spoiled - 1 > 30
    world.check()


def longer(reply):
    return sealed(b"\x02\x18" + reply[2:] + bytes(10))


def test_after_a_bad_reply_the_pause_before_the_next_telegram_is_kept_all_the_same():
    """Defect 8: a bad reply hurried it, though its characters might still be coming in."""
    for polled in (False, True):
        for change in (lambda reply: claims(reply, LEFT), longer):
            world = running(polled=polled)
            spoiler = Spoiler(world.drives[1], change)
            world.run(900)
            assert spoiler.spoiled > 20
            last = world.wire.log.last(40)
            for before, after in zip(last, last[1:]):
                silence_us = after[0] - before[0] - world.wire.ends[len(before[2]) - 1]
                assert silence_us >= world.wire.start_interval_us - 1, silence_us
            world.check()


def flipping(place, bit):
    return lambda reply: reply[:place] + bytes((reply[place] ^ bit,)) + reply[place + 1 :]


def test_one_wrong_bit_anywhere_costs_the_whole_reply_and_only_that():
    """Defect 9: a character with wrong parity was left out and the rest moved up."""
    world = running()
    for place in range(16):
        for bit in range(8):
            good, bad = counted(world, "good"), failures(world)
            spoiler = Spoiler(world.drives[1], once(flipping(place, 1 << bit)))
            while failures(world) == bad and counted(world, "good") - good < 3:
                world.run(1)
                assert known(world) == RIGHT, (place, bit)
            assert counted(world, "good") - good <= 1, (place, bit)
            world.run(30)
            assert spoiler.spoiled == 1 and failures(world) == bad + 1, (place, bit)
            spoiler.remove()
    assert world.lcd() == ("S: 10.0 F: 10.00", "RUNNING      A1 ")
    world.check()


# --- what follows a reply that failed ------------------------------------------------------------


def without(place):
    return lambda reply: reply[:place] + reply[place + 1 :]


def only(length):
    return lambda reply: reply[:length]


def test_after_a_lost_character_the_next_exchange_works():
    """Defect 10: the panel waited for it for ever, and counted it in the next reply."""
    for polled in (False, True):
        world = running(polled=polled)
        for place in range(16):
            bad = failures(world)
            spoiler = Spoiler(world.drives[1], once(without(place)))
            world.run(60)  # the one that was under way, and the one that failed
            good = counted(world, "good")
            world.run(60)
            assert spoiler.spoiled == 1 and failures(world) == bad + 1, (polled, place)
            assert counted(world, "good") - good >= 2, (polled, place)
            spoiler.remove()
        assert world.lcd() == ("S: 10.0 F: 10.00", "RUNNING      A1 ")
        world.check()


def test_a_reply_that_breaks_off_anywhere_holds_up_nothing():
    """Defect 10: so did a reply of which only the beginning came."""
    for polled in (False, True):
        world = running(polled=polled)
        for length in range(16):
            bad = failures(world)
            spoiler = Spoiler(world.drives[1], once(only(length)))
            world.run(70)
            good = counted(world, "good")
            world.run(60)
            assert failures(world) == bad + 1, (polled, length)
            assert counted(world, "good") - good >= 2, (polled, length)
            spoiler.remove()
        world.check()


def preceding(characters):
    return lambda reply: characters + reply


def test_02h_inside_of_data_begins_no_telegram():
    """Defect 20: any 02h began one, whether or not the line had been silent before it.

    A whole and valid reply that other characters precede without a pause is part of those.
    """
    for before in (b"\x55", b"\x02", b"\x02\x0e", b"\x02\x0e\x01", bytes(5), b"\x02\x12\x01"):
        world = running()
        good = counted(world, "good")
        spoiler = Spoiler(world.drives[1], standing_and(preceding(before)))
        world.run(500)
        assert spoiler.spoiled > 5 and counted(world, "good") - good <= 1, before
        assert known(world) == RIGHT, before
        spoiler.remove()
        world.run(500)
        assert world.lcd() == ("S: 10.0 F: 10.00", "RUNNING      A1 "), before
        world.check()


def test_02h_inside_of_data_begins_no_telegram_where_the_line_is_looked_at():
    """Defect 20, without a receive interrupt: a look may fall between such characters and STX."""
    for count in (14, 15, 16, 18, 20, 25, 30):
        world = running(polled=True)
        good = counted(world, "good")
        spoiler = Spoiler(world.drives[1], standing_and(preceding(b"\x55" * count)))
        world.run(500)
        assert spoiler.spoiled > 5 and counted(world, "good") - good <= 1, count
        assert known(world) == RIGHT, count
        world.check()


def test_02h_begins_a_telegram_only_after_the_start_interval():
    """Defect 20, where the instant of each character is known: two characters of silence."""
    for pause_us, finding in (
        (0, WAITING),
        (TCH, WAITING),
        (2 * TCH - 9, WAITING),
        (2 * TCH, GOOD),
    ):
        line = Line()
        assert line.come(b"\x55", 3 * TCH) == WAITING
        assert line.come(REPLY, pause_us) == finding, pause_us


def test_a_reply_full_of_02h_is_one_reply():
    """Defect 20, the other way round: 02h may be data."""
    world = running()
    words = (0x0234, 0x0202)  # 1.57 Hz of 50 Hz
    Spoiler(world.drives[1], lambda reply: sealed(claims(reply, words)))
    bad = failures(world)
    world.run(500)
    assert row_1(world) == "S: 10.0 F:  1.57" and failures(world) == bad
    world.check()


# --- parameters of any index and width -----------------------------------------------------------


def answered(world, job):
    bus_drive(world).ask(job)
    world.run(1500)
    assert job.state == pkw.DONE, job
    return job


def test_a_parameter_of_any_index_can_be_read_and_written():
    """Defect 16: the low byte of IND, which is the index, was always 0."""
    world = panel()
    drive = world.drives[1]
    for index, value in enumerate((0x00340000, 0x00150000, 0, 0x00350000)):
        assert answered(world, pkw.read(2019, index)).integer_value() == value, index
    answered(world, pkw.write_word(2014, 1234, 1))
    assert drive.read(2014, 1) == 1234 and drive.read(2014, 0) == 2000
    sent = [characters[3:11] for _, _, characters in world.wire.log.last(1000)]
    assert b"\x20\x0e\x80\x01\x00\x00\x04\xd2" in sent
    world.check()


def test_values_of_32_bits_and_frequencies_can_be_read_and_written():
    """Defect 16: only 16-bit values were known."""
    world = panel()
    drive = world.drives[1]
    assert answered(world, pkw.read(1082)).float_value() == 50.0
    assert answered(world, pkw.read(700)).integer_value() == 5
    answered(world, pkw.write_float(1120, 2.5))
    assert drive.read(1120) == 2.5
    answered(world, pkw.write_double(2019, 0x00180000, 2))  # r0024 in the third word
    assert drive.read(2019, 2) == 0x00180000
    assert answered(world, pkw.read(2019, 2)).integer_value() == 0x00180000
    world.check()


# --- nothing waits for anything ------------------------------------------------------------------


def rates(world, ms):
    """How many telegrams the panel sends in so many milliseconds, and how often its loop turns."""
    keypad = world.app.board.keypad
    read, turns = keypad.read, [0]

    def counting():
        turns[0] += 1
        return read()

    keypad.read = counting
    began = world.app.bus.turns.exchanges
    world.run(ms)
    del keypad.read
    return (world.app.bus.turns.exchanges - began) & 0xFFFF, turns[0]


def test_keys_and_display_slow_down_neither_the_bus_nor_the_loop():
    """Defect 17: delays in interrupts, and a debounce that waited."""
    for polled in (False, True):
        world = running(polled=polled)
        quiet = rates(world, 1000)
        assert quiet[0] >= 40, quiet  # an exchange takes 21.2 ms
        for keys in (("UP",), ("DOWN",), ("PARAM",), ("NEXT",), ("EDIT", "UP"), ("STOP", "START")):
            for key in keys:
                world.down(key)
            busy = rates(world, 1000)
            for key in keys:
                world.up(key)
            let_go = rates(world, 200)
            assert abs(busy[0] - quiet[0]) <= 1, (polled, keys, busy, quiet)
            assert busy[1] >= quiet[1] * 97 // 100, (polled, keys, busy, quiet)
            assert abs(5 * let_go[0] - quiet[0]) <= 5, (polled, keys, let_go, quiet)
        world.check()


def test_the_bus_goes_on_while_the_loop_does_not():
    """Defect 17: it ran by interrupts that waited inside; these do not, and need no loop."""
    for polled in (False, True):
        world = running(polled=polled)
        quiet, _ = rates(world, 1000)
        for hang_ms, stw in ((250, ON), (1000, OFF1)):
            hung_us = world.clock.now_us
            world.hang(hang_ms)
            sent = telegrams(world, hung_us)
            assert abs(len(sent) * 1000 - quiet * hang_ms) <= 1500, (polled, len(sent), quiet)
            assert sent[-1][1] == stw
            world.run(100)
        world.check()


# --- the baud rate -------------------------------------------------------------------------------

TOLERANCE_PERMILLE = 3  # specification B-2.3: 0.3 %

# Specification B-2.4.
SPECIFIED = (
    300, 600, 1200, 2400, 4800, 9600, 19200, 38400, 57600, 76800, 93750, 115200, 187500,
)  # fmt: skip

# Clock of the UART, bits of its divider before and behind the point, clocks of a bit at divider 1.
# RP2040 data sheet 4.2.7.1 (PL011); ESP32 technical reference manual, UART_CLKDIV_REG.
UARTS = (
    ("RP2040", 125_000_000, 16, 6, 16),
    ("ESP32", 80_000_000, 20, 4, 1),
)


def divided(clock_hz, whole_bits, fraction_bits, clocks, baud):
    """The rate that a divider of that many bits comes nearest to: numerator and denominator."""
    numerator = clock_hz << fraction_bits
    steps = (numerator + clocks * baud // 2) // (clocks * baud)
    assert 1 << fraction_bits <= steps < 1 << (whole_bits + fraction_bits), baud
    return numerator, clocks * steps


def test_every_rate_of_uss_can_be_made_exactly_enough():
    """Defect 21: 2451 bit/s instead of 2400, 2.1 % off. A fact of the chips and their clocks."""
    for chip, clock_hz, whole_bits, fraction_bits, clocks in UARTS:
        for baud in BAUD_RATES:
            numerator, denominator = divided(clock_hz, whole_bits, fraction_bits, clocks, baud)
            error = abs(numerator - baud * denominator) * 1000
            assert error <= TOLERANCE_PERMILLE * baud * denominator, (chip, baud)

    assert abs(2451 - 2400) * 1000 > TOLERANCE_PERMILLE * 2400


def test_no_other_rate_than_those_of_uss_can_be_set():
    """Defect 21: whatever the settings say, the line runs at a rate of the specification."""
    assert BAUD_RATES == SPECIFIED
    for baud in mm420.BAUD_CODES.values():
        assert baud in BAUD_RATES
    for baud in (2451, 0, 19201, 250_000, "19200"):
        world = panel(settings={"baud": baud})  # the line runs at 19200, which is the default
        assert row_2(world) == "SETTINGS DAMAGED", baud
        assert world.app.bus.timing.baud == load(world.app.board.store).baud == 19200
        world.run(3000)
        assert row_2(world) == "baud", baud
        world.run(3000)
        assert row_2(world) == "READY        A1", baud
        world.check()


def test_the_line_runs_at_the_rate_that_was_set():
    """Defect 21: and at no other. A telegram of another rate would be noise."""
    for baud in (2400, 9600, 38400, 115200):
        world = World(main.start, baud=baud)
        world.run(4000)
        assert world.chip.uarts[0].baud == baud
        assert row_2(world) == "READY        A1" and failures(world) == 0
        world.check()
