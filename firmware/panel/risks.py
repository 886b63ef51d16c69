# SPDX-License-Identifier: MIT
"""What START asks before a motor turns: risks that its operator may take, in the order of asking.

    is_open(control, row)           # there is this risk, and nobody has accepted it
    text, values, can_fix, value = ask(control, row)
    control.accept_risk(row, value) # as it was when that was asked

P2014 = 0 is accepted for good, in the settings, and with it any other P2014. All else is accepted
until the panel restarts, and only as it is: another P2014, another P1210 is asked about anew.
"""

from micropython import const

from panel import texts
from uss.families import rows

NONE = const(-1)  # there is no such risk

_RESTARTS = const(2)  # from this P1210 on the drive may start by itself when its mains are back
_FOR_EVER_MS = const(1 << 20)  # longer than any P2014


def _of_supervision(control):
    """P2014 with which the motor runs on too long when the panel dies, 0: for ever, or unread."""
    off_time_ms = control.survey.off_time_ms()
    if 0 < off_time_ms <= control.desk.longest_off_time_ms:
        return NONE
    return off_time_ms


def _of_restart(control):
    """P1210 where the drive restarts by itself."""
    mode = control.survey.values[rows.RESTART]
    return mode if mode >= _RESTARTS else NONE


def _of_lateness(control):
    """The address of the drive that this bus cannot ask within a third of its P2014, if it ran."""
    drive = control.desk.bus.deadlines.first_late(control.drive)
    return NONE if drive is None else drive.address


RISKS = (  # its value or NONE, what is asked, whether SET puts it right: SET writes P2014
    (_of_supervision, texts.ASK_LONG, True),
    (_of_lateness, texts.ASK_LATE, False),
    (_of_restart, texts.ASK_RESTART, False),
)
SUPERVISION = const(0)


def measure(control, row):
    """What the risk is now: a value of its own kind, or NONE."""
    return RISKS[row][0](control)


def is_open(control, row):
    """Whether there is this risk, and nobody has accepted it."""
    value = measure(control, row)
    if value == NONE or control.accepts(row, value):
        return False
    return row != SUPERVISION or not control.accepts_unsupervised()


def ask(control, row):
    """The text of a `Question`, the values in it, whether SET answers it too, and the risk's."""
    _, text, can_fix = RISKS[row]
    value = measure(control, row)
    values = (value,)
    if row == SUPERVISION:
        survey = control.survey
        number, told = survey.family.off_time_number, survey.values[rows.SUPERVISION]
        can_fix = number is not None and control.drive.layout.pkw_words
        tenths = -(-value // 100)
        values = (number, told, tenths // 10, tenths % 10)
        if not value:
            text, values = texts.ASK_UNSUPERVISED, (number,)
        if not can_fix:
            text, values = texts.ASK_UNTOLD, ()
    return text, values, can_fix, value


def exposure_ms(control):
    """How long its motor would run on too long: 0 for not at all."""
    off_time_ms = _of_supervision(control)
    return off_time_ms or _FOR_EVER_MS if off_time_ms != NONE else 0
