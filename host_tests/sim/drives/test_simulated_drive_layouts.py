# SPDX-License-Identifier: MIT
"""The simulated drive in every layout: 0, 3, 4 or variable PKW words, 0...16 PZD words.

It is the drive of the specification (generic.py), which can be set to all of them. Section numbers
are those of the USS specification ("SPEC").
"""

from boards.sim.drives.families import generic, mm440
from drive_bench import HALF, OFF1, RUN, Bench, float_words, telegram

VARIABLE = 127
PZD_WORDS = range(17)


def drive_of(pkw_words, pzd_words, **more):
    return Bench({2013: pkw_words, 2012: pzd_words, 1120: 0.0}, family=generic, **more)


def pzd(count, stw=OFF1, hsw=0):
    """So many words to the drive, the further ones telling their place."""
    return ([stw, hsw] + [0x0300 + place for place in range(2, 16)])[:count]


def test_process_data_of_every_length():
    for pkw_words in (0, 3, 4, VARIABLE):
        pkw = [0] * (3 if pkw_words == VARIABLE else pkw_words)
        for count in PZD_WORDS:
            if not pkw and not count:
                continue
            bench = drive_of(pkw_words, count)
            bench.exchange(*pkw + pzd(count))
            reply = bench.exchange(*pkw + pzd(count, RUN, HALF))
            there = count >= 2
            expected = [0xFB34 if there else 0xFA34, HALF, 0, 0x06E6] + [0] * 12
            if count == 1:
                expected[0] = 0xFB34  # at 0 Hz
            assert reply == pkw + expected[:count], (pkw_words, count, reply)
            image = [bench.drive.read(2018, i) for i in range(16)]
            assert image == pzd(count, RUN, HALF) + [0] * (16 - count)
            assert bench.drive.layout == (pkw_words, count)


def test_further_words_are_what_p2019_says():
    bench = drive_of(0, 16)
    for place in range(4, 16):
        bench.drive.write(2019, place, (52, 21, 54, 55)[place % 4] << 16)
    bench.exchange(*pzd(16))
    reply = bench.exchange(*pzd(16, RUN, HALF))
    assert reply[4:] == [0xFB34, HALF, RUN, 0x0303] * 3


def test_a_telegram_of_another_length_is_not_answered():
    for pkw_words, count in ((0, 2), (3, 2), (4, 2), (4, 16), (0, 16), (3, 0)):
        bench = drive_of(pkw_words, count)
        for words in range(1, 30):
            answered = bench.exchange(*[0] * words) is not None
            assert answered == (words == pkw_words + count), (pkw_words, count, words)


def test_set_to_no_words_at_all_it_hears_nothing():
    # LGE is 3 at least (SPEC ): a telegram without net data is not one.
    for pkw_words in (0, VARIABLE):
        bench = drive_of(pkw_words, 0)
        for address in (1, 0x41):
            assert bench.ask(telegram(address)) is None
        assert bench.drive.read(2031) == bench.drive.read(2025) == 2 and not bench.drive.read(2024)


def test_without_process_data_only_parameters():
    # C-8 example 6: AK 2 writes P18 = 7000h; C-8 example 5: AK 8 writes P4, second element.
    bench = drive_of(4, 0)
    assert bench.exchange(0x2012, 0, 0, 0x7000) == [0x1012, 0, 0, 0x7000]
    assert bench.exchange(0x8004, 2, 0x4000, 0) == [0x5004, 2, 0x4000, 0]
    assert bench.drive.read(4, 1) == 0x40000000


# --- variable length: SPEC C-4.1.2 ------------------------------------------------------------


def test_all_elements_of_an_array():
    bench = drive_of(VARIABLE, 2)
    data = (OFF1, 0)
    for request, reply in (
        # doubles: P4, read, written, read
        ((0x6004, 0x00FF, 0), [0x5004, 0x00FF, 0, 1, 0, 2, 0, 3, 0, 4]),
        ((0x8004, 0x00FF, 1, 1, 2, 2, 3, 3, 4, 4), [0x5004, 0x00FF, 1, 1, 2, 2, 3, 3, 4, 4]),
        # words: P9
        ((0x6009, 0x00FF, 0), [0x4009, 0x00FF, 5, 5, 5]),
        ((0x7009, 0x00FF, 1, 2, 3), [0x4009, 0x00FF, 1, 2, 3]),
        # one element beyond its limits: none is written
        ((0x7009, 0x00FF, 4, 5, 10), [0x7009, 0x00FF, 2, 9, 9]),
        # too few, too many, no array
        ((0x7009, 0x00FF, 4, 5), [0x7009, 0x00FF, 108]),
        ((0x7009, 0x00FF, 4, 5, 6, 7), [0x7009, 0x00FF, 108]),
        ((0x6012, 0x00FF, 0), [0x7012, 0x00FF, 4]),
        ((0x9009, 0, 0), [0x6009, 0, 3]),
    ):
        assert bench.exchange(*request + data)[:-2] == reply, request
    assert [bench.drive.read(9, i) for i in range(3)] == [1, 2, 3]


def test_all_elements_into_the_eeprom():
    bench = drive_of(VARIABLE, 2)
    bench.exchange(0xC009, 0x00FF, 1, 2, 3, OFF1, 0)
    bench.exchange(0x7009, 0x00FF, 4, 5, 6, OFF1, 0)
    assert bench.drive.eeprom_writes == 3
    bench.drive.power_off()
    bench.drive.power_on()
    assert [bench.drive.read(9, i) for i in range(3)] == [1, 2, 3]


def test_all_elements_need_variable_length_and_room():
    for pkw_words in (3, 4):
        bench = drive_of(pkw_words, 2)
        rest = [0] * (pkw_words - 2)
        reply = bench.exchange(*[0x6009, 0x00FF] + rest + [OFF1, 0])
        assert reply[:2] + reply[pkw_words - 1 : pkw_words] == [0x7009, 0x00FF, 102]
    bench = drive_of(VARIABLE, 16)
    reply = bench.exchange(*[0x6012 | 1, 0x80FF, 0] + pzd(16))  # P2019: 16 double words
    assert len(reply) == 2 + 32 + 16


def test_elements_count_from_one_where_the_specification_has_its_way():
    bench = drive_of(VARIABLE, 2)
    assert bench.exchange(0x6004, 1, 0, OFF1, 0)[2:4] == [0, 1]
    assert bench.exchange(0x6004, 4, 0, OFF1, 0)[2:4] == [0, 4]
    for index in (0, 5):
        assert bench.exchange(0x6004, index, 0, OFF1, 0)[:3] == [0x7004, index, 3]
    assert bench.exchange(0x6012, 1, 0, OFF1, 0)[:3] == [0x7012, 1, 4]  # P18 is no array


def test_neighbours_of_a_number_that_does_not_exist():
    # Error 0 and the next existing number (RM420), and the one before (G110D).
    bench = drive_of(VARIABLE, 2)
    assert bench.exchange(0x1008, 0, 0, OFF1, 0)[:-2] == [0x7008, 0, 0, 9, 7]
    assert bench.exchange(0x1001, 0, 0, OFF1, 0)[:-2] == [0x7001, 0, 0, 2, 0]
    assert bench.exchange(0x17CF, 0x8000, 0, OFF1, 0)[:-2] == [0x77CF, 0x8000, 0, 0, 3986]
    # V59 V60, of an MM4: the next one only, and in variable length alone
    bench = Bench({2013: VARIABLE}, family=mm440)
    assert bench.exchange(0x1001, 0, 0, OFF1, 0)[:-2] == [0x7001, 0, 0, 2]
    bench = Bench(family=mm440)
    assert bench.exchange(0x1001, 0, 0, 0, OFF1, 0)[:-2] == [0x7001, 0, 0, 0]


def test_legal_values_next_to_an_illegal_one():
    # Error 2, the next and the previous legal value (RM420): both the limit, a word only.
    bench = drive_of(VARIABLE, 2)
    assert bench.exchange(0x200B, 0x8000, 32, OFF1, 0)[:-2] == [0x700B, 0x8000, 2, 31, 31]
    assert bench.exchange(0x2013, 0, 0xF000, OFF1, 0)[:-2] == [0x7013, 0, 2, 0xFC18, 0xFC18]
    words = (0x3460, 0) + float_words(651.0) + (OFF1, 0)
    assert bench.exchange(*words)[:-2] == [0x7460, 0, 2]
    bench = drive_of(4, 2)
    assert bench.exchange(0x200B, 0x8000, 0, 32, OFF1, 0)[:-2] == [0x700B, 0x8000, 0, 2]


def test_a_signed_word():
    bench = drive_of(3, 2)
    assert bench.exchange(0x1013, 0, 0, OFF1, 0)[2] == 0xFFFF
    assert bench.exchange(0x2013, 0, 0xFF00, OFF1, 0)[:3] == [0x1013, 0, 0xFF00]
    assert bench.drive.read(19) == -256


# --- broadcast: SPEC A-3, C-5.2.3 -------------------------------------------------------------


def test_broadcast_takes_what_the_enable_array_lets_through():
    bench = drive_of(4, 16)

    def image():
        return [bench.drive.read(2018, i) for i in range(16)]

    old = [OFF1, 0] + [0] * 14
    new = [RUN, 0x2000] + [0x1000 * i for i in range(2, 16)]
    for enable, taken in (
        ((0x0000, 0xFFFF, 0xFFFF, 0xFFFF), ()),
        ((0x0005, 0, 0, 0), (1,)),  # the main setpoint alone
        ((0xFFF1, 0, 0xFFFF, 0xFFFF), tuple(range(3, 15))),  # never PZD16
        ((0x0009, 0, 0, 0), (2,)),
        ((0xFFFF, 0xFFFF, 0xFFFF, 0xFFFF), tuple(range(15))),
    ):
        bench.exchange(*[0, 0, 0, 0] + old)
        # Bit 10 of the control word says in each that the words are valid.
        assert bench.ask(telegram(0x20, *list(enable) + new)) is None
        expected = [new[i] if i in taken else old[i] for i in range(16)]
        assert image() == expected, (enable, image())


def test_broadcast_takes_pzd4_and_pzd5_bit_by_bit():
    bench = drive_of(4, 6)
    bench.exchange(0, 0, 0, 0, OFF1, 0, 0, 0xAAAA, 0x5555, 0)
    bench.ask(telegram(0x20, 0x0031, 0, 0x00FF, 0x0F0F, OFF1, 0, 0, 0x1234, 0x1234, 0x1234))
    assert [bench.drive.read(2018, i) for i in (3, 4, 5)] == [0xAA34, 0x5254, 0]


def test_broadcast_reaches_a_drive_of_variable_length_by_four_words():
    bench = drive_of(VARIABLE, 2)
    bench.exchange(0, 0, 0, OFF1, 0)
    bench.ask(telegram(0x20, 0x0005, 0, 0, 0, OFF1, 0x1111))
    assert bench.drive.read(2018, 1) == 0x1111
    bench.ask(telegram(0x20, 0x0005, 0, 0, OFF1, 0x2222))
    assert bench.drive.read(2018, 1) == 0x1111


# --- a write that stands ----------------------------------------------------------------------


def test_a_standing_write_may_be_carried_out_every_time():
    # SPEC C-4.2.1.1 does not forbid it; the EEPROM wears out.
    bench = drive_of(4, 2)
    for repeats, writes in ((False, 1), (True, 6)):
        bench.drive.reexecute = repeats
        for _ in range(5):
            assert bench.exchange(0xE012, 0, 0, 7, OFF1, 0)[:4] == [0x1012, 0, 0, 7]
        bench.exchange(0, 0, 0, 0, OFF1, 0)
        assert bench.drive.eeprom_writes == writes
    assert bench.drive.reexecute
    bench.exchange(0x23CB, 0, 0, 1, OFF1, 0)
    assert bench.drive.eeprom_writes == 7  # P0971 counts once
