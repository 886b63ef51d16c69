# SPDX-License-Identifier: MIT
"""Planted bugs. A soak must find them, or it proves nothing.

Each row of MUTATIONS plants one bug. host_tests/tools/test_soak_mutations.py applies each to a
copy of firmware/, and soaks that with the row's seed.
"""

import itertools

from tools.soaking.dice import may


class Mutation:
    """name; why it matters; rules, one of which the soak must name; the seed that finds it;
    changes, each (file below firmware/, old text, new text). roams: the operator opens menu and
    search. given_to: what he has to be given to (`dice.GIVEN_TO`), if it is anything.
    """

    roams = True
    given_to = None

    def __init__(self, name, why, rules, seed, *changes):
        self.name = name
        self.why = why
        self.rules = rules
        self.seed = seed
        self.changes = changes

    def seeds(self, count):
        """The first ones whose operator is given to what finds it."""
        given_to = self.given_to
        seeds = (seed for seed in itertools.count(1) if not given_to or may(given_to, seed))
        return list(itertools.islice(seeds, count))

    def apply(self, folder):
        """Change the copy of firmware/ in `folder`, a Path. LookupError if an old text is gone."""
        for name, old, new in self.changes:
            path = folder / name
            text = path.read_text(encoding="utf-8")
            if text.count(old) != 1:
                raise LookupError(
                    f"mutation {self.name}: firmware/{name} has {text.count(old)} times\n{old}"
                )
            path.write_text(text.replace(old, new), encoding="utf-8")


class AtHome(Mutation):
    """Found by an operator who opens neither menu nor search, because he needs all of his time."""

    roams = False


class Typing(AtHome):
    given_to = "types"


class LookingUp(Mutation):
    given_to = "looks_up"


class Diagnosing(Mutation):
    given_to = "diagnoses"


class Commissioning(Mutation):
    given_to = "commissions"


class Locking(Mutation):
    given_to = "locks"


class Arranging(Mutation):
    given_to = "arranges"


class Resetting(Mutation):
    given_to = "resets"


MUTATIONS = (
    Mutation(
        "jog bit kept",
        "a jog goes on when its key is let go",
        ("JOG",), 741,
        (
            "panel/keys/jog_keys.py",
            "if down != self._key or control is not",
            "if down & ~self._key or control is not",
        ),
    ),
    Mutation(
        "both jog keys",
        "two jog keys at once are one",
        ("JOG",), 782,
        (
            "panel/keys/jog_keys.py",
            "if down != self._key or control is not",
            "if not down & self._key or control is not",
        ),
    ),
    AtHome(
        "BCC unchecked",
        "a spoilt reply counts",
        ("WITHOUT REASON", "SHOWN", "LOST", "START"), 743,
        (
            "uss/telegram.py",
            "    if exclusive_or(buffer, count):\n        return BAD_BCC\n",
            "",
        ),
        ("uss/fast/viper.py", "    if check != 0:\n        return False\n", ""),
    ),
    Mutation(
        "ON kept over a loss",
        "a drive that comes back into contact starts by itself",
        ("START", "LOST"), 700,
        (
            "uss/drive.py",
            "            self.was_running = self._may_run or not self.tells_status\n"
            "            self.revoke()\n",
            "            self.was_running = self._may_run or not self.tells_status\n",
        ),
        (
            "uss/drive.py",
            "            self.revoke()\n            self.contacts",
            "            self.contacts",
        ),
    ),
    Mutation(
        "ON while lost",
        "ON is sent to a drive that does not answer",
        ("LOST", "MAY RUN"), 4,
        (
            "uss/master.py",
            "drive.miss(finding, now, self.turns.lost_us, self._mask)\n        if",
            "drive.miss(finding, now, 8 * self.turns.lost_us, self._mask)\n        if",
        ),
    ),
    Mutation(
        "stale PKW accepted",
        "an old answer is taken for that of another parameter",
        ("SETPOINT", "SHOWN", "RECOVERS"), 63,
        (
            "uss/pkw.py",
            "reply = reply_about(net, at, self.words)",
            "reply = net[at] >> 4",
        ),
    ),
    Mutation(
        "driver enable late",
        "the panel holds the line when the drive answers",
        ("LINE",), 1,
        (
            "hal/link/rs485.py",
            "        self._arm(self._duration_us)\n",
            "        self._arm(self._duration_us + self._durations_us[2])\n",
        ),
    ),
    AtHome(
        "dead man removed",
        "ON goes on while the panel hangs",
        ("DEAD MAN",), 791,
        ("uss/master.py", "DEAD_MAN_US = const(300_000)", "DEAD_MAN_US = const(3_000_000)"),
    ),
    Mutation(
        "wrong drive stopped",
        "STOP stops the first drive, whichever is shown",
        ("STOP", "START"), 4,
        (
            "panel/keys/stop_key.py",
            "            control.stop()\n",
            "            self._controls[0].stop()\n",
        ),
    ),
    Mutation(
        "STOP waits its turn",
        "STOP does not go before the list",
        ("STOP",), 4,
        (
            "uss/drive.py",
            "        self.stops = (self.stops + 1) & _TICKET_MASK\n        self.hurry()\n",
            "        self.stops = (self.stops + 1) & _TICKET_MASK\n        self.steady = False\n",
        ),
    ),
    AtHome(
        "STOP beaten by START",
        "START is obeyed while STOP is down",
        ("STOP", "START"), 7,
        (
            "panel/panel.py",
            "if self.stop_key.is_down and acts.pressed & self._motion_bits:",
            "if self.stop_key.is_down and acts.pressed & self._jog_bits:",
        ),
    ),
    Mutation(
        "started after a reset",
        "a motor that turns when the panel has restarted is sent ON",
        ("START",), 761,
        (
            "panel/control.py",
            "            self._contact = drive.contact\n",
            "            self._contact = drive.contact\n            if self.runs():\n"
            "                self._obey(self.desk.bus.dead_man_trips)\n"
            "                self.drive.start(self.drive.hsw, self._on())\n",
        ),
    ),
    AtHome(
        "START without release",
        "a START that was down at power-on counts, sooner or later",
        ("START",), 57,
        (
            "panel/keys/__init__.py",
            "self._released = 0  #",
            "self._released = (1 << len(names)) - 1  #",
        ),
        (
            "panel/panel.py",
            'elif acts.has("START"):',
            'elif acts.has("START") or acts.repeated & acts.bit("START"):',
        ),
    ),
    Mutation(
        "EEPROM without asking",
        "every write wears the EEPROM",
        ("EEPROM",), 724,
        (
            "panel/writer.py",
            "pkw.WRITE_WORD_EEPROM if write.eeprom else pkw.WRITE_WORD",
            "pkw.WRITE_WORD_EEPROM",
        ),
    ),
    Mutation(
        "no question",
        "a parameter that cuts the panel off is written at once",
        ("WRITE",), 14,
        ("panel/pages/writing.py", "if risk is not None and not", "if risk == -1 and not"),
    ),
    Mutation(
        "setpoint limit dropped",
        "the limits of the drive are not kept",
        ("SETPOINT",), 872,
        (
            "panel/setpoint.py",
            "            highest = min(highest, survey.highest())\n",
            "            highest = min(highest, 2 * survey.highest())\n",
        ),
    ),
    Mutation(
        "bit 10 dropped",
        "the drive ignores the telegram and goes on as before",
        ("CONTROL",), 276,
        ("uss/pzd.py", "OFF3 = const(0x047A)", "OFF3 = const(0x007A)"),
    ),
    Mutation(
        "second stop at once",
        "OFF3 is sent before STOP was held",
        ("SECOND STOP",), 2,
        ("panel/keys/stop_key.py", "SECOND_MS = const(1_500)", "SECOND_MS = const(500)"),
    ),
    Mutation(
        "STOP ALL forgets drives",
        "STOP held for 4 s stops only what is shown",
        ("STOP ALL",), 15,
        (
            "panel/keys/stop_key.py",
            "            self.left = 2 * len(self._controls)\n",
            "            self.left = 0\n",
        ),
    ),
    Mutation(
        "selecting stops",
        "another drive is shown, and the one before is stopped",
        ("WITHOUT REASON", "ANNOUNCED"), 20,
        (
            "panel/panel.py",
            "        self.selected.keep_quiet()\n",
            "        self.selected.stop_unseen()\n",
        ),
    ),
    Mutation(
        "watchdog fed always",
        "a bus that stands is not restarted",
        ("WATCHDOG",), 702,
        ("app.py", "if stands_ms * 1000 < self.bus.patience_us():", "if stands_ms >= 0:"),
    ),
    Mutation(
        "watchdog starved",
        "a panel that works is restarted",
        ("WATCHDOG",), 1,
        ("app.py", "_FEED_MS = const(100)", "_FEED_MS = const(2_500)"),
    ),
    Mutation(
        "lost drive looks alive",
        "a drive that is lost is shown as it was last",
        ("MAY RUN",), 31,
        (
            "panel/wording.py",
            "    if not drive.contact:\n"
            "        return control.desk.defect or _TROUBLES[drive.trouble]\n",
            "",
        ),
    ),
    Mutation(
        "lost drive forgotten",
        "a drive that ran and is lost is just NO CONTACT",
        ("MAY RUN",), 700,
        (
            "panel/control.py",
            "is_lost_running = drive.was_running and not drive.contact",
            "is_lost_running = False",
        ),
    ),
    Mutation(
        "unconfirmed STOP unsaid",
        "nobody is told that a STOP has no effect",
        ("UNCONFIRMED",), 15,
        ("panel/stop_watch.py", "            self.unconfirmed = True\n", "            pass\n"),
    ),
    Mutation(
        "faults acknowledged by themselves",
        "a tripped drive is reset though nobody has seen it",
        ("ACKNOWLEDGE",), 740,
        (
            "panel/reports/fault.py",
            "            self._shown_ms += passed_ms\n",
            "            self._shown_ms += passed_ms\n"
            "            if self.was_shown():\n"
            "                self._drive.acknowledge()\n",
        ),
    ),
    Mutation(
        "wrong sign shown",
        "a motor that turns left reads as one that turns right",
        ("SHOWN",), 25,
        ("panel/view.py", "-setpoint if control.reversed else setpoint", "setpoint"),
    ),
    Mutation(
        "listens to nobody",
        "the panel talks into another master's telegrams after power-on",
        ("LISTEN",), 19,
        ("uss/master.py", "LISTEN_US = const(100_000)", "LISTEN_US = const(10_000)"),
    ),
    Mutation(
        "start interval halved",
        "the drives miss telegrams that come too soon",
        ("LINE",), 179,
        ("uss/timing.py", "START_INTERVAL_CHARACTERS = 2", "START_INTERVAL_CHARACTERS = 1"),
    ),
    AtHome(
        "faults started",
        "START is obeyed by a drive that has tripped",
        ("REFUSED",), 778,
        (
            "panel/permits.py",
            "    if state == pzd.FAULT:\n        return texts.REFUSED_FAULT\n",
            "",
        ),
    ),
    Mutation(
        "foreign commands ignored",
        "START is obeyed though the drive takes its commands elsewhere",
        ("REFUSED",), 765,
        (
            "panel/permits.py",
            "    return survey.wrong[rows.COMMAND] != rows.RIGHT\n",
            "    return False\n",
        ),
    ),
    Mutation(
        "unsupervised is nothing",
        "nobody is asked whether a motor may run on without the panel",
        ("UNSUPERVISED",), 1,
        (
            "panel/risks.py",
            "    off_time_ms = control.survey.off_time_ms()\n",
            "    return NONE\n",
        ),
    ),
    Mutation(
        "STOP stops all",
        "STOP stops drives that are not shown",
        ("WITHOUT REASON",), 15,
        (
            "panel/keys/stop_key.py",
            "            control.stop()\n",
            "            control.stop()\n"
            "            for other in self._controls:\n"
            "                other.stop_unseen()\n",
        ),
    ),
    Mutation(
        "all stopped too soon",
        "STOP held for the second stop stops every drive",
        ("WITHOUT REASON",), 808,
        ("panel/keys/stop_key.py", "_ALL_MS = const(4_000)", "_ALL_MS = const(1_500)"),
    ),
    Mutation(
        "second stop for all",
        "OFF3 goes to drives that are not shown",
        ("SECOND STOP",), 179,
        (
            "panel/keys/stop_key.py",
            "            self._control.second_stop()\n",
            "            for control in self._controls:\n"
            "                control.second_stop()\n",
        ),
    ),
    Mutation(
        "second stop given up",
        "OFF3 is sent once, whether or not the drive has heard it",
        ("SECOND STOP",), 750,
        (
            "panel/control.py",
            "        if drive.answered_stw & ~pzd.STW_ACKNOWLEDGE != drive.off:\n"
            "            return\n",
            "",
        ),
    ),
    Mutation(
        "written elsewhere",
        "a parameter is written into the first drive, whichever is shown",
        ("WRITE",), 874,
        (
            "panel/writer.py",
            "        drive = write.control.drive\n        if drive.channel.is_full():",
            "        drive = self._bus.turns.drives[0]\n        if drive.channel.is_full():",
        ),
    ),
    Mutation(
        "another value written",
        "what is written is not what was confirmed",
        ("WRITE",), 14,
        (
            "panel/writer.py",
            "write.number, write.index, high, low)",
            "write.number, write.index, high, low ^ 1)",
        ),
    ),
    Mutation(
        "silent drives forgotten",
        "a drive that does not answer is not asked again",
        ("NEGLECTED",), 17,
        ("uss/silence.py", "            asked.ask_soon()\n", "            pass\n"),
    ),
    AtHome(
        "a running drive backs off",
        "a drive that runs, and is lost, is asked as seldom as one that stands",
        ("NEGLECTED",), 60,
        (
            "uss/drive.py",
            "return not self.contact and not self.was_running",
            "return not self.contact",
        ),
    ),
    Mutation(
        "saved at any time",
        "settings are written while a motor turns, and the bus stands still",
        ("FLASH",), 8,
        (
            "app.py",
            "if self.panel.any_runs() or has_just_failed and errand is None:",
            "if has_just_failed and errand is None:",
        ),
    ),
    Mutation(
        "listens too long",
        "the panel keeps silent after power-on, and nothing can be stopped",
        ("SILENT PANEL", "WATCHDOG"), 2,
        ("uss/master.py", "LISTEN_US = const(100_000)", "LISTEN_US = const(6_000_000)"),
    ),
    Mutation(
        "BCC of yesterday",
        "a telegram is changed behind its check",
        ("TELEGRAM",), 1,
        (
            "uss/master.py",
            "if not drive.sealed or request[2] != drive.address:",
            "if request[2] != drive.address:",
        ),
    ),
    Mutation(
        "display hurried",
        "the display is written to while it is still at work",
        ("DISPLAY",), 1,
        ("hal/display/character_display.py", "_COMMAND_US = const(53)", "_COMMAND_US = const(20)"),
    ),
    Mutation(
        "the first alarm for ever",
        "of several drives in trouble one is announced, and hides the others",
        ("ANNOUNCED",), 11,
        (
            "panel/announcer.py",
            "                position = self._find(kind, position + 1)\n",
            "                position = self._find(kind, max(position, 0))\n",
        ),
    ),
    Mutation(
        "a question hides a trip",
        "what a drive does is not said as long as a question has the display",
        ("ANNOUNCED",), 716,
        (
            "panel/view.py",
            "            if panel.announcer.kind != NOTHING:\n"
            "                panel.announcer.draw(screen, 0)\n            if self._page",
            "            if self._page",
        ),
    ),
    Mutation(
        "never heard is nothing",
        "nobody is told that a drive that is silent since power-on may be running",
        ("ANNOUNCED",), 15,
        (
            "panel/control.py",
            "return not self.drive.contacts and self.drive.silent >= _SILENT_MAX",
            "return False",
        ),
    ),
    Mutation(
        "trips unseen",
        "a drive that is not shown trips, and nobody is told",
        ("ANNOUNCED",), 893,
        (
            "panel/announcer.py",
            "        if control.fault.active:\n            return TRIPPED\n",
            "        if control.fault.active:\n            return NOTHING\n",
        ),
    ),
    Mutation(
        "a warning without its number",
        "what a drive warns of is not shown",
        ("SHOWN",), 863,
        (
            "panel/pages/warning.py",
            "report.active and panel.announcer.page_turns & 1",
            "report.active and panel.announcer.page_turns < 0",
        ),
    ),
    Mutation(
        "silence costs nothing",
        "drives that do not answer take the line from those that run",
        ("NEGLECTED",), 2,
        (
            "uss/silence.py",
            "        elif self.wait_us <= 0 and self.resting:\n",
            "        elif self.resting:\n",
        ),
    ),
    Mutation(
        "a task for ever",
        "a task that a drive answers with silence is sent until the drive is lost",
        ("TASK",), 8,
        (
            "uss/channel.py",
            "            if pressing or silences >= _SILENCES_MAX:\n",
            "            if silences >= 50 * _SILENCES_MAX:\n",
        ),
    ),
    Mutation(
        "lost a little later",
        "ON goes to a silent drive for a tenth longer than the settings say",
        ("LOST",), 700,
        ("app.py", "settings.lost_ms * 1000", "settings.lost_ms * 1100"),
    ),
    Typing(
        "digits take effect without SET",
        "a motor goes faster while somebody still types what it shall turn with",
        ("RISES",), 706,
        (
            "panel/pages/digits.py",
            "        self._centihertz += ((digit + direction) % 10 - digit) * worth\n",
            "        self._centihertz += ((digit + direction) % 10 - digit) * worth\n"
            "        self._control.change(self._centihertz - self._control.setpoint.centihertz)\n",
        ),
    ),
    AtHome(
        "one START, two runs",
        "a motor that was without mains for a moment starts again by itself",
        ("TURNS", "START"), 184,
        (
            "uss/drive.py",
            "                if (self.hiw + (near >> 1)) & 0xFFFF <= near:  # 1 %\n"
            "                    self.revoke()\n",
            "                pass\n",
        ),
        (
            "panel/control.py",
            "            if survey.has_restarted():\n"
            "                self._take_back(texts.DRIVE_RESET)\n",
            "",
        ),
    ),
    Mutation(
        "a long time is short",
        "a motor may run on for a minute without the panel, and nobody is asked",
        ("UNSUPERVISED",), 1,
        (
            "panel/risks.py",
            "    if 0 < off_time_ms <= control.desk.longest_off_time_ms:\n",
            "    if 0 < off_time_ms:\n",
        ),
    ),
    Mutation(
        "runs on longer, unsaid",
        "somebody takes the supervision of a motor that runs away, and nobody is told",
        ("SHOWN", "ANNOUNCED"), 784,
        (
            "panel/control.py",
            "        if risks.exposure_ms(self) > self._command.exposure_ms:\n",
            "        if risks.exposure_ms(self) < 0:\n",
        ),
    ),
    Mutation(
        "a silence for all",
        "one drive that may run and is silent takes the turns of those that rest",
        ("NEGLECTED",), 867,
        (
            "uss/silence.py",
            "        if drive.outside or not drive.was_running:\n"
            "            self.shared_us = (self.shared_us + spent_us) & SPENT_MASK\n",
            "        self.shared_us = (self.shared_us + spent_us) & SPENT_MASK\n",
        ),
    ),
    Mutation(
        "an exception",
        "a page that fails takes the panel with it",
        ("EXCEPTION",), 8,
        (
            "panel/view.py",
            "        screen.put(0, 10, 6, texts.of(texts.BEYOND_VALUE))\n",
            "        screen.put(0, 10, 6, None)\n",
        ),
        (
            "panel/control.py",
            "return self.drive.hiw in pzd.BEYOND",
            "return self.drive.hiw > 0x2000",
        ),
    ),
    # --- families and layouts -------------------------------------------------------------------
    Mutation(
        "MM3 reversed as an MM4",
        "REVERSE turns a MICROMASTER 3 right by the word that turns an MM4 left",
        ("SHOWN",), 25,
        ("uss/families/mm3.py", "on_reverse = 0x147F", "on_reverse = 0x0C7F"),
    ),
    AtHome(
        "MM3 started as an MM4",
        "a MICROMASTER 3 is sent a word without a direction",
        ("CONTROL",), 25,
        ("uss/families/mm3.py", "    on = 0x0C7F", "    on = 0x047F"),
    ),
    Mutation(
        "HIW of an MM3 has a sign",
        "a motor that turns left reads as one that turns right, where bit 14 of ZSW tells it",
        ("SHOWN",), 25,
        (
            "uss/pzd.py",
            "if family.hiw_is_signed or zsw & ZSW_RUNS_RIGHT or hiw & 0x8000:",
            "if hiw is not None:",
        ),
    ),
    Mutation(
        "percent sent as hertz",
        "10.0% goes out as 10 Hz of 50 Hz",
        ("SHOWN", "SETPOINT"), 836,
        ("uss/survey.py", "_HUNDRED_PERCENT = const(10_000)", "_HUNDRED_PERCENT = const(5_000)"),
    ),
    Mutation(
        "percent looks like hertz",
        "a drive that does not tell its reference is shown in hertz",
        ("SHOWN",), 186,
        ("panel/texts.py", 'ACTUAL_PERCENT = b"%F:"', 'ACTUAL_PERCENT = b" F:"'),
    ),
    AtHome(
        "percent of what",
        "START is obeyed though the drive takes 0.01 Hz for what the panel sends as percent",
        ("REFUSED",), 753,
        (
            "uss/survey.py",
            "reference = _HUNDRED_PERCENT if reference and not is_absolute else 0",
            "reference = _HUNDRED_PERCENT if reference else 0",
        ),
        (
            "uss/survey.py",
            "            if is_absolute:\n                self.unreadable = True\n",
            "            is_absolute = False\n",
        ),
    ),
    Mutation(
        "untold is supervised",
        "a drive without a parameter channel is started, and nobody is asked",
        ("UNSUPERVISED",), 21,
        (
            "panel/risks.py",
            "    if 0 < off_time_ms <= control.desk.longest_off_time_ms:\n",
            "    if not control.drive.layout.pkw_words:\n        return NONE\n"
            "    if 0 < off_time_ms <= control.desk.longest_off_time_ms:\n",
        ),
    ),
    AtHome(
        "reversed without a bit",
        "the display says left, and a drive without a reverse bit is sent the same setpoint",
        ("SHOWN",), 18,
        (
            "panel/control.py",
            "            self.setpoint.negate(self.reversed)\n",
            "            pass\n",
        ),
    ),
    Mutation(
        "jogs without a jog",
        "a drive whose family has no jog is sent that of another",
        ("CONTROL",), 868,
        (
            "panel/permits.py",
            "    if not control.survey.family.jog_right:\n"
            "        return texts.REFUSED_NO_JOG\n",
            "",
        ),
    ),
    Mutation(
        "local is remote",
        "START is obeyed by a MICROMASTER 3 that is controlled from its keypad",
        ("REFUSED",), 63,
        ("uss/families/mm3.py", "ALL_DIGITS, (1,), None)", "ALL_DIGITS, (0, 1, 2, 4), None)"),
    ),
    Mutation(
        "looked for though it answers",
        "a drive that answers is sent telegrams in other layouts",
        ("MIRROR",), 6,
        (
            "uss/finding/finder.py",
            "            if not drive.doubted or drive.may_run():\n                return False\n",
            "            pass\n",
        ),
    ),
    AtHome(
        "looked for too soon",
        "a drive that may run is sent other telegrams before its STOP had a chance",
        ("MIRROR",), 700,
        ("uss/finding/finder.py", "STOPPED_MIN = const(30)", "STOPPED_MIN = const(3)"),
    ),
    Mutation(
        "a mirror telegram that commands",
        "a drive that takes it for one of its own telegrams obeys what it says",
        ("MIRROR",), 2,
        (
            "uss/finding/mirror.py",
            "            self.request[NET + index] = 0\n",
            "            self.request[NET + index] = 4\n",
        ),
    ),
    Mutation(
        "mirrors have no share",
        "looking for layouts takes the line from the drives that run",
        ("NEGLECTED",), 872,
        (
            "uss/finding/finder.py",
            "        if self._turns.has_command() or silence.shared_us != silence.charged_us:\n"
            "            return False  # what the last one took is not accounted for yet\n",
            "        return not self._turns.has_command()\n",
        ),
    ),
    Mutation(
        "layout guessed",
        "a drive is given a layout in which nothing has come back",
        ("TELEGRAM",), 2,
        (
            "uss/finding/finder.py",
            "            self._tries = 0\n            self._row += 1\n",
            "            self._tries = 0\n"
            "            if self._row < _FURTHER:\n"
            "                self._find(_WORDS[self._row], self._layout.pzd_words)\n"
            "            self._row += 1\n",
        ),
    ),
    Mutation(
        "found and forgotten",
        "the layout of a drive is found out, and not used",
        ("RECOVERS",), 15,
        (
            "uss/finding/finder.py",
            "            self._turns.relayout(drive, layout, drive.doubted)\n",
            "            self._layout = layout\n",
        ),
    ),
    Mutation(
        "STOP dead in the menu",
        "whoever reads a list cannot stop the motor",
        ("STOP",), 238,
        (
            "panel/panel.py",
            "        if down & self._stop_bit:\n",
            "        if down & self._stop_bit and not hasattr(self._cover, \"_lists\"):\n",
        ),
    ),
    Diagnosing(
        "START acts in the menu",
        "a motor starts that nobody has on the display",
        ("START",), 53,
        (
            "panel/menu/engine.py",
            "        if acts.has(\"PARAM\"):\n"
            "            self._leave(now_ms)\n",
            "        if acts.has(\"START\"):\n"
            "            self.panel.selected.start()\n"
            "        if acts.has(\"PARAM\"):\n"
            "            self._leave(now_ms)\n",
        ),
    ),
    Mutation(
        "jog keys act in the menu",
        "a motor jogs that nobody has on the display",
        ("JOG",), 876,
        (
            "panel/panel.py",
            "            allowed = page.obeys and not self.stop_key.is_down\n",
            "            allowed = not self.stop_key.is_down\n",
        ),
    ),
    Mutation(
        "address key held starts",
        "a key that only looks at addresses starts a motor",
        ("START",), 732,
        (
            "panel/panel.py",
            "            self._open_menu(now_ms, (\"address\", None))\n",
            "            self._open_menu(now_ms, (\"address\", None))\n"
            "            self.selected.start()\n",
        ),
    ),
    Mutation(
        "looked for before it is stopped",
        "a drive that may run is sent mirror telegrams in place of its STOP",
        ("MIRROR",), 700,
        (
            "uss/finding/finder.py",
            "(drive.silent < STOPPED_MIN or drive.is_told_in_vain())",
            "drive.silent < SILENT_MIN",
        ),
    ),
    Mutation(
        "search without a question",
        "the panel leaves its drives for others, and nobody has said yes",
        ("SEARCH",), 28,
        (
            "panel/panel.py",
            "            return\n"
            "        self._ask_search()\n",
            "            return\n"
            "        self._search(now_ms)\n",
        ),
    ),
    LookingUp(
        "low word lost",
        "the page of a parameter shows 0 for whole numbers",
        ("SHOWN",), 161,
        (
            "panel/lookup/answers.py",
            "self.high, self.low = job.high, job.low",
            "self.high, self.low = job.high, 0",
        ),
    ),
    Mutation(
        "a set unmarked",
        "a set is written, and no settings in the flash say that the drive has one in part",
        ("WRITE", "REFUSED"), 138,
        (
            "panel/sets/writing.py",
            "        settings.note_set(address, self._check)\n        while settings.dirty:\n",
            "        while settings.dirty:\n",
        ),
    ),
    Mutation(
        "saved wrong",
        "a set has not what the drive has",
        ("SET",), 905,
        (
            "panel/sets/saving.py",
            "set_file.row_line(number, index, kind, job.high, job.low)",
            "set_file.row_line(number, index, kind, job.high, job.low | 1)",
        ),
    ),
    Mutation(
        "a set for the RAM alone",
        "each write of a set wears the EEPROM",
        ("EEPROM",), 138,
        (
            "panel/sets/pump.py",
            "    eeprom = family.has_eeprom_tasks and (eeprom or number in family.permanent)\n",
            "    eeprom = family.has_eeprom_tasks\n",
        ),
    ),
    Mutation(
        "equal for all that",
        "a drive reads as equal to a set, and is not",
        ("SET",), 138,
        (
            "panel/sets/writing.py",
            "is_equal = job.state == pkw.DONE and job.width == width and told == (high, low)",
            "is_equal = job.state == pkw.DONE and job.width == width and told[1] == low",
        ),
    ),
    Mutation(
        "bus off talks on",
        "the display says that the line is free, and the panel talks",
        ("BUS OFF",), 28,
        (
            "panel/menu/diagnosis/off.py",
            "        if self.panel.bus.phase == OFF:\n            return texts.of(words.LINE",
            "        if self._is_left:\n            return texts.of(words.LINE",
        ),
        ("panel/menu/diagnosis/off.py", "self.panel.bus.off()", "self.panel.bus.stop_all()"),
    ),
    Mutation(
        "bus off stops nobody",
        "the panel leaves the line, and has told nobody to stop",
        ("BUS OFF",), 28,
        (
            "uss/master.py",
            "        self.stop_all()\n        self._held |= _HELD_BY_OFF\n",
            "        self._held |= _HELD_BY_OFF | _GIVEN_UP\n",
        ),
    ),
    Mutation(
        "back without listening",
        "the panel takes the line back while others talk",
        ("LISTEN",), 28,
        (
            "uss/master.py",
            "            self.foreign = 0\n            self.phase = LISTENING\n",
            "            self.foreign = 0\n            self.phase = RESTING\n",
        ),
    ),
    Diagnosing(
        "a mirror test that commands",
        "a drive that takes it for one of its own telegrams obeys what it says",
        ("MIRROR",), 186,
        ("panel/menu/diagnosis/mirror.py", "] &= 0xFB", "] |= 0x04"),
    ),
    Diagnosing(
        "good replies miscounted",
        "the diagnosis shows other counters than those of the drive",
        ("SHOWN",), 665,
        (
            "panel/menu/diagnosis/counters.py",
            "            counted += control.drive.counters[row]\n",
            "            counted += control.drive.counters[0] + control.drive.counters[row]\n",
        ),
    ),
    Commissioning(
        "a step unasked",
        "SET writes a step of commissioning at once, and nobody has seen what",
        ("WRITE",), 849,
        (
            "panel/commission/course.py",
            "            self._phase = ASKS\n        elif self._phase == TYPES:\n",
            "            self._begin_write(now_ms)\n        elif self._phase == TYPES:\n",
        ),
    ),
    Mutation(
        "looked at and written",
        "a step of commissioning is written when it is shown",
        ("WRITE",), 34,
        (
            "panel/commission/course.py",
            "        elif self._phase == LOOKS and not self.is_searching():\n",
            "        elif self._form and step._needs.isdigit() and not step.is_done:\n"
            "            self._bits = step.needed(self._form, self._has)\n"
            "            self._begin_write(now_ms)\n"
            "        elif self._phase == LOOKS and not self.is_searching():\n",
        ),
    ),
    Commissioning(
        "typed and not taken",
        "a step of commissioning is written as it was, not as it was typed",
        ("WRITE",), 849,
        (
            "panel/commission/course.py",
            "                self._bits = form.bits(self._typed)\n",
            "                self._bits = form.bits(self._typed) ^ 1 << 12\n",
        ),
    ),
    Commissioning(
        "commissioned while it runs",
        "a step is written while the motor turns",
        ("WRITE",), 395,
        (
            "panel/commission/course.py",
            "        if self._control.is_active():\n",
            "        if self._control.is_active() and not self._form:\n",
        ),
    ),
    Commissioning(
        "STOP dead in commissioning",
        "whoever commissions a drive cannot stop it",
        ("STOP", "STOP ALL"), 235,
        (
            "panel/panel.py",
            "        if down & self._stop_bit:\n",
            "        lists = getattr(self._cover, \"_lists\", None)\n"
            "        course = lists and hasattr(lists[-1][1], \"_bits\")\n"
            "        if down & self._stop_bit and not course:\n",
        ),
    ),
    Commissioning(
        "events too young",
        "an event reads as half as old as it is",
        ("SHOWN",), 238,
        (
            "panel/reports/journal.py",
            "self._counted_at_ms, self._mask) >= 1_000",
            "self._counted_at_ms, self._mask) >= 2_000",
        ),
        (
            "panel/reports/journal.py",
            "self._counted_at_ms + 1_000 &",
            "self._counted_at_ms + 2_000 &",
        ),
    ),
    Commissioning(
        "another drive's event",
        "an event reads as that of the drive that is shown",
        ("SHOWN",), 11,
        (
            "panel/menu/events.py",
            "        who = _THE_PANEL if address == NOBODY else b\"A%d\" % address\n",
            "        address = self.panel.selected.drive.address\n"
            "        who = _THE_PANEL if address == NOBODY else b\"A%d\" % address\n",
        ),
    ),
    Locking(
        "jog while locked",
        "the lock is closed, and the jog keys turn a motor",
        ("LOCK",), 762,
        (
            "panel/panel.py",
            "                allowed = False\n            self._jog_keys",
            "                pass\n            self._jog_keys",
        ),
    ),
    Locking(
        "reversed while locked",
        "the lock is closed, and REVERSE turns a motor round",
        ("LOCK",), 252,
        (
            "panel/keys/guard.py",
            "LOCKED_KEYS = (\"REVERSE\", ",
            "LOCKED_KEYS = (",
        ),
    ),
    Locking(
        "STOP dead while locked",
        "the lock is closed, and nobody can stop a motor",
        ("STOP", "STOP ALL", "SECOND STOP"), 39,
        (
            "panel/panel.py",
            "        if down & self._stop_bit:\n",
            "        if down & self._stop_bit and not (self.guard and self.guard.locked):\n",
        ),
    ),
    Locking(
        "any code opens",
        "the lock opens by whatever code",
        ("LOCK",), 872,
        (
            "panel/menu/code.py",
            "        if code != panel.settings.lock_code:\n",
            "        if not code:\n",
        ),
    ),
    Locking(
        "the menu behind the lock",
        "PARAM that is held opens the menu, though the lock is closed",
        ("LOCK",), 32,
        (
            "panel/panel.py",
            "            self._open_menu(now_ms, (\"code\", False))\n",
            "            self._open_menu(now_ms)\n",
        ),
    ),
    Locking(
        "open after power-on",
        "the lock is open when the panel starts",
        ("LOCK",), 32,
        (
            "panel/panel.py",
            "        self.heed_settings(locked=True)\n",
            "        self.heed_settings()\n",
        ),
    ),
    Locking(
        "a code that can be read",
        "who looks on learns the code of the lock",
        ("LOCK",), 32,
        (
            "panel/menu/code.py",
            "text, before = words.CODE, b\"*\" * len(before)",
            "text = words.CODE",
        ),
    ),
    Locking(
        "LOCK that closes nothing",
        "the display says that the lock is closed, and it is open",
        ("LOCK",), 536,
        (
            "panel/keys/guard.py",
            "        self.locked = self._settings.lock_code != 0\n",
            "        self.locked = False\n",
        ),
    ),
    Arranging(
        "an order not kept",
        "the panel begins anew, and the drives stand in the list as before",
        ("LIST",), 882,
        (
            "panel/menu/order.py",
            "            panel.settings.change(\"drives\", drives)\n",
            "",
        ),
    ),
    Arranging(
        "carried elsewhere",
        "a drive is put down at another place than the display says",
        ("LIST",), 179,
        (
            "panel/menu/order.py",
            "            drives.insert(self._carried, address)\n",
            "            drives.insert(0, address)\n",
        ),
    ),
    Arranging(
        "turns of another drive",
        "SET gives other turns to a drive than to that which the display names",
        ("LIST",), 276,
        (
            "panel/menu/turns.py",
            "        address = panel.controls[position].drive.address\n"
            "        repeats = dict",
            "        address = panel.controls[position - 1].drive.address\n"
            "        repeats = dict",
        ),
    ),
    Arranging(
        "turns for nobody",
        "a drive has as many turns as ever, whatever the settings say",
        ("LIST",), 276,
        ("panel/roster.py", "        if repeats:\n", "        if repeats and not controls:\n"),
    ),
    Resetting(
        "reset unasked",
        "one SET gives a drive its factory settings",
        ("WRITE",), 34,
        (
            "panel/commission/course.py",
            "            self._phase = ASKS\n        elif self._phase == TYPES:\n",
            "            self._phase = ASKS\n"
            "            if step.number == 970:\n"
            "                self._begin_write(now_ms)\n"
            "        elif self._phase == TYPES:\n",
        ),
    ),
    Resetting(
        "identified unasked",
        "one SET makes the next ON one that gives the motor current",
        ("WRITE",), 201,
        (
            "panel/commission/course.py",
            "            self._phase = ASKS\n        elif self._phase == TYPES:\n",
            "            self._phase = ASKS\n"
            "            if step.number == 1910:\n"
            "                self._begin_write(now_ms)\n"
            "        elif self._phase == TYPES:\n",
        ),
    ),
    Mutation(
        "goes on though somebody calls",
        "the telegram that was made ready goes out though the program has taken ON back",
        ("STOP", "TURNS", "START"), 741,
        ("uss/going_on/viper.py", "    return attention[96] == 0  # ANY\n", "    return True\n"),
        ("uss/going_on/python.py", "    return attention[ANY] == 0\n", "    return True\n"),
    ),
    Mutation(
        "goes on without a check",
        "the next telegram follows what is no reply",
        ("WITHOUT REASON", "SHOWN", "LOST", "START", "STOP"), 893,
        (
            "uss/going_on/viper.py",
            "    if check != 0:\n        return False\n    last = count - 1\n"
            "    while reply[last] == request[last]:  # an echo? Mostly the BCC differs\n"
            "        if last == 0:\n            return False\n        last -= 1\n",
            "",
        ),
        (
            "uss/going_on/python.py",
            "    if not is_reply(reply, count, request):\n        return False\n",
            "",
        ),
    ),
    Mutation(
        "goes on beside bad news",
        "a drive that trips or stops by itself is sent ON once more",
        ("STOP", "TURNS", "START"), 761,
        ("uss/going_on/viper.py", "& 0x4C:  # plan.ZSW", "& 0:"),
        ("uss/going_on/python.py", "^ plan[ZSW]) & MOTION:", "^ plan[ZSW]) & 0:"),
    ),
    Mutation(
        "goes on with what was ready before",
        "an entry into the engine leaves the telegram that was made ready",
        ("STOP", "WATCHDOG"), 2,
        (
            "uss/going_on/master.py",
            "        self._link.take_back()\n        due_us",
            "        due_us",
        ),
    ),
    Mutation(
        "goes on to where a drive was",
        "the telegram that was made ready for a drive goes out after that has moved",
        ("ADDRESS",), 20,
        (
            "uss/drive.py",
            "        self.address = address\n        self.call_again()  #",
            "        self.address = address\n        #",
        ),
        (
            "panel/writer.py",
            "readdress(drive, address)\n        drive.hurry()\n",
            "readdress(drive, address)\n",
        ),
    ),
)  # fmt: skip
