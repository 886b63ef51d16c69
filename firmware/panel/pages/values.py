# SPDX-License-Identifier: MIT
"""What the home page shows in row 1 in place of the actual frequency, once NEXT was pressed.

    S: 10.0   1.37A         one value at a time: which a drive has, `uss.families.readings` says

Percent of the reference comes from PZD2, the others are parameters, which are read again and again
behind everything else that is asked of the drive. In use, by the home page:

    values = Values(panel)
    values.turn(1)              # NEXT; False: it is the actual frequency's turn again
    values.step(now_ms)         # again and again; likewise
    values.draw(screen)         # False: the drive shown has no such value
"""

from micropython import const

import on_demand
from panel import texts
from panel.phases import CHECKING
from panel.reading import Reading
from uss import pkw
from uss.timing import elapsed

_READ_MS = const(300)  # between an answer and the next question
_REFUSED_MS = const(10_000)  # and after one that the drive does not answer
_STALE_MS = const(3_000)  # an older value is none any more

_FREQUENCY = const(-2)  # the actual one, which `panel.view` draws
_PERCENT = const(-1)  # of the reference

# By quantity of `uss.families.readings`: unit, decimals. They are the same in every language.
_UNITS = (
    (b"Hz", 2),
    (b"rpm", 0),
    (b"A", 2),
    (b"V", 0),
    (b"Vdc", 0),
    (b"kW", 2),
    (b"C M", 0),  # motor
    (b"C I", 0),  # inverter
)
_UNIT_COLUMN = const(13)
_UNIT_WIDTH = const(3)
_FIELD_COLUMN = const(7)
_FIELD_WIDTH = const(6)
_WIDE = const(999_950)  # hundredths, 10000: from here on a minus needs the whole field
_WIDEST = const(9_999_950)  # 100000: a number without a minus does

_SHIFT = const(21)  # of 23 bits behind the point: 2 go into the factor 100 = 25 << 2
_EXPONENT_MAX = const(16)  # above 131071 nothing is believed
_EXPONENT_MIN = const(-8)  # below 1/256 it is nothing


class Values:
    """Which value is shown, and of which drive it was read last. panel: the `Panel`."""

    def __init__(self, panel):
        self._panel = panel
        self._reading = Reading()
        self._quantity = _FREQUENCY
        self._direction = 0  # in which the operator goes on; 0: the drive has told a value
        self._control = self._family = self._layout = None
        self._rows = ()  # of this family with this layout
        self._refused = []  # quantities, of this drive
        self._read_at_ms = 0
        self._look()

    def turn(self, direction):
        """Another value; those that the drive has refused are left out."""
        self._look()
        order = [_FREQUENCY] if self._is_percent() else [_FREQUENCY, _PERCENT]
        order += [row[0] for row in self._rows]
        at = order.index(self._quantity) if self._quantity in order else 0
        at = (at + direction) % len(order)
        while order[at] in self._refused:
            at = (at + direction) % len(order)
        self._quantity = order[at]
        self._direction = direction
        self.forget()
        return order[at] != _FREQUENCY

    def forget(self):
        """What is known is old: it is read anew."""
        self._value = None  # in hundredths
        self._untold = False  # it was asked for in vain
        self._wait_ms = 0  # from the last answer to the next question
        self._reading.drop()

    def step(self, now_ms):
        self._look()
        if self._quantity == _PERCENT:
            return True
        control = self._control
        if not control.drive.contact:
            if self._value is not None or self._untold:
                self.forget()
            return True
        since_ms = elapsed(now_ms, self._read_at_ms, self._panel.mask)
        if self._reading.asked:
            if self._value is not None and since_ms >= _STALE_MS:
                self._value = None
            return self._take(now_ms)
        row = self._row()
        if row is None or control.phase == CHECKING or control.survey.unchecked:
            return True  # a START, or a drive that has just been turned to, goes first
        if since_ms >= self._wait_ms:
            self._reading.ask(control.drive, row[1])
        return True

    def draw(self, screen):
        """Draw it into row 1; answers whether there was anything to draw."""
        control = self._control
        if control is not self._panel.selected:
            return False  # until `step` has seen that
        if self._quantity == _PERCENT:
            unit, decimals = texts.PERCENT, 1
            if self._is_percent():
                return False
            if control.actual_is_beyond() and control.actual_centihertz() is not None:
                screen.put(0, _FIELD_COLUMN, _FIELD_WIDTH, texts.of(texts.BEYOND_VALUE))
                screen.put(0, _UNIT_COLUMN, _UNIT_WIDTH, texts.of(unit))
                return True
            value = self._percent()
        elif self._row() is None:
            return False
        else:
            unit, decimals = _UNITS[self._quantity]
            value = self._value
        if value is None:
            known = self._quantity == _PERCENT or self._untold or not control.drive.contact
            text = texts.UNKNOWN_VALUE if known else texts.UNREAD_VALUE
            screen.put(0, _FIELD_COLUMN, _FIELD_WIDTH, texts.of(text))
        else:
            short = 0 if value <= -_WIDE or value >= _WIDEST else 1
            screen.put(0, _FIELD_COLUMN, 1, b"")
            column, width = _FIELD_COLUMN + short, _FIELD_WIDTH - short
            screen.number(0, column, width, value, decimals)
        screen.put(0, _UNIT_COLUMN, _UNIT_WIDTH, texts.of(unit))
        return True

    def _look(self):
        """See which drive is shown, and how it can be asked now."""
        control = self._panel.selected
        if control is not self._control:
            self._control = control
            whose, refused = self._panel.remembered.get(__name__, (None, None))
            self._refused = refused if whose is control else []
            self._direction = 0
            self.forget()
        family, layout = control.survey.family, control.drive.layout
        if family is not self._family or layout is not self._layout:
            self._family, self._layout = family, layout
            self._rows = on_demand.call("uss.families.readings", "of", family, layout.pkw_words)

    def _row(self):
        """That of the value shown; None: this drive has no such value."""
        for row in self._rows:
            if row[0] == self._quantity:
                return row
        return None

    def _take(self, now_ms):
        """Take an answer. One that refuses what NEXT has just come to leads on to the next one;
        answers whether that is not the actual frequency."""
        job = self._reading.take()
        if job is None:
            return True
        self._read_at_ms = now_ms
        self._wait_ms = _READ_MS
        row = self._row()
        self._value = None if row is None else _hundredths(job, row[2])
        self._untold = self._value is None
        if job.state == pkw.REFUSED or job.state == pkw.UNANSWERED:
            self._wait_ms = _REFUSED_MS
            if self._direction:
                self._refused.append(self._quantity)
                self._panel.remembered[__name__] = (self._control, self._refused)
                return self.turn(self._direction)
        elif job.state == pkw.DONE:
            self._direction = 0
        return True

    def _is_percent(self):
        """Whether the drive is shown in percent anyway."""
        return self._control.survey.is_percent()

    def _percent(self):
        """The actual frequency in 0.01 % of the reference, or None."""
        control = self._control
        actual, scaling = control.actual_centihertz(), control.survey.scaling
        if actual is None or scaling is None:
            return None
        half = scaling.reference_centihertz // 2
        percent = (abs(actual) * 5_000 + half // 2) // half  # no more than 31 bits
        return -percent if actual < 0 else percent


def _hundredths(job, factor):
    """What a job has read, in hundredths of the unit, or None. It takes no floating-point number,
    which would take memory each time."""
    if factor:
        return job.low * factor if job.width == pkw.WORD else None
    if job.width != pkw.DOUBLE:
        return None
    exponent = (job.high >> 7 & 0xFF) - 127
    if exponent > _EXPONENT_MAX:
        return None
    value = 0
    if exponent >= _EXPONENT_MIN:
        shift = _SHIFT - exponent
        mantissa = (0x80 | job.high & 0x7F) << 16 | job.low
        value = (mantissa * 25 + (1 << shift - 1)) >> shift
    return -value if job.high & 0x8000 else value
