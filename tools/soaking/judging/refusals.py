# SPDX-License-Identifier: MIT
"""What START and JOG must refuse, judged by the drive itself and by what the line said of it.

In use:

    reason = reason_against(witness, case, address, pressed_us, jogs)     # a text, or None
"""

from tools.soaking.judging.case import drive_at
from tools.soaking.judging.facts import LONG_US, MS, S

TAKEN_US = 1 * S  # the panel may not have seen so recent a change at the drive


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
