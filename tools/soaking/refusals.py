# SPDX-License-Identifier: MIT
"""What START and JOG must refuse, told from the drive itself and from what the line said of it.

    reason = reason_against(judge, case, address, pressed_us, jogs)     # a text, or None
"""

from tools.soaking.case import drive_at
from tools.soaking.facts import CONTROLLED, MS, S

USS = 5  # P0700, P1000
READ_US = 60 * S  # settings of a drive that is shown are read within; START has them read anew
TAKEN_US = 1 * S  # a change at the drive that is so young may still come in between


def reason_against(judge, case, address, pressed_us, jogs):
    """Why ON, or JOG, should not have been sent for the key that went down at `pressed_us`."""
    if case.bad_us > case.good_us and pressed_us > case.bad_us + 10 * MS:
        return "its status word forbids it"
    drive = drive_at(judge.world, address)
    if drive is None or drive.family.NAME not in CONTROLLED:
        return None
    if case.settings_us > pressed_us - (READ_US if jogs else TAKEN_US):
        return None
    if drive.read(700) != USS:
        return "P0700 is %s" % drive.read(700)
    if not jogs and drive.read(1000) != USS:
        return "P1000 is %s" % drive.read(1000)
    return None


def runs_on_unasked(judge, case, address, pressed_us, jogs):
    """Whether P2014 is 0, so that the motor would run on without the panel, and nobody agreed."""
    if case.accepted or address in judge.plan.settings.get("unsupervised", ()):
        return False
    drive = drive_at(judge.world, address)
    if drive is None or drive.family.NAME not in CONTROLLED or address in judge.moved:
        return False
    if case.settings_us > pressed_us - (READ_US if jogs else TAKEN_US):
        return False
    return drive.read(2014) == 0
