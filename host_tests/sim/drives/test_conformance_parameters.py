# SPDX-License-Identifier: MIT
"""The parameter channel of the drives that tools/drive serves, tried by a master of its own.

Every sentence of the specification that a master could notice has its test; sections are those of
the USS specification (E20125-D0001-S302-A1-7600).
"""

import pytest

from conformance.kinds import EVERYBODY, KINDS, VALUES
from conformance.master import VARIABLE, Node
from conformance.program import Drives
from conformance.telegrams import float_of, framed

INTERPRETERS = "host"

# Reply ids, C-4.2.1 table 4.2.
WORD, DOUBLE, DESCRIPTION, ARRAY_WORD, ARRAY_DOUBLE, ELEMENTS, REFUSED, NO_RIGHTS = range(1, 9)
TEXT = 15

# Error numbers of REFUSED.
UNKNOWN, READ_ONLY, LIMIT, SUBINDEX, NO_ARRAY, TYPE = range(6)
DESCRIPTION_FIXED = 7
STATE, TOO_SMALL, DISCRETE, NOT_IMPLEMENTED, LEVEL = 17, 102, 104, 106, 204

ALL = 255
WITH_PKW = [name for name, kind in KINDS.items() if kind.pkw_words]
MICROMASTER_4 = [name for name in WITH_PKW if name[:4] in ("mm42", "mm44", "g110", "v20 ")]
ACTUAL_FREQUENCY = 21
RUN, OFF1 = 0x047F, 0x047E


@pytest.fixture(scope="module")
def drives():
    with Drives(EVERYBODY) as drives:
        yield drives


@pytest.fixture
def node(request, drives):
    """The drive that the test is parametrized with, or asks for by `on`, after a power-up."""
    node = drives.ready(request.param)
    node.exchange(node.no_task())
    yield node
    drives.leave(node)


def on(*names, having=None):
    """Run the test on each of these drives, or on those that have such a parameter."""
    names = [
        name for name in names if having is None or getattr(EVERYBODY[name], having) is not None
    ]
    return pytest.mark.parametrize(
        "node, kind", [(n, EVERYBODY[n]) for n in names], ids=names, indirect=["node"]
    )


def refused(node, answer, number):
    """Whether the answer is this refusal, whatever advice goes with it in variable length."""
    ak, values = answer
    return (
        ak == REFUSED and values[0] == number and (node.pkw_words == VARIABLE or len(values) == 1)
    )


def short(node):
    """Whether the drive has no room for a double word."""
    return node.pkw_words == 3


# ---- each task and its reply: C-4.2.1, tables 4.1 to 4.3 -------------------------------------


@on(*WITH_PKW)
def test_no_task_is_answered_by_no_reply_filled_with_zeros(node, kind):
    assert node.exchange(node.no_task())[0] == node.no_task()


@on(*WITH_PKW)
def test_task_1_reads_a_word(node, kind):
    ak, values = node.task(1, kind.word)
    assert ak == WORD and len(values) == 1


@on(*WITH_PKW, having="double")
def test_task_1_reads_a_double_word_where_there_is_room(node, kind):
    ak, values = node.task(1, kind.double)
    if short(node):
        assert (ak, values) == (REFUSED, [TOO_SMALL])
    else:
        assert ak == DOUBLE and len(values) == 2


@on(*WITH_PKW)
def test_task_2_writes_a_word(node, kind):
    assert node.task(2, kind.word, 0, VALUES[kind.word]) == (WORD, VALUES[kind.word])
    assert node.task(1, kind.word) == (WORD, VALUES[kind.word])


@on(*MICROMASTER_4, "g120 variable+2", "generic 4+16", "generic variable+0")
def test_task_3_writes_a_double_word_where_there_is_room(node, kind):
    answer = node.task(3, kind.double, 0, VALUES[kind.double])
    if short(node):
        assert answer == (REFUSED, [TOO_SMALL])
    else:
        assert answer == (DOUBLE, VALUES[kind.double])
        assert node.task(1, kind.double) == answer


@on("mm440 4+8", "mm440 variable+4", "v20 variable+2", "generic 4+16", "generic variable+0")
def test_task_4_reads_an_element_of_the_description(node, kind):
    number = kind.double
    elements = 3 if kind.family in ("mm440", "v20") else 1
    assert node.task(4, number, 2) == (DESCRIPTION, placed(node, [elements]))
    lower, upper = node.task(4, number, 7), node.task(4, number, 8)
    assert (lower[0], upper[0]) == (DESCRIPTION, DESCRIPTION)
    assert (float_of(lower[1]), float_of(upper[1])) == (0.0, 650.0)


def placed(node, words):
    """Value words with the filling that a reply of two words at the most has."""
    return [0] * (2 - len(words)) + words if node.pkw_words == 4 else words


@on("generic variable+0")
def test_task_4_reads_a_name_and_everything_at_once_in_variable_length(node, kind):
    # C-6: elements 1 to 8 and 10, 18 words of a number of 16 bits and 20 of one of 32.
    ak, name = node.task(4, 1120, 6)
    assert ak == DESCRIPTION and len(name) == 8
    for number, count in ((3, 18), (1120, 20)):
        ak, everything = node.task(4, number, ALL)
        assert ak == DESCRIPTION and len(everything) == count
        elements = []
        for element in (1, 2, 3, 4, 5, 6, 7, 8, 10):
            elements += node.task(4, number, element)[1]
        assert elements == everything


@on("generic 4+16")
def test_task_4_has_no_room_for_a_name_in_four_words(node, kind):
    assert node.task(4, 1120, 6) == (REFUSED, [TOO_SMALL])


@on(*MICROMASTER_4)
def test_task_5_is_not_implemented(node, kind):
    assert node.task(5, kind.word, 7, [0]) == (REFUSED, [NOT_IMPLEMENTED])


@on("generic 4+16", "generic variable+0")
def test_task_5_cannot_change_a_description(node, kind):
    assert node.task(5, kind.word, 7, [0]) == (REFUSED, [DESCRIPTION_FIXED])


@on(*WITH_PKW, having="words")
def test_task_6_reads_an_element_of_an_array_of_words(node, kind):
    ak, values = node.task(6, kind.words, 1)
    assert ak == ARRAY_WORD and len(values) == 1


@on(*WITH_PKW, having="doubles")
def test_task_6_reads_an_element_of_an_array_of_double_words(node, kind):
    ak, values = node.task(6, kind.doubles, 1)
    if short(node):
        assert (ak, values) == (REFUSED, [TOO_SMALL])
    else:
        assert ak == ARRAY_DOUBLE and len(values) == 2


@on(*WITH_PKW, having="words")
def test_task_7_writes_an_element_of_an_array_of_words(node, kind):
    written = (ARRAY_WORD, VALUES[kind.words])
    assert node.task(7, kind.words, 1, VALUES[kind.words]) == written
    assert node.task(6, kind.words, 1) == written


@on(*WITH_PKW, having="doubles")
def test_task_8_writes_an_element_of_an_array_of_double_words(node, kind):
    answer = node.task(8, kind.doubles, 1, VALUES[kind.doubles])
    if short(node):
        assert answer == (REFUSED, [TOO_SMALL])
    else:
        assert answer == (ARRAY_DOUBLE, VALUES[kind.doubles])
        assert node.task(6, kind.doubles, 1) == answer


@on(*WITH_PKW, having="doubles")
def test_task_9_reads_how_many_elements_an_array_has(node, kind):
    ak, (count,) = node.task(9, kind.doubles)
    assert ak == ELEMENTS and count >= 3
    last = count - 1 if kind.family != "generic" else count
    assert short(node) or node.task(6, kind.doubles, last)[0] == ARRAY_DOUBLE
    assert refused(node, node.task(6, kind.doubles, last + 1), SUBINDEX)


@on(*WITH_PKW)
def test_task_10_does_not_exist(node, kind):
    assert node.task(10, kind.word) == (REFUSED, [NOT_IMPLEMENTED])


# AK of a task that writes into the EEPROM too: what is written, the reply id, whether it is an
# array.
LASTING = {
    11: ("doubles", ARRAY_DOUBLE, 1),
    12: ("words", ARRAY_WORD, 1),
    13: ("double", DOUBLE, 0),
    14: ("word", WORD, 0),
}


@on(
    "mm420 4+2",
    "mm440 variable+4",
    "g110 variable+2",
    "v20 4+2",
    "g120 variable+2",
    "generic 4+16",
)
@pytest.mark.parametrize("task", LASTING)
def test_tasks_11_to_14_write_what_outlives_the_power(drives, node, kind, task):
    name, reply, index = LASTING[task]
    number = getattr(kind, name)
    if number is None:
        return
    before = node.task(6 if index else 1, number, index)[1]
    answer = (reply, VALUES[number])
    assert node.task(task, number, index, VALUES[number]) == answer
    drives.power_cycle(node)
    assert node.task(6 if index else 1, number, index) == answer
    assert node.task(task, number, index, before) == (reply, before)


@on(*MICROMASTER_4)
def test_task_15_is_not_implemented(node, kind):
    assert node.task(15, kind.word, 1) == (REFUSED, [NOT_IMPLEMENTED])


@on("generic variable+0")
def test_task_15_reads_and_writes_texts(node, kind):
    # C-8 examples 7 and 8; and no number of characters but 16.
    assert node.task(15, 7, 3) == (TEXT, text_words("300 BAUD"))
    assert node.exchange(node.request(15, 9, 2))[0][2:] == text_words("BAUDRATE FOR SS2")
    other = text_words("SPEED OF PORT 2")
    assert node.exchange([0xF009, 0x0102] + other)[0] == [0xF009, 0x0102] + other
    assert node.exchange([0xF009, 0x0002, 0])[0][2:] == other
    assert node.exchange([0xF009, 0x0204, 0])[0][2:] == text_words("1200 BAUD")
    assert node.task(15, 7, ALL)[0] == REFUSED


@on("generic 4+16")
def test_task_15_needs_variable_length(node, kind):
    assert node.task(15, 7, 3)[0] == REFUSED


def text_words(text):
    padded = text.ljust(16).encode()
    return [padded[i] << 8 | padded[i + 1] for i in range(0, 16, 2)]


@on("mm3 3+2")
@pytest.mark.parametrize("task", [task for task in range(3, 16)])
def test_a_micromaster_3_knows_tasks_1_and_2(node, kind, task):
    assert node.task(task, kind.word, 0, [1])[0] == REFUSED


@on("generic 4+16", "generic variable+0")
def test_a_negative_word_is_its_twos_complement(node, kind):
    assert node.task(1, 19) == (WORD, [0xFFFF])
    assert node.task(2, 19, 0, [0xFC18]) == (WORD, [0xFC18])  # -1000, the least
    assert refused(node, node.task(2, 19, 0, [0xFC17]), LIMIT)


# ---- all elements at once: C-4.2.2 ------------------------------------------------------------


@on("mm440 variable+4", "v20 variable+2", "generic variable+0")
def test_index_255_reads_and_writes_all_elements(node, kind):
    count = node.task(9, kind.doubles)[1][0]
    ak, values = node.task(6, kind.doubles, ALL)
    assert ak == ARRAY_DOUBLE and len(values) == 2 * count
    written = VALUES[kind.doubles] * count
    assert node.task(8, kind.doubles, ALL, written) == (ARRAY_DOUBLE, written)
    assert node.task(6, kind.doubles, ALL) == (ARRAY_DOUBLE, written)
    assert node.task(6, kind.words, ALL)[0] == ARRAY_WORD


@on("mm420 4+2", "mm420 3+2", "mm440 4+8", "v20 4+2", "generic 4+16")
def test_index_255_needs_variable_length(node, kind):
    for task in (6, 8, 11):
        answer = node.task(task, kind.doubles, ALL, VALUES[kind.doubles][: node.pkw_words - 2])
        assert answer == (REFUSED, [TOO_SMALL]), task


# ---- errors: C-4.2.1 table 4.4, RM420, PROFIdrive ---------------------------------------------


@on(*WITH_PKW)
def test_error_0_there_is_no_such_number(node, kind):
    for task in (1, 2):
        assert refused(node, node.task(task, 1999 if kind.family != "mm3" else 999), UNKNOWN)


@on("mm420 variable+2", "mm440 variable+4", "v20 variable+2", "g110 variable+2")
def test_error_0_tells_the_next_number_in_variable_length(node, kind):
    # So a panel browses the drive (RM420).
    seen = [0]
    for _ in range(5):
        ak, values = node.task(1, seen[-1] + 1)
        seen.append(values[1] if ak == REFUSED else seen[-1] + 1)
    assert seen == sorted(seen) and seen[1] > 0
    assert node.task(1, 1998)[1][1] == 2000


@on(*WITH_PKW)
def test_error_1_a_reading_cannot_be_written(node, kind):
    assert refused(node, node.task(2, kind.reading, 0, [0]), READ_ONLY)


@on(*[name for name in WITH_PKW if name != "mm3 3+2"])
def test_error_2_beyond_a_limit(node, kind):
    assert refused(node, node.task(2, 3, 0, [5]), LIMIT)
    assert node.task(1, 3)[1] != [5]
    if not short(node) and kind.family != "g120":
        assert refused(node, node.task(3, 1120, 0, [0x4422, 0xC000]), LIMIT)  # 651.0 s


@on("mm3 3+2")
def test_error_2_beyond_a_limit_of_a_micromaster_3(node, kind):
    assert node.task(2, 91, 0, [32]) == (REFUSED, [LIMIT])


@on("mm420 variable+2", "mm440 variable+4", "v20 variable+2")
def test_error_2_tells_the_next_legal_values_in_variable_length(node, kind):
    assert node.task(2, 3, 0, [9]) == (REFUSED, [LIMIT, 4, 4])


@on(*WITH_PKW, having="words")
def test_error_3_there_is_no_such_element(node, kind):
    for task in (6, 7):
        answer = node.task(task, kind.words, 50, VALUES[kind.words])
        assert refused(node, answer, SUBINDEX), task


@on(*[name for name in MICROMASTER_4 if name != "v20 4+2"])
def test_error_4_only_an_index_above_1_shows_that_it_is_no_array(node, kind):
    # RM420: with index 0 or 1 an array task of a number that is no array is carried out.
    value = node.task(1, 3)[1]
    assert node.task(6, 3, 0) == node.task(6, 3, 1) == (ARRAY_WORD, value)
    assert node.task(7, 3, 1, [4]) == (ARRAY_WORD, [4])
    answer = node.task(6, 3, 2)
    assert refused(node, answer, NO_ARRAY) or refused(node, answer, SUBINDEX)


@on(*WITH_PKW, having="double")
def test_error_5_word_and_double_word_mixed_up(node, kind):
    assert refused(node, node.task(2, kind.double, 0, [1]), TYPE)
    if not short(node):
        assert refused(node, node.task(3, kind.word, 0, [0, 1]), TYPE)


@on(*MICROMASTER_4)
def test_error_17_not_while_the_motor_runs(node, kind):
    task = (2, 1000, 0, [5]) if short(node) else (3, 1082, 0, [0x4220, 0])
    node.control(RUN)
    assert node.zsw & 4
    assert node.task(*task) == (REFUSED, [STATE])
    node.control(0x047C)
    assert node.task(*task)[0] in (WORD, DOUBLE)


@on("mm440 4+8", "mm440 variable+4", "v20 4+2")
def test_error_17_motor_data_only_in_commissioning(node, kind):
    assert refused(node, node.task(2, 304, 0, [400]), STATE)
    assert node.task(2, 10, 0, [1]) == (WORD, [1])
    assert node.task(2, 304, 0, [400]) == (WORD, [400])
    assert node.task(2, 10, 0, [0]) == (WORD, [0])


@on(*WITH_PKW, having="discrete")
def test_error_104_a_value_between_those_that_exist(node, kind):
    assert refused(node, node.task(2, kind.discrete, 0, [3]), DISCRETE) or kind.family == "g120"


@on(*MICROMASTER_4)
def test_error_204_the_access_level_forbids_it(node, kind):
    assert node.task(2, 3, 0, [1]) == (WORD, [1])
    assert refused(node, node.task(2, 2012, 0, [kind.pzd_words]), LEVEL)
    assert node.task(1, 2012) == (WORD, [kind.pzd_words])  # reading is free
    assert node.task(2, 3, 0, [3]) == (WORD, [3])
    assert node.task(2, 2012, 0, [kind.pzd_words]) == (WORD, [kind.pzd_words])


@on(*MICROMASTER_4)
def test_without_change_rights_writes_are_refused_and_reads_are_done(node, kind):
    # C-4.2.1.1, P0927: AK 8.
    assert node.task(2, 927, 0, [7]) == (WORD, [7])
    for task in (2, 7, 12, 14):
        assert node.task(task, 3, 0, [4]) == (NO_RIGHTS, []), task
    assert node.task(1, 3) == (WORD, [3])
    if not short(node):
        for task in (3, 8, 11, 13):
            assert node.task(task, 1120, 0, [0x4140, 0]) == (NO_RIGHTS, []), task


# ---- how a task goes: C-4.2.1.1 ---------------------------------------------------------------


@on("mm420 4+2")
def test_a_task_that_stands_is_answered_every_time(node, kind):
    request = node.request(1, 700)
    assert [node.exchange(request)[0] for _ in range(3)] == [node.request(1, 700, 0, [5])] * 3


@on("mm420 4+2")
def test_a_repeated_reply_carries_the_present_value(node, kind):
    node.task(3, 1120, 0, VALUES[1120])
    node.control(OFF1, 0x4000)
    node.control(RUN)
    request = node.request(1, ACTUAL_FREQUENCY)
    heard = [float_of(node.exchange(request)[0][2:]) for _ in range(10)]
    assert heard == sorted(heard) and heard[-1] > heard[0], heard


@on("mm420 4+2")
def test_a_write_that_stands_is_carried_out_once(drives, node, kind):
    # The specification does not forbid more; that it is once is how these drives are made.
    request = node.request(2, 3, 0, [2])
    assert node.exchange(request)[0] == node.request(1, 3, 0, [2])
    drives.set(node, 3, 4)
    assert node.exchange(request)[0] == node.request(1, 3, 0, [4])
    node.exchange(node.no_task())
    assert node.exchange(request)[0] == node.request(1, 3, 0, [2])


@on("repeats writes")
def test_a_master_that_leaves_a_write_standing_may_write_every_time(drives, node, kind):
    request = node.request(2, 3, 0, [2])
    node.exchange(request)
    drives.set(node, 3, 4)
    assert node.exchange(request)[0] == node.request(1, 3, 0, [2])


@on("late replies")
def test_the_reply_to_the_task_before_may_still_come(node, kind):
    # It is no error: the number tells whose reply it is. Process data are the newest all the same.
    first, second = node.request(1, 700), node.request(1, 1000)
    heard = [node.exchange(first)[0] for _ in range(3)]
    heard += [node.exchange(second)[0] for _ in range(3)]
    nothing, reply = node.no_task(), [0x1000 | 700, 0, 0, 5]
    assert heard == [nothing, nothing, reply, reply, reply, [0x1000 | 1000, 0, 0, 5]]
    node.exchange(node.request(2, 3, 0, [2]))
    zsw = node.zsw
    node.pzd[0] = RUN
    pkw, pzd = node.exchange(node.request(2, 3, 0, [2]))
    assert pkw[0] != 0x1003 and pzd[0] & 4 and pzd[0] != zsw
    node.control(0x047C)


@on("mm420 4+2")
def test_every_change_of_the_task_is_a_new_task(node, kind):
    for ak, number, values in ((1, 700, []), (1, 1000, []), (2, 3, [2]), (2, 3, [3]), (6, 3, [])):
        reply = node.exchange(node.request(ak, number, 0, values))[0]
        assert reply[0] & 0x7FF == number and reply[0] >> 12 in (WORD, ARRAY_WORD)
    assert node.task(1, 3) == (WORD, [3])


@on(*MICROMASTER_4)
def test_bit_11_of_pke_is_always_0(node, kind):
    # No MICROMASTER 4 sends change reports.
    request = node.request(1, kind.word)
    request[0] |= 0x0800
    reply, _ = node.exchange(request)
    assert reply[0] == WORD << 12 | kind.word


@on(*MICROMASTER_4)
def test_ind_names_pages_of_2000_numbers(node, kind):
    node.task(1, 2000 if not short(node) else 2013)
    pkw, _ = node.exchange(node.request(1, 2011))
    assert pkw[:2] == [WORD << 12 | 11, 0x8000] and pkw[-1] == kind.address
    assert refused(node, node.task(1, 4011), UNKNOWN)


@on("mm420 variable+2", "mm440 variable+4", "g110 variable+2", "v20 variable+2")
def test_in_variable_length_a_reply_is_as_long_as_it_has_to_be(node, kind):
    assert len(node.exchange([0x1000 | 3, 0, 0])[0]) == 3
    assert len(node.exchange([0x1000 | 1120, 0, 0])[0]) == 4
    # A master that always sends four words: the value of a word is in PWE2 then.
    assert node.exchange([0x2000 | 3, 0, 0, 4])[0] == [0x1000 | 3, 0, 4]
    assert node.exchange([0x1000 | 3, 0, 0, 0])[0] == [0x1000 | 3, 0, 4]


@on("generic variable+0")
def test_a_reply_may_fill_a_telegram(node, kind):
    words, _ = node.exchange([0x6000 | 2019 % 2000, 0x80FF, 0])
    assert words[0] >> 12 == ARRAY_DOUBLE and len(words) == 2 + 2 * 16


# ---- rights, storage, commissioning -----------------------------------------------------------


@on("mm420 4+2", "mm440 variable+4", "g110 variable+2", "v20 4+2", "g120 variable+2")
def test_tasks_2_and_3_write_what_the_power_takes(drives, node, kind):
    word, double = node.task(1, 3), node.task(1, 1120)
    assert node.task(2, 3, 0, [4]) == (WORD, [4])
    assert node.task(3, 1120, 0, [0x4140, 0]) == (DOUBLE, [0x4140, 0])
    drives.power_cycle(node)
    assert (node.task(1, 3), node.task(1, 1120)) == (word, double)


@on("mm420 4+2", "mm440 variable+4", "v20 4+2", "g120 variable+2")
def test_p0971_keeps_everything_and_returns_to_0(drives, node, kind):
    before = node.task(1, 1120)[1]
    node.task(3, 1120, 0, [0x4140, 0])
    assert node.task(2, 971, 0, [1])[0] == WORD
    assert value_becomes(node, 971, 0)
    drives.power_cycle(node)
    assert node.task(1, 1120) == (DOUBLE, [0x4140, 0])
    assert node.task(13, 1120, 0, before) == (DOUBLE, before)


def test_a_factory_reset_and_a_calculation_take_a_while_in_which_the_drive_is_silent(drives):
    reset, set_up = drives.node("to be reset"), drives.node("to be set up")
    reset.control(OFF1)
    set_up.control(OFF1)
    assert reset.task(13, 1120, 0, [0x40A0, 0]) == (DOUBLE, [0x40A0, 0])
    assert reset.task(2, 10, 0, [30]) == (WORD, [30])
    for node, number in ((reset, 970), (set_up, 340)):
        # The task is answered before the drive falls silent.
        assert node.exchange(node.request(2, number, 0, [1]))[0][0] == 0x1000 | number
        assert node.master.is_silent(framed(node.address, [0, 0, 0, 0, OFF1, 0]))
    for node, number in ((set_up, 340), (reset, 970)):
        answers_again(node)
        assert node.task(1, number) == node.task(1, 10) == (WORD, [0])
    assert reset.task(1, 1120) == (DOUBLE, [0x4120, 0])  # 10.0 s, as delivered
    assert reset.task(1, 2011) == (WORD, [reset.address])  # or it would be lost


def answers_again(node):
    """Wait until a drive that was busy answers."""
    request = framed(node.address, [0, 0, 0, 0, OFF1, 0])
    for _ in range(60):
        if not node.master.is_silent(request):
            break
        node.master.wait(0.5)
    node.master.settle()


def value_becomes(node, number, value):
    for _ in range(100):
        if node.task(1, number) == (WORD, [value]):
            return True
    return False


@on("mm420 4+2", "mm440 4+8", "v20 4+2", "g110 variable+2")
def test_while_it_is_commissioned_the_motor_does_not_start(node, kind):
    assert node.task(2, 10, 0, [1]) == (WORD, [1])
    node.control(OFF1)
    node.control(RUN)
    assert node.control(RUN)[0] & 4 == 0
    assert node.task(2, 10, 0, [0]) == (WORD, [0])
    assert node.control(RUN)[0] & 4 == 0  # starting takes an edge of ON
    node.control(OFF1)
    assert node.control(RUN)[0] & 4
    node.control(0x047C)


@on("mm420 4+2", "mm440 variable+4", "v20 4+2", "g110 variable+2")
def test_a_parameter_task_may_change_the_address(drives, node, kind):
    # It answers once more at the old one.
    pkw, _ = node.exchange(node.request(2, 2011, 0, [30]))
    assert pkw[0] >> 12 == WORD and pkw[-1] == 30
    moved = Node(node.master, 30, node.pkw_words, node.pzd_words)
    assert moved.task(1, 2011) == (WORD, [30])
    assert moved.exchange(moved.request(2, 2011, 0, [kind.address]))[0][0] >> 12 == WORD
    assert node.task(1, 2011) == (WORD, [kind.address])


@on("mm3 3+2")
def test_a_micromaster_3_has_no_pages(node, kind):
    assert node.exchange([0x1000 | 2, 0, 0])[0][0] == 0x1002
    assert node.exchange([0x1000 | 2, 0x8000, 0])[0] == [0x7002, 0x8000, UNKNOWN]
