# SPDX-License-Identifier: MIT
"""What the tests of the master share: a master on a link whose drives are a few lines of test.

A drive answers what it is told to; time passes as the master asks for it.
"""

from uss import telegram
from uss.master import Master
from uss.timing import Timing

MASK = (1 << 30) - 1
TIMING = Timing(19200)
REPLY_DELAY_US = 3 * TIMING.character_us


class Bus:
    """A link, and what hangs on it: `answer(request)` gives the reply's net data or None."""

    interrupts = True
    resolution_us = 0

    def __init__(self, addresses=(1,), start_at=0):
        self.now = start_at
        self.sent = []  # (instant, characters)
        self.silent = set()
        self.zsw = {address: 0xFB31 for address in addresses}
        self.hiw = {}  # 0 where there is none
        self.pkw = {address: None for address in addresses}  # request's PKW -> reply's PKW
        self.on_activity = None
        self.sent_at = 0
        self.received_at = 0
        self._sending_until = None
        self.reply = b""
        self.reply_at = 0
        self.master = Master(self, TIMING, MASK)
        self.drives = [self.master.turns.add(address) for address in addresses]

    # The link.

    def send(self, buffer, count):
        characters = bytes(buffer[:count])
        self.sent.append((self.now, characters))
        self._sending_until = self.now + TIMING.telegram_us(count - 4)
        self.reply = b""
        address = characters[2]
        if address in self.zsw and address not in self.silent:
            self.answer(address, characters)

    def sending_us(self, now):
        if self._sending_until is None:
            return 0
        if self.now < self._sending_until:
            return self._sending_until - self.now
        self.sent_at = self._sending_until & MASK
        self._sending_until = None
        return 0

    def receive(self, buffer, at):
        if not self.reply or self.now < self.reply_at:
            return 0
        reply, self.reply = self.reply, b""
        buffer[at : at + len(reply)] = reply
        self.received_at = self.reply_at & MASK
        return len(reply)

    def answer(self, address, request):
        net = bytearray(12)
        take_pkw = self.pkw[address]
        net[:8] = take_pkw(request[3:11]) if take_pkw else bytes(8)
        telegram.put_word(net, 8, self.zsw[address])
        telegram.put_word(net, 10, self.hiw.get(address, 0))
        reply = bytearray(20)
        reply[3:15] = net
        count = telegram.seal(reply, address, 12)
        self.reply = bytes(reply[:count])
        self.reply_at = self._sending_until + REPLY_DELAY_US + TIMING.telegram_us(12)

    # Time.

    def run(self, us, refresh=True):
        until = self.now + us
        while self.now < until:
            self.now += self._step(refresh)

    def run_until(self, condition):
        """Let time pass up to the instant at which the engine makes `condition()` true."""
        for _ in range(1_000):
            step_us = self._step(True)
            if condition():
                return
            self.now += step_us
        raise AssertionError("it did not come so far")

    def _step(self, refresh):
        """Enter the engine; how long it is until that is due again."""
        if refresh:
            self.master.refresh(self.now & MASK)
        wait_us = self.master.poll(self.now & MASK)
        assert wait_us >= 1
        if self.reply:
            wait_us = min(wait_us, max(1, self.reply_at - self.now))
        return min(wait_us, 5_000)

    def addresses(self, since=0):
        return [characters[2] for _, characters in self.sent[since:]]

    def stws(self, address, since=0):
        return [
            telegram.get_word(characters, 11)
            for _, characters in self.sent[since:]
            if characters[2] == address
        ]


def parameters(values):
    """A drive's parameter channel: number -> (reply id, high word, low word)."""

    def take(request):
        reply = bytearray(8)
        task = request[0] >> 4
        number = ((request[0] & 7) << 8 | request[1]) + (2000 if request[2] & 0x80 else 0)
        if task and number in values:
            answer, high, low = values[number]
            telegram.put_word(reply, 0, answer << 12 | (request[0] & 7) << 8 | request[1])
            telegram.put_word(reply, 2, request[2] << 8 | request[3])
            telegram.put_word(reply, 4, high)
            telegram.put_word(reply, 6, low)
        return reply

    return take
