# SPDX-License-Identifier: MIT
"""What is changed in a file to make a mutant of it: the operators of cosmic-ray, and two of ours.

An operator knows the nodes of a syntax tree of parso that it can change, and in how many ways.
OPERATORS has them by name; `fitting(node)` has those that may know what to do with a node.
"""

import sys
from pathlib import Path

LIBRARY = Path(__file__).resolve().parents[2] / "build" / "mutating"
sys.path.insert(0, str(LIBRARY))

from cosmic_ray.ast import ast_nodes  # noqa: E402
from cosmic_ray.operators import provider  # noqa: E402
from cosmic_ray.operators.binary_operator_replacement import BinaryOperators  # noqa: E402
from cosmic_ray.operators.number_replacer import NumberReplacer  # noqa: E402
from cosmic_ray.operators.operator import Operator  # noqa: E402
from parso.python.tree import Keyword, Number  # noqa: E402

SMALL = 16  # a number up to this is changed by one, a greater one is doubled or halved
KEPT = {  # kinds of statements that are not taken away
    "import_name", "import_from", "global_stmt", "string", "strings", "keyword", "operator",
    "newline",
}  # fmt: skip
SAME = {"Eq", "NotEq", "Lt", "LtE", "Gt", "GtE"}  # beside Is and IsNot
MACHINE_CODE = ("@micropython.", "@rp2.")


class ReplaceNumber(NumberReplacer):
    """One more or less; a great number twice or half, for one more of it is hardly a bug."""

    def mutate(self, node, index):
        number = float(node.value) if _is_fraction(node.value) else int(node.value, 0)
        if number > SMALL:
            number = number * 2 if index == 0 else number // 2
        else:
            number += 1 if index == 0 else -1
        return Number(str(number), node.start_pos, node.prefix)


class RemoveStatement(Operator):
    """A statement of a function is not there.

    Bare keywords, imports and docstrings stay. So does what makes a variable: without it the
    function only fails, as it does at once without what `__init__` sets. And so does `return None`
    at the end, where nothing else happens without it.
    """

    def mutation_positions(self, node):
        line = node.parent
        if line is None or line.type != "simple_stmt" or node.type in KEPT:
            return
        function = line.search_ancestor("funcdef")
        if function and line is function.children[-1].children[-1]:
            if node.get_code(include_prefix=False) == "return None":
                return
        if function and not (node.type == "expr_stmt" and self._makes(node, function)):
            yield node.start_pos, node.end_pos

    def _makes(self, node, function):
        names = node.get_defined_names()
        if any(name.parent.type == "trailer" for name in names):
            return function.name.value == "__init__"
        bound = [
            leaf.value
            for leaf in ast_nodes(function)
            if leaf.type == "name" and (leaf.is_definition() or leaf.parent.type == "global_stmt")
        ]
        return any(bound.count(name.value) == 1 for name in names)

    def mutate(self, node, index):
        return Keyword("pass", node.start_pos, node.get_first_leaf().prefix)

    @classmethod
    def examples(cls):
        return ()


def _is_fraction(word):
    return not word.lower().startswith("0x") and any(letter in word for letter in ".eE")


def _useful():
    """Those of cosmic-ray that need to be told nothing, and do what ours do not do better."""
    operators = provider.OperatorProvider()
    for name in operators:
        from_and_to = name.split("_")[1:]
        of_identity = {word in SAME for word in from_and_to if word in SAME | {"Is", "IsNot"}}
        # Of small integers, and of objects that compare as such, `is` and `==` are the same.
        mixes = name.startswith("ReplaceComparison") and len(of_identity) == 2
        if not operators[name].arguments() and name != "NumberReplacer" and not mixes:
            yield name, operators[name]()


OPERATORS = dict(_useful()) | {
    "ReplaceNumber": ReplaceNumber(),
    "RemoveStatement": RemoveStatement(),
}


# Which nodes an operator is for, where that is quickly told: they are two hundred.
_ARITHMETIC = {operator.value for operator in BinaryOperators}
_FOR = (
    ("ReplaceBinaryOperator", lambda node: getattr(node, "value", "") in _ARITHMETIC),
    ("ReplaceComparisonOperator", lambda node: node.type == "comparison"),
    ("ReplaceUnaryOperator", lambda node: node.type in ("factor", "not_test")),
    ("", lambda node: node.type not in ("name", "operator", "newline", "string", "endmarker")),
)
_OPERATORS_FOR = tuple(
    (
        is_for,
        [
            (name, operator)
            for name, operator in OPERATORS.items()
            if next(begin for begin, _ in _FOR if name.startswith(begin)) == beginning
        ],
    )
    for beginning, is_for in _FOR
)


def fitting(node):
    """(name, operator) of those that may find something to change in the node."""
    for is_for, operators in _OPERATORS_FOR:
        if is_for(node):
            yield from (one for one in operators if _is_sensible(one[0], node))


def _is_sensible(name, node):
    """Whether what it makes of the node can be a bug that somebody makes."""
    if name == "RemoveDecorator":  # it would be slower, and the same
        return not node.get_code(include_prefix=False).startswith(MACHINE_CODE)
    if name.startswith("ReplaceBinaryOperator_Mod"):
        before = node.get_previous_leaf()
        return before.type != "string"  # a text is formatted: anything else is an error
    return True
