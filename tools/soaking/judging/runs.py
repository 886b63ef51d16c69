# SPDX-License-Identifier: MIT
"""One START, one run: what START and JOG must refuse, judged by the drive itself and by what the
line said of it; and the rules for a motor that was started.

A reply ends a run if the drive has tripped, or stands although it was not told to. If a motor
starts once more, after a moment without mains, the panel must stop it before long. While a run
goes on, only UP raises its setpoint, or SET where the display has digits that are typed in.

    reason = reason_against(witness, case, address, pressed_us, jogs)     # a text, or None
    if is_over(case, zsw) or is_standstill(case, hiw): ...
"""

from tools.soaking.judging.case import drive_at
from tools.soaking.judging.drive_settings import magnitude
from tools.soaking.judging.facts import (
    LONG_US,
    MS,
    NEVER,
    ON_BIT,
    ZSW_FAULT,
    ZSW_INHIBIT,
    ZSW_RUNNING,
    S,
)
from tools.soaking.judging.rules import Broken

FULL = 0x4000  # of HSW and HIW
NEAR = FULL // 50  # 2 %: HIW has reached HSW
STANDS = FULL // 200  # the panel sees a standstill at 1 %
TURNS = FULL * 6 // 100  # it looks for one from 5 % on
ROUNDING = 4  # of HSW: 0.01 Hz
RAISED_US = 600 * MS  # until what UP has done is on the line, or waits for it to be free
TAKEN_US = 1 * S  # the panel may not have seen so recent a change at the drive
COUNTED_US = 2 * S  # the telegrams received, r2024, are read as often


def begin(case, hsw):
    """The first ON or JOG of a run is sent."""
    case.ran = case.reached = False
    case.run_starts = 0
    case.again_us = NEVER
    case.highest_hsw = magnitude(hsw)


def judge_rise(witness, case, hsw, now, where):
    """A setpoint that is above what UP left of it, in the telegram before this one."""
    hsw = magnitude(hsw)
    raises = "UP" in witness.down and case in witness.candidates()
    if raises or case.sent_us - case.raised_us < RAISED_US + 2 * witness.cycle_us:
        case.highest_hsw = hsw
    elif hsw > case.highest_hsw + ROUNDING:
        told = (where, hsw, case.highest_hsw)
        raise Broken("RISES", "%s, HSW %04X was %04X, and nobody pressed UP or SET" % told)
    else:
        case.highest_hsw = min(case.highest_hsw, hsw)


def is_over(case, zsw):
    """Whether a status word shows that a run is over."""
    return zsw & (ZSW_FAULT | ZSW_INHIBIT) or case.ran and not zsw & ZSW_RUNNING


def is_standstill(case, hiw, reverse):
    """Whether a drive that is told to turn, and did, stands by this HIW. reverse: the control word
    that turns it round."""
    if not case.stw & ON_BIT or magnitude(case.hsw) < TURNS:
        return False
    speed = hiw - 0x10000 if hiw & 0x8000 else hiw
    wanted = case.hsw - 0x10000 if case.hsw & 0x8000 else case.hsw
    wanted = -wanted if case.stw == reverse else wanted
    if abs(speed - wanted) < NEAR // 2:
        case.reached = True
    return case.reached and abs(speed) < STANDS


def begin_again(case, now):
    """The motor of a drive that is told to run was switched on."""
    case.run_starts += 1
    if case.run_starts == 2:
        case.again_us = now


def judge_restart(witness, case, sight, where, now):
    """A motor has started twice by one START: ON is taken back when r2024 has told that."""
    if not case.telltale or case.again_us < case.on_us or sight is None or not sight.counts:
        return
    since_us = now - max(case.again_us, witness.late_us, witness.stalled_us)
    if since_us > COUNTED_US + S + 4 * witness.cycle_us:
        raise Broken("TURNS", "%s, its motor started again %d ms ago" % (where, since_us // MS))


# --- what START and JOG must refuse -------------------------------------------------------------


def reason_against(witness, case, address, pressed_us, jogs):
    """Why ON, or JOG, should not have been sent for the key that went down at `pressed_us`."""
    if case.bad_us > case.good_us and pressed_us > case.bad_us + 10 * MS:
        return "its status word forbids it"
    drive, sight = drive_at(witness.world, address), witness.sight_of(address)
    if drive is None or sight is None or not sight.reads_words:
        return None
    family = sight.family
    if not family.is_right_for(drive) or not _knows(witness, case, address, pressed_us, jogs):
        return None
    selected = drive.read(family.selection) if family.selection else 0
    tens, units = selected // 10, selected % 10
    wrong = _wrong(drive, sight, tens, family.command)
    if jogs or wrong:
        return wrong
    if sight.is_percent and family.absolute:
        number, value = family.absolute
        if family.read(drive, number) == value:
            return "P%04d is %d, and nobody knows 100 %%" % (number, value)
    return _wrong(drive, sight, units, family.setpoint)


def _knows(witness, case, address, pressed_us, jogs):
    """Whether the panel must know its settings. START makes it read them anew."""
    if jogs:
        return witness.knows(case, address, pressed_us)
    return case.settings_us <= pressed_us - TAKEN_US


def _wrong(drive, sight, selected, sources):
    """Which of these sources is not USS. selected: a digit of P0719; 0: the others decide."""
    if selected not in (0, sight.family.uss):
        return "P0719 is %s" % drive.read(719)
    for number, value, is_double in () if selected else sources:
        if sight.reads(is_double) and drive.read(number) != value:
            return "P%04d is %s" % (number, drive.read(number))
    return None


def runs_on_unasked(witness, case, address, pressed_us, jogs):
    """Whether the motor would run on without the panel, for ever or long, or nobody can read
    whether it would, and the operator has not agreed to that."""
    if case.accepted or address in witness.plan.settings.get("unsupervised", ()):
        return False
    drive, sight = drive_at(witness.world, address), witness.sight_of(address)
    if drive is None or sight is None or address in witness.moved:
        return False
    if not sight.reads_words:
        return True
    if not sight.family.is_right_for(drive):
        return False
    if not _knows(witness, case, address, pressed_us, jogs):
        return False
    number, unit_us = sight.family.off_time
    off_time_us = sight.family.read(drive, number) * unit_us
    return not off_time_us or off_time_us > 2 * max(LONG_US, 4 * witness.cycle_us)
