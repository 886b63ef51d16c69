# SPDX-License-Identifier: MIT
"""The parameter behind or before another one, in a group of the catalogue, round and round."""

import catalogue
from catalogue.beside import following, preceding

INTERPRETERS = "unix64 unix32 cpython"


def last_of(rows):
    """The number of the row that a search ends with; None: there is none."""
    found = [catalogue.number(row) for row in rows if row]
    assert len(found) < 2
    return found[0] if found else None


def test_both_directions_walk_each_group_round():
    for family, groups in (("mm420", (1, 2, 14, 19)), ("mm440", (14, 22)), ("mm3", (1, 4))):
        for group in catalogue.groups(family):
            if catalogue.number(group) not in groups:
                continue
            numbers = group[catalogue.NUMBERS]
            members = [catalogue.number(row) for row in catalogue.rows(family, numbers)]
            assert len(members) > 1, (family, group)
            for number, behind in zip(members, members[1:] + members[:1]):
                assert last_of(following(family, numbers, number)) == behind, (family, number)
                assert last_of(preceding(family, numbers, behind)) == number, (family, number)


def test_a_group_begins_with_its_first_number():
    assert last_of(following("mm440", b"300-311 335", -1)) == 300
    assert last_of(following("mm420", b"918 2040-2091", -1)) == 918


def test_from_a_number_that_the_catalogue_does_not_know():
    assert last_of(following("mm440", catalogue.ALL, 1119)) == 1120
    members = [catalogue.number(row) for row in catalogue.rows("mm440")]
    assert last_of(preceding("mm440", catalogue.ALL, 9999)) == members[-1]
    assert last_of(following("mm440", catalogue.ALL, 9999)) == members[0]


def test_a_group_of_nothing_has_nothing():
    assert last_of(following("mm440", b"9000-9999", 5)) is None
    assert last_of(preceding("mm440", b"9000-9999", 9500)) is None
