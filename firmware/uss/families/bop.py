# SPDX-License-Identifier: MIT
"""USS on the BOP link of a MICROMASTER 4: RS-232, the plug of its keypad.

The manuals give the link two indices: 0 is the COM link, the RS-485 terminals, and 1 is this one
(USS.md 1.3, 4.2). So a family on it is the same family with other numbers; what is here is all
that differs. P0700 = P1000 = 4 choose it.

    bus.add(3, on_bop(MM440))
    on_bop(MM440).link_index        # 1
    on_bop(MM440).__name__          # "MM440-BOP"
"""

from uss.families.rows import source

SUFFIX = "-BOP"

_INDEX = 1
_LINKED = (2009, 2010, 2011, 2012, 2013, 2014, 2024, 2025)  # their index is that of the link
_FAULT = 71  # (?) as 72

# What stands on this link for what on the COM link: parameters, and values of parameters.
_NUMBERS = {2019: 2016}  # what is sent
_VALUES = {  # P0700 and the like; control word 1, PZD2
    5: 4,
    source(2036, 0): source(2032, 0),
    source(2018, 1): source(2015, 1),
}

_made = {}  # family -> the same on this link: drives share it


def on_bop(family):
    """The family with its USS on the BOP link. ValueError if it has none."""
    if not family.has_bop_link:
        raise ValueError("a %s has no BOP link" % family.name)
    if family not in _made:
        _made[family] = type(family.__name__ + SUFFIX, (family,), _differences(family))
    return _made[family]


def _differences(family):
    return {
        "name": family.name + " (BOP link)",
        "com": family,
        "link_index": _INDEX,
        "linked": _LINKED,
        "off_time_fault": _FAULT,
        "survey": tuple([row and _row(*row) for row in family.survey]),
        "meaning": tuple([_rule(*rule) for rule in family.meaning]),
    }


def _row(number, index, kind, missing):
    index = _INDEX if number in _LINKED else index
    return _NUMBERS.get(number, number), index, kind, _VALUES.get(missing, missing)


def _rule(subject, row, place, values, digit):
    return subject, row, place, tuple([_VALUES.get(value, value) for value in values]), digit
