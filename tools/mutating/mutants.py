# SPDX-License-Identifier: MIT
"""Mutants: files of the firmware with one change each, as a slip makes it.

    for mutant in chosen(tree, paths, count, seed): ...
    text = mutant.applied(source)

A mutant has a name, by which `named` makes it again: the file, line and column, the operator, and
which of its changes there.
"""

import ast
import random
import tokenize
from collections import defaultdict
from difflib import unified_diff
from typing import NamedTuple

from tools.mutating.operators import OPERATORS, fitting

from cosmic_ray.ast import Visitor, ast_nodes, get_ast  # isort: skip  # operators.py finds it


class Mutant(NamedTuple):
    path: str  # from the top of the tree
    line: int
    column: int
    operator: str
    which: int

    def __str__(self):
        return "%s:%d:%d:%s:%d" % self

    def applied(self, source):
        """The text with the change. LookupError if there is nothing to change."""
        change = _Change(self)
        text = change.walk(get_ast(source)).get_code()
        if not change.is_done:
            raise LookupError("there is no mutant " + str(self))
        return text

    def difference(self, source):
        """The lines that differ, as `diff` shows them, without its heads."""
        lines = unified_diff(source.splitlines(), self.applied(source).splitlines(), n=0)
        return [line for line in lines if not line.startswith(("---", "+++", "@@"))]


class _Change(Visitor):
    """A walk through a syntax tree that makes one change."""

    def __init__(self, mutant):
        self.mutant = mutant
        self.operator = OPERATORS[mutant.operator]
        self.is_done = False

    def visit(self, node):
        if self.is_done:
            return node
        wanted = (self.mutant.line, self.mutant.column)
        for index, (start, _) in enumerate(self.operator.mutation_positions(node)):
            if start == wanted and index == self.mutant.which:
                self.is_done = True
                return self.operator.mutate(node, index)
        return node


def read(path):
    """The text of a source file."""
    with tokenize.open(path) as file:
        return file.read()


def places(path, source):
    """(line, column) -> the mutants that can be made there."""
    found = defaultdict(list)
    for node in ast_nodes(get_ast(source)):
        for name, operator in fitting(node):
            for index, (start, _) in enumerate(operator.mutation_positions(node)):
                found[start].append(Mutant(path, start[0], start[1], name, index))
    return found


def is_one(source, mutated):
    """Whether it can be compiled, and is another program."""
    try:
        return ast.dump(ast.parse(mutated)) != ast.dump(ast.parse(source))
    except SyntaxError:
        return False


def chosen(tree, paths, count, seed):
    """`count` mutants of these files, or as many as there are.

    A place is as likely as any other, however many changes can be made there; then one of these
    is taken. So the same seed gives the same mutants as long as the files stay the same.
    """
    dice = random.Random(seed)
    sources = {path: read(tree / path) for path in sorted(paths)}
    everywhere = [
        mutants
        for path, source in sources.items()
        for _, mutants in sorted(places(path, source).items())
    ]
    dice.shuffle(everywhere)
    found = []
    for mutants in everywhere:
        if len(found) == count:
            break
        mutant = dice.choice(mutants)
        if is_one(sources[mutant.path], mutant.applied(sources[mutant.path])):
            found.append(mutant)
    return found


def named(name):
    """The mutant of this name. ValueError if it is none."""
    path, line, column, operator, which = name.split(":")
    if operator not in OPERATORS:
        raise ValueError("--mutant: %s is no name of a mutant" % name)
    return Mutant(path, int(line), int(column), operator, int(which))
