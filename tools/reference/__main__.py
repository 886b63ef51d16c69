# SPDX-License-Identifier: MIT
"""Writes firmware/uss/REFERENCE.md, the reference of the library, from its docstrings.

    python3 tools/reference

A test compares what is there with what this makes.
"""

import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
sys.path[0] = str(TOP)

from tools.reference.page import contents, part  # noqa: E402
from tools.reference.source import Module  # noqa: E402

PAGE = "firmware/uss/REFERENCE.md"
HEAD = """# Reference of the library

All that a program may use, module by module, as the docstrings have it; `python3 tools/reference`
writes this page. [README.md](README.md) shows how the parts work together: begin there."""

# What a program uses, from the face down to the engine.
MODULES = (
    "uss.bus uss.errors uss.families uss.families.generic uss.families.kinds uss.layout "
    "uss.scaling uss.pkw uss.bus.pkw_errors uss.tasks.arrays uss.tasks.descriptions "
    "uss.tasks.texts uss.tasks.change_reports uss.pzd uss.bits uss.outside uss.finding.scan "
    "uss.s7 uss.s7.parameters uss.s7.codes uss.br uss.br.blocks uss.br.structures uss.br.codes "
    "uss.master uss.turns uss.deadlines uss.drive uss.receiver uss.timing uss.telegram"
).split()


def module(name):
    path = TOP / "firmware" / name.replace(".", "/")
    return Module(name, path / "__init__.py" if path.is_dir() else path.with_suffix(".py"))


def page():
    """The text of the page."""
    modules = [module(name) for name in MODULES]
    return "\n\n".join([HEAD, contents(modules), *map(part, modules)]) + "\n"


if __name__ == "__main__":
    (TOP / PAGE).write_text(page(), encoding="utf-8")
