# SPDX-License-Identifier: MIT
"""What the pages of the diagnosis say, compared with the tape and the world.

A4 MIRROR TEST      A4 GOOD      1/7        A4 SENT      5/9        RESTART      1/2
>12 OK OF 12        >  812  2880/min        >020E040000 ...         >POWER OR RESET

In use:

    diagnosed = Diagnosed(witness)
    diagnosed.read(rows, steady, now)       # the display, after every slice: raises Broken
    diagnosed.key(key, now)                 # before a key goes down
    diagnosed.tests(address, now)           # whether the panel may send a drive a mirror test
    diagnosed.sent(); diagnosed.returned(address)           # one of those
"""

from tools.soaking.judging.facts import CHOSEN_US, MENU, MS, NEVER
from tools.soaking.judging.rules import Broken

MIRROR_TEST, OK_OF = "MIRROR TEST", "OK OF"
RESTART, BY_WATCHDOG, BY_OTHERS = "RESTART", MENU + "WATCHDOG", MENU + "POWER OR RESET"
SENT, GOOD = "SENT", "GOOD"
# After the page was read last: announcements may hide row 1 meanwhile, and what STOP says row 2.
TESTS_US = 6_000 * MS
SLACK = 3  # telegrams: one is on its way, and another picture is not drawn yet
COUNTS = 0x10000
HEXADECIMAL = 14  # digits of a row that is full


class Diagnosed:
    def __init__(self, witness):
        self.witness = witness
        self._tested = None  # the address that the mirror test is about,
        self._tested_us = NEVER  # and when its page was read last
        self._offered_us = NEVER  # it can be chosen
        self._opened_us = NEVER  # it was: row 1 may announce something before it says of whom
        self._sent = self._returned = 0  # of these telegrams, since that SET
        self._since_us = NEVER
        self._counted = []  # (when, address, good replies for sure), as long as it may be shown

    def read(self, rows, steady, now):
        """steady: both rows are drawn to their end."""
        if not rows[1].startswith(MENU):
            return
        name, _, what = rows[0].strip().partition(" ")
        what = what.strip()
        text = rows[1].rstrip()
        address = int(name[1:]) if name[:1] == "A" and name[1:].isdigit() else None
        if text == MENU + MIRROR_TEST:
            self._offered_us = now
        elif OK_OF in text or what == MIRROR_TEST:  # something else may hide either row
            self._read_mirror(address if what == MIRROR_TEST else None, text, steady, now)
        elif not steady or self.witness.hung_us is not None:
            pass
        elif name == RESTART and text in (BY_WATCHDOG, BY_OTHERS):
            if (text == BY_WATCHDOG) != self.witness.bitten:
                raise Broken("SHOWN", "%s, and that is not why it started" % text)
        elif address is not None and what.startswith(GOOD):
            self._judge_good(address, text, now)
        elif address is not None and what.startswith(SENT):
            self._judge_sent(address, text)

    def key(self, key, now):
        if key == "SET" and now - self._offered_us < CHOSEN_US:
            self._opened_us = now
            self._tested = None

    def _read_mirror(self, address, text, steady, now):
        """address: None where row 1 announces something."""
        self._tested_us = now
        if address is not None and address != self._tested:
            self._tested = address
            self._count_anew()
        good, found, total = text[len(MENU) :].partition(OK_OF)
        if not (steady and found and good.strip().isdigit() and total.strip().isdigit()):
            return
        if self._since_us != self.witness.set_us:
            self._count_anew()
        elif int(good) > self._returned + SLACK or int(total) > self._sent + SLACK:
            told = (text, self._returned, self._sent)
            raise Broken("SHOWN", "%s, and %d of %d came back" % told)

    def tests(self, address, now):
        if self._tested is None and now - self._opened_us < TESTS_US:
            self._tested = address
            self._count_anew()
        recently_us = max(self._tested_us, self._opened_us)
        return address == self._tested and now - recently_us < TESTS_US

    def _count_anew(self):
        """The page does, with SET."""
        self._since_us = self.witness.set_us
        self._sent = self._returned = 0

    def sent(self):
        self._sent += 1

    def returned(self, address):
        if address == self._tested:
            self._returned += 1

    def _judge_good(self, address, text, now):
        """It counts good replies, from the start of the panel on. To a question of what the drive
        is another one answers than the drive of the list."""
        digits = text[len(MENU) :].split()[0]
        case = self.witness.cases[address]
        if not digits.isdigit() or case.questions:
            return
        shown, least = int(digits), self._counted_before(address, case.heard, now)
        if not least - SLACK <= shown <= case.taken + SLACK and case.taken < COUNTS // 2:
            told = (text, address, least, case.taken)
            raise Broken("SHOWN", "%s: drive %d has sent %d good replies, or up to %d" % told)

    def _counted_before(self, address, heard, now):
        """How many it must have been when what is shown now was drawn; 0: nobody looked then."""
        counted = self._counted
        counted.append((now, address, heard))
        while len(counted) > 1 and counted[1][0] <= now - self.witness.seen_us:
            counted.pop(0)
        when, whose, least = counted[0]
        return least if whose == address and when <= now - self.witness.seen_us else 0

    def _judge_sent(self, address, text):
        """The first row of a telegram in hexadecimal."""
        digits = text[len(MENU) :]
        if len(digits) != HEXADECIMAL or not digits.startswith("02") or " " in digits:
            return
        if int(digits[4:6], 16) != address:
            raise Broken("SHOWN", "%s was not sent to drive %d" % (text, address))
