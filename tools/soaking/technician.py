# SPDX-License-Identifier: MIT
"""A technician at the panel: he looks into the line, leaves it to others, keeps parameter sets,
commissions drives, and looks into every list of the menu.
"""

import json

from tools.soaking.at_the_drive import people_at
from tools.soaking.fingers import HOME_TRIES, OPENS_MS, SLICE_MS, TYPES
from tools.soaking.judging.facts import MENU
from tools.soaking.judging.kept_sets import ENDING, HALF, NAMES, SETTINGS_FILE
from tools.soaking.mischief import Mischief

DIAGNOSIS, BUS_OFF, LEAVES, FREE = "DIAGNOSIS", "BUS OFF", "SET=LEAVE", "LINE IS FREE"
OF_THE_LINE = ("BUS COUNTERS", "BUS TIMES", "THE PANEL")
OF_A_DRIVE = ("COUNTERS", "TIMES", "TELEGRAMS", "MIRROR TEST")
SETS, SAVE, GIVE_UP = "SETS", "SAVE A", "GIVE UP A"
OF_A_SET = ("COMPARE", "INTO", "INTO", "INTO", "DELETE")
WRITE, YES, SAVED = "SET=WRITE", "SET=DO", "SAVED"
ENDS = (  # how the work with a set may end, or what it asks
    SAVED, "BUT ", "ALL EQUAL", "DIFFER", "WRITTEN", "HALF", "NOTHING", "NO ", "IS NO", "INCOMP",
    "DAMAGED", "TOO", "IT IS OF", "FLASH", "20 SETS", "STOP FIRST", WRITE, YES, "REFUSED", "P0003",
    "THE BUS", "CHANGE THE",
)  # fmt: skip
MESSAGE_MS = 3_300  # by then none hides what is shown
SETS_MAX = 3  # he keeps
SAVED_S = (3, 50, 50, 50)  # he waits so long
COMMISSION, PROCEDURES = "COMMISSION", ("FOR USS", "FOR USS", "THE MOTOR", "THE MOTOR", "F")
# Steps that he does; the others he only looks at. A drive that has lost its motor data, or its
# address, has to be put in order by hand.
STEPS = (2, 3, 9, 10, 94, 700, 910, 971, 1000, 1080, 1082, 1120, 1121, 2000, 2009, 2014, 3900)
TYPING, ASKING = "[", ("SET=YES", "RESCALES")
EVENTS, FAULT, STEPS_MAX, LOOKS_MAX = "EVENTS", "FAULT ", 8, 12
TOURED = (  # all of the menu's first list that no other deed is about
    "DRIVES", "ANY ADDRESS", "FIND DRIVES", "SETTINGS", "SETS", "ORDER", "TURNS", "FAULT MEMORY",
    "EVENTS", "ABOUT", "WHY NO CONTACT", "WHAT IS", "COMMISSION",
)  # fmt: skip
CARRYING = ("ORDER", "TURNS")
TOURS = (
    "DOWN", "DOWN", "DOWN", "UP", "NEXT", "PREVIOUS", "STOP", "START", "REVERSE", "EDIT", "SET",
    "ADDRESS_UP", "ADDRESS_DOWN", "JOG_RIGHT", "JOG_LEFT",
)  # fmt: skip
CHANGED = ((1120, 5.0), (1120, 2.0), (1121, 3.0), (1121, 2.0))  # at the drive, before he writes


class Technician(Mischief):
    """Deeds that begin in the menu, and end at home."""

    def __init__(self, world, plan, judge, reader, weather):
        Mischief.__init__(self, world, plan, judge, reader, weather)
        self.may_do = STEPS
        if plan.diagnoses:
            self.common += 24 * [self.diagnose] + 16 * [self.leave_the_line]
        if plan.keeps_sets:
            self.common += 20 * [self.keep_sets]
        if plan.commissions:
            self.common += 40 * [self.commission] + 16 * [self.read_events] + 16 * [self.tour]

    def diagnose(self):
        """Look what goes on, with a motor running or not."""
        if self.dice.below(3):
            self.run_long()
        if not self._open(DIAGNOSIS):
            return
        if self.dice.below(2):
            wanted = self.dice.one_of(OF_THE_LINE)
        else:
            wanted = "A%d " % self.dice.one_of(self.plan.listed)
        if self._choose(wanted) and wanted[0] == "A":
            self._choose(self.dice.one_of(OF_A_DRIVE))
        for _ in range(self.dice.between(2, 10)):
            self.run(self.dice.one_of((self._seen_ms, 900, 3_000)))
            self.press(self.dice.one_of(("DOWN", "DOWN", "DOWN", "UP", "SET", "STOP", "START")))
        self.go_home()

    def leave_the_line(self):
        """Bus off, and back."""
        if self.dice.below(4):
            self.long_stop()
            self.run(4_000)
        if self._open(DIAGNOSIS) and self._choose(BUS_OFF) and self._choose(LEAVES):
            self.run(self.dice.one_of((50, 500, 2_000, 8_000)))
            for _ in range(self.dice.below(3)):
                self.press(self.dice.one_of(("DOWN", "START", "SET", "REVERSE", "UP")))
                self.run(self.dice.one_of((100, 1_000)))
            self.press(self.dice.one_of(("PARAM", "PARAM", "STOP")))
            self.run(self.dice.between(50, 2_000))
        self.go_home()

    def commission(self):
        """Do some steps of a procedure, while the motor stands or not; change one's mind."""
        if self.dice.below(2):
            self.press("STOP")
            self.run(self.dice.between(2_000, 6_000))
        else:
            self.run_long()
        if not self.dice.below(3):
            self._leave_undone()
        if self._open(COMMISSION) and self._choose(self.dice.one_of(PROCEDURES)):
            for _ in range(self.dice.between(2, STEPS_MAX)):
                for _ in range(self.dice.below(LOOKS_MAX)):
                    self.press("DOWN", 60)
                    self.run(self._seen_ms)
                    step = self._step()
                    if step and not self.reader.rows[0].startswith(step + "*"):
                        break
                self._do_step()
                if not self.dice.below(3):
                    self.press(self.dice.one_of(TOURS))
        self.go_home()
        if self.dice.below(2):  # half commissioned, perhaps
            self.press(self.dice.one_of(("START", "START", "JOG_RIGHT")), 300)
            self.run(self.dice.between(500, 7_000))
            self.press("STOP")

    def _leave_undone(self):
        """At the drive shown, set something that commissioning puts right."""
        drive = None if self.witness.shown is None else self.reader.drive_at(self.witness.shown)
        if drive is not None and drive.state != "off":
            people = people_at(drive)
            number, value = self.dice.one_of(people.doubts + people.more)
            if number is not None and self.set_at_drive(drive, number, value):
                self.note("drive %d: P%s=%s at the drive itself" % (drive.address, number, value))

    def _step(self):
        """The step on the display, "P0700", if it is one of those that he does; or ""."""
        label = self.reader.rows[0][:5]
        return label if label[1:].isdigit() and int(label[1:]) in self.may_do else ""

    def _do_step(self):
        for _ in range(HOME_TRIES):  # an announcement may hide it
            self.run(self._seen_ms)
            if self.reader.rows[0][:1] == "P":
                break
        step = self._step()
        if not step:
            return
        self.run(self.dice.one_of((self._seen_ms, 3_000)))  # until it is read
        for _ in range(3):
            for _ in range(HOME_TRIES):  # an announcement takes turns with it
                if self._step() == step:
                    self._agree()
                    break
                self.run(4 * SLICE_MS)
            self.run(self._seen_ms)
            entry = self._entry()
            if TYPING in entry:
                for _ in range(self.dice.below(4)):
                    self.press(self.dice.one_of(TYPES))
            elif not any([text in entry for text in ASKING]):
                break
            if not self.dice.below(4):
                self.press(self.dice.one_of(("PARAM", "STOP", "START")))
        self.run(self.dice.one_of((50, 1_000, 4_000)))

    def read_events(self):
        """Read what has happened, and what a fault means, with a motor running or not."""
        if self.dice.below(3):
            self.run_long()
        if self.dice.below(2):
            self.trip()
            self.run(self.dice.between(500, 4_000))
        if self._open(EVENTS):
            for _ in range(self.dice.between(2, LOOKS_MAX)):
                self.run(self.dice.one_of((self._seen_ms, 2_000)))
                if self._entry().startswith(FAULT) and not self.dice.below(3):
                    self._means = (FAULT,)
                    self.press("SET")
                    self._means = ()
                self.press(self.dice.one_of(("DOWN", "DOWN", "UP", "STOP", "START", "PARAM")))
        self.go_home()

    def tour(self):
        """Press keys of all kinds in one list of the menu. What one SET takes up in ORDER and
        TURNS, a second one would keep."""
        if self.dice.below(3):
            self.run_long()
        entry = self.dice.one_of(TOURED)
        keys = TOURS
        if self._open(entry):
            for _ in range(self.dice.between(2, LOOKS_MAX)):
                self.run(self.dice.one_of((20, self._seen_ms, 2_000)))
                key = self.dice.one_of(keys)
                if key == "SET" and entry in CARRYING:
                    keys = tuple([one for one in TOURS if one != "SET"])
                self.press(key, self.dice.one_of((60, 100, 900)))
        self.go_home()

    def keep_sets(self):
        """Save a set, compare it, write it, or delete it."""
        self.press("STOP", 4_300)
        self.run(5_000)
        names = [name for name in self.world.flash.files if name.endswith(ENDING)]
        is_there = self._open(SETS)
        if is_there and (not names or len(names) < SETS_MAX and not self.dice.below(4)):
            is_there = self._save()
        if is_there:
            if self.dice.below(3):
                drive = self.any_drive()
                number, value = self.dice.one_of(CHANGED)
                self.note("drive %d: P%d=%s at the drive itself" % (drive.address, number, value))
                self.set_at_drive(drive, number, value)
            self._use()
        self.run(MESSAGE_MS)
        self.go_home()
        if self.dice.below(2):  # what is half written must not start
            self.press("START")
            self.run(self.dice.between(500, 3_000))
            self.press("STOP")

    def _save(self):
        """Whether there is a new one, and the list of all is shown again."""
        if not self._choose(SAVE):
            return False
        for _ in range(self.dice.below(4)):
            self.press(self.dice.one_of(TYPES))
        self._agree()
        self._wait(self.dice.one_of(SAVED_S))
        is_saved = self._entry().startswith(SAVED)
        if is_saved:
            self._agree()
        return is_saved

    def _use(self):
        self.press("UP")  # the last one
        if not self._choose("A") or not self._choose(self.dice.one_of(OF_A_SET)):
            return
        for _ in range(3):
            self._wait(self.dice.one_of(SAVED_S))
            entry = self._entry()
            if not entry.startswith((WRITE, YES, "P0003", "THE BUS", "CHANGE THE")):
                return
            self.run(self.dice.one_of((self._seen_ms, 3_000)))
            if not self.dice.below(4):
                self.press("PARAM")
            else:
                self._agree()
                if not self.dice.below(3):  # he changes his mind
                    self.run(self.dice.between(50, 1_500))
                    self.press("PARAM")
                    return

    def give_sets_up(self):
        """Say of every drive that has one in part that it may be started."""
        self.run(MESSAGE_MS)
        self.go_home()
        for address in self.plan.listed:
            half = json.loads(self.world.flash.files[SETTINGS_FILE]).get(HALF, {})
            if str(address) in half and self._show(address):
                if self._open(SETS) and self._choose(GIVE_UP):
                    self._choose(YES)
                    self.run(2_000)
                self.go_home()

    def _show(self, address):
        for _ in self.plan.listed:
            self.run(3_000)
            if self.witness.shown == address:
                return True
            self.press("ADDRESS_UP")
        return False

    def _wait(self, seconds):
        """Until what is done with a set is over, asks something, or has not even begun."""
        for _ in range(seconds * 1_000 // SLICE_MS):
            is_refused = not self._entry() and self.reader.rows[0].startswith(NAMES)
            if self._entry().startswith(ENDS) or is_refused:
                return
            self.run(SLICE_MS)

    def _entry(self):
        row_2 = self.reader.rows[1]
        return row_2[len(MENU) :] if row_2.startswith(MENU) else ""

    def _open(self, entry):
        """The menu, and this list of it; whether it is there."""
        self.press("PARAM", OPENS_MS)
        self.run(2 * self._seen_ms)
        return self._choose(entry)

    def _agree(self):
        """Press SET on whatever is there."""
        self.run(self._seen_ms)
        for _ in range(HOME_TRIES):  # a row that says several things in turn
            if self.reader.steady:
                break
            self.run(SLICE_MS)
        self._means = ("",)
        self.press("SET")
        self._means = ()

    def _choose(self, entry):
        """Walk to an entry and press SET on it; whether it is there."""
        self._means = (entry,)
        for _ in range(2 * HOME_TRIES):
            self.run(self._seen_ms)
            if self._entry().startswith(entry):
                self.press("SET")
                self.run(self._seen_ms)
                self._means = ()
                return True
            if not self.is_away():
                break
            self.press("DOWN")
        self._means = ()
        return False
