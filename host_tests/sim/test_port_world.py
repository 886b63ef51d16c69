# SPDX-License-Identifier: MIT
"""The panel on a real line, in virtual time: its port leads to a line of simulated drives.

The two have clocks of their own, as two computers have. An adapter may keep characters back.
"""

import main
from boards.port.clock import RealClock
from boards.port.line import PtyMaster
from boards.port.world import PortWorld
from boards.sim.clock import Clock, Event
from boards.sim.drives.drive import Drive
from boards.sim.line.wire import Wire

STEP_US = 250  # of the machine, for one look at the clock


class Adapter:
    """A port, and drives behind it; what comes is kept back for so long."""

    name = "/dev/ttyUSB0"

    def __init__(self, addresses=(1,), late_us=0):
        self.clock = Clock()
        self.wire = Wire(self.clock, 19200)
        self.drives = {}
        for address in addresses:
            supervised = {2014: 2000}
            self.drives[address] = Drive(self.clock, self.wire, address, supervised)
        self.is_cut = False
        self.notices = []
        self._late_us = late_us
        self._master = PtyMaster(self.wire, self._keep)
        self._ready = b""

    def true_us(self):
        return self.clock.now_us

    def wait(self, ms):
        self.clock.advance(1000 * ms if not self._ready else STEP_US)

    def read(self, count):
        came, self._ready = self._ready[:count], self._ready[count:]
        return came or None

    def write(self, data):
        if not self.is_cut:
            self._master.received(data)

    def _keep(self, data):
        def hand_over():
            if not self.is_cut:
                self._ready += data

        self.clock.schedule(Event(hand_over), self.clock.now_us + self._late_us)


def panel(adapter, *addresses, **settings):
    settings.setdefault("reply_timeout_ms", 60)
    clock = RealClock(adapter.true_us)
    return PortWorld(main.start, adapter, addresses or (1,), 19200, clock, settings)


def test_start_turns_the_motor_and_stop_stops_it():
    adapter = Adapter()
    world = panel(adapter)
    world.run(1500)
    world.press("START")
    world.run(2500)
    assert world.lcd() == ("S: 10.0 F: 10.00", "RUNNING      A1 ")
    assert adapter.drives[1].state == "running"
    world.press("STOP")
    world.run(3000)
    assert adapter.drives[1].state == "ready" and adapter.drives[1].starts == 1
    world.check()
    assert adapter.drives[1].read(2025) == 0


def test_two_drives_are_asked_in_turn_without_needless_waiting():
    adapter = Adapter((3, 7))
    world = panel(adapter, 3, 7)
    world.run(2000)
    exchanges = sum(drive.read(2024) for drive in adapter.drives.values())
    assert exchanges > 70, exchanges  # of 88 that the line has room for
    asked = world.wire.log.last(40)
    assert {characters[2] for _, from_panel, characters in asked if from_panel} == {3, 7}
    assert all(len(characters) == 16 for _, _, characters in asked)


def test_an_adapter_that_keeps_characters_back_is_waited_for():
    adapter = Adapter(late_us=25_000)
    world = panel(adapter)
    world.run(2500)
    assert world.reads("READY")
    assert world.app.bus.turns.drives[0].contact


def test_whoever_leaves_stops_the_drives_first():
    adapter = Adapter((1, 2))
    world = panel(adapter, 1, 2, 9)
    world.run(1500)
    world.press("START")
    world.run(1500)
    assert adapter.drives[1].state == "running"
    world.close()
    assert adapter.drives[1].state == "stopping"
    assert world.unconfirmed() == [9]
    sent = adapter.drives[1].read(2024)
    world.close()
    assert adapter.drives[1].read(2024) == sent


def test_a_port_that_has_gone_is_a_line_that_is_cut():
    adapter = Adapter()
    world = panel(adapter)
    world.run(1500)
    assert world.place == "/dev/ttyUSB0"
    adapter.is_cut = True
    adapter.notices.append("it has gone")
    world.run(1500)  # less than P2014
    assert world.reads("NO CONTACT")
    assert world.place == "/dev/ttyUSB0 (LINE CUT)" and world.notices == ["it has gone"]
    adapter.is_cut = False
    world.run(2000)
    assert world.reads("READY")


def test_a_panel_that_was_held_up_restarts_and_starts_nothing():
    adapter = Adapter()
    world = panel(adapter)
    world.run(1500)
    world.press("START")
    world.run(1500)
    world.hang(5000)
    world.run(1500)
    assert world.resets == 1 and not world.app.panel.any_runs()
    assert adapter.drives[1].starts == 1 and adapter.drives[1].state != "running"


def test_the_drives_of_a_real_line_cannot_be_commanded():
    world = panel(Adapter())
    for command in ("drive", "param", "fault", "clear", "warn", "load", "supply", "plug", "line"):
        assert "no drive is simulated here" in world.refused[command], command
    assert "dip" in world.refused and "press" not in world.refused
    assert not world.drives
