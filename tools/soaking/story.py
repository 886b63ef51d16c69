# SPDX-License-Identifier: MIT
"""What led to a broken rule, for people: keys, faults, screens and telegrams, with their times.

In use:

    for line in story(soak): print(line)
"""

import io
import sys

from tools.soaking.judging.rules import RULES, Broken

EVENTS = 110
TELEGRAMS = 24
FEW = 6  # at most so many drives are reported at the end

WORDS = {
    0x047E: "OFF1", 0x047C: "OFF2", 0x047A: "OFF3", 0x047F: "ON", 0x0C7F: "ON, reverse",
    0x057E: "JOG right", 0x067E: "JOG left",
}  # fmt: skip
ACKNOWLEDGE = 0x0080
STATES = (  # bit of the status word, what it says; the first that is set
    (0x08, "fault"), (0x40, "inhibited"), (0x04, "running"), (0x02, "ready to run"),
    (0x01, "ready"), (0xFFFF, "not ready"),
)  # fmt: skip
TASKS = {
    1: "read", 2: "write", 3: "write double", 13: "write double, EEPROM", 14: "write, EEPROM",
}  # fmt: skip


def story(soak):
    """The lines about a `Soak` that has broken a rule or ended in an exception."""
    broken = soak.broken
    if isinstance(broken, Broken):
        rule, what = broken.args
        yield "seed %d breaks the rule %s: %s" % (soak.seed, rule, RULES[rule])
        yield "    " + what
    else:
        yield "seed %d ended in an exception" % soak.seed
        for line in traceback(broken).split("\n"):
            yield "    " + line
    yield "at %s, %s" % (time_of(soak.world.clock.now_us), soak.plan)
    for at_us, text in sorted(events(soak))[-EVENTS:]:
        yield "%s %s" % (time_of(at_us), text)
    for drive in list(soak.world.drives.values())[:FEW]:
        yield "    " + drive.report()


def events(soak):
    for at_us, text in soak.hand.deeds:
        yield at_us, "        " + text
    if soak.weather.faults is not None:
        for at_us, kind, detail in soak.weather.faults.log:
            yield at_us, "      ! %s %s" % (kind, detail)
    for at_us, row_1, row_2 in soak.reader.screens:
        yield at_us, "            |%s|%s|" % (row_1, row_2)
    for at_us, from_panel, characters in soak.world.wire.log.last(TELEGRAMS):
        yield at_us, decoded(from_panel, characters)


def decoded(from_panel, characters):
    """A telegram as text: its words if it has 4 PKW and 2 PZD words, else its characters."""
    shown = " ".join("%02X" % character for character in characters)
    shown = "%s %s" % (">" if from_panel else "<", shown)
    if len(characters) != 16 or characters[0] != 0x02:
        return shown
    words = [characters[at] << 8 | characters[at + 1] for at in range(3, 15, 2)]
    text = commanded(words[4]) if from_panel else answered(words[4])
    task = words[0] >> 12
    if task:
        number = (words[0] & 0x7FF) + (2000 if words[1] & 0x8000 else 0)
        name = TASKS.get(task, "task %d" % task) if from_panel else "reply %d" % task
        text += "; %s P%04d = %04X %04X" % (name, number, words[2], words[3])
    return "%s  A%d %s" % (shown, characters[2] & 31, text)


def commanded(stw):
    text = WORDS.get(stw & ~ACKNOWLEDGE, "STW %04X" % stw)
    return text + ", acknowledge" if stw & ACKNOWLEDGE else text


def answered(zsw):
    for bit, name in STATES:
        if zsw & bit:
            return name
    return STATES[-1][1]


def time_of(us):
    return "%6d.%06d s" % (us // 1_000_000, us % 1_000_000)


def traceback(error):
    if hasattr(sys, "print_exception"):  # MicroPython
        text = io.StringIO()
        sys.print_exception(error, text)
        return text.getvalue().strip()
    import traceback as of_cpython

    return "".join(of_cpython.format_exception(error)).strip()
