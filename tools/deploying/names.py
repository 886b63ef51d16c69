# SPDX-License-Identifier: MIT
"""Short names for what is private to one file, so that the panel as files needs less memory.

    for path, source in shortened(sources).items(): ...     # {"uss/drive.py": bytes}

MicroPython keeps each name that a module brings for good, even when the module has left the
memory. All of the panel's names do not fit: the table of names would have to grow by 15 KB in one
piece, which a chip that has run for a while does not have. `_turns_left` and `_last_answer` of two
files that have nothing to do with each other are both `_a` on the chip, and take the place of one.

Only a name that begins with one underscore is shortened, that one file alone has, and no text.
Two files whose classes inherit from each other have no short name in common, since both write into
the same object.
"""

import ast
import re
from collections import Counter
from string import ascii_lowercase

PRIVATE = re.compile(r"_[a-zA-Z0-9]\w*")
WORD = re.compile(r"\w+")
EXCHANGE = re.compile(r"( *)(.+?,.+?) = (.+,.+)")
FIELD = {  # where a name stands in a node of the syntax tree
    ast.Name: "id",
    ast.Attribute: "attr",
    ast.FunctionDef: "name",
    ast.ClassDef: "name",
    ast.arg: "arg",
    ast.keyword: "arg",
    ast.alias: "name",
    ast.ExceptHandler: "name",
}


def shortened(sources, fixed=()):
    """The same sources with short names. Those whose path is in `fixed` stay as they are, and so
    do the names in them.
    """
    trees = {path: ast.parse(source) for path, source in sources.items()}
    short = _short(trees, fixed)
    return {
        path: source_of(_Renaming(short[path]).visit(tree)).encode() + b"\n"
        if short[path]
        else sources[path]
        for path, tree in trees.items()
    }


def source_of(tree):
    """The text of a tree. `a, b = b, a` stays without parentheses, which `ast.unparse` may put
    round each side: with them MicroPython makes a tuple, and an interrupt has no memory for one.
    """
    return "\n".join(map(_exchange, ast.unparse(tree).split("\n")))


def _exchange(line):
    found = EXCHANGE.fullmatch(line)
    if found:
        indent, *sides = found.groups()
        bare = " = ".join(side[1:-1] if side[0] + side[-1] == "()" else side for side in sides)
        try:
            if ast.dump(ast.parse(bare)) == ast.dump(ast.parse(line.strip())):
                return indent + bare
        except SyntaxError:
            pass  # the parentheses belong to something else, or it is a line of a text
    return line


def short_names(sources, fixed=()):
    """{path: {name: its short name}}: what a traceback from the chip has in place of it."""
    return _short({path: ast.parse(source) for path, source in sources.items()}, fixed)


def _short(trees, fixed):
    private = _private(trees, fixed)
    known = set().union(*map(_words, trees.values()))
    short = {}
    for relatives in _families(trees):
        names = sorted(name for path in relatives for name in private.get(path, ()))
        of = dict(zip(names, _free_names(known)))
        for path in relatives:
            short[path] = {name: of[name] for name in sorted(private.get(path, ()))}
    return short


def _private(trees, fixed):
    """{path: the names that nobody but this file knows}."""
    files_with = Counter(name for tree in trees.values() for name in _words(tree))
    return {
        path: {
            name
            for name in _made(tree) - _said(tree) - _given(tree)
            if PRIVATE.fullmatch(name) and files_with[name] == 1
        }
        for path, tree in trees.items()
        if path not in fixed
    }


def _words(tree):
    """All names of a file, and all words of its texts: an attribute is found by its text, too."""
    return {word for node in ast.walk(tree) for word in _names(node)} | _said(tree)


def _names(node):
    if isinstance(node, (ast.Global, ast.Nonlocal)):
        return node.names
    if isinstance(node, ast.ImportFrom):
        return WORD.findall(node.module or "")
    if isinstance(node, ast.alias):
        return WORD.findall(f"{node.name} {node.asname or ''}")
    name = getattr(node, FIELD.get(type(node), ""), None)
    return [name] if name else []


def _said(tree):
    """The words of the texts in a file; a text that stands alone is for the reader."""
    said = set()
    alone = {node.value for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    for node in ast.walk(tree):
        text = node.value if isinstance(node, ast.Constant) and node not in alone else None
        if isinstance(text, bytes):
            text = text.decode("latin-1")
        if isinstance(text, str):
            said.update(WORD.findall(text))
    return said


def _made(tree):
    """Names that the file itself gives; `sys.implementation._machine` it only reads."""
    return {
        name
        for node in ast.walk(tree)
        if not isinstance(node, (ast.alias, ast.ImportFrom))
        and not isinstance(getattr(node, "ctx", None), ast.Load)
        for name in _names(node)
    }


def _given(tree):
    """Names that an object gets from outside of its class: it may be of another file."""
    return {
        node.attr
        for node in ast.walk(tree)
        if isinstance(node, ast.Attribute)
        and isinstance(node.ctx, ast.Store)
        and not (isinstance(node.value, ast.Name) and node.value.id == "self")
    }


def _families(trees):
    """The paths in groups: those whose classes inherit from each other are in one."""
    group = {path: {path} for path in trees}
    home = {}
    for path, tree in trees.items():
        for node in ast.walk(tree):
            if isinstance(node, ast.ClassDef):
                home.setdefault(node.name, []).append(path)
    for path, tree in trees.items():
        for node in ast.walk(tree):
            bases = node.bases if isinstance(node, ast.ClassDef) else ()
            for name in [name for base in bases for name in _names(base)]:
                for other in home.get(name, ()):
                    joined = group[path] | group[other]
                    group.update(dict.fromkeys(joined, joined))
    return sorted({min(paths): sorted(paths) for paths in group.values()}.values())


def _free_names(known):
    """_a, _b, ... _z, _aa, _ab: without those that the firmware has itself."""
    ends = [""]
    while True:
        ends = [end + letter for end in ends for letter in ascii_lowercase]
        yield from (name for name in map("_".__add__, ends) if name not in known)


class _Renaming(ast.NodeTransformer):
    def __init__(self, short):
        self.short = short

    def visit(self, node):
        field = FIELD.get(type(node))
        if field:
            name = getattr(node, field)
            setattr(node, field, self.short.get(name, name))
        elif isinstance(node, (ast.Global, ast.Nonlocal)):
            node.names = [self.short.get(name, name) for name in node.names]
        return self.generic_visit(node)
