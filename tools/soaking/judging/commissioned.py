# SPDX-License-Identifier: MIT
"""Commissioning at the panel: a step is written when SET has said so, while the motor stands.

P0304*      7/23    >000[4]00       SET writes what is typed, unless another question follows
P0700       9/12    >5 SET=YES      SET writes that
P2000       8/12    >RESCALES SPEED in turn with >50.00 SET=YES

In use:

    commissioned = Commissioned(witness)
    commissioned.read(rows, now)            # the display, after every slice, drawn to its end
    commissioned.key(key, now)              # before a key goes down
    commissioned.is_open(now)               # a step is on the display, and nothing else may write
    commissioned.has_asked(address, number, bits, is_dangerous, now)    # SET has said so
"""

import struct

from tools.soaking.judging.case import drive_at
from tools.soaking.judging.facts import CHOSEN_US, MENU, NEVER, RUN, ZSW_RUNNING, S

YES, RESCALES = " SET=YES", MENU + "RESCALES SPEED"
SEEN_US = 2 * S  # a question that has two texts shows each of them by then
RUNS_US = 1 * S  # the panel knows that a motor runs
NUMERIC = "+-.0123456789"
HALF_DIGIT = 0.51  # of the last one that is shown


class Commissioned:
    def __init__(self, witness):
        self._witness = witness
        self._open_us = NEVER  # a step was read last
        self._offer = None  # (number, what is shown of the value, whether that is a question)
        self._last = None  # likewise; SET does not end it
        self._row_2 = ""  # as read last with a step above it
        self._offered_us = NEVER
        self._said = []  # (until when, address or None) + offer
        self._other_us = NEVER  # SET was pressed last outside the menu: that may write as well

    def read(self, rows, now):
        number, row_2 = step_in(rows), rows[1].rstrip()
        if number is None:  # row 1 may announce something meanwhile
            if self._offer is not None and row_2 == self._row_2:
                self._offered_us = now
            elif is_typed(row_2) and self._last is not None and now - self._open_us < S:
                self._row_2 = row_2  # it was announced while a digit was being changed
                self._offer_value(self._last[0], typed_in(row_2), False, now)
            return
        self._row_2 = row_2
        self._open_us = now
        if row_2.endswith(YES):
            self._offer_value(number, row_2[len(MENU) : -len(YES)], True, now)
        elif is_typed(row_2):
            self._offer_value(number, typed_in(row_2), False, now)
        elif row_2 == RESCALES:  # of what was just typed, or in turn with the value
            if self._last is not None and self._last[0] == number:
                if now - self._offered_us < SEEN_US:
                    self._offer_value(number, self._last[1], True, now)
        else:
            self._offer = None

    def _offer_value(self, number, text, is_question, now):
        self._offer = self._last = (number, text, is_question)
        self._offered_us = now

    def key(self, key, now):
        if key != "SET":
            return
        witness = self._witness
        if not witness.is_in_menu():
            self._other_us = now
        elif self._offer is not None and now - self._offered_us < CHOSEN_US:
            if not self._runs(now):
                self._said = [row for row in self._said if row[0] > now]
                self._said.append((now + witness.wish_us, witness.shown) + self._offer)
            self._offer = None

    def _runs(self, now):
        """Whether the drive runs, as far as it is known which one that is: SET is refused."""
        witness = self._witness
        if witness.shown is None:
            return False
        case = witness.cases[witness.shown]
        return case.stw & RUN and case.zsw & ZSW_RUNNING and now - case.on_us > RUNS_US

    def is_open(self, now):
        return now - self._open_us < S and now - self._other_us > self._witness.wish_us

    def has_asked(self, address, number, bits, is_dangerous, now):
        """Whether SET has said yes to this value. To type one is enough where it does no harm, or
        where the drive has it already.
        """
        for until_us, shown, asked, text, is_question in self._said:
            if until_us > now and shown in (None, address) and asked == number:
                is_enough = is_question or not is_dangerous or self._has(address, number, text)
                if is_enough and shows(text, bits):
                    return True
        return False

    def _has(self, address, number, text):
        drive = drive_at(self._witness.world, address)
        try:
            return drive is None or _reads(text, drive.read(number))
        except KeyError:
            return False


def is_typed(row_2):
    return row_2.startswith(MENU) and "[" in row_2 and "]" in row_2


def typed_in(row_2):
    return row_2[len(MENU) :].replace("[", "").replace("]", "")


def step_in(rows):
    """The number of the step of a procedure that row 1 names, or None."""
    row_1, row_2 = rows
    label = row_1[:11].rstrip().rstrip("*")
    if not row_2.startswith(MENU) or label[:1] != "P" or len(label) != 5:
        return None
    return int(label[1:]) if label[1:].isdigit() else None


def shows(text, bits):
    """Whether this is what the display shows of 16 or 32 bits: as a whole number, with or without
    a sign, in hexadecimal, or as a floating-point number. What is no number may be any."""
    if text[-1:] == "h" or ":" in text or not text[:1] or text[0] not in NUMERIC:
        return True
    (real,) = struct.unpack("<f", struct.pack("<I", bits))
    wholes = [bits - (1 << width) for width in (16, 32) if bits >> width - 1 == 1]
    return any([_reads(text, value) for value in [bits, real] + wholes])


def _reads(text, value):
    digits = text
    while digits and digits[-1] not in NUMERIC:
        digits = digits[:-1]
    try:
        shown = float(digits)
    except ValueError:
        return False
    decimals = len(digits.partition(".")[2])
    return abs(shown - value) <= HALF_DIGIT / 10**decimals + abs(value) / 1_000_000
