# SPDX-License-Identifier: MIT
"""Bus off: the panel leaves the line to others, for as long as its display says so.

P2014 MAY TRIP      SET leaves it: every drive of the list is told OFF1, then nothing is sent
>SET=LEAVE LINE

PARAM=BACK          until PARAM or STOP; then the line must be silent for 100 ms first
>LINE IS FREE

In use:

    left = LineLeft(witness)
    left.read(rows, steady, now)        # the display, after every slice: raises Broken
    left.key(key, now)                  # before a key goes down
    left.judge(where, now)              # a telegram of the panel: raises Broken
"""

from tools.soaking.judging.facts import CHOSEN_US, MENU, MS, NEVER
from tools.soaking.judging.rules import Broken

OFFERS, FREE = MENU + "SET=LEAVE LINE", MENU + "LINE IS FREE"  # row 2
ENDS = ("PARAM", "STOP")
TAKEN_US = 1_500 * MS  # a key that was to end it, and then says the display that it did not


class LineLeft:
    """is_free: nothing may be sent. back_us: when that ended last."""

    def __init__(self, witness):
        self.witness = witness
        self.is_free = False
        self.back_us = NEVER
        self._offered_us = NEVER
        self._chosen_us = NEVER

    def read(self, rows, steady, now):
        row_2 = rows[1].rstrip()
        if row_2 == OFFERS:
            self._offered_us = now
        elif row_2 == FREE and steady and not self.is_free:
            if self._chosen_us > self.back_us:
                self._judge_told(now)
                self.is_free = True
            elif now - self.back_us > TAKEN_US:
                if self._chosen_us < self.witness.boot_us:
                    raise Broken("BUS OFF", "at %d, and nobody asked for it" % now)
                self.is_free = True  # the panel has not seen the key

    def key(self, key, now):
        if key == "SET" and now - self._offered_us < CHOSEN_US:
            self._chosen_us = now
        elif key in ENDS:
            self.end(now)

    def end(self, now):
        """The panel may take the line again, and must before long."""
        if self.is_free:
            self.is_free = False
            self.back_us = self.witness.stalled_us = self.witness.begun_us = now

    def judge(self, where, now):
        if self.is_free and self.witness.hung_us is None:
            raise Broken("BUS OFF", "%s at %d, and the display says LINE IS FREE" % (where, now))

    def _judge_told(self, now):
        """Every drive of the list was told to stop before the panel left, unless it was mute."""
        witness = self.witness
        if witness.tape.sent_us < max(witness.boot_us, self.back_us):
            return
        for address in witness.plan.listed:
            sent_us = witness.cases[address].sent_us
            if sent_us < self._chosen_us and address not in witness.moved:
                raise Broken(
                    "BUS OFF", "at %d, and drive %d was not told to stop" % (now, address)
                )
