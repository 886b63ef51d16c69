# SPDX-License-Identifier: MIT
"""The USS telegram: how net data becomes a frame, and whether received characters are one.

    STX  LGE  ADR  net[0] ... net[n-1]  BCC        LGE = n + 2, at most 254
    02h              words, high byte first        BCC = exclusive or of all before it

It knows neither time nor line: it judges a burst of characters that is complete. `pkw` and `pzd`
say what the net data mean. Source: specification A-4 and A-5.2.

    count = seal(buffer, address, 12)     # net data already stand at buffer[NET:]
    judge(buffer, count, address, 12)     # GOOD, or what is wrong with it
"""

from micropython import const

from uss.fast import exclusive_or, frame

STX = const(0x02)
NET = const(3)  # net data begin here
NET_COUNT_MAX = const(252)
SIZE_MAX = const(256)  # the longest telegram, all characters counted

# ADR: bits 0-4 are the node, the others the kind of telegram (specification ).
NODE_MAX = const(31)
BROADCAST = const(0x20)
MIRROR = const(0x40)
SPECIAL = const(0x80)

# What `judge` finds, in the order of the checks in specification.
GOOD = const(0)
BAD_START = const(1)  # the first character is not STX
BAD_LENGTH = const(2)  # LGE is not the agreed one, or does not fit the characters that came
BAD_BCC = const(3)
BAD_ADDRESS = const(4)  # somebody else's telegram, or the flag bits differ

FINDINGS = ("good", "start not identified", "wrong length", "wrong BCC", "wrong address")


def put_word(buffer, at, word):
    """Store a 16-bit word, high byte first."""
    buffer[at] = (word >> 8) & 0xFF
    buffer[at + 1] = word & 0xFF


def get_word(buffer, at):
    """The unsigned 16-bit word that stands at index `at`."""
    return buffer[at] << 8 | buffer[at + 1]


# The BCC is this over all characters before it, STX included (specification ). Over a whole
# telegram with its BCC it is 0.
bcc = exclusive_or


def seal(buffer, address, net_count):
    """Put STX, LGE, ADR and BCC around the net data in `buffer`; return the telegram's size.

    buffer: at least net_count + 4 characters, net data from index NET on.
    address: ADR with its flag bits, 0...255.
    net_count: 1...252, even in the drive profile. ValueError beyond it.
    """
    if not 0 < net_count <= NET_COUNT_MAX:
        raise ValueError("net data of %d characters" % net_count)
    size = net_count + 4
    frame(buffer, size, address)
    return size


def judge(buffer, count, address, net_count):
    """Judge whether the `count` characters in `buffer` are the awaited telegram.

    address: the ADR that must stand in it, flag bits included; None accepts any.
    net_count: the agreed number of net characters; None accepts what LGE says.
    Returns GOOD or one of the BAD_ findings. Use nothing of a telegram that is not GOOD.
    """
    if count < 1 or buffer[0] != STX:
        return BAD_START
    if count < 5 or buffer[1] != count - 2:
        return BAD_LENGTH
    if net_count is not None and net_count != count - 4:
        return BAD_LENGTH
    if exclusive_or(buffer, count):
        return BAD_BCC
    if address is not None and buffer[2] != address:
        return BAD_ADDRESS
    return GOOD
