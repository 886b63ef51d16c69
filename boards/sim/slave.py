"""The link layer of a simulated drive: which characters on the line are a telegram for it.

It judges start interval, LGE, residual time, BCC and ADR in the order of the specification
(A-5.2), counts what goes wrong and says nothing about it. It knows no net data, and it shares no
code with the panel's protocol, so that a mistake of one shows against the other.

    form = slave.hear(burst)            # STANDARD, MIRROR, BROADCAST, or None: drop it silently
    slave.telegram[:slave.length]       # the telegram, STX to BCC
    count = slave.frame(buffer, words)  # a reply of these net words

Gaps inside a telegram are no error as long as its residual time is kept (A-6.3). Telegrams for
others are counted neither as good nor as rejected; the specification leaves that open.
"""

STX = 0x02
BROADCAST_BIT, MIRROR_BIT, SPECIAL_BIT = 0x20, 0x40, 0x80

STANDARD = "standard"
MIRROR = "mirror"
BROADCAST = "broadcast"

# Places in `counters`, which are r2024 ... r2031 in their order.
GOOD, REJECTED, FRAME, OVERRUN, PARITY, START, BCC, LENGTH = range(8)

VARIABLE = 127  # PKW length that says: as many words as a task needs


def xor_of(data, count):
    """The block check character of data[:count]: all characters, the STX among them."""
    bcc = 0
    for i in range(count):
        bcc ^= data[i]
    return bcc


class Slave:
    """address, pkw_words (0, 3, 4 or VARIABLE), pzd_words, baud: as the drive is set up now.

    takes_broadcast       False: a broadcast is not for it
    counters              since power-up, see GOOD ... LENGTH; 16 bits each
    residual_time_errors  telegrams that did not end in time, which no reading shows
    """

    def __init__(self, wire):
        self._wire = wire
        self.address = 0
        self.pkw_words = 4
        self.pzd_words = 2
        self.baud = wire.baud
        self.takes_broadcast = True
        self.telegram = bytearray(256)
        self.reset()

    def reset(self):
        """As at power-up: nothing received, nothing counted."""
        self.counters = [0] * 8
        self.residual_time_errors = 0
        self.length = 0
        self._received = 0  # characters of a telegram that is coming in
        self._stx_us = 0
        self._skipping = False  # until the line has been idle for the start interval

    def hear(self, burst):
        """Take a burst at its end; the form of the telegram for this drive that it completes."""
        if self._received and burst.start_us + burst.ends[0] > self._deadline_us():
            self._drop_late()
        if not self._received and not self._starts(burst):
            return None
        if burst.garbled or self.baud != self._wire.baud:
            return self._drop(FRAME)
        have = self._received
        take = min(burst.count, 256 - have)
        self.telegram[have : have + take] = burst.data[:take]
        self._received = have + take
        if not self._length_fits():
            return self._drop(LENGTH)
        self.length = self.telegram[1] + 2 if self._received > 1 else 256
        surplus = have + burst.count - self.length
        if surplus < 0:
            return None
        if burst.start_us + burst.ends[burst.count - surplus - 1] > self._deadline_us():
            return self._drop_late()
        form = self._judge()
        if surplus:
            self._drop(START)  # a character without a pause before it
        return form

    def frame(self, buffer, words):
        """Put a telegram with these net data words into `buffer`; its length."""
        buffer[0] = STX
        buffer[1] = 2 * len(words) + 2
        buffer[2] = self.address
        at = 3
        for word in words:
            buffer[at] = word >> 8
            buffer[at + 1] = word & 0xFF
            at += 2
        buffer[at] = xor_of(buffer, at)
        return at + 1

    # One step of the judgement each

    def _starts(self, burst):
        # The line counts an interval as kept down to 1 us less: instants are rounded.
        if burst.silence_us >= self._wire.start_interval_us - 1:
            self._skipping = False
        elif not self._skipping:
            self._drop(START)
        if self._skipping:
            return False
        if burst.data[0] != STX and not burst.garbled:
            self._drop(START)
            return False
        self._stx_us = burst.start_us + burst.ends[0]
        return True

    def _length_fits(self):
        if self._received < 2:
            return True
        lge = self.telegram[1]
        if self.pkw_words == VARIABLE:
            return 4 <= lge <= 254 and not lge & 1 and lge >= 2 * self.pzd_words + 2
        return lge == 2 * (self.pkw_words + self.pzd_words) + 2

    def _deadline_us(self):
        # 1.5 times the compressed time of LGE, ADR, n characters and BCC; n is 252 as long as a
        # telegram of variable length has not told its own.
        net = 252
        if self.pkw_words != VARIABLE:
            net = 2 * (self.pkw_words + self.pzd_words)
        elif self._received > 1:
            net = self.telegram[1] - 2
        return self._stx_us - (-(net + 3) * 16_500_000 // self._wire.baud)

    def _judge(self):
        if xor_of(self.telegram, self.length):
            return self._drop(BCC)
        self._received = 0
        form = self._form(self.telegram[2])
        if form is not None:
            self._count(GOOD)
        return form

    def _form(self, adr):
        if not adr & (SPECIAL_BIT | MIRROR_BIT) and adr & BROADCAST_BIT:
            return BROADCAST if self.takes_broadcast else None
        if adr == self.address:
            return STANDARD
        if adr == self.address | MIRROR_BIT:
            return MIRROR
        return None

    # Errors: drop all, say nothing, wait for an idle line

    def _drop(self, kind):
        if self._received < 3 or self._form(self.telegram[2]) is not None:
            self._count(kind)
            self._count(REJECTED)
        self._received = 0
        self._skipping = True

    def _drop_late(self):
        self.residual_time_errors += 1
        self._received = 0
        self._skipping = True

    def _count(self, kind):
        self.counters[kind] = (self.counters[kind] + 1) & 0xFFFF
