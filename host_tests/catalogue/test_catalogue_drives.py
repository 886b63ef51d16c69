# SPDX-License-Identifier: MIT
"""The catalogue and the other tables of drives agree: the simulated drives, which were written
independently of it, and the families of the library.
"""

import struct

import catalogue
from boards.sim.drives.families import named as simulated
from boards.sim.drives.parameters import CHANGE, INDICES, MAXIMUM, MINIMUM, NUMBER, TYPE
from catalogue_bench import named
from uss import families
from uss.families import rows
from uss.families.generic import CUTS_OFF

INTERPRETERS = "host"

SIMULATED = ("mm440", "mm420", "g110", "v20", "g120", "mm3")

# Of the catalogue's types, what a simulated drive calls them.
TYPES = {"Float": "F", "BICO": "U32"}

# Where the two hold different things: numbers, and why. All of it is general knowledge.
DIFFER = {
    "mm440": {313: "an array in the lists", 330: "an array in the lists"},
    "v20": {313: "an array in the lists", 330: "an array in the lists"},
    "g120": {
        3: "a signed word in the list manual",
        10: "a signed word in the list manual",
        15: "a double word in the list manual, of which the simulated drive knows few macros",
    },
}
# A V20 goes up to 599 Hz, with later firmware to 550; the simulated one, as an MM440, to 650.
V20_HIGHEST_HZ = (599, 650)


def single(value):
    return struct.unpack(">f", struct.pack(">f", value))[0]


def pairs(family):
    """Each row of the simulated drive, with the catalogue's."""
    for row in simulated(family).ROWS:
        cells = catalogue.find(family, row[NUMBER])
        assert cells, "%s: the catalogue has no %d" % (family, row[NUMBER])
        if row[NUMBER] not in DIFFER.get(family, ()):
            yield "%s %d" % (family, row[NUMBER]), row, named(cells)


def test_the_types_agree():
    for family in SIMULATED:
        for place, row, told in pairs(family):
            assert TYPES.get(told.type, told.type) == row[TYPE], place


def test_the_indices_agree():
    for family in SIMULATED:
        for place, row, told in pairs(family):
            assert int(told.indices.split()[0]) == row[INDICES], (place, told.indices)


def test_the_limits_agree():
    for family in SIMULATED:
        for place, row, told in pairs(family):
            if not row[CHANGE]:
                assert told.key[0] == "r", place
                continue
            limits = [catalogue.value(cell.encode()) for cell in (told.lowest, told.highest)]
            if row[TYPE] == "F":
                limits = [single(limit) for limit in limits]
            expected = [row[MINIMUM], row[MAXIMUM]]
            if family == "v20" and told.unit == "Hz" and row[MAXIMUM] == V20_HIGHEST_HZ[1]:
                expected = [max(row[MINIMUM], -V20_HIGHEST_HZ[0]), V20_HIGHEST_HZ[0]]
            assert limits == expected, (place, limits)


def test_the_states_of_a_change_agree():
    for family in SIMULATED:
        for place, row, told in pairs(family):
            assert told.states == row[CHANGE], place


def test_what_asks_first_agrees_with_the_families():
    for family in catalogue.FAMILIES:
        ask_first = getattr(families, family.upper()).ask_first
        told = {}
        for cells in catalogue.rows(family):
            row = named(cells)
            if row.asks:
                told[row.number()] = CUTS_OFF if row.asks == "C" else 1 - CUTS_OFF
        known = {catalogue.number(cells) for cells in catalogue.rows(family)}
        assert told == {number: why for number, why in ask_first.items() if number in known}


def test_which_double_words_are_integers_agrees_with_the_families():
    """What a family takes for a floating-point number is read as one by the library."""
    for family in catalogue.FAMILIES:
        data = getattr(families, family.upper())
        for row in catalogue.rows(family):
            told = named(row)
            if told.type in ("U32", "I32", "BICO", "Float"):
                number = catalogue.number(row)
                is_float = families.is_float(data, number)
                assert is_float == (told.type == "Float"), (family, number)


def test_every_parameter_of_the_bus_is_in_the_catalogue():
    for family in catalogue.FAMILIES:
        data = getattr(families, family.upper())
        wanted = [row[0] for row in data.survey if row and row[3] is None]
        wanted += [data.baud_number, data.address_number, data.pzd_words_number]
        wanted += [data.pkw_words_number, data.off_time_number, data.fault_number]
        wanted += [number for number, _ in data.shown]
        wanted += [one[0] for one in (data.access, data.protocol, data.save) if one]
        wanted += list(data.motor or ()) + list(data.permanent)
        for number in wanted:
            if number is not None:
                assert catalogue.find(family, number), (family, number)


def test_a_frequency_that_the_panel_reads_is_one_here_too():
    kinds = {
        rows.WORD: ("U16",), rows.CENTIHERTZ: ("Float",), rows.RPM: ("Float",),
        rows.STEPS: ("U16",), rows.SOURCE: ("BICO", "U32"), rows.COUNT: ("U16",),
    }  # fmt: skip
    for family in catalogue.FAMILIES:
        for row in getattr(families, family.upper()).survey:
            cells = row and catalogue.find(family, row[0])
            if cells:
                assert cells[catalogue.TYPE].decode() in kinds[row[2]], (family, row)


def test_the_codes_of_the_baud_rates_agree():
    for family in catalogue.FAMILIES:
        data = getattr(families, family.upper())
        told = catalogue.find(family, data.baud_number)
        assert told, family
        texts = catalogue.choices(family, told[catalogue.FORM])
        codes = {catalogue.number(row, 1): int(row[catalogue.NAME].split()[0]) for row in texts}
        limits = [catalogue.value(told[column]) for column in (7, 8)]
        offered = {code: baud for code, baud in codes.items() if limits[0] <= code <= limits[1]}
        for code, baud in data.baud_codes.items():
            assert offered[code] == baud, (family, code)


def test_the_fault_of_a_lost_bus_is_explained():
    for family in catalogue.FAMILIES:
        number = getattr(families, family.upper()).off_time_fault
        assert catalogue.fault(family, number), (family, number)


def test_every_fault_of_a_simulated_drive_is_explained():
    for family in SIMULATED:
        style = simulated(family).STYLE
        for number in list(style["faults"].values()) + [simulated(family).LINK["fault"]]:
            assert catalogue.fault(family, number), (family, number)
        for _, number in style["warnings"]:
            assert catalogue.warning(family, number), (family, number)
