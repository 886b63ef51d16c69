# SPDX-License-Identifier: MIT
"""Why a drive does not answer: what was heard of it, and what to check, step by step.

A3 HEARD     1/8        the first entry: in words; and how many telegrams it has answered
>NOTHING

CHECK        4/8        the others: the most likely first, for what was heard. SET opens what
>P2010=7 19200          helps: the baud rate, any address, its PKW and PZD words, the search
"""

from micropython import const

from panel import texts
from panel.menu import Entries, words
from uss.drive import COUNTERS
from uss.receiver import NOISE, OTHER_ADDRESS, OTHER_LENGTH, SILENCE, WRONG_CHECK

_COUNTED_MAX = const(9999)  # that has room

# What can be checked. The first five are numbers of a family and what has to stand there.
RATE, ADDRESS, PKW_WORDS, PZD_WORDS, TWINS = range(5)
PLUG, MAINS, SWAPPED, ENDS, SHIELD, MASTERS, FIND = range(5, 12)
_NUMBERS = ("baud_number", "address_number", "pkw_words_number", "pzd_words_number")
_WORDS = {
    PLUG: words.CHECK_PLUG,
    MAINS: words.CHECK_MAINS,
    SWAPPED: words.CHECK_SWAPPED,
    ENDS: words.CHECK_ENDS,
    SHIELD: words.CHECK_SHIELD,
    MASTERS: words.CHECK_MASTERS,
    FIND: texts.FIND_DRIVES,
}
_KIND_ROWS = {PKW_WORDS: 1, PZD_WORDS: 2}  # of words.KIND

ALONE, IN_USE = const(-1), const(-2)  # nobody answers at all; another master talks

# The most likely first, by what was heard.
STEPS = {
    ALONE: (PLUG, SWAPPED, RATE, MAINS, ADDRESS, ENDS, FIND),
    SILENCE: (MAINS, PLUG, ADDRESS, RATE, SWAPPED, PKW_WORDS, FIND),
    NOISE: (TWINS, RATE, ENDS, SWAPPED, SHIELD, MASTERS),
    OTHER_LENGTH: (PKW_WORDS, PZD_WORDS, TWINS),
    OTHER_ADDRESS: (MASTERS, ADDRESS, TWINS),
    WRONG_CHECK: (SHIELD, ENDS, TWINS),
    IN_USE: (MASTERS,),
}
_HEARD = {
    ALONE: words.HEARD_NOBODY,
    SILENCE: words.HEARD_NOTHING,
    NOISE: texts.LINE_NOISE,
    OTHER_LENGTH: texts.OTHER_LENGTH,
    OTHER_ADDRESS: texts.WRONG_DRIVE,
    WRONG_CHECK: texts.WRONG_CHECK,
    IN_USE: texts.LINE_IN_USE,
}


class List(Entries):
    """Of the drive that is shown."""

    def __init__(self, panel, argument):
        Entries.__init__(self, panel, argument)
        self._finding = self._heard()
        self._steps = STEPS[self._finding]

    def heading(self, position):
        if position < 2:
            return texts.of(words.HEARD_OF, self.panel.selected.drive.address)
        return texts.of(words.CHECK)

    def count(self):
        return 2 + len(self._steps)

    def words(self, position):
        drive = self.panel.selected.drive
        if position == 0:
            return texts.of(words.IT_ANSWERS if drive.contact else _HEARD[self._finding])
        if position == 1:
            counted = sum(drive.counters)
            good = drive.counters[COUNTERS.index("good")]
            return texts.of(words.OK_OF, min(good, _COUNTED_MAX), min(counted, _COUNTED_MAX))
        return self._check(self._steps[position - 2])

    def step(self, position, now_ms):
        if position < 2 and self._finding != self._heard():
            self._finding = self._heard()
            self._steps = STEPS[self._finding]

    def choose(self, position, now_ms):
        step = self._steps[position - 2] if position > 1 else None
        if step == RATE:
            return "value", words.SETTINGS[0]
        if step in _KIND_ROWS:
            return "kind", (self.panel.selected, _KIND_ROWS[step])
        if step == ADDRESS:
            return "address", None
        return ("find", None) if step == FIND else None

    def _heard(self):
        """What was heard: a key of STEPS."""
        panel = self.panel
        if panel.line_in_use():
            return IN_USE
        trouble = panel.selected.drive.trouble
        if trouble == SILENCE and not any([one.drive.contact for one in panel.controls]):
            return ALONE
        return trouble

    def _check(self, step):
        drive = self.panel.selected.drive
        if step == TWINS:
            return texts.of(words.CHECK_TWINS, drive.address)
        if step in _WORDS:
            return texts.of(_WORDS[step])
        wanted = (
            self.panel.settings.baud, drive.address,
            drive.layout.pkw_words, drive.layout.pzd_words,
        )[step]  # fmt: skip
        family = self.panel.selected.survey.family
        number = getattr(family, _NUMBERS[step])
        if number is None:
            return texts.of(words.CHECK_UNNAMED[step], wanted)
        if step == RATE:
            for code in family.baud_codes:
                if family.baud_codes[code] == wanted:
                    return texts.of(words.CHECK_RATE, number, code, wanted)
        return texts.of(words.CHECK_PARAMETER, number, wanted)
