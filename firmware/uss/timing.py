# SPDX-License-Identifier: MIT
"""The times of the USS line, all derived from the baud rate, all integers in microseconds.

This is not a clock. `Timing` tells how long something takes or may take; `elapsed` measures the
time between two readings of a counter that wraps.

    line = Timing(19200)
    line.start_interval_us          # 1146: silence that must precede every STX
    elapsed(now, since, mask)       # microseconds from `since` to `now`, across the wrap
"""

BITS_PER_CHARACTER = 11  # start, 8 data, even parity, stop (specification B-3.2)
START_INTERVAL_CHARACTERS = 2  # silence before STX (specification)
RESPONSE_DELAY_US = 20_000  # at most, from request to STX of the reply (specification A-5.2.1.1)
FRAME_CHARACTERS = 4  # STX, LGE, ADR and BCC stand around the net characters

# Every rate of specification B-2.4. 9600, 19200, 38400 and 187500 are those of every interface.
BAUD_RATES = (
    300, 600, 1200, 2400, 4800, 9600, 19200, 38400, 57600, 76800, 93750, 115200, 187500,
)  # fmt: skip


def characters_us(baud, count):
    """Duration of `count` characters sent back to back, in microseconds, rounded up."""
    return -(-BITS_PER_CHARACTER * 1_000_000 * count // baud)


class Timing:
    """The times of a line with the given baud rate.

    Computed once and kept, because large products do not fit the small integers of a 32-bit chip
    and an interrupt must not allocate.

    baud: bits per second; ValueError unless it is one of BAUD_RATES.
    reply_timeout_us: how long the master waits for the first character of a reply. The
        specification says 20 ms; adapters that delay need more. Below 2400 baud the pause that the
        drive must keep before its reply comes near that or exceeds it: then the master waits twice
        that pause.
    """

    def __init__(self, baud, reply_timeout_us=RESPONSE_DELAY_US):
        if baud not in BAUD_RATES:
            raise ValueError("baud rate %r is none of USS: %s" % (baud, BAUD_RATES))
        self.baud = baud
        self.character_us = characters_us(baud, 1)
        self._sixteen_us = characters_us(baud, 16)
        self.start_interval_us = characters_us(baud, START_INTERVAL_CHARACTERS)
        self.reply_timeout_us = max(reply_timeout_us, 2 * self.start_interval_us)

    def telegram_us(self, net_count):
        """Duration of a telegram with `net_count` net characters sent without a gap."""
        return characters_us(self.baud, net_count + FRAME_CHARACTERS)

    def residual_us(self, net_count):
        """Longest time from the start of STX to the end of BCC: one and a half times the
        compressed time of the characters after STX (specification A-6.3), and STX itself.

        Called by the engine: no product leaves the small integers."""
        compressed_us = (net_count + FRAME_CHARACTERS - 1) * self._sixteen_us
        return (3 * compressed_us >> 5) + self.character_us

    def exchange_us(self, net_count, reply_delay_us, link_delay_us=0):
        """One request and its reply, both with `net_count` net characters, and the silences
        between.

        link_delay_us: how long after the end of a reply the link reports it; the RP2040 takes 32
        bits (`idle_us` of its link), which is longer than the start interval.
        """
        return self.cycle_us(((net_count, net_count, reply_delay_us),), link_delay_us)

    def cycle_us(self, exchanges, link_delay_us=0):
        """A round of the circulating list (specification A-5.1.1), without the master's own time.

        exchanges: for each entry (net characters of the request, of the reply, reply delay in
        microseconds). Reply delay None: a broadcast, or a drive that does not answer; the master
        waits for the response delay.
        """
        pause_us = max(self.start_interval_us, link_delay_us)
        cycle_us = 0
        for request_count, reply_count, reply_delay_us in exchanges:
            cycle_us += self.telegram_us(request_count)
            if reply_delay_us is None:
                cycle_us += self.start_interval_us + self.reply_timeout_us + self.character_us
            else:
                cycle_us += pause_us + reply_delay_us + self.telegram_us(reply_count)
        return cycle_us


def elapsed(now, since, mask):
    """Microseconds from the reading `since` to the reading `now` of one wrapping counter.

    mask: the counter's period - 1, at most 2**30 - 1 so that nothing leaves the small integers.
    If `since` lies ahead of `now` (an interrupt was faster than its reader), the answer is 0. More
    than half a period looks the same, so code that waits so long must latch a flag.
    """
    difference = (now - since) & mask
    return difference if difference <= mask >> 1 else 0
