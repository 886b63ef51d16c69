# SPDX-License-Identifier: MIT
"""The machine code of the bus engine means what its twins in plain Python mean."""

import random
from array import array

from uss import fast
from uss.fast import python

ROUNDS = 3000
NAMES = (
    "exclusive_or", "is_reply", "agreeing", "get_words", "copy", "greatest", "frame", "calling",
    "reply_about", "translate",
)  # fmt: skip


def characters(count):
    return bytearray(random.getrandbits(8) for _ in range(count))


def framed(count):
    """Characters that are a telegram, or nearly one: each part is sometimes wrong."""
    buffer = characters(count + random.randrange(3))
    if count > 2:
        buffer[0] = 0x02 if random.randrange(8) else buffer[0]
        buffer[1] = count - 2 if random.randrange(8) else buffer[1]
        buffer[2] = 5 if random.randrange(8) else buffer[2]
        in_python = python.exclusive_or
        if random.randrange(4):
            buffer[count - 1] = in_python(buffer, count - 1)
    return buffer


def test_the_exclusive_or_is_the_same():
    random.seed(11)
    in_python = python.exclusive_or
    for _ in range(ROUNDS):
        count = random.randrange(257)
        buffer = characters(count)
        assert fast.exclusive_or(buffer, count) == in_python(buffer, count), buffer
    assert fast.exclusive_or(b"", 0) == 0 and fast.exclusive_or(b"\x02\xd6", 2) == 0xD4


def test_a_whole_buffer_is_summed_up_as_any_part_of_it():
    random.seed(12)
    in_python = python.exclusive_or
    for _ in range(ROUNDS):
        count = random.randrange(257)
        buffer = characters(count)
        assert in_python(buffer, count) == in_python(buffer + b"\xa5", count), buffer


def test_the_rows_are_found_in_which_somebody_calls():
    random.seed(18)
    in_python = python.calling
    for _ in range(ROUNDS):
        size = random.randrange(1, 9)
        rows = random.randrange(4)
        values = bytearray(rows * size + random.randrange(size))
        for _ in range(random.randrange(4)):
            if values:
                values[random.randrange(len(values))] = random.randrange(256)
        whole = rows * size
        found = fast.calling(values, size, whole)
        assert found == in_python(values, size, whole), (values, size)
        for row in range(rows):
            assert bool(found >> row & 1) == any(values[row * size : row * size + size])


def test_a_reply_is_about_the_parameter_and_index_that_were_asked_for():
    random.seed(19)
    in_python = python.reply_about
    asked = bytes((0x12, 0xBC, 0x80, 0x01, 0, 0, 0, 0))  # AK 1, P2700[1]
    assert fast.reply_about(b"\x22\xbc\x80\x01", 0, asked) == 2
    assert fast.reply_about(b"\x2a\xbc\x80\x01", 0, asked) == 2  # bit 11 is no part of PNU
    for _ in range(ROUNDS):
        net = bytearray(3) + bytearray(asked[:4])
        for _ in range(random.randrange(3)):
            net[3 + random.randrange(4)] ^= 1 << random.randrange(8)
        found = fast.reply_about(net, 3, asked)
        assert found == in_python(net, 3, asked), net
        same = (net[3] ^ asked[0]) & 7 == 0 and net[4:7] == asked[1:4]
        assert found == (net[3] >> 4 if same else 0), net


def test_net_data_are_framed():
    random.seed(17)
    in_python = python.frame
    for _ in range(ROUNDS // 10):
        size, address = random.randrange(5, 257), random.randrange(256)
        framed_by_both, expected = characters(256), bytearray(256)
        expected[:] = framed_by_both
        fast.frame(framed_by_both, size, address)
        in_python(expected, size, address)
        assert framed_by_both == expected
        assert bytes(expected[:3]) == bytes((0x02, size - 2, address))
        assert fast.exclusive_or(expected, size) == 0


def test_a_telegram_is_recognised_by_both_or_by_none():
    random.seed(12)
    in_python = python.is_reply
    found = 0
    for _ in range(ROUNDS):
        count = random.randrange(0, 40)
        buffer = framed(count)
        request = bytearray(framed(count) + bytes(8))
        request[2] = 5
        if random.randrange(8) == 0:
            request[: len(buffer)] = buffer  # an echo
        expected = in_python(buffer, count, request)
        assert bool(fast.is_reply(buffer, count, request)) == expected, (count, buffer, request)
        found += expected
    assert ROUNDS // 10 < found < ROUNDS * 9 // 10


def test_what_was_sent_is_no_reply():
    request = b"\x02\x06\x05\x04\x7e\x00\x00\x7b"
    for is_reply in (fast.is_reply, python.is_reply):
        assert not is_reply(request, 8, request)
        assert is_reply(b"\x02\x06\x05\xfb\x31\x00\x00\xcb", 8, request)
        assert is_reply(b"\x02\x04\x05\xfb\x31\xc9", 6, request)


def test_agreeing_characters_are_counted_up_to_the_first_that_differs():
    random.seed(14)
    in_python = python.agreeing
    lengths = set()
    for _ in range(ROUNDS // 10):
        buffer = bytes(random.getrandbits(1) for _ in range(20))
        other = bytes(random.getrandbits(1) for _ in range(20))
        at, other_at, count = random.randrange(10), random.randrange(10), random.randrange(11)
        expected = in_python(buffer, at, other, other_at, count)
        assert fast.agreeing(buffer, at, other, other_at, count) == expected
        assert buffer[at : at + expected] == other[other_at : other_at + expected]
        lengths.add(expected)
    assert {0, 1, 2, 3} <= lengths


def test_words_are_taken_high_byte_first():
    random.seed(15)
    in_python = python.get_words
    for _ in range(ROUNDS // 10):
        buffer, at, count = characters(40), random.randrange(9), random.randrange(16)
        taken, expected = array("H", bytes(40)), array("H", bytes(40))
        fast.get_words(buffer, at, taken, 4, count)
        in_python(buffer, at, expected, 4, count)
        assert list(taken) == list(expected)
        for index in range(count):
            word = buffer[at + 2 * index] << 8 | buffer[at + 2 * index + 1]
            assert taken[4 + index] == word


def test_the_greatest_is_found_going_round():
    random.seed(16)
    in_python = python.greatest
    found = set()
    for _ in range(ROUNDS):
        values = bytes(random.choice((0, 0, 0, 0, 1, 2, 4)) for _ in range(10))
        start = random.randrange(6)
        expected = in_python(values, 2, 6, start)
        assert fast.greatest(values, 2, 6, start) == expected, (values, start)
        if expected >= 0:
            assert values[2 + expected] == max(values[2:8])
        found.add(expected)
    assert found == {-1, 0, 1, 2, 3, 4, 5}


def test_characters_are_copied_to_the_same_place():
    random.seed(13)
    in_python = python.copy
    for _ in range(ROUNDS // 10):
        source, before = characters(20), characters(40)
        at, count = random.randrange(20), random.randrange(21)
        copied, expected = bytearray(before), bytearray(before)
        fast.copy(source, copied, at, count)
        in_python(source, expected, at, count)
        assert copied == expected
        assert copied[at : at + count] == source[:count]
        assert copied[:at] == before[:at] and copied[at + count :] == before[at + count :]


def test_characters_from_128_on_are_translated():
    random.seed(14)
    in_python = python.translate
    codes = characters(128)
    for _ in range(ROUNDS // 10):
        source, before = characters(20), characters(40)
        at, count = random.randrange(20), random.randrange(21)
        written, expected = bytearray(before), bytearray(before)
        fast.translate(source, written, at, count, codes)
        in_python(source, expected, at, count, codes)
        assert written == expected
        assert written[:at] == before[:at] and written[at + count :] == before[at + count :]
    fast.translate(b"A\x7f\x80\xff", written, 0, 4, codes)
    assert written[:4] == bytes((0x41, 0x7F, codes[0], codes[127]))


def test_micropython_has_the_machine_code():
    """Or the comparisons above would compare a function with itself."""
    has_viper = True
    try:
        import uss.fast.viper
    except AttributeError:
        has_viper = False  # CPython
    for name in NAMES:
        assert (getattr(fast, name) is getattr(python, name)) != has_viper
    if has_viper:
        assert uss.fast.viper.copy is fast.copy
