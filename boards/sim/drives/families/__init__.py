# SPDX-License-Identifier: MIT
"""The families of simulated drives: a module each, with the tables that mm420.py explains.

    Drive(clock, wire, 3, family=named("v20"))

To add a family, write a file here and put its name into NAMES.
"""

NAMES = ("mm420", "mm440", "mm3", "g110", "v20", "g120", "generic")


def named(name):
    """The module of that family. ValueError if there is none."""
    if name not in NAMES:
        raise ValueError("no family %s: there are %s" % (name, " ".join(NAMES)))
    return __import__("boards.sim.drives.families." + name, None, None, ("ROWS",))
