# SPDX-License-Identifier: MIT
"""The settings of the port: from the command line, else the environment, else a small file.

port = "/dev/ttyUSB0"               # uss.toml here, or ~/.config/uss.toml, or --config FILE
baud = 19200
address = "1,2"
kind = "1=mm440,2=g110/0"           # or a class of your own: "pump.py:Pump"
reply_timeout = 60
"""

import os
import runpy
import tomllib
from pathlib import Path

from tools.uss_command.errors import Misused
from uss.families import GENERIC
from uss.families.kinds import kind as kind_of
from uss.telegram import NODE_MAX
from uss.timing import BAUD_RATES

FILES = (Path("uss.toml"), Path.home() / ".config" / "uss.toml")
DEFAULTS = {"port": None, "baud": 9600, "address": "1", "kind": "", "reply_timeout": 60}
REPLY_TIMEOUTS_MS = (20, 2000)
EVERYONE = -1  # a kind without an address


class Settings:
    """chosen: of argparse. port, baud, addresses, reply_timeout_ms; kinds {address: (family,
    layout)}, EVERYONE for all others. Misused."""

    def __init__(self, chosen, environment=os.environ):
        self._given = {**DEFAULTS, **from_file(getattr(chosen, "config", None))}
        for name in DEFAULTS:
            word = environment.get("USS_" + name.upper())
            if word:
                self._given[name] = word
            if getattr(chosen, name, None) is not None:
                self._given[name] = getattr(chosen, name)
        self.port = self._given["port"]
        self.baud = number("baud", self._given["baud"])
        if self.baud not in BAUD_RATES:
            rates = " ".join(map(str, BAUD_RATES))
            raise Misused("baud: %d is no rate of USS: %s" % (self.baud, rates))
        self.addresses = numbers("address", str(self._given["address"]), NODE_MAX)
        self.reply_timeout_ms = number("reply_timeout", self._given["reply_timeout"])
        least, most = REPLY_TIMEOUTS_MS
        if not least <= self.reply_timeout_ms <= most:
            raise Misused("reply_timeout: %d...%d ms" % REPLY_TIMEOUTS_MS)
        self.kinds, self._layouts = kinds(str(self._given["kind"]))

    def the_address(self):
        """The only one. Misused."""
        if len(self.addresses) != 1:
            raise Misused("this is about one drive: --address 1")
        return self.addresses[0]

    def kind(self, address):
        """(family, layout) that somebody has told, or None."""
        return self.kinds.get(address) or self.kinds.get(EVERYONE)

    def says_layout(self, address):
        """Whether its kind names its layout, too: mm440/4+4."""
        return (address if address in self.kinds else EVERYONE) in self._layouts


def from_file(path):
    """What a file says. Misused."""
    paths = [Path(path)] if path else [found for found in FILES if found.is_file()][:1]
    for one in paths:
        try:
            told = tomllib.loads(one.read_text(encoding="utf-8"))
        except (OSError, ValueError) as error:
            raise Misused("%s: %s" % (one, getattr(error, "strerror", None) or error)) from None
        unknown = told.keys() - DEFAULTS.keys()
        if unknown:
            have = ", ".join(DEFAULTS)
            raise Misused("%s: there is no setting %s: %s" % (one, sorted(unknown)[0], have))
        return told
    return {}


def number(name, word):
    try:
        return int(word)
    except ValueError:
        raise Misused("%s: %s is no number" % (name, word)) from None


def numbers(name, text, most):
    """[1, 2, 5, 6] for "1,2,5-6". Misused."""
    found = []
    for part in text.replace(" ", "").split(","):
        first, _, last = part.partition("-")
        if not (first.isdigit() and (last or first).isdigit()):
            raise Misused("%s: %s is no list such as 1,2,5-8" % (name, text))
        found += range(int(first), int(last or first) + 1)
        if found and found[-1] > most or not found:
            raise Misused("%s: %s is not within 0...%d" % (name, part, most))
    return list(dict.fromkeys(found))


def kinds(text):
    """{address: (family, layout)} for "1=mm440,2=g110/0", or "mm440" for all; and a set of those
    that name a layout. Misused."""
    found, with_layout = {}, set()
    for part in text.split(",") if text else ():
        address, equals, word = part.rpartition("=")
        own = ":" in word
        try:
            known = family_of(word) if own else kind_of(word)
        except ValueError as error:
            raise Misused("kind: %s" % error) from None
        whose = numbers("kind", address, NODE_MAX)[0] if equals else EVERYONE
        found[whose] = known
        if own or "/" in word:
            with_layout.add(whose)
    return found, with_layout


def family_of(word):
    """The class in "pump.py:Pump", and its layout. ValueError."""
    path, _, name = word.rpartition(":")
    try:
        family = runpy.run_path(path)[name]
    except KeyError:
        raise ValueError("%s has no %s" % (path, name)) from None
    except Exception as error:
        raise ValueError("%s: %s" % (path, getattr(error, "strerror", None) or error)) from None
    if not (isinstance(family, type) and issubclass(family, GENERIC)):
        raise ValueError("%s is no class of a family, such as class %s(GENERIC)" % (name, name))
    return family, family.layout
