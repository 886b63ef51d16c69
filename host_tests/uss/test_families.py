# SPDX-License-Identifier: MIT
"""The drive families: each one's table agrees with itself, with the line and with the manuals.

Numbers of chapters are those of the protocol notes, USS.md.
"""

import uss.families.readings as readings
from boards.sim.drives.families import named as simulated
from boards.sim.drives.parameters import NUMBER, TYPE
from uss import bits, families, pkw, pzd
from uss.families import (
    CU240S,
    FAMILIES,
    G110,
    G120,
    GENERIC,
    MM3,
    MM4,
    MM410,
    MM420,
    MM430,
    MM440,
    V20,
    baud_code,
    can_be_set_to,
    is_float,
    on_bop,
    rows,
    value,
)
from uss.families.generic import CUTS_OFF, RESCALES
from uss.families.kinds import kind as understood
from uss.families.kinds import text
from uss.layout import VARIABLE, Layout
from uss.timing import BAUD_RATES

CONTROL = 1 << 10
KINDS = (rows.WORD, rows.CENTIHERTZ, rows.RPM, rows.STEPS, rows.SOURCE, rows.COUNT)

# Family: lowest and highest baud code and the rates they stand for, the rate as delivered (1.3).
BAUD = (
    (MM3, 3, 1200, 7, 19200, 9600),
    (MM410, 3, 1200, 7, 19200, 9600),
    (MM420, 3, 1200, 9, 57600, 9600),
    (MM430, 4, 2400, 12, 115200, 9600),
    (MM440, 4, 2400, 12, 115200, 9600),
    (G110, 3, 1200, 9, 57600, 9600),
    (V20, 6, 9600, 12, 115200, 38400),
    (CU240S, 4, 2400, 12, 115200, 9600),
    (G120, 4, 2400, 13, 187500, 38400),
)

# Family: parameters of baud rate, address, PZD, PKW, telegram-off time; its fault (1.3, 1.9, 4.7).
LINK = (
    (MM3, 92, 91, None, None, 93, "F008"),
    (MM440, 2010, 2011, 2012, 2013, 2014, "F0072"),
    (G110, 2010, 2011, 2012, 2013, 2014, "F0072"),
    (V20, 2010, 2011, 2012, 2013, 2014, "F72"),
    (G120, 2020, 2021, 2022, 2023, 2040, "F01910"),
)


# Family: rated frequency and rated speed of its motor, present fault and warning; then what is to
# be set at it first, as (number, value): access to all parameters, USS at the terminals; and what
# copies RAM to EEPROM.
NUMBERS = (
    (MM3, (81, 82), 930, None, (9, 3), None, (971, 1)),
    (MM440, (310, 311), 947, 2110, (3, 3), None, (971, 1)),
    (G110, (310, 311), 947, 2110, (3, 3), None, (971, 1)),
    (V20, (310, 311), 947, 2110, (3, 3), (2023, 1), (971, 1)),
    (CU240S, (310, 311), 947, 2110, (3, 3), None, (971, 1)),
    (G120, (310, 311), 947, None, None, (2030, 1), (971, 1)),
    (GENERIC, None, None, None, None, None, None),
)

# Family: what a panel without a catalogue shows of it, each with the highest value that it writes.
SHOWN = (
    (MM3, ((910, 4), (91, 30), (94, None), (12, None), (13, None))),
    (MM440, ((700, 6), (1000, 77), (2011, 31), (2024, None), (2025, None))),
    (G110, ((700, 6), (1000, 77), (2011, 31), (2024, None), (2025, None))),
    (G120, ((2021, 30), (2040, 65535))),
    (GENERIC, ()),
)


def refused(work, *arguments):
    """What it says to that; False if it does not refuse."""
    try:
        work(*arguments)
    except ValueError as error:
        return str(error)
    return False


def start_words(family):
    return [word for word in (family.on, family.on_reverse) if word]


def jog_words(family):
    return [word for word in (family.jog_right, family.jog_left) if word]


def test_baud_codes_are_those_of_the_manuals():
    for family, first, slowest, last, fastest, delivered in BAUD:
        codes = family.baud_codes
        assert min(codes) == first and codes[first] == slowest, family.name
        assert max(codes) == last and codes[last] == fastest, family.name
        assert sorted(codes) == list(range(first, last + 1)), family.name
        assert family.baud == delivered and delivered in codes.values(), family.name
    assert GENERIC.baud == 9600 and not GENERIC.baud_codes


def test_every_code_is_a_rate_of_the_line_and_back():
    for family in FAMILIES:
        for code, baud in family.baud_codes.items():
            assert baud in BAUD_RATES
            assert baud_code(family, baud) == code


def test_a_rate_that_a_family_does_not_have_is_refused():
    assert refused(baud_code, MM420, 115200)
    assert refused(baud_code, V20, 4800)
    assert refused(baud_code, GENERIC, 9600)  # nobody knows its codes


def test_the_parameters_of_the_link():
    for family, baud, address, pzd_words, pkw_words, off_time, fault in LINK:
        assert family.baud_number == baud, family.name
        assert family.address_number == address, family.name
        assert family.pzd_words_number == pzd_words, family.name
        assert family.pkw_words_number == pkw_words, family.name
        assert family.off_time_number == off_time, family.name
        assert family.fault_format % family.off_time_fault == fault, family.name


def test_the_parameters_of_the_motor_of_faults_and_of_what_is_set_first():
    for family, *told in NUMBERS:
        assert told == [
            family.motor, family.fault_number, family.warning_number,
            family.access, family.protocol, family.save,
        ], family.name  # fmt: skip


def test_what_a_panel_without_a_catalogue_shows_of_each_family():
    for family, shown in SHOWN:
        assert family.shown == shown, family.name


def test_the_telegram_off_time_of_an_mm3_is_in_seconds():
    for family in FAMILIES:
        assert family.off_time_unit_ms == (1000 if family is MM3 else 1)


def test_each_family_can_be_set_to_the_layout_it_is_given():
    for family in FAMILIES:
        assert can_be_set_to(family, family.layout), family.name


def test_which_layouts_a_family_can_be_set_to():
    assert can_be_set_to(MM420, Layout(4, 4)) and not can_be_set_to(MM420, Layout(4, 5))
    assert can_be_set_to(MM440, Layout(VARIABLE, 8)) and not can_be_set_to(MM440, Layout(4, 9))
    assert can_be_set_to(G110, Layout(0, 2))  # as in the B&R project
    assert can_be_set_to(MM3, Layout(3, 2))
    for layout in (Layout(4, 2), Layout(3, 4), Layout(0, 2), Layout(VARIABLE, 2)):
        assert not can_be_set_to(MM3, layout)
    for pkw_words in (0, 3, 4, VARIABLE):
        assert can_be_set_to(GENERIC, Layout(pkw_words, 16))


def test_how_the_telegrams_of_a_family_are_divided_unless_somebody_says_so():
    for family in FAMILIES:
        layout = Layout(4, 2)
        if family in (G110, V20, G120):
            layout = Layout(VARIABLE, 2)
        elif family is MM3:
            layout = Layout(3, 2)
        assert family.layout.is_like(layout), family.name


def test_how_many_process_data_a_family_can_be_set_to():
    for family, most in ((MM420, 4), (MM440, 8), (G110, 4), (V20, 8), (G120, 8), (GENERIC, 16)):
        assert list(family.pzd_choices) == list(range(most + 1)), family.name
    assert list(MM3.pzd_choices) == [2]


def test_no_word_gives_up_control():
    for family in FAMILIES:
        for word in start_words(family) + jog_words(family):
            assert word & CONTROL, (family.name, hex(word))
            assert word & pzd.OFF1 == pzd.OFF1, "nothing else that a running drive needs is 0"


def test_words_that_start_have_on_or_a_jog_and_never_both():
    for family in FAMILIES:
        assert start_words(family)
        for word in start_words(family):
            assert word & pzd.STW_RUN == pzd.STW_ON, (family.name, hex(word))
        for word in jog_words(family):
            assert word & pzd.STW_RUN in (0x0100, 0x0200), (family.name, hex(word))
    for word in (pzd.OFF1, pzd.OFF2, pzd.OFF3):
        assert not word & pzd.STW_RUN and word & CONTROL


def test_the_control_words_of_the_manuals():
    """4.2 and 4.8."""
    assert (MM440.on, MM440.on_reverse) == (0x047F, 0x0C7F)
    assert (MM440.jog_right, MM440.jog_left) == (0x057E, 0x067E)
    assert (MM3.on, MM3.on_reverse) == (0x0C7F, 0x147F)
    assert (GENERIC.on, GENERIC.on_reverse) == (0x047F, 0)  # bits above 10 are the drive's own
    assert not jog_words(GENERIC) and not jog_words(G120)


def test_a_drive_that_takes_no_sign_has_a_word_for_the_other_direction():
    for family in FAMILIES:
        assert family.hsw_is_signed or family.on_reverse, family.name


def test_the_words_bits_are_named_for_what_they_do():
    def named(family, word):
        return bits.names(word & ~pzd.OFF1, family.stw_bits)

    assert named(MM440, MM440.on_reverse) == ["ON", "REVERSE"]
    assert named(MM3, MM3.on) == ["ON", "RUN_RIGHT"]
    assert named(MM3, MM3.on_reverse) == ["ON", "RUN_LEFT"]
    assert named(G120, G120.on_reverse) == ["ON", "REVERSE"]
    assert named(MM440, MM440.jog_left) == ["JOG_LEFT"]


def test_surveys_have_every_row_and_no_kind_that_nobody_reads():
    for family in FAMILIES:
        assert len(family.survey) == rows.COUNT_OF_ROWS, family.name
        for row in family.survey:
            if row is not None:
                number, index, kind, _ = row
                assert 0 < number < 4000 and kind in KINDS, (family.name, row)
                assert index == 0 or family.has_indices  # also of the data set that is active


def test_a_value_that_is_expected_belongs_to_a_row():
    for family in FAMILIES:
        absolute = family.survey[rows.ABSOLUTE]
        assert (absolute is None) == (family.absolute_value is None), family.name


def test_the_rows_of_a_micromaster_4():
    """Its file has the words of `rows` once more, as constants."""
    kinds = {
        rows.WORD: [700, 1000, 2009, 2014, 1210, 50, 51, 719],
        rows.CENTIHERTZ: [2000, 1080, 1082],
        rows.SOURCE: [2019, 2019, 840, 1070, 2200],
        rows.COUNT: [2024],
    }
    for kind, numbers in kinds.items():
        assert [row[0] for row in MM4.survey if row[2] == kind] == numbers
    by_command_set = [row[0] for row in MM4.survey if row[1] == rows.BY_COMMAND_SET]
    assert by_command_set == [700, 1000, 719, 840, 1070, 2200]
    by_drive_set = [row[0] for row in MM4.survey if row[1] == rows.BY_DRIVE_SET]
    assert by_drive_set == [2000, 1080, 1082]
    assert [row[0] for row in MM4.survey if row[1] > 0] == [51, 2019]
    active, sent = MM4.survey[rows.DRIVE_SET], MM4.survey[rows.ACTUAL_SENT]
    assert active[:2] == (51, 1) and sent[:2] == (2019, 1)
    missing = [MM4.survey[row][3] for row in (rows.ON_SOURCE, rows.MAIN_SOURCE)]
    assert missing == [rows.source(2036), rows.source(2018, 1)]


def test_a_g110_is_asked_for_the_numbers_of_a_micromaster_4_as_far_as_it_has_them():
    """Always with index 0. It has no P2009, no data sets, no P2019[1] and no PID controller."""
    asked = [row and row[:3] for row in G110.survey]
    lacks = (rows.ABSOLUTE, rows.COMMAND_SET, rows.DRIVE_SET, rows.ACTUAL_SENT, rows.PID)
    assert [row for row in range(len(asked)) if asked[row] is None] == sorted(lacks)
    for row in range(len(asked)):
        if row not in lacks:
            number, _, kind, _ = MM4.survey[row]
            assert asked[row] == (number, 0, kind), row


def test_the_rows_of_a_micromaster_3_and_of_a_g120_are_seven():
    """Their files have these alone: the macro of a G120 connects ON and the setpoint."""
    for family, kind, words, scaled in (
        (MM3, rows.STEPS, {0: 910, 3: 95, 6: 93}, {2: 94, 4: 12, 5: 13}),
        (G120, rows.RPM, {6: 2040}, {2: 2000, 4: 1080, 5: 1082}),
    ):
        expected = [None] * rows.COUNT_OF_ROWS
        for numbers, kind_of_it in ((words, rows.WORD), (scaled, kind)):
            for row, number in numbers.items():
                expected[row] = (number, 0, kind_of_it, None)
        assert list(family.survey) == expected, family.name


def test_what_a_row_is_taken_for_where_the_drive_has_no_such_parameter():
    """None: then nothing is known of the drive, and it does not start."""
    missing = [row[3] for row in MM4.survey]
    assert missing[: rows.SUPERVISION] == [None] * 6
    assert missing[rows.SUPERVISION : rows.STATUS_SENT] == [0] * 5
    assert missing[rows.STATUS_SENT : rows.SELECTION] == [None] * 2
    assert missing[rows.SELECTION] == missing[rows.PID] == 0
    missing = [row and row[3] for row in G110.survey]
    expected = {rows.RESTART: 0, rows.COUNTER: 0, rows.SELECTION: 0}
    expected[rows.ON_SOURCE], expected[rows.MAIN_SOURCE] = 2036 << 16, 2018 << 16 | 1
    assert missing == [expected.get(row) for row in range(rows.COUNT_OF_ROWS)]


def test_the_set_that_is_active_is_the_index_of_what_belongs_to_it():
    values = [rows.UNKNOWN] * rows.COUNT_OF_ROWS
    asked = [rows.index_of(row, values) for row in MM4.survey]
    assert asked == [row[1] if row[1] > 0 else 0 for row in MM4.survey], "the first, so far"
    values[rows.COMMAND_SET], values[rows.DRIVE_SET] = 1, 2
    for row in MM4.survey:
        of_the_set = {rows.BY_COMMAND_SET: 1, rows.BY_DRIVE_SET: 2}
        assert rows.index_of(row, values) == of_the_set.get(row[1], row[1]), row


def test_what_a_drive_tells_is_judged_by_the_rules_of_its_family():
    """P0719 goes before P0700 and P1000, each digit before one of them."""
    assert rows.RIGHT not in range(rows.COUNT_OF_ROWS) and rows.UNKNOWN < 0
    values = [rows.UNKNOWN] * rows.COUNT_OF_ROWS
    for family in FAMILIES:
        assert list(rows.wrong_rows(family.meaning, values)) == [rows.RIGHT] * 4, "nobody knows"
    right = {
        rows.SELECTION: 0, rows.COMMAND_SOURCE: 5, rows.ON_SOURCE: 2036 << 16,
        rows.SETPOINT_SOURCE: 5, rows.MAIN_SOURCE: 2018 << 16 | 1, rows.PID: 0,
        rows.STATUS_SENT: 52 << 16, rows.ACTUAL_SENT: 21 << 16,
    }  # fmt: skip
    for told, wrong in (
        ({}, {}),
        ({rows.COMMAND_SOURCE: 4}, {rows.COMMAND: rows.COMMAND_SOURCE}),
        ({rows.COMMAND_SOURCE: 15}, {rows.COMMAND: rows.COMMAND_SOURCE}),
        ({rows.ON_SOURCE: 2032 << 16}, {rows.COMMAND: rows.ON_SOURCE}),
        ({rows.COMMAND_SOURCE: 2, rows.ON_SOURCE: 1}, {rows.COMMAND: rows.COMMAND_SOURCE}),
        ({rows.SELECTION: 50, rows.COMMAND_SOURCE: 2, rows.ON_SOURCE: 1}, {}),
        (
            {rows.SELECTION: rows.UNKNOWN, rows.COMMAND_SOURCE: 2, rows.SETPOINT_SOURCE: 2},
            {rows.COMMAND: rows.COMMAND_SOURCE, rows.SETPOINT: rows.SETPOINT_SOURCE},
        ),
        ({rows.SELECTION: 40}, {rows.COMMAND: rows.SELECTION}),
        ({rows.SELECTION: 4}, {rows.SETPOINT: rows.SELECTION}),
        ({rows.SELECTION: 5, rows.SETPOINT_SOURCE: 2, rows.MAIN_SOURCE: 1}, {}),
        ({rows.SELECTION: 5, rows.COMMAND_SOURCE: 2}, {rows.COMMAND: rows.COMMAND_SOURCE}),
        ({rows.SELECTION: 50, rows.SETPOINT_SOURCE: 2}, {rows.SETPOINT: rows.SETPOINT_SOURCE}),
        ({rows.SETPOINT_SOURCE: 15}, {rows.SETPOINT: rows.SETPOINT_SOURCE}),
        ({rows.MAIN_SOURCE: 2015 << 16}, {rows.SETPOINT: rows.MAIN_SOURCE}),
        ({rows.PID: 1 << 16}, {rows.SETPOINT: rows.PID}),
        ({rows.STATUS_SENT: 53 << 16}, {rows.STATUS: rows.STATUS_SENT}),
        (
            {rows.ACTUAL_SENT: 27 << 16, rows.STATUS_SENT: 0},
            {rows.ACTUAL: rows.ACTUAL_SENT, rows.STATUS: rows.STATUS_SENT},
        ),
    ):
        for row in range(rows.COUNT_OF_ROWS):
            values[row] = told.get(row, right.get(row, rows.UNKNOWN))
        expected = [wrong.get(subject, rows.RIGHT) for subject in range(4)]
        assert list(rows.wrong_rows(MM4.meaning, values)) == expected, told
    for source, wrong in ((1, rows.RIGHT), (0, rows.COMMAND_SOURCE), (2, rows.COMMAND_SOURCE)):
        values[rows.COMMAND_SOURCE] = source
        assert rows.wrong_rows(MM3.meaning, values)[rows.COMMAND] == wrong, source


def test_every_rule_says_which_values_of_which_row_are_right():
    for family in FAMILIES:
        for subject, row, place, right, digit in family.meaning:
            assert subject in range(len(rows.NOTHING_WRONG)) and row in range(rows.COUNT_OF_ROWS)
            assert right and place in (rows.ALL_DIGITS, 1, 10) and digit in (None, 1, 10)
    judged = [subject for subject, _, _, _, _ in MM4.meaning]
    assert judged == sorted(judged) and sorted(set(judged)) == [0, 1, 2, 3]


def test_what_ends_control_when_it_is_changed_is_asked_for():
    for family in FAMILIES:
        links = (family.baud_number, family.address_number, family.pzd_words_number,
                 family.pkw_words_number, family.off_time_number)  # fmt: skip
        for number in links:
            assert number is None or family.ask_first[number] == CUTS_OFF, number
        for row in (rows.REFERENCE, rows.ABSOLUTE):
            if family.survey[row] is not None:
                number = family.survey[row][0]
                assert family.ask_first[number] == RESCALES, (family.name, number)


def test_what_is_always_permanent_is_asked_for_as_well():
    for family in FAMILIES:
        for number in family.permanent:
            assert number in family.ask_first, (family.name, number)
        if family.address_number is not None:
            assert family.baud_number in family.permanent
            assert family.address_number in family.permanent
    assert MM4.permanent == G110.permanent == (2010, 2011, 2012, 2013)
    assert V20.permanent == (2010, 2011, 2012, 2013, 2023)
    assert MM3.permanent == (91, 92) and G120.permanent == (2020, 2021, 2022, 2023, 2030)


def test_the_panel_asks_before_everything_that_cuts_it_off_or_rescales():
    named = (3, 10, 700, 719, 840, 918, 927, 970, 1000, 1070, 1910, 2000, 2009, 2010, 2011, 2012,
             2013, 2014, 2016, 2019, 2023, 3900)  # fmt: skip
    assert sorted(MM4.ask_first) == sorted(named)
    assert sorted(V20.ask_first) == sorted(named + (717,))
    assert sorted(MM3.ask_first) == [9, 91, 92, 93, 94, 95, 910, 944]
    named = (10, 15, 840, 970, 1070, 2000, 2020, 2021, 2022, 2023, 2030, 2040, 2051)
    assert sorted(G120.ask_first) == list(named)
    rescales = (94, 95, 2000, 2009, 2016, 2019, 2051)
    for family in FAMILIES:
        for number, why in family.ask_first.items():
            assert why == (RESCALES if number in rescales else CUTS_OFF), (family.name, number)


def test_the_bop_link_of_a_micromaster_4_has_words_and_indices_of_its_own():
    for family in (MM410, MM420, MM430, MM440, CU240S):
        bop = on_bop(family)
        assert bop is on_bop(family) and bop.com is family and family.com is None
        assert bop.__name__ == family.__name__ + "-BOP" and issubclass(bop, family)
        assert (family.link_index, bop.link_index) == (0, 1)
        assert (family.off_time_fault, bop.off_time_fault) == (72, 71)
        of_the_link = {
            family.baud_number,
            family.address_number,
            family.pzd_words_number,
            family.pkw_words_number,
            family.off_time_number,
        }
        # and what normalises the setpoint, and the counters of good and of bad telegrams
        assert set(bop.linked) == of_the_link | {2009, 2024, 2025}
        for row in range(rows.COUNT_OF_ROWS):
            com, own = family.survey[row], bop.survey[row]
            if row in (rows.ABSOLUTE, rows.SUPERVISION, rows.COUNTER):
                assert (com[:2], own[:2]) == ((com[0], 0), (com[0], 1)), row
            elif row in (rows.STATUS_SENT, rows.ACTUAL_SENT):
                assert (com[0], own[0]) == (2019, 2016) and com[1:] == own[1:]
            else:
                assert com[:3] == own[:3], row
        missing = [bop.survey[row][3] for row in (rows.ON_SOURCE, rows.MAIN_SOURCE)]
        assert missing == [rows.source(2032), rows.source(2015, 1)]
    right = [rule[3] for rule in on_bop(MM440).meaning]
    assert right == [
        (0, 4), (4,), (2032 << 16,), (0, 4), (4,), (2015 << 16 | 1,), (0,), (0,), (52 << 16,),
        (21 << 16,),
    ]  # fmt: skip
    for family in (MM3, G110, V20, G120, GENERIC):
        assert refused(on_bop, family), family.name


def test_a_kind_says_which_link_it_is_on():
    for word, family, layout in (
        ("mm440-bop", on_bop(MM440), Layout(4, 2)),
        ("mm420-bop/127+4", on_bop(MM420), Layout(VARIABLE, 4)),
        ("cu240s-bop/0", on_bop(CU240S), Layout(0, 2)),
    ):
        found = understood(word)
        assert found[0] is family and found[1].is_like(layout), word
        assert text(*found) == word
    for word in ("mm440/", "mm440/+4", "mm440/4+", "mm440/ 4", "mm440/4+ 2", "mm440/four"):
        text_of_it = "%s is no layout such as /4, or /4+6" % word[len("mm440") :]
        assert refused(understood, word) == text_of_it, word
    for word in ("generic/4+0", "generic/4+1", "mm440/4+1"):
        text_of_it = "a drive without PZD1 and PZD2 takes no commands"
        assert refused(understood, word) == text_of_it, word
    for word in ("v20-bop", "-bop", "mm440-bop-bop", "bop", "mm440-com", "mm420-bop/4+5"):
        assert refused(understood, word), word


def test_a_kind_says_that_telegrams_without_a_task_are_short():
    for word, layout in (
        ("mm440/127s", Layout(VARIABLE, 2, short=True)),
        ("g110/127s", Layout(VARIABLE, 2, short=True)),
        ("mm420-bop/127s+4", Layout(VARIABLE, 4, short=True)),
    ):
        found = understood(word)
        assert found[1].is_like(layout), word
        assert text(*found) == word
    for word in ("mm440/4s", "mm440/s", "mm440/127ss", "mm440/127s+", "mm3/127s"):
        assert refused(understood, word), word


def test_values_of_a_survey():
    frequency = pkw.read(2000)
    frequency.high, frequency.low, frequency.width = 0x4248, 0x0000, 2
    assert value(frequency, rows.CENTIHERTZ) == 50.0
    word = pkw.read(94)
    word.high, word.low, word.width = 0, 500, 1
    assert value(word, rows.WORD) == 500
    assert value(word, rows.STEPS) == 50.0  # P095 = 0: in 0.1 Hz
    assert value(word, rows.STEPS, is_fine=True) == 5.0


def test_which_32_bit_values_are_floating_point():
    assert is_float(MM440, 1120) and is_float(MM440, 2000)
    assert not is_float(MM440, 2019), "a connector: r0052 and an index"
    assert not is_float(GENERIC, 2000), "nobody knows"
    for number in (732, 733):
        assert not is_float(MM440, number), "a relay output more than an MM420 has"
    for row in simulated("mm420").ROWS:
        if row[TYPE] in ("F", "U32"):
            assert is_float(MM420, row[NUMBER]) == (row[TYPE] == "F"), row[NUMBER]


def test_what_a_drive_tells_of_itself_while_it_runs():
    """Three PKW words carry no floating-point value, and without any it tells nothing."""
    usual = [
        (readings.OUTPUT, 24), (readings.SPEED, 22), (readings.CURRENT, 27),
        (readings.VOLTAGE, 25), (readings.DC_LINK, 26),
    ]  # fmt: skip
    more = [(readings.POWER, 32), (readings.MOTOR, 35)]
    inverter = [(readings.INVERTER, 37)]
    for family in FAMILIES:
        vector = more if family in (MM430, MM440, CU240S, V20, G120) else []
        expected = [row + (readings.FLOAT,) for row in usual + vector + inverter]
        if family not in (GENERIC, MM3):
            assert list(readings.of(family, 4)) == expected, family.name
            assert list(readings.of(family, VARIABLE)) == expected, family.name
        assert not readings.of(family, 0), family.name
        assert family is MM3 or not readings.of(family, 3), family.name
    words = (
        (readings.SPEED, 135, 100), (readings.CURRENT, 132, 10), (readings.VOLTAGE, 137, 100),
        (readings.DC_LINK, 134, 100),
    )  # fmt: skip
    assert readings.of(MM3, 3) == readings.of(MM3, 4) == words
    assert not readings.of(GENERIC, 4)


def test_what_the_families_have_in_common_and_what_not():
    assert MM4 is MM420
    assert [family for family in FAMILIES if family.is_cumulative] == [GENERIC, G120]
    assert [family for family in FAMILIES if not family.hiw_is_signed] == [MM3]
    assert [family for family in FAMILIES if not family.has_eeprom_tasks] == [MM3]
    assert [family for family in FAMILIES if not family.has_indices] == [MM3, G110]
    assert not G120.takes_broadcast and not GENERIC.takes_broadcast
    assert MM440.takes_broadcast and G110.takes_broadcast and not MM3.takes_broadcast
    assert [family for family in FAMILIES if family.first_index] == [GENERIC]
    assert [family for family in FAMILIES if not family.takes_no_control] == [G120]
    by_array_tasks = [family for family in FAMILIES if family.has_array_tasks]
    assert by_array_tasks == [GENERIC, V20, CU240S, G120]
    with_bop = [family for family in FAMILIES if family.has_bop_link]
    assert with_bop == [MM410, MM420, MM430, MM440, CU240S]
    absolute = [(family, family.absolute_value) for family in FAMILIES if family.absolute_value]
    assert absolute[0] == (MM3, 2) and {value for _, value in absolute[1:]} == {1}
    names = [family.name for family in FAMILIES]
    assert len(set(names)) == len(names)


def test_a_family_that_there_is_not_is_an_error():
    try:
        raise AssertionError("who is %r?" % families.MM450)
    except AttributeError as error:
        assert "MM450" in str(error)


def test_a_drive_of_ones_own_is_one_more_class():
    class Pump(MM440):
        layout = Layout(4, 4)

    assert Pump.layout.pzd_words == 4 and Pump.on_reverse == 0x0C7F
    assert MM440.layout.pzd_words == 2


def test_a_generic_drive_may_have_every_layout_that_there_is():
    for pkw_words in (0, 3, 4, VARIABLE):
        for pzd_words in range(17):
            try:
                layout = Layout(pkw_words, pzd_words)
            except ValueError:
                continue
            assert layout.suits(GENERIC), layout
    assert Layout(3, 0).suits(GENERIC) and not Layout(3, 0).suits(MM3)
