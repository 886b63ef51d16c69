# SPDX-License-Identifier: MIT
"""The setpoint digit by digit, behind EDIT of the home page. Row 1 still has the one in force.

    S: 10.0 F:  9.98
    NEW 017.50Hz A1         the digit that UP and DOWN change blinks

NEXT and PREVIOUS go to another digit. The new value takes effect with SET, and with nothing else:
EDIT, PARAM, STOP, an address key or half a minute without a key leave the setpoint as it was.
START, REVERSE and JOG are refused, because it is not settled yet what they would turn with.
"""

from micropython import const

from panel import texts
from panel.pages import Page
from panel.phases import ASKING
from uss.timing import elapsed

NEW_SETPOINT = b"NEW"
SET_TO_LIMIT = b"LIMIT: %d.%02d"  # in place of what was beyond it
REFUSED_DIGITS = b"NO: SET OR PARAM"  # first: the setpoint is being edited
HERTZ = b"Hz"

_STALE_MS = const(30_000)
_BLINK_MS = const(800)  # of these the digit is away for
_AWAY_MS = const(250)

# Digits and their columns in row 2; a point stands before the hundredths.
_PLACES = (10_000, 1_000, 100, 10, 1)  # centihertz
_COLUMNS = (4, 5, 6, 8, 9)
_ONES = const(2)  # of the places, which EDIT begins at
_SIGN_COLUMN = const(3)
_POINT_COLUMN = const(7)
_UNIT_COLUMN = const(10)
_ADDRESS_COLUMN = const(13)
_REFUSED_KEYS = ("START", "REVERSE", "JOG_RIGHT", "JOG_LEFT")


class Digits(Page):
    """The setpoint of the drive that was shown when EDIT was pressed, in centihertz or 0.01 %."""

    modules = ("panel.pages.digits",)
    obeys = False
    locks = False  # the setpoint may be moved while the lock is closed, and nothing else here

    def __init__(self, panel):
        Page.__init__(self, panel)
        self._control = control = panel.selected
        self._percent = control.survey.is_percent()
        self._centihertz = control.setpoint.centihertz
        self._place = _ONES
        self._used_at_ms = None  # a key was pressed; None: it has just begun

    # --- keys -----------------------------------------------------------------------------------

    def take_keys(self, acts, now_ms):
        self._used_at_ms = now_ms
        turned = acts.direction("ADDRESS_UP", "ADDRESS_DOWN")
        if acts.has("STOP") or acts.has("PARAM") or acts.has("EDIT"):
            self._leave(acts)
        elif turned:
            self._leave(acts)
            panel = self.panel
            controls = panel.controls
            panel.show(controls[(controls.index(self._control) + turned) % len(controls)])
        elif acts.pressed & sum([acts.bit(key) for key in _REFUSED_KEYS]):
            self.panel.say(now_ms, REFUSED_DIGITS)
        elif acts.has("SET"):
            if acts.pressed == acts.bit("SET"):  # with another key it is no clear wish
                self._set(acts, now_ms)
        else:
            self._place = (self._place + acts.direction("NEXT", "PREVIOUS")) % len(_PLACES)
            self._turn(acts.direction("UP", "DOWN"))

    def _turn(self, direction):
        """The digit goes round by itself, the others stay."""
        worth = _PLACES[self._place]
        digit = self._centihertz // worth % 10
        self._centihertz += ((digit + direction) % 10 - digit) * worth

    def _set(self, acts, now_ms):
        control, wish = self._control, self._centihertz
        control.setpoint.step()  # a limit that has just been read counts
        steps = wish - control.setpoint.centihertz
        if steps or not control.drive.wanted:
            control.change(steps)
            if control.refusal:
                return  # the panel says why, and the digits stay
        self._leave(acts)
        reached = control.setpoint.centihertz
        if reached != wish:
            self.panel.say(now_ms, SET_TO_LIMIT, reached // 100, reached % 100)

    def _leave(self, acts):
        acts.forget()  # a key that is held does nothing else
        self.close()

    # --- what goes on ---------------------------------------------------------------------------

    def step(self, keys, now_ms):
        if self._used_at_ms is None:
            self._used_at_ms = now_ms
        panel, control = self.panel, self._control
        if (
            panel.selected is not control
            or control.needs_attention()  # an alarm is not to be hidden
            or control.phase == ASKING  # nor is a question
            or control.survey.is_percent() != self._percent  # the digits mean something else now
            or elapsed(now_ms, self._used_at_ms, panel.mask) >= _STALE_MS
        ):
            self.close()

    def draw(self, screen, now_ms):
        screen.put(1, 0, _SIGN_COLUMN, texts.of(NEW_SETPOINT))
        screen.put(1, _SIGN_COLUMN, 1, b"-" if self._control.reversed else b" ")
        used_at_ms = now_ms if self._used_at_ms is None else self._used_at_ms
        since_ms = elapsed(now_ms, used_at_ms, self.panel.mask)
        away = self._place if since_ms % _BLINK_MS >= _BLINK_MS - _AWAY_MS else -1
        for place in range(len(_PLACES)):
            if place == away:
                screen.put(1, _COLUMNS[place], 1, b"_")
            else:
                screen.digits(1, _COLUMNS[place], 1, self._centihertz // _PLACES[place])
        screen.put(1, _POINT_COLUMN, 1, b".")
        unit = texts.PERCENT if self._percent else HERTZ
        screen.put(1, _UNIT_COLUMN, _ADDRESS_COLUMN - _UNIT_COLUMN, texts.of(unit))
