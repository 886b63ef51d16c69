"""The machine code behind `fast`: MicroPython's viper, whose types are those of the processor.

Each function has a twin in plain Python in `fast`, and means exactly the same.
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
def is_telegram(buffer: ptr8, count: int, address: int) -> bool:
    if count < 5 or buffer[0] != 0x02 or buffer[1] != count - 2 or buffer[2] != address:
        return False
    check = 0
    index = 0
    while index < count:
        check ^= buffer[index]
        index += 1
    return check == 0


@micropython.viper
def copy(source: ptr8, target: ptr8, at: int, count: int):
    index = 0
    while index < count:
        target[at + index] = source[index]
        index += 1
