# SPDX-License-Identifier: MIT
"""The families of simulated drives: a module each, with the tables that mm420.py explains.

    Drive(clock, wire, 3, family=named("v20"))
    Drive(clock, wire, 4, family=named("mm440-bop"))    # USS on its BOP link, see bop_link.py

To add a family, write a file here and put its name into NAMES.
"""

NAMES = ("mm420", "mm440", "mm3", "g110", "v20", "g120", "generic")
BOP = "-bop"
WITH_BOP = ("mm420", "mm440")  # which have the second link


def named(name):
    """What is known of that family. ValueError if there is none."""
    if without_link(name) not in NAMES:
        raise ValueError("no family %s: there are %s" % (name, " ".join(NAMES)))
    family = _module("families." + without_link(name), "ROWS")
    if name.endswith(BOP):
        if without_link(name) not in WITH_BOP:
            raise ValueError("a %s has no BOP link" % family.NAME)
        return _module("bop_link", "on_bop").on_bop(family)
    return family


def without_link(name):
    """The name of the family alone."""
    return name[: -len(BOP)] if name.endswith(BOP) else name


def setting_of(family, name):
    """A setting of the link, such as "address", as a key for the parameters of a `Drive`."""
    number, index = family.LINK[name], family.LINK["index"]
    return (number, index) if index else number


def _module(name, what):
    return __import__("boards.sim.drives." + name, None, None, (what,))
