# SPDX-License-Identifier: MIT
"""The list of drives: its order, and how often each stands in it, are as SET and PARAM kept them.

ORDER       2/5     >A3             SET takes it up
SET=KEEP    2/5     >A3  UP DOWN    UP and DOWN carry it; PARAM keeps the order
TURNS       2/5     >A3  x2         SET takes it up
SET=KEEP    2/5     >A3  x3         UP and DOWN change it; SET keeps it

The panel begins anew with either, so no motor may run.

In use:

    arranged = Arranged(witness)
    arranged.read(rows, now)            # the display, drawn to its end
    arranged.key(key, now)              # before a key goes down
    arranged.booted(handed_over, now)   # raises Broken if the list is another one than was kept
    arranged.look(now)                  # after every slice: raises Broken if it is not kept
    arranged.order, arranged.repeats    # as the panel has them
    arranged.turns()                    # so many telegrams are a round
"""

import json

from tools.soaking.judging.facts import ALWAYS, CHOSEN_US, MENU, NEVER, RUN, ZSW_RUNNING, S
from tools.soaking.judging.kept_sets import SETTINGS_FILE
from tools.soaking.judging.rules import Broken

ORDER, TURNS, CARRIES = "ORDER", "TURNS", "SET=KEEP"  # row 1
LISTS = (MENU + ORDER, MENU + TURNS)
CARRIED, TIMES = "UP DOWN", "x"  # behind the address
ENDS = ("SET", "PARAM")
PLACE = 11  # the column of row 1 where a list has its place
REFUSALS = ("STOP ALL FIRST", "NO: STILL CHECKS", "SHORT")
ANEW_US = 5 * S  # until the panel has begun anew; and a round of OFF
NEAR_US = 10 * S  # somebody may be in one of these lists, so long after he was seen there
RESTS_US = 2 * S  # the panel knows that a motor has come to rest


class Arranged:
    def __init__(self, witness):
        self._witness = witness
        self.order, self.repeats = self._stored()
        self._carried = None  # the order on the display; None: nobody has read it
        self._is_sure = False  # that is the whole of it,
        self._is_missed = False  # unless one was put down where nobody has read that
        self._taken = None  # address and turns on the display, while SET would keep them
        self._read_us = self._near_us = NEVER
        self._wanted = None  # (order, repeats) that SET or PARAM has kept,
        self._wanted_us = ALWAYS

    def turns(self):
        return sum([self.repeats.get(str(address), 1) for address in self.order])

    def _stored(self):
        stored = json.loads(self._witness.world.flash.files[SETTINGS_FILE])
        return list(stored.get("drives", [1])), stored.get("repeats", {})

    # --- what the display says ------------------------------------------------------------------

    def read(self, rows, now):
        row_1, words = rows[0].rstrip(), rows[1].rstrip()
        if words.endswith(REFUSALS):
            self._wanted_us = ALWAYS
        if words in LISTS:
            self._carried = self._taken = None
            self._is_missed = False
            self._near_us = now
        address = address_of(words)
        if address is None:
            return
        place, what = place_in(row_1), words.partition(" ")[2].strip()
        if what == CARRIED:
            self._carry(address, place if row_1.startswith(CARRIES) else None)
        elif what.startswith(TIMES) and what[1:].isdigit():
            self._is_sure = row_1.startswith((CARRIES, TURNS))  # else something is announced
            is_taken = row_1.startswith(CARRIES)
            self._taken = (address, int(what[1:])) if is_taken else None
        elif row_1.startswith(ORDER) and place is not None and not what:
            if self._carried is None:
                self._carried, self._is_sure = list(self.order), True
        else:
            return
        self._read_us = self._near_us = now

    def _carry(self, address, place):
        if self._carried is None:
            self._carried = list(self.order)
        self._is_sure = address in self._carried and place in range(1, len(self._carried) + 1)
        if self._is_sure:
            self._carried.remove(address)
            self._carried.insert(place - 1, address)

    # --- keys -----------------------------------------------------------------------------------

    def key(self, key, now):
        if key not in ENDS or now - self._near_us > NEAR_US:
            return
        is_unread = not self._is_sure or not self._is_read(key, now)
        if key == "SET" and self._carried is not None:  # it takes one up, or puts it down
            self._is_missed = self._is_missed or is_unread
        elif is_unread or self._is_missed:
            self._want(None, None, now)
        elif key == "PARAM" and self._carried is not None:
            self._want(self._carried, self.repeats, now)
        elif key == "SET" and self._taken is not None:
            address, times = self._taken
            repeats = dict(self.repeats)
            repeats.pop(str(address), None)
            if times > 1:
                repeats[str(address)] = times
            self._want(self.order, repeats, now)
        if key == "PARAM":
            self._carried = self._taken = None

    def _is_read(self, key, now):
        """Whether the display has shown what this key is for, since another one has moved."""
        witness = self._witness
        moved_us = [at_us for name, at_us in witness.pressed_us.items() if name != key]
        moved_us = max(moved_us + list(witness.up.values()))
        return now - self._read_us < CHOSEN_US and self._read_us - moved_us > witness.seen_us // 2

    def _want(self, order, repeats, now):
        """order: None: it is not known which."""
        if (order, repeats) == (self.order, self.repeats):
            return
        if order is None and self._wanted_us != ALWAYS:
            return  # it begins anew already
        self._wanted = order, repeats
        self._wanted_us = now if order is not None and self._is_quiet(now) else ALWAYS

    def _is_quiet(self, now):
        """Whether nothing speaks against it: every drive is heard, and none runs."""
        witness = self._witness
        befell_us = max(witness.stalled_us, witness.boot_us, witness.pulled_us)
        for address in witness.plan.listed:
            case = witness.cases[address]
            since_us = max(case.turned_us, case.ran_us, befell_us)
            if case.stw & RUN or case.zsw & ZSW_RUNNING or now - since_us < RESTS_US:
                return False
            if now - case.answered_us > S + 2 * witness.cycle_us:
                return False
        return witness.hung_us is None and len(witness.down) == 1

    # --- what comes of it -----------------------------------------------------------------------

    def look(self, now):
        witness = self._witness
        if now - self._wanted_us < ANEW_US + 4 * witness.cycle_us:
            return
        since_us, self._wanted_us = self._wanted_us, ALWAYS
        befell_us = max(witness.stalled_us, witness.boot_us, witness.pulled_us)
        if befell_us < since_us and witness.hung_us is None:
            raise Broken("LIST", "%s, %s kept at %d, and nothing" % (self._wanted + (since_us,)))

    def booted(self, handed_over):
        """The panel starts with what its flash has."""
        before, before_repeats = self.order, self.repeats
        self.order, self.repeats = self._stored()
        wanted, self._wanted = self._wanted, None
        is_due, self._wanted_us = self._wanted_us != ALWAYS and handed_over, ALWAYS
        self._carried = self._taken = None
        if sorted(before) != sorted(self.order):
            return  # drives have come or gone
        is_new = (self.order, self.repeats) != (before, before_repeats)
        if wanted is not None and wanted[0] is None:
            return  # nobody has read what it is
        if is_new and (self.order, self.repeats) != wanted:
            raise Broken("LIST", "%s, %s, and nobody kept that" % (self.order, self.repeats))
        if is_due and not is_new:
            raise Broken("LIST", "%s, %s was kept, and is not there" % wanted)


def address_of(words):
    """The address that row 2 of a list begins with, or None."""
    name = words[len(MENU) :].partition(" ")[0]
    if not words.startswith(MENU + "A") or not name[1:].isdigit():
        return None
    return int(name[1:])


def place_in(row_1):
    """The place in the list that row 1 has, or None."""
    place, slash, count = row_1[PLACE:].strip().partition("/")
    return int(place) if slash and place.isdigit() and count.isdigit() else None
