"""Golden telegrams: what the documents print, byte for byte. They pin the codec.

golden.json holds one telegram a line. Not all of them are valid: misprints of the sources are kept
to show that they are refused, and `wrong` says what is wrong with them, "length" or "BCC". Lengths
and BCC of all were computed anew. `source` is the specification E20125-D0001-S302-A1-7600 (09.94),
the MICROMASTER 420 Reference Manual, or the author of a published project with live drives.
"""

import json

with open(__file__.rsplit("/", 1)[0] + "/golden.json") as _file:
    GOLDEN = json.loads(_file.read())


class Telegram:
    """One golden telegram: `characters` (bytes), `net` (bytes), and the fields of its row."""

    def __init__(self, row):
        self.id = row["id"]
        self.kind = row["kind"]
        self.wrong = row["wrong"]
        self.pkw_words = row["pkw_words"]
        self.pzd_words = row["pzd_words"]
        self.meaning = row["meaning"]
        self.characters = bytes(int(pair, 16) for pair in row["characters"].split())
        self.net = self.characters[3:-1]

    def words(self):
        """The net data as words, PKW first."""
        net = self.net
        return [net[at] << 8 | net[at + 1] for at in range(0, len(net), 2)]


VALID = [Telegram(row) for row in GOLDEN if row["wrong"] is None]
INVALID = [Telegram(row) for row in GOLDEN if row["wrong"] is not None]
