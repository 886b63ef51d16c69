# SPDX-License-Identifier: MIT
"""The lock of the keys: closed it lets through START, STOP, the setpoint and the address keys
alone, and nothing opens it but its code.

LOCK: HOLD PARAM    row 2: it is closed, and a key was refused, or it was just closed
>CODE **4_          the third digit is given; SET takes it
UNLOCKED            behind the fourth SET, or WRONG CODE
>NEW CODE 20__      likewise; then KEPT, or NO LOCK for 0000

In use:

    locked = Locked(witness)
    locked.booted(now)                      # with a code it is closed from then on
    locked.read(rows, now)                  # the display, drawn to its end: raises Broken
    locked.key(key, now)                    # before a key goes down
    locked.look(now)                        # after every slice: raises Broken
    locked.judge_jog(pressed_us, where)     # these three raise Broken where it is closed
    locked.judge_direction(address, is_left, where, now)
    locked.judge_write(where, now)
    locked.is_closed, locked.code           # as far as is known, or None
"""

import json

from tools.soaking.judging.announced import is_looked_up, is_parameter
from tools.soaking.judging.facts import ALWAYS, CHOSEN_US, MENU, MS, NEVER, S
from tools.soaking.judging.kept_sets import SETTINGS_FILE
from tools.soaking.judging.rules import Broken

LOCKED = "LOCK: HOLD PARAM"  # row 2
CLOSES = MENU + "LOCK"
CODE, NEW_CODE = MENU + "CODE ", MENU + "NEW CODE "
REFUSES, STOPS = MENU + "NO: IN THE MENU", ": STOP"  # in place of the code, for a while
OPENED, WRONG, KEPT = "UNLOCKED", "WRONG CODE", ("KEPT", "NO LOCK")
DIGITS, HIDDEN, MISSING = 4, "*", "_"
ANSWER_US = 2 * S  # to the last digit, or to LOCK in the menu
ITSELF_US = 290 * S  # without a key for so long it closes by itself
LEFT_US = 2 * S  # pages that it forbids are gone by then, the first picture is drawn


class Locked:
    def __init__(self, witness):
        self._witness = witness
        self._rows = None
        self.code = None
        self.is_closed = None
        self._closed_us = ALWAYS
        self._free_us = NEVER  # what was asked for before it closed is written until then
        self._offer = None  # what SET says yes to, and when that was read last
        self._offered_us = NEVER
        self._digits = []  # that SET has taken; None among them: nobody has read which
        self._asks = None  # CODE or NEW_CODE, as read last
        self._asked = None  # likewise: the last digit of it was given,
        self._asked_us = NEVER
        self._chosen_us = ALWAYS  # SET was pressed on LOCK, and nothing has come of it yet
        self._lefts = {}  # address -> the direction of an ON since it is closed
        self.booted(0)

    def booted(self, now):
        stored = self._witness.world.flash.files.get(SETTINGS_FILE)
        self.code = None if stored is None else json.loads(stored).get("lock_code", 0)
        self._open()
        self._asked, self._chosen_us = None, ALWAYS
        if self.code:
            self._close(now, now)
        elif self.code is None:
            self.is_closed = None

    def _open(self):
        self.is_closed, self._closed_us = False, ALWAYS
        self._lefts = {}

    def _close(self, now, free_us):
        self.is_closed, self._closed_us, self._free_us = True, now, free_us
        self._lefts = {}

    # --- what the display says ------------------------------------------------------------------

    def read(self, rows, now):
        if self._witness.searches:
            return
        row_2 = rows[1].rstrip()
        if row_2 == CLOSES or row_2.startswith((CODE, NEW_CODE)):
            self._offer, self._offered_us = row_2, now
        if rows != self._rows:
            self._rows = rows
            self._take_message(row_2, now)
        if self.is_closed and now - self._closed_us > LEFT_US + self._witness.seen_us:
            self._judge_page(rows)

    def _take_message(self, row_2, now):
        """A row 2 that is new."""
        if row_2 == LOCKED and not self.is_closed:
            self._judge_closed(now)
            self._chosen_us = ALWAYS
            self._close(now, now + self._witness.wish_us)
        elif row_2 == OPENED:
            self._judge_answer(False, row_2, now)
            self._open()
        elif row_2 == WRONG:
            self._judge_answer(True, row_2, now)
        elif row_2 in KEPT and self._asked == NEW_CODE and now - self._asked_us < ANSWER_US:
            self.code = self._given()
            self._open()
            self._asked = None

    def _judge_closed(self, now):
        is_known = self.is_closed is False and self._chosen_us == ALWAYS
        pressed_us = max(self._witness.pressed_us.values())
        if is_known and now - max(pressed_us, self._witness.boot_us) < ITSELF_US:
            raise Broken("LOCK", "it has closed at %d, and nobody asked for that" % now)

    def _judge_answer(self, is_wrong, text, now):
        """UNLOCKED behind a wrong code, or WRONG CODE behind the right one."""
        given = self._given()
        is_asked = self._asked == CODE and now - self._asked_us < ANSWER_US
        self._asked = None
        if not is_asked and not is_wrong and self.is_closed:
            raise Broken("LOCK", "%s at %d, and nobody gave a code" % (text, now))
        if is_asked and given is not None and self.code is not None:
            if (given != self.code) != is_wrong:
                raise Broken("LOCK", "%s: %04d was given for %04d" % (text, given, self.code))

    def _given(self):
        """The code that was given; None: a digit of it is not known."""
        if len(self._digits) != DIGITS or None in self._digits:
            return None
        code = 0
        for digit in self._digits:
            code = 10 * code + digit
        return code

    def _judge_page(self, rows):
        """Only the page for its code is to be had."""
        row_2 = rows[1].rstrip()
        is_free = row_2 == MENU or row_2 == REFUSES or row_2.endswith(STOPS)
        if row_2.startswith(MENU) and not is_free and not row_2.startswith(CODE):
            raise Broken("LOCK", "it is closed, and the menu has %s" % row_2)
        is_home = rows[1][13:14] == "A"  # P2014 LONG   A7
        if is_parameter(rows[1]) or is_looked_up(rows) and not is_home:
            raise Broken("LOCK", "it is closed, and a page has %s" % row_2)
        if row_2.startswith(CODE) and row_2[len(CODE) :].rstrip(MISSING)[:-1].strip(HIDDEN):
            raise Broken("LOCK", "%s can be read" % row_2)

    # --- keys -----------------------------------------------------------------------------------

    def key(self, key, now):
        if self._chosen_us != ALWAYS:
            self._chosen_us = ALWAYS  # that key takes the message away
            self.is_closed = None
        if key == "PARAM":
            self._digits = []  # it leaves the page
        if key != "SET":
            return
        offer, self._offer = self._offer, None
        if offer is not None and now - self._offered_us < CHOSEN_US:
            if offer != CLOSES:
                self._asks = CODE if offer.startswith(CODE) else NEW_CODE
                self._read_digit(offer[len(self._asks) :].rstrip(MISSING))
                self._take_last(now)
            elif not self.is_closed:
                self._chosen_us = now
        elif self._digits:
            self._digits.append(None)  # it may have taken one that nobody has read
            self._take_last(now)

    def _read_digit(self, digits):
        """digits: those that are there, the last of which SET takes."""
        place = len(digits) - 1
        if place == 0:
            self._digits = []
        if not digits[-1:].isdigit() or place != len(self._digits):
            self._digits = [None] * max(place, 0)
        self._digits.append(int(digits[-1]) if digits[-1:].isdigit() else None)

    def _take_last(self, now):
        if len(self._digits) < DIGITS:
            return
        self._asked, self._asked_us = self._asks, now
        if self._asks == CODE and self._given() in (None, self.code):
            self.is_closed = None  # until the display tells
        elif self._asks == NEW_CODE:
            self.code = None

    def look(self, now):
        """LOCK in the menu closes it, unless something else befell the panel meanwhile."""
        witness = self._witness
        if self._chosen_us == ALWAYS or now - self._chosen_us < ANSWER_US + witness.seen_us:
            return
        befell_us = max(witness.late_us, witness.stalled_us, witness.boot_us, witness.pulled_us)
        since_us, self._chosen_us = self._chosen_us, ALWAYS
        if witness.hung_us is None and befell_us < since_us - S:
            raise Broken("LOCK", "chosen at %d, and it is not closed" % since_us)
        self.is_closed = None

    # --- what is sent ---------------------------------------------------------------------------

    def _is_sure(self, now):
        patience_us = self._witness.seen_us + 2 * self._witness.exchange_us
        return self.is_closed and now - self._closed_us > patience_us

    def judge_jog(self, pressed_us, where):
        if self.is_closed and pressed_us > self._closed_us + 100 * MS:
            raise Broken("LOCK", "%s, the lock is closed" % where)

    def judge_direction(self, address, is_left, where, now):
        """Of an ON that turns a motor: REVERSE changes nothing."""
        if not self._is_sure(now):
            return
        before = self._lefts.setdefault(address, is_left)
        if before != is_left:
            raise Broken("LOCK", "%s, the other direction, and the lock is closed" % where)

    def judge_write(self, where, now):
        if self._is_sure(now) and now > self._free_us:
            raise Broken("LOCK", "%s, and the lock is closed" % where)
