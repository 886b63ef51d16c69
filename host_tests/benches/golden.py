# SPDX-License-Identifier: MIT
"""Golden telegrams: what documents print, byte for byte, and what it means. They pin the codec.

golden.json holds one telegram a line. Not all of them are valid: misprints of the sources are kept
to show that they are refused, and `wrong` says what is wrong with them, "length" or "BCC". Lengths
and BCC of all were computed anew. `source` is the specification E20125-D0001-S302-A1-7600 (09.94),
the MICROMASTER 420 Reference Manual, or the author of a published project with live drives; V01 to
V67 were derived from the rules.

A valid row also says what its telegram means, in fields that it can be built from:

    {"kind": "request", "node": 1, "layout": [4, 2], "pzd": ["OFF1", "0000"],
     "pkw": {"ak": 2, "number": 1000, "index": 0, "word": 5}}
"""

import json

with open(__file__.rsplit("/", 1)[0] + "/golden.json") as _file:
    GOLDEN = json.loads(_file.read())

# The flag bits of ADR that make each kind of telegram (specification ). Bits 6 and 5 together
# are undefined.
FLAGS = {
    "request": 0x00,
    "reply": 0x00,
    "mirror": 0x40,
    "broadcast": 0x20,
    "special": 0x80,
    "special broadcast": 0xA0,
    "undefined": 0x60,
}


class Telegram:
    """One golden telegram: `characters` (bytes), `net` (bytes), and the fields of its row.

    pkw_words, pzd_words: as many as stand in it. layout: as agreed with the drive, 127 for a
    variable number of PKW words. Of a valid one only:

    node: 0...31. pzd: a word each, four hexadecimal digits or a name of `uss.pzd`.
    pkw: None without a task, otherwise a dictionary of
        ak, number, index; toggle (bit 11 of PKE) and field (bits 8 and 9 of IND) where they matter
        word, double, float, text, count, error: the value, by whichever it is; next: the next
            existing number behind error 0
        enable: instead of all these, the enable array of a broadcast
        words: instead of all these, words without a meaning
    state: the name in `uss.pzd` of what the status word of a reply says.
    to: the id of the request that a reply answers, or the `pkw` of one that is no golden telegram.
    """

    def __init__(self, row):
        self.id = row["id"]
        self.kind = row["kind"]
        self.wrong = row["wrong"]
        self.pkw_words = row["pkw_words"]
        self.pzd_words = row["pzd_words"]
        self.meaning = row["meaning"]
        self.characters = bytes(int(pair, 16) for pair in row["characters"].split())
        self.net = self.characters[3:-1]
        self.node = row.get("node")
        self.layout = row.get("layout")
        self.pkw = row.get("pkw")
        self.pzd = row.get("pzd")
        self.state = row.get("state")
        self.to = row.get("to")

    def words(self):
        """The net data as words, PKW first."""
        net = self.net
        return [net[at] << 8 | net[at + 1] for at in range(0, len(net), 2)]

    def address(self):
        """ADR with its flag bits, from node and kind."""
        return self.node | FLAGS[self.kind]

    def asked(self):
        """The `pkw` of the request that this reply answers; None when there is no such."""
        return self.to if isinstance(self.to, dict) or self.to is None else BY_ID[self.to].pkw


VALID = [Telegram(row) for row in GOLDEN if row["wrong"] is None]
INVALID = [Telegram(row) for row in GOLDEN if row["wrong"] is not None]
BY_ID = {example.id: example for example in VALID}
