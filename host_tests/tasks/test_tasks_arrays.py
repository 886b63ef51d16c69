# SPDX-License-Identifier: MIT
"""Arrays: an element, all elements, how many there are (specification C-4.2.2, tasks 6...12)."""

from pkw_bench import FOUR, THREE, VARIABLE, answered, asked, refused
from uss import pkw
from uss.bus import pkw_errors
from uss.channel import Channel
from uss.families import GENERIC, MM420
from uss.layout import VARIABLE as VARIABLE_WORDS
from uss.tasks import arrays
from uss.tasks.descriptions import LOWER_LIMIT, read_description

MASK = (1 << 30) - 1


def sent(job, pkw_words=VARIABLE_WORDS, longest=20):
    """The PKW words of the telegram that carries the job."""
    channel = Channel(MASK, pkw_words, longest)
    net = bytearray(60)
    channel.ask(job)
    size = channel.fill(net, 0, 0)
    return [net[at] << 8 | net[at + 1] for at in range(0, size, 2)]


def test_one_element():
    """Read P0304[2], P2010[1]; write P0731[0] with r0052 bit 7."""
    assert asked(arrays.read_element(304, 2)) == (0x6130, 2, 0, 0)
    assert asked(arrays.read_element(2010, 1)) == (0x600A, 0x8001, 0, 0)
    assert asked(arrays.write_element_word(304, 2, 230)) == (0x7130, 2, 0, 230)
    assert asked(arrays.write_element_word(304, 2, -1, True)) == (0xC130, 2, 0, 0xFFFF)
    job = arrays.write_element_double(731, 0, 0x00340007)
    assert asked(job) == (0x82DB, 0, 0x0034, 7)
    assert asked(arrays.write_element_double(731, 0, 1, True)) == (0xB2DB, 0, 0, 1)
    assert asked(arrays.write_element_float(1120, 1, 50.0)) == (0x8460, 1, 0x4248, 0)
    assert asked(arrays.write_element_float(1120, 1, 50.0, True)) == (0xB460, 1, 0x4248, 0)


def test_an_index_goes_with_the_task_for_an_element_if_the_family_takes_it_by_that():
    for family, index, task in (
        (MM420, 1, pkw.READ), (GENERIC, 1, pkw.READ_ELEMENT), (GENERIC, 0, pkw.READ),
    ):  # fmt: skip
        job = pkw.read(2010, index)
        assert arrays.with_array_task(job, family) is job and job.task == task
    job = read_description(2010, LOWER_LIMIT)  # this is no index
    assert arrays.with_array_task(job, GENERIC).task == pkw.READ_DESCRIPTION


def test_its_answer_has_the_width_of_its_value():
    job = arrays.read_element(304, 2)
    assert answered(job, (0x4130, 2, 0, 230))
    assert job.width == pkw.WORD and job.integer_value() == 230
    assert answered(job, (0x5130, 2, 0x4248, 0))
    assert job.width == pkw.DOUBLE and job.float_value() == 50.0
    assert answered(job, (0x4130, 2, 231), VARIABLE)
    assert job.integer_value() == 231


def test_how_many_elements_there_are():
    job = arrays.count_elements(304)
    assert asked(job) == (0x9130, 0, 0, 0)
    assert answered(job, (0x6130, 0, 3), THREE)
    assert job.integer_value() == 3


def test_all_elements_are_read():
    job = arrays.read_all(304)
    assert sent(job) == [0x6130, 0x00FF, 0]
    assert answered(job, (0x4130, 0xFF, 400, 0x8000, 0xFFFF), VARIABLE)
    assert job.state == pkw.DONE and (job.high, job.low) == (400, 0x8000)
    assert job.integer_values() == [400, 32768, 65535] and job.signed_values() == [400, -32768, -1]
    assert answered(job, (0x5130, 0xFF, 0x4248, 0, 0xC120, 0), VARIABLE)
    assert job.integer_values() == [0x42480000, 0xC1200000] and job.float_values() == [50.0, -10.0]
    assert answered(job, (0x5130, 0xFF, 0x3E20, 0, 0x4248, 0x8000), VARIABLE)
    assert job.float_values() == [0.15625, 50.125] and (job.high, job.low) == (0x3E20, 0)
    assert answered(job, (0x5130, 0xFF, 0x4248, 0, 0xC120, 0), VARIABLE)
    assert job.signed_values() == [0x42480000, 0xC1200000 - (1 << 32)]
    assert answered(job, (0x5130, 0xFF, 1, 2, 0xFFFF, 0xFFFE), VARIABLE)
    assert job.integer_values() == [0x00010002, 0xFFFFFFFE] and job.signed_values() == [65538, -2]
    assert answered(job, (0x4130, 0xFF, 7), VARIABLE)
    assert job.integer_values() == [7] and (job.high, job.low) == (0, 7)
    assert answered(job, (0x4130, 0xFF, 7, 8), VARIABLE) and (job.high, job.low) == (7, 8)


def test_the_longest_answer_has_124_words():
    job = arrays.read_all(304)
    assert len(job.data) == 124, "room for no more"
    assert answered(job, [0x4130, 0xFF] + list(range(124)), VARIABLE)
    assert job.integer_values() == list(range(124))


def test_an_answer_longer_than_its_room_is_an_error():
    job = arrays.read_all(304, words=4)
    assert answered(job, (0x4130, 0xFF, 1, 2, 3, 4, 5), VARIABLE)
    assert job.state == pkw.REFUSED and pkw_errors.error_text(job.error) == "answer too long"


def test_half_a_double_word_is_no_answer():
    job = arrays.read_all(304)
    assert not answered(job, (0x5130, 0xFF, 1, 2, 3), VARIABLE)
    assert not answered(job, (0x4130, 0xFF), VARIABLE)


def test_all_elements_are_written():
    for job, words in (
        (arrays.write_all_words(304, (1, -2, 3)), [0x7130, 0xFF, 1, 0xFFFE, 3]),
        (arrays.write_all_words(304, (9,)), [0x7130, 0xFF, 9]),
        (arrays.write_all_words(304, (8, 9), True), [0xC130, 0xFF, 8, 9]),
        (arrays.write_all_doubles(304, (1, -1)), [0x8130, 0xFF, 0, 1, 0xFFFF, 0xFFFF]),
        (arrays.write_all_floats(304, (50.0, -10.0)), [0x8130, 0xFF, 0x4248, 0, 0xC120, 0]),
        (arrays.write_all_floats(304, (50.0,), True), [0xB130, 0xFF, 0x4248, 0]),
    ):
        assert sent(job) == words, job
        reply = [5 << 12 | 304 if job.task in (8, 11) else 4 << 12 | 304] + words[1:]
        assert answered(job, reply, VARIABLE) and job.state == pkw.DONE, job
    assert job.float_values() == [50.0]


def test_all_elements_need_variable_length():
    """With a fixed one the drive could only refuse: it is not even asked."""
    for pkw_words in (3, 4):
        for job in (arrays.read_all(304), arrays.write_all_words(304, (1,))):
            channel = Channel(MASK, pkw_words)
            channel.ask(job)
            assert job.state == pkw.REFUSED and job.error == 102, job
            assert pkw_errors.error_text(job.error) == "channel too small"


def test_more_values_than_the_telegram_has_room_for_are_not_sent():
    channel = Channel(MASK, VARIABLE_WORDS, 10)
    fits, does_not = (arrays.write_all_words(304, [1] * count) for count in (8, 9))
    channel.ask(fits)
    channel.ask(does_not)
    assert fits.state == pkw.PENDING
    assert does_not.state == pkw.REFUSED and does_not.error == 102


def test_what_cannot_be_asked_is_refused_at_once():
    for act, arguments in (
        (arrays.read_element, (304, 255)),
        (arrays.write_element_word, (304, 0, 65536)),
        (arrays.write_all_words, (304, (1, 65536))),
        (arrays.write_all_doubles, (304, (1 << 32,))),
        (arrays.write_all_words, (304, ())),
        (arrays.read_all, (-1,)),
    ):
        assert refused(ValueError, act, *arguments), (act, arguments)


def test_in_fixed_layouts_an_element_is_answered_as_ever():
    for form, words in ((THREE, (0x4130, 2, 230)), (FOUR, (0x4130, 2, 0, 230))):
        job = arrays.read_element(304, 2)
        assert answered(job, words, form) and job.integer_value() == 230
