# SPDX-License-Identifier: MIT
"""Which data set of a MICROMASTER 440 is in force: parameters with three indices have a value for
each.

P0810 and P0811 choose the command data set, P0820 and P0821 the drive data set; each of them names
a connector that gives one bit. A new drive data set comes into force at standstill. Numbers and
their division are general knowledge. Two indices are those of the two links.

    sets = DataSets(sources, 0)
    sets.take(ram)                  # the four connectors
    sets.look(image, standing)      # True: another set is in force now
    sets.index(700, 3)              # 1: the place of the value in force, of three
"""

SETS = 3
LINKS = 2

# Numbers with three indices that belong to the commands; the others belong to the drive.
OF_COMMANDS = (
    700, 701, 702, 703, 704, 705, 706, 707, 708, 719, 731, 732, 733, 840, 1000, 1070, 1110, 2103,
    2106, 2200, 2253, 2264,
)  # fmt: skip
CHOICES = (810, 811), (820, 821)  # bit 0, bit 1


class DataSets:
    """sources: a `Sources`, which knows what connectors say. link: the index of this bus.

    command   the command data set in force, 0...2, r0050
    drive     the drive data set in force, r0051[1]
    selected  the drive data set that is selected, r0051[0]
    """

    def __init__(self, sources, link):
        self._sources = sources
        self._link = link
        self._connectors = ((0, 0), (0, 0))
        self.by_bus = False  # a word that is received may choose another one
        self.command = self.drive = self.selected = 0

    def take(self, ram):
        """Take the connectors from `ram`. A family without them has one set."""
        zero = (0,)
        self._connectors = [[ram.get(number, zero)[0] for number in pair] for pair in CHOICES]
        self.by_bus = False
        for low, high in self._connectors:
            if self._sources.is_word(low) or self._sources.is_word(high):
                self.by_bus = True

    def look(self, image, standing):
        """Select by what the connectors say now; return whether another set is in force."""
        before = self.command, self.drive
        self.command, self.selected = [self._chosen(pair, image) for pair in self._connectors]
        if standing:
            self.drive = self.selected
        return before != (self.command, self.drive)

    def _chosen(self, pair, image):
        low, high = [self._sources.bit(connector, image) for connector in pair]
        return SETS - 1 if high else low

    def index(self, number, indices):
        if indices != SETS:
            return self._link if indices == LINKS else 0
        return self.command if number in OF_COMMANDS else self.drive
