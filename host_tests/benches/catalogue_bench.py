# SPDX-License-Identifier: MIT
"""The tables of the catalogue, as they stand in the files: for the tests of their form.

table = Table("mm440")
table.rows["P"]                     # lists of cells, as written, in the order of the file
for row in table.parameters(): ...  # as the reader completes them, with names for the cells
"""

import catalogue

FOLDER = "firmware/catalogue/"

# By letter: names of the columns.
COLUMNS = {
    "A": "key en de cause_en cause_de remedy_en remedy_de unsure source".split(),
    "G": "key en de numbers unsure source".split(),
    "P": (
        "key en de type indices unit form lowest highest default level states asks unsure source"
    ).split(),
    "S": "key en de number index value note_en note_de unsure source".split(),
    "V": "key en de unsure source".split(),
}
COLUMNS["F"] = COLUMNS["A"]
ORDER = "AFGPSV"


def letter(key):
    return "P" if key[0] == "r" else key[0].upper()


class Row:
    """A row with its cells by name, as text."""

    def __init__(self, cells):
        for name, cell in zip(COLUMNS[letter(cells[0])], cells):
            setattr(self, name, cell)

    def number(self):
        return int(self.key[1:].split(".")[0])


class Table:
    def __init__(self, family):
        self.family = family
        self.rows = {kind: [] for kind in ORDER}
        with open(FOLDER + family + ".tsv", encoding="utf-8") as file:
            self.lines = file.read().split("\n")
        self.head = self.lines[0].split("\t")
        for line in self.lines[1:]:
            if line and line[0] != "#":
                self.rows[letter(line)].append(line.split("\t"))

    def parameters(self):
        """Each as the reader gives it: with what the family it is like adds."""
        return [named(row) for row in catalogue.rows(self.family)]

    def messages(self):
        return [named(row) for kind in "AF" for row in catalogue.rows(self.family, kind=kind)]


def named(row):
    return Row([cell.decode("iso-8859-1") for cell in row])
