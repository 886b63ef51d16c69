# SPDX-License-Identifier: MIT
"""Notes which lines of the firmware run, on CPython, for a small part of what tracing costs.

Every statement of the firmware is compiled with another one before it, which notes that its line
runs. That one stands on the same line, so that tracebacks and trace functions see the source as it
is. In use:

    begin()  # before any of the firmware is imported
    for path, numbers in seen(): ...
"""

import ast
import builtins
import sys
from functools import cache
from importlib.machinery import SOURCE_SUFFIXES, FileFinder, SourceFileLoader
from os.path import abspath, join, relpath

ROOM = abspath("firmware")

# The statements find the notes among the builtins, so that no module has a name more than it has
# on the chip. A list, for in nothing else is an entry set as quickly.
NOTES = "__lines_that_ran__"
_ran = []
_places = []  # for each note: path, line number


def begin():
    setattr(builtins, NOTES, _ran)
    sys.path_hooks.insert(0, _finder)
    sys.path_importer_cache.clear()


def seen():
    """Each file of which lines ran, from the top of the tree, and their numbers."""
    numbers = {}
    for ran, (path, number) in zip(_ran, _places, strict=True):
        if ran:
            numbers.setdefault(relpath(path), set()).add(number)
    return numbers.items()


def _finder(folder):
    if not join(abspath(folder), "").startswith(join(ROOM, "")):
        raise ImportError("not of the firmware")  # so the next hook takes it
    return FileFinder(folder, (_Loader, SOURCE_SUFFIXES))


class _Loader(SourceFileLoader):
    def get_code(self, fullname):
        return _compiled(self.get_filename(fullname))


@cache  # the panel throws modules away and imports them again and again
def _compiled(path):
    with open(path, "rb") as source:
        tree = Noting(path, _places).visit(ast.parse(source.read(), path))
    _ran.extend([False] * (len(_places) - len(_ran)))
    return compile(tree, path, "exec", dont_inherit=True)


class Noting(ast.NodeTransformer):
    """Puts before every statement of a file one that notes its line: `NOTES[number] = True`.

    places: takes path and line number of each note, which is its place there.
    """

    def __init__(self, path, places):
        self.path = path
        self.places = places

    def generic_visit(self, node):
        super().generic_visit(node)
        for part in ("body", "orelse", "finalbody"):
            statements = getattr(node, part, None)
            if isinstance(statements, list):  # that of a lambda is none
                setattr(node, part, list(self._noted(statements)))
        return node

    def visit_ExceptHandler(self, node):
        """Its line runs when it is asked whether it takes the exception."""
        self.generic_visit(node)
        if node.type:
            noted = self.noting("{}.__setitem__({}, True)", node.lineno).value
            node.type = ast.copy_location(ast.BoolOp(ast.Or(), [noted, node.type]), node.type)
        else:
            node.body.insert(0, self.noting("{}[{}] = True", node.lineno))
        return node

    def _noted(self, statements):
        for statement in statements:
            if not (statement is statements[0] and _is_text(statement)):
                for each in (*getattr(statement, "decorator_list", ()), statement):
                    yield self.noting("{}[{}] = True", each.lineno)
            yield statement

    def noting(self, text, number):
        """A statement on that line, with a note of its own."""
        (statement,) = ast.parse(text.format(NOTES, len(self.places))).body
        self.places.append((self.path, number))
        return ast.increment_lineno(statement, number - statement.lineno)


def _is_text(statement):
    """A docstring, which has to stay where it is."""
    return isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant)
