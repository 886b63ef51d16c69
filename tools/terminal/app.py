# SPDX-License-Identifier: MIT
"""The live panel's window: strokes and the mouse in, messages to the panel out, a picture of what
it tells.

    PanelApp(child, driver_class=TerminalDriver).run()      # child: as `Child`, and it has told

A person is at the keys, and may mistype. Text never counts as keys: a command line stays open
until the person leaves it, and what comes all at once, as a paste does, is left out, except STOP.
START and JOG need the display in sight. On a real line, where a motor turns, they also need
another key before them. The panel hears from this front end only while the terminal answers.
"""

import asyncio
import re
import time
from functools import partial
from itertools import zip_longest

from rich.text import Text
from textual import events
from textual.app import App, ScreenStackError
from textual.containers import Grid, Horizontal, Vertical, VerticalScroll
from textual.css.query import NoMatches
from textual.widgets import Static

from tools.live.keys import ARM, LETTERS, STARTERS, STOP
from tools.terminal import manuals, views
from tools.terminal.hand import Hand
from tools.terminal.letters import COMMAND, HELP, HEX, PAUSE, QUIT, SETPOINT, keys_of
from tools.terminal.shafts import Shafts
from tools.terminal.widgets import LEFT, STOPPED, KeyCap, Line, Shown, Telegrams

DRAW_S = 0.05
TELEGRAMS_S = 0.25  # slow enough to be read
ALIVE_S = 0.1
HEARD_S = 0.3  # a panel that was silent for so long does not answer
ARMED_S = 2.0
SAID_ROWS = 3
KEY_COLUMNS = 3
ARMING = "ARM"  # the name beside `g`

PRESSING = ("press", "hold", "down")
QUITS = ("quit", "q")
CTRL_C = "\x03"
PASTED = "that came all at once, as a paste does: it was left out"
STOP_KEPT = ", but for STOP"
OUT_OF_SIGHT = "no %s while the display is not in sight: make the terminal larger"
UNARMED = "on a real line %s is two keys within 2 s: g, then the letter"
ARMED = "g: now the letter of START or of a JOG"
TOO_FAST = "too fast: this %s was left out"
UNHEARD = "no %s while the panel does not answer"
WAITING = "waiting, %d s left (space: STOP, Esc: no further): %s"
NOTHING = "%s does nothing here; the letters stand beside the keys"
UNKNOWN = "nothing is called %s: see the manuals, or :help"
NO_SPEED = "use: speed N (0...100: time passes N times as fast; 0: it stands)"
NO_SETPOINT = "%s is no setpoint, such as 12.5 or -30"
HINTS = " small: tap  CAPITAL: hold  Esc: let go  space: STOP  :command  ? help  q: quit"
HINTS_OF_LINE = {
    COMMAND: " Enter: do it  empty line, Esc: back to the keys  two spaces: STOP",
    SETPOINT: " in Hz, negative: to the left  Enter: it takes effect  Esc: no  space: STOP",
}
SMALL = "q quits. %d x %d is too small: the panel needs %d x %d"
ROWS, COLUMNS = 24, 79
FIGURE = re.compile(r"-?\d{1,3}([.,]\d{0,2})?")


class PanelApp(App):
    """child: has read(), send(kind, **fields), is_over, fileno(), errors() and hear().

    way_out: how the person left: "quit", "interrupt" or None: the panel has ended by itself.
    heard_s: a panel that was silent for so long is not started. armed_s: so long `g` counts.
    """

    CSS_PATH = "window.tcss"
    ENABLE_COMMAND_PALETTE = False
    BINDINGS = []
    VERTICAL_BREAKPOINTS = [(0, "-low"), (24, "-usual"), (34, "-tall")]
    HORIZONTAL_BREAKPOINTS = [(0, "-narrow"), (79, "-wide")]

    def __init__(self, child, told, **others):
        super().__init__(**others)
        self.way_out = None
        self.heard_s = HEARD_S
        self.armed_s = ARMED_S
        self.told = told
        self._child = child
        self._real = bool(told.hello["real"])
        self.hand = Hand(child.send, self._real)
        self._keys = keys_of(told.hello["keys"])
        self._armed_at_s = None  # when ARM was typed
        self._heard_at_s = time.monotonic()  # when the panel was heard last
        self._said = []
        self._asked = {}  # number of a `do`: what was typed
        self._number = 0
        self._shafts = Shafts()

    # --- what is on the window ------------------------------------------------------------------

    def compose(self):
        yield Shown(id="head")
        with Horizontal(id="panel"):
            yield Shown(id="display")
            with Grid(id="keys"):
                yield from self._caps()
        yield Shown(id="hints")
        with VerticalScroll(id="drives_box"):
            yield Shown(id="drives")
        yield Shown(id="exchanges")
        with Vertical(id="middle"):
            yield Shown(id="telegrams_head")
            yield Telegrams(self.told.telegrams, id="telegrams")
            with VerticalScroll(id="help_box"):
                yield Shown(id="help")
        yield Shown(id="broken")
        yield Shown(id="said")
        with Horizontal(id="bottom"):
            yield Shown(id="prompt")
            yield Line(id="line")

    def _caps(self):
        """The keys, from top to bottom and from left to right."""
        names = self.told.hello["keys"]
        caps = []
        for letter, key in LETTERS:
            if key in names:
                armed = ARM if self._real and key in STARTERS else ""
                caps.append(KeyCap(armed + letter, key))
        if self._real:
            caps.append(KeyCap(ARM, ARMING))
        rows = -(-len(caps) // KEY_COLUMNS)
        for row in range(rows):
            yield from caps[row::rows]
            if len(caps[row::rows]) < KEY_COLUMNS:
                yield Static()

    def on_mount(self):
        for box in self.query(VerticalScroll):
            box.can_focus = False
        self.query_one("#line").display = False
        self.query_one("#help_box").display = False
        self.screen.set_focus(None)
        loop = asyncio.get_running_loop()
        loop.add_reader(self._child.fileno(), self._read)
        loop.add_reader(self._child.errors(), self._hear)
        self.set_interval(DRAW_S, partial(self._at_a_window, self._draw))
        self.set_interval(TELEGRAMS_S, partial(self._at_a_window, self._draw_telegrams))
        self.set_interval(ALIVE_S, self._sign_of_life)
        self._draw()
        self._draw_telegrams()

    def _at_a_window(self, draw):
        """A timer may ring once more while the window is being closed."""
        try:
            draw()
        except (NoMatches, ScreenStackError):
            pass

    def _draw(self):
        self.hand.step(now_ms())
        self.hand.see(self.told.down, now_ms())
        told = self.told
        for text in told.notices:
            self._say(text)
        told.notices.clear()
        self._shafts.turn(told.drives, told.us)
        self._show("#head", views.head(told))
        self._show("#display", views.display(told.lcd))
        self._show("#drives", views.drives(told, self._shafts))
        self._show("#exchanges", views.exchanges(told))
        self._show("#broken", Text("BROKEN: " + told.broken if told.broken else "", "bold red"))
        self._show("#said", Text("\n".join(self._bottom())))
        self._show("#hints", Text(self._hints()))
        held = (self.hand.held, self.hand.pressed)
        for cap in self.query(KeyCap):
            down = cap.key in told.down
            cap.show("HELD" if down and cap.key in held else "down" if down else "")

    def _draw_telegrams(self):
        telegrams = self.told.telegrams
        how = "  PAUSED, %s goes on" % PAUSE if telegrams.paused else "  %s: pause" % PAUSE
        how += "  %s: %s" % (HEX, "words" if self.query_one("#telegrams").in_hex else "hex")
        self._show("#telegrams_head", Text(" telegrams: > from the panel, < to it" + how, "dim"))
        self.query_one("#telegrams").refresh()

    def _show(self, where, text):
        self.query_one(where).show(text)

    def _hints(self):
        kind = self.query_one(Line).kind
        if kind:
            return HINTS_OF_LINE[kind]
        size = self.size
        if size.height < ROWS or size.width < COLUMNS:
            return SMALL % (size.width, size.height, COLUMNS, ROWS)
        return HINTS

    def _bottom(self):
        doing = self.told.doing
        if doing:
            seconds = -(-doing["left_ms"] // 1000)
            return [WAITING % (seconds, doing["line"])] + self._said[-1:]
        return self._said

    def _say(self, *lines):
        self._said = (self._said + [one for line in lines for one in line.split("\n")])[
            -SAID_ROWS:
        ]

    # --- from the panel -------------------------------------------------------------------------

    def _read(self):
        messages = self._child.read()
        if self._child.is_over:
            self._leave(None)
            return
        if messages:
            self._heard_at_s = time.monotonic()
        for message in messages:
            if message["t"] == "done":
                self._done(message)
            elif message["t"] == "error":
                self._refused(message)
            else:
                self.told.take(message)
                self.hand.see(self.told.down, now_ms())

    def _hear(self):
        if not self._child.hear():
            asyncio.get_running_loop().remove_reader(self._child.errors())

    def _done(self, message):
        line = self._asked.pop(message["n"], "")
        self._say(*message["out"])
        if not message["ok"] and not message["out"]:
            self._say("ended early: " + line)
        elif message["ok"] and not message["out"]:
            self._say("done: " + line)

    def _refused(self, message):
        if self._asked.pop(message["n"], None) is None:
            self.hand.refused()
        self._say(message["text"])

    # --- from the terminal ----------------------------------------------------------------------

    def _sign_of_life(self):
        """The panel hears that somebody is there as often as the terminal answers."""
        ask = getattr(self._driver, "ask", None)
        if ask is None:
            self.on_answered()
        else:
            ask()

    def on_answered(self, _=None):
        self._child.send("alive")

    def on_gone(self, _):
        self._leave("interrupt")

    def on_resize(self, _):
        """Draw everything. Textual would not, where the size is that of before again; but what a
        smaller terminal had no room for, even for a moment, is lost.
        """
        self.refresh()

    def on_app_blur(self, _):
        """Another window has the keyboard now, and gets the key's repeats."""
        if self.hand.held or self.hand.pressed:
            self.hand.let_go()

    async def on_event(self, event):
        """Strokes are taken here, one after the other, before Textual hands them on: whether one
        is a key or text must not depend on which message comes first.
        """
        if isinstance(event, events.Key) and not event.is_forwarded:
            self.take(event)
        else:
            await super().on_event(event)

    def take(self, event):
        """A stroke."""
        self._said = []
        if event.key == "ctrl+c":
            self._leave("interrupt")
        elif self.query_one(Line).kind:
            self._take_text(self.query_one(Line).take(event))
        elif event.key in (QUIT, "ctrl+d"):
            self._leave("quit")
        elif event.key == "escape":
            self._let_go()
        elif event.character in ACTIONS:
            ACTIONS[event.character](self)
        elif event.key in ("pageup", "pagedown"):
            self._page(1 if event.key == "pageup" else -1)
        else:
            self._stroke(event)

    def on_together(self, event):
        """Strokes that were not typed one by one: only STOP counts, and Ctrl-C. In an open command
        line they are text, if they stand in no brackets; its Enter must be typed.
        """
        strokes = event.strokes
        line = self.query_one(Line)
        if CTRL_C in strokes:
            self._leave("interrupt")
            return
        if line.kind and not event.brackets:
            line.put("".join(one for one in strokes if len(one) == 1 and one >= " "))
            return
        stops = any(self._keys.get(key_name(stroke)) == STOP for stroke in strokes)
        if "\x1b" in strokes or stops:
            self._let_go()
        if stops:
            self._tap(STOP)
        self._said = [PASTED + (STOP_KEPT if stops else "")]

    def on_paste(self, event):
        event.stop()

    # --- keys of the panel ----------------------------------------------------------------------

    def _stroke(self, event):
        name = event.character if event.character and event.is_printable else event.key
        name = "space" if name == " " else name
        key = self._keys.get(name.lower())
        if key is None:
            shown = event.character if event.is_printable and event.character else "that key"
            self._say(NOTHING % shown)
        elif name == name.lower():
            if self._may_press(key):
                self._tap(key)
        elif self.hand.holds(key) or self._may_press(key):
            if not self.hand.hold(key, now_ms()):
                self._say(TOO_FAST % key)

    def _tap(self, key):
        if not self.hand.tap(key, now_ms()):
            self._say(TOO_FAST % key)

    def _arm(self):
        if self._real:
            self._armed_at_s = time.monotonic()
            self._child.send("arm")
            self._say(ARMED)
        else:
            self._say(NOTHING % ARM)

    def _may_press(self, key):
        """Whether a key may go down now. If one that turns a motor may not, say why."""
        armed_at_s, self._armed_at_s = self._armed_at_s, None
        if key not in STARTERS:
            return True
        if not self._may_turn(key):
            return False
        if self._real and (armed_at_s is None or time.monotonic() - armed_at_s >= self.armed_s):
            self._say(UNARMED % key)
            return False
        return True

    def _may_turn(self, key):
        if not self.in_sight():
            self._say(OUT_OF_SIGHT % key)
        elif time.monotonic() - self._heard_at_s >= self.heard_s:
            self._say(UNHEARD % key)
        else:
            return True
        return False

    def in_sight(self):
        """Whether the whole display is on the screen, by the size that the terminal has now."""
        columns, rows = terminal_size(self)
        place = self.query_one("#display").region
        return place.right <= columns and place.bottom <= rows and place.area > 0

    def _let_go(self):
        self.hand.let_go()
        self._help(None)

    def on_key_cap_pressed(self, event):
        self._said = []
        if event.key == ARMING:
            self._arm()
        elif self._may_press(event.key):
            self.hand.press(event.key, now_ms())

    def on_key_cap_lifted(self, _):
        self.hand.lift()

    # --- the line to type on --------------------------------------------------------------------

    def _open_command(self):
        self._open(COMMAND)

    def _open_setpoint(self):
        self._open(SETPOINT)

    def _open(self, kind):
        self.query_one(Line).open(kind)
        self._show("#prompt", Text(" " + kind, "bold"))

    def _close(self):
        self.query_one(Line).close()
        self._show("#prompt", Text(""))

    def _take_text(self, typed):
        """What a stroke on the line means."""
        if typed is LEFT:
            self._close()
            self._let_go()
        elif typed is STOPPED:
            self._tap(STOP)
        elif typed is not None and self.query_one(Line).kind == SETPOINT:
            self._close()
            self._set(typed)
        elif typed is not None:
            self._obey(typed)

    def _obey(self, text):
        words = text.split("#")[0].split()
        if words[:1] == ["help"]:
            self._explain(" ".join(words[1:]))
        elif words and words[0] in QUITS:
            self._leave("quit")
        elif words[:1] == ["speed"]:
            self._speed(words[1:])
        elif words[:1] and words[0] in PRESSING and words[1:2] and words[1] in STARTERS:
            if self._may_turn(words[1]):
                self._do(text)
        elif words:
            self._do(text)

    def _speed(self, words):
        """How fast time passes; 0: it stands."""
        if len(words) == 1 and words[0].isdigit():
            self._child.send("speed", x=int(words[0]))
        else:
            self._say(NO_SPEED)

    def _set(self, text):
        if FIGURE.fullmatch(text):
            self._do("setpoint " + text.replace(",", "."))
        else:
            self._say(NO_SETPOINT % text)

    def _do(self, line):
        self._number += 1
        self._asked[self._number] = line
        self._child.send("do", n=self._number, line=line)

    # --- help, telegrams ------------------------------------------------------------------------

    def _toggle_help(self):
        if self.query_one("#help_box").display:
            self._help(None)
        else:
            self._help(manuals.strokes())

    def _explain(self, word):
        if not word:
            usages = sorted(self.told.hello["commands"].values())
            pairs = zip_longest(usages[::2], usages[1::2], fillvalue="")
            self._help([("%-38s%s" % pair, "") for pair in pairs] + HELP_COMMANDS)
        else:
            found = manuals.explained(word)
            self._help(found or None)
            if not found:
                self._say(UNKNOWN % word)

    def _help(self, rows):
        """Show these rows in the place of the telegrams, so that the display stays in sight."""
        self.query_one("#help_box").display = rows is not None
        for name in ("#telegrams", "#telegrams_head", "#drives_box", "#exchanges"):
            self.query_one(name).display = rows is None
        if rows is not None:
            text = Text()
            for what, meaning in rows:
                text.append(what, "bold").append("  " + meaning + "\n" if meaning else "\n")
            self._show("#help", text)
            self.query_one("#help_box").scroll_home(animate=False)

    def _pause(self):
        telegrams = self.told.telegrams
        telegrams.pause(not telegrams.paused)
        if not telegrams.paused:
            self.query_one("#telegrams").back = 0
        self._draw_telegrams()

    def _hex(self):
        view = self.query_one("#telegrams")
        view.in_hex = not view.in_hex
        self._draw_telegrams()

    def _page(self, way):
        box = self.query_one("#help_box")
        if box.display:
            (box.scroll_page_up if way > 0 else box.scroll_page_down)(animate=False)
        else:
            self.query_one("#telegrams").scroll_rows(
                way * self.query_one("#telegrams").size.height
            )

    # --- leaving --------------------------------------------------------------------------------

    def _leave(self, way):
        self.way_out = way
        loop = asyncio.get_running_loop()
        loop.remove_reader(self._child.fileno())
        loop.remove_reader(self._child.errors())
        self.exit()


HELP_COMMANDS = [
    ("help WORD", "what the manuals say of it"),
    ("speed N", "time passes N times as fast; 0: it stands"),
    ("quit", "stops the drives, and leaves"),
]
ACTIONS = {
    COMMAND: PanelApp._open_command,
    SETPOINT: PanelApp._open_setpoint,
    HELP: PanelApp._toggle_help,
    PAUSE: PanelApp._pause,
    HEX: PanelApp._hex,
    ARM: PanelApp._arm,
}


def now_ms():
    return int(time.monotonic() * 1000)


def key_name(stroke):
    """A stroke as `keys_of` names it."""
    return {" ": "space", "\x1b[A": "up", "\x1b[B": "down"}.get(stroke, stroke.lower())


def terminal_size(app):
    """What the terminal says now: it may be smaller already than the last picture."""
    size = getattr(app._driver, "size_now", None)
    return size() if size else (app.size.width, app.size.height)
