# SPDX-License-Identifier: MIT
"""What the tests of a bad line share: replies that are spoilt on their way, each in one manner.

TROUBLES has for each how it is done, what the firmware is to take it for, what the display says,
and a part of what the exceptions of the library say.
"""

from round_bench import framed
from uss import receiver


def silent(reply):
    return None


def noisy(reply):
    return bytes((0x55, 0x00, 0x31)) + reply[:7]


def garbled(reply):
    """STX, and an LGE of nobody."""
    return reply[:1] + b"\xf1" + reply[2:]


def cut_off(reply):
    return reply[:9]


def longer(reply):
    return framed(reply[2], reply[3:-1] + bytes(4))


def shorter(reply):
    return framed(reply[2], reply[3:-3])


def of_another_address(reply):
    return framed(reply[2] ^ 4, reply[3:-1])


def with_a_wrong_check(reply):
    return reply[:-1] + bytes((reply[-1] ^ 0x10,))


# How a reply is spoilt; the trouble; what the display says; what the exception says.
TROUBLES = (
    (silent, receiver.SILENCE, "NO CONTACT", "drive 1 does not answer"),
    (noisy, receiver.NOISE, "LINE NOISE", "noise"),
    (garbled, receiver.NOISE, "LINE NOISE", "noise"),
    (cut_off, receiver.NOISE, "LINE NOISE", "noise"),
    (longer, receiver.OTHER_LENGTH, "OTHER LENGTH", "another length"),
    (shorter, receiver.OTHER_LENGTH, "OTHER LENGTH", "another length"),
    (of_another_address, receiver.OTHER_ADDRESS, "WRONG DRIVE", "another address"),
    (with_a_wrong_check, receiver.WRONG_CHECK, "WRONG CHECK", "wrong check"),
)


class Spoilt:
    """No closure: the master's telegrams pass it with the heap locked."""

    def __init__(self, talk, drive, how):
        self._talk = talk
        self._drive = drive
        self._how = how

    def talk(self, station, data, count):
        if station is self._drive:
            data = bytearray(self._how(bytes(data[:count])))
            count = len(data)
        return self._talk(station, data, count)


def spoil(wire, drive, how):
    """From now on the replies of this simulated drive are changed on their way."""
    if how is silent:
        drive.unplug()
    else:
        wire.talk = Spoilt(wire.talk, drive, how).talk
