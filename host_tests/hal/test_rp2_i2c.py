# SPDX-License-Identifier: MIT
"""I2C of the RP2040 that does not wait, by the registers of the DW_apb_i2c: what goes into its
FIFO, when it waits for room there, and what it makes of a transfer that has failed."""

from boards.sim.clock import Clock
from hal.display.rp2_i2c import PostedI2C

BASE = 0x4004_4000
DATA_CMD, RAW_INTR_STAT, TXFLR = BASE + 0x10, BASE + 0x34, BASE + 0x74
STOP, TX_ABRT = 0x200, 0x40
EIO, ETIMEDOUT = 5, 110
BYTE_US = 90  # at 100 kHz


class Registers:
    """`mem32`, the FIFO behind it, and the I2C of the port. moves: it sends, a byte in 90 us."""

    def __init__(self, ticks_start=0):
        self.clock = Clock(ticks_start)
        self.transfers = []  # of the port
        self.words = []  # that went into the FIFO
        self.status = 0
        self.held = 0
        self.moves = True
        self.i2c = PostedI2C(self, BASE, self, self.clock)
        self.i2c.writeto(0x27, b"first")
        assert self.transfers == [(0x27, b"first")]

    def writeto(self, address, data):
        self.transfers.append((address, bytes(data)))

    def __getitem__(self, register):
        if register == RAW_INTR_STAT:
            return self.status
        assert register == TXFLR and self.clock.now_us < 10_000, "it waits for ever"
        held = self.held
        if held:
            self.clock.advance(BYTE_US if self.moves else 1)
            self.held -= self.moves
        return held

    def __setitem__(self, register, word):
        assert register == DATA_CMD and self.held < 16, "it would be lost"
        self.held += 1
        self.words.append(word)

    def waits_us(self, held, count):
        """How long a transfer of so many bytes waits while the FIFO holds these."""
        self.held, since_us = held, self.clock.now_us
        self.i2c.writeto(0x27, bytes(count))
        return self.clock.now_us - since_us


def error_of(registers, data=b"\x08"):
    try:
        registers.i2c.writeto(0x27, data)
    except OSError as error:
        return error.args[0]


def test_the_port_makes_the_first_transfer_and_the_fifo_has_the_others():
    """Each ends with a stop."""
    registers = Registers()
    for data, words in (
        (b"\x08", [0x208]),
        (b"\x01\x02", [0x01, 0x202]),
        (bytes(range(0xF0, 0x100)), list(range(0xF0, 0xFF)) + [0x2FF]),
    ):
        registers.held = 0
        registers.words.clear()
        registers.i2c.writeto(0x27, data)
        assert registers.words == words and len(registers.transfers) == 1


def test_a_first_transfer_that_fails_is_made_again():
    registers = Registers()

    def fail(_address, _data):
        raise OSError(EIO)

    registers.writeto, writeto = fail, registers.writeto
    registers.i2c = PostedI2C(registers, BASE, registers, registers.clock)
    assert error_of(registers) == EIO
    registers.writeto = writeto
    assert error_of(registers) is None
    assert registers.transfers[1:] == [(0x27, b"\x08")] and not registers.words


def test_a_transfer_that_was_not_acknowledged_is_told_by_the_next_which_sends_nothing():
    for status, error in ((TX_ABRT, EIO), (0xFFFF, EIO), (0xFFFF ^ TX_ABRT, None), (0, None)):
        registers = Registers()
        registers.status = status
        assert error_of(registers) == error, status
        assert len(registers.words) == (error is None)


def test_a_transfer_waits_until_there_is_room_for_all_its_bytes():
    """Bytes that the FIFO holds, bytes of the transfer: looks that it takes."""
    for held, count, looks in (
        (0, 16, 0), (1, 15, 1), (15, 1, 1), (6, 10, 1),
        (1, 16, 1), (7, 10, 2), (16, 1, 2), (16, 10, 11), (16, 16, 16),
    ):  # fmt: skip
        assert Registers().waits_us(held, count) == looks * BYTE_US, (held, count)


def test_a_fifo_that_is_stuck_is_waited_for_for_two_milliseconds():
    for ticks_start in (0, 0x3FFFFFFF - 1_000):  # the clock may begin anew meanwhile
        registers = Registers(ticks_start)
        registers.held, registers.moves = 16, False
        since_us = registers.clock.now_us
        assert error_of(registers) == ETIMEDOUT and not registers.words
        # Each look takes 1 us; the first one is before the wait.
        assert registers.clock.now_us - since_us == 1 + 2_000 + 1
