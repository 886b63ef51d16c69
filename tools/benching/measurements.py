# SPDX-License-Identifier: MIT
"""The measurements of the bench: an emulated Pico with the frozen firmware, or the host alone.

One process does one measurement, and prints its figures as a line of JSON. It does not judge them:
rows.py has the bars. Runs on the Unix port, started by __main__.py; by hand

    python3 tools/emulator/launch.py build/unix64/micropython -X heapsize=64M \\
        tools/benching/measurements.py quick stop 19200 1
"""

import gc
import json
import sys
import time

sys.path[:] = ["", "firmware", ".frozen"]

# Bytes between two collections: otherwise MicroPython fills its heap first, and finds no holes.
COLLECT_AFTER = 1_000_000

CHARACTER_BITS = 11
TELEGRAM_CHARACTERS = 16
SHORT_NET_CHARACTERS = 4  # STW and HSW
COLLECT_MS = 100
REPLY_CHARACTERS = 2
LOG_BEGINS_MS = 1_000
SETTLE_MS = 3_000  # from power-on of the panel until it knows its drive, if there is only one
SETTLE_MORE_MS = 30_000  # the longest time with 31 drives
READY_MS = 1_200  # until it shows READY
OLD_SETPOINT = 1_000  # 0.01 Hz
SAVE_MS = 300  # from one save to the next
SAVES = 3  # the last of which erases a sector
START_MS = 5_000  # until ON is sent, at most
STOP_HZ = 0.3  # the motor turns
ON, JOGS = 0x0001, 0x0300  # bits of STW
STW_AT = 11  # in a telegram with a PKW area of 4 words

REFERENCE_CENTIHERTZ = 5_000  # P2000 of a simulated drive
ACTUAL_AT = 10  # column of the actual frequency, in the first row
KEY_MS = 200
TAP_MS = 100
BEGINS_MS = {"frozen": 300, "files": 700}
CHANGES = 20  # of the display, then the other key

BOOT_MS = 5_000  # to the prompt; as files it takes longer
ON_CHIP = "tools/benching/on_chip.py"
MASTER_ON_CHIP = "tools/benching/master_on_chip.py"
DEPLOYED = "build/deployed"  # the firmware as tools/deploy copies it onto a chip
LEARN_MS_A_DRIVE = 1_000  # for a drive that is not shown to tell its settings
TELLS_FREE_MS = 2_000
TELLS_FREE = (
    b"""
import gc
from machine import Timer
def tell(_):
    gc.collect()
    print(gc.mem_alloc(), "taken", gc.mem_free(), "bytes free")
timer = Timer(period=%d, mode=Timer.PERIODIC, callback=tell)
"""
    % TELLS_FREE_MS
)


# --- the chip and what is around it -------------------------------------------------------------


def world_at(baud, drives=1, seed=0, **more):
    """A Pico with the panel's firmware at the line of so many drives, which answer at any rate."""
    kinds = {address % 32: {"parameters": {2014: 2_000}} for address in range(1, drives + 1)}
    return world_of(kinds, baud, seed, **more)


def world_of(kinds, baud, seed=0, **more):
    """kinds: {address: what a simulated drive is given}."""
    from boards.sim.drives.drive import Drive
    from tools.emulator.world import PicoWorld

    settings = {"drives": sorted(kinds)}
    settings.update(more.pop("settings", {}))
    program = more.pop("program", "panel")
    world = PicoWorld(program, addresses=(), baud=baud, settings=settings, seed=seed, **more)
    for address, kind in kinds.items():
        kind["reply_delay_us"] = -(-REPLY_CHARACTERS * CHARACTER_BITS * 1_000_000 // baud)
        world.drives[address] = Drive(world.clock, world.wire, address, any_baud=True, **kind)
    return world


def at_the_prompt(world, program=ON_CHIP):
    """Hold DOWN at power-on, which leaves the chip at its prompt, and load what is in
    `program`.
    """
    world.down("DOWN")
    if not world.run_until(lambda: b"not started" in world.usb, BOOT_MS):
        raise RuntimeError("the chip does not come to its prompt: %r" % bytes(world.usb))
    world.repl.open()
    world.up("DOWN")
    with open(program) as file:
        pieces = file.read().split("\n\n\n")  # no more than there is room for in one piece
    for piece in ["import gc"] + pieces:
        printed, error = world.repl.execute(piece + "\ngc.collect()")
        if error:
            raise RuntimeError(error)


def result(world, ms, begins=b"{"):
    """What a function of on_chip.py has printed, once it is over. begins: how it does, where lines
    of the log stand before it."""
    printed = world.repl.wait_for(b"\x04", ms, since=2)
    error = world.repl.wait_for(b"\x04>", ms, since=2 + len(printed))
    if len(error) > 2:
        raise RuntimeError(error.decode())
    return json.loads(printed[printed.find(begins) : -1].decode())


def settle(world):
    """Wait until the panel knows the drive that is shown."""
    world.run(SETTLE_MS)
    if not world.run_until(lambda: world.reads("READY"), SETTLE_MORE_MS):
        raise RuntimeError("the drive is not ready: %r" % (world.lcd(),))


def start_the_motor(world):
    """Press START and check that the motor turns: otherwise there is nothing to measure."""
    settle(world)
    world.press("START")
    if not world.run_until(lambda: world.drives[1].hz() > STOP_HZ, 4_000):
        raise RuntimeError("the motor does not turn: %r" % (world.lcd(),))


def character_ns(baud):
    return CHARACTER_BITS * 1_000_000_000 // baud


def spread(figures):
    """[least, median, 99 of 100, greatest, how many] of some figures."""
    figures = sorted(figures)
    count = len(figures)
    if not count:
        return [None, None, None, None, 0]
    return [figures[0], figures[count // 2], figures[(count * 99 - 1) // 100], figures[-1], count]


def percentile(table, percent):
    """Of [[value, count], ...] in the order of values."""
    left = sum(count for _, count in table) * percent
    for value, count in table:
        left -= count * 100
        if left <= 0:
            return value


def steps_of(table, bucket_us=20):
    """[median, 99 of 100, greatest, how many] of a table of durations, at their buckets' ends."""
    figures = [percentile(table, percent) + bucket_us for percent in (50, 99, 100)]
    return figures + [sum(count for _, count in table)]


def checked(world, figures):
    """Breaches of the rules of line and display are a figure too."""
    figures["complaints"] = world.complaints()[:5]
    figures["restarts"] = ["%s at %d" % (cause, at) for at, cause in world.restarts[:5]]
    return figures


# --- on the chip --------------------------------------------------------------------------------


def line(quick, baud, drives):
    """Exchanges, idle time, driver enable; keys and display busy, a collection every 100 ms."""
    return exchanges(quick, baud, drives, False)


def short(quick, baud):
    """As `line`, with one drive whose telegrams without a task have no PKW words."""
    from boards.sim.drives.families import mm440

    kinds = {1: {"family": mm440, "parameters": {2013: 127, 2014: 2_000}}}
    settings = {"kinds": {"1": "mm440/127s"}}
    found = exchanges(quick, baud, 1, False, kinds=kinds, settings=settings)
    found["limit"] = rate_limit(int(baud), SHORT_NET_CHARACTERS)
    return found


def asking(quick, baud, drives):
    """As `line`, and each drive always has a parameter task pending."""
    return exchanges(quick, baud, drives, True)


def logging(quick, baud, drives):
    """As `line`, and the panel writes its log to a PC that reads. Before it does it counts its
    memory, which takes long.
    """
    return exchanges(quick, baud, drives, False, LOG_BEGINS_MS, settings={"log": "JSON"})


def exchanges(quick, baud, drives, tasks, begins_ms=0, kinds=None, **more):
    baud, drives = int(baud), int(drives)
    most = 10_000 if drives == 1 else 3_000
    telegrams = (100 if quick else 400) if baud < 57600 else 500 if quick else most
    world = world_of(kinds, baud, **more) if kinds else world_at(baud, drives, **more)
    at_the_prompt(world)
    busy_ms = telegrams * 1000 // rate_limit(baud) * 18 // 10 + 2_000
    whole_ms = busy_ms + SETTLE_MS + 3_000 + 400 * drives
    world.repl.begin("steps(%d, 1, %d, %r, %d)" % (whole_ms, COLLECT_MS, tasks, begins_ms))
    start_the_motor(world)
    first = Line(world)
    while first.telegrams() < telegrams and world.clock.now_us < whole_ms * 1000:
        world.press(("UP", "UP", "DOWN", "UP", "DOWN", "DOWN")[world.random(0, 5)], 60)
    found = first.figures()
    found["limit"] = rate_limit(baud)
    inside = result(world, whole_ms + begins_ms, b'{"collections_us"')
    found["steps_us"] = steps_of(inside["steps"][0])
    found["collections_us"] = spread(inside["collections_us"])
    found["tasks"] = inside["tasks"]
    return checked(world, found)


class Line:
    """What is measured on the line from now on."""

    def __init__(self, world):
        figures = world.figures
        self._world = world
        self._first = [len(figures.lead_ns), len(figures.release_ns), len(figures.idle_ns)]
        self._began_us = world.clock.now_us

    def telegrams(self):
        return len(self._world.figures.release_ns) - self._first[1]

    def figures(self):
        figures = self._world.figures
        passed_us = self._world.clock.now_us - self._began_us
        one_ns = character_ns(self._world.wire.baud)
        idle_ns = [idle - 2 * one_ns for idle in figures.idle_ns[self._first[2] :]]
        return {
            "baud": self._world.wire.baud,
            "rate": round(len(idle_ns) * 1e6 / passed_us, 1),
            "lead_ns": spread(figures.lead_ns[self._first[0] :]),
            "release_ns": spread(figures.release_ns[self._first[1] :]),
            "idle_ns": spread(idle_ns),
            "character_ns": one_ns,
        }


def rate_limit(baud, net_count=TELEGRAM_CHARACTERS - 4):
    """Exchanges a second that the wire allows: silence, two telegrams, the drive's own time."""
    characters = 2 + 2 * (net_count + 4) + REPLY_CHARACTERS
    return baud // (characters * CHARACTER_BITS)


def mixed(quick, baud):
    """31 drives of all families and layouts, with the master alone, without a task."""
    from boards.sim.drives.fleet import kinds
    from uss.layout import Layout

    baud = int(baud)
    ms = 3_000 if quick else 10_000
    world = world_of(kinds(31, 0, first=1), baud)
    at_the_prompt(world, MASTER_ON_CHIP)
    layouts = [(address,) + drive.layout for address, drive in sorted(world.drives.items())]
    world.repl.begin("mixed(%d, %r, %d)" % (baud, layouts, ms + SETTLE_MS + 1_000))
    world.run(SETTLE_MS)
    first = Line(world)
    world.run(ms)
    found = first.figures()
    nets = [Layout(pkw_words, pzd_words).net_count for _, pkw_words, pzd_words in layouts]
    found["limit"] = rate_limit(baud, sum(nets) / len(nets))
    found.update(result(world, ms))
    return checked(world, found)


def saving(quick):
    """The driver enable while the settings are written."""
    times = 5 if quick else 20
    world = world_at(19200)
    at_the_prompt(world)
    world.repl.begin("saving(%d, %d, %d)" % (SETTLE_MS, times, SAVE_MS))
    found = result(world, 12_000 + times * SAVE_MS)
    figures = world.figures
    found.update({
        "flash": len(world.flash_log),
        "lead_ns": spread(figures.lead_ns),
        "release_ns": spread(figures.release_ns),
        "character_ns": character_ns(19200),
    })  # fmt: skip
    return checked(world, found)


def cuts(quick):
    """Power is cut within and after every flash operation of a save: are the settings the old ones
    or the new ones?

    The same records give the same run, to the microsecond, so one run tells when to cut the
    others.
    """
    world = saving_again()
    result(world, 10_000)
    instants = []
    for at_us, _, duration_us in last_save(world.flash_log):
        for percent in (60,) if quick else (10, 60, 105):
            instants.append(at_us + duration_us * percent // 100)
    instants.append(instants[-1] + 1_000)
    found = {"old": 0, "new": 0, "neither": 0, "complaints": [], "restarts": []}
    for at_us in instants:
        world = saving_again()
        world.cut_power(at_us)
        if not world.run_until(lambda: bool(world.restarts), 10_000):
            raise RuntimeError("power was not cut at %d us" % at_us)
        world.run(1_500)
        found[whose(world, OLD_SETPOINT + 10 * (SAVES - 1))] += 1
        found["complaints"] = (found["complaints"] + world.complaints())[:5]
    return found


def saving_again():
    world = world_at(19200, settings={"setpoint_centihertz": OLD_SETPOINT})
    at_the_prompt(world)
    world.repl.begin("saving(%d, %d, %d)" % (READY_MS, SAVES, SAVE_MS))
    return world


def last_save(flash_log):
    """The flash operations of the last of several saves."""
    ends_us = flash_log[-1][0]
    return [operation for operation in flash_log if ends_us - operation[0] < SAVE_MS * 500]


def whose(world, old):
    """Which settings the panel has after it restarted, by what it shows and what it keeps."""
    for name, setpoint in (("old", old), ("new", old + 10)):
        kept = world.settings().get("setpoint_centihertz") == setpoint
        if kept and world.reads("S:%5.1f" % (setpoint / 100)) and world.reads("READY"):
            return name
    return "neither"


def memory(quick, drives):
    """Heap taken by exchanges."""
    drives = int(drives)
    exchanges = 500 if quick else 10_000
    settled_ms = 20_000 + 1_700 * drives  # by then each drive has told all
    world = world_at(115200, drives)
    at_the_prompt(world)
    world.repl.begin("memory(%d, %d)" % (exchanges, settled_ms))
    start_the_motor(world)
    return checked(world, result(world, settled_ms + 20_000 + exchanges * 10))


def stop(quick, baud, drives):
    """START, from the contact to the end of the telegram that carries ON, and STOP to OFF1."""
    baud, drives = int(baud), int(drives)
    presses = 5 if quick else 50 if drives == 1 else 20
    world = world_at(baud, drives, seed=5)
    at_the_prompt(world)
    world.repl.begin("collecting(%d, %d)" % (presses * 20_000, COLLECT_MS))
    took_us, starts_us, lost_starts = [], [], 0
    settle(world)
    for _ in range(presses):
        lost_starts += start_the_motor_again(world, starts_us)
        world.run(world.random(1, 150))
        since_us = world.clock.now_us
        world.down("STOP")
        world.run(world.random(150, 250))
        world.up("STOP")
        took_us.append(off_after_us(world, since_us, ON))
        world.run_until(lambda: world.drives[1].hz() == 0, 3_000)
        world.run(300)
    exchange_us = 1_000_000 // rate_limit(baud)
    found = {"baud": baud, "took_us": sorted(took_us), "exchange_us": exchange_us}
    found["starts_us"] = sorted(starts_us)
    found["lost_starts"] = lost_starts
    return checked(world, found)


def start_the_motor_again(world, starts_us):
    """How many times START had no effect before it had; `starts_us` gets how long that took."""
    drive = world.drives[1]
    for lost in range(5):
        since_us = world.clock.now_us
        world.down("START")
        is_on = world.run_until(lambda: drive.stw & ON, START_MS)
        if is_on:
            starts_us.append(world.clock.now_us - since_us)
        world.run(100)
        world.up("START")
        if is_on and world.run_until(lambda: drive.hz() > STOP_HZ, 2_000):
            return lost
    raise RuntimeError("the motor does not turn: %r" % (world.lcd(),))


def off_after_us(world, since_us, bits):
    """Microseconds until the end of the first telegram to drive 1 without these bits of STW."""
    telegram_us = TELEGRAM_CHARACTERS * CHARACTER_BITS * 1_000_000 // world.wire.baud
    for start_us, from_panel, telegram in world.wire.log.last(500):
        ours = from_panel and start_us >= since_us and len(telegram) == TELEGRAM_CHARACTERS
        if ours and telegram[2] == 1:
            if not (telegram[STW_AT] << 8 | telegram[STW_AT + 1]) & bits:
                return start_us + telegram_us - since_us
    raise RuntimeError("no OFF on the wire after %d us" % since_us)


def hang(quick, how, drive):
    """The main loop hangs during a jog: how long until OFF is on the wire."""
    world = world_at(19200)
    at_the_prompt(world)
    world.repl.begin("hang(%r, %d)" % (how, SETTLE_MS + 2_000))
    world.run(SETTLE_MS)
    world.down("JOG_RIGHT")
    found = {}
    while world.usb.find(b"HANGS") < 0:
        world.run(1)
    since_us = world.clock.now_us
    if world.drives[1].hz() <= STOP_HZ:
        raise RuntimeError("the motor does not turn: %r" % (world.lcd(),))
    if drive == "silent":
        world.drives[1].unplug()
    world.run(700)
    found["took_us"] = off_after_us(world, since_us, ON | JOGS)
    world.run(2_000)
    return checked(world, found)


def steps(quick, baud, drives):
    """A step of the main loop: the home page, a changing display, the parameter page."""
    drives = int(drives)
    phase_ms = (4_000 if quick else 10_000) + 100 * drives
    world = world_at(int(baud), drives)
    at_the_prompt(world)
    world.repl.begin("steps(%d, 3, %d)" % (phase_ms, COLLECT_MS))
    began_us = world.clock.now_us
    world.run(500)
    world.run(max(0, began_us + phase_ms * 1000 - world.clock.now_us) // 1000)
    start_the_motor(world)
    while world.clock.now_us < began_us + 2 * phase_ms * 1000:
        world.press("UP", 900)
        world.press("DOWN", 900)
    world.press("PARAM")
    while world.clock.now_us < began_us + 3 * phase_ms * 1000:
        world.press("NEXT", 300)
    inside = result(world, 5_000)
    names = ("home", "changing", "parameters")
    found = {name: steps_of(table) for name, table in zip(names, inside["steps"])}
    found["collections_us"] = spread(inside["collections_us"])
    return checked(world, found)


# What a person does at the menu: opens it, walks it, opens each of its lists, and in each list the
# entries. MENU is a PARAM that is held, BACK one that is pressed until the home page is there.
MENU, BACK = "menu", "back"
HOME = "S:"  # row 1 of the home page begins with it
HOLD_MS, READ_MS, OPENS_MS = 1_300, 300, 700
SCENE_MS = 15_000
ENTRIES = 13
FIND = 2  # the entry in whose list SET would begin a search, which is another program
OPENS = 2 * (MENU, BACK)
WALKS = (MENU,) + ENTRIES * ("DOWN",) + (BACK,)
LISTS = tuple(
    (MENU,)
    + entry * ("DOWN",)
    + ("SET", "DOWN", "DOWN")
    + (() if entry == FIND else ("SET", "UP"))
    + (BACK,)
    for entry in range(ENTRIES)
)


def menu(quick, how, drives):
    """A step of the main loop while a person opens the menu, walks it, and opens each list.

    how: as in `heap`.
    """
    scenes = (OPENS, WALKS) + LISTS
    settled_ms = SETTLE_MS + LEARN_MS_A_DRIVE * int(drives)
    world = world_at(19200, int(drives), **firmware_as(how))
    at_the_prompt(world)
    begun_ms = world.clock.now_us // 1000
    call = (SCENE_MS, len(scenes), COLLECT_MS, False, settled_ms, len(scenes) - len(LISTS) + 1)
    world.repl.begin("steps(%d, %d, %d, %r, %d, %d)" % call)
    settle(world)
    for place, keys in enumerate(scenes):
        # The chip is some way behind with its start, and more so as files.
        begins_ms = begun_ms + settled_ms + place * SCENE_MS + BEGINS_MS[how]
        world.run(max(0, begins_ms - world.clock.now_us // 1000))
        for key in keys:
            do_at_the_menu(world, key)
        if world.clock.now_us // 1000 > begins_ms + SCENE_MS - BEGINS_MS[how]:
            raise RuntimeError("%r takes more than %d ms" % (keys, SCENE_MS))
    opening, walking, lists = result(world, 2 * SCENE_MS)["steps"]
    found = {"opening": opening, "walking": walking, "lists": lists}
    return checked(world, {name: steps_of(table) for name, table in found.items()})


def do_at_the_menu(world, key):
    if key == BACK:
        while not world.lcd()[0].startswith(HOME):
            do_at_the_menu(world, "PARAM")
        return
    world.press("PARAM" if key == MENU else key, HOLD_MS if key == MENU else TAP_MS)
    world.run(READ_MS)
    if key == MENU and not world.run_until(lambda: not world.reads(HOME), OPENS_MS):
        raise RuntimeError("the menu does not open: %r" % (world.lcd(),))


# What a person does with parameters: opens the list of groups, goes to the first one of a group,
# walks, changes a value, and looks at faults. The entry in the main menu is reached from its end.
PARAMETERS_UP, MEMORY_UP = 5 * ("UP",), 3 * ("UP",)
GROUP_SCENES = (
    (MENU,) + PARAMETERS_UP + ("SET", "DOWN", "DOWN", "DOWN", BACK),
    (MENU,) + MEMORY_UP + ("SET", "DOWN", "DOWN", BACK),
    (MENU, "SET", "DOWN", "DOWN", "DOWN", BACK),  # what the warning means
)
GROUP_KEYS = (
    ("NEXT", "NEXT", "PREVIOUS", "UP", "DOWN"),
    ("EDIT", "UP", "NEXT", "DOWN", "EDIT", "EDIT", "EDIT"),
    ("EDIT", "UP", "SET"),
)
GROUPS = {True: 4, False: 23}  # of an MM440, as quick or not
WARNING = 501


def lookup(quick, how, drives):
    """A step of the main loop while a person looks up parameters and faults, and how long it takes
    from SET on a group until its first parameter is on the display.
    """
    from boards.sim.drives.families import named

    drives = int(drives)
    groups = GROUPS[quick]
    scenes = len(GROUP_SCENES) + groups
    settled_ms = SETTLE_MS + LEARN_MS_A_DRIVE * drives
    settings = {"kinds": {str(address): "mm440" for address in range(1, drives + 1)}}
    kind = {"family": named("mm440"), "parameters": {2014: 2_000}}
    kinds = {address: dict(kind) for address in range(1, drives + 1)}
    world = world_of(kinds, 19200, settings=settings, **firmware_as(how))
    at_the_prompt(world)
    call = (LOOKUP_MS, scenes, COLLECT_MS, False, settled_ms)
    begun_ms = world.clock.now_us // 1000
    world.repl.begin("steps(%d, %d, %d, %r, %d)" % call)
    settle(world)
    world.drives[1].warn(WARNING)
    firsts_us = []
    for place in range(scenes):
        begins_ms = begun_ms + settled_ms + place * LOOKUP_MS + BEGINS_MS[how]
        world.run(max(0, begins_ms - world.clock.now_us // 1000))
        if place < len(GROUP_SCENES):
            keys = GROUP_SCENES[place]
        else:
            entry = place - len(GROUP_SCENES)
            for key in (MENU,) + PARAMETERS_UP + ("SET",):
                do_at_the_menu(world, key)
            world.run(LISTED_MS)  # the groups are listed
            for _ in range(1 if entry else 3):
                do_at_the_menu(world, "DOWN")  # it begins where it was left
            firsts_us.append(first_row_us(world))
            keys = GROUP_KEYS[entry % len(GROUP_KEYS)] + (BACK,)
        for key in keys:
            do_at_the_menu(world, key)
        if world.clock.now_us // 1000 > begins_ms + LOOKUP_MS - BEGINS_MS[how]:
            raise RuntimeError("%r takes more than %d ms" % (keys, LOOKUP_MS))
    lists, memory, what, *pages = result(world, 2 * LOOKUP_MS)["steps"]
    found = {"lists": sorted(lists + memory + what), "pages": sorted(sum(pages, []))}
    found = {name: steps_of(table) for name, table in found.items()}
    found["firsts_us"] = spread(firsts_us)
    return checked(world, found)


LOOKUP_MS, LISTED_MS, FIRST_ROW_MS = 12_000, 1_500, 3_000


def first_row_us(world):
    """SET is pressed on a group: until row 2 is `P1120[0]      ?`, with or without its value."""
    since_us = world.clock.now_us
    world.down("SET")
    if not world.run_until(lambda: is_parameter(world.lcd()[1]), FIRST_ROW_MS):
        raise RuntimeError("no parameter comes: %r" % (world.lcd(),))
    took_us = world.clock.now_us - since_us
    world.run(TAP_MS)
    world.up("SET")
    world.run(READ_MS)
    return took_us


def is_parameter(row):
    return row[:1] in ("P", "r") and row[1:5].isdigit() and row[5:6] in (" ", "[")


def boot(quick, display):
    """From power-on to the first telegram, and to the home page."""
    world = world_at(19200, display=display)
    found = {}
    while not world.wire.log.count and world.clock.now_us < 5_000_000:
        world.run(1)
    found["telegram_us"] = world.wire.log.last(1)[0][0]
    while not world.reads("READY") and world.clock.now_us < 10_000_000:
        world.run(1)
    found["home_us"] = world.clock.now_us
    return checked(world, found)


def heap(quick, how, drives):
    """Heap of the panel as it runs and knows so many drives, taken and free: a timer tells it.

    how: "frozen", or "files", compiled by __main__.py, on a MicroPython without the panel.
    """
    world = world_at(19200, int(drives), **firmware_as(how, {"boot.py": TELLS_FREE}))
    settle(world)
    world.run(LEARN_MS_A_DRIVE * int(drives))
    told = world.usb.count(b" bytes free")
    if not world.run_until(lambda: world.usb.count(b" bytes free") > told, 2 * TELLS_FREE_MS):
        raise RuntimeError("the chip tells no free heap: %r" % bytes(world.usb[-500:]))
    *_, taken, _, free = bytes(world.usb).rpartition(b" bytes free")[0].split()
    return checked(world, {"taken": int(taken), "free": int(free)})


def firmware_as(how, files=()):
    """Which program a chip has, "frozen" or as "files", and which other files beside it."""
    files = dict(files)
    if how == "files":
        from tools.emulator.flash_image import files_in

        files.update(files_in(DEPLOYED))
    return {"program": "panel" if how == "frozen" else "stock", "files": files}


def picture(quick, baud, drives):
    """How old the frequency on the display is: from the end of the first reply with another one
    until the display changes, while the motor follows a setpoint that goes up and down.
    """
    from uss.pzd import Scaling

    ms = 5_000 if quick else 30_000
    drives = int(drives)
    world = world_at(int(baud), drives)
    scaling = Scaling(REFERENCE_CENTIHERTZ, False)
    at_the_prompt(world)
    world.repl.begin("collecting(%d, %d)" % (ms + 30_000 + 1_000 * drives, COLLECT_MS))
    start_the_motor(world)
    until_us = world.clock.now_us + ms * 1000
    log, seen = world.wire.log, world.wire.log.count
    told = []  # (when, what the display is to show), from what it shows on
    ages_us = []
    while world.clock.now_us < until_us:
        key = ("UP", "DOWN")[len(ages_us) // CHANGES % 2]
        world.down(key)
        for _ in range(KEY_MS):
            world.run(1)
            for start_us, from_panel, telegram in log.last(log.count - seen):
                if not from_panel and telegram[2] == 1:
                    hiw = telegram[STW_AT + 2] << 8 | telegram[STW_AT + 3]
                    characters_us = len(telegram) * CHARACTER_BITS * 1_000_000 // int(baud)
                    text = "%.2f" % (scaling.centihertz(hiw) / 100)
                    told.append((start_us + characters_us, text))
            seen = log.count
            age_us = take_shown(told, world.lcd()[0][ACTUAL_AT:].strip(), world.clock.now_us)
            if age_us is not None:
                ages_us.append(age_us)
        world.up(key)
    return checked(world, {"ages_us": spread(ages_us)})


def take_shown(told, shown, now_us):
    """Drop what is older than what is shown. How long the display had been out of date, when it
    shows something else than before.
    """
    places = [place for place, (_, text) in enumerate(told) if text == shown]
    if not places:
        return None
    changed = [at_us for at_us, text in told if text != told[0][1]]
    is_new = told[0][1] != shown
    del told[: places[-1]]
    return now_us - changed[0] if is_new else None


# --- on the host, by the processor's time: others may be using it as well ------------------------


def codec(quick):
    """Characters a second through the receiver, and through the builder of telegrams."""
    from uss import telegram

    rounds = 200_000 if quick else 2_000_000
    buffer = bytearray(TELEGRAM_CHARACTERS)
    net = TELEGRAM_CHARACTERS - 4

    def build():
        telegram.seal(buffer, 1, net)

    receiver, link, drive, request_at = awaiting(buffer)

    def receive():
        receiver.open(drive, request_at)
        if receiver.take(link, request_at) != telegram.GOOD:
            raise RuntimeError("the receiver takes no telegram")

    build()
    return {
        "builder": TELEGRAM_CHARACTERS * rate_of(build, rounds),
        "receiver": TELEGRAM_CHARACTERS * rate_of(receive, rounds),
    }


class Reply:
    """A link that has one whole telegram, each time it is asked."""

    resolution_us = 0
    interrupts = True
    received_at = 20_000

    def __init__(self, characters):
        self._characters = characters

    def receive(self, buffer, at):
        count = len(self._characters)
        buffer[at : at + count] = self._characters
        return count


def awaiting(characters):
    from uss import telegram
    from uss.drive import Drive
    from uss.receiver import Receiver
    from uss.timing import Timing

    mask = 0x3FFFFFFF
    drive = Drive(1, mask)
    drive.fill(0)  # its request, which a reply is held against
    telegram.seal(drive.request, 1, drive.size - 4)
    return Receiver(Timing(19200), mask), Reply(characters), drive, 1_000


def rate_of(function, rounds):
    began = time.clock()
    for _ in range(rounds):
        function()
    return round(rounds / (time.clock() - began))


def simulation(quick):
    """Simulated seconds a second: the whole panel, LCD model, one drive at 19200, running."""
    import main
    from boards.sim.world import World

    seconds = 20 if quick else 200
    world = World(main.start)
    world.run(2_000)
    world.press("START")
    world.run(2_000)
    if world.drives[1].hz() <= STOP_HZ:
        raise RuntimeError("the motor does not turn: %r" % (world.lcd(),))
    began = time.clock()
    world.run(seconds * 1000)
    times = round(seconds / (time.clock() - began))
    return {"times": times, "complaints": world.complaints()[:5]}


MEASUREMENTS = {
    function.__name__: function
    for function in (
        line,
        short,
        asking,
        logging,
        mixed,
        saving,
        cuts,
        memory,
        stop,
        hang,
        steps,
        menu,
        lookup,
        picture,
        boot,
        heap,
        codec,
        simulation,
    )
}


def main_program(quick, name, *arguments):
    gc.threshold(COLLECT_AFTER)
    print(json.dumps(MEASUREMENTS[name](quick == "quick", *arguments)))


if __name__ == "__main__":
    main_program(*sys.argv[1:])
