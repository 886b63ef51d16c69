# SPDX-License-Identifier: MIT
"""The sixteen checks of tools/bringup: what is asked of the chip, what is right, what to do
otherwise.

    for check in CHECKS:
        if check.needs in present:
            answer = chip.call(check.function, *check.filled(address, baud))
            figure, right = check.judge(answer)

Each row confirms an assumption of the firmware, which `proves` says. (Plain enough for
MicroPython, on which the tests judge an emulated chip.)
"""

RATES = (9_600, 19_200, 115_200, 187_500)
DRIVER_RATES = (300, 19_200, 187_500)
TELEGRAM = 16  # characters
IDLE_BITS = 32  # the receive time-out of a PL011
IDLE_SLACK_BITS, IDLE_SLACK_US = 4, 400
DRIVER_BITS, DRIVER_SLACK_BITS = 11 * TELEGRAM + 0.5, 0.25  # as hal.link.rp2_rs485 says
TURNS = 200
TURN_LEAST_US = 11 * TELEGRAM * 1_000_000 // 115_200  # the telegram alone
TURN_US = 2_200  # the emulated RP2040 takes 2,070, of which 1,806 are the line's
SAVES, SAVE_MS = 30, 300
WATCHDOG_US, WATCHDOG_PERCENT = 2_000_000, 5
TIMER_LATE_US = 20_000  # a collection, with a stock build
TIMERS = 1_000
PANEL_KB, PANEL_FREE_KB = 200, 36  # what a deployed panel with 31 drives takes: tools/bench.md
BACKPACKS = (0x27, 0x3F)
I2C_US, I2C_PIECES = 1_000, 10_000
PAGES = (0x20, 0x40, 0x60, 0xA0, 0xC0, 0xE0)  # of character codes; a controller has no others
BIT_PERCENT = 1
MPY_OLDEST = (1, 25)

# What a check needs besides the board: bare is with both jumpers, the others need --wired.
NOTHING, JUMPERS, RESTART, DISPLAY, TRANSCEIVER, DRIVE = (
    "", "jumpers", "restart", "display", "transceiver", "drive",
)  # fmt: skip
WHY_NOT = {  # a check was not made
    JUMPERS: "it needs the bare board with its jumpers: leave out --wired",
    RESTART: "it needs the bare board with its jumpers: leave out --wired",
    DISPLAY: "there is no display yet: wire it, then tools/bringup --wired display",
    TRANSCEIVER: "there is no transceiver yet: wire it, leave its bus open, then"
    " tools/bringup --wired transceiver",
    DRIVE: "there is no drive yet: wire it, then tools/bringup --wired drive --address N",
}
ADDRESS, BAUD = "address", "baud"  # in the arguments of a check: of the command line


class Check:
    """number: in the list of what real chips may do otherwise. title: of its line. needs: one of
    the above. function, arguments: of on_line.py or on_chip.py. judge(answer): the figure as text,
    and whether it is right. pages: the function is called for each of these arguments more, and a
    person says what is to be seen; the answers are pairs, (answer, what the person said)."""

    def __init__(
        self, number, title, needs, function, arguments, judge, proves, remedy, pages=None
    ):
        self.number = number
        self.title = title
        self.needs = needs
        self.function = function
        self.arguments = arguments
        self.judge = judge
        self.proves = proves
        self.remedy = remedy
        self.pages = pages

    def filled(self, address, baud):
        """Its arguments, with those of the command line."""
        given = {ADDRESS: address, BAUD: baud}
        return tuple([given.get(argument, argument) for argument in self.arguments])


def judge_identity(answer):
    """What stands above the lines; and whether the firmware runs on this MicroPython."""
    chip, release, mhz, _ = answer
    version = tuple(int(part) for part in release.split("-")[0].split(".")[:2])
    return "%s, MicroPython %s, %d MHz" % (chip, release, mhz), version >= MPY_OLDEST


def judge_timeout(answer):
    came, at_once, later = answer
    if not came:
        return "it does not come", False
    if at_once:
        return "it is there again at once", True
    return "it comes once" if not later else "it comes again after 32 bits", True


def judge_bursts(answer):
    right = True
    latest = []
    for baud, sent, came, same, late_us in answer:
        bits = late_us * baud / 1_000_000
        slack = IDLE_SLACK_BITS + IDLE_SLACK_US * baud / 1_000_000
        right = right and sent == came and same
        right = right and IDLE_BITS - IDLE_SLACK_BITS <= bits <= IDLE_BITS + slack
        latest.append(bits)
    lost = sum(sent - came for _, sent, came, _, _ in answer)
    figure = "%d lost, interrupt after %.1f to %.1f bits" % (lost, min(latest), max(latest))
    return figure, right


def judge_codes(answer):
    came, right, errors = answer
    figure = "%d of 256, %s, error bits %xh" % (came, "right" if right else "WRONG", errors)
    return figure, came == 256 and right and not errors


def judge_driver_pulses(answer):
    right = True
    words = []
    for baud, telegrams, pulses, shortest, longest in answer:
        least, most = shortest / 32, longest / 32
        right = right and pulses == telegrams
        right = right and abs(least - DRIVER_BITS) <= DRIVER_SLACK_BITS
        right = right and abs(most - DRIVER_BITS) <= DRIVER_SLACK_BITS
        words.append("%d of %d at %d, %.1f to %.1f" % (pulses, telegrams, baud, least, most))
    return "; ".join(words) + " bits of %.1f" % DRIVER_BITS, right


def judge_driver_after_bite(answer):
    before, after = answer
    return "%d before, %d at the first statement" % (before, after), (before, after) == (1, 0)


def judge_turns(answer):
    left, took_us, reads, hits = answer
    each_us = took_us / TURNS
    figure = "%d in turn, %.2f ms each" % (TURNS - left, each_us / 1_000)
    cache = "%.1f %% of the reads" % (100 * hits / reads) if reads else "not counted here"
    return figure + ", cache: " + cache, not left and TURN_LEAST_US < each_us <= TURN_US


def judge_saves(answer):
    return f"the longest {answer} ms", answer < SAVE_MS


def judge_watchdog(answer):
    hung_us, cause, stopped = answer
    figure = "%.3f s, then %s" % (hung_us / 1_000_000, cause or "no cause")
    near = abs(hung_us - WATCHDOG_US) * 100 <= WATCHDOG_US * WATCHDOG_PERCENT
    return figure + ", stops", near and cause == "WATCHDOG" and stopped is True


def judge_timers(answer):
    came, late_us, is_hard = answer
    kind = "hard" if is_hard else "soft"
    figure = "%d of %d, the latest %d us, %s" % (came, TIMERS, late_us, kind)
    return figure, came == TIMERS and late_us <= TIMER_LATE_US


def judge_unread(answer):
    came, right = answer
    return f"afterwards {came} of {TELEGRAM} heard", came == TELEGRAM and right


def judge_heap(answer):
    heap_kb = answer // 1024
    figure = "%d KB; a deployed panel with 31 drives leaves %d (calculated)"
    return figure % (heap_kb, heap_kb - PANEL_KB), heap_kb - PANEL_KB >= PANEL_FREE_KB


def judge_i2c(answer):
    if answer < 0:
        return "a backpack, %d of %d pieces failed" % (-1 - answer, I2C_PIECES), answer == -1
    return f"nobody there, said after {answer} us", answer < I2C_US


def judge_display(answer):
    shown = sum(is_shown for is_shown, _ in answer)
    seen = sum(is_seen for _, is_seen in answer)
    figure = "%d of %d pages shown, %d seen" % (shown, len(answer), seen)
    return figure, shown == seen == len(answer)


def judge_quiet(answer):
    return f"{answer} characters heard", answer == 0


def judge_bit(answer):
    baud, count, three_bits_ns = answer
    if not three_bits_ns:
        return "no answer", False
    off = 100 * (three_bits_ns * baud / 3e9 - 1)
    return "%d characters, bits %+.2f %%" % (count, off), abs(off) <= BIT_PERCENT


WIRE = "join GP4 to GP5 by a short wire, and nothing else to either"
JUMPER = "join GP6 to GP3 by a short wire, and nothing else to either"
TELL = "tell us, with the report"
CHECKS = (
    Check(
        1,
        "receive time-out",
        NOTHING,
        "receive_timeout",
        (),
        judge_timeout,
        "the UART says so when characters are left in it, once or again and again",
        TELL,
    ),
    Check(
        2,
        "bursts at %d to %d baud" % (RATES[0], RATES[-1]),
        JUMPERS,
        "bursts",
        (RATES,),
        judge_bursts,
        "the interrupt comes 32 bits after a telegram, and nothing is lost",
        WIRE,
    ),
    Check(
        3,
        "all characters",
        JUMPERS,
        "codes",
        (),
        judge_codes,
        "the state machine sends 8E1, as the UART understands it",
        WIRE,
    ),
    Check(
        4,
        "driver enable, a pulse for each telegram",
        JUMPERS,
        "driver_pulses",
        (DRIVER_RATES,),
        judge_driver_pulses,
        "neither a collection nor writing the flash moves an edge of the driver",
        JUMPER + "; if it is, " + TELL,
    ),
    Check(
        5,
        "driver enable after the watchdog",
        RESTART,
        "driver_after_bite",
        (),
        judge_driver_after_bite,
        "nobody drives the bus while the chip boots",
        JUMPER + ", and take off whatever else is joined to GP6",
    ),
    Check(
        6,
        "telegrams by interrupt",
        JUMPERS,
        "turns",
        (TURNS,),
        judge_turns,
        "the chip is as fast as the emulated one, of which tools/bench.md tells",
        WIRE + "; if it is, " + TELL,
    ),
    Check(
        7,
        "%d saves" % SAVES,
        NOTHING,
        "saves",
        (SAVES,),
        judge_saves,
        "a save holds the panel up for less than its drives' time-out",
        "the flash is slow or worn: use another board",
    ),
    Check(
        8,
        "watchdog",
        RESTART,
        "watchdog",
        (),
        judge_watchdog,
        "it bites after 2 s, says so afterwards, and Ctrl-C can stop it",
        TELL,
    ),
    Check(
        9,
        "%d timer callbacks" % TIMERS,
        NOTHING,
        "timers",
        (TIMERS,),
        judge_timers,
        "collections and USB delay a callback by 20 ms at most",
        "a MicroPython of your own may collect longer: " + TELL,
    ),
    Check(
        10,
        "400 characters, nobody reads",
        JUMPERS,
        "unread",
        (),
        judge_unread,
        "a line that talks without end does not hang the chip",
        WIRE,
    ),
    Check(
        11,
        "heap",
        NOTHING,
        "heap",
        (),
        judge_heap,
        "the panel has room for 31 drives",
        "use a MicroPython that leaves more, or fewer drives, or the one file of tools/uf2",
    ),
    Check(
        12,
        "I2C",
        NOTHING,
        "i2c",
        (BACKPACKS, I2C_PIECES),
        judge_i2c,
        "a missing backpack does not hold up the start, and one that is there fails never",
        "GP0 or GP1 is shorted to ground, or the backpack's wires are too long",
    ),
    Check(
        13,
        "display",
        DISPLAY,
        "show",
        (BACKPACKS,),
        judge_display,
        "the display shows every character that its controller has",
        "check its wires; if some characters are others, " + TELL,
        PAGES,
    ),
    Check(
        14,
        "a second with the driver on",
        TRANSCEIVER,
        "heard_while_driving",
        (BAUD,),
        judge_quiet,
        "the panel does not hear itself",
        "join /RE to DE; if it is, something pulls GP5 down",
    ),
    Check(
        15,
        "10 s of silence",
        TRANSCEIVER,
        "heard_in_silence",
        (BAUD,),
        judge_quiet,
        "a line on which nobody talks reads as silent",
        "the line needs its bias: boards/README.md",
    ),
    Check(
        16,
        "a bit of the drive's reply",
        DRIVE,
        "bit_of",
        (ADDRESS, BAUD),
        judge_bit,
        "chip and drive agree on the length of a bit within 1 %",
        "set the drive to this rate and address; if it is, " + TELL,
    ),
)


def line_of(check, figure, right):
    """right: None where it was not checked, and `figure` says why."""
    words = {True: "PASS", False: "FAIL", None: "NOT CHECKED"}
    return "%-11s %2d %s: %s" % (words[right], check.number, check.title, figure)
