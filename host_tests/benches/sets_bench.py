# SPDX-License-Identifier: MIT
"""What the tests of parameter sets share: hands that save and write them, files made elsewhere."""

import json
from binascii import crc32

import catalogue
from boards.sim.drives import parameters
from boards.sim.drives.families import mm3, mm440
from panel.sets import work
from panel_bench import panel, press, row_2, said, settled, starts, wait_until_known

BAUD = 57600  # for the tests' sake: a set takes a minute at 19200
ENDING = ".set"
ROWS = [(1080, 1, b"Float", b"40A00000"), (1120, 0, b"Float", b"40200000")]

TYPES = {b"U16": "U16", b"I16": "I16", b"Float": "F"}  # of the catalogue; the others are U32
LIMITS = {"U16": (0, 65535), "I16": (-32768, 32767), "F": (-1e9, 1e9), "U32": (0, 0xFFFFFFFF)}


def two(**options):
    """A panel with two MICROMASTER 440 that stand. kinds: what is different in one of them."""
    kinds = options.pop("kinds", {})
    for address in (1, 2):
        kinds.setdefault(address, {}).setdefault("family", mm440)
    settings = {"kinds": {"1": "mm440", "2": "mm440"}}
    settings.update(options.pop("settings", {}))
    world = panel(addresses=(1, 2), baud=BAUD, kinds=kinds, settings=settings, **options)
    wait_until_known(world)
    return world


def small():
    """A panel with a MICROMASTER 3, whose set is saved in a tenth of the time."""
    world = panel(kinds={1: {"family": mm3}}, settings={"kinds": {"1": "mm3"}})
    wait_until_known(world)
    return world


def walk_to(world, entry, key="DOWN"):
    """From entry to entry until one begins with this."""
    for _ in range(40):
        if settled(world)[1].startswith(">" + entry):
            return
        press(world, key)
    raise AssertionError("no %s: %r" % (entry, world.lcd()))


def sets(world):
    """From the home page to the list of sets."""
    world.press("PARAM", 1500)
    world.run(300)
    walk_to(world, "SETS")
    press(world, "SET")
    for _ in range(60):  # something else may be said in turn
        if world.lcd()[0].startswith("SETS"):
            return
        world.run(50)
    raise AssertionError(world.lcd())


def home(world):
    for _ in range(6):
        if not row_2(world).startswith(">"):
            return
        press(world, "PARAM")
    raise AssertionError(world.lcd())


def show(world, address):
    """Show this drive on the home page."""
    for _ in range(40):
        if world.selected() == address:
            break
        press(world, "ADDRESS_UP")


def wait(world, *ends, ms=200_000):
    """Let time pass until row 2 begins with one of these; answers row 2."""
    for _ in range(ms // 100):
        row = row_2(world)
        for end in ends:
            if row.lstrip(">").startswith(end):
                return settled(world)[1].rstrip()
        world.run(100)
    raise AssertionError("%r does not come: %r" % (ends, world.lcd()))


def save(world, address=1):
    """Save the parameters of a drive, under the name that is offered; answers the file."""
    before = files(world)
    show(world, address)
    sets(world)
    walk_to(world, "SAVE")
    press(world, "SET", "SET")
    wait(world, "SAVED")
    home(world)
    made = [name for name in files(world) if name not in before]
    assert len(made) == 1, made
    return made[0]


def open_set(world, entry, address=2):
    """From the home page to what can be done with a set; entry: as the list has it."""
    show(world, address)
    sets(world)
    walk_to(world, entry)
    press(world, "SET")


def begin(world, entry, what, address=2):
    """Compare or write: the drive with this address, and the set with this entry."""
    open_set(world, entry, address)
    walk_to(world, what)
    press(world, "SET")


def write(world, entry="A1 SET 1", address=2, where="RAM"):
    """Write a set to its end, with every question answered by SET; answers how it ended."""
    begin(world, entry, "INTO A%d %s" % (address, where), address)
    return finish(world)


def finish(world):
    """Answer what is asked; answers how it ended."""
    for _ in range(40):
        ends = ("SET=", "ALL EQUAL", "WRITTEN", "HALF", "DIFFER", "NO", "IS ", "STOP")
        row = wait(
            world, *ends + ("INCOMPLETE", "DAMAGED", "TOO BIG", "IT IS", "P0003 TOO", "A2: HALF")
        )
        if not row.startswith(">SET="):
            return row.lstrip(">")
        press(world, "SET")
    raise AssertionError(world.lcd())


def files(world):
    return sorted([name for name in world.flash.files if name.endswith(ENDING)])


def marks(world):
    """What the panel would find in its flash if it restarted now."""
    found = json.loads(world.flash.files["settings.json"]).get("half_written", {})
    return sorted([int(address) for address in found])


def refuses_to_move(world):
    """START and JOG of drive 2 say why not."""
    show(world, 2)
    world.run(2000)
    before = starts(world, 2)
    for key in ("START", "JOG_RIGHT", "JOG_LEFT"):
        world.down(key)
        world.run(400)
        assert "NO: HALF A SET" in said(world, 400), (key, world.lcd())
        world.up(key)
        world.run(200)
    world.run(3000)
    if world.drives[2].state != "fault":
        assert settled(world)[1] == "HALF A SET   A2 ", world.lcd()
    assert starts(world, 2) == before and world.drives[2].hz() == 0


def made(rows, family=b"mm440", address=1, name=b"MADE", ratings=()):
    """A file as a program on a PC would make it. rows: (number, index, type, value in hex)."""
    text = bytearray(b"USS SET 1\nfamily %s\naddress %d\nname %s\n" % (family, address, name))
    text += b"panel 0.0\n"
    for rating in ratings:
        text += b"rating %d %s\n" % rating
    count = 0
    for row in rows:
        text += b"P%04d %d %s %s\n" % row
        count += 1
    return bytes(text) + b"end %d %08X\n" % (count, crc32(text) & 0xFFFFFFFF)


def rows_of(file):
    """{(number, index): value in hex} of a file."""
    found = {}
    for line in file.decode().split("\n"):
        if line[:1] == "P":
            key, index, _, value = line.split()
            found[int(key[1:]), int(index)] = value
    return found


def catalogued():
    """{(number, index): type} of all that a set of an MM440 may have, as the catalogue tells."""
    found = {}
    for row in catalogue.rows("mm440"):
        number = catalogue.number(row)
        if row[catalogue.KEY][:1] == b"P" and number not in work.USUAL_NEVER:
            for index in range(catalogue.indices(row)):
                found[number, index] = TYPES.get(row[catalogue.TYPE], "U32")
    return found


def complete_mm440():
    """A family for the simulation: the MM440 with all parameters and indices of the catalogue."""

    class Complete:
        pass

    for name in dir(mm440):
        if name[:2] != "__":
            setattr(Complete, name, getattr(mm440, name))
    rows = {row[parameters.NUMBER]: list(row) for row in mm440.ROWS}
    for (number, index), kind in catalogued().items():
        low, high = LIMITS[kind]
        added = [number, "added", kind, "", 1, low, high, 0, "CUT", 1, ""]
        row = rows.setdefault(number, added)
        more = index + 1 - row[parameters.INDICES]
        if more > 0:
            row[parameters.INDICES] += more
            default = row[parameters.DEFAULT]
            if isinstance(default, tuple):
                row[parameters.DEFAULT] = default + default[-1:] * more
    Complete.ROWS = tuple([tuple(rows[number]) for number in sorted(rows)])
    return Complete


def make_each_value_another(drive):
    """What was added to the drive has values that are its own: none is mistaken for another."""
    usual = {row[parameters.NUMBER] for row in mm440.ROWS}
    for number, values in drive.parameters.ram.items():
        if number not in usual:
            for index in range(len(values)):
                drive.parameters.set(number, index, number + 7 * index)


def has(drive, row, value):
    """Whether a drive has the value of a row: ((number, index), value in hex)."""
    number, index = row
    kind = drive.parameters.rows[number][parameters.TYPE]
    words = parameters.words_of(kind, drive.parameters.get(number, index))
    return value == "".join(["%04X" % word for word in words])


def put(world, *rows, name="1.set", name_inside=b"MADE", **options):
    """A file that was copied onto the panel while it was off."""
    options["name"] = name_inside
    world.flash.files[name] = made(sorted(rows or ROWS), **options)
