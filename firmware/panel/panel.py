# SPDX-License-Identifier: MIT
"""The panel: keys that act on every page, which drive is selected, which page is shown.

    panel = Panel(controls, bus, keypad.names, settings, clock.ticks_mask)
    if panel.step(keypad.read(), now_ms, now_us):   # each step of the loop
        display.show(panel.screen.picture)

STOP acts on every page, before everything else. START, REVERSE, the jog and the address keys act
on every page that shows the drive they act on; PARAM changes between home and parameter mode.
"""

from micropython import const

from panel import risks, texts
from panel.announcer import Announcer
from panel.fault import Report
from panel.jog_keys import JogKeys
from panel.keys import Acts, Keys, unknown
from panel.pages.home import Home
from panel.pages.parameters import Parameters
from panel.pages.question import Question
from panel.pages.splash import Splash
from panel.screen import Screen
from panel.stop_key import StopKey
from panel.supervision import longest_off_time_ms, off_time_ms
from panel.view import View
from panel.writer import Writer
from uss import profiles, pzd
from uss.timing import elapsed

_SPLASH_MS = const(800)
_DRAW_MS = const(50)
_MESSAGE_MS = const(3_000)
_READING_MS = const(1_000)  # so long a START does not answer a question: it may be a double tap
_LAST_TURN = const(7)
_UNSEEN_US = const(2_000_000)  # of a drive that is not shown, a setting is read again so often

# They act on every page that shows the drive they act on. STOP acts on every page.
COMMAND_KEYS = (
    "START", "REVERSE", "JOG_RIGHT", "JOG_LEFT", "ADDRESS_UP", "ADDRESS_DOWN", "PARAM",
)  # fmt: skip

# What these do ends when they go up, or goes on; the others act when they are pressed.
HELD_KEYS = ("STOP", "JOG_RIGHT", "JOG_LEFT")


class Panel:
    """controls: a `Control` for each drive, at least one. key_names: as the keypad has its bits.

    settings: a `Settings`. mask: the clock's period - 1. notice: a row that is said after the
    splash, or None; what is wrong with the settings goes before it.

    For pages and view: `selected`, the control that is shown; `warning`, its `Report`; `message`,
    a row that is shown for a while, or None; `stop_key`; `announcer`; `setpoint_step` in
    centihertz.
    """

    def __init__(self, controls, bus, key_names, settings, mask, notice=None):
        self._turn = 0  # asked for in every step, so it is first: as in `Master`
        self._acting = False  # keys that were pressed are still to do what they do
        self.controls = controls
        self.selected = controls[0]
        self.announcer = Announcer(controls, mask)
        self.warning = Report(self.selected.drive, mask, pzd.ZSW_WARNING, profiles.WARNING_NUMBER)
        self.screen = screen = Screen()
        self.message = None
        self.setpoint_step = settings.setpoint_step_centihertz
        self._bus = bus
        self._mask = mask
        self._settings = settings
        self._keys = keys = Keys(key_names, mask, HELD_KEYS)
        self.stop_key = StopKey(keys.bit("STOP"), controls, settings.second_stop, mask, self.say)
        self._jog_keys = JogKeys(keys.bit("JOG_RIGHT"), keys.bit("JOG_LEFT"))
        self._writer = Writer(bus, settings, mask)
        cycle_us = bus.longest_cycle_us()
        self._off_time_ms = off_time_ms(cycle_us)
        for control in controls:
            control.longest_off_time_ms = longest_off_time_ms(cycle_us)
        self._home = Home(self, keys)
        self._parameters = Parameters(self, keys, self._writer, mask)
        self._page = self._home
        self._splash = Splash()
        self._risk_question = None  # the `Question` about a risk that was asked last,
        self._risk = None  # which risk that is,
        self._risk_value = None  # and as it was then
        self._over = self._splash  # what hides the page: the splash, a question, or None
        self._began_at = None
        self._notices = _about(settings) or ([notice] if notice else [])
        self._notices += [_about_key(name) for name in unknown(key_names)]
        self._message_at = 0
        self._view = View(self, screen)
        self._view.begin(self._splash)
        self._drawn_at = None  # when the picture was begun; None: a new one at once
        self._name_keys(keys)
        self._position = 0  # of the selected one in the controls
        self._around = 0  # of the controls: the one besides the selected that was looked at last
        self._neighbour = None  # it was asked, and is still to be watched
        self._put_off = 0  # what can wait, in the turn before
        self._at_rest = 0  # so many of them in a row were found at rest
        # What is not done at once takes turns, so that each step of the loop stays short.
        around = self._look_around if len(controls) > 1 else self._ask
        self._turns = (
            self._draw, self._ask, self._leave, self._watch,
            self._draw, self._follow, self._leave, around,
        )  # fmt: skip

    def _name_keys(self, keys):
        """The bits of keys, because names take long to look up."""
        self._stop_bit = keys.bit("STOP")
        self._start_key = keys.bit("START")
        self._reverse_key = keys.bit("REVERSE")
        self._jog_bits = keys.bits(("JOG_RIGHT", "JOG_LEFT"))
        self._motion_keys = self._start_key | self._jog_bits
        self._up_key = keys.bit("ADDRESS_UP")
        self._down_key = keys.bit("ADDRESS_DOWN")
        self._parameter_key = keys.bit("PARAM")
        self._command_keys = keys.bits(COMMAND_KEYS)
        self._were_down = 0  # the keys that were down in the last step, as bits
        self._acts = Acts(keys)

    def step(self, raw_keys, now_ms, now_us, unclear_keys=0):
        """raw_keys: the keys down now, as bits; unclear_keys: those that cannot be told.

        Both times are readings of the clock. STOP and the jog keys act in this very step, the
        others in the next one; what comes of it is taken up in those that follow, each of which
        does one thing of several in turn. Answers whether the rest of the step is for others: the
        display, and drives that are silent or wait too long.
        """
        keys = self._keys
        self._turn = turn = self._turn + 1 & _LAST_TURN
        if raw_keys or unclear_keys or not keys.at_rest:
            if keys.update(raw_keys, now_ms, unclear_keys) and self._take_keys(keys, now_ms):
                return False  # that was enough for a step
        if self._acting:
            self._act(now_ms)
            return False
        if self.stop_key.left:
            self.stop_key.stop_next()
            return False
        return self._turns[turn](now_ms, now_us)

    # --- for the pages --------------------------------------------------------------------------

    def say(self, text, now_ms):
        """Show a row for _MESSAGE_MS, unless something else is said or a key is pressed."""
        self.message = text
        self._message_at = now_ms

    def ask(self, question):
        """Show a `Question` over the page until a key answers it."""
        self._over = question

    def close_question(self):
        if self._over is self._risk_question:  # another one leaves a START still to be asked about
            self.selected.question = None
        self._over = None

    def is_taken(self, address):
        """Whether another drive of this panel than the selected one has this address."""
        if self._writer.takes(address):
            return True
        return address != self.selected.drive.address and address in self._settings.drives

    def any_runs(self):
        """Whether a drive of this panel runs, is told to, or may run out of contact, as far as it
        is known: each of those that are not shown is looked at again and again.
        """
        return self.selected.is_active() or self._at_rest + 1 < len(self.controls)

    def line_in_use(self):
        """Whether another master was heard before the first telegram, so that none is sent."""
        return self._bus.is_line_in_use()

    # --- what takes turns: each answers whether it leaves the rest of the step to others -------

    def _ask(self, _now_ms, now_us):
        if self.selected.ask(now_us):
            self._heed(self.selected)
        return False

    def _heed(self, control):
        """A drive has told its settings: its telegram-off time decides how soon it is asked."""
        survey = control.survey
        if survey.complete:
            self._bus.supervise(control.drive, survey.values[profiles.SUPERVISION])

    def _watch(self, _now_ms, now_us):
        selected = self.selected
        if not selected.checking:
            self.announcer.look(self._position)
        selected.watch(now_us)
        return False

    def _follow(self, now_ms, now_us):
        if self._over is self._splash:
            self._wait_for_splash(now_ms)
        self._writer.step(now_us)
        self.selected.ask_on(now_us)
        self._collect(now_ms)
        if self._page is self._parameters:
            self._parameters.step(self._keys, now_ms)
        return False

    def _draw(self, now_ms, now_us):
        # In a slow loop a picture takes longer than _DRAW_MS: it is drawn to its end all the same.
        view, drawn_at = self._view, self._drawn_at
        if drawn_at is None or (
            view.is_done() and elapsed(now_ms, drawn_at, self._mask) >= _DRAW_MS
        ):
            self._drawn_at = now_ms
            self._begin_picture(now_ms)
            self.warning.step(now_us)
        else:
            view.step(now_ms)
        return False

    def _begin_picture(self, now_ms):
        """What it tells is settled here: drawing changes nothing but the picture."""
        page, view = self._over or self._page, self._view
        if page is not self._splash:
            self.announcer.begin(self._position, page, view.tells_state(page), now_ms)
        view.begin(page)

    def _leave(self, _now_ms, _now_us):
        return not self._puts_off()

    def _puts_off(self):
        """Keys that are unsettled take long already: what can wait does, once."""
        self._put_off = self._keys.unsettled and not self._put_off
        return self._put_off

    def _look_around(self, _now_ms, now_us):
        """The next of the drives that are not shown. It has nothing to say and nothing to ask:
        START has to be pressed anew, with that drive in sight."""
        if self._puts_off():
            return False
        control = self._neighbour
        if control is None:
            control = self._next_neighbour()
            if control.ask(now_us, _UNSEEN_US):
                self._heed(control)
                self._around -= 1  # it has told something: in its next turn it is asked for more
            elif control.is_quiet():
                if not control.drive.contact:  # of the others nothing new can be said
                    self.announcer.look(self._around)
                self._at_rest += 1
            else:
                self._neighbour = control  # that was enough for a step
            return False
        self._neighbour = None
        control.watch(now_us)
        control.keep_quiet()
        self.announcer.look(self._around)
        self._at_rest = 0 if control.is_active() else self._at_rest + 1
        return False

    def _next_neighbour(self):
        controls = self.controls
        around = self._around
        while True:
            around = around + 1 if around + 1 < len(controls) else 0
            if controls[around] is not self.selected:
                self._around = around
                return controls[around]

    # --- keys -----------------------------------------------------------------------------------

    def _take_keys(self, keys, now_ms):
        """A key was pressed, repeats or is held. Answers whether it takes the rest of the step."""
        down = keys.down | self._were_down
        self._were_down = keys.down
        if keys.pressed:
            self.message = None
        if down & self._stop_bit:
            self.stop_key.step(keys, self.selected, now_ms)
        page = self._over or self._page
        if down & self._jog_bits:
            self._jog_keys.step(keys, self.selected, page.obeys and not self.stop_key.is_down)
        if not (keys.pressed or keys.repeated):
            return False
        if self._acting:  # since the last step
            self._act(now_ms)
        self._acts.note()
        self._acting = True
        return True

    def _act(self, now_ms):
        """What was pressed or repeats does what it does on this page."""
        self._acting = False
        acts = self._acts
        page = self._over or self._page
        if (acts.pressed | acts.repeated) & self._command_keys and page.obeys:
            self._take_command(acts, now_ms)
        page.take_keys(acts, now_ms)
        if acts.pressed:
            if self._over is self._splash:
                self._end_splash(now_ms)
            self._drawn_at = None  # a new picture at once

    def _take_command(self, acts, now_ms):
        pressed = acts.pressed
        if self.stop_key.is_down and pressed & self._motion_keys:
            self.say(texts.REFUSED_STOP, now_ms)
        elif pressed & self._start_key:
            self.selected.start()
        if pressed & self._reverse_key:
            self.selected.reverse()
        direction = acts.moved(self._up_key) - acts.moved(self._down_key)
        if direction:
            self._select(direction)
        if pressed & self._parameter_key:
            self._toggle_parameters()

    def _toggle_parameters(self):
        if self._page is self._parameters:
            self._page = self._home
        else:
            self._page = self._parameters
            self._parameters.open()

    def _select(self, direction):
        """Show another drive. It starts and stops nothing.

        What is known of it may be old: all of that is asked for at once.
        """
        self.selected.keep_quiet()
        position = self._position
        self._position = (position + direction) % len(self.controls)
        self.selected = self.controls[self._position]
        self.selected.learn_anew()
        self.warning.turn_to(self.selected.drive)
        # The one that is shown no longer is looked at next, and all are counted anew.
        self._around = position - 1
        self._neighbour = None
        self._at_rest = 0

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
        if selected.question is not None and self._over is None:
            self._ask_risk(selected.question)
        over = self._over
        if over is not None and over is not self._splash:
            asks_risk = over is self._risk_question and selected.question is not None
            if asks_risk and self._asks_what_was():
                self._ask_risk(self._risk)
            elif over.step(now_ms) or selected.needs_attention():
                self.close_question()  # an alarm is not to be hidden
        if self.message and elapsed(now_ms, self._message_at, self._mask) >= _MESSAGE_MS:
            self.message = None
        if self._notices and self.message is None and self._over is None:
            self.say(self._notices.pop(0), now_ms)  # also when a key has ended the one before

    def _ask_risk(self, row):
        if not risks.is_open(self.selected, row):  # not any more
            self.selected.question = None
            self._over = None
            return
        self._risk = row
        text, can_fix, self._risk_value = risks.ask(self.selected, row)
        answers = {"START": self._accept_risk}
        if can_fix:
            answers["SET"] = self._supervise
        self._risk_question = Question(self, text, answers, self._mask, _READING_MS)
        self.ask(self._risk_question)

    def _asks_what_was(self):
        """Whether the risk that is asked about is another one by now."""
        return risks.measure(self.selected, self._risk) != self._risk_value

    def _supervise(self, now_ms):
        """Have the drive stop by itself when this panel falls silent."""
        number, index = profiles.TELEGRAM_OFF_TIME, profiles.COM_LINK
        reason = self._writer.write(self.selected, number, index, self._off_time_ms, False)
        if reason is not None:
            self.say(reason, now_ms)

    def _accept_risk(self, now_ms):
        if self.stop_key.is_down:
            self.say(texts.REFUSED_STOP, now_ms)
        else:
            self.selected.accept_risk(self._risk, self._risk_value)

    def _wait_for_splash(self, now_ms):
        """It ends by itself."""
        if self._began_at is None:
            self._began_at = now_ms
        elif elapsed(now_ms, self._began_at, self._mask) >= _SPLASH_MS:
            self._end_splash(now_ms)

    def _end_splash(self, now_ms):
        self._over = None
        if self._notices:
            self.say(self._notices.pop(0), now_ms)
        elif self._acts.pressed & self._start_key:
            self.say(texts.REFUSED_EARLY, now_ms)


def _about_key(name):
    """A row about a key of the board that the panel does not know."""
    return texts.KEY_UNKNOWN + str(name)[: texts.ROW_WIDTH - len(texts.KEY_UNKNOWN)].encode()


def _about(settings):
    """What is wrong with the settings file: rows that are said one after the other."""
    if settings.complaint is None:
        return []
    suspect = settings.suspect
    name = suspect[: texts.ROW_WIDTH].encode()
    return [texts.SETTINGS_DAMAGED, texts.SETTINGS_SUSPECTS.get(suspect, name)]
