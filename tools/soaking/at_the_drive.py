# SPDX-License-Identifier: MIT
"""What a person sets at the keypad of a drive during a soak, by the family of the drive.

people = people_at(drive)
for number, value in people.order: ...
"""

from tools.soaking.judging.families import (
    ACTUAL_HZ,
    G110,
    G120,
    GENERIC,
    LINKED,
    MM3,
    MM420,
    MM440,
    USS,
    USS_ON_BOP,
    V20,
)


class People:
    """order: what puts the drive in order. meddled: what they change. doubts: what START and JOG
    must refuse, or ask about; without a number: a fault; more: such in worlds of all families.
    Each (number, or number and index, value).

    off_time: the number of the telegram off time.
    """

    def __init__(self, off_time, order, meddled, doubts, more=()):
        self.off_time = off_time
        self.order = order
        self.meddled = meddled
        self.doubts = doubts
        self.more = more


MM4 = People(
    2014,
    (
        (700, 5), (1000, 5), (1080, 0.0), (1082, 50.0), (2000, 50.0), (2009, 0), (1120, 2.0),
        (1121, 2.0), (1135, 1.0), (3, 3), (10, 0), (927, 15), (719, 0), (840, 2036 << 16),
        (1070, 2018 << 16 | 1), (2200, 0), (1210, 1), ((2019, 1), ACTUAL_HZ),
    ),
    (
        (700, 5), (700, 2), (1000, 5), (1000, 1), (1080, 5.0), (1080, 0.0), (1082, 50.0),
        (1082, 35.0), (2000, 60.0), (2000, 50.0), (2009, 1), (2009, 0), (2014, 0), (2014, 5000),
        (2014, 65535), (1120, 2.0), (1121, 1.0), (1121, 10.0), (1058, 8.0), (1210, 1), (1210, 2),
        (1210, 6), ((2019, 1), 0), ((2019, 1), 20 << 16), ((2019, 1), ACTUAL_HZ), (719, 11),
        (719, 0), (1070, 755 << 16), (840, 722 << 16), (2200, 1 << 16),
    ),
    (
        (700, 2), (1000, 1), (2014, 0), (2014, 0), (2014, 0), (2014, 65535), (719, 11),
        (1070, 755 << 16), (None, 0),
    ),
    ((2009, 1), (2009, 1)),
)  # fmt: skip

ON_BOP = {  # what stands for these on the BOP link: numbers, and pairs of number and value
    (2019, 1): (2016, 1),
    (700, USS): (700, USS_ON_BOP),
    (1000, USS): (1000, USS_ON_BOP),
    (840, 2036 << 16): (840, 2032 << 16),
    (1070, 2018 << 16 | 1): (1070, 2015 << 16 | 1),
}

AT_THE_DRIVE = {
    MM420: MM4,
    MM440: MM4,
    G110: MM4,
    V20: MM4,
    GENERIC: MM4,
    MM3: People(
        93,
        ((9, 3), (910, 1), (95, 0), (12, 0), (13, 500), (94, 500), (2, 20), (3, 20), (34, 20)),
        (
            (910, 1), (910, 0), (910, 2), (12, 50), (12, 0), (13, 500), (13, 350), (94, 600),
            (94, 500), (95, 0), (95, 1), (95, 2), (93, 0), (93, 5), (93, 240), (2, 20), (3, 10),
            (3, 100), (31, 80),
        ),
        ((910, 0), (910, 4), (93, 0), (93, 0), (93, 240), (None, 0)),
    ),
    G120: People(
        2040,
        (
            (3, 3), (10, 0), (15, 21), (1080, 0.0), (1082, 1500.0), (2000, 1500.0), (1120, 2.0),
            (1121, 2.0), (1135, 1.0), (1210, 0),
        ),
        (
            (1080, 300.0), (1080, 0.0), (1082, 1500.0), (1082, 1050.0), (2000, 1800.0),
            (2000, 1500.0), (2040, 0), (2040, 5000), (2040, 65535), (1120, 2.0), (1121, 1.0),
            (1121, 10.0),
        ),
        ((2040, 0), (2040, 0), (2040, 65535), (None, 0)),
        ((1080, 300.0),),
    ),
}  # fmt: skip


def people_at(drive):
    """Those at that drive: a `People`."""
    people = AT_THE_DRIVE[drive.family.NAME]
    return _on_bop(people) if drive.family.LINK["index"] else people


def _on_bop(people):
    rows = people.order, people.meddled, people.doubts, people.more
    return People(_linked(people.off_time), *[tuple(map(_row_on_bop, each)) for each in rows])


def _row_on_bop(row):
    number, value = ON_BOP.get(row, row)
    return ON_BOP.get(number, _linked(number)), value


def _linked(number):
    return (number, 1) if number in LINKED else number
