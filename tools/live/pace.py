# SPDX-License-Identifier: MIT
"""How the world's time follows real time.

pace = Pace(world.clock, session, 1, time)      # or RealPace, on a real line
pace.follow()                                   # every few milliseconds of real time
"""

FRAME_MS = 20
SLICE_MS = 10  # of the world's time, between two movements of the hand
WORK_MS = 60  # for the world at a time, before the keys are looked at again
SPEED_MS = 1_000  # the speed shown is the mean of so long
UNHEARD_MS = 300  # after so long without input a front end counts as having let go of all keys


class Pace:
    """Lets the world's time follow real time, so many times as fast.

    clock: of the world. session: has a `hand`, and `run` for the world. time: has ticks_us and
    ticks_diff. now_ms: real time since the beginning. wanted: the speed that it should have; 0:
    time stands. speed: the true one. late: the machine is too slow. It drops the time that it does
    not manage, and never makes up for it.
    """

    def __init__(self, clock, session, wanted, time):
        self.now_ms = 0
        self.speed = self.wanted = wanted
        self.late = False
        self._clock = clock
        self._run = session.run
        self._hand = session.hand
        self._ticks_us = time.ticks_us
        self._ticks_diff = time.ticks_diff
        self._seen_us = time.ticks_us()
        self._rest_us = 0  # real time that is no whole millisecond yet
        self._owed_us = 0  # of the world's time
        self._measured_ms = 0
        self._measured_us = clock.now_us

    def follow(self):
        """Let as much time pass in the world as has really passed since the last call."""
        clock = self._clock
        began_us = self._ticks_us()
        real_us = self._ticks_diff(began_us, self._seen_us)
        self._seen_us = began_us
        self._rest_us += real_us
        self.now_ms += self._rest_us // 1000
        self._rest_us %= 1000
        self._owed_us += min(real_us, 2 * WORK_MS * 1000) * self.wanted
        self._hand.step(self.now_ms)
        self.late = False
        while self._owed_us >= SLICE_MS * 1000:
            if self._ticks_diff(self._ticks_us(), began_us) >= WORK_MS * 1000:
                self.late = True
                self._owed_us = 0
                break
            before_us = clock.now_us
            self._run(SLICE_MS)
            self._owed_us -= clock.now_us - before_us
            self._hand.step(self.now_ms)
        self._measure()

    def want(self, speed):
        """From now on time passes so many times as fast."""
        self.wanted = self.speed = speed
        self._owed_us = 0
        self._measure_anew()

    def _measure(self):
        passed_ms = self.now_ms - self._measured_ms
        if passed_ms >= SPEED_MS:
            world_us = self._clock.now_us
            self.speed = (world_us - self._measured_us) / (passed_ms * 1000)
            self._measure_anew()

    def _measure_anew(self):
        self._measured_ms = self.now_ms
        self._measured_us = self._clock.now_us


class RealPace:
    """As `Pace`, for a world whose time is the real one: it just waits.

    A program that stood still heard no keys meanwhile, so the hand lets go of everything.
    """

    late = True  # nothing else waits
    speed = wanted = 1.0

    def __init__(self, clock, session):
        self._clock = clock
        self._run = session.run
        self._hand = session.hand
        self._heard_ms = self.now_ms

    @property
    def now_ms(self):
        return self._clock.now_us // 1000

    def want(self, speed):
        """Time passes as it does."""

    def follow(self):
        for _ in range(FRAME_MS // SLICE_MS):
            if self.now_ms - self._heard_ms >= UNHEARD_MS:
                self._hand.vanish()
            self._heard_ms = self.now_ms
            self._hand.step(self.now_ms)
            self._run(SLICE_MS)
