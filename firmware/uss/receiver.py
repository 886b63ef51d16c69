"""From the bursts that a link delivers to the one telegram that is awaited.

A link hands over characters in bursts of any size and says when the last of them came, as exactly
as it knows. The receiver puts them together, watches the response delay and the residual run time
(specification A-5.2.1), and has `telegram.judge` look at the result. It keeps nothing after an
error: `open` begins anew each time.

    receiver.open(address, net_count, residual_us, sent_at)     # the request has just left
    finding = receiver.take(link, now)              # WAITING until there is something to say
"""

from micropython import const

from uss import telegram
from uss.fast import is_telegram
from uss.timing import elapsed

WAITING = const(-1)  # nothing to say yet
# 0 is telegram.GOOD, 1...4 are the BAD_ findings of telegram.judge.
SILENT = const(5)  # no STX within the response delay
CUT_OFF = const(6)  # the residual run time passed before the telegram was complete

FINDINGS = telegram.FINDINGS + ("no reply", "residual time expired")

COMING = const(-1)  # what a link says of characters that it will announce when they are over

POLL_US = const(1_000)  # how often a link without interrupts is looked at
# Of `telegram`, for the compiler: these are needed in every exchange.
_STX = const(0x02)
_GOOD = const(0)

ROUNDING_US = const(2)  # two instants, each rounded to a microsecond


class Receiver:
    """Awaits the reply to one request.

    timing: the line's `Timing`. mask: the clock's period - 1.
    After `take` said GOOD the telegram is `buffer[:count]`; `heard_at` is when its last character
    came. `heard_at` is also kept after an error, because the line must be silent before the next
    telegram whoever spoke last. `window_us` after the request a reply is too late.
    """

    def __init__(self, timing, mask):
        self.buffer = bytearray(telegram.SIZE_MAX + 8)
        self.count = 0
        self.heard_at = 0
        self.stray = False  # characters came since `open` that begin no telegram
        self._character_us = timing.character_us
        self._start_interval_us = timing.start_interval_us
        # The first bit of STX may come at the very end of the response delay; it is seen a
        # character later.
        self.window_us = timing.reply_timeout_us + timing.character_us + ROUNDING_US
        self._mask = mask
        self._address = 0
        self._size = 0
        self._residual_us = 0
        self._sent_at = 0
        self._began_at = 0
        self._coming = False  # the link has announced nothing yet, but will

    def open(self, address, net_count, residual_us, sent_at):
        """Await a telegram of exactly `net_count` net characters from `address`.

        residual_us: `Timing.residual_us(net_count)`, computed beforehand by whoever calls this in
        an interrupt. sent_at: when the last stop bit of the request had left.
        """
        self._address = address
        self._size = net_count + 4
        self._residual_us = residual_us
        self._sent_at = sent_at
        self.heard_at = sent_at
        self.count = 0
        self.stray = False
        self._coming = False

    def take(self, link, now):
        """Take what the link has; answer WAITING, GOOD, or why there will be no telegram.

        Characters that begin no telegram (a spike when the line turns round) set `stray` and are
        skipped up to the next pause; the reply may still follow in its time.
        """
        buffer = self.buffer
        count = self.count
        added = link.receive(buffer, count)
        if added <= 0:
            return self._judge_silence(link, now, added)
        mask = self._mask
        received_at = link.received_at
        resolution_us = link.resolution_us
        size = self._size
        if count == 0:
            since_us = (received_at - self.heard_at) & mask
            if since_us > mask >> 1:  # it was over before the request was: no reply to that
                self.stray = True
                return WAITING
            length_us = added * self._character_us
            pause_us = since_us - length_us + ROUNDING_US
            # A link that sees late says so by its resolution: only a pause that was certainly too
            # short is held against the telegram. Behind stray characters it must be a certain one:
            # a look may have fallen between them and what follows without a pause.
            if not self.stray:
                pause_us += resolution_us
            self.heard_at = received_at
            if pause_us < self._start_interval_us or buffer[0] != _STX:
                self.stray = True
                return WAITING
            if added == size and is_telegram(buffer, size, self._address):
                self.count = size
                return _GOOD  # in one go, as nearly always
            self._began_at = (received_at - length_us) & mask
        self.heard_at = received_at
        self.count = count = count + added
        if count < size:
            wrong = count >= 2 and buffer[1] != size - 2
            return telegram.BAD_LENGTH if wrong else WAITING
        if (received_at - self._began_at) & mask > self._residual_us + resolution_us:
            return CUT_OFF
        return telegram.judge(buffer, count, self._address, size - 4)

    def due_us(self, link, now):
        """Microseconds until `take` has something to say, at least 1.

        A link with interrupts announces what it hears, so that only the time-outs are due. Another
        one is looked at when the telegram can be complete at the earliest, then every POLL_US.
        """
        passed_us = elapsed(now, self._sent_at, self._mask)
        if self.count:
            left = self._residual_us + link.resolution_us + 1
            left -= elapsed(now, self._began_at, self._mask)
        elif self._coming:
            left = self.window_us + self._residual_us + link.resolution_us - passed_us
        else:
            left = self.window_us - passed_us
        if not link.interrupts:
            earliest_us = self._start_interval_us + self._size * self._character_us
            left = min(left, max(earliest_us - passed_us, POLL_US))
        return max(left, 1)

    def _judge_silence(self, link, now, added):
        """Nothing to take: whether it is too late for what may still come, or is just coming."""
        late_us = self._residual_us + link.resolution_us
        self._coming = added == COMING
        if self.count:
            if elapsed(now, self._began_at, self._mask) <= late_us:
                return WAITING
            finding = CUT_OFF
        else:
            window_us = self.window_us + late_us if self._coming else self.window_us
            if elapsed(now, self._sent_at, self._mask) < window_us:
                return WAITING
            finding = telegram.BAD_START if self.stray or self._coming else SILENT
        if self._coming:
            self.heard_at = now  # the line is not silent
        return finding
