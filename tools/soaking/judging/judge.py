# SPDX-License-Identifier: MIT
"""The judge of a soak: he compares what the panel sends with what a hand at its keys has asked
for.

He knows the keys, the line, the loop and the display's picture, and asks the firmware nothing. He
plays back the tape after every slice of time and before every key that moves, so that he judges
each telegram by the keys as they were when it began.

    judge = Judge(world, plan)
    judge.look()                    # after every slice: raises Broken
    judge.witness.key("START", True)    # before the key moves
"""

from tools.soaking.judging.case import drive_at
from tools.soaking.judging.drive_settings import magnitude, scalings
from tools.soaking.judging.facts import (
    ACKNOWLEDGE,
    ALL_STOP_US,
    ALWAYS,
    CONTROLS,
    DEAD_MAN_US,
    DOUBLES,
    DOUBTED_US,
    EEPROM_WRITES,
    HELD_SET_US,
    JOG_BITS,
    JOG_RIGHT_BIT,
    MEANT_US,
    MS,
    NEVER,
    OFF1,
    OFFERED,
    OFFS,
    ON_BIT,
    RAM_WRITES,
    READS,
    RUN,
    SECOND_STOP_US,
    SHORT_CHORD_US,
    SILENT_MIN,
    STOPPED_MIN,
    STUCK_US,
    TOLD_MIN,
    ZSW_FAULT,
    ZSW_INHIBIT,
    ZSW_RUNNING,
    S,
    start_us,
)
from tools.soaking.judging.families import VARIABLE
from tools.soaking.judging.rules import Broken
from tools.soaking.judging.runs import (
    begin,
    begin_again,
    is_over,
    is_standstill,
    judge_restart,
    judge_rise,
    reason_against,
    runs_on_unasked,
)
from tools.soaking.judging.shares import Shares
from tools.soaking.judging.tape import MALFORMED, MIRRORED, REPLY, REQUEST
from tools.soaking.judging.witness import Witness

IDENTIFIES = 1910  # with the next ON the motor has current: a step that has to ask
LISTEN_US = 95 * MS  # 100 ms, less the error of the panel's clocks
SILENT_US = 3_500 * MS  # a panel that listens, and then one exchange


class Judge:
    """world: a `SoakWorld`. plan: its `Plan`. witness: it is told what is done to that world.
    exchanges: telegrams that were judged.
    """

    def __init__(self, world, plan):
        self.world = world
        self.plan = plan
        self.clock = world.clock
        self.witness = witness = Witness(world, plan, self)
        self.cases = witness.cases
        self.tape = witness.tape
        self.exchanges = 0
        self.drives = list(world.drives.values())
        self.starts = [0] * len(self.drives)  # of their motors, as counted last
        self._shares = Shares(witness)
        self._patience_us = SILENT_US + witness.exchange_us
        self.unsettled = []  # replies that may still be spoilt, and what to note of each then
        self._may_ask = False  # the last telegram may have asked a drive what it is,
        self._is_question = False  # and has
        self._begun_us = None  # of the witness, when the first telegram since then was judged
        self._counted_us = 0

    def look(self):
        """Judge what has happened since the last look."""
        witness = self.witness
        now = self.clock.now_us
        if witness.weather.is_bad():
            witness.late_us = witness.stirred_us = now
        if self.unsettled:
            self.settle_replies(now)
        self.play()
        world = self.world
        chip = world.chip
        if chip.handler_errors:
            raise Broken("EXCEPTION", "interrupt handler: %r" % chip.handler_errors[0])
        if world.wire.violation_count():
            self._judge_line()
        if world.lcd_chip.complaints():
            raise Broken("DISPLAY", world.lcd_chip.complaints()[0])
        spoken_us = max(self.tape.sent_us, witness.boot_us, witness.line.back_us)
        if witness.stuck_us is not None:
            is_late = now - witness.stuck_us > STUCK_US + witness.exchange_us
            if is_late and not witness.searches:  # no motor runs beside a search
                raise Broken("WATCHDOG", "the bus stands since %d" % witness.stuck_us)
        elif witness.searches or witness.line.is_free:
            pass  # it talks when it is told to
        elif witness.hung_us is None and now - max(spoken_us, witness.late_us) > self._patience_us:
            raise Broken("SILENT PANEL", "no telegram for %d ms" % ((now - spoken_us) // MS))
        self.judge_motors(now)
        if now - self._counted_us > S and not witness.searches:
            self._counted_us = now
            self._shares.look(now)
            witness.note_settings(now)
        down = witness.down
        if down:
            if "STOP" in down and "STOP" not in witness.spoilt:
                self._judge_held_stop(now, now - down["STOP"])
            if "SET" in down and now - down["SET"] > HELD_SET_US:
                witness.wishes["eeprom"] = now + witness.wish_us

    def _judge_held_stop(self, now, held_us):
        """Judge what a STOP that is held must have led to by now."""
        witness = self.witness
        pressed_us = now - held_us
        if max(witness.stalled_us, witness.late_us) > pressed_us or witness.hung_us is not None:
            return
        patience_us = witness.debounce_us + 4 * witness.exchange_us
        if witness.second_owed is not None and held_us > SECOND_STOP_US + patience_us:
            if witness.second_owed.second_us < pressed_us:
                raise Broken("SECOND STOP", "not sent at %d" % now)
        patience_us += len(self.plan.listed) * (2 * witness.exchange_us + 10 * MS)
        if held_us > ALL_STOP_US + patience_us:
            for address, case in enumerate(self.cases):
                if case.stw & RUN:
                    raise Broken("STOP ALL", "drive %d is still told to run" % address)

    def play(self):
        """Judge what is new on the tape."""
        tape = self.tape
        for row in tape.news():
            kind = tape.kind[row]
            if self.witness.searches and kind != MALFORMED:
                self._judge_search(row, tape)
            elif kind == REQUEST:
                self._judge_request(row, tape)
            elif kind == MALFORMED:
                raise Broken("TELEGRAM", "at %d" % tape.at_us[row])
            elif kind == REPLY and self._is_question:
                self._shares.answered()
            elif kind == REPLY:
                self._take_reply(row, tape)
            elif kind == MIRRORED:
                self._is_question = False
                self.witness.line.judge("a mirror telegram", tape.at_us[row])
                self.judge_mirror(row, tape)
            else:
                self._shares.answered()
                self.witness.diagnosed.returned(tape.address[row])
                kind = self.witness.kinds[tape.address[row]]
                kind.returned(tape.count[row], self._is_sure(row, tape))

    def _judge_search(self, row, tape):
        """A telegram of the program that finds drives, or an answer. It reads, and says OFF1; a
        drive that divides it in another way obeys nothing in it."""
        address, count = tape.address[row], tape.count[row]
        where = address, tape.at_us[row]
        if tape.kind[row] not in (REQUEST, MIRRORED):
            return
        self.exchanges += 1
        if self._begun_us != self.witness.begun_us:
            self._judge_first(row, tape)
        if tape.kind[row] == MIRRORED:
            if not tape.is_blank(row):
                raise Broken("MIRROR", "drive %d at %d, its net data are not nothing" % where)
            return
        for drive in self.drives:
            pkw_words, pzd_words = drive.layout
            takes = (count,) if pkw_words == VARIABLE else (pkw_words + pzd_words,)
            if drive.address != address or count not in takes:
                continue
            stw = tape.word(row, -pzd_words) if count >= pzd_words else 0
            if stw & CONTROLS and stw != OFF1:
                raise Broken("CONTROL", "drive %d at %d, %04X" % (where + (stw,)))
            task = tape.word(row, 0) >> 12 if pkw_words else 0
            if task not in READS:
                raise Broken("WRITE", "drive %d at %d, task %d" % (where + (task,)))

    def judge_mirror(self, row, tape):
        """It looks for the layout of a drive that is silent; no drive acts on it."""
        now, address = tape.at_us[row], tape.address[row]
        witness, case = self.witness, self.cases[address]
        where = "drive %d at %d" % (address, now)
        self.exchanges += 1
        witness.kinds[address].mirror(tape.count[row])
        if self._begun_us != witness.begun_us:
            self._judge_first(row, tape)
        if not tape.is_blank(row):
            self._judge_mirror_test(row, tape, address, where)
            self._shares.mirror(case, now)
            return
        is_listed = address in witness.plan.listed
        if witness.may_look(now) and (not is_listed or address in witness.moved):
            self._shares.mirror(case, now)
            return
        if not is_listed and address not in witness.moved:
            raise Broken("MIRROR", "%s, which is not in the list" % where)
        # One that waits to be sent when the drive answers still goes out, perhaps behind another:
        # every second telegram is one of the list, and of the others every second one.
        waits = 4 + 2 * witness.may_look(now)
        waited_us = waits * (witness.exchange_us + self.plan.loop_us)
        recently_us = max(witness.boot_us, now - witness.lost_us * 9 // 10)
        may_run = case.turned_us > max(case.rested_us, witness.boot_us)
        is_doubtful = now - witness.late_us < DOUBTED_US + 20 * witness.cycle_us
        if witness.kinds[address].may_be_taken_for_variable() and not may_run:
            is_doubtful = True
        misses = case.requests - case.heard_requests
        # A round may take longer, the one in which an answer is spoilt as well.
        answers = case.answered_us > recently_us or misses < SILENT_MIN
        if case.is_told:  # an answer to a question is no contact yet
            is_doubtful = answers = True
        if answers and (is_doubtful or not witness.is_able(address)):
            self._shares.mirror(case, now)
            return  # its answers may make no sense
        if case.heard_us > recently_us and now - case.contact_us > waited_us:
            told = (where, (now - case.contact_us) // MS, (now - case.heard_us) // MS)
            raise Broken("MIRROR", "%s, in contact for %d ms, heard %d ms ago" % told)
        least = STOPPED_MIN if may_run else SILENT_MIN
        if misses < least and now - case.contact_us > waited_us:
            raise Broken("MIRROR", "%s, silent for %d telegrams" % (where, misses))
        told = case.requests - case.run_requests
        if may_run and told < TOLD_MIN and now - case.contact_us > waited_us:
            raise Broken("MIRROR", "%s, told to stop in %d telegrams" % (where, told))
        self._shares.mirror(case, now)

    def _judge_mirror_test(self, row, tape, address, where):
        """Somebody counts the telegrams that come back. They are as long as the drive's own, and
        it obeys none that it takes for one of those: bit 10 is 0."""
        pzd_words = self.witness.kinds[address].pzd_words
        if not self.witness.diagnosed.tests(address, tape.at_us[row]):
            raise Broken("MIRROR", "%s, its net data are not nothing" % where)
        if tape.count[row] >= pzd_words and tape.word(row, -pzd_words) & CONTROLS:
            raise Broken("MIRROR", "%s, a drive may obey it" % where)
        self.witness.diagnosed.sent()

    def _take_reply(self, row, tape):
        address = tape.address[row]
        case = self.cases[address]
        kind = self.witness.kinds[address]
        if not kind.may_be_reply(tape.count[row]):
            return
        self._shares.answered()
        now = tape.end_us[row]
        zsw = tape.word(row, -kind.pzd_words)
        hiw = tape.word(row, 1 - kind.pzd_words)
        if case.missed_us - case.answered_us > self.witness.lost_us + 100 * MS:
            case.void_us = max(case.void_us, now - SHORT_CHORD_US)
            case.excused_us = now + 2 * S + self.witness.cycle_us
            case.heard_us = NEVER
        case.answered_us = now
        case.taken += 1
        case.unheard = 0
        case.asked_us = NEVER
        case.zsw = zsw
        self.witness.happened.reply(address, zsw, now)
        if zsw & ZSW_RUNNING:
            case.ran_us = now
        elif not case.stw & RUN:
            case.rested_us = now
        if not zsw & (ZSW_FAULT | ZSW_INHIBIT):
            case.good_us = now
        stops = False
        if case.stw & RUN:
            if zsw & ZSW_RUNNING:
                case.ran = True
            stops = is_over(case, zsw)
            reverse = kind.family.reverse
            if is_standstill(case, hiw, reverse) and self._tells_speed(address):
                stops = True
            if stops:
                case.excused_us = now + 2 * S + self.witness.cycle_us
        self.unsettled.append((row, case, kind, zsw, case.requests, stops, self._may_ask))

    def _tells_speed(self, address):
        """Whether HIW is the speed, in percent and with a sign, by what the drive is set to."""
        meant = self.witness.meant(address)
        told = [values.tells_speed and not values.absolute for values in meant]
        return self.witness.kinds[address].family.signed and bool(told) and all(told)

    def settle_replies(self, now):
        """The replies that the panel must have taken by now."""
        tape = self.tape
        waiting = []
        for one in self.unsettled:
            row, case, kind, zsw, requests, stops, is_told = one
            if not tape.is_settled(row, now):
                waiting.append(one)
            elif self._is_sure(row, tape) and kind.is_sure_reply(tape.count[row]):
                if self.witness.is_able(tape.address[row]):
                    kind.answered()
                case.replies += 1
                case.heard += 1
                case.heard_requests = max(case.heard_requests, requests)
                heard_us = tape.end_us[row]
                lost_us = max(self.witness.boot_us, heard_us - self.witness.lost_us)
                if case.heard_us < lost_us:
                    case.contact_us = heard_us
                if heard_us > case.heard_us:
                    case.heard_us, case.is_told = heard_us, is_told
                if zsw & (ZSW_FAULT | ZSW_INHIBIT):
                    case.bad_us = max(case.bad_us, tape.end_us[row])
                if stops:
                    case.void_us = case.off_us = max(case.void_us, tape.end_us[row])
        self.unsettled = waiting

    def _is_sure(self, row, tape):
        """Whether the panel must have taken this reply."""
        delay_us = tape.delay_us[row]
        return (
            tape.flawless[row]
            and self.world.wire.start_interval_us + 200 < delay_us < self.witness.timeout_us - MS
            and not self.witness.weather.may_be_deaf()
        )

    def _judge_request(self, row, tape):
        now = tape.at_us[row]
        address = tape.address[row]
        case = self.cases[address]
        kind = self.witness.kinds[address]
        self.exchanges += 1
        self.witness.line.judge("a telegram to drive %d" % address, now)
        self._may_ask = kind.may_ask(tape.count[row])
        case.questions += self._may_ask
        self._is_question = self._may_ask and self._asks(row, tape, kind)
        if self._is_question:
            case.question_us = now
            self._shares.mirror(case, now)
            return
        if tape.left[row]:
            raise Broken("ADDRESS", "%d at %d, which its drive had left" % (address, now))
        pkw_words = tape.count[row] - kind.pzd_words
        pke = tape.word(row, 0) if pkw_words > 0 else 0
        task = pke >> 12
        self._judge_layout(row, tape, kind, task)
        kind = self.witness.kinds[address]
        index = tape.word(row, 1) if task else 0
        stw, hsw = tape.word(row, -kind.pzd_words), tape.word(row, 1 - kind.pzd_words)
        self._shares.ask(case, address, (pke, index) if task else None, now)
        if self._begun_us != self.witness.begun_us:
            self._judge_first(row, tape)
        if case.asked_us > 0:
            case.missed_us = case.asked_us
            heard_us = max(case.answered_us, self.witness.boot_us)
            if case.lost_us < heard_us < case.missed_us - self.witness.lost_us:
                case.lost_us = now
        case.asked_us = now
        case.unheard += 1
        case.requests += 1
        if self.witness.owed:
            self._judge_owed(case, now)
        if task and task != 1:
            high = tape.word(row, 2) if task in DOUBLES else 0
            value = tape.word(row, 2 if pkw_words == 3 else 3)
            self._judge_task(task, pke & 0x7FF, index, (high, value), now, address)
        if stw & RUN and tape.withdrawn[row]:
            raise Broken("STOP", "drive %d gets %04X after ON was taken back" % (address, stw))
        if not stw & RUN:
            if hsw:
                raise Broken("SETPOINT", "%04X with OFF" % hsw)
            if self.witness.owed and case in self.witness.owed and now >= case.owed_us:
                self.witness.owed.remove(case)
                case.owed_us = NEVER
        if stw == OFF1 and case.stw == OFF1:
            case.sent_us = now
            return
        self._judge_word(case, address, stw, now)
        if stw & RUN:
            case.run_requests = case.requests
            self._judge_run(case, address, stw, hsw, now)
        else:
            self._judge_off(case, address, stw, now)
        case.stw = stw & ~ACKNOWLEDGE
        case.hsw = hsw
        case.sent_us = now

    def _asks(self, row, tape, kind):
        """Whether a telegram asks a drive what it is, in a layout that it does not have: it obeys
        nothing in that. In its own, the panel may just have found it."""
        now, address, count = tape.at_us[row], tape.address[row], tape.count[row]
        drive = drive_at(self.world, address)
        if drive is not None and count >= drive.layout[1]:
            stw = tape.word(row, -drive.layout[1])
            if stw & CONTROLS and kind.learn(drive.layout, count):
                self.witness.layout_changed(address, now)
                return False
        if count >= kind.pzd_words and tape.word(row, -kind.pzd_words) & CONTROLS:
            return False
        says_off = any([tape.word(row, at) in OFFS for at in range(count)])  # that which is owed
        if kind.may_be_reply(count) and not says_off:
            return False  # no question, but a word of its own that is wrong
        if tape.word(row, 0) >> 12 not in READS:
            raise Broken("WRITE", "drive %d at %d, which is asked what it is" % (address, now))
        return True

    def _judge_layout(self, row, tape, kind, task):
        """The panel divides its telegrams as its settings say, or as a mirror telegram did that
        has come back. Further words than STW and HSW are nothing."""
        now, address = tape.at_us[row], tape.address[row]
        before = kind.words
        count = tape.count[row]
        if not kind.send(count, task) and not self._is_newcomer(address, count, task):
            told = (count, address, kind.pzd_words, sorted(before), now)
            raise Broken("TELEGRAM", "%d words to drive %d, PZD %d, PKW %s, at %d" % told)
        kind = self.witness.kinds[address]
        if kind.words != before:
            self.witness.layout_changed(address, now)
        for place in range(2, kind.pzd_words):
            if tape.word(row, place - kind.pzd_words):
                raise Broken("TELEGRAM", "PZD%d of drive %d at %d" % (place + 1, address, now))

    def _is_newcomer(self, address, count, task):
        """Whether the panel asks whether an address is free that a drive is to be given: in the
        layout of that drive."""
        kinds = self.witness.kinds
        for _, question in self.witness.confirmed:
            old = self.plan.listed if question is None else (question[0],)
            for one in old:
                asked = question is None or question[1:] == (kinds[one].family.address, address)
                if asked and kinds[one].send(count, task):
                    kinds[address] = kinds[one]
                    return True
        return False

    def _judge_first(self, row, tape):
        self._begun_us = begun_us = self.witness.begun_us
        if tape.at_us[row] - self.witness.late_us < S:
            return
        if tape.silence_us[row] < LISTEN_US or tape.at_us[row] - begun_us < LISTEN_US:
            raise Broken("LISTEN", "the line was silent for %d us" % tape.silence_us[row])

    def _judge_word(self, case, address, stw, now):
        known = self.witness.kinds[address].family.known
        if not stw & CONTROLS or stw & ~ACKNOWLEDGE not in known:
            raise Broken("CONTROL", "%04X to drive %d at %d" % (stw, address, now))
        if stw & ACKNOWLEDGE:
            if stw & RUN or now - case.acknowledge_us > 30 * S:
                raise Broken("ACKNOWLEDGE", "%04X to drive %d at %d" % (stw, address, now))

    def _grace(self, since_us):
        """When a key that moved at `since_us` must have had its effect."""
        if self.witness.stalled_us > since_us:
            since_us = self.witness.stalled_us
        return since_us + self.witness.debounce_us

    def _judge_run(self, case, address, stw, hsw, now):
        witness = self.witness
        where = "%04X to drive %d at %d" % (stw, address, now)
        silent_us = now - case.answered_us
        if case.missed_us - case.answered_us > witness.lost_us + 10 * MS:
            raise Broken("LOST", "%s, silent for %d ms" % (where, silent_us // MS))
        if witness.hung_us is not None:
            stood_us = now - witness.hung_us
            if stood_us > DEAD_MAN_US + witness.exchange_us + 10 * MS:
                raise Broken("DEAD MAN", "%s, the loop stood for %d ms" % (where, stood_us // MS))
        stop_us = witness.down.get("STOP")
        if stop_us is not None and witness.hung_us is None and case.stop_us == stop_us:
            if now > self._grace(stop_us):
                raise Broken("STOP", "%s, and STOP is down" % where)
        is_on = stw & ON_BIT != 0
        begins = is_on and not case.stw & ON_BIT
        if is_on:
            self._judge_on(case, where, now)
            self._judge_direction(address, stw, hsw, where, now)
            self._judge_setpoint(address, hsw, now, where, begins)
        else:
            key = "JOG_RIGHT" if stw & JOG_BITS == JOG_RIGHT_BIT else "JOG_LEFT"
            self._judge_jog(case, key, where, now)
        if begins or not case.stw & RUN:
            begin(case, hsw)
            case.exposed_us = witness.exposed_us(address, case) if is_on else ALWAYS
        elif is_on:
            judge_rise(witness, case, hsw, now, where)
            judge_restart(witness, case, witness.sight_of(address), where, now)
        if stw != case.stw or hsw != case.hsw:
            case.reached = False
        if not case.stw & RUN:
            case.on_us = now
            self._judge_permission(case, address, not is_on, where, now)
        case.turned_us = now
        if case.owed_us > 0 and now > self._grace(case.owed_us):
            if witness.hung_us is None:
                raise Broken("STOP", "%s, and no OFF before it" % where)

    def _judge_permission(self, case, address, jogs, where, now):
        pressed_us = case.jog_us if jogs else case.used_us
        if now - self.tape.chance_us < MEANT_US:
            return
        reason = reason_against(self.witness, case, address, pressed_us, jogs)
        if reason is not None:
            raise Broken("REFUSED", "%s: %s" % (where, reason))
        if self.witness.sets.is_half(address):
            raise Broken("REFUSED", "%s, and it has half of a set" % where)
        if runs_on_unasked(self.witness, case, address, pressed_us, jogs):
            raise Broken("UNSUPERVISED", where)

    def _judge_on(self, case, where, now):
        if case.stw & ON_BIT:
            start_us = case.used_us
            if start_us <= case.void_us and case.start_us > case.void_us:
                start_us = case.start_us
        else:
            start_us = case.start_us
            if now - start_us > self._start_within_us():
                raise Broken("START", "%s, pressed at %d" % (where, start_us))
        if start_us <= case.void_us and now > self._grace(case.void_us):
            told = (where, start_us, case.void_us)
            raise Broken("START", "%s, pressed at %d, void from %d on" % told)
        if not case.stw & ON_BIT:
            case.used_us = start_us

    def _start_within_us(self):
        return start_us(self.plan, self.witness.turns)

    def _judge_direction(self, address, stw, hsw, where, now):
        reverse = self.witness.kinds[address].family.reverse
        if hsw:
            is_left = stw == reverse if reverse else hsw & 0x8000 != 0
            self.witness.locked.judge_direction(address, is_left, where, now)

    def _judge_jog(self, case, key, where, now):
        witness = self.witness
        other = "JOG_LEFT" if key == "JOG_RIGHT" else "JOG_RIGHT"
        pressed_us = witness.pressed_us[key]
        if pressed_us <= case.jog_void_us and now > self._grace(case.jog_void_us):
            raise Broken("JOG", "%s, by a key that had done its work" % where)
        case.jog_us = pressed_us
        witness.locked.judge_jog(pressed_us, where)
        if witness.is_sure() and self.cases[witness.shown] is not case:
            raise Broken("JOG", "%s, drive %d is shown" % (where, witness.shown))
        if witness.hung_us is not None:
            return
        if key not in witness.down and now > self._grace(witness.up[key]):
            raise Broken("JOG", "%s, the key is up" % where)
        if key in witness.down and now > self._grace(witness.down.get(other, ALWAYS)):
            raise Broken("JOG", "%s, both keys are down" % where)
        if key in witness.spoilt:
            raise Broken("JOG", "%s, the key was down at power-on" % where)
        if case.stw & ON_BIT:
            raise Broken("JOG", "%s, right behind ON" % where)
        if witness.menu_us > now - 100 * MS:
            if now - max(witness.menu_since_us, pressed_us) > witness.seen_us:
                raise Broken("JOG", "%s, in the menu" % where)

    def _judge_setpoint(self, address, hsw, now, where, begins):
        if hsw & 0x8000 and self.witness.kinds[address].family.reverse:
            raise Broken("SETPOINT", "%s, HSW %04X, and there is a word for it" % (where, hsw))
        limited = self.witness.limited(address)
        for scaling in scalings(self.witness.meant(address)):
            for values in limited:
                if scaling.allows(magnitude(hsw), values, self.plan.settings, begins):
                    return
        if not limited:
            return
        raise Broken("SETPOINT", "%s, HSW %04X" % (where, hsw))

    def _judge_off(self, case, address, stw, now):
        off = stw & ~ACKNOWLEDGE
        if off != OFF1:
            case.second_us = now
        elif case.stw != OFF1 and not case.stw & RUN:
            self._judge_back(case, address, now)
        if off != case.stw:
            case.second_since_us = now
        if off != OFF1 and off != case.stw:
            self._judge_second_stop(case, address, off, now)
        if not case.stw & RUN:
            return
        jogged = not case.stw & 1
        if jogged:
            case.jog_void_us = max(case.jog_void_us, case.jog_us)
        if case.used_us <= case.void_us or case.start_us <= case.used_us:
            case.void_us = max(case.void_us, case.used_us)
        if now > case.excused_us and not self.has_reason(case, now, jogged):
            raise Broken("WITHOUT REASON", "%04X to drive %d at %d" % (stw, address, now))

    def _judge_back(self, case, address, now):
        """From OFF2 or OFF3 to OFF1: when the drive has heard it, or is lost."""
        if case.answered_us > case.second_since_us or now < case.excused_us:
            return
        if (
            now - case.answered_us < self.witness.lost_us * 9 // 10
            and self.witness.hung_us is None
        ):
            raise Broken("SECOND STOP", "drive %d never heard it, at %d" % (address, now))

    def has_reason(self, case, now, jogged):
        witness = self.witness
        let_go = len(witness.down) != 1 or now - max(witness.up.values()) < 2 * S
        return (
            (jogged and let_go)
            or self._is_stopping(case, now)
            or now - case.heard_us > witness.lost_us * 9 // 10
            or (not case.ran and now - case.on_us > 4 * S)
            or case.again_us > case.on_us  # r2024 tells it, of many drives that run after a while
            or now - self.tape.chance_us < 2 * S + witness.cycle_us
            or witness.hung_us is not None
        )

    def _is_stopping(self, case, now):
        """Whether STOP stops this drive: it is the one shown, or the key is held for 4 s."""
        witness = self.witness
        if now < witness.all_until_us + 2 * S:
            return True
        is_down = "STOP" in witness.down
        if is_down and now - witness.stop_from_us > ALL_STOP_US - 150 * MS:
            return True
        if not is_down and now - witness.up["STOP"] > 2 * S:
            return False
        return witness.stopping is None or case in witness.stopping

    def _judge_second_stop(self, case, address, off, now):
        witness = self.witness
        if witness.stopping is not None and case not in witness.stopping:
            raise Broken("SECOND STOP", "%04X to drive %d, which is not shown" % (off, address))
        pressed_us = witness.stop_from_us if "STOP" in witness.down else None
        if pressed_us is None and now - witness.up["STOP"] < 200 * MS + witness.exchange_us:
            pressed_us = min(case.stop_us, witness.stop_from_us)
        if case.sent_us < witness.held_us + SECOND_STOP_US + witness.debounce_us:
            pressed_us = witness.held_us  # the line was busy: no telegram went to it since then
        held_us = now - (pressed_us if pressed_us is not None else ALWAYS)
        if off != witness.second_stop or held_us < SECOND_STOP_US - 50 * MS:
            told = (off, address, now, held_us // MS)
            raise Broken("SECOND STOP", "%04X to drive %d at %d, held for %d ms" % told)

    def _judge_owed(self, told, now):
        """A telegram went to `told` while others are owed an OFF, which goes before all but other
        stops.
        """
        for case in self.witness.owed:
            if (
                case is not told
                and self.witness.hung_us is None
                and now > self._grace(case.owed_us)
            ):
                case.owed_requests += 1
                if case.owed_requests > 2 + self._running() and now > self.witness.all_until_us:
                    address = self.cases.index(case)
                    raise Broken("STOP", "drive %d was not told within two telegrams" % address)

    def _running(self):
        return sum(1 for case in self.cases if case.stw & RUN or case.turned_us > case.owed_us > 0)

    def _judge_task(self, task, number, index, words, now, address):
        witness = self.witness
        if task in READS:
            return
        high, value = words
        number += 2000 if index & 0x8000 else 0
        family = witness.kinds[address].family
        self.cases[address].changes(now)
        if number == family.address:
            witness.moves(address, value)
        where = "parameter %d of drive %d, task %d at %d" % (number, address, task, now)
        witness.locked.judge_write(where, now)
        if task not in RAM_WRITES and task not in EEPROM_WRITES:
            raise Broken("TELEGRAM", where)
        if witness.sets.writes(address, now):
            what = number, index & 0xFF, high << 16 | value
            witness.sets.judge_write(address, what, task, family, where)
            return
        is_dangerous = number in family.dangerous
        commissioned, bits = witness.commissioned, high << 16 | value
        is_asked = is_dangerous or number == IDENTIFIES
        is_step = commissioned.has_asked(address, number, bits, is_asked, now)
        if is_step:
            pass
        elif commissioned.is_open(now):
            raise Broken("WRITE", "%s: %08X, and no step asked for that" % (where, bits))
        elif is_dangerous and now > witness.wishes.get("write", NEVER):
            raise Broken("WRITE", where)
        elif is_dangerous and not self._is_confirmed((address, number, value), family, now):
            raise Broken("WRITE", "%s: %d, and that was not asked" % (where, value))
        elif not is_dangerous and now - witness.set_us > witness.wish_us:
            raise Broken("WRITE", where)
        if task in EEPROM_WRITES and family.save is not None:
            raise Broken("EEPROM", "%s, which no task can write" % where)
        if number == family.save or task in EEPROM_WRITES and number not in family.permanent:
            is_offered = number in OFFERED and now <= witness.wishes.get("offer", NEVER)
            is_offered = is_offered or is_step and number == family.save
            if now > witness.wishes.get("eeprom", NEVER) and not is_offered:
                raise Broken("EEPROM", where)

    def _is_confirmed(self, written, family, now):
        for until_us, question in self.witness.confirmed:
            if until_us < now:
                continue
            if question is None or question == written:
                return True
            # A drive is told its new address at the old one, and there, until it has said yes.
            address = question[2]
            if written[1:] == question[1:] == (family.address, address) and written[0] == address:
                return True
        return False

    def judge_motors(self, now):
        for index, drive in enumerate(self.drives):
            starts = drive.starts
            if starts != self.starts[index]:
                self.starts[index] = starts
                case = self.cases[drive.address]
                begin_again(case, now)
                is_late = now - case.turned_us > S + self.witness.exchange_us
                if is_late and not self._is_garbage(drive):
                    raise Broken("TURNS", "the motor of drive %d starts" % drive.address)

    def _is_garbage(self, drive):
        """Whether a drive got what no panel sends: what faults of the line left of telegrams."""
        weather, family = self.witness.weather, self.witness.kinds[drive.address].family
        return weather.faults is not None and drive.stw & ~ACKNOWLEDGE not in family.known

    def _judge_line(self):
        wire = self.world.wire
        helpless = (
            self.witness.stuck_us is not None
            or self.clock.now_us - self.witness.boot_us < 200 * MS
        )
        # If a plug is pulled within a character, that character is not heard, but is no silence.
        pulled = self.clock.now_us - self.witness.pulled_us < 100 * MS
        if not helpless and not pulled:
            raise Broken("LINE", wire.violations()[0])
        wire.forgive()
