# SPDX-License-Identifier: MIT
"""Parameter mode: row 1 stays as it is on the home page, row 2 is a parameter of the drive shown.

    S: 10.0 F:  9.98
    P1000:     5 A1         the value as the drive tells it, read again and again

NEXT and PREVIOUS walk the parameters that the drive's family shows. EDIT freezes the value, UP and
DOWN change it, EDIT lets it go again. SET writes it into the drive's RAM; SET held for 1.5 s, and
no other key with it, writes it into the EEPROM as well. Between value and address: an arrow while
the value is frozen, an hourglass while a write is on its way. A warning of the drive takes turns
with all that.
"""

from micropython import const

from panel import texts
from panel.pages import parameter_words as words
from panel.pages import Page, warning
from panel.pages.parameter_words import failure
from panel.pages.table import PAGES, PARAMETERS
from panel.pages.writing import Writing
from panel.reading import Reading
from panel.screen import BUSY, EDITS
from uss import pkw
from uss.timing import elapsed

_READ_MS = const(500)  # between an answer and the next question
_FAST_SPAN = const(100)  # values of a smaller range move by ones, however long the key is held

_MARK_COLUMN = const(12)
_ADDRESS_COLUMN = const(13)
GLYPHS = (bytes((BUSY,)), bytes((EDITS,)))


class Parameters(Page):
    """Which parameter is shown, of which drive, and what is done with it."""

    modules = PAGES[PARAMETERS][2]

    def __init__(self, panel):
        Page.__init__(self, panel)
        self._row = panel.remembered.get(__name__, 0)
        self._edited = 0
        self._reading = Reading()
        self._writing = Writing(panel)
        self._read_at_ms = 0
        self._value = None  # as last told by the drive
        self._refused = False  # it does not tell it
        self._control = None  # whose it all is: the first step looks, for this one takes long

    # --- keys -----------------------------------------------------------------------------------

    def take_keys(self, acts, now_ms):
        self._look_at_selected()
        if not self._shown:
            return
        set_key = acts.bit("SET")
        if acts.pressed & ~set_key:
            self._writing.let_go()
        step = acts.direction("NEXT", "PREVIOUS")
        if step:
            self._row += step
            self._forget()
            self.panel.remembered[__name__] = self._row
        elif acts.has("EDIT"):
            self._toggle_edit(now_ms)
        elif acts.pressed == set_key and set_key:  # with another key it is no clear wish
            self._set(now_ms)
        direction = acts.direction("UP", "DOWN")
        if direction:
            self._change(direction, acts, now_ms)

    def _toggle_edit(self, now_ms):
        if self._shown[self._row][1] is None:
            self.panel.say(now_ms, words.READ_ONLY)
        elif self._value is None:
            self.panel.say(now_ms, words.NOT_READ_YET)
        else:
            self._editing = not self._editing
            self._edited = self._value

    def _change(self, direction, acts, now_ms):
        highest = self._shown[self._row][1]
        if not self._editing:
            self.panel.say(now_ms, words.READ_ONLY if highest is None else words.EDIT_FIRST)
            return
        pace = acts.pace(100 if highest > _FAST_SPAN else 1)
        value = max(0, min(highest, self._edited + direction * pace))
        if 0 < value < self._shortest():
            value = self._shortest() if direction > 0 else 0
        self._edited = value

    def _shortest(self):
        """The least value that is not 0. With a shorter telegram-off time the drive would trip on
        this bus, see `supervision`."""
        control = self._control
        family = control.survey.family
        if self._shown[self._row][0] != family.off_time_number:
            return 0
        return -(-control.desk.off_time_ms // family.off_time_unit_ms)

    def _set(self, now_ms):
        if not self._editing:
            self.panel.say(now_ms, words.EDIT_FIRST)
            return
        control, number, value = self._control, self._shown[self._row][0], self._edited
        risk = control.survey.family.ask_first.get(number)
        what = (control, number, self._index(number), value)
        self._writing.set(now_ms, what, risk, (control.drive.address, number, value))

    # --- what goes on ---------------------------------------------------------------------------

    def step(self, keys, now_ms):
        if self.panel.selected is not self._control:
            self._forget()  # nothing else in this step: this takes long enough
            return
        if self._reading.prepare():
            return
        contact = self._control.drive.contact and self._shown
        if not contact:
            self._value = None
            self._due = True
        write = self._writing.step(keys.down & keys.bit("SET") if contact else 0, now_ms)
        if write:
            self._due = True
            self._editing = self._editing and not write.done
        if self._reading.asked:
            self._take_answer(now_ms)
        elif contact:
            self._ask(now_ms)

    def _index(self, number):
        """The index of the link, where the number has one for each link."""
        family = self._control.survey.family
        return family.link_index if number in family.linked else 0

    def _look_at_selected(self):
        if self.panel.selected is not self._control:
            self._forget()

    def _ask(self, now_ms):
        waited_ms = elapsed(now_ms, self._read_at_ms, self.panel.mask)
        if self._due or waited_ms >= _READ_MS:
            number = self._shown[self._row][0]
            if self._reading.ask(self._control.drive, number, self._index(number)):
                self._due = False

    def _take_answer(self, now_ms):
        job = self._reading.take()
        if job is None:
            return
        self._read_at_ms = now_ms
        refused = job.state in (pkw.REFUSED, pkw.UNANSWERED)
        if refused and not self._refused:
            self.panel.say(now_ms, *failure(job))
        self._refused = refused
        self._value = job.low if job.state == pkw.DONE else None

    def _forget(self):
        """Another parameter or another drive: nothing is known of it yet, nothing is edited."""
        self._control = control = self.panel.selected
        # (number, highest value; None: read only)
        self._shown = control.survey.family.shown if control.drive.layout.pkw_words else ()
        self._row %= max(len(self._shown), 1)
        self._value = None
        self._refused = False
        self._editing = False
        self._writing.forget()
        self._due = True  # ask at once
        self._reading.drop()

    def draw(self, screen, now_ms):
        if self._control is None:
            return
        if warning.draw(screen, self.panel):
            return
        if not self._shown:
            screen.put(1, 0, _ADDRESS_COLUMN, texts.of(words.NO_PARAMETERS))
            return
        value = self._edited if self._editing else self._value
        number, highest = self._shown[self._row]
        name = words.READ_PARAMETER if highest is None else words.PARAMETER
        screen.put(1, 0, words.PARAMETER_WIDTH, texts.of(name))
        screen.digits(1, 1, 4, number)
        if value is not None:
            screen.number(1, words.PARAMETER_WIDTH, texts.VALUE_WIDTH, value * 100, 0)
        else:
            unknown = words.REFUSED_VALUE if self._refused else texts.UNREAD_VALUE
            screen.put(1, words.PARAMETER_WIDTH, texts.VALUE_WIDTH, texts.of(unknown))
        mark = GLYPHS[BUSY] if self._writing.write else GLYPHS[EDITS] if self._editing else b""
        screen.put(1, _MARK_COLUMN, 1, mark)
