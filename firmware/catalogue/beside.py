# SPDX-License-Identifier: MIT
"""The parameter behind or before one, in a group of the catalogue; round and round.

    for row in following("mm440", b"300-311 335", 311):     # None again and again, then r0335
    for row in preceding("mm440", b"300-311 335", 300):     # likewise: P0335

Nothing of the group is in memory: a table is read forwards only, so what stands before a number is
looked for in stretches that grow.
"""

from catalogue import rows

_PARTS = 8  # of a group that one look takes
_STRETCH = 4  # each stretch before a number is so much longer than the one before it


def following(family, numbers, number):
    """None for each look, then the row; no row where the group has none."""
    before, part, behind = yield from _split(numbers, number)
    for first, last in [(number + 1, part[1])] + behind + before + [(part[0], number)]:
        if first <= last:
            for row in rows(family, b"%d-%d" % (first, last), paced=True):
                yield row
                if row:
                    return


def preceding(family, numbers, number):
    """The same in the other direction."""
    before, part, behind = yield from _split(numbers, number)
    parts = [(number, part[1])] + behind + before + [(part[0], number - 1)]
    for first, last in reversed(parts):
        count = 1
        while first <= last:
            begin, found = max(first, last - count + 1), None
            for row in rows(family, b"%d-%d" % (begin, last), paced=True):
                found = row or found
                yield None
            if found:
                yield found
                return
            last = begin - 1
            count *= _STRETCH


def _split(numbers, number):
    """The parts of a group before that with the number, this one, and those behind it. None for
    each look.
    """
    parts = []
    for part in numbers.split():
        if len(parts) % _PARTS == 0:
            yield None
        first, _, last = part.partition(b"-")
        parts.append((int(first), int(last or first)))
    yield None
    for place, (first, last) in enumerate(parts):
        if first <= number <= last:
            return parts[:place], parts[place], parts[place + 1 :]
    return [], (number + 1, number), parts  # it is none of them
