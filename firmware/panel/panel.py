"""The panel: keys that act on every page, which drive is selected, which page is shown.

    panel = Panel(controls, bus, keypad.names, settings, clock.ticks_mask)
    if panel.step(keypad.read(), now_ms, now_us):   # each step of the loop
        display.show(panel.screen.picture)

STOP acts on every page, before everything else. START, REVERSE, the jog and the address keys act
on every page that shows the drive they act on; PARAM changes between home and parameter mode.
"""

from micropython import const

from panel import texts
from panel.jog_keys import JogKeys
from panel.keys import Keys
from panel.pages.home import Home
from panel.pages.parameters import Parameters
from panel.pages.question import Question
from panel.pages.splash import Splash
from panel.screen import Screen
from panel.stop_key import StopKey
from panel.supervision import off_time_ms
from panel.view import View
from panel.writer import Writer
from uss import profiles
from uss.timing import elapsed

SPLASH_MS = const(800)
DRAW_MS = const(50)
MESSAGE_MS = const(3_000)
READING_MS = const(1_000)  # so long a START does not answer a question: it may be a double tap

# They act on every page that shows the drive they act on. STOP acts on every page.
COMMAND_KEYS = (
    "START", "REVERSE", "JOG_RIGHT", "JOG_LEFT", "ADDRESS_UP", "ADDRESS_DOWN", "PARAM",
)  # fmt: skip


class Panel:
    """controls: a `Control` for each drive, at least one. key_names: as the keypad has its bits.

    settings: a `Settings`. mask: the clock's period - 1. notice: a row that is said after the
    splash, or None.

    For pages and view: `selected`, the control that is shown; `message`, a row that is shown for a
    while, or None; `stop_key`; `setpoint_step` in centihertz.
    """

    def __init__(self, controls, bus, key_names, settings, mask, notice=None):
        self.controls = controls
        self.selected = controls[0]
        self.screen = Screen()
        self.message = None
        self.setpoint_step = settings.setpoint_step_centihertz
        self._bus = bus
        self._mask = mask
        self._keys = keys = Keys(key_names, mask)
        self.stop_key = StopKey(
            keys.bit("STOP"), controls, settings.second_stop, mask, self.say
        )
        self._jog_keys = JogKeys(keys.bit("JOG_RIGHT"), keys.bit("JOG_LEFT"))
        self._turn = 0  # of the controls: the one that was looked at last
        self._writer = Writer(bus, settings, mask)
        self._home = Home(self)
        self._parameters = Parameters(self, self._writer, mask)
        self._page = self._home
        self._splash = Splash()
        self._over = self._splash  # what hides the page: the splash, a question, or None
        self._view = View(self, self.screen)
        self._began_at = None
        self._notice = texts.SETTINGS_DAMAGED if settings.complaint else notice
        self._message_at = 0
        self._drawn_at = 0
        self._were_down = 0  # the keys that were down in the last step, as bits
        # What they do ends when they go up, or goes on; the others act when they are pressed.
        self._held_keys = keys.bits(("STOP", "JOG_RIGHT", "JOG_LEFT"))
        self._command_keys = keys.bits(COMMAND_KEYS)
        # What is not done at once takes turns, so that each step of the loop stays short.
        self._turns = (self._look, self._follow, self._draw, self._let_show)
        self._next_turn = 0

    def step(self, raw_keys, now_ms, now_us, unclear_keys=0):
        """raw_keys: the keys down now, as bits; unclear_keys: those that cannot be told.

        Both times are readings of the clock. What an operator does is done in this very step; what
        comes of it is taken up in the next ones, each of which does one thing of several in turn.
        Answers whether the rest of the step is for the display.
        """
        keys = self._keys
        keys.update(raw_keys, now_ms, unclear_keys)
        if (keys.down | self._were_down) & self._held_keys or keys.pressed or keys.repeated:
            self._take_keys(keys, now_ms)
        self._were_down = keys.down
        if self._over is self._splash:
            self._end_splash(now_ms)
        if keys.pressed:
            self._begin_picture(now_ms)
        if keys.pressed or keys.repeated:
            return False  # that was enough for a step
        return self._take_turn(now_ms, now_us)

    # --- for the pages --------------------------------------------------------------------------

    def say(self, text, now_ms):
        """Show a row for MESSAGE_MS, unless something else is said or a key is pressed."""
        self.message = text
        self._message_at = now_ms

    def ask(self, question):
        """Show a `Question` over the page until a key answers it."""
        self._over = question

    def close_question(self):
        self._over = None
        self.selected.question = False

    def is_taken(self, address):
        """Whether another drive of this panel than the selected one has this address."""
        for control in self.controls:
            if control is not self.selected and control.drive.address == address:
                return True
        return self._writer.takes(address)

    def any_runs(self):
        """Whether a drive of this panel runs, is told to, or may run out of contact."""
        for control in self.controls:
            if control.runs() or control.drive.is_on() or control.lost_running:
                return True
        return False

    def line_in_use(self):
        """Whether another master was heard before the first telegram, so that none is sent."""
        return self._bus.is_line_in_use()

    # --- what takes turns: each answers whether the step has time left for the display ----------

    def _take_turn(self, now_ms, now_us):
        turn = self._next_turn
        self._next_turn = turn + 1 if turn + 1 < len(self._turns) else 0
        return self._turns[turn](now_ms, now_us)

    def _look(self, _now_ms, now_us):
        self.selected.step(now_us)
        return False

    def _follow(self, now_ms, now_us):
        self._writer.step(now_us)
        self._collect(now_ms)
        if self._page is self._parameters:
            self._parameters.step(self._keys, now_ms)
        if len(self.controls) > 1:
            self._look_at_another(now_us)
        return False

    def _draw(self, now_ms, _now_us):
        # In a slow loop a picture takes longer than DRAW_MS: it is drawn to its end all the same.
        if self._view.is_done() and elapsed(now_ms, self._drawn_at, self._mask) >= DRAW_MS:
            self._begin_picture(now_ms)
        self._view.step(now_ms)
        return False

    def _begin_picture(self, now_ms):
        self._drawn_at = now_ms
        self._view.begin(self._over or self._page)

    def _let_show(self, _now_ms, _now_us):
        return True

    def _look_at_another(self, now_us):
        """The next drive in turn. One that is not shown has nothing to say and nothing to ask:
        START has to be pressed anew, with that drive in sight."""
        self._turn = (self._turn + 1) % len(self.controls)
        control = self.controls[self._turn]
        if control is not self.selected:
            control.step(now_us)
            control.keep_quiet()

    # --- keys -----------------------------------------------------------------------------------

    def _take_keys(self, keys, now_ms):
        if keys.pressed:
            self.message = None
        self.stop_key.step(keys, self.selected, now_ms)
        page = self._over or self._page
        self._jog_keys.step(keys, self.selected, page.obeys and not self.stop_key.is_down)
        acts = keys.pressed | keys.repeated
        if acts & self._command_keys and page.obeys:
            self._take_command(keys, now_ms)
        if acts:
            page.take_keys(keys, now_ms)

    def _take_command(self, keys, now_ms):
        if keys.pressed & keys.bit("START"):
            if self.stop_key.is_down:
                self.say(texts.REFUSED_STOP, now_ms)
            else:
                self.selected.start()
        if keys.pressed & keys.bit("REVERSE"):
            self.selected.reverse()
        if keys.pressed & (keys.bit("JOG_RIGHT") | keys.bit("JOG_LEFT")):
            if self.stop_key.is_down:
                self.say(texts.REFUSED_STOP, now_ms)
        direction = keys.moved("ADDRESS_UP") - keys.moved("ADDRESS_DOWN")
        if direction:
            self._select(direction)
        if keys.pressed & keys.bit("PARAM"):
            self._toggle_parameters()

    def _toggle_parameters(self):
        if self._page is self._parameters:
            self._page = self._home
        else:
            self._page = self._parameters
            self._parameters.open()

    def _select(self, direction):
        """Show another drive. It starts and stops nothing."""
        self.selected.keep_quiet()
        position = self.controls.index(self.selected) + direction
        self.selected = self.controls[position % len(self.controls)]

    # --- what has to be said --------------------------------------------------------------------

    def _collect(self, now_ms):
        """Take up what the drives and the writer have to say and to ask."""
        selected = self.selected
        refusal = selected.take_refusal()
        if refusal:
            self.say(refusal, now_ms)
        result = self._writer.take_result(selected)
        if result:
            self.say(result, now_ms)
        if selected.question and self._over is None:
            self._ask_unsupervised()
        if self._over is not None and self._over is not self._splash:
            if selected.needs_attention() or self._over.is_stale(now_ms):
                self.close_question()  # an alarm is not to be hidden
        if self.message and elapsed(now_ms, self._message_at, self._mask) >= MESSAGE_MS:
            self.message = None

    def _ask_unsupervised(self):
        answers = {"SET": self._supervise, "START": self._accept_unsupervised}
        self.ask(Question(self, texts.ASK_UNSUPERVISED, answers, self._mask, READING_MS))

    def _supervise(self, now_ms):
        """Have the drive stop by itself when this panel falls silent."""
        number, index = profiles.TELEGRAM_OFF_TIME, profiles.COM_LINK
        value_ms = off_time_ms(self._bus.longest_cycle_us())
        reason = self._writer.write(self.selected, number, index, value_ms, False)
        if reason is not None:
            self.say(reason, now_ms)

    def _accept_unsupervised(self, now_ms):
        if self.stop_key.is_down:
            self.say(texts.REFUSED_STOP, now_ms)
        else:
            self.selected.accept_unsupervised()

    def _end_splash(self, now_ms):
        if self._began_at is None:
            self._began_at = now_ms
            self._begin_picture(now_ms)
        if elapsed(now_ms, self._began_at, self._mask) >= SPLASH_MS or self._keys.pressed:
            self._over = None
            if self._notice:
                self.say(self._notice, now_ms)
            elif self._keys.pressed & self._keys.bit("START"):
                self.say(texts.REFUSED_EARLY, now_ms)
