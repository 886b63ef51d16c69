# SPDX-License-Identifier: MIT
"""What befalls drives, chip and flash during a soak; what befalls the line is `weather`.

Judge and reader are told of it before it happens.
"""

from boards.sim.chip import Timer
from tools.soaking.facts import QUESTIONS
from tools.soaking.fingers import JOGS, SLICE_MS, Fingers, weights

PARAMETERS = (  # what somebody sets at the drive itself
    (700, 5), (700, 2), (1000, 5), (1000, 1), (1080, 5.0), (1080, 0.0), (1082, 50.0), (1082, 35.0),
    (2000, 60.0), (2000, 50.0), (2009, 1), (2009, 0), (2014, 0), (2014, 5000), (1120, 2.0),
    (1121, 1.0), (1121, 10.0), (1058, 8.0),
)  # fmt: skip

# What START and JOG have to refuse, or to ask about; no number: a fault.
DOUBTS = ((700, 2), (1000, 1), (2014, 0), (2014, 0), (2014, 0), (None, 0))


class Mischief(Fingers):
    """faults: how many of each kind."""

    def __init__(self, world, plan, judge, reader, weather):
        Fingers.__init__(self, world, plan, judge, reader, weather)
        self.faults = {}
        self.failures = weights((
            (4, self.unplug), (3, self.plug), (3, self.trip), (2, self.mains), (3, self.meddle),
            (3, self.hang), (3, self.restart), (1, self.cut_power), (1, self.cut_flash),
            (2, self.old_replies), (1, self.stick),
        ))  # fmt: skip
        self.common += 3 * [self.distrust]
        for drive in self.drives:
            if not self.dice.below(4):
                drive.stale_replies = 1 + self.dice.below(2)
            drive.reexecute = not self.dice.below(4)

    def count(self, fault):
        self.faults[fault] = self.faults.get(fault, 0) + 1

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

    def distrust(self):
        """The drive shown becomes one that START and JOG have to refuse, or to ask about; another
        one may run meanwhile."""
        if len(self.drives) > 1 and self.dice.below(4):
            self.press("START")
            self.run(self.dice.between(500, 2_000))
            self.press("ADDRESS_UP")
            self.run(self.dice.between(400, 1_000))
        self.press("STOP")
        self.run(self.dice.between(500, 2_000))
        drive = None if self.judge.shown is None else self.reader.drive_at(self.judge.shown)
        number, value = self.dice.one_of(DOUBTS)
        if drive is None:
            return
        if number is None:
            self.judge.excuse(drive.address)
            drive.fault(self.dice.between(1, 80))
        else:
            self.set_at_drive(drive, number, value)
        self.note("drive %d is not to be trusted: %s" % (drive.address, number or "a fault"))
        self.run(self.dice.between(1_200, 4_000))
        self.press(self.dice.one_of(("START", "START") + JOGS), 300)
        self.run(self.dice.between(300, 3_000))
        if self.reader.rows[1] == QUESTIONS[1] and self.dice.below(4):
            self.run(1_200)
            self.press("START")
            self.run(self.dice.between(300, 5_000))

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
