# SPDX-License-Identifier: MIT
"""What goes wrong with drives, chip and flash during a soak; `weather` does so for the line.

It tells the witness of each thing before it happens.
"""

from boards.sim.chip.machine import Timer
from tools.soaking.at_the_drive import people_at
from tools.soaking.fingers import JOGS, SLICE_MS, Fingers, weights
from tools.soaking.judging.facts import GOES
from tools.soaking.worlds import bears_silences

AT_ONCE_MS = (0, 0, 20, 200)  # between two troubles
LONGER_MS = 16_000  # by then the panel says that a P2014 has become longer
SAID_S = 3  # no key for so long, for each drive in trouble
WARNINGS = (501, 503, 505)


class Mischief(Fingers):
    """faults: how many of each kind."""

    def __init__(self, world, plan, judge, reader, weather):
        Fingers.__init__(self, world, plan, judge, reader, weather)
        self.faults = {}
        self.failures = weights((
            (4, self.unplug), (3, self.plug), (3, self.trip), (2, self.mains), (3, self.blink),
            (3, self.meddle), (3, self.hang), (3, self.restart), (1, self.cut_power),
            (1, self.cut_flash), (2, self.old_replies), (1, self.stick), (2, self.warn),
            (3, self.two_troubles),
        ))  # fmt: skip
        self.at_once = (
            self.unplug, self.unplug, self.trip, self.mains, self.blink, self.meddle, self.warn,
            self.hang, self.restart, self.old_replies,
        )  # fmt: skip
        self.common += 6 * [self.distrust] + 2 * [self.meddle_while_it_runs]
        if plan.has_families:
            self.common += 6 * [self.turn_round]
        if plan.types:
            self.common += 8 * [self.type_digits]
        if plan.looks_up:
            self.common += 40 * [self.look_up]
        if plan.troubles > 1:
            self.common += len(self.common) * [self.two_troubles]
        for drive in self.drives:
            if not self.dice.below(4):
                self.lag(drive, 1 + self.dice.below(2))
            drive.reexecute = not self.dice.below(4)

    def count(self, fault):
        self.faults[fault] = self.faults.get(fault, 0) + 1

    def any_drive(self):
        return self.dice.one_of(self.drives)

    def unplug(self):
        drive = self.any_drive()
        self.note("drive %d unplugged" % drive.address)
        self.count("unplugged")
        self.witness.excuse(drive.address)
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
        if drive.state != "off":
            self.note("drive %d trips" % drive.address)
            self.count("trip")
            self.witness.excuse(drive.address)
            drive.fault(self.dice.between(1, 80))

    def mains(self):
        drive = self.any_drive()
        if drive.mains:
            self.note("drive %d loses its mains" % drive.address)
            self.count("mains")
            self.power_off(drive)
        else:
            self.note("drive %d has mains again" % drive.address)
            self.power_on(drive)

    def blink(self):
        """Let the mains of one drive fail for a moment, of a running one if there is any."""
        running = [drive for drive in self.drives if drive.state == "running"]
        drive = self.dice.one_of(running) if running else self.any_drive()
        if not drive.mains:
            return
        ms = self.dice.one_of((30, 80, 150, 300, 600, 1_000))
        self.note("the mains of drive %d fail for %d ms" % (drive.address, ms))
        self.count("blink")
        self.power_off(drive)
        self.run(ms)
        self.power_on(drive)
        self.run(self.dice.between(500, 8_000))

    def power_off(self, drive):
        self.witness.unpowered(drive)
        drive.power_off()

    def power_on(self, drive):
        self.witness.powered(drive)
        drive.power_on()

    def dip(self, whose, ms):
        """Let a supply fail for a moment: that of all drives, of the panel, or of both."""
        self.note("the supply of %s fails for %d ms" % (whose, ms))
        if whose != "panel":
            off = [drive for drive in self.drives if drive.mains]
            for drive in off:
                self.power_off(drive)
            self.run(ms)
            for drive in off:
                self.power_on(drive)
        if whose != "drives":
            self.cut_power()

    def meddle(self):
        drive = self.any_drive()
        people = people_at(drive)
        number, value = self.dice.one_of(people.meddled)
        if self.set_at_drive(drive, number, value):
            self.note("drive %d: P%s=%s at the drive itself" % (drive.address, number, value))
            self.count("parameter")
            return number == people.off_time

    def meddle_while_it_runs(self):
        """Change parameters at a drive whose motor turns, without pressing a key."""
        self.run_long()
        for _ in range(self.dice.between(1, 3)):
            is_off_time = self.meddle()
            self.run(self.dice.between(1_000, 14_000))
            if is_off_time:
                self.run(LONGER_MS)

    def warn(self):
        drive = self.any_drive()
        number, on = self.dice.one_of(WARNINGS), bool(self.dice.below(3))
        happens = "comes" if on else "goes"
        self.note("drive %d: warning A%04d %s" % (drive.address, number, happens))
        self.count("warning")
        self.witness.stirred_us = self.world.clock.now_us
        drive.warn(number, on)
        self.run(self.dice.one_of((50, 50, 9_000)))

    def two_troubles(self):
        """While drives run, let two things fail at once; press no key until all is said."""
        self.start_others()
        first = self.dice.below(len(self.at_once))
        second = (first + 1 + self.dice.below(len(self.at_once) - 1)) % len(self.at_once)
        self.note("two troubles at once")
        self.at_once[first]()
        self.run(self.dice.one_of(AT_ONCE_MS))
        self.at_once[second]()
        self.run(SAID_S * 1_000 * self.dice.between(1, 4))

    def distrust(self):
        """Change the drive shown into one that START and JOG must refuse, or ask about; another
        one may run meanwhile.
        """
        if len(self.drives) > 1 and self.dice.below(4):
            self.press("START")
            self.run(self.dice.between(500, 2_000))
            self.press("ADDRESS_UP")
            self.run(self.dice.between(400, 1_000))
        self.press("STOP")
        self.run(self.dice.between(500, 2_000))
        drive = None if self.witness.shown is None else self.reader.drive_at(self.witness.shown)
        people = people_at(self.drives[0] if drive is None else drive)
        doubts = people.doubts + people.more if self.plan.has_families else people.doubts
        number, value = self.dice.one_of(doubts)
        if drive is None or drive.state == "off":
            return
        if number is None:
            self.witness.excuse(drive.address)
            drive.fault(self.dice.between(1, 80))
        else:
            self.set_at_drive(drive, number, value)
        self.note("drive %d is not to be trusted: %s" % (drive.address, number or "a fault"))
        self.run(self.dice.between(1_200, 4_000))
        self.press(self.dice.one_of(("START", "START") + JOGS), 300)
        self.run(self.dice.between(300, 3_000))
        if self.reader.rows[1] in GOES and self.dice.below(4):
            self.run(1_200)
            self.press("START")
            self.run(self.dice.between(300, 5_000))

    def set_at_drive(self, drive, number, value):
        """number: of the parameter, or this and an index."""
        number, index = number if isinstance(number, tuple) else (number, 0)
        try:
            if drive.read(number, index) == value:
                return
            drive.write(number, index, value)
        except (KeyError, ValueError):
            return
        self.witness.meddled(drive)
        return True

    def old_replies(self):
        drive = self.any_drive()
        self.lag(drive, self.dice.below(4))
        drive.reexecute = not self.dice.below(3)

    def lag(self, drive, count):
        if not drive.switches.silent_refusals or bears_silences(self.plan):
            drive.stale_replies = count

    def hang(self):
        ms = self.dice.one_of((60, 200, 400, 700, 1_500, 2_600, 4_000))
        self.note("the loop hangs for %d ms" % ms)
        self.count("hang")
        self.witness.hangs(True)
        while ms > 0 and self.witness.hung_us is not None:
            self.world.hang(min(ms, SLICE_MS))
            ms -= SLICE_MS
            self.judge.look()
        self.witness.hangs(False)

    def stick(self):
        """Let the chip's timers die, as if their clock stood: the watchdog must restart the
        chip."""
        self.note("the timers die")
        self.count("dead timers")
        self.witness.sticks()
        for peripheral in self.world.chip.peripherals:
            if isinstance(peripheral, Timer):
                peripheral.die()

    def restart(self):
        """Restart the chip, sometimes while a key is held down."""
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
        """Let the power fail at one of the next steps of writing the flash."""
        self.note("power fails when the flash is written")
        self.count("flash cut")
        self.world.flash.cut_at = self.world.flash.steps + self.dice.below(5)
