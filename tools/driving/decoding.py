# SPDX-License-Identifier: MIT
"""A telegram in words, for the log of tools/drive: who, which parameter task, which commands.

    setups = {1: Setup(drive)}          # when the telegram begins
    characters, damage = said(burst)    # when it is over
    line(12_345_678, True, characters, setups, damage)
    # "   12.345678 > A1  read P0700[0]  STW 047E  HSW    0.0 %"

A telegram that no drive would take is shown as characters, with what is wrong.
"""

import struct

from boards.sim.drives.families.texts import SECOND_FIELD, TEXT_CHARACTERS, WRITES
from boards.sim.drives.parameter_channel import ALL_ELEMENTS, PAGE_BITS, number_of, sent_value
from boards.sim.drives.slave import BROADCAST_BIT, MIRROR_BIT, SPECIAL_BIT, STX, VARIABLE, xor_of

NODE = 0x1F
SHOWN = 24  # at most so many characters of something that is not a telegram
DAMAGED = "??"  # stands for a character that came with an error

TALKED_INTO = "talked into: %d of %d characters damaged"
WRONG_BITS = "parity or stop bit wrong: %d of %d characters"

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
ARRAY_TASKS, ARRAY_REPLIES = (7, 8, 11, 12), (4, 5, 11, 12)
TEXT = 15  # task and reply

PAGE = sum(bit for bit, _ in PAGE_BITS)  # in IND

# Bits of STW and ZSW (USS specification C-5.2.1): the word when it is 1, the word when it is 0.
STW_BITS = (
    ("ON", "OFF1"), ("", "OFF2"), ("", "OFF3"), ("", "pulses off"), ("", "ramp zero"),
    ("", "ramp held"), ("", "setpoint off"), ("ACKNOWLEDGE", ""), ("JOG RIGHT", ""),
    ("JOG LEFT", ""), ("", "NOT BY PLC"), ("REVERSE", ""),
)  # fmt: skip
STW_BITS_OF_TWO_DIRECTIONS = STW_BITS[:11] + (("RIGHT", ""), ("LEFT", ""))
ZSW_BITS = (
    ("", ""), ("ready", ""), ("running", ""), ("FAULT", ""), ("", "OFF2"), ("", "OFF3"),
    ("inhibited", ""), ("warning", ""), ("at setpoint", ""), ("", "local"),
)  # fmt: skip

FULL_SCALE = 0x4000  # is 100 %


class Setup:
    """The settings with which a drive takes a telegram. Kept from its beginning, because a write
    may change them at its end."""

    def __init__(self, drive):
        self.address = drive.address
        self.layout = drive.layout
        self.two_directions = drive.family.STYLE["two directions"]
        self.raw_numbers = drive.switches.raw_numbers
        self.second_word = drive.switches.second_word


def said(burst):
    """What was heard of a burst: its characters, None for each with an error; and its damage."""
    characters = list(burst.data[: burst.count])
    if burst.errors is None:
        return characters, ""
    heard = [None if burst.errors[i] else characters[i] for i in range(burst.count)]
    if None not in heard:
        return characters, ""
    why = TALKED_INTO if burst.garbled else WRONG_BITS
    return heard, why % (heard.count(None), len(heard))


def line(at_us, from_master, characters, setups, damage=""):
    """One line of the log. setups: {address: `Setup`}. characters, damage: as `said` has them."""
    head = "%5d.%06d %s " % (at_us // 1_000_000, at_us % 1_000_000, "<>"[from_master])
    wrong = damage or flaw(characters, from_master, setups)
    if wrong:
        shown = " ".join(DAMAGED if one is None else "%02X" % one for one in characters[:SHOWN])
        return "%s%s%s  (%s)" % (head, shown, " ..." if len(characters) > SHOWN else "", wrong)
    return head + telegram(characters, from_master, setups)


def flaw(characters, from_master, here):
    """Why no drive takes this; "" if one does."""
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
        short = "A%d has %d PZD words: LGE %d is too short"
        return "" if words >= pzd else short % (adr & NODE, pzd, characters[1])
    if words != pkw + pzd or characters[1] & 1:
        expected = 2 * (pkw + pzd) + 2
        wrong = "A%d has %d + %d words: LGE %d should be %d"
        return wrong % (adr & NODE, pkw, pzd, characters[1], expected)
    return ""


def telegram(characters, from_master, here):
    """What a valid telegram says, in words."""
    adr = characters[2]
    end = characters[1] + 1
    words = [characters[i] << 8 | characters[i + 1] for i in range(3, end, 2)]
    if adr & BROADCAST_BIT:
        return "all broadcast, enable " + " ".join("%04X" % word for word in words)
    if adr & MIRROR_BIT:
        return "A%-2d mirror" % (adr & NODE)
    setup = here[adr]
    count = max(len(words) - setup.layout[1], 0)
    parts = ["A%-2d" % adr]
    if count:
        parts.append("%-28s" % parameter(words[:count], from_master, setup))
    return " ".join(parts + [process(words[count:], from_master, setup)]).rstrip()


def parameter(words, from_master, setup):
    """The PKW area in words: "read P0700[0]", "is P0700[0] = 5"."""
    kind = words[0] >> 12
    name = (TASKS if from_master else REPLIES)[kind]
    if not name:
        return "-"
    ind = words[1] if len(words) > 1 else 0
    writes_text = kind == TEXT and ind & WRITES
    if from_master and writes_text:
        name = "write text"
    told = name + " " + place(words[0], ind, setup)
    if kind == TEXT:
        told += ", field 2" if ind & SECOND_FIELD else ""
        return told if from_master and not writes_text else told + " = " + text(words[2:])
    if kind not in (TASKS_WITH_VALUE if from_master else REPLIES_WITH_VALUE):
        return told
    long = kind in (LONG_TASKS if from_master else LONG_REPLIES)
    array = kind in (ARRAY_TASKS if from_master else ARRAY_REPLIES)
    if array and ind & 0xFF == ALL_ELEMENTS and setup.layout[0] == VARIABLE:
        return told + " = " + values(words[2:], long)
    return told + " = " + value(words[2:], long, setup, from_master)


def place(pke, ind, setup):
    """P2013[0]; or why it is not a valid number: PNU goes to 1999, and IND tells the page."""
    number = number_of(pke, ind, setup.raw_numbers)
    if number is not None:
        return "P%04d[%d]" % (number, ind & 0xFF)
    page = "page %02X" % ((ind & PAGE) >> 8) if ind & PAGE else "no page"
    return "PNU %d[%d] (%s)" % (pke & 0x7FF, ind & 0xFF, page)


def value(words, long, setup, from_master):
    """The PWE area with one value."""
    if not words:
        return "?"
    if long and len(words) > 1:
        return double_word(words)
    # A reply has the value in one place only; a master has a choice.
    (word,) = sent_value(words, 1, setup.layout[0], from_master and setup.second_word)
    return "%d" % word


def values(words, long):
    """The PWE area with all elements of an array."""
    if long:
        return ", ".join(double_word(words[i : i + 2]) for i in range(0, len(words) - 1, 2))
    return ", ".join("%d" % word for word in words)


def double_word(words):
    """The value as a float, if that makes sense."""
    double = words[0] << 16 | words[1]
    (real,) = struct.unpack(">f", struct.pack(">I", double))
    if 1e-4 < abs(real) < 1e7:
        return "%g (%08X)" % (round(real, 4), double)
    return "%d" % double


def text(words):
    if 2 * len(words) != TEXT_CHARACTERS:
        return " ".join("%04X" % word for word in words) or "?"
    return repr(struct.pack(">8H", *words).decode("latin-1").rstrip())


def process(words, from_master, setup):
    """The PZD area: control or status word, setpoint or actual value, the others as they are."""
    if not words:
        return ""
    name, second, bits = ("STW", "HSW", STW_BITS) if from_master else ("ZSW", "HIW", ZSW_BITS)
    if from_master and setup.two_directions:
        bits = STW_BITS_OF_TWO_DIRECTIONS
    told = "%s %04X" % (name, words[0])
    if len(words) > 1:
        signed = words[1] - (words[1] >> 15 << 16)
        told += " %s %7.2f %%" % (second, 100 * signed / FULL_SCALE)
    if len(words) > 2:
        told += " " + " ".join("%04X" % word for word in words[2:])
    meanings = (bits[i][not words[0] >> i & 1] for i in range(len(bits)))
    return told + "  " + ", ".join(meaning for meaning in meanings if meaning)
