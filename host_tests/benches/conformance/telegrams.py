# SPDX-License-Identifier: MIT
"""What a USS telegram looks like: STX LGE ADR net data BCC (specification A-4).

It knows no drive and no port; net data are words here, the high byte first.

    framed(0x01, [0x047E, 0])       # b"\\x02\\x06\\x01\\x04\\x7e\\x00\\x00\\x7f"
    words_of(reply, 0x01)           # [0x047E, 0]; ValueError says what is wrong with it
"""

import struct

STX = 0x02
BROADCAST, MIRROR, SPECIAL = 0x20, 0x40, 0x80  # bits 5, 6 and 7 of ADR


def check_character(characters):
    """BCC: all characters before it, exclusive-ored, the STX among them."""
    bcc = 0
    for character in characters:
        bcc ^= character
    return bcc


def framed(adr, words):
    """The characters of a telegram with these net data words, 126 at the most."""
    net = struct.pack(">%dH" % len(words), *words)
    telegram = bytes([STX, len(net) + 2, adr]) + net
    return telegram + bytes([check_character(telegram)])


def missing(characters):
    """How many characters a telegram that begins like this still lacks, as far as it tells."""
    return max(0, (characters[1] + 2 if len(characters) > 1 else 4) - len(characters))


def words_of(characters, adr):
    """The net data words of a telegram that has to be whole and from `adr`."""
    problem = _problem(characters, adr)
    if problem:
        raise ValueError("%s: %s" % (problem, characters.hex(" ")))
    return list(struct.unpack(">%dH" % ((len(characters) - 4) // 2), characters[3:-1]))


def _problem(characters, adr):
    if len(characters) < 4 or len(characters) % 2:
        return "no telegram has %d characters" % len(characters)
    if characters[0] != STX:
        return "it does not begin with STX"
    if characters[1] != len(characters) - 2:
        return "LGE says %d characters" % (characters[1] + 2)
    if check_character(characters):
        return "wrong BCC"
    if characters[2] != adr:
        return "ADR is %02X" % characters[2]
    return None


def float_of(words):
    """A float (IEEE 754, single precision) of two words, the high one first."""
    return struct.unpack(">f", struct.pack(">HH", *words))[0]
