# SPDX-License-Identifier: MIT
"""How the world's time follows real time, at every speed, and on a machine that is too slow."""

from conversation_bench import FRAME_MS, Talk, Time
from tools.live.pace import WORK_MS, Pace, RealPace


class Clock:
    now_us = 0


class Keys:
    """A world of nothing but keys, and whoever holds them."""

    def __init__(self):
        self.clock = Clock()
        self.hand = self
        self.vanished = 0

    def step(self, now_ms):
        pass

    def vanish(self):
        self.vanished += 1


def test_a_tap_is_seen_at_every_speed():
    for speed in (1, 10, 100):
        talk = Talk(speed)
        talk.ready()
        talk.tap("START")
        talk.wait(200 + 2000 // speed)
        assert talk.state() == "running", speed
        talk.tap("STOP")
        talk.wait(200 + 8000 // speed)
        assert talk.state() == "ready", speed


class Machine(Keys):
    """A world of keys on a machine that takes so much real time for a millisecond of it."""

    def __init__(self, time, ms_us):
        super().__init__()
        self.time = time
        self.ms_us = ms_us

    def run(self, ms):
        self.clock.now_us += ms * 1000
        self.time.us += ms * self.ms_us


def test_the_world_follows_real_time():
    for speed in (1, 7, 100):
        time = Time()
        world = Machine(time, 5)
        pace = Pace(world.clock, world, speed, time)
        for _ in range(150):
            time.us += FRAME_MS * 1000
            pace.follow()
        passed_us = time.us - Time().us
        assert abs(world.clock.now_us - passed_us * speed) <= 40_000 * speed, speed
        assert abs(pace.speed - speed) < 0.05 * speed and not pace.late
        assert 0 <= passed_us - pace.now_ms * 1000 < 30_000


def test_a_machine_that_is_too_slow_falls_behind_and_says_so():
    time = Time()
    world = Machine(time, 5_000)
    pace = Pace(world.clock, world, 1, time)
    for _ in range(100):
        before_us = time.us
        pace.follow()
        assert time.us - before_us <= 2 * WORK_MS * 1000  # the keys are looked at again
        time.us += 1000
    assert pace.late and 0.1 < pace.speed < 0.25


def test_a_program_that_stood_still_has_let_go_of_all_keys():
    class Stalling(Keys):
        def run(self, ms):
            self.clock.now_us += ms * 1000

    keys = Stalling()
    pace = RealPace(keys.clock, keys)
    pace.follow()
    assert not keys.vanished
    keys.clock.now_us += 310_000
    pace.follow()
    assert keys.vanished == 1
