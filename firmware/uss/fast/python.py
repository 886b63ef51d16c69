# SPDX-License-Identifier: MIT
"""The loops behind `fast` in plain Python. They define the meaning, and run if there is no viper.

Each has a twin in machine code in `viper`.
"""


def exclusive_or(buffer, count):
    """Exclusive or of the first `count` characters."""
    check = 0
    if count == len(buffer):  # without an index a loop takes half the time
        for character in buffer:
            check ^= character
        return check
    for index in range(count):
        check ^= buffer[index]
    return check


def frame(buffer, size, address):
    """Put STX, LGE, ADR and BCC around the net data of a telegram of `size` characters."""
    buffer[0] = 0x02
    buffer[1] = size - 2
    buffer[2] = address
    buffer[size - 1] = 0  # a request is as long as its buffer, mostly
    buffer[size - 1] = exclusive_or(buffer, size)


def is_reply(buffer, count, request):
    """Whether the `count` characters are a whole telegram with the ADR of `request`, but not that
    request itself, which a line with two wires may bring back.

    STX, LGE and BCC must be right. If not, `telegram.judge` says what is wrong.
    """
    return (
        count >= 5
        and buffer[0] == 0x02
        and buffer[1] == count - 2
        and buffer[2] == request[2]
        and exclusive_or(buffer, count) == 0
        and (buffer[1] != request[1] or agreeing(buffer, 0, request, 0, count) < count)
    )


def agreeing(buffer, at, other, other_at, count):
    """How many of `count` characters agree, from these indices on, until the first that differs.

    The caller makes sure that both are long enough.
    """
    index = 0
    while index < count and buffer[at + index] == other[other_at + index]:
        index += 1
    return index


def get_words(buffer, at, words, to, count):
    """Copy `count` words, high byte first, from buffer[at:] to words[to:], an array("H")."""
    for index in range(to, to + count):
        words[index] = buffer[at] << 8 | buffer[at + 1]
        at += 2


def copy(source, target, at, count):
    """Put the first `count` characters of `source` into `target` from index `at` on."""
    for index in range(count):
        target[at + index] = source[index]


def translate(source, target, at, count, codes):
    """As `copy`, with codes[character - 128] in place of each character from 128 on."""
    for index in range(count):
        code = source[index]
        target[at + index] = codes[code - 128] if code >= 128 else code


def greatest(values, at, count, start):
    """The number of the greatest of `count` characters from values[at:] on; -1 if all are 0.

    Of equal ones it is the first after number `start`, going round.
    """
    found = -1
    highest = 0
    for step in range(1, count + 1):
        number = (start + step) % count
        if values[at + number] > highest:
            highest = values[at + number]
            found = number
    return found


def calling(values, size, count):
    """Which rows of `size` hold anything but 0 among the first `count` values: a bit for each row,
    bit 0 for the first."""
    rows = 0
    for row in range(count // size):
        for at in range(row * size, row * size + size):
            if values[at]:
                rows |= 1 << row
                break
    return rows


def _can_count():
    """Whether a bytearray counts numbers in a part of it, as CPython's does."""
    try:
        return bytearray(2).count(0, 1, 2) == 1
    except (AttributeError, TypeError):
        return False


if _can_count():  # a third of an exchange went into that loop

    def calling(values, size, count):
        rows = 0
        for row in range(count // size):
            if values.count(0, row * size, row * size + size) < size:
                rows |= 1 << row
        return rows


def reply_about(net, at, words):
    """AK of the parameter reply in `net` from index `at` on, if its PNU and IND are those of the
    task `words`; else 0. Bit 11 of PKE belongs to neither AK nor PNU.
    """
    if net[at + 1] != words[1] or net[at + 3] != words[3] or net[at + 2] != words[2]:
        return 0
    return 0 if (net[at] ^ words[0]) & 0x07 else net[at] >> 4
