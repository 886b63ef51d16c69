# SPDX-License-Identifier: MIT
"""What START and JOG must refuse, judged by the drive itself and by what the line said of it.

In use:

    reason = reason_against(witness, case, address, pressed_us, jogs)     # a text, or None
"""

from tools.soaking.judging.case import drive_at
from tools.soaking.judging.facts import CONTROLLED, LONG_US, MS, S

USS = 5  # P0700, P1000, a digit of P0719
COMMAND = ((700, USS), (840, 2036 << 16))  # with the connector of the words received
SETPOINT = ((1000, USS), (1070, 2018 << 16 | 1), (2200, 0))
TAKEN_US = 1 * S  # the panel may not have seen so recent a change at the drive


def reason_against(witness, case, address, pressed_us, jogs):
    """Why ON, or JOG, should not have been sent for the key that went down at `pressed_us`."""
    if case.bad_us > case.good_us and pressed_us > case.bad_us + 10 * MS:
        return "its status word forbids it"
    drive = drive_at(witness.world, address)
    if drive is None or drive.family.NAME not in CONTROLLED:
        return None
    if not _knows(witness, case, address, pressed_us, jogs):
        return None
    tens, units = drive.read(719) // 10, drive.read(719) % 10
    wrong = _wrong(drive, tens, COMMAND)
    return wrong if jogs else wrong or _wrong(drive, units, SETPOINT)


def _knows(witness, case, address, pressed_us, jogs):
    """Whether the panel must know its settings. START makes it read them anew."""
    if jogs:
        return witness.knows(case, address, pressed_us)
    return case.settings_us <= pressed_us - TAKEN_US


def _wrong(drive, selected, sources):
    """Which of these sources is not USS. selected: a digit of P0719; 0: the others decide."""
    if selected not in (0, USS):
        return "P0719 is %s" % drive.read(719)
    for number, value in () if selected else sources:
        if drive.read(number) != value:
            return "P%04d is %s" % (number, drive.read(number))
    return None


def runs_on_unasked(witness, case, address, pressed_us, jogs):
    """Whether the motor would run on without the panel, for ever or long, and the operator has not
    agreed to that."""
    if case.accepted or address in witness.plan.settings.get("unsupervised", ()):
        return False
    drive = drive_at(witness.world, address)
    if drive is None or drive.family.NAME not in CONTROLLED or address in witness.moved:
        return False
    if not _knows(witness, case, address, pressed_us, jogs):
        return False
    off_time_us = drive.read(2014) * MS
    return not off_time_us or off_time_us > 2 * max(LONG_US, 4 * witness.cycle_us)
