# SPDX-License-Identifier: MIT
"""Somebody presses keys at random while line and panel fail at random; nothing starts by surprise.

Each seed is a world of its own. What is checked is read off the wire, not asked of the firmware: a
telegram with ON to a drive must be covered by a START that was pressed while that drive was shown,
and by nothing since that forbids it; one with JOG by a jog key that is down, or was just now.
"""

import main
from boards.sim.board import KEYS
from boards.sim.world import World

SEEDS = range(1, 13)
SECONDS = 20

PRESSED = ("START", "START", "START", "START", "STOP", "JOG_RIGHT", "JOG_LEFT", "REVERSE") + tuple(
    KEYS[5:]  # UP, DOWN, the address keys, those of parameter mode
)
PARAMETERS = (
    (700, 5), (700, 2), (1000, 5), (1080, 5.0), (1082, 50.0), (2000, 60.0), (2009, 1), (2014, 0),
    (2014, 5000),
)  # fmt: skip
TURNS = {0x047F: "START", 0x0C7F: "START", 0x057E: "JOG_RIGHT", 0x067E: "JOG_LEFT"}
MIRROR = 0x40  # bit of ADR: the drive sends the telegram back as it came
OFF = (0x047E, 0x047A, 0x04FE, 0x04FA)  # OFF1, OFF3, each with an acknowledgement
JOG_RELEASE_US = 150_000  # debouncing, the exchange under way, a stop of another drive


class Operator:
    def __init__(self, seed):
        print("seed", seed)
        self.world = world = World(
            main.start,
            addresses=((1,), (1, 2), (3, 8, 30))[seed % 3],
            baud=(19200, 9600, 57600)[seed % 5 % 3],
            seed=seed,
            polled=seed % 4 == 0,
            ticks_start=seed * 44_444_444,
            ticks_mask=(1 << (24, 30)[seed & 1]) - 1,
        )
        # By the address on the line: parameter mode can change it.
        self.started = {address: False for address in range(32)}  # covered by a START
        self.last_answer_us = {address: 0 for address in range(32)}
        self.jogged = (None, None, 0, 0)  # address, key, from when to when it was down
        self.looked_at = 0
        world.run(1500)

    def live(self):
        while self.world.clock.now_us < SECONDS * 1_000_000:
            self.act()
            self.look()

    def act(self):
        world, roll = self.world, self.world.random(0, 99)
        drive = world.drives[sorted(world.drives)[world.random(0, len(world.drives) - 1)]]
        if roll < 70:
            self.press(PRESSED[world.random(0, len(PRESSED) - 1)], (40, 100, 700, 4200)[roll % 4])
        elif roll < 76:
            world.run(10)
            self.look()
            world.hang((100, 600, 2600)[roll % 3])
            if roll % 3:
                self.forbid()
        elif roll < 78:
            world.reset()
            self.forbid()
        elif roll < 86:
            if drive.plugged:
                drive.unplug()
            else:
                drive.plug()
        elif roll < 90:
            drive.fault(1)
        elif roll < 96:
            number, value = PARAMETERS[world.random(0, len(PARAMETERS) - 1)]
            drive.write(number, 0, value)
        world.run(world.random(20, 800))

    def press(self, key, ms):
        selected = self.world.app.panel.selected.drive.address
        if key == "START":
            self.started[selected] = True
        began_us = self.world.clock.now_us
        self.world.press(key, ms)
        if key.startswith("JOG"):
            self.jogged = (selected, key, began_us, began_us + ms * 1000 + JOG_RELEASE_US)
        self.world.run(60)
        self.look()
        if key == "STOP":
            self.started[selected] = False
            if ms > 4100:
                self.forbid()

    def forbid(self):
        """From now on no drive may be sent ON; what is on the line already is let pass."""
        self.world.run(400)
        self.looked_at = self.world.wire.log.count
        for address in self.started:
            self.started[address] = False

    def look(self):
        """Judge every telegram since the last look."""
        log = self.world.wire.log
        for at_us, from_panel, characters in log.last(min(log.count - self.looked_at, 1000)):
            if len(characters) != 16:
                continue  # cut by a reset
            address, stw = characters[2], characters[11] << 8 | characters[12]
            if not from_panel:
                self.last_answer_us[address] = at_us
                continue
            if address & MIRROR:
                assert not any(characters[3:-1]), characters  # nobody could obey it
            elif stw not in OFF:
                self.judge(at_us, address, stw)
        self.looked_at = log.count

    def judge(self, at_us, address, stw):
        """A telegram that makes a motor turn."""
        where = "%04X to drive %d at %d" % (stw, address, at_us)
        assert stw in TURNS, where
        if TURNS[stw] == "START":
            assert self.started[address], where
        else:
            jogged, key, from_us, to_us = self.jogged
            assert (jogged, key) == (address, TURNS[stw]) and from_us <= at_us <= to_us, where
        silent_us = at_us - self.last_answer_us[address]
        assert silent_us < 1_500_000, where + ", which is lost"


def test_nothing_starts_by_surprise_whatever_happens():
    for seed in SEEDS:
        operator = Operator(seed)
        operator.live()
        world = operator.world
        for address in world.drives:
            world.drives[address].plug()
        world.press("STOP", 4200)  # all of them
        world.run(13_000)
        for drive in world.drives.values():
            assert drive.hz() == 0, drive.report()
        assert not [chip for chip in world.chips if chip.handler_errors]
