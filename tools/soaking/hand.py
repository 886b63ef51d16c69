"""The hand of a soak: it presses keys at random and lets things fail at random.

One number decides all of it. It lives in turns: a time in which anything may happen, then one in
which everything is put in order and it looks whether the panel controls its drives again.

    hand = Hand(world, plan, judge, reader, weather)
    hand.live(180)                  # seconds of virtual time: raises Broken, or what firmware did
    hand.deeds                      # the last things it did
"""

import json

from boards.sim.chip import Timer
from tools.soaking.judge import MS, QUESTIONS, S
from tools.soaking.reader import address_in
from tools.soaking.rules import Broken
from tools.soaking.worlds import CLEAN

SLICE_MS = 40
DEEDS = 60
TURN_S = (8, 25)

TAPPED = (
    "START", "START", "START", "STOP", "STOP", "REVERSE", "UP", "DOWN", "ADDRESS_UP",
    "ADDRESS_DOWN", "PARAM", "NEXT", "PREVIOUS", "EDIT", "SET",
)  # fmt: skip
JOGS = ("JOG_RIGHT", "JOG_LEFT")
PARAMETERS = (
    (700, 5), (700, 2), (1000, 5), (1000, 1), (1080, 5.0), (1080, 0.0), (1082, 50.0), (1082, 35.0),
    (2000, 60.0), (2000, 50.0), (2009, 1), (2009, 0), (2014, 0), (2014, 5000), (1120, 2.0),
    (1121, 1.0), (1121, 10.0), (1058, 8.0),
)  # fmt: skip
IN_ORDER = {
    700: 5, 1000: 5, 1080: 0.0, 1082: 50.0, 2000: 50.0, 2009: 0, 1120: 2.0, 1121: 2.0, 1135: 1.0,
    3: 3, 10: 0, 927: 15,
}  # fmt: skip


class Hand:
    """deeds: the last things done, texts with their instants. faults: how many of each kind."""

    def __init__(self, world, plan, judge, reader, weather):
        self.world = world
        self.plan = plan
        self.judge = judge
        self.reader = reader
        self.weather = weather
        self.dice = plan.dice
        self.deeds = []
        self.faults = {}
        self.drives = [world.drives[address] for address in plan.addresses]
        # Deeds by weight: always; when faults may strike.
        self.common = weights((
            (12, self.tap), (4, self.hold), (6, self.start), (5, self.stop), (9, self.jog),
            (4, self.chord), (4, self.long_stop), (5, self.edit), (4, self.rest), (3, self.select),
            (4, self.start_others), (3, self.start_under_stop), (5, self.run_long),
        ))  # fmt: skip
        self.failures = weights((
            (4, self.unplug), (3, self.plug), (3, self.trip), (2, self.mains), (3, self.meddle),
            (3, self.hang), (3, self.restart), (1, self.cut_power), (1, self.cut_flash),
            (2, self.old_replies), (1, self.stick),
        ))  # fmt: skip

        for drive in self.drives:
            if not self.dice.below(4):
                drive.stale_replies = 1 + self.dice.below(2)
            drive.reexecute = not self.dice.below(4)

    def live(self, until_s):
        """Until so many seconds of virtual time are over, and the turn that goes on then."""
        while self.world.clock.now_us < until_s * S:
            self.weather.change()
            self.bustle(self.dice.between(*TURN_S))
            self.weather.clear()
            self.put_in_order()
            self.prove_control()

    def bustle(self, seconds):
        until_us = self.world.clock.now_us + seconds * S
        while self.world.clock.now_us < until_us:
            fails = self.plan.level != CLEAN and not self.dice.below(3)
            if fails and self.dice.below(2):
                self.run_or_jog()
            self.dice.one_of(self.failures if fails else self.common)()
            self.run((20, 60, 100, 200, 400, 900)[self.dice.below(6)])

    # --- time -----------------------------------------------------------------------------------

    def run(self, ms):
        """Let time pass, and look what happens."""
        world = self.world
        while ms > 0:
            world.run(min(ms, SLICE_MS))
            ms -= SLICE_MS
            self.judge.look()
            self.reader.look()
            if self.weather.dips:
                self.dip(*self.weather.dips.pop())

    def note(self, text):
        if len(self.deeds) >= DEEDS:
            del self.deeds[0]
        self.deeds.append((self.world.clock.now_us, text))

    def count(self, fault):
        self.faults[fault] = self.faults.get(fault, 0) + 1

    # --- keys -----------------------------------------------------------------------------------

    def down(self, key):
        if key not in self.judge.down:
            self.judge.key(key, True)
            self.note("%s down" % key)
            self.world.down(key)

    def up(self, key):
        if key in self.judge.down:
            self.judge.key(key, False)
            self.note("%s up" % key)
            self.world.up(key)

    def press(self, key, ms=100):
        self.up(key)
        self.down(key)
        self.run(ms)
        self.up(key)
        self.run(60)

    def let_go(self):
        for key in list(self.judge.down):
            self.up(key)
        self.run(100)

    def tap(self):
        self.press(self.dice.one_of(TAPPED), self.dice.one_of((35, 60, 100, 200)))

    def hold(self):
        self.press(self.dice.one_of(TAPPED), self.dice.one_of((500, 700, 1700, 2500)))

    def start(self):
        self.press("START")
        self.run(self.dice.between(50, 3_000))

    def stop(self):
        self.press("STOP")

    def run_or_jog(self):
        """The drive shown is to turn, so that what comes next matters."""
        self.press("STOP")
        self.run(self.dice.between(100, 1_500))
        if self.dice.below(3):
            self.press("START", self.dice.one_of((60, 100, 800)))
            self.run(self.dice.between(300, 2_000))
        else:
            self.down(self.dice.one_of(JOGS))
            self.run(self.dice.between(100, 1_000))
            if self.dice.below(2):  # else it stays down for a while
                self.release_jogs()

    def run_long(self):
        """A motor turns for a while, and nobody does anything."""
        self.press("STOP")
        self.run(self.dice.between(500, 1_500))
        self.press("START")
        self.run(self.dice.between(2_000, 9_000))

    def release_jogs(self):
        for key in JOGS:
            self.up(key)

    def start_under_stop(self):
        """STOP is down, and somebody presses what makes a motor turn."""
        self.press("STOP")
        self.run(self.dice.between(300, 1_500))
        self.down("STOP")
        self.run(self.dice.between(20, 400))
        self.press(self.dice.one_of(("START", "START") + JOGS), self.dice.one_of((60, 300)))
        self.run(self.dice.between(20, 1_000))
        self.up("STOP")
        self.run(60)

    def start_others(self):
        """Several drives, one after the other."""
        for _ in range(self.dice.between(1, 3)):
            self.press("START")
            self.run(self.dice.between(200, 1_500))
            self.press("ADDRESS_UP")
            self.run(self.dice.between(50, 500))

    def long_stop(self):
        self.press("STOP", self.dice.one_of((1_300, 1_700, 3_800, 4_300, 6_000)))

    def jog(self):
        first, second = JOGS if self.dice.below(2) else (JOGS[1], JOGS[0])
        self.release_jogs()
        if self.dice.below(2):
            self.press("STOP")
            self.run(self.dice.between(100, 1_500))
        self.down(first)
        self.run(self.dice.between(50, 2_000))
        if not self.dice.below(4):
            self.down(second)
            self.run(self.dice.between(20, 600))
        if not self.dice.below(4):
            self.press(self.dice.one_of(TAPPED))
        if self.dice.below(2):
            self.up(second)
            self.run(self.dice.between(20, 400))
        self.up(first)
        self.up(second)
        self.run(60)

    def chord(self):
        keys = self.world.keypad.names
        chosen = [self.dice.one_of(keys) for _ in range(2 + self.dice.below(2))]
        for key in chosen:
            self.down(key)
            self.run(self.dice.one_of((1, 5, 30, 300)))
        for key in chosen:
            self.up(key)
            self.run(self.dice.one_of((1, 5, 30, 300)))

    def select(self):
        self.press(self.dice.one_of(("ADDRESS_UP", "ADDRESS_DOWN")), self.dice.one_of((60, 900)))

    def rest(self):
        self.run(self.dice.between(500, 6_000))

    def edit(self):
        """Parameter mode, as somebody who knows it uses it, up to where he changes his mind."""
        self.press("PARAM")
        for _ in range(self.dice.below(3)):
            self.press("NEXT")
        self.run(self.dice.between(100, 1_500))
        self.press("EDIT")
        for _ in range(self.dice.below(4)):
            self.press(self.dice.one_of(("UP", "DOWN")))
        self.press("SET", self.dice.one_of((60, 100, 1_700)))
        self.run(self.dice.between(50, 1_500))
        if self.dice.below(4):
            self.press("SET", self.dice.one_of((60, 100, 1_700, 2_500)))
        self.run(self.dice.between(50, 3_000))
        if self.dice.below(3):
            self.press("PARAM")

    # --- what fails -----------------------------------------------------------------------------

    def any_drive(self):
        return self.dice.one_of(self.drives)

    def unplug(self):
        drive = self.any_drive()
        self.note("drive %d unplugged" % drive.address)
        self.count("unplugged")
        self.judge.excuse(drive.address)
        self.judge.look()
        drive.unplug()

    def plug(self):
        drive = self.any_drive()
        if not drive.plugged:
            self.note("drive %d plugged in" % drive.address)
            self.judge.look()
            drive.plug()

    def trip(self):
        drive = self.any_drive()
        if drive.powered:
            self.note("drive %d trips" % drive.address)
            self.count("trip")
            self.judge.excuse(drive.address)
            drive.fault(self.dice.between(1, 80))

    def mains(self):
        drive = self.any_drive()
        self.judge.excuse(drive.address)
        self.judge.look()
        if drive.powered:
            self.note("drive %d loses its mains" % drive.address)
            self.count("mains")
            drive.power_off()
        else:
            self.note("drive %d has mains again" % drive.address)
            drive.power_on()

    def dip(self, whose, ms):
        """The supply fails for a moment: of all drives, of the panel, of both."""
        self.note("the supply of %s fails for %d ms" % (whose, ms))
        if whose != "panel":
            off = [drive for drive in self.drives if drive.powered]
            for drive in off:
                self.judge.excuse(drive.address)
                drive.power_off()
            self.run(ms)
            for drive in off:
                self.judge.excuse(drive.address)
                drive.power_on()
        if whose != "drives":
            self.cut_power()

    def meddle(self):
        drive = self.any_drive()
        number, value = self.dice.one_of(PARAMETERS)
        if self.set_at_drive(drive, number, value):
            self.note("drive %d: P%04d=%s at the drive itself" % (drive.address, number, value))
            self.count("parameter")

    def set_at_drive(self, drive, number, value):
        try:
            if drive.read(number) == value:
                return
            drive.write(number, 0, value)
        except (KeyError, ValueError):
            return
        self.judge.meddled(drive)
        return True

    def old_replies(self):
        drive = self.any_drive()
        drive.stale_replies = self.dice.below(4)
        drive.reexecute = not self.dice.below(3)

    def hang(self):
        ms = self.dice.one_of((60, 200, 400, 700, 1_500, 2_600, 4_000))
        self.note("the loop hangs for %d ms" % ms)
        self.count("hang")
        self.judge.hangs(True)
        while ms > 0 and self.judge.hung_us is not None:
            self.world.hang(min(ms, SLICE_MS))
            ms -= SLICE_MS
            self.judge.look()
        self.judge.hangs(False)

    def stick(self):
        """The chip's timers die, as if their clock stood: the watchdog has to help."""
        self.note("the timers die")
        self.count("dead timers")
        self.judge.sticks()
        for peripheral in self.world.chip.peripherals:
            if isinstance(peripheral, Timer):
                peripheral.die()

    def restart(self):
        """The chip restarts, now and then while somebody leans on a key."""
        key = self.dice.one_of(("START", "START", "STOP") + JOGS)
        if self.dice.below(4):
            self.down(key)
        self.note("reset")
        self.count("reset")
        self.world.reset()
        self.run(self.dice.between(100, 5_000))
        self.up(key)

    def cut_power(self):
        self.note("power cut")
        self.count("power cut")
        self.world.cut_power()

    def cut_flash(self):
        """The power fails at one of the next steps of writing the flash."""
        self.note("power fails when the flash is written")
        self.count("flash cut")
        self.world.flash.cut_at = self.world.flash.steps + self.dice.below(5)

    # --- order ----------------------------------------------------------------------------------

    def put_in_order(self):
        """Everything is as it should be: plugged in, powered, set up; every key is up."""
        self.note("everything is put in order")
        self.let_go()
        self.judge.look()
        self.world.flash.cut_at = None
        self.run(2_500 + 8 * self.judge.cycle_us // MS)  # what was asked for is written by then
        for drive in self.drives:
            self.judge.excuse(drive.address, 3)
            if not drive.plugged:
                drive.plug()
            if not drive.powered:
                drive.power_on()
            for number, value in IN_ORDER.items():
                self.set_at_drive(drive, number, value)
        self.follow_addresses()
        self.run(1_500 + 4 * self.judge.cycle_us // MS)
        self.press("STOP", 4_300)
        self.run(3_000)

    def follow_addresses(self):
        """A drive that is where the panel does not look for it gets an address where it does."""
        known = json.loads(self.world.store.read())["drives"]
        free = [address for address in known if address not in [d.address for d in self.drives]]
        for drive in self.drives:
            if drive.address not in known and free:
                self.set_at_drive(drive, 2011, free.pop())

    def prove_control(self):
        """START runs the drive shown, and STOP stops it."""
        self.find_one_that_answers()
        self.wait_for("an address on the display", self._is_home, 8)
        reader = self.reader
        address = self.judge.shown
        if not reader.is_able(address):
            return
        drive = reader.drive_at(address)
        if drive.state == "fault":
            self.run(1_500)
            self.press("STOP")
        self.wait_for("drive %d to be ready" % address, lambda: drive.state == "ready", 20)
        self.wait_for("READY on the display", lambda: reader.rows[1].startswith("READY"), 8)
        self.press("START")
        self.run(200)
        if self.reader.reads("NO:"):  # a drive that was not shown is not always known by now
            self.run(3_000 + 20 * self.judge.cycle_us // MS)
            self.press("START")
        self.wait_for("a START to be answered", lambda: self._is_answered(drive), 8)
        if reader.reads(QUESTIONS[1]):
            self.run(1_200)
            self.press("START")
        self.wait_for("drive %d to run" % address, lambda: drive.state == "running", 8)
        self.run(self.dice.between(100, 6_000))
        if self.dice.below(2):
            self.press("STOP")
            self.wait_for("drive %d to stand" % address, lambda: drive.state == "ready", 12)
        elif len(self.drives) > 1 and self._all_are_well():
            self.prove_announced(drive)

    def find_one_that_answers(self):
        """A drive that the panel cannot control never confirms its STOP: another one is shown."""
        able = [drive for drive in self.drives if self.reader.is_able(drive.address)]
        for _ in range(len(self.drives) - len(able)):
            self.run(2_000)
            if not self.reader.rows[1].startswith("STOP UNCONFIRMED"):
                return
            self.press("ADDRESS_UP")
            self.run(2_000)

    def prove_announced(self, drive):
        """Another drive is shown: this one runs on, and the display says so."""
        self.press("ADDRESS_UP")
        text = "A%d RUN,HOLD=ALL" % drive.address
        self.wait_for(text, lambda: self.reader.reads(text), 8, "ANNOUNCED")
        self.press("STOP", 4_300)
        self.wait_for("drive %d to stand" % drive.address, lambda: drive.state == "ready", 12)

    def wait_for(self, what, condition, seconds, rule="RECOVERS"):
        until_us = self.world.clock.now_us + seconds * S + 20 * self.judge.cycle_us
        while not condition():
            if self.world.clock.now_us > until_us:
                raise Broken(rule, "waited for %s" % what)
            self.run(SLICE_MS)

    def _all_are_well(self):
        """Whether no drive has anything to say that matters more than one that runs."""
        for drive in self.drives:
            if not self.reader.is_able(drive.address) or drive.state not in ("ready", "running"):
                return False
        return True

    def _is_answered(self, drive):
        return drive.state == "running" or self.reader.reads(QUESTIONS[1])

    def _is_home(self):
        """Parameter mode is left as soon as it is seen."""
        reader, judge = self.reader, self.judge
        if not reader.steady or judge.shown is None or self.world.clock.now_us < judge.unsure_us:
            return False
        if address_in(reader.rows[1]) != judge.shown:
            return False
        if reader.rows[1][5] == ":":
            self.press("PARAM")
            return False
        return True


def weights(table):
    found = []
    for weight, deed in table:
        found += [deed] * weight
    return found
