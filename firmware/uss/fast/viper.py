# SPDX-License-Identifier: MIT
"""The machine code behind `fast`: MicroPython's viper, whose types are those of the processor.

Each function has a twin in plain Python in `python`, and means exactly the same.
"""

import micropython


@micropython.viper
def exclusive_or(buffer: ptr8, count: int) -> int:
    check = 0
    index = 0
    while index < count:
        check ^= buffer[index]
        index += 1
    return check


@micropython.viper
def frame(buffer: ptr8, size: int, address: int):
    buffer[0] = 0x02
    buffer[1] = size - 2
    buffer[2] = address
    check = 0
    index = 0
    while index < size - 1:
        check ^= buffer[index]
        index += 1
    buffer[index] = check


@micropython.viper
def is_reply(buffer: ptr8, count: int, request: ptr8) -> bool:
    if count < 5 or buffer[0] != 0x02 or buffer[1] != count - 2 or buffer[2] != request[2]:
        return False
    check = 0
    index = 0
    while index < count:
        check ^= buffer[index]
        index += 1
    if check != 0:
        return False
    if buffer[1] != request[1]:
        return True
    index = 0
    while index < count:
        if buffer[index] != request[index]:
            return True
        index += 1
    return False


@micropython.viper
def agreeing(buffer: ptr8, at: int, other: ptr8, other_at: int, count: int) -> int:
    index = 0
    while index < count:
        if buffer[at + index] != other[other_at + index]:
            break
        index += 1
    return index


@micropython.viper
def get_words(buffer: ptr8, at: int, words: ptr16, to: int, count: int):
    index = 0
    while index < count:
        words[to + index] = buffer[at + 2 * index] << 8 | buffer[at + 2 * index + 1]
        index += 1


@micropython.viper
def copy(source: ptr8, target: ptr8, at: int, count: int):
    index = 0
    while index < count:
        target[at + index] = source[index]
        index += 1


@micropython.viper
def translate(source: ptr8, target: ptr8, at: int, count: int, codes: ptr8):
    index = 0
    while index < count:
        code = source[index]
        if code >= 128:
            code = codes[code - 128]
        target[at + index] = code
        index += 1


@micropython.viper
def greatest(values: ptr8, at: int, count: int, start: int) -> int:
    found = -1
    highest = 0
    number = start
    step = 0
    while step < count:
        number += 1
        if number >= count:
            number = 0
        if values[at + number] > highest:
            highest = values[at + number]
            found = number
        step += 1
    return found


@micropython.viper
def calling(values: ptr8, size: int, count: int) -> int:
    rows = 0
    row = 1
    at = 0
    while at < count:
        end = at + size
        while at < end:
            if values[at]:
                rows |= row
                at = end
            else:
                at += 1
        row <<= 1
    return rows


@micropython.viper
def reply_about(net: ptr8, at: int, words: ptr8) -> int:
    if net[at + 1] != words[1] or net[at + 3] != words[3] or net[at + 2] != words[2]:
        return 0
    if (net[at] ^ words[0]) & 0x07:
        return 0
    return net[at] >> 4
