# SPDX-License-Identifier: MIT
"""The list of events, compared with what has happened: a fault stands there with the instant at
which that drive had one, STOP KEY with that of a STOP.

A3 5:12       1/7       the drive, and how long ago: 5 min 12 s
>FAULT F0001

In use:

    happened = Happened(witness)
    happened.read(rows, now)            # the display, after every slice, drawn to its end
    happened.key(key, now)              # before a key goes down
    happened.reply(address, zsw, now)   # each reply
"""

from tools.soaking.judging.facts import MENU, ZSW_FAULT, S
from tools.soaking.judging.rules import Broken

FAULT, STOPPED = MENU + "FAULT ", MENU + "STOP KEY"
EARLY_US = 2 * S  # ages are in whole seconds, and a picture is behind
LATE_US = 3 * S  # and what has happened is known when the drive has told its number
STALLED_US = 2 * S  # after a standstill of the loop the picture is old
HELD_US = 6 * S  # the longest press
KEPT = 100


class Happened:
    def __init__(self, witness):
        self._witness = witness
        self._faults = {}  # address -> [since, until, whether it goes on] of each time it had one
        self._stops = []  # when that key went down

    def reply(self, address, zsw, now):
        times = self._faults.setdefault(address, [])
        is_open = times and times[-1][2]
        if zsw & ZSW_FAULT:
            if not is_open:
                times.append([now, now, True])
            times[-1][1] = now
        elif is_open:
            times[-1][1], times[-1][2] = now, False

    def key(self, key, now):
        if key == "STOP":
            self._stops.append(now)
            del self._stops[:-KEPT]

    def read(self, rows, now):
        told, witness = event_in(rows), self._witness
        if told is None or witness.hung_us is not None or now - witness.stalled_us < STALLED_US:
            return
        address, age_s, is_fault = told
        at_us, late_us = now - age_s * S, LATE_US + 4 * witness.cycle_us
        if at_us < witness.boot_us - EARLY_US:
            raise Broken("SHOWN", "%s, and the panel started later" % rows[0])
        if is_fault:
            for since_us, until_us, _ in self._faults.get(address, ()):
                if since_us - EARLY_US < at_us < until_us + late_us:
                    return
        elif self._is_stop(at_us):
            return
        raise Broken("SHOWN", "%s: %s, and nothing of the kind" % rows)

    def _is_stop(self, at_us):
        """Whether STOP was down then."""
        if self._witness.down.get("STOP", at_us + EARLY_US) - EARLY_US < at_us:
            return True
        for since_us in self._stops:
            if since_us - EARLY_US < at_us < since_us + LATE_US + HELD_US:
                return True
        return False


def event_in(rows):
    """Address, age in seconds, and whether it is a fault (else a STOP), of an event; or None."""
    words, row_2 = rows[0].split(), rows[1].rstrip()
    if len(words) < 2 or words[0][:1] != "A" or not words[0][1:].isdigit():
        return None
    minutes, colon, seconds = words[1].partition(":")
    if not (colon and minutes.isdigit() and len(seconds) == 2 and seconds.isdigit()):
        return None
    if not row_2.startswith(FAULT) and row_2 != STOPPED:
        return None
    return int(words[0][1:]), 60 * int(minutes) + int(seconds), row_2 != STOPPED
