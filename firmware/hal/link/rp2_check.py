# SPDX-License-Identifier: MIT
"""What the bus of an RP2040 or RP2350 can find wrong with itself before the first telegram.

    defect = find(machine.mem32, UART_REGISTERS, driver_enable, receive_pin, clock, baud)
    # of DEFECTS, or ""

It takes 3 ms, and up to 14 where the line is low. Nothing leaves the chip: the characters that it
sends stay in the UART (PL011, ARM DDI 0183: loopback). A line that is merely busy is no defect.
"""

from micropython import const

# The driver enable is on though nothing is sent; what the UART sends by internal loopback, it does
# not receive; the receive pin is low for longer than any character.
DEFECTS = DRIVER, UART, LINE = "driver", "uart", "line"

# Offsets of registers; bits.
_DATA, _FLAGS, _WHOLE, _FRACTION = const(0x00), const(0x18), const(0x24), const(0x28)
_FORMAT, _CONTROL, _MASK, _CLEAR = const(0x2C), const(0x30), const(0x38), const(0x44)
_EMPTY, _BUSY = const(0x10), const(0x08)  # of _FLAGS
_LOOPBACK, _ON = const(0x80), const(0x301)  # of _CONTROL; _ON: it, its sender and its receiver
_ALL = const(0x7FF)  # of _MASK, _CLEAR

_DIVISOR = const(4)  # of the UART's clock, besides its own 16: 8 characters take 50 us or so
_CODES = b"\x00\xff\x55\xaa\x01\x80\x7f\xfe"
_FIFO = const(32)
_LOOK_US = const(20)
_LOOKS = const(50)
_CHARACTER_BITS = const(12)  # and one more
_LONGEST_US = const(11_000)  # a character of 1200 baud: of a slower line nobody waits for the end
_WATCHED_US = const(3_000)  # many characters of a fast line


def find(mem32, uart, driver_enable, receive, clock, baud):
    """mem32: reads and writes the word at an address. uart: the first register of the bus's UART,
    which is open. driver_enable, receive: pins."""
    if driver_enable.value():
        return DRIVER
    if not _loops_back(mem32, uart, clock):
        return UART
    return LINE if _stays_low(receive, clock, baud) else ""


def _loops_back(mem32, uart, clock):
    """Its registers are what they were afterwards, but that its FIFO is empty."""
    registers = (_WHOLE, _FRACTION, _FORMAT, _MASK)
    before = [mem32[uart + offset] for offset in registers]
    control = mem32[uart + _CONTROL]
    mem32[uart + _MASK] = 0  # or MicroPython would take the characters
    mem32[uart + _CONTROL] = _LOOPBACK
    _drain(mem32, uart)
    for offset, value in ((_WHOLE, _DIVISOR), (_FRACTION, 0), (_FORMAT, before[2])):
        mem32[uart + offset] = value  # the last one makes the others act
    mem32[uart + _CONTROL] = _LOOPBACK | _ON
    for code in _CODES:
        mem32[uart + _DATA] = code
    looks = _LOOKS
    while looks and mem32[uart + _FLAGS] & _BUSY:
        looks -= 1
        clock.sleep_us(_LOOK_US)
    right = looks > 0
    for code in _CODES:
        right = right and not mem32[uart + _FLAGS] & _EMPTY and mem32[uart + _DATA] == code
    mem32[uart + _CONTROL] = _LOOPBACK
    _drain(mem32, uart)
    for offset, value in zip(registers[:3], before):
        mem32[uart + offset] = value
    mem32[uart + _CLEAR] = _ALL
    mem32[uart + _CONTROL] = control
    mem32[uart + _MASK] = before[3]
    return right


def _drain(mem32, uart):
    for _ in range(_FIFO):
        if mem32[uart + _FLAGS] & _EMPTY:
            return
        mem32[uart + _DATA]


def _stays_low(receive, clock, baud):
    """A character is high in its stop bit at the latest: each look takes less than a bit."""
    character_us = _CHARACTER_BITS * 1_000_000 // baud
    if character_us > _LONGEST_US:
        return False
    watched_us = max(character_us, _WATCHED_US)
    level, ticks_us, mask = receive.value, clock.ticks_us, clock.ticks_mask
    began = ticks_us()
    while (ticks_us() - began) & mask < watched_us:
        for _ in range(_LOOKS):
            if level():
                return False
        clock.sleep_us(1)
    return True
