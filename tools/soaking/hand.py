# SPDX-License-Identifier: MIT
"""The hand of a soak: it presses keys at random and lets things fail at random.

One number decides all of it. It works in turns: for a time anything may happen; then it puts
everything in order and checks whether the panel controls its drives again.

    hand = Hand(world, plan, judge, reader, weather)
    hand.live(180)                  # virtual seconds: raises Broken, or what the firmware raised
    hand.deeds                      # the last things it did
"""

import json

from boards.sim.drives.families import setting_of
from boards.sim.world import supervision, supervision_ms
from tools.soaking.at_the_drive import people_at
from tools.soaking.fingers import SLICE_MS
from tools.soaking.foreman import Foreman
from tools.soaking.judging.announced import is_parameter
from tools.soaking.judging.facts import GOES, MEANT_READS, MS, READ_REPLIES, S
from tools.soaking.judging.reader import address_in
from tools.soaking.judging.rules import Broken
from tools.soaking.mischief import WARNINGS
from tools.soaking.worlds import CLEAN

TURN_S = (8, 25)
RISKS_MAX = 3  # so many risks the panel may ask about before a motor starts
ACKNOWLEDGED_MS = 5_000
TRIES = 12  # the hand selects at most so many addresses to find one that answers
SHORT_US = 1 * S  # a telegram off time that a person, too, finds too short
FOUND_S = 20  # in which a drive that answers in another layout is found, and rounds of the line
FOUND_ROUNDS = 200
READY_S = 8
COUNTED_MS, COUNTED_ROUNDS, COUNTED_SLACK = 2_000, 4, 3  # the turns of a drive, telegrams
KNOWN_S = 120  # the longest time until the panel knows what a drive is set to


class Hand(Foreman):
    """See `Fingers` for what it takes, and for `deeds`; `Mischief` for `faults`."""

    def live(self, until_s):
        """Go on until so many seconds of virtual time are over, to the end of the turn."""
        while self.world.clock.now_us < until_s * S:
            self.weather.change()
            self.bustle(self.dice.between(*TURN_S))
            self.weather.clear()
            self.put_in_order()
            self.prove_control()

    def bustle(self, seconds):
        until_us = self.world.clock.now_us + seconds * S
        while self.world.clock.now_us < until_us:
            fails = self.plan.level != CLEAN and not self.dice.below(3)
            if fails and self.dice.below(2):
                self.run_or_jog()
            self.dice.one_of(self.failures if fails else self.common)()
            self.run((20, 60, 100, 200, 400, 900)[self.dice.below(6)])

    # --- order ----------------------------------------------------------------------------------

    def put_in_order(self):
        """Put everything in order: plugged in, powered, set up; every key up."""
        self.note("everything is put in order")
        self.let_go()
        self.judge.look()
        self.go_home()
        self.world.flash.cut_at = None
        self.run(2_500 + 8 * self.witness.cycle_us // MS)  # by then every requested write is done
        self.wait_for_the_busy()
        for drive in self.drives:
            self.witness.excuse(drive.address, 3)
            if not drive.plugged:
                drive.plug()
            if not drive.mains:
                self.power_on(drive)
            self.put_back(drive)
            for number, value in people_at(drive).order:
                self.set_at_drive(drive, number, value)
            self.supervise_again(drive)
            for number in WARNINGS:
                drive.warn(number, False)
        self.follow_addresses()
        self.run(1_500 + 4 * self.witness.cycle_us // MS)
        if self.plan.keeps_sets:
            self.give_sets_up()
        self.press("STOP", 4_300)
        self.run(3_000)

    def supervise_again(self, drive):
        """Give a drive a longer telegram off time if none could keep the one that it has."""
        link = drive.family.LINK
        if 0 < drive.read(link["off time"], link["index"]) * link["unit us"] < SHORT_US:
            ms = supervision_ms(self.plan.baud, len(self.plan.listed))
            for setting in supervision(drive.family, ms).items():
                self.set_at_drive(drive, *setting)

    def follow_addresses(self):
        """Give a drive that is not at an address of the panel's list such an address, of its own
        kind if there is one."""
        known = json.loads(self.world.store.read())["drives"]
        free = [address for address in known if address not in [d.address for d in self.drives]]
        for drive in self.drives:
            if drive.address not in known and free:
                fitting = [one for one in free if self.witness.kinds[one].can_find(drive)]
                address = (fitting or free)[-1]
                free.remove(address)
                self.set_at_drive(drive, setting_of(drive.family, "address"), address)

    def prove_control(self):
        """Check that drives in another layout were found, that START runs the drive shown, and
        that STOP stops it."""
        self.prove_found()
        self.prove_list()
        if not self.find_one_that_answers():
            return
        reader = self.reader
        if self.is_unconfirmed():
            return
        self.wait_for("an address on the display", self._is_home, 8)
        address = self.witness.shown
        if not reader.is_able(address):
            return
        drive = reader.drive_at(address)
        self.run(1_500)  # a fault must be shown for a second
        self.press("STOP")  # this also dismisses a message
        self.acknowledge(drive)
        self.wait_for("drive %d to be ready" % address, lambda: drive.state == "ready", 20)
        seconds = max(READY_S, self.known_s(drive))
        self.wait_for("READY on the display", lambda: reader.rows[1].startswith("READY"), seconds)
        self.press("START")
        self.run(200)
        if self.reader.reads("NO:"):  # a drive that was not shown may not be surveyed yet
            self.run_until_known(address)
            self.press("START")
        for _ in range(RISKS_MAX):
            self.wait_for("a START to be answered", lambda: self._is_answered(drive), 8)
            if drive.state == "running":
                break
            self.run(1_200)
            self.press("START")
            self.run(200)
        self.wait_for("drive %d to run" % address, lambda: drive.state == "running", 8)
        self.run(self.dice.between(100, 6_000))
        if self.dice.below(2):
            self.press("STOP")
            self.wait_for("drive %d to stand" % address, lambda: drive.state == "ready", 12)
        elif len(self.drives) > 1 and self._all_are_well():
            self.prove_announced(drive)

    def prove_found(self):
        """Check that the panel finds out how the telegrams of its drives are divided."""
        kinds = self.witness.kinds
        findable = [one for one in self.drives if kinds[one.address].can_find(one)]
        known = json.loads(self.world.store.read())["drives"]
        findable = [one for one in findable if one.address in known]
        seconds = FOUND_S + FOUND_ROUNDS * self.witness.cycle_us // S
        for drive in findable:
            self.wait_for(
                "the layout of drive %d" % drive.address,
                lambda drive=drive: kinds[drive.address].answers(drive),
                seconds,
            )

    def prove_list(self):
        """Check that each drive has as many turns as it was given, and that the address keys go
        through the drives in the order that was kept."""
        able = [address for address in self.plan.listed if self.reader.is_able(address)]
        if not self.plan.arranges or len(able) < len(self.plan.listed):
            return
        self.prove_turns()
        witness, order = self.witness, self.witness.arranged.order
        self.wait_for("an address on the display", self._is_home, 8)
        before = witness.shown
        if before not in order:
            return
        following = order[(order.index(before) + 1) % len(order)]
        self.press("ADDRESS_UP")
        self.wait_for(
            "drive %d behind drive %d" % (following, before),
            lambda: self._is_home() and witness.shown == following,
            8,
            "LIST",
        )

    def prove_turns(self):
        witness, listed = self.witness, self.plan.listed
        asked = {address: witness.cases[address].requests for address in listed}
        self.run(COUNTED_MS + COUNTED_ROUNDS * witness.cycle_us // MS)
        asked = {address: witness.cases[address].requests - asked[address] for address in listed}
        for address, count in asked.items():
            times = witness.arranged.repeats.get(str(address), 1)
            due = times * sum(asked.values()) // witness.turns
            if abs(count - due) > COUNTED_SLACK + due // 8:
                told = (address, times, count, sum(asked.values()))
                raise Broken("LIST", "drive %d, x%d, had %d of %d telegrams" % told)

    def acknowledge(self, drive):
        """Press STOP again if a fault took turns with others and was not shown for a second."""
        for _ in range(ACKNOWLEDGED_MS // SLICE_MS):
            if drive.state != "fault":
                return
            self.run(SLICE_MS)
        self.press("STOP")

    def find_one_that_answers(self):
        """Select another drive if the panel cannot control this one, which never confirms its
        STOP. Return whether there is a drive that it can control."""
        able = [drive for drive in self.drives if self.reader.is_able(drive.address)]
        for _ in range(min(len(self.plan.listed) - len(able), TRIES)):
            if not self.is_unconfirmed():
                break
            self.press("ADDRESS_UP")
            self.run(2_000)
        return bool(able)

    def is_unconfirmed(self):
        """Whether the display says, now and then, that the STOP of the drive shown is."""
        for _ in range(3_000 // SLICE_MS):
            self.run(SLICE_MS)
            if self.reader.reads("STOP UNCONFIRMED"):
                return True
        return False

    def prove_announced(self, drive):
        """Select another drive: check that this one runs on, and that the display says so."""
        self.press("ADDRESS_UP")
        text = "A%d RUN,HOLD=ALL" % drive.address
        self.wait_for(text, lambda: self.reader.reads(text), 8, "ANNOUNCED")
        self.press("STOP", 4_300)
        self.wait_for("drive %d to stand" % drive.address, lambda: drive.state == "ready", 12)

    def known_s(self, drive):
        """The seconds in which the panel has read all settings of a drive that is shown: one in a
        round, or in several where it lags. Until then it may read LOCAL, though it is in order.
        """
        replies = MEANT_READS * (READ_REPLIES + drive.stale_replies)
        return replies * self.witness.cycle_us // S

    def run_until_known(self, address):
        """Until the panel must know what the drive that is shown is set to, which takes long where
        many are asked and this one answers late.
        """
        witness, clock = self.witness, self.world.clock
        self.run(3_000 + 20 * witness.cycle_us // MS)
        until_us = clock.now_us + KNOWN_S * S
        while clock.now_us < until_us:
            if witness.knows(witness.cases[address], address, clock.now_us):
                return
            self.run(SLICE_MS)

    def wait_for(self, what, condition, seconds, rule="RECOVERS"):
        until_us = self.world.clock.now_us + seconds * S + 20 * self.witness.cycle_us
        while not condition():
            if self.world.clock.now_us > until_us:
                raise Broken(rule, "waited for %s" % what)
            self.run(SLICE_MS)

    def _all_are_well(self):
        """Whether no drive has an announcement that goes before that of a running drive."""
        for drive in self.drives:
            if not self.reader.is_able(drive.address) or drive.state not in ("ready", "running"):
                return False
        return True

    def _is_answered(self, drive):
        """Press START again if the panel gave it up: because the drive tells its settings slowly
        or the line is busy, or because a clock that wraps soon lets it wait for a few seconds
        only."""
        if self.reader.reads("NO: STILL CHECKS"):
            self.press("START")
        return drive.state == "running" or self.reader.rows[1] in GOES

    def _is_home(self):
        """Leave the menu and parameter mode as soon as they are seen."""
        reader, witness = self.reader, self.witness
        if self.is_away():
            self.go_home()
        if (
            not reader.steady
            or witness.shown is None
            or self.world.clock.now_us < witness.unsure_us
        ):
            return False
        if address_in(reader.rows[1]) != witness.shown:
            return False
        if is_parameter(reader.rows[1]):
            self.press("PARAM")
            return False
        return True
