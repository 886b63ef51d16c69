# SPDX-License-Identifier: MIT
"""Descriptions of parameters: elements, and the whole of it (specification C-6, tasks 4, 5)."""

from pkw_bench import FOUR, THREE, VARIABLE, Line, answered, refused, text_words
from uss import pkw
from uss.bus import pkw_errors
from uss.layout import VARIABLE as VARIABLE_WORDS
from uss.tasks.descriptions import (
    ACCESS,
    ARRAY,
    CHANGED,
    DEFAULT,
    DESCRIPTION,
    ELEMENTS,
    EXTENSION,
    FACTOR,
    FLOAT,
    HAS_TEXTS,
    I16,
    I32,
    IDENTIFIER,
    LOWER_LIMIT,
    NAME,
    ONLY_RESETTABLE,
    QUANTITY,
    STRING,
    U8,
    U16,
    U32,
    UPPER_LIMIT,
    WRITE_PROTECTED,
    is_size,
    read_description,
    typed,
    write_description,
)


def test_the_lower_limit_of_example_4():
    """Task 4, element 7 of P52, three fixed words: 5FFFh."""
    job = read_description(52, LOWER_LIMIT)
    assert Line(3).ask(job).state == pkw.PENDING
    assert bytes(job.words) == b"\x40\x34\x00\x07\x00\x00\x00\x00"
    assert answered(job, (0x3034, 7, 0x5FFF), THREE)
    assert job.state == pkw.DONE and job.description().lower == 0x5FFF


def test_the_whole_description_of_example_3_is_refused_with_fixed_length():
    """The specification's drive says 101; it may be asked, as it says best why not."""
    line = Line(3)
    job = line.ask(read_description(52))
    assert line.send() == (0x4034, 0x00FF, 0)
    line.answer(0x7034, 0x00FF, 101)
    assert job.state == pkw.REFUSED and job.error == 101


def test_each_element():
    """A word in PWE1 with variable length, in PWE2 of four fixed words."""
    for element, variable, four, field, value in (
        (IDENTIFIER, (0x5008,), (0, 0x5008), "identifier", 0x5008),
        (ELEMENTS, (3,), (0, 3), "elements", 3),
        (ELEMENTS, (3,), (0xFFFF, 3), "elements", 3),  # PWE1 is no part of a word
        (FACTOR, (0x3F80, 0), (0x3F80, 0), "factor", 1.0),
        (QUANTITY, (0x04FD,), (0, 0x04FD), "quantity", 0x04FD),
        (ACCESS, (0x0102, 0x0304), (0x0102, 0x0304), "access", b"\x01\x02\x03\x04"),
        (LOWER_LIMIT, (7,), (0, 7), "lower", 7),
        (UPPER_LIMIT, (1, 2), (1, 2), "upper", 0x10002),
        (EXTENSION, (9,), (0, 9), "extension", 9),
    ):
        for form, words in ((VARIABLE, variable), (FOUR, four)):
            job = read_description(2010, element)
            assert answered(job, (0x300A, 0x8000 | element) + words, form), element
            description = job.description()
            assert getattr(description, field) == value, (element, form)
            assert [getattr(description, row[2]) for row in DESCRIPTION].count(None) == 9


def test_the_name_has_sixteen_characters():
    job = read_description(1120, NAME)
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
        job = read_description(1120)
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
    assert description.identifier & CHANGED and description.identifier & ARRAY
    assert not answered(job, complete(3, (1, 2), (3,)), VARIABLE)


def test_the_bits_of_an_identifier():
    """As SIDOOR and TR have them."""
    assert (WRITE_PROTECTED, HAS_TEXTS, CHANGED) == (0x0200, 0x0400, 0x1000)
    assert (ONLY_RESETTABLE, ARRAY) == (0x2000, 0x4000)
    assert (I16, I32, U8, U16, U32, FLOAT, STRING) == (3, 4, 5, 6, 7, 8, 9)
    for kind, words, limit in (
        (I16, (0, 0xFFFF), -1), (I16, (0, 0x8000), -32768), (I16, (0, 0x7FFF), 32767),
        (U16, (0, 0xFFFF), 0xFFFF), (U8, (0, 0xFF), 0xFF), (I32, (0xFFFF, 0xFFFF), -1),
        (I32, (0x8000, 0), -1 << 31), (U32, (0xFFFF, 0xFFFF), 0xFFFFFFFF),
        (FLOAT, (0x4248, 0), 50), (FLOAT, (0x4249, 0x8000), 50.375),
        (STRING, (0xFFFF, 0xFFFF), 0xFFFFFFFF),
    ):  # fmt: skip
        wide = kind in (I32, U32, FLOAT, STRING)
        value = words[0] << 16 | words[1]
        assert typed(value, 4 if wide else 2, kind) == limit, kind
    pi = 0x40490FDB
    assert typed(pi, 4, FLOAT) == pkw.words_to_float(0x4049, 0x0FDB)
    for word in (0x4248, 0xC248):  # a word is no floating-point number
        assert typed(word, 2, FLOAT) == word
    job = read_description(2010, IDENTIFIER)
    assert answered(job, (0x300A, 0x8000 | IDENTIFIER, 0x50C8), VARIABLE)
    assert job.description().data_type() == 0xC8


def test_a_default_is_an_element_of_its_own_and_of_no_whole_description():
    """It has the width of the value, a word or a double word."""
    for words, form, value in (
        ((7,), VARIABLE, 7),
        ((0, 7), FOUR, 7),
        ((1, 2), VARIABLE, 0x10002),
    ):
        job = read_description(2010, DEFAULT)
        assert answered(job, (0x300A, 0x8000 | DEFAULT) + words, form)
        assert job.description().default == value
    for size, takes in ((1, False), (2, True), (3, False), (4, True), (5, False)):
        assert is_size(DEFAULT, size) == takes, size


def test_a_description_is_written():
    """Task 5; no MICROMASTER does that: error 106."""
    for element, characters, words in (
        (LOWER_LIMIT, b"\x00\x07", (0x5460, LOWER_LIMIT, 7)),
        (FACTOR, b"\x3f\x80\x00\x00", (0x5460, FACTOR, 0x3F80, 0)),
        (NAME, b"Ramp-up time    ", (0x5460, NAME) + tuple(text_words("Ramp-up time    "))),
    ):
        line = Line(VARIABLE_WORDS)
        job = line.ask(write_description(1120, element, characters))
        assert line.send() == words
        line.answer(*((0x3460,) + words[1:]))
        assert job.state == pkw.DONE, element
    line = Line(4)
    job = line.ask(write_description(1120, LOWER_LIMIT, b"\x00\x07"))
    assert line.send() == (0x5460, LOWER_LIMIT, 0, 7)
    line.answer(0x7460, LOWER_LIMIT, 0, 106)
    assert pkw_errors.error_text(job.error) == "task not implemented"
    for pkw_words, characters in ((3, bytes(4)), (4, bytes(16))):
        element = FACTOR if len(characters) == 4 else NAME
        job = Line(pkw_words).ask(write_description(1120, element, characters))
        assert job.state == pkw.REFUSED and job.error == 102
    for element, size in ((IDENTIFIER, 4), (NAME, 15), (LOWER_LIMIT, 3), (FACTOR, 0), (255, 38)):
        assert refused(ValueError, write_description, 1120, element, bytes(size)), element
