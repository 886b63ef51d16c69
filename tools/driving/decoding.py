"""A telegram in words, for the log of tools/drive: who, which parameter task, which commands.

    line(12_345_678, True, characters, drives)
    # "   12.345678 > A1  read P0700[0]  STW 047E  HSW    0.0 %"

drives: {address: `Drive`}; how a telegram is divided into PKW and PZD is asked of them, at the
moment. A telegram that none of them would take is shown as characters, with what is wrong.
"""

import struct

from boards.sim.slave import BROADCAST_BIT, MIRROR_BIT, SPECIAL_BIT, STX, VARIABLE, xor_of

NODE = 0x1F
SHOWN = 24  # characters of something that is no telegram

TASKS = (
    "", "read", "write", "write long", "read description", "write description", "read array",
    "write array", "write array long", "count", "task 10", "write array long EEPROM",
    "write array EEPROM", "write long EEPROM", "write EEPROM", "read text",
)  # fmt: skip
REPLIES = (
    "", "is", "is long", "description", "is array", "is array long", "elements", "error",
    "no change rights", "report", "report long", "report array", "report array long", "reply 13",
    "reply 14", "text",
)  # fmt: skip
TASKS_WITH_VALUE = (2, 3, 7, 8, 11, 12, 13, 14)
REPLIES_WITH_VALUE = (1, 2, 4, 5, 6, 7, 9, 10, 11, 12)
LONG_TASKS, LONG_REPLIES = (3, 8, 11, 13), (2, 5, 10, 12)

# High byte of IND: where a family numbers its parameters beyond 1999.
PAGES = {0x80: 2000, 0x10: 4000, 0x90: 6000, 0x20: 8000}

# Bits of STW and ZSW (USS specification C-5.2.1): the word when it is 1, the word when it is 0.
STW_BITS = (
    ("ON", "OFF1"), ("", "OFF2"), ("", "OFF3"), ("", "pulses off"), ("", "ramp zero"),
    ("", "ramp held"), ("", "setpoint off"), ("ACKNOWLEDGE", ""), ("JOG RIGHT", ""),
    ("JOG LEFT", ""), ("", "NOT BY PLC"), ("REVERSE", ""),
)  # fmt: skip
ZSW_BITS = (
    ("", ""), ("ready", ""), ("running", ""), ("FAULT", ""), ("", "OFF2"), ("", "OFF3"),
    ("inhibited", ""), ("warning", ""), ("at setpoint", ""), ("", "local"),
)  # fmt: skip

FULL_SCALE = 0x4000  # is 100 %


def line(at_us, from_master, characters, drives):
    """One line of the log."""
    head = "%5d.%06d %s " % (at_us // 1_000_000, at_us % 1_000_000, "<>"[from_master])
    here = {drive.address: drive for drive in drives.values()}
    wrong = flaw(characters, from_master, here)
    if wrong:
        shown = " ".join("%02X" % character for character in characters[:SHOWN])
        return "%s%s%s  (%s)" % (head, shown, " ..." if len(characters) > SHOWN else "", wrong)
    return head + telegram(characters, from_master, here)


def flaw(characters, from_master, here):
    """Why no drive takes this; "" when one does."""
    count = len(characters)
    if characters[0] != STX:
        return "no STX"
    if count < 3 or count < characters[1] + 2:
        expected = " of %d" % (characters[1] + 2) if count > 1 else ""
        return "cut off: %d%s characters" % (count, expected)
    length = characters[1] + 2
    if xor_of(characters, length):
        bcc = xor_of(characters, length - 1)
        return "BCC %02X should be %02X" % (characters[length - 1], bcc)
    if count > length:
        return "%d characters behind the telegram, without a pause" % (count - length)
    return _why_not_taken(characters, from_master, here)


def _why_not_taken(characters, from_master, here):
    adr = characters[2]
    if adr & SPECIAL_BIT:
        return "special telegram"
    if adr & BROADCAST_BIT:
        return "" if not adr & MIRROR_BIT else "mirror and broadcast at once"
    if adr & NODE not in here:
        return "nobody has address %d" % (adr & NODE) if from_master else "another drive's"
    pkw, pzd = here[adr & NODE].layout
    words = (characters[1] - 2) // 2
    if pkw == VARIABLE:
        return "" if words >= pzd else "LGE %d, the drive has %d PZD words" % (characters[1], pzd)
    if words != pkw + pzd or characters[1] & 1:
        expected = 2 * (pkw + pzd) + 2
        return "LGE %d should be %d: %d + %d words" % (characters[1], expected, pkw, pzd)
    return ""


def telegram(characters, from_master, here):
    """What a telegram says that is in order."""
    adr = characters[2]
    end = characters[1] + 1
    words = [characters[i] << 8 | characters[i + 1] for i in range(3, end, 2)]
    if adr & BROADCAST_BIT:
        return "all broadcast, enable " + " ".join("%04X" % word for word in words)
    if adr & MIRROR_BIT:
        return "A%-2d mirror" % (adr & NODE)
    count = max(len(words) - here[adr].layout[1], 0)
    parts = ["A%-2d" % adr]
    if count:
        parts.append(("%-28s" % parameter(words[:count], from_master)))
    return " ".join(parts + [process(words[count:], from_master)]).rstrip()


def parameter(words, from_master):
    """The PKW area in words: "read P0700[0]", "is P0700[0] = 5"."""
    kind = words[0] >> 12
    name = (TASKS if from_master else REPLIES)[kind]
    if not name:
        return "-"
    index = words[1] if len(words) > 1 else 0
    number = (words[0] & 0x7FF) + PAGES.get(index >> 8 & 0xFC, 0)
    said = "%s P%04d[%d]" % (name, number, index & 0xFF)
    if kind not in (TASKS_WITH_VALUE if from_master else REPLIES_WITH_VALUE):
        return said
    long = kind in (LONG_TASKS if from_master else LONG_REPLIES)
    return said + " = " + value(words[2:], long)


def value(words, long):
    """The PWE area: a word, or a double word, which is a float where that makes sense."""
    if not long or len(words) < 2:
        return "%d" % words[-1] if words else "?"
    double = words[0] << 16 | words[1]
    (real,) = struct.unpack(">f", struct.pack(">I", double))
    if 1e-4 < abs(real) < 1e7:
        return "%g (%08X)" % (round(real, 4), double)
    return "%d" % double


def process(words, from_master):
    """The PZD area: control or status word, setpoint or actual value, the others as they are."""
    if not words:
        return ""
    name, second, bits = ("STW", "HSW", STW_BITS) if from_master else ("ZSW", "HIW", ZSW_BITS)
    said = "%s %04X" % (name, words[0])
    if len(words) > 1:
        signed = words[1] - (words[1] >> 15 << 16)
        said += " %s %7.2f %%" % (second, 100 * signed / FULL_SCALE)
    if len(words) > 2:
        said += " " + " ".join("%04X" % word for word in words[2:])
    meanings = (bits[i][not words[0] >> i & 1] for i in range(len(bits)))
    return said + "  " + ", ".join(meaning for meaning in meanings if meaning)
