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
from functools import cached_property
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
    files = {path: _File(source) for path, source in sources.items()}
    short = _short(files, fixed)
    return {
        path: file.renamed(short[path]) if short[path] else sources[path]
        for path, file in files.items()
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
    return _short({path: _File(source) for path, source in sources.items()}, fixed)


def _short(files, fixed):
    private = _private(files, fixed)
    known = set().union(*(file.words for file in files.values()))
    short = {}
    for relatives in _families(files):
        names = sorted(name for path in relatives for name in private.get(path, ()))
        of = dict(zip(names, _free_names(known)))
        for path in relatives:
            short[path] = {name: of[name] for name in sorted(private.get(path, ()))}
    return short


def _private(files, fixed):
    """{path: the names that nobody but this file knows}."""
    files_with = Counter(word for file in files.values() for word in file.words)
    return {
        path: {
            name
            for name in file.made - file.said - file.given
            if PRIVATE.fullmatch(name) and files_with[name] == 1
        }
        for path, file in files.items()
        if path not in fixed
    }


def _families(files):
    """The paths in groups: those whose classes inherit from each other are in one."""
    group = {path: {path} for path in files}
    home = {}
    for path, file in files.items():
        for one in file.classes:
            home.setdefault(one.name, []).append(path)
    for path, file in files.items():
        for name in [name for one in file.classes for base in one.bases for name in _names(base)]:
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


class _File:
    """A source, and its names."""

    def __init__(self, source):
        self._tree = ast.parse(source)
        self._nodes = list(ast.walk(self._tree))  # to walk takes longer than to look
        self.classes = [node for node in self._nodes if isinstance(node, ast.ClassDef)]

    @cached_property
    def words(self):
        """All names, and all words of its texts: an attribute is found by its text, too."""
        return {word for node in self._nodes for word in _names(node)} | self.said

    @cached_property
    def said(self):
        """The words of the texts; a text that stands alone is for the reader."""
        said = set()
        alone = {node.value for node in self._nodes if isinstance(node, ast.Expr)}
        for node in self._nodes:
            text = node.value if isinstance(node, ast.Constant) and node not in alone else None
            if isinstance(text, bytes):
                text = text.decode("latin-1")
            if isinstance(text, str):
                said.update(WORD.findall(text))
        return said

    @property
    def made(self):
        """Names that the file itself gives; `sys.implementation._machine` it only reads."""
        return {
            name
            for node in self._nodes
            if not isinstance(node, (ast.alias, ast.ImportFrom))
            and not isinstance(getattr(node, "ctx", None), ast.Load)
            for name in _names(node)
        }

    @property
    def given(self):
        """Names that an object gets from outside of its class: it may be of another file."""
        return {
            node.attr
            for node in self._nodes
            if isinstance(node, ast.Attribute)
            and isinstance(node.ctx, ast.Store)
            and not (isinstance(node.value, ast.Name) and node.value.id == "self")
        }

    def renamed(self, short):
        """The source with the short names. What it was before is lost."""
        for node in self._nodes:
            field = FIELD.get(type(node))
            if field:
                name = getattr(node, field)
                setattr(node, field, short.get(name, name))
            elif isinstance(node, (ast.Global, ast.Nonlocal)):
                node.names = [short.get(name, name) for name in node.names]
        return source_of(self._tree).encode() + b"\n"


def _names(node):
    if isinstance(node, (ast.Global, ast.Nonlocal)):
        return node.names
    if isinstance(node, ast.ImportFrom):
        return WORD.findall(node.module or "")
    if isinstance(node, ast.alias):
        return WORD.findall(f"{node.name} {node.asname or ''}")
    name = getattr(node, FIELD.get(type(node), ""), None)
    return [name] if name else []
