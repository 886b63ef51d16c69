# SPDX-License-Identifier: MIT
"""What the judge is told: which keys move, when the chip restarts, hangs, writes its flash.

From that follows what the panel may send, and what it must send; the `Case` of each address notes
it. If a person could not tell either (which of two keys came first, which drive is shown while the
address keys move), both ways are allowed.
"""

from boards.sim.board import KEYS
from tools.soaking.judging.arranged import Arranged
from tools.soaking.judging.case import Case, drive_at
from tools.soaking.judging.commissioned import Commissioned
from tools.soaking.judging.diagnosed import Diagnosed
from tools.soaking.judging.drive_settings import Settings
from tools.soaking.judging.facts import (
    ALL_STOP_US,
    ALWAYS,
    BABBLED_US,
    DEAD_MAN_US,
    DRAWN_STEPS,
    HELD_OPENS_US,
    HUNG_MAX_US,
    LEFT_US,
    LIMITED_READS,
    LIMITED_SHOWN_US,
    LIMITED_US,
    LONG_US,
    LOOKED_FOR_US,
    LOOKED_STEPS,
    LOST_SAID_US,
    MEANT_READS,
    MEANT_STEPS,
    MEANT_US,
    MS,
    NEVER,
    OFF1,
    ON_BIT,
    READ_REPLIES,
    RUN,
    SECOND_STOP_US,
    SECOND_STOPS,
    SEEN_US,
    SHORT_CHORD_US,
    WATCHDOG_US,
    WISH_US,
    ZSW_RUNNING,
    S,
    debounce_us,
    exchange_us,
    lost_us,
)
from tools.soaking.judging.families import kinds_of
from tools.soaking.judging.happened import Happened
from tools.soaking.judging.kept_sets import KeptSets
from tools.soaking.judging.line_left import LineLeft
from tools.soaking.judging.locked import Locked
from tools.soaking.judging.rules import Broken
from tools.soaking.judging.tape import Tape


class Witness:
    """world: a `SoakWorld`. plan: its `Plan`. judge: has `look` and `play`, and judges with them
    what has happened so far, before anything new is noted.

    The hand, its mischief and the world tell it things. Others write some fields: the judge writes
    `late_us`, `stirred_us` and `wishes`, and takes cases out of `owed`; the reader writes
    what the display asks, `asked_us`, `go_us`, `leaves_us` and `question`, `menu_us`,
    `named` and `typed_us`.
    """

    def __init__(self, world, plan, judge):
        self.judge = judge
        self.world = world
        self.plan = plan
        self.tape = Tape(world.wire)
        self.cases = [Case() for _ in range(32)]
        self.clock = world.clock
        self.exchange_us = exchange_us(plan)
        self.debounce_us = debounce_us(plan)
        self.turns = len(plan.listed)  # telegrams of a round
        self.cycle_us = self.exchange_us * self.turns
        self.wish_us = WISH_US + 20 * self.cycle_us
        self.timeout_us = plan.settings.get("reply_timeout_ms", 20) * MS
        self.lost_us = lost_us(plan)
        self.second_stop = SECOND_STOPS[plan.settings.get("second_stop", "OFF3")]
        self.down = {}  # key -> since when
        self.up = {key: NEVER for key in KEYS}  # key -> when it was let go
        self.pressed_us = dict(self.up)  # key -> when it last went down
        self.spoilt = {}  # keys that must go up before they count -> True
        self.boot_us = 0
        self.begun_us = 0  # it must listen before it sends, since then
        self.bitten = False  # the watchdog has restarted it
        self.hung_us = None  # since when the loop stands still
        self.stalled_us = NEVER  # the end of the last standstill of any kind
        self.weather = None  # a `Weather`: what befalls the line
        self.late_us = NEVER  # the line was not its best lately
        self.wishes = {}  # "write", "eeprom" and "offer" -> until when
        self.set_us = NEVER
        self.asked_us = NEVER  # the display asks something: the reader notes it
        self.go_us = NEVER  # it asks whether a drive may run though nothing watches its line
        self.refused_us = NEVER  # a START was refused, because the drive obeys somebody else
        self.leaves_us = NEVER  # it asks whether the panel shall leave the line to find drives
        self.left_us = NEVER  # SET has said yes to that
        self.searches = False  # the program that finds drives has the line
        self.typed_us = NEVER  # the display has digits of a setpoint that is typed in
        self.menu_us = NEVER  # the menu was seen last,
        self.menu_since_us = ALWAYS  # and first, without anything else in between
        self.named = ()  # addresses in there, which a STOP is for, too
        self.seen_us = SEEN_US + DRAWN_STEPS * plan.loop_us
        self._is_handed_over = False  # the panel has ended to begin anew
        self._menu_shown = None  # the drive that is shown behind the menu
        self._menu_starts = ()  # cases, and which START of each counted when it was pressed there
        self.question = None  # address, number and value that it asks about, as far as it is known
        self.confirmed = []  # what SET has said yes to, until when: (instant, question)
        self.moved = {}  # addresses that a drive was given, or left, or was to -> True
        self.owed = []  # cases that wait for their OFF
        self.all_from_us = NEVER  # a STOP of all began then, as far as is known,
        self.all_until_us = NEVER  # and until then every drive is stopped, one after the other
        self.stop_from_us = NEVER  # STOP is held since, as far as is known
        self.stopping = ()  # cases that the last STOP is for; None: not known
        self.held_us = NEVER  # since when the last STOP that lasted until OFF2 or OFF3 was held
        self.second_owed = None  # the drive that a STOP, if it is held, stops by OFF2 or OFF3
        self.shown = None  # the address shown, None while it cannot be told
        self.shown_us = NEVER  # since when
        self.unsure_us = 0  # until when it cannot
        # By address, what the panel takes a drive for, as its settings name it: a `Kind`.
        self.kinds = kinds = kinds_of(plan.settings, range(32))
        self.settings = {
            address: Settings(drive, kinds[address]) for address, drive in world.drives.items()
        }
        self.stirred_us = 0  # when something was last done to keys, drives, line or loop
        self.pulled_us = NEVER  # something was last done that may cut what a drive sends
        self.stuck_us = None  # since when the chip's timers are dead
        self._noted_us = NEVER  # settings of the drives
        self.line = LineLeft(self)
        self.sets = KeptSets(world, self)
        self.diagnosed = Diagnosed(self)
        self.commissioned = Commissioned(self)
        self.happened = Happened(self)
        self.locked = Locked(self)
        self.arranged = Arranged(self)
        self._take_round()
        world.witness = self

    # --- what the hand tells --------------------------------------------------------------------

    def key(self, key, down):
        """A key is about to move."""
        self.judge.look()
        self.stirred_us = now = self.clock.now_us
        if key == "UP" or key == "SET" and self._may_take_digits(now):
            for case in self.candidates():
                case.raised_us = now
        if not down:
            held_us = now - self.down.pop(key, now)
            self.up[key] = now
            self.spoilt.pop(key, None)
            if key == "STOP":
                self._stop_is_up(now, held_us)
            elif key.startswith("ADDRESS"):
                moving = [name for name in self.down if name.startswith("ADDRESS")]
                self.unsure_us = ALWAYS if moving else now + 250 * MS
            return
        self.down[key] = self.pressed_us[key] = now
        self.line.key(key, now)
        self.sets.key(key, now)
        self.diagnosed.key(key, now)
        self.commissioned.key(key, now)
        self.happened.key(key, now)
        self.locked.key(key, now)
        self.arranged.key(key, now)
        if key == "STOP":
            if now - self.up[key] > self.debounce_us:  # else the panel may not have seen it go up
                self.stop_from_us = now
            self._stop_pressed(now)
        elif key == "START":
            self._start_pressed(now)
        elif key.startswith("ADDRESS"):
            self._selects(now)
        elif key == "SET":
            self._set_pressed(now)

    def is_in_menu(self):
        """Whether the menu covers all pages, as far as can be seen."""
        return self.menu_since_us != ALWAYS

    def _may_take_digits(self, now):
        """Whether SET may take a setpoint that was typed in: the display has its digits, or may
        have had them since EDIT was pressed."""
        opened_us = max(self.pressed_us["EDIT"], self.stalled_us)
        return now - max(self.typed_us, opened_us) < self.seen_us

    def sees_menu(self):
        """The menu is on the display: what START was pressed in it for has come to nothing."""
        self.menu_us = now = self.clock.now_us
        if not self.is_in_menu():
            self.menu_since_us = now
            self._menu_shown = self.shown
            self._menu_starts = ()
        if self._menu_starts and now - self.pressed_us["START"] > self.seen_us:
            for case, start_us in self._menu_starts:
                if case.stw & RUN and case.used_us == self.pressed_us["START"]:
                    raise Broken("START", "pressed at %d, in the menu" % case.used_us)
                case.start_us = start_us
            self._menu_starts = ()
        if self._menu_shown is not None and now > self.unsure_us + self.seen_us:
            self.shows(self._menu_shown)

    def may_look(self, now):
        """Whether the display may have an address that the panel asks: in the menu, or because an
        address key is held."""
        # On a line that others talk on, what the menu has asked waits.
        left_us = self.menu_us + max(0, min(self.late_us - self.menu_us, BABBLED_US))
        if self.is_in_menu() or now - left_us < LOOKED_FOR_US + 4 * self.cycle_us:
            return True  # a STOP that is held hides its second row
        for key in ("ADDRESS_UP", "ADDRESS_DOWN"):
            until_us = now if key in self.down else self.up[key]
            is_late = now - until_us >= LOOKED_FOR_US + 4 * self.cycle_us
            if until_us - self.pressed_us[key] > HELD_OPENS_US and not is_late:
                return True
        return False

    def candidates(self):
        """Cases of the drives that may be the one shown."""
        return (self.cases[self.shown],) if self.is_sure() else self.cases

    def is_sure(self):
        """Whether it is known which drive is shown."""
        return self.shown is not None and self.clock.now_us > self.unsure_us

    def _selects(self, now):
        recently = now - SHORT_CHORD_US
        if self.down.get("START", NEVER) > recently:
            for case in self.cases:
                case.start_us = now
        if self.shown is not None:
            self._menu_shown = self.shown
        self.shown = None
        self.unsure_us = ALWAYS

    def _start_pressed(self, now):
        stop_us = self.down.get("STOP")
        if stop_us is not None and now - stop_us > SHORT_CHORD_US:
            return
        if self.is_in_menu() and not self._menu_starts:
            self._menu_starts = [(case, case.start_us) for case in self.candidates()]
        for case in self.candidates():
            case.start_us = now
            if now - self.go_us < 500 * MS:
                case.accepted = True

    def _stop_pressed(self, now):
        for case in self.candidates():
            case.acknowledge_us = now
            case.excused_us = max(case.excused_us, now + 600 * MS + 4 * self.exchange_us)
        self.second_owed = self.stopping = None
        if self.is_sure():
            case = self.cases[self.shown]
            self.stopping = (case,)
            if self.is_in_menu():
                self.stopping = self._stopped_in_menu(now)
            if self.second_stop != OFF1:
                self.second_owed = case
            case.brakes = not case.stw & RUN
            case.stop_us = now
            case.void_us = now
            case.owed_us = now
            case.owed_requests = 0
            if case not in self.owed:
                self.owed.append(case)

    def _stopped_in_menu(self, now):
        """The case of the drive shown and those that the menu names; None: it may have moved."""
        moved_us = max(at_us for key, at_us in self.pressed_us.items() if key != "STOP")
        moved_us = max([moved_us] + [at_us for key, at_us in self.up.items() if key != "STOP"])
        if now - moved_us < self.seen_us or len(self.down) > 1:
            return None
        named = [one for one in self.named if one < len(self.cases)]
        return tuple([self.cases[one] for one in [self.shown] + named])

    def _stop_is_up(self, now, held_us):
        if now - self.stop_from_us > SECOND_STOP_US - 50 * MS:
            self.held_us = self.stop_from_us
        if held_us > ALL_STOP_US - 100 * MS:
            drives = len(self.plan.listed)
            self.all_from_us = now - held_us + ALL_STOP_US - 150 * MS
            self.all_until_us = now + drives * (2 * self.exchange_us + 10 * MS)

    def _set_pressed(self, now):
        self.set_us = now
        if self.is_in_menu():  # it may choose another drive
            if self.shown is not None:
                self._menu_shown = self.shown
            self.shown = None
            self.unsure_us = max(self.unsure_us, now + 250 * MS)
        if self.leaves_us > now - 500 * MS:
            self.left_us = now
        if self.asked_us > now - 500 * MS:
            self.wishes["write"] = now + self.wish_us
            self.confirmed = [row for row in self.confirmed if row[0] > now]
            self.confirmed.append((now + self.wish_us, self.question))
            if self.refused_us > now - WISH_US:
                self.wishes["offer"] = now + self.wish_us
            self.shown = None
            self.unsure_us = now + 2 * S + 3 * self.cycle_us

    # --- what the world tells -------------------------------------------------------------------

    def reset(self, bitten):
        """The chip is about to restart."""
        now = self.clock.now_us
        self.judge.play()
        self.bitten = bool(bitten)
        if bitten:
            stood_us = 0 if self.hung_us is None else now - self.hung_us
            if stood_us < WATCHDOG_US - 200 * MS and self.stuck_us is None:
                raise Broken("WATCHDOG", "it bit at %d, the loop was alive" % now)

    def sticks(self):
        """The chip's timers die: nothing ends a transmission any more."""
        self.judge.look()
        self.stuck_us = self.stirred_us = self.clock.now_us
        for case in self.cases:
            case.excused_us = ALWAYS

    def handed_over(self, searches):
        """Another program has left the line to this one: the search, or the panel anew."""
        now = self.clock.now_us
        self.judge.play()
        if searches and now - self.left_us > LEFT_US + 20 * self.cycle_us:
            raise Broken("SEARCH", "it begins at %d, and nobody asked for it" % now)
        self.left_us = NEVER
        stuck_us = self.stuck_us
        self._is_handed_over = not searches and not self.searches
        self.booted()
        self._is_handed_over = False
        self.boot_us -= self.plan.loop_us  # when it began, the loop had a step to end
        self.begun_us = self.boot_us
        self.searches = searches
        if stuck_us is not None:
            self.stuck_us = now

    def booted(self):
        """The chip has restarted; the firmware is about to begin."""
        now = self.clock.now_us
        self.searches = False
        self.menu_us, self.menu_since_us = NEVER, ALWAYS
        self.line.end(now)
        self.sets.booted()
        self.locked.booted(now)
        self.arranged.booted(self._is_handed_over)
        self._take_round()
        self.boot_us = self.begun_us = now
        self.stirred_us = now
        self.stalled_us = now
        self.stuck_us = None
        self.hung_us = None
        for kind in self.kinds.values():
            kind.restarted()
        for case in self.cases:
            case.unheard = 0
            case.heard_requests = case.requests
            case.heard = case.taken = case.questions = 0
            case.void_us = now
            case.owed_us = NEVER
            case.excused_us = now + 3 * S
            case.stw = OFF1
            case.jog_void_us = now
        for key in self.down:
            self.spoilt[key] = True
        self.wishes.clear()
        del self.confirmed[:]
        del self.owed[:]
        self.shown = None
        self.unsure_us = now + 1_500 * MS

    def _take_round(self):
        """Some drives may stand in the list several times."""
        self.turns = max(len(self.plan.listed), self.arranged.turns())
        self.cycle_us = self.exchange_us * self.turns
        self.wish_us = WISH_US + 20 * self.cycle_us

    def flash_written(self):
        """The chip stands still: a step of writing its flash."""
        now = self.clock.now_us
        self.stalled_us = now
        for address, case in enumerate(self.cases):
            if case.stw & RUN and now - case.sent_us < S:
                raise Broken("FLASH", "written at %d while drive %d is on" % (now, address))

    def hangs(self, on):
        """The main loop stops, or goes on."""
        self.judge.look()
        self.stirred_us = now = self.clock.now_us
        if on:
            self.hung_us = now
            return
        if self.hung_us is None:
            return  # the watchdog has bitten
        stood_us = now - self.hung_us
        if stood_us > DEAD_MAN_US - 20 * MS:
            for case in self.cases:
                case.excused_us = now + 3 * S
        if stood_us > DEAD_MAN_US + 20 * MS:
            for case in self.cases:
                if case.start_us < self.hung_us - 60 * MS:
                    case.void_us = self.hung_us
                case.jog_void_us = max(case.jog_void_us, self.hung_us - 60 * MS)
        if stood_us > WATCHDOG_US + 300 * MS:
            raise Broken("WATCHDOG", "the loop stood still for %d ms" % (stood_us // MS))
        self.hung_us = None
        self.stalled_us = now

    def meddled(self, drive):
        """Parameters were changed at the drive itself."""
        self.stirred_us = now = self.clock.now_us
        self.sets.changed(drive.address, now)
        self.cases[drive.address].changes(now)
        self.judge.look()
        self.note_settings(now)
        self.cases[drive.address].excused_us = now + 30 * S

    def unpowered(self, drive):
        """The mains of a drive are about to go."""
        self.excuse(drive.address, 5 + 4 * self.cycle_us // S)
        case, now = self.cases[drive.address], self.clock.now_us
        ran_us = now - case.on_us - 2 * self.cycle_us
        case.telltale = ran_us > 4 * S and now - case.powered_us > 10 * S + 4 * self.cycle_us

    def powered(self, drive):
        """The mains of a drive are about to come."""
        self.excuse(drive.address, 5 + 4 * self.cycle_us // S)
        self.cases[drive.address].powered_us = self.clock.now_us

    # --- what follows from that -----------------------------------------------------------------

    def stops_all_us(self, now):
        """When the last STOP of all drives has begun."""
        if "STOP" in self.down and now - self.down["STOP"] > ALL_STOP_US - 150 * MS:
            return self.down["STOP"] + ALL_STOP_US - 150 * MS
        return self.all_from_us

    def silent_us(self, case, now):
        """How long ago a reply came that the panel may have taken."""
        return now - max(case.answered_us, self.boot_us, self.tape.blurred_us)

    def asked_for_us(self, case, now):
        """How long a drive was not asked that could have been."""
        if self.hung_us is not None or self.stuck_us is not None or self.line.is_free:
            return 0
        return now - max(case.sent_us, self.stalled_us, self.late_us, self.boot_us)

    def is_lost(self, case, now):
        """Whether a drive is silent for so long, and was asked meanwhile, that all must say so."""
        return (
            self.silent_us(case, now) > self.lost_us + LOST_SAID_US + 2 * self.cycle_us
            and case.lost_us > max(case.answered_us, self.boot_us)
            and now - case.lost_us > LOST_SAID_US
        )

    # --- settings of the drives -----------------------------------------------------------------

    def note_settings(self, now):
        """Of drives that may have others by now."""
        for settings in self.settings.values():
            case = self.cases[settings.drive.address]
            if case.settings_us > self._noted_us - 2 * S:  # a task may just be on its way
                settings.note(now, case.replies)
        self._noted_us = now

    def sight_of(self, address):
        """What the panel can know of the drive there: a `Sight`; None: that cannot be told."""
        return self.kinds[address].sight()

    def is_able(self, address):
        """Whether the panel can control the drive that is there now."""
        drive = drive_at(self.world, address)
        return drive is not None and self.kinds[address].is_right_for(drive)

    def layout_changed(self, address, now):
        """The panel divides its telegrams to a drive another way from now on."""
        case = self.cases[address]
        case.changes(now)
        settings = self.settings.get(address)
        if settings is not None:
            settings.note(now, case.replies)

    def moves(self, address, other):
        """A drive is given another address; the panel takes it there for what it was here."""
        self.moved[address] = self.moved[other] = True
        self.kinds[other] = self.kinds[address]

    def shows(self, address):
        """The display tells which drive is shown."""
        if address != self.shown:
            self.shown = address
            self.shown_us = self.clock.now_us

    def meant(self, address):
        """What setpoint and actual frequency may mean to the panel: `Values`; none: not known."""
        return self._in_force(address, self.clock.now_us - MEANT_US, MEANT_READS)

    def exposed_us(self, address, case):
        """How long the motor may run on too long when the panel dies, by the P2014 that the panel
        has read when START was pressed: ALWAYS, for ever; 0, not at all.
        """
        settings = self.settings.get(address)
        if settings is None or settings.drive.address != address:
            return ALWAYS
        if self.sight_of(address) is None:
            return ALWAYS
        found = settings.in_force(case.used_us - S, ALWAYS)
        return max(_exposure_us(values, LONG_US) for values in found)

    def is_more_exposed(self, address, case):
        """Whether a motor runs that would run on longer by now, and the panel must know that."""
        if not case.stw & ON_BIT or not case.zsw & ZSW_RUNNING:
            return False
        running = sum(1 for other in self.cases if other.stw & RUN)
        patience_us = max(MEANT_US, MEANT_STEPS * self.plan.loop_us * running)
        found = self._in_force(address, self.clock.now_us - patience_us, MEANT_READS)
        long_us = 2 * max(LONG_US, 4 * self.cycle_us)
        return any(found) and min(_exposure_us(one, long_us) for one in found) > case.exposed_us

    def limited(self, address):
        """What the panel may take for the limits of a drive: `Values`; none: not known."""
        now = self.clock.now_us
        since_us = now - LIMITED_SHOWN_US
        if not self.is_sure() or self.shown != address or self.shown_us > since_us:
            running = sum(1 for case in self.cases if case.stw & RUN)
            since_us = now - max(LIMITED_US, LOOKED_STEPS * self.plan.loop_us * running)
        return self._in_force(address, since_us, LIMITED_READS)

    def knows(self, case, address, by_us):
        """Whether the panel must know by then what a drive that is shown is set to."""
        since_us = max(case.settings_us, self.shown_us, self.stalled_us)
        drive = drive_at(self.world, address)
        if drive is None or self.shown != address or by_us - since_us < MEANT_US:
            return False
        replies = MEANT_READS * (READ_REPLIES + drive.stale_replies)
        return case.replies - case.settings_at > replies

    def _in_force(self, address, since_us, reads):
        settings = self.settings.get(address)
        if settings is None or settings.drive.address != address:
            return ()  # it was given another address: it is not known whose they are
        if self.sight_of(address) is None:
            return ()
        if self.hung_us is not None or self.stalled_us > since_us:
            since_us -= HUNG_MAX_US
        replies = reads * (READ_REPLIES + settings.drive.stale_replies)
        return settings.in_force(since_us, self.cases[address].replies - replies)

    # --- what is excused ------------------------------------------------------------------------

    def excuse(self, address, s=5):
        """Something is being done to this drive that may stop it."""
        self.stirred_us = self.pulled_us = now = self.clock.now_us
        self.cases[address].changes(now)
        self.judge.look()
        self.cases[address].excused_us = now + s * S


def _exposure_us(values, long_us):
    """How long a motor runs on without a panel. ALWAYS: for ever; 0: not longer than it may."""
    off_time_us = values.off_time_us
    if not off_time_us:
        return ALWAYS
    return off_time_us if off_time_us > long_us else 0
