# SPDX-License-Identifier: MIT
"""A value that is being changed, in one of several ways; EDIT goes from one to the next.

    P1120[0]  10.00s    Keypad (BOP)        Running             row 1
    NEW+002.50s         NEW            1    P0055.02       1    row 2
    digit by digit      by the texts        bit by bit

NEXT and PREVIOUS go to another digit or bit; UP and DOWN change it, or the text.
"""

import catalogue
from panel import texts
from panel.lookup import Search, text, value, words

DIGITS, CHOICES, BITS, HEX = range(4)

_MISSING = b"..."


class Editing:
    """shown: the `Inspection`, whose value was read. way: how it is changed; None: not at all."""

    def __init__(self, shown):
        self._shown = shown
        self.search = Search()
        form = shown.form
        ways = [DIGITS]
        if form.list:
            ways.insert(0, CHOICES if form.list[:1] == b"v" else BITS)
        if form.kind != value.HEX:
            ways.append(HEX)  # what none of the others can say
        if shown.is_reading():
            ways = [way for way in ways if way == BITS]
        self._ways = ways
        self.next_way()

    def next_way(self):
        """Another way to change it; `way` is None where there is no further one."""
        shown = self._shown
        self.way = way = self._ways.pop(0) if self._ways else None
        self.search.begin(None)  # what the way before has looked for
        self._bits = shown.high << 16 | shown.low
        self._is_changed = False
        self._form = form = shown.form
        if way == DIGITS and not form.can_be_typed(shown.high, shown.low):
            self.next_way()
            return
        if way == HEX:
            self._form = form = value.Form(None, form.width, is_hex=True)
        if way == HEX or way == DIGITS:
            self._typed, self._place = form.typed(shown.high, shown.low)
        elif way == CHOICES:
            self._choices = []  # (value, text), as far as they are known
            self._number = form.number(shown.high, shown.low)
            self._look_for(form.list[1:])
        elif way == BITS:
            self._turn_to(0)

    def bits(self):
        """The value as 16 or 32 bits. ValueError: beyond its type."""
        if self.way == BITS:
            return self._bits
        if self.way == CHOICES:
            return self._form.of_number(self._number)
        return self._form.bits(self._typed)

    def take_keys(self, acts):
        """Answers whether something was refused, because it is only to be read."""
        place, direction = acts.direction("NEXT", "PREVIOUS"), acts.direction("UP", "DOWN")
        if self.way == CHOICES:
            self._choose(direction)
        elif self.way == BITS:
            if place:
                self._turn_to((self._bit + place) % (16 * self._form.width))
            if direction and self._shown.is_reading():
                return True
            if direction:
                self._is_changed = True
                one = 1 << self._bit
                self._bits = self._bits | one if direction > 0 else self._bits & ~one
        else:
            if place:
                self._place = value.move(self._typed, self._place, place)
            if direction:
                base = 16 if self._form.kind == value.HEX else 10
                value.turn(self._typed, self._place, direction, base)
        return False

    def step(self):
        """Look on for the texts."""
        if self.search.rows is None:
            return
        row = self.search.step()
        if row and self.way == CHOICES:
            self._choices.append((catalogue.number(row, 1), text(row)))
        elif row and catalogue.number(row, 1) == self._bit:
            self._name = text(row)
        elif self.way == BITS and self.search.rows is None and self._name is _MISSING:
            self._name = texts.NOTHING

    def name(self):
        """Of the text or the bit that is shown, for row 1; None: it has none."""
        if self.way == BITS:
            return self._name
        if self.way != CHOICES:
            return None
        for number, name in self._choices:
            if number == self._number:
                return name
        return _MISSING if self.search.rows is not None else texts.NOTHING

    def row(self, is_away):
        """Row 2. is_away: the place that UP and DOWN change is not shown now."""
        shown = self._shown
        if self.way == CHOICES:
            return b"%s%13d" % (texts.of(words.NEW_VALUE), self._number)
        if self.way == BITS:
            if not self._is_changed:
                self._bits = shown.high << 16 | shown.low
            label = shown.label() + b".%02d" % self._bit
            mark = b"-" if is_away and self._is_changed else b" "
            bit = self._bits >> self._bit & 1
            return label + mark * (15 - len(label)) + b"%d" % bit
        typed = bytes(self._typed)
        if is_away:
            typed = typed[: self._place] + b"_" + typed[self._place + 1 :]
        row = texts.of(words.NEW_VALUE) + (b" " if len(typed) < value.TYPED_MAX else b"") + typed
        unit = self._form.unit
        return row + unit if len(row) + len(unit) <= texts.ROW_WIDTH else row

    def _choose(self, direction):
        if not direction or self.search.rows is not None or not self._choices:
            return
        numbers = [number for number, _ in self._choices]
        if self._number in numbers:
            place = (numbers.index(self._number) + direction) % len(numbers)
        else:
            place = 0 if direction > 0 else -1
        self._number = numbers[place]

    def _turn_to(self, bit):
        self._bit = bit
        self._name = _MISSING
        self._look_for(b"%s.%d" % (self._form.list[1:], bit))

    def _look_for(self, numbers):
        self.search.begin(catalogue.rows(self._shown.table, numbers, "V", paced=True))
