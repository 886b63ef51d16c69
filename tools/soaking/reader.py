# SPDX-License-Identifier: MIT
"""An eye on the display: what it must say, and what it must not, held against the drives.

    reader = Reader(world, plan, judge)
    reader.look()                   # after every slice: raises Broken
    reader.screens                  # the last pictures, (instant, row 1, row 2)
"""

from tools.soaking.case import drive_at, limits_of
from tools.soaking.facts import (
    CONTROLLED,
    MS,
    NEVER,
    ON,
    ON_REVERSE,
    QUESTIONS,
    ZSW_RUNNING,
    S,
)
from tools.soaking.rules import Broken

SCREENS = 12
DRAWN_US = 100 * MS  # a row that is the same for so long is drawn to its end
VALUES = ("P0700:", "P1000:", "P2011:")
STATES = (  # what row 2 begins with, the state of the drive
    ("READY", "ready"), ("RUNNING", "running"), ("STOPPING", "stopping"), ("FAULT", "fault"),
    ("INHIBITED", "inhibited"),
)  # fmt: skip
DOINGS = (("STARTING",), ("JOG",), ("LOCAL",), ("RUNS",))  # what only a drive in contact reads
MAY_RUN = ("NO CONTACT,", "UNCONFIRMED", "PANEL STOPPED", "USS PANEL")


class Reader:
    """screens: the last pictures, oldest first. rows: the present one."""

    def __init__(self, world, plan, judge):
        self.world = world
        self.plan = plan
        self.judge = judge
        self.screens = []
        self.rows = ("", "")
        self.steady = False  # row 2 is drawn to its end
        self._changed_us = 0  # row 2 was another one until then
        self._written_us = 0  # when the controller was last seen to have been written to
        self._written = -1
        self._calm_us = 3 * S + 12 * judge.cycle_us
        self._judged_us = 0
        self._subject = None  # of a question, as read last
        self._hz = None  # of the drive shown, then; None: that was too long ago

    def look(self):
        lcd = self.world.lcd_chip
        now = self.world.clock.now_us
        written = lcd.characters + lcd.instructions
        if written != self._written:
            self._written = written
            self._read(lcd.text(), now)
            self._written_us = now
        self.steady = now - self._changed_us > DRAWN_US
        if self.steady and now > self.judge.unsure_us:
            address = address_in(self.rows[1])
            if address is not None:
                self.judge.shown = address
        judge = self.judge
        if self.rows[1] in QUESTIONS:
            self._read_question(now)
        else:
            judge.question = None
        if judge.shown is None or now < judge.unsure_us or judge.hung_us is not None:
            return
        if not self.steady or now == self._written_us:
            return
        case = judge.cases[judge.shown]
        self._judge_lost(case, now)
        self._judge_unconfirmed(case, now)
        if now - judge.stirred_us > self._calm_us and now - self._judged_us > S:
            if not judge.down and now - judge.late_us > self._calm_us:
                if now - self._judged_us > 2 * S:
                    self._hz = None
                self._judged_us = now
                self._judge_shown()

    def _read(self, rows, now):
        if rows[1] != self.rows[1]:
            self._changed_us = now
        if rows != self.rows:
            self.rows = rows
            if len(self.screens) >= SCREENS:
                del self.screens[0]
            self.screens.append((now, rows[0], rows[1]))

    def _read_question(self, now):
        judge = self.judge
        if self.rows[1] == QUESTIONS[1]:
            judge.go_us = now
        judge.asked_us = now
        subject = subject_in(self.rows[0])
        if subject is not None and subject == self._subject:  # drawn to its end
            judge.question = subject
        self._subject = subject

    def reads(self, text):
        row_1, row_2 = self.rows
        return text in row_1 or text in row_2

    def _judge_lost(self, case, now):
        judge = self.judge
        address = judge.shown
        silent_us = now - max(case.answered_us, judge.boot_us, judge.tape.blurred_us)
        if silent_us < judge.lost_us + 700 * MS + 2 * judge.cycle_us:
            return
        if now - judge.stalled_us < S or now - judge.unsure_us < S:
            return
        if now < judge.wishes.get("write", NEVER):
            return  # it may be on its way to another address
        row_1, row_2 = self.rows
        if row_1[7:10] == " F:" and row_1[15:].isdigit() and address_in(row_2) == address:
            raise Broken("MAY RUN", "drive %d is silent for %d ms" % (address, silent_us // MS))
        for text in STATES + DOINGS:
            if row_2.startswith(text[0]) and address_in(row_2) == address:
                raise Broken("MAY RUN", "%s, silent for %d ms" % (row_2, silent_us // MS))
        if not self._may_run(case) or case.answered_us < judge.boot_us:
            return
        if case.acknowledge_us > case.answered_us or "STOP" in judge.down:
            return
        for text in MAY_RUN:
            if self.reads(text):
                return
        raise Broken("MAY RUN", "drive %d, silent for %d ms" % (address, silent_us // MS))

    def _may_run(self, case):
        """Whether it ran by its last reply, or had been told to before."""
        return case.zsw & ZSW_RUNNING and case.ran_us == case.answered_us

    def _judge_unconfirmed(self, case, now):
        judge = self.judge
        address = judge.shown
        stop_us = case.stop_us
        if case.answered_us >= stop_us - 100 * MS or stop_us < judge.boot_us:
            return
        patience_us = 3_800 * MS if case.brakes else 1_800 * MS
        if now - stop_us < patience_us + judge.exchange_us or now - judge.stalled_us < S:
            return
        if judge.stuck_us is not None:
            return
        if max(judge.up.values()) > stop_us + 400 * MS and judge.up["STOP"] != max(
            judge.up.values()
        ):
            return  # another key was pressed since
        if judge.down and list(judge.down) != ["STOP"]:
            return
        if case.start_us > stop_us:
            return
        if not self.reads("STOP UNCONFIRMED"):
            since_ms = (now - stop_us) // MS
            raise Broken("UNCONFIRMED", "STOP of drive %d, %d ms ago" % (address, since_ms))

    def _judge_shown(self):
        """Nothing was done for a while: is the display right?"""
        address = self.judge.shown
        drive = self.drive_at(address)
        if drive is None or not self.is_able(address):
            return
        row_1, row_2 = self.rows
        if self.reads("STOP UNCONFIRMED") and drive.state in ("ready", "fault", "inhibited"):
            answered_us = self.judge.cases[address].answered_us
            if self.world.clock.now_us - answered_us < S + self.judge.cycle_us:
                raise Broken("UNCONFIRMED", "drive %d stands, and says so" % address)
        hz, before_hz = drive.hz(), self._hz
        self._hz = hz
        if address_in(row_2) != address:
            return
        if row_2[:6] in VALUES and row_2[6:12].strip().isdigit():
            number = int(row_2[1:5])
            if number != 2024 and int(row_2[6:12]) != drive.read(number) and row_2[12] == " ":
                raise Broken("SHOWN", "%s and it is %s" % (row_2, drive.read(number)))
        for text, state in STATES:
            if row_2.startswith(text):
                if drive.state != state:
                    raise Broken("SHOWN", "drive %d is %s" % (address, drive.state))
                break
        case = self.judge.cases[address]
        if row_1[:2] == "S:" and case.stw in (ON, ON_REVERSE):
            hz_sent = limits_of(drive).hz(case.hsw)
            if case.stw == ON_REVERSE:
                hz_sent = -hz_sent
            shown = row_1[2:7].strip()
            if shown[-1:].isdigit() and not shown.startswith("- "):
                if abs(float(shown) - hz_sent) > 0.06 + abs(hz_sent) / 0x2000:
                    raise Broken("SHOWN", "%s, %.2f Hz are sent" % (row_1, hz_sent))
        shown = row_1[10:].strip()
        if row_1[7:10] == " F:" and shown[-1:].isdigit() and before_hz == hz:
            if abs(float(shown) - hz) > 0.06:
                raise Broken("SHOWN", "%s, drive %d turns at %.2f Hz" % (row_1, address, hz))

    def drive_at(self, address):
        return drive_at(self.world, address)

    def is_able(self, address):
        """Whether the drive there is one that this panel can control."""
        drive = self.drive_at(address)
        return drive is not None and drive.layout == (4, 2) and drive.family.NAME in CONTROLLED


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


def address_in(row_2):
    """The address that row 2 shows, None when something else stands there."""
    if len(row_2) < 16 or row_2[13] != "A" or not row_2[14].isdigit():
        return None
    if row_2[15] != " " and not row_2[15].isdigit():
        return None
    return int(row_2[14:].strip())
