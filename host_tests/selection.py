# SPDX-License-Identifier: MIT
"""What -k may mean, by the names in the files, before one of them is read: so it takes seconds.

    chosen = Selection("home and unix64")
    chosen.may_run(path)            # whether a test in this file may be meant
    chosen.tiers(path)              # the tiers on which one of its tests may be

As a program it tells tools/test what a command line needs: names of tiers, a line, and "chip" if
an ordinary test may want the emulated Pico as well.
"""

import itertools
import re
import sys
from pathlib import Path

from _pytest.mark.expression import Expression

from tiers import OR, TIERS, TOP, usual

TESTS = TOP / "host_tests"
ORDINARY = "host"
FUNCTION = re.compile(r"^def (test_\w+)", re.MULTILINE)
INTERPRETERS = re.compile(r'^INTERPRETERS = "(.*)"$', re.MULTILINE)
OF_VALUES = "parametrize"  # such a test has names that only the file itself can tell
OF_FUNCTIONS = "test_"
CHIP = "chip"
CHIPS = re.compile(r"pico", re.IGNORECASE)
UNKNOWN_MAX = 6  # words, all of which may be true or not


class Selection:
    """expression: that of -k; "" takes all. ValueError: it is none."""

    def __init__(self, expression):
        self._expression = None
        if expression:
            try:
                self._expression = Expression.compile(expression)
            except SyntaxError as error:
                raise ValueError(str(error)) from None

    def may_run(self, path):
        return bool(self.tiers(path))

    def tiers(self, path, surely=False):
        """surely: without those of which nobody knows yet whether they may."""
        text = path.read_text(encoding="utf-8", errors="replace")
        named = INTERPRETERS.search(text)
        words = named[1].split() if named else usual(path)
        names = [name for word in words for name in word.split(OR)]
        if self._expression is None:
            return names
        of_path = path.relative_to(TESTS).parts if path.is_relative_to(TESTS) else (path.name,)
        functions = FUNCTION.findall(text)
        has_values = not surely and ORDINARY in names and OF_VALUES in text
        return [
            tier
            for tier in names
            if any(self._may({*of_path, tier, one}, has_values) for one in functions)
        ]

    def _may(self, names, has_values):
        """Whether the expression may be true of a test with these names."""
        lower = [name.lower() for name in names]
        unknown = []

        def known(word, **_):
            if any(word.lower() in name for name in lower):
                return True
            if not word.startswith(OF_FUNCTIONS):  # no value is called like a function
                unknown.append(word)
            return False

        if self._expression.evaluate(known):
            return True
        if not has_values:
            return False
        words = sorted({*unknown})
        if len(words) > UNKNOWN_MAX:
            return True
        for truths in itertools.product((False, True), repeat=len(words)):
            true = {word for word, is_true in zip(words, truths) if is_true}
            if self._expression.evaluate(lambda word, **_: word in true or known(word)):
                return True
        return False


def expression_of(words):
    """What -k says on this command line."""
    for number, word in enumerate(words):
        if word == "-k":
            return words[number + 1] if number + 1 < len(words) else ""
        if word.startswith("-k"):
            return word[2:].removeprefix("=")
    return ""


def files_of(words):
    """The test files that a command line names, by themselves or by a folder; else all."""
    paths = [Path(word.partition("::")[0]) for word in words if not word.startswith("-")]
    paths = [path.resolve() for path in paths if path.exists()] or [TESTS]
    for path in paths:
        yield from [path] if path.is_file() else sorted(path.rglob("test_*.py"))


def needs(words):
    """The tiers that a command line may need, and CHIP."""
    chosen = Selection(expression_of(words))
    found = set()
    for path in files_of(words):
        found.update(chosen.tiers(path))
        is_ordinary = ORDINARY in chosen.tiers(path, surely=True)
        if is_ordinary and CHIPS.search(path.read_text(encoding="utf-8", errors="replace")):
            found.add(CHIP)
    return found


if __name__ == "__main__":
    try:
        print(*sorted(needs(sys.argv[1:])), sep="\n")
    except ValueError:
        print(*TIERS, CHIP, sep="\n")  # pytest says what is wrong
