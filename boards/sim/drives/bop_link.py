# SPDX-License-Identifier: MIT
"""A MICROMASTER 4 with its USS on the BOP link: RS-232, the plug of the keypad.

It is the family that it is, with the other index of each number of the link, and with the words
of that link: r2015, P2016, r2032 and r2033 (CU240S manual, and a program that ran an MM440 by
it). Bit 2 of P0927 and F0071 are general knowledge. What is said to the RS-485 terminals reaches
nobody.

    Drive(clock, wire, 1, {(2013, 1): 127}, family=on_bop(mm440))
"""

from boards.sim.drives.words import THIS_BUS

INDEX = 1
THIS_LINK = 4  # of P0700, P1000 and the digits of P0719; 5 is the other link

# Numbers whose index is the one of the link.
LINKED = (2009, 2010, 2011, 2012, 2013, 2014)

RECEIVED_FIRST, SENT = 2015, 2016
CONTROL_WORD_1, CONTROL_WORD_2 = 2032, 2033
FAULT = 71
RIGHTS_BIT = 0x0004

_made = {}  # by name: a family has one


def on_bop(family):
    """The family, a module such as mm420, as it is on this link."""
    if family.NAME not in _made:
        _made[family.NAME] = _OnBop(family)
    return _made[family.NAME]


class _OnBop:
    """Has what the module has."""

    def __init__(self, family):
        for name in dir(family):
            if name.isupper():
                setattr(self, name, getattr(family, name))
        self.LINK = link = dict(family.LINK)
        link["index"] = INDEX
        link["fault"] = FAULT
        link["sent"] = SENT
        self.COMMISSIONED = {
            (number, INDEX) if number in LINKED else number: value
            for number, value in family.COMMISSIONED.items()
        }
        self.COMMISSIONED[700] = self.COMMISSIONED[1000] = THIS_LINK
        self.PERMITTED = dict(family.PERMITTED)
        self.PERMITTED[SENT] = family.PERMITTED[family.LINK["sent"]]
        self.OTHER_COMMANDS = dict(family.OTHER_COMMANDS)
        self.OTHER_COMMANDS[THIS_BUS] = self.OTHER_COMMANDS.pop(THIS_LINK)
        self._connect(family.SOURCES)
        self.CHANNEL = dict(family.CHANNEL)
        self.CHANNEL["rights"] = (family.CHANNEL["rights"][0], RIGHTS_BIT)

    def _connect(self, sources):
        """The words of this link are in force, those of the other one are 0."""
        self.SOURCES = dict(sources)
        self.READINGS = readings = dict(self.READINGS)
        words = {0: CONTROL_WORD_1, 3: CONTROL_WORD_2}
        self.SOURCES["words"] = {words[place]: place for place in sources["words"].values()}
        self.SOURCES["received"] = RECEIVED_FIRST
        self.SOURCES["digit"] = THIS_LINK
        readings[RECEIVED_FIRST] = readings.pop(sources["received"])
        for number, place in sources["words"].items():
            readings[words[place]] = readings.pop(number)
