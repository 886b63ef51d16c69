# SPDX-License-Identifier: MIT
"""A master alone on a line, and at the other end nothing but what a test says: to the microsecond.

`answer(request)` makes the reply to the characters of a request when its last stop bit is over:

    None                        nobody answers
    characters                  back to back, after a pause of three characters
    [(pause_us, characters)...] pieces, each after a silence; an announced burst each

    line = Line(lambda request: reply)
    drive = line.master.turns.add(1)
    line.exchange()                 # ... until one more reply is judged
"""

from uss import telegram
from uss.master import Master
from uss.receiver import COMING
from uss.timing import Timing, characters_us

MASK = (1 << 30) - 1
POLLED_RESOLUTION_US = 5_000  # as hal.link.rs485 has it
TIMING = Timing(19200)


def sealed(net, address=1):
    """The telegram with these net data, as bytes."""
    buffer = bytearray(telegram.SIZE_MAX)
    buffer[telegram.NET : telegram.NET + len(net)] = net
    return bytes(buffer[: telegram.seal(buffer, address, len(net))])


def of_words(words, address=1):
    """The telegram with these net data words."""
    net = bytearray(2 * len(words))
    for index, word in enumerate(words):
        telegram.put_word(net, 2 * index, word)
    return sealed(net, address)


def words_of(characters):
    """The net data words of a telegram."""
    return [telegram.get_word(characters, at) for at in range(3, len(characters) - 1, 2)]


class Line:
    """The link of a master, and the time that passes for it.

    polled: a link without interrupts, which hands over what is complete when it is looked at.
    answer: may be replaced at any time. requests: the characters of all that was sent; asked: of
    the one that was last handed to `answer`.
    """

    def __init__(self, answer=None, timing=TIMING, polled=False, **options):
        self.interrupts = not polled
        self.resolution_us = POLLED_RESOLUTION_US if polled else 0
        self.answer = answer
        self.requests = []
        self.asked = None
        self.now = 0
        self.on_activity = None
        self.sent_at = 0
        self.received_at = 0
        self._timing = timing
        self._sending_until = None
        self._coming = []  # (begin, end, characters) of each burst, the next one first
        self.master = Master(self, timing, MASK, **options)

    # --- the link -------------------------------------------------------------------------------

    def send(self, buffer, count):
        self.requests.append(bytes(buffer[:count]))
        self._coming = []
        self._sending_until = self.now + characters_us(self._timing.baud, count)

    def sending_us(self, now):
        if self._sending_until is None:
            return 0
        if self.now < self._sending_until:
            return self._sending_until - self.now
        self.sent_at = self._sending_until & MASK
        self.asked = self.requests[-1]
        self.hear(self._sending_until, self.answer and self.answer(self.asked))
        self._sending_until = None
        return 0

    def receive(self, buffer, at):
        if not self._coming:
            return 0
        begins_at, ends_at, characters = self._coming[0]
        if not self.interrupts:
            return self._receive_polled(buffer, at)
        if self.now < ends_at:
            return COMING if self.now >= begins_at + self._timing.character_us else 0
        self._coming.pop(0)
        count = min(len(characters), len(buffer) - at)
        buffer[at : at + count] = characters[:count]
        self.received_at = ends_at & MASK
        return count

    def _receive_polled(self, buffer, at):
        first = at
        while self._coming and at < len(buffer):
            begins_at, ends_at, characters = self._coming.pop(0)
            here = (self.now - begins_at) // self._timing.character_us
            if self.now >= ends_at:
                here = len(characters)
            here = min(max(here, 0), len(buffer) - at)
            buffer[at : at + here] = characters[:here]
            at += here
            if here < len(characters):
                begins_at += here * self._timing.character_us
                self._coming.insert(0, (begins_at, ends_at, characters[here:]))
                break
        self.received_at = self.now & MASK
        return at - first

    def hear(self, since, pieces):
        if pieces is None:
            return
        if not isinstance(pieces, list):
            pieces = [(3 * self._timing.character_us, pieces)]
        for pause_us, characters in pieces:
            begins_at = since + pause_us
            since = begins_at + characters_us(self._timing.baud, len(characters))
            self._coming.append((begins_at, since, bytes(characters)))

    # --- time -----------------------------------------------------------------------------------

    def step(self):
        """The master does what is due; then it is when something is due again, or comes."""
        self.master.refresh(self.now & MASK)
        wait_us = self.master.poll(self.now & MASK)
        assert wait_us >= 1
        until = self.now + min(wait_us, 5_000)
        if self._sending_until is not None:
            until = min(until, self._sending_until)
        if self._coming and self.interrupts:
            until = min(until, max(self._coming[0][1], self.now))
        self.now = max(until, self.now + 1)

    def run(self, us):
        """Let so much time pass."""
        until = self.now + us
        while self.now < until:
            self.step()

    def exchange(self, count=1):
        """Go on until `count` more replies have been judged, or given up.

        The request after that may be on the line already, but is not answered yet.
        """
        while not self.requests:
            self.step()
        for _ in range(count):
            progress = self.master.progress
            while self.master.progress == progress:
                self.step()
