# SPDX-License-Identifier: MIT
"""The application: engine, panel and settings put together on a board.

    app = App(board)
    app.start()
    while True: app.step()          # the main loop: keys, panel, a piece of the display
    app.close()                     # every drive is stopped first

The bus runs by interrupts beside the loop (`hal.pacer`), and each watches the other: the engine
sends ON only while `step` refreshes it, and `step` feeds the watchdog only while the engine works.
"""

from micropython import const

import on_demand

# From the bottom of the house up: an import inside an import inside an import takes stack.
import uss.fast  # noqa: F401
from uss.timing import Timing, elapsed
from uss.drive import Drive
import uss.master  # noqa: F401
from uss.going_on import master_of
from uss.leave import leave, persist
import uss.survey  # noqa: F401
from hal.pacer import Pacer
from panel import texts
import panel.risks  # noqa: F401
import panel.control  # noqa: F401
from panel.roster import Roster
import panel.pages.home  # noqa: F401
from panel.panel import Panel
from panel.screen import GLYPHS

_FINDER = ("uss.finding", "uss.finding.mirror", "uss.finding.finder")
_FAREWELL_STEPS = const(100)  # for the display to show that nothing is controlled any more
_SAVE_AGAIN_MS = const(10_000)  # after the store failed
_LONG_US = const(500)  # a step that has taken so long is not to do two more things
_ENOUGH_US = const(1_500)  # if the panel has taken so long, the step is over
_FULL_US = const(2_000)  # after so long, what can wait does
_SHORT_US = const(700)  # one that has taken no longer has time for a piece of the log
_SILENCES = const(3)  # telegrams without an answer, then somebody looks for another layout
_FEED_MS = const(100)  # of the watchdog, which bites after 2 s
_HUNGRY_MS = const(500)  # then it is fed in any step


class App:
    """board: contract of `hal`. Nothing is sent before `start`, which must follow within 2 s: the
    watchdog is at work."""

    def __init__(self, board):
        board.watchdog.feed()  # it bites from now on, whatever hangs before the loop is reached
        self.board = board
        self.settings = settings = on_demand.call("settings_file", "load", board.store)
        if getattr(board, "must_supervise", False):
            settings.unsupervised = ()  # what was accepted on another board
        mask = board.clock.ticks_mask
        self.link = board.make_link(settings.baud)
        timing = Timing(settings.baud, settings.reply_timeout_ms * 1000)
        self.bus = master_of(self.link, timing, mask, settings.lost_ms * 1000)
        self._finder = None
        self._doubts = Drive.doubts
        self.pacer = Pacer(self.bus, self.link, board.clock, board.timer)
        defect = texts.DEFECTS.get(getattr(self.link, "defect", ""), texts.NOTHING)
        self._roster = roster = Roster(self.bus, settings, mask, defect)
        board.display.define(GLYPHS)
        restart = texts.WATCHDOG_RESTART if board.reset_cause else texts.NOTHING
        self.panel = Panel(roster, self.bus, board, settings, mask, (defect, restart))
        on_demand.keep("panel.at_hand")
        self._log = None  # the `Log`, while the settings want one
        self._mask = mask
        self.ticks_us = board.clock.ticks_us
        self._ticks_ms = board.clock.ticks_ms
        # A method that is found once is not looked for in every step.
        self.step_panel = self.panel.step
        self.refresh_bus = self.bus.refresh
        self._tend = self.pacer.tend
        self._polled = board.timer is None  # then each step drives the bus
        self._progress = 0  # of the bus as last seen, and when it moved
        self._progress_at_ms = 0
        self._fed_at_ms = 0
        self._save_failed_at_ms = None
        self._shows_next = False

    def start(self):
        self._progress_at_ms = self._fed_at_ms = self._ticks_ms()
        self.board.watchdog.feed()
        self.bus.refresh(self.ticks_us())
        self.pacer.start()

    def step(self):
        """One turn of the main loop, 4 ms of work at most; ends in the board's `idle`. Answers the
        program that comes next, None as long as this one goes on."""
        now_us = self.ticks_us()  # first: an interrupt counts as time of this step
        board = self.board
        keypad = board.keypad
        now_ms = self._ticks_ms()
        self.refresh_bus(now_us, False)
        if self.step_panel(keypad.read(), now_ms, now_us, keypad.unclear):
            if (self.ticks_us() - now_us) & self._mask <= _ENOUGH_US:
                self._look_or_show(now_us)
            if self.settings.dirty or self.panel.errand:
                self._write_if_quiet(now_ms)
        elif (now_ms - self._fed_at_ms) & self._mask >= _FEED_MS:
            self._feed(now_ms, now_us)
        elif self._log is not None:
            self._log_on(now_ms, now_us)
        elif not self._is_long(now_us):
            self._tend()  # the panel may have asked for something
        if self._polled:
            self._tend()
        board.idle()
        return self._hand_over() if self.panel.wants else None

    def _hand_over(self):
        """The program that comes next: this one leaves the line, and no motor runs."""
        wanted, self.panel.wants = self.panel.wants, None
        if self.panel.any_runs():
            return None
        self._leave()
        if self.settings.dirty:
            self._save(0)
        if wanted == "app":
            self._say(texts.BEGINS_ANEW)
        # A chip has no room for two panels of 31 drives: whoever still finds this finds no more.
        self.link = self.bus = self.pacer = self.panel = self._roster = self._finder = (
            self._log
        ) = None
        self.step_panel = self.refresh_bus = self._tend = None
        return Handover(self.board, self.settings, wanted)

    def _look_or_show(self, now_us):
        """The drives that are silent or wait too long, and the pacer; a piece of the display: both
        of these, or one where that has taken long, and next time the other one.
        """
        if not self._shows_next:
            if self._finder is None and self._wants_finder():
                self._load_finder()
                return
            self.refresh_bus(now_us)
            if self._finder is not None:
                self._find(now_us)
            if self._is_long(now_us) or self._tend() and self._is_long(now_us):
                self._shows_next = True
                return
        self._shows_next = False
        self.board.display.show(self.panel.screen.picture)

    def _is_long(self, now_us):
        """Whether the step that began then has taken long."""
        return (self.ticks_us() - now_us) & self._mask > _LONG_US

    def _find(self, now_us):
        """Look for drives that are silent because their telegrams are divided differently."""
        found = self._finder.step(now_us)
        if found is not None:
            self._roster.note_layout(found)

    def _wants_finder(self):
        """Whether a drive is silent, or in doubt, for the first time: most need none."""
        return self.bus.deadlines.silence.count >= _SILENCES or Drive.doubts != self._doubts

    def _load_finder(self):
        """One of its modules; when all are there, the finder."""
        missing = on_demand.missing(_FINDER)
        module = on_demand.load(missing[0] if missing else _FINDER[-1])
        if not missing:
            self._finder = module.Finder(self.bus, self._mask, _enquirer)

    def _write_if_quiet(self, now_ms):
        """Writing flash holds everything up for a while, interrupts too: only when no drive runs,
        and between two exchanges."""
        failed_at_ms = self._save_failed_at_ms
        has_just_failed = (
            failed_at_ms is not None and elapsed(now_ms, failed_at_ms, self._mask) < _SAVE_AGAIN_MS
        )
        errand = self.panel.errand
        if self.panel.any_runs() or has_just_failed and errand is None:
            self.bus.resume()
            return
        self.bus.pause()
        # `paused` does not know yet of a command that this very step has given: that goes first.
        if self.bus.paused and not self.bus.turns.has_command():
            if errand is not None:
                self.panel.errand = None
                errand()
            elif self.settings.dirty:
                self._save(now_ms)
            self.bus.resume()

    def _save(self, now_ms):
        try:
            on_demand.call("settings_file", "save", self.board.store, self.settings)
            self._save_failed_at_ms = None
        except OSError:
            self._save_failed_at_ms = now_ms
            self.panel.say(now_ms, texts.NOT_SAVED)

    def close(self):
        """Stop every drive, wait for its answer as long as it may take, and leave no interrupt.

        Ctrl-C does not cut this short, wherever it strikes.
        """
        if self.bus is not None:
            self._leave()
            persist(self._say, texts.FAREWELL)

    def _leave(self):
        try:
            leave(self.bus, self.board.clock, self._go_on)
        finally:
            persist(self.pacer.stop)

    def _go_on(self):
        self.pacer.tend()
        self.board.watchdog.feed()
        self.board.idle()

    def _say(self, rows):
        """The picture of a panel that has stopped would go on saying what no longer holds."""
        screen = self.panel.screen
        for row in range(len(rows)):
            screen.put(row, 0, texts.ROW_WIDTH, texts.of(rows[row]))
        try:
            for _ in range(_FAREWELL_STEPS):
                if self.board.display.show(screen.picture):
                    return
                self.board.idle()
        except Exception:  # it may be the display that has failed
            pass

    def _feed(self, now_ms, now_us):
        """Feed the watchdog, as long as the engine works; what took long is not made longer."""
        unfed_ms = elapsed(now_ms, self._fed_at_ms, self._mask)
        if unfed_ms < _HUNGRY_MS and (self.ticks_us() - now_us) & self._mask >= _FULL_US:
            return
        self._fed_at_ms = now_ms
        if self.bus.progress != self._progress:
            self._progress = self.bus.progress
            self._progress_at_ms = now_ms
        stands_ms = elapsed(now_ms, self._progress_at_ms, self._mask)
        if stands_ms * 1000 < self.bus.patience_us():
            self.board.watchdog.feed()
        if (self._log is not None) != (self.settings.log != "none"):
            self._switch_log(now_ms)

    def _log_on(self, now_ms, now_us):
        """A piece of the log, if a step has time for it that has begun then."""
        if (self.ticks_us() - now_us) & self._mask < _SHORT_US:
            self._log.step(now_ms)

    def _switch_log(self, now_ms):
        """Begin the log that the settings want, or end it."""
        make_serial = getattr(self.board, "serial", None)
        if make_serial is None:  # the settings of another board
            self.settings.log = "none"
            return
        try:
            serial = make_serial()
            serial.listen(self._log is None)
            if self._log is not None:
                self._log = None
                on_demand.drop("log")
            else:
                self._log = on_demand.load("log").Log(self.panel, serial, now_ms)
        except MemoryError:
            self.settings.log = "none"
            self.panel.say(now_ms, texts.NO_MEMORY)


def _enquirer(*node):
    """Asks a drive what it is; the module leaves the memory with it."""
    return on_demand.call("uss.finding.enquiry", "Enquirer", *node)


class Handover:
    """The program between two others: whoever has called the one before has let go of it when this
    one makes the next. wanted: as `wants` of `Panel`."""

    def __init__(self, board, settings, wanted):
        self._board = board
        self._settings = settings
        self._wanted = wanted
        self._following = None

    def step(self):
        """Answers the program that comes next, which is at work."""
        if self._wanted == "app":
            for module in on_demand.load("search").MODULES:
                on_demand.drop(module)
            on_demand.flush()
            self._following = App(self._board)
        else:
            on_demand.flush()
            search = on_demand.load("search.search").Search
            self._following = search(self._board, self._settings)
        self._following.start()
        return self._following

    def close(self):
        if self._following is not None:
            self._following.close()
