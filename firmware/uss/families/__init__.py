# SPDX-License-Identifier: MIT
"""The drive families, as data: what a program must know of a drive to talk to it and to run it.

A family is a class that only holds values and is never instantiated; what it does not say itself
it has from the family it is like. `GENERIC`, the specification alone, says what each value means.
A drive that differs is one more class: `class Pump(MM440): layout = Layout(4, 4)`. Each row that
the protocol notes hold unverified is marked (?). A family is loaded when it is named for the first
time, so that the panel has room for its drives.

    from uss.families import MM440
    bus.add(3, MM440)
    MM440.baud_codes[7]                # 19200
    baud_code(MM440, 19200)            # 7, for P2010

How the families differ from the MICROMASTER 4, in short (USS.md 1.3, 1.9, 4.2, 4.5, 4.7):

    MM3     3 + 2 words, no IND, numbers below 1000; ON is 0C7Fh right, 147Fh left, and HIW has no
            sign; P091...P095, telegram-off time in seconds
    -BOP    USS on the second link of a MICROMASTER 4 or CU240S: `bop` makes it of the family
    G110    parameters without index, 127 PKW words as delivered, no P2009
    V20     USS is chosen by P2023 = 1 and a power cycle; baud codes from 9600 on; trips with F72
    CU240S  the first G120: as an MM440
    G120    ready xx31h, runs xx37h; reference p2000 in rpm; link p2020...p2040; jog bits reserved;
            no broadcast; trips with F01910, and with F07220 when bit 10 drops while it runs
"""

import uss.families.rows  # noqa: F401 - __getattr__ does not see the modules of this package

# Which module has which families. The last two have what a program asks of them.
_MODULES = (
    ("generic", "GENERIC"),
    ("mm3", "MM3"),
    ("mm4", "MM410 MM420 MM430 MM440"),
    ("g110", "G110"),
    ("v20", "V20"),
    ("g120", "CU240S G120"),
    ("bop", "on_bop"),
    ("questions", ""),
)
NAMES = [name for _, names in _MODULES for name in names.split() if name.isupper()]


def __getattr__(name):
    """A family or a function that is named for the first time; FAMILIES are all of them."""
    if name == "FAMILIES":
        return tuple([__getattr__(family) for family in NAMES])
    home = "mm4" if name == "MM4" else "questions"
    for module, names in _MODULES:
        if name in names.split():
            home = module
    found = getattr(__import__(__name__ + "." + home, None, None, (name,)), name, None)
    if found is None:
        raise AttributeError("uss.families has no %s" % name)
    return found
