# SPDX-License-Identifier: MIT
"""The parameter channel of a simulated drive: PKW tasks in, replies out.

It carries out tasks 1 ... 9 and 11 ... 15 (specification C-4.2), as far as the family knows them,
on a parameter store and refuses the others with error 106. It does not know where on the line the
words come from. Descriptions and texts are made in texts.py, change reports in
change_reports.py.

    channel.accept([0x1460, 0, 0, 0], 4)    # the PKW words of a request, and P2013: read P1120
    channel.reply(4)                        # [0x2460, 0, 0x4120, 0]: a double word, 10.0

A task is carried out once, when it changes; a reply that carries a value always carries the
present one. No document says in which order a drive checks a task; this checks: task known, change
rights, number, access level for reading (a switch), bits for texts (a switch), index, room,
read-only, type, state, commissioning step, access level, in use, key, number of values, limits,
discrete values.
"""

from boards.sim.drives.change_reports import BIT, Reports
from boards.sim.drives.parameters import (
    CHANGE,
    INDICES,
    LEVEL,
    OUT_OF_LIMITS,
    TYPE,
    is_word,
    value_of,
    words_of,
)
from boards.sim.drives.families.texts import HAS_TEXTS, Texts, element
from boards.sim.drives.slave import VARIABLE

READ, WRITE, COUNT = range(3)

# AK of a task: what it does, words of its value, as an array element, into the EEPROM too.
TASKS = {
    1: (READ, 0, False, False),
    2: (WRITE, 1, False, False),
    3: (WRITE, 2, False, False),
    6: (READ, 0, True, False),
    7: (WRITE, 1, True, False),
    8: (WRITE, 2, True, False),
    9: (COUNT, 0, True, False),
    11: (WRITE, 2, True, True),
    12: (WRITE, 1, True, True),
    13: (WRITE, 2, False, True),
    14: (WRITE, 1, False, True),
}
READ_DESCRIPTION, WRITE_DESCRIPTION, TEXT_TASK = 4, 5, 15

# AK of a reply.
WORD, DOUBLE_WORD, DESCRIPTION, ARRAY_WORD, ARRAY_DOUBLE_WORD = 1, 2, 3, 4, 5
ELEMENTS = 6
REFUSED = 7
NO_RIGHTS = 8
TEXT = 15

# Error numbers of a REFUSED task; two more are in parameters.py.
UNKNOWN_NUMBER = 0
READ_ONLY = 1
WRONG_SUBINDEX = 3
NO_ARRAY = 4
WRONG_TYPE = 5
DESCRIPTION_FIXED = 7
NO_DESCRIPTION = 9
WRONG_KEY = 12
NO_TEXT_ARRAY = 15
WRONG_STATE = 17
NOT_ACTIVE = 101
CHANNEL_TOO_SMALL = 102
NOT_IMPLEMENTED = 106
TEXT_FIXED = 107
WRONG_VALUE_COUNT = 108
BELOW_TIGHTENED, ABOVE_TIGHTENED = 200, 201
ACCESS_LEVEL = 204

DOWNLOAD = 29  # of the commissioning parameter: opens every step

ALL_ELEMENTS = 255  # of an array, and of a description
TEXT_BITS = 0x0300  # of IND
NET_WORDS = 126  # of a telegram, at most

NO_TASK = (0, 0, ())
NO_REPLY = {3: [0, 0, 0], 4: [0, 0, 0, 0], VARIABLE: [0, 0, 0]}

# Bits of IND that make the page of 2000 numbers: bit, its weight.
PAGE_BITS = (
    (0x8000, 1), (0x1000, 2), (0x2000, 4), (0x4000, 8), (0x0400, 16), (0x0800, 32),
)  # fmt: skip


def number_of(pke, ind, raw):
    """The parameter number that PKE and IND name, or None: PNU goes to 1999 on a MICROMASTER.

    raw: without a page it may go on to 2047.
    """
    pnu = pke & 0x07FF
    if pnu > 1999 and (not raw or ind >> 8):
        return None
    return pnu + 2000 * sum([weight for bit, weight in PAGE_BITS if ind & bit])


def page_of(number):
    """The high byte of IND for a parameter number, in its place."""
    return sum([bit for bit, weight in PAGE_BITS if number // 2000 & weight])


class ParameterChannel:
    """family: a module such as mm420. state() is "C", "U" or "T": commissioning, running, ready.
    changed(number) is called after writes. switches: see switches.py. reports: it tells of changes
    that others make.
    """

    def __init__(self, parameters, family, state, changed, switches, reports=False):
        self._switches = switches
        self._parameters = parameters
        self._family = family.CHANNEL
        self._texts = Texts(family.CHANNEL["texts"])
        self._state = state
        self._changed = changed
        self._tells_changes = reports
        self.reset()

    def reset(self):
        """As at power-up: no task, none answered."""
        self._task = self._answered = NO_TASK
        self._waiting = 0
        self._number = None  # of the answered task
        self._refusal = None  # AK, error number and what is told with it, if it failed
        self._reports = Reports() if self._tells_changes else None

    def accept(self, words, layout):
        """Take the PKW words of a request; `layout` is P2013 (3, 4 or VARIABLE)."""
        task = NO_TASK
        pke = words[0]
        if pke >> 12:
            # Bit 11 acknowledges change reports.
            task = (pke & 0xF7FF, words[1] if len(words) > 1 else 0, tuple(words[2:]))
        if self._reports is not None:
            self._reports.hear(pke & BIT)
        if task != self._task:
            self._task = task
            self._waiting = self._switches.stale_replies
        elif self._waiting:
            self._waiting -= 1
        if not self._waiting and (self._answered is not self._task or self._switches.reexecute):
            self._answered = self._task
            self._refusal = self._carry_out(self._task, layout) if task is not NO_TASK else None

    def reply(self, layout, pzd_words=2):
        """The PKW words of the reply, with the present value; so many PZD words go with them."""
        reports = self._reports
        if reports is None:
            if not self._answered[0]:
                return NO_REPLY[layout]
            return self._reply(self._answered[0], self._answered[1], layout, pzd_words)
        report = reports.send()
        if report is None:
            words = self._reply(self._answered[0], self._answered[1], layout, pzd_words)
        else:
            words = self._report(report[0], report[1], layout)
        words[0] |= reports.bit
        return words

    def refuses(self):
        """Whether the reply to the last request is a refusal."""
        return self._refusal is not None

    def report(self, number, index):
        """Report that another has changed this element, or ALL_ELEMENTS."""
        if self._reports is not None:
            self._reports.add(number, index)

    # Words

    def _reply(self, pke, ind, layout, pzd_words):
        if not pke:
            return list(NO_REPLY[layout])
        ak, values = self._answer(pke >> 12, ind, layout)
        room = layout - 2 if layout != VARIABLE else NET_WORDS - 2 - pzd_words
        if len(values) > room:
            ak, values = REFUSED, (CHANNEL_TOO_SMALL,)
        return [ak << 12 | pke & 0x07FF, ind] + placed(values, layout)

    def _answer(self, ak, ind, layout):
        """AK of the reply and its value words."""
        number = self._number
        if self._refusal is not None:
            ak, error, advice = self._refusal
            return ak, (error,) + advice if layout == VARIABLE else (error,)
        if ak in (READ_DESCRIPTION, WRITE_DESCRIPTION):
            return DESCRIPTION, self._description(number, ind & 0xFF)
        if ak == TEXT_TASK:
            return TEXT, self._texts.words(number, ind)
        row = self._parameters.rows[number]
        what, _, array, _ = TASKS[ak]
        if what == COUNT:
            return ELEMENTS, (row[INDICES],)
        words = self._value_words(row, number, self._position(row, array, ind))
        if is_word(row[TYPE]):
            return ARRAY_WORD if array else WORD, words
        return ARRAY_DOUBLE_WORD if array else DOUBLE_WORD, words

    def _value_words(self, row, number, position):
        kind = row[TYPE]
        if position is not None:
            return words_of(kind, self._parameters.value(number, position))
        words = ()
        for i in range(row[INDICES]):
            words += words_of(kind, self._parameters.value(number, i))
        return words

    def _report(self, number, index, layout):
        """PKW words that tell the value of an element that another has changed."""
        row = self._parameters.rows[number]
        array = row[INDICES] > 1
        position = index if index != ALL_ELEMENTS else None
        ind = index if position is None or not array else index + self._family["first index"]
        ak = (11 if array else 9) + (0 if is_word(row[TYPE]) else 1)
        values = (0,)
        if position is not None or layout == VARIABLE:  # a whole array has no room otherwise
            values = self._value_words(row, number, position)
        if layout == 3:
            values = values[:1]
        return [ak << 12 | number % 2000, page_of(number) | ind] + placed(values, layout)

    def _description(self, number, which):
        parameters = self._parameters
        row = parameters.rows[number]
        flags = parameters.flags(number) | (HAS_TEXTS if self._texts.has(number) else 0)
        return element(row, which, flags)

    def _position(self, row, array, ind):
        """The place of the element that IND names; None: all of them."""
        index = ind & 0xFF
        if array and index == ALL_ELEMENTS:
            return None
        if array and row[INDICES] == 1:
            return 0  # a scalar addressed as an array answers to index 0 and 1 (RM420)
        first = self._family["first index"]
        return index - first if array or index else 0

    # Tasks

    def _carry_out(self, task, layout):
        """Execute a task. The refusal, AK, error number and what is told with it, or None."""
        pke, ind, values = task
        ak = pke >> 12
        self._number = number = self._number_of(pke, ind)
        if ak not in self._family["tasks"]:
            return REFUSED, NOT_IMPLEMENTED, ()
        writes = ak in (WRITE_DESCRIPTION,) or ak in TASKS and TASKS[ak][0] == WRITE
        if (writes or ak == TEXT_TASK and Texts.writes(ind)) and not self._has_rights():
            error = self._switches.no_rights_error
            return REFUSED if error else NO_RIGHTS, error, ()
        if number not in self._parameters.rows:
            return REFUSED, UNKNOWN_NUMBER, self._neighbours(number)
        if self._switches.level_for_reading and not self._is_accessible(number):
            return REFUSED, ACCESS_LEVEL, ()
        if ak == TEXT_TASK:
            error = self._text(ind, values, layout)
        elif ind & TEXT_BITS and self._switches.text_bits_error:
            error = self._switches.text_bits_error
        elif ak in (READ_DESCRIPTION, WRITE_DESCRIPTION):
            error = self._describe(ak, ind & 0xFF, layout)
        else:
            error = self._misaddressed(TASKS[ak], ind & 0xFF, layout)
            if error is None and TASKS[ak][1] == 2 and len(values) < 2:
                error = CHANNEL_TOO_SMALL
            if error is None and writes:
                return self._write(TASKS[ak], ind, values, layout)
        return None if error is None else (REFUSED, error, ())

    def _number_of(self, pke, ind):
        if self._family["pages"]:
            return number_of(pke, ind, self._switches.raw_numbers)
        return None if ind >> 8 else pke & 0x07FF

    def _has_rights(self):
        rights = self._family["rights"]
        return rights is None or self._parameters.ram[rights[0]][0] & rights[1]

    def _neighbours(self, number):
        """The next number that exists and the one before, for browsing (RM420, G110D)."""
        if number is None:
            return ()
        numbers = self._parameters.numbers
        if self._switches.level_for_reading:
            numbers = [one for one in numbers if self._is_accessible(one)]
        above = [one for one in numbers if one > number]
        below = [one for one in numbers if one < number]
        found = (above[0] & 0xFFFF if above else 0, below[-1] & 0xFFFF if below else 0)
        return found[: self._family["neighbours"]]

    def _misaddressed(self, task, index, layout):
        row = self._parameters.rows[self._number]
        if task[0] == COUNT:  # of no element: errors 3 and 4 are not among its own; a scalar has 1
            return None
        if task[2]:
            if row[INDICES] == 1:
                return NO_ARRAY if index > 1 or not self._family["scalar as array"] else None
            if index == ALL_ELEMENTS:
                return None if layout == VARIABLE else CHANNEL_TOO_SMALL
        elif index and not self._family["plain index"]:
            return WRONG_SUBINDEX
        return None if 0 <= self._position(row, task[2], index) < row[INDICES] else WRONG_SUBINDEX

    def _describe(self, ak, which, layout):
        elements = self._family["elements"]
        if layout == VARIABLE:
            elements += self._family["variable elements"]
        if which not in elements:
            # The whole description does not fit fixed length (SPEC C-4.2.2, OI440). A single
            # element that needs variable length does not exist in fixed length.
            whole = which == ALL_ELEMENTS and which in self._family["variable elements"]
            return CHANNEL_TOO_SMALL if whole else NO_DESCRIPTION
        return DESCRIPTION_FIXED if ak == WRITE_DESCRIPTION else None

    def _text(self, ind, values, layout):
        if layout != VARIABLE or ind & 0xFF == ALL_ELEMENTS:
            return CHANNEL_TOO_SMALL
        if not self._texts.has(self._number):
            return NO_TEXT_ARRAY
        if not self._texts.exists(self._number, ind):
            return WRONG_SUBINDEX
        if Texts.writes(ind) and not self._texts.write(self._number, ind, values):
            return WRONG_VALUE_COUNT
        return None

    def _write(self, task, ind, values, layout):
        """Put values into elements that exist, all or none; the refusal, or None."""
        parameters = self._parameters
        number = self._number
        row = parameters.rows[number]
        width = task[1]
        error = self._unwritable(row, width) or self._closed(row)
        if error is not None:
            return REFUSED, error, ()
        position = self._position(row, task[2], ind)
        places = range(row[INDICES]) if position is None else (position,)
        raw = values
        if position is not None:
            raw = sent_value(values, width, layout, self._switches.second_word)
        if len(raw) != width * len(places):
            return REFUSED, WRONG_VALUE_COUNT, ()
        starts = range(0, len(raw), width)
        wanted = [value_of(row[TYPE], raw[start : start + width]) for start in starts]
        for place, value in zip(places, wanted):
            error = parameters.objection(number, place, value) or self._beyond(place, value)
            if error is not None:
                return REFUSED, error, self._legal(row, error, value)
        for place, value in zip(places, wanted):
            parameters.store(number, place, value, task[3])
        self._changed(number)
        return None

    def _unwritable(self, row, width):
        """The error number that forbids a write of so many words to this number now, or None."""
        if not row[CHANGE]:
            return READ_ONLY
        if is_word(row[TYPE]) != (width == 1):
            return WRONG_TYPE
        if self._state() not in row[CHANGE]:
            return WRONG_STATE
        steps = self._family["steps"]
        if row[CHANGE] == "C" and steps is not None:
            step = self._parameters.ram[steps[0]][0]
            if step not in (steps[1].get(self._number, 1), DOWNLOAD):
                return WRONG_STATE
        return None if self._is_accessible(self._number) else ACCESS_LEVEL

    def _closed(self, row):
        """The error number that another parameter forbids a write with, or None."""
        ram = self._parameters.ram
        active = self._family["active"].get(self._number)
        if active and self._switches.inactive_refused and ram[active[0]][0] not in active[1]:
            return NOT_ACTIVE
        lists = self._family["user list"]
        if lists is not None and self._number == lists[0] and ram[lists[1]] != ram[lists[2]]:
            return WRONG_KEY
        return None

    def _is_accessible(self, number):
        """Whether the access level opens a number; at level 0 the user list does."""
        level = self._family["level"]
        if number == level:
            return True
        ram = self._parameters.ram
        lists = self._family["user list"]
        if lists is not None and not ram[level][0]:
            return number in ram[lists[0]]
        return self._parameters.rows[number][LEVEL] <= ram[level][0]

    def _beyond(self, place, value):
        """The error number of a limit that is narrower while the drive runs, or None."""
        limits = self._family["tightened"]
        if limits is None or not self._switches.tightened_limits or self._state() != "U":
            return None
        lower, upper = limits
        ram = self._parameters.ram
        if self._number == lower and value > ram[upper][place]:
            return ABOVE_TIGHTENED
        if self._number == upper and value < ram[lower][place]:
            return BELOW_TIGHTENED
        return None

    def _legal(self, row, error, value):
        """The next and the previous legal value (RM420); both are the limit.

        No document says how a drive tells a double word.
        """
        if error != OUT_OF_LIMITS or not self._family["neighbours"] or not is_word(row[TYPE]):
            return ()
        return 2 * words_of(row[TYPE], self._parameters.nearest(self._number, value))


def sent_value(values, width, layout, second_word):
    """The words of one value among those after PKE and IND.

    second_word: in variable length a master may always send four words; the last one counts.
    """
    if width == 2:
        return values[:2]
    if layout == 4 or layout == VARIABLE and second_word and len(values) > 1 and values[1]:
        return values[1:2]
    return values[:1]


def placed(values, layout):
    """The value words in their places in the layout."""
    if layout == 4 and len(values) == 1:
        return [0, values[0]]
    return list(values) or [0]
