# SPDX-License-Identifier: MIT
"""The link layer of a simulated drive: which characters on the line are a telegram for it.

It judges start interval, LGE, times, BCC, character errors and ADR in the order of the
specification (A-5.2), counts what goes wrong and says nothing about it. It knows no net data, and
it shares no code with the panel's protocol, so that a mistake of one shows against the other.

    form = slave.hear(burst)            # STANDARD, MIRROR, BROADCAST, or None: drop it silently
    slave.telegram[:slave.length]       # the telegram, STX to BCC
    count = slave.frame(buffer, words)  # a reply of these net words

A burst without errors and gaps is judged at one go, any other character by character; both mean
the same. What the specification leaves open is a switch (switches.py).
"""

from struct import unpack_from

from boards.sim.drives.switches import Switches
from boards.sim.line.wire import FRAME as FRAME_ERROR
from boards.sim.line.wire import OVERRUN as OVERRUN_ERROR
from boards.sim.line.wire import start_interval_us

STX = 0x02
BROADCAST_BIT, MIRROR_BIT, SPECIAL_BIT = 0x20, 0x40, 0x80

STANDARD = "standard"
MIRROR = "mirror"
BROADCAST = "broadcast"

# Places in `counters`, which are r2024 ... r2031 in their order.
GOOD, REJECTED, FRAME, OVERRUN, PARITY, START, BCC, LENGTH = range(8)
# Two more, which no parameter of the listed families shows.
RESIDUAL_TIME, WATCHDOG = 8, 9

# Bits of the error status word (specification ), by the same numbers.
STATUS_BITS = (0, 0, 0x01, 0x02, 0x04, 0x08, 0x10, 0x40, 0x20, 0x80)

VARIABLE = 127  # PKW length that says: as many words as a task needs
NET_MAX = 252
WORDS = tuple([">%dH" % count for count in range(NET_MAX // 2 + 1)])  # in the words of `struct`
ROUNDING_US = 2  # instants are whole microseconds, and a gap lies between two of them


def xor_of(data, count):
    """The block check character of data[:count]: all characters, the STX among them."""
    bcc = 0
    for i in range(count):
        bcc ^= data[i]
    return bcc


def words_of(telegram, at, end):
    """The words in telegram[at:end]."""
    return list(unpack_from(WORDS[(end - at) // 2], telegram, at))


def kind_of(errors):
    """Which counter a character with these errors belongs to; it is one of them only."""
    if errors & FRAME_ERROR:
        return FRAME
    return OVERRUN if errors & OVERRUN_ERROR else PARITY


class Slave:
    """address, pkw_words (0, 3, 4 or VARIABLE), pzd_words, baud: as the drive is set up now.

    takes_broadcast  False: a broadcast is not for it
    counters         since power-up, see GOOD ... LENGTH, then RESIDUAL_TIME and WATCHDOG; 16 bits
    error_status     the error status word: what went wrong since the last good telegram for it
    """

    def __init__(self, wire, switches=None):
        self._wire = wire
        self._switches = switches or Switches()
        self.address = 0
        self.pkw_words = 4
        self.pzd_words = 2
        self.takes_broadcast = True
        self.telegram = bytearray(NET_MAX + 4)
        self.set_baud(wire.baud)
        self.reset()

    def set_baud(self, baud):
        """Hear and judge by this rate from now on."""
        self.baud = baud
        self._pause_us = start_interval_us(baud) - 1
        self._character_us = -(-11_000_000 // baud)

    def reset(self):
        """As at power-up: nothing received, nothing counted."""
        self._counters = [0] * 10
        self._error_status = 0
        self.length = 0
        self._received = 0  # characters of a telegram that is coming in
        self._errors = 0  # the errors of the first of them that has any
        self._is_mine = True  # as far as its ADR is known; not if the ADR has an error
        self._stx_us = 0
        self._last_us = 0  # the end of the last of them
        self._skipping = False  # until the line has been idle for the start interval

    def counters(self):
        self._settle()
        return self._counters

    def error_status(self):
        self._settle()
        return self._error_status

    def watchdog_expired(self):
        """Count that the telegram failure time is over."""
        self._count(WATCHDOG)

    def hear(self, burst):
        """Take a burst at its end; return the form of the telegram for this drive in it, or
        None."""
        if self.baud != burst.baud:
            return self._hear_garbage(burst)
        if (
            self._received
            or burst.errors is not None
            or burst.ends is not burst.even_ends
            or burst.silence_us < self._pause_us
        ):
            return self._hear_characters(burst)
        data = burst.data
        count = burst.count
        if count < 3 or data[0] != STX or data[1] != count - 2 or not self._fits(count - 2):
            return self._hear_characters(burst)
        self._skipping = False
        self._errors = 0
        adr = data[2]
        if adr < BROADCAST_BIT and adr != self.address:  # most are for another drive, or from one
            self._is_mine = False
            if not (self._switches.counts_all or burst.exclusive_or()):
                return None
        else:
            self._is_mine = self._form(adr) is not None
        return self._judge(data, count, burst.exclusive_or())

    def frame(self, buffer, words):
        """Put a telegram with these net data words into `buffer`; its length."""
        buffer[0] = STX
        buffer[1] = 2 * len(words) + 2
        buffer[2] = self.address
        check = STX ^ buffer[1] ^ self.address
        at = 3
        for word in words:
            buffer[at] = word >> 8
            buffer[at + 1] = word & 0xFF
            at += 2
            check ^= word
        buffer[at] = (check >> 8 ^ check) & 0xFF
        return at + 1

    # A telegram

    def _judge(self, data, count, check):
        """Judge a telegram that is complete, and in time."""
        self._received = 0
        if check:
            return self._reject(BCC)
        if self._errors:
            return self._reject(kind_of(self._errors))
        if self._is_mine:
            self.length = count
            if data is not self.telegram:
                self.telegram[:count] = data[:count]
            self._error_status = 0
            self._count(GOOD)
            return self._form(data[2])
        if self._switches.counts_all:
            self._count(GOOD)
        return None

    def _form(self, adr):
        if not adr & (SPECIAL_BIT | MIRROR_BIT) and adr & BROADCAST_BIT:
            return BROADCAST if self.takes_broadcast else None
        if adr == self.address:
            return STANDARD
        if adr == self.address | MIRROR_BIT:
            return MIRROR
        return None

    def _fits(self, lge):
        if self.pkw_words == VARIABLE:
            return 4 <= lge <= 254 and not lge & 1 and lge >= 2 * self.pzd_words + 2
        # LGE 2, without net data, is not valid: a drive that is set to no words hears nothing.
        return lge > 2 and lge == 2 * (self.pkw_words + self.pzd_words) + 2

    def _deadline_us(self):
        # 1.5 times the compressed time of LGE, ADR, n characters and BCC; n is 252 until the LGE
        # of a telegram of variable length has come.
        net = NET_MAX
        if self.pkw_words != VARIABLE:
            net = 2 * (self.pkw_words + self.pzd_words)
        elif self._received > 1:
            net = self.telegram[1] - 2
        return self._stx_us - (-(net + 3) * 16_500_000 // self.baud)

    # Character by character

    def _hear_characters(self, burst):
        data = burst.data
        errors = burst.errors
        ends = burst.ends
        if burst.inside:  # another talker's telegram, which this one spoils, will tell
            return None
        form = None
        before_us = -burst.silence_us
        character_us = self._character_us
        for i in range(burst.count):
            gap_us = ends[i] - character_us - before_us
            before_us = ends[i]
            flaws = errors[i] if errors is not None else 0
            form = self._take(data[i], flaws, burst.start_us + before_us, gap_us) or form
        return form

    def _take(self, character, errors, end_us, gap_us):
        """Take one character, `gap_us` after the last; return the form of a telegram it ends."""
        paused = gap_us >= self._pause_us - ROUNDING_US
        if self._received:
            self._give_up(end_us, paused)
        if not self._received:
            self._begin(character, errors, end_us, paused)
            return None
        at = self._received
        self._last_us = end_us
        self._errors = self._errors or errors
        self.telegram[at] = character
        self._received = count = at + 1
        if count == 2:
            return None
        if count == 3:
            self._is_mine = errors != 0 or self._form(character) is not None
            if not self._fits(self.telegram[1]):
                self._received = 0
                return self._reject(LENGTH)
        if count < self.telegram[1] + 2:
            return None
        return self._judge(self.telegram, count, xor_of(self.telegram, count))

    def _begin(self, character, errors, end_us, paused):
        """Take what may be the first character of a telegram."""
        if paused:
            self._skipping = False
        if self._skipping:
            return
        self._is_mine = True
        if errors and paused:
            self._reject(kind_of(errors))
        elif not paused or character != STX:
            self._reject(START)
        else:
            self.telegram[0] = character
            self._received = 1
            self._errors = 0
            self._stx_us = self._last_us = end_us

    def _give_up(self, now_us, paused):
        """Drop the telegram that is coming in if it cannot be one any more."""
        if self._received == 2 and not self._fits(self.telegram[1]):
            if paused:
                self._received = 0
                self._reject(LENGTH)
        elif now_us > self._deadline_us() or (paused and self._switches.strict_gaps):
            self._received = 0
            self._skipping = True
            if self._is_mine or self._switches.counts_all:
                self._count(RESIDUAL_TIME)

    def _settle(self):
        """Before the counters are read: count what is over by now."""
        now_us = self._wire.clock.now_us
        if self._received:
            self._give_up(now_us, now_us - self._last_us >= self._pause_us)

    def _hear_garbage(self, burst):
        """Take a burst of another baud rate: no character is valid; the pauses count as at
        ours."""
        self._received = 0
        self._is_mine = True
        if burst.silence_us >= 22_000_000 // self.baud:
            self._skipping = False
        if not self._skipping:
            self._reject(FRAME)

    # Errors: drop all, say nothing, wait for an idle line

    def _reject(self, kind):
        self._skipping = True
        if self._is_mine or self._switches.counts_all:
            self._count(kind)
            self._count(REJECTED)

    def _count(self, kind):
        self._counters[kind] = (self._counters[kind] + 1) & 0xFFFF
        self._error_status |= STATUS_BITS[kind]
