# SPDX-License-Identifier: MIT
"""What a module offers, read from its source: classes, functions, constants, and what is said of
them. Nothing is imported.

    module = Module("uss.scaling", path)
    module.text                     # its docstring
    module.items[0].signature       # "Scale(reference_hertz=None, ...)"
"""

import ast
import io
import tokenize

SHOWN_MAX = 60  # characters of a value


class Item:
    """A class, a function, a method or a property. items, values: of a class."""

    def __init__(self, name, kind, signature, text, items=(), values=()):
        self.name = name
        self.kind = kind
        self.signature = signature
        self.text = text
        self.items = items
        self.values = values


class Value:
    """A constant: its value as it is written, and the remark beside it or above it."""

    def __init__(self, name, written, remark):
        self.name = name
        self.written = written
        self.remark = remark


class Module:
    """name: as one imports it. path: a `pathlib.Path`."""

    def __init__(self, name, path):
        source = path.read_text(encoding="utf-8")
        tree = ast.parse(source)
        self.name = name
        self.text = ast.get_docstring(tree) or ""
        remarks = _Remarks(source)
        self.values = _values(tree.body, remarks)
        self.items = [_item(node, remarks) for node in tree.body if _is_offered(node)]


class _Remarks:
    """The comments of a source by line, and whether there is code in front of them."""

    def __init__(self, source):
        self._beside, self._alone = {}, {}
        for token in tokenize.generate_tokens(io.StringIO(source).readline):
            if token.type == tokenize.COMMENT:
                is_alone = not token.line[: token.start[1]].strip()
                remark = token.string.lstrip("# ").rstrip()
                (self._alone if is_alone else self._beside)[token.start[0]] = remark

    def of(self, node):
        """Beside it, or else in the lines above it."""
        beside = [self._beside.get(line) for line in range(node.lineno, node.end_lineno + 1)]
        beside = [remark for remark in beside if remark and not remark.startswith("fmt:")]
        if len(beside) == 1:  # several are about parts of the value
            return beside[0]
        above, line = [], node.lineno - 1
        while line in self._alone:
            above.insert(0, self._alone[line])
            line -= 1
        return "" if any("---" in remark for remark in above) else " ".join(above)


def _is_offered(node):
    return isinstance(node, (ast.ClassDef, ast.FunctionDef)) and node.name[0] != "_"


def _item(node, remarks):
    text = ast.get_docstring(node) or ""
    if isinstance(node, ast.FunctionDef):
        is_property = any(ast.unparse(one) == "property" for one in node.decorator_list)
        signature = node.name if is_property else "%s(%s)" % (node.name, _arguments(node))
        return Item(node.name, "property" if is_property else "function", signature, text)
    begins = [one for one in node.body if getattr(one, "name", "") == "__init__"]
    signature = "%s(%s)" % (node.name, _arguments(begins[0])) if begins else node.name
    bases = [base for base in map(ast.unparse, node.bases) if base != "Exception"]
    if bases:
        signature += ", a " + ", ".join(bases)
    items = [
        _item(one, remarks)
        for one in node.body
        if _is_offered(one) and not any(".setter" in ast.unparse(d) for d in one.decorator_list)
    ]
    return Item(node.name, "class", signature, text, items, _values(node.body, remarks))


def _arguments(function):
    words = ast.unparse(function.args).split(", ")
    return ", ".join(words[1:] if words[0] in ("self", "cls") else words)


def _values(body, remarks):
    """The constants among these statements whose names are no secret."""
    found = []
    for node in body:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            name = node.targets[0].id
            if name[0] != "_":
                found.append(Value(name, _written(node.value), remarks.of(node)))
    return found


def _written(value):
    """As one line; without `const`, which is for the compiler."""
    if isinstance(value, ast.Call) and ast.unparse(value.func) == "const":
        value = value.args[0]
    text = ast.unparse(value)
    return text if len(text) <= SHOWN_MAX else ""
