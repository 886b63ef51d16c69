# SPDX-License-Identifier: MIT
"""A command of tools/ at the serial port of an emulated Pico: tools/deploy, tools/settings.

    status, said = at_port(world, "deploy", "--dry-run")

The command is a process of its own; meanwhile the world's time goes on. A chip that only waits
for the command runs far ahead of it, for nothing: so the world stands until the command has said
that it begins, and rests while the chip sleeps.
"""

import os
import time

from tools.emulator.world import temporary

SILENT_S = 100  # of the host: a command that says nothing for so long hangs
STEP_MS = 10
ASLEEP_US = 1_000  # of the host, for a step; a chip that works takes more
REST_MS = 1
SPEAK_FIRST = ("deploy", "settings")  # before they do anything at the port; deploy compiles first


def read(path):
    try:
        with open(path) as file:
            return file.read()
    except OSError:
        return ""


class AtPort:
    """The command at work; `said` is what it has printed so far."""

    def __init__(self, world, command, *arguments):
        self.world = world
        self.said = ""
        self._output = temporary()
        world.tell("S", 1)
        os.system(
            "{ ./tools/%s --port $USS_PICO_SERIAL %s; echo EXIT $?; } >%s 2>&1 </dev/null &"
            % (command, " ".join(arguments), self._output)
        )
        if command in SPEAK_FIRST:
            self._until(lambda: self.said, time.sleep_ms, 10 * REST_MS)

    def goes_on_until(self, condition):
        self._until(condition, self._step)

    def _until(self, condition, act, *arguments):
        heard = time.time()
        while not condition():
            act(*arguments)
            said = read(self._output)
            if said != self.said:
                self.said, heard = said, time.time()
            assert time.time() - heard < SILENT_S, said

    def _step(self):
        began = time.ticks_us()
        self.world.run(STEP_MS)
        if time.ticks_diff(time.ticks_us(), began) < ASLEEP_US:
            time.sleep_ms(REST_MS)

    def ends(self):
        """Its exit status and what it said."""
        self.goes_on_until(lambda: "EXIT " in self.said)
        said, _, status = self.said.rpartition("EXIT ")
        os.remove(self._output)
        self.world.tell("S", 0)
        return int(status), said


def at_port(world, command, *arguments):
    return AtPort(world, command, *arguments).ends()


def ready(world):
    """A person waits for the panel. A drive that heard nothing meanwhile has tripped: STOP."""
    up = ("READY", "F0072")
    assert world.run_until(lambda: any(map(world.reads, up)), 15_000), world.lcd()
    if world.reads("F0072"):
        world.run(1_500)
        world.press("STOP")
    assert world.run_until(lambda: world.reads("READY"), 5_000), world.lcd()


def start(world):
    """A motor that turns already is left alone."""
    if world.drives[1].hz() > 1:
        return
    ready(world)
    world.press("START")
    assert world.run_until(lambda: world.reads("RUNNING"), 5_000), world.lcd()
    world.run(1_000)
    assert world.drives[1].hz() > 1
