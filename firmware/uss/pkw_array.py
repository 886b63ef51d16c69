"""Parameters that are arrays: one element, all of them, how many there are (tasks 6...9, 11, 12).

The panel does without: a MICROMASTER 4 gives one element to `pkw.read(number, index)` as well. A
G120 prefers these tasks. All elements at once need variable length (P2013 = 127). Their index
counts as the drive does, from 0 or from 1.

    job = read_all(304)                         # or write_element_word(304, 2, 230)
    drive.ask(job)                              # ... later:
    if job.state == pkw.DONE: print(job.values, job.float_values())
"""

from array import array

from micropython import const

from uss import pkw
from uss.fast import get_words

WORDS_MAX = const(124)  # of an answer, behind PKE and IND


def read_element(number, index):
    """A job that reads one element of an array, 16 or 32 bits wide."""
    return pkw.Job(pkw.READ_ELEMENT, number, index)


def write_element_word(number, index, value, eeprom=False):
    """A job that writes one element, -32768...65535, to RAM or, when asked, to EEPROM too."""
    task = pkw.WRITE_ELEMENT_WORD_EEPROM if eeprom else pkw.WRITE_ELEMENT_WORD
    return pkw.Job(task, number, index, 0, pkw.word_of(value))


def write_element_double(number, index, value, eeprom=False):
    """A job that writes one element of 32 bits, -2**31...2**32 - 1."""
    task = pkw.WRITE_ELEMENT_DOUBLE_EEPROM if eeprom else pkw.WRITE_ELEMENT_DOUBLE
    high, low = pkw.words_of(value)
    return pkw.Job(task, number, index, high, low)


def write_element_float(number, index, value, eeprom=False):
    """A job that writes one floating-point element, rounded to single precision."""
    task = pkw.WRITE_ELEMENT_DOUBLE_EEPROM if eeprom else pkw.WRITE_ELEMENT_DOUBLE
    high, low = pkw.float_to_words(value)
    return pkw.Job(task, number, index, high, low)


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


class LongJob(pkw.Job):
    """A job whose task or answer may be longer than a double word.

    task: AK. index: 0...255. words: those of the value to write. room: the most words of the
    answer; one that is longer ends the job as REFUSED, error 21.

    When DONE the answer is the first `count` words of `data`, an array, and the first two of them
    are `high` and `low`, as in a `Job`. Of a drive with four fixed words it is only there, and
    `count` is 0. Not to be aimed at anything else. What kind of job it is says _is_whole(reply,
    words): whether an answer with this AK may have so many words.
    """

    def __init__(self, task, number, index, words, room):
        self.data = array("H", [0] * room)
        self.count = 0
        self._size = 2 * (2 + max(1, len(words)))
        padded = [0] * (2 - len(words)) + list(words)  # a word stands last, as in a `Job`
        super().__init__(task, number, index, padded[0], padded[1])
        head = self.words
        self.words = bytearray(2 * (2 + len(padded)))
        self.words[:4] = head[:4]
        for position, word in enumerate(padded):
            self.words[4 + 2 * position] = word >> 8
            self.words[5 + 2 * position] = word & 0xFF

    def size(self):
        """Characters of the task."""
        return self._size

    def _keep_value(self, reply, net, at, count, form):
        """Keep the words that stand from index `at` on; whether their number fits the reply."""
        words = count >> 1
        if not self._is_whole(reply, words):
            return False
        if words > len(self.data):
            self.refuse(pkw.TOO_LONG)
        else:
            get_words(net, at, self.data, 0, words)
            self.count = words
            self.high = self.data[0] if words > 1 else 0
            self.low = self.data[1] if words > 1 else self.data[0]
            self.width = pkw.DOUBLE if reply == pkw.ELEMENT_DOUBLE else pkw.WORD
            self.state = pkw.DONE
        return True


class ArrayJob(LongJob):
    """All elements of an array at once, read or written. Needs variable length.

    words: those of the values to write, ValueError when there are none; or none to read.
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

    @property
    def values(self):
        """The elements as unsigned numbers."""
        data = self.data
        if self.width == pkw.WORD:
            return list(data[: self.count])
        return [data[at] << 16 | data[at + 1] for at in range(0, self.count, 2)]

    def signed_values(self):
        """The elements as numbers with a sign."""
        half = 1 << 16 * self.width - 1
        return [value - 2 * half if value >= half else value for value in self.values]

    def float_values(self):
        """The elements of a 32-bit array as IEEE-754 singles."""
        data = self.data
        return [pkw.words_to_float(data[at], data[at + 1]) for at in range(0, self.count, 2)]
