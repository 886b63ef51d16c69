# SPDX-License-Identifier: MIT
"""Parameter mode: row 1 stays as it is on the home page, row 2 is a parameter of the drive shown.

    S: 10.0 F:  9.98
    P1000:     5 A1         the value as the drive tells it, read again and again

NEXT and PREVIOUS walk the rows of PARAMETERS. EDIT freezes the value, UP and DOWN change it, EDIT
lets it go again. SET writes it into the drive's RAM; SET held for 1.5 s, and no other key with it,
writes it into the EEPROM as well. Between value and address: an arrow while the value is frozen,
an hourglass while a write is on its way. A warning of the drive takes turns with all that.
"""

from micropython import const

from panel import texts
from panel.pages import warning
from panel.pages.question import Question
from panel.screen import BUSY, EDITS
from panel.writer import refusal, unanswered
from uss import pkw, profiles
from uss.timing import elapsed

PARAMETERS = (  # what is shown, number, index, highest value or None: read only. Lowest is 0.
    (b"P0700:", 700, 0, 6),
    (b"P1000:", 1000, 0, 77),
    (b"P2011:", 2011, 0, 31),
    (b"r2024:", 2024, 0, None),
    (b"r2025:", 2025, 0, None),
)

KEYS = ("UP", "DOWN", "NEXT", "PREVIOUS", "EDIT", "SET")

_READ_MS = const(500)  # between an answer and the next question
_EEPROM_MS = const(1_500)  # SET is held so long
_FAST_SPAN = const(100)  # values of a smaller range move by ones, however long the key is held

_MARK_COLUMN = const(12)
GLYPHS = (bytes((BUSY,)), bytes((EDITS,)))

ASK = {profiles.CUTS_OFF: texts.ASK_CUTS_OFF, profiles.RESCALES: texts.ASK_RESCALES}


class Parameters:
    """panel: the `Panel`. keys: its `Keys`. writer: its `Writer`. mask: the clock's period - 1."""

    whole = False
    tells_state = False
    obeys = True

    def __init__(self, panel, keys, writer, mask):
        self._panel = panel
        self._bits = tuple(keys.bit(key) for key in KEYS)
        self._set_key = keys.bit("SET")
        self._writer = writer
        self._mask = mask
        self._row = 0
        self._control = None  # the drive that what follows belongs to
        self._value = None  # as last told by the drive
        self._refused = False  # it does not tell it
        self._editing = False
        self._edited = 0
        self._job = pkw.read(0)
        self._other_job = pkw.read(0)
        self._asked = False
        self._due = True  # ask at once
        self._read_at_ms = 0
        # What SET was pressed for: control, number, index, value.
        self._wish = None
        self._writing = False  # the wish is on its way
        # A SET that is held makes a write permanent once it is confirmed.
        self._set_at_ms = None  # when it went down, None when it is up or was used up

    def open(self):
        """It is shown from now on."""
        self._forget()

    # --- keys -----------------------------------------------------------------------------------

    def take_keys(self, acts, now_ms):
        self._look_at_selected()
        up, down, following, previous, edit, set_key = self._bits
        if acts.pressed & ~set_key:
            self._set_at_ms = None
        step = acts.moved(following) - acts.moved(previous)
        if step:
            self._row = (self._row + step) % len(PARAMETERS)
            self._forget()
        elif acts.pressed & edit:
            self._toggle_edit(now_ms)
        elif acts.pressed == set_key and set_key:  # with another key it is no clear wish
            self._set(now_ms)
        direction = acts.moved(up) - acts.moved(down)
        if direction:
            self._change(direction, acts, now_ms)

    def _toggle_edit(self, now_ms):
        if PARAMETERS[self._row][3] is None:
            self._panel.say(texts.READ_ONLY, now_ms)
        elif self._value is None:
            self._panel.say(texts.NOT_READ_YET, now_ms)
        else:
            self._editing = not self._editing
            self._edited = self._value

    def _change(self, direction, acts, now_ms):
        highest = PARAMETERS[self._row][3]
        if not self._editing:
            self._panel.say(texts.EDIT_FIRST if highest is not None else texts.READ_ONLY, now_ms)
            return
        pace = acts.pace(100 if highest > _FAST_SPAN else 1)
        self._edited = max(0, min(highest, self._edited + direction * pace))

    def _set(self, now_ms):
        if not self._editing:
            self._panel.say(texts.EDIT_FIRST, now_ms)
            return
        _, number, index, _ = PARAMETERS[self._row]
        self._wish = (self._control, number, index, self._edited)
        reason = self._why_not()
        if reason is not None:
            self._panel.say(reason, now_ms)
        elif number in profiles.ASK_FIRST:
            turns, choice = ASK[profiles.ASK_FIRST[number]]
            subject = b"A%d: P%04d=%d" % (self._control.drive.address, number, self._edited)
            text = ((subject,) + turns, choice)
            self._panel.ask(Question(self._panel, text, {"SET": self._write}, self._mask))
        else:
            self._write(now_ms)

    def _why_not(self):
        """Why the wish is not even tried. Asked again when a question was answered."""
        control, number, _, value = self._wish
        if number != profiles.USS_ADDRESS:
            return None
        if self._panel.any_runs() or control.is_starting():
            return texts.STOP_FIRST
        return texts.ADDRESS_TAKEN if self._panel.is_taken(value) else None

    def _write(self, now_ms, eeprom=False):
        reason = self._why_not()
        if reason is None:
            control, number, index, value = self._wish
            always = number in profiles.PERMANENT
            reason = self._writer.write(control, number, index, value, eeprom or always)
        if reason is not None:
            self._panel.say(reason, now_ms)
            return
        self._writing = True
        self._set_at_ms = None if eeprom or always else now_ms

    # --- what goes on ---------------------------------------------------------------------------

    def step(self, keys, now_ms):
        """Again and again while it is shown."""
        self._look_at_selected()
        contact = self._control.drive.contact
        if not contact or not keys.down & self._set_key:
            self._set_at_ms = None
        if not contact:
            self._value = None
            self._due = True
        if not self._writer.busy:
            self._follow_write(now_ms)
        if self._asked:
            self._take_answer(now_ms)
        elif contact:
            self._ask(now_ms)

    def _look_at_selected(self):
        if self._panel.selected is not self._control:
            self._forget()

    def _follow_write(self, now_ms):
        if self._writing:
            self._writing = False
            self._due = True
            if self._writer.written:
                self._editing = False
            else:
                self._set_at_ms = None
        elif self._set_at_ms is not None:
            if elapsed(now_ms, self._set_at_ms, self._mask) >= _EEPROM_MS:
                self._write(now_ms, True)

    def _ask(self, now_ms):
        waited_ms = elapsed(now_ms, self._read_at_ms, self._mask)
        drive = self._control.drive
        if (self._due or waited_ms >= _READ_MS) and not drive.channel.is_full():
            _, number, index, _ = PARAMETERS[self._row]
            self._job.aim(pkw.READ, number, index)
            drive.ask(self._job)
            self._asked = True
            self._due = False

    def _take_answer(self, now_ms):
        job = self._job
        if job.state == pkw.PENDING:
            return
        self._asked = False
        self._read_at_ms = now_ms
        refused = job.state in (pkw.REFUSED, pkw.UNANSWERED)
        if refused and not self._refused:
            text = refusal(job.error) if job.state == pkw.REFUSED else unanswered(job)
            self._panel.say(text, now_ms)
        self._refused = refused
        self._value = job.low if job.state == pkw.DONE else None

    def _forget(self):
        """Another parameter or another drive: nothing is known of it yet, nothing is edited."""
        self._control = self._panel.selected
        self._value = None
        self._refused = False
        self._editing = False
        self._writing = False
        self._wish = None
        self._set_at_ms = None
        self._due = True
        if self._asked:  # the drive may take its time with that one
            self._asked = False
            self._job, self._other_job = self._other_job, self._job
            if self._job.state == pkw.PENDING:
                self._job = pkw.read(0)

    def draw(self, screen, now_ms):
        if warning.draw(screen, self._panel):
            return
        value = self._edited if self._editing else self._value
        screen.put(1, 0, texts.PARAMETER_WIDTH, PARAMETERS[self._row][0])
        if value is not None:
            screen.number(1, texts.PARAMETER_WIDTH, texts.VALUE_WIDTH, value * 100, 0)
        else:
            unknown = texts.REFUSED_VALUE if self._refused else texts.UNREAD_VALUE
            screen.put(1, texts.PARAMETER_WIDTH, texts.VALUE_WIDTH, unknown)
        mark = GLYPHS[BUSY] if self._writing else GLYPHS[EDITS] if self._editing else b""
        screen.put(1, _MARK_COLUMN, 1, mark)
