"""The judge of a soak: what the panel sends, held against what a hand at its keys has asked for.

He knows the keys, the line, the loop and the display's picture, and asks the firmware nothing. He
plays back the tape after every slice of time and before every key that moves, so that each
telegram is judged by the keys as they were when it began. Where a person could not tell either
(which of two keys came first, which drive is shown while the address keys move) he lets pass what
either way allows.

    judge = Judge(world, plan)
    judge.look()                    # after every slice: raises Broken
    judge.key("START", True)        # before the key moves
    judge.hangs(True)
"""

from boards.sim.board import KEYS
from tools.soaking.rules import Broken
from tools.soaking.tape import MALFORMED, REQUEST, Tape

MS = 1000
S = 1_000_000

# Control words of USS (specification C-5.2.1), as a panel that never gives control away sends them.
OFF1, OFF2, OFF3 = 0x047E, 0x047C, 0x047A
ON, ON_REVERSE, JOG_RIGHT, JOG_LEFT = 0x047F, 0x0C7F, 0x057E, 0x067E
ACKNOWLEDGE = 0x0080
RUN = 0x0301  # bits of which each turns the motor
OFFS = (OFF1, OFF2, OFF3)
KNOWN = OFFS + (ON, ON_REVERSE, JOG_RIGHT, JOG_LEFT)
SECOND_STOPS = {"OFF3": OFF3, "OFF2": OFF2, "none": OFF1}

ZSW_RUNNING, ZSW_FAULT, ZSW_INHIBIT = 0x0004, 0x0008, 0x0040

# Task ids (specification C-4.2.1, table 4.1).
READS = (0, 1, 4, 6, 9)
RAM_WRITES = (2, 3, 7, 8)
EEPROM_WRITES = (11, 12, 13, 14)

# DESIGN, rule 7, and those among them that must not be forgotten by the drive.
DANGEROUS = (
    3, 10, 700, 719, 840, 918, 927, 970, 1000, 1070, 2000, 2009, 2010, 2011, 2012, 2013, 2014,
    2016, 2019, 2023, 3900,
)  # fmt: skip
PERMANENT = (2010, 2011, 2012, 2013)
QUESTIONS = ("SET=DO  PARAM=NO", "SET=FIX START=GO")

# How long the panel may take: a key settles in 20 ms and bounces for up to 5; two steps of the
# loop, 4 ms each at the most, and those of a drawing that is under way.
DEBOUNCE_US = 45 * MS
SHORT_CHORD_US = 120 * MS  # within which nobody can tell which of two keys came first
DEAD_MAN_US = 300 * MS
SECOND_STOP_US = 1_500 * MS
ALL_STOP_US = 4_000 * MS
START_S = 10  # a START that has not led to ON by then is forgotten, and 14 exchanges each
HELD_SET_US = 1_400 * MS
WISH_US = 40 * S  # a write that SET has asked for is over by then
SETTINGS_US = 60 * S  # so long settings that the drive has had may still count
STUCK_US = 5_000 * MS  # a bus that stands for so long makes the watchdog bite
WATCHDOG_US = 2_000 * MS
NEVER = -1_000_000_000_000
ALWAYS = 1 << 60


class Case:
    """What is known of one address on the line."""

    def __init__(self):
        self.start_us = NEVER  # START pressed for it
        self.used_us = NEVER  # the START that the ON in force goes back to
        self.void_us = NEVER  # STARTs up to here do not count any more
        self.on_us = NEVER  # first telegram of the ON or JOG in force
        self.stw = OFF1  # sent last
        self.sent_us = NEVER
        self.answered_us = NEVER  # end of its last whole reply
        self.heard_us = NEVER  # the last one that the panel is sure to have taken
        self.hsw = 0  # sent last
        self.asked_us = NEVER  # the last request, if no reply has come to it
        self.missed_us = NEVER  # a request that stayed without a reply, the last one
        self.zsw = 0
        self.ran = False  # since ON was sent first
        self.ran_us = NEVER  # seen running last
        self.turned_us = NEVER  # ON or JOG sent last
        self.stop_us = NEVER  # STOP pressed for it last
        self.owed_us = NEVER  # STOP pressed, and no OFF sent since
        self.owed_requests = 0  # to whomever, since that must have had its effect
        self.brakes = False  # it was to stop already when STOP was pressed
        self.jog_us = NEVER  # when the key was pressed whose jog is in force
        self.jog_void_us = NEVER  # jog keys pressed up to here do not count any more
        self.excused_us = NEVER  # until when an OFF needs no other reason
        self.acknowledge_us = NEVER  # STOP that may acknowledge
        self.second_us = NEVER  # OFF2 or OFF3 sent last


class Judge:
    """world: a `SoakWorld`. plan: its `Plan`. reader: the `Reader` of its display."""

    def __init__(self, world, plan):
        self.world = world
        self.plan = plan
        self.tape = Tape(world.wire)
        self.cases = [Case() for _ in range(32)]
        self.clock = world.clock
        self.drives = list(world.drives.values())
        self.starts = [0] * len(self.drives)  # of their motors, as counted last
        self.exchange_us = _exchange_us(plan)
        self.cycle_us = self.exchange_us * len(plan.addresses)
        self.timeout_us = plan.settings.get("reply_timeout_ms", 20) * MS
        self.lost_us = plan.settings.get("lost_ms", 1000) * MS
        self.second_stop = SECOND_STOPS[plan.settings.get("second_stop", "OFF3")]
        self.down = {}  # key -> since when
        self.up = {key: NEVER for key in KEYS}  # key -> when it was let go
        self.pressed_us = dict(self.up)  # key -> when it last went down
        self.spoilt = {}  # keys that must go up before they count -> True
        self.boot_us = 0
        self.first_sent = self.tape.sent
        self.hung_us = None  # since when the loop stands still
        self.hang_us = NEVER  # the end of the last hang that mattered
        self.stalled_us = NEVER  # the end of the last standstill of any kind
        self.weather = None  # a `Weather`: what befalls the line
        self.late_us = NEVER  # the line was not its best lately
        self.stop_key_cut = False
        self.wishes = {}  # "write" and "eeprom" -> until when
        self.set_us = NEVER
        self.unsettled = []  # replies that may still be spoilt: row, case, whether it has stopped
        self.owed = []  # cases that wait for their OFF
        self.all_until_us = NEVER  # until when every drive is being stopped, one after the other
        self.second_owed = None  # the drive that a STOP, if it is held, stops by OFF2 or OFF3
        self.shown = None  # the address shown, None while it cannot be told
        self.unsure_us = 0  # until when it cannot
        self.limits = {a: [(ALWAYS, limits_of(d))] for a, d in world.drives.items()}
        self.resets = 0
        self.exchanges = 0
        self.spoken_us = 0
        self.stirred_us = 0  # when something was last done to keys, drives, line or loop
        self.stuck_us = None  # since when the chip's timers are dead
        world.witness = self

    # --- what the hand tells --------------------------------------------------------------------

    def key(self, key, down):
        """A key is about to move."""
        self.look()
        self.stirred_us = now = self.clock.now_us
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
        if key == "STOP":
            self._stop_pressed(now)
        elif key == "START":
            self._start_pressed(now)
        elif key.startswith("ADDRESS"):
            self._selects(now)
        elif key == "SET":
            self._set_pressed(now)

    def candidates(self):
        """Cases of the drives that may be the one shown."""
        if self.shown is not None and self.clock.now_us > self.unsure_us:
            return (self.cases[self.shown],)
        return self.cases

    def is_sure(self):
        return self.shown is not None and self.clock.now_us > self.unsure_us

    def _selects(self, now):
        recently = now - SHORT_CHORD_US
        if self.down.get("START", NEVER) > recently:
            for case in self.cases:
                case.start_us = now
        self.shown = None
        self.unsure_us = ALWAYS

    def _start_pressed(self, now):
        stop_us = self.down.get("STOP")
        if stop_us is not None and now - stop_us > SHORT_CHORD_US:
            return
        for case in self.candidates():
            case.start_us = now

    def _stop_pressed(self, now):
        for case in self.candidates():
            case.acknowledge_us = now
            case.excused_us = max(case.excused_us, now + 600 * MS + 4 * self.exchange_us)
        self.second_owed = None
        if self.is_sure():
            case = self.cases[self.shown]
            if self.second_stop != OFF1:
                self.second_owed = case
            case.brakes = not case.stw & RUN
            case.stop_us = now
            case.void_us = now
            case.owed_us = now
            case.owed_requests = 0
            if case not in self.owed:
                self.owed.append(case)

    def _stop_is_up(self, now, held_us):
        if held_us > ALL_STOP_US - 100 * MS:
            drives = len(self.plan.addresses)
            self.all_until_us = now + drives * (2 * self.exchange_us + 10 * MS)

    def _set_pressed(self, now):
        self.set_us = now
        if self.world_asks():
            self.wishes["write"] = now + WISH_US
            self.shown = None
            self.unsure_us = now + 2 * S + 3 * self.cycle_us

    def world_asks(self):
        """Whether the display asks, or asked just now, whether to write."""
        return self.asked_us > self.clock.now_us - 500 * MS

    asked_us = NEVER  # the reader notes it

    # --- what the world tells -------------------------------------------------------------------

    def reset(self, bitten):
        """The chip is about to restart."""
        now = self.clock.now_us
        self.resets += 1
        self._play()
        if bitten:
            stood_us = 0 if self.hung_us is None else now - self.hung_us
            if stood_us < WATCHDOG_US - 200 * MS and self.stuck_us is None:
                raise Broken("WATCHDOG", "it bit at %d, the loop was alive" % now)

    def sticks(self):
        """The chip's timers die: nothing ends a transmission any more."""
        self.look()
        self.stuck_us = self.stirred_us = self.clock.now_us
        for case in self.cases:
            case.excused_us = ALWAYS

    def booted(self):
        """The chip has restarted; the firmware is about to begin."""
        now = self.clock.now_us
        self.boot_us = now
        self.stirred_us = now
        self.stalled_us = now
        self.stuck_us = None
        self.spoken_us = now
        self.first_sent = self.tape.sent
        if self.hung_us is not None:
            self.hung_us = None
        for case in self.cases:
            case.void_us = now
            case.owed_us = NEVER
            case.excused_us = now + 3 * S
            case.stw = OFF1
            case.jog_void_us = now
        for key in self.down:
            self.spoilt[key] = True
        self.wishes.clear()
        del self.owed[:]
        self.shown = None
        self.unsure_us = now + 1_500 * MS

    def flash_written(self):
        """The chip stands still: a step of writing its flash."""
        now = self.clock.now_us
        self.stalled_us = now
        for address, case in enumerate(self.cases):
            if case.stw & RUN and now - case.sent_us < S:
                raise Broken("FLASH", "written at %d while drive %d is on" % (now, address))

    def hangs(self, on):
        """The main loop stops, or goes on."""
        self.look()
        self.stirred_us = now = self.clock.now_us
        if on:
            self.hung_us = now
            return
        if self.hung_us is None:
            return  # the watchdog has bitten
        if now - self.hung_us > DEAD_MAN_US - 20 * MS:
            for case in self.cases:
                case.excused_us = now + 3 * S
        if now - self.hung_us > DEAD_MAN_US + 20 * MS:
            for case in self.cases:
                if case.start_us < self.hung_us - 60 * MS:
                    case.void_us = self.hung_us
                case.jog_void_us = max(case.jog_void_us, self.hung_us - 60 * MS)
        if now - self.hung_us > WATCHDOG_US + 300 * MS:
            raise Broken("WATCHDOG", "the loop stood still for %d ms" % (_ms(now - self.hung_us)))
        self.hung_us = None
        self.stalled_us = now

    def meddled(self, drive):
        """Somebody has changed parameters at the drive itself."""
        self.look()
        self.stirred_us = now = self.clock.now_us
        for address, other in self.world.drives.items():
            if other is drive:
                self._note_limits(address, drive, now)
        self.cases[drive.address].excused_us = now + 30 * S

    def _note_limits(self, address, drive, now):
        history = self.limits[address]
        history[-1] = (now + SETTINGS_US, history[-1][1])
        history.append((ALWAYS, limits_of(drive)))
        while history[0][0] < now:
            del history[0]

    def excuse(self, address, s=5):
        """Something is being done to this drive that may stop it."""
        self.look()
        self.stirred_us = now = self.clock.now_us
        self.cases[address].excused_us = now + s * S

    # --- judging --------------------------------------------------------------------------------

    def look(self):
        """Judge what has happened since the last look."""
        now = self.clock.now_us
        if self.weather is not None and self.weather.is_bad():
            self.late_us = self.stirred_us = now
        if self.unsettled:
            self._settle_replies(now)
        self._play()
        world = self.world
        chip = world.chip
        if chip.handler_errors:
            raise Broken("EXCEPTION", "interrupt handler: %r" % chip.handler_errors[0])
        failure = world.app.pacer.failure
        if failure is not None:
            raise Broken("EXCEPTION", "the bus engine: %r" % failure)
        if world.wire.violation_count:
            self._judge_line()
        if world.lcd_chip._complained:
            raise Broken("DISPLAY", world.lcd_chip.complaints[0])
        if self.tape.sent_us > self.spoken_us:
            self.spoken_us = self.tape.sent_us
        if self.stuck_us is not None:
            if now - self.stuck_us > STUCK_US + self.exchange_us:
                raise Broken("WATCHDOG", "the bus stands since %d" % self.stuck_us)
        elif now - max(self.spoken_us, self.late_us) > self.patience_us() and self.hung_us is None:
            raise Broken("SILENT PANEL", "no telegram for %d ms" % _ms(now - self.spoken_us))
        self._judge_motors(now)
        down = self.down
        if down:
            if "STOP" in down and "STOP" not in self.spoilt:
                self._judge_held_stop(now, now - down["STOP"])
            if "SET" in down and now - down["SET"] > HELD_SET_US:
                self.wishes["eeprom"] = now + WISH_US

    def _judge_held_stop(self, now, held_us):
        """What a STOP that is held must have led to by now."""
        pressed_us = now - held_us
        if max(self.stalled_us, self.late_us) > pressed_us or self.hung_us is not None:
            return
        patience_us = DEBOUNCE_US + 4 * self.exchange_us
        if self.second_owed is not None and held_us > SECOND_STOP_US + patience_us:
            if self.second_owed.second_us < pressed_us:
                raise Broken("SECOND STOP", "not sent at %d" % now)
        patience_us += len(self.plan.addresses) * (2 * self.exchange_us + 10 * MS)
        if held_us > ALL_STOP_US + patience_us:
            for address, case in enumerate(self.cases):
                if case.stw & RUN:
                    raise Broken("STOP ALL", "drive %d is still told to run" % address)

    def patience_us(self):
        return 3_500 * MS + self.exchange_us

    def _play(self):
        tape = self.tape
        for row in tape.news():
            kind = tape.kind[row]
            if kind == REQUEST:
                self._judge_request(row, tape)
            elif kind == MALFORMED:
                raise Broken("TELEGRAM", "at %d" % tape.at_us[row])
            else:
                self._take_reply(row, tape)

    def _take_reply(self, row, tape):
        at = 6 * row
        case = self.cases[tape.address[row]]
        now = tape.end_us[row]
        zsw = tape.words[at + 4]
        if case.missed_us - case.answered_us > self.lost_us + 100 * MS:
            case.void_us = max(case.void_us, now - SHORT_CHORD_US)
            case.excused_us = now + 2 * S + self.cycle_us
            case.heard_us = NEVER
        case.answered_us = now
        case.asked_us = NEVER
        case.zsw = zsw
        if zsw & ZSW_RUNNING:
            case.ran_us = now
        stops = False
        if case.stw & RUN:
            if zsw & ZSW_RUNNING:
                case.ran = True
            stops = zsw & (ZSW_FAULT | ZSW_INHIBIT) or case.ran and not zsw & ZSW_RUNNING
            if stops:
                case.excused_us = now + 2 * S + self.cycle_us
        self.unsettled.append((row, case, stops))

    def _settle_replies(self, now):
        """Those by now that the panel must have taken."""
        tape = self.tape
        waiting = []
        for one in self.unsettled:
            row, case, stops = one
            if not tape.is_settled(row, now):
                waiting.append(one)
            elif self._is_sure(row, tape):
                case.heard_us = max(case.heard_us, tape.end_us[row])
                if stops:
                    case.void_us = max(case.void_us, tape.end_us[row])
        self.unsettled = waiting

    def _is_sure(self, row, tape):
        """Whether the panel must have taken this reply."""
        delay_us = tape.delay_us[row]
        return (
            tape.flawless[row]
            and self.world.wire.start_interval_us + 200 < delay_us < self.timeout_us - MS
            and not (self.weather is not None and self.weather.may_be_deaf())
        )

    def _judge_request(self, row, tape):
        now = tape.at_us[row]
        address = tape.address[row]
        at = 6 * row
        words = tape.words
        stw = words[at + 4]
        case = self.cases[address]
        self.exchanges += 1
        if self.first_sent is not None:
            self._judge_first(row, tape)
        task = words[at] >> 12
        if case.asked_us > 0:
            case.missed_us = case.asked_us
        case.asked_us = now
        if self.owed:
            self._judge_owed(case, now)
        if task and task != 1:
            self._judge_task(task, words[at] & 0x7FF, words[at + 1], now, address)
        if not stw & RUN and self.owed and case in self.owed and now >= case.owed_us:
            self.owed.remove(case)
            case.owed_us = NEVER
        if stw == OFF1 and case.stw == OFF1:
            case.sent_us = now
            if words[at + 5]:
                raise Broken("SETPOINT", "%04X with OFF" % words[at + 5])
            return
        self._judge_word(case, address, stw, now)
        if stw & RUN:
            self._judge_run(case, address, stw, words[at + 5], now)
        else:
            self._judge_off(case, address, stw, now)
            if words[at + 5]:
                raise Broken("SETPOINT", "%04X with OFF" % words[at + 5])
        case.stw = stw & ~ACKNOWLEDGE
        case.hsw = words[at + 5]
        case.sent_us = now

    def _judge_first(self, row, tape):
        self.first_sent = None
        if tape.at_us[row] - self.late_us < S:
            return
        if tape.silence_us[row] < 95 * MS or tape.at_us[row] - self.boot_us < 95 * MS:
            raise Broken("LISTEN", "the line was silent for %d us" % tape.silence_us[row])

    def _judge_word(self, case, address, stw, now):
        if not stw & 0x0400 or stw & ~ACKNOWLEDGE not in KNOWN:
            raise Broken("CONTROL", "%04X to drive %d at %d" % (stw, address, now))
        if stw & ACKNOWLEDGE:
            if stw & RUN or now - case.acknowledge_us > 30 * S:
                raise Broken("ACKNOWLEDGE", "%04X to drive %d at %d" % (stw, address, now))

    def _grace(self, since_us):
        """From when on a key moved at `since_us` must have had its effect."""
        if self.stalled_us > since_us:
            since_us = self.stalled_us
        return since_us + DEBOUNCE_US

    def _judge_run(self, case, address, stw, hsw, now):
        where = "%04X to drive %d at %d" % (stw, address, now)
        silent_us = now - case.answered_us
        if case.missed_us - case.answered_us > self.lost_us + 10 * MS:
            raise Broken("LOST", "%s, silent for %d ms" % (where, _ms(silent_us)))
        if self.hung_us is not None:
            stands_us = now - self.hung_us
            if stands_us > DEAD_MAN_US + self.exchange_us + 10 * MS:
                raise Broken("DEAD MAN", "%s, the loop stands for %d ms" % (where, _ms(stands_us)))
        stop_us = self.down.get("STOP")
        if stop_us is not None and self.hung_us is None and case.stop_us == stop_us:
            if now > self._grace(stop_us):
                raise Broken("STOP", "%s, and STOP is down" % where)
        if stw in (ON, ON_REVERSE):
            self._judge_on(case, address, where, now)
            self._judge_setpoint(address, hsw, now, where)
        else:
            self._judge_jog(case, address, "JOG_RIGHT" if stw == JOG_RIGHT else "JOG_LEFT", where, now)
        if not case.stw & RUN:
            case.on_us = now
            case.ran = False
        case.turned_us = now
        if case.owed_us > 0 and now > self._grace(case.owed_us):
            if self.hung_us is None:
                raise Broken("STOP", "%s, and no OFF before it" % where)

    def _judge_on(self, case, address, where, now):
        if case.stw & RUN and case.stw in (ON, ON_REVERSE):
            start_us = case.used_us
            if start_us <= case.void_us and case.start_us > case.void_us:
                start_us = case.start_us
        else:
            start_us = case.start_us
            if now - start_us > START_S * S + 28 * self.cycle_us:
                raise Broken("START", "%s, pressed at %d" % (where, start_us))
        if start_us <= case.void_us and now > self._grace(case.void_us):
            raise Broken("START", "%s, pressed at %d, void from %d on" % (where, start_us, case.void_us))
        if case.stw not in (ON, ON_REVERSE):
            case.used_us = start_us

    def _judge_jog(self, case, address, key, where, now):
        other = "JOG_LEFT" if key == "JOG_RIGHT" else "JOG_RIGHT"
        pressed_us = self.pressed_us[key]
        if pressed_us <= case.jog_void_us and now > self._grace(case.jog_void_us):
            raise Broken("JOG", "%s, by a key that had done its work" % where)
        case.jog_us = pressed_us
        if self.is_sure() and self.cases[self.shown] is not case:
            raise Broken("JOG", "%s, drive %d is shown" % (where, self.shown))
        if self.hung_us is not None:
            return
        if key not in self.down and now > self._grace(self.up[key]):
            raise Broken("JOG", "%s, the key is up" % where)
        if key in self.down and now > self._grace(self.down.get(other, ALWAYS)):
            raise Broken("JOG", "%s, both keys are down" % where)
        if key in self.spoilt:
            raise Broken("JOG", "%s, the key was down at power-on" % where)
        if case.stw in (ON, ON_REVERSE):
            raise Broken("JOG", "%s, right behind ON" % where)

    def _judge_setpoint(self, address, hsw, now, where):
        for until_us, limits in self.limits.get(address, ()):
            if until_us >= now and limits.allow(hsw, self.plan.settings):
                return
        if address not in self.limits or address != self.world.drives[address].address:
            return  # it was given another address: nobody knows whose limits these are
        raise Broken("SETPOINT", "%s, HSW %04X" % (where, hsw))

    def _judge_off(self, case, address, stw, now):
        off = stw & ~ACKNOWLEDGE
        if off != OFF1:
            case.second_us = now
        if off != OFF1 and off != case.stw:
            self._judge_second_stop(case, address, off, now)
        if not case.stw & RUN:
            return
        jogged = not case.stw & 1
        if jogged:
            case.jog_void_us = max(case.jog_void_us, case.jog_us)
        if case.used_us <= case.void_us or case.start_us <= case.used_us:
            case.void_us = max(case.void_us, case.used_us)
        if now > case.excused_us and not self._has_reason(case, now, jogged):
            raise Broken("WITHOUT REASON", "%04X to drive %d at %d" % (stw, address, now))

    def _has_reason(self, case, now, jogged):
        if jogged and len(self.down) != 1:
            return True
        if jogged and now - max(self.up.values()) < 2 * S:
            return True
        if "STOP" in self.down or now - self.up["STOP"] < 2 * S or self.stop_key_cut:
            return True
        if now - case.heard_us > self.lost_us * 9 // 10:
            return True
        if not case.ran and now - case.on_us > 4 * S:
            return True
        return self.hung_us is not None

    def _judge_second_stop(self, case, address, off, now):
        pressed_us = self.down.get("STOP")
        if pressed_us is None and now - self.up["STOP"] < 200 * MS + self.exchange_us:
            pressed_us = case.stop_us
        held_us = now - (pressed_us if pressed_us is not None else ALWAYS)
        if off != self.second_stop or held_us < SECOND_STOP_US - 50 * MS:
            raise Broken(
                "SECOND STOP", "%04X to drive %d at %d, held %d ms" % (off, address, now, _ms(held_us))
            )

    def _judge_owed(self, told, now):
        """A telegram to `told`; an OFF is owed to others: it goes before all but other stops."""
        for case in self.owed:
            if case is not told and self.hung_us is None and now > self._grace(case.owed_us):
                case.owed_requests += 1
                if case.owed_requests > 2 + self._running() and now > self.all_until_us:
                    address = self.cases.index(case)
                    raise Broken("STOP", "drive %d was not told within two telegrams" % address)

    def _running(self):
        return sum(1 for case in self.cases if case.stw & RUN or case.turned_us > case.owed_us > 0)

    def _judge_task(self, task, number, index, now, address):
        if task in READS:
            return
        number += 2000 if index & 0x8000 else 0
        where = "parameter %d of drive %d, task %d at %d" % (number, address, task, now)
        if task not in RAM_WRITES and task not in EEPROM_WRITES:
            raise Broken("TELEGRAM", where)
        if number in DANGEROUS and now > self.wishes.get("write", NEVER):
            raise Broken("WRITE", where)
        if number not in DANGEROUS and now - self.set_us > WISH_US:
            raise Broken("WRITE", where)
        if task in EEPROM_WRITES and number not in PERMANENT:
            if now > self.wishes.get("eeprom", NEVER):
                raise Broken("EEPROM", where)

    def _judge_motors(self, now):
        for index, drive in enumerate(self.drives):
            starts = drive.starts
            if starts != self.starts[index]:
                self.starts[index] = starts
                case = self.cases[drive.address]
                if now - case.turned_us > S + self.exchange_us:
                    raise Broken("TURNS", "the motor of drive %d starts" % drive.address)

    def _judge_line(self):
        wire = self.world.wire
        if self.stuck_us is None and self.clock.now_us - self.boot_us > 200 * MS:
            raise Broken("LINE", wire.violations[0])
        wire.forgive()


class Limits:
    """What a drive lets a setpoint be: P1080, P1082, P2000, and whether PZD2 is in 0.01 Hz."""

    def __init__(self, lowest_hz, highest_hz, reference_hz, absolute):
        self.lowest_hz = lowest_hz
        self.highest_hz = highest_hz
        self.reference_hz = reference_hz
        self.absolute = absolute

    def hz(self, hsw):
        return hsw / 100 if self.absolute else hsw * self.reference_hz / 0x4000

    def allow(self, hsw, settings):
        if hsw & 0x8000:
            return False
        hz = self.hz(hsw)
        highest_hz = min(self.highest_hz, settings.get("highest_centihertz", 65000) / 100)
        lowest_hz = max(self.lowest_hz, settings.get("lowest_centihertz", 0) / 100)
        full_hz = 327.67 if self.absolute else 1.99994 * self.reference_hz
        highest_hz = min(highest_hz, full_hz)
        lowest_hz = min(lowest_hz, highest_hz)
        slack_hz = 0.006 + self.reference_hz / 0x4000
        return lowest_hz - slack_hz <= hz <= highest_hz + slack_hz


def limits_of(drive):
    try:
        absolute = bool(drive.read(2009))
    except KeyError:
        absolute = False
    try:
        return Limits(drive.read(1080), drive.read(1082), drive.read(2000), absolute)
    except KeyError:
        return Limits(0, 650, 50, False)


def _exchange_us(plan):
    """The longest exchange on this line: the reply comes, and ends, at the last moment."""
    character_us = -(-11_000_000 // plan.baud)
    timeout_us = max(plan.settings.get("reply_timeout_ms", 20) * MS, 4 * character_us)
    return 2 * character_us + 16 * character_us + timeout_us + 25 * character_us


def _ms(us):
    return us // MS
