# SPDX-License-Identifier: MIT
"""A foreman at the panel: he locks its keys, keeps another order of the drives and other turns of
theirs, resets drives, and has their motors identified.
"""

from boards.sim.drives.families import setting_of
from tools.soaking.fingers import JOGS, LOCK_CODE, OPENS_MS, SETTINGS
from tools.soaking.judging.arranged import ORDER, TURNS
from tools.soaking.judging.locked import CODE, NEW_CODE
from tools.soaking.technician import COMMISSION, LOOKS_MAX, STEPS, Technician

LOCK = "LOCK"
DIGITS = 1000, 100, 10, 1
CODE_MAX = 9_999
LOCKS_OUT = ("REVERSE", "REVERSE", "PARAM", "SET", "EDIT", "UP", "DOWN", "NEXT") + JOGS + JOGS
HELD_OUT = ("PARAM", "ADDRESS_UP", "SET")
BEGINS_ANEW_MS = 5_000
RESET, IDENTIFIES = ("FACTORY", (10, 970)), ("FOR EX", (1910,))
BUSY_MS, BUSY_SLICE_MS = 60_000, 500  # the longest time that a drive is busy with that
OF_THE_LINE = ("address", "baud", "pzd words")  # what a reset may take from a drive


class Foreman(Technician):
    """Deeds that begin in the menu, and what has to be put in order behind them."""

    def __init__(self, world, plan, judge, reader, weather):
        Technician.__init__(self, world, plan, judge, reader, weather)
        self._links = {id(drive): _link(drive) for drive in self.drives}
        if plan.locks:
            self.common += 60 * [self.lock_or_open] + 30 * [self.try_the_lock]
        if plan.arranges:
            self.common += 50 * [self.reorder] + 50 * [self.take_turns]
        if plan.resets:
            self.common += 60 * [self.reset_a_drive] + 30 * [self.identify_a_motor]

    # --- the lock -------------------------------------------------------------------------------

    def lock_or_open(self):
        """Close the lock, open it, or keep another code; with a motor running or not."""
        if self.dice.below(2):
            self.run_long()
        locked = self.witness.locked
        if locked.is_closed:
            self._open_lock(locked)
        elif locked.code and self.dice.below(3):
            if self._open(LOCK):
                self.run(self.dice.between(500, 3_000))
        elif self._open(SETTINGS) and self._choose(LOCK_CODE):
            self._give(NEW_CODE, self.dice.below(6) and self.dice.between(1, CODE_MAX))
            self.run(2 * self._seen_ms)
        self.go_home()

    def _open_lock(self, locked):
        """With its code, or another one."""
        self.press("PARAM", OPENS_MS)
        self.run(2 * self._seen_ms)
        code = locked.code or 0
        if not self.dice.below(4):
            code = (code + self.dice.one_of(DIGITS)) % (CODE_MAX + 1)
        self._give(CODE, code)
        self.run(self.dice.between(500, 3_000))

    def _give(self, asked, code):
        """Digit by digit; he may change his mind."""
        for place in DIGITS:
            self.run(self._seen_ms)
            if not self.reader.rows[1].startswith(asked):
                return
            digit = code // place % 10
            key, times = ("UP", digit) if digit <= 5 else ("DOWN", 10 - digit)
            for _ in range(times):
                self.press(key, 60)
            if not self.dice.below(24):
                self.press(self.dice.one_of(("STOP", "START", "PARAM", "REVERSE")))
            self._agree()

    def try_the_lock(self):
        """Press keys that it refuses, if it is closed, beside those that it lets through."""
        if self.dice.below(2):
            self.press("STOP")
            self.run(self.dice.between(500, 2_000))
        else:
            self.run_long()
        for _ in range(self.dice.between(1, 5)):
            if self.dice.below(4):
                self.press(self.dice.one_of(LOCKS_OUT), self.dice.one_of((60, 100, 900)))
            else:
                self.press(self.dice.one_of(HELD_OUT), OPENS_MS)
            self.run(self.dice.one_of((20, 2 * self._seen_ms, 2_000)))
        self.press(self.dice.one_of(("STOP", "STOP", "START")))
        self.run(self.dice.between(50, 3_000))
        self.go_home()

    # --- the list of drives ---------------------------------------------------------------------

    def reorder(self):
        """Carry drives to other places in the list, and keep that."""
        self._mostly_stop_all()
        if self._open(ORDER):
            for _ in range(self.dice.between(1, 2)):
                self._walk()
                self._agree()
                self._walk()
                if self.dice.below(4):  # otherwise he leaves with the drive in his hand
                    self._agree()
            self.run(2 * self._seen_ms)
            self.press("PARAM")
            self.run(BEGINS_ANEW_MS)
        self.go_home()

    def take_turns(self):
        """Let a drive stand in the list more often than others, or not any more."""
        self._mostly_stop_all()
        if self._open(TURNS):
            self._walk()
            self._agree()
            for _ in range(self.dice.between(1, 3)):
                self.press(self.dice.one_of(("UP", "UP", "UP", "DOWN")))
            self.run(2 * self._seen_ms)
            self._agree()
            self.run(BEGINS_ANEW_MS)
        self.go_home()

    def _mostly_stop_all(self):
        if self.dice.below(5):
            self.long_stop_of_all()
        else:
            self.run_long()

    def long_stop_of_all(self):
        self.press("STOP", 4_300)
        self.run(4_000)

    def _walk(self):
        for _ in range(self.dice.below(4)):
            self.press(self.dice.one_of(("DOWN", "DOWN", "UP")), 60)
        self.run(2 * self._seen_ms)

    # --- drives that lose what they know --------------------------------------------------------

    def reset_a_drive(self):
        """Give a drive its factory settings, mostly while it stands."""
        self._write_steps(*RESET)

    def identify_a_motor(self):
        """P1910, which begins with the next ON."""
        self._write_steps(*IDENTIFIES)

    def _write_steps(self, procedure, numbers):
        if self.dice.below(4):
            self.press("STOP")
            self.run(self.dice.between(2_000, 6_000))
        else:
            self.run_long()
        self.may_do = numbers
        if self._open(COMMISSION) and self._choose(procedure):
            for _ in range(LOOKS_MAX):
                self.run(2 * self._seen_ms)
                step = self._step()
                if step and self.dice.below(8):
                    self._do_step()
                    if int(step[1:]) == numbers[-1]:
                        break
                self.press("DOWN", 60)
        self.may_do = STEPS
        if self.dice.below(2):
            self.go_home()
        self.press(self.dice.one_of(("START", "START", "STOP") + JOGS), 300)
        self.run(self.dice.between(500, 15_000))
        self.press("STOP")
        self.go_home()

    def wait_for_the_busy(self):
        """Until no drive is silent because of what it has been told to do."""
        for _ in range(BUSY_MS // BUSY_SLICE_MS):
            if not self.plan.resets or not any([drive.silent for drive in self.drives]):
                break
            self.run(BUSY_SLICE_MS)

    def put_back(self, drive):
        """On the line, as it was: a reset has given it other settings of that."""
        if self.plan.resets:
            for setting, value in self._links[id(drive)]:
                self.set_at_drive(drive, setting, value)


def _link(drive):
    """(parameter, value) of a drive's settings of the line."""
    found = []
    for name in OF_THE_LINE:
        setting = setting_of(drive.family, name)
        number, index = setting if isinstance(setting, tuple) else (setting, 0)
        if number is not None:
            found.append((setting, drive.read(number, index)))
    return found
