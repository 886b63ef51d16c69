# SPDX-License-Identifier: MIT
"""An eye on the display: it compares what the display says, and does not say, with the drives.

In use:

    reader = Reader(world, plan, witness)
    reader.look()                   # after every slice: raises Broken
    reader.screens                  # the last pictures, (instant, row 1, row 2)
"""

from tools.soaking.judging.announced import Announced, is_looked_up, is_parameter, said_in
from tools.soaking.judging.case import drive_at
from tools.soaking.judging.drive_settings import magnitude, scalings
from tools.soaking.judging.facts import (
    ALWAYS,
    CHOICES,
    DRAWN_STEPS,
    LEAVES,
    MENU,
    MS,
    NEVER,
    NOT_USS,
    ON_BIT,
    QUESTIONS,
    RISKS,
    RUNS_ON,
    TYPED,
    UNTOLD,
    ZSW_FAULT,
    ZSW_RUNNING,
    ZSW_WARNING,
    S,
)
from tools.soaking.judging.looked_up import address_above, is_wrong, label_in
from tools.soaking.judging.rules import Broken

SCREENS = 12
QUIET_US = 60 * MS
COVERED_US = 3_500 * MS  # what a STOP does covers a row of the menu, and so long after
EXPOSED_US = 6 * S
PRESENT = 2  # of r2110: so many of its warnings are present, the others are gone
WARNED_US = 5_500 * MS
STATES = (  # what row 2 begins with, the state of the drive
    ("READY", "ready"), ("RUNNING", "running"), ("STOPPING", "stopping"), ("FAULT", "fault"),
    ("INHIBITED", "inhibited"),
)  # fmt: skip
DOINGS = (  # what only a drive in contact reads
    ("STARTING",), ("JOG",), ("LOCAL",), ("RUNS",), ("CHECKING",), ("NOT READY",), ("RUN,",),
    ("BELOW P",), ("P2014 LONG",), ("P0093 LONG",), ("P2040 LONG",),
)  # fmt: skip
EXPOSED = ("RUN, P", "LONG")  # texts about a P2014 that has become longer, of any family
MAY_RUN = ("NO CONTACT,", "UNCONFIRMED", "PANEL STOPPED", "USS PANEL")


class Reader:
    """screens: the last pictures, oldest first. rows: the present one. address: that row 2 shows,
    or None. looks_up: the page of any parameter is shown, or a message hides it; label: of
    the last one that was seen there, ("P2155", index or None)."""

    def __init__(self, world, plan, witness):
        self.world = world
        self.plan = plan
        self.witness = witness
        self.screens = []
        self.rows = ("", "")
        self.address = None
        self.announced = Announced(plan, witness, self)
        self.steady = False  # row 2 is drawn to its end
        self._drawn_us = DRAWN_STEPS * plan.loop_us
        self._changed_us = 0  # row 2 was another one until then
        self._written_us = 0  # when the controller was last seen to have been written to
        self._written = -1
        self._judged_us = 0
        self._exposed_us = 0  # that its P2014 is longer by now was said, or could not be
        self._warned_us = NEVER  # a warning of the drive shown was read last
        self._unwarned_us = 0  # it had none, or something else was to be seen
        self.looks_up = False
        self.label = None
        self._rows_us = 0  # the picture was another one until then
        self._types = False  # row 2 has digits that are typed in, or a message hides them
        self._subject = None  # of a question, as read last
        self._is_untold = False  # the question on the display is about a P2014 that nobody reads
        self._hz = None  # of the drive shown, then; None: that was too long ago
        self._state = None  # of the drive shown,
        self._state_us = 0  # and since when: the display may be a picture behind
        self._unconfirmed_us = 0  # when that was read last

    def look(self):
        lcd = self.world.lcd_chip
        now = self.world.clock.now_us
        written = lcd.characters + lcd.instructions
        if written != self._written:
            self._written = written
            self._read(lcd.text(), now)
            self._written_us = now
        self.steady = now - self._changed_us > self._drawn_us
        if self.reads("BUS ERROR"):
            raise Broken("EXCEPTION", "the display says BUS ERROR at %d" % now)
        if self.steady and now > self.witness.unsure_us:
            if self.address is not None:
                self.witness.shows(self.address)
        self.announced.look(now)
        witness = self.witness
        if self.reads(NOT_USS):
            witness.refused_us = now
        self._note_menu(now)
        self._note_page(now)
        is_drawn = now - self._rows_us > self._drawn_us
        witness.line.read(self.rows, is_drawn, now)
        # What counts is drawn again and again: nothing was written for two slices.
        is_quiet = now - self._written_us > QUIET_US
        witness.diagnosed.read(self.rows, is_drawn or is_quiet, now)
        if is_drawn:
            witness.sets.read(self.rows, now)
            witness.commissioned.read(self.rows, now)
            witness.happened.read(self.rows, now)
            witness.locked.read(self.rows, now)
            witness.arranged.read(self.rows, now)
        witness.locked.look(now)
        witness.arranged.look(now)
        self._note_digits(now)
        if self.rows[1] in QUESTIONS and self.rows[0].strip() in LEAVES:
            witness.leaves_us = now
            witness.question = None
        elif self.rows[1] in QUESTIONS:
            self._read_question(now)
        else:
            witness.question = None
        self._is_untold = self.rows[1] == RISKS and (
            self._is_untold or self.rows[0].strip() in UNTOLD
        )
        if self._is_untold:
            witness.go_us = now
        if witness.shown is None or now < witness.unsure_us or witness.hung_us is not None:
            self._unwarned_us = self._exposed_us = now
            return
        if not self.steady or now == self._written_us:
            return
        case = witness.cases[witness.shown]
        drive = self.drive_at(witness.shown)
        if drive is not None and drive.state != self._state:
            self._state = drive.state
            self._state_us = now
        self._judge_lost(case, now)
        self._judge_unconfirmed(case, now)
        self._judge_warning(case, now)
        self._judge_exposed(case, now)
        calm_us = 3 * S + 12 * witness.cycle_us
        if now - witness.stirred_us > calm_us and now - self._judged_us > S:
            if not witness.down and now - witness.late_us > calm_us:
                if now - self._judged_us > 2 * S:
                    self._hz = None
                self._judged_us = now
                self._judge_shown(now)

    def _read(self, rows, now):
        if rows[1] != self.rows[1]:
            self._changed_us = now
            self.address = address_in(rows[1])
        if rows != self.rows:
            self.rows = rows
            self._rows_us = now
            if len(self.screens) >= SCREENS:
                del self.screens[0]
            self.screens.append((now, rows[0], rows[1]))

    def _note_menu(self, now):
        witness = self.witness
        if self.rows[1].startswith(MENU):
            witness.sees_menu()
            witness.named = addresses_in(self.rows)
        elif self.steady and "STOP" not in witness.down:
            if now - witness.up["STOP"] > COVERED_US or self.address is not None:
                witness.menu_since_us = ALWAYS

    def _note_page(self, now):
        """The page of any parameter, whose row 1 has the address now and then."""
        witness, row_2 = self.witness, self.rows[1]
        if is_looked_up(self.rows):
            self.looks_up = True
            self.label = label_in(self.rows) or self.label
            address = address_above(self.rows)
            if address is not None and now > witness.unsure_us + self._drawn_us:
                if now - self._rows_us > self._drawn_us:
                    witness.shows(address)
        elif row_2.startswith(MENU) or self.steady and self.address is not None:
            self.looks_up = False
        elif now - witness.boot_us < S:
            self.looks_up = False

    def _note_digits(self, now):
        row_2 = self.rows[1]
        if row_2.startswith(TYPED) and not self.looks_up:
            self._types = True
        elif self.steady and self.address is not None or row_2.startswith(MENU):
            self._types = False
        if self._types:
            self.witness.typed_us = now

    def _read_question(self, now):
        witness = self.witness
        if self.rows[1] == RUNS_ON:
            witness.go_us = now
        witness.asked_us = now
        subject = subject_in(self.rows[0])
        if subject is not None and subject == self._subject:  # drawn to its end
            witness.question = subject
        self._subject = subject

    def reads(self, text):
        row_1, row_2 = self.rows
        return text in row_1 or text in row_2

    def _judge_lost(self, case, now):
        witness = self.witness
        address = witness.shown
        silent_us = witness.silent_us(case, now)
        if not witness.is_lost(case, now):
            return
        if now - witness.stalled_us < S or now - witness.unsure_us < S:
            return
        if now < witness.wishes.get("write", NEVER):
            return  # it may be on its way to another address
        row_1, row_2 = self.rows
        if row_1[8:10] == "F:" and row_1[15:].isdigit() and address_in(row_2) == address:
            raise Broken("MAY RUN", "drive %d is silent for %d ms" % (address, silent_us // MS))
        for text in STATES + DOINGS:
            if row_2.startswith(text[0]) and address_in(row_2) == address:
                raise Broken("MAY RUN", "%s, silent for %d ms" % (row_2, silent_us // MS))
        if not self._may_run(case) or case.heard_us < witness.boot_us:
            return
        if case.acknowledge_us > case.answered_us or "STOP" in witness.down:
            return
        if witness.is_in_menu():
            return  # row 1 says it in turn with the name of the list: `Announced` waits for that
        for text in MAY_RUN:
            if self.reads(text):
                return
        raise Broken("MAY RUN", "drive %d, silent for %d ms" % (address, silent_us // MS))

    def _judge_warning(self, case, now):
        """The number of a warning is shown in turn with the state, standing and running."""
        row_2 = self.rows[1]
        drive = self.drive_at(self.witness.shown)
        if drive is None or not self.is_able(self.witness.shown):
            self._unwarned_us = now
            return
        sight, present = self.witness.sight_of(self.witness.shown), ()
        if sight.reads_words and sight.family.warnings:
            present = [drive.read(sight.family.warnings, index) for index in range(PRESENT)]
        for number in present:
            if number and row_2.startswith("WARN A%04d" % number):
                self._warned_us = now
        if not any(present) and row_2.startswith("WARN  "):
            self._warned_us = now  # the drive has no number for it
        hidden = is_parameter(row_2) or row_2 in CHOICES or self.reads("STOP UNCONFIRMED")
        hidden = hidden or "STOP" in self.witness.down  # row 2 tells what that does
        hidden = hidden or self._types
        hidden = hidden or address_in(row_2) is None and said_in(row_2) is None  # a message
        lost = now - case.answered_us > self.witness.lost_us // 2
        if hidden or lost or not case.zsw & ZSW_WARNING or case.zsw & ZSW_FAULT:
            self._unwarned_us = now
        waited_us = now - max(self._unwarned_us, self._warned_us, self.witness.stirred_us)
        patience_us = WARNED_US + 4 * self.witness.cycle_us
        if waited_us > patience_us and now - self.witness.late_us > waited_us:
            raise Broken("SHOWN", "a warning of drive %d is not shown" % self.witness.shown)

    def _judge_exposed(self, case, now):
        """A P2014 that has become longer while the drive runs is said in place of RUNNING, which
        takes turns with announcements and warnings."""
        witness = self.witness
        row_2 = self.rows[1]
        hides = row_2.startswith(("RUNNING", "WARN")) or said_in(row_2)
        if not hides or self.reads(EXPOSED[0]) or self.reads(EXPOSED[1]):
            self._exposed_us = now
        elif not witness.is_more_exposed(witness.shown, case):
            self._exposed_us = now
        elif now - self._exposed_us > EXPOSED_US + 2 * witness.cycle_us:
            raise Broken("SHOWN", "%s, and P2014 has become longer" % row_2)

    def _may_run(self, case):
        """Whether it ran by its last reply, or had been told to before."""
        return case.zsw & ZSW_RUNNING and case.ran_us == case.answered_us

    def _judge_unconfirmed(self, case, now):
        witness = self.witness
        address = witness.shown
        stop_us = case.stop_us
        if tells_unconfirmed(self.rows, address):
            self._unconfirmed_us = now
            return
        if case.answered_us >= stop_us - 100 * MS or stop_us < witness.boot_us:
            return
        if not case.zsw & ZSW_RUNNING and case.turned_us < case.answered_us > witness.boot_us:
            return  # heard at rest since the last ON
        patience_us = 5_800 * MS if case.brakes else 3_800 * MS
        if now - stop_us < patience_us + witness.exchange_us or now - witness.stalled_us < S:
            return
        if witness.stuck_us is not None:
            return
        if max(witness.up.values()) > stop_us + 400 * MS and witness.up["STOP"] != max(
            witness.up.values()
        ):
            self._unconfirmed_us = now  # another key was pressed since
            return
        if witness.down and list(witness.down) != ["STOP"]:
            return
        if case.start_us > stop_us:
            return
        if now - self._unconfirmed_us > 2 * S:  # it may take turns with other drives
            since_ms = (now - stop_us) // MS
            raise Broken("UNCONFIRMED", "STOP of drive %d, %d ms ago" % (address, since_ms))

    def _judge_shown(self, now):
        """Check the display after a while in which nothing was done."""
        witness = self.witness
        address = witness.shown
        drive = self.drive_at(address)
        if drive is None or not self.is_able(address):
            return
        row_1, row_2 = self.rows
        if self.reads("STOP UNCONFIRMED") and drive.state in ("ready", "fault", "inhibited"):
            answered_us = witness.cases[address].answered_us
            if self.world.clock.now_us - answered_us < S + witness.cycle_us:
                raise Broken("UNCONFIRMED", "drive %d stands, and says so" % address)
        if self.looks_up and is_wrong(self.rows, drive):
            raise Broken("SHOWN", "%s, of drive %d" % (row_2, address))
        hz, before_hz = drive.hz(), self._hz
        self._hz = hz
        if address_in(row_2) != address:
            return
        if row_2[0] == "P" and row_2[5] == ":" and row_2[6:12].strip().isdigit():
            value = witness.kinds[address].family.read(drive, int(row_2[1:5]))
            if int(row_2[6:12]) != value and row_2[12] == " ":
                raise Broken("SHOWN", "%s and it is %s" % (row_2, value))
        for text, state in STATES:
            if row_2.startswith(text):
                if drive.state != state and now - self._state_us > S:
                    raise Broken("SHOWN", "drive %d is %s" % (address, drive.state))
                break
        case = witness.cases[address]
        meant = witness.meant(address)
        if row_1[:2] == "S:" and row_1[8:10] == "F:" and meant:
            if (row_1[7] == "%") not in [values.is_percent for values in meant]:
                raise Broken("SHOWN", "%s, PKW words %d" % (row_1, drive.layout[0]))
        if row_1[:2] == "S:" and case.stw & ON_BIT:
            shown = row_1[2:7].strip()
            if shown[-1:].isdigit() and not shown.startswith("- "):
                self._judge_setpoint(case, float(shown), meant)
        shown = row_1[10:].strip()
        is_steady = before_hz == hz and len({values.meaning() for values in meant}) == 1
        if row_1[8:10] == "F:" and shown[-1:].isdigit() and is_steady:
            values = meant[0]
            told_hz = hz * values.reference_hz / values.full_hz
            is_judged = values.shows_speed or not values.tells_speed
            if is_judged and abs(float(shown) - told_hz) > 0.06:
                told = (row_1, address, hz, told_hz)
                raise Broken("SHOWN", "%s, drive %d turns at %.2f Hz, that is %.2f" % told)

    def _judge_setpoint(self, case, shown_hz, meant):
        """Check that it is the one sent, by the scaling that the panel could last read."""
        kind = self.witness.kinds[self.witness.shown]
        is_left = case.stw == kind.family.reverse or case.hsw & 0x8000
        sign = -1 if is_left else 1
        sent_hz = [sign * scaling.hz(magnitude(case.hsw)) for scaling in scalings(meant)]
        if sent_hz and not [hz for hz in sent_hz if abs(shown_hz - hz) <= 0.06 + abs(hz) / 0x2000]:
            raise Broken("SHOWN", "%s, %.2f are sent" % (self.rows[0], sent_hz[-1]))

    def drive_at(self, address):
        return drive_at(self.world, address)

    def is_able(self, address):
        """Whether the drive there is one that this panel can control."""
        return self.witness.is_able(address)


def tells_unconfirmed(rows, address):
    """Whether the display has the alarm of the drive shown; the menu has it in row 1, in turn."""
    return "STOP UNCONFIRMED" in rows or rows[0].startswith("A%d NOT STOPPED" % address)


def subject_in(row_1):
    """Address, number and value of a question that begins "A1: P0700=6", or None."""
    words = row_1.strip().split(": P")
    if len(words) != 2 or words[0][:1] != "A" or words[1][4:5] != "=":
        return None
    texts = words[0][1:], words[1][:4], words[1][5:]
    for text in texts:
        if not text.isdigit():
            return None
    return tuple(int(text) for text in texts)


def addresses_in(rows):
    """All that the menu names: A3, wherever."""
    words = " ".join(rows).replace(MENU, " ").replace(":", " ").split()
    return [int(word[1:]) for word in words if word[:1] == "A" and word[1:].isdigit()]


def address_in(row_2):
    """The address that row 2 shows, None when something else stands there."""
    if len(row_2) < 16 or row_2[0] == MENU or row_2[13] != "A" or not row_2[14].isdigit():
        return None
    if row_2[15] != " " and not row_2[15].isdigit():
        return None
    return int(row_2[14:].strip())
