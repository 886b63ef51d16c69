# SPDX-License-Identifier: MIT
"""A program that does anything at any time: no motor starts but by a run() that says it did.

A failure names its seed; `play(seed, paced)` repeats it.
"""

from bus_bench import Bench
from uss import pzd
from uss.bus import UssError

SEEDS = range(1, 9)
STEPS = 60


class Program:
    """Bad luck and a nervous programmer, on two drives."""

    def __init__(self, seed, paced):
        self.bench = Bench((1, 2), paced=paced, seed=seed)
        self.started = [0, 0]  # how often each motor was started by a run() or jog
        self.random = self.bench.random

    def step(self):
        index = self.random(0, 1)
        drive = self.bench.bus.drives[index]
        motor = self.bench.motor(index + 1)
        action = self.ACTIONS[self.random(0, len(self.ACTIONS) - 1)]
        action(self, drive, motor)
        self.watch()

    def watch(self):
        """Whoever starts outside of run() and jog is caught here."""
        for index in range(2):
            motor = self.bench.motor(index + 1)
            assert motor.starts <= self.started[index], motor.report()

    def run(self, drive, motor):
        before = motor.starts
        try:
            if self.random(0, 3):
                drive.run(self.random(-4000, 4000) / 100)
            else:
                drive.jog_left()
        except UssError:
            self.watch_for(0.3)
            assert not drive.is_on() or drive.is_running
        else:
            assert drive.is_running and drive.is_on()
        if motor.starts > before:  # also one that was lost before it could say so
            self.started[drive.address - 1] = motor.starts

    def stop(self, drive, motor):
        (drive.stop, drive.off2, drive.off3, self.bench.bus.stop_all)[self.random(0, 3)]()
        self.watch_for(0.2)
        if drive.contact and motor.plugged:
            word = self.bench.stws(drive.address)[-1]
            assert not word & pzd.STW_RUN, "%04X" % word

    def acknowledge(self, drive, motor):
        drive.acknowledge()

    def pull_or_push(self, drive, motor):
        if motor.plugged:
            motor.unplug()
        else:
            motor.plug()

    def trip(self, drive, motor):
        if self.random(0, 1):
            motor.fault(1)

    def hang(self, drive, motor):
        self.bench.clock.advance(self.random(1, 900) * 1000)

    def go_on(self, drive, motor):
        self.watch_for(self.random(1, 300) / 100)

    def leave_the_line(self, drive, motor):
        if not self.random(0, 4):
            self.bench.bus.off()
            self.watch_for(self.random(1, 100) / 100)
            self.bench.bus.on()

    def look(self, drive, motor):
        try:
            assert -51 < drive.hertz < 51 and drive.fault >= 0 and drive.read(700) == 5
        except UssError:
            assert not motor.plugged or drive.silent or self.bench.bus.is_silent()

    def watch_for(self, seconds):
        self.bench.bus.wait(seconds)
        self.watch()

    ACTIONS = (
        run, run, run, stop, acknowledge, pull_or_push, trip, hang, go_on, go_on, leave_the_line,
        look,
    )  # fmt: skip


def play(seed, paced):
    program = Program(seed, paced)
    try:
        for _ in range(STEPS):
            program.step()
        program.bench.end()
    except BaseException:
        print("seed %d, paced %r" % (seed, paced))
        raise
    return sum(program.started)


def test_no_motor_starts_but_by_run_when_the_loop_polls():
    assert sum(play(seed, False) for seed in SEEDS) > 20


def test_no_motor_starts_but_by_run_when_interrupts_do_it():
    assert sum(play(seed, True) for seed in SEEDS) > 20
