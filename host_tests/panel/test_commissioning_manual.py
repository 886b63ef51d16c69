# SPDX-License-Identifier: MIT
"""boards/COMMISSIONING.md: its tables are those of the catalogue, and a simulated drive as
delivered, which gets their values one by one, shows what they say and turns its motor.
"""

import catalogue
from boards.sim.drives.families import named as simulated_family
from boards.sim.drives.families import v20
from panel.supervision import off_time_ms
from panel_bench import settled, starts, switched_on, wait_until_known
from uss import families

INTERPRETERS = "unix64"

MANUAL = "boards/COMMISSIONING.md"
USS = 1  # of the catalogue's procedures
BAUD, ADDRESS, OFF_TIME_MS = 19200, 1, 2000

# Heading, families of the table, those of them that are simulated.
TABLES = (
    (
        "MICROMASTER 410, 420, 430, 440",
        ("mm410", "mm420", "mm430", "mm440"),
        ("mm420", "mm440"),
    ),
    ("SINAMICS G110", ("g110",), ("g110",)),
    ("SINAMICS V20", ("v20",), ("v20",)),
    ("SINAMICS G120", ("g120",), ("g120",)),
    ("MICROMASTER 3", ("mm3",), ("mm3",)),
)
LEFT = "leave it"
MAINS = "mains off and on"
BESIDE = {"A1 MAY RUN"}  # in turn with NO CONTACT, until the drive was heard for the first time


def rows_of(heading):
    """The cells of the first table under a heading, without its head."""
    with open(MANUAL, encoding="utf-8") as manual:
        text = manual.read().split("\n### %s\n" % heading)[1].split("\n#")[0]
    lines = [line for line in text.split("\n") if line.startswith("|")]
    return [[cell.strip() for cell in line.split("|")[1:-1]] for line in lines[2:]]


def number(label):
    return int(label.split("[")[0][1:])


def label(family, parameter, listed):
    """As the manual has it: with an index where all drives of the table have several."""
    form = {"mm3": "P%03d", "g120": "p%04d"}.get(family, "P%04d")
    counts = [catalogue.indices(catalogue.find(one, parameter)) for one in listed]
    return form % parameter + ("[0]" if min(counts) > 1 else "")


def needed(family, step, text):
    """Whether a value of the manual is that of the catalogue's step."""
    value = step[catalogue.STEP_VALUE].decode()
    data = getattr(families, family.upper())
    if value == "?":
        told = catalogue.find(family, catalogue.value(step[catalogue.STEP_NUMBER]))
        return text.startswith(told[catalogue.DEFAULT].decode() + ", or your motor's ")
    if value == "@off":
        return int(text) * data.off_time_unit_ms == OFF_TIME_MS
    wanted = {
        "@baud": families.baud_code(data, BAUD),
        "@address": ADDRESS,
        "@pkw": data.layout.pkw_words,
    }
    return int(text) == wanted[value] if value in wanted else text == value


def test_every_step_of_the_catalogue_stands_in_the_table_of_its_family_and_nothing_else():
    for heading, listed, _ in TABLES:
        rows = [row for row in rows_of(heading) if row[1] != MAINS and row[3] != LEFT]
        for family in listed:
            steps = list(catalogue.steps(family, USS))
            assert len(steps) == len(rows), (family, len(steps), len(rows))
            for step in steps:
                parameter, name = catalogue.value(step[catalogue.STEP_NUMBER]), step[1].decode()
                found = [row for row in rows if (number(row[0]), row[1]) == (parameter, name)]
                assert len(found) == 1, (family, parameter, name)
                assert found[0][0] == label(family, parameter, listed), (family, found)
                assert needed(family, step, found[0][3]), (family, found)


def test_what_a_drive_has_as_delivered_is_what_the_catalogue_says():
    for heading, listed, _ in TABLES:
        for row in rows_of(heading):
            if row[1] == MAINS:
                continue
            place = int(row[0].split("[")[1][:-1]) if "[" in row[0] else 0
            is_sure = True
            for family in listed:
                told = catalogue.find(family, number(row[0]))
                default = told[catalogue.DEFAULT].decode().split(",")
                found = default[place if len(default) > 1 else 0]
                assert row[2].replace(" (?)", "") == found, (family, row)
                is_sure = is_sure and b"d" not in told[catalogue.UNSURE]
            assert is_sure == ("(?)" not in row[2]), row


def test_what_is_left_as_it_is_suits_the_panel():
    for heading, listed, _ in TABLES:
        for row in [row for row in rows_of(heading) if row[3] == LEFT]:
            connector = catalogue.value(row[2].encode())
            for family in listed:
                data = getattr(families, family.upper())
                assert catalogue.find(family, number(row[0]))[catalogue.NAME].decode() == row[1]
                place = int(row[0].split("[")[1][:-1])
                rows = [one for one in data.survey if one and one[:2] == (number(row[0]), place)]
                if rows:  # (a G110 is asked for the first word alone)
                    values = [rule[3] for rule in data.meaning if data.survey[rule[1]] in rows]
                    assert values and all([connector in right for right in values]), row


def test_the_codes_of_the_rates():
    told = {}
    for baud, code, names in rows_of("Codes of the rates"):
        for name in names.split(", "):
            told.setdefault(name, {})[int(code)] = int(baud)
    assert len(told) == 8
    for name, codes in told.items():
        assert codes == getattr(families, name).baud_codes, name


def as_delivered(family):
    """A panel that knows of one drive, at address 1, which nobody has set up."""
    stored = {"drives": [ADDRESS]}
    if family != "mm420":
        stored["kinds"] = {str(ADDRESS): family}
    kinds = {ADDRESS: {"family": simulated_family(family), "factory": True}}
    world = switched_on((ADDRESS,), BAUD, settings=stored, kinds=kinds)
    world.run(4000)
    return world


def mains_off_and_on(world):
    world.drives[1].power_off()
    world.run(30_000)
    world.drives[1].power_on()


def do(world, row):
    """What somebody does at the keys of the drive."""
    drive = world.drives[1]
    if row[1] == MAINS:
        mains_off_and_on(world)
    elif row[3] != LEFT:
        value = float(row[3].split(",")[0])
        kind = [one[2] for one in drive.family.ROWS if one[0] == number(row[0])][0]
        drive.write(number(row[0]), 0, value if kind == "F" else int(value))


def shown(world):
    """Row 2, as it takes turns, without the address; some seconds later."""
    world.run(6000)
    found = set()
    for _ in range(15):
        world.run(250)
        found.add(settled(world)[1].rstrip())
    return {row[:-2].rstrip() if row.endswith(" A1") else row for row in found}


def commission(family, heading):
    world = as_delivered(family)
    assert "NO CONTACT" in shown(world), world.lcd()
    for row in rows_of(heading):
        do(world, row)
        seen = shown(world)
        if row[4] == "NO CONTACT":
            seen -= BESIDE
        assert seen == {row[4]}, (family, row, seen)
    return world


def test_a_drive_as_delivered_that_gets_these_values_turns_its_motor():
    for heading, _, tried in TABLES:
        for family in tried:
            world = commission(family, heading)
            mains_off_and_on(world)
            world.run(15_000)
            wait_until_known(world)
            world.press("START")
            world.run(12_000)
            drive = world.drives[1]
            assert world.lcd()[1].startswith("RUNNING"), (family, world.lcd())
            assert starts(world) == 1 and abs(drive.hz()) > 4, (family, drive.report())
            drive.unplug()  # the wire breaks: P2014
            world.run(5000)
            assert drive.state == "fault", (family, drive.report())
            world.check()


def test_the_macro_of_a_v20_is_as_it_is_told():
    with open(MANUAL, encoding="utf-8") as manual:
        told = [line for line in manual if "macro Cn010" in line][0]
    for place, value in v20.COMMISSIONED.items():
        if place in (2013, 2014):
            assert "P%04d = %d" % (place, value) in told
    for number in (
        "P2010 = %d" % families.baud_code(families.V20, families.V20.baud),
        "P2011 = 1",
    ):
        assert number in told


def test_fifteen_drives_have_time_enough_at_2000_ms():
    for count, suits in ((15, True), (16, False)):
        world = switched_on(tuple(range(1, count + 1)), BAUD)
        longest_us = world.app.bus.turns.longest_cycle_us()
        assert (off_time_ms(longest_us) <= OFF_TIME_MS) == suits, (count, longest_us)
