# SPDX-License-Identifier: MIT
"""Texts of parameters (specification C-4.2.2, task 15)."""

from pkw_bench import Line, refused, text_words
from uss import pkw
from uss.layout import VARIABLE as VARIABLE_WORDS
from uss.tasks import texts


def test_the_texts_of_examples_7_and_8():
    """Task 15; bits 9 and 8 of IND say which field, and whether it is written."""
    rate, ss2, baud = "300 BAUD        ", "BAUDRATE FOR SS2", "1200 BAUD       "
    for job, head, text, is_write in (
        (texts.read_text(7, 3), (0xF007, 0x0003), rate, False),
        (texts.read_text(9, 2), (0xF009, 0x0002), ss2, False),
        (texts.write_text(9, 2, ss2), (0xF009, 0x0102), ss2, True),
        (texts.read_text(9, 4, field=2), (0xF009, 0x0204), baud, False),
        (texts.write_text(9, 4, "1200 BAUD", field=2), (0xF009, 0x0304), baud, True),
    ):
        line = Line(VARIABLE_WORDS, 10)
        line.ask(job)
        assert line.send() == head + (tuple(text_words(text)) if is_write else (0,)), job
        line.answer(head[0], head[1] ^ 0x0200, *text_words(text))  # of the other field
        assert job.state == pkw.PENDING
        for words in (text_words(text)[:7], text_words(text) + [0x2020]):
            line.answer(head[0], head[1], *words)
            assert job.state == pkw.PENDING
        line.answer(*(head + tuple(text_words(text))))
        assert job.state == pkw.DONE and job.text() == text.rstrip(" "), job


def test_what_fills_a_text_up_is_no_part_of_it():
    for filled, text in (
        ("RAMP TIME\0\0\0\0\0\0\0", "RAMP TIME"), ("  RAMP TIME \0 \0 ", "  RAMP TIME"),
    ):  # fmt: skip
        line = Line(VARIABLE_WORDS)
        job = line.ask(texts.read_text(7, 3))
        line.send()
        line.answer(0xF007, 3, *text_words(filled))
        assert job.text() == text


def test_a_text_of_the_second_field_is_asked_for_right_after_the_value():
    """Their answers cannot be mistaken for one another: no telegram without a task is between."""
    line = Line(VARIABLE_WORDS)
    line.ask(pkw.read(9, 2))
    line.ask(texts.read_text(9, 2, field=2))
    assert line.send() == (0x1009, 0x0002, 0)
    line.answer(0x1009, 0x0002, 5)
    assert line.send() == (0xF009, 0x0202, 0)


def test_a_text_that_the_telegram_has_no_room_for_is_not_sent():
    for longest, state in ((9, pkw.REFUSED), (10, pkw.PENDING)):
        line = Line(VARIABLE_WORDS, longest)
        assert line.ask(texts.write_text(9, 2, "BAUDRATE FOR SS2")).state == state
        assert line.ask(texts.read_text(9, 2)).state == pkw.PENDING


def test_a_drive_refuses_a_text():
    for words, error in (((0x7007, 3, 15), 15), ((0x8007, 3, 0), pkw.NO_CHANGE_RIGHTS)):
        line = Line(VARIABLE_WORDS)
        job = line.ask(texts.read_text(7, 3))
        line.send()
        line.answer(*words)
        assert job.state == pkw.REFUSED and job.error == error


def test_nothing_but_a_text_is_the_answer():
    line = Line(VARIABLE_WORDS)
    job = line.ask(texts.read_text(7, 3))
    line.send()
    for reply in range(15):
        if reply not in (pkw.REFUSED_REPLY, pkw.NO_RIGHTS_REPLY):
            line.answer(reply << 12 | 7, 3, *text_words("300 BAUD        "))
            assert job.state == pkw.PENDING, reply


def test_texts_need_variable_length():
    for pkw_words in (3, 4):
        job = Line(pkw_words).ask(texts.read_text(7, 3))
        assert job.state == pkw.REFUSED and job.error == 102


def test_a_text_that_cannot_be_is_refused_at_once():
    for act, arguments in (
        (texts.read_text, (7, 0)),
        (texts.read_text, (7, 255)),
        (texts.read_text, (7, 1, 0)),
        (texts.read_text, (7, 1, 3)),
        (texts.write_text, (7, 1, "seventeen letters")),
        (texts.write_text, (7, 1, "\u0394")),
    ):
        assert refused(ValueError, act, *arguments), arguments
    assert bytes(texts.write_text(7, 254, "\xd6").words[4:6]) == b"\xd6 "
