# SPDX-License-Identifier: MIT
"""Parameter tasks and what their replies mean (specification C-4, MM420 Reference Manual).

How tasks are repeated, and told apart, is in test_channel.py; arrays and texts have their own.
"""

from pkw_bench import FOUR, THREE, VARIABLE, answered, asked, characters, refused
from uss import pkw
from uss.bus import pkw_errors

# --- requests -----------------------------------------------------------------------------------


def test_the_tasks_of_the_reference_manual():
    """MM420 Reference Manual 3.3.5."""
    for job, words in (
        (pkw.read(700), (0x12BC, 0, 0, 0)),
        (pkw.read(2000), (0x1000, 0x8000, 0, 0)),
        (pkw.read(2010, 1), (0x100A, 0x8001, 0, 0)),
        (pkw.write_float(1082, 40.5), (0x343A, 0, 0x4222, 0)),
        (pkw.write_float(1082, 40.0, eeprom=True), (0xD43A, 0, 0x4220, 0)),
        (pkw.write_word(1000, 5, eeprom=True), (0xE3E8, 0, 0, 5)),
        (pkw.write_word(700, 2), (0x22BC, 0, 0, 2)),
        (pkw.write_double(731, 0x00340007), (0x32DB, 0, 0x0034, 0x0007)),
    ):
        assert asked(job) == words, job


def test_a_job_that_is_not_told_a_value_or_an_index_has_0():
    for task, pke in ((pkw.READ, 0x12DB), (pkw.WRITE_WORD, 0x22DB), (pkw.WRITE_DOUBLE, 0x32DB)):
        job = pkw.Job(task, 731)
        assert asked(job) == (pke, 0, 0, 0) and (job.index, job.high, job.low) == (0, 0, 0)
        job.aim(task, 1000, 3, 4, 5)
        job.aim(task, 731)
        assert asked(job) == (pke, 0, 0, 0) and (job.index, job.high, job.low) == (0, 0, 0)


def test_numbers_with_a_sign_are_written_in_two_s_complement():
    assert asked(pkw.write_word(1005, -3000))[3] == 0x10000 - 3000
    assert asked(pkw.write_word(1005, 0xFFFF))[3] == 0xFFFF
    assert asked(pkw.write_word(1005, -0x8000))[3] == 0x8000
    assert asked(pkw.write_double(1005, -2))[2:] == (0xFFFF, 0xFFFE)
    assert asked(pkw.write_double(1005, 0xFFFFFFFF))[2:] == (0xFFFF, 0xFFFF)
    assert asked(pkw.write_double(1005, -0x80000000))[2:] == (0x8000, 0)
    assert asked(pkw.write_float(1005, -10.0))[2:] == (0xC120, 0)


def test_pages_of_numbers_from_2000_on():
    """High byte of IND for the first number of a page (CU240S manual, SIDOOR table 6-64)."""
    for number, high_byte in (
        (0, 0x00), (1999, 0x00), (2000, 0x80), (4000, 0x10), (6000, 0x90), (8000, 0x20),
        (10000, 0xA0), (12000, 0x30), (14000, 0xB0), (16000, 0x40), (20000, 0x50),
        (30000, 0xF0), (32000, 0x04), (60000, 0x74), (64000, 0x08),
    ):  # fmt: skip
        assert pkw.ind(number, 0) == high_byte << 8, number
        assert pkw.ind(number, 3) == high_byte << 8 | 3, number
    assert asked(pkw.read(8820, 16))[:2] == (0x1334, 0x2010)
    assert pkw.pke(1, 8820) == 0x1334
    assert asked(pkw.read(127999, 254))[:2] == (0x17CF, 0xFCFE)  # the last of all


def test_every_page_can_be_told_from_every_other():
    """The six bits of the page each have their place; the index stays what it is."""
    places = ((1, 15), (2, 12), (4, 13), (8, 14), (16, 10), (32, 11))
    for page in range(64):
        word = sum(1 << bit for weight, bit in places if page & weight)
        assert pkw.ind(2000 * page + 1999, 254) == word | 254, page
        assert asked(pkw.read(2000 * page + 7, 9))[:2] == (0x1007, word | 9), page
    some = [(page, pnu, index) for page in range(64) for pnu in (0, 1, 2, 3, 1998, 1999)
            for index in (0, 1, 254)]  # fmt: skip
    keys = {pkw.read(2000 * page + pnu, index).key for page, pnu, index in some}
    assert len(keys) == len(some), "each of them has a key of its own"


def test_a_micromaster_3_never_sees_an_index():
    """Its numbers go to 999 and IND is always 0 (SIMATIC compilation for MMV and MDV)."""
    for number in range(1000):
        assert asked(pkw.read(number))[:2] == (0x1000 | number, 0)


def test_what_cannot_be_asked_is_refused_at_once():
    for act, arguments in (
        (pkw.read, (-1,)),
        (pkw.read, (128000,)),
        (pkw.read, (700, 255)),  # all elements: see tasks.arrays
        (pkw.read, (700, -1)),
        (pkw.write_word, (700, 65536)),
        (pkw.write_word, (700, -32769)),
        (pkw.write_double, (731, 1 << 32)),
        (pkw.write_double, (731, -(1 << 31) - 1)),
        (pkw.Job, (0, 700)),
        (pkw.Job, (10, 700)),  # reserved
        (pkw.Job, (16, 700)),
        (pkw.Job, (-1, 700)),
        (pkw.Job, (4, 700)),  # descriptions and texts: see tasks.long_jobs
        (pkw.Job, (15, 700)),
    ):
        assert refused(ValueError, act, *arguments), (act, arguments)
    for value in (5.0, "5", None):
        assert refused(TypeError, pkw.write_word, 700, value), value


def test_a_task_says_whether_it_writes_and_how_many_characters_it_needs():
    """Only what carries a double word needs a channel of four words."""
    for task, writes, size in (
        (pkw.READ, False, 6), (pkw.WRITE_WORD, True, 6), (pkw.WRITE_DOUBLE, True, 8),
        (pkw.READ_ELEMENT, False, 6), (pkw.WRITE_ELEMENT_WORD, True, 6),
        (pkw.WRITE_ELEMENT_DOUBLE, True, 8), (pkw.COUNT_ELEMENTS, False, 6),
        (pkw.WRITE_ELEMENT_DOUBLE_EEPROM, True, 8), (pkw.WRITE_ELEMENT_WORD_EEPROM, True, 6),
        (pkw.WRITE_DOUBLE_EEPROM, True, 8), (pkw.WRITE_WORD_EEPROM, True, 6),
    ):  # fmt: skip
        job = pkw.Job(task, 700)
        assert (job.writes(), job.size()) == (writes, size), task
        for form, room in ((THREE, 6), (FOUR, 8), (VARIABLE, 20), (pkw.VARIABLE_LENGTH | 6, 6)):
            assert job.fits(form) == (size <= room), (task, form)
        assert asked(pkw.Job(task, 700, 0, 1, 2))[2:] == ((1, 2) if writes else (0, 0)), task
    numbers = [pkw.WRITE_WORD, pkw.WRITE_DOUBLE, pkw.WRITE_WORD_EEPROM, pkw.WRITE_DOUBLE_EEPROM]
    made = [pkw.write_word(1, 2), pkw.write_double(1, 2)]
    made += [pkw.write_word(1, 2, 3, True), pkw.write_double(1, 2, 3, True)]
    assert [job.task for job in made] == numbers
    assert [(job.number, job.index, job.low) for job in made] == [(1, 0, 2)] * 2 + [(1, 3, 2)] * 2
    assert [pkw.write_float(1, 1.0, 3, eeprom).task for eeprom in (False, True)] == [3, 13]


def test_a_job_shows_what_it_is_and_what_has_become_of_it():
    job = pkw.read(13, 7)
    for state, text in (
        (pkw.NEW, "new"), (pkw.PENDING, "pending"), (pkw.DONE, "done"), (pkw.REFUSED, "refused"),
        (pkw.TIMED_OUT, "timed out"), (pkw.UNANSWERED, "unanswered"),
    ):  # fmt: skip
        job.state = state
        assert repr(job) == "<AK1 P0013[7] %s>" % text
    assert pkw.name(700) == "P0700[0]" and pkw.name(12345, 1) == "P12345[1]"
    assert refused_with(pkw.read, 700, 255) == "index 255 of P0700[0]"
    assert refused_with(pkw.read, 128000) == "parameter number 128000"
    assert refused_with(pkw.Job, 10, 700) == "task 10"
    assert (job.since, job.tries, job.silences, job.lags, job.tag) == (0,) * 5
    job.refuse(17)
    assert (job.state, job.error) == (pkw.REFUSED, 17)


def refused_with(make, *arguments):
    try:
        make(*arguments)
    except ValueError as error:
        return str(error)
    raise AssertionError("taken: %r" % (arguments,))


# --- replies ------------------------------------------------------------------------------------


def test_a_value_stands_where_the_length_says():
    """Specification C-4.2.3: a word in PWE1 of three, in PWE2 of four; a double word in both."""
    for form, words, value in (
        (THREE, (0x13E8, 0, 5), 5),
        (VARIABLE, (0x13E8, 0, 5), 5),
        (FOUR, (0x13E8, 0, 0, 5), 5),
        (FOUR, (0x23E8, 0, 0x4248, 0x1234), 0x42481234),
        (VARIABLE, (0x23E8, 0, 0x4248, 0x1234), 0x42481234),
    ):
        job = pkw.read(1000)
        assert answered(job, words, form), words
        assert job.state == pkw.DONE and job.integer_value() == value, words
        assert job.width == words[0] >> 12
        assert (job.high, job.low) == (value >> 16, value & 0xFFFF), words


def test_an_answer_is_taken_from_where_it_stands_among_others():
    """Behind the head of a telegram, before its process data; each character has its place."""
    for form, words, high, low in (
        (THREE, (0x13E8, 0, 0x1234), 0, 0x1234),
        (VARIABLE, (0x13E8, 0, 0x1234), 0, 0x1234),
        (FOUR, (0x13E8, 0, 0x1234, 0x5678), 0x1234, 0x5678),
        (FOUR, (0x23E8, 0, 0x1234, 0x5678), 0x1234, 0x5678),
        (VARIABLE, (0x23E8, 0, 0x1234, 0x5678), 0x1234, 0x5678),
    ):
        net = b"\xaa\xbb\xcc\xab\xba" + characters(*words) + b"\xdd\xee\xff\x99\x88\x77"
        job = pkw.read(1000)
        assert job.answer(net, 5, 2 * len(words), form), words
        assert (job.high, job.low, job.width) == (high, low, words[0] >> 12), words
    for form, words, refusal in (
        (THREE, (0x73E8, 0, 0x0234), (0x0234, None, None)),
        (FOUR, (0x73E8, 0, 0x1234, 0x0156), (0x0156, None, None)),
        (VARIABLE, (0x73E8, 0, 0x0234), (0x0234, None, None)),
        (VARIABLE, (0x73E8, 0, 2, 0x1234), (2, 0x1234, None)),
        (VARIABLE, (0x73E8, 0, 2, 0x1234, 0x5678), (2, 0x1234, 0x5678)),
        (VARIABLE, (0x73E8, 0, 0, 0x1234, 0x5678), (0, 0x1234, 0x5678)),
    ):
        net = b"\xaa\xbb\xcc\xab\xba" + characters(*words) + b"\xdd\xee\xff\x99\x88\x77"
        job = pkw.read(1000)
        assert job.answer(net, 5, 2 * len(words), form), words
        assert (job.error, job.next, job.previous) == refusal, words
        assert job.state == pkw.REFUSED


def test_the_same_bits_as_unsigned_as_signed_and_as_float():
    job = pkw.read(1000)
    answered(job, (0x13E8, 0, 0, 0xF448))
    assert job.integer_value() == 62536 and job.signed_value() == -3000
    for word, value in ((0x7FFF, 32767), (0x8000, -32768), (0xFFFF, -1), (0, 0)):
        answered(job, (0x13E8, 0, 0, word))
        assert job.integer_value() == word and job.signed_value() == value
    answered(job, (0x23E8, 0, 0xC120, 0))
    assert job.integer_value() == 0xC1200000 and job.signed_value() == 0xC1200000 - (1 << 32)
    assert job.float_value() == -10.0
    for high, value in ((0x7FFF, 0x7FFF0001), (0x8000, 0x80000001 - (1 << 32))):
        answered(job, (0x23E8, 0, high, 1))
        assert job.integer_value() == high << 16 | 1 and job.signed_value() == value


def test_what_was_offered_instead_is_forgotten_when_a_job_is_refused_again():
    job = pkw.write_word(1000, 61000)
    for words, offered in (
        ((0x73E8, 0, 2, 60000, 7), (2, 60000, 7)),
        ((0x73E8, 0, 2, 60000), (2, 60000, None)),
        ((0x73E8, 0, 2), (2, None, None)),
        ((0x73E8, 0, 0, 1001, 999), (0, 1001, 999)),
        ((0x73E8, 0, 17), (17, None, None)),
    ):
        assert answered(job, words, VARIABLE) and job.state == pkw.REFUSED
        assert (job.error, job.next, job.previous) == offered, words


def test_every_task_is_answered_by_its_own_replies():
    """Specification tables 4.1 and 4.2: AK 7 refuses any, AK 8 those that change something."""
    answers = {
        1: (1, 2), 2: (1,), 3: (2,), 6: (4, 5), 7: (4,), 8: (5,), 9: (6,),
        11: (5,), 12: (4,), 13: (2,), 14: (1,),
    }  # fmt: skip
    for task, fitting in answers.items():
        for reply in range(16):
            job = pkw.Job(task, 304, 2)
            job.state = pkw.PENDING
            ends = answered(job, (reply << 12 | 304, 2, 0, 3))
            writes = task not in (1, 6, 9)
            assert ends == (reply in fitting or reply == 7 or reply == 8 and writes), (task, reply)
            state = pkw.REFUSED if reply in (7, 8) else pkw.DONE
            assert job.state == (state if ends else pkw.PENDING), (task, reply)


def test_descriptions_and_texts_are_answered_by_their_own_replies_too():
    """Which `tasks.long_jobs` asks for; and what is no task is answered by none."""
    for task, fitting in ((4, [3, 7]), (5, [3, 7, 8]), (15, [7, 8, 15]), (0, []), (10, [])):
        assert [one for one in range(32) if pkw.FITTING[task] >> one & 1] == fitting, task
    assert len(pkw.FITTING) == 16


def test_a_reply_of_the_wrong_length_is_none():
    """With variable length the AK says how many words there have to be."""
    for words in (
        (0x13E8, 0, 5, 0),
        (0x13E8, 0, 5, 0, 0),
        (0x13E8, 0),
        (0x23E8, 0, 5),
        (0x23E8, 0, 5, 0, 0),
    ):
        job = pkw.read(1000)
        assert not answered(job, words, VARIABLE), words
    assert not answered(pkw.read(1000), (0x23E8, 0, 5), THREE)


def test_a_stale_reply_is_ignored():
    """Until the drive has seen the new task it may repeat the old reply: no error, no answer."""
    job = pkw.read(1000)
    job.state = pkw.PENDING
    for words in (
        (0x12BC, 0, 0, 5),  # P0700, asked before
        (0x13E8, 1, 0, 5),  # P1000[1]
        (0x13E8, 0x8000, 0, 5),  # P3000
        (0x13E8, 0x0100, 0, 5),  # a text of it
        (0x03E8, 0, 0, 0),  # no reply yet
        (0x0000, 0, 0, 0),
        (0x72BC, 0, 0, 17),  # a refusal of the old task
        (0x33E8, 0, 0, 5),  # a description element: answers no read
        (0x43E8, 0, 0, 5),  # an array element: neither
        (0x83E8, 0, 0, 0),  # no change rights: answers writes only
        (0x93E8, 0, 0, 5),  # somebody has changed it
    ):
        assert not answered(job, words), words
        assert job.state == pkw.PENDING
    assert answered(job, (0x13E8, 0, 0, 5))
    assert job.state == pkw.DONE and job.integer_value() == 5


def test_the_change_report_bit_is_no_part_of_the_number():
    assert answered(pkw.read(1000), (0x1BE8, 0, 0, 5))


def test_a_write_of_a_word_is_not_answered_by_a_double_word():
    job = pkw.write_word(1000, 5)
    job.state = pkw.PENDING
    assert not answered(job, (0x23E8, 0, 0, 5))
    assert job.state == pkw.PENDING


# --- refusals -----------------------------------------------------------------------------------


def test_refusals_say_why_in_words():
    job = pkw.write_word(1082, 40)
    assert answered(job, (0x743A, 0, 0, 5))
    assert job.state == pkw.REFUSED
    assert pkw_errors.error_text(job.error) == "wrong data type"
    job = pkw.write_word(700, 5)
    assert answered(job, (0x82BC, 0, 0, 0))
    assert pkw_errors.error_text(job.error) == "no change rights"
    assert pkw_errors.error_text(17) == "not in this operating state"
    assert pkw_errors.error_text(999) == "error 999"


def test_the_error_number_stands_where_a_word_does():
    for form, words in (
        (THREE, (0x743A, 0, 0x111)),
        (FOUR, (0x743A, 0, 0, 0x111)),
        (VARIABLE, (0x743A, 0, 0x111)),
        (VARIABLE, (0x743A, 0, 0x111, 0)),
        (VARIABLE, (0x743A, 0, 0x111, 0, 0)),
    ):
        job = pkw.read(1082)
        assert answered(job, words, form) and job.error == 0x111, words
        assert job.next is None and job.previous is None


def test_a_drive_with_variable_length_says_what_there_is_instead():
    """A MICROMASTER 4 lets itself be browsed (Reference Manual 3.3.4); others say less."""
    for words, following, before in (
        ((0x7001, 0, 0, 2), 2, None),  # no P0001, but P0002
        ((0x7001, 0, 0, 2011, 0), 2011, 0),
        ((0x7001, 0, 2, 600, 400), 600, 400),  # beyond the limits: 600 and 400 are legal
        ((0x7001, 0, 2, 60), 60, None),
        ((0x7001, 0, 0), None, None),
        ((0x7001, 0, 0, 0), None, None),  # there is none behind it
        ((0x7001, 0, 2, 0, 0), 0, 0),
    ):
        job = pkw.read(1)
        answered(job, words, VARIABLE)
        assert (job.next, job.previous) == (following, before), words
    job.aim(pkw.READ, 1)
    answered(job, (0x7001, 0, 0, 2), FOUR)  # there it is the error number
    assert job.error == 2 and job.next is None


def test_every_error_number_of_the_documents_has_a_text():
    numbers = [number for number, _ in pkw_errors.ERRORS]
    assert numbers == sorted(set(numbers))
    for number in (
        tuple(range(19)) + (20, 21, 22, 23, 24) + tuple(range(101, 109)) + (200, 201, 204)
    ):
        assert pkw_errors.error_text(number) != "error %d" % number, number
    for _, text in pkw_errors.ERRORS:
        assert 5 < len(text) <= 36, text


def test_a_job_is_used_again():
    """The panel has one for all its questions: nothing of the last answer is left."""
    job = pkw.read(700)
    answered(job, (0x72BC, 0, 2, 60, 40), VARIABLE)
    job.aim(pkw.WRITE_WORD, 2000, 0, 0, 5)
    assert asked(job) == (0x2000, 0x8000, 0, 5)
    assert (job.state, job.error, job.width) == (pkw.NEW, 0, 0)
    assert job.next is None and job.previous is None
    assert repr(job) == "<AK2 P2000[0] new>"
    job.aim(pkw.READ, 2000, 0, 1, 2)  # only a write carries a value
    assert asked(job) == (0x1000, 0x8000, 0, 0)
