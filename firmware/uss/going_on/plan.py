# SPDX-License-Identifier: MIT
"""The plan by which a reply is looked at before the next telegram may leave: words of 16 bits."""

from micropython import const

from uss.drive import MOTION
from uss.pkw import FITTING
from uss.pzd import STW_RUN, ZSW_RUNNING

AK = const(0)  # which AK the reply may have, a bit each; 0: any. Unless AK is 0, PNU and IND agree
ZSW_AT = const(1)  # where its ZSW stands; 0: that may be anything
ZSW = const(2)  # what the bits of motion in it must be
NEAR = const(3)  # HIW must be further from 0 than half of this; 0: it may be anything
WORDS = const(4)

__all__ = ("AK", "MOTION", "NEAR", "WORDS", "ZSW", "ZSW_AT", "leave_open", "watch")


def leave_open(plan):
    """The reply of a drive that is not the next one: it may say anything."""
    plan[AK] = plan[ZSW_AT] = 0


def watch(plan, drive):
    """What must not change in the reply that is under way if another request to the same drive is
    to follow at once. With the words as they were, `Drive.take` takes no ON back, and the channel
    goes on as `Channel.foresee` says.
    """
    channel = drive.channel
    plan[AK] = plan[ZSW_AT] = 0
    if not channel.idle:
        if channel._without:
            plan[AK] = 1
        else:
            job = channel._queue[channel._out]
            if job is not None and job.tries > 0:
                plan[AK] = FITTING[job.task]
    if drive._sent_stw & STW_RUN:
        plan[ZSW_AT] = drive.size - drive.layout.pzd_count - 1
        plan[ZSW] = drive.zsw & ZSW_RUNNING  # and neither fault nor inhibit, old or new
        plan[NEAR] = drive.near if drive._arrived else 0
