# SPDX-License-Identifier: MIT
"""What SET does on a page of parameters: it writes into the drive's RAM, and, as long as it is
held alone, into the EEPROM as well once that is confirmed. What is risky asks first.

    writing = Writing(panel)
    writing.set(now_ms, what, risk, words)      # SET was pressed
    writing.let_go()                            # another key was
    write = writing.step(set_is_down, now_ms)   # again and again: the `Write` that has ended
"""

from micropython import const

import on_demand
from panel import texts
from panel.pages import parameter_words as words
from uss.families.generic import CUTS_OFF, RESCALES
from uss.timing import elapsed

EEPROM_MS = const(1_500)  # SET is held so long

_TO_BE_WRITTEN = b"A%d: P%04d=%d"
_DO_OR_NOT = b"SET=DO  PARAM=NO"
ASK = {  # by risk: what row 1 says in turn, and the choice in row 2
    CUTS_OFF: ((_TO_BE_WRITTEN, b"PANEL MAY LOSE", b"THE DRIVE BY IT"), _DO_OR_NOT),
    RESCALES: ((_TO_BE_WRITTEN, b"SETPOINTS MAY", b"CHANGE THEIR HZ"), _DO_OR_NOT),
}


class Writing:
    """write: the `Write` that is on its way, or None."""

    def __init__(self, panel):
        self._panel = panel
        self.forget()

    def forget(self):
        """Another parameter or another drive is shown."""
        self.write = None
        self._wish = None  # what SET was pressed for: as of `Writer.write`
        # A SET that is held makes a write permanent once it is confirmed.
        self._set_at_ms = None  # when it went down, None when it is up or was used up

    def let_go(self):
        """That SET is held does not count any more."""
        self._set_at_ms = None

    def set(self, now_ms, what, risk, values, ask=ASK):
        """what: control, number, index, value and, if it is no word, its width.

        risk: CUTS_OFF, RESCALES or None: it is written without a question. values: what belongs
        into the question. ask: by risk, the question.
        """
        self._wish = what
        if risk is not None and not self._why_not():
            question = on_demand.load("panel.pages.question").Question
            page = question(self._panel, ask[risk], values, {"SET": self._grant})
            self._panel.cover(page)
        else:
            self._grant(now_ms)

    def _why_not(self):
        """Why the wish is not even tried. Asked again when a question was answered."""
        control, number, _, value = self._wish[:4]
        panel = self._panel
        if number != control.survey.family.address_number:
            return texts.NOTHING
        if panel.any_runs() or control.is_starting():
            return texts.STOP_FIRST
        return words.ADDRESS_TAKEN if panel.is_taken(value) else texts.NOTHING

    def _grant(self, now_ms, eeprom=False):
        """Write what was wished for."""
        reason = self._why_not()
        if reason:
            self._panel.say(now_ms, reason)
            return
        control, number, index, value = self._wish[:4]
        family = control.survey.family
        eeprom = family.has_eeprom_tasks and (eeprom or number in family.permanent)
        what = (control, number, index, value, eeprom) + self._wish[4:]
        self.write = self._panel.write(now_ms, *what)
        holds = self.write and family.has_eeprom_tasks and not eeprom
        self._set_at_ms = now_ms if holds else None

    def step(self, set_is_down, now_ms):
        """The `Write` that has just ended; None: there is none."""
        if not set_is_down:
            self._set_at_ms = None
        write = self.write
        if write:
            if write.outcome is None:
                return None
            self.write = None
            if not write.done:
                self._set_at_ms = None
        elif self._set_at_ms is not None:
            if elapsed(now_ms, self._set_at_ms, self._panel.mask) >= EEPROM_MS:
                self._grant(now_ms, True)
        return write
