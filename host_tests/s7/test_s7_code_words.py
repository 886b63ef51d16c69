# SPDX-License-Identifier: MIT
"""The status codes of the S7-200's library, their texts, and the S7-1200's words beside them."""

from uss import pkw
from uss.drive import COUNTERS
from uss.s7 import codes


def refused(error):
    job = pkw.read(700)
    job.state = pkw.REFUSED
    job.error = error
    return job


def ended(state, width=0):
    job = pkw.read(700)
    job.state = state
    job.width = width
    return job


def test_the_codes_are_0_to_22_and_each_has_a_text_of_its_own():
    assert len(codes.CODES) == 23
    texts = [codes.text(code) for code in range(23)]
    assert len(set(texts)) == 23 and all(texts)
    assert texts[0] == "no error" and texts[13] == "another drive answered"
    try:
        codes.text(23)
    except IndexError:
        return
    raise AssertionError("code 23")


def test_the_words_are_those_of_the_s7_1200():
    assert sorted(codes.WORDS) == [0] + list(range(0x8180, 0x818F))
    of_codes = [codes.word(code) for code in range(23)]
    for word in of_codes:
        assert word is None or word in codes.WORDS
    extra = (codes.WRONG_VALUE_TYPE, codes.ACCESS_REFUSED, 0x8188)
    assert set(codes.WORDS) == {word for word in of_codes if word is not None} | set(extra)
    # The pairs that both libraries describe in the same words.
    for code, word in (
        (1, 0x818B), (2, 0x8184), (6, 0x8185), (8, 0x818A), (9, 0x8186), (10, 0x8180),
        (13, 0x8187), (18, 0x8189), (20, 0x818C), (21, 0x8182), (22, 0x8183),
    ):  # fmt: skip
        assert codes.word(code) == word


def test_what_the_engine_counts_has_a_code():
    found = dict(zip(COUNTERS, codes.COUNTER_CODES))
    assert len(found) == len(COUNTERS) == len(codes.COUNTER_CODES)
    assert found == {
        "good": 0, "start": 11, "length": 12, "bcc": 2, "address": 13, "no_reply": 1,
        "residual": 10,
    }  # fmt: skip


def test_of_several_findings_the_one_that_says_most_is_told():
    before = [5, 0, 3, 65535, 0, 7, 0]
    assert codes.of_reply(before, before) == codes.NO_ERROR
    for changed, code in (
        ({0: 6}, 0), ({5: 8}, 1), ({3: 0}, 2), ({5: 8, 3: 0}, 2), ({0: 6, 4: 1, 5: 9}, 13),
    ):  # fmt: skip
        counters = list(before)
        for index, count in changed.items():
            counters[index] = count
        assert codes.of_reply(counters, before) == code, changed


def test_how_a_job_ends():
    word, double = pkw.WORD, pkw.DOUBLE
    assert codes.of_job(ended(pkw.DONE, word), word, 0) == codes.NO_ERROR
    assert codes.of_job(ended(pkw.DONE, double), double, 0) == codes.NO_ERROR
    assert codes.of_job(ended(pkw.DONE, double), word, 0) == codes.WIDTH_DOUBLE
    assert codes.of_job(ended(pkw.DONE, word), double, 0) == codes.WIDTH_WORD
    assert codes.of_job(refused(17), word, 0) == codes.PARAMETER_REPLY
    assert codes.of_job(ended(pkw.TIMED_OUT), word, codes.CHECKSUM) == codes.CHECKSUM
    assert codes.of_job(ended(pkw.TIMED_OUT), word, 0) == codes.PARAMETER_REPLY
    assert codes.of_job(ended(pkw.UNANSWERED), word, 0) == codes.NO_ANSWER


def test_no_rights_has_a_word_of_its_own():
    assert codes.word_of_job(refused(17), 20) == 0x818C
    assert codes.word_of_job(refused(pkw.NO_CHANGE_RIGHTS), 20) == 0x818D
    assert codes.word_of_job(ended(pkw.DONE, pkw.WORD), 0) == 0
