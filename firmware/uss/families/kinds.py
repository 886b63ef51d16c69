# SPDX-License-Identifier: MIT
"""The kind of a drive in a word: its family, and how its telegrams are divided.

    kind("g110")                # (G110, Layout(127, 2)): as that family usually is
    kind("mm440/4+4")           # (MM440, Layout(4, 4)): PKW words, and PZD words if not 2
    kind("mm440/127s")          # no PKW words in a telegram without a task: `Layout`, short
    kind("mm440-bop/127")       # USS on the BOP link, not on the RS-485 terminals
    text(MM440, Layout(4, 4))   # "mm440/4+4"

This is for programs that obey a person's choice, so a layout has PZD1 and PZD2 at the least.
"""

from uss import families
from uss.layout import STANDARD, Layout

_BOP = "-bop"
_SHORT = "s"
_PZD_USUAL = 2
PZD_MIN = 2  # STW and HSW: without them nobody commands a drive


def kind(text):
    """The family and the layout. ValueError if there is no such kind."""
    name, slash, words = text.partition("/")
    is_bop = name.endswith(_BOP)
    name = name[: -len(_BOP)] if is_bop else name
    if name not in [name.lower() for name in families.NAMES]:
        raise ValueError("no family %s: there are %s" % (name, " ".join(families.NAMES).lower()))
    family = getattr(families, name.upper())
    if is_bop:
        family = families.on_bop(family)
    layout = _layout(words) if slash else family.layout
    if not layout.suits(family):
        raise ValueError("a %s has no %r" % (family.name, layout))
    return family, STANDARD if layout.is_like(STANDARD) else layout


def text(family, layout):
    """As `kind` takes it, as short as it can be."""
    name = family.__name__.lower()
    if layout.is_like(family.layout):
        return name
    short = _SHORT if layout.short else ""
    more = "" if layout.pzd_words == _PZD_USUAL else "+%d" % layout.pzd_words
    return "%s/%d%s%s" % (name, layout.pkw_words, short, more)


def _layout(words):
    pkw_words, plus, pzd_words = words.partition("+")
    short = pkw_words.endswith(_SHORT)
    pkw_words = pkw_words[:-1] if short else pkw_words
    if not (pkw_words.isdigit() and (pzd_words.isdigit() or not plus)):
        raise ValueError("/%s is no layout such as /4, or /4+6" % words)
    pzd_words = int(pzd_words) if plus else _PZD_USUAL
    if pzd_words < PZD_MIN:
        raise ValueError("a drive without PZD1 and PZD2 takes no commands")
    return Layout(int(pkw_words), pzd_words, short=short)
