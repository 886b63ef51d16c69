# SPDX-License-Identifier: MIT
"""A PLC program whose inputs change at random, on a line and drives that fail at random.

What is checked is read off the motors: none starts but by an edge of RUN that was given just
before and is still on, and each is standing when RUN has been off, or the program has hung, for so
long as its ramp takes.
"""

from plc_bench import Plc

SEEDS = (1, 2, 3, 4, 5, 6)
STEPS = 150
SOON_MS = 1_100  # from the edge of RUN to the start: a drive counts as lost after a second
ON_THE_WAY_MS = 40  # a telegram with ON is sent to its end, whatever happens meanwhile
STANDS_AFTER_MS = 300 + 1_000 + 500  # dead man, the longest ramp, the way to the drive
STARTED = ("running", "stopping")
SETPOINTS = (0.0, 10.0, -35.0, 100.0, 200.0, -200.0, 250.0)


class Program:
    """One world. In it the clock of `calm_since` tells since when a motor has to stop."""

    def __init__(self, seed):
        print("seed", seed)
        self._state = seed * 0x9E3779 + 1
        self.plc = Plc((1, 2), paced=seed % 2 == 0)
        self.edge_ms = {1: None, 2: None}
        self.calm_since_ms = {1: 0, 2: 0}
        self.wanted_ms = {1: 0, 2: 0}
        self.starts = {1: 0, 2: 0}

    def random(self, low, high):
        state = self._state
        state ^= (state << 7) & 0x3FFFFFFF
        state ^= state >> 9
        state ^= (state << 8) & 0x3FFFFFFF
        self._state = state
        return low + state % (high - low + 1)

    def now_ms(self):
        return self.plc.clock.now_us // 1000

    def act(self):
        plc = self.plc
        address = self.random(1, 2)
        inputs, drive = plc.motor(address), plc.drive(address)
        roll = self.random(0, 99)
        if roll < 20:  # somebody puts everything in order
            inputs.OFF2 = inputs.OFF3 = False
            inputs.EN = True
            inputs.F_ACK = not inputs.F_ACK
            drive.plug()
        elif roll < 55:
            inputs.RUN = not inputs.RUN
            if inputs.RUN:
                self.edge_ms[address] = self.now_ms()
        elif roll < 62:
            inputs.SPEED_SP = SETPOINTS[self.random(0, len(SETPOINTS) - 1)]
        elif roll < 67:
            inputs.DIR = not inputs.DIR
        elif roll < 71:
            inputs.OFF2 = not inputs.OFF2
        elif roll < 75:
            inputs.OFF3 = not inputs.OFF3
        elif roll < 80:
            inputs.F_ACK = not inputs.F_ACK
        elif roll < 84:
            drive.fault(1)
        elif roll < 88:
            drive.unplug()
        elif roll < 94:
            drive.plug()
        elif roll < 97:
            inputs.EN = not inputs.EN
        else:
            plc.hang(self.random(1, 600))

    def watch(self):
        now_ms = self.now_ms()
        for address, drive in self.plc.drives.items():
            inputs = self.plc.motor(address)
            wants = inputs.RUN and inputs.EN and not inputs.OFF2 and not inputs.OFF3
            if wants:
                self.wanted_ms[address] = now_ms
            if drive.starts != self.starts[address]:
                self.starts[address] = drive.starts
                late_ms = now_ms - self.wanted_ms[address]
                assert late_ms <= ON_THE_WAY_MS, (address, now_ms, late_ms)
                edge_ms = self.edge_ms[address]
                assert edge_ms is not None and now_ms - edge_ms <= SOON_MS, (now_ms, edge_ms)
            if wants or not drive.plugged:
                self.calm_since_ms[address] = now_ms
            elif now_ms - self.calm_since_ms[address] > STANDS_AFTER_MS:
                assert drive.state not in STARTED, (now_ms, drive.report())

    def run(self):
        for _ in range(STEPS):
            self.act()
            for _ in range(self.random(1, 20)):
                self.plc.run(20)
                self.watch()
        self.plc.check()
        return sum(self.starts.values())


def test_nothing_starts_by_surprise_and_everything_stops():
    starts = [Program(seed).run() for seed in SEEDS]
    print("starts:", starts)
    assert sum(starts) > 30
