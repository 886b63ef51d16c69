# SPDX-License-Identifier: MIT
"""The drives that a command line names: 1,2=g110,3=v20/4,7=mm440/4+4,8=mm420/factory

An entry is an address; then "=" and a family; then "/" and PKW words (0, 3, 4 or 127), "+" and PZD
words, if the drive is set up for others than the family usually has; or "/factory" if nobody has
set it up since it was delivered. Behind the family may stand "-bop": the drive has its USS on the
BOP link, not on its RS-485 terminals.

    listed = listed_drives("1,2=g110/0,8=mm420/factory")
    simulated(listed)       # {1: {"family": mm420}, 2: {"family": g110, "layout": (0, 2)}, ...
    expected(listed)        # {"2": "g110/0"}: what the panel's settings say of the kinds

Each error is a ValueError with a text of one line.
"""

from boards.sim.drives.parameters import MAXIMUM, NUMBER
from boards.sim.drives.families import NAMES, named, setting_of, without_link

USUAL = "mm420"
ADDRESS_MAX = 31
PKW_WORDS = (0, 3, 4, 127)
PZD_USUAL, PZD_MIN, PZD_MAX = 2, 2, 16  # without PZD1 and PZD2 nobody commands a drive
DIGITS_MAX = 9
FACTORY = "factory"


class ListedDrive:
    """One entry.

    address  as it stands there. A drive as delivered is known by it, and answers at another one
    family   the name of its family, with its link: mm440-bop
    plain    whether the entry says nothing but the address
    layout   PKW and PZD words, or None: those that the family usually has
    factory  whether it is as delivered
    """

    def __init__(self, address, family, plain, layout=None, factory=False):
        self.address = address
        self.family = family
        self.plain = plain
        self.layout = layout
        self.factory = factory

    def kind(self):
        """What stands behind "=": the family, and what it is unlike others of its family."""
        if self.factory:
            return "%s/%s" % (self.family, FACTORY)
        if self.layout is None:
            return self.family
        pkw, pzd = self.layout
        return "%s/%d" % (self.family, pkw) + ("" if pzd == PZD_USUAL else "+%d" % pzd)

    def text(self):
        """The entry, as short as it can be."""
        return str(self.address) + ("" if self.plain else "=" + self.kind())


def listed_drives(text, usual=USUAL, names=NAMES):
    """The entries of a list.

    usual: the family of those that name none. names: of the families that there are. Of a family
    that is not simulated only the panel knows which layouts and addresses it has.
    """
    listed = []
    for entry in text.split(","):
        one = _understood(entry, usual, names)
        if one.address in [other.address for other in listed]:
            raise ValueError("%d stands there twice" % one.address)
        listed.append(one)
    return listed


def text_of(listed):
    """As the list may be written."""
    return ",".join([one.text() for one in listed])


def simulated(listed):
    """What `Drive` is given: {address: keyword arguments}."""
    found = {}
    for one in listed:
        found[one.address] = kind = {"family": named(one.family)}
        if one.layout is not None:
            kind["layout"] = one.layout
        if one.factory:
            kind["factory"] = True
    return found


def expected(listed):
    """{address: kind}, both as text, of the drives that the panel is told of, but plain ones."""
    told = [one for one in listed if not (one.plain or one.factory)]
    return {str(one.address): one.kind() for one in told}


def knowing(listed, baud):
    """ValueError if one of these drives cannot be set to this rate."""
    for one in listed:
        if not one.factory:
            family = named(one.family)
            if baud not in family.BAUD_CODES.values():
                raise ValueError("a %s has no code for %d baud" % (family.NAME, baud))


def as_delivered(drives, baud):
    """Lines for people about the drives, {address: Drive}, that nobody has set up.

    baud: of the line that they are on.
    """
    lines = []
    for address in sorted(drives):
        drive = drives[address]
        if drive.factory:
            where = (address, drive.address, drive.slave.baud)
            line = "drive %d is as delivered: it answers at address %d, at %d baud" % where
            lines.append(line if drive.slave.baud == baud else line + ", not %d" % baud)
    return lines


def _understood(entry, usual, names):
    """The drive that an entry means."""
    word, _, kind = entry.partition("=")
    if not _is_number(word, ADDRESS_MAX):
        raise ValueError("%s is no address 0...%d" % (word or "nothing", ADDRESS_MAX))
    family, slash, rest = kind.lower().partition("/")
    plus, pzd = "", ""
    if not slash:
        family, plus, pzd = family.partition("+")
    family = family or usual
    if without_link(family) not in names:
        raise ValueError("no family %s: there are %s" % (family, " ".join(names)))
    address, plain = int(word), not kind
    if slash and rest == FACTORY:
        return ListedDrive(address, family, plain, factory=True)
    if slash:
        rest, plus, pzd = rest.partition("+")
    layout = _usual_layout(family)
    if slash or plus:
        layout = _words(entry, rest if slash else str(layout[0]), pzd if plus else str(layout[1]))
    if _is_simulated(family):
        _check(entry, named(family), address, layout)
    if layout == _usual_layout(family):
        layout = None
    return ListedDrive(address, family, plain, layout)


def _words(entry, pkw, pzd):
    """PKW and PZD words as numbers."""
    if not _is_number(pkw, PKW_WORDS[-1]) or int(pkw) not in PKW_WORDS:
        allowed = "behind / stand PKW words, 0, 3, 4 or 127, or %s" % FACTORY
        raise ValueError("%s: %s" % (entry, allowed))
    if not _is_number(pzd, PZD_MAX) or int(pzd) < PZD_MIN:
        raise ValueError("%s: behind + stand PZD words, %d...%d" % (entry, PZD_MIN, PZD_MAX))
    return int(pkw), int(pzd)


def _usual_layout(family):
    """PKW and PZD words of a family, as somebody sets it up."""
    if not _is_simulated(family):
        return 4, PZD_USUAL
    module = named(family)
    link = module.LINK
    return link["layout"] or (module.COMMISSIONED[setting_of(module, "pkw words")], PZD_USUAL)


def _is_simulated(family):
    return without_link(family) in NAMES


def _check(entry, family, address, layout):
    """ValueError unless a drive of this family can have that address and layout."""
    link = family.LINK
    highest = _highest(family, link["address"])
    if address > highest:
        raise ValueError("%s: a %s has addresses 0...%d" % (entry, family.NAME, highest))
    if link["layout"] is not None:
        if layout != link["layout"]:
            raise ValueError("%s: a %s has %d+%d words" % ((entry, family.NAME) + link["layout"]))
        return
    pkw, pzd = layout
    choices = family.PERMITTED[link["pkw words"]]
    if pkw not in choices:
        choices = " ".join([str(choice) for choice in choices])
        raise ValueError("%s: a %s has PKW words %s" % (entry, family.NAME, choices))
    most = _highest(family, link["pzd words"])
    if pzd > most:
        limits = (entry, family.NAME, PZD_MIN, most)
        raise ValueError("%s: a %s has %d...%d PZD words" % limits)


def _highest(family, number):
    """The highest value of a parameter that the family has."""
    return [row[MAXIMUM] for row in family.ROWS if row[NUMBER] == number][0]


def _is_number(word, highest):
    """Whether it is one from 0 on, in the digits of ASCII."""
    if not 0 < len(word) <= DIGITS_MAX or [one for one in word if not "0" <= one <= "9"]:
        return False
    return int(word) <= highest
