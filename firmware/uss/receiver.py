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
from uss.timing import elapsed

WAITING = const(-1)  # nothing to say yet
# 0 is telegram.GOOD, 1...4 are the BAD_ findings of telegram.judge.
SILENT = const(5)  # no STX within the response delay
CUT_OFF = const(6)  # the residual run time passed before the telegram was complete

FINDINGS = telegram.FINDINGS + ("no reply", "residual time expired")

POLL_US = const(1_000)  # how often a link without interrupts is looked at
ROUNDING_US = const(2)  # two instants, each rounded to a microsecond


class Receiver:
    """Awaits the reply to one request.

    timing: the line's `Timing`. mask: the clock's period - 1.
    After `take` said GOOD the telegram is `buffer[:count]`; `heard_at` is when its last character
    came. `heard_at` is also kept after an error, because the line must be silent before the next
    telegram whoever spoke last.
    """

    def __init__(self, timing, mask):
        self.buffer = bytearray(telegram.SIZE_MAX + 8)
        self.count = 0
        self.heard_at = 0
        self.stray = False  # characters came since `open` that begin no telegram
        self._timing = timing
        self._mask = mask
        self._address = 0
        self._net_count = 0
        self._size = 0
        self._residual_us = 0
        self._sent_at = 0
        self._began_at = 0

    def open(self, address, net_count, residual_us, sent_at):
        """Await a telegram of exactly `net_count` net characters from `address`.

        residual_us: `Timing.residual_us(net_count)`, computed beforehand by whoever calls this in
        an interrupt. sent_at: when the last stop bit of the request had left.
        """
        self._address = address
        self._net_count = net_count
        self._size = net_count + 4
        self._residual_us = residual_us
        self._sent_at = sent_at
        self.heard_at = sent_at
        self.count = 0
        self.stray = False

    def take(self, link, now):
        """Take what the link has; answer WAITING, GOOD, or why there will be no telegram.

        Characters that begin no telegram (a spike when the line turns round) set `stray` and are
        skipped up to the next pause; the reply may still follow in its time.
        """
        added = link.receive(self.buffer, self.count)
        if added:
            return self._add(added, link.received_at, link.resolution_us)
        if self.count:
            if elapsed(now, self._began_at, self._mask) > self._residual_us + link.resolution_us:
                return CUT_OFF
        elif elapsed(now, self._sent_at, self._mask) >= self._window_us():
            return telegram.BAD_START if self.stray else SILENT
        return WAITING

    def due_us(self, link, now):
        """Microseconds until `take` has something to say, at least 1.

        A link with interrupts announces what it hears, so that only the time-outs are due. Another
        one is looked at when the telegram can be complete at the earliest, then every POLL_US.
        """
        passed_us = elapsed(now, self._sent_at, self._mask)
        if self.count:
            left = self._residual_us + link.resolution_us + 1
            left -= elapsed(now, self._began_at, self._mask)
        else:
            left = self._window_us() - passed_us
        if not link.interrupts:
            timing = self._timing
            earliest_us = timing.start_interval_us + self._size * timing.character_us
            left = min(left, max(earliest_us - passed_us, POLL_US))
        return max(left, 1)

    def _window_us(self):
        # The first bit of STX may come at the very end of the response delay; it is seen a
        # character later.
        return self._timing.reply_timeout_us + self._timing.character_us + ROUNDING_US

    def _add(self, added, received_at, resolution_us):
        """Judge the buffer after `added` characters came, the last of them at `received_at`."""
        length_us = added * self._timing.character_us
        # A link that sees late says so by its resolution: only a pause that was certainly too
        # short is held against the telegram. Behind stray characters it must be a certain one:
        # a look may have fallen between them and what follows without a pause.
        late_us = 0 if self.stray else resolution_us
        pause_us = elapsed(received_at, self.heard_at, self._mask) - length_us
        paused = pause_us + late_us + ROUNDING_US >= self._timing.start_interval_us
        self.heard_at = received_at
        if self.count == 0:
            if not paused or self.buffer[0] != telegram.STX:
                self.stray = True
                return WAITING
            self._began_at = (received_at - length_us) & self._mask
        self.count += added
        if self.count >= 2 and self.buffer[1] != self._size - 2:
            return telegram.BAD_LENGTH
        if self.count < self._size:
            return WAITING
        if elapsed(received_at, self._began_at, self._mask) > self._residual_us + resolution_us:
            return CUT_OFF
        return telegram.judge(self.buffer, self.count, self._address, self._net_count)
