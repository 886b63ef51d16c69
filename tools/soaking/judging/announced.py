# SPDX-License-Identifier: MIT
"""Checks that the panel says every trouble: it compares the display with what the line tells of
each drive.

A drive is in trouble if it runs and is not shown, has tripped, ran when contact was lost, was
never heard since power-on, or was stopped by something other than STOP. If n drives are in
trouble, each must be on the display for a second within 2 n s, again and again, on every page.

    announced = Announced(plan, witness, reader)
    announced.look(now)             # after every slice: raises Broken
"""

from tools.soaking.judging.facts import (
    CHOICES,
    MENU,
    MS,
    NEVER,
    NO_PARAMETERS,
    ZSW_FAULT,
    ZSW_RUNNING,
    S,
)
from tools.soaking.judging.rules import Broken

RUNS, EXPOSED, TRIPPED, MAY_RUN, NOT_STOPPED, UNHEARD, UNSURE, OFF = (
    "it runs", "it runs, and its P2014 is longer by now", "it has tripped", "it may run",
    "STOP unconfirmed", "never heard", "it may run, or was never heard", "it was stopped",
)  # fmt: skip

ONE = (  # text after "A" and an address, and the troubles that it tells; any other text: it is off
    ("RUN,HOLD=ALL", (RUNS,)),
    ("RUN, P", (RUNS, EXPOSED)),  # and the number of its telegram off time
    ("P2014 LONG", (RUNS, EXPOSED)),
    ("P0093 LONG", (RUNS, EXPOSED)),
    ("P2040 LONG", (RUNS, EXPOSED)),
    ("BELOW P", (RUNS,)),
    ("FAULT", (TRIPPED, OFF)),
    ("LOST,MAY RUN", (MAY_RUN, UNSURE)),
    ("NOT STOPPED", (NOT_STOPPED, RUNS, EXPOSED, MAY_RUN, UNSURE)),
    ("MAY RUN", (UNHEARD, UNSURE)),
    ("", (OFF,)),
)
MANY = (  # text before their number, if there are more than FEW of them
    ("RUN,HOLD=ALL:", (RUNS,)),
    ("RUN, P2014 ?:", (RUNS, EXPOSED)),
    ("DRIVES FAULT:", (TRIPPED, OFF)),
    ("LOST,MAY RUN:", (MAY_RUN, UNSURE)),
    ("NOT STOPPED:", (NOT_STOPPED, RUNS, EXPOSED, MAY_RUN, UNSURE)),
    ("MAY RUN:", (UNHEARD, UNSURE)),
    ("DRIVES OFF:", (OFF,)),
)
UNCONFIRMED, LOST = "STOP UNCONFIRMED", "NO CONTACT, "  # an alarm of the drive shown, a row
PLACE = 11  # the column of row 1 where a list has its place
ANY, SHOWN = -1, -2  # in place of an address: all of a kind; the drive shown, whichever it is

LONG_US = 900 * MS  # 1 s, less the time lost by drawing and by looking
TURN_US = 2 * S  # for each drive in trouble
SPLASH_US = 1_500 * MS  # what is on the display after power-on
SLACK_US = 500 * MS  # for drawing
STOPS_US = 100 * MS  # a longer STOP of all shortens the announcements meanwhile
PAGE_US = 700 * MS  # the page of a drive that was just selected has a turn first
REDRAWN_US, REDRAWN_STEPS = 200 * MS, 10  # an announcement may move from one row to the other
FOUND_US = 1_500 * MS  # until a trouble is noticed; and for each drive of the list
FOUND_STEPS = 20  # steps of the loop more
UNHEARD_TELEGRAMS = 4  # without a reply since power-on
LATELY = 4  # turns: announcements in these may have taken the time of a due one


class Announced:
    def __init__(self, plan, witness, reader):
        self.plan = plan
        self.witness = witness
        self.reader = reader
        self._troubles = {}  # address -> (which, since when)
        self._said = {}  # (address or ANY, which) -> when it was last said, for long enough
        self._read = ()  # what is being said: (address or ANY, troubles)
        self._times = {}  # each of these -> since when, and when it was read last
        self._many = {}  # troubles -> how many drives were told to have them, and when
        self._rows = None
        self._alarm = False  # the rows have one of the drive shown
        self._free_us = 0  # when the display last had nothing else to show
        self._redrawn_us = REDRAWN_US + REDRAWN_STEPS * plan.loop_us
        self._stops_us = plan.loop_us * len(plan.listed)  # a STOP of all: nothing is drawn
        self._found_us = FOUND_US + FOUND_STEPS * plan.loop_us * len(plan.listed)

    def look(self, now):
        self._read_rows(now)
        if self._is_taken(now):
            self._free_us = now
        self._find_troubles(now)
        witness = self.witness
        if not self._troubles or witness.shown is None or now < witness.unsure_us:
            return
        patience_us = TURN_US * self._count(now) + SLACK_US
        selected_us = max(witness.pressed_us["ADDRESS_UP"], witness.pressed_us["ADDRESS_DOWN"])
        if now - selected_us < patience_us:
            patience_us += PAGE_US
        if self._stops_us > STOPS_US and now - witness.pressed_us["STOP"] < 2 * patience_us:
            patience_us *= 2  # an announcement during a STOP of all is short, and comes again
        for address, (which, since_us) in self._troubles.items():
            said_us = max(self._said.get((one, which), NEVER) for one in (address, ANY, SHOWN))
            waited_us = now - max(since_us + self._found_us, self._free_us, said_us)
            if waited_us > patience_us:
                told = (address, which, waited_us // MS, len(self._troubles), now)
                text = "drive %d, %s: unsaid for %d ms, %d in trouble, at %d"
                raise Broken("ANNOUNCED", text % told)

    def _read_rows(self, now):
        rows = self.reader.rows
        if rows != self._rows:
            self._rows = rows
            self._read = tuple(one for one in (said_in(row) for row in rows) if one is not None)
            self._alarm = UNCONFIRMED in rows or rows[0].startswith(LOST)
            for address, troubles in self._read:
                if address == ANY and number_in(rows):  # without a number it is half drawn
                    self._many[troubles] = (number_in(rows), now)
        read = self._read
        if self._alarm and self.witness.shown is None:  # the page of whichever drive says it
            read += ((SHOWN, (NOT_STOPPED, RUNS, EXPOSED, MAY_RUN, UNSURE)),)
        for address, troubles in read:
            since_us, last_us = self._times.get((address, troubles), (now, NEVER))
            if now - last_us > self._redrawn_us:
                since_us = now
            self._times[address, troubles] = (since_us, now)
            if now - since_us >= LONG_US:
                for which in troubles:
                    self._said[address, which] = now

    def _is_taken(self, now):
        """Whether the panel starts, hangs, or may do nothing."""
        witness = self.witness
        return (
            witness.hung_us is not None
            or witness.stuck_us is not None
            or now - max(witness.boot_us, witness.stalled_us) < SPLASH_US
            or self.reader.reads("LINE IN USE")
        )

    def _count(self, now):
        """How much the panel may have to say: of drives in trouble, or spoken of in the last round
        of all that. One whose trouble becomes another is spoken of twice."""
        many = [count for count, read_us in self._many.values() if now - read_us < 8 * TURN_US]
        turns, count = 0, LATELY
        while count > turns:
            turns = count
            told = [
                address for (address, _), (_, last_us) in self._times.items()
                if now - last_us < turns * TURN_US and address != SHOWN
            ]  # fmt: skip
            untold = [address for address in self._troubles if address not in told]
            count = len(told) + len(untold) + sum(many)
        return count

    def _find_troubles(self, now):
        witness = self.witness
        for address in self.plan.listed:
            which = None
            if address not in witness.moved:
                which = self._trouble_of(address, witness.cases[address], now)
            before = self._troubles.get(address)
            if which is None:
                self._troubles.pop(address, None)
            elif before is None or before[0] != which:
                self._troubles[address] = (which, now)

    def _trouble_of(self, address, case, now):
        witness = self.witness
        is_shown = address == (self.reader.address if witness.shown is None else witness.shown)
        if case.answered_us < witness.boot_us:
            unheard = case.acknowledge_us < witness.boot_us and case.unheard > UNHEARD_TELEGRAMS
            return UNHEARD if unheard else None
        if is_shown and not self._hides_state():
            return None  # its own page says it
        taken_us = min(case.answered_us, case.heard_us)  # a reply that the panel has surely taken
        # A panel that has left the line knows nothing of a drive any more.
        if witness.line.is_free or now - taken_us > witness.lost_us * 9 // 10:
            if not witness.is_lost(case, now):
                return None  # it may be, or about to be
            may_run = case.zsw & ZSW_RUNNING and case.ran_us == case.answered_us
            if not may_run:
                return None
            return MAY_RUN if case.heard_us >= witness.boot_us else UNSURE
        if case.zsw & ZSW_FAULT:
            return TRIPPED
        if case.zsw & ZSW_RUNNING:
            if is_shown:
                return None
            return EXPOSED if witness.is_more_exposed(address, case) else RUNS
        known_us = max(case.acknowledge_us, case.start_us, witness.boot_us)
        return OFF if case.off_us > known_us else None

    def _hides_state(self):
        """Whether the page is one that does not tell what the drive shown does."""
        row_2 = self.reader.rows[1]
        return (
            self.reader.looks_up
            or row_2 in CHOICES
            or row_2.startswith(MENU)
            or is_parameter(row_2)
        )


def is_parameter(row_2):
    """Whether the page is that of parameter mode."""
    return row_2[5:6] == ":" or row_2.startswith(NO_PARAMETERS)


def is_looked_up(rows):
    """Whether the page is that of any parameter, `P1120[0]  10.00s`, also while it is changed."""
    for row in rows:
        if row[:1] in ("P", "r") and row[1:5].isdigit() and row[5:6] in (" ", "[", "."):
            return not is_place(row[PLACE:])  # a step of commissioning
    return False


def is_place(text):
    """Whether this is the place in a list, 15/23."""
    place, _, count = text.strip().partition("/")
    return place.isdigit() and count.isdigit()


def said_in(row):
    """The address that a whole row speaks of, or ANY, and the troubles that it tells; or None."""
    for text, troubles in MANY:
        if row.startswith(text):
            return ANY, troubles
    if row[:1] != "A" or not row[1:2].isdigit():
        return None
    end = 3 if row[2:3].isdigit() else 2
    if row[end : end + 1] != " " or "..." in row or not row[end:].strip():
        return None  # address and limits of a parameter
    for text, troubles in ONE:
        if row[end:].strip().startswith(text):
            return int(row[1:end]), troubles


def number_in(rows):
    """How many drives a row speaks of that ends in their number."""
    for row in rows:
        words = row.split()
        if len(words) > 1 and words[-2].endswith(":") and words[-1].isdigit():
            return int(words[-1])
    return 0
