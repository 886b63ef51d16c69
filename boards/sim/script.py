# SPDX-License-Identifier: MIT
"""The script language of the simulated panel: one command a line, for people and for tests.

    press START          # a tap; everything after # is a comment
    wait 5000
    expect RUNNING
    line flip 0.001      # from now on a bit of every thousandth character is wrong

The commands are the table COMMANDS. A line that cannot be understood is a ScriptError that names
script and line; an expectation that fails is an ExpectationFailed that shows the display. What the
firmware raises while a command lets time pass goes through as it is.
"""

from boards.sim.dice import Dice
from boards.sim.drives.switches import switch_value
from boards.sim.line.faults import KINDS, SUPPLIES, WAYS, LineFaults
from boards.sim.drives.mains import Mains
from boards.sim.drives.power.plant import EXPONENTS, FAN
from boards.sim.setpoint import Untyped, centihertz, typed

FAULT_MAX = 9999
DAYS_MAX = 100
MS_MAX = DAYS_MAX * 24 * 3600 * 1000
COUNT_DIGITS_MAX = 9
LINE_MAX = 1000  # characters of a command
DICE = 2  # `which` of the line's dice; the drives' delays come from other dice and do not change


class ScriptError(Exception):
    """A line that is no command. Text: script:line: what is wrong."""


class ExpectationFailed(Exception):
    """The display does not show what was expected. Text: script:line: what, and the display."""


class Refused(Exception):
    """A command has a value that is well-formed, but that the drive refuses."""


class Script:
    """world: a `World`. name: of the script, for messages. show: takes each line of output."""

    def __init__(self, world, name="script", show=print):
        self.world = world
        self.show = show
        self._name = name
        self._line = 0

    def run(self, lines):
        """Do the commands of the lines, one after the other."""
        for line in lines:
            name, values = self.understood(line)
            if name:
                self.do(name, values)

    def understood(self, line):
        """The next line: the name of its command and the values for it, or None and nothing."""
        self._line += 1
        if len(line) > LINE_MAX:
            raise self._error("a line of more than %d characters is no command" % LINE_MAX)
        words = line.split("#", 1)[0].split()
        if not words:
            return None, ()
        name = words[0]
        if name not in COMMANDS:
            raise self._error("unknown command %s (there are: %s)" % (name, " ".join(ORDER)))
        if name in self.world.refused:
            raise self._error(self.world.refused[name])
        usage, readers, optional, _ = COMMANDS[name]
        arguments = words[1:]
        if readers and readers[-1] is text:
            arguments = arguments[: len(readers) - 1] + [" ".join(arguments[len(readers) - 1 :])]
            if not arguments[-1]:
                arguments.pop()
        if not len(readers) - optional <= len(arguments) <= len(readers):
            raise self._error("use: %s" % usage)
        try:
            return name, [reader(self.world, word) for reader, word in zip(readers, arguments)]
        except ValueError as error:
            raise self._error("%s (use: %s)" % (error.args[0], usage))

    def do(self, name, values):
        """Do a command, as `understood` answered it."""
        usage, _, _, command = COMMANDS[name]
        try:
            command(self, *values)
        except Refused as error:
            raise self._error("%s (use: %s)" % (error, usage))

    # --- what the commands do -------------------------------------------------------------------

    def lcd(self):
        for row in self.world.lcd():
            self.show("|%s|" % row)

    def bus(self, count):
        for at_us, from_panel, characters in self.world.wire.log.last(count):
            shown = " ".join("%02X" % character for character in characters)
            self.show("%10d %s %s" % (at_us, ">" if from_panel else "<", shown))

    def param(self, drive, parameter, value=None):
        number, index = parameter
        try:
            if value is not None:
                drive.write(number, index, value)
            now = drive.read(number, index)
        except (ValueError, KeyError) as error:
            raise Refused(error.args[0])
        self.show("%s=%s" % (parameter_name(number, index), now))

    def fault(self, drive, number, lasting=None):
        try:
            drive.fault(number, 0, lasting is not None)
        except ValueError as error:
            raise Refused(error.args[0])

    def set_switch(self, drive, setting):
        """Set how the drive behaves where the documents leave it open."""
        name, wanted = setting
        if wanted is not None:
            drive.switches.set(name, wanted)
        self.show("%s=%s" % (name, int(getattr(drive.switches, name))))

    def warn(self, drive, number, on=True):
        drive.warn(number, on)

    def load(self, drive, percent, kind=FAN):
        drive.load(percent, kind)

    def setpoint(self, wanted):
        try:
            for key, down_ms, up_ms in typed(self.world, wanted):
                if key:
                    self.world.down(key)
                    self.world.run(down_ms)
                    self.world.up(key)
                self.world.run(up_ms)
        except Untyped as error:
            raise Refused(error.args[0])

    # --- the line -------------------------------------------------------------------------------

    def faults(self):
        """The faults of the line, made at the first command that needs them."""
        world = self.world
        if world.wire.faults is None:
            dice = Dice(getattr(world, "seed", 0), DICE)
            LineFaults(world.wire, dice.random, on_dip=getattr(world, "dip", None))
        return world.wire.faults

    def line(self, kind, rate=None):
        faults = self.faults()
        if kind == "calm":
            faults.calm()
        elif rate is None:
            self.show("%s: %s, %d times" % (kind, faults.rates[kind], faults.count[kind]))
        else:
            try:
                faults.set(kind, rate)
            except ValueError as error:
                raise Refused(error.args[0])

    def strike(self, kind, how_much=None):
        try:
            self.faults().strike(kind, how_much)
        except ValueError as error:
            raise Refused(error.args[0])

    def late(self, drive, ms):
        self.faults().strike("late", ms, drive)

    def cut(self, name, way="both"):
        self.faults().cut(name, way)

    def dip(self, ms, whose="all"):
        world = self.world
        if whose != "panel":
            mains = getattr(world, "mains", None)
            if mains is None:
                mains = world.mains = Mains(world.clock, list(world.drives.values()))
            mains.dip(ms)
        if whose != "drives" and hasattr(world, "cut_power"):
            world.cut_power()

    def expect(self, wanted):
        if not self.world.reads(wanted):
            raise ExpectationFailed(
                "%s:%d: expected %s, the display shows\n|%s|\n|%s|"
                % ((self._name, self._line, wanted) + self.world.lcd())
            )

    def _error(self, message):
        return ScriptError("%s:%d: %s" % (self._name, self._line, message))


# --- how arguments are read: the world and a word -> a value, or ValueError ---------------------


def key(world, word):
    if word not in world.keypad.names:
        raise ValueError("no key %s: there are %s" % (word, " ".join(world.keypad.names)))
    return word


def milliseconds(world, word):
    if not word.isdigit():
        raise ValueError("%s is no number of milliseconds" % word)
    if len(word) > len(str(MS_MAX)) or int(word) > MS_MAX:
        raise ValueError("more than %d milliseconds (%d days) are too many" % (MS_MAX, DAYS_MAX))
    return int(word)


def duration(world, word):
    if milliseconds(world, word) < 1:
        raise ValueError("a key is held for 1 millisecond at the least")
    return int(word)


def count(world, word):
    if not word.isdigit():
        raise ValueError("%s is no number" % word)
    if len(word) > COUNT_DIGITS_MAX:
        raise ValueError("%s has more than %d digits" % (word, COUNT_DIGITS_MAX))
    return int(word)


def drive(world, word):
    if not word.isdigit() or int(word) not in world.drives:
        there = " ".join(str(address) for address in sorted(world.drives))
        raise ValueError("no drive at address %s: there are %s" % (word, there))
    return world.drives[int(word)]


def parameter(world, word):
    """P0700, P0700[0], r0021: number and index."""
    digits, _, rest = word[1:].partition("[")
    index = rest[:-1] if rest.endswith("]") else "0" if not rest and "[" not in word else ""
    if word[:1] not in ("P", "p", "r") or not digits.isdigit() or not index.isdigit():
        raise ValueError("%s is no parameter like P0700[0]" % word)
    return int(digits), int(index)


def value(world, word):
    try:
        return float(word) if "." in word else int(word)
    except ValueError:
        raise ValueError("%s is no number" % word)


def fault(world, word):
    if word[:1] != "F" or not word[1:].isdigit() or not 0 < int(word[1:]) <= FAULT_MAX:
        raise ValueError("%s is no fault like F0001" % word)
    return int(word[1:])


def warning(world, word):
    if word[:1] != "A" or not word[1:].isdigit() or not 0 < int(word[1:]) <= FAULT_MAX:
        raise ValueError("%s is no warning like A0501" % word)
    return int(word[1:])


def power(world, word):
    if word != "cut":
        raise ValueError("%s is nothing that power does here" % word)
    return word


def kind(world, word):
    """A kind of fault of the line: blanks of its name are hyphens here."""
    word = word.replace("-", " ")
    if word not in KINDS:
        there = " ".join(sorted(KINDS)).replace("wire cut", "wire-cut")
        raise ValueError("no fault of the line is called %s: there are %s" % (word, there))
    return word


def kind_or_calm(world, word):
    return word if word == "calm" else kind(world, word)


def switch(world, word):
    if word not in ("on", "off"):
        raise ValueError("%s is neither on nor off" % word)
    return word == "on"


def setting(world, word):
    """NAME or NAME=VALUE of a switch of the drive: name and value, None to look."""
    name, equals, wanted = word.partition("=")
    try:
        if equals:
            return name, switch_value(name, wanted)
        switch_value(name, "0")
        return name, None
    except ValueError as error:
        raise ValueError("%s: %s" % (word, error.args[0]))


def setpoint(world, word):
    return centihertz(word)


def rate(world, word):
    """A number, on or off."""
    if word in ("on", "off"):
        return word == "on"
    try:
        return float(word) if "." in word else int(word)
    except ValueError:
        raise ValueError("%s is no rate: a number, on or off" % word)


def station(world, word):
    """panel or the address of a drive: the name of its place on the wire."""
    return word if word == "panel" else drive(world, word).name


def one_of(words):
    def reader(world, word):
        if word not in words:
            raise ValueError("%s is none of %s" % (word, " ".join(sorted(words))))
        return word

    return reader


def text(world, words):
    return words


def parameter_name(number, index):
    return "P%04d[%d]" % (number, index)


# Command: usage, readers of its arguments, how many of the last may be left out, what it does.
COMMANDS = {
    "press": ("press KEY", (key,), 0, lambda do, key: do.world.press(key)),
    "hold": ("hold KEY MS", (key, duration), 0, lambda do, key, ms: do.world.press(key, ms)),
    "down": ("down KEY", (key,), 0, lambda do, key: do.world.down(key)),
    "up": ("up KEY", (key,), 0, lambda do, key: do.world.up(key)),
    "setpoint": ("setpoint HZ", (setpoint,), 0, Script.setpoint),
    "wait": ("wait MS", (milliseconds,), 0, lambda do, ms: do.world.run(ms)),
    "lcd": ("lcd", (), 0, Script.lcd),
    "bus": ("bus N", (count,), 0, Script.bus),
    "drive": ("drive A", (drive,), 0, lambda do, drive: do.show(drive.report())),
    "param": ("param A P0700[0] [VALUE]", (drive, parameter, value), 1, Script.param),
    "fault": ("fault A F0001 [lasting]", (drive, fault, one_of(("lasting",))), 1, Script.fault),
    "clear": ("clear A", (drive,), 0, lambda do, drive: drive.clear_cause()),
    "warn": ("warn A A0501 [on|off]", (drive, warning, switch), 1, Script.warn),
    "load": ("load A PERCENT [fan|linear|constant]", (drive, count, one_of(EXPONENTS)), 1,
        Script.load),
    "supply": ("supply A VOLTS", (drive, count), 0, lambda do, drive, volts: drive.supply(volts)),
    "off": ("off A", (drive,), 0, lambda do, drive: drive.power_off()),
    "on": ("on A", (drive,), 0, lambda do, drive: drive.power_on()),
    "switch": ("switch A NAME[=VALUE]", (drive, setting), 0, Script.set_switch),
    "unplug": ("unplug A", (drive,), 0, lambda do, drive: drive.unplug()),
    "plug": ("plug A", (drive,), 0, lambda do, drive: drive.plug()),
    "hang": ("hang MS", (milliseconds,), 0, lambda do, ms: do.world.hang(ms)),
    "reset": ("reset", (), 0, lambda do: do.world.reset()),
    "power": ("power cut", (power,), 0, lambda do, _: do.world.cut_power()),
    "line": ("line KIND|calm [RATE]", (kind_or_calm, rate), 1, Script.line),
    "strike": ("strike KIND [N]", (kind, count), 1, Script.strike),
    "late": ("late A MS", (drive, milliseconds), 0, Script.late),
    "babble": ("babble MS", (milliseconds,), 0, lambda do, ms: do.strike("babble", ms)),
    "cut": ("cut A|panel [both|hears|talks]", (station, one_of(WAYS)), 1, Script.cut),
    "mend": ("mend", (), 0, lambda do: do.faults().mend()),
    "dip": ("dip MS [all|drives|panel]", (milliseconds, one_of(SUPPLIES)), 1, Script.dip),
    "expect": ("expect TEXT", (text,), 0, Script.expect),
}  # fmt: skip

ORDER = (
    "press", "hold", "down", "up", "setpoint", "wait", "lcd", "expect", "bus", "drive", "param",
    "fault", "clear", "warn", "load", "supply", "off", "on", "switch", "unplug", "plug", "hang",
    "reset", "power",
    "line", "strike", "late", "babble", "cut", "mend", "dip",
)  # fmt: skip
OF_THE_LINE = ORDER[-7:]  # these cannot be done on a real line
