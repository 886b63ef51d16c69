# SPDX-License-Identifier: MIT
"""The simulated drive's parameter channel, tasks and refusals.

Section numbers are those of the USS specification (E20125-D0001-S302-A1-7600, "SPEC"); RM420 is
the MICROMASTER 420 Reference Manual, OI440 the MICROMASTER 440 Operating Instructions.
"""

from boards.sim.drives.families import generic
from drive_bench import HALF, OFF1, RUN, Bench, float_words, from_hex, telegram

# What, PKE, IND, PWE1, PWE2, reply PKE, PWE2
REFUSALS = (
    ("unknown number", 0x1001, 0, 0, 0, 0x7001, 0),
    ("unknown number on another page", 0x13B3, 0x8000, 0, 0, 0x73B3, 0),
    ("PNU beyond 1999, as a master without pages sends P2013", 0x17DD, 0, 0, 0, 0x77DD, 0),
    ("V35: PNU 1999", 0x17CF, 0, 0, 0, 0x77CF, 0),
    ("r0021 is read-only", 0x3015, 0, 0x4120, 0, 0x7015, 1),
    ("P1120 above 650", 0x3460, 0, 0x4422, 0xC000, 0x7460, 2),
    ("P1120 below 0", 0x3460, 0, 0xBF80, 0, 0x7460, 2),
    ("P1120 not a number", 0x3460, 0, 0x7FC0, 0, 0x7460, 2),
    ("P2011 above 31", 0x200B, 0x8000, 0, 32, 0x700B, 2),
    ("P2010 has no index 2", 0x100A, 0x8002, 0, 0, 0x700A, 3),
    ("P0700 has no index 1 on a MICROMASTER 420", 0x12BC, 0x0001, 0, 0, 0x72BC, 3),
    ("P0700 is no array", 0x62BC, 0x0002, 0, 0, 0x72BC, 4),
    ("P1082 is a float", 0x243A, 0, 0, 40, 0x743A, 5),
    ("P0700 is a word", 0x32BC, 0, 0, 5, 0x72BC, 5),
    ("P0700 cannot be 3", 0x22BC, 0, 0, 3, 0x72BC, 104),
    ("P2013 cannot be 5", 0x200D, 0x8000, 0, 5, 0x700D, 104),
    ("all elements do not fit", 0x600A, 0x80FF, 0, 0, 0x700A, 102),
    ("description, of an element that none has", 0x4034, 0x000B, 0, 0, 0x7034, 9),
    ("description, writing", 0x5034, 0x0007, 0, 0, 0x7034, 106),
    ("reserved task", 0xA2BC, 0, 0, 0, 0x72BC, 106),
    ("text", 0xF2BC, 0, 0, 0, 0x72BC, 106),
)


def test_what_cannot_be_done_is_refused_with_a_number():
    bench = Bench()
    for what, pke, ind, pwe1, pwe2, reply_pke, error in REFUSALS:
        assert bench.task(pke, ind, pwe1, pwe2) == (reply_pke, ind, 0, error), what
    bench.drive.write(3, 0, 1)
    assert bench.task(0x200B, 0x8000, 0, 7) == (0x700B, 0x8000, 0, 204)  # P2011 needs P0003 = 2
    assert bench.task(0x100B, 0x8000) == (0x100B, 0x8000, 0, 1)  # reading does not
    assert bench.task(0x2003, 0, 0, 3) == (0x1003, 0, 0, 3)
    assert bench.drive.read(2011) == 1


def test_change_states():
    # C commissioning, U running, T ready: else error 17 (RM420 for P1082).
    bench = Bench()
    bench.run()
    p1082 = (0x343A, 0) + float_words(40.0)
    running = (RUN, HALF)
    assert bench.task(*(p1082 + running)) == (0x743A, 0, 0, 17)
    assert bench.task(0x3000, 0x8000, 0x4248, 0, RUN, HALF) == (0x7000, 0x8000, 0, 17)
    assert bench.task(0x22BC, 0, 0, 2, RUN, HALF) == (0x72BC, 0, 0, 17)
    assert bench.task(0x3460, 0, 0x40A0, 0, RUN, HALF) == (0x2460, 0, 0x40A0, 0)  # P1120: CUT
    assert bench.task(*(p1082 + (OFF1, 0)))[3] == 17  # while it stops
    bench.wait(10)
    assert bench.task(0)[0] == 0
    assert bench.task(*p1082) == (0x243A, 0, 0x4220, 0)
    bench.drive.write(10, 0, 1)
    assert bench.task(0x343A, 0, 0x4248, 0) == (0x243A, 0, 0x4248, 0)
    assert bench.drive.hz() == 0


def test_no_change_rights():
    # P0927 bit 3 = 0: writes get AK 8 (V38), reads are done (SPEC C-4.2.1.1).
    bench = Bench({927: 7})
    for ak in (2, 3, 7, 8, 11, 12, 13, 14):
        assert bench.task(ak << 12 | 700, 0, 0, 2) == (0x82BC, 0, 0, 0), ak
    assert bench.task(0x12BC) == (0x12BC, 0, 0, 5)
    assert bench.task(0x239F | 0, 0, 0, 15)[0] == 0x839F  # P0927 itself is for the other ports
    bench.drive.write(927, 0, 15)
    assert bench.task(0x22BC, 0, 0, 2) == (0x12BC, 0, 0, 2)


def test_array_tasks():
    bench = Bench()
    assert bench.task(0x600A, 0x8001) == (0x400A, 0x8001, 0, 6)  # read P2010[1]
    assert bench.task(0x700A, 0x8001, 0, 7) == (0x400A, 0x8001, 0, 7)  # write it
    assert bench.task(0x900A, 0x8000) == (0x600A, 0x8000, 0, 2)  # it has two elements
    assert bench.task(0x6013, 0x8003) == (0x5013, 0x8003, 0x0035, 0)  # P2019[3] = r0053
    assert bench.task(0x8013, 0x8002, 0x0015, 0) == (0x5013, 0x8002, 0x0015, 0)
    assert bench.task(0x643A, 0x0001) == (0x543A, 0x0001, 0x4248, 0)  # a scalar has index 0 and 1
    assert bench.drive.read(2019, 2) == 0x00150000 and bench.drive.read(2010, 1) == 7


def test_the_number_of_elements_is_that_of_the_array_not_of_an_element():
    # Task 9 asks for no element, so no index is wrong, and a number that is no array has one:
    # errors 3 and 4 belong to the tasks that read and write elements (G110D, SPEC C-4.2.1).
    bench = Bench()
    assert bench.task(0x900A, 0x8000) == (0x600A, 0x8000, 0, 2)
    assert bench.task(0x900A, 0x8005) == (0x600A, 0x8005, 0, 2)
    assert bench.task(0x9438, 5) == (0x6438, 5, 0, 1)  # P1080
    assert bench.task(0x6438, 5) == (0x7438, 5, 0, 4)
    assert bench.task(0x97CF, 0) == (0x77CF, 0, 0, 0)  # but there has to be such a number
    bench = Bench(family=generic)
    assert bench.task(0x9012, 1) == (0x6012, 1, 0, 1)  # P18


def test_bit_11_of_pke_means_nothing():
    bench = Bench()
    assert bench.task(0x1ABC) == (0x12BC, 0, 0, 5)


def test_readings():
    bench = Bench()
    bench.run()
    for number in (20, 21, 24):
        assert bench.task(0x1000 | number, stw=RUN, hsw=HALF) == (0x2000 | number, 0, 0x41C8, 0)
    assert bench.task(0x1034, stw=RUN, hsw=HALF) == (0x1034, 0, 0, 0xFB34)
    assert bench.task(0x1036, stw=RUN, hsw=HALF) == (0x1036, 0, 0, RUN)
    assert bench.task(0x1012, 0x8001, stw=RUN, hsw=HALF) == (0x1012, 0x8001, 0, HALF)
    assert bench.task(0x1018, 0x8000, stw=RUN, hsw=HALF)[3] == bench.drive.read(2024)
    assert bench.task(0x1035, stw=RUN, hsw=HALF) == (0x1035, 0, 0, 0x06E6)
    assert bench.task(0x1018, 0x8001, stw=RUN, hsw=HALF)[3] == 0  # the BOP link


def test_no_task_gets_no_reply_id():
    bench = Bench()
    assert bench.task(0x12BC)[0] == 0x12BC
    assert bench.task(0) == (0, 0, 0, 0)
    assert bench.task(0x02BC) == (0, 0, 0, 0)


def test_a_standing_read_shows_the_present_value():
    bench = Bench()  # SPEC C-4.2.1.1
    assert bench.task(0x12BC)[3] == 5
    bench.drive.write(700, 0, 2)
    assert bench.task(0x12BC)[3] == 2


def test_a_standing_write_is_carried_out_once():
    # SPEC C-4.2.1.1 leaves it open; here once for each change of PKE, IND or PWE.
    bench = Bench()
    write = (0x22BC, 0, 0, 2)
    assert bench.task(*write)[3] == 2
    bench.drive.write(700, 0, 5)
    assert bench.task(*write)[3] == 5  # the present value, not written again
    bench.task(0)
    assert bench.task(*write)[3] == 2
    bench.drive.write(700, 0, 5)
    assert bench.task(0x22BC, 0, 0, 4)[3] == 4
    assert bench.drive.read(700) == 4


def test_stale_replies():
    # SPEC C-4.2.1.1: until a new task is recognised the old reply may be sent, or AK 0 at first.
    bench = Bench()
    bench.drive.stale_replies = 2
    assert bench.drive.stale_replies == 2
    for answer in (0, 0, 0x12BC, 0x12BC):
        assert bench.task(0x12BC)[0] == answer
    for answer in (0x12BC, 0x12BC, 0x143A):
        assert bench.task(0x143A, 0)[0] & 0xFFF == answer & 0xFFF
    assert bench.task(0x2460, 0, 0, 1)[0] == 0x243A  # a new task twice cut short
    assert bench.task(0x2461, 0, 0, 1)[0] == 0x243A
    for answer in (0x243A, 0x243A, 0x0000, 0x0000):
        assert bench.task(0)[0] == answer
    # A write happens when its reply appears, once.
    for expected in (5, 5, 2, 2):
        bench.task(0x22BC, 0, 0, 2)
        assert bench.drive.read(700) == expected


def test_ram_and_eeprom():
    # Tasks 2 and 3 write RAM, 13 and 14 the EEPROM too (OI440); P0971 = 1 saves all.
    bench = Bench()

    def power_cycle():
        bench.drive.power_off()
        bench.drive.power_on()

    bench.task(0x23E8, 0, 0, 1)
    bench.task(0x3460, 0, *float_words(3.0))
    bench.task(0xE2BC, 0, 0, 2)
    bench.task(0xD461, 0, *float_words(4.0))
    power_cycle()
    assert [bench.drive.read(n) for n in (1000, 1120, 700, 1121)] == [5, 10.0, 2, 4.0]
    bench.task(0x23E8, 0, 0, 1)
    assert bench.task(0x23CB, 0, 0, 1) == (0x13CB, 0, 0, 1)
    assert bench.task(0x13CB) == (0x13CB, 0, 0, 0)  # back to 0 when done
    power_cycle()
    assert bench.drive.read(1000) == 1 and bench.drive.read(971) == 0


def test_link_settings_take_effect_behind_the_reply():
    bench = Bench()
    assert bench.task(0x200B, 0x8000, 0, 7) == (0x100B, 0x8000, 0, 7)  # address 7
    assert bench.ask(telegram(1, 0, 0, 0, 0, OFF1, 0)) is None
    assert bench.ask(telegram(7, 0, 0, 0, 0, OFF1, 0)) == telegram(7, 0, 0, 0, 0, 0xFB31, 0)
    assert bench.drive.address == 7
    reply = bench.ask(telegram(7, 0x200D, 0x8000, 0, 0, OFF1, 0))  # no PKW words any more
    assert reply == telegram(7, 0x100D, 0x8000, 0, 0, 0xFB31, 0)
    assert bench.ask(telegram(7, OFF1, 0)) == telegram(7, 0xFB31, 0)
    bench.drive.write(2013, 0, 4)  # at the keypad: at once
    bench.drive.write(2012, 0, 1)
    assert bench.ask(telegram(7, 0, 0, 0, 0, OFF1)) == telegram(7, 0, 0, 0, 0, 0xFB31)


def test_at_another_baud_rate_it_reads_nothing():
    bench = Bench()
    assert bench.task(0x200A, 0x8000, 0, 6) == (0x100A, 0x8000, 0, 6)  # 9600
    assert bench.ask(telegram(1, 0, 0, 0, 0, OFF1, 0)) is None
    assert bench.drive.read(2024) == 1 and bench.drive.read(2026) == 1
    bench.drive.write(2010, 0, 7)
    assert bench.ask(telegram(1, 0, 0, 0, 0, OFF1, 0))


def test_three_parameter_words():
    # P2013 = 3: words in PWE1, nothing wider (SPEC C-4.1).
    bench = Bench({2013: 3})
    assert bench.ask(telegram(1, 0x12BC, 0, 0, OFF1, 0)) == telegram(1, 0x12BC, 0, 5, 0xFB31, 0)
    assert bench.ask(telegram(1, 0x143A, 0, 0, OFF1, 0))[3:9] == from_hex("74 3A 00 00 00 66")
    assert bench.ask(telegram(1, 0x343A, 0, 0x4220, OFF1, 0))[3:9] == from_hex("74 3A 00 00 00 66")
    assert bench.ask(telegram(1, 0xE2BC, 0, 2, OFF1, 0))[3:9] == from_hex("12 BC 00 00 00 02")
    assert bench.drive.read(1082) == 50 and bench.drive.read(700) == 2


def test_variable_length():
    # P2013 = 127: a word in PWE1 and 3 PKW words, a double word in 4 (SPEC C-4.1.2, RM420).
    bench = Bench({2013: 127})
    for request, reply in (
        ((0x143A, 0, 0, OFF1, 0), (0x243A, 0, 0x4248, 0, 0xFB31, 0)),
        ((0x343A, 0, 0x4220, 0, OFF1, 0), (0x243A, 0, 0x4220, 0, 0xFB31, 0)),
        ((0x23E8, 0, 1, OFF1, 0), (0x13E8, 0, 1, 0xFA31, 0)),
        ((0x23E8, 0, 0, 5, OFF1, 0), (0x13E8, 0, 5, 0xFB31, 0)),
        ((0x23E8, 0, 2, 0, OFF1, 0), (0x13E8, 0, 2, 0xFB31, 0)),
        ((0x23E8, 0, 2, 1, OFF1, 0), (0x13E8, 0, 1, 0xFA31, 0)),  # PWE2 unless it is 0
        ((0x23E8, 0, 5, 0, OFF1, 0), (0x13E8, 0, 5, 0xFB31, 0)),
        ((0, 0, 0, OFF1, 0), (0, 0, 0, 0xFB31, 0)),
        ((OFF1, 0), (0xFB31, 0)),
        # error 0 comes with the next number that exists
        ((0x1001, 0, 0, OFF1, 0), (0x7001, 0, 0, 2, 0xFB31, 0)),  # V60
        ((0x17CF, 0x8000, 0, OFF1, 0), (0x77CF, 0x8000, 0, 0, 0xFB31, 0)),  # P3999: none above
        ((0x343A, 0, 0x4220, OFF1, 0), (0x743A, 0, 102, 0xFB31, 0)),
    ):
        assert bench.ask(telegram(1, *request)) == telegram(1, *reply), request
    assert bench.ask(telegram(1, OFF1)) is None  # shorter than the process data
    assert bench.ask(telegram(1, *[0] * 124 + [OFF1, 0])) == telegram(1, 0, 0, 0, 0xFB31, 0)
