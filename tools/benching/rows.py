# SPDX-License-Identifier: MIT
"""The rows of the bench: each says what is measured, its bar, and how it is shown.

The bars are here; the figures come from measurements.py, whose functions and arguments are the
tasks. Nothing here measures.
"""

from collections.abc import Callable
from typing import NamedTuple

from boards.sim.ports.chips import HEAP_BYTES
from tools.benching import beside_s7
from tools.benching.beside_s7 import CHARACTER_BITS, CHARACTERS


class Task(NamedTuple):
    """command: function of measurements.py and its arguments. beside: measured by libraries.py,
    beside other libraries.
    """

    command: tuple
    on_chip: bool = True
    beside: bool = False

    @property
    def name(self):
        return self.command[0]


class Row(NamedTuple):
    """show: figures -> text. holds: figures -> whether the bar is reached; None: there is none.
    beside: the baud rate, if the figure stands in the table of `beside_s7`.
    """

    task: Task
    what: str
    bar: str
    show: Callable
    holds: Callable | None
    beside: int | None = None


# How many telegrams are measured at which baud rate.
BAUDS = (9600, 19200, 38400, 115200, 187500)
FAST_BAUD = 57600
TELEGRAMS_FAST, TELEGRAMS_SLOW = 10_000, 50  # bar of the driver enable
TELEGRAMS_FULL = {19200: 400, 115200: 2_000}  # with 31 drives

RATE_BARS = {115200: 260, 187500: 420}  # exchanges a second
SHORT_RATE_BAR = 440
# From a reply to the next start bit, beyond the start interval: median, 99 of 100.
IDLE_NS = {
    9600: (2_400_000, None),
    19200: (2_000_000, None),
    38400: (1_600_000, None),
    115200: (250_000, 1_100_000),
}
ASKING_IDLE_NS = {115200: (700_000, None)}  # a parameter task always pending
MIXED_IDLE_NS = {115200: (500_000, 1_100_000)}  # many lengths, some of them long
DEBOUNCE_US = 20_000
START_US = {(19200, 1): 1_000_000, (19200, 31): 3_000_000}
HANG_US = 400_000
STEP_US = 4_000
READ_US = 100_000  # a step that reads a module from a file: a third of the dead man's 300 ms
FIRST_TELEGRAM_US = 500_000
PICTURE_US = 100_000
FIRST_ROW_US = 300_000
FREE_BYTES = {"frozen": 118 * 1024, "files": 36 * 1024}
ESP32_FREE_BYTES = 40 * 1024
TOO_SMALL = ("ESP32 without PSRAM",)  # boards/esp32/README.md says so
SIMULATION_TIMES = 100
LIBRARY_TIMES = 3  # as fast as the fastest of the others

HANGS = (("pass", "drive"), ("sleep", "drive"), ("collect", "drive"), ("pass", "silent"))
HOW_IT_LIES = {"frozen": "frozen", "files": "as files on plain MicroPython"}
HANG_TEXT = {"pass": "`while True: pass`", "sleep": "time.sleep_ms", "collect": "gc.collect"}

LINES = {baud: Task(("line", str(baud), "1")) for baud in BAUDS}
FULL_BAUDS = (19200, 115200)
FULL_LINES = {baud: Task(("line", str(baud), "31")) for baud in FULL_BAUDS}
ASKING_LINES = {
    (baud, drives): Task(("asking", str(baud), str(drives)))
    for drives in (1, 31)
    for baud in FULL_BAUDS
}
SHORT = Task(("short", "115200"))
LOGGING = Task(("logging", "115200", "31"))
MIXED = {baud: Task(("mixed", str(baud))) for baud in FULL_BAUDS}
SAVING = Task(("saving",))
CUTS = Task(("cuts",))
MEMORIES = {drives: Task(("memory", str(drives))) for drives in (1, 31)}
STOPS = {
    (baud, drives): Task(("stop", str(baud), str(drives)))
    for drives in (1, 31)
    for baud in FULL_BAUDS
}
HANGING = {which: Task(("hang", *which)) for which in HANGS}
STEPS = Task(("steps", "19200", "1"))
FULL_STEPS = Task(("steps", "115200", "31"))
# As files and with 31 drives, there is no room for what measures beside what is measured.
MENUS = {(how, drives): Task(("menu", how, str(drives)))
         for how, drives in (("frozen", 31), ("files", 1))}  # fmt: skip
LOOKUPS = {("frozen", 31): Task(("lookup", "frozen", "31"))}
BOOTS = {display: Task(("boot", display)) for display in ("wires", "backpack")}
PICTURES = {drives: Task(("picture", "19200", str(drives))) for drives in (1, 31)}
HEAPS = {
    (how, drives): Task(("heap", how, str(drives))) for how in HOW_IT_LIES for drives in (1, 31)
}
CODEC = Task(("codec",), on_chip=False)
SIMULATION = Task(("simulation",), on_chip=False)
LIBRARIES = Task(("libraries",), on_chip=False, beside=True)
OTHERS = ("TurboCtl", "MinimalModbus", "PyModbus", "UModbus")

# The long ones first, so that the last one does not run alone for long.
TASKS = (
    LINES[115200], LINES[187500], *MEMORIES.values(), *FULL_LINES.values(),
    *ASKING_LINES.values(), SHORT, LOGGING, *STOPS.values(),
    FULL_STEPS, STEPS, *MENUS.values(), *LOOKUPS.values(), *HANGING.values(), SAVING, CUTS,
    *MIXED.values(),
    LINES[9600], LINES[19200], LINES[38400], *PICTURES.values(), *BOOTS.values(), *HEAPS.values(),
    CODEC, SIMULATION, LIBRARIES,
)  # fmt: skip


def names():
    return sorted({task.name for task in TASKS})


# --- how figures read ---------------------------------------------------------------------------


def ms(ns):
    return "-" if ns is None else "%.2f ms" % (ns / 1e6)


def us(ns):
    return "-" if ns is None else "%.1f us" % (ns / 1e3)


def least_to_most(spread):
    """Of [least, median, 99 of 100, greatest, how many], in nanoseconds."""
    least, median, _, most, count = spread
    return "%s / %s / %s of %d" % (us(least), us(median), us(most), count)


def of_drives(count):
    return "%d drive%s" % (count, "s"[: count > 1])


def baud_of(baud):
    return "%d baud" % baud


def wanted_at(baud):
    return TELEGRAMS_FAST if baud >= FAST_BAUD else TELEGRAMS_SLOW


def within_a_character(spread, character_ns):
    return spread[4] > 0 and 0 <= spread[0] and spread[3] <= character_ns


# --- rows ---------------------------------------------------------------------------------------


def rate_row(task, what, baud, beside=None):
    bar = RATE_BARS.get(baud)
    limit = "wire's limit %.1f" % beside_s7.limit(baud)
    others = ["%s %.1f" % at for at in beside_s7.rates(baud).items()]
    return Row(
        task,
        "exchanges per second, %s (%s)" % (what, ", ".join([limit, *others])),
        ">= %d" % bar if bar else "",
        lambda figures: "%.1f" % figures["rate"],
        (lambda figures: figures["rate"] >= bar) if bar else None,
        beside,
    )


def short_row():
    return Row(
        SHORT,
        "exchanges per second, 115200 baud, telegrams of 8 characters without a task",
        ">= %d" % SHORT_RATE_BAR,
        lambda figures: "%.1f (wire's limit %.1f)" % (figures["rate"], figures["limit"]),
        lambda figures: figures["rate"] >= SHORT_RATE_BAR,
    )


def idle_row(task, what, baud, bars=IDLE_NS):
    bars_ns = bars.get(baud, (None, None))

    def show(figures):
        _, median, p99, most, count = figures["idle_ns"]
        return "%s / %s / %s of %d" % (ms(median), ms(p99), ms(most), count)

    def holds(figures):
        _, median, p99, _, count = figures["idle_ns"]
        return count > 0 and all(
            bar_ns is None or idle_ns <= bar_ns
            for idle_ns, bar_ns in zip((median, p99), bars_ns, strict=True)
        )

    return Row(
        task,
        "reply to next start bit beyond the start interval, %s: median / p99 / max" % what,
        "<= %s" % " / ".join(ms(bar_ns) for bar_ns in bars_ns if bar_ns) if any(bars_ns) else "",
        show,
        holds if any(bars_ns) else None,
    )


def tasks_row(task, what):
    return Row(
        task,
        "parameters read, %s" % what,
        "some",
        lambda figures: "%d" % figures["tasks"],
        lambda figures: figures["tasks"] > 0,
    )


def release_row(task, what, baud, wanted):
    """wanted: so many telegrams at least."""

    def holds(figures):
        spread = figures["release_ns"]
        return within_a_character(spread, figures["character_ns"]) and spread[4] >= wanted

    return Row(
        task,
        "driver off after the last stop bit, %s: min / median / max" % what,
        "0...%s, all of %d" % (us(CHARACTER_BITS * 1_000_000_000 // baud), wanted),
        lambda figures: least_to_most(figures["release_ns"]),
        holds,
    )


def lead_row(task, what, baud):
    return Row(
        task,
        "driver on before the first start bit, %s: min / median / max" % what,
        "0...%s" % us(CHARACTER_BITS * 1_000_000_000 // baud),
        lambda figures: least_to_most(figures["lead_ns"]),
        lambda figures: within_a_character(figures["lead_ns"], figures["character_ns"]),
    )


def saving_row():
    return Row(
        SAVING,
        "driver off after the last stop bit while settings are written, 19200 baud: "
        "min / median / max",
        "0...%s" % us(CHARACTER_BITS * 1_000_000_000 // 19200),
        lambda figures: (
            "%s; %d flash operations" % (least_to_most(figures["release_ns"]), figures["flash"])
        ),
        lambda figures: (
            figures["flash"] > 0
            and not figures["unsaved"]
            and within_a_character(figures["release_ns"], figures["character_ns"])
        ),
    )


def cuts_row():
    return Row(
        CUTS,
        "power cut while settings are written: panel starts with the old ones, the new ones",
        "none lost",
        lambda figures: "%(old)d old, %(new)d new, %(neither)d lost" % figures,
        lambda figures: figures["neither"] == 0 and figures["old"] > 0 and figures["new"] > 0,
    )


def mixed_rate_row(task, what):
    return Row(
        task,
        "exchanges per second, %s" % what,
        "all answer",
        lambda figures: "%.1f (wire's limit %.1f)" % (figures["rate"], figures["limit"]),
        lambda figures: figures["rate"] > 0 and not figures["silent"],
    )


def memory_row(drives):
    return Row(
        MEMORIES[drives],
        "heap taken by exchanges and the home page, %s, motor running, no collection"
        % of_drives(drives),
        "0 bytes in 10000 exchanges",
        lambda figures: "%d bytes in %d exchanges" % (figures["taken"], figures["exchanges"]),
        lambda figures: figures["taken"] == 0 and figures["runs"],
    )


def stop_row(baud, drives):
    def bound_us(figures):
        return DEBOUNCE_US + 2 * figures["exchange_us"]

    def show(figures):
        took = figures["took_us"]
        middle = took[len(took) // 2]
        shown = tuple(at / 1000 for at in (took[0], middle, took[-1]))
        lost = "; %d STARTs did nothing" % figures["lost_starts"] if figures["lost_starts"] else ""
        return "%.1f / %.1f / %.1f ms of %d" % (*shown, len(took)) + lost

    return Row(
        STOPS[baud, drives],
        "STOP pressed to the end of the OFF1 telegram, %s, %d baud: min / median / max"
        % (of_drives(drives), baud),
        "<= %.1f ms: debounce and 2 exchanges"
        % ((DEBOUNCE_US + 2e6 * CHARACTERS * CHARACTER_BITS / baud) / 1000),
        show,
        lambda figures: figures["took_us"][-1] <= bound_us(figures) and not figures["lost_starts"],
    )


def start_row(baud, drives):
    bar_us = START_US.get((baud, drives))

    def show(figures):
        took = figures["starts_us"]
        return "%.0f / %.0f / %.0f ms of %d" % (
            took[0] / 1000, took[len(took) // 2] / 1000, took[-1] / 1000, len(took)
        )  # fmt: skip

    return Row(
        STOPS[baud, drives],
        "START pressed to the end of the ON telegram, %s, %d baud: min / median / max"
        % (of_drives(drives), baud),
        "<= %d s" % (bar_us // 1_000_000) if bar_us else "",
        show,
        (lambda figures: figures["starts_us"][-1] <= bar_us) if bar_us else None,
    )


def hang_row(which):
    how, drive = which
    return Row(
        HANGING[which],
        "main loop hangs in %s while jogging%s: OFF1 on the wire after"
        % (HANG_TEXT[how], ", drive silent" if drive == "silent" else ""),
        "<= %d ms" % (HANG_US // 1000),
        lambda figures: "%.0f ms" % (figures["took_us"] / 1000),
        lambda figures: figures["took_us"] <= HANG_US,
    )


def step_row(task, name, what, bar_us=STEP_US):
    def of(figures):
        return figures[name] if name else figures["steps_us"]

    return Row(
        task,
        "a step of the main loop, %s: median / p99 / max" % what,
        "max <= %.1f ms" % (bar_us / 1000),
        lambda figures: "%d / %d / %d us of %d" % tuple(of(figures)),
        lambda figures: of(figures)[2] <= bar_us,
    )


def collection_row():
    return Row(
        STEPS,
        "a garbage collection, 19200 baud: median / max",
        "",
        lambda figures: "%.1f / %.1f ms" % (
            figures["collections_us"][1] / 1000, figures["collections_us"][3] / 1000
        ),
        None,
    )  # fmt: skip


def boot_rows(display):
    on = "display on four data lines" if display == "wires" else "display on I2C"
    return (
        Row(
            BOOTS[display],
            "power-on to the first telegram, frozen, %s" % on,
            "<= %.1f s" % (FIRST_TELEGRAM_US / 1e6),
            lambda figures: "%.2f s" % (figures["telegram_us"] / 1e6),
            lambda figures: figures["telegram_us"] <= FIRST_TELEGRAM_US,
        ),
        Row(
            BOOTS[display],
            "power-on to READY on the home page, frozen, %s" % on,
            "",
            lambda figures: "%.2f s" % (figures["home_us"] / 1e6),
            None,
        ),
    )


def picture_row(drives):
    def show(figures):
        _, median, p99, most, count = figures["ages_us"]
        return "%.0f / %.0f / %.0f ms of %d" % (median / 1000, p99 / 1000, most / 1000, count)

    return Row(
        PICTURES[drives],
        "a reply brings another frequency, the display shows it, %s, 19200 baud: "
        "median / p99 / max" % of_drives(drives),
        "max <= %d ms" % (PICTURE_US // 1000),
        show,
        lambda figures: figures["ages_us"][4] > 0 and figures["ages_us"][3] <= PICTURE_US,
    )


def first_row(task, drives):
    """The first parameter of a group."""

    def show(figures):
        least, median, _, most, count = figures["firsts_us"]
        return "%.0f / %.0f / %.0f ms of %d" % (least / 1000, median / 1000, most / 1000, count)

    return Row(
        task,
        "SET on a group of parameters, its first one is on the display, %s: min / median / max"
        % of_drives(drives),
        "max <= %d ms" % (FIRST_ROW_US // 1000),
        show,
        lambda figures: figures["firsts_us"][3] <= FIRST_ROW_US,
    )


def heap_row(how, drives):
    bar = FREE_BYTES[how]
    return Row(
        HEAPS[how, drives],
        "free heap of the running panel, %s, %s" % (HOW_IT_LIES[how], of_drives(drives)),
        ">= %d KB" % (bar // 1024) if drives == 31 else "",
        lambda figures: "%.1f KB" % (figures["free"] / 1024),
        (lambda figures: figures["free"] >= bar) if drives == 31 else None,
    )


def esp32_heap_row(chip):
    """The same bytecode, on a chip that is not emulated: what it takes here, of the heap there."""

    def free(figures):
        return HEAP_BYTES[chip] - figures["taken"]

    has_bar = chip not in TOO_SMALL
    return Row(
        HEAPS["files", 31],
        "free heap of an %s, by what its MicroPython prints, as files, 31 drives" % chip,
        ">= %d KB" % (ESP32_FREE_BYTES // 1024) if has_bar else "",
        lambda figures: "%.1f KB" % (free(figures) / 1024),
        (lambda figures: free(figures) >= ESP32_FREE_BYTES) if has_bar else None,
    )


def rules_row(task):
    """A broken rule of line or display is a figure too."""
    return Row(
        task,
        "rules of line and display broken, and restarts, in `%s`" % " ".join(task.command),
        "none",
        lambda figures: "; ".join(figures["complaints"] + figures["restarts"]) or "none",
        lambda figures: not figures["complaints"] and not figures["restarts"],
    )


def library_row(name, what, key):
    """The time of one of the other libraries."""

    def show(figures):
        own = figures["Uss"][key]
        return "%.1f us: %.1f times ours" % (figures[name][key], figures[name][key] / own)

    return Row(LIBRARIES, "%s, %s" % (what, name), "", show, None)


def own_library_row(what, key):
    """Our time, beside that of the fastest of the others."""

    def times(figures):
        return min(figures[name][key] for name in OTHERS) / figures["Uss"][key]

    return Row(
        LIBRARIES,
        "%s, this library" % what,
        ">= %d times as fast as the fastest other" % LIBRARY_TIMES,
        lambda figures: "%.1f us: %.1f times" % (figures["Uss"][key], times(figures)),
        lambda figures: times(figures) >= LIBRARY_TIMES,
    )


LIBRARY_TEXT = {"parse_us": "a reply parsed", "exchange_us": "an exchange"}

FULL = "31 drives, %d baud"
ASKING = {
    (baud, drives): "%s, %d baud, a parameter task always pending" % (of_drives(drives), baud)
    for baud, drives in ASKING_LINES
}
MENU_TEXT = {
    "opening": "the menu is opened and closed, %s, %s",
    "walking": "the menu is walked, %s, %s",
    "lists": "each list of the menu is opened, a module in a step, %s, %s",
}
LOOKUP_TEXT = {
    "lists": "groups, fault memory and the text of a warning, %s, %s",
    "pages": "parameters of groups are walked and changed, %s, %s",
}
MENU_US = {"frozen": STEP_US, "files": READ_US}
MIXED_TEXT = "31 drives of mixed layouts, %d baud, master alone"

ROWS = (
    *(rate_row(LINES[baud], baud_of(baud), baud, baud) for baud in BAUDS),
    *(rate_row(FULL_LINES[baud], FULL % baud, baud) for baud in FULL_BAUDS),
    *(rate_row(task, ASKING[at], at[0]) for at, task in ASKING_LINES.items()),
    short_row(),
    *(mixed_rate_row(MIXED[baud], MIXED_TEXT % baud) for baud in FULL_BAUDS),
    *(idle_row(LINES[baud], baud_of(baud), baud) for baud in BAUDS),
    *(idle_row(FULL_LINES[baud], FULL % baud, baud) for baud in FULL_BAUDS),
    *(idle_row(task, ASKING[at], at[0], ASKING_IDLE_NS) for at, task in ASKING_LINES.items()),
    *(tasks_row(task, ASKING[at]) for at, task in ASKING_LINES.items()),
    *(idle_row(MIXED[b], MIXED_TEXT % b, b, MIXED_IDLE_NS) for b in FULL_BAUDS),
    *(release_row(LINES[baud], baud_of(baud), baud, wanted_at(baud)) for baud in BAUDS),
    *(release_row(FULL_LINES[b], FULL % b, b, TELEGRAMS_FULL[b]) for b in FULL_BAUDS),
    *(release_row(MIXED[b], MIXED_TEXT % b, b, TELEGRAMS_SLOW) for b in FULL_BAUDS),
    saving_row(),
    *(lead_row(LINES[baud], baud_of(baud), baud) for baud in BAUDS),
    *(lead_row(FULL_LINES[baud], FULL % baud, baud) for baud in FULL_BAUDS),
    *(memory_row(drives) for drives in MEMORIES),
    *(stop_row(baud, drives) for baud, drives in STOPS),
    *(start_row(baud, drives) for baud, drives in STOPS),
    *(hang_row(which) for which in HANGS),
    step_row(STEPS, "home", "home page, 19200 baud"),
    step_row(STEPS, "changing", "changing display, 19200 baud"),
    step_row(STEPS, "parameters", "parameter page, 19200 baud"),
    step_row(LINES[115200], None, "changing display, 115200 baud"),
    step_row(FULL_STEPS, "home", "home page, " + FULL % 115200),
    step_row(FULL_STEPS, "changing", "changing display, " + FULL % 115200),
    step_row(FULL_STEPS, "parameters", "parameter page, " + FULL % 115200),
    step_row(FULL_LINES[19200], None, "changing display, " + FULL % 19200),
    *(
        step_row(task, None, "changing display, " + ASKING[at])
        for at, task in ASKING_LINES.items()
    ),
    step_row(LOGGING, None, "changing display, a line of the log a second, " + FULL % 115200),
    *(
        step_row(task, name, MENU_TEXT[name] % (HOW_IT_LIES[how], of_drives(drives)), MENU_US[how])
        for (how, drives), task in MENUS.items()
        for name in MENU_TEXT
    ),
    *(
        step_row(task, name, LOOKUP_TEXT[name] % (HOW_IT_LIES[how], of_drives(drives)))
        for (how, drives), task in LOOKUPS.items()
        for name in LOOKUP_TEXT
    ),
    *(first_row(task, drives) for (_, drives), task in LOOKUPS.items()),
    collection_row(),
    *(picture_row(drives) for drives in PICTURES),
    *(row for display in BOOTS for row in boot_rows(display)),
    *(heap_row(*which) for which in HEAPS),
    *map(esp32_heap_row, HEAP_BYTES),
    cuts_row(),
    *(rules_row(task) for task in TASKS if task.on_chip and task.name != "hang"),
    Row(CODEC, "receiver, characters per second", "", lambda f: "%d" % f["receiver"], None),
    Row(CODEC, "builder, characters per second", "", lambda f: "%d" % f["builder"], None),
    Row(
        SIMULATION,
        "simulation, whole panel, display, one drive at 19200, running: x real time",
        ">= %d" % SIMULATION_TIMES,
        lambda figures: "%d" % figures["times"],
        lambda figures: figures["times"] >= SIMULATION_TIMES and not figures["complaints"],
    ),
    *(
        row
        for key, what in LIBRARY_TEXT.items()
        for row in (
            own_library_row(what, key),
            *(library_row(name, what, key) for name in OTHERS),
        )
    ),
)
