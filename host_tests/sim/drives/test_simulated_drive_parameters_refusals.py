# SPDX-License-Identifier: MIT
"""Why a simulated drive refuses a parameter task, family by family, and the switches about it.

Error numbers are those of the USS specification (C-4.2.1) up to 7, of the PROFIBUS profile and the
manuals of the drives beyond. Which error wins where several would fit no document says: the order
is that of parameter_channel.py.
"""

from boards.sim.drives.families import g110, g120, generic, mm3, mm420, mm440, v20
from boards.sim.drives.switches import SWITCHES, Switches
from drive_bench import HALF, OFF1, RUN, Bench, float_words

VARIABLE = 127


def words_in(bench, ak, number, words=(0,), index=0):
    """PKW words of the reply to a task, in whatever layout."""
    layout = bench.drive.layout[0]
    words = list(words)
    if layout == 4 and len(words) == 1:
        words = [0] + words
    page = 0x8000 if number >= 2000 else 0
    reply = bench.exchange(*[ak << 12 | number % 2000, page | index] + words + [OFF1, 0])
    return [reply[0] >> 12] + reply[2:-2]


def error_of(bench, ak, number, words=(0,), index=0):
    """The error number of a refused task, None of one that was done."""
    reply = words_in(bench, ak, number, words, index)
    if reply[0] != 7:
        return None
    return reply[-1] if bench.drive.layout[0] == 4 else reply[1]


# --- what a family has ------------------------------------------------------------------------

# Numbers that some have and others lack: error 0.
NUMBERS = (
    # number, who has it
    (31, (mm440, v20, g120, mm3)),  # where it is a JOG frequency
    (35, (mm440, v20, g120)),
    (705, (mm440,)),
    (732, (mm440, v20)),
    (733, (mm440,)),
    (918, (mm420, mm440, generic)),
    (944, (mm3,)),
    (945, (g120,)),
    (1008, (mm440, v20)),
    (1237, (mm440, v20)),
    (2009, (mm420, mm440, generic)),
    (2021, (v20, g120)),
    (2023, (v20, g120)),
    (2200, (mm420, mm440, v20, generic)),
    (3981, (mm420, mm440, g110, v20, generic)),
)


def test_what_a_family_lacks_is_error_0():
    for family in (mm3, mm420, mm440, g110, v20, g120, generic):
        bench = Bench(family=family)
        for number, owners in NUMBERS:
            error = error_of(bench, 1, number)
            assert (error == 0) == (family not in owners), (family.NAME, number, error)


# A word that one family takes and another does not: error None, 2 beyond, 104 between the limits.
VALUES = (
    # number, value, error by family
    (1000, 77, ((mm420, 2), (mm440, None), (g110, 2), (v20, None))),
    (1000, 4, ((mm420, None), (mm440, None), (g110, 104), (v20, 104))),
    (1000, 48, ((mm420, 104), (mm440, 104), (v20, 104))),
    (700, 4, ((mm420, None), (mm440, None), (g110, 104), (v20, 104))),
    (700, 6, ((mm420, None), (mm440, None), (g110, 2), (v20, 2))),
    (927, 31, ((mm420, 2), (mm440, 2), (v20, None))),
    (1300, 1, ((mm420, None), (mm440, None), (g110, 104))),
    (1300, 20, ((mm420, 2), (mm440, None), (g110, 2))),
    (335, 3, ((mm420, 2), (mm440, None), (g110, 2))),
    (701, 17, ((mm420, 104), (mm440, 104))),
    (2010, 3, ((mm420, None), (mm440, 2), (g110, None), (v20, 2), (g120, 0))),
    (2010, 12, ((mm420, None), (mm440, None), (g110, 2), (v20, None))),
    (2012, 8, ((mm420, 2), (mm440, None), (g110, 2), (generic, None))),
    (2013, 5, ((mm420, 104), (mm440, 104), (g110, 104), (v20, 104))),
    (2011, 32, ((mm420, 2), (mm440, 2), (g110, 2), (v20, 2))),
    (10, 3, ((mm420, 104), (mm440, 104), (v20, 104))),
)


def test_limits_and_settings_differ():
    for number, value, errors in VALUES:
        for family, expected in errors:
            error = error_of(Bench(family=family), 2, number, (value,))
            assert error == expected, (family.NAME, number, value, error)


def test_a_v20_resets_with_1_or_21():
    for value, error in ((1, None), (5, 104), (21, None), (22, 2)):
        assert error_of(Bench({10: 30}, family=v20), 2, 970, (value,)) == error, value


# --- the order --------------------------------------------------------------------------------


def test_which_error_wins():
    """Each task has everything wrong that the ones below it have."""
    bench = Bench({3: 1, 927: 7, 1080: 0.0}, family=mm440)
    bench.run()
    running = (RUN, HALF)

    def error(pke, ind=0, *values):
        return bench.task(pke, ind, *values + running)[3]

    assert error(0xA7CF, 0, 0, 0) == 106  # a task that there is not, of a number that there is not
    assert bench.task(0x27CF, 0, 0, 9, *running)[0] >> 12 == 8  # no rights
    bench.drive.write(927, 0, 15)
    assert error(0x27CF, 0, 0, 9) == 0  # no such number
    assert error(0x7015, 9, 0, 9) == 4  # no array, and read-only
    assert error(0x700A, 0x8009, 0, 99) == 3  # no such index
    assert error(0x2015, 0, 0, 9) == 1  # read-only, and another type
    assert error(0x37D0 - 0x3E8, 0, 0, 9) == 5  # P1000 is a word; it cannot be changed now
    assert error(0x22BC, 0, 0, 9) == 17  # not while it runs, and out of limits
    assert error(0x3422, 0, 0x4479, 0) == 204  # P1058 needs more access, and is out of limits
    bench.drive.write(3, 0, 3)
    assert error(0x3422, 0, 0x4480, 0) == 2


# --- levels and keys --------------------------------------------------------------------------


def test_access_levels():
    bench = Bench({3: 1})
    for level, errors in (
        (1, (None, 204, 204, 204)), (2, (None, None, 204, 204)),
        (3, (None, None, None, 204)), (4, (None, None, None, None)),
    ):  # fmt: skip
        assert error_of(bench, 2, 3, (level,)) is None  # P0003 itself is always open
        for number, error in zip((1000, 2011, 2014, 3981), errors):
            assert error_of(bench, 2, number, (0,)) == error, number
            bench.drive.write(2011, 0, 1)


def test_level_0_opens_the_user_list():
    bench = Bench({(13, 0): 2011, (13, 1): 1120, 3: 0})
    assert error_of(bench, 2, 1000, (1,)) == 204
    assert error_of(bench, 2, 2011, (1,)) is None
    assert error_of(bench, 3, 1120, float_words(2.0)) is None
    assert error_of(bench, 2, 3, (3,)) is None


def test_the_user_list_has_a_key():
    # Error 12 while P0012, the key, is not P0011, the lock.
    bench = Bench({11: 4711})
    assert error_of(bench, 7, 13, (1120,), 2) == 12
    assert error_of(bench, 2, 12, (4711,)) is None
    assert error_of(bench, 7, 13, (1120,), 2) is None
    assert bench.drive.read(13, 2) == 1120


def test_reading_above_the_access_level_is_a_switch():
    bench = Bench({3: 1, 2013: VARIABLE}, switches={"level_for_reading": True})
    assert error_of(bench, 1, 2011) == 204
    assert error_of(bench, 1, 1000) is None
    # Browsing finds what is accessible: after P0700 comes P0970, in level 1.
    assert words_in(bench, 1, 709) == [7, 0, 970]
    bench.drive.switches.level_for_reading = False
    bench.exchange(0, 0, 0, OFF1, 0)
    assert words_in(bench, 1, 709) == [7, 0, 719]


# --- rights -----------------------------------------------------------------------------------


def test_what_says_that_there_are_no_rights():
    for switch, reply in ((0, [8, 0, 0]), (11, [7, 0, 11]), (7, [7, 0, 7])):
        bench = Bench({927: 7}, switches={"no_rights_error": switch})
        assert words_in(bench, 2, 700, (2,)) == reply
        assert words_in(bench, 14, 700, (2,)) == reply
        assert words_in(bench, 1, 700) == [1, 0, 5]


# --- numbers and places -----------------------------------------------------------------------


def test_an_index_belongs_to_the_tasks_for_arrays():
    """Specification C-4.2.2; a MICROMASTER takes it with the others as well."""
    for family, error, second in ((generic, 3, 2), (mm420, None, 1), (mm440, None, 1)):
        bench = Bench(family=family)
        for ak, words in ((1, (0,)), (2, (2,)), (14, (2,))):
            assert error_of(bench, ak, 2012, words, second) == error, (family, ak)
        for ak, words in ((6, (0,)), (7, (2,)), (12, (2,))):
            assert error_of(bench, ak, 2012, words, second) is None, (family, ak)


def test_a_drive_may_keep_silent_where_others_refuse():
    bench = Bench(switches={"silent_refusals": True})
    assert bench.exchange(0x1000 | 700, 0, 0, 0, OFF1, 0)[0] == 0x1000 | 700
    for _ in range(3):
        assert bench.exchange(0x1000 | 999, 0, 0, 0, OFF1, 0) is None
    assert bench.exchange(0, 0, 0, 0, OFF1, 0) is not None
    assert bench.drive.stw == OFF1  # it obeys the process data all the same


def test_numbers_without_a_page():
    # A third-party master for the G110 asks for P2013 as PNU 7DDh.
    for raw, reply in ((False, [0x77DD, 0, 0]), (True, [0x17DD, 0, 4])):
        bench = Bench(switches={"raw_numbers": raw})
        words = bench.task(0x17DD)
        assert [words[0], words[1], words[3]] == reply
        assert bench.task(0x17DD, 0x8000)[3] == 0  # 4013, with a page


def test_bits_of_ind_that_select_a_text_where_there_is_none():
    # A master sends 0 there (SPEC C-4.2.2). What a drive makes of a 1 is not told: a switch.
    for error in (0, 3):
        bench = Bench(switches={"text_bits_error": error})
        for bits in (0x0100, 0x0200, 0x0300):
            refused = (0x72BC, bits, 0, 3)
            assert bench.task(0x12BC, bits) == (refused if error else (0x12BC, bits, 0, 5))
            assert bench.task(0x22BC, bits, 0, 2) == (refused if error else (0x12BC, bits, 0, 2))
            assert bench.drive.read(700) == (5 if error else 2)
            bench.drive.write(700, 0, 5)
        page = bench.task(0x100A, 0x8101)  # and nothing of the page or of the index is lost
        assert page == ((0x700A, 0x8101, 0, 3) if error else (0x100A, 0x8101, 0, 6))
        assert bench.task(0x42BC, 0x0102)[3] == (3 if error else 1)  # of a description
        bench = Bench({2013: VARIABLE}, family=generic, switches={"text_bits_error": error})
        assert bench.exchange(0xF009, 0x0204, 0, OFF1, 0)[:3] == [0xF009, 0x0204, 0x3132]


def test_four_words_in_variable_length():
    for second, places in ((True, ((2, 0, 2), (0, 2, 2), (2, 1, 1))),
                           (False, ((2, 0, 2), (0, 2, 0), (2, 1, 2)))):  # fmt: skip
        for first_word, second_word, value in places:
            bench = Bench({2013: VARIABLE}, switches={"second_word": second})
            bench.exchange(0x23E8, 0, first_word, second_word, OFF1, 0)
            assert bench.drive.read(1000) == value, (second, first_word, second_word)


def test_when_a_new_layout_begins():
    bench = Bench(switches={"layout_at_once": True})
    assert bench.exchange(0x200D, 0x8000, 0, 3, OFF1, 0) == [0x100D, 0x8000, 3, 0xFB31, 0]
    bench = Bench(switches={"layout_at_once": True})
    assert bench.exchange(0x200D, 0x8000, 0, 0, OFF1, 0) == [0xFB31, 0]  # no parameters any more
    bench = Bench()
    assert bench.exchange(0x200D, 0x8000, 0, 3, OFF1, 0) == [0x100D, 0x8000, 0, 3, 0xFB31, 0]


# --- what depends on other parameters ---------------------------------------------------------


def test_numbers_out_of_use():
    # P0308 counts where P0100 is 0 or 2, P0309 where it is 1.
    for norm, errors in ((0, (None, 101)), (1, (101, None)), (2, (None, 101))):
        bench = Bench({10: 1, 100: norm}, switches={"inactive_refused": True})
        for number, error in zip((308, 309), errors):
            assert error_of(bench, 3, number, float_words(0.5)) == error, (norm, number)
    assert error_of(Bench({10: 1}), 3, 309, float_words(0.5)) is None


def test_limits_are_tighter_while_it_runs():
    # P1080 stays below P1082: error 201.
    p1080_is_51 = (0x3438, 0) + float_words(51.0)
    for on, error in ((True, 201), (False, 0)):
        bench = Bench(switches={"tightened_limits": on})
        bench.run()
        reply = bench.task(*p1080_is_51 + (RUN, HALF))
        assert reply == ((0x7438, 0, 0, 201) if error else (0x2438, 0) + float_words(51.0))
    assert Bench().task(*p1080_is_51)[0] == 0x2438


def test_a_limit_is_the_float_that_the_line_carries():
    # 99.9 and 0.1 have no exact single: what they become is still legal.
    bench = Bench({10: 1})
    for number, value in ((309, 99.9), (2002, 0.1), (305, 0.01), (760, 99999.9)):
        assert error_of(bench, 3, number, float_words(value)) is None, number
        assert error_of(bench, 3, number, float_words(value * 1.00001)) in (None, 2)


# --- the switches themselves ------------------------------------------------------------------


def test_every_switch_has_a_default_and_a_reason():
    names = [name for name, _, _, _ in SWITCHES]
    assert len(set(names)) == len(names)
    switches = Switches()
    for name, default, what, why in SWITCHES:
        assert getattr(switches, name) == default and what and why


def test_a_switch_that_there_is_not():
    for use in (lambda: Bench(switches={"stale": 1}), lambda: Bench().drive.switches.set("x", 1)):
        try:
            use()
        except ValueError as error:
            assert "a drive has no switch" in error.args[0]
        else:
            raise AssertionError("taken")
