# SPDX-License-Identifier: MIT
"""The operator's side of the search: what to look for, how far it is, what to take.

    FIND DRIVES  20s        OFFER: UP and DOWN choose how many rates are tried, and say how long
    3 RATES SET=GO          that takes if nobody answers. SET begins, PARAM goes back to the panel

    19200 BAUD   12s        HUNTING: how long it still takes. STOP ends it
    2 FOUND STOP=NO

    A3 19200 G110           CHOOSING: UP and DOWN walk what was found, SET takes it or leaves it,
    127+2  READY [X]        PARAM goes on

    TAKE 2 DRIVES?          ASKING: SET writes the settings, PARAM goes back to the panel
    SET=YES PARAM=NO

It obeys no key that moves a motor, and it knows no drive that could. In use: as `App`.
"""

from micropython import const

import on_demand
from panel import texts
from panel.keys import Acts, keys_of
from panel.screen import GLYPHS, Screen
from search import words
from search.hunt import Hunt, seconds_for
from uss.timing import BAUD_RATES

OFFER, HUNTING, CHOOSING, ASKING, NOBODY = range(5)

QUICK_RATES = (9600, 19200, 38400)  # those of every interface (specification B-2.4)
_DRAW_MS = const(100)


class Search:
    """board: contract of `hal`. settings: a `Settings`, of a panel that has left the line."""

    def __init__(self, board, settings):
        self.board = board
        self.settings = settings
        self._mask = mask = board.clock.ticks_mask
        names = board.keypad.names
        self._keys = keys = keys_of(names, mask)
        self._acts = Acts(keys)
        self.screen = Screen(getattr(board.display, "rom", "A00"))
        board.display.define(GLYPHS)
        self._state = OFFER
        self._all_rates = False
        self._hunt = None
        self._row = 0  # of what was found
        self._taken = []  # addresses at the rate of the first one
        self._drawn_at_ms = 0
        self._following = None  # the program that comes next

    def start(self):
        self.board.watchdog.feed()

    def step(self):
        """One turn of the main loop. Answers the program that comes next, None as long as this
        one goes on."""
        board = self.board
        now_ms = board.clock.ticks_ms()
        board.watchdog.feed()
        if self._hunt is not None and not self._hunt.over:
            if self._hunt.step(board.clock.ticks_us()):
                self._end_hunt()
        keys = self._keys
        if keys.update(board.keypad.read(), now_ms, board.keypad.unclear):
            self._acts.note()
            self._take_keys(self._acts)
        if (now_ms - self._drawn_at_ms) & self._mask >= _DRAW_MS:
            self._drawn_at_ms = now_ms
            self._draw()
        board.display.show(self.screen.picture)
        if self.settings.log != "none":
            board.serial().hear()
        board.idle()
        return self._following

    def close(self):
        if self._hunt is not None:
            self._hunt.close()

    def _leave(self):
        """Back to the panel."""
        self.close()
        self._following = on_demand.load("app").Handover(self.board, self.settings, "app")

    # --- keys -----------------------------------------------------------------------------------

    def _take_keys(self, acts):
        state = self._state
        direction = acts.direction("UP", "DOWN") or acts.direction("NEXT", "PREVIOUS")
        if state == HUNTING:
            if acts.has("STOP"):
                self._end_early()
        elif acts.has("PARAM"):
            if state == CHOOSING and self._taken:
                self._state = ASKING
            else:
                self._leave()
        elif state == OFFER and direction:
            self._all_rates = not self._all_rates
        elif state == OFFER and acts.has("SET"):
            self._hunt = Hunt(self.board, self._rates(), self.settings.reply_timeout_ms)
            self._state = HUNTING
        elif state == CHOOSING and direction:
            self._row = (self._row - direction) % len(self._hunt.found)
        elif state == CHOOSING and acts.has("SET"):
            self._choose(self._hunt.found[self._row])
        elif state == ASKING and acts.has("SET"):
            self._write()
            self._leave()
        elif state == NOBODY and acts.pressed:
            self._state = OFFER

    def _rates(self):
        """The likely ones first: the slow ones take minutes, and STOP keeps what was found."""
        rates = [self.settings.baud]
        for rate in QUICK_RATES + (BAUD_RATES if self._all_rates else ()):
            if rate not in rates:
                rates.append(rate)
        return tuple(rates)

    def _end_early(self):
        """What was found so far stays; STOP once more does not even ask it what it is."""
        if self._hunt.ends:
            self._hunt.end()
            self._end_hunt()
        self._hunt.finish()

    def _end_hunt(self):
        found = self._hunt.found
        self._state = CHOOSING if found else NOBODY
        self._row = 0
        rates = [one.baud for one in found]
        rate = max(rates, key=rates.count) if rates else 0
        self._taken = [one for one in found if one.baud == rate]

    def _choose(self, one):
        """Take it, or leave it. All that are taken have one rate: that of the last one taken."""
        if one in self._taken:
            self._taken.remove(one)
        else:
            self._taken = [other for other in self._taken if other.baud == one.baud] + [one]

    def _write(self):
        """The drives that were taken are those of the panel, in the order of their addresses.

        At the rate that the panel had, those that it had before stay as well: they may be without
        their mains just now.
        """
        settings, rate = self.settings, self._taken[0].baud
        if rate != settings.baud or settings.new:
            settings.begin_anew(rate)
        for one in sorted(self._taken, key=lambda one: one.address):
            kind = on_demand.call("uss.families.kinds", "text", one.family, one.layout)
            if one.address in settings.drives:
                settings.set_kind(one.address, kind)
            else:
                settings.add(one.address, kind)
        on_demand.call("settings_file", "save", self.board.store, settings)

    # --- what is shown --------------------------------------------------------------------------

    def _draw(self):
        rows = self._rows_of(self._state)
        for row in range(2):
            self.screen.put(row, 0, texts.ROW_WIDTH, rows[row])
        self.screen.mark(self._keys.shift)

    def _rows_of(self, state):
        if state == OFFER:
            rates = self._rates()
            taking_s = seconds_for(rates, self.settings.reply_timeout_ms * 1000)
            first = texts.of(words.FIND_DRIVES_S, taking_s)
            return first, texts.of(words.RATES_SET_GO, len(rates))
        if state == HUNTING:
            hunt = self._hunt
            if hunt.ends:
                return texts.of(words.SEARCH_ENDS), texts.of(words.FOUND_STOP_ENDS, hunt.count())
            return (
                texts.of(words.BAUD_SECONDS, hunt.baud, hunt.seconds_left()),
                texts.of(words.FOUND_STOP_ENDS, hunt.count()),
            )
        if state == CHOOSING:
            return self._choice(self._hunt.found[self._row])
        if state == ASKING:
            return texts.of(words.TAKE_DRIVES, len(self._taken)), texts.of(words.SET_YES)
        heard = texts.LINE_IN_USE if self._hunt.line_in_use else words.NOBODY_FOUND
        return texts.of(heard), texts.of(words.CHECK_WIRES)

    def _choice(self, one):
        family = one.family.__name__.encode()
        layout = b"%d+%d" % (one.layout.pkw_words, one.layout.pzd_words)
        mark = texts.of(words.TAKEN if one in self._taken else words.NOT_TAKEN)
        state = texts.of(texts.FOUND_STATES[one.state])
        first = b"A%d %d %s" % (one.address, one.baud, family)
        second = b"%-5s %s" % (state, mark)
        room = texts.ROW_WIDTH - len(second) - 1
        return first, b"%s%s %s" % (layout, b" " * (room - len(layout)), second)
