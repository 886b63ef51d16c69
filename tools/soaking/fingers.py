# SPDX-License-Identifier: MIT
"""An operator's fingers: they press the keys of a panel at random, sensibly or not.

Time passes in slices; after each slice judge and reader look.
"""

from tools.soaking.judging.announced import is_parameter
from tools.soaking.judging.facts import DRAWN_STEPS, LEAVES, MENU, MS, SEEN_US

SLICE_MS = 40
DEEDS = 60
CONTACT_MS = 40  # the shortest press of a hand

TAPPED = (
    "START", "START", "START", "STOP", "STOP", "REVERSE", "UP", "DOWN", "ADDRESS_UP",
    "ADDRESS_DOWN", "PARAM", "NEXT", "PREVIOUS", "EDIT", "SET",
)  # fmt: skip
JOGS = ("JOG_RIGHT", "JOG_LEFT")
WALKED = (  # in the menu
    "UP", "DOWN", "DOWN", "DOWN", "SET", "SET", "SET", "SET", "PARAM", "NEXT", "PREVIOUS",
    "ADDRESS_UP", "ADDRESS_DOWN", "STOP", "START", "REVERSE", "EDIT",
) + JOGS  # fmt: skip
TYPES = ("UP", "UP", "DOWN", "DOWN", "NEXT", "PREVIOUS")  # digits
TYPED_BY = ("SET", "SET", "SET", "EDIT", "PARAM", "STOP", "ADDRESS_UP")
OPENS = ("PARAM", "PARAM", "PARAM", "ADDRESS_UP", "ADDRESS_DOWN")  # the menu, held
OPENS_MS = 1_500
FIND, LEAVING, HUNTS, TAKES = "FIND DRIVES", "AT ALL RATES", "FOUND STOP=NO", "TAKE "
SETTINGS, KEY_TEST = "SETTINGS", "HOLD PARAM: ENDS"  # row 1
CHOSEN = (  # they change nothing
    "DRIVES", "ANY ADDRESS", FIND, "AT THIS RATE", "SET=BEGIN", LEAVING, SETTINGS, "SETS", "ABOUT",
    "SHOW IT",
    "DIAGNOSIS", "BUS COUNTERS", "BUS TIMES", "BUS OFF", "THE PANEL", "COUNTERS", "TIMES",
    "TELEGRAMS", "MIRROR TEST", "SET=COUNT",
)  # fmt: skip
PARAMETERS, FAULT_MEMORY, BY_NUMBER = "PARAMETERS", "FAULT MEMORY", "BY NUMBER"
WHAT_IS, TYPES_NUMBER = "WHAT IS", "NUMBER"
MEANT = ("CAUSE", "REMEDY", "F")  # row 1 of the lists that follow
LOOKED = (  # on the page of a parameter
    "NEXT", "NEXT", "NEXT", "PREVIOUS", "UP", "UP", "DOWN", "EDIT", "EDIT", "SET", "ADDRESS_UP",
    "STOP", "START", "REVERSE",
) + JOGS  # fmt: skip
HARMLESS, HARMLESS_DIGITS = "P2155", (2, 1, 5, 5)  # a threshold that a status word tells
LEFT_ALONE = ("...", "ANSWERS", "NOBODY", "IN THE LIST", "SET=ASK")  # of an address
LOCK_CODE = "LOCK CODE"
CHANGING = (LOCK_CODE, "P2014=0 OK")  # of the settings
HOME_TRIES = 16


class TimeIsUp(Exception):
    """A life ends in the middle of what the hand does."""


class Fingers:
    """deeds: the last things done, texts with their instants. ends_us: when its `TimeIsUp`, or
    None."""

    ends_us = None
    dip = None  # dip(whose, ms): a supply fails; see `Mischief`

    def __init__(self, world, plan, judge, reader, weather):
        self.world = world
        self.plan = plan
        self.judge = judge
        self.witness = judge.witness
        self.reader = reader
        self.weather = weather
        self.dice = plan.dice
        self.deeds = []
        self._chooses_group = False  # of parameters; an announcement may hide the list's name
        self._means = ()  # what he means to choose, however it reads to the end
        self.drives = [world.drives[address] for address in plan.addresses]
        self._seen_ms = SEEN_US // MS + DRAWN_STEPS * plan.loop_us // MS
        self.common = weights((
            (12, self.tap), (4, self.hold), (6, self.start), (5, self.stop), (9, self.jog),
            (4, self.chord), (4, self.long_stop), (5, self.edit), (4, self.rest), (3, self.select),
            (4, self.start_others), (3, self.start_under_stop), (5, self.run_long),
        ))  # fmt: skip
        if plan.roams:
            self.common += weights(((6, self.walk_menu), (2, self.look_for_drives)))

    # --- time -----------------------------------------------------------------------------------

    def run(self, ms):
        """Let time pass, and let judge and reader look."""
        world = self.world
        while ms > 0:
            world.run(min(ms, SLICE_MS))
            ms -= SLICE_MS
            self.judge.look()
            self.reader.look()
            if self.ends_us and world.clock.now_us >= self.ends_us:
                raise TimeIsUp
            if self.weather.dips:
                self.dip(*self.weather.dips.pop())

    def note(self, text):
        if len(self.deeds) >= DEEDS:
            del self.deeds[0]
        self.deeds.append((self.world.clock.now_us, text))

    # --- keys -----------------------------------------------------------------------------------

    def down(self, key):
        if key not in self.witness.down and (key != "SET" or self._may_choose()):
            self.witness.key(key, True)
            self.note("%s down" % key)
            self.world.down(key)

    def up(self, key):
        if key in self.witness.down:
            self.witness.key(key, False)
            self.note("%s up" % key)
            self.world.up(key)

    def press(self, key, ms=100):
        self.up(key)
        self.down(key)
        self.run(ms)
        self.up(key)
        self.run(60)

    def let_go(self):
        for key in list(self.witness.down):
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
        """Make the drive shown turn, so that the next deed matters."""
        self.press("STOP")
        self.run(self.dice.between(100, 1_500))
        if self.dice.below(3):
            self.press("START", self.dice.one_of((60, 100, 800)))
            self.run(self.dice.between(300, 2_000))
        else:
            self.down(self.dice.one_of(JOGS))
            self.run(self.dice.between(100, 1_000))
            if self.dice.below(2):  # otherwise the key stays down for a while
                self.release_jogs()

    def run_long(self):
        """Let a motor turn for a while without any deed."""
        self.press("STOP")
        self.run(self.dice.between(500, 1_500))
        self.press("START")
        self.run(self.dice.between(2_000, 9_000))

    def turn_round(self):
        """Let a motor turn one way and the other, with time to look at the display."""
        self.run_long()
        self.press("REVERSE")
        self.run(self.dice.between(4_000, 9_000))

    def release_jogs(self):
        for key in JOGS:
            self.up(key)

    def start_under_stop(self):
        """Hold STOP down, and press keys that make a motor turn."""
        self.press("STOP")
        self.run(self.dice.between(300, 1_500))
        self.down("STOP")
        self.run(self.dice.between(20, 400))
        self.press(self.dice.one_of(("START", "START") + JOGS), self.dice.one_of((60, 300)))
        self.run(self.dice.between(20, 1_000))
        self.up("STOP")
        self.run(60)

    def start_others(self):
        """Start several drives, one after the other."""
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
        self.run(CONTACT_MS)
        for key in chosen:
            self.up(key)
            self.run(self.dice.one_of((1, 5, 30, 300)))

    def type_digits(self):
        """Set the setpoint digit by digit, mostly while a motor runs, or change one's mind."""
        if is_parameter(self.reader.rows[1]):
            self.press("PARAM")
        if self.dice.below(4):
            self.run_long()
        self.press("EDIT")
        for _ in range(1 + self.dice.below(7)):
            self.run(self.dice.one_of((20, 100, 900)))
            self.press(self.dice.one_of(TYPES), self.dice.one_of((60, 100, 100, 900)))
        self.run(self.dice.one_of((20, 2 * self._seen_ms, 6_000)))
        self.press(self.dice.one_of(TYPED_BY))
        self.run(self.dice.between(50, 3_000))

    # --- the menu, and the search ---------------------------------------------------------------

    def walk_menu(self):
        """Press keys of all kinds in the menu, mostly while a motor runs, and one that matters."""
        if self.dice.below(4):
            self.run_long()
        self.press(self.dice.one_of(OPENS), OPENS_MS)
        for _ in range(self.dice.below(8)):
            key = self.dice.one_of(WALKED)
            self.run(self._seen_ms if key == "SET" else self.dice.one_of((20, 100, 900)))
            self.press(key, self.dice.one_of((60, 100, 100, 100, 900)))
        self.run(2 * self._seen_ms)
        self.press(self.dice.one_of(("STOP", "STOP", "START") + JOGS), 2 * self._seen_ms)
        self.run(self.dice.between(50, 3_000))
        if self.dice.below(3):
            self.go_home()

    def look_up(self):
        """Look up parameters, faults and warnings, mostly while a motor runs; change a value that
        does no harm, or change one's mind.
        """
        if self.dice.below(4):
            self.run_long()
        self.press("PARAM", OPENS_MS)
        self.run(2 * self._seen_ms)
        wanted = self.dice.one_of((PARAMETERS, PARAMETERS, PARAMETERS, FAULT_MEMORY))
        if self.reader.rows[1].startswith(MENU + WHAT_IS):
            wanted = WHAT_IS
        if not self._walk_to(wanted):
            self.go_home()
            return
        self.press("SET")
        if wanted != PARAMETERS:
            for _ in range(self.dice.between(1, 8)):
                self.run(self._seen_ms)
                self.press(self.dice.one_of(("DOWN", "DOWN", "UP", "SET", "STOP", "PARAM")))
        elif self.dice.below(3):
            for _ in range(self.dice.below(20)):
                self.press("DOWN")
            self.run(2 * self._seen_ms)
            self._chooses_group = self.reader.rows[1].startswith(MENU)
            self.press("SET")
            self._chooses_group = False
            self._look_round()
        elif self._walk_to(BY_NUMBER):
            self.press("SET")
            self._change_harmless()
        self.run(self.dice.between(50, 3_000))
        if self.dice.below(3):
            self.go_home()

    def _walk_to(self, entry):
        """Go up to an entry of the menu; whether it is there."""
        for _ in range(HOME_TRIES):
            self.run(self._seen_ms)
            if self.reader.rows[1].startswith(MENU + entry):
                return True
            if not self.is_away():
                return False
            self.press("UP")
        return False

    def _look_round(self):
        """Walk a group of parameters."""
        for _ in range(self.dice.between(1, 10)):
            self.run(self.dice.one_of((20, 2 * self._seen_ms, 6_000, 8_000)))
            self.press(self.dice.one_of(LOOKED), self.dice.one_of((60, 100, 100, 900)))

    def _change_harmless(self):
        self.run(2 * self._seen_ms)
        for digit in HARMLESS_DIGITS:
            for _ in range(digit):
                self.press("UP", 60)
            self.press("NEXT", 60)
        self.run(2 * self._seen_ms)
        self.press("SET")
        self.run(self.dice.one_of((500, 6_000)))
        self.press(self.dice.one_of(("EDIT", "EDIT", "EDIT", "UP", "NEXT")))
        for _ in range(self.dice.below(5)):
            self.press(self.dice.one_of(TYPES))
        self.run(2 * self._seen_ms)
        self.press(self.dice.one_of(TYPED_BY), self.dice.one_of((100, 100, 2_500)))
        self.run(self.dice.one_of((500, 6_000)))

    def look_for_drives(self):
        """Leave the line for a search, up to the point where somebody changes his mind."""
        if self.dice.below(4):
            self.press("STOP")
            self.run(self.dice.between(500, 3_000))
        self.press("PARAM", OPENS_MS)
        for entry in (FIND, LEAVING):
            for _ in range(HOME_TRIES):
                self.run(self._seen_ms)
                if self.reader.rows[1].startswith(MENU + entry):
                    break
                self.press("DOWN")
            self.press("SET")
        self.run(self._seen_ms)
        if self.reader.rows[0].strip() in LEAVES:
            self.press("SET")
            self.run(4_000)
        if not self.witness.searches:
            return
        for _ in range(self.dice.between(1, 10)):
            self.press(self.dice.one_of(("SET", "SET", "SET", "UP", "DOWN", "PARAM", "STOP")))
            self.run(self.dice.one_of((300, 2_000, 9_000)))
            if not self.witness.searches:
                return
        if self.dice.below(4):
            self.go_home()

    def go_home(self):
        """Leave the menu, and the search."""
        for _ in range(HOME_TRIES):
            self.run(self._seen_ms)
            if not self.is_away():
                return
            row_1, row_2 = self.reader.rows
            held = row_1.startswith(KEY_TEST)
            self.press("STOP" if HUNTS in row_2 else "PARAM", OPENS_MS if held else 100)

    def is_away(self):
        """Whether the menu is on the display, the page of any parameter, or the search."""
        reader = self.reader
        return self.witness.searches or reader.looks_up or reader.rows[1].startswith(MENU)

    def _may_choose(self):
        """Whether SET changes nothing that the panel is told of drives and line. In the menu he
        presses it only when he has read what he chooses."""
        row_1, row_2 = self.reader.rows
        if self.witness.searches:
            return not row_1.startswith(TAKES)
        witness = self.witness
        is_on_page = self.reader.looks_up
        if not witness.is_in_menu() and not row_2.startswith(MENU) and not is_on_page:
            return True
        moved_us = max(max(witness.up.values()), max(witness.pressed_us.values()))
        is_read = self.world.clock.now_us - moved_us >= (self._seen_ms - SLICE_MS) * MS
        if is_on_page:
            label = self.reader.label
            is_known = (
                row_1.startswith(TYPES_NUMBER)
                or label is not None
                and (label[0] == HARMLESS or row_2.startswith(label[0]) and row_2[5] != ".")
            )
            return is_read and not witness.down and self.reader.steady and is_known
        entry = row_2[1:].rstrip()
        is_drive = entry[:1] == "A" and entry[1:2].isdigit() and not entry.endswith(LEFT_ALONE)
        is_known = entry in CHOSEN or is_drive
        if self.plan.looks_up and (
            entry.startswith((PARAMETERS, FAULT_MEMORY, WHAT_IS, BY_NUMBER)) or self._chooses_group
        ):
            is_known = True
        if self._means and entry.startswith(self._means):
            is_known = True
        if row_1.startswith(SETTINGS) and not (self.plan.locks and entry == LOCK_CODE):
            is_known = entry not in CHANGING
        return is_read and not witness.down and self.reader.steady and is_known

    def select(self):
        self.press(self.dice.one_of(("ADDRESS_UP", "ADDRESS_DOWN")), self.dice.one_of((60, 900)))

    def rest(self):
        self.run(self.dice.between(500, 6_000))

    def edit(self):
        """Use parameter mode as an expert does, up to the point where he changes his mind."""
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


def weights(table):
    """A list in which each deed stands as often as its weight says."""
    found = []
    for weight, deed in table:
        found += [deed] * weight
    return found
