# SPDX-License-Identifier: MIT
"""How the panel shares out the line: how often it has to ask each drive, and what silence may
cost.

A drive that runs has its turn within a third of its telegram off time, as far as the drives that
answer allow that. All drives together that are silent, and were not running, have a fifth of the
line. The panel asks each of them so often that it finds a drive that is switched on. It withdraws
a task that a drive answers with silence.

    shares = Shares(witness)
    shares.ask(case, address, task, now)    # a request begins; task: of its PKW words, or None
    shares.mirror(case, now)                # or a telegram that the drive is to send back
    shares.answered()                       # that got its answer
    shares.look(now)                        # now and then: both raise Broken
"""

from tools.soaking.judging.case import drive_at
from tools.soaking.judging.facts import MS, NEVER, RUN, SHARED, ZSW_RUNNING, S
from tools.soaking.judging.rules import Broken

FOUND_US = 5 * S  # a drive that is switched on is asked within, or as soon as its share allows
SHARE = 5  # the part of the line that all silent drives together have
OWED = 2  # times that, because they may have had less than their share before
RARE_US = 1 * S  # between two silences that make a running drive's telegram late
LOOKS = 10  # steps of the loop until one that runs has the turn that it needs
PRESS_US = 16 * MS  # until the panel notices that one that runs needs its turn
SLACK = 5  # in percent of the line
COUNTED_US = 10 * S  # over which the share is judged
STOPS = 8  # turns that a STOP takes which a silent drive does not confirm: every other one is its
TASKS = 4  # telegrams with a task that nobody answers: 3, and one that is made ready already


class Shares:
    def __init__(self, witness):
        self.witness = witness
        self._answer_us = witness.exchange_us - witness.timeout_us + 20 * MS
        self._last = None  # the case that was asked last, and when
        self._last_us = 0
        self._is_answered = True  # that
        self._is_mirror = False  # it was a mirror telegram
        self._silent_us = 0  # that silence has cost since `_since_us`
        self._since_us = 0
        self._crowded_us = self._full_us = NEVER

    def ask(self, case, address, task, now):
        witness = self.witness
        may_run = case.stw & RUN or (
            case.zsw & ZSW_RUNNING
            and case.asked_us > case.answered_us
            and case.heard_us > witness.boot_us  # the panel knows it
        )
        if may_run and address not in witness.moved:
            self._judge_gap(case, address, now)
        self._judge_task(case, address, task, now)
        self._count(case, False, now)

    def mirror(self, case, now):
        self._count(case, True, now)

    def answered(self):
        self._is_answered = True

    def look(self, now):
        witness = self.witness
        silent = [case for case in self._listed() if self._may_rest(case, now)]
        patience_us = OWED * max(FOUND_US, SHARED * SHARE * len(silent) * witness.exchange_us)
        if self._is_crowded():
            self._crowded_us = now
        if self._is_full():
            self._full_us = now
        if now - self._crowded_us < patience_us:
            patience_us += OWED * RARE_US * len(silent)
        for address in witness.plan.listed:
            if address not in witness.moved:
                case = witness.cases[address]
                asked_us = witness.asked_for_us(case, now)
                if case in silent:
                    asked_us = min(asked_us, now - max(self._full_us, case.question_us))
                if asked_us > patience_us + 2 * witness.cycle_us:
                    told = (address, asked_us // MS, now)
                    raise Broken("NEGLECTED", "drive %d not asked for %d ms at %d" % told)
        self._judge_share(silent, now)

    def _is_crowded(self):
        """Whether a silence would make a drive that runs late, whose turns come first."""
        witness = self.witness
        running = [address for address in witness.plan.listed if witness.cases[address].stw & RUN]
        needed_us = LOOKS * witness.plan.loop_us + 2 * witness.exchange_us
        needed_us += 3 * len(running) * self._answer_us // 2
        return any(self._limit_us(address) < needed_us for address in running)

    def _is_full(self):
        """Whether a third of the time after which a drive that runs trips, or is lost, is shorter
        than an exchange, or than what all need that run, and a silence; of the time after which it
        is lost, two thirds. Then silent drives are asked only while it stands (manual, settings).
        """
        witness = self.witness
        running = [address for address in witness.plan.listed if witness.cases[address].stw & RUN]
        needed_us = 2 * witness.plan.loop_us + PRESS_US + witness.exchange_us
        needed_us += (3 * len(running) // 2 + 1) * self._answer_us
        return any(
            self._limit_us(address) < witness.exchange_us
            or (self._off_time_us(address) or 2 * witness.lost_us) // 3 < needed_us
            for address in running
        )

    def _listed(self):
        witness = self.witness
        return [witness.cases[address] for address in witness.plan.listed]

    def _may_rest(self, case, now):
        """Whether the panel may take it for one that is silent and was heard at rest."""
        return self._is_silent(case, now, case.heard_us > self.witness.boot_us)

    def _surely_rests(self, case, now):
        """Whether it cannot take it for one that may run: it has heard it at rest, or never."""
        return self._is_silent(case, now, case.taken > 0)

    def _is_silent(self, case, now, is_known):
        """Whether it is silent for so long that the panel does not wait for it, and was at rest
        since it was told to run. is_known: the panel has heard how it was."""
        if is_known or case.stw & RUN:
            if case.stw & RUN or case.zsw & ZSW_RUNNING or case.turned_us > case.rested_us:
                return False
        witness = self.witness
        return now - max(case.answered_us, witness.boot_us) > witness.lost_us + S

    def _judge_gap(self, case, address, now):
        """A drive that runs, or may run, has its turn in time, whatever else there is to say."""
        witness = self.witness
        gap_us = witness.asked_for_us(case, now)
        others = witness.turns
        silent = sum(1 for one in self._listed() if self._surely_rests(one, now))
        round_us = (others - silent) * self._answer_us + witness.exchange_us
        longest_us = (
            max(self._limit_us(address), 2 * round_us) + 6 * witness.exchange_us + 200 * MS
        )
        stop_us = others * witness.exchange_us  # of all: a telegram to each goes before that
        if now - gap_us < witness.stops_all_us(now) + stop_us:
            longest_us += stop_us
        if gap_us > longest_us:
            told = (address, gap_us // MS, now)
            raise Broken("NEGLECTED", "drive %d, which may run, not asked for %d ms at %d" % told)

    def _limit_us(self, address):
        """A third of P2014, of the lost time where there is none."""
        return (self._off_time_us(address) or self.witness.lost_us) // 3

    def _off_time_us(self, address):
        """P2014; 0: it never trips, or nobody can read it."""
        witness = self.witness
        drive, sight = drive_at(witness.world, address), witness.sight_of(address)
        if drive is not None and sight is not None and sight.reads_words:
            if sight.family.is_right_for(drive):
                number, unit_us = sight.family.off_time
                return sight.family.read(drive, number) * unit_us
        return 0

    def _judge_task(self, case, address, task, now):
        """The same one, from the first that was not answered on."""
        if case.asked_us <= case.answered_us:
            case.task, case.tasks = task, 0
        if task is None or task != case.task:
            case.task = None
            return
        case.tasks += 1
        witness = self.witness
        if case.tasks > TASKS and now - max(witness.late_us, witness.stalled_us) > witness.lost_us:
            told = (address, case.tasks, now)
            raise Broken("TASK", "drive %d, %d telegrams with a task unanswered at %d" % told)

    # --- what silence costs ---------------------------------------------------------------------

    def _count(self, case, is_mirror, now):
        before = self._last
        if before is not None and not self._is_answered:
            if self._is_mirror or self._surely_rests(before, now):
                self._silent_us += now - self._last_us
        self._last, self._last_us = case, now
        self._is_answered, self._is_mirror = False, is_mirror

    def _judge_share(self, silent, now):
        witness = self.witness
        # A STOP goes before all shares, and is repeated to those that do not confirm it.
        stops_us = witness.all_until_us + STOPS * len(silent) * witness.exchange_us
        disturbed_us = max(
            witness.late_us, witness.stalled_us, witness.stirred_us, witness.boot_us, stops_us
        )
        alone = not [case for case in self._listed() if now - case.answered_us < witness.lost_us]
        if alone or disturbed_us > self._since_us or witness.hung_us is not None:
            self._since_us, self._silent_us = now, 0
            return
        passed_us = now - self._since_us
        if passed_us < COUNTED_US:
            return
        most_us = passed_us // SHARE + passed_us * SLACK // 100 + 2 * witness.exchange_us
        if self._silent_us > most_us:
            told = (len(silent), 100 * self._silent_us // passed_us, now)
            raise Broken("NEGLECTED", "%d silent drives take %d %% of the line at %d" % told)
        self._since_us, self._silent_us = now, 0
