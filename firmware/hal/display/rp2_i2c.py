# SPDX-License-Identifier: MIT
"""Writes through I2C of the RP2040 without waiting: it puts the bytes into the FIFO, which sends.

A piece for a backpack takes 1 ms on the bus, and the loop must not wait so long. This has the one
method of machine.I2C that `backpack` uses. The next transfer tells whether the one before was
acknowledged.

    i2c = PostedI2C(machine.I2C(0, ...), 0x4004_4000, machine.mem32, clock)
    i2c.writeto(0x27, buffer)           # OSError: this one, or the one before, has failed

For one device only: the first transfer, which the port makes, sets its address. After an OSError
make the machine.I2C anew, and this with it. It runs on the chip only.
"""

from micropython import const

_EIO = const(5)
_ETIMEDOUT = const(110)
_FIFO_LENGTH = const(16)
_WAIT_MAX_US = const(2_000)  # for room in the FIFO: it empties within 1.5 ms

# Registers of the DW_apb_i2c (RP2040 data sheet, 4.3.17), and what is used of them.
_DATA_CMD = const(0x10)
_STOP = const(0x200)
_RAW_INTR_STAT = const(0x34)
_TX_ABRT = const(0x40)
_TXFLR = const(0x74)  # how many bytes the FIFO holds


class PostedI2C:
    """i2c: a machine.I2C. base: address of its registers. memory: mem32. clock: of `hal`."""

    def __init__(self, i2c, base, memory, clock):
        self._i2c = i2c
        self._memory = memory
        self._data_command = base + _DATA_CMD
        self._status = base + _RAW_INTR_STAT
        self._level = base + _TXFLR
        self._ticks_us = clock.ticks_us
        self._mask = clock.ticks_mask
        self._is_first = True

    def writeto(self, address, buffer):
        """Send at most _FIFO_LENGTH bytes. OSError: no acknowledgement, or the bus is stuck."""
        if self._is_first:
            self._i2c.writeto(address, buffer)
            self._is_first = False
            return
        memory, register = self._memory, self._data_command
        if memory[self._status] & _TX_ABRT:
            raise OSError(_EIO)
        last = len(buffer) - 1
        if memory[self._level] + last >= _FIFO_LENGTH:
            self._wait_for(last)
        for index in range(last):
            memory[register] = buffer[index]
        memory[register] = buffer[last] | _STOP

    def _wait_for(self, last):
        began_at_us = self._ticks_us()
        while self._memory[self._level] + last >= _FIFO_LENGTH:
            if (self._ticks_us() - began_at_us) & self._mask > _WAIT_MAX_US:
                raise OSError(_ETIMEDOUT)
