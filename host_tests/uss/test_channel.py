# SPDX-License-Identifier: MIT
"""The parameter channel of a drive: one task at a time, repeated until the fitting reply comes.

Specification C-4.2.1.1. Time is in microseconds and only passes when a test says so.
"""

import random

from pkw_bench import MASK, Line, refused
from uss import pkw
from uss.channel import JOBS_MAX, REST_MAX, Channel
from uss.layout import VARIABLE
from uss.tasks import arrays
from uss.tasks.change_reports import Reports

NO_TASK = (0, 0, 0, 0)


def tasks(line):
    """AK of each request."""
    return [words[0] >> 12 for words in line.sent]


def words_of(text):
    return tuple([int(word, 16) for word in text.split()])


# --- where the words stand ----------------------------------------------------------------------


def test_without_a_task_the_words_are_zero():
    for pkw_words, size in ((0, 0), (3, 6), (4, 8), (VARIABLE, 6)):
        line = Line(pkw_words)
        for _ in range(2):
            assert line.send() == (0,) * (size // 2)
            assert line.channel.idle, pkw_words


def test_every_task_in_every_layout():
    """Specification C-4.2.3. None: the channel is too small, and nothing is sent."""
    word, double = 0x1234, 0x12345678
    read, write, write_long = (
        arrays.read_element,
        arrays.write_element_word,
        pkw.write_double,
    )
    write_long_element = arrays.write_element_double
    for job, three, four, variable in (
        (pkw.read(2010, 1), "100A 8001 0", "100A 8001 0 0", "100A 8001 0"),
        (pkw.write_word(700, word), "22BC 0 1234", "22BC 0 0 1234", "22BC 0 1234"),
        (write_long(731, double), None, "32DB 0 1234 5678", "32DB 0 1234 5678"),
        (read(304, 2), "6130 2 0", "6130 2 0 0", "6130 2 0"),
        (write(304, 2, word), "7130 2 1234", "7130 2 0 1234", "7130 2 1234"),
        (write_long_element(731, 2, double), None, "82DB 2 1234 5678", "82DB 2 1234 5678"),
        (arrays.count_elements(304), "9130 0 0", "9130 0 0 0", "9130 0 0"),
        (write_long_element(731, 2, double, True), None, "B2DB 2 1234 5678", "B2DB 2 1234 5678"),
        (write(304, 2, word, True), "C130 2 1234", "C130 2 0 1234", "C130 2 1234"),
        (write_long(731, double, 0, True), None, "D2DB 0 1234 5678", "D2DB 0 1234 5678"),
        (pkw.write_word(700, word, 0, True), "E2BC 0 1234", "E2BC 0 0 1234", "E2BC 0 1234"),
        (arrays.read_all(304), None, None, "6130 FF 0"),
        (arrays.write_all_words(304, (1, 2, 3)), None, None, "7130 FF 1 2 3"),
    ):
        for pkw_words, expected in ((3, three), (4, four), (VARIABLE, variable)):
            line = Line(pkw_words)
            line.ask(job)
            if expected is None:
                assert job.state == pkw.REFUSED and job.error == 102, job
                expected = "0 0 0 0" if pkw_words == 4 else "0 0 0"
            assert line.send() == words_of(expected), (job, pkw_words)
            job.state = pkw.NEW


def test_a_job_may_go_to_drives_of_different_layouts_one_after_the_other():
    """It knows its value; the channel knows the place."""
    job = pkw.write_word(700, 5)
    for pkw_words, words in (
        (4, (0x22BC, 0, 0, 5)),
        (3, (0x22BC, 0, 5)),
        (VARIABLE, (0x22BC, 0, 5)),
    ):
        line = Line(pkw_words)
        line.ask(job)
        assert line.send() == words
        line.answer(*((0x12BC,) + words[1:]))
        assert job.state == pkw.DONE and job.integer_value() == 5, pkw_words


def test_with_variable_length_the_task_makes_the_telegram_longer_and_shorter():
    line = Line(VARIABLE)
    for job, words in (
        (pkw.read(700), (0x12BC, 0, 5)),
        (pkw.write_double(731, 1), (0x22DB, 0, 0, 1)),
        (arrays.write_all_words(304, (1, 2, 3, 4)), (0x4130, 0xFF, 1, 2, 3, 4)),
    ):
        line.ask(job)
        assert len(line.send()) == len(words)
        line.answer(*words)
        assert job.state == pkw.DONE
        assert line.send() == (0, 0, 0)
        line.answer(0, 0, 0)


def test_a_task_must_find_room_in_the_request():
    line = Line(VARIABLE, longest=3)
    job = line.ask(pkw.write_double(731, 1))
    assert job.state == pkw.REFUSED and job.error == pkw.TOO_SMALL
    line.ask(pkw.write_word(731, 1))
    assert line.send() == (0x22DB, 0, 1)
    line = Line(3)
    Reports(line.channel)  # who follows them has no more room by that
    line.ask(job)
    assert job.state == pkw.REFUSED and job.error == pkw.TOO_SMALL


def test_a_drive_without_pkw_words_cannot_be_asked():
    line = Line(0)
    assert line.channel.idle and line.channel.is_full()
    try:
        line.ask(pkw.read(700))
    except RuntimeError as error:
        assert "no parameter channel" in str(error)
    else:
        raise AssertionError("asked")
    line.miss()
    assert line.send() == ()


def test_a_request_without_a_task_has_as_many_words_as_its_form_and_tells_of_the_reports():
    """None in a short telegram, unless change reports are followed: then its first bit counts."""
    for pkw_words, short, count in (
        (3, False, 3), (4, False, 4), (VARIABLE, False, 3), (VARIABLE, True, 0),
    ):  # fmt: skip
        line = Line(pkw_words)
        line.channel = channel = Channel(MASK, pkw_words, 20, short)
        assert line.send() == (0,) * count and channel.idle
        reports = Reports(channel)
        assert not channel.idle
        for bit in (0, 8, 0):
            reports.bit = bit
            assert line.send() == (bit << 8,) + (0,) * (max(count, 3) - 1)
            assert not channel.idle
        reports.bit = 8
        job = line.ask(pkw.write_word(700, 5))
        value = (0, 5) if pkw_words == 4 else (5,)
        assert line.send() == (0x2ABC, 0) + value
        reports.close()
        assert line.send() == (0x22BC, 0) + value
        line.answer(0x12BC, 0, *value)
        assert job.state == pkw.DONE
        assert line.send() == (0,) * count and not channel.idle
        line.answer(*(0,) * count)
        assert line.send() == (0,) * count and channel.idle
        line.channel.become(Channel(MASK, 4))
        assert line.send() == NO_TASK and not channel.idle


# --- a task and its end -------------------------------------------------------------------------


def test_a_task_stands_until_it_is_answered_and_not_longer():
    line = Line()
    job = line.ask(pkw.read(700))
    for _ in range(5):
        assert line.send() == (0x12BC, 0, 0, 0)
        line.answer(*NO_TASK)
    assert job.state == pkw.PENDING
    line.send()
    line.answer(0x12BC, 0, 0, 5)
    assert job.state == pkw.DONE and job.integer_value() == 5
    assert line.send() == NO_TASK
    assert not line.channel.idle  # the drive has not said AK 0 yet
    line.answer(*NO_TASK)
    assert line.channel.idle


def test_stale_replies_are_ignored_for_as_long_as_they_come():
    """Old task, no reply yet, another parameter, somebody else's change, the wrong length."""
    for pkw_words in (3, 4, VARIABLE):
        word = (0, 7) if pkw_words == 4 else (7,)
        line = Line(pkw_words)
        job = line.ask(pkw.read(1000))
        for round_number in range(30):
            for head in (
                (0x12BC, 0), (0, 0), (0x13E8, 1), (0x13E8, 0x8000), (0x93E8, 0), (0x9BE8, 0),
                (0xA3E8, 0), (0xB3E8, 0), (0xC3E8, 0), (0x33E8, 0), (0x72BC, 0), (0xF3E8, 0),
            ):  # fmt: skip
                assert line.send(us=1000)[0] == 0x13E8, round_number
                line.answer(*(head + word))
                assert job.state == pkw.PENDING, head
        line.send()
        line.answer(*((0x1BE8, 0) + word))  # bit 11 is no part of the number
        assert job.state == pkw.DONE and job.integer_value() == 7


def test_two_tasks_of_one_parameter_have_no_task_between_them():
    """Or the old reply would be taken for the answer, or the same write not be carried out."""
    line = Line()
    first, second = line.ask(pkw.write_word(700, 5)), line.ask(pkw.write_word(700, 5))
    line.send()
    line.answer(0x12BC, 0, 0, 5)
    for _ in range(3):
        assert line.send() == NO_TASK
        line.answer(0x12BC, 0, 0, 5)  # the drive has not seen that yet
        assert (first.state, second.state) == (pkw.DONE, pkw.PENDING)
    line.send()
    line.answer(*NO_TASK)
    assert line.send() == (0x22BC, 0, 0, 5)
    assert tasks(line) == [2, 0, 0, 0, 0, 2]


def test_tasks_of_different_parameters_follow_each_other_at_once():
    line = Line()
    for number in (700, 1000, 700):
        line.ask(pkw.read(number))
    for number in (700, 1000, 700):
        assert line.send() == (0x1000 | number, 0, 0, 0)
        line.answer(0x1000 | number, 0, 0, 5)


def test_what_went_into_the_eeprom_is_followed_by_no_task_whatever_comes_next():
    for job in (
        pkw.write_word(700, 5, eeprom=True),
        pkw.write_double(700, 5, eeprom=True),
        arrays.write_element_word(700, 0, 5, eeprom=True),
        arrays.write_element_double(700, 0, 5, eeprom=True),
    ):
        line = Line()
        line.ask(job)
        line.ask(pkw.read(1000))
        line.send()
        reply = {11: 5, 12: 4, 13: 2, 14: 1}[job.task]
        line.answer(reply << 12 | 700, 0, 0, 5)
        assert job.state == pkw.DONE
        assert line.send() == NO_TASK
        line.answer(*NO_TASK)
        assert line.send() == (0x13E8, 0, 0, 0)


def test_a_write_that_timed_out_is_followed_by_no_task_as_well():
    """It may be carried out late: its answer must not be taken for that of the next one."""
    for eeprom, us in ((False, 2_000_000), (True, 5_000_000)):
        for following, number in ((pkw.read(1000), 1000), (pkw.read(700), 700)):
            line = Line()
            job = line.ask(pkw.write_word(700, 5, 0, eeprom))
            line.ask(following)
            for _ in range(5):
                line.send()
                line.miss()
            line.now += us
            assert line.send() == NO_TASK and job.state == pkw.TIMED_OUT
            line.answer(0x12BC, 0, 0, 5)
            assert line.send() == NO_TASK
            line.answer(*NO_TASK)
            assert line.send() == (0x1000 | number, 0, 0, 0)


def test_what_was_only_read_may_be_followed_by_another_task_at_once():
    line = Line()
    line.ask(pkw.read(700))
    line.ask(pkw.read(1000))
    for _ in range(5):
        line.send(us=1_000_000)
        line.miss()
    assert line.send() == (0x13E8, 0, 0, 0)


def test_a_drive_that_never_says_that_there_is_no_task_is_asked_all_the_same():
    for number, head in ((700, 0x12BC), (5, 0x1005)):
        line = Line()
        for _ in range(2 * JOBS_MAX):  # wherever in the ring of jobs that happens
            job = line.ask(pkw.read(number))
            while line.send() == NO_TASK:
                line.answer(head, 0, 0, 5)
                assert job.state == pkw.PENDING
            line.answer(head, 0, 0, 5)
            assert job.state == pkw.DONE
        assert tasks(line) == [1] + ([0] * REST_MAX + [1]) * (2 * JOBS_MAX - 1)


def test_a_drive_that_falls_silent_over_its_reply_is_asked_all_the_same():
    """Wherever in the ring of jobs that happens."""
    line = Line()
    for _ in range(2 * JOBS_MAX):
        line.ask(pkw.read(700))
        line.send()
        line.answer(0x12BC, 0, 0, 5)
        job = line.ask(pkw.read(700))
        for _ in range(REST_MAX):
            assert line.send() == NO_TASK
            line.miss()
        assert line.send() == (0x12BC, 0, 0, 0)
        line.answer(0x12BC, 0, 0, 5)
        assert job.state == pkw.DONE
        for _ in range(REST_MAX):
            assert line.send() == NO_TASK and not line.channel.idle
            line.miss()
        line.send()
        assert line.channel.idle
        line.ask(pkw.read(1000))
        line.send()
        line.answer(0x13E8, 0, 0, 5)


def test_a_refusal_ends_a_task():
    line = Line(VARIABLE)
    job = line.ask(pkw.read(1))
    line.send()
    line.answer(0x7001, 0, 0, 2)
    assert job.state == pkw.REFUSED and job.error == 0 and job.next == 2
    assert line.send() == (0, 0, 0)


def test_a_drive_is_browsed_by_what_it_offers_next():
    """MM420 Reference Manual 3.3.4: ask for any number; error 0 says which one comes next."""
    existing = (2, 3, 700, 1000, 2011)
    line, found, number = Line(VARIABLE), [], 0
    while number is not None:
        job = line.ask(pkw.read(number))
        line.send()
        head = (pkw.pke(0, number), pkw.ind(number, 0))
        if number in existing:
            found.append(number)
            line.answer(0x1000 | head[0], head[1], 5)
        else:
            following = [other for other in existing if other > number]
            line.answer(*((0x7000 | head[0], head[1], 0) + tuple(following[:1])))
        number = number + 1 if job.state == pkw.DONE else job.next
    assert tuple(found) == existing


# --- jobs that wait -----------------------------------------------------------------------------


def test_eight_jobs_wait_and_a_ninth_is_not_taken():
    line = Line()
    jobs = [line.ask(pkw.read(700 + number)) for number in range(JOBS_MAX)]
    assert line.channel.is_full()
    assert refused(RuntimeError, line.ask, pkw.read(700))
    for number, job in enumerate(jobs):
        assert line.send()[0] == 0x1000 | 700 + number
        line.answer(0x1000 | 700 + number, 0, 0, number)
        assert job.state == pkw.DONE and job.integer_value() == number
    assert not line.channel.is_full()


def test_a_channel_that_becomes_another_begins_anew():
    """What waited is over. The answer to it may come still: the drive says AK 0 first."""
    for waiting in (0, 1, 3, JOBS_MAX):
        line = Line()
        line.ask(pkw.read(700))
        line.send()
        line.answer(0x12BC, 0, 0, 5)
        jobs = [line.ask(pkw.read(700 + number)) for number in range(waiting)]
        line.channel.become(Channel(MASK, 3))
        assert [job.state for job in jobs] == [pkw.TIMED_OUT] * waiting
        jobs = [line.ask(pkw.read(1000 + number)) for number in range(JOBS_MAX)]
        assert line.channel.is_full()
        for head in (0x12BC, 0x13E8, 0):
            assert line.send() == (0, 0, 0), waiting
            line.answer(head, 0, 0)
        for number, job in enumerate(jobs):
            assert line.send() == (0x1000 | 1000 + number, 0, 0), waiting
            line.answer(0x1000 | 1000 + number, 0, number)
            assert job.state == pkw.DONE and job.low == number
    line.channel.become(Channel(MASK, 0))
    assert line.channel.idle and line.channel.is_full()


def test_a_pending_job_is_not_taken_twice():
    line = Line()
    job = line.ask(pkw.read(700))
    assert refused(RuntimeError, line.ask, job)
    assert refused(RuntimeError, Line().ask, job)


def test_an_answered_job_may_be_asked_again():
    line = Line()
    job = pkw.write_word(700, 5)
    for value in (5, 5, 5):
        line.ask(job)
        assert line.send() == (0x22BC, 0, 0, value)
        line.answer(0x12BC, 0, 0, value)
        line.send()
        line.answer(*NO_TASK)
        assert job.state == pkw.DONE


def test_the_time_of_a_job_begins_when_it_is_its_turn():
    """And it is waited for through five telegrams at least, however long a round takes."""
    line = Line()
    first, second = [line.ask(pkw.read(number)) for number in (700, 1000)]
    for _ in range(5):
        assert first.state == second.state == pkw.PENDING
        line.send(us=3_000_000)
        line.miss()
    # Silent on three, and then without it as well: it is not for the task.
    assert first.state == pkw.TIMED_OUT and tasks(line) == [1, 1, 1, 0, 0]
    for _ in range(6):
        assert second.state == pkw.PENDING
        line.send(us=380_000)
        line.miss()
    assert second.state == pkw.PENDING
    line.now += 200_000
    line.miss()
    assert second.state == pkw.TIMED_OUT


def test_what_may_be_too_old_by_then_is_not_foreseen():
    """A link may send the telegram that is foreseen much later, without anyone looking at it."""
    line = Line()
    line.now = 3_000_000  # its time begins with its first telegram
    job = line.ask(pkw.read(1000))
    for _ in range(5):
        words = line.channel.foresee(False)
        assert words == job.words
        line.channel.sent(words, 0, line.now)
        line.answer(0x12BC, 0, 0, 5)  # still what was asked before
    assert line.channel.foresee(False) is None and job.state == pkw.PENDING
    line.send(us=1_000_000)
    assert job.state == pkw.PENDING
    line.send(us=1_000_000)
    assert job.state == pkw.TIMED_OUT


def test_the_time_of_a_job_goes_on_while_it_waits_for_the_end_of_the_one_before():
    line = Line()
    line.ask(pkw.read(700))
    job = line.ask(pkw.read(700))
    line.send()
    line.answer(0x12BC, 0, 0, 5)
    for _ in range(REST_MAX):
        assert line.send(us=100_000) == NO_TASK
        line.answer(0x12BC, 0, 0, 5)
    for _ in range(5):
        assert line.send() == (0x12BC, 0, 0, 0) and job.state == pkw.PENDING
        line.answer(*NO_TASK)
    line.send(us=100_000)
    assert job.state == pkw.TIMED_OUT  # 2 s after its turn came


def foreseen(line, answering):
    """The words that are foreseen; None if that depends."""
    words = line.channel.foresee(answering)
    return words and tuple(words[at] << 8 | words[at + 1] for at in range(0, 8, 2))


def test_what_is_foreseen_behind_an_answer_is_what_is_sent_then():
    """Whatever was asked, and whatever comes next."""
    for make in (
        lambda: pkw.read(700),
        lambda: pkw.write_word(700, 5),
        lambda: pkw.write_word(700, 5, eeprom=True),
        lambda: pkw.write_double(700, 5, eeprom=True),
        lambda: arrays.write_element_word(700, 0, 5, eeprom=True),
        lambda: arrays.write_element_double(700, 0, 5, eeprom=True),
    ):
        for number, index in ((None, 0), (700, 0), (700, 1), (5, 0), (1000, 0), (2700, 0)):
            line = Line()
            job = line.ask(make())
            if number is not None:
                line.ask(pkw.read(number, index))
            assert foreseen(line, True) == foreseen(line, False) == line.send()
            assert foreseen(line, False) == line.sent[-1]  # an old answer comes
            following = foreseen(line, True)
            reply = {1: 1, 2: 1, 11: 5, 12: 4, 13: 2, 14: 1}[job.task]
            line.answer(reply << 12 | 700, 0, 0, 5)
            assert job.state == pkw.DONE
            assert foreseen(line, False) == line.send() == following, (job, number)
            if following == NO_TASK:
                following = foreseen(line, True)
                line.answer(*NO_TASK)
                assert foreseen(line, False) == line.send() == following, (job, number)


def test_telegrams_that_were_foreseen_end_a_task_as_any_others_do():
    """With one without the task behind it, and none more: the next question is sent at once."""
    line = Line()
    for value in range(2 * JOBS_MAX):
        job = line.ask(pkw.read(700))
        for words, reply in ((job.words, (0x12BC, 0, 0, value)), (bytes(8), NO_TASK)):
            assert line.channel.foresee(False) == words
            line.channel.sent(words, 0, line.now)
            assert not line.channel.idle
            line.answer(*reply)
        assert job.state == pkw.DONE and job.low == value and line.channel.idle
    reports = Reports(line.channel)
    line.channel.sent(bytes(8), 0, line.now)  # it was foreseen before
    assert not line.channel.idle
    reports.close()
    line.channel.sent(bytes(8), 0, line.now)
    assert line.channel.idle


def test_a_drive_that_lags_three_telegrams_is_read_however_slow_the_round_is():
    line = Line()
    job = line.ask(pkw.read(1000))
    for _ in range(3):
        line.send(us=3_000_000)
        line.answer(0x12BC, 0, 0, 5)  # still what was asked before
    line.send(us=3_000_000)
    line.miss()
    line.send(us=3_000_000)
    line.answer(0x13E8, 0, 0, 5)
    assert job.state == pkw.DONE and job.low == 5


def test_a_slow_drive_has_two_seconds_and_five_for_its_eeprom():
    for job, seconds in (
        (pkw.read(700), 2),
        (pkw.write_word(700, 5, 0, True), 5),
        (arrays.write_element_double(700, 0, 5, True), 5),
    ):
        line = Line()
        line.ask(job)
        for _ in range(seconds * 100):
            line.send(us=10_000)
            line.answer(*NO_TASK)
            assert job.state == pkw.PENDING
        line.send(us=10_000)
        assert job.state == pkw.TIMED_OUT


# --- a drive that falls silent on a task --------------------------------------------------------


def ask_in_vain(line, job, telegrams=3):
    """Telegrams with a task that nobody answers; the one before was answered."""
    line.send()
    line.answer(*NO_TASK)
    line.ask(job)
    for silent in range(1, telegrams + 1):
        words = line.send()
        assert words[0] >> 12 == job.task and job.state == pkw.PENDING, silent
        line.channel.miss(line.now, silent)


def test_a_task_that_silences_the_drive_is_withdrawn_after_three_telegrams():
    """Without it the drive answers: the task is to blame."""
    for job in (
        pkw.read(999),
        pkw.write_word(999, 5),
        pkw.write_double(999, 5, eeprom=True),
        arrays.read_element(999, 2),
    ):
        line = Line()
        ask_in_vain(line, job)
        following = line.ask(pkw.read(700))
        assert line.send() == NO_TASK
        assert line.channel.foresee(True) is line.channel.foresee(False) is None  # that depends
        line.answer(*NO_TASK)
        assert job.state == pkw.UNANSWERED, job
        if job.writes():  # its answer may come late
            assert line.send() == NO_TASK
            line.answer(*NO_TASK)
        assert line.send() == (0x12BC, 0, 0, 0)
        line.answer(0x12BC, 0, 0, 5)
        assert following.state == pkw.DONE and following.low == 5
        assert [task for task in tasks(line) if task == job.task][3:] == [1] * (job.task == 1)
        line.send()
        line.answer(*NO_TASK)
        ask_in_vain(line, job)  # what it was blamed for is not held against it again


def test_a_task_is_not_to_blame_when_the_drive_is_silent_without_it_too():
    """A wire that was pulled for a moment: the question is asked again, and answered."""
    line = Line()
    job = pkw.read(1000)
    ask_in_vain(line, job)
    for silent in range(4, 9):
        assert line.send() == NO_TASK
        line.channel.miss(line.now, silent)
    assert line.send() == NO_TASK
    line.answer(*NO_TASK)
    assert job.state == pkw.PENDING
    assert line.send() == (0x13E8, 0, 0, 0)
    line.answer(0x13E8, 0, 0, 5)
    assert job.state == pkw.DONE


def test_a_write_that_was_interrupted_so_is_not_sent_again():
    """The drive may have heard both: it would be carried out twice."""
    line = Line()
    job = pkw.write_word(700, 5, eeprom=True)
    ask_in_vain(line, job)
    line.send()
    line.channel.miss(line.now, 4)
    line.send()
    following = line.ask(pkw.read(1000))
    line.answer(*NO_TASK)
    assert job.state == pkw.TIMED_OUT
    assert line.send() == NO_TASK  # its answer may come late
    line.answer(*NO_TASK)
    assert line.send() == (0x13E8, 0, 0, 0)
    line.answer(0x13E8, 0, 0, 5)
    assert following.state == pkw.DONE
    for _ in range(10):
        assert line.send() == NO_TASK
        line.answer(*NO_TASK)


def test_a_drive_that_was_silent_before_the_task_came_says_nothing_about_it():
    line = Line()
    line.send()
    line.channel.miss(line.now, 1)
    job = line.ask(pkw.read(1000))
    for silent in range(2, 5):
        assert line.send() == (0x13E8, 0, 0, 0)
        line.channel.miss(line.now, silent)
    assert line.send() == NO_TASK
    line.answer(*NO_TASK)
    assert job.state == pkw.PENDING
    for silent in range(1, 4):  # but these do
        assert line.send() == (0x13E8, 0, 0, 0)
        line.channel.miss(line.now, silent)
    line.send()
    line.answer(*NO_TASK)
    assert job.state == pkw.UNANSWERED


def test_a_silence_before_its_first_telegram_is_not_held_against_a_task():
    line = Line()
    line.send()
    job = line.ask(pkw.read(999))
    for _ in range(3):
        line.channel.miss(line.now, 1)  # of the one that is on the line
    for silent in range(1, 4):
        assert line.send() == (0x13E7, 0, 0, 0)
        line.channel.miss(line.now, silent)
    line.send()
    line.answer(*NO_TASK)
    assert job.state == pkw.UNANSWERED


def test_an_old_answer_in_between_is_an_answer():
    line = Line()
    job = line.ask(pkw.read(1000))
    for _ in range(20):
        for silent in (1, 2):
            assert line.send() == (0x13E8, 0, 0, 0)
            line.channel.miss(line.now, silent)
        assert line.send() == (0x13E8, 0, 0, 0)
        line.answer(0x12BC, 0, 0, 5)
    assert job.state == pkw.PENDING


def lagging(line, lag):
    """A drive that carries out a task so many telegrams late, and is silent on all but P1000:
    what it heard so many telegrams ago decides what it does."""
    heard = [NO_TASK] * (lag + 1)
    silent = [0]

    def exchange():
        heard.append(line.send())
        at_work = heard[-1 - lag]
        if at_work[0] >> 12 == 0 or at_work[0] & 0x7FF == 1000:
            silent[0] = 0
            task = at_work[0] >> 12
            line.answer(*((0x13E8, 0, 0, 5) if task else NO_TASK))
        else:
            silent[0] += 1
            line.channel.miss(line.now, silent[0])
        return silent[0]

    return exchange


def test_a_drive_that_lags_is_silent_for_longer_on_a_task_that_it_does_not_know():
    """It answers the first telegrams with the task, and not the first without: as many each."""
    for lag in range(4):
        line = Line()
        exchange = lagging(line, lag)
        exchange()
        job = line.ask(pkw.read(999))
        silences = []
        while job.state == pkw.PENDING:
            silences.append(exchange())
            assert len(silences) < 20, (lag, silences)
        assert job.state == pkw.UNANSWERED, lag
        assert max(silences) == 3 + lag
        following = line.ask(pkw.read(1000))
        for _ in range(20):
            exchange()
        assert following.state == pkw.DONE and following.low == 5, lag


def test_a_drive_that_lags_may_be_silent_for_as_many_telegrams_without_the_task():
    """If it is so for one more, the wire is to blame. Four at the most are counted."""
    for lags in range(6):
        for silent, state in ((0, pkw.UNANSWERED), (1, pkw.PENDING)):
            line = Line()
            job = line.ask(pkw.read(1000))
            for _ in range(lags):
                line.send()
                line.answer(*NO_TASK)
            for _ in range(3):
                assert line.send() == (0x13E8, 0, 0, 0)
                line.miss()
            for _ in range(min(lags, 4) + silent):
                assert line.send() == NO_TASK
                line.miss()
            assert line.send() == NO_TASK
            line.answer(*NO_TASK)
            assert job.state == state, (lags, silent)


def test_in_a_slow_round_every_second_telegram_goes_without_the_task():
    """With the next silence half of the lost time would be over: the drive is asked without it in
    between, and three silences on it, each behind an answer, are enough all the same.
    """
    line = Line()
    job = line.ask(pkw.read(999))
    for _ in range(3):
        assert job.state == pkw.PENDING
        assert line.send(us=300_000) == (0x13E7, 0, 0, 0)
        line.channel.miss(line.now, 1, True)
        assert line.send(us=300_000) == NO_TASK
        line.answer(*NO_TASK)
    assert job.state == pkw.UNANSWERED


def test_in_a_slow_round_two_silences_are_enough_of_a_drive_that_lags():
    """Its old answer has come between; of one that has not answered so, a third is wanted."""
    for lags, state in ((1, pkw.UNANSWERED), (0, pkw.PENDING)):
        line = Line()
        job = line.ask(pkw.read(999))
        for _ in range(lags):
            line.send()
            line.answer(*NO_TASK)
        for silent in (1, 2):
            assert line.send(us=300_000) == (0x13E7, 0, 0, 0)
            line.channel.miss(line.now, silent, silent == 2)
        for silent in range(lags):
            assert line.send(us=300_000) == NO_TASK
            line.channel.miss(line.now, 3 + silent, True)
        assert line.send(us=300_000) == NO_TASK
        line.answer(*NO_TASK)
        assert job.state == state, lags


def test_in_a_slow_round_a_single_loss_is_not_held_against_a_question():
    line = Line()
    job = line.ask(pkw.read(1000))
    line.send(us=300_000)
    line.channel.miss(line.now, 1, True)
    line.send(us=300_000)
    line.answer(*NO_TASK)
    assert line.send(us=300_000) == (0x13E8, 0, 0, 0)
    line.answer(0x13E8, 0, 0, 5)
    assert job.state == pkw.DONE


# --- any tasks, any trouble ---------------------------------------------------------------------


class PaperDrive:
    """What a drive has to answer, worked out word by word from the tables of the specification.

    It carries a task out once, when it changes, and may take some telegrams over its reply.
    """

    NARROW = {700: [5], 304: [400, 230, 110], 2010: [6, 7], 8820: [1, 2, 3]}
    WIDE = {1082: [0x42480000], 731: [0x00340007, 1, 2], 64001: [9]}
    READ_ONLY = {52: [0xFB31]}
    LIMIT = 60000  # of a word

    def __init__(self, pkw_words):
        self.pkw_words = pkw_words
        self.values = {}
        for table in (self.NARROW, self.WIDE, self.READ_ONLY):
            for number, values in table.items():
                self.values[number] = list(values)
        self.writes = 0
        self.task = self.reply = (0, 0)
        self.lag = 0

    def hear(self, words):
        """The reply to a request, both as words."""
        if words != self.task:
            self.task, self.old = words, self.reply
            self.reply = self.carry_out(words)
            self.lag = random.choice((0, 0, 1, 2, 6))
        if self.lag:
            self.lag -= 1
            return self.old if random.randrange(3) else self.words(0, 0, 0, ())
        return self.reply

    def carry_out(self, words):
        ak, index = words[0] >> 12, words[1] & 0xFF
        page = 0
        for bit, weight in ((15, 1), (12, 2), (13, 4), (14, 8), (10, 16), (11, 32)):
            page += weight * (words[1] >> bit & 1)
        number = (words[0] & 0x7FF) + 2000 * page
        wide, array = number in self.WIDE, ak in (6, 7, 8, 11, 12)
        if ak == 0:
            return self.words(0, 0, 0, ())
        if number not in self.values:
            following = [other for other in self.values if other > number]
            return self.refusal(words, 0, [min(following)] if following else [])
        values = self.values[number]
        if ak == 9:
            return self.words(6, words[0], words[1], (len(values),))
        if index != 255 and index >= len(values):
            return self.refusal(words, 3, [])
        if ak not in (1, 6):
            if number == 700 and index == 0 and words[-1] == 0x7777:
                return self.words(8, words[0], words[1], (0,))
            error, hints = self.write(words, ak in (3, 8, 11, 13), number, index)
            if error:
                return self.refusal(words, error, hints)
        told = values if index == 255 else [values[index]]
        flat = [
            part
            for value in told
            for part in ((value >> 16, value & 0xFFFF) if wide else (value,))
        ]
        return self.words(
            (5 if wide else 4) if array else (2 if wide else 1), words[0], words[1], flat
        )

    def write(self, words, double, number, index):
        if number in self.READ_ONLY:
            return 1, []
        if double != (number in self.WIDE):
            return 5, []
        given = list(words[2:])
        if self.pkw_words == 4 and not double:
            given = given[1:]
        if double:
            given = [given[at] << 16 | given[at + 1] for at in range(0, len(given), 2)]
        if not double and max(given) > self.LIMIT:
            return 2, [self.LIMIT, 0]
        self.writes += 1
        if index == 255:
            self.values[number][:] = given
        else:
            self.values[number][index] = given[0]
        return None, []

    def refusal(self, words, error, hints):
        if self.pkw_words != VARIABLE:
            hints = []
        return self.words(7, words[0], words[1], [error] + hints)

    def words(self, ak, pke, ind, values):
        """PKE and IND, and values in their place; two at the most where the length is fixed."""
        head = (ak << 12 | pke & 0x7FF, ind)
        if self.pkw_words == VARIABLE:
            return head + (tuple(values) or (0,))
        if self.pkw_words == 3 and len(values) > 1:
            return (7 << 12 | pke & 0x7FF, ind, 102)
        return head + (0,) * (self.pkw_words - 2 - len(values)) + tuple(values)


def some_job(drive):
    """Any task, mostly one that the drive can carry out; and the words it writes."""
    wide = random.randrange(2)
    number = random.choice(tuple(drive.WIDE if wide else drive.NARROW))
    count = len(drive.values[number])
    index = random.randrange(count)
    value = random.choice((0, 1, 0x7777, 0xFFFF, random.getrandbits(16)))
    value |= random.getrandbits(16) << 16 if wide else 0
    eeprom = random.randrange(2) == 1
    writes = (
        (pkw.write_double, arrays.write_element_double, arrays.write_all_doubles)
        if wide
        else (pkw.write_word, arrays.write_element_word, arrays.write_all_words)
    )
    return random.choice(
        (
            lambda: pkw.read(number, index),
            lambda: arrays.read_element(number, index),
            lambda: arrays.count_elements(number),
            lambda: writes[0](number, value, index, eeprom),
            lambda: writes[1](number, index, value, eeprom),
            lambda: arrays.read_all(number),
            lambda: writes[2](number, [value] * count, eeprom),
            lambda: pkw.read(random.choice((1, 52, 1999, 4000, 127999))),
            lambda: pkw.write_word(52, 1),
            lambda: pkw.write_word(1082, 1),  # a word for a double word
            lambda: pkw.read(number, 77),
        )
    )()


def expected(drive, reply):
    """State, error, next, previous and values that a reply stands for."""
    ak, values = reply[0] >> 12, list(reply[2:])
    if ak == 8:
        return pkw.REFUSED, pkw.NO_CHANGE_RIGHTS, None, None, None
    if ak == 7:
        if drive.pkw_words == 4:
            values = values[1:]
        values += [None, None]
        return (pkw.REFUSED,) + tuple(values[:3]) + (None,)
    if drive.pkw_words == 4 and ak in (1, 4, 6):
        values = values[1:]
    if ak in (2, 5):
        values = [values[at] << 16 | values[at + 1] for at in range(0, len(values), 2)]
    return pkw.DONE, 0, None, None, values


def result(job):
    if job.state == pkw.REFUSED:
        return job.state, job.error, job.next, job.previous, None
    values = job.integer_values() if isinstance(job, arrays.ArrayJob) else [job.integer_value()]
    return job.state, job.error, job.next, job.previous, values


def exchange(line, drive):
    """One telegram, or what is left of it."""
    words = line.send()
    trouble = random.randrange(12)
    if trouble == 0:  # the drive has not heard it
        return line.miss()
    reply = drive.hear(words)
    if trouble == 1:  # its reply was lost
        return line.miss()
    if trouble == 2:  # somebody else's change
        reply = (9 << 12 | 700,) + tuple(reply[1:])
    if trouble == 3:  # nonsense
        reply = tuple(random.getrandbits(16) & 0xF7FF for _ in range(len(reply)))
    return line.answer(*reply)


def test_whatever_is_asked_and_whatever_goes_wrong_each_job_has_its_own_answer():
    """Against a drive on paper; a write is carried out once, and identical ones each once."""
    states = set()
    withdrawn = 0
    for seed in range(60):
        random.seed(seed)
        pkw_words = (3, 4, VARIABLE)[seed % 3]
        line, drive = Line(pkw_words), PaperDrive(pkw_words)
        for step in range(40):
            job, writes = some_job(drive), drive.writes
            line.ask(job)
            if job.state == pkw.REFUSED:
                assert job.error == 102 and pkw_words != VARIABLE, (seed, step, job)
                continue
            line.losses = 0
            losses = 0  # in a row, the most of them
            for _ in range(400):
                if job.state != pkw.PENDING:
                    break
                exchange(line, drive)
                losses = max(losses, line.losses)
            is_write = job.task not in (1, 6, 9)
            if job.state in (pkw.UNANSWERED, pkw.TIMED_OUT):
                # Three in a row: it looks as if the drive fell silent on the task.
                assert losses >= 3, (seed, step, job)
                assert is_write or job.state == pkw.UNANSWERED, (seed, step, job)
                assert drive.writes - writes in (0, int(is_write)), (seed, step, job)
                withdrawn += 1
                continue
            wanted = expected(drive, drive.reply)
            assert result(job) == wanted, (seed, step, job, result(job), wanted)
            done = is_write and job.state == pkw.DONE
            assert drive.writes == writes + done, (seed, step, job)
            states.add((pkw_words, job.task, job.state))
    assert 0 < withdrawn < 60, withdrawn  # of 2400 or so, one telegram of six being lost
    for pkw_words, count in ((3, 7), (4, 11), (VARIABLE, 11)):
        seen = [task for words, task, state in states if words == pkw_words and state == pkw.DONE]
        assert len(seen) == count, (pkw_words, sorted(seen))
