# SPDX-License-Identifier: MIT
"""What START asks before a motor turns: risks that its operator may take, in the order of asking.

    is_open(control, row)           # there is this risk, and nobody has accepted it
    text, can_fix, value = ask(control, row)
    accept(control, row, value)     # as it was when that was asked

P2014 = 0 is accepted for good, in the settings, and with it any other P2014. All else is accepted
until the panel restarts, and only as it is: another P2014, another P1210 is asked about anew.
"""

from micropython import const

from panel import texts
from uss import profiles

NONE = const(-1)  # there is no such risk

_RESTARTS = const(2)  # from this P1210 on the drive may start by itself when its mains are back
_FOR_EVER_MS = const(1 << 20)  # longer than any P2014


def _of_supervision(control):
    """P2014 with which the motor runs on too long when the panel dies, 0: for ever, or unread."""
    off_time_ms = max(control.survey.values[profiles.SUPERVISION], 0)
    if 0 < off_time_ms <= control.longest_off_time_ms:
        return NONE
    return off_time_ms


def _of_restart(control):
    """P1210 where the drive restarts by itself."""
    mode = control.survey.values[profiles.RESTART]
    return mode if mode >= _RESTARTS else NONE


def _of_lateness(control):
    """The address of the drive that this bus cannot ask within a third of its P2014, if it ran."""
    drive = control.bus.first_late(control.drive)
    return NONE if drive is None else drive.address


def _ask_supervision(_control, off_time_ms):
    if not off_time_ms:
        return texts.ASK_UNSUPERVISED
    tenths = -(-off_time_ms // 100)
    turns = (
        texts.ASK_LONG[0] % off_time_ms,
        texts.ASK_LONG[1] % (tenths // 10, tenths % 10),
        texts.ASK_LONG[2],
    )
    return turns, texts.ASK_UNSUPERVISED[1]


def _ask_lateness(_control, address):
    turns, choice = texts.ASK_LATE
    return (turns[0] % address,) + turns[1:], choice


def _ask_restart(_control, mode):
    turns, choice = texts.ASK_RESTART
    return (turns[0] % mode,) + turns[1:], choice


RISKS = (  # its value or NONE, what is asked, whether SET puts it right: SET writes P2014
    (_of_supervision, _ask_supervision, True),
    (_of_lateness, _ask_lateness, False),
    (_of_restart, _ask_restart, False),
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
    """The text of a `Question`, whether SET answers it too, and the value that it tells."""
    _, words, can_fix = RISKS[row]
    value = measure(control, row)
    return words(control, value), can_fix, value


def accept(control, row, value):
    """The operator takes this risk, with the value that was asked about."""
    if row == SUPERVISION and not value:
        control.accept_unsupervised()
    else:
        control.accept(row, value)


def exposure_ms(control):
    """How long its motor would run on too long: 0 for not at all."""
    off_time_ms = _of_supervision(control)
    return off_time_ms or _FOR_EVER_MS if off_time_ms != NONE else 0
