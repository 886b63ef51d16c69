"""The parameter channel of a simulated drive: PKW tasks in, replies out.

It carries out tasks 1, 2, 3, 6 ... 9 and 11 ... 14 (specification C-4.2) on a parameter store and
refuses the others with error 106. It does not know where on the line the words come from.

    channel.accept([0x1460, 0, 0, 0], 4)    # the PKW words of a request, and P2013: read P1120
    channel.reply(4)                        # [0x2460, 0, 0x4120, 0]: a double word, 10.0

A task is carried out once, when it changes; a reply that carries a value always carries the
present one. For the first `stale_replies` telegrams of a new task the reply is still that of the
task before, which the specification allows (C-4.2.1.1) and real drives do.
"""

import struct

from boards.sim.drive_parameters import CHANGE, INDICES, LEVEL, TYPE
from boards.sim.slave import VARIABLE

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

# AK of a reply.
WORD, DOUBLE_WORD, ARRAY_WORD, ARRAY_DOUBLE_WORD = 1, 2, 4, 5
ELEMENTS = 6
REFUSED = 7
NO_RIGHTS = 8

# Error numbers of a REFUSED task; two more are in drive_parameters.py.
UNKNOWN_NUMBER = 0
READ_ONLY = 1
WRONG_SUBINDEX = 3
NO_ARRAY = 4
WRONG_TYPE = 5
WRONG_STATE = 17
CHANNEL_TOO_SMALL = 102
NOT_IMPLEMENTED = 106
ACCESS_LEVEL = 204

UNKNOWN = (REFUSED, UNKNOWN_NUMBER)

ALL_ELEMENTS = 255
VIA_COM_LINK = 0x0008  # P0927

NO_TASK = (0, 0, 0, 0, 0)

# Bits of IND that make the page of 2000 numbers: bit, its weight.
PAGE_BITS = (
    (0x8000, 1), (0x1000, 2), (0x2000, 4), (0x4000, 8), (0x0400, 16), (0x0800, 32),
)  # fmt: skip


def number_of(pke, ind):
    """The parameter number that PKE and IND name, or None: PNU goes to 1999 on a MICROMASTER."""
    pnu = pke & 0x07FF
    if pnu > 1999:
        return None
    return pnu + 2000 * sum([weight for bit, weight in PAGE_BITS if ind & bit])


class ParameterChannel:
    """state() is "C", "U" or "T": commissioning, running, ready. changed(number) hears of writes.

    stale_replies   telegrams that a new task waits for its own reply
    """

    def __init__(self, parameters, state, changed):
        self.stale_replies = 0
        self._parameters = parameters
        self._state = state
        self._changed = changed
        self.reset()

    def reset(self):
        """As at power-up: no task, none answered."""
        self._task = self._answered = NO_TASK
        self._waiting = 0
        self._number = None  # of the answered task
        self._refusal = None  # AK and error number, if it failed

    def accept(self, words, layout):
        """Take the PKW words of a request; `layout` is P2013 (3, 4 or VARIABLE)."""
        task = self._decoded(words, layout)
        if task != self._task:
            self._task = task
            self._waiting = self.stale_replies
        elif self._waiting:
            self._waiting -= 1
        if not self._waiting and self._answered is not self._task:
            self._answered = self._task
            self._number = number_of(self._task[0], self._task[1])
            self._refusal = self._carry_out(self._task)

    def reply(self, layout):
        """The PKW words of the reply, with the present value."""
        pke, ind = self._answered[:2]
        ak, high, low, wide = self._answer(pke, ind, layout)
        if wide and layout == 3:
            ak, low, wide = REFUSED, CHANNEL_TOO_SMALL, False
        head = [ak << 12 | pke & 0x07FF, ind] if ak else [0, 0]
        if layout == 4 or wide:
            return head + [high, low]
        return head + [low]

    # Words

    def _decoded(self, words, layout):
        pke, ind, pwe1, pwe2 = (list(words) + [0, 0, 0, 0])[:4]
        if not pke >> 12:
            return NO_TASK
        word = pwe2 if layout == 4 else pwe1
        if layout == VARIABLE and len(words) > 3 and pwe2 and not pwe1:
            word = pwe2  # a master that always sends four words
        # Bit 11 acknowledges change reports, of which a MICROMASTER makes none.
        return (pke & 0xF7FF, ind, word, pwe1 << 16 | pwe2, len(words))

    def _answer(self, pke, ind, layout):
        """AK, high word, low word, and whether it takes both."""
        if not pke >> 12:
            return 0, 0, 0, False
        number = self._number
        if self._refusal is not None:
            ak, error = self._refusal
            if layout == VARIABLE and (ak, error) == UNKNOWN and number is not None:
                return ak, error, self._parameters.next_number(number), True  # to browse by
            return ak, 0, error, False
        row = self._parameters.rows[number]
        task = TASKS[pke >> 12]
        if task[0] == COUNT:
            return ELEMENTS, 0, row[INDICES], False
        value = self._parameters.value(number, self._index(row, task, ind))
        array = task[2]
        if row[TYPE] == "U16":
            return ARRAY_WORD if array else WORD, 0, value & 0xFFFF, False
        high, low = struct.unpack(">HH", struct.pack(">f" if row[TYPE] == "F" else ">I", value))
        return ARRAY_DOUBLE_WORD if array else DOUBLE_WORD, high, low, True

    def _index(self, row, task, ind):
        # A scalar that is addressed as an array answers to index 0 and to index 1 (RM420).
        return 0 if task[2] and row[INDICES] == 1 else ind & 0xFF

    # Tasks

    def _carry_out(self, task):
        """Execute a new task. The refusal, AK and error number, or None."""
        pke, ind, word, double_word, count = task
        ak = pke >> 12
        if not ak:
            return None
        if ak not in TASKS:
            return REFUSED, NOT_IMPLEMENTED
        what, width = TASKS[ak][:2]
        if what == WRITE and not self._parameters.ram[927][0] & VIA_COM_LINK:
            return NO_RIGHTS, 0
        number = self._number
        error = self._misaddressed(number, TASKS[ak], ind & 0xFF)
        if error is None and width == 2 and count < 4:
            error = CHANNEL_TOO_SMALL
        if error is None and what == WRITE:
            error = self._write(number, TASKS[ak], ind, word if width == 1 else double_word)
        return None if error is None else (REFUSED, error)

    def _misaddressed(self, number, task, index):
        row = self._parameters.rows.get(number)
        if row is None:
            return UNKNOWN_NUMBER
        if task[0] == COUNT:
            return None
        if task[2]:
            if index == ALL_ELEMENTS:
                return CHANNEL_TOO_SMALL
            if row[INDICES] == 1:
                return NO_ARRAY if index > 1 else None
        return WRONG_SUBINDEX if index >= row[INDICES] else None

    def _write(self, number, task, ind, raw):
        """Put a value into an existing element; the error number, or None."""
        parameters = self._parameters
        row = parameters.rows[number]
        if not row[CHANGE]:
            return READ_ONLY
        if (row[TYPE] == "U16") != (task[1] == 1):
            return WRONG_TYPE
        if self._state() not in row[CHANGE]:
            return WRONG_STATE
        if row[LEVEL] > parameters.ram[3][0] and number != 3:
            return ACCESS_LEVEL
        value = struct.unpack(">f", struct.pack(">I", raw))[0] if row[TYPE] == "F" else raw
        index = self._index(row, task, ind)
        error = parameters.objection(number, index, value)
        if error is None:
            parameters.store(number, index, value, task[3])
            self._changed(number)
        return error
