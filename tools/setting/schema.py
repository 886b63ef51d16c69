# SPDX-License-Identifier: MIT
"""What settings there are, by the tables of the firmware, and what a change makes of their file.

    data = changed(data, ["baud=9600", "kinds.2=g110"])     # Mistake: beyond the limits, and which
    for line in table(loaded(data)): print(line)

The panel's own code reads and writes the file here. So what it would not take is refused before
it gets there, and what a newer firmware has stored stays.
"""

import io
import json

import strict_json
from panel.sets import set_file
from settings_file import (
    ADDRESSES,
    BY_ADDRESS,
    BY_FAMILY,
    CHOICES,
    DEFAULTS,
    FAVOURITES_MAX,
    NUMBERS,
    REPEATS_MAX,
    as_dictionary,
    load,
    save,
)
from uss.telegram import NODE_MAX

OBJECTS = [row[0] for row in BY_ADDRESS + BY_FAMILY]
LISTS = [row[0] for row in ADDRESSES]
COLUMN = 44  # where the meaning begins


class Mistake(Exception):
    """What is wrong with a name, a value or a file, in one sentence."""


class Stored:
    """A store of `hal` in memory."""

    def __init__(self, data):
        self.data = data

    def read(self, most=-1):
        return self.data if most < 0 or self.data is None else self.data[:most]

    def replace(self, data):
        self.data = data

    def set_aside(self):
        """The place where it is kept does that."""

    def open(self, name):
        return io.BytesIO(self.data)


def loaded(data):
    """The `Settings` in a file, as the panel sees them. data: None if there is no file."""
    return load(Stored(data))


def check(data):
    """Mistake: the panel would say SETTINGS DAMAGED."""
    complaint = loaded(data).complaint
    if complaint:
        raise Mistake(complaint)


def check_set(name, data):
    """Mistake: it is no parameter set, or not whole."""
    store = Stored(data)
    try:
        set_file.read_head(store, name)
        for _ in set_file.rows(store, name):
            pass
    except ValueError as error:
        why = error.args[0] if error.args else "no set"
        text = why.decode() if isinstance(why, bytes) else str(why)
        raise Mistake(f"{name} is no parameter set that a panel takes ({text})") from None


def whole(data):
    """The file with every setting in it, as the panel would write it."""
    store = Stored(None)
    save(store, loaded(data))
    return store.data


def changed(data, changes):
    """The file with these changes, each NAME=VALUE or NAME.KEY=VALUE. Mistake."""
    try:
        found = strict_json.fields(data) if data is not None else []
    except ValueError as error:
        raise Mistake(f"the settings are damaged ({error}): edit them") from None
    before = as_dictionary(loaded(data))
    new = {}
    for change in changes:
        name, _, word = change.partition("=")
        name, dot, key = name.strip().partition(".")
        check_names([name])
        if dot and name not in OBJECTS:
            raise Mistake(f"{name} has no parts: say {name}=VALUE")
        if dot:
            new.setdefault(name, dict(before[name]))
            new[name].pop(key, None)
            if word:
                new[name][key] = [*numbers(word)] if name == "favourites" else value(word)
        elif name in OBJECTS:
            new[name] = object_of(name, word)
        else:
            new[name] = [*numbers(word)] if name in LISTS else value(word)
    members = [source.decode() for name, _, source in found if name not in new]
    members += [f"{json.dumps(name)}: {json.dumps(of)}" for name, of in new.items()]
    data = "{%s}" % ", ".join(members)
    check(data.encode())
    return whole(data.encode())


def check_names(names):
    for name in names:
        if name not in DEFAULTS:
            raise Mistake(f"there is no setting {name}: there are {' '.join(DEFAULTS)}")


def value(word):
    return int(word) if word.isascii() and word.isdigit() else word


def numbers(text):
    """Those in "1,2,5", or in "[1, 2, 5]"."""
    words = text.strip().removeprefix("[").removesuffix("]").replace(",", " ").split()
    return [value(word) for word in words]


def object_of(name, text):
    try:
        return json.loads(text or "{}")
    except ValueError:
        raise Mistake(f'{name}: say {name}.1=VALUE, or {name}={{"1": VALUE}}') from None


# ---- to be shown ------------------------------------------------------------------------------


def limits():
    """{name: (what it may be, what it means)}, by the tables."""
    found = {}
    for name, _, choices, meaning in CHOICES:
        found[name] = " ".join(map(str, choices)), meaning
    for name, _, lowest, highest, meaning in NUMBERS:
        found[name] = f"{lowest}...{highest}", meaning
    for name, _, fewest, meaning in ADDRESSES:
        found[name] = f"{fewest}...{NODE_MAX} addresses 0...{NODE_MAX}", meaning
    for name, _, meaning in BY_ADDRESS:
        found[name] = f"by address 0...{NODE_MAX}", meaning
    for name, _, meaning in BY_FAMILY:
        found[name] = f"by family, {FAVOURITES_MAX} numbers at the most", meaning
    found["repeats"] = f"by address 0...{NODE_MAX}: 2...{REPEATS_MAX}", found["repeats"][1]
    return found


def table(settings, names=()):
    """A line for each: name, value, meaning and limits."""
    of, told = as_dictionary(settings), limits()
    for name in names or DEFAULTS:
        allowed, meaning = told[name]
        shown = f"{name} = {json.dumps(of[name])}"
        yield f"{shown.ljust(COLUMN)}  # {meaning}; {allowed}"
