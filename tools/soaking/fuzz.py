# SPDX-License-Identifier: MIT
"""Feeds random bytes to the firmware's bus engine and its receiver, and checks that nothing
breaks.

It sends noise, telegrams with a few wrong bits, pieces of telegrams and good replies, in bursts of
any size, with pauses of any length. These rules must hold: the firmware raises no exception; it
takes every good reply after a start gap, unless something that begins like a telegram is still
coming in; it takes nothing else.

    fuzz(1_000_000, 7)          # {"bytes": ..., "good": ..., "broken": None or a text}
"""

from tools.soaking.dice import Dice
from uss.layout import VARIABLE, Layout
from uss.master import AWAITING, Master
from uss.timing import Timing

MASK = 0x3FFFFFFF
STX = 0x02
LAYOUTS = ((4, 2), (4, 2), (3, 2), (0, 2), (VARIABLE, 2), (4, 16))
BAUDS = (9600, 19200, 115200)
EXCHANGES = 2_000  # on each line; then the next line begins
NOISE, SPOILT, PIECE = range(3)


class Line:
    """A link of `hal` that is told what comes in. now_us: virtual time, of a clock that wraps."""

    interrupts = True
    resolution_us = 0

    def __init__(self, timing, now_us):
        self.now_us = now_us
        self.sent = None
        self.sends = 0
        self.sent_at = 0
        self.received_at = 0
        self._timing = timing
        self._burst = b""

    def send(self, buffer, count):
        self.sent = bytes(buffer[:count])
        self.sends += 1
        duration_us = self._timing.telegram_us(count - 4)
        self.sent_at = (self.now_us + duration_us) & MASK

    def sending_us(self, now):
        left_us = (self.sent_at - now) & MASK
        return left_us if left_us < MASK >> 1 else 0

    def receive(self, buffer, at):
        burst = self._burst[: len(buffer) - at]
        self._burst = self._burst[len(burst) :]
        buffer[at : at + len(burst)] = burst
        return len(burst)

    def come(self, burst):
        """Take characters that have just come in; the last one ends now."""
        self._burst = burst
        self.received_at = self.now_us


class Fuzz:
    """A master, the drives of its list, and the answers for them."""

    def __init__(self, dice):
        self.dice = dice
        self.timing = Timing(dice.one_of(BAUDS))
        self.line = Line(self.timing, dice.below(MASK))
        self.master = Master(self.line, self.timing, MASK)
        for address in range(1 + dice.below(3)):
            self.master.turns.add(address, Layout(*dice.one_of(LAYOUTS)))
        self.fed = 0
        self.good = 0
        self._due_us = 1  # until the engine wants to be called again
        self._sends = 0  # telegrams sent on the line, the request of this exchange included

    def exchange(self):
        """Do one exchange: a request, random bursts, perhaps the reply. Return what is wrong, or
        None."""
        line, dice = self.line, self.dice
        self._sends = line.sends + 1
        while line.sends < self._sends:
            self.pass_time(self._due_us)
        request = line.sent
        drive = self.drive_at(request[2])
        good = drive.counters[0]
        self.pass_time(line.sending_us(line.now_us))
        heard = []
        for _ in range(dice.below(4)):
            if self.is_awaited():
                heard.append(self.rubbish(request))
                self.come(heard[-1])
        taken = False
        if self.is_awaited() and dice.below(4):
            reply = self.reply(request)
            taken = self.is_in_time() and not [burst for burst in heard if burst[0] == STX]
            heard.append(reply)
            self.come(reply)
        while self.is_awaited():
            self.pass_time(self._due_us)
        more = (drive.counters[0] - good) & 0xFFFF
        self.good += more
        if taken and not more:
            return "a good reply was not taken: %s to %s" % (heard, request)
        if more and not taken and not was_good(heard, request):
            return "taken for a reply: %s to %s" % (heard, request)
        return None

    def is_awaited(self):
        """Whether the reply to this request is still to come."""
        return self.master.phase == AWAITING and self.line.sends == self._sends

    def is_in_time(self):
        """Whether what comes two characters from now still begins within the response delay."""
        passed_us = (self.line.now_us - self.line.sent_at) & MASK
        return passed_us + 3 * self.timing.character_us < self.timing.reply_timeout_us

    def drive_at(self, address):
        for drive in self.master.turns.drives:
            if drive.address == address:
                return drive

    def pass_time(self, us):
        line = self.line
        line.now_us = (line.now_us + us) & MASK
        self.master.refresh(line.now_us)
        self._due_us = self.master.poll(line.now_us)

    def come(self, burst):
        """Pause: mostly for a start gap, before a reply always."""
        timing, line = self.timing, self.line
        self.fed += len(burst)
        pause_us = timing.start_interval_us + 2
        if self.dice.below(3) == 0 and burst[0] != STX:
            pause_us = self.dice.below(pause_us)
        due_us = self._due_us
        took_us = pause_us + timing.telegram_us(len(burst) - 4)
        if due_us < took_us - len(burst) * timing.character_us:
            self.pass_time(due_us)
            took_us -= due_us
        line.now_us = (line.now_us + took_us) & MASK
        line.come(burst)
        self.master.refresh(line.now_us)
        self._due_us = self.master.poll(line.now_us)

    # --- what comes -----------------------------------------------------------------------------

    def reply(self, request):
        """A good reply with random words, which differs from the request."""
        reply = bytearray(request)
        for index in range(3, len(reply) - 1):
            reply[index] = self.dice.below(256)
        reply[-2] ^= 1 if reply[-2] == request[-2] else 0
        reply[-1] = 0
        reply[-1] = check_of(reply)
        return bytes(reply)

    def rubbish(self, request):
        dice = self.dice
        kind = dice.below(3)
        if kind == NOISE:
            return bytes(dice.below(256) for _ in range(1 + dice.below(40)))
        burst = bytearray(self.reply(request))
        if kind == SPOILT:
            for _ in range(1 + dice.below(3)):
                burst[dice.below(len(burst))] ^= 1 << dice.below(8)
            return bytes(burst)
        return bytes(burst[: 1 + dice.below(len(burst))])


def was_good(heard, request):
    """Whether what came is a whole reply by chance, in one piece or in several."""
    for first in range(len(heard)):
        stream = b"".join(heard[first:])
        if len(stream) > 4 and stream[0] == STX and stream[2] == request[2]:
            size = stream[1] + 2
            if 5 <= size <= len(stream) and not check_of(stream[:size]):
                return True
    return False


def check_of(characters):
    check = 0
    for character in characters:
        check ^= character
    return check


def fuzz(count, seed):
    """Feed `count` bytes. Exceptions of the firmware reach the caller."""
    dice = Dice(seed)
    fed = good = exchanges = 0
    broken = None
    while fed < count and not broken:
        one = Fuzz(dice)
        for _ in range(EXCHANGES):
            broken = one.exchange()
            exchanges += 1
            if broken or fed + one.fed >= count:
                break
        fed += one.fed
        good += one.good
    return {"bytes": fed, "exchanges": exchanges, "good": good, "broken": broken}
