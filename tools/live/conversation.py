# SPDX-License-Identifier: MIT
"""The panel's side of the language between a running panel and what shows it: README.md.

    conversation = Conversation(world, speed=1, time=time)
    conversation.take('{"t":"down","key":"START"}')     # whatever came
    conversation.follow()                               # time passes as it really does
    for line in conversation.news(): ...                # bytes, while somebody reads
    conversation.answers()                              # what must not be dropped

It knows neither a pipe nor a browser: `lines` and `in_browser` are its ways to the outside.
"""

import version
from boards.sim.script import COMMANDS, ORDER, ExpectationFailed, Script, ScriptError
from boards.sim.setpoint import Untyped
from panel.keys.compact import FUNCTIONS
from tools.live.errand import ERRANDS, Errand
from tools.live.holds import Holds, KeyRefused
from tools.live.keys import LETTERS, STOP
from tools.live.language import SPEED_MAX, VERSION, Misunderstood, spoken, understood
from tools.live.pace import UNHEARD_MS, Pace, RealPace
from tools.live.sights import Sights

STATE_MS = 20
DRIVES_MS = 100
TIME_MS = 250
COUNT_MS = 1_000
CHECK_MS = 500
ANSWERS_MAX = 100

ANOTHER_VERSION = "this panel speaks version %d"
BUSY = "another command lets time pass: %s"
REAL_TIME = "the time of a real line is the real one"
SPEEDS = "time passes 0...%d times as fast" % SPEED_MAX
STALE = "the panel stood still: this %s was left out"
NOBODY = "nobody was heard at the panel for 2 s: every drive was sent OFF1"
FN = "FN"
DONE, ENDED = 1, 0


class Conversation:
    """world: a `World`. speed: how many times as fast its time passes. time: has ticks_us and
    ticks_diff. said: lines for people, about the world.
    """

    def __init__(self, world, speed, time, said=()):
        self.hand = Holds(world)  # as `Pace` calls it
        self.broken = ""
        self._world = world
        self._sights = Sights(world)
        self._script = Script(world, "command", self._print)
        self._printed = []
        self._errand = None  # the command that lets time pass now
        self._doing = None  # its message
        self._answers = []
        self._is_real = world.port is not None
        self._time_of = time
        self._followed_us = time.ticks_us()
        self._pace = (
            RealPace(world.clock, self) if self._is_real else Pace(world.clock, self, speed, time)
        )
        self._notices = list(said)
        self._was_lonely = False
        self._sent = {}  # kind: the fields that were sent last
        self._due_ms = {}  # kind: when it is looked at again

    # --- time -----------------------------------------------------------------------------------

    @property
    def now_ms(self):
        """Real time."""
        return self._pace.now_ms

    def follow(self):
        """Let as much time pass in the world as has really passed."""
        self._pace.follow()
        if self.hand.lonely and not self._was_lonely:
            self._end_errand(ENDED)
            self._notices.append(NOBODY)
        self._was_lonely = self.hand.lonely
        self._followed_us = self._time_of.ticks_us()

    def run(self, ms):
        """Let so much of the world's time pass: `Pace`."""
        if self._errand is None:
            self._world.run(ms)
            return
        try:
            self._errand.run(ms)
        except Untyped as error:
            self._print(str(error))
            self._end_errand(ENDED)
            return
        if not self._errand.left_us():
            self._end_errand(DONE)

    # --- what comes -----------------------------------------------------------------------------

    def take(self, line):
        """Do what a message says. What is wrong with it is answered."""
        message = {}
        try:
            message = understood(line)
            self.hand.hear(message["id"], self.now_ms)
            TAKERS[message["t"]](self, message)
        except Misunderstood as error:
            self._answer("error", id=error.id, n=error.n, text=str(error))
        except KeyRefused as error:
            self._refuse(message, str(error))

    def end(self):
        """Nobody will ever say anything again."""
        self.hand.vanish()
        self._end_errand(ENDED)

    def _hello(self, message):
        if message["v"] != VERSION:
            self.hand.leave(message["id"])
            self._refuse(message, ANOTHER_VERSION % VERSION)
            return
        self.forget()

    def _alive(self, message):
        pass  # it was heard

    def _bye(self, message):
        self.hand.leave(message["id"])

    def _down(self, message):
        if self._is_stale() and message["key"] != STOP:
            raise KeyRefused(STALE % message["key"])
        self.hand.down(message["id"], message["key"])
        if message["key"] == STOP:
            self._end_errand(ENDED)

    def _is_stale(self):
        """Whether the panel stood still on a real line: what came meanwhile is of any age."""
        time = self._time_of
        stood_us = time.ticks_diff(time.ticks_us(), self._followed_us)
        return self._is_real and stood_us >= UNHEARD_MS * 1000

    def _up(self, message):
        self.hand.up(message["id"], message["key"])

    def _release(self, message):
        self.hand.release(message["id"])
        self._end_errand(ENDED)

    def _arm(self, message):
        self.hand.arm(message["id"])

    def _speed(self, message):
        if self._is_real:
            self._refuse(message, REAL_TIME)
        elif 0 <= message["x"] <= SPEED_MAX:
            self._pace.want(message["x"])
        else:
            self._refuse(message, SPEEDS)

    def _do(self, message):
        """A line of the script language."""
        try:
            name, values = self._script.understood(message["line"])
            if name in ("down", "up"):  # held by this front end, as if it had a button for it
                (self.hand.down if name == "down" else self.hand.up)(message["id"], *values)
            elif name in ERRANDS:
                self._begin(message, name, values)
                return
            elif name:
                self._script.do(name, values)
        except (ScriptError, ExpectationFailed) as error:
            self._printed += str(error).split("\n")
            self._finish(message, ENDED)
            return
        self._finish(message, DONE)

    def _begin(self, message, name, values):
        if self._errand is not None:
            self._refuse(message, BUSY % self._doing["line"])
            return
        self._errand = Errand(self._world, self.hand, name, values)
        self._doing = message

    def _end_errand(self, how):
        if self._errand is not None:
            self._errand.end()
            self._errand = None
            self._finish(self._doing, how)

    def _print(self, line):
        self._printed.append(line)

    def _finish(self, message, how):
        printed, self._printed = self._printed, []
        self._answer("done", id=message["id"], n=message["n"], ok=how, out=printed)

    def _refuse(self, message, text):
        self._answer("error", id=message.get("id", 0), n=message.get("n"), text=text)

    def _answer(self, kind, **fields):
        if len(self._answers) < ANSWERS_MAX:
            self._answers.append(spoken(kind, **fields))

    # --- what goes ------------------------------------------------------------------------------

    def forget(self):
        """Say everything anew."""
        self._sent.clear()
        self._due_ms.clear()

    def answers(self):
        """The answers that nobody has taken yet, as bytes."""
        answers, self._answers = self._answers, []
        return answers

    def news(self):
        """What has changed, as bytes, a line each."""
        lines = []
        if "hello" not in self._sent:
            self._tell(lines, "hello", self._greeting())
        if self._is_due("state", STATE_MS):
            self._tell(lines, "state", self._state(), besides=("us",))
        if self._is_due("drives", DRIVES_MS):
            self._tell(lines, "drives", self._drives(), besides=("us",))
        if self._is_due("time", TIME_MS):
            self._tell(lines, "time", self._time())
        if self._is_due("count", COUNT_MS):
            self._tell(lines, "count", {"drives": self._sights.counters()})
        if self._is_due("broken", CHECK_MS):
            self._tell(lines, "broken", {"text": self._complaint()})
        for number, us, from_panel, hexed, text, wrong in self._sights.telegrams():
            whence = "panel" if from_panel else "drive"
            fields = {"n": number, "us": us, "from": whence, "hex": hexed, "text": text}
            lines.append(spoken("telegram", wrong=wrong, **fields))
        for text in self._said():
            lines.append(spoken("notice", text=text))
        return lines

    def _is_due(self, kind, every_ms):
        now_ms = self.now_ms
        if now_ms < self._due_ms.get(kind, 0):
            return False
        self._due_ms[kind] = now_ms + every_ms
        return True

    def _tell(self, lines, kind, fields, besides=()):
        """Say it if anything but the fields `besides` has changed."""
        new = {name: value for name, value in fields.items() if name not in besides}
        if self._sent.get(kind) != new:
            self._sent[kind] = new
            lines.append(spoken(kind, **fields))

    def _greeting(self):
        world = self._world
        refused, names = world.refused, list(world.keypad.names)
        return {
            "v": VERSION,
            "version": version.VERSION,
            "place": world.place,
            "real": int(self._is_real),
            "keys": names,
            "letters": {key: letter for letter, key in LETTERS if key in names},
            "behind_fn": {
                key: FUNCTIONS[key][1:] for key in names if FN in names and key in FUNCTIONS
            },
            "drives": self._sights.addresses(),
            "baud": world.wire.baud,
            "lease_ms": UNHEARD_MS,
            "commands": {name: COMMANDS[name][0] for name in ORDER if name not in refused},
        }

    def _state(self):
        doing = None
        if self._errand is not None:
            left_ms = -(-self._errand.left_us() // 1_000_000) * 1000
            doing = {"line": self._doing["line"], "left_ms": left_ms}
        return {
            "us": self._world.clock.now_us,
            "lcd": self._sights.lcd(),
            "down": self.hand.keys(),
            "shown": self._world.selected(),
            "doing": doing,
        }

    def _drives(self):
        return {"us": self._world.clock.now_us, "drives": self._sights.drives()}

    def _time(self):
        pace = self._pace
        return {
            "us": self._world.clock.now_us,
            "speed": round(pace.speed, 2),
            "wanted": pace.wanted,
        }

    def _complaint(self):
        try:
            self._world.check()
        except AssertionError as error:
            self.broken = str(error)
        return self.broken

    def _said(self):
        said = self._notices + list(self._world.notices)
        self._notices = []
        if said and self._world.notices:
            self._world.notices = []
        return said


TAKERS = {
    "hello": Conversation._hello,
    "alive": Conversation._alive,
    "bye": Conversation._bye,
    "down": Conversation._down,
    "up": Conversation._up,
    "release": Conversation._release,
    "arm": Conversation._arm,
    "do": Conversation._do,
    "speed": Conversation._speed,
}
