# SPDX-License-Identifier: MIT
"""Notes which lines of the firmware run, on CPython, for a small part of what tracing costs.

A statement of the firmware is compiled with another one before it, which notes that its line runs,
and the lines that surely run with it. That one stands on the same line, so that tracebacks and
trace functions see the source as it is. In use:

    begin()  # before any of the firmware is imported
    for path, numbers in seen(): ...

In a copy of this process:

    before = state()
    notes = list(seen(before))  # which this process takes: add(notes)
"""

import ast
import builtins
import marshal
import os
import sys
from contextlib import suppress
from functools import cache
from hashlib import sha256
from importlib.machinery import SOURCE_SUFFIXES, FileFinder, SourceFileLoader
from itertools import compress
from os.path import abspath, dirname, join, relpath

ROOM = abspath("firmware")
KEPT = abspath("build/noted")  # to compile with notes takes each process 0.2 s: what is made stays

# The statements find the notes among the builtins, so that no module has a name more than it has
# on the chip. A list for each file, for in nothing else is an entry set as quickly.
NOTES = "__lines_of_{}__"
# By paths from the top of the tree.
_noted = {}  # whether each note was made, and the numbers of its lines
_added = {}  # numbers of lines


def begin():
    sys.path_hooks.insert(0, _finder)
    sys.path_importer_cache.clear()


# What can end a statement before the next one runs, or take it elsewhere. That a name or an
# attribute is not there would be a defect.
NOT_SURE = (
    ast.Call, ast.Subscript, ast.Await, ast.Yield, ast.YieldFrom, ast.Div, ast.FloorDiv, ast.Mod,
    ast.Starred, ast.List, ast.Tuple, ast.comprehension, ast.NamedExpr,
)  # fmt: skip
MAY_BE_SURE = (ast.Assign, ast.AugAssign, ast.AnnAssign, ast.Pass, ast.Global, ast.Nonlocal)


def state():
    """How much was noted of each file: for `seen`."""
    added = {path: len(numbers) for path, numbers in _added.items()}
    return {path: (bytes(made), added.get(path)) for path, (made, _) in _noted.items()}


def seen(before=None):
    """Each file of which lines ran, from the top of the tree, and their numbers. before: what
    `state` has said: leaves out those of which no more ran since."""
    now = state() if before else {}
    for path in _noted.keys() | _added.keys():
        if before and path in now and now[path] == before.get(path):
            continue
        made, numbers = _noted.get(path, ((), ()))
        ran = _added.get(path, set()).union(*compress(numbers, made))
        if ran:
            yield path, ran


def add(notes):
    for path, numbers in notes:
        _added.setdefault(path, set()).update(numbers)


def _finder(folder):
    if not join(abspath(folder), "").startswith(join(ROOM, "")):
        raise ImportError("not of the firmware")  # so the next hook takes it
    return FileFinder(folder, (_Loader, SOURCE_SUFFIXES))


class _Loader(SourceFileLoader):
    def get_code(self, fullname):
        return _compiled(self.get_filename(fullname))


@cache  # the panel throws modules away and imports them again and again
def _compiled(path):
    path = abspath(path)
    place = join(KEPT, relpath(path, ROOM))
    with open(path, "rb") as source, open(__file__, "rb") as own:
        content = source.read()
        made_of = sha256(b"\n".join((content, own.read(), sys.version.encode()))).digest()
    try:
        with open(place, "rb") as file:
            was_made_of, notes, numbers, code = marshal.load(file)
    except (OSError, EOFError, ValueError, TypeError):
        was_made_of = None
    if was_made_of != made_of:
        notes = NOTES.format(relpath(path, ROOM).encode().hex())
        code, numbers = _compile(path, content, notes)
        _keep(place, (made_of, notes, numbers, code))
    made = [False] * len(numbers)
    _noted[relpath(path)] = made, numbers
    setattr(builtins, notes, made)
    return code


def _compile(path, content, notes):
    places = []
    tree = Noting(path, places, notes).visit(ast.parse(content, path))
    code = compile(tree, path, "exec", dont_inherit=True)
    return code, [lines for _, lines in places]


def _keep(place, what):
    """For the next process, if there is a build/ to write to: others may be doing the same."""
    if not os.path.isdir(dirname(KEPT)):
        return
    unfinished = f"{place}.{os.getpid()}"
    with suppress(OSError):
        os.makedirs(dirname(place), exist_ok=True)
        with open(unfinished, "wb") as file:
            marshal.dump(what, file)
        os.replace(unfinished, place)


class Noting(ast.NodeTransformer):
    """Puts before the statements of a file some that note their lines: `notes[number] = True`.

    places: takes path and line numbers of each note, which is its place there. notes: the name of
    the list.
    """

    def __init__(self, path, places, notes):
        self.path = path
        self.places = places
        self.notes = notes

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
        lines = None  # of the note before, as long as the next statement surely runs as well
        for statement in statements:
            if not (statement is statements[0] and _is_text(statement)):
                for each in (*getattr(statement, "decorator_list", ()), statement):
                    if lines is None:
                        yield self.noting("{}[{}] = True", each.lineno)
                        _, lines = self.places[-1]
                    elif each.lineno not in lines:
                        lines.append(each.lineno)
                if not _is_sure(statement):
                    lines = None
            yield statement

    def noting(self, text, number):
        """A statement on that line, with a note of its own."""
        (statement,) = ast.parse(text.format(self.notes, len(self.places))).body
        self.places.append((self.path, [number]))
        return ast.increment_lineno(statement, number - statement.lineno)


def _is_sure(statement):
    """Whether the statement behind it runs whenever it does."""
    return isinstance(statement, MAY_BE_SURE) and not any(
        isinstance(each, NOT_SURE) for each in ast.walk(statement)
    )


def _is_text(statement):
    """A docstring, which has to stay where it is."""
    return isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant)
