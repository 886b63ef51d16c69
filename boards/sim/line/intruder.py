# SPDX-License-Identifier: MIT
"""A second master on the line, where there must be only one. It talks now and then, even while
others talk.

It is a station that never listens. Its maker decides what it says.

    intruder = Intruder(clock, wire, telegram, period_us=400_000)
    intruder.begin()
    intruder.end()
"""

from boards.sim.clock import Event


class Intruder:
    """data: the telegram that it sends, the first time `period_us` after begin().

    sent   how often it has talked
    """

    name = "intruder"

    def __init__(self, clock, wire, data, period_us):
        self.sent = 0
        self._clock = clock
        self._wire = wire
        self._data = data
        self._period_us = period_us
        self._talk = Event(self._talks)
        wire.attach(self)

    def begin(self):
        self._clock.schedule(self._talk, self._clock.now_us + self._period_us)

    def end(self):
        """Stop talking, after the end of a telegram under way."""
        self._clock.cancel(self._talk)

    def hear(self, burst):
        pass

    def _talks(self):
        self._wire.talk(self, self._data, len(self._data))
        self.sent += 1
        self.begin()
