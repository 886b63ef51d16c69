"""The parameter channel with four fixed PKW words (specification C-4, MM420 Reference Manual)."""

import golden
from uss import pkw

COVERED_TASKS = (0, 1, 2, 3, 13, 14)
COVERED_REPLIES = (0, 1, 2, 7, 8)


def pairs():
    """Golden request and reply of each parameter task covered here, as (id, words, words)."""
    by_id = {example.id: example for example in golden.VALID}
    for name in sorted(by_id):
        reply = by_id.get(name[:-1] + "r")
        if name.endswith("q") and reply and by_id[name].pkw_words == 4:
            request = by_id[name].words()[:4]
            if by_id[name].kind == "request" and request[0] >> 12 in COVERED_TASKS:
                yield name, request, reply.words()[:4]


def job_of(words):
    """The job that puts these four words on the line."""
    page = 1 if words[1] & 0x8000 else 0
    number = (words[0] & 0x7FF) + 2000 * page
    return pkw.Job(words[0] >> 12, number, words[1] & 0xFF, words[2], words[3])


def test_golden_requests_are_asked_as_printed():
    seen = 0
    for name, request, _ in pairs():
        job = job_of(request)
        assert [job.pke, job.ind, job.high, job.low] == request, name
        seen += 1
    assert seen == 10


def test_golden_replies_end_their_jobs():
    for name, request, reply in pairs():
        job = job_of(request)
        job.state = pkw.PENDING
        assert job.answer(*reply), name
        if reply[0] >> 12 == 7:
            assert job.state == pkw.REFUSED and job.error == reply[3], name
        else:
            assert job.state == pkw.DONE, name


def test_reading_what_the_reference_manual_reads():
    """MM420 Reference Manual 3.3.5."""
    job = pkw.read(1082)
    job.answer(0x243A, 0x0000, 0x4248, 0x0000)
    assert job.float_value() == 50.0
    job = pkw.read(700)
    job.answer(0x12BC, 0, 0, 2)
    assert job.integer_value() == 2
    job = pkw.write_float(1082, 40.5)
    assert (job.pke, job.ind, job.high, job.low) == (0x343A, 0, 0x4222, 0)
    job = pkw.write_float(1082, 40.0, eeprom=True)
    assert (job.pke, job.high, job.low) == (0xD43A, 0x4220, 0)
    job = pkw.write_word(1000, 5, eeprom=True)
    assert (job.pke, job.high, job.low) == (0xE3E8, 0, 5)
    job = pkw.write_double(731, 0x00340007)
    assert (job.high, job.low) == (0x0034, 0x0007)


def test_pages_of_numbers_from_2000_on():
    """High byte of IND for the first number of a page (CU240S manual, SIDOOR table 6-64)."""
    for number, high_byte in (
        (0, 0x00), (1999, 0x00), (2000, 0x80), (4000, 0x10), (6000, 0x90), (8000, 0x20),
        (10000, 0xA0), (12000, 0x30), (14000, 0xB0), (16000, 0x40), (20000, 0x50),
        (30000, 0xF0), (32000, 0x04), (60000, 0x74), (64000, 0x08),
    ):  # fmt: skip
        assert pkw.ind(number, 0) == high_byte << 8, number
        assert pkw.ind(number, 3) == high_byte << 8 | 3, number
    assert pkw.pke(1, 8820) == 0x1334  # P8820[16]: PKE 1334 IND 2010
    assert pkw.ind(8820, 16) == 0x2010


def test_a_stale_reply_is_ignored():
    """Until the drive has seen the new task it may repeat the old reply: no error, no answer."""
    job = pkw.read(1000)
    job.state = pkw.PENDING
    for words in (
        (0x12BC, 0, 0, 5),  # P0700, asked before
        (0x13E8, 1, 0, 5),  # P1000[1]
        (0x13E8, 0x8000, 0, 5),  # P3000
        (0x03E8, 0, 0, 0),  # no reply yet
        (0x0000, 0, 0, 0),
        (0x72BC, 0, 0, 17),  # a refusal of the old task
        (0x33E8, 0, 0, 5),  # a description element: answers no read
        (0x83E8, 0, 0, 0),  # no change rights: answers writes only
    ):
        assert not job.answer(*words), words
        assert job.state == pkw.PENDING
    assert job.answer(0x13E8, 0, 0, 5)
    assert job.state == pkw.DONE and job.integer_value() == 5


def test_the_change_report_bit_is_no_part_of_the_number():
    job = pkw.read(1000)
    assert job.answer(0x1BE8, 0, 0, 5)


def test_a_write_of_a_word_is_not_answered_by_a_double_word():
    job = pkw.write_word(1000, 5)
    job.state = pkw.PENDING
    assert not job.answer(0x23E8, 0, 0, 5)
    assert job.state == pkw.PENDING


def test_refusals_say_why_in_words():
    job = pkw.write_word(1082, 40)
    assert job.answer(0x743A, 0, 0, 5)
    assert job.state == pkw.REFUSED
    assert pkw.error_text(job.error) == "wrong data type"
    job = pkw.write_word(700, 5)
    assert job.answer(0x82BC, 0, 0, 0)
    assert pkw.error_text(job.error) == "no change rights"
    assert pkw.error_text(17) == "not in this operating state"
    assert pkw.error_text(999) == "error 999"


def test_what_cannot_be_asked_is_refused_at_once():
    for wrong in (
        lambda: pkw.read(-1),
        lambda: pkw.read(128000),
        lambda: pkw.read(700, 255),  # "all elements" needs variable length
        lambda: pkw.write_word(700, 65536),
        lambda: pkw.write_word(700, -1),
        lambda: pkw.write_double(731, 1 << 32),
        lambda: pkw.Job(4, 700),
    ):
        try:
            wrong()
        except ValueError:
            continue
        raise AssertionError("accepted")
