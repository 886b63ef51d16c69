# SPDX-License-Identifier: MIT
"""The look at a reply in plain Python. It defines the meaning, and runs if there is no viper."""

from uss.drive import ANY
from uss.fast.python import agreeing, is_reply
from uss.going_on.plan import AK, MOTION, NEAR, ZSW, ZSW_AT
from uss.telegram import NET


def says_nothing_new(reply, count, request, plan, attention):
    """Whether the `count` characters are the reply to `request`, all is as the plan has it (see
    `plan.watch`), and nobody calls. request: at least as long as the reply.
    """
    if not is_reply(reply, count, request):
        return False
    answers = plan[AK]
    if answers:
        answer = reply[NET] >> 4
        if not answers >> answer & 1 or answer and not _is_about(reply, request):
            return False
    at = plan[ZSW_AT]
    if at:
        if ((reply[at] << 8 | reply[at + 1]) ^ plan[ZSW]) & MOTION:
            return False
        near = plan[NEAR]
        hiw = reply[at + 2] << 8 | reply[at + 3]
        if near and (hiw + (near >> 1)) & 0xFFFF <= near:
            return False
    return attention[ANY] == 0


def _is_about(reply, request):
    """Whether PNU and IND are the same."""
    same = agreeing(reply, NET + 1, request, NET + 1, 3) == 3
    return same and not (reply[NET] ^ request[NET]) & 0x07
