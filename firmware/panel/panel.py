# SPDX-License-Identifier: MIT
"""The panel: keys that act on every page, which drive is selected, which page is shown.

In use:

    panel = Panel(roster, bus, board, settings, clock.ticks_mask)
    if panel.step(keypad.read(), now_ms, now_us):   # each step of the loop
        display.show(panel.screen.picture)

STOP acts on every page, before everything else. START, REVERSE, the jog and the address keys act
on every page that obeys them; PARAM goes to the next page of `pages.table`.
"""

from micropython import const

import on_demand
from panel import permits, texts, wording
from panel.announcer import Announcer
from panel.reports.fault import DriveWarning
from panel.keys import Acts, keys_of
from panel.keys.jog_keys import JogKeys
from panel.keys.stop_key import StopKey
from panel.neighbours import Neighbours
from panel.pages.home import Home
from panel.pages.table import PAGES
from panel.phases import ASKING, CHECKING
from panel.screen import Screen
from panel.view import View
from uss.timing import elapsed

_DRAW_MS = const(45)
_MESSAGE_MS = const(3_000)
_LAST_TURN = const(7)
_UNSEEN_MS = const(300)  # so long a page that is coming goes before the next picture
_WAITS_MAX = const(8)  # turns until what takes long does not wait for a telegram any more,
_WAITS_MOST = const(16)  # and until it does not wait for a step that has just begun
_LONG_US = const(2_000)  # it takes up to so long, and is not to be interrupted
_LATE_US = const(800)  # a step that has taken so long is not to begin it: it was interrupted

# They act on every page that obeys. STOP acts on every page.
COMMAND_KEYS = (
    "START", "REVERSE", "JOG_RIGHT", "JOG_LEFT", "ADDRESS_UP", "ADDRESS_DOWN", "PARAM",
)  # fmt: skip
MOTION_KEYS = ("START", "JOG_RIGHT", "JOG_LEFT")

# What these do ends when they go up, or goes on; the others act when they are pressed.
HELD_KEYS = ("STOP", "JOG_RIGHT", "JOG_LEFT")


class Panel:
    """roster: the `Roster`, its drives. key_names: as the keypad has its bits.

    settings: a `Settings`. mask: the clock's period - 1. board: contract of `hal`. notices: texts
    that are said after the splash, or NOTHING; what is wrong with the settings comes after them.

    For pages and view: `selected`, the control that is shown; `warning`, its `DriveWarning`;
    `message`, words that are shown for a while, or None; `stop_key`; `announcer`; `guard`, a
    `Guard` or None; `setpoint_step` in centihertz; `remembered`; `settings`; `bus`; `board`;
    `mask`. For `App`: `wants`, and `errand`, which a page may set and `App` clears. Nobody else
    writes a field of it: pages call `say`, `cover`, `uncover`, `write`, `show_page`, `turn_page`,
    `add`, `remove`, `heed_settings`, `begin_anew` and `lock`.
    """

    def __init__(self, roster, bus, board, settings, mask, notices=()):
        self._turn = 0  # asked for in every step, so it is first: as in `Master`
        self._begun_us = 0  # when the step began
        self._acting = False  # keys that were pressed are still to do what they do
        self._taker = None  # the page that is to take them now that the panel has
        self._rests = False  # the step is not for making a page
        self._waits = 0  # so many turns what takes long has waited
        self._trips = 0  # bus.dead_man_trips when they were
        self.roster = roster
        self.controls = controls = roster.controls
        self.selected = controls[0]
        self.announcer = Announcer(controls, mask)
        self.warning = DriveWarning(self.selected.drive, mask, self.selected.survey.family)
        self.screen = screen = Screen(getattr(board.display, "rom", "A00"))
        self.mask = mask
        self.message = None
        self.bus = bus
        self.board = board
        self.settings = settings
        key_names = board.keypad.names
        self._keys = keys = keys_of(key_names, mask, HELD_KEYS, self)
        self._acts = Acts(keys)
        self._stop_bit = keys.bit("STOP")  # names take long to look up
        self._jog_bits = keys.bits(("JOG_RIGHT", "JOG_LEFT"))
        self._command_bits = keys.bits(COMMAND_KEYS)
        self.heed_settings(locked=True)
        self._param_bit = keys.bit("PARAM")
        self._address_bits = keys.bits(("ADDRESS_UP", "ADDRESS_DOWN"))
        self._motion_bits = keys.bits(MOTION_KEYS)
        self._were_down = 0  # the keys that were down in the last step, as bits
        self.stop_key = StopKey(self._stop_bit, controls, settings.second_stop, mask, self.say)
        self._jog_keys = JogKeys(keys.bit("JOG_RIGHT"), keys.bit("JOG_LEFT"))
        self._writer = None  # the `Writer`, as long as it has something to do
        self._home = self._page = Home(self)
        self._place = 0  # of the page in PAGES
        self._is_new = settings.new  # nobody has set it up: it offers to find drives
        self.errand = None  # a function to be called once the flash may be written
        self.wants = None  # another program: "search", or "app", this one anew
        self.remembered = {}  # by module: where a page was when it was left
        on_demand.load("panel.menu")  # with the engine it would be too much for one step
        splash = on_demand.load("panel.pages.splash")
        self._cover = splash.Splash(self)  # a page that hides it: the splash, a question, or None
        self._notices = splash.notices(settings, key_names, notices)
        self.journal = controls[0].desk.journal
        for notice in notices:
            if notice:
                self.journal.note(notice)
        self._message_at_ms = 0
        self._view = View(self, screen, keys)
        self._view.begin(self._cover)
        self._drawn_at_ms = None  # when the picture was begun; None: a new one at once
        self._is_unseen = False  # the page shown is coming, and goes before the picture
        self._position = 0  # of the selected one in the controls
        self._neighbours = Neighbours(controls, self.announcer, self)
        self._put_off = 0  # what can wait, in the turn before
        # What is not done at once takes turns, so that each step of the loop stays short.
        self._turns = (
            self._draw, self._ask, self._leave, self._watch,
            self._work_or_draw, self._follow, self._work, self._look_around,
        )  # fmt: skip

    def step(self, raw_keys, now_ms, now_us, unclear_keys=0):
        """raw_keys: the keys down now, as bits; unclear_keys: those that cannot be told.

        Both times are readings of the clock. STOP and the jog keys act in this very step, the
        others in the next one; what comes of it is taken up in those that follow, each of which
        does one thing of several in turn. Answers whether the rest of the step is for others: the
        display, and drives that are silent or wait too long.
        """
        keys = self._keys
        self._begun_us = now_us
        self._turn = turn = self._turn + 1 & _LAST_TURN
        if raw_keys or unclear_keys or not keys.at_rest:
            if keys.update(raw_keys, now_ms, unclear_keys) and self._take_keys(keys, now_ms):
                return False  # that was enough for a step
        if self._acting:
            self._act(now_ms)
            return False
        if self._waits and self.is_undisturbed(_LONG_US) and self._go_on(now_ms):
            return False
        if self._place and self._page is self._home:
            self._rests = not self._rests
            if not self._rests and self._make_page(now_ms):
                return False
        if self.stop_key.left:
            self.stop_key.stop_next()
            return False
        return self._turns[turn](now_ms, now_us)

    # --- for the pages --------------------------------------------------------------------------

    def say(self, now_ms, text, *values):
        """Show a text for _MESSAGE_MS, unless something else is said or a key is pressed."""
        self.message = texts.of(text, *values)
        self._message_at_ms = now_ms

    def cover(self, page):
        """Show a page over the one that is shown, until `uncover`."""
        self._cover = page

    def uncover(self):
        on_demand.drop(*self._cover.modules)
        self._cover = None

    def write(self, now_ms, *what):
        """The `Write` made with `what`, whose outcome the panel will say; None where it has said
        already why it cannot be tried.
        """
        if self._writer is None:
            writer = on_demand.load("panel.writer").Writer
            self._writer = writer(self.bus, self.settings, self.mask)
        write = self._writer.write(*what)
        if write.outcome is None:
            return write
        self.say(now_ms, *write.outcome)
        return None

    def has_time(self):
        """Whether to begin what takes long, such as to load a module. Asked again in each turn."""
        self._waits = waits = self._waits + 1
        if waits < _WAITS_MAX:
            has_time = self.is_undisturbed(_LONG_US)
        else:
            has_time = waits >= _WAITS_MOST or not self.has_taken(_LATE_US)
        if has_time:
            self._waits = 0
        return has_time

    def is_undisturbed(self, for_us=0):
        """Whether nothing interrupts the loop for so long: a telegram is on its way, or the reply.
        In a step that was interrupted already, it is too late for what takes long.
        """
        if self.has_taken(_LATE_US):
            return False
        return self.bus.is_undisturbed(self.board.clock.ticks_us() + for_us & self.mask)

    def has_taken(self, us):
        """Whether this step has taken so long already."""
        return (self.board.clock.ticks_us() - self._begun_us) & self.mask >= us

    def close_menu(self):
        """Close the menu that covers the page."""
        self._cover.close()

    def show_page(self, now_ms, place):
        """Close the menu, and show this page of the table."""
        self._cover.close(PAGES[place][2])
        self.turn_page(now_ms, place)

    def heed(self, control):
        """A drive has told its settings: its telegram-off time decides how soon it is asked."""
        survey = control.survey
        if survey.complete:
            self.bus.deadlines.supervise(control.drive, survey.off_time_ms())

    def heed_settings(self, locked=False):
        """Settings that act at once have changed. locked: where they have a lock, it is closed."""
        settings = self.settings
        texts.speak(settings.language)
        self.setpoint_step = settings.setpoint_step_centihertz
        keys = self._keys
        keys.pace(settings.key_delay_ms, settings.key_repeat_ms)
        if settings.lock_code or settings.light_minutes:
            backlight = getattr(self.board, "backlight", None)
            guard = on_demand.load("panel.keys.guard").Guard
            self.guard = guard(settings, keys, self.mask, backlight, locked)
        else:
            self.guard = None

    def lock(self, now_ms):
        """Close the lock. The home page is what it leaves."""
        self.guard.lock()
        if self._cover is not None and not self._cover.locks:
            self.close_menu()
        self.turn_page(now_ms, 0)
        self.say(now_ms, texts.LOCKED)

    def begin_anew(self):
        """Settings have changed with which a panel begins. No motor may run."""
        self.close_menu()
        self.wants = "app"

    def offer_search(self, now_ms):
        """Ask whether drives shall be looked for."""
        self.close_menu()
        if self.any_runs() or self.line_in_use():
            self.say(now_ms, texts.STOP_FIRST)
            return
        self._ask_search()

    def _ask_search(self):
        question = on_demand.load("panel.pages.question").Question
        self.cover(question(self, texts.ASK_SEARCH, (), {"SET": self._search}))

    def add(self, address, kind):
        """Take a drive into the list, and show it. ValueError: see `Roster`."""
        control = self.roster.add(address, kind)
        self.announcer.make_room()
        self.show(control)

    def remove(self):
        """Take the drive shown out of the list. ValueError: see `Roster`."""
        position, control = self._position, self.selected
        self.roster.remove(control)
        self.announcer.close_up(position)
        self._position = position % len(self.controls)
        self._turn_to(self._position)

    def show(self, control):
        """Show another drive. It starts and stops nothing."""
        self.selected.keep_quiet()
        self._turn_to(self.controls.index(control))

    def is_taken(self, address):
        """Whether another drive of this panel than the selected one has this address."""
        if self._writer and self._writer.takes(address):
            return True
        return address != self.selected.drive.address and address in self.settings.drives

    def any_runs(self):
        """Whether a drive of this panel runs, is told to, or may run out of contact, as far as it
        is known: each of those that are not shown is looked at again and again.
        """
        return self.selected.is_active() or not self._neighbours.are_at_rest()

    def line_in_use(self):
        """Whether another master was heard before the first telegram, so that none is sent."""
        return self.bus.is_line_in_use()

    # --- what takes turns: each answers whether it leaves the rest of the step to others -------

    def _ask(self, _now_ms, now_us):
        if self.selected.ask(now_us):
            self.heed(self.selected)
        return False

    def _watch(self, _now_ms, now_us):
        on_demand.tidy()
        selected = self.selected
        if selected.phase != CHECKING:
            self.announcer.look(self._position)
        selected.watch(now_us)
        return False

    def _follow(self, now_ms, now_us):
        if self._writer:
            self._writer.step(now_us)
        self.selected.ask_on(now_us)
        self._collect(now_ms)
        self.journal.tick(now_ms)
        guard = self.guard
        if guard is not None and guard.step(now_ms, self._has_alarm()):
            self.lock(now_ms)
        self._page.step(self._keys, now_ms)
        if self._cover is not None:
            self._cover.step(self._keys, now_ms)
        return False

    def _draw(self, now_ms, now_us):
        # In a slow loop a picture takes longer than _DRAW_MS: it is drawn to its end all the same.
        view, drawn_at_ms = self._view, self._drawn_at_ms
        is_coming = self._page.is_coming() and self._cover is None and drawn_at_ms is not None
        if is_coming and (view.is_done() or not self._is_unseen):
            if elapsed(now_ms, drawn_at_ms, self.mask) < _UNSEEN_MS:
                view.begin(None)
                self._is_unseen = True
                self._waits = 1  # the other turns work on it as well, when nothing disturbs
                self._page.work(now_ms)
                return False
        if self._is_unseen and not is_coming:  # what was drawn before is of another page
            self._is_unseen = False
            drawn_at_ms = None
        if drawn_at_ms is None or (
            view.is_done() and elapsed(now_ms, drawn_at_ms, self.mask) >= _DRAW_MS
        ):
            # What it tells is settled now: drawing changes nothing but the picture.
            self._drawn_at_ms = now_ms
            page = self._cover
            if page is None or not page.is_ready():
                page = self._page
            if page.announces:
                self.announcer.begin(self._position, page, view.tells_state(page), now_ms)
            view.begin(page)
            self.warning.step(now_us)
        elif view.is_done():
            return not self._puts_off()
        else:
            view.step(now_ms)
        return False

    def _leave(self, _now_ms, _now_us):
        return not self._puts_off()

    def _work(self, now_ms, now_us):
        """A page that has something to look for does it faster; others leave the step."""
        return not self._works(now_ms) and self._leave(now_ms, now_us)

    def _work_or_draw(self, now_ms, now_us):
        return not self._works(now_ms) and self._draw(now_ms, now_us)

    def _works(self, now_ms):
        page = self._cover or self._page
        is_busy = page.is_busy
        if is_busy:
            page.work(now_ms)
        return is_busy

    def _puts_off(self):
        """Keys that are unsettled take long already: what can wait does, once."""
        self._put_off = self._keys.unsettled and not self._put_off
        return self._put_off

    def _look_around(self, now_ms, now_us):
        if len(self.controls) == 1:
            return self._ask(now_ms, now_us)
        if not self._puts_off():
            self._neighbours.step(now_us)
        return False

    # --- keys -----------------------------------------------------------------------------------

    def _take_keys(self, keys, now_ms):
        """A key was pressed, repeats or is held. Answers whether it takes the rest of the step."""
        down = keys.down | self._were_down
        self._were_down = keys.down
        if keys.pressed:
            self.message = None
        if down & self._stop_bit:
            self.stop_key.step(keys, self.selected, now_ms)
        page = self._cover or self._page
        guard = self.guard
        if guard is not None:
            if keys.pressed or keys.repeated or keys.shift or down & self._jog_bits:
                guard.note_keys(now_ms)
        if down & self._jog_bits:
            allowed = page.obeys and not self.stop_key.is_down
            if guard is not None and guard.locked:
                allowed = False
            self._jog_keys.step(keys, self.selected, allowed)
        if not (keys.pressed or keys.repeated):
            return False
        while self._acting:  # since the last step
            self._act(now_ms)
        self._acts.note()
        self._acting = True
        self._trips = self.bus.dead_man_trips
        return True

    def _act(self, now_ms):
        """What was pressed or repeats does what it does on this page: first what it does on every
        page that obeys. Then the page takes it in the next step, as both take long.
        """
        self._acting = False
        page, self._taker = self._taker, None
        if self.bus.dead_man_trips != self._trips:  # the panel has hung since
            self.say(now_ms, texts.PANEL_HUNG)
            return
        acts = self._acts
        if page is None:
            page = self._cover or self._page
            guard = self.guard
            if guard is not None and guard.locked and page.locks and self._is_locked(page, now_ms):
                return
            if (acts.pressed | acts.repeated) & self._command_bits and page.obeys:
                self._take_command(acts, now_ms)
                self._taker = page
                self._acting = True
                return
        if page:
            page.take_keys(acts, now_ms)
        if acts.pressed:
            self._drawn_at_ms = None  # a new picture at once

    def _take_command(self, acts, now_ms):
        if self.stop_key.is_down and acts.pressed & self._motion_bits:
            self.say(now_ms, texts.REFUSED_STOP)
        elif acts.has("START"):
            self.selected.start()
        if acts.has("REVERSE"):
            self.selected.reverse()
        if acts.pressed & self._address_bits:
            self._select(acts.direction("ADDRESS_UP", "ADDRESS_DOWN"))
        if acts.has("PARAM"):
            self.turn_page(now_ms, PAGES[self._place][1])
        if acts.is_held(self._param_bit):
            self._open_menu(now_ms)
        elif acts.is_held(self._address_bits):
            self._open_menu(now_ms, ("address", None))

    def _is_locked(self, page, now_ms):
        """The lock is closed: what it refuses is not done. Answers whether nothing is left."""
        acts = self._acts
        held = page.obeys and acts.is_held(self._param_bit | self._address_bits)
        if held and acts.repeated & self._param_bit:
            self.message = None
            self._open_menu(now_ms, ("code", False))
        elif self.guard.holds_back(acts, page) or held:
            self.say(now_ms, texts.LOCKED)
        return held or not (acts.pressed or acts.repeated)

    def _open_menu(self, now_ms, begin=("main", None)):
        self.turn_page(now_ms, 0)  # PARAM has gone to another one when it went down
        try:
            self.cover(on_demand.load("panel.menu.engine").Menu(self, begin))
        except MemoryError:
            self.say(now_ms, texts.NO_MEMORY)

    def _search(self, now_ms):
        if self.any_runs():
            self.say(now_ms, texts.STOP_FIRST)
        else:
            self.wants = "search"

    def turn_page(self, now_ms, place):
        """Another page of the table: the steps that follow make it. The one before leaves the
        memory."""
        before = self._page
        self._place = place
        self._page = self._home
        on_demand.drop(*before.modules)
        self._page.open()

    def _go_on(self, now_ms):
        """What waited for this goes on. Answers whether there was anything."""
        waited = self._waits
        self._waits = begun = max(waited, _WAITS_MAX)  # `has_time` agrees, unless it is too late
        if self._place and self._page is self._home:
            has_gone_on = self._make_page(now_ms)
        else:
            has_gone_on = self._works(now_ms)
        if self._waits > begun:  # it was too late: this turn counts like any other
            self._waits = waited + 1
        else:
            self._waits = 1 if self._page.is_coming() else 0
        return has_gone_on

    def _make_page(self, now_ms):
        """One of its modules; when all are there, the page. Answers whether that took long."""
        page, _, modules = PAGES[self._place]
        missing = on_demand.missing(modules)
        if missing and not self.has_time():
            return False
        try:
            module = on_demand.load(missing[0] if missing else modules[-1])
            if not missing:
                self._page = getattr(module, page)(self)
                self._waits = 1  # it may be coming still
        except MemoryError:
            self._place = 0
            self.say(now_ms, texts.NO_MEMORY)
        return True

    def _select(self, direction):
        """Show the next drive, or the one before."""
        self.show(self.controls[(self._position + direction) % len(self.controls)])

    def _turn_to(self, position):
        """What is known of that drive may be old: all of that is asked for at once."""
        self._position = position
        self.selected = control = self.controls[position]
        control.survey.recheck()
        self.warning.turn_to(control.drive, control.survey.family)
        self._neighbours.show(position)

    # --- what has to be said --------------------------------------------------------------------

    def _collect(self, now_ms):
        """Take up what the drives and the writer have to say and to ask."""
        selected = self.selected
        refusal = selected.take_refusal()
        if refusal:
            self.say(now_ms, wording.of(refusal, selected.survey.family))
            if permits.is_about_source(refusal):
                self._offer("offer")
        if self._writer:
            self._take_written(now_ms)
        if selected.phase == ASKING and self._cover is None:
            on_demand.load("panel.pages.question")  # first: an import inside an import takes stack
            self._cover = on_demand.load("panel.pages.risk").RiskQuestion(self)
        if self.message and elapsed(now_ms, self._message_at_ms, self.mask) >= _MESSAGE_MS:
            self.message = None
        if self._is_new and self._cover is None:
            self._is_new = False
            self._ask_search()
        if self._notices and self.message is None and self._cover is None:
            self.say(now_ms, *self._notices.pop(0))  # also when a key has ended the one before

    def _has_alarm(self):
        selected = self.selected
        return selected.needs_attention() or selected.fault.active or self.announcer.has_alarm()

    def _offer(self, what):
        """To write a parameter that the drive shown needs."""
        if self._cover is None:
            on_demand.load("panel.pages.question")  # first: an import inside an import takes stack
            on_demand.call("panel.pages.set_up", what, self)

    def _take_written(self, now_ms):
        write = self._writer.take_ended()
        if write:
            self.say(now_ms, *write.news(self.selected))
            if write.outcome[0] is texts.ACCESS_TOO_LOW and write.control is self.selected:
                self._offer("unlock")
        if self._writer.is_idle():
            self._writer = None
            on_demand.drop("panel.writer")
            if self._page is self._home:
                on_demand.drop("panel.pages.parameter_words")
