# SPDX-License-Identifier: MIT
"""Puts together the one awaited telegram from the bursts that a link delivers.

A link hands over characters in bursts of any size and says when the last of them came, as exactly
as it knows. The receiver puts them together, watches the response delay and the residual run time
(specification A-5.2.1), and has `telegram.judge` look at the result. It keeps nothing after an
error: `open` begins anew each time. A line with two wires brings back what was sent; the receiver
recognises that echo and skips it.

    receiver.open(drive, sent_at)                   # the drive's request has just left
    finding = receiver.take(link, now)              # WAITING until there is something to say
"""

from micropython import const

from uss import telegram
from uss.fast import agreeing, is_reply
from uss.timing import BITS_PER_CHARACTER, elapsed

WAITING = const(-1)  # nothing to say yet
# 0 is telegram.GOOD, 1...4 are the BAD_ findings of telegram.judge. BAD_LENGTH: a whole telegram.
SILENT = const(5)  # no STX within the response delay
CUT_OFF = const(6)  # the residual run time passed before the telegram was complete
GARBLED = const(7)  # LGE is not the agreed one, and what came is no telegram of its length either

FINDINGS = telegram.FINDINGS + ("no reply", "residual time expired", "wrong length and content")

# What a finding means to a person who looks for the fault. A whole telegram of another length is
# not noise: the drive's P2013, or P2012, is not what it should be.
SILENCE = const(0)
NOISE = const(1)
OTHER_LENGTH = const(2)
OTHER_ADDRESS = const(3)
WRONG_CHECK = const(4)
TROUBLES = (SILENCE, NOISE, OTHER_LENGTH, WRONG_CHECK, OTHER_ADDRESS, SILENCE, NOISE, NOISE)

COMING = const(-1)  # a link says so of characters that it will announce when they are over

_POLL_US = const(1_000)  # how often a link without interrupts is looked at
# Copies from `telegram` for the compiler: every exchange needs them.
_STX = const(0x02)
_GOOD = const(0)
_FRAME = const(4)  # characters of a telegram that are not net data

ROUNDING_US = const(2)  # of two instants, each rounded to a microsecond


class Receiver:
    """Awaits the reply to one request.

    timing: the line's `Timing`. mask: the clock's period - 1.
    After `take` said GOOD the telegram is `buffer[:count]`; `heard_at` is when its last character
    came. `heard_at` is also kept after an error, because the line must be silent before the next
    telegram, whoever spoke last. A reply that begins later than `window_us` after the request is
    too late. `echo`: what is sent comes back on this line.
    """

    def __init__(self, timing, mask):
        self.buffer = bytearray(telegram.SIZE_MAX + 8)
        self.count = 0
        self.heard_at = 0
        self.stray = False  # since `open`, characters came that begin no telegram
        self.echo = False
        self._timing = timing
        self._start_interval_us = timing.start_interval_us
        # The first bit of STX may come at the very end of the response delay; STX is seen one
        # character later.
        self.window_us = timing.reply_timeout_us + timing.character_us + ROUNDING_US
        # Rounded down, so that no pause counts as shorter than it was.
        self.sixteen_us = 16 * BITS_PER_CHARACTER * 1_000_000 // timing.baud
        self._mask = mask
        self._awaited = None
        self.sent_at = 0
        self._began_at = 0
        self._echoed = 0  # characters of the request that have come back
        self._coming = False  # the link will announce characters, but has not yet

    def open(self, awaited, sent_at):
        """Await the reply to `awaited`, a `Drive` or a telegram outside the list (`outside`).

        It must have: `address`, the ADR of the reply; `request` and `size`, the characters sent,
        and the reply probably has as many; `fits(net_count)`, whether the reply may have so many
        net characters; `may_reply_alike()`. sent_at: when the last stop bit of the request had
        left.
        """
        self._awaited = awaited
        self.sent_at = sent_at
        self.heard_at = sent_at
        self.count = 0
        self.stray = False
        self._echoed = 0
        self._coming = False

    def accept(self, count, received_at):
        """The reply is in `buffer`, and somebody has found that `take` would say GOOD."""
        self.count = count
        self.heard_at = received_at

    def await_instead(self, awaited):
        """Go on with the same request, of which `awaited` says now what a reply is."""
        self._awaited = awaited

    def take(self, link, now):
        """Take what the link has; return WAITING, GOOD, or why there will be no telegram.

        Characters that begin no telegram (a spike when the line turns round) set `stray` and are
        skipped up to the next pause; the reply may still follow in its time.
        """
        buffer = self.buffer
        count = self.count
        added = link.receive(buffer, count)
        if added <= 0:
            return self._judge_silence(link, now, added)
        received_at = link.received_at
        if count == 0:
            mask = self._mask
            since_us = (received_at - self.heard_at) & mask
            length_us = added * self.sixteen_us >> 4
            pause_us = since_us - length_us + ROUNDING_US
            # A link that sees late says so by its resolution. So the telegram is refused only if
            # the pause was certainly too short. But after stray characters there must certainly
            # have been a pause: a look may have separated them from what follows without one.
            if not self.stray:
                pause_us += link.resolution_us
            if pause_us < self._start_interval_us or buffer[0] != _STX or since_us > mask >> 1:
                return self._take_other(link, added, since_us)
            self.heard_at = received_at
            awaited = self._awaited
            if added == awaited.size and is_reply(buffer, added, awaited.request):
                self.count = added
                return _GOOD  # it came in one burst, as nearly always
            least_us = since_us - length_us - link.resolution_us
            if not self._echoed and self._is_echo(added, least_us):
                return self._take_other(link, added, since_us)
            self._began_at = (received_at - length_us) & mask
        self.heard_at = received_at
        self.count = count = count + added
        return self._judge(link, count)

    def _judge(self, link, count):
        """The finding on the characters that came; they began with STX after a pause."""
        buffer = self.buffer
        awaited = self._awaited
        if count < 2:
            return WAITING
        size = buffer[1] + 2
        if not awaited.fits(size - _FRAME):
            return self._judge_other(count, size)
        if count < size:
            return WAITING
        passed_us = (self.heard_at - self._began_at) & self._mask
        if passed_us > self._limit_us() + link.resolution_us:
            return CUT_OFF
        if count > size:
            return GARBLED
        # The ADR of the request, because the drive may have been given another address since.
        return telegram.judge(buffer, count, awaited.request[2], size - _FRAME)

    def _judge_other(self, count, size):
        """The finding if LGE is not an awaited one: a telegram of another length, or noise."""
        buffer = self.buffer
        if not 5 <= size <= telegram.SIZE_MAX or count > size:
            return GARBLED
        if count < size:
            return WAITING
        finding = telegram.judge(buffer, count, self._awaited.request[2], None)
        if finding == telegram.BAD_BCC:
            return GARBLED
        return finding or telegram.BAD_LENGTH

    def _is_other(self):
        """Whether what has begun has none of the awaited lengths."""
        return self.count >= 2 and not self._awaited.fits(self.buffer[1] + 2 - _FRAME)

    def _ended_us(self, link):
        """How long after its last character a telegram that is not awaited counts as over."""
        return self._start_interval_us + link.resolution_us + 1

    def _is_echo(self, added, pause_us):
        """Whether the first characters are the echo of the request. pause_us: the pause before
        them, at least.

        A reply may be equal to the request (mirror, or only an empty parameter channel). It counts
        as a reply if there certainly was a pause; in doubt, if this line has shown no echo so far.
        """
        awaited = self._awaited
        size = awaited.size
        if added < size or agreeing(self.buffer, 0, awaited.request, 0, size) < size:
            return False
        if pause_us >= self._start_interval_us:
            return False
        return self.echo or not awaited.may_reply_alike()

    def _take_other(self, link, added, since_us):
        """Take characters that begin no reply: they are the echo of the request, or stray.

        After an echo the reply may follow in the same burst. Where a line echoes, the first copy
        of a mirror telegram is the echo.
        """
        buffer = self.buffer
        awaited = self._awaited
        self._coming = False  # these were announced; the reply was not yet
        count = min(added, awaited.size - self._echoed)
        if agreeing(buffer, 0, awaited.request, self._echoed, count) == count and count:
            self._echoed += count
            if self._echoed == awaited.size:
                return self._end_echo(link, added, count)
        self.stray = True
        if since_us <= self._mask >> 1:  # else it ended before the request did
            self.heard_at = link.received_at
        return WAITING

    def _end_echo(self, link, added, count):
        """The whole request has come back; the reply may follow these `count` characters."""
        buffer = self.buffer
        self.echo = True
        self.stray = False
        self.heard_at = self.sent_at
        added -= count
        if not added:
            return WAITING
        for index in range(added):
            buffer[index] = buffer[count + index]
        began_at = (link.received_at - (added * self.sixteen_us >> 4)) & self._mask
        pause_us = elapsed(began_at, self.sent_at, self._mask) + ROUNDING_US
        self.heard_at = link.received_at
        if pause_us + link.resolution_us < self._start_interval_us or buffer[0] != _STX:
            self.stray = True
            return WAITING
        self._began_at = began_at
        self.count = added
        return self._judge(link, added)

    def _limit_us(self):
        """Residual run time of the telegram that is coming in, the time of STX included.

        One and a half times the time that the characters after STX take without gaps
        (specification A-6.3). Until the LGE of a telegram of variable length has come, that of the
        longest telegram (A-5.2.1.2).
        """
        if self.count >= 2:
            size = self.buffer[1] + 2
        elif self._awaited.fits(telegram.NET_COUNT_MAX):
            size = telegram.SIZE_MAX
        else:
            size = self._awaited.size
        return self._timing.residual_us(size - _FRAME)

    def due_us(self, link, now):
        """Microseconds until `take` has something to say, at least 1.

        A link with interrupts announces what it hears, so only the time-outs are due. The receiver
        looks at another link when the telegram can be complete at the earliest, then every
        _POLL_US.
        """
        passed_us = elapsed(now, self.sent_at, self._mask)
        if self.count:
            left = self._limit_us() + link.resolution_us + 1
            left -= elapsed(now, self._began_at, self._mask)
            if not self._coming and self._is_other():
                silent_us = elapsed(now, self.heard_at, self._mask)
                left = min(left, self._ended_us(link) - silent_us)
        elif self._coming:
            left = self.window_us + self._limit_us() + link.resolution_us - passed_us
        else:
            left = self.window_us - passed_us
        if not link.interrupts:
            earliest_us = self._start_interval_us
            earliest_us += self._awaited.size * self.sixteen_us >> 4
            left = min(left, max(earliest_us - passed_us, _POLL_US))
        return max(left, 1)

    def _judge_silence(self, link, now, added):
        """The finding while there is nothing to take: WAITING, or that it is too late."""
        self._coming = added == COMING
        if self.count:
            passed_us = elapsed(now, self._began_at, self._mask)
            finding = GARBLED if self._is_other() else CUT_OFF
            if passed_us <= self._limit_us() + link.resolution_us:
                silent_us = elapsed(now, self.heard_at, self._mask)
                if finding == CUT_OFF or self._coming or silent_us < self._ended_us(link):
                    return WAITING
        else:
            window_us = self.window_us
            if self._coming:
                window_us += self._limit_us() + link.resolution_us
            if elapsed(now, self.sent_at, self._mask) < window_us:
                return WAITING
            finding = telegram.BAD_START if self.stray or self._coming else SILENT
        if self._coming:
            self.heard_at = now  # the line is not silent
        return finding
