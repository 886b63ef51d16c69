# SPDX-License-Identifier: MIT
"""The simulated drive's descriptions, texts and change reports: tasks 4, 5, 15, replies 9...12.

Only the drive of the specification has them all. Section numbers are those of the USS
specification ("SPEC"); the vectors SP7 and SP8 are its own examples.
"""

from boards.sim.drives.families import g110, generic, mm3, mm420, mm440, v20
from drive_bench import OFF1, Bench, float_words, from_hex, telegram

VARIABLE = 127
PZD = (OFF1, 0)


def drive_of(pkw_words=VARIABLE, pzd_words=2, **more):
    return Bench({2013: pkw_words, 2012: pzd_words}, family=generic, **more)


def text_of(words):
    return b"".join([bytes((word >> 8, word & 0xFF)) for word in words]).decode()


# --- descriptions: SPEC C-6 -------------------------------------------------------------------


def test_elements_of_a_description():
    bench = drive_of()

    def element(number, which):
        page = 0x8000 if number >= 2000 else 0
        reply = bench.exchange(*(0x4000 | number % 2000, page | which, 0) + PZD)[:-2]
        assert reply[:2] == [0x3000 | number % 2000, page | which], (number, which)
        return tuple(reply[2:])

    assert element(1120, 1) == (8,)  # a float
    assert element(52, 1) == (0x0206,)  # a word, read-only
    assert element(4, 1) == (0x4007,)  # an array of double words
    assert element(7, 1) == (0x0406,)  # with texts
    assert element(700, 1) == (0x1006,)  # not as delivered
    assert [element(number, 2) for number in (4, 700)] == [(4,), (1,)]
    assert element(1120, 3) == float_words(1.0)
    assert element(1120, 4) == (0x0400,)
    assert len(element(1120, 5)) == 2
    assert text_of(element(1120, 6)) == "ramp-up time    "
    assert text_of(element(700, 6)) == "command source  "
    assert element(1120, 7) == float_words(0.0) and element(1120, 8) == float_words(650.0)
    assert element(2011, 8) == (31,) and element(19, 7) == (0xFC18,)
    assert element(1120, 9) == float_words(10.0) and element(2019, 9) == (0x0034, 0)
    assert element(1120, 10) == (0,)
    assert element(52, 7) == element(52, 8) == (0,)


def test_the_complete_description():
    # 36 characters for a word, 40 for a double word: elements 1 to 8 and 10.
    bench = drive_of()
    word = bench.exchange(*(0x42BC, 255, 0) + PZD)[2:-2]
    double = bench.exchange(*(0x4460, 255, 0) + PZD)[2:-2]
    assert (len(word), len(double)) == (18, 20)
    assert text_of(double[7:15]) == "ramp-up time    "


def test_descriptions_that_there_are_not():
    bench = drive_of()
    for pke, which, error in ((0x4460, 0, 9), (0x4460, 11, 9), (0x5460, 7, 7), (0x5460, 0, 9)):
        assert bench.exchange(*(pke, which, 0) + PZD)[2] == error, (pke, which)
    assert bench.exchange(*(0x4001, 1, 0) + PZD)[2] == 0
    bench = Bench(family=mm440)
    assert bench.exchange(0x4460, 8, 0, 0, OFF1, 0)[:4] == [0x3460, 8] + list(float_words(650.0))
    assert bench.exchange(0x4460, 6, 0, 0, OFF1, 0)[:4] == [0x7460, 6, 0, 9]
    # All of it, which there is in variable length, has no room (OI440: "channel too small").
    assert bench.exchange(0x4460, 255, 0, 0, OFF1, 0)[:4] == [0x7460, 255, 0, 102]
    bench = Bench({2013: 3})
    assert bench.exchange(0x4460, 255, 0, OFF1, 0)[:3] == [0x7460, 255, 102]
    assert Bench(family=mm3).exchange(0x4002, 8, 0, OFF1, 0)[2] == 106


def test_a_micromaster_4_tells_more_in_variable_length():
    # Elements 1, 2, 7, 8 and 9 always, 3, 4, 6 and 255 in variable length: a choice.
    for pkw_words, there in ((4, (1, 2, 7, 8, 9)), (VARIABLE, (1, 2, 3, 4, 6, 7, 8, 9, 255))):
        for family in (mm420, mm440, g110, v20):
            bench = Bench({2013: pkw_words, 2014: 0}, family=family)
            for which in tuple(range(12)) + (255,):
                words = [0x4460, which] + [0] * (2 if pkw_words == 4 else 1) + [OFF1, 0]
                reply = bench.exchange(*words)[:-2]
                assert (reply[0] == 0x3460) == (which in there), (family.NAME, which)
                assert which in there or reply[-1] == (102 if which == 255 else 9)
                if which == 6 and which in there:
                    assert text_of(reply[2:]) == "ramp-up time    "


def test_an_element_that_does_not_fit():
    # Three words: two characters; four: four; the name in variable length only (SPEC C-6).
    for pkw_words, fitting in ((3, (1, 2, 4, 10)), (4, (1, 2, 3, 4, 5, 7, 8, 9, 10))):
        bench = drive_of(pkw_words)
        for which in tuple(range(1, 11)) + (255,):
            words = [0x4460, which] + [0] * (pkw_words - 2) + [OFF1, 0]
            reply = bench.exchange(*words)
            ak = reply[0] >> 12
            assert ak == (3 if which in fitting else 7), (pkw_words, which)
            assert ak == 3 or reply[pkw_words - 1] == 102


# --- texts: SPEC C-4.2.2 ----------------------------------------------------------------------

# Examples 7 and 8 of the specification, a bus without PZD words.
TEXT_EXCHANGES = (
    ("SP7", "02 08 01 F0 07 00 03 00 00 FF",
     "02 16 01 F0 07 00 03 33 30 30 20 42 41 55 44 20 20 20 20 20 20 20 20 E0"),
    ("SP8a", "02 08 01 F0 09 00 02 00 00 F0",
     "02 16 01 F0 09 00 02 42 41 55 44 52 41 54 45 20 46 4F 52 20 53 53 32 97"),
    ("SP8b", "02 16 01 F0 09 01 02 42 41 55 44 52 41 54 45 20 46 4F 52 20 53 53 32 96",
     "02 16 01 F0 09 01 02 42 41 55 44 52 41 54 45 20 46 4F 52 20 53 53 32 96"),
    ("SP8c", "02 08 01 F0 09 02 04 00 00 F4",
     "02 16 01 F0 09 02 04 31 32 30 30 20 42 41 55 44 20 20 20 20 20 20 20 FB"),
    ("SP8d", "02 16 01 F0 09 03 04 31 32 30 30 20 42 41 55 44 20 20 20 20 20 20 20 FA",
     "02 16 01 F0 09 03 04 31 32 30 30 20 42 41 55 44 20 20 20 20 20 20 20 FA"),
)  # fmt: skip


def test_texts_as_in_the_specification():
    bench = drive_of(pzd_words=0)
    for name, request, reply in TEXT_EXCHANGES:
        assert bench.ask(from_hex(request)) == from_hex(reply), name


def test_a_text_that_was_written_is_read():
    bench = drive_of()
    words = tuple(0x4100 + i for i in range(8))
    assert bench.exchange(*(0xF009, 0x0101) + words + PZD)[2:-2] == list(words)
    assert bench.exchange(*(0xF009, 0x0001, 0) + PZD)[2:-2] == list(words)
    assert bench.exchange(*(0xF009, 0x0002, 0) + PZD)[2] == 0x4241


def test_texts_that_there_are_not():
    bench = drive_of()
    for pke, ind, error in (
        (0xF009, 255, 102), (0xF012, 1, 15), (0xF009, 9, 3), (0xF001, 1, 0), (0xF009, 0x0101, 108),
    ):  # fmt: skip
        assert bench.exchange(*(pke, ind, 0) + PZD)[2] == error, (pke, ind)
    assert drive_of(4).exchange(0xF009, 1, 0, 0, OFF1, 0)[3] == 102
    bench.drive.write(927, 0, 7)
    assert bench.exchange(*(0xF009, 0x0001, 0) + PZD)[0] == 0xF009  # reading needs no rights
    assert bench.exchange(*(0xF009, 0x0101) + (0x4141,) * 8 + PZD)[:2] == [0x8009, 0x0101]


# --- change reports: SPEC C-4.2.1.2 -----------------------------------------------------------


def test_a_report_is_repeated_until_bit_11_is_echoed():
    bench = drive_of(4, reports=True)
    read = (0x13E8, 0, 0, 0) + PZD
    acknowledged = (0x1BE8, 0, 0, 0) + PZD
    assert bench.exchange(*read)[:4] == [0x13E8, 0, 0, 5]
    bench.drive.write(700, 0, 2)
    for _ in range(3):
        assert bench.exchange(*read)[:4] == [0x9ABC, 0, 0, 2]  # V62
    assert bench.exchange(*acknowledged)[:4] == [0x1BE8, 0, 0, 5]  # V64
    assert bench.exchange(*acknowledged)[:4] == [0x1BE8, 0, 0, 5]


def test_the_example_with_a_lost_reply():
    # Two reports while task 2 waits for its reply; the second one is lost once.
    bench = drive_of(4, reports=True)
    task_1, task_2 = 0x13E8, 0x12BC
    assert bench.exchange(task_1, 0, 0, 0, OFF1, 0)[0] == 0x13E8
    bench.drive.write(1120, 0, 3.0)
    bench.drive.write(9, 1, 8)
    ramp = [0xAC60, 0] + list(float_words(3.0))
    element = [0xB009, 2, 0, 8]
    assert bench.exchange(task_2, 0, 0, 0, OFF1, 0)[:4] == ramp
    for _ in range(2):  # the master has not heard the first of them
        assert bench.exchange(task_2 | 0x0800, 0, 0, 0, OFF1, 0)[:4] == element
    assert bench.exchange(task_2, 0, 0, 0, OFF1, 0)[:4] == [0x12BC, 0, 0, 5]


def test_a_report_keeps_its_bit_with_no_task():
    bench = drive_of(3, reports=True)
    bench.drive.write(1120, 0, 3.0)  # a double word: the high word fits
    assert bench.exchange(0, 0, 0, OFF1, 0)[:3] == [0xAC60, 0, float_words(3.0)[0]]
    assert bench.exchange(0x0800, 0, 0, OFF1, 0)[:3] == [0x0800, 0, 0]


def test_a_report_of_a_whole_array():
    for pkw_words, request, report in (
        (VARIABLE, (0, 0, 0), [0xB809, 0x00FF, 1, 2, 3]),
        (4, (0, 0, 0, 0), [0xB809, 0x00FF, 0, 0]),  # without the values
    ):
        bench = drive_of(pkw_words, reports=True)
        bench.drive.write(9, 255, (1, 2, 3))
        assert bench.exchange(*request + PZD)[:-2] == report
        assert [bench.drive.read(9, i) for i in range(3)] == [1, 2, 3]


def test_a_number_on_another_page_is_reported_with_it():
    bench = drive_of(4, reports=True)
    bench.drive.write(2009, 0, 1)
    assert bench.exchange(0, 0, 0, 0, OFF1, 0)[:4] == [0xB809, 0x8001, 0, 1]


def test_what_the_master_writes_is_not_reported():
    bench = drive_of(4, reports=True)
    assert bench.exchange(0x22BC, 0, 0, 2, OFF1, 0)[:4] == [0x12BC, 0, 0, 2]
    assert bench.exchange(0, 0, 0, 0, OFF1, 0)[0] == 0


def test_without_reports_nothing_is_told():
    bench = drive_of(4)
    bench.drive.write(700, 0, 2)
    assert bench.exchange(0, 0, 0, 0, OFF1, 0)[0] == 0


def test_reports_that_nobody_acknowledges_are_bounded():
    bench = drive_of(4, reports=True)
    for i in range(100):
        bench.drive.write(18, 0, i)
    told = 0
    pke = 0
    for _ in range(100):
        reply = bench.exchange(pke, 0, 0, 0, OFF1, 0)
        told += reply[0] >> 12 == 9
        pke = reply[0] & 0x0800
    assert told == 16


def test_mirror_telegrams_are_not_looked_into():
    bench = drive_of(VARIABLE, reports=True)
    mirror = telegram(0x41, 0xF009, 0x0101, 1, 2, 3, 4, 5, 6, 7, 8, OFF1, 0)
    assert bench.ask(mirror) == mirror
    assert bench.exchange(*(0xF009, 0x0001, 0) + PZD)[2] == 0x4241
