"""The machine code of the bus engine means what its twins in plain Python mean."""

import random

from uss import fast

ROUNDS = 3000


def characters(count):
    return bytearray(random.getrandbits(8) for _ in range(count))


def framed(count):
    """Characters that are a telegram, or nearly one: each part is sometimes wrong."""
    buffer = characters(count + random.randrange(3))
    if count > 2:
        buffer[0] = 0x02 if random.randrange(8) else buffer[0]
        buffer[1] = count - 2 if random.randrange(8) else buffer[1]
        buffer[2] = 5 if random.randrange(8) else buffer[2]
        in_python, _, _ = fast.IN_PYTHON
        if random.randrange(4):
            buffer[count - 1] = in_python(buffer, count - 1)
    return buffer


def test_the_exclusive_or_is_the_same():
    random.seed(11)
    in_python, _, _ = fast.IN_PYTHON
    for _ in range(ROUNDS):
        count = random.randrange(257)
        buffer = characters(count)
        assert fast.exclusive_or(buffer, count) == in_python(buffer, count), buffer
    assert fast.exclusive_or(b"", 0) == 0 and fast.exclusive_or(b"\x02\xd6", 2) == 0xD4


def test_a_telegram_is_recognised_by_both_or_by_none():
    random.seed(12)
    _, in_python, _ = fast.IN_PYTHON
    found = 0
    for _ in range(ROUNDS):
        count = random.randrange(0, 40)
        buffer = framed(count)
        expected = in_python(buffer, count, 5)
        assert bool(fast.is_telegram(buffer, count, 5)) == expected, (count, buffer)
        found += expected
    assert ROUNDS // 10 < found < ROUNDS * 9 // 10


def test_characters_are_copied_to_the_same_place():
    random.seed(13)
    _, _, in_python = fast.IN_PYTHON
    for _ in range(ROUNDS // 10):
        source, before = characters(20), characters(40)
        at, count = random.randrange(20), random.randrange(21)
        copied, expected = bytearray(before), bytearray(before)
        fast.copy(source, copied, at, count)
        in_python(source, expected, at, count)
        assert copied == expected
        assert copied[at : at + count] == source[:count]
        assert copied[:at] == before[:at] and copied[at + count :] == before[at + count :]


def test_micropython_has_the_machine_code():
    """Or the comparisons above would compare a function with itself."""
    has_viper = True
    try:
        import uss.fast_viper
    except AttributeError:
        has_viper = False  # CPython
    for quick, plain in zip((fast.exclusive_or, fast.is_telegram, fast.copy), fast.IN_PYTHON):
        assert (quick is plain) != has_viper
    if has_viper:
        assert uss.fast_viper.copy is fast.copy
