# SPDX-License-Identifier: MIT
"""Change reports: what somebody else has written (specification C-4.2.1.2, replies 9...12)."""

from pkw_bench import Line, refused
from uss import pkw
from uss.layout import VARIABLE as VARIABLE_WORDS
from uss.tasks.change_reports import Reports

SO_MANY_WAIT = 8


def test_the_example_of_the_specification_with_a_lost_reply():
    """C-4.2.1.2: task1 (0) reply1 (0); task2 (0) report1 (1); task2 (1) report2 (0), lost;
    task2 (1) report2 (0); task2 (0) reply2 (0). In brackets bit 11 of PKE.
    """
    line = Line()
    reports = Reports(line.channel)
    first, second = line.ask(pkw.read(700)), line.ask(pkw.read(1000))
    assert line.send() == (0x12BC, 0, 0, 0)
    line.answer(0x12BC, 0, 0, 5)
    assert first.state == pkw.DONE
    assert line.send() == (0x13E8, 0, 0, 0)
    line.answer(0x9C60, 0, 0, 10)  # P1120 is 10 now
    assert line.send() == (0x1BE8, 0, 0, 0)
    line.miss()  # P1121 is 11.0, but nobody hears of it
    assert line.send() == (0x1BE8, 0, 0, 0)
    line.answer(0xA461, 0, 0x4130, 0)
    assert second.state == pkw.PENDING
    assert line.send() == (0x13E8, 0, 0, 0)
    line.answer(0x13E8, 0, 0, 7)
    assert second.state == pkw.DONE and second.integer_value() == 7
    report = reports.get()
    assert (report.number, report.index, report.integer_value()) == (1120, 0, 10)
    report = reports.get()
    assert (report.number, report.width, report.float_value()) == (1121, pkw.DOUBLE, 11.0)
    assert reports.get() is None


def test_a_report_is_counted_once_however_often_it_is_repeated():
    line = Line()
    reports = Reports(line.channel)
    line.send()
    line.answer(0, 0, 0, 0)
    for _ in range(5):
        line.answer(0x9C60, 0, 0, 10)
    assert reports.get().number == 1120 and reports.get() is None
    assert line.send() == (0x0800, 0, 0, 0)  # also without a task, and for ever after


def test_a_master_that_begins_later_takes_the_bit_from_the_drive():
    """The drive has reported before: its bit is 1, and the next report comes with 0."""
    line = Line()
    reports = Reports(line.channel)
    line.send()
    line.answer(0x0800, 0, 0, 0)
    assert line.send() == (0x0800, 0, 0, 0)
    line.answer(0x9460, 0, 0, 10)
    assert reports.get().integer_value() == 10
    line = Line()
    reports = Reports(line.channel)
    line.send()
    line.answer(0x9460, 0, 0, 10)  # or this is the very first that it hears
    assert reports.get().integer_value() == 10


def test_what_a_report_says_in_every_layout():
    """Three words hold no double word, and none a whole array: those must be read."""
    for pkw_words, reply, index, width, value in (
        (3, (0x9460, 2, 0xFFFF), 2, pkw.WORD, -1),
        (3, (0xA460, 0, 0), 0, 0, None),
        (4, (0xB460, 1, 0, 10), 1, pkw.WORD, 10),
        (4, (0xC460, 1, 0xFFFF, 0xFFFE), 1, pkw.DOUBLE, -2),
        (4, (0xC460, 255, 0, 0), 255, 0, None),
        (VARIABLE_WORDS, (0x9460, 2, 10), 2, pkw.WORD, 10),
        (VARIABLE_WORDS, (0xA460, 2, 0, 10), 2, pkw.DOUBLE, 10),
        (VARIABLE_WORDS, (0xB460, 255, 1, 2, 3, 4, 5), 255, 0, None),
    ):
        line = Line(pkw_words)
        reports = Reports(line.channel)
        line.send()
        line.answer(*((0x0800,) + (0,) * (len(reply) - 1)))
        line.answer(*reply)
        report = reports.get()
        assert (report.number, report.index, report.width) == (1120, index, width), reply
        assert value is None or report.signed_value() == value, reply
        assert width == pkw.DOUBLE or report.high == 0, reply


def test_no_other_reply_is_a_report():
    for reply in (0, 1, 2, 3, 4, 5, 6, 7, 8, 13, 14, 15):
        line = Line()
        reports = Reports(line.channel)
        for bit in (0x0800, 0, 0x0800):
            line.send()
            line.answer(reply << 12 | bit | 700, 0, 0, 5)
            assert reports.get() is None, reply
            assert line.send()[0] == bit, reply


def test_a_report_names_any_number():
    for number in (0, 1999, 2010, 8820, 64001, 127999):
        line = Line()
        reports = Reports(line.channel)
        line.answer(0x9000 | pkw.pke(0, number), pkw.ind(number, 3), 0, 1)
        report = reports.get()
        assert (report.number, report.index) == (number, 3)


def test_a_report_that_nobody_has_room_for_is_not_acknowledged():
    """The drive repeats it, and nothing is lost, however many were taken before. Meanwhile it
    answers no task."""
    for before in range(2 * SO_MANY_WAIT):
        line = Line()
        reports = Reports(line.channel)
        for number in range(before + 20):
            bit = (number & 1) << 11
            line.send()
            line.answer(0x9100 | bit | number, 0, 0, number)
            if number < before:
                assert reports.get().number == 0x100 | number
            last = min(number, before + SO_MANY_WAIT - 1)
            assert line.send()[0] == (last & 1) << 11, (before, number)
        taken = [reports.get().integer_value() for _ in range(SO_MANY_WAIT)]
        following = before + SO_MANY_WAIT
        assert taken == list(range(before, following)) and reports.get() is None
        line.answer(0x9100 | (following & 1) << 11 | following, 0, 0, following)
        assert reports.get().number == 0x100 | following


def test_reports_come_for_ever():
    """Each says its own value, or none."""
    line = Line()
    reports = Reports(line.channel)
    for count in range(60):
        line.send()
        whole = count % 3 == 0
        reply = (0xA000 | (count & 1) << 11 | 700 + count, 0, 0x4248, count)
        line.answer(*((reply[0] + 0x2000, 0xFF, 0, 0) if whole else reply))
        report = reports.get()
        assert report.number == 700 + count and reports.get() is None
        assert report.width == (0 if whole else pkw.DOUBLE)
        assert (report.high, report.low) == ((0, 0) if whole else (0x4248, count))


def test_reports_are_ignored_unless_somebody_follows_them():
    line = Line()
    job = line.ask(pkw.read(1000))
    for _ in range(3):
        assert line.send() == (0x13E8, 0, 0, 0)
        line.answer(0x9C60, 0, 0, 10)
    reports = Reports(line.channel)
    line.answer(0x9C60, 0, 0, 10)
    assert line.send() == (0x1BE8, 0, 0, 0) and reports.get().number == 1120
    reports.close()
    assert line.send() == (0x13E8, 0, 0, 0)
    line.answer(0x13E8, 0, 0, 5)
    line.send()
    line.answer(0, 0, 0, 0)
    assert job.state == pkw.DONE and line.channel.idle


def test_a_drive_without_pkw_words_reports_nothing():
    assert refused(RuntimeError, Reports, Line(0).channel)
