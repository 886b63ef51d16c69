# SPDX-License-Identifier: MIT
"""Jobs whose task or answer is longer than a double word; words to characters and back.

`arrays`, `descriptions` and `texts` each have a kind of `LongJob`; here is what these share. The
panel needs none of them and imports none.

    words_of(b"AB")                     # [0x4142]
    text_of(b"RAMP TIME  ")             # "RAMP TIME"
"""

import struct
from array import array

from uss import pkw
from uss.fast import get_words


class LongJob(pkw.Job):
    """A job whose task or answer may be longer than a double word.

    task: AK. index: 0...255. words: those of the value to write. room: the most words of the
    answer; a longer answer ends the job as REFUSED, error 21.

    When DONE the answer is the first `count` words of the array `data`; the first two of them are
    also `high` and `low`, as in a `Job`. From a drive with four fixed words the answer is only in
    `high` and `low`, and `count` is 0. Do not `aim` such a job at anything else. Each kind of job
    defines _is_whole(reply, words): whether an answer with this AK may have so many words.
    """

    def __init__(self, task, number, index, words, room):
        self.data = array("H", [0] * room)
        self.count = 0
        self._size = 2 * (2 + max(1, len(words)))
        padded = [0] * (2 - len(words)) + list(words)  # a single word stands last, as in a `Job`
        super().__init__(task, number, index, padded[0], padded[1])
        head = self.words
        self.words = bytearray(2 * (2 + len(padded)))
        self.words[:4] = head[:4]
        for position, word in enumerate(padded):
            self.words[4 + 2 * position] = word >> 8
            self.words[5 + 2 * position] = word & 0xFF

    _is_whole = None  # see above

    def size(self):
        """Characters of the task."""
        return self._size

    def _keep_value(self, reply, net, at, count, form):
        """Keep the words from index `at` on; return whether their number fits the reply."""
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


# --- words and characters -----------------------------------------------------------------------


def characters_of(words):
    """Words as the characters that go over the line."""
    return b"".join([struct.pack(">H", word) for word in words])


def words_of(characters):
    """An even number of characters as words."""
    return [number_of(characters[at : at + 2]) for at in range(0, len(characters), 2)]


def number_of(characters):
    """Characters as an unsigned number, the high one first."""
    return int.from_bytes(characters, "big")


def text_of(characters):
    """Characters as a text, without the blanks at its end."""
    return "".join([chr(character) for character in characters]).rstrip(" \0")
