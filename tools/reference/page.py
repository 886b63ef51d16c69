# SPDX-License-Identifier: MIT
"""A module as a part of a manual, in Markdown.

A docstring stays as it is, but for what Markdown would take for something else, and for columns:

    name       what it is, and             * `name`: what it is, and what
               what is left to say           is left to say
"""

import re

COLUMNS = re.compile(r"^(\S+(?: \S+)*?)  +(\S.*)$")


def contents(modules):
    """A table of the modules."""
    rows = ["| module | |", "|---|---|"]
    for module in modules:
        first = module.text.partition("\n\n")[0].replace("\n", " ")
        rows.append(f"| [`{module.name}`](#{anchor(module.name)}) | {_escaped(first)} |")
    return "\n".join(rows)


def anchor(name):
    """Of a heading that is a name, as the forge makes it."""
    return name.replace(".", "")


def part(module):
    """All of a module."""
    parts = [f"## `{module.name}`", markdown(module.text), _table(module.values)]
    for item in module.items:
        parts += _of_item(item)
    return "\n\n".join(one for one in parts if one)


def _of_item(item):
    if item.kind != "class":
        return [f"**`{item.signature}`**", markdown(item.text)]
    parts = [f"### `{item.signature}`", markdown(item.text), _table(item.values)]
    for one in item.items:
        if not one.text:
            continue  # it does what the one of the base does
        parts += [f"**`{one.signature}`**", markdown(one.text)]
    return parts


def _table(values):
    if not values:
        return ""
    rows = ["| name | value | |", "|---|---|---|"]
    for value in values:
        written = f"`{value.written}`".replace("|", "\\|") if value.written else "..."
        rows.append(f"| `{value.name}` | {written} | {_escaped(value.remark)} |")
    return "\n".join(rows)


def markdown(text):
    """A docstring."""
    return "\n\n".join(_block(block) for block in text.split("\n\n") if block.strip())


def _block(block):
    lines = block.split("\n")
    if all(line.startswith("    ") for line in lines):
        return block  # an example
    made = []
    for line in lines:
        columns = COLUMNS.match(line)
        if columns and not line.startswith(" "):
            made.append(f"* `{columns[1]}`: {_escaped(columns[2])}")
        elif line.startswith("    ") and made and made[-1].startswith(("* ", "  ")):
            made.append("  " + _escaped(line.strip()))
        elif line.startswith("    "):
            made.append("* " + _escaped(line.strip()))
        else:
            made.append(_escaped(line))
    text = "\n".join(made)
    return re.sub(r"^(?![* ])(.*)\n\* ", r"\1\n\n* ", text, flags=re.M)


def _escaped(text):
    """Outside of what stands in backquotes."""
    parts = text.split("`")
    parts[::2] = [re.sub(r"([*<|])", r"\\\1", part).replace("](", "] (") for part in parts[::2]]
    return "`".join(parts)
