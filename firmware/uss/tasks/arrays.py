# SPDX-License-Identifier: MIT
"""Parameters that are arrays: one element, all of them, how many there are (tasks 6...9, 11, 12).

The panel does not need this: a MICROMASTER 4 gives one element to `pkw.read(number, index)` too.
By the specification (C-4.2.2) only these tasks have an index, and a G120 prefers them: `bus` and
`s7` choose by what `families` says of a drive, with `with_array_task`. All elements at once need
variable length (P2013 = 127). The index counts as the drive does, from 0 or from 1.

    job = read_all(304)                         # or write_element_word(304, 2, 230)
    drive.ask(job)                              # ... later:
    if job.state == pkw.DONE: print(job.integer_values(), job.float_values())
"""

from micropython import const

from uss import pkw
from uss.tasks.long_jobs import LongJob

WORDS_MAX = const(124)  # of an answer, after PKE and IND

# Task for a single value -> task for an element of an array.
_ARRAY_TASKS = {
    pkw.READ: pkw.READ_ELEMENT,
    pkw.WRITE_WORD: pkw.WRITE_ELEMENT_WORD,
    pkw.WRITE_DOUBLE: pkw.WRITE_ELEMENT_DOUBLE,
    pkw.WRITE_DOUBLE_EEPROM: pkw.WRITE_ELEMENT_DOUBLE_EEPROM,
    pkw.WRITE_WORD_EEPROM: pkw.WRITE_ELEMENT_WORD_EEPROM,
}


def with_array_task(job, family):
    """Change a job of `pkw` to an array task if the family takes an index by those; return it."""
    if job.index and family.has_array_tasks and job.task in _ARRAY_TASKS:
        _aim_at_element(job)
    return job


def _aim_at_element(job):
    job.aim(_ARRAY_TASKS[job.task], job.number, job.index, job.high, job.low)
    return job


def read_element(number, index):
    """A job that reads one element of an array, 16 or 32 bits wide."""
    return pkw.Job(pkw.READ_ELEMENT, number, index)


def write_element_word(number, index, value, eeprom=False):
    """A job that writes one element, -32768...65535, to RAM or, when asked, to EEPROM too."""
    return _aim_at_element(pkw.write_word(number, value, index, eeprom))


def write_element_double(number, index, value, eeprom=False):
    """A job that writes one element of 32 bits, -2**31...2**32 - 1."""
    return _aim_at_element(pkw.write_double(number, value, index, eeprom))


def write_element_float(number, index, value, eeprom=False):
    """A job that writes one floating-point element, rounded to single precision."""
    return _aim_at_element(pkw.write_float(number, value, index, eeprom))


def count_elements(number):
    """A job whose `integer_value` is the number of elements that the parameter has."""
    return pkw.Job(pkw.COUNT_ELEMENTS, number)


def read_all(number, words=WORDS_MAX):
    """A job that reads all elements. words: room for the answer, one or two for each element."""
    return ArrayJob(pkw.READ_ELEMENT, number, (), words)


def write_all_words(number, values, eeprom=False):
    """A job that writes all elements of a 16-bit array, each -32768...65535."""
    task = pkw.WRITE_ELEMENT_WORD_EEPROM if eeprom else pkw.WRITE_ELEMENT_WORD
    return ArrayJob(task, number, [pkw.word_of(value) for value in values])


def write_all_doubles(number, values, eeprom=False):
    """A job that writes all elements of a 32-bit array, each -2**31...2**32 - 1."""
    return _write_pairs(number, [pkw.words_of(value) for value in values], eeprom)


def write_all_floats(number, values, eeprom=False):
    """A job that writes all elements of a floating-point array."""
    return _write_pairs(number, [pkw.float_to_words(value) for value in values], eeprom)


def _write_pairs(number, pairs, eeprom):
    task = pkw.WRITE_ELEMENT_DOUBLE_EEPROM if eeprom else pkw.WRITE_ELEMENT_DOUBLE
    return ArrayJob(task, number, [word for pair in pairs for word in pair])


class ArrayJob(LongJob):
    """All elements of an array at once, read or written. Needs variable length.

    words: the words of the values to write, ValueError if there are none; or None to read.
    """

    def __init__(self, task, number, words, room=0):
        if not words and task != pkw.READ_ELEMENT:
            raise ValueError("no values for %s" % pkw.name(number, pkw.ALL))
        super().__init__(task, number, pkw.ALL, words, room or len(words))

    def fits(self, form):
        """Whether a channel of this form can carry it."""
        return bool(form & pkw.VARIABLE_LENGTH) and super().fits(form)

    def _is_whole(self, reply, words):
        return words > 0 and not (reply == pkw.ELEMENT_DOUBLE and words & 1)

    def integer_values(self):
        """The elements as unsigned numbers."""
        data = self.data
        if self.width == pkw.WORD:
            return list(data[: self.count])
        return [data[at] << 16 | data[at + 1] for at in range(0, self.count, 2)]

    def signed_values(self):
        """The elements as numbers with a sign."""
        half = 1 << 16 * self.width - 1
        return [value - 2 * half if value >= half else value for value in self.integer_values()]

    def float_values(self):
        """The elements of a 32-bit array as IEEE-754 singles."""
        data = self.data
        return [pkw.words_to_float(data[at], data[at + 1]) for at in range(0, self.count, 2)]
