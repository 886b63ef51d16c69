# SPDX-License-Identifier: MIT
"""The machine code that looks at a reply. Its twin in plain Python, in `python`, says what it
means."""

import micropython


@micropython.viper
def says_nothing_new(reply: ptr8, count: int, request: ptr8, plan: ptr16, attention: ptr8) -> bool:
    if reply[0] != 0x02 or reply[1] != count - 2 or reply[2] != request[2]:
        return False
    check = 0
    index = count
    while index:
        index -= 1
        check ^= reply[index]
    if check != 0:
        return False
    last = count - 1
    while reply[last] == request[last]:  # an echo? Mostly the BCC differs
        if last == 0:
            return False
        last -= 1
    answers = plan[0]  # plan.AK
    if answers != 0:
        answer = reply[3] >> 4
        if answers >> answer & 1 == 0:
            return False
        if answer != 0:
            if (reply[3] ^ request[3]) & 0x07 or reply[4] != request[4]:
                return False
            if reply[5] != request[5] or reply[6] != request[6]:
                return False
    at = plan[1]  # plan.ZSW_AT
    if at != 0:
        if ((reply[at] << 8 | reply[at + 1]) ^ plan[2]) & 0x4C:  # plan.ZSW
            return False
        near = plan[3]  # plan.NEAR
        if near != 0:
            hiw = reply[at + 2] << 8 | reply[at + 3]
            if (hiw + (near >> 1)) & 0xFFFF <= near:
                return False
    return attention[96] == 0  # ANY
