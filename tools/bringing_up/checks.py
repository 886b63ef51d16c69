# SPDX-License-Identifier: MIT
"""The checks of tools/bringup: what is asked of the chip, what is right, what to do otherwise.

    for check in CHECKS:
        answer = chip.call(check.function, *check.arguments)
        figure, right = check.judge(answer)

Each row confirms an assumption of the firmware, which `proves` says. (Plain enough for
MicroPython, on which the tests judge an emulated chip.)
"""

RATES = (9_600, 19_200, 115_200)
IDLE_BITS = 32  # the receive time-out of a PL011
IDLE_SLACK_BITS, IDLE_SLACK_US = 4, 400
SAVES, SAVE_MS = 20, 300
TIMER_LATE_US = 20_000  # a collection, with a stock build
I2C_US = 1_000
TIMERS = 200
MPY_OLDEST = (1, 25)


class Check:
    """title: of its line. function, arguments: of on_chip.py. judge(answer): the figure as text,
    and whether it is right."""

    def __init__(self, title, function, arguments, judge, proves, remedy):
        self.title = title
        self.function = function
        self.arguments = arguments
        self.judge = judge
        self.proves = proves
        self.remedy = remedy


def judge_identity(answer):
    chip, release, mhz, heap = answer
    version = tuple(int(part) for part in release.split("-")[0].split(".")[:2])
    figure = "%s, MicroPython %s, %d MHz, %d KB free" % (chip, release, mhz, heap // 1024)
    return figure, version >= MPY_OLDEST and heap > 100 * 1024


def judge_driver(answer):
    level, cause = answer
    return "level %d" % level + (", after %s" % cause.lower() if cause else ""), level == 0


def judge_bursts(baud):
    def judge(answer):
        bits = [late_us * baud / 1_000_000 for _, _, _, late_us in answer]
        slack = IDLE_SLACK_BITS + IDLE_SLACK_US * baud / 1_000_000
        right = all(
            sent == came and same and abs(late - IDLE_BITS) <= slack
            for (sent, came, same, _), late in zip(answer, bits)
        )
        lost = sum(sent - came for sent, came, _, _ in answer)
        return "%d lost, interrupt after %.1f to %.1f bits" % (lost, min(bits), max(bits)), right

    return judge


def judge_codes(answer):
    came, right, errors = answer
    figure = "%d of 256, %s, error bits %xh" % (came, "right" if right else "WRONG", errors)
    return figure, came == 256 and right and not errors


def judge_unread(answer):
    came, right = answer
    return f"afterwards {came} of 16 heard", came == 16 and right


def judge_saves(answer):
    return f"the longest {answer} ms", answer < SAVE_MS


def judge_timers(answer):
    came, late_us, is_hard = answer
    kind = "hard" if is_hard else "soft"
    figure = "%d of %d, the latest %d us, %s" % (came, TIMERS, late_us, kind)
    return figure, came == TIMERS and late_us <= TIMER_LATE_US


def judge_i2c(answer):
    if answer < 0:
        return "somebody answers: a backpack", True
    return f"{answer} us", answer < I2C_US


def judge_true(answer):
    return "yes" if answer else "no", answer is True


WIRE = "join GP4 to GP5 by a short wire, and nothing else to either"
BURSTS = tuple(
    [
        Check(
            "bursts at %d baud" % baud,
            "bursts",
            (baud,),
            judge_bursts(baud),
            "the interrupt comes 32 bits after a telegram, and nothing is lost",
            WIRE,
        )
        for baud in RATES
    ]
)
CHECKS = BURSTS + (
    Check(
        "chip and MicroPython",
        "identity",
        (),
        judge_identity,
        "the firmware fits it",
        "put MicroPython 1.25 or newer onto it",
    ),
    Check(
        "driver enable is low",
        "driver_is_low",
        (),
        judge_driver,
        "nobody drives the bus while the chip boots",
        "take off what is joined to GP6, or put its pull-down there",
    ),
    Check(
        "all characters",
        "codes",
        (),
        judge_codes,
        "the state machine sends 8E1, as the UART understands it",
        WIRE,
    ),
    Check(
        "400 characters, nobody reads",
        "unread",
        (),
        judge_unread,
        "a line that talks without end does not hang the chip",
        WIRE,
    ),
    Check(
        "%d saves" % SAVES,
        "saves",
        (SAVES,),
        judge_saves,
        "a save holds the panel up for less than its drives' time-out",
        "the flash is slow or worn: use another board",
    ),
    Check(
        "%d timer callbacks" % TIMERS,
        "timers",
        (TIMERS,),
        judge_timers,
        "collections delay a soft callback by 20 ms at most",
        "a MicroPython of your own may collect longer: tell us",
    ),
    Check(
        "I2C with nothing attached",
        "i2c_absent",
        (),
        judge_i2c,
        "a missing backpack does not hold up the start",
        "GP0 or GP1 is shorted to ground",
    ),
    Check(
        "watchdog stops",
        "watchdog_stops",
        (),
        judge_true,
        "Ctrl-C leaves time to work on the chip",
        "tell us: the register is another one",
    ),
)


def line_of(check, figure, right):
    return "%s  %s: %s" % ("PASS" if right else "FAIL", check.title, figure)
