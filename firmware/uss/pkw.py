"""The parameter channel: tasks, replies, numbers, values (specification C-4).

Fixed layout of four PKW words:

    PKE                       IND                      PWE1        PWE2
    AK 15-12 | 0 | PNU 10-0   page 15-10 | index 7-0   high word   low word, or the 16-bit value

A `Job` is one task for one drive and, later, its result. Who carries it to the drive is `drive`.

    job = read(2000)                     # or write_word(700, 5), write_float(1082, 40.5)
    drive.ask(job)                       # ... later:
    if job.state == DONE: hertz = job.float_value()
"""

import struct

from micropython import const

# --- task and reply identifiers AK --------------------------------------------------------------

NO_TASK = const(0)
READ = const(1)
WRITE_WORD = const(2)
WRITE_DOUBLE = const(3)
WRITE_DOUBLE_EEPROM = const(13)
WRITE_WORD_EEPROM = const(14)

NO_REPLY = const(0)
WORD = const(1)
DOUBLE = const(2)
REFUSED_REPLY = const(7)
NO_RIGHTS_REPLY = const(8)

# Replies that fit a task (specification tables 4.1, 4.2): besides these, 7 to any and 8 to writes.
FITTING_REPLIES = {
    READ: (WORD, DOUBLE),
    WRITE_WORD: (WORD,),
    WRITE_DOUBLE: (DOUBLE,),
    WRITE_DOUBLE_EEPROM: (DOUBLE,),
    WRITE_WORD_EEPROM: (WORD,),
}

# Error numbers of reply 7 (specification table 4.9 up to 7, PROFIBUS profile and drives beyond).
ERRORS = {
    0: "no such parameter",
    1: "read-only parameter",
    2: "beyond the limits",
    3: "no such index",
    4: "not an array",
    5: "wrong data type",
    6: "may only be reset",
    7: "description not changeable",
    11: "no change rights",
    12: "key word missing",
    17: "not in this operating state",
    18: "other error",
    20: "value not allowed",
    101: "parameter inactive",
    102: "channel too small",
    104: "value not permitted",
    106: "task not implemented",
    200: "below the limit in operation",
    201: "above the limit in operation",
    204: "access level too low",
}

NO_CHANGE_RIGHTS = const(-1)  # what `Job.error` holds after reply 8, which carries no number


def error_text(number):
    """Words for an error number of reply 7, or for NO_CHANGE_RIGHTS."""
    if number == NO_CHANGE_RIGHTS:
        return ERRORS[11]
    return ERRORS.get(number, "error %d" % number)


# --- numbers ------------------------------------------------------------------------------------

PNU_PER_PAGE = const(2000)
NUMBER_MAX = const(63 * 2000 + 1999)
INDEX_MAX = const(254)

# Where the bits of the page number stand in IND (MM4 and G1xx; CU240S manual, SIDOOR table 6-64).
PAGE_BITS = ((1, 15), (2, 12), (4, 13), (8, 14), (16, 10), (32, 11))  # weight, bit of IND


def pke(task, number):
    """The PKE word: AK of the task and the parameter's number within its page."""
    return task << 12 | number % PNU_PER_PAGE


def ind(number, index):
    """The IND word: page of the parameter's number in the high byte, index in the low byte."""
    page = number // PNU_PER_PAGE
    word = index
    for weight, bit in PAGE_BITS:
        if page & weight:
            word |= 1 << bit
    return word


def name(number, index=0):
    """P0700[0], as the manuals write it."""
    return "P%04d[%d]" % (number, index)


# --- jobs ---------------------------------------------------------------------------------------

# States of a job. While PENDING it belongs to the engine, before and after to the loop.
NEW, PENDING, DONE, REFUSED, TIMED_OUT = range(5)
STATE_TEXTS = ("new", "pending", "done", "refused", "timed out")

WORK_TIMEOUT_US = const(2_000_000)  # a reply may lag some cycles
EEPROM_TIMEOUT_US = const(5_000_000)


class Job:
    """One parameter task and its result.

    task: READ, WRITE_... . number: 0...127999. index: 0...254. high, low: the value as two words.
    ValueError when one of them is out of range.

    After it left PENDING: `state`; `error` when REFUSED (see error_text); when DONE `width` (WORD
    or DOUBLE) and the words `high` and `low`, which for a write are what the drive confirmed. May
    be handed to `Drive.ask` again when it is not PENDING; a write then needs its value anew.
    """

    def __init__(self, task, number, index=0, high=0, low=0):
        self.words = bytearray(8)  # PKE, IND, PWE1, PWE2 as they are sent
        self.aim(task, number, index, high, low)

    def aim(self, task, number, index=0, high=0, low=0):
        """Make this another job, as if new; for whoever asks often and must not allocate."""
        if task not in FITTING_REPLIES:
            raise ValueError("task %r" % (task,))
        if not 0 <= number <= NUMBER_MAX:
            raise ValueError("parameter number %r" % (number,))
        if not 0 <= index <= INDEX_MAX:
            raise ValueError("index %r of %s" % (index, name(number)))
        self.task = task
        self.number = number
        self.index = index
        self.pke = pke(task, number)
        self.ind = ind(number, index)
        self.high = high
        self.low = low
        # `high` and `low` are also where the result will stand; only a write carries a value.
        if task == READ:
            high = low = 0
        struct.pack_into(">HHHH", self.words, 0, self.pke, self.ind, high, low)
        self.state = NEW
        self.width = 0
        self.error = 0
        self.fitting = 0  # one bit for each AK that answers this task
        for reply in FITTING_REPLIES[task]:
            self.fitting |= 1 << reply
        eeprom = task == WRITE_DOUBLE_EEPROM or task == WRITE_WORD_EEPROM
        self.timeout_us = EEPROM_TIMEOUT_US if eeprom else WORK_TIMEOUT_US

    def answer(self, reply_pke, reply_ind, high, low):
        """Take the PKW words of a reply; True when they end this job.

        A reply to an older task, or none, is no error (specification C-4.2.1.1): it is ignored.
        Called by the engine: allocates nothing. Bit 11 of PKE (change report) is no part of PNU.
        """
        reply = reply_pke >> 12
        if (reply_pke ^ self.pke) & 0x07FF or reply_ind != self.ind:
            return False
        if self.fitting >> reply & 1:
            self.width = reply
            self.high = high
            self.low = low
            self.state = DONE
        elif reply == REFUSED_REPLY:
            self.error = low
            self.state = REFUSED
        elif reply == NO_RIGHTS_REPLY and self.task != READ:
            self.error = NO_CHANGE_RIGHTS
            self.state = REFUSED
        else:
            return False
        return True

    def integer_value(self):
        """The result as an unsigned number of 16 or 32 bits."""
        return self.low if self.width == WORD else self.high << 16 | self.low

    def float_value(self):
        """The result as the IEEE-754 single that MM4 uses for most 32-bit parameters."""
        return words_to_float(self.high, self.low)

    def __repr__(self):
        return "<AK%d %s %s>" % (self.task, name(self.number, self.index), STATE_TEXTS[self.state])


def read(number, index=0):
    """A job that reads a parameter, 16 or 32 bits wide."""
    return Job(READ, number, index)


def write_word(number, value, index=0, eeprom=False):
    """A job that writes a 16-bit value, 0...65535, to RAM or, when asked, to RAM and EEPROM."""
    if not 0 <= value <= 0xFFFF:
        raise ValueError("%r for the word %s" % (value, name(number, index)))
    return Job(WRITE_WORD_EEPROM if eeprom else WRITE_WORD, number, index, 0, value)


def write_double(number, value, index=0, eeprom=False):
    """A job that writes a 32-bit value, 0...2**32 - 1."""
    if not 0 <= value <= 0xFFFFFFFF:
        raise ValueError("%r for the double word %s" % (value, name(number, index)))
    task = WRITE_DOUBLE_EEPROM if eeprom else WRITE_DOUBLE
    return Job(task, number, index, value >> 16, value & 0xFFFF)


def write_float(number, value, index=0, eeprom=False):
    """A job that writes a floating-point value, rounded to single precision."""
    high, low = float_to_words(value)
    task = WRITE_DOUBLE_EEPROM if eeprom else WRITE_DOUBLE
    return Job(task, number, index, high, low)


def float_to_words(value):
    """High and low word of an IEEE-754 single: 50.0 is (4248h, 0000h)."""
    return struct.unpack(">HH", struct.pack(">f", value))


def words_to_float(high, low):
    """The IEEE-754 single that two words make."""
    return struct.unpack(">f", struct.pack(">HH", high, low))[0]
