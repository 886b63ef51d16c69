# SPDX-License-Identifier: MIT
"""The panel speaks its language (README.md) on standard input and output, a line a message.

    speak(world, speed=1)               # until standard input ends

Neither a front end that does not read holds the panel up, nor one that talks without end.
"""

import select
import sys
import time

from tools.live.conversation import Conversation
from tools.live.language import LINE_MAX

WAIT_MS = 5  # for something to come, while nothing else is to be done
READ_MAX = 4_000  # characters at a time, before the panel goes on
PIECE_MAX = 4_096  # so much goes into a pipe that says it has room: PIPE_BUF
WAITING_MAX = 65_536  # characters that wait for the reader; more answers are dropped
TOO_LONG = " " * (LINE_MAX + 1)  # stands for a line whose beginning was not kept


def speak(world, speed, said=()):
    """said: lines for people, about the world."""
    conversation = Conversation(world, speed, time, said)
    ears, mouth = Ears(), Mouth()
    while not ears.ended:
        for line in ears.listen(WAIT_MS):
            conversation.take(line)
        conversation.follow()
        for answer in conversation.answers():
            mouth.say(answer)
        if mouth.is_free():
            if mouth.has_missed:
                mouth.has_missed = False
                conversation.forget()
            for line in conversation.news():
                mouth.say(line)
        else:
            mouth.has_missed = True
        mouth.flush()
    conversation.end()


class Ears:
    """Standard input. ended: there will be nothing more."""

    def __init__(self):
        self.ended = False
        self._line = bytearray()
        self._is_long = False
        self._poller = select.poll()
        self._poller.register(sys.stdin, select.POLLIN)

    def listen(self, wait_ms):
        """The lines that are complete; waits so long for the first character."""
        lines = []
        for _ in range(READ_MAX):
            if not self._poller.poll(wait_ms):
                break
            wait_ms = 0
            try:
                character = sys.stdin.buffer.read(1)
            except OSError:
                character = b""
            if not character:
                self.ended = True
                break
            if character == b"\n":
                lines.append(self._taken())
            elif len(self._line) <= LINE_MAX:
                self._line += character
        return lines

    def _taken(self):
        line = bytes(self._line)
        self._line = bytearray()
        try:
            return line.decode()
        except UnicodeError:
            return "\x00"  # which is no JSON either


class Mouth:
    """Standard output, which is written to only while it takes something. has_missed: something
    was not said, because nobody read."""

    def __init__(self):
        self.has_missed = False
        self._waiting = bytearray()
        self._poller = select.poll()
        self._poller.register(sys.stdout, select.POLLOUT)

    def is_free(self):
        """Whether all that was said has gone."""
        self.flush()
        return not self._waiting

    def say(self, line):
        if len(self._waiting) + len(line) <= WAITING_MAX:
            self._waiting += line

    def flush(self):
        while self._waiting and self._has_room():
            piece = bytes(self._waiting[:PIECE_MAX])
            try:
                count = sys.stdout.buffer.write(piece)
            except OSError:  # the reader has gone: standard input ends, too
                count = len(self._waiting)
            self._waiting = self._waiting[count or 0 :]

    def _has_room(self):
        return any(event & select.POLLOUT for _, event in self._poller.poll(0))
