# SPDX-License-Identifier: MIT
"""The parameter channel: tasks, replies, numbers, values (specification C-4).

A request and its reply begin with PKE, IND and the value, whose place depends on the length:

    PKE                       IND                      PWE1        PWE2
    AK 15-12 | 0 | PNU 10-0   page 15-10 | index 7-0   high word   low word    of a double word
                                                       0           the word    4 words, fixed
                                                       the word    -           3 words, or variable

A `Job` is one task for one drive and, later, its result. `channel` carries it to the drive; jobs
of more than one value are in `tasks`.

    job = read(2000)                     # or write_word(700, 5), write_float(1082, 40.5)
    drive.ask(job)                       # ... later:
    if job.state == DONE: hertz = job.float_value()
"""

import struct

from micropython import const

from uss.fast import reply_about

# --- task and reply identifiers AK --------------------------------------------------------------

NO_TASK = const(0)
READ = const(1)
WRITE_WORD = const(2)
WRITE_DOUBLE = const(3)
READ_DESCRIPTION = const(4)
WRITE_DESCRIPTION = const(5)
READ_ELEMENT = const(6)
WRITE_ELEMENT_WORD = const(7)
WRITE_ELEMENT_DOUBLE = const(8)
COUNT_ELEMENTS = const(9)
WRITE_ELEMENT_DOUBLE_EEPROM = const(11)
WRITE_ELEMENT_WORD_EEPROM = const(12)
WRITE_DOUBLE_EEPROM = const(13)
WRITE_WORD_EEPROM = const(14)
TEXT = const(15)

NO_REPLY = const(0)
WORD = const(1)
DOUBLE = const(2)
DESCRIPTION_REPLY = const(3)
ELEMENT_WORD = const(4)
ELEMENT_DOUBLE = const(5)
COUNT_REPLY = const(6)
REFUSED_REPLY = const(7)
NO_RIGHTS_REPLY = const(8)
TEXT_REPLY = const(15)

_NO_RIGHTS = const(1 << NO_RIGHTS_REPLY)  # in FITTING of all tasks that write
_REFUSED = const(1 << REFUSED_REPLY)
_WORD = const(1 << WORD)
_DOUBLE = const(1 << DOUBLE)
_DESCRIPTION = const(1 << DESCRIPTION_REPLY)
_ELEMENT_WORD = const(1 << ELEMENT_WORD)
_ELEMENT_DOUBLE = const(1 << ELEMENT_DOUBLE)

# By task, one bit for each AK that answers it (specification tables 4.1...4.3 and 4.10...4.11);
# 0: there is no such task.
FITTING = (
    0,  # NO_TASK
    _WORD | _DOUBLE | _REFUSED,  # READ
    _WORD | _REFUSED | _NO_RIGHTS,  # WRITE_WORD
    _DOUBLE | _REFUSED | _NO_RIGHTS,  # WRITE_DOUBLE
    _DESCRIPTION | _REFUSED,  # READ_DESCRIPTION
    _DESCRIPTION | _REFUSED | _NO_RIGHTS,  # WRITE_DESCRIPTION
    _ELEMENT_WORD | _ELEMENT_DOUBLE | _REFUSED,  # READ_ELEMENT
    _ELEMENT_WORD | _REFUSED | _NO_RIGHTS,  # WRITE_ELEMENT_WORD
    _ELEMENT_DOUBLE | _REFUSED | _NO_RIGHTS,  # WRITE_ELEMENT_DOUBLE
    1 << COUNT_REPLY | _REFUSED,  # COUNT_ELEMENTS
    0,
    _ELEMENT_DOUBLE | _REFUSED | _NO_RIGHTS,  # WRITE_ELEMENT_DOUBLE_EEPROM
    _ELEMENT_WORD | _REFUSED | _NO_RIGHTS,  # WRITE_ELEMENT_WORD_EEPROM
    _DOUBLE | _REFUSED | _NO_RIGHTS,  # WRITE_DOUBLE_EEPROM
    _WORD | _REFUSED | _NO_RIGHTS,  # WRITE_WORD_EEPROM
    1 << TEXT_REPLY | _REFUSED | _NO_RIGHTS,  # TEXT
)

# Sets of tasks, one bit for each.
_DOUBLE_TASKS = const(
    1 << WRITE_DOUBLE
    | 1 << WRITE_ELEMENT_DOUBLE
    | 1 << WRITE_ELEMENT_DOUBLE_EEPROM
    | 1 << WRITE_DOUBLE_EEPROM
)
# Their answer may be longer than a double word.
_LONG_TASKS = const(1 << READ_DESCRIPTION | 1 << WRITE_DESCRIPTION | 1 << TEXT)
FIRST_PERMANENT = const(11)  # this task and higher ones may write to the EEPROM

_WIDTHS = (0, 1, 2, 0, 1, 2, 1)  # by reply: words of its value, WORD or DOUBLE

# --- errors -------------------------------------------------------------------------------------

# Error numbers of reply 7 that the code uses; `bus.pkw_errors` has all of them in words.
NO_CHANGE_RIGHTS = const(-1)  # what `Job.error` holds after reply 8, which carries no number
NO_PARAMETER = const(0)
BEYOND_LIMITS = const(2)
NO_INDEX = const(3)
TOO_LONG = const(21)
TOO_SMALL = const(102)

# --- numbers ------------------------------------------------------------------------------------

PNU_PER_PAGE = const(2000)
NUMBER_MAX = const(63 * 2000 + 1999)
INDEX_MAX = const(254)
ALL = const(255)  # as an index: all elements, or the whole description


def pke(task, number):
    """The PKE word: AK of the task and the parameter's number within its page."""
    return task << 12 | number % PNU_PER_PAGE


def ind(number, index):
    """The IND word: page of the parameter's number in the high byte, index in the low byte.

    The six bits of the page stand in bits 15, 12, 13, 14, 10 and 11, the lowest first (MM4 and
    G1xx: CU240S manual; SIDOOR table 6-64).
    """
    page = number // PNU_PER_PAGE
    if page == 0:
        return index
    return (page & 0x01) << 15 | (page & 0x0E) << 11 | (page & 0x30) << 6 | index


def name(number, index=0):
    """P0700[0], as the manuals write it."""
    return "P%04d[%d]" % (number, index)


# --- jobs ---------------------------------------------------------------------------------------

# States of a job. While PENDING it belongs to the engine, before and after that to the loop.
# UNANSWERED: the drive answers telegrams without the task, but not those with it. A write that
# ended as TIMED_OUT or UNANSWERED may or may not have been carried out.
NEW, PENDING, DONE, REFUSED, TIMED_OUT, UNANSWERED = range(6)
STATE_TEXTS = ("new", "pending", "done", "refused", "timed out", "unanswered")

# The form of a parameter channel: its characters with fixed length, 6 or 8. With variable length
# this bit, and in the low byte the most characters that a task may have.
THREE_WORDS = const(6)
FOUR_WORDS = const(8)
VARIABLE_LENGTH = const(0x100)

_HEAD = const(4)  # characters of PKE and IND


class Job:
    """One parameter task and its result.

    task: READ, WRITE_... . number: 0...127999. index: 0...254, counted as the drive does. high,
    low: the value to write, as two words. ValueError if one of them is out of range, or the task
    is one for a `tasks.long_jobs.LongJob`.

    After it left PENDING, look at `state`. When DONE: `width` (WORD or DOUBLE) and the words
    `high` and `low`; for a write they are what the drive confirmed. When REFUSED: `error` (see
    `bus.pkw_errors`) and what a drive with variable length offers instead, else None: `next` and
    `previous`, after error 0 a parameter that exists, after error 2 a legal value of 16 bits. A
    job that is not PENDING may be asked again, with the same value.
    """

    data = None  # room for an answer that is longer than a double word: see `tasks.long_jobs`

    def __init__(self, task, number, index=0, high=0, low=0):
        self.words = bytearray(8)  # PKE, IND, PWE1, PWE2 as four fixed words have them
        self.since = 0  # for the engine: when it was begun,
        self.tries = 0  # how often it was sent, as far as that matters,
        self.silences = 0  # how often in a row the drive was silent on it,
        self.lags = 0  # and how often before that it gave an old answer
        self.tag = 0  # for the caller: which of its questions this is
        self.aim(task, number, index, high, low)

    def aim(self, task, number, index=0, high=0, low=0):
        """Make this another job, as if new; for callers that ask often and must not allocate."""
        fitting = FITTING[task] if 0 <= task <= TEXT else 0
        if not fitting or _LONG_TASKS >> task & 1 and self.data is None:
            raise ValueError("task %r" % (task,))
        if not 0 <= number <= NUMBER_MAX:
            raise ValueError("parameter number %r" % (number,))
        if not 0 <= index <= INDEX_MAX and (index != ALL or self.data is None):
            raise ValueError("index %r of %s" % (index, name(number)))
        self.task = task
        self.number = number
        self.index = index
        self.high = high
        self.low = low
        # `high` and `low` are also where the result will stand; only a write carries a value.
        if not fitting & _NO_RIGHTS:
            high = low = 0
        pnu = number
        page = index
        if number >= PNU_PER_PAGE:
            pnu = number % PNU_PER_PAGE
            page = ind(number, index)
        struct.pack_into(">HHHH", self.words, 0, task << 12 | pnu, page, high, low)
        self.key = pnu << 16 | page  # the parameter that a reply must be about
        self.state = NEW
        self.width = 0
        self.error = 0
        self.next = None
        self.previous = None

    def size(self):
        """Characters of the task with variable length; fixed length needs at least so many."""
        return FOUR_WORDS if _DOUBLE_TASKS >> self.task & 1 else THREE_WORDS

    def writes(self):
        """Whether the task writes."""
        return FITTING[self.task] & _NO_RIGHTS != 0

    def fits(self, form):
        """Whether a channel of this form can carry it."""
        return self.size() <= form & 0xFF

    def refuse(self, error):
        """End it with an error number."""
        self.error = error
        self.state = REFUSED

    def integer_value(self):
        """The result as an unsigned number of 16 or 32 bits."""
        return self.low if self.width == WORD else self.high << 16 | self.low

    def signed_value(self):
        """The result as a number with a sign, of 16 or 32 bits."""
        value = self.integer_value()
        half = 1 << 16 * self.width - 1
        return value - 2 * half if value >= half else value

    def float_value(self):
        """The result as the IEEE-754 single that MM4 uses for most 32-bit parameters."""
        return words_to_float(self.high, self.low)

    # --- for the engine: allocates nothing ------------------------------------------------------

    def answer(self, net, at, count, form):
        """Take the PKW words of a reply, `count` characters in `net` from index `at` on.

        True if they end this job. A reply to an older task, or AK 0, is no error (specification
        C-4.2.1.1): it is ignored, and so is one whose length does not fit its AK. Bit 11 of PKE
        (change report) is not part of PNU.
        """
        reply = reply_about(net, at, self.words)
        if not FITTING[self.task] >> reply & 1:
            return False
        if form == FOUR_WORDS and reply < REFUSED_REPLY:
            self.high = net[at + 4] << 8 | net[at + 5]
            self.low = net[at + 6] << 8 | net[at + 7]
            self.width = _WIDTHS[reply]
            self.state = DONE
        elif reply == REFUSED_REPLY:
            self._keep_error(net, at + _HEAD, count - _HEAD, form)
        elif reply == NO_RIGHTS_REPLY:
            self.refuse(NO_CHANGE_RIGHTS)
        else:
            return self._keep_value(reply, net, at + _HEAD, count - _HEAD, form)
        return True

    def _keep_value(self, reply, net, at, count, form):
        """Keep the value from index `at` on; return whether its length fits the reply."""
        width = _WIDTHS[reply]
        if count != 2 * width:
            return False
        self.high = net[at] << 8 | net[at + 1] if width == DOUBLE else 0
        self.low = net[at + count - 2] << 8 | net[at + count - 1]
        self.width = width
        self.state = DONE
        return True

    def _keep_error(self, net, at, count, form):
        """Keep the error number and what a drive with variable length says after it."""
        if form == FOUR_WORDS:
            self.refuse(net[at + 2] << 8 | net[at + 3])
            return
        error = net[at] << 8 | net[at + 1]
        self.next = None
        self.previous = None
        if error == NO_PARAMETER or error == BEYOND_LIMITS:
            if count >= 4:
                following = net[at + 2] << 8 | net[at + 3]
                # 0 is no parameter number: it says that there is none.
                self.next = following if following or error == BEYOND_LIMITS else None
            if count >= 6:
                self.previous = net[at + 4] << 8 | net[at + 5]
        self.refuse(error)

    def __repr__(self):
        return "<AK%d %s %s>" % (self.task, name(self.number, self.index), STATE_TEXTS[self.state])


def read(number, index=0):
    """A job that reads a parameter, 16 or 32 bits wide."""
    return Job(READ, number, index)


def write_word(number, value, index=0, eeprom=False):
    """A job that writes a 16-bit value, -32768...65535, to RAM or, when asked, to EEPROM too."""
    low = word_of(value)
    return Job(WRITE_WORD_EEPROM if eeprom else WRITE_WORD, number, index, 0, low)


def write_double(number, value, index=0, eeprom=False):
    """A job that writes a 32-bit value, -2**31...2**32 - 1."""
    high, low = words_of(value)
    return Job(WRITE_DOUBLE_EEPROM if eeprom else WRITE_DOUBLE, number, index, high, low)


def write_float(number, value, index=0, eeprom=False):
    """A job that writes a floating-point value, rounded to single precision."""
    high, low = float_to_words(value)
    return Job(WRITE_DOUBLE_EEPROM if eeprom else WRITE_DOUBLE, number, index, high, low)


# --- values -------------------------------------------------------------------------------------


def word_of(value):
    """A number of 16 bits, with or without a sign, as a word. ValueError beyond."""
    if not -0x8000 <= value <= 0xFFFF:
        raise ValueError("%r is no number of 16 bits" % (value,))
    return value & 0xFFFF


def words_of(value):
    """A number of 32 bits, with or without a sign, as high and low word. ValueError beyond."""
    if not -0x80000000 <= value <= 0xFFFFFFFF:
        raise ValueError("%r is no number of 32 bits" % (value,))
    return value >> 16 & 0xFFFF, value & 0xFFFF


def float_to_words(value):
    """High and low word of an IEEE-754 single: 50.0 is (4248h, 0000h)."""
    return struct.unpack(">HH", struct.pack(">f", value))


def words_to_float(high, low):
    """The IEEE-754 single that two words make."""
    return struct.unpack(">f", struct.pack(">HH", high, low))[0]
