# SPDX-License-Identifier: MIT
"""A USS master on a serial port: it asks, and waits for the answer.

Everything is 8E1, but on a pseudo terminal, which refuses a parity and needs none. A reply is
waited for much longer than the 20 ms of the specification: the other end may be a program on a
busy machine. When it was sent, nobody can tell here; that is tried in virtual time.

    master = Master("/dev/pts/4")
    drive = Node(master, 1, pkw_words=4, pzd_words=2)
    drive.control(0x047E)               # [0xFB31, 0x0000]: the PZD words of the reply
    drive.task(1, 700)                  # (1, [5]): reply id 1, one word
"""

import os
import time

import serial

from conformance.telegrams import MIRROR, framed, missing, words_of

REPLY_S = 5.0  # and a telegram has to be complete by then
SILENCE_S = 0.022  # nobody answers later than 20 ms
RESIDUAL_S = 0.25  # the longest residual time, of 252 net characters, from 19200 baud on
VARIABLE = 127  # PKW words: as many as a task needs

# AK of replies: with a value of two words (3, a description element, may have them), and without.
DOUBLE_WORDS = (2, 3, 5)
NO_RIGHTS = 8

# The bits of IND that carry the page of 2000 numbers, those of weight 1, 2, 4 ... in their order.
PAGE_BITS = (0x8000, 0x1000, 0x2000, 0x4000, 0x0400, 0x0800)


class NoReply(Exception):
    """A reply did not begin, or did not end, in REPLY_S."""


class Master:
    """port: a path. baud: bits a second, of no consequence on a pseudo terminal. caught_up():
    returns when the other end has read all that was sent, if somebody can tell; so a slow machine
    is not taken for silence, and two telegrams do not meet in the other end's queue.
    """

    def __init__(self, port, baud=19200, caught_up=lambda: None):
        on_a_pty = os.path.realpath(port).startswith("/dev/pts/")
        parity = serial.PARITY_NONE if on_a_pty else serial.PARITY_EVEN
        self._serial = serial.Serial(port, baud, parity=parity, timeout=REPLY_S)
        self._caught_up = caught_up
        self._character_s = 11 / baud

    def close(self):
        self._serial.close()

    def send(self, characters):
        """A request, after a pause of twice the start interval."""
        time.sleep(4 * self._character_s)
        self._serial.reset_input_buffer()
        self._serial.write(characters)
        self._serial.flush()

    def ask(self, characters):
        """The characters of the reply to these. NoReply: none, or not a whole one."""
        self.send(characters)
        deadline = time.monotonic() + REPLY_S
        reply = b""
        while lacking := missing(reply):
            reply += self._serial.read(lacking)
            if time.monotonic() > deadline:
                raise NoReply("%s was answered by %r" % (characters.hex(" "), reply.hex(" ")))
        return reply

    def is_silent(self, *requests):
        """Whether nobody says a word after any of these."""
        for characters in requests:
            self.send(characters)
            self.wait(SILENCE_S + 3 * len(characters) * self._character_s)
            if self._serial.in_waiting:
                return False
        return True

    def settle(self):
        """Wait until the beginning of a telegram, of any length, has been given up."""
        self.wait(RESIDUAL_S)

    def wait(self, seconds):
        """Let time pass at the other end, from when it has heard everything."""
        self._caught_up()
        time.sleep(seconds)
        self._caught_up()


class Node:
    """A drive with `pkw_words` (0, 3, 4 or VARIABLE) and `pzd_words`.

    pzd     the process data that go out with everything; PZD1 is the control word
    zsw     the status word that came last
    """

    def __init__(self, master, address, pkw_words=4, pzd_words=2):
        self.master = master
        self.address = address
        self.pkw_words = pkw_words
        self.pzd_words = pzd_words
        self.pzd = [0x047E] + [0] * (pzd_words - 1) if pzd_words else []
        self.zsw = None

    def exchange(self, pkw):
        """PKW and PZD words of the reply to one telegram with these PKW words."""
        request = framed(self.address, list(pkw) + self.pzd)
        words = words_of(self.master.ask(request), self.address)
        count = len(words) - self.pzd_words
        if self.pkw_words != VARIABLE and count != self.pkw_words:
            raise ValueError("%d PKW words were agreed, %d came" % (self.pkw_words, count))
        if self.pzd_words:
            self.zsw = words[count]
        return words[:count], words[count:]

    def control(self, *pzd):
        """Send these PZD words, the others as before, and return those of the reply."""
        self.pzd[: len(pzd)] = pzd
        return self.exchange(self.no_task())[1]

    def no_task(self):
        return [0] * (self.pkw_words if self.pkw_words != VARIABLE else 3)

    def task(self, ak, number, index=0, values=()):
        """Carry out a parameter task: AK of the reply and its value words, without filling.

        The task is repeated until its number comes back, then withdrawn: the reply of the one
        before, or none, may come first (C-4.2.1.1).
        """
        request = self.request(ak, number, index, values)
        deadline = time.monotonic() + REPLY_S
        while True:
            pkw, _ = self.exchange(request)
            if pkw[0] >> 12 and (pkw[0] & 0x7FF, pkw[1]) == (request[0] & 0x7FF, request[1]):
                break
            if time.monotonic() > deadline:
                raise NoReply("task %d of %d" % (ak, number))
        self.exchange(self.no_task())
        return pkw[0] >> 12, self._values(pkw)

    def request(self, ak, number, index=0, values=()):
        """The PKW words of a task, the value where the length of the area wants it."""
        values = list(values)
        if self.pkw_words == 3:
            values = values[:1]  # there is no room for more
        elif self.pkw_words == 4:
            values = [0] * (2 - len(values)) + values
        return [ak << 12 | number % 2000, page_bits(number // 2000) | index] + (values or [0])

    def _values(self, pkw):
        values = pkw[2:]
        if pkw[0] >> 12 == NO_RIGHTS:
            return []
        if self.pkw_words == 4 and pkw[0] >> 12 not in DOUBLE_WORDS:
            if values[0]:
                raise ValueError("a word has its place in PWE2: %r" % pkw)
            return values[1:]
        return values

    def is_mirror(self, pkw):
        """Whether a mirror telegram with these PKW words comes back unchanged."""
        request = framed(self.address | MIRROR, list(pkw) + self.pzd)
        return self.master.ask(request) == request


def page_bits(page):
    return sum([bit for place, bit in enumerate(PAGE_BITS) if page >> place & 1])
