# SPDX-License-Identifier: MIT
"""What the tests of parameter tasks share: their words, and a channel whose drive a test plays.

In use:

    line = Line()
    job = line.ask(pkw.read(700))
    line.send()                             # the PKW words of the next request
    line.answer(0x12BC, 0, 0, 5)            # those of the reply
"""

from uss import pkw
from uss.channel import Channel

MASK = (1 << 30) - 1
THREE, FOUR, VARIABLE = pkw.THREE_WORDS, pkw.FOUR_WORDS, pkw.VARIABLE_LENGTH | 20


def characters(*words):
    """Words as they travel."""
    return bytes([character for word in words for character in (word >> 8, word & 0xFF)])


def text_words(text):
    """The words of a text."""
    codes = [ord(character) for character in text]
    return [codes[at] << 8 | codes[at + 1] for at in range(0, len(codes), 2)]


def answered(job, words, form=FOUR):
    """Whether these PKW words of a reply end the job."""
    net = characters(*words)
    return job.answer(net, 0, len(net), form)


def asked(job):
    """The four words of the job."""
    return tuple(job.words[at] << 8 | job.words[at + 1] for at in range(0, 8, 2))


def refused(error, act, *arguments):
    try:
        act(*arguments)
    except error:
        return True
    return False


class AskedDrive:
    """A drive, and its channel, as far as somebody asks it. It answers when it is told to."""

    contact = tells_status = True
    full = False
    zsw = 0

    def __init__(self):
        self.channel = self
        self.asked = []

    def is_full(self):
        return self.full

    def ask(self, job):
        job.state = pkw.PENDING
        self.asked.append(job)

    def answer(self, low=0, state=pkw.DONE):
        """The last one that was asked."""
        self.asked[-1].low = low
        self.asked[-1].state = state

    def numbers(self):
        return [job.number for job in self.asked]


class Line:
    """A channel and the telegrams that go to and fro."""

    def __init__(self, pkw_words=4, longest=20):
        self.channel = Channel(MASK, pkw_words, longest)
        self.now = 0
        self.sent = []  # PKW words of each request
        self.losses = 0  # telegrams in a row that were not answered
        self._size = 0  # of the PKW words, when they were written last

    def send(self, us=10_000):
        """The PKW words of the next request."""
        self.now += us
        net = bytearray(260)
        if not self.channel.idle:
            self._size = self.channel.fill(net, 3, self.now)
        size = self._size
        words = tuple(net[at] << 8 | net[at + 1] for at in range(3, 3 + size, 2))
        assert net[3 + size :] == bytes(len(net) - 3 - size)
        self.sent.append(words)
        return words

    def answer(self, *words):
        """A reply comes."""
        net = characters(*words)
        if not self.channel.idle:
            self.channel.take(b"\x02\x00\x05" + net, 3, len(net))
        self.losses = 0

    def miss(self):
        """None comes."""
        self.losses += 1
        self.channel.miss(self.now, self.losses)

    def ask(self, job):
        self.channel.ask(job)
        return job
