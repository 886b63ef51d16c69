# SPDX-License-Identifier: MIT
"""The simulated drive against a slow one: the same random commands, integrated step by step.

The drive works out what time does when somebody asks. The slow one below goes by the sentences of
the manual, a millisecond at a time, and shares no code with it. It also skips telegrams that say
nothing new; a second drive hears something new in each. A failure prints the seed.
"""

import math

from boards.sim.dice import Dice
from drive_bench import ACKNOWLEDGE, JOG_LEFT, JOG_RIGHT, OFF1, RUN, Bench, telegram

SEEDS = 8
COMMANDS = 60
STEP_S = 0.001

ON, NO_OFF2, NO_OFF3, PULSES, OUTPUT, START, SETPOINT, REVERSE = 1, 2, 4, 8, 16, 32, 64, 0x800
JOGS = 0x300

WORDS = (
    RUN, RUN, RUN, RUN | REVERSE, OFF1, OFF1, 0x047D, 0x047C, 0x047B, 0x047A, RUN & ~PULSES,
    RUN & ~OUTPUT, RUN & ~START, RUN & ~SETPOINT, JOG_RIGHT, JOG_LEFT, JOG_RIGHT | JOG_LEFT,
    OFF1 & ~PULSES, 0x007F,
)  # fmt: skip


class SlowDrive:
    """numbers: {P number: value} of ramps, limits and the like, in Hz and s; load in percent."""

    def __init__(self, numbers, load):
        self.numbers = numbers
        self.load = load
        self.hz = self.heat = 0.0
        self.state = "inhibited"
        self.quick = self.jogging = False
        self.stw = self.hsw = 0

    def command(self, stw, hsw):
        if not stw & 0x0400:
            return
        on_rises, jog_rises = stw & ~self.stw & ON, stw & ~self.stw & JOGS
        self.stw, self.hsw = stw, hsw
        one_jog = bool(stw & JOGS) and stw & JOGS != JOGS and not stw & ON
        turning = self.state in ("running", "stopping")
        if not stw & NO_OFF2:
            self.become("inhibited")
        elif not stw & NO_OFF3:
            if turning and stw & PULSES:
                self.state, self.quick = "stopping", True
            else:
                self.become("inhibited")
        elif turning and not stw & PULSES:
            was_on = self.state == "running" and stw & ON
            self.become("inhibited" if self.quick else "ready to run" if was_on else "ready")
        elif self.state == "inhibited" and not stw & ON:
            self.become("ready")
        elif self.state == "ready" and on_rises:
            self.become("running" if stw & PULSES else "ready to run")
        elif self.state == "ready" and jog_rises and one_jog and stw & PULSES:
            self.become("running")
            self.jogging = True
        elif self.state == "ready to run":
            self.become("ready" if not stw & ON else "running" if stw & PULSES else self.state)
        elif self.state == "running":
            if on_rises:
                self.jogging = False
            elif not stw & (JOGS if self.jogging else ON):
                self.state = "stopping"
        elif self.state == "stopping" and not self.quick:
            if on_rises:
                self.state, self.jogging = "running", False
            elif self.jogging and jog_rises and one_jog:
                self.state = "running"

    def become(self, state):
        if state == "running" and self.state != "running" and not self.numbers[1200]:
            self.hz = 0.0
        self.state = state
        self.quick = self.jogging = False

    def run(self, seconds):
        while seconds > 0:
            self.step(min(STEP_S, seconds))
            seconds -= STEP_S

    def step(self, seconds):
        numbers = self.numbers
        before_hz = self.hz
        turning = self.state in ("running", "stopping")
        if not turning:
            self.go(0.0, 50.0 * seconds / numbers["coast"], 0)
        elif self.state == "stopping":
            down_s = numbers[1135 if self.quick else 1061 if self.jogging else 1121]
            self.go(0.0, numbers[1082] * seconds / down_s, 0)
        elif not self.stw & OUTPUT:
            self.hz = 0.0
        elif self.stw & START and not (self.jogging and self.stw & JOGS == JOGS):
            up_s, down_s = numbers[1060 if self.jogging else 1120], numbers[1121]
            if self.jogging:
                down_s = numbers[1061]
            full_hz = numbers[1082] * seconds
            self.go(self.goal(), full_hz / down_s, full_hz / up_s)
        self.warm_up(before_hz, seconds, turning)
        if self.state == "stopping" and self.hz == 0:
            self.become("inhibited" if self.quick else "ready")

    def goal(self):
        if not self.stw & SETPOINT:
            return 0.0
        hz = (self.hsw - (self.hsw >> 15 << 16)) * 50.0 / 16384
        if self.jogging:
            hz = self.numbers[1059 if self.stw & 0x200 else 1058]
        size = max(self.numbers[1080], min(abs(hz), self.numbers[1082]))
        if self.jogging:
            return -size if self.stw & 0x200 else size
        left = (hz < 0) != bool(self.stw & REVERSE) if hz else bool(self.stw & REVERSE)
        return -size if left else size

    def go(self, goal_hz, down_hz, up_hz):
        """One step: towards 0 first if the goal is on the other side of it."""
        if self.hz * goal_hz < 0:
            goal_hz = 0.0
        step_hz = down_hz if abs(goal_hz) < abs(self.hz) else up_hz
        self.hz += max(-step_hz, min(goal_hz - self.hz, step_hz))

    def warm_up(self, before_hz, seconds, driven):
        """I squared t of a fan: half of the rated current magnetises."""
        square = 0.0
        if driven:
            torque = self.load / 100 * min(abs(self.hz) / 50.0, 1.0) ** 2
            torque += (abs(self.hz) - abs(before_hz)) / seconds / 50.0 * 0.5
            square = min(0.25 + 0.75 * torque * torque, 2.25)
        self.heat += (square - self.heat) * (1 - math.exp(-seconds / 100))


def numbers_of(roll):
    return {
        1058: roll(10, 100) / 10, 1059: roll(10, 100) / 10, 1060: roll(5, 100) / 10,
        1061: roll(5, 100) / 10, 1080: roll(0, 1) * 2.5, 1082: float(roll(30, 60)),
        1120: roll(10, 150) / 10, 1121: roll(10, 150) / 10, 1135: roll(10, 60) / 10,
        1200: roll(0, 1), "coast": roll(20, 200) / 10,
    }  # fmt: skip


def compare(seed):
    roll = Dice(seed, 1).random
    numbers = numbers_of(roll)
    load = roll(0, 90)
    parameters = {number: value for number, value in numbers.items() if number != "coast"}
    bench = Bench(parameters, switches={"overload_trips": False})
    drive = bench.drive
    drive.plant.coast_s = numbers["coast"]
    drive.load(load)
    slow = SlowDrive(numbers, load)
    behind_us = bench.clock.now_us
    said = []
    for _ in range(COMMANDS):
        stw = WORDS[roll(0, len(WORDS) - 1)]
        hsw = roll(-20_000, 20_000) & 0xFFFF
        bench.send(telegram(1, 0, 0, 0, 0, stw, hsw))
        now_us = bench.clock.now_us
        slow.run((now_us - behind_us) / 1e6)
        slow.command(stw, hsw)
        said.append("%04X %04X" % (stw, hsw))
        bench.clock.advance(roll(30_000, 3_000_000))
        behind_us = bench.clock.now_us
        slow.run((behind_us - now_us) / 1e6)
        where = "seed %d after %s: %s, slow: %s %.3f" % (
            seed, said[-4:], drive.report(), slow.state, slow.hz,
        )  # fmt: skip
        assert abs(drive.hz() - slow.hz) < 0.2, where
        # A millisecond more or less decides whether it stands already.
        assert drive.state == slow.state or abs(slow.hz) < 0.2, where
        assert abs(drive.read(34) - slow.heat * 100) < 0.5, where
    assert drive.starts > 3, "seed %d: nothing happened" % seed


def test_random_commands_end_where_a_slow_integration_ends():
    for seed in range(1, SEEDS + 1):
        compare(seed)


# --- words that stand -------------------------------------------------------------------------

PAIRS = 30
EXTERNAL = 2037 << 16 | 13  # P2106: STW2 bit 13

# What is done to a drive between two telegrams: its keypad, its cause of a fault, its mains.
DEEDS = (
    lambda drive, roll: drive.fault(roll(1, 3), lasting=roll(0, 1) == 1),
    lambda drive, roll: drive.clear_cause(),
    lambda drive, roll: drive.write(3981, 0, 1),
    lambda drive, roll: drive.write(700, 0, (2, 4, 5, 5)[roll(0, 3)]),
    lambda drive, roll: drive.write(10, 0, (0, 0, 1)[roll(0, 2)]),
    lambda drive, roll: drive.write(1121, 0, float(roll(0, 3))),
    lambda drive, roll: drive.write(1135, 0, float(roll(0, 3))),
    lambda drive, roll: drive.write(2106, 0, (0x00010000, EXTERNAL)[roll(0, 1)]),
    lambda drive, roll: drive.supply((200, 400, 400)[roll(0, 2)]),
)


def compare_words_that_stand(seed):
    """Each control word stands for some telegrams. The second drive's third word never does."""
    roll = Dice(seed, 2).random
    benches = [Bench({2012: 4, 3: 4}) for _ in range(2)]
    words = WORDS + (ACKNOWLEDGE, ACKNOWLEDGE, OFF1, RUN | 0x80)
    count = 0
    said = []
    for _ in range(COMMANDS):
        command = words[roll(0, len(words) - 1)], roll(0, 1) * 0x2000, (0, 0x2000)[roll(0, 1)]
        for _ in range(roll(1, 4)):
            count += 1
            if not roll(0, 3):
                deed, deed_seed = roll(0, len(DEEDS) - 1), roll(1, 1000)
                said.append("deed %d" % deed)
                for bench in benches:
                    DEEDS[deed](bench.drive, Dice(deed_seed, 3).random)
            stw, hsw, stw_2 = command
            said.append("%04X %04X %04X" % command)
            replies = []
            for bench, third in zip(benches, (0, count)):
                replies.append(bench.exchange(0, 0, 0, 0, stw, hsw, third, stw_2))
                bench.drive.clear_cause(85)
            where = "seed %d after %s" % (seed, said[-8:])
            assert replies[0] == replies[1], "%s: %s" % (where, replies)
            pause_us = roll(10_000, 600_000)
            for bench in benches:
                bench.clock.advance(pause_us)
        reports = [bench.drive.report() for bench in benches]
        assert reports[0] == reports[1], "%s: %s" % (where, reports)


def test_words_that_stand_lead_as_far_as_words_that_change():
    for seed in range(1, PAIRS + 1):
        compare_words_that_stand(seed)
