# SPDX-License-Identifier: MIT
"""The live panel in a terminal: the virtual world in real time, keys in, a picture out.

    live(world, speed=1)        # until q, Ctrl-C or the terminal's end

It joins the pieces: `terminal` (bytes and lines), `hand` (keys), `errand` (commands that take
time), `picture` (what is shown). However it ends, it stops the drives and leaves the terminal as
it was before.

A person is at the keys, and may mistype. Text never counts as keys: a command line stays open
until the person leaves it, and the panel ignores input that comes all at once, as a paste does,
except STOP. START and JOG need the display in sight. On a real line, where a motor turns, they
also need another key before them.
"""

import os
import time

from boards.sim.script import ORDER, ExpectationFailed, Script, ScriptError
from boards.sim.setpoint import Untyped
from tools.live.errand import ERRANDS, Errand
from tools.live.hand import Hand
from tools.live.keys import ARM, LETTERS, STARTERS, STOP
from tools.live.pace import FRAME_MS, Pace, RealPace
from tools.live.picture import COLUMNS, SAID_ROWS, Picture, fitted, folded, shows_display
from tools.live.terminal import ESCAPE, Strokes, Terminal

DRAW_MS = 50
TELEGRAMS_MS = 250  # slow enough to be read
CHECK_MS = 500
SIZE_MS = 2_000
TELEGRAMS = 16
ARMED_MS = 2_000

CTRL_C, CTRL_D, CTRL_U = "\x03", "\x04", "\x15"
BACKSPACES = ("\x08", "\x7f")
ENTERS = ("\r", "\n")
COMMAND_MAX = 70
KEY_COMMANDS = ("down", "up")
PRESSING = ("press", "hold", "down")
QUITS = ("quit", "q")
HELP_WORDS = ORDER + ("help", "quit")
HELP = [" ".join(HELP_WORDS[at : at + 12]) for at in range(0, len(HELP_WORDS), 12)]
LEFT = "every drive was sent OFF1."
LINE_CUT = "the line is cut, and no drive could be sent OFF1."
PASTED = "that came all at once, as a paste does: it was left out"
STOP_KEPT = ", but for STOP"
OUT_OF_SIGHT = "no %s while the display is not in sight: make the terminal larger"
UNARMED = "on a real line %s is two keys within 2 s: g, then the letter"
ARMED = "g: now the letter of START or of a JOG"
WAITING = "waiting, %d s left (space: STOP, Esc: no further): %s"

STROKES = LETTERS + (
    (" ", STOP), ("UP", "UP"), ("DOWN", "DOWN"), ("RIGHT", "NEXT"), ("LEFT", "PREVIOUS"),
)  # fmt: skip


def live(world, speed, said=()):
    """Run until the person leaves; then stop the drives. KeyboardInterrupt if it was by Ctrl-C.

    said: lines for the person, until the first stroke.
    """
    terminal = Terminal()
    session = Session(world, shows_boxes(os.getenv), said)
    there = True
    try:
        terminal.open()
        if world.port is None:
            run(session, terminal, Pace(world.clock, session, speed, time))
        else:
            run(session, terminal, RealPace(world.clock, session))
    except EOFError:
        there = False
    finally:
        ran = turning(world)
        try:
            world.close()
        finally:
            terminal.close()
        if there:
            print(farewell(world, ran))


def run(session, terminal, pace):
    """One frame after the other: keys, time, now and then the picture."""
    strokes = Strokes()
    size = terminal.size()
    sized_ms = 0
    drawn_ms = -DRAW_MS
    while not session.left:
        typed = terminal.read(0 if pace.late else FRAME_MS)
        taken = strokes.take(typed, pace.now_ms)
        if session.may_start(taken) or pace.now_ms - sized_ms >= SIZE_MS:
            sized_ms = pace.now_ms
            before, size = size, terminal.size()
            if size != before:
                terminal.clear()
        session.in_sight = shows_display(*size)
        if strokes.pasted:
            session.take_paste(taken, strokes.brackets, pace.now_ms)
        else:
            for stroke in taken:
                session.take(stroke, pace.now_ms)
        pace.follow()
        if pace.now_ms - drawn_ms >= DRAW_MS:
            drawn_ms = pace.now_ms
            terminal.draw(fitted(session.lines(pace.now_ms, pace.speed), *size))


class Session:
    """What a person does to the world, and sees of it, as strokes and lines, for any terminal.

    left: the person wants to go. command: what is being typed after `:`, or None: keys. errand:
    the command that lets time pass now, or None. said: up to SAID_ROWS lines for the person, until
    the next stroke. in_sight: the terminal has room for the whole display.
    """

    def __init__(self, world, boxes, said=()):
        self.hand = Hand(world)
        self.left = False
        self.command = None
        self.errand = None
        self.said = []
        self.in_sight = True
        self._keys = {stroke: key for stroke, key in STROKES if key in world.keypad.names}
        self._armed_ms = -ARMED_MS  # when ARM was typed
        self._begun = ""  # the command that the errand is
        self._world = world
        self._picture = Picture(world, self.hand, boxes)
        self._script = Script(world, "keyboard", self._print)
        self._drawn_us = world.clock.now_us
        self._telegrams = ()
        self._telegrams_ms = -TELEGRAMS_MS
        self.broken = ""
        self._checked_ms = 0
        for line in said:
            self._print(line)

    def run(self, ms):
        """Let so much of the world's time pass, or less, when a command is over before that."""
        if not self.errand:
            self._world.run(ms)
            return
        try:
            self.errand.run(ms)
        except Untyped as error:
            self._end_errand("ended early: ")
            self._print(str(error))
            return
        if not self.errand.left_us():
            self._end_errand("done: ")

    def take(self, stroke, now_ms):
        """One stroke, as `Strokes` names them; now_ms is real time. KeyboardInterrupt: Ctrl-C."""
        if stroke == CTRL_C:
            raise KeyboardInterrupt
        self.said = []
        if self.errand:
            self._interrupt(stroke, now_ms)
        elif self.command is not None:
            self._type(stroke, now_ms)
        elif stroke in ("q", CTRL_D):
            self.left = True
        elif stroke == ":":
            self.command = ""
        elif stroke == ESCAPE:
            self.hand.let_go()
        else:
            self._press(stroke, now_ms)

    def may_start(self, strokes):
        """Whether these strokes may turn a motor: is the display in sight then?"""
        if self.command is not None:
            return any(stroke in ENTERS for stroke in strokes)
        return any(self._keys.get(stroke.lower()) in STARTERS for stroke in strokes)

    def take_paste(self, strokes, brackets, now_ms):
        """Take strokes that were not typed one by one: only STOP counts, and Ctrl-C. In an open
        command line they are text, if they stand in no brackets; its Enter must be typed.
        """
        if CTRL_C in strokes:
            raise KeyboardInterrupt
        if self.command is not None and not self.errand and not brackets:
            for stroke in strokes:
                if stroke != ESCAPE and stroke not in ENTERS:
                    self.take(stroke, now_ms)
            return
        stops = [stroke for stroke in strokes if self._keys.get(stroke.lower()) == STOP]
        if ESCAPE in strokes:
            self.hand.let_go()
        if stops and self.errand:
            self._interrupt(" ", now_ms)
        elif stops:
            self._press(" ", now_ms)
        self.said = [PASTED + (STOP_KEPT if stops else "")]

    def lines(self, now_ms, speed):
        """The picture now; now_ms is real time, speed the true one."""
        for line in self._world.notices:
            self._print(line)
        self._world.notices = []
        world_us = self._world.clock.now_us
        self._picture.turn(world_us - self._drawn_us)
        self._drawn_us = world_us
        if now_ms - self._telegrams_ms >= TELEGRAMS_MS:
            self._telegrams_ms = now_ms
            self._telegrams = self._world.wire.log.last(TELEGRAMS)
        if now_ms - self._checked_ms >= CHECK_MS:
            self._checked_ms = now_ms
            self._check()
        command = None if self.errand else self.command  # which waits for the errand
        return self._picture.lines(self._telegrams, self._bottom(), self.broken, speed, command)

    def _bottom(self):
        if self.errand:
            seconds = -(-self.errand.left_us() // 1_000_000)
            return [WAITING % (seconds, self._begun)] + self.said[-1:]
        return self.said

    def _press(self, stroke, now_ms):
        small = stroke.lower() if len(stroke) == 1 else stroke
        key = self._keys.get(small)
        armed_ms, self._armed_ms = self._armed_ms, -ARMED_MS
        if stroke == ARM and self._world.port is not None:
            self._armed_ms = now_ms
            self.said = [ARMED]
        elif key is None:
            name = stroke if len(stroke) == 1 and stroke > " " else "that key"
            self.said = ["%s does nothing here; the letters stand beside the keys" % name]
        elif small != stroke and self.hand.holds(key):
            self.hand.hold(key, now_ms)  # the keyboard repeats it
        elif not self._may_press(key, now_ms - armed_ms < ARMED_MS):
            return
        elif small != stroke:
            self.hand.hold(key, now_ms)
        elif not self.hand.tap(key):
            self.said = ["too fast: this %s was left out" % key]

    def _may_press(self, key, armed):
        """Whether a key may go down now. If one that turns a motor may not, say why."""
        if key not in STARTERS:
            return True
        if not self.in_sight:
            self._print(OUT_OF_SIGHT % key)
        elif self._world.port is not None and not armed:
            self._print(UNARMED % key)
        else:
            return True
        return False

    def _interrupt(self, stroke, now_ms):
        """A stroke while a command lets time pass: STOP and Esc end that, the others wait."""
        if stroke in ("q", CTRL_D):
            self.left = True
            return
        if stroke == ESCAPE:
            self.hand.let_go()
        elif self._keys.get(stroke.lower()) == STOP:
            self._press(stroke, now_ms)  # before the command lets go of its key
        else:
            self.said = ["a key has to wait until the command is done"]
            return
        self._end_errand("ended early: ")

    def _end_errand(self, how):
        self.errand.end()
        self.errand = None
        self._print(how + self._begun)

    def _type(self, stroke, now_ms):
        command = self.command
        if stroke == ESCAPE or stroke in ENTERS and not command:
            self.command = None
        elif stroke in ENTERS:
            self.command = ""  # the command line stays open: the next stroke is not a key
            self._do(command)
        elif stroke == " " and command[-1:] in ("", " "):  # no command needs it: it is STOP
            self.command = ""
            self._press(stroke, now_ms)
        elif stroke in BACKSPACES:
            self.command = command[:-1]
        elif stroke == CTRL_U:
            self.command = ""
        elif len(stroke) == 1 and stroke >= " " and len(command) < COMMAND_MAX:
            self.command = command + stroke

    def _do(self, command):
        """Do what was typed after `:`; say what it prints, or what is wrong with it."""
        word = command.split("#")[0].strip()
        if word == "help":
            self.said = list(HELP)
        elif word in QUITS:
            self.left = True
        elif word:
            self._obey(command)

    def _obey(self, command):
        """One line of the script language."""
        try:
            name, values = self._script.understood(command)
            if name in PRESSING and not self._may_press(values[0], True):
                return
            if name in ERRANDS:
                self._begun = command
                self.errand = Errand(self._world, self.hand, name, values)
                return
            self._script.do(name, values)
            if name in KEY_COMMANDS:
                self.hand.fix(values[0], name == "down")
        except ScriptError as error:
            self._print(str(error))
        except ExpectationFailed as error:
            wrong, row_1, row_2 = str(error).split("\n")
            self._print(wrong)
            self._print(row_1 + " " + row_2)
        if not self.said:
            self._print("done: " + command)

    def _print(self, line):
        """Say a line, broken into several if it is too long. Keep the last few lines; if one alone
        needs more, keep its beginning."""
        self.said = (self.said + folded(line, COLUMNS)[:SAID_ROWS])[-SAID_ROWS:]

    def _check(self):
        try:
            self._world.check()
        except AssertionError as error:
            self.broken = str(error)


def shows_boxes(getenv):
    """Whether the environment says that the terminal understands UTF-8."""
    for name in ("LC_ALL", "LC_CTYPE", "LANG"):
        value = getenv(name)
        if value:
            return "UTF8" in value.upper().replace("-", "")
    return False


def turning(world):
    """Which motors turn, and how fast: [(address, hz)]."""
    drives = world.drives
    return [(address, drives[address].hz()) for address in sorted(drives) if drives[address].hz()]


def farewell(world, ran):
    """What the panel says when it has gone; ran: what `turning` answered before."""
    seconds = world.clock.now_us // 1_000_000
    if world.port is not None:
        return "USS panel: ended; " + (LINE_CUT if world.port.is_cut else LEFT)
    text = "USS panel: ended after %d:%02d:%02d of the world's time; " % (
        seconds // 3600, seconds // 60 % 60, seconds % 60,
    )  # fmt: skip
    if not ran:
        return text + "no motor was turning."
    return text + "stopped: %s." % ", ".join("A%d at %.2f Hz" % motor for motor in ran)
