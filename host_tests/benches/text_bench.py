# SPDX-License-Identifier: MIT
"""Every text of the panel, and the rows of `languages/words.tsv` that say it in other languages.

A module that has texts stands in MODULES; host_tests/house/test_structure.py finds one that is
missing.
"""

from panel import texts
from panel.commission import words as commission_words
from panel.lookup import ask
from panel.lookup import words as lookup_words
from panel.menu import words as menu_words
from panel.menu.diagnosis import words as diagnosis_words
from panel.menu.sets import words as set_words
from panel.pages import digits, parameter_words, set_up, splash, writing
from search import words as search_words

MODULES = (
    texts, splash, parameter_words, menu_words, set_words, diagnosis_words, search_words,
    lookup_words, ask, commission_words, set_up, writing,
    digits,
)  # fmt: skip
TABLE = "firmware/panel/languages/words.tsv"


def named():
    """(module, name, text or texts) of all that the modules of texts have."""
    return [
        (module, name, getattr(module, name))
        for module in MODULES
        for name in sorted(dir(module))
        if not name.startswith("__") and name not in ("NOTHING", "_ENGLISH")
    ]


def parts(value):
    """The texts in it, in English, in whatever they stand: bytes, tuples, dictionaries."""
    if isinstance(value, bytes):
        yield value
    elif isinstance(value, (tuple, dict)):
        for part in value.values() if isinstance(value, dict) else value:
            yield from parts(part)


def rows():
    """(the languages besides English, [cells of a row, the text first]): ISO 8859-1."""
    found = []
    with open(TABLE, encoding="utf-8") as table:
        for line in table:
            if not line.startswith("#"):
                cells = line.rstrip("\n").split("\t")
                found.append([bytes([ord(letter) for letter in cell]) for cell in cells])
    return [name.decode() for name in found[0][1:]], found[1:]


def columns():
    """{language: {text: its words}}, English among them."""
    languages, found = rows()
    spoken = {"en": {row[0]: row[0] for row in found}}
    for place, language in enumerate(languages, 1):
        spoken[language] = {
            row[0]: row[place] if len(row) > place and row[place] else row[0] for row in found
        }
    return spoken
