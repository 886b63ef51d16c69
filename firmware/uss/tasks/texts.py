# SPDX-License-Identifier: MIT
"""The texts that a drive keeps for its parameters: what an index or a value means (task 15).

No MICROMASTER, G110 or V20 has any; MASTERDRIVES have. Needs variable length (P2013 = 127).
Source: specification C-4.2.2, examples 7 and 8.

    job = read_text(7, 3)               # the meaning of value 2 of P0007
    drive.ask(job)                      # ... later:
    if job.state == pkw.DONE: print(job.text())
"""

from micropython import const

from uss import pkw
from uss.tasks.long_jobs import LongJob, characters_of, text_of, words_of

TEXT_SIZE = const(16)  # characters
_WRITE = const(1 << 8)  # bits of IND
_SECOND_FIELD = const(1 << 9)


class TextJob(LongJob):
    """Reads or writes a text of 16 characters.

    field 1: for an array, the meaning of each index (element = index); for a single number, the
    meaning of each value (element = value + 1). field 2: for an array, the meaning of each value
    (element = value + 1). ValueError if there is no such field or element, or if a drive cannot
    have these characters.
    """

    def __init__(self, number, element, field, characters=None):
        if not 1 <= element <= pkw.INDEX_MAX or field not in (1, 2):
            raise ValueError("text %r of field %r" % (element, field))
        words = () if characters is None else words_of(characters)
        super().__init__(pkw.TEXT, number, element, words, TEXT_SIZE // 2)
        page = (0 if characters is None else _WRITE) | (_SECOND_FIELD if field == 2 else 0)
        self.words[2] |= page >> 8
        self.key |= page

    def fits(self, form):
        """Whether a channel of this form can carry it."""
        return bool(form & pkw.VARIABLE_LENGTH) and super().fits(form)

    def text(self):
        """The text, without the blanks at its end."""
        return text_of(characters_of(self.data[: self.count]))

    def _is_whole(self, reply, words):
        return 2 * words == TEXT_SIZE


def read_text(number, element, field=1):
    """A job that reads a text; see `TextJob`."""
    return TextJob(number, element, field)


def write_text(number, element, text, field=1):
    """A job that writes a text, 0...16 characters of Latin-1."""
    characters = bytes([ord(character) for character in text])
    if len(characters) > TEXT_SIZE:
        raise ValueError("a text of %d characters" % len(characters))
    return TextJob(number, element, field, characters + b" " * (TEXT_SIZE - len(characters)))
