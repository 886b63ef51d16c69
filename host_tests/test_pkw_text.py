"""Descriptions, texts and change reports (specification C-4.2.1.2, C-4.2.2, C-6)."""

from test_channel import Line
from test_pkw import FOUR, THREE, VARIABLE, answered, refused
from uss import pkw, pkw_text
from uss.layout import VARIABLE as VARIABLE_WORDS
from uss.pkw_text import (
    ACCESS,
    ELEMENTS,
    EXTENSION,
    FACTOR,
    IDENTIFIER,
    LOWER_LIMIT,
    NAME,
    QUANTITY,
    UPPER_LIMIT,
    Reports,
)


def text_words(text):
    """The words of a text."""
    codes = [ord(character) for character in text]
    return [codes[at] << 8 | codes[at + 1] for at in range(0, len(codes), 2)]


# --- descriptions -------------------------------------------------------------------------------


def test_the_lower_limit_of_example_4():
    """Task 4, element 7 of P52, three fixed words: 5FFFh."""
    job = pkw_text.read_description(52, LOWER_LIMIT)
    assert Line(3).ask(job).state == pkw.PENDING
    assert bytes(job.words) == b"\x40\x34\x00\x07\x00\x00\x00\x00"
    assert answered(job, (0x3034, 7, 0x5FFF), THREE)
    assert job.state == pkw.DONE and job.description().lower == 0x5FFF


def test_the_whole_description_of_example_3_is_refused_with_fixed_length():
    """The specification's drive says 101; it may be asked, as it says best why not."""
    line = Line(3)
    job = line.ask(pkw_text.read_description(52))
    assert line.send() == (0x4034, 0x00FF, 0)
    line.answer(0x7034, 0x00FF, 101)
    assert job.state == pkw.REFUSED and job.error == 101


def test_each_element():
    """A word in PWE1 with variable length, in PWE2 of four fixed words."""
    for element, variable, four, field, value in (
        (IDENTIFIER, (0x5008,), (0, 0x5008), "identifier", 0x5008),
        (ELEMENTS, (3,), (0, 3), "elements", 3),
        (FACTOR, (0x3F80, 0), (0x3F80, 0), "factor", 1.0),
        (QUANTITY, (0x04FD,), (0, 0x04FD), "quantity", 0x04FD),
        (ACCESS, (0x0102, 0x0304), (0x0102, 0x0304), "access", b"\x01\x02\x03\x04"),
        (LOWER_LIMIT, (7,), (0, 7), "lower", 7),
        (UPPER_LIMIT, (1, 2), (1, 2), "upper", 0x10002),
        (EXTENSION, (9,), (0, 9), "extension", 9),
    ):
        for form, words in ((VARIABLE, variable), (FOUR, four)):
            job = pkw_text.read_description(2010, element)
            assert answered(job, (0x300A, 0x8000 | element) + words, form), element
            description = job.description()
            assert getattr(description, field) == value, (element, form)
            assert [getattr(description, row[2]) for row in pkw_text.DESCRIPTION].count(None) == 9


def test_the_name_has_sixteen_characters():
    job = pkw_text.read_description(1120, NAME)
    assert not answered(job, [0x3460, NAME] + text_words("Ramp-up time"), VARIABLE)
    assert answered(job, [0x3460, NAME] + text_words("Ramp-up time    "), VARIABLE)
    assert job.description().name == "Ramp-up time"


def complete(kind, lower, upper):
    words = [kind, 2, 0x3F00, 0, 0x0400, 0x0003, 0x0001] + text_words("Ramp-up time    ")
    return [0x3460, 0x00FF] + words + list(lower) + list(upper) + [0]


def test_the_whole_description():
    """36 characters of a 16-bit parameter, 40 of a 32-bit one, in the order of the elements."""
    for kind, lower, upper, limits in (
        (0x0003, (0x8000,), (5,), (-32768, 5)),
        (0x0006, (0xFFFE,), (5,), (0xFFFE, 5)),
        (0x0004, (0xFFFF, 0xFFFE), (0, 5), (-2, 5)),
        (0x0007, (0xFFFF, 0xFFFE), (0, 5), (0xFFFFFFFE, 5)),
        (0x5008, (0, 0), (0x4422, 0x8000), (0.0, 650.0)),
    ):
        job = pkw_text.read_description(1120)
        assert answered(job, complete(kind, lower, upper), VARIABLE)
        description = job.description()
        assert (description.lower, description.upper) == limits, kind
        assert description.data_type() == kind & 0xFF
        assert (description.elements, description.factor, description.name) == (
            2,
            0.5,
            "Ramp-up time",
        )
        assert (description.quantity, description.extension) == (0x0400, 0)
        assert description.access == b"\x00\x03\x00\x01"
        assert description.default is None
    assert description.identifier & pkw_text.CHANGED and description.identifier & pkw_text.ARRAY
    assert not answered(job, complete(3, (1, 2), (3,)), VARIABLE)


def test_a_description_is_written():
    """Task 5; no MICROMASTER does that: error 106."""
    for element, characters, words in (
        (LOWER_LIMIT, b"\x00\x07", (0x5460, LOWER_LIMIT, 7)),
        (FACTOR, b"\x3f\x80\x00\x00", (0x5460, FACTOR, 0x3F80, 0)),
        (NAME, b"Ramp-up time    ", (0x5460, NAME) + tuple(text_words("Ramp-up time    "))),
    ):
        line = Line(VARIABLE_WORDS)
        job = line.ask(pkw_text.write_description(1120, element, characters))
        assert line.send() == words
        line.answer(*((0x3460,) + words[1:]))
        assert job.state == pkw.DONE, element
    line = Line(4)
    job = line.ask(pkw_text.write_description(1120, LOWER_LIMIT, b"\x00\x07"))
    assert line.send() == (0x5460, LOWER_LIMIT, 0, 7)
    line.answer(0x7460, LOWER_LIMIT, 0, 106)
    assert pkw.error_text(job.error) == "task not implemented"
    for pkw_words, characters in ((3, bytes(4)), (4, bytes(16))):
        element = FACTOR if len(characters) == 4 else NAME
        job = Line(pkw_words).ask(pkw_text.write_description(1120, element, characters))
        assert job.state == pkw.REFUSED and job.error == 102
    for element, size in ((IDENTIFIER, 4), (NAME, 15), (LOWER_LIMIT, 3), (FACTOR, 0), (255, 38)):
        assert refused(ValueError, pkw_text.write_description, 1120, element, bytes(size)), element


# --- texts --------------------------------------------------------------------------------------


def test_the_texts_of_examples_7_and_8():
    """Task 15; bits 9 and 8 of IND say which field, and whether it is written."""
    rate, ss2, baud = "300 BAUD        ", "BAUDRATE FOR SS2", "1200 BAUD       "
    for job, head, text, is_write in (
        (pkw_text.read_text(7, 3), (0xF007, 0x0003), rate, False),
        (pkw_text.read_text(9, 2), (0xF009, 0x0002), ss2, False),
        (pkw_text.write_text(9, 2, ss2), (0xF009, 0x0102), ss2, True),
        (pkw_text.read_text(9, 4, field=2), (0xF009, 0x0204), baud, False),
        (pkw_text.write_text(9, 4, "1200 BAUD", field=2), (0xF009, 0x0304), baud, True),
    ):
        line = Line(VARIABLE_WORDS, 10)
        line.ask(job)
        assert line.send() == head + (tuple(text_words(text)) if is_write else (0,)), job
        line.answer(head[0], head[1] ^ 0x0200, *text_words(text))  # of the other field
        assert job.state == pkw.PENDING
        line.answer(head[0], head[1], *text_words(text)[:7])
        assert job.state == pkw.PENDING
        line.answer(*(head + tuple(text_words(text))))
        assert job.state == pkw.DONE and job.text == text.rstrip(" "), job


def test_a_drive_refuses_a_text():
    for words, error in (((0x7007, 3, 15), 15), ((0x8007, 3, 0), pkw.NO_CHANGE_RIGHTS)):
        line = Line(VARIABLE_WORDS)
        job = line.ask(pkw_text.read_text(7, 3))
        line.send()
        line.answer(*words)
        assert job.state == pkw.REFUSED and job.error == error


def test_texts_need_variable_length():
    for pkw_words in (3, 4):
        job = Line(pkw_words).ask(pkw_text.read_text(7, 3))
        assert job.state == pkw.REFUSED and job.error == 102


def test_a_text_that_cannot_be_is_refused_at_once():
    for act, arguments in (
        (pkw_text.read_text, (7, 0)),
        (pkw_text.read_text, (7, 255)),
        (pkw_text.read_text, (7, 1, 3)),
        (pkw_text.write_text, (7, 1, "seventeen letters")),
        (pkw_text.write_text, (7, 1, "\u0394")),
    ):
        assert refused(ValueError, act, *arguments), arguments
    assert bytes(pkw_text.write_text(7, 1, "\xd6").words[4:6]) == b"\xd6 "


# --- change reports -----------------------------------------------------------------------------


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


def test_a_report_names_any_number():
    for number in (0, 1999, 2010, 8820, 64001, 127999):
        line = Line()
        reports = Reports(line.channel)
        line.answer(0x9000 | pkw.pke(0, number), pkw.ind(number, 3), 0, 1)
        report = reports.get()
        assert (report.number, report.index) == (number, 3)


def test_a_report_that_nobody_has_room_for_is_not_acknowledged():
    """The drive repeats it, and nothing is lost. Meanwhile it answers no task."""
    line = Line()
    reports = Reports(line.channel)
    for number in range(20):
        line.send()
        line.answer(0x9000 | (number & 1) << 11 | number, 0, 0, number)
        bit = (min(number, pkw_text.REPORTS_MAX - 1) & 1) << 11
        assert line.send()[0] == bit, number
    taken = [reports.get().number for _ in range(pkw_text.REPORTS_MAX)]
    assert taken == list(range(pkw_text.REPORTS_MAX)) and reports.get() is None
    line.answer(0x9008, 0, 0, 8)
    assert reports.get().number == 8


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
