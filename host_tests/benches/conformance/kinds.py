# SPDX-License-Identifier: MIT
"""The drives that the conformance test tries: who they are, and which numbers they are asked for.

Numbers and layouts are those of the specification and of the manuals, as a master would have to
know them.

    KINDS["mm440 variable+4"].double        # 1120: a number with a value of two words
"""

from typing import NamedTuple

from conformance.master import VARIABLE


class Kind(NamedTuple):
    """word, double: a number of that size that may be written at any time.

    words, doubles: an array of such values, with a settable element 1. reading: a number that
    nobody can write. discrete: one that may have certain values only, 3 not among them. None: the
    family has none, or has no parameter channel. more: what else is set, {number: value};
    switches: {name: value}, how it behaves where the documents leave it open.
    """

    address: int
    family: str
    pkw_words: int
    pzd_words: int
    word: int | None = 3
    double: int | None = 1120
    words: int | None = None
    doubles: int | None = None
    reading: int | None = 52
    discrete: int | None = 700
    more: dict = {}
    switches: dict = {}

    def settings(self):
        """{number: value} that its commissioning has to say."""
        if self.family == "mm3":
            return self.more
        pkw, pzd = (2023, 2022) if self.family == "g120" else (2013, 2012)
        return {pkw: self.pkw_words, pzd: self.pzd_words, **self.more}

    @property
    def baud(self):
        """The highest rate that the family knows."""
        return {"mm3": 19200, "g110": 57600}.get(self.family, 115200)


AT_ONCE = {1120: 0.0, 1121: 0.0, 1135: 0.0, 1060: 0.0, 1061: 0.0}  # no ramps
UNWATCHED = {2014: 0}  # a V20 watches its line as delivered

KINDS = {
    "mm420 4+2": Kind(1, "mm420", 4, 2, words=2010, doubles=2019, more=AT_ONCE),
    "mm420 3+2": Kind(2, "mm420", 3, 2, words=2010, doubles=2019),
    "mm420 variable+2": Kind(3, "mm420", VARIABLE, 2, words=2010, doubles=2019),
    "mm440 4+8": Kind(4, "mm440", 4, 8, words=2010, doubles=1120, more=AT_ONCE),
    "mm440 variable+4": Kind(5, "mm440", VARIABLE, 4, words=2010, doubles=1120),
    "g110 variable+2": Kind(6, "g110", VARIABLE, 2, doubles=2019, more=AT_ONCE),
    "g110 0+2": Kind(7, "g110", 0, 2),
    "v20 4+2": Kind(8, "v20", 4, 2, words=2010, doubles=1120, more={**UNWATCHED, **AT_ONCE}),
    "v20 variable+2": Kind(9, "v20", VARIABLE, 2, words=2010, doubles=1120, more=UNWATCHED),
    "mm3 3+2": Kind(
        10, "mm3", 3, 2, word=2, double=None, reading=131, discrete=None, more={2: 0, 3: 0}
    ),
    "g120 variable+2": Kind(
        11, "g120", VARIABLE, 2, doubles=2051, discrete=2023, more={1120: 0.0, 1121: 0.0}
    ),
    "generic 4+16": Kind(12, "generic", 4, 16, words=9, doubles=4),
    "generic variable+0": Kind(13, "generic", VARIABLE, 0, words=9, doubles=4),
    "generic 0+6": Kind(31, "generic", 0, 6),
    "mm420 at address 0": Kind(0, "mm420", 4, 2),
}

# Drives for single tests: with other habits, or to be spoilt.
ODD_ONES = {
    "late replies": Kind(14, "mm420", 4, 2, switches={"stale_replies": 2}),
    "repeats writes": Kind(15, "mm420", 4, 2, switches={"reexecute": 1}),
    "to be reset": Kind(16, "mm420", VARIABLE, 2),
    "to be set up": Kind(17, "mm440", 4, 2),
}
EVERYBODY = {**KINDS, **ODD_ONES}

# Values that may be written into them at any time, as words.
VALUES = {
    2: [20],  # MM3: ramp-up time, 0.1 s
    3: [4],  # access level
    4: [0x1234, 0x5678],
    9: [3],
    1120: [0x4140, 0],  # ramp-up time, 12.0 s
    2010: [8],  # of the other port: baud rate
    2019: [0x0015, 0],  # r0021
    2051: [0x0015, 0],
}
